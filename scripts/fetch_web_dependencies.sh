#!/usr/bin/env bash
# Lays out under build/deps what the WebAssembly build needs and Emscripten doesn't bring: zstd's sources
# (from the npm package zstd-napi, which carries them) and the header-only libraries. Idempotent.
set -euo pipefail
cd "$(dirname "$0")/.."
zstd_napi_version=0.0.13
deps=build/deps
stamp=$deps/.complete-$zstd_napi_version
[ -e "$stamp" ] && exit 0

rm -rf "$deps" && mkdir -p "$deps/include"
# The header-only libraries come from Debian; /usr/include itself must not be on Emscripten's path.
cp -r /usr/include/catch2 /usr/include/nlohmann "$deps/include/"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && npm pack --loglevel=error "zstd-napi@$zstd_napi_version" >/dev/null && tar xzf zstd-napi-*.tgz)
lib=$(find "$work" -type d -path '*zstd/lib' | head -n 1)
[ -n "$lib" ] || { echo "zstd's sources are not in zstd-napi $zstd_napi_version" >&2; exit 1; }
mkdir -p "$deps/zstd" && cp -r "$lib" "$deps/zstd/lib"
touch "$stamp"
