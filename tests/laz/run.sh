#!/usr/bin/env bash
# run.sh PROGRAM [options…]: a test program whose files laz-perf (npm) reads back.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
stamp=$folder/node_modules/.complete
lock=$(cat "$folder/package-lock.json" "$folder/package.json" | sha256sum)
if [ "$(cat "$stamp" 2>/dev/null)" != "$lock" ]; then
  npm --prefix "$folder" ci --silent
  echo "$lock" > "$stamp"
fi
exec "$@"
