#!/bin/sh
# How much code programs link that use one thing of the core each (src/bin): bytes of .text and .rodata, for x86-64 in f64 at opt-level 3, and for a
# Cortex-M4F in f32 at opt-level s; and at how many places the former could panic. More than the limits (processor, program, bytes, places) fails.
# Needs the sources of Rust's core for the other processor: on Debian `apt install rust-web-src rustc-web cargo-web`; without them that part is left out.
set -eu
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-$(cd ../../.. && pwd)/target}/size
failed=0
panics='(call|jmp) .*<core::(panicking::|slice::index::slice_index_fail|slice::copy_from_slice_impl|option::(unwrap|expect)_failed|result::unwrap_failed)'

# Measures the programs of a processor.
measure() {
    for source in src/bin/*.rs; do
        name=$(basename "$source" .rs)
        bytes=$(size -A "$target/$2/release/$name" | awk '/^\.(text|rodata)/ { sum += $2 } END { print sum }')
        set -- "$1" "$2" $(sed -n "s/^$1 $name //p" limits.txt)
        echo "$1 $name $bytes (at most ${3:-?})"
        [ "$bytes" -le "${3:--1}" ] || { echo "$name links more code than $1 may"; failed=1; }
        [ "$1" = x86-64 ] || continue
        places=$(objdump -dC --no-show-raw-insn "$target/$2/release/$name" | grep -cE "$panics" || true)
        echo "    places that could panic: $places (at most ${4:-?})"
        [ "$places" -le "${4:--1}" ] || { echo "$name has more places that could panic than it may"; failed=1; }
    done
}

cargo build --quiet --release --target x86_64-unknown-linux-gnu --target-dir "$target" \
    --config "target.x86_64-unknown-linux-gnu.rustflags=['-Clink-arg=-nostartfiles', '-Clink-arg=-lc', '-Clink-arg=-Wl,--gc-sections']"
measure x86-64 x86_64-unknown-linux-gnu

if [ -x /usr/bin/rustc ] && [ -d /usr/lib/rustlib/src/rust/library/core ]; then
    lld=$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld
    RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_PROFILE_RELEASE_OPT_LEVEL=s cargo build --quiet --release --target thumbv7em-none-eabihf \
        -Z build-std=core --target-dir "$target" --config "target.thumbv7em-none-eabihf.linker='$lld'" \
        --config "target.thumbv7em-none-eabihf.rustflags=['-Clink-arg=--gc-sections']"
    measure m4f thumbv7em-none-eabihf
else
    echo "SKIPPED the Cortex-M4F: Debian's rust-web-src is not installed"
fi
exit $failed
