#!/usr/bin/env bash
# Builds everything, then shows point scans in the browser: those named, or a sample made here.
#   scripts/demo.sh [SCAN...]        scans of any kind that convert reads, or .stipple files
# Options through the environment: STIPPLE_PORT (default 8017), STIPPLE_SAMPLE_POINTS (default 2000000).
set -euo pipefail
scans=()
for scan in "$@"; do
  [ -e "$scan" ] || { echo "scripts/demo.sh: $scan does not exist" >&2; exit 3; }
  scans+=("$(realpath "$scan")")
done
cd "$(dirname "$0")/.."
mkdir -p build

scripts/install_dependencies.sh
. scripts/environment.sh
echo "building the program"
configure_and_build release stipple
echo "building the page"
scripts/build_web.sh
stipple=build/release/client/headless/stipple

if [ ${#scans[@]} -eq 0 ]; then
  points=${STIPPLE_SAMPLE_POINTS:-2000000}
  sample=build/demo/town-$points.stipple
  if [ ! -e "$sample" ]; then
    mkdir -p build/demo
    scan=build/demo/town-$points.las
    "$stipple" synth "$scan" --points "$points" --scene town --seed 1
    "$stipple" convert "$scan" -o "$sample" --name "Sample town"
    rm -f "$scan"
  fi
  scans=("$sample")
fi
exec "$stipple" view --port "${STIPPLE_PORT:-8017}" "${scans[@]}"
