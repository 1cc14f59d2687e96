#!/bin/sh
# The library as C, C++, Fortran and Rust programs link it: archive, pkg-config, CMake, with and without std; all print one hash of their results.
# A tool that is not there is named and its part left out. CC, CXX and FC may name compilers.
set -eu
cd "$(dirname "$0")"
here=$(pwd)
target=${CARGO_TARGET_DIR:-$(cd ../.. && pwd)/target}
out="$target/link"
rm -rf "$out"
mkdir -p "$out"
CC=${CC:-gcc} CXX=${CXX:-g++} FC=${FC:-gfortran}
warnings="-Wall -Wextra -pedantic -Werror"
hashes="$out/hashes"
: >"$hashes"

has() { command -v "$1" >/dev/null || { echo "SKIPPED $2: $1 is not installed"; return 1; }; }
# Runs a program and keeps its hash; the first argument names the way it was made.
run() {
    way=$1
    shift
    "$@" >"$out/output" || { echo "$way failed"; exit 1; }
    hash=$(sed -n 's/^hash //p' "$out/output")
    [ -n "$hash" ] || { echo "$way printed no hash"; exit 1; }
    echo "$hash  $way" | tee -a "$hashes"
}

sh header.sh --check
python3 packaging/fortran.py --check
sh install.sh "$out/prefix"
prefix="$out/prefix"
libs=$(sed -n 's/^Libs.private: //p' "$prefix/lib/pkgconfig/voidage.pc")
archive="$prefix/lib/libvoidage.a $libs"
readelf -d "$prefix/lib/libvoidage.so" | grep -q 'SONAME.*libvoidage.so.0' || { echo "the shared library has no SONAME"; exit 1; }

c="$CC -std=c99 $warnings -O2"
cpp="$CXX -std=c++17 $warnings -O2"
fortran="$FC -std=f2008 $warnings -O2 -J$out"

# The archive.
$c -I"$prefix/include" examples/porous_box.c $archive -o "$out/c"
run "C, archive" "$out/c"
$cpp -I"$prefix/include" examples/porous_box.cpp $archive -o "$out/cpp"
run "C++, archive" "$out/cpp"
for language in c cpp; do
    compiler=$([ $language = c ] && echo "$c" || echo "$cpp")
    $compiler -g -fsanitize=address,undefined -fno-sanitize-recover -I"$prefix/include" examples/porous_box.$language $archive -o "$out/sanitized"
    run "$language, archive, address and undefined-behaviour sanitizers" "$out/sanitized"
done
if has "$FC" Fortran; then
    $fortran -c "$prefix/include/voidage.f90" -o "$out/voidage.o"
    $fortran examples/porous_box.f90 "$out/voidage.o" $archive -o "$out/f"
    run "Fortran, archive" "$out/f"
fi

# The shared library by pkg-config.
if has pkg-config "pkg-config"; then
    flags=$(PKG_CONFIG_PATH="$prefix/lib/pkgconfig" pkg-config --cflags --libs voidage)
    for language in c cpp; do
        compiler=$([ $language = c ] && echo "$c" || echo "$cpp")
        $compiler examples/porous_box.$language $flags -o "$out/shared"
        run "$language, pkg-config" env LD_LIBRARY_PATH="$prefix/lib" "$out/shared"
    done
    if has "$FC" "Fortran by pkg-config"; then
        $fortran examples/porous_box.f90 "$out/voidage.o" $flags -o "$out/shared"
        run "Fortran, pkg-config" env LD_LIBRARY_PATH="$prefix/lib" "$out/shared"
    fi
fi

# CMake.
if has cmake CMake; then
    cmake -S examples -B "$out/cmake" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release >"$out/cmake.log"
    cmake --build "$out/cmake" >>"$out/cmake.log" || { cat "$out/cmake.log"; exit 1; }
    for program in "$out"/cmake/porous_box_?*; do
        [ ! -x "$program" ] || [ -d "$program" ] || run "CMake, $(basename "$program")" "$program"
    done
fi

# Without std: linked without a flag, and asking for nothing but what every C library has.
CARGO_PROFILE_RELEASE_PANIC=abort cargo rustc --quiet --release -p voidage-capi --no-default-features --crate-type staticlib \
    --manifest-path "$here/Cargo.toml" --target-dir "$target/without-std"
free="$target/without-std/release/libvoidage_capi.a"
$c -I"$prefix/include" examples/porous_box.c "$free" -o "$out/free"
run "C, archive without std" "$out/free"
$CC -c -O2 -I"$prefix/include" packaging/start.c -o "$out/start.o"
$CC -nostdlib -static "$out/start.o" "$free" -o "$out/nothing" 2>"$out/undefined" || true
asked=$(sed -n "s/.*undefined reference to .\([A-Za-z0-9_]*\).*/\1/p" "$out/undefined" | sort -u | tr '\n' ' ')
echo "the archive without std asks for: $asked"
for symbol in $asked; do
    case $symbol in
    memcpy | memmove | memset | memcmp | bcmp) ;;
    *) echo "$symbol is more than memory functions"; exit 1 ;;
    esac
done

# The core alone, from Rust.
cargo run --quiet --release --manifest-path examples/core_alone/Cargo.toml --target-dir "$target/core-alone" >"$out/rust"
run "Rust, voidage-core alone" cat "$out/rust"

[ "$(cut -c1-16 "$hashes" | sort -u | wc -l)" = 1 ] || { echo "the hashes differ"; exit 1; }
echo "one hash in $(wc -l <"$hashes") ways"
