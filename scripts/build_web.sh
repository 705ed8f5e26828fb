#!/usr/bin/env bash
# Builds the WebAssembly programs and the page: www/dist is what any static host can serve. Idempotent; takes
# seconds when nothing changed.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh

scripts/fetch_web_dependencies.sh
configure_and_build wasm stipple_viewer stipple_decoder stipple_region

# node_modules is made anew when the lock file changes.
stamp=www/node_modules/.complete
lock=$(sha256sum www/package-lock.json www/package.json)
if [ "$(cat "$stamp" 2>/dev/null)" != "$lock" ]; then
  echo "installing the page's packages"
  npm --prefix www ci --silent
  echo "$lock" > "$stamp"
fi

# The page is built anew when a source of it, or a program in it, changed. Servers send the coded copies.
stamp=www/node_modules/.page
sources=$( { find www/src www/public -type f; ls www/index.html www/*.ts www/*.json scripts/compress_page.mjs \
  build/wasm/client/web/*.mjs build/wasm/client/web/*.wasm; } | LC_ALL=C sort | xargs sha256sum | sha256sum)
if [ ! -e www/dist/index.html ] || [ "$(cat "$stamp" 2>/dev/null)" != "$sources" ]; then
  echo "building the page"
  npm --prefix www run --silent build
  node scripts/compress_page.mjs www/dist
  echo "$sources" > "$stamp"
fi
