//! A program with a PROGRAM for every operation at every repr, and one for every conversion:
//! the IR as the front end would build it, without the front end.

use staunch_ir::{
    Class, ClassId, ClassKind, Const, Conversion, Elementary, Expr, Field, FieldId, Instance, Location, Op, Place,
    Program, Reach, Repr, Root, Routine, RoutineId, RoutineKind, Section, SourceFile, Statement, Struct, StructId,
    Type, Value, Variable,
};

/// What one instance of the program computes from its operands.
#[derive(Clone, Copy, Debug)]
pub enum Task {
    Apply(Op, Repr),
    /// The back ends may turn a negated comparison around.
    NotApply(Op, Repr),
    /// By a constant, which a back end may know more of than of a variable.
    Shift(Op, Repr, i64),
    Convert(Conversion, Repr, Repr),
}

impl Task {
    /// In the order of the program's instances.
    pub fn all() -> Vec<Self> {
        let mut tasks = Vec::new();
        for op in Op::ALL {
            for repr in Repr::ALL.into_iter().filter(|it| op.allows(*it)) {
                tasks.push(Self::Apply(*op, repr));
                if op.result() == Some(Repr::Bool) {
                    tasks.push(Self::NotApply(*op, repr));
                }
            }
        }
        for repr in Repr::ALL.into_iter().filter(|it| it.is_unsigned()) {
            let bits = i64::from(repr.size()) * 8;
            let counts = [-1, 0, 1, bits / 2, bits - 1, bits, bits + 1];
            tasks.extend([Op::Shl, Op::Shr].iter().flat_map(|op| counts.map(|count| Self::Shift(*op, repr, count))));
        }
        for from in Repr::ALL {
            tasks.extend(
                Repr::ALL.into_iter().filter(|to| *to != from).map(|to| Self::Convert(Conversion::Value, from, to)),
            );
            if from.is_float() {
                let integers = Repr::ALL.into_iter().filter(|it| it.is_integer());
                tasks.extend(integers.map(|to| Self::Convert(Conversion::Truncate, from, to)));
            }
        }
        for (real, bits) in [(Repr::F32, Repr::U32), (Repr::F64, Repr::U64)] {
            tasks.push(Self::Convert(Conversion::Bits, real, bits));
            tasks.push(Self::Convert(Conversion::Bits, bits, real));
        }
        tasks
    }

    /// The reprs of the fields `a`, `b` …
    pub fn operands(self) -> Vec<Repr> {
        match self {
            Self::Apply(op, repr) | Self::NotApply(op, repr) => {
                op.operands().iter().map(|it| it.unwrap_or(repr)).collect()
            }
            Self::Shift(_, repr, _) => vec![repr],
            Self::Convert(_, from, _) => vec![from],
        }
    }

    /// The repr of the field after the operands.
    pub fn result(self) -> Repr {
        match self {
            Self::Apply(op, repr) => op.result().unwrap_or(repr),
            Self::NotApply(..) => Repr::Bool,
            Self::Shift(_, repr, _) => repr,
            Self::Convert(_, _, to) => to,
        }
    }

    pub fn name(self) -> String {
        match self {
            Self::Apply(op, repr) => format!("{op:?}_{repr:?}"),
            Self::NotApply(op, repr) => format!("Not{op:?}_{repr:?}"),
            Self::Shift(op, repr, count) if count < 0 => format!("{op:?}_{repr:?}_back_{}", -count),
            Self::Shift(op, repr, count) => format!("{op:?}_{repr:?}_by_{count}"),
            Self::Convert(how, from, to) => format!("{how:?}_{from:?}_{to:?}"),
        }
    }

    /// `result := op(a, b, …);`, every node at a place of its own.
    fn statement(self, state: StructId) -> Statement {
        let operands = self.operands();
        let place = |at: usize, repr| {
            Place::root(Root::Instance, Type::Struct(state))
                .field(FieldId::next(at), Type::Elementary(Elementary::number(repr)))
        };
        let mut loads: Vec<_> =
            operands.iter().enumerate().map(|(at, repr)| Expr::load(place(at, *repr), AT)).collect();
        if let Self::Shift(_, _, count) = self {
            loads.push(Expr::constant(Elementary::Lint, Value::I64(count), AT));
        }
        let ty = Type::Elementary(Elementary::number(self.result()));
        let value = match self {
            Self::Apply(op, _) | Self::Shift(op, ..) => Expr::apply(op, ty, loads, AT),
            Self::NotApply(op, _) => Expr::apply(Op::Not, ty, vec![Expr::apply(op, ty, loads, AT)], AT),
            Self::Convert(how, ..) => {
                Expr::convert(how, ty, loads.into_iter().next().expect("a conversion has an operand"), AT)
            }
        };
        Statement::assign(place(operands.len(), self.result()), value, AT)
    }
}

/// Where every operation is.
pub const AT: Location = Location { file: 0, line: 7, column: 3 };

