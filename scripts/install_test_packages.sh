#!/usr/bin/env bash
# Installs the npm packages of a folder of tests. Idempotent.
#   scripts/install_test_packages.sh FOLDER
# Playwright (tests/e2e) stays at a version that drives Debian's Firefox ESR: later ones (1.65) send it commands that it does not know.
set -euo pipefail
cd "$(dirname "$0")/../$1"

stamp=node_modules/.complete
lock=$(sha256sum package-lock.json package.json)
if [ "$(cat "$stamp" 2>/dev/null)" != "$lock" ]; then
  npm ci --silent --ignore-scripts
  echo "$lock" > "$stamp"
fi
