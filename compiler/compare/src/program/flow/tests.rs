//! The plain form does what the program does, and no variable holds more than is said of it.

use super::walk;
use super::{Name, Names, Range, Ranges, Written, unread};
use crate::program::scalar::{Role, Scalars};
use staunch_frontend::{Dialect, Options, Source, Sources, compile};
use staunch_ir::interpret::Interpreter;
use staunch_ir::layout::Layout;
use staunch_ir::{Program, RoutineId, Type};
use staunch_runtime::{Context, Repr, Value};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Numbers without order, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Small ones, those at the ends of types, and any.
    fn value(&mut self, repr: Repr) -> Option<Value> {
        let number = i128::from(self.next() >> 8);
        if repr == Repr::Bool {
            return Some(Value::Bool(number % 2 == 1));
        }
        let (least, greatest) = repr.range().filter(|_| repr.is_integer())?;
        let ends = [least, greatest, least + 1, greatest - 1, -1, 0, 100];
        let number = match self.next() % 4 {
            0 => number % 12 - 3,
            1 => ends[usize::try_from(number % 7).unwrap_or(0)],
            2 => number % 300 - 150,
            _ => number % (greatest - least) + least,
        };
        repr.integer(number.clamp(least, greatest))
    }
}

fn compiled(name: &str, text: &str, dialect: Dialect) -> Option<Program> {
    let mut sources = Sources::default();
    sources.add(Source::new(name, text.to_owned()));
    compile(&sources, &Options { dialect, ..Options::default() }).program
}

fn starts(program: &Program, scalars: &Scalars, state: &[u8]) -> HashMap<Name, Range> {
    let (mut found, mut outside): (HashMap<Name, Range>, Vec<Name>) = (HashMap::new(), Vec::new());
    for scalar in &scalars.all {
        let Some((owner, field)) = scalar.field else { continue };
        let name = Name::Field(owner, field);
        let repr = program.repr(scalar.ty);
        let value = repr.and_then(|it| Value::read(it, &state[scalar.offset..]).as_integer());
        let is_located = program.structure(owner).fields[field.index()].address.is_some();
        match value.filter(|_| scalar.role != Role::Input && !is_located && !scalar.is_shared) {
            Some(value) => {
                let range = found.entry(name).or_insert((value, value));
                *range = (range.0.min(value), range.1.max(value));
            }
            None => outside.push(name),
        }
    }
    found.retain(|name, _| !outside.contains(name) && !scalars.truncated);
    found
}

/// Also where it may fault.
fn plain(names: &Names<'_>) -> Program {
    let mut plain = names.program.clone();
    for (at, routine) in plain.routines.iter_mut().enumerate() {
        let walked = walk::routine(names, RoutineId::next(at), &mut Written::default());
        *routine = unread::without_unread(routine, walked.body);
    }
    plain
}

/// So many scans of it were compared.
fn check(name: &str, program: &Program) -> usize {
    let scalars = Scalars::of(program);
    let mut own = Interpreter::new(program);
    let known = starts(program, &scalars, own.state());
    let ranges = Ranges::of(program, &known);
    let plain = plain(&ranges.names);
    let mut other = Interpreter::new(&plain);
    let faultless = ranges.plain().is_some();
    let mut numbers = Numbers(88_172_645_463_325_252);
    for scan in 0..30 {
        for input in scalars.all.iter().filter(|it| it.role == Role::Input) {
            let value = program.repr(input.ty).and_then(|it| numbers.value(it));
            let range = program.range(input.ty);
            let is_one =
                |it: &Value| range.zip(it.as_integer()).is_none_or(|(range, it)| range.0 <= it && it <= range.1);
            if let Some(value) = value.filter(|it| is_one(it) && !matches!(input.ty, Type::Enum(_))) {
                value.write(&mut own.state_mut()[input.offset..]);
                value.write(&mut other.state_mut()[input.offset..]);
            }
        }
        for instance in 0..program.instances.len() {
            let cx = Context::new(scan * 10_000_000, scan == 0);
            for it in [&mut own, &mut other] {
                it.set_budget(Some(100_000));
            }
            let ended = own.scan(instance, &cx);
            assert!(ended.is_ok() || !faultless, "{name}: scan {scan} faults: {ended:?}");
            if ended.is_err() {
                return usize::try_from(scan).unwrap_or(0);
            }
            let same = other.scan(instance, &cx);
            assert!(same.is_ok(), "{name}: scan {scan} of the plain form: {same:?}\n{plain}");
        }
        let size = scalars.all.iter().map(|it| it.offset).max().unwrap_or(0);
        assert!(own.state()[..size] == other.state()[..size], "{name}: scan {scan}\n{program}\n{plain}");
        for scalar in scalars.all.iter().filter(|it| it.role != Role::Input) {
            let Some((owner, field)) = scalar.field else { continue };
            // Another view of the bytes of a union.
            if leaf(program, program.structure(owner).fields[field.index()].ty) != scalar.ty {
                continue;
            }
            let Some(range) = ranges.names.known.get(&Name::Field(owner, field)) else { continue };
            let value =
                program.repr(scalar.ty).and_then(|it| Value::read(it, &own.state()[scalar.offset..]).as_integer());
            let is_inside = value.is_none_or(|it| range.0 <= it && it <= range.1);
            assert!(is_inside, "{name}: scan {scan}: {} is {value:?}, not in {range:?}\n{program}", scalar.path);
        }
    }
    30
}

