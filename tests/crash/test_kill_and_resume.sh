#!/usr/bin/env bash
# The share of kill_and_resume.sh that every test run pays for: two scans, a memory so small that points go to
# disk, five kills. The whole of it: tests/crash/kill_and_resume.sh STIPPLE SCAN.las, with KILLS=20.
set -euo pipefail
stipple=${1:?usage: test_kill_and_resume.sh STIPPLE}
scans=$(mktemp -d)
trap 'rm -rf "$scans"' EXIT
"$stipple" synth "$scans/a.las" --points 900000 --scene town --seed 1 --quiet
"$stipple" synth "$scans/b.las" --points 600000 --scene terrain --seed 2 --quiet
KILLS=5 "$(dirname "$0")/kill_and_resume.sh" "$stipple" "$scans/a.las" "$scans/b.las" -- --memory 64M --threads 2
