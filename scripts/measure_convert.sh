#!/usr/bin/env bash
# Measures `stipple convert` and prints a table: medians of RUNS runs (default 5) for each input at each of THREADS (default
# "1 2"). Needs the program that scripts/test.sh or scripts/demo.sh builds. Works in build/measure_convert (WORK sets another
# folder), where the clouds it makes stay for the next time.
#
#   scripts/measure_convert.sh [--data FOLDER] [--large] [INPUT...] [-- OPTION...]
#
#   INPUT          a scan, a folder of them or a pattern: as for convert
#   --data FOLDER  also FOLDER/clouds/autzen.laz, and the LAS file of its points
#   --large        also towns of 10, 20 and 100 million points (`stipple synth`; 4.7 GB of LAS), the cost of a point of the
#                  largest against the smallest, and the largest with --memory 1G. SIZES="10 20 100" are the millions.
#   OPTION         for every convert
# The runs take turns (each input and thread count once, then again), so that what else the machine does falls on all alike.
set -euo pipefail
fail() { echo "scripts/measure_convert.sh: $1" >&2; exit "${2:-2}"; }
root=$(realpath "$(dirname "$0")/..")
stipple=${STIPPLE:-$root/build/release/client/headless/stipple}
[ -x "$stipple" ] || fail "$stipple is not there; scripts/demo.sh builds it"
runs=${RUNS:-5}
threads=${THREADS:-1 2}
read -ra sizes <<<"${SIZES:-10 20 100}"
work=${WORK:-$root/build/measure_convert}

large=false data= inputs=() options=()
while [ $# -gt 0 ]; do
  case $1 in
    --data) [ $# -gt 1 ] || fail "--data needs a folder"; data=$2; shift ;;
    --large) large=true ;;
    --) shift; options=("$@"); break ;;
    -*) fail "$1 is no option" ;;
    *) inputs+=("$1") ;;
  esac
  shift
done
mkdir -p "$work"
results=$work/results.jsonl
: >"$results"

# make FILE COMMAND...: FILE by the command, unless it is there from the last time.
make() {
  local file=$1
  shift
  [ -e "$file" ] || { echo "making $(basename "$file")" >&2; "$@" >&2; }
}
if [ -n "$data" ]; then
  laz=$data/clouds/autzen.laz las=$work/autzen.las
  [ -e "$laz" ] || fail "$laz is not there"
  if [ ! -e "$las" ]; then
    "$stipple" convert "$laz" -o "$work/autzen.stipple" >&2
    make "$las" "$stipple" export "$work/autzen.stipple" -o "$las"
    rm "$work/autzen.stipple"
  fi
  inputs+=("$las" "$laz")
fi
towns=()
if $large; then
  for millions in "${sizes[@]}"; do
    town=$work/town_${millions}M.las
    make "$town" "$stipple" synth "$town" --points "${millions}000000" --scene town --seed 1
    towns+=("$town")
  done
  inputs+=("${towns[@]}")
fi
[ ${#inputs[@]} -gt 0 ] || fail "nothing to measure: name an input, --data or --large"

# measure LABEL THREADS INPUT OPTION...: one run, a line in the results.
measure() {
  local label=$1 count=$2 input=$3
  shift 3
  rm -rf "$work/out.stipple" "$work/out.stipple.work"
  "$stipple" convert "$input" -o "$work/out.stipple" --name measured --threads "$count" --json "$@" >"$work/result.json" \
    2>"$work/errors" || { cat "$work/errors" >&2; fail "$input can't be converted" 3; }
  node -e '
    const [file, label, threads] = process.argv.slice(1);
    const result = JSON.parse(require("fs").readFileSync(file, "utf8"));
    delete result.warnings;
    console.log(JSON.stringify({ label, threads: Number(threads), ...result }));' "$work/result.json" "$label" "$count" >>"$results"
}
for run in $(seq "$runs"); do
  echo "run $run of $runs" >&2
  for input in "${inputs[@]}"; do
    for count in $threads; do
      measure "$(basename "$input")" "$count" "$input" "${options[@]}"
    done
  done
  if $large; then
    measure "$(basename "${towns[-1]}") --memory 1G" "${threads##* }" "${towns[-1]}" --memory 1G "${options[@]}"
  fi
done
rm -f "$work/out.stipple" "$work/result.json" "$work/errors"

node - "$results" "$($large && basename "${towns[0]}")" "$($large && basename "${towns[-1]}")" <<'JS'
const [file, small, large] = process.argv.slice(2);
const groups = new Map();
for (const line of require("fs").readFileSync(file, "utf8").trim().split("\n")) {
  const run = JSON.parse(line);
  const key = `${run.label} ${run.threads}`;
  groups.set(key, [...(groups.get(key) ?? []), run]);
}
function sorted(group, value) { return group.map(value).sort((a, b) => a - b); }
function median(group, value) {
  const values = sorted(group, value), middle = values.length >> 1;
  return values.length % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}
const speed = (run) => run.points / run.seconds.total / 1e6;
const row = (cells) => console.log(`| ${cells.join(" | ")} |`);

const head = ["input", "points", "threads", "M points/s (range)", "CPU s", "CPU µs a point", "peak RSS MB", "temporary MB",
  "bytes a point", "scan s", "tile s", "sample s", "pack s", "total s"];
row(head);
row(head.map(() => "---"));
for (const group of groups.values()) {
  const speeds = sorted(group, speed);
  const { label, threads, points } = group[0];
  const phase = (name) => median(group, (run) => run.seconds[name]).toFixed(2);
  row([label, points, threads, `${median(group, speed).toFixed(2)} (${speeds[0].toFixed(2)}-${speeds.at(-1).toFixed(2)})`,
    median(group, (run) => run.cpuSeconds).toFixed(2), (median(group, (run) => run.cpuSeconds) / points * 1e6).toFixed(3),
    (median(group, (run) => run.peakMemoryBytes) / 1e6).toFixed(0), (median(group, (run) => run.temporaryBytes) / 1e6).toFixed(0),
    median(group, (run) => run.bytesPerPoint).toFixed(3), ...["scan", "tile", "sample", "pack", "total"].map(phase)]);
}
const hashes = new Map();
for (const [key, group] of groups)
  for (const run of group) hashes.set(run.label, (hashes.get(run.label) ?? new Set()).add(`${run.pointHash} ${run.bytes}`));
for (const [label, seen] of hashes)
  if (seen.size > 1) console.log(`${label}: the runs did not give the same cloud: ${[...seen].join(", ")}`);
if (small && small !== large)
  for (const group of groups.values()) {
    if (group[0].label !== small) continue;
    const other = groups.get(`${large} ${group[0].threads}`);
    const ratio = (value) => (median(other, (run) => value(run) / run.points) / median(group, (run) => value(run) / run.points)).toFixed(3);
    console.log(`cost of a point, ${large} against ${small}, ${group[0].threads} threads: ` +
      `${ratio((run) => run.seconds.total)} of the time, ${ratio((run) => run.cpuSeconds)} of the CPU time`);
  }
JS
