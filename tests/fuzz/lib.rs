//! What a text is held to: the compiler does not panic, what it accepts every back end takes, and the interpreter and native code agree.

use staunch_frontend::{Dialect, Options, Source, Sources, Style, compile, render};
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;
use staunch_ir::{Program, verify};
use staunch_native::{Jit, Target, object};
use staunch_runtime::Context;

/// Steps of a scan on the interpreter: a program may loop.
const STEPS: u64 = 20_000;
const SCANS: i64 = 3;
/// States that are worth the time.
const MOST_BYTES: u64 = 1 << 16;

/// The dialect is picked by a byte.
pub fn dialect(byte: u8) -> Dialect {
    Dialect::ALL[usize::from(byte) % Dialect::ALL.len()]
}

/// Compiles a file, and does with it all that may be done.
pub fn held(name: &str, bytes: &[u8], dialect: Dialect) {
    let mut sources = Sources::default();
    sources.add(Source::decode(name, bytes));
    let options = Options { dialect, is_run: true, ..Options::default() };
    let compilation = compile(&sources, &options);
    for it in &compilation.diagnostics {
        render(it, &sources, staunch_frontend::Format::Human, Style::default());
    }
    assert_eq!(compilation.has_errors(), compilation.program.is_none());
    if let Some(program) = &compilation.program {
        assert!(verify::verify(program).is_ok(), "the program does not verify");
        runs_alike(program);
    }
}

fn runs_alike(program: &Program) {
    let layout = Layout::new(program);
    if layout.machine.size > MOST_BYTES {
        return;
    }
    staunch_rust::emit(program, &staunch_rust::Options::default());
    object(program, &Target::host().expect("a machine with native code")).expect("verified IR");
    let jit = Jit::new(program).expect("verified IR");
    // Declarations alone have no state, and nothing that runs.
    if program.instances.is_empty() {
        return;
    }
    let map = staunch_host::Map::parse(&map_text(program, &layout)).expect("the compiler's own map");
    // SAFETY: the code was made of this program, and lives longer than the machine.
    let mut native = unsafe { staunch_host::Compiled::new(&map, jit.init, jit.scan) };
    let mut interpreter = Interpreter::new(program);
    for scan in 0..SCANS {
        for instance in 0..program.instances.len() {
            let cx = || Context::new(scan * 10_000_000, scan == 0).with_turns(1000);
            interpreter.set_budget(Some(STEPS));
            let expected = match interpreter.scan(instance, &cx()) {
                Ok(()) => Ok(()),
                Err(Stop::Fault(fault)) => Err(fault),
                Err(Stop::OutOfSteps) => return,
            };
            let ended = staunch_host::Machine::scan(&mut native, instance, &cx());
            assert_eq!(ended, expected, "scan {scan} of instance {instance}");
            if ended.is_err() {
                return;
            }
        }
    }
    same(&map, interpreter.state(), staunch_host::Machine::state(&native));
}

/// Every variable that has a name has the same value.
fn same(map: &staunch_host::Map, a: &[u8], b: &[u8]) {
    for instance in &map.instances {
        for variable in &instance.variables {
            let path = format!("{}.{}", instance.name, variable.name);
            let value = |state| staunch_host::value_at(map, &[], state, &path);
            assert_eq!(value(a), value(b), "{path}");
        }
    }
}
