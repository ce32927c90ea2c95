//! How the runtime is compiled with rustc alone, without cargo or a registry. The command's
//! build script does it once for the host; `--backend rust` and cross targets do it again.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::Command;

/// One crate of the runtime, in an order in which each comes after what it uses.
pub struct Recipe {
    /// Its folder in the source archive, which is also the package's name.
    pub package: &'static str,
    pub edition: &'static str,
    pub uses: &'static [&'static str],
    pub flags: &'static [&'static str],
}

pub const RUNTIME: [Recipe; 5] = [
    // `optimizations_enabled` is what libm's own build script sets from the second level on.
    Recipe { package: "libm", edition: "2021", uses: &[], flags: &["--cfg", "optimizations_enabled"] },
    Recipe { package: "ryu", edition: "2021", uses: &[], flags: &["--cfg", "feature=\"small\""] },
    Recipe { package: "staunch-runtime", edition: "2024", uses: &["libm", "ryu"], flags: &[] },
    Recipe { package: "staunch-runtime-abi", edition: "2024", uses: &["staunch-runtime"], flags: &[] },
    Recipe { package: "staunch-host", edition: "2024", uses: &["staunch-runtime"], flags: &[] },
];

/// The entry of an executable whose program is native code: linked from C's `main`.
const NATIVE_MAIN: &str = r#"
extern crate staunch_runtime_abi as _;
use core::ffi::{c_char, c_int};
use staunch_runtime::Context;
unsafe extern "C" {
    static staunch_map: u8;
    static staunch_map_len: usize;
    fn staunch_init(state: *mut u8);
    fn staunch_scan(state: *mut u8, cx: *const Context, instance: u32) -> u64;
}
#[unsafe(no_mangle)]
extern "C" fn main(_argc: c_int, _argv: *const *const c_char) -> c_int {
    // SAFETY: the object that this library is linked with defines the four symbols; the map is
    // that many bytes of UTF-8.
    let code = unsafe {
        let map = core::slice::from_raw_parts(&raw const staunch_map, staunch_map_len);
        staunch_host::Code::new(core::str::from_utf8_unchecked(map), staunch_init, staunch_scan)
    };
    c_int::from(staunch_host::main_with(code, std::env::args_os()))
}
"#;

/// What an object is linked with where `main` is somebody else's, or where there is none.
const RUNTIME_ALONE: &str = r#"
#![no_std]
extern crate staunch_runtime_abi as _;
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
"#;

/// What native code is linked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Library {
    /// The runtime, without `std`: it needs nothing but `memcpy` and its like.
    Runtime,
    /// The runtime, the host and C's `main`.
    Program,
}

impl Library {
    pub fn file(self) -> &'static str {
        match self {
            Self::Runtime => "libstaunch_native.a",
            Self::Program => "libstaunch_program.a",
        }
    }
}

/// Makes one object of a crate and what it uses, without what nobody calls.
pub const WHOLE: [&str; 2] = ["-Clto=fat", "-Ccodegen-units=1"];

/// A rustc to call, and what for.
#[derive(Clone, Debug)]
pub struct Rustc {
    pub program: OsString,
    /// `None` for the host.
    pub target: Option<String>,
    /// `-Copt-level`: 3, or `z` for small code.
    pub level: &'static str,
}

impl Rustc {
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.arg(format!("-Copt-level={}", self.level));
        command.args(["-Cpanic=abort", "-Cdebuginfo=0", "--cap-lints=allow"]);
        if let Some(target) = &self.target {
            command.args(["--target", target]);
        }
        // What the caller's cargo wants of its own crates is not for these.
        for variable in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "RUSTC_WRAPPER", "RUSTC_WORKSPACE_WRAPPER"] {
            command.env_remove(variable);
        }
        command
    }

    /// Compiles the runtime's crates below `sources` to rlibs in `out`.
    pub fn runtime(&self, sources: &Path, out: &Path, with_host: bool) -> Result<(), String> {
        for recipe in RUNTIME.iter().filter(|it| with_host || it.package != "staunch-host") {
            self.rlib(recipe, sources, out)?;
        }
        Ok(())
    }

    fn rlib(&self, recipe: &Recipe, sources: &Path, out: &Path) -> Result<(), String> {
        let mut command = self.command();
        command
            .args(["--crate-type", "rlib", "--edition", recipe.edition])
            .args(["--crate-name", &crate_name(recipe.package)])
            .args(recipe.flags)
            .arg(remapped(sources))
            .env("CFG_CARGO_FEATURES", "[]")
            .env("CFG_OPT_LEVEL", self.level)
            .env("CFG_TARGET_FEATURES", "[]")
            .env("CARGO_PKG_VERSION", env!("CARGO_PKG_VERSION"))
            .arg("-o")
            .arg(rlib_path(out, recipe.package))
            .arg(sources.join(recipe.package).join("src").join("lib.rs"));
        link_args(&mut command, out, recipe.uses);
        run(command, recipe.package)
    }

    /// A library for native code, in `out`, of the runtime's rlibs there.
    pub fn static_library(&self, library: Library, out: &Path) -> Result<PathBuf, String> {
        let packages = ["staunch-runtime", "staunch-runtime-abi", "staunch-host"];
        let (text, flags, packages) = match library {
            Library::Runtime => (RUNTIME_ALONE, &WHOLE[..], &packages[..2]),
            Library::Program => (NATIVE_MAIN, &[][..], &packages[..]),
        };
        let file = out.join(library.file());
        let source = file.with_extension("rs");
        std::fs::write(&source, text).map_err(|it| format!("{}: {it}", source.display()))?;
        let mut command = self.command();
        command.args(["--crate-type", "staticlib", "--edition", "2024", "-Cstrip=debuginfo", "-o"]);
        command.arg(&file).args(flags).arg(&source);
        link_args(&mut command, out, packages);
        run(command, "the runtime library")?;
        Ok(file)
    }
}

/// Messages name a source by its place in the archive, wherever that was unpacked.
fn remapped(sources: &Path) -> OsString {
    let mut argument = OsString::from("--remap-path-prefix=");
    argument.push(sources);
    argument.push("=staunch");
    argument
}

/// Names the rlibs in `out` to a rustc call.
pub fn link_args(command: &mut Command, out: &Path, packages: &[&str]) {
    command.arg("-L").arg(out);
    for package in packages {
        let mut argument = OsString::from(format!("{}=", crate_name(package)));
        argument.push(rlib_path(out, package));
        command.arg("--extern").arg(argument);
    }
}

fn crate_name(package: &str) -> String {
    package.replace('-', "_")
}

fn rlib_path(out: &Path, package: &str) -> PathBuf {
    out.join(format!("lib{}.rlib", crate_name(package)))
}

/// Runs a compiler or linker; the error is what it printed.
pub fn run(mut command: Command, what: &str) -> Result<(), String> {
    let program = command.get_program().to_os_string();
    let output = command.output().map_err(|error| format!("cannot run {}: {error}", display(&program)))?;
    if output.status.success() {
        return Ok(());
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    Err(format!("{} failed for {what}:\n{}", display(&program), errors.trim_end()))
}

fn display(program: &OsStr) -> String {
    program.to_string_lossy().into_owned()
}
