#!/usr/bin/env bash
# The tests that take minutes: those tagged [slow], tens of thousands of damaged files under the sanitizers, and every fuzz
# target for a minute each. SECONDS_PER_TARGET (default 60) sets the last.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh --with-fuzzing
. scripts/environment.sh
configure_and_build release
configure_and_build asan

failed=0
for preset in release asan; do
  while read -r program; do
    # A program without slow tests answers that no test matched; that is no failure.
    "$program" --list-tests "[slow]" | grep -q '^0 ' && continue
    echo "== $program, [slow], $preset"
    "$program" "[slow]" || failed=1
  done < <(find "build/$preset/tests" -type f -executable -name 'test_*')
done
scripts/fuzz.sh "${SECONDS_PER_TARGET:-60}" || failed=1
[ "$failed" = 0 ] || { echo "slow tests failed"; exit 1; }
