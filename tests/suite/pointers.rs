//! No Structured Text can corrupt memory: random programs of pointers do on all executors what a model says
//! that knows the rules of `docs/references.md`, and nothing of the table by which accesses are checked.
//!
//! `STAUNCH_SEEDS=first..end` chooses the programs.

use staunch_frontend::{Dialect, Options, Source, Sources};
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{FaultKind, FieldId, Program, Repr, StructId, Type};
use staunch_runtime::Context;
use staunch_tests::execute::Executor;
use staunch_tests::pointers::{self, Operation, POINTERS, TARGETS, cut};
use std::collections::BTreeMap;

const PROGRAMS: u64 = 60;

#[test]
fn random_pointers_do_what_the_model_says() {
    let range = std::env::var("STAUNCH_SEEDS").unwrap_or(format!("0..{PROGRAMS}"));
    let (first, end) = range.split_once("..").unwrap();
    let mut tally = BTreeMap::new();
    for seed in first.parse::<u64>().unwrap()..end.parse().unwrap() {
        check(seed, &mut tally);
    }
    println!("{tally:?}");
    // Each way to fail is tried, and most accesses succeed.
    for kind in [FaultKind::NullReference, FaultKind::OutsideObject, FaultKind::ForbiddenView] {
        assert!(tally.contains_key(&format!("{kind:?}")), "{tally:?}");
    }
}

fn check(seed: u64, tally: &mut BTreeMap<String, u64>) {
    let text = pointers::program(seed);
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text.clone()));
    let compilation = staunch_frontend::compile(&sources, &Options { dialect: Dialect::Codesys, ..Options::default() });
    let Some(program) = &compilation.program else { panic!("{:?}\n{text}", compilation.diagnostics) };
    let mut executors = vec![Executor::Interpreter, Executor::Native];
    if seed < pointers::PRINTED {
        executors.push(Executor::Rust);
    }
    let mut machines: Vec<_> =
        executors.iter().map(|it| it.machine(program, &pointers::module(seed)).unwrap()).collect();
    let mut model = Model::new(program, machines[0].state());
    for (at, operation) in pointers::operations(seed).into_iter().enumerate() {
        let expected = model.run(operation);
        *tally.entry(expected.err().map_or("fine".to_owned(), |it| format!("{it:?}"))).or_default() += 1;
        for (machine, executor) in machines.iter_mut().zip(&executors) {
            let found = machine.scan(0, &Context::at(0)).map_err(|it| it.kind);
            assert_eq!(found, expected, "seed {seed}, {executor:?}, operation {}: {operation:?}\n{text}", at + 1);
            if let Some(wrong) = model.difference(machine.state()) {
                panic!("seed {seed}, {executor:?}, operation {}: {operation:?}: {wrong}\n{text}", at + 1);
            }
        }
    }
}

/// What a byte of a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Number,
    Truth,
    Enumeration,
    /// Of a subrange, a reference or an instance.
    Hidden,
    /// A string's: where that begins, its capacity, and where it ends.
    Text(usize, usize, usize),
    /// Of no variable.
    Gap,
}

#[derive(Clone, Copy, Debug, Default)]
struct Pointer {
    object: Option<usize>,
    address: u32,
}

const ORIGIN: u32 = 0x1000;

struct Model {
    kinds: Vec<Kind>,
    memory: Vec<u8>,
    texts: BTreeMap<usize, Vec<u8>>,
    /// Where each variable begins, and its size.
    objects: Vec<(usize, usize)>,
    /// For each target its object and where it is.
    targets: Vec<(usize, usize)>,
    pointers: [Pointer; POINTERS.len()],
    /// Where the results of operations are.
    results: BTreeMap<&'static str, usize>,
    step: u16,
}

type Outcome<T> = Result<T, FaultKind>;