pub fn program(tasks: &[Task]) -> Program {
    let mut structs: Vec<_> = tasks.iter().map(|it| structure(*it)).collect();
    structs.push(Struct::new("globals".to_owned(), None, AT, Vec::new()));
    Program {
        files: vec![SourceFile { path: "operations.st".to_owned(), system: staunch_runtime::Family::Iec }],
        enums: Vec::new(),
        bounds: Vec::new(),
        milliseconds: None,
        remotes: Vec::new(),
        arrays: Vec::new(),
        interfaces: Vec::new(),
        implementers: Vec::new(),
        references: Vec::new(),
        globals: StructId::next(tasks.len()),
        aliases: Vec::new(),
        global_paths: Vec::new(),
        bound: Vec::new(),
        reentered: std::collections::BTreeSet::new(),
        reach: Reach::default(),
        reached: None,
        places: std::collections::BTreeSet::new(),
        uses: staunch_ir::Uses::default(),
        is_configured: false,
        structs,
        classes: tasks
            .iter()
            .enumerate()
            .map(|(at, task)| class(*task, StructId::next(at), RoutineId::next(at)))
            .collect(),
        routines: tasks.iter().enumerate().map(|(at, task)| routine(*task, StructId::next(at))).collect(),
        instances: tasks.iter().enumerate().map(|(at, task)| instance(*task, ClassId::next(at))).collect(),
    }
}

fn fields(task: Task) -> Vec<(String, Type)> {
    let names = ["a", "b", "c", "d"].into_iter().map(str::to_owned);
    let mut fields: Vec<_> =
        names.zip(task.operands().into_iter().map(|it| Type::Elementary(Elementary::number(it)))).collect();
    fields.push(("result".to_owned(), Type::Elementary(Elementary::number(task.result()))));
    fields
}

fn structure(task: Task) -> Struct {
    let field = |(name, ty)| Field {
        name,
        ty,
        initial: Const::Zero,
        section: Section::Internal,
        retain: staunch_ir::Retain::Inherited,
        constant: false,
        address: None,
        doc: None,
        location: AT,
        declared: None,
    };
    Struct::new(task.name(), None, AT, fields(task).into_iter().map(field).collect())
}

fn routine(task: Task, state: StructId) -> Routine {
    Routine {
        kind: RoutineKind::Body,
        name: task.name(),
        doc: None,
        location: AT,
        state: Some(state),
        params: Vec::new(),
        locals: Vec::new(),
        result: None,
        body: vec![task.statement(state)],
    }
}

fn class(task: Task, state: StructId, body: RoutineId) -> Class {
    let variable = |(at, (name, ty))| Variable {
        name,
        section: Section::Internal,
        place: Place::root(Root::Instance, Type::Struct(state)).field(FieldId::next(at), ty),
        view: None,
    };
    Class {
        kind: ClassKind::Program,
        name: task.name(),
        doc: None,
        location: AT,
        state,
        variables: fields(task).into_iter().enumerate().map(variable).collect(),
        body,
        prescan: None,
        start: None,
    }
}

fn instance(task: Task, program: ClassId) -> Instance {
    Instance { name: format!("run_{}", task.name().to_lowercase()), program, task: None, interval: None, priority: 0 }
}

/// Values at which operations are likely to differ.
pub fn edges(repr: Repr) -> Vec<Value> {
    match repr {
        Repr::Bool => vec![Value::Bool(false), Value::Bool(true)],
        Repr::F32 => FLOATS.iter().map(|it| Value::F32(*it)).chain(singles()).collect(),
        Repr::F64 => FLOATS.iter().map(|it| Value::F64(f64::from(*it))).chain(doubles()).collect(),
        _ => integers(repr),
    }
}

fn integers(repr: Repr) -> Vec<Value> {
    let (low, high) = repr.range().expect("an integer repr has a range");
    let bits = i128::from(repr.size()) * 8;
    let near = [low, low + 1, -2, -1, 0, 1, 2, 3, 7, bits - 1, bits, bits + 1, high / 2, high / 2 + 1, high - 1, high];
    let mut values: Vec<i128> = near.into_iter().filter(|it| (low..=high).contains(it)).collect();
    values.sort_unstable();
    values.dedup();
    values.into_iter().filter_map(|it| repr.integer(it)).collect()
}

const FLOATS: &[f32] = &[
    f32::NAN,
    f32::NEG_INFINITY,
    -2.5,
    -1.5,
    -1.0,
    -0.5,
    -0.0,
    0.0,
    0.5,
    1.0,
    1.5,
    2.5,
    3.5,
    127.5,
    255.5,
    32767.5,
    65535.5,
    2_147_483_648.0,
    4_294_967_296.0,
    9_223_372_036_854_775_808.0,
    18_446_744_073_709_551_616.0,
    f32::INFINITY,
];

fn singles() -> impl Iterator<Item = Value> {
    [f32::MIN, f32::MAX, f32::MIN_POSITIVE, f32::from_bits(1)].into_iter().map(Value::F32)
}

fn doubles() -> impl Iterator<Item = Value> {
    [
        f64::MIN,
        f64::MAX,
        f64::MIN_POSITIVE,
        f64::from_bits(1),
        9_007_199_254_740_993.0,
        0.1,
        2_147_483_647.5,
        -2_147_483_648.5,
    ]
    .into_iter()
    .map(Value::F64)
}
