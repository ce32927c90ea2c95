//! `--backend rust`: the emitted Rust, compiled offline with the user's rustc and the runtime's
//! source that the command carries.

use crate::args::Opt;
use crate::cache;
use crate::linker;
use crate::toolchain::{Library, Rustc, WHOLE, link_args, run};
use staunch_ir::Program;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

static SOURCES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/runtime-sources"));

/// How the runtime is compiled, and how a program: what comes out depends on both.
static RECIPES: [&[u8]; 2] = [include_bytes!("toolchain.rs"), include_bytes!("rustc.rs")];

/// What to make of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Executable,
    StaticLibrary,
    Object,
}

/// `$RUSTC` or `rustc`, after making sure that it can compile for `target`.
pub fn find(target: Option<&str>, opt: Opt) -> Result<Rustc, String> {
    let program = std::env::var_os("RUSTC").filter(|it| !it.is_empty()).unwrap_or_else(|| OsString::from("rustc"));
    let level = match opt {
        Opt::Speed => "3",
        Opt::Size => "z",
    };
    let rustc = Rustc { program, target: target.filter(|it| !linker::is_host(it)).map(str::to_owned), level };
    version(&rustc)?;
    if let Some(target) = &rustc.target {
        let output = Command::new(&rustc.program).args(["--print", "target-libdir", "--target", target]).output();
        let output = output.map_err(|it| it.to_string())?;
        if !output.status.success() {
            return Err(format!("rustc does not know the target `{target}`"));
        }
        let folder = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        if !folder.is_dir() {
            return Err(format!(
                "rustc has no standard library for {target}; install it with `rustup target add {target}`"
            ));
        }
    }
    Ok(rustc)
}

fn version(rustc: &Rustc) -> Result<Vec<u8>, String> {
    let missing = "rustc was not found: install it from https://rustup.rs; only --backend native for this machine works without it";
    let output = Command::new(&rustc.program).arg("-vV").output().map_err(|_| missing.to_owned())?;
    if output.status.success() { Ok(output.stdout) } else { Err(missing.to_owned()) }
}

/// Whether the target has a standard library: an operating system to run scans on.
fn has_std(rustc: &Rustc) -> bool {
    rustc.target.as_ref().is_none_or(|it| !it.contains("-none"))
}

/// The folder with the runtime's rlibs and its libraries for native code. The one with `main`
/// needs a `std`.
pub fn runtime(rustc: &Rustc) -> Result<PathBuf, String> {
    let version = version(rustc)?;
    let target = linker::describe(rustc);
    let key = cache::key("runtime", &[SOURCES, RECIPES[0], &version, target.as_bytes(), rustc.level.as_bytes()]);
    cache::entry(&key, |folder| {
        let sources = folder.join("sources");
        unpack(&sources)?;
        rustc.runtime(&sources, folder, has_std(rustc))?;
        rustc.static_library(Library::Runtime, folder)?;
        if has_std(rustc) {
            rustc.static_library(Library::Program, folder)?;
        }
        let _ = std::fs::remove_dir_all(&sources);
        Ok(())
    })
}

fn unpack(folder: &Path) -> Result<(), String> {
    let mut rest = SOURCES;
    while !rest.is_empty() {
        let line = rest.iter().position(|it| *it == b'\n').ok_or("the embedded sources are damaged")?;
        let header = String::from_utf8_lossy(&rest[..line]);
        let (path, length) = header.split_once('\t').ok_or("the embedded sources are damaged")?;
        let length: usize = length.parse().map_err(|_| "the embedded sources are damaged")?;
        let bytes = rest.get(line + 1..line + 1 + length).ok_or("the embedded sources are damaged")?;
        let file = folder.join(path);
        let parent = file.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(|it| format!("{}: {it}", parent.display()))?;
        std::fs::write(&file, bytes).map_err(|it| format!("{}: {it}", file.display()))?;
        rest = &rest[line + 1 + length..];
    }
    Ok(())
}

