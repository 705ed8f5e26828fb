#!/usr/bin/env bash
# Runs the page's tests in Debian's Firefox, on a virtual screen. Needs build/release and www/dist; not part of scripts/test.sh.
#   scripts/test_firefox.sh [node --test options…]
# What the tests can't do there for want of a driver is skipped with its reason (tests/e2e/support/browser.mjs). Left out whole
# are files that use fingers (clip_handles, tools, undoing) or saved files (everything, filming, scenes) throughout, that read the memory of
# Chromium's processes (embedding), or that count what workers ask for (size).
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
scripts/install_dependencies.sh --with-firefox

for needed in build/release/client/headless/stipple build/release/tests/e2e/native_answers www/dist/index.html; do
  [ -e "$needed" ] || { echo "scripts/test_firefox.sh: $needed is missing; build first" >&2; exit 3; }
done
scripts/install_test_packages.sh tests/e2e

files=()
for name in access accessibility annotating appearance clipping keyboard many_clouds map measuring navigating page profiling regions texts transport; do
  files+=("tests/e2e/$name.test.mjs")
done
export STIPPLE_BROWSER=firefox
exec xvfb-run --auto-servernum --server-args='-screen 0 1600x1200x24' \
  node --test --test-reporter=spec --test-concurrency=1 "$@" "${files[@]}"
