#!/usr/bin/env bash
# Feeds the readers of files with bytes that nobody thought of, each for so many seconds, two at once, beginning from the
# project's own good and bad files. Says in reports/trust/fuzz.txt how many were tried. Stable Rust and a C++ compiler are
# enough: the passes that libFuzzer needs are asked of the compiler itself.
#   tests/trust/fuzz.sh SECONDS [TARGET...]
set -euo pipefail
seconds=${1:?seconds for each target}
shift
root=$(cd "$(dirname "$0")/../.." && pwd)
targets=("$@")
[ $# -gt 0 ] || targets=(stl scene grid geotiff shapefile ply las)
work=$(mktemp -d /tmp/rockfall_fuzz.XXXX)
trap 'rm -rf "$work"' EXIT

machine=$(rustc -vV | sed -n 's/^host: //p')
built=${CARGO_TARGET_DIR:-$root/fuzz/target}/$machine/release
passes="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4"
passes="$passes -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table"
passes="$passes -Cllvm-args=-sanitizer-coverage-trace-compares"
# overflow of whole numbers counts as a finding
RUSTFLAGS="$passes --cfg fuzzing -Cdebug-assertions -Coverflow-checks -Ccodegen-units=1" \
    cargo build --manifest-path "$root/fuzz/Cargo.toml" --locked --release --target "$machine"

seeds() {
    mkdir -p "$work/$1"
    case $1 in
        stl) find "$root/tests/meshes" "$root/tests/bad_meshes" "$root/terrain/paper_roof.stl" -name '*.stl' -type f -size -16k ;;
        scene) find "$root/tests/bad" "$root/examples" -name '*.toml' ;;
        grid) printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2\n3 -9999\n' > "$work/$1/grid" ;;
        *) find "$root/fuzz/seeds/$1" -type f ;;
    esac | while read -r file; do cp "$file" "$work/$1/$(basename "$(dirname "$file")")_$(basename "$file")"; done
}

feed() {
    seeds "$1"
    cd "$work"
    local status=0
    /usr/bin/time -f "cpu %U" "$built/$1" "$1" -max_total_time="$seconds" -max_len=16384 -timeout=20 \
        -rss_limit_mb=2048 -print_final_stats=1 -verbosity=1 -artifact_prefix="$work/$1_" > "$1.log" 2>&1 || status=$?
    echo "exit $status" >> "$1.log"
}

for target in "${targets[@]}"; do
    feed "$target" &
    [ "$(jobs -rp | wc -l)" -lt 2 ] || wait -n
done
wait
mkdir -p "$root/reports/trust"
record=$root/reports/trust/fuzz.txt
touch "$record"
for target in "${targets[@]}"; do
    log="$work/$target.log"
    tried=$(grep -o 'number_of_executed_units: *[0-9]*' "$log" | grep -o '[0-9]*$' || echo 0)
    cpu=$(grep -o '^cpu [0-9.]*' "$log" | cut -d' ' -f2)
    if grep -q '^exit 0' "$log"; then found=none; else found="SEE $log"; trap - EXIT; fi
    # one line a target; those that were not fed keep theirs
    sed -i "/^$target: /d" "$record"
    echo "$target: $tried executions in $cpu s of processor time, findings: $found" | tee -a "$record"
done
