#!/bin/sh
# Checks all programs below a folder in as many runs as there are cores, or in SHARES of them.
# To use other computers too, add --sshlogin: gwatt, the machine file and the programs have to
# lie at the same places there.
#
#     parallel.sh MACHINE FOLDER [SHARES] > results.jsonl
set -eu
machine=$1
folder=$2
shares=${3:-$(nproc)}

check='gwatt check "$1" -m "$2" --threads 1 --format jsonl --shard "$3" || [ $? -le 2 ]'
seq "$shares" | parallel --will-cite --jobs "$shares" --quote \
    sh -c "$check" sh "$folder" "$machine" "{}/$shares"
