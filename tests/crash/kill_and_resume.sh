#!/usr/bin/env bash
# A conversion that is killed at any moment goes on when the same command is given again, and ends with the same bytes.
#
#   tests/crash/kill_and_resume.sh STIPPLE INPUT... [-- OPTION...]      KILLS=20 SEED=1
#
# Converts once undisturbed. Then KILLS times: starts the same conversion, sends SIGKILL after a random part of the
# time that it took, looks that no output has appeared (or a whole one), starts it again to the end and compares.
# The last round kills again and again, each time a little later, until it gets through.
set -euo pipefail
stipple=${1:?usage: kill_and_resume.sh STIPPLE INPUT... [-- OPTION...]}
shift
inputs=() options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do inputs+=("$1"); shift; done
[ $# -eq 0 ] || { shift; options=("$@"); }
kills=${KILLS:-20}
RANDOM=${SEED:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

milliseconds() { date +%s%3N; }
convert() { "$stipple" convert "${inputs[@]}" -o "$1" --name cloud --progress none "${options[@]}"; }
fail() { echo "kill_and_resume: $*" >&2; exit 1; }

started=$(milliseconds)
convert "$work/whole.stipple" >"$work/whole.log" 2>&1 || { cat "$work/whole.log" >&2; fail "the undisturbed conversion failed"; }
took=$(($(milliseconds) - started))
sum=$(sha256sum <"$work/whole.stipple")

# Starts the conversion and kills it after $1 ms; 0 if it was killed, 1 if it had ended before.
start_and_kill() {
  convert "$work/out.stipple" >"$work/killed.log" 2>&1 &
  local process=$!
  sleep "$(printf '%d.%03d' $(($1 / 1000)) $(($1 % 1000)))"
  # The shell function runs in a subshell: the program is its child.
  pkill -KILL -P $process 2>/dev/null || { wait $process || fail "ended by itself, with $?"; return 1; }
  wait $process 2>/dev/null || true
}
check_whole() {
  [ "$(sha256sum <"$work/out.stipple")" = "$sum" ] || fail "$1: other bytes"
  [ ! -e "$work/out.stipple.work" ] || fail "$1: the folder for temporary files is still there"
  rm -f "$work/out.stipple"
}

resumed=0
for round in $(seq "$kills"); do
  at=$((RANDOM * took / 32768))
  if start_and_kill $at; then
    [ ! -e "$work/out.stipple" ] || [ "$(sha256sum <"$work/out.stipple")" = "$sum" ] ||
      fail "round $round: an unfinished file bears the output's name"
    ! [ -e "$work/out.stipple.work" ] || resumed=$((resumed + 1))
    convert "$work/out.stipple" >"$work/resumed.log" 2>&1 || { cat "$work/resumed.log" >&2; fail "round $round: killed after $at ms, it does not go on"; }
  fi
  check_whole "round $round (killed after $at ms)"
done

attempts=0
at=$((took / 8))
while start_and_kill $at; do
  attempts=$((attempts + 1))
  at=$((at + took / 16))
done
check_whole "the round of many kills"
[ "$kills" -lt 5 ] || [ "$resumed" -gt 0 ] || fail "no kill left anything to go on from"
echo "kill_and_resume: $kills kills at random moments of $took ms, $resumed left a checkpoint; $attempts kills in a row: the same bytes each time"
