#!/bin/sh
# Runs the cases of section 4.4 as a job array of a Slurm cluster: experiments/submit_couette.sh [SEEDS] [sbatch options]
# One task of one core a case; a task that was cut off goes on from its checkpoint when it is submitted again. Collect
# with `make table2_order_parameter table3_effective_viscosity fig9_order_parameter fig10_effective_viscosity SEEDS=n`.
set -eu
cd "$(dirname "$0")/.."
seeds=${1:-1}
[ $# -eq 0 ] || shift
make build/couette_run
mkdir -p results/couette_run
list=results/couette_run/cases.txt
make -s couette_cases SEEDS="$seeds" > "$list"
sbatch --array="1-$(wc -l < "$list")" --ntasks=1 --cpus-per-task=1 --job-name=couette "$@" --wrap \
  "build/couette_run case=\$(sed -n \"\${SLURM_ARRAY_TASK_ID}p\" $list) results=results"
