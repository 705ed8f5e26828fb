#!/usr/bin/env bash
# Puts the golden cases of tests/http/golden/open to Debian's nginx on the same files, and fails where its answers
# differ from ours in a way that tests/http/nginx_differences.txt does not list. Needs nginx (Debian: nginx-light),
# which building and the other tests do not.
set -euo pipefail
cd "$(dirname "$0")/../.."
command -v nginx >/dev/null || { echo "skipped: there is no nginx (apt-get install nginx-light)"; exit 0; }
. scripts/environment.sh
configure_and_build release test_http
nginx -v
build/release/tests/http/test_http "[.nginx]"
