#!/bin/sh
# Builds the wheel, installs it into an environment of its own, and runs its tests and its example. Packages come from PyPI and crates.io only.
set -eu
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-$(cd ../.. && pwd)/target}
[ -x "$target/python/bin/python" ] || python3 -m venv "$target/python"
"$target/python/bin/pip" install --quiet maturin numpy
rm -rf "$target/wheels"
CARGO_TARGET_DIR="$target/python-native" "$target/python/bin/maturin" build --quiet --release --out "$target/wheels"
"$target/python/bin/pip" install --quiet --force-reinstall --no-deps "$target"/wheels/voidage-*.whl
"$target/python/bin/python" -m unittest discover --start-directory tests
"$target/python/bin/python" examples/porous_box.py
ls -l "$target"/wheels/*.whl
