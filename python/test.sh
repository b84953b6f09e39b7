#!/usr/bin/env bash
# Builds the wheel, installs it into a fresh virtual environment and runs the tests there. Needs
# maturin, and packages of the index. The profile: test, or what is given.
set -euo pipefail
cd "$(dirname "$0")"
profile=${1:-test}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

maturin build --locked --profile "$profile" --out "$work/wheels"
python3 -m venv "$work/fresh"
"$work/fresh/bin/pip" install --quiet "$work"/wheels/*.whl
# Without any other package first: gwatt needs none.
"$work/fresh/bin/python" -m unittest discover --start-directory tests
"$work/fresh/bin/pip" install --quiet \
    numpy pandas pyarrow matplotlib distributed mypy typing_extensions
"$work/fresh/bin/python" -m unittest discover --start-directory tests
# The stub is that of the package, not of the library in it.
echo 'gwatt\.gwatt' >"$work/allowed"
"$work/fresh/bin/python" -m mypy.stubtest gwatt --allowlist "$work/allowed"
