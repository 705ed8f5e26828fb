#!/usr/bin/env bash
# Measures how long a picture by address takes, 1280 × 720 with 2 million points:
#   cold   the first picture of a server that has just started, the cloud's file not in memory
#   warm   another view of the same cloud: its nodes are decoded as far as they are the same
#   kept   the same picture again, as PNG from the server's memory
# Prints medians and extremes over the rounds, in milliseconds.
#   scripts/measure_images.sh CLOUD.stipple [ROUNDS, default 5]
set -euo pipefail
[ $# -ge 1 ] || { sed -n 2,8p "$0"; exit 2; }
cloud=$(realpath "$1")
rounds=${2:-5}
cd "$(dirname "$0")/.."
program=${STIPPLE_PROGRAM:-build/release/client/headless/stipple}
[ -x "$program" ] || { echo "$program is missing; build first" >&2; exit 3; }
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server" 2>/dev/null; rm -rf "$work"' EXIT
id=$(basename "$cloud" .stipple)

start() {
  dd if="$cloud" iflag=nocache count=0 status=none # forgets what of the file is in memory
  "$program" serve "$cloud" --port 0 --pictures-per-minute 0 >"$work/out" 2>&1 &
  server=$!
  for _ in $(seq 100); do
    address=$(grep -om1 'http://[0-9.:]*/' "$work/out" || true)
    [ -z "$address" ] || return 0
    sleep 0.05
  done
  cat "$work/out" >&2
  exit 1
}
# ask NAME QUERY: one line, the seconds it took
ask() {
  local status
  read -r status seconds < <(curl -so "$work/picture" -w '%{http_code} %{time_total}\n' \
    "${address}api/v1/clouds/$id/image?width=1280&height=720&budget=2000000&$2")
  [ "$status" = 200 ] || { cat "$work/picture" >&2; exit 1; }
  echo "$seconds" >>"$work/$1"
}

for _ in $(seq "$rounds"); do
  start
  ask "cold PNG" 'view=iso'
  ask "warm PNG" 'view=front'
  ask "kept PNG" 'view=iso'
  ask "warm WebP" 'view=front&format=webp'
  kill "$server"
  wait "$server" || true
  server=
done
for name in "cold PNG" "warm PNG" "warm WebP" "kept PNG"; do
  sort -n "$work/$name" | awk -v name="$name" '{ v[NR] = $1 * 1000 }
    END { printf "%-10s %7.1f ms (%.1f to %.1f)\n", name, v[int((NR + 1) / 2)], v[1], v[NR] }'
done
