#!/usr/bin/env bash
# Streams a view over a link that the kernel shapes (tc's token bucket, in a network namespace of its own), to set against the
# simulated networks of `streaming_bench`: seconds until the view is complete, requests, bytes, and the part of the link's time that
# its bytes alone would take (with TCP's and HTTP's own below 1). Needs root, `ip` and `tc`.
#
#   scripts/measure_shaped.sh CLOUD.stipple [MBIT...]      default: 5 50 500
#   BUDGETS="50000 200000 1000000" sets how many points the view has
set -euo pipefail
fail() { echo "scripts/measure_shaped.sh: $1" >&2; exit "${2:-2}"; }
root=$(realpath "$(dirname "$0")/..")
stipple=${STIPPLE:-$root/build/release/client/headless/stipple}
[ -x "$stipple" ] || fail "$stipple is not there; scripts/test.sh builds it"
[ $# -gt 0 ] || fail "say which cloud: CLOUD.stipple [MBIT...]"
cloud=$(realpath -e "$1" 2> /dev/null) || fail "$1 is not there" 3
shift
[ $# -gt 0 ] || set -- 5 50 500
for tool in ip tc node; do command -v "$tool" > /dev/null || fail "$tool is missing (Debian: iproute2, nodejs)"; done
[ "$(id -u)" = 0 ] || fail "only root may make a network namespace"

space=stipple-shaped-$$ work=$(mktemp -d)
server=
cleanup() {
  [ -z "$server" ] || kill "$server" 2> /dev/null || true
  ip netns del "$space" 2> /dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT
ip netns add "$space"
inside() { ip netns exec "$space" "$@"; }
inside ip link set lo mtu 1500 up

inside "$stipple" serve "$cloud" --port 8017 --page "$work" --grace 0 > "$work/server.log" 2>&1 &
server=$!
for _ in $(seq 100); do
  inside "$stipple" render "http://127.0.0.1:8017/clouds/$(basename "$cloud")" --size 64x36 --budget 1000 -o "$work/one.png" > /dev/null 2>&1 && break
  kill -0 "$server" 2> /dev/null || { cat "$work/server.log" >&2; fail "the server ended" 6; }
  sleep 0.1
done

printf '%8s %10s %10s %10s %10s %10s\n' Mbit/s points seconds requests MB used
for megabits in "$@"; do
  # The bucket holds 5 ms of the link, at least ten packets; half a second may wait in the queue before it.
  burst=$((megabits * 625))
  [ "$burst" -ge 15000 ] || burst=15000
  inside tc qdisc replace dev lo root tbf rate "${megabits}mbit" burst "$burst" latency 500ms
  for budget in ${BUDGETS:-50000 200000 1000000}; do
    inside "$stipple" render "http://127.0.0.1:8017/clouds/$(basename "$cloud")" --size 1280x720 --budget "$budget" --timeout 600 --json -o "$work/one.png" > "$work/one.json"
    node -e '
      const { seconds, session } = JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"));
      const all = seconds.open + seconds.load, megabits = +process.argv[2];
      const cell = (value) => String(value).padStart(10);
      console.log(String(megabits).padStart(8), cell(process.argv[3]), cell(all.toFixed(2)), cell(session.requests),
        cell((session.bytesReceived / 1e6).toFixed(2)), cell((session.bytesReceived * 8e-6 / megabits / all).toFixed(2)));
    ' "$work/one.json" "$megabits" "$budget"
  done
done
