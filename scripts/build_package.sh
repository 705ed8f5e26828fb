#!/usr/bin/env bash
# Packs the element <stipple-viewer> as an npm package: build/package/stipple-viewer-VERSION.tgz. After scripts/build_web.sh.
set -euo pipefail
cd "$(dirname "$0")/../www"
. ../scripts/environment.sh

rm -rf package/dist
npx vite build --logLevel warn --config vite.package.config.ts
npx tsc --project tsconfig.package.json
node ../scripts/prune_types.mjs package/dist/types package.d.ts
cp ../LICENSE package/LICENSE
mkdir -p ../build/package && rm -f ../build/package/*.tgz
npm pack --silent --pack-destination ../build/package ./package
