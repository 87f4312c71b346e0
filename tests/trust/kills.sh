#!/usr/bin/env bash
# Kills runs at random moments, many times, plain ones and such that go on until an interval is narrow, and says in
# reports/trust/kills.txt and until.txt how it went.
#   tests/trust/kills.sh 300
set -euo pipefail
cd "$(dirname "$0")/../.."
mkdir -p reports/trust
ROCKFALL_KILLS=${1:?number of kills} cargo test --test commands kill:: -- --nocapture | tee /dev/stderr \
    | grep -E '^[0-9]+ kills in|^test result' > reports/trust/kills.txt
cargo test --test commands until:: -- --include-ignored --nocapture | tee /dev/stderr \
    | grep -E '^[0-9]+ kills in|^test result' > reports/trust/until.txt
