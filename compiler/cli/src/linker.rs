//! Which linker a target has, and how a target is named.

use crate::toolchain::Rustc;
use std::ffi::OsString;
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
        None => ["cc", "gcc", "clang"].map(str::to_owned).to_vec(),
    };
    names.iter().find(|name| exists(name)).map(Command::new).ok_or_else(|| {
        let package = foreign.map_or("gcc".to_owned(), |it| format!("gcc-{}", prefix(it).trim_end_matches('-')));
        format!(
            "no linker was found: looked for {} (install a C compiler, for Debian `apt install {package}`, or set {variable})",
            names.join(", ")
        )
    })
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
    let system = if target.contains("linux") { "linux" } else { "none" };
    let abi = parts.last().copied().filter(|it| *it != "linux").unwrap_or("gnu");
    format!("{arch}-{system}-{abi}-")
}

fn exists(program: &str) -> bool {
    let Some(path) = std::env::var_os("PATH") else { return false };
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Shows that a rustc can be asked for, in messages.
pub fn describe(rustc: &Rustc) -> String {
    rustc.target.clone().unwrap_or_else(|| host().to_owned())
}
