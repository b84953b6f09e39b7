#!/usr/bin/env bash
# Checks programs for the action: annotations for GitHub on standard output, and SARIF into a
# file if one is named. PROGRAMS and ARGUMENTS have one entry a line.
set -euo pipefail

arguments=()
# Takes the lines of a text that are not empty.
take() {
    local line
    while IFS= read -r line || [ -n "$line" ]; do
        line=${line%$'\r'}
        if [ -n "$line" ]; then arguments+=("$line"); fi
    done <<<"$1"
}
if [ -n "${MACHINE:-}" ]; then arguments+=(--machine "$MACHINE"); fi
if [ -n "${BASELINE:-}" ]; then arguments+=(--baseline "$BASELINE"); fi
take "${ARGUMENTS:-}"
arguments+=(--)
take "${PROGRAMS:-.}"

code=0
if [ -n "${SARIF:-}" ]; then
    # The same verdict comes again below.
    gwatt check --format sarif "${arguments[@]}" >"$SARIF" 2>/dev/null || code=$?
    if [ "$code" -gt 2 ]; then exit "$code"; fi
fi
exec gwatt check --format github "${arguments[@]}"
