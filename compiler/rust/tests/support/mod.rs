//! Compiles Structured Text, prints it as Rust, and runs that together with the interpreter.
#![allow(dead_code, reason = "not every test uses every part")]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use staunch_frontend::{Format, Source, Sources, Style, render};
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{FieldId, Program, StructId, Type};
use staunch_runtime::Context;
use staunch_rust::{Options, State, emit, emit_glue};

const SCANS: i64 = 4;

pub fn program(st: &str) -> Program {
    let mut sources = Sources::default();
    sources.add(Source::new("case.st", st.to_owned()));
    let compilation = staunch_frontend::compile(&sources, &staunch_frontend::Options::default());
    let messages: String =
        compilation.diagnostics.iter().map(|it| render(it, &sources, Format::Human, Style::default())).collect();
    compilation.program.unwrap_or_else(|| panic!("{messages}"))
}

/// Prints the program, lints it, runs it, and compares each scan with the interpreter's.
/// Returns the printed text.
pub fn agree(name: &str, st: &str) -> String {
    let program = program(st);
    let text = emit(&program, &Options::default());
    let folder = folder(name);
    write_crate(&folder, &program, &text);
    lint(&folder);
    link_without_panics(&folder, MAIN_PROBE);
    assert_eq!(run_rust(&folder), run_interpreter(&program), "{text}");
    text
}

/// What a `main` prints that has the program as `code`.
pub fn output_of(name: &str, st: &str, main: &str) -> String {
    output_with(name, st, main, State::Mapped)
}

/// [`output_of`] with one of the forms of the state.
pub fn output_with(name: &str, st: &str, main: &str, state: State) -> String {
    output_as(name, st, main, &Options { state, ..Options::default() })
}

/// [`output_of`], emitted by `options`.
pub fn output_as(name: &str, st: &str, main: &str, options: &Options) -> String {
    let program = program(st);
    let folder = folder(name);
    write_crate(&folder, &program, &emit(&program, options));
    lint(&folder);
    std::fs::write(folder.join("main.rs"), format!("mod code;\n{main}")).expect("the main's file");
    run_rust(&folder)
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a folder for the case");
    folder
}

fn write_crate(folder: &Path, program: &Program, text: &str) {
    let layout = Layout::new(program);
    let map = staunch_ir::symbols::map_text(program, &layout);
    let glue = emit_glue(program, "crate::code", &map, &Options::default());
    let main = format!(
        "mod code;\nmod glue;\nconst MASK: &[u8] = &{:?};\nconst SCANS: i64 = {SCANS};\n{SHOW}{MAIN}",
        mask(program, &layout)
    );
    for (file, text) in [
        ("code.rs", text),
        ("glue.rs", &glue),
        ("main.rs", &main),
        ("lib.rs", "#![no_std]\n#![warn(missing_docs)]\n//! The case.\n/// Its code.\npub mod code;\n"),
    ] {
        std::fs::write(folder.join(file), text).expect("the case's files");
    }
}

const MAIN: &str = r#"
use staunch_runtime::Context;

fn main() {
    let mut state = core::mem::MaybeUninit::<glue::Machine>::uninit();
    let at = state.as_mut_ptr().cast::<u8>();
    unsafe { glue::staunch_init(at) };
    print(at, 0);
    for scan in 0..SCANS {
        let cx = Context::new(scan * 10_000_000, scan == 0);
        let fault = unsafe { glue::staunch_scan(at, &cx, 0) };
        print(at, fault);
    }
}

fn print(at: *const u8, fault: u64) {
    let mut left = 0;
    let mut last = [0; 2];
    let bytes = MASK.iter().enumerate().map(|(offset, mask)| {
        let byte = if *mask == 0 { 0 } else { unsafe { at.add(offset).read() } };
        show(byte, *mask, &mut last, &mut left)
    });
    println!("{fault:x} {:?}", bytes.collect::<Vec<_>>());
}
"#;

/// A byte as it is compared; both sides use it.
const SHOW: &str = include_str!("show.rs");
include!("show.rs");

/// 1 for each byte of the state that belongs to a variable, 2 for the characters of a string, 0 for
/// padding.
fn mask(program: &Program, layout: &Layout) -> Vec<u8> {
    let mut mask = vec![0; usize_of(layout.machine.size)];
    mark(program, layout, Type::Struct(program.globals), layout.machine.globals, &mut mask);
    for (instance, offset) in program.instances.iter().zip(&layout.machine.instances) {
        let state = program.class(instance.program).state;
        mark(program, layout, Type::Struct(state), *offset, &mut mask);
    }
    mask
}

