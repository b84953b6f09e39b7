# gwatt alone, on Alpine:
#
#     docker build -t gwatt .
#     docker run --rm -v "$PWD:/work" gwatt check part.nc -m mine.toml
FROM rust:1-alpine AS build
RUN apk add --no-cache musl-dev
WORKDIR /gwatt
COPY . .
RUN cargo build --release --locked --bin gwatt

# A shell is in it for the sake of jobs that begin with a line of it.
FROM alpine:3
COPY --from=build /gwatt/target/release/gwatt /usr/local/bin/gwatt
COPY LICENSE-MIT LICENSE-APACHE /usr/share/licenses/gwatt/
# Not root; --user to write what belongs to somebody else.
USER 65534:65534
WORKDIR /work
ENTRYPOINT ["gwatt"]
