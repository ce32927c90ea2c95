//! Programs made by hand, and how to run them on the interpreter and as native code.
#![allow(dead_code, reason = "each test uses a part")]

use staunch_host::{Compiled, Machine, Map};
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::*;
use staunch_native::Jit;
use staunch_runtime::{Context, Fault};

pub const AT: Location = Location { file: 0, column: 3, line: 7 };

pub fn line(line: u32) -> Location {
    Location { line, ..AT }
}

/// The IEC type that counts in a repr.
pub fn elementary(repr: Repr) -> Type {
    Type::Elementary(Elementary::number(repr))
}

pub fn field(name: &str, ty: Type, initial: Const) -> Field {
    Field {
        name: name.to_owned(),
        ty,
        initial,
        section: Section::Internal,
        retain: Retain::Inherited,
        constant: false,
        address: None,
        doc: None,
        location: AT,
        declared: None,
    }
}

pub fn zero(name: &str, ty: Type) -> Field {
    field(name, ty, Const::Zero)
}

pub fn structure(name: &str, fields: Vec<Field>) -> Struct {
    Struct::new(name.to_owned(), None, AT, fields)
}

pub fn local(name: &str, ty: Type, initial: Const) -> Local {
    Local { name: name.to_owned(), ty, initial, doc: None }
}

pub fn param(name: &str, ty: Type, mode: Mode) -> Param {
    Param { name: name.to_owned(), ty, doc: None, mode, bounds: Vec::new() }
}

pub fn routine(kind: RoutineKind, name: &str, state: Option<StructId>) -> Routine {
    Routine {
        kind,
        name: name.to_owned(),
        doc: None,
        location: AT,
        state,
        params: Vec::new(),
        locals: Vec::new(),
        result: None,
        body: Vec::new(),
    }
}

pub fn instance(program: ClassId) -> Instance {
    Instance { name: format!("i{}", program.0), program, task: None, interval: None, priority: 0 }
}

/// The class of a body.
pub fn class(kind: ClassKind, routines: &[Routine], body: RoutineId, prescan: Option<RoutineId>) -> Class {
    let routine = &routines[body.index()];
    let (name, state) = (routine.name.clone(), routine.state.unwrap());
    Class { kind, name, doc: None, location: AT, state, variables: Vec::new(), body, prescan, start: None }
}

/// A program of PROGRAMs that have one instance each, in order.
pub fn program(arrays: Vec<Array>, mut structs: Vec<Struct>, routines: Vec<Routine>) -> Program {
    structs.push(structure("globals", Vec::new()));
    let bodies = (0..routines.len()).filter(|at| routines[*at].kind == RoutineKind::Body).map(RoutineId::next);
    let classes: Vec<_> = bodies.map(|it| class(ClassKind::Program, &routines, it, None)).collect();
    Program {
        files: vec![SourceFile { path: "main.st".to_owned(), system: staunch_runtime::Family::Iec }],
        enums: Vec::new(),
        bounds: Vec::new(),
        milliseconds: None,
        remotes: Vec::new(),
        arrays,
        interfaces: Vec::new(),
        implementers: Vec::new(),
        references: Vec::new(),
        globals: StructId::next(structs.len() - 1),
        aliases: Vec::new(),
        global_paths: Vec::new(),
        bound: Vec::new(),
        reentered: std::collections::BTreeSet::new(),
        reach: Reach::default(),
        reached: None,
        places: std::collections::BTreeSet::new(),
        uses: Default::default(),
        is_configured: false,
        instances: (0..classes.len()).map(|at| instance(ClassId::next(at))).collect(),
        classes,
        structs,
        routines,
    }
}

/// Of the instance's state.
pub fn member(structure: StructId, at: usize, ty: Type) -> Place {
    Place::root(Root::Instance, Type::Struct(structure)).field(FieldId::next(at), ty)
}

pub fn load(place: Place) -> Expr {
    Expr::load(place, AT)
}

pub fn constant(value: Value) -> Expr {
    Expr::constant(Elementary::number(value.repr()), value, AT)
}

pub fn int(value: i16) -> Expr {
    constant(Value::I16(value))
}

pub fn lint(value: i64) -> Expr {
    constant(Value::I64(value))
}

pub fn operation(op: Op, ty: Type, operands: Vec<Expr>) -> Expr {
    Expr::apply(op, ty, operands, AT)
}

pub fn stmt(kind: StatementKind) -> Statement {
    Statement::new(kind, AT)
}

pub fn assign(target: Place, value: Expr) -> Statement {
    Statement::assign(target, value, AT)
}

