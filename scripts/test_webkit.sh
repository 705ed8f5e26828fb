#!/usr/bin/env bash
# Runs tests of the page in WebKitGTK, which has the engine of Safari, on a virtual screen. Needs build/release and www/dist;
# not part of scripts/test.sh.
#   scripts/test_webkit.sh [node --test options…]
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
scripts/install_dependencies.sh --with-webkit

for needed in build/release/client/headless/stipple www/dist/index.html; do
  [ -e "$needed" ] || { echo "scripts/test_webkit.sh: $needed is missing; build first" >&2; exit 3; }
done
scripts/install_test_packages.sh tests/webkit

exec xvfb-run --auto-servernum --server-args='-screen 0 1600x1200x24' \
  node --test --test-reporter=spec "$@" tests/webkit/*.test.mjs
