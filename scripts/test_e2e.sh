#!/usr/bin/env bash
# Runs the page in headless Chromium against the real server. Needs build/release and www/dist.
#   scripts/test_e2e.sh [node --test options…]
# STIPPLE_CHROMIUM names another browser; STIPPLE_E2E_PICTURES a folder that screenshots are put in.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh

for needed in build/release/client/headless/stipple build/release/tests/e2e/native_answers www/dist/index.html; do
  [ -e "$needed" ] || { echo "scripts/test_e2e.sh: $needed is missing; build first" >&2; exit 3; }
done
scripts/install_test_packages.sh tests/e2e
exec node --test --test-reporter=spec --test-concurrency=1 "$@" tests/e2e/*.test.mjs
