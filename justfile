# Everything that CI runs
ci:
    .ci/run

test *args:
    cargo test --locked {{args}}

fmt:
    cargo fmt --all

lint:
    cargo clippy --all-targets -- -D warnings

# Accept what snapshots and README examples show now
bless:
    INSTA_UPDATE=always TRYCMD=overwrite cargo test

doc:
    RUSTDOCFLAGS="-D warnings" cargo doc --no-deps

# The documentation as a book, in target/book; needs mdbook
book:
    docs/book.sh target/book

bench *args:
    cargo bench {{args}}

# One fuzz target, ten minutes; needs cargo-fuzz and a nightly toolchain
fuzz target seconds="600":
    cargo +nightly fuzz run {{target}} -- -max_total_time={{seconds}} -dict=fuzz/gcode.dict
