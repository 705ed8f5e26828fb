#!/usr/bin/env bash
# Prints how fast both rasterizers draw, and what delayed expansion gains and costs: `client_render_speed` at 1080p with 2, 5, 10 and
# 20 million points; the tables of docs/MEASUREMENTS.md. For a quiet machine: minutes in software, an hour with a GL in software.
#
#   scripts/measure_rendering.sh [GLES 1 or 0, default 0] [MILLIONS...]
#   PART=cases|discs|expansion takes one part of the table alone; all of them by default
#
# Error against time of every way of drawing, on scans: scripts/bench_rendering.sh.
set -euo pipefail
fail() { echo "scripts/measure_rendering.sh: $1" >&2; exit "${2:-2}"; }
root=$(realpath "$(dirname "$0")/..")
speed=${CLIENT_RENDER_SPEED:-$root/build/release/tests/unit/client/render/client_render_speed}
[ -x "$speed" ] || fail "$speed is not there; scripts/test.sh builds it"
gles=${1:-0}
case $gles in 0 | 1) ;; *) fail "the first argument is 1 (with OpenGL ES) or 0 (without), not '$gles'" ;; esac
shift || true
[ $# -gt 0 ] || set -- 2 5 10 20
echo "$(nproc) cores, load $(cut -d' ' -f1-3 /proc/loadavg)"
for millions in "$@"; do
  case $millions in '' | *[!0-9.]*) fail "'$millions' is not a number of millions" ;; esac
  "$speed" "$millions" 1920 1080 "$gles" "${PART:-all}"
  echo
done
