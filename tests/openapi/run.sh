#!/usr/bin/env bash
# run.sh PROGRAM: the server `PROGRAM serve` against its own description, over sockets.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
stamp=$folder/node_modules/.complete
lock=$(cat "$folder/package-lock.json" "$folder/package.json" | sha256sum)
if [ "$(cat "$stamp" 2>/dev/null)" != "$lock" ]; then
  npm --prefix "$folder" ci --silent
  echo "$lock" > "$stamp"
fi
STIPPLE_PROGRAM=$1 exec node --test --test-reporter=spec --test-concurrency=1 "$folder"/*.test.mjs
