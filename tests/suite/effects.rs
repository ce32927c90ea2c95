//! What `staunch_ir::effects` says of routines, held against what the interpreter does: a scan writes only
//! what its routines are said to write, what it does depends only on what they are said to read, and
//! it faults only where one of them is said to.

use staunch_frontend::{Options, Source, Sources};
use staunch_host::{Domain, Map};
use staunch_ir::effects::{Effects, Rules, effects};
use staunch_ir::interpret::Interpreter;
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::symbols::map_text;
use staunch_ir::{FieldId, Program, StructId};
use staunch_runtime::Context;
use staunch_tests::case::{self, Pin};
use staunch_tests::cases;
use staunch_witness::generate;
use std::ops::Range;

const SCANS: i64 = 4;
const TURNS: u64 = 2_000;
const RANDOM_PROGRAMS: u64 = 400;

#[test]
fn cases_touch_what_their_effects_say() {
    let (cases, _) = case::discover(&cases());
    let mut tested = Tested::default();
    for case in cases.iter().filter(|it| it.pins.contains(&Pin::Scan)) {
        if let Some(program) = case.compile().1.program {
            tested.program(&program, &case.name);
        }
    }
    assert!(tested.written > 500 && tested.spared > 500 && tested.faults > 20, "{tested:?}");
}

#[test]
fn random_programs_touch_what_their_effects_say() {
    let mut tested = Tested::default();
    for seed in 0..RANDOM_PROGRAMS {
        let mut sources = Sources::default();
        sources.add(Source::new("program.st", generate::program(seed)));
        // `check` refuses a few.
        if let Some(program) = staunch_frontend::compile(&sources, &Options::default()).program {
            tested.program(&program, &format!("seed {seed}"));
        }
    }
    assert!(tested.written > 2000 && tested.spared > 200, "{tested:?}");
}

/// How much was looked at.
#[derive(Debug, Default)]
struct Tested {
    /// Variables that a scan wrote.
    written: usize,
    /// Variables that a scan is said not to write, or not to read.
    spared: usize,
    faults: usize,
}

/// A variable of the globals or of an instance.
struct Variable {
    name: String,
    bytes: Range<usize>,
    is_read: bool,
    is_written: bool,
}

impl Tested {
    fn program(&mut self, program: &Program, name: &str) {
        let known = effects(program, &Rules::PLAIN);
        let map = Map::parse(&map_text(program, &Layout::new(program))).unwrap();
        for instance in 0..program.instances.len() {
            let variables = variables(program, &known, instance);
            self.scans(program, name, instance, &variables, &Domain::of(&map));
            let class = program.class(program.instances[instance].program);
            let may_fault = [Some(class.body), class.prescan].into_iter().flatten().any(|it| known[it.index()].faults);
            self.faults(program, name, instance, may_fault);
        }
    }

    fn scans(&mut self, program: &Program, name: &str, instance: usize, variables: &[Variable], domain: &Domain) {
        let mut plain = Interpreter::new(program);
        for scan in 0..SCANS {
            let before = plain.state().to_vec();
            let mut forged = Interpreter::new(program);
            forged.state_mut().copy_from_slice(&before);
            // What is not read may be anything.
            for it in variables.iter().filter(|it| !it.is_read) {
                let other: Vec<u8> = before[it.bytes.clone()].iter().map(|byte| byte ^ 0x55).collect();
                domain.write(forged.state_mut(), it.bytes.start, &other);
            }
            let cx = || Context::new(scan * 10_000_000, scan == 0).with_turns(TURNS);
            let ends = [plain.scan(instance, &cx()), forged.scan(instance, &cx())];
            assert_eq!(ends[0], ends[1], "{name}, scan {scan}: what is not read changed how it ends");
            for it in variables {
                let (old, new) = (&before[it.bytes.clone()], &plain.state()[it.bytes.clone()]);
                assert!(old == new || it.is_written, "{name}, scan {scan}: {} is written", it.name);
                let depends = it.is_read && new != &forged.state()[it.bytes.clone()];
                assert!(!depends, "{name}, scan {scan}: {} depends on what is not read", it.name);
                self.written += usize::from(old != new);
                self.spared += usize::from(!it.is_written || !it.is_read);
            }
        }
    }

    fn faults(&mut self, program: &Program, name: &str, instance: usize, may_fault: bool) {
        let mut interpreter = Interpreter::new(program);
        for scan in 0..SCANS {
            let end = interpreter.scan(instance, &Context::new(scan * 10_000_000, scan == 0).with_turns(TURNS));
            assert!(end.is_ok() || may_fault, "{name}, scan {scan}: {end:?}, without a word of faults");
            self.faults += usize::from(end.is_err());
        }
    }
}

/// The variables that the routines of an instance can name, and what they are said to do to them.
fn variables(program: &Program, known: &[Effects], instance: usize) -> Vec<Variable> {
    let layout = Layout::new(program);
    let class = program.class(program.instances[instance].program);
    let routines: Vec<&Effects> =
        [Some(class.body), class.prescan].into_iter().flatten().map(|it| &known[it.index()]).collect();
    let all = |id: StructId, base: u64, of: &dyn Fn(&Effects, FieldId) -> [bool; 2]| {
        let fields = program.structure(id).fields.iter().enumerate();
        let variable = |(at, field): (usize, &staunch_ir::Field)| {
            let start = usize_of(base + layout.field(id, FieldId::next(at)));
            let found: Vec<[bool; 2]> = routines.iter().map(|it| of(it, FieldId::next(at))).collect();
            Variable {
                name: field.name.clone(),
                bytes: start..start + usize_of(layout.size(field.ty)),
                is_read: found.iter().any(|it| it[0]),
                is_written: found.iter().any(|it| it[1]),
            }
        };
        fields.map(variable).collect::<Vec<_>>()
    };
    let globals = |it: &Effects, id| [it.reads.has_global(id), it.writes.has_global(id)];
    let own = |it: &Effects, id| [it.reads.has_own(id), it.writes.has_own(id)];
    let mut found = all(program.globals, layout.machine.globals, &globals);
    found.extend(all(class.state, layout.machine.instances[instance], &own));
    found
}
