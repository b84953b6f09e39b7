#!/usr/bin/env bash
# CPU time of `gwatt check` and `gwatt limit` on a large program, as a ratio to
# a stream editor that replaces every F word of the same file: once with its
# output discarded, once with its output written to a file, as `limit` does.
#
#     benches/compare.sh program.ngc [machine…]
#
# Needs bash, GNU time and sed. GWATT: the binary (default: the release build);
# ROUNDS: how often each command runs (5). The commands take turns, so that
# whatever else the computer does falls on all alike; medians count.
set -euo pipefail

if [ $# -lt 1 ]; then
    sed -n '2,10s/^# \{0,1\}//p' "$0" >&2
    exit 2
fi
program=$1
shift
machines=("${@:-three-axis}")
gwatt=${GWATT:-$(dirname "$0")/../target/release/gwatt}
rounds=${ROUNDS:-5}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
TIMEFORMAT='%3U %3S'

# Runs a command and appends its name, CPU seconds and peak memory in KiB.
# A program that does not fit (exit 1) is as good as one that does.
measure() {
    local name=$1 out=$2 status=0
    shift 2
    { time LC_ALL=C /usr/bin/time -q -o "$scratch/memory" -f %M \
        "$@" >"$out" 2>"$scratch/messages" || status=$?; } 2>"$scratch/times"
    if [ "$status" -gt 1 ]; then
        echo "$name: exit $status" >&2
        head -20 "$scratch/messages" >&2
        exit 2
    fi
    paste -d ' ' "$scratch/times" "$scratch/memory" |
        awk -v name="$name" '{ print name, $1 + $2, $3 }' >>"$scratch/figures"
}

# The median of a column of one command's figures.
median() {
    awk -v name="$1" -v column="$2" '$1 == name { print $column }' "$scratch/figures" | sort -g |
        awk '{ value[NR] = $1 } END { print (value[int((NR + 1) / 2)] + value[int(NR / 2) + 1]) / 2 }'
}

for ((round = 0; round < rounds; round++)); do
    measure sed /dev/null sed -E 's/F[0-9.]+/F999/' "$program"
    measure sed-to-file "$scratch/out" sed -E 's/F[0-9.]+/F999/' "$program"
    for machine in "${machines[@]}"; do
        measure "check:$machine" /dev/null \
            "$gwatt" check --machine "$machine" --threads 1 "$program"
        measure "limit:$machine" /dev/null \
            "$gwatt" limit --machine "$machine" --allow feed --threads 1 \
            --output "$scratch/out.ngc" "$program"
    done
done

megabytes=$(wc -c <"$program" | awk '{ print $1 / 1e6 }')
discarded=$(median sed 2)
written=$(median sed-to-file 2)
printf '%-20s %8s %8s %8s %12s %9s\n' command CPU/s MB/s ratio ratio-file peak/MiB
for name in sed sed-to-file "${machines[@]/#/check:}" "${machines[@]/#/limit:}"; do
    awk -v name="$name" -v s="$(median "$name" 2)" -v kib="$(median "$name" 3)" \
        -v discarded="$discarded" -v written="$written" -v megabytes="$megabytes" \
        'BEGIN { printf "%-20s %8.3f %8.1f %8.2f %12.2f %9.1f\n", name, s, megabytes / s,
                 s / discarded, s / written, kib / 1024 }'
done
