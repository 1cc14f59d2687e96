#!/bin/sh
# Builds the library and puts it where C, C++ and Fortran programs find it: `sh core/capi/install.sh /usr/local`, or any other directory.
#
#   include/voidage.h, include/voidage.f90, lib/libvoidage.a, lib/libvoidage.so (SONAME libvoidage.so.0), lib/pkgconfig/voidage.pc,
#   lib/cmake/voidage/voidageConfig.cmake
#
# Packagers may use cargo-c instead: `cargo cinstall -p voidage-capi`.
set -eu
[ $# = 1 ] || { echo "usage: sh $0 PREFIX"; exit 2; }
mkdir -p "$1"
prefix=$(cd "$1" && pwd)
cd "$(dirname "$0")"
target=${CARGO_TARGET_DIR:-$(cd ../.. && pwd)/target}
version=$(sed -n '/^\[workspace.package\]/,/^version/s/^version = "\(.*\)"/\1/p' ../../Cargo.toml)

# The number after `.so` changes when programs that were linked before no longer run.
VOIDAGE_SONAME=libvoidage.so.0 cargo build --quiet --release -p voidage-capi
# What the archive asks of the system, as the compiler tells it.
libs="-lpthread -ldl -lm -lgcc_s -lc"

mkdir -p "$prefix/include" "$prefix/lib/pkgconfig" "$prefix/lib/cmake/voidage"
cp include/voidage.h include/voidage.f90 "$prefix/include/"
cp "$target/release/libvoidage_capi.a" "$prefix/lib/libvoidage.a"
cp "$target/release/libvoidage_capi.so" "$prefix/lib/libvoidage.so.$version"
# Without what only debuggers read: a fifth of the shared library, half of the archive is left.
strip -S "$prefix/lib/libvoidage.a" "$prefix/lib/libvoidage.so.$version"
ln -sf "libvoidage.so.$version" "$prefix/lib/libvoidage.so.0"
ln -sf libvoidage.so.0 "$prefix/lib/libvoidage.so"
fill() { sed "s|@prefix@|$prefix|; s|@version@|$version|; s|@libs@|$libs|" "packaging/$1.in"; }
fill voidage.pc >"$prefix/lib/pkgconfig/voidage.pc"
fill voidageConfig.cmake >"$prefix/lib/cmake/voidage/voidageConfig.cmake"
fill voidageConfigVersion.cmake >"$prefix/lib/cmake/voidage/voidageConfigVersion.cmake"
echo "voidage $version is in $prefix"
