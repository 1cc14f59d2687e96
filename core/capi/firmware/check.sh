#!/bin/sh
# Runs the jobs on the host and on a Cortex-M4F under QEMU: all hashes are equal. Prints for each job bytes of stack and thousands of instructions, and
# the size of the program. Stack beyond the limits fails, and a program without the square root of the floating-point unit.
# Needs the sources of Rust's core for the other processor: on Debian `apt install rust-web-src rustc-web cargo-web qemu-system-arm`.
set -eu
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-$(cd ../../.. && pwd)/target}/firmware
# In CI everything is installed: what is missing there is an error.
skip() {
    echo "SKIPPED the firmware: $1 is not installed"
    [ "${CI:-}" != true ]
    exit
}
for tool in qemu-system-arm /usr/bin/rustc; do
    command -v $tool >/dev/null || skip $tool
done
[ -d /usr/lib/rustlib/src/rust/library/core ] || skip "Debian's rust-web-src"
mkdir -p "$target"
# Quick to build: no optimisation changes bits.
CARGO_PROFILE_RELEASE_OPT_LEVEL=1 CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
    cargo run --quiet --release --target-dir "$target/host" >"$target/host.txt"

lld=$(rustc --print sysroot)/lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld
RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 cargo build --quiet --release --target thumbv7em-none-eabihf -Z build-std=core --target-dir "$target" \
    --config "target.thumbv7em-none-eabihf.linker='$lld'" \
    --config "target.thumbv7em-none-eabihf.rustflags=['-Clink-arg=-T$(pwd)/memory.ld', '-Clink-arg=--gc-sections']"
program="$target/thumbv7em-none-eabihf/release/voidage-firmware"
timeout 300 qemu-system-arm -machine mps2-an386 -icount shift=0 -nographic -monitor none -serial none \
    -semihosting-config enable=on,target=native -kernel "$program" >"$target/board.txt" 2>&1
echo "precision, job, hash, bytes of stack, thousands of instructions:"
cat "$target/board.txt"
cut -d' ' -f1-3 "$target/board.txt" | diff "$target/host.txt" - || { echo "the hashes of host and board differ"; exit 1; }
[ "$(wc -l <"$target/host.txt")" = 12 ] || { echo "not all jobs ran"; exit 1; }
echo "all jobs have the bits of the host"
size "$program"
if command -v llvm-objdump >/dev/null; then
    roots=$(llvm-objdump -d --mattr=+vfp4d16sp "$program" | grep -c 'vsqrt\.f32' || true)
    echo "square roots by instruction: $roots"
    [ "$roots" -gt 0 ] || { echo "the square root of the floating-point unit is not used"; exit 1; }
else
    echo "SKIPPED the look at square roots: llvm-objdump is not installed"
fi
while read -r precision job _ stack _; do
    most=$(sed -n "s/^$precision $job //p" stack.txt)
    [ "$stack" -le "$most" ] || { echo "$precision $job takes $stack bytes of stack, more than $most"; exit 1; }
done <"$target/board.txt"