/// What the elements of an array are, in the end.
fn leaf(program: &Program, ty: Type) -> Type {
    match ty {
        Type::Array(id) => leaf(program, program.array(id).element),
        other => other,
    }
}

fn cases(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            cases(&path, found);
        } else if path.extension().is_some_and(|it| it == "st") {
            found.push(path);
        }
    }
}

#[test]
fn the_plain_form_of_each_case_does_the_same() {
    let mut files = Vec::new();
    cases(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases"), &mut files);
    let (mut programs, mut scans) = (0, 0);
    for file in files {
        let Ok(text) = fs::read_to_string(&file) else { continue };
        let named = text.lines().find_map(|it| it.strip_prefix("// dialect: "));
        let dialect = named.and_then(|it| Dialect::ALL.iter().copied().find(|own| own.name() == it.trim()));
        let name = file.display().to_string();
        let program = compiled(&name, &text, dialect.unwrap_or_default());
        let Some(program) = program.filter(|it| !it.instances.is_empty()) else { continue };
        if Layout::try_new(&program).is_err() {
            continue;
        }
        programs += 1;
        scans += check(&name, &program);
    }
    assert!(programs > 500 && scans > 8_000, "{programs} programs, {scans} scans");
}

/// Statements of numbers under guards, in all dialects.
#[test]
fn the_plain_form_of_random_statements_does_the_same() {
    const TYPES: [&str; 6] = ["SINT", "INT", "DINT", "USINT", "UINT", "LINT"];
    let mut numbers = Numbers(7);
    let mut scans = 0;
    for program in 0..400_usize {
        let pick = |numbers: &mut Numbers, all: &[&'static str]| {
            all[usize::try_from(numbers.next() % all.len() as u64).unwrap_or(0)]
        };
        let ty = TYPES[program % TYPES.len()];
        let dialect = Dialect::ALL[program / 6 % Dialect::ALL.len()];
        let mut text = format!(
            "PROGRAM p\nVAR_INPUT a, b : {ty}; c : BOOL; END_VAR\nVAR x, y : {ty}; t : ARRAY[0..7] OF {ty}; END_VAR\n"
        );
        for _ in 0..8 {
            let names = ["a", "b", "x", "y", "3", "1", "100", "7"];
            let operation = |numbers: &mut Numbers| {
                let (left, right) = (pick(numbers, &names), pick(numbers, &names));
                match numbers.next() % 6 {
                    0 => format!("MAX({left}, {right})"),
                    1 => format!("ABS({left})"),
                    2 => format!("({left} * {right}) / {}", pick(numbers, &["2", "5", "x"])),
                    _ => format!("{left} {} {right}", pick(numbers, &["+", "-", "*", "/", "MOD"])),
                }
            };
            let comparison = |numbers: &mut Numbers| {
                let (left, sign, right) =
                    (operation(numbers), pick(numbers, &["<", "<=", ">", ">=", "=", "<>"]), pick(numbers, &names));
                format!("{left} {sign} {right}")
            };
            let (left, right) = (comparison(&mut numbers), comparison(&mut numbers));
            let value = operation(&mut numbers);
            let target = pick(&mut numbers, &["x", "y"]);
            let join = pick(&mut numbers, &["AND", "OR"]);
            text += &match numbers.next() % 5 {
                0 => format!("IF {left} {join} NOT ({right}) THEN {target} := {value}; END_IF;\n"),
                1 => format!("IF {target} >= 0 AND {target} <= 7 THEN t[{target}] := {value}; END_IF;\n"),
                2 => format!("CASE {target} OF 0: x := {value}; 1..5: y := {value}; ELSE {target} := 1; END_CASE;\n"),
                3 => format!("FOR y := 0 TO 5 DO x := {value}; IF {left} THEN EXIT; END_IF; END_FOR;\n"),
                _ => format!("{target} := {value};\n"),
            };
        }
        text += "END_PROGRAM\n";
        if let Some(compiled) = compiled("random.st", &text, dialect) {
            scans += check(&text, &compiled);
        }
    }
    assert!(scans > 500, "{scans}");
}
