#!/usr/bin/env bash
# Measures time against error of every way of drawing (`stipple bench`): towns of 1 and 5 million points, and scans given to
# it. Needs the program that scripts/test.sh or scripts/demo.sh builds. Works in build/bench_rendering (WORK sets another
# folder), where clouds and reference pictures stay for the next time. The report is report.html there: time against error of
# all modes and budgets with the line that none beats, a chart for each group (detail, shapes and splats, delayed expansion, skips),
# and a table of modes against others, each skip off against on; report.json and frames.csv have the same.
#
#   scripts/bench_rendering.sh [SCAN...] [-- OPTION...]
#
#   SCAN     a scan that `stipple convert` reads, or a .stipple file
#   OPTION   for stipple bench: --modes, --paths, --budgets, --frames, --size, --repeats, …; stipple bench --help
# Without options: six paths of six frames, all modes, budgets from 0.1 to 20 million points, 1280x720; hours on two cores
# the first time, most of it the reference pictures. Counts and errors are exact; times are what they are
# on a machine that does something else as well.
set -euo pipefail
fail() { echo "scripts/bench_rendering.sh: $1" >&2; exit "${2:-2}"; }
root=$(realpath "$(dirname "$0")/..")
stipple=${STIPPLE:-$root/build/release/client/headless/stipple}
[ -x "$stipple" ] || fail "$stipple is not there; scripts/demo.sh builds it"
work=${WORK:-$root/build/bench_rendering}
mkdir -p "$work"

scans=()
while [ $# -gt 0 ]; do
  case $1 in
    --) shift; break ;;
    -*) fail "$1 is no option; options for stipple bench go behind --" ;;
    *) [ -e "$1" ] || fail "$1 is not there"; scans+=("$1") ;;
  esac
  shift
done

clouds=()
for millions in 1 5; do
  cloud=$work/town$millions.stipple
  if [ ! -e "$cloud" ]; then
    "$stipple" synth "$work/town.las" --points ${millions}000000 --scene town --seed 1
    "$stipple" convert "$work/town.las" -o "$cloud" --progress none
    rm "$work/town.las"
  fi
  clouds+=("$cloud")
done
for scan in "${scans[@]}"; do
  if [ "${scan##*.}" = stipple ]; then
    clouds+=("$scan")
    continue
  fi
  name=$(basename "$scan")
  cloud=$work/${name%.*}.stipple
  [ -e "$cloud" ] || "$stipple" convert "$scan" -o "$cloud" --progress none
  clouds+=("$cloud")
done
exec "$stipple" bench "${clouds[@]}" -o "$work" "$@"
