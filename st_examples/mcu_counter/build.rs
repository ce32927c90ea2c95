//! Compiles the Structured Text, and hands the linker the memory of the board.

use std::path::Path;

fn main() {
    staunch_build::compile("counter.st");
    // cortex-m-rt's link script includes the board's memory from a folder that the linker searches.
    let out = std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR");
    std::fs::copy("memory.x", Path::new(&out).join("memory.x")).expect("memory.x is next to build.rs");
    println!("cargo::rerun-if-changed=memory.x");
    println!("cargo::rustc-link-search={}", Path::new(&out).display());
}