fn mark(program: &Program, layout: &Layout, ty: Type, offset: u64, mask: &mut [u8]) {
    match ty {
        Type::Struct(id) => mark_fields(program, layout, id, offset, mask),
        Type::Array(id) => {
            let array = program.array(id);
            for at in 0..array.len() {
                mark(program, layout, array.element, offset + at * layout.stride(id), mask);
            }
        }
        Type::Block(id) => {
            for at in 0..id.info().pins.len() {
                let pin = FieldId::next(at);
                let ty = id.pin_type(pin).expect("the pin exists");
                mark(program, layout, ty, offset + layout.offset(Type::Block(id), pin), mask);
            }
        }
        Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
            mask[usize_of(offset)..][..usize_of(layout.size(ty))].fill(1)
        }
        // Bytes after a string's end mean nothing.
        Type::String(it) => {
            let at = usize_of(offset);
            mask[at..][..2].fill(1);
            mask[at + 2..][..usize::from(it.capacity) * usize_of(it.unit_size().into())].fill(2);
        }
    }
}

fn mark_fields(program: &Program, layout: &Layout, id: StructId, offset: u64, mask: &mut [u8]) {
    for (at, field) in program.structure(id).fields.iter().enumerate() {
        mark(program, layout, field.ty, offset + layout.field(id, FieldId::next(at)), mask);
    }
}

fn run_interpreter(program: &Program) -> String {
    let mask = mask(program, &Layout::new(program));
    let mut interpreter = Interpreter::new(program);
    let mut lines = String::new();
    let mut print = |fault: u64, state: &[u8]| {
        let (mut last, mut left) = ([0; 2], 0);
        let bytes = state.iter().zip(&mask).map(|(byte, mask)| show(*byte, *mask, &mut last, &mut left));
        let bytes: Vec<u8> = bytes.collect();
        lines.push_str(&format!("{fault:x} {bytes:?}\n"));
    };
    print(0, interpreter.state());
    for scan in 0..SCANS {
        let cx = Context::new(scan * 10_000_000, scan == 0);
        let fault = match interpreter.scan(0, &cx) {
            Ok(()) => 0,
            Err(Stop::Fault(fault)) => fault.code(),
            Err(other) => panic!("{other:?}"),
        };
        print(fault, interpreter.state());
    }
    lines
}

fn run_rust(folder: &Path) -> String {
    succeed(rustc("rustc", folder, "main.rs").args(["-O", "--crate-name", "case", "-o"]).arg(folder.join("case")));
    succeed(&mut Command::new(folder.join("case")))
}

fn lint(folder: &Path) {
    let mut command = rustc("clippy-driver", folder, "lib.rs");
    succeed(command.args(["--crate-type", "lib", "--emit", "metadata", "-D", "warnings", "--out-dir"]).arg(folder));
}

fn rustc(program: &str, folder: &Path, file: &str) -> Command {
    let runtime = runtime();
    let mut command = Command::new(program);
    command.current_dir(folder).args(["--edition", "2024", file]);
    command.arg("--extern").arg(format!("staunch_runtime={}", runtime.join("libstaunch_runtime.rlib").display()));
    command.arg("-L").arg(format!("dependency={}", runtime.join("deps").display()));
    command
}

/// Links the program without `std` and with a panic handler that does not exist: that succeeds
/// only where no panic is reachable.
pub fn cannot_panic(name: &str, st: &str) {
    let program = program(st);
    let folder = folder(name);
    write_crate(&folder, &program, &emit(&program, &Options::default()));
    link_without_panics(&folder, MAIN_PROBE);
}

/// Links a `main` that has the program as `code`.
pub fn cannot_panic_in(name: &str, st: &str, main: &str) {
    let program = program(st);
    let folder = folder(name);
    write_crate(&folder, &program, &emit(&program, &Options::default()));
    lint(&folder);
    link_without_panics(&folder, main);
}

fn link_without_panics(folder: &Path, main: &str) {
    std::fs::write(folder.join("probe.rs"), format!("{PROBE}{main}")).expect("the probe's file");
    let mut command = rustc("rustc", folder, "probe.rs");
    command.args(["-O", "-C", "panic=abort", "-C", "link-args=-Wl,--gc-sections -lc", "--crate-name", "probe", "-o"]);
    succeed(command.arg(folder.join("probe")));
}

const PROBE: &str = r#"#![no_std]
#![no_main]
mod code;
mod glue;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        fn a_panic_is_reachable() -> !;
    }
    unsafe { a_panic_is_reachable() }
}

#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
"#;

const MAIN_PROBE: &str = r#"
static mut MACHINE: core::mem::MaybeUninit<glue::Machine> = core::mem::MaybeUninit::zeroed();

#[unsafe(no_mangle)]
extern "C" fn main(count: i32, time: i64) -> i32 {
    let at = (&raw mut MACHINE).cast::<u8>();
    let cx = staunch_runtime::Context::new(time, count == 1);
    unsafe {
        glue::staunch_init(at);
        i32::from(glue::staunch_scan(at, &cx, count.unsigned_abs() / 2) != 0)
    }
}
"#;

/// The folder of the runtime's library, built once.
fn runtime() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("runtime");
        let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.toml");
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--release", "-p", "staunch-runtime", "--manifest-path", manifest, "--target-dir"]);
        succeed(cargo.arg(&target));
        target.join("release")
    })
}

fn succeed(command: &mut Command) -> String {
    let output = command.output().expect("the command starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{errors}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}
