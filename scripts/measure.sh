#!/usr/bin/env bash
# Measures one LAS or LAZ file through the whole product and prints the figures of docs/MEASUREMENTS.md:
# conversion, proof, export, bits and decode speed (native and WebAssembly), requests to the first picture by the server's
# log, both rasterizers and their difference. Needs what scripts/test.sh builds. Leaves its files in build/measure.
#   scripts/measure.sh SCAN.las
set -euo pipefail
scan=$(realpath "${1:?usage: scripts/measure.sh SCAN.las}")
cd "$(dirname "$0")/.."
. scripts/environment.sh
stipple=$PWD/build/release/client/headless/stipple
name=$(basename "$scan")
name=${name%.la[sz]}
work=build/measure
mkdir -p "$work"
cloud=$work/$name.stipple
json() { node -e 'let t="";process.stdin.on("data",d=>t+=d).on("end",()=>{const d=JSON.parse(t);console.log(eval(process.argv[1]))})' "$1"; }

echo "== convert (5 runs)"
for _ in 1 2 3 4 5; do
  "$stipple" convert "$scan" -o "$cloud" --json 2>/dev/null |
    json '`${(d.points/d.seconds.total/1e6).toFixed(2)} M points/s, ${d.bytesPerPoint.toFixed(2)} bytes a point, ${d.nodes} nodes, ${(d.hierarchyBytes/d.nodes).toFixed(1)} bytes a node`'
done
echo "== verify --against, export, verify the export"
"$stipple" verify "$cloud" --against "$scan" 2>/dev/null | tail -n 3
"$stipple" export "$cloud" -o "$work/$name.las" 2>/dev/null
"$stipple" verify "$cloud" --against "$work/$name.las" 2>/dev/null | tail -n 3

echo "== bits a point and decode speed, native"
build/release/tests/bench/codec_bench "$cloud"
if [ -e build/wasm/tests/bench/codec_bench.js ]; then
  echo "== the same as WebAssembly"
  node build/wasm/tests/bench/codec_bench.js "$cloud"
fi

echo "== requests to the first picture and to the whole one (server's log)"
log=$work/serve.log
"$stipple" serve "$cloud" --port 0 --json --log json >"$work/serve.json" 2>"$log" &
server=$!
trap 'kill $server 2>/dev/null || true' EXIT
until [ -s "$work/serve.json" ]; do sleep 0.1; done
address=$(json 'd.clouds[0].address' <"$work/serve.json")
for budget in 1000 2000000; do
  : >"$log"
  "$stipple" render "$address" -o "$work/$name.$budget.png" --budget "$budget" --json |
    json '`budget '"$budget"': ${d.frame.pointsDrawn} points of ${d.frame.nodesDrawn} nodes`'
  awk 'match($0, /"bytes":[0-9]+/) { n++; b += substr($0, RSTART + 8, RLENGTH - 8) } END { print "  " n " requests, " b " bytes" }' "$log"
done

echo "== both rasterizers, 1280x720, 2 M points"
for backend in software gles; do
  "$stipple" render "$cloud" -o "$work/$name.$backend.png" --backend "$backend" --json |
    json '`${d.renderer}: ${(d.frame.pointsDrawn/d.seconds.draw/1e6).toFixed(1)} M points/s`'
done
node --input-type=module -e "
  import { compare, readPng } from '$PWD/tests/e2e/support/picture.mjs';
  console.log(JSON.stringify(compare(await readPng('$work/$name.software.png'), await readPng('$work/$name.gles.png'))));"
