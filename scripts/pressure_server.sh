#!/usr/bin/env bash
# `stipple serve` under pressure: 1000 slow readers and 1000 half-open connections beside normal clients, an end
# under load, files that are replaced and cut while they are served, no descriptors left, clients that are killed in
# every state. Prints figures; fails if bytes were lost or mixed, or if the server is busy without clients. 4 minutes.
#   scripts/pressure_server.sh [slow|end|change|descriptors|gone...]
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
ulimit -n "$(ulimit -Hn)"
configure_and_build release stipple pad_cloud
stipple=build/release/client/headless/stipple
work=build/pressure
mkdir -p "$work"
if [ ! -e "$work/done" ]; then
  "$stipple" synth "$work/small.las" --points 2000 --scene terrain --seed 1 >/dev/null
  "$stipple" convert "$work/small.las" -o "$work/small.stipple" --progress none >/dev/null
  for cloud in large:536870912:1 a:16777216:2 b:16777216:3; do
    IFS=: read -r name bytes seed <<<"$cloud"
    cp "$work/small.stipple" "$work/$name.stipple"
    build/release/tests/bench/pad_cloud "$work/$name.stipple" "$bytes" "$seed"
  done
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 3650 -subj /CN=localhost \
    -keyout "$work/key.pem" -out "$work/cert.pem" 2>/dev/null
  touch "$work/done"
fi
[ "${1:-}" = --prepare ] && exit # for other scripts
node tests/load/pressure.mjs "$stipple" "$work" "$@"
