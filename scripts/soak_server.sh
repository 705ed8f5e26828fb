#!/usr/bin/env bash
# An hour's worth of mixed load on `stipple serve`, squeezed into ten minutes: ranges of files that are replaced, the page,
# points, profiles, nodes and pictures, https, an upstream, clients that leave and that are killed, SIGHUP. Memory, descriptors
# and processor time at twenty quiet moments must be flat (tests/load/soak.mjs has the criteria). With --asan or --tsan, the same
# against a server built with that sanitizer, for a minute.
#   scripts/soak_server.sh [--asan|--tsan] [--seconds 600]
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
ulimit -n "$(ulimit -Hn)"
preset=release seconds= sanitized=
while [ $# -gt 0 ]; do
  case "$1" in
    --asan | --tsan) preset=${1#--} sanitized=sanitized; shift ;;
    --seconds) seconds=$2; shift 2 ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
done
[ -n "$seconds" ] || { [ -n "$sanitized" ] && seconds=60 || seconds=600; }
scripts/pressure_server.sh --prepare
work=build/pressure
if [ ! -e "$work/scan.stipple" ]; then
  build/release/client/headless/stipple synth "$work/scan.las" --points 300000 --scene terrain --seed 2 >/dev/null
  build/release/client/headless/stipple convert "$work/scan.las" -o "$work/scan.stipple" --progress none >/dev/null
fi
[ -e www/dist/index.html ] || scripts/build_web.sh
[ "$preset" = release ] || configure_and_build "$preset" stipple
node tests/load/soak.mjs "build/$preset/client/headless/stipple" "$work" "$seconds" $sanitized
