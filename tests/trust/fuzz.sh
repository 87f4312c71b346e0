#!/usr/bin/env bash
# Feeds the readers of files with bytes that nobody thought of, each for so many seconds, all at once, beginning from the
# project's own good and bad files. Says in reports/trust/fuzz.txt how many were tried. Needs nightly Rust and cargo-fuzz.
#   tests/trust/fuzz.sh SECONDS
set -euo pipefail
seconds=${1:?seconds for each target}
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d /tmp/rockfall_fuzz.XXXX)
trap 'rm -rf "$work"' EXIT
cd "$root/fuzz"
[ -n "${ROCKFALL_FUZZ_BUILT:-}" ] || cargo +nightly fuzz build   # set: take what was built before
programs=$(echo target/*/release)

seeds() {
    mkdir -p "$work/$1"
    case $1 in
        stl) find "$root/tests/meshes" "$root/tests/bad_meshes" "$root/terrain/paper_roof.stl" -name '*.stl' -type f -size -16k ;;
        scene) find "$root/tests/bad" "$root/examples" -name '*.toml' ;;
        grid) printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2\n3 -9999\n' > "$work/$1/grid" ;;
    esac | while read -r file; do cp "$file" "$work/$1/$(basename "$(dirname "$file")")_$(basename "$file")"; done
}

for target in stl scene grid; do
    seeds "$target"
    ( cd "$work" && /usr/bin/time -f "cpu %U" "$root/fuzz/$programs/$target" "$target" -max_total_time="$seconds" \
        -max_len=16384 -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=1 > "$target.log" 2>&1
      echo "exit $?" >> "$target.log" ) &
done
wait
mkdir -p "$root/reports/trust"
for target in stl scene grid; do
    log="$work/$target.log"
    tried=$(grep -o 'number_of_executed_units: *[0-9]*' "$log" | grep -o '[0-9]*$')
    cpu=$(grep -o '^cpu [0-9.]*' "$log" | cut -d' ' -f2)
    if grep -q '^exit 0' "$log"; then found=none; else found="SEE $log"; trap - EXIT; fi
    echo "$target: $tried executions in $cpu s of processor time, findings: $found"
done | tee "$root/reports/trust/fuzz.txt"