impl Model {
    fn new(program: &Program, state: &[u8]) -> Self {
        let layout = Layout::new(program);
        let main = program.class(program.instances[0].program).state;
        let start = usize_of(layout.machine.instances[0]);
        let field = |of: StructId, name: &str| {
            let fields = &program.structure(of).fields;
            let at = fields.iter().position(|it| it.name == name).unwrap_or_else(|| panic!("{name}"));
            (usize_of(layout.field(of, FieldId::next(at))), fields[at].ty)
        };
        let mut model = Self {
            kinds: vec![Kind::Gap; state.len()],
            memory: state.to_vec(),
            texts: BTreeMap::new(),
            objects: Vec::new(),
            targets: Vec::new(),
            pointers: Default::default(),
            results: BTreeMap::new(),
            step: 0,
        };
        for (path, variable) in TARGETS {
            let (offset, ty) = field(main, variable);
            let object = (start + offset, usize_of(layout.size(ty)));
            let number = model.objects.iter().position(|it| *it == object).unwrap_or_else(|| {
                model.kinds(program, &layout, ty, object.0);
                model.objects.push(object);
                model.objects.len() - 1
            });
            let way = match path.rsplit_once(['.', '[']) {
                None => 0,
                Some((before, part)) => {
                    let mut base = 0;
                    let mut whole = ty;
                    if let (Type::Array(id), true) = (ty, path.contains('.')) {
                        // The one array of structures is indexed by 1.
                        assert_eq!(before, "frames[1]");
                        (base, whole) = (usize_of(layout.stride(id)), program.array(id).element);
                    }
                    match whole {
                        Type::Struct(id) => base + field(id, part).0,
                        Type::Array(id) => {
                            usize_of(layout.stride(id)) * part.trim_end_matches(']').parse::<usize>().unwrap()
                        }
                        _ => panic!("{path}"),
                    }
                }
            };
            model.targets.push((number, object.0 + way));
        }
        for name in ["got", "truth", "done", "order", "n", "step"] {
            model.results.insert(name, start + field(main, name).0);
        }
        model
    }

    fn kinds(&mut self, program: &Program, layout: &Layout, ty: Type, at: usize) {
        let size = usize_of(layout.size(ty));
        let kind = match ty {
            Type::Array(id) => {
                for element in 0..usize::try_from(program.array(id).len()).unwrap() {
                    let stride = usize_of(layout.stride(id));
                    self.kinds(program, layout, program.array(id).element, at + element * stride);
                }
                return;
            }
            Type::Struct(id) => {
                for (field, it) in program.structure(id).fields.iter().enumerate() {
                    let offset = usize_of(layout.field(id, FieldId::next(field)));
                    self.kinds(program, layout, it.ty, at + offset);
                }
                return;
            }
            Type::Elementary(it) if it.repr() == Repr::Bool => Kind::Truth,
            Type::Elementary(_) => Kind::Number,
            Type::Enum(_) => Kind::Enumeration,
            Type::String(it) => {
                self.texts.insert(at, Vec::new());
                Kind::Text(at, it.capacity.into(), at + size)
            }
            _ => Kind::Hidden,
        };
        self.kinds[at..at + size].fill(kind);
    }

    fn run(&mut self, operation: Operation) -> Outcome<()> {
        self.step += 1;
        self.set("step", &self.step.to_le_bytes());
        match operation {
            Operation::Address { pointer, target } => {
                let (object, at) = self.targets[target];
                let address = ORIGIN + u32::try_from(at).unwrap();
                self.pointers[pointer] = Pointer { object: Some(object), address };
            }
            Operation::Move { to, from, by } => {
                let Pointer { object, address } = self.pointers[from];
                let low = u32::try_from(by & 0xFFFF_FFFF).unwrap();
                self.pointers[to] = Pointer { object, address: address.wrapping_add(low) };
            }
            Operation::Null { pointer } => self.pointers[pointer] = Pointer::default(),
            Operation::Load { pointer } if POINTERS[pointer].1 == 0 => {
                let truth = self.truth(self.pointers[pointer])?;
                self.set("truth", &[u8::from(self.memory[truth] != 0)]);
            }
            Operation::Load { pointer } => {
                let bytes = self.load(self.pointers[pointer], POINTERS[pointer].1)?;
                self.set("got", &bytes);
            }
            Operation::Store { pointer, value } if POINTERS[pointer].1 == 0 => {
                let truth = self.truth(self.pointers[pointer])?;
                self.memory[truth] = u8::from(value & 1 == 1);
            }
            Operation::Store { pointer, value } => {
                let size = POINTERS[pointer].1;
                self.store(self.pointers[pointer], size, cut(value, size))?;
            }
            Operation::Copy { to, from, count } => self.copy(self.pointers[to], self.pointers[from], count)?,
            Operation::Fill { to, value, count } => {
                self.set("n", &count.to_le_bytes());
                let done = self.fill(self.pointers[to], value, count)?;
                self.set("done", &done.to_le_bytes());
            }
            Operation::Compare { a, b, count } => {
                self.set("n", &count.to_le_bytes());
                let order = self.compare(self.pointers[a], self.pointers[b], count)?;
                self.set("order", &order.to_le_bytes());
            }
        }
        Ok(())
    }

