#!/usr/bin/env bash
# Computes the values that the error measures are tested with again, by independent implementations (npm packages).
# The tests themselves (test_client_measure) need none of it. Exit code 1 if a value is another one now.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/environment.sh
npm --prefix tests/oracles ci --silent
exec node tests/oracles/check_ssim.mjs
