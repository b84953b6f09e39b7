#!/usr/bin/env bash
# Builds the documentation as a book, with mdBook:
#
#     docs/book.sh OUT [ADDRESS]
#
# ADDRESS is where the files of the repository are shown, such as
# https://example.org/gwatt/blob/main: links to files that are not in the book lead there.
set -euo pipefail
out=$(realpath -m "$1")
address=${2:-https://example.org/gwatt}
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$root/book.toml" "$work"
cp -r "$root/docs" "$work/docs"
sed -i -E "s#\]\(\.\./\.\./([^)]*)\)#]($address/\1)#g; s#\]\(\.\./([^)]*)\)#]($address/\1)#g" \
    "$work"/docs/*.md
sed -i -E "s#\]\(\.\./\.\./([^)]*)\)#]($address/\1)#g" "$work"/docs/rules/*.md
mdbook build "$work" --dest-dir "$out"
