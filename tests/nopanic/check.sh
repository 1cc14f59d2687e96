#!/bin/sh
# Shows by symbol inspection that no query of the core can panic, allocate or call into std: builds them freestanding, in release, and looks
# for what a panic or an allocator would leave behind. Exit code 1 if anything is found.
set -eu
cd "$(dirname "$0")"
target="${CARGO_TARGET_DIR:-target}"
cargo rustc --quiet --release -- -C link-arg=-nostartfiles -C link-arg=-Wl,--gc-sections
object="$target/release/libvoidage_nopanic.so"
for query in nopanic_f64 nopanic_layers_f64 nopanic_round_f64; do
    nm -D "$object" | grep -q " T $query\$" || { echo "no $query in $object"; exit 1; }
done
if nm -C "$object" | grep -iE 'panic(ked|king|_fmt|_bounds|_const|_nounwind|_impl)|rust_begin_unwind|unwrap_failed|expect_failed|slice_.*_fail|len_mismatch|__rust_alloc|malloc'; then
    echo "a panic or an allocation is reachable from a query"
    exit 1
fi
echo "no panic and no allocation in $(stat -c %s "$object") bytes of queries; undefined symbols:"
nm -u "$object" | sed 's/^ */  /'