/// A program as native code, with its state.
pub struct Native {
    /// Before the code that it calls: it goes first.
    machine: Compiled,
    _jit: Jit,
    pub layout: Layout,
}

impl Native {
    pub fn new(program: &Program) -> Self {
        if let Err(violations) = verify::verify(program) {
            panic!("{violations:#?}");
        }
        let (jit, layout) = (Jit::new(program).unwrap(), Layout::new(program));
        let map = Map::parse(&symbols::map_text(program, &layout)).unwrap();
        // SAFETY: the code was made of the program that the map describes, and is kept with it.
        let machine = unsafe { Compiled::new(&map, jit.init, jit.scan) };
        Self { machine, _jit: jit, layout }
    }

    pub fn init(&mut self) {
        self.machine.init();
    }

    pub fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        self.machine.scan(instance, cx)
    }

    pub fn state(&self) -> &[u8] {
        self.machine.state()
    }

    pub fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.machine.write(offset, bytes);
    }

    pub fn write_value(&mut self, offset: usize, value: Value) {
        let mut bytes = [0; 8];
        value.write(&mut bytes);
        self.machine.write(offset, &bytes[..usize::try_from(value.repr().size()).unwrap()]);
    }

    /// Offset of a field of an instance's state.
    pub fn offset(&self, program: &Program, instance: usize, at: usize) -> usize {
        let state = program.class(program.instances[instance].program).state;
        usize_of(self.layout.machine.instances[instance] + self.layout.field(state, FieldId::next(at)))
    }
}

/// Equal, and equal in the sign of zero; every NaN is one.
pub fn same(a: Value, b: Value) -> bool {
    match (a, b) {
        (Value::F32(a), Value::F32(b)) => a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(),
        (Value::F64(a), Value::F64(b)) => a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(),
        _ => a == b,
    }
}

/// The values of a repr at which operations differ.
pub fn edges(repr: Repr) -> Vec<Value> {
    if repr.is_float() {
        return REALS.iter().map(|it| real(repr, *it)).chain(extremes(repr)).collect();
    }
    let (min, max) = repr.range().unwrap();
    let mut numbers = vec![min, min + 1, max - 1, max, -2, -1, 0, 1, 2, 3, 7, 10, 100];
    numbers.extend([max / 2, max / 2 + 1, min / 2]);
    numbers.extend([8, 9, 15, 16, 17, 31, 32, 33, 63, 64, 65, 255, 256, 257, -8, -64, 1 << 32, (1 << 32) + 1]);
    // Where the nearest REAL or LREAL is a tie, or just not.
    numbers.extend([(1 << 24) + 1, (1 << 24) + 3, (1 << 53) + 1, (1 << 53) + 3, -(1 << 24) - 1]);
    numbers.extend([
        (1 << 63) + (1 << 39),
        (1 << 63) + (1 << 39) + 1,
        (1 << 63) + (1 << 10),
        (1 << 63) + (1 << 10) + 1,
    ]);
    numbers.sort_unstable();
    numbers.dedup();
    numbers.into_iter().filter_map(|number| repr.integer(number)).collect()
}

const REALS: &[f64] = &[
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    0.49999997,
    1.5,
    -1.5,
    2.5,
    -2.5,
    3.5,
    100.25,
    126.5,
    127.5,
    128.5,
    -127.5,
    -128.5,
    -129.5,
    254.5,
    255.5,
    256.5,
    32766.5,
    32767.5,
    32768.5,
    -32768.5,
    -32769.0,
    65534.5,
    65535.5,
    65536.0,
    2147483646.5,
    2147483647.0,
    2147483647.5,
    2147483648.0,
    -2147483648.0,
    -2147483648.5,
    -2147483649.0,
    4294967294.5,
    4294967295.0,
    4294967295.5,
    4294967296.0,
    9007199254740993.0,
    9223372036854774784.0,
    9223372036854775808.0,
    -9223372036854775808.0,
    -9223372036854777856.0,
    18446744073709549568.0,
    18446744073709551616.0,
    1e30,
    -1e30,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

fn real(repr: Repr, value: f64) -> Value {
    if repr == Repr::F32 { Value::F32(value as f32) } else { Value::F64(value) }
}

fn extremes(repr: Repr) -> Vec<Value> {
    if repr == Repr::F32 {
        [f32::MAX, f32::MIN, f32::MIN_POSITIVE, f32::from_bits(1), -f32::NAN].map(Value::F32).to_vec()
    } else {
        [f64::MAX, f64::MIN, f64::MIN_POSITIVE, f64::from_bits(1), -f64::NAN, 1e300].map(Value::F64).to_vec()
    }
}
