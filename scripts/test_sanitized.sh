#!/usr/bin/env bash
# Builds with the address and undefined-behaviour sanitizers and runs the tests of everything that reads untrusted bytes.
# With --server: the same of the server with its sockets. With --threads: the thread sanitizer, and the tests of everything that
# uses threads.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
case "${1:-}" in
  --threads) preset=tsan label=threads ;;
  --server) preset=asan label=server ;;
  "") preset=asan label=untrusted ;;
  *) echo "scripts/test_sanitized.sh: $1 is no option (--server or --threads)" >&2; exit 2 ;;
esac
configure_and_build "$preset" "sanitize_$label"
export TSAN_OPTIONS="suppressions=$PWD/tests/support/thread_sanitizer.supp${TSAN_OPTIONS:+:$TSAN_OPTIONS}"
ctest --test-dir "build/$preset" -L "$label" --output-on-failure --no-tests=error
