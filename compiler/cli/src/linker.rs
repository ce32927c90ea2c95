//! Which linker a target has, and how a target is named.

use crate::toolchain::Rustc;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;

/// Why a machine without an operating system gets no executable.
pub fn no_system(target: &str) -> String {
    format!("{target} has no operating system to run an executable on; write --emit lib and link it into your firmware")
}

/// The target of this machine.
pub fn host() -> &'static str {
    env!("STAUNCH_TARGET")
}

pub fn is_host(target: &str) -> bool {
    target == host()
}

/// Whether programs for a target, or for this machine, are for Windows.
pub fn is_windows(target: Option<&str>) -> bool {
    target.unwrap_or_else(|| host()).contains("-windows-")
}

/// The C compiler as a linker. For the host `$CC` or a usual name; for another target `$CC_` and
/// its name with underscores, or a cross compiler by its usual name.
pub fn find(target: Option<&str>) -> Result<Command, String> {
    let foreign = target.filter(|it| !is_host(it));
    let variable = foreign.map_or("CC".to_owned(), |it| format!("CC_{}", it.replace('-', "_")));
    if let Some(command) = std::env::var(&variable).ok().and_then(|it| words(&it)) {
        return Ok(command);
    }
    let names: Vec<String> = match foreign {
        Some(target) => vec![format!("{}gcc", prefix(target))],
        None => HOST_NAMES.map(str::to_owned).to_vec(),
    };
    let found = names.iter().find(|name| exists(name)).map(Command::new);
    found.or_else(|| of_rust(foreign)).ok_or_else(|| {
        format!("no linker was found: looked for {} ({}, or set {variable})", names.join(", "), advice(foreign))
    })
}

/// A compiler for Windows that is not MinGW's has other libraries.
const HOST_NAMES: [&str; 3] =
    if cfg!(windows) { ["x86_64-w64-mingw32-gcc", "gcc", "cc"] } else { ["cc", "gcc", "clang"] };

/// The linker that comes with Rust for Windows, and the libraries next to it.
fn of_rust(foreign: Option<&str>) -> Option<Command> {
    if foreign.is_some() || !cfg!(windows) {
        return None;
    }
    let rustc = std::env::var_os("RUSTC").filter(|it| !it.is_empty()).unwrap_or_else(|| OsString::from("rustc"));
    let output = Command::new(rustc).args(["--print", "target-libdir", "--target", host()]).output().ok()?;
    let libraries = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim()).join("self-contained");
    let start = libraries.join("crt2.o");
    let programs = libraries.parent()?.with_file_name("bin").join("self-contained");
    let compiler = programs.join("x86_64-w64-mingw32-gcc.exe");
    let mut command = Command::new(compiler.is_file().then_some(compiler)?);
    command.args(["-fno-use-linker-plugin", "-nostartfiles"]).arg(start);
    command.arg("-B").arg(programs).arg("-L").arg(libraries);
    Some(command)
}

/// How to come by a linker.
fn advice(foreign: Option<&str>) -> String {
    if foreign.is_none() && cfg!(windows) {
        return "install MinGW-w64 and have its `bin` in PATH, or `rustup toolchain install stable-x86_64-pc-windows-gnu` \
                and have that one's rustc in RUSTC"
            .to_owned();
    }
    let package = match foreign {
        None => "gcc".to_owned(),
        Some(target) if is_windows(foreign) => {
            format!("gcc-mingw-w64-{}", target.split('-').next().unwrap_or_default().replace('_', "-"))
        }
        Some(target) => format!("gcc-{}", prefix(target).trim_end_matches('-')),
    };
    format!("install a C compiler, for Debian `apt install {package}`")
}

/// A command with arguments, as in `CC='ccache gcc'`.
fn words(text: &str) -> Option<Command> {
    let mut words = text.split_whitespace();
    let mut command = Command::new(words.next()?);
    command.args(words);
    Some(command)
}

/// The linker that rustc is to call for a target, where it needs one by name.
pub fn of_rustc(target: Option<&str>) -> Result<Option<OsString>, String> {
    let Some(target) = target.filter(|it| !is_host(it)) else { return Ok(None) };
    let name = format!("{}gcc", prefix(target));
    match exists(&name) {
        true => Ok(Some(OsString::from(name))),
        // A target of another C library or system may come with all it needs.
        false if target.contains("linux-gnu") => find(Some(target)).map(|it| Some(it.get_program().to_owned())),
        false => Ok(None),
    }
}

/// Debian's prefix of a target's tools: `aarch64-linux-gnu-`.
fn prefix(target: &str) -> String {
    let parts: Vec<_> = target.split('-').collect();
    let arch = match parts.first() {
        Some(arch) if arch.starts_with("riscv64") => "riscv64",
        Some(arch) if arch.starts_with("armv7") => "arm",
        Some(arch) => arch,
        None => "",
    };
    if is_windows(Some(target)) {
        return format!("{arch}-w64-mingw32-");
    }
    let system = if target.contains("linux") { "linux" } else { "none" };
    let abi = parts.last().copied().filter(|it| *it != "linux").unwrap_or("gnu");
    format!("{arch}-{system}-{abi}-")
}

fn exists(program: &str) -> bool {
    let Some(path) = std::env::var_os("PATH") else { return false };
    let file = format!("{program}{}", std::env::consts::EXE_SUFFIX);
    std::env::split_paths(&path).any(|folder| folder.join(&file).is_file())
}

/// Shows that a rustc can be asked for, in messages.
pub fn describe(rustc: &Rustc) -> String {
    rustc.target.clone().unwrap_or_else(|| host().to_owned())
}
