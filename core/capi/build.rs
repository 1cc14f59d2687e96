//! Gives the shared library its SONAME, if the environment asks for it as `install.sh` does. Not always: Cargo would pass the argument on to
//! shared libraries of other packages that use this one.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=VOIDAGE_SONAME");
    if let Ok(name) = std::env::var("VOIDAGE_SONAME") {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,{name}");
    }
}
