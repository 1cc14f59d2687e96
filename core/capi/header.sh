#!/bin/sh
# Makes include/voidage.h and src/single.rs. With --check it only compares them with what is committed, and says so if cbindgen is not there.
# cbindgen: `cargo install --locked cbindgen`.
set -eu
cd "$(dirname "$0")"
if ! command -v cbindgen >/dev/null; then
    echo "SKIPPED the header: cbindgen is not installed"
    exit 0
fi
made=$(mktemp)
trap 'rm -f "$made"' EXIT
[ "${1:-}" = --check ] || python3 single.py
# Safety sections and backquotes are for readers of Rust; /// lists and code become plain text.
cbindgen --quiet --config cbindgen.toml | python3 header.py >"$made"
if [ "${1:-}" = --check ]; then
    diff -u include/voidage.h "$made" || { echo "include/voidage.h is not what its sources say: sh core/capi/header.sh"; exit 1; }
    echo "include/voidage.h is what its sources say"
else
    cp "$made" include/voidage.h
fi
