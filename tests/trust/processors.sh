#!/usr/bin/env bash
# Runs scenes with and without the C library's variants for FMA, at once and as shards of unlike processors, and compares all
# bytes but those of the clock; then the test on an emulated processor. Says in reports/trust/processors.txt how it went.
#   ROCKFALL_QEMU=qemu-x86_64 tests/trust/processors.sh target/release/rockfall
set -euo pipefail
program=$(realpath "${1:?the program}")
cd "$(dirname "$0")/../.."
work=$(mktemp -d /tmp/rockfall_processors.XXXX)
trap 'rm -rf "$work"' EXIT
off="glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable,-FMA4_Usable"
active() { /lib64/ld-linux-x86-64.so.2 --list-diagnostics | grep '^dl_hwcaps_subdirs_active'; }
[ "$(active)" != "$(GLIBC_TUNABLES=$off active)" ] || { echo "the C library does not heed the switches" >&2; exit 1; }

fell() { "$program" run "$1" --quiet --yes --releases "$2" --out "$work/$3" "${@:4}"; }
without_fma() { GLIBC_TUNABLES=$off "$@"; }

compare() {
    local differ=0 files=0 bytes=0 file
    while read -r file; do
        cmp -s "$work/$2/$file" "$work/$3/$file" || { differ=$((differ + 1)); echo "$1: $file differs"; }
        files=$((files + 1))
        bytes=$((bytes + $(stat -c %s "$work/$2/$file")))
    done < <(cd "$work/$2" && find . -type f ! -name report.html ! -name summary.json ! -name .lock)
    echo "$1: $files files, $bytes bytes compared, $differ files differ"
    rm -rf "${work:?}/$2" "${work:?}/$3"
}

scheme() { printf '%s\n[solver]\nscheme = "%s"\n' "$(sed "s|\.\./terrain|$PWD/terrain|" "$1")" "$2" > "$work/$2.toml"; }
scheme examples/quick.toml rigid
scheme examples/tyrol.toml reference
{
    while read -r name scene releases; do
        fell "$scene" "$releases" with
        without_fma fell "$scene" "$releases" without
        compare "$name, $releases releases" with without
    done << END
examples/tyrol.toml examples/tyrol.toml 1000
the_same_with_reference $work/reference.toml 300
quick_with_rigid $work/rigid.toml 1000
examples/blocks.toml examples/blocks.toml 300
examples/road.toml examples/road.toml 1000
END
    fell examples/tyrol.toml 1000 whole
    fell examples/tyrol.toml 1000 first --shard 1/2
    without_fma fell examples/tyrol.toml 1000 second --shard 2/2
    "$program" merge "$work/first" "$work/second" --out "$work/merged" > /dev/null
    compare "one shard of two without FMA, merged" whole merged
    echo "tests/same_bits.rs, without FMA and on an emulated Nehalem, digests:"
    cargo test --locked --test same_bits -- --nocapture --test-threads 1 2> /dev/null | grep -E 'compared|not checked|^test result'
} | tee reports/trust/processors.txt