    fn set(&mut self, name: &str, bytes: &[u8]) {
        let at = self.results[name];
        self.memory[at..at + bytes.len()].copy_from_slice(bytes);
    }

    /// Where a pointer points to, and the bytes of the object from there on.
    fn locate(&self, pointer: Pointer) -> Outcome<(usize, usize)> {
        let object = pointer.object.ok_or(FaultKind::NullReference)?;
        let (start, size) = self.objects[object];
        let at = pointer.address.checked_sub(ORIGIN).ok_or(FaultKind::OutsideObject)?;
        let at = usize::try_from(at).unwrap();
        if at < start || at >= start + size { Err(FaultKind::OutsideObject) } else { Ok((at, start + size - at)) }
    }

    fn truth(&self, pointer: Pointer) -> Outcome<usize> {
        let (at, _) = self.locate(pointer)?;
        match self.kinds[at] {
            Kind::Number | Kind::Truth => Ok(at),
            Kind::Enumeration | Kind::Hidden | Kind::Text(..) | Kind::Gap => Err(FaultKind::ForbiddenView),
        }
    }

    /// Whether a number of this size may be seen, where it does not begin in what is seen as bytes alone.
    fn is_wide(&self, at: usize, rest: usize, size: usize) -> Outcome<()> {
        if rest < size {
            return Err(FaultKind::OutsideObject);
        }
        let plain = |it: &Kind| matches!(it, Kind::Number | Kind::Gap);
        if self.kinds[at..at + size].iter().all(plain) { Ok(()) } else { Err(FaultKind::ForbiddenView) }
    }

    fn load(&self, pointer: Pointer, size: u32) -> Outcome<[u8; 8]> {
        let (at, rest) = self.locate(pointer)?;
        let mut bytes = [0; 8];
        let size = usize::try_from(size).unwrap();
        match (self.kinds[at], size) {
            (Kind::Number | Kind::Gap, _) => {
                self.is_wide(at, rest, size)?;
                for (byte, at) in bytes[..size].iter_mut().zip(at..) {
                    *byte = if self.kinds[at] == Kind::Gap { 0 } else { self.memory[at] };
                }
            }
            (Kind::Truth | Kind::Enumeration, 1) => bytes[0] = self.memory[at],
            (Kind::Text(start, capacity, end), 1) => match at - start {
                index if index <= capacity => bytes[0] = self.texts[&start].get(index).copied().unwrap_or(0),
                _ if rest > end - at => {}
                _ => return Err(FaultKind::OutsideObject),
            },
            (Kind::Truth | Kind::Enumeration | Kind::Hidden | Kind::Text(..), _) => {
                return Err(FaultKind::ForbiddenView);
            }
        }
        Ok(bytes)
    }

