#!/usr/bin/env bash
# Runs every fuzz target for SECONDS (default 60), starting from its seeds in tests/fuzz/corpus. What it finds lands
# in build/fuzz/findings/TARGET and makes this script fail.
#   scripts/fuzz.sh [SECONDS] [TARGET...]
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build
seconds=${1:-60}
shift || true
scripts/install_dependencies.sh --with-fuzzing
. scripts/environment.sh
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for source in tests/fuzz/fuzz_*.cpp; do
    targets+=("$(basename "$source" .cpp)")
  done
fi
configure_and_build fuzz "${targets[@]}"

failed=0
for target in "${targets[@]}"; do
  name=${target#fuzz_}
  findings=build/fuzz/findings/$name/
  corpus=build/fuzz/corpus/$name
  mkdir -p "$findings" "$corpus"
  seeds=()
  [ -d "tests/fuzz/corpus/$name" ] && seeds=("tests/fuzz/corpus/$name")
  echo "== $target, $seconds s"
  if ! "build/fuzz/tests/fuzz/$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
    -print_final_stats=1 -artifact_prefix="$findings" "$corpus" "${seeds[@]}" >"build/fuzz/$target.log" 2>&1; then
    failed=1
    tail -n 40 "build/fuzz/$target.log"
  fi
  grep -E 'stat::(number_of_executed_units|peak_rss_mb)|^Done' "build/fuzz/$target.log" || true
done
[ "$failed" = 0 ] && echo "${#targets[@]} passed, 0 failed" || { echo "a target failed; see build/fuzz/findings"; exit 1; }
