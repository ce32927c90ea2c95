//! No function of the runtime can panic, whatever its operands. A program with all symbols is
//! linked without `std` and with a panic handler that needs a symbol which does not exist: the
//! link succeeds only where no panic is reachable.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROBE: &str = r#"#![no_std]
#![no_main]

#[unsafe(no_mangle)]
extern "C" fn main(count: i32, arguments: *const usize) -> i32 {
    let mut sum = 0;
    staunch_runtime_abi::for_each_symbol(&mut |_, address| sum ^= address as usize);
    sum as i32 + one_of(&[3, 5, 7], count as usize, arguments)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn a_panic_is_reachable() -> !;
    }
    unsafe { a_panic_is_reachable() }
}

#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
"#;

const CAREFUL: &str = "
fn one_of(list: &[i32], at: usize, _: *const usize) -> i32 {
    list.get(at).copied().unwrap_or(0)
}
";

const CARELESS: &str = "
fn one_of(list: &[i32], at: usize, _: *const usize) -> i32 {
    list[at]
}
";

#[test]
fn no_symbol_reaches_a_panic() {
    let runtime = runtime();
    let linked = link(&runtime, "careful", CAREFUL);
    assert!(linked.status.success(), "{}", String::from_utf8_lossy(&linked.stderr));
    // A probe that cannot fail would prove nothing.
    let refused = link(&runtime, "careless", CARELESS);
    let text = String::from_utf8_lossy(&refused.stderr);
    assert!(!refused.status.success() && text.contains("a_panic_is_reachable"), "{text}");
}

/// The folder of the runtime's libraries, optimised: unoptimised code holds checks of `core`'s own.
fn runtime() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("runtime");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--release", "-p", "staunch-runtime-abi", "--target-dir"]).arg(&target);
    // Machine code to link, where the release profile keeps bitcode for the whole program.
    cargo.env("CARGO_PROFILE_RELEASE_LTO", "off").env("CARGO_PROFILE_RELEASE_PANIC", "abort");
    let built = cargo.current_dir(env!("CARGO_MANIFEST_DIR")).output().expect("cargo starts");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    target.join("release")
}

fn link(runtime: &Path, name: &str, function: &str) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let source = folder.join(format!("{name}.rs"));
    std::fs::write(&source, format!("{PROBE}{function}")).expect("the probe is written");
    let mut rustc = Command::new("rustc");
    rustc.args(["--edition", "2024", "-O", "-C", "panic=abort", "-C", "link-args=-Wl,--gc-sections -lc", "--extern"]);
    rustc.arg(format!("staunch_runtime_abi={}", runtime.join("libstaunch_runtime_abi.rlib").display()));
    rustc.arg("-L").arg(format!("dependency={}", runtime.join("deps").display()));
    rustc.arg(&source).arg("-o").arg(folder.join(name));
    rustc.output().expect("rustc starts")
}
