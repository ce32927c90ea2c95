//! Hand-built programs for the tests of this crate.

use crate::*;
use staunch_runtime::{BLOCKS, Family};

pub const AT: Location = Location { file: 0, line: 7, column: 3 };

/// Line `line`, to distinguish locations.
pub fn at(line: u32) -> Location {
    Location { line, ..AT }
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

/// A program that runs `routines`' last, a PROGRAM, as `main`; the globals are the last of `structs`.
pub fn program(arrays: Vec<Array>, structs: Vec<Struct>, routines: Vec<Routine>) -> Program {
    Program {
        files: vec![SourceFile { path: "main.st".to_owned(), system: Family::Iec }],
        enums: vec![color()],
        bounds: vec![(-3, 7), (1, 9)],
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
        uses: Uses::default(),
        is_configured: false,
        structs,
        instances: vec![Instance {
            name: "main".to_owned(),
            program: ClassId::next(classes(&routines).len() - 1),
            task: None,
            interval: None,
            priority: 0,
        }],
        classes: classes(&routines),
        routines,
    }
}

/// A class for each body; the last is a PROGRAM.
fn classes(routines: &[Routine]) -> Vec<Class> {
    let find = |kind, state| routines.iter().position(|it| it.kind == kind && it.state == state).map(RoutineId::next);
    let bodies = routines.iter().filter(|it| it.kind == RoutineKind::Body);
    let mut classes: Vec<_> = bodies
        .map(|it| Class {
            kind: ClassKind::FunctionBlock,
            name: it.name.clone(),
            doc: None,
            location: AT,
            state: it.state.unwrap(),
            variables: Vec::new(),
            body: find(RoutineKind::Body, it.state).unwrap(),
            prescan: find(RoutineKind::Prescan, it.state),
            start: None,
        })
        .collect();
    classes.last_mut().unwrap().kind = ClassKind::Program;
    classes
}

fn color() -> Enum {
    let value = |name: &str, value| Enumerator { name: name.to_owned(), doc: None, value };
    Enum {
        name: "Color".to_owned(),
        doc: None,
        location: AT,
        base: Elementary::Int,
        values: vec![value("Red", Value::I16(0)), value("Green", Value::I16(5))],
    }
}

pub const COLOR: Type = Type::Enum(EnumId(0));

/// What the tests below work on: a function, a function block, and a PROGRAM with a body that
/// the test gives.
///
/// ```text
/// TYPE Color: (Red := 0, Green := 5)
/// array 0: ARRAY[1..3] OF INT
/// struct 0 Adder     sum: INT := 10                       state of the function block
/// struct 1 Main      count: INT, wide: DINT, values: ARRAY, adder: Adder, name: STRING[8],
///                    counter: CTU, color: Color, limit: INT CONSTANT := 3, flag: BOOL
/// struct 2 globals   total: DINT
/// FUNCTION Double(x: INT): INT, VAR_OUTPUT remainder: INT      routine 0
/// FUNCTION_BLOCK Adder  VAR_IN_OUT amount: INT                  routine 1
///     its prescan                                               routine 2
/// PROGRAM Main, VAR_TEMP temp: INT := 4                         routine 3
/// ```
pub fn sample(body: Block) -> Program {
    let values = Type::Array(ArrayId(0));
    let adder_initial = Const::Struct(vec![Const::Scalar(Value::I16(10))]);
    let main = structure(
        "Main",
        vec![
            field("count", Type::INT, Const::Zero),
            field("wide", Type::DINT, Const::Zero),
            field("values", values, Const::Array(vec![(2, int_const(1)), (1, int_const(9))])),
            field("adder", Type::Struct(StructId(0)), adder_initial),
            field("name", Type::string(8), Const::Text(Chars::Narrow(b"abc".to_vec()))),
            field("counter", Type::Block(ctu()), Const::Zero),
            field("color", COLOR, Const::Scalar(Value::I16(5))),
            Field { constant: true, ..field("limit", Type::INT, int_const(3)) },
            field("flag", Type::BOOL, Const::Zero),
        ],
    );
    let adder = structure("Adder", vec![field("sum", Type::INT, int_const(10))]);
    let globals = structure("globals", vec![field("total", Type::DINT, Const::Zero)]);
    let arrays = vec![Array { low: 1, high: 3, element: Type::INT }];
    let routines = vec![double(), adder_routine(), adder_prescan(), main_routine(body)];
    let mut program = program(arrays, vec![adder, main, globals], routines);
    let variable =
        |name: &str, place| Variable { name: name.to_owned(), section: Section::Internal, place, view: None };
    program.classes[1].variables = vec![
        variable("count", count()),
        variable("temp", temp()),
        Variable { section: Section::External, ..variable("total", total()) },
        variable("counter", counter()),
    ];
    program
}

pub fn int_const(value: i16) -> Const {
    Const::Scalar(Value::I16(value))
}

/// `Double := x * 2; remainder := x;`
fn double() -> Routine {
    let x = || Place::local(LocalId(0), Type::INT);
    let product = Expr::apply(Op::Mul, Type::INT, vec![load(x()), int(2)], AT);
    Routine {
        params: vec![param("x", Type::INT, Mode::Value(LocalId(0))), param("remainder", Type::INT, Mode::Reference)],
        locals: vec![local("x", Type::INT, Const::Zero), local("Double", Type::INT, Const::Zero)],
        result: Some(LocalId(1)),
        body: vec![
            Statement::assign(Place::local(LocalId(1), Type::INT), product, AT),
            Statement::assign(Place::root(Root::Param(ParamId(1)), Type::INT), load(x()), AT),
        ],
        ..routine(RoutineKind::Function, "Double", None)
    }
}

fn sum() -> Place {
    Place::root(Root::Instance, Type::Struct(StructId(0))).field(FieldId(0), Type::INT)
}

/// `amount := amount + 1; sum := sum + amount;`
fn adder_routine() -> Routine {
    let amount = || Place::root(Root::Param(ParamId(0)), Type::INT);
    Routine {
        params: vec![param("amount", Type::INT, Mode::Reference)],
        body: vec![
            Statement::assign(amount(), add(load(amount()), int(1)), AT),
            Statement::assign(sum(), add(load(sum()), load(amount())), AT),
        ],
        ..routine(RoutineKind::Body, "Adder", Some(StructId(0)))
    }
}

/// `sum := 100;`
fn adder_prescan() -> Routine {
    let body = vec![Statement::assign(sum(), int(100), AT)];
    Routine { body, ..routine(RoutineKind::Prescan, "Adder", Some(StructId(0))) }
}

fn main_routine(body: Block) -> Routine {
    let locals = vec![local("temp", Type::INT, int_const(4))];
    Routine { locals, body, ..routine(RoutineKind::Body, "Main", Some(StructId(1))) }
}

/// Runs a routine of the adder on its instance.
pub fn prescan_adder(callee: RoutineId, instance: Place) -> Statement {
    stmt(StatementKind::Call { callee, instance: Some(instance), arguments: Vec::new(), result: None })
}

/// The IEC counter of INT.
pub fn ctu() -> BlockId {
    block("CTU", Family::Iec)
}

pub fn block(name: &str, family: Family) -> BlockId {
    let at = BLOCKS.iter().position(|info| info.name == name && info.family == family);
    BlockId::next(at.unwrap())
}

pub fn int(value: i16) -> Expr {
    Expr::constant(Elementary::Int, Value::I16(value), AT)
}

pub fn lint(value: i64) -> Expr {
    Expr::constant(Elementary::Lint, Value::I64(value), AT)
}

pub fn load(place: Place) -> Expr {
    Expr::load(place, AT)
}

pub fn add(a: Expr, b: Expr) -> Expr {
    Expr::apply(Op::Add, Type::INT, vec![a, b], AT)
}

fn main_field(id: u32, ty: Type) -> Place {
    Place::root(Root::Instance, Type::Struct(StructId(1))).field(FieldId(id), ty)
}

pub fn count() -> Place {
    main_field(0, Type::INT)
}

pub fn wide() -> Place {
    main_field(1, Type::DINT)
}

pub fn values() -> Place {
    main_field(2, Type::Array(ArrayId(0)))
}

pub fn value(index: Expr, line: u32) -> Place {
    values().index(index, Type::INT, at(line))
}

pub fn adder() -> Place {
    main_field(3, Type::Struct(StructId(0)))
}

pub fn name() -> Place {
    main_field(4, Type::string(8))
}

pub fn counter() -> Place {
    main_field(5, Type::Block(ctu()))
}

pub fn color_place() -> Place {
    main_field(6, COLOR)
}

pub fn limit() -> Place {
    main_field(7, Type::INT)
}

pub fn flag() -> Place {
    main_field(8, Type::BOOL)
}

pub fn temp() -> Place {
    Place::local(LocalId(0), Type::INT)
}

pub fn total() -> Place {
    Place::root(Root::Globals, Type::Struct(StructId(2))).field(FieldId(0), Type::DINT)
}

pub fn assign(target: Place, value: Expr) -> Statement {
    Statement::assign(target, value, AT)
}

pub fn stmt(kind: StatementKind) -> Statement {
    Statement::new(kind, AT)
}

/// `result := Double(x, remainder => remainder)`.
pub fn call_double(x: Expr, remainder: Place, result: Option<Place>) -> Statement {
    let arguments = vec![Argument::Value(x), Argument::Reference(remainder)];
    stmt(StatementKind::Call { callee: RoutineId(0), instance: None, arguments, result })
}

/// `adder(amount := amount)`.
pub fn call_adder(amount: Place) -> Statement {
    let arguments = vec![Argument::Reference(amount)];
    stmt(StatementKind::Call { callee: RoutineId(1), instance: Some(adder()), arguments, result: None })
}

/// `counter(cu, FALSE, pv)`.
pub fn call_counter(cu: Expr, pv: i16) -> Statement {
    let inputs = vec![cu, Expr::bool(false, AT), int(pv)];
    stmt(StatementKind::CallBlock { block: counter(), instruction: 0, inputs })
}
