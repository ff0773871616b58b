#!/bin/bash
# Stops simulate and three experiments at random moments and starts them again until they end. Their results must then be,
# byte for byte, those of runs that were left alone; only their times differ. SIGKILL, SIGTERM and SIGHUP take turns.
#   tests/interruptions.sh [COUNT of signals, 100] [BUILD folder, build] [SEED, 1]
# `make interruptions` builds the programs first.
set -euo pipefail
cd "$(dirname "$0")/.."
count=${1:-100} build=$(realpath "${2:-build}") RANDOM=${3:-1}
thirty="$build/simulate $PWD/experiments/cases/thirty.txt output=results checkpoint_every=0.2"
commands=(
  "$thirty end_time=0.5"
  "$thirty end_time=0.3 integrator=rk3 tolerance=1e-4"
  "$build/couette_run case=phi5_lambda3_paper_quick"
  "$build/fig6_injection case=quick"
  "$build/fig4_taylor_green case=quick")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

microseconds() { echo "${EPOCHREALTIME/./}"; }

# start FOLDER: the command, with its results there, in the background.
start() {
  mkdir -p "$1"
  (cd "$1" && exec $command) > "$work/log" 2>&1 < /dev/null &
  process=$!
}

stopped=0
for number in "${!commands[@]}"; do
  command=${commands[$number]} whole=$work/whole$number parts=$work/parts$number runs=0
  began=$(microseconds)
  start "$whole"
  wait "$process" || { cat "$work/log"; exit 1; }
  length=$(($(microseconds) - began))
  until_now=$((count * (number + 1) / ${#commands[@]}))
  while [ "$stopped" -lt "$until_now" ]; do
    rm -rf "$parts"
    status=1
    while [ "$status" != 0 ]; do
      start "$parts"
      if [ "$stopped" -lt "$until_now" ]; then
        delay=$((length * RANDOM / 32767))
        sleep "$(printf '%d.%06d' $((delay / 1000000)) $((delay % 1000000)))"
        signals=(KILL TERM HUP)
        if kill -s "${signals[$((stopped % 3))]}" "$process" 2> /dev/null; then stopped=$((stopped + 1)); fi
      fi
      status=0
      wait "$process" 2> /dev/null || status=$?
      case $status in
        0 | 129 | 137 | 143) ;;
        *) cat "$work/log"; echo "$command: status $status"; exit 1 ;;
      esac
    done
    runs=$((runs + 1))
    diff -r -x '*_timing.csv' "$whole" "$parts" || { echo "$command: other results after interruptions"; exit 1; }
  done
  echo "${command#"$build/"}: $runs runs with $stopped signals so far, same results; $((length / 1000)) ms without"
done
