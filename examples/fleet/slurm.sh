#!/bin/sh
#SBATCH --job-name=gwatt
#SBATCH --array=1-16
#SBATCH --cpus-per-task=4
#
# Checks all programs below a folder, each task of the array its share. The array has to begin
# with 1. Results are put into a folder, a file for each task.
#
#     MACHINE=mill.toml FOLDER=programs RESULTS=results sbatch slurm.sh
set -eu
share=$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT
mkdir -p "$RESULTS"

gwatt check "$FOLDER" -m "$MACHINE" --shard "$share" --format jsonl \
    --threads "${SLURM_CPUS_PER_TASK:-1}" >"$RESULTS/$SLURM_ARRAY_TASK_ID.jsonl" || [ $? -le 2 ]
