#!/usr/bin/env bash
# Builds gwatt for the action, unless it is installed. Runs with GITHUB_ACTION_PATH (the clone of
# gwatt), GITHUB_PATH and RUNNER_TEMP, as GitHub gives them.
set -euo pipefail

if command -v gwatt >/dev/null; then
    gwatt --version
    exit 0
fi
target=${CARGO_TARGET_DIR:-$RUNNER_TEMP/gwatt}
cargo build --release --locked --manifest-path "$GITHUB_ACTION_PATH/Cargo.toml" --target-dir "$target"
echo "$target/release" >>"$GITHUB_PATH"