    fn store(&mut self, pointer: Pointer, size: u32, value: u64) -> Outcome<()> {
        let (at, rest) = self.locate(pointer)?;
        let bytes = value.to_le_bytes();
        let size = usize::try_from(size).unwrap();
        match (self.kinds[at], size) {
            (Kind::Number | Kind::Gap, _) => {
                self.is_wide(at, rest, size)?;
                for (byte, at) in bytes[..size].iter().zip(at..).filter(|(_, at)| self.kinds[*at] != Kind::Gap) {
                    self.memory[at] = *byte;
                }
            }
            (Kind::Truth, 1) => self.memory[at] = u8::from(bytes[0] != 0),
            (Kind::Enumeration, 1) => self.memory[at] = bytes[0],
            (Kind::Text(start, capacity, end), 1) => {
                let (index, text) = (at - start, self.texts.get_mut(&start).unwrap());
                match bytes[0] {
                    _ if index > capacity && rest > end - at => {}
                    _ if index > capacity => return Err(FaultKind::OutsideObject),
                    0 => text.truncate(index),
                    _ if index == capacity => return Err(FaultKind::OutsideObject),
                    byte => {
                        text.resize(text.len().max(index + 1), 0);
                        text[index] = byte;
                    }
                }
            }
            (Kind::Truth | Kind::Enumeration | Kind::Hidden | Kind::Text(..), _) => {
                return Err(FaultKind::ForbiddenView);
            }
        }
        Ok(())
    }

    fn is_null(pointer: Pointer) -> bool {
        pointer.object.is_none() && pointer.address == 0
    }

    fn copy(&mut self, to: Pointer, from: Pointer, count: u32) -> Outcome<()> {
        if Self::is_null(to) || Self::is_null(from) {
            self.set("done", &[0; 4]);
            return Ok(());
        }
        let order: Vec<u32> = if to.address > from.address { (0..count).rev().collect() } else { (0..count).collect() };
        for offset in order {
            let value = self.load(plus(from, offset), 1)?;
            self.store(plus(to, offset), 1, value[0].into())?;
        }
        self.set("done", &count.to_le_bytes());
        Ok(())
    }

    fn fill(&mut self, to: Pointer, value: u8, count: u32) -> Outcome<u32> {
        if Self::is_null(to) {
            return Ok(0);
        }
        for offset in 0..count {
            self.store(plus(to, offset), 1, value.into())?;
        }
        Ok(count)
    }

    fn compare(&self, a: Pointer, b: Pointer, count: u32) -> Outcome<i32> {
        if Self::is_null(a) || Self::is_null(b) {
            return Ok(255);
        }
        for offset in 0..count {
            let bytes = [self.load(plus(a, offset), 1)?[0], self.load(plus(b, offset), 1)?[0]];
            if bytes[0] != bytes[1] {
                return Ok(if bytes[0] < bytes[1] { -1 } else { 1 });
            }
        }
        Ok(0)
    }

    /// The first variable that is not as the model has it.
    fn difference(&self, state: &[u8]) -> Option<String> {
        for (at, kind) in self.kinds.iter().enumerate() {
            let is_seen = matches!(kind, Kind::Number | Kind::Truth | Kind::Enumeration | Kind::Hidden);
            if is_seen && state[at] != self.memory[at] {
                return Some(format!("byte {at} is {}, not {}", state[at], self.memory[at]));
            }
        }
        for (at, text) in &self.texts {
            let length = usize::from(u16::from_le_bytes([state[*at], state[at + 1]]));
            let found = state.get(at + 2..at + 2 + length);
            if found != Some(text) {
                return Some(format!("the string at {at} is {found:?}, not {text:?}"));
            }
        }
        for (name, at) in &self.results {
            let size = match *name {
                "got" => 8,
                "truth" => 1,
                "step" => 2,
                _ => 4,
            };
            if state[*at..at + size] != self.memory[*at..at + size] {
                return Some(format!(
                    "`{name}` is {:?}, not {:?}",
                    &state[*at..at + size],
                    &self.memory[*at..at + size]
                ));
            }
        }
        None
    }
}

fn plus(pointer: Pointer, offset: u32) -> Pointer {
    Pointer { address: pointer.address.wrapping_add(offset), ..pointer }
}
