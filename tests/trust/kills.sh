#!/usr/bin/env bash
# Kills runs at random moments, many times, and says in reports/trust/kills.txt how it went.
#   tests/trust/kills.sh 500
set -euo pipefail
cd "$(dirname "$0")/../.."
mkdir -p reports/trust
ROCKFALL_KILLS=${1:?number of kills} cargo test --test commands kill:: -- --nocapture | tee /dev/stderr \
    | grep -E '^[0-9]+ kills in|^test result' > reports/trust/kills.txt