/// The program's Rust with its entry points, as one crate. One that others link has no `std`, so
/// that it needs nothing of theirs.
fn crate_text(program: &Program, kind: Kind) -> String {
    let options = staunch_rust::Options::default();
    let layout = staunch_ir::layout::Layout::new(program);
    let map = staunch_ir::symbols::map_text(program, &layout);
    let code = staunch_rust::emit(program, &options);
    let glue = staunch_rust::emit_glue(program, "crate::program", &map, &options);
    let modules = format!("pub mod program {{\n{code}\n}}\npub mod entry {{\n{glue}\n}}\n");
    match kind {
        Kind::Executable => modules + EXECUTABLE_MAIN,
        Kind::StaticLibrary | Kind::Object => LIBRARY_HEAD.to_owned() + &modules,
    }
}

const EXECUTABLE_MAIN: &str = r#"
fn main() -> std::process::ExitCode {
    let map = core::str::from_utf8(&entry::staunch_map).unwrap_or_default();
    // SAFETY: the entry points are those of the program whose map this is.
    let code = unsafe { staunch_host::Code::new(map, entry::staunch_init, entry::staunch_scan) };
    staunch_host::main(code)
}
"#;

const LIBRARY_HEAD: &str = "#![no_std]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
";

/// Compiles a program with rustc and returns the file it made, in the cache.
pub fn compile(program: &Program, kind: Kind, target: Option<&str>, opt: Opt) -> Result<PathBuf, String> {
    let rustc = find(target, opt)?;
    if kind == Kind::Executable && !has_std(&rustc) {
        return Err(linker::no_system(&linker::describe(&rustc)));
    }
    let linker = match kind {
        Kind::Executable => linker::of_rustc(rustc.target.as_deref())?,
        Kind::StaticLibrary | Kind::Object => None,
    };
    let runtime = runtime(&rustc)?;
    let text = crate_text(program, kind);
    // The runtime's folder is named after its source, the compiler, the target and how it is compiled.
    let runtime_key = runtime.as_os_str().as_encoded_bytes();
    let key = cache::key("program", &[RECIPES[1], text.as_bytes(), runtime_key, format!("{kind:?}").as_bytes()]);
    let folder = cache::entry(&key, |folder| {
        let source = folder.join("program.rs");
        std::fs::write(&source, &text).map_err(|it| format!("{}: {it}", source.display()))?;
        let mut command = rustc.command();
        command.args(["--edition", "2024", "--crate-name", "program", "-Cstrip=debuginfo"]).arg(&source);
        match kind {
            Kind::Executable => executable(&mut command, &folder.join(executable_name(&rustc)), linker.as_ref()),
            Kind::StaticLibrary | Kind::Object => library(&mut command, folder),
        }
        let crates: &[&str] =
            if kind == Kind::Executable { &["staunch-runtime", "staunch-host"] } else { &["staunch-runtime"] };
        link_args(&mut command, &runtime, crates);
        run(command, "the program")
    })?;
    Ok(match kind {
        Kind::Executable => folder.join(executable_name(&rustc)),
        Kind::StaticLibrary => folder.join(LIBRARY),
        Kind::Object => folder.join(OBJECT),
    })
}

const LIBRARY: &str = "libprogram.a";
const OBJECT: &str = "program.o";

/// Windows runs nothing without this ending.
fn executable_name(rustc: &Rustc) -> &'static str {
    if linker::is_windows(rustc.target.as_deref()) { "program.exe" } else { "program" }
}

fn executable(command: &mut Command, file: &Path, linker: Option<&OsString>) {
    command.args(["--crate-type", "bin", "-Ccodegen-units=1", "-o"]).arg(file);
    if let Some(linker) = linker {
        let mut argument = OsString::from("-Clinker=");
        argument.push(linker);
        command.arg(argument);
    }
}

/// Rustc merges the runtime into the object where it makes the library too.
fn library(command: &mut Command, folder: &Path) {
    command.args(["--crate-type", "staticlib"]).args(WHOLE);
    // What rustc makes on the way goes there too, and not to the folder that the command is called in, where a second one would
    // take it for its own.
    command.arg("--out-dir").arg(folder);
    for (what, file) in [("link", LIBRARY), ("obj", OBJECT)] {
        let mut argument = OsString::from(format!("{what}="));
        argument.push(folder.join(file));
        command.arg("--emit").arg(argument);
    }
}
