//! Gives the shared library its SONAME: the number after `.so` changes when programs that were linked before no longer run.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libvoidage.so.0");
    }
}
