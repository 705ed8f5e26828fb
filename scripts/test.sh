#!/usr/bin/env bash
# Builds everything and runs every fast test: natively, as WebAssembly under Node, under the address and
# undefined-behaviour sanitizers, and the page in a real browser. Slow ones: scripts/test_slow.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build
step() { printf '\n== %s (%s s)\n' "$1" "$SECONDS"; }

step "dependencies"
scripts/install_dependencies.sh
. scripts/environment.sh

step "format of the sources"
git ls-files '*.hpp' '*.cpp' | xargs clang-format --dry-run -Werror

step "native build"
configure_and_build release

step "native tests"
ctest --test-dir build/release --output-on-failure --no-tests=error

step "WebAssembly build and page"
scripts/build_web.sh

step "WebAssembly tests"
configure_and_build wasm
ctest --test-dir build/wasm --output-on-failure --no-tests=error

step "parsers and decoders under the sanitizers"
scripts/test_sanitized.sh

step "the page in a browser"
scripts/test_e2e.sh

step "done"
