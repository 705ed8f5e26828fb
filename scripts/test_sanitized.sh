#!/usr/bin/env bash
# Builds with the address and undefined-behaviour sanitizers and runs the tests of everything that reads untrusted bytes.
# With --threads: the thread sanitizer, and the tests of everything that uses threads.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
if [ "${1:-}" = --threads ]; then
  preset=tsan
  label=threads
else
  preset=asan
  label=untrusted
fi
configure_and_build "$preset" "sanitize_$label"
ctest --test-dir "build/$preset" -L "$label" --output-on-failure --no-tests=error
