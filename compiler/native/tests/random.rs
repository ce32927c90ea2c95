//! Random programs do on native code what they do on the interpreter: same state, byte by byte,
//! same fault, scan after scan.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::*;
use staunch_runtime::{BLOCKS, Context, Kind};
use support::*;

/// How many programs, and how many scans of each.
const PROGRAMS: u64 = 100;
const SCANS: i64 = 6;
/// Programs that take longer in a scan are left out.
const BUDGET: u64 = 50_000;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, limit: usize) -> usize {
        usize::try_from((self.next() >> 8) % u64::try_from(limit).unwrap()).unwrap()
    }

    fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())].clone()
    }
}

/// A variable that a body can use.
#[derive(Clone)]
struct Known {
    place: Place,
    writable: bool,
}

/// Makes a program: types, functions, function blocks and a PROGRAM.
struct Maker {
    random: Random,
    line: u32,
    arrays: Vec<Array>,
    structs: Vec<Struct>,
    routines: Vec<Routine>,
    classes: Vec<Class>,
    /// What the routine being made can use.
    known: Vec<Known>,
    locals: Vec<Local>,
    loops: usize,
    /// In the `continuing` of a loop, or in a prescan.
    plain: bool,
}

/// Of the one subrange; every integer type holds them.
const LIMITS: (i128, i128) = (3, 100);
const STRINGS: [StringType; 5] =
    [StringType::narrow(4), StringType::narrow(9), StringType::narrow(80), StringType::wide(5), StringType::wide(30)];

impl Maker {
    fn program(seed: u64) -> Program {
        let mut maker = Self {
            random: Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1),
            line: 10,
            arrays: Vec::new(),
            structs: Vec::new(),
            routines: Vec::new(),
            classes: Vec::new(),
            known: Vec::new(),
            locals: Vec::new(),
            loops: 0,
            plain: false,
        };
        maker.types();
        let globals = maker.state("globals", 6);
        for _ in 0..2 {
            maker.function(globals);
        }
        for _ in 0..2 {
            maker.class(ClassKind::FunctionBlock, globals);
        }
        for _ in 0..2 {
            maker.class(ClassKind::Program, globals);
        }
        let is_program = |at: &usize| maker.classes[*at].kind == ClassKind::Program;
        let instances = (0..maker.classes.len()).filter(is_program).map(|at| instance(ClassId::next(at)));
        Program {
            files: vec![SourceFile { path: "random.st".to_owned(), system: staunch_runtime::Family::Iec }],
            bounds: vec![LIMITS],
            milliseconds: None,
            remotes: Vec::new(),
            enums: vec![Enum {
                name: "Color".to_owned(),
                doc: None,
                location: AT,
                base: Elementary::Sint,
                values: vec![Enumerator { name: "Red".to_owned(), doc: None, value: Value::I8(-3) }],
            }],
            instances: instances.collect(),
            arrays: maker.arrays,
            interfaces: Vec::new(),
            implementers: Vec::new(),
            references: Vec::new(),
            globals,
            aliases: Vec::new(),
            global_paths: Vec::new(),
            bound: Vec::new(),
            reentered: std::collections::BTreeSet::new(),
            reach: Reach::default(),
            reached: None,
            places: std::collections::BTreeSet::new(),
            uses: Default::default(),
            is_configured: false,
            structs: maker.structs,
            classes: maker.classes,
            routines: maker.routines,
        }
    }

    fn types(&mut self) {
        for _ in 0..4 {
            let element = self.part();
            let low = self.random.of(&[-3, 0, 1, i64::MAX - 4, i64::MIN]);
            let len = self.random.below(5);
            self.arrays.push(Array { low, high: low + i64::try_from(len).unwrap(), element });
        }
        self.state("Pair", 3);
        self.state("Deep", 3);
    }

    fn part(&mut self) -> Type {
        match self.random.below(12) {
            0 => Type::String(self.random.of(&STRINGS)),
            1 if self.random.one_in(2) => Type::Enum(EnumId(0)),
            1 => Type::Subrange(Elementary::Int, BoundsId(0)),
            2 if !self.arrays.is_empty() => Type::Array(ArrayId::next(self.random.below(self.arrays.len()))),
            3 if !self.structs.is_empty() => Type::Struct(StructId::next(self.random.below(2.min(self.structs.len())))),
            4 => self.block(),
            _ => Type::Elementary(self.random.of(&Elementary::ALL)),
        }
    }

    /// Of what may be passed by value.
    fn copied_part(&mut self) -> Type {
        loop {
            let ty = self.part();
            if !holds_instance(&self.arrays, &self.structs, ty) {
                return ty;
            }
        }
    }

    fn block(&mut self) -> Type {
        Type::Block(BlockId::next(self.random.below(BLOCKS.len())))
    }

    fn state(&mut self, name: &str, fields: usize) -> StructId {
        let fields = (0..fields).map(|_| {
            let ty = self.part();
            field("field", ty, self.initial(ty))
        });
        let fields = fields.collect();
        self.structs.push(structure(name, fields));
        StructId::next(self.structs.len() - 1)
    }

    fn initial(&mut self, ty: Type) -> Const {
        match ty {
            Type::Elementary(it) => Const::Scalar(self.value(it.repr())),
            Type::Subrange(it, _) => it.repr().integer(LIMITS.0).map_or(Const::Zero, Const::Scalar),
            Type::Enum(_) => Const::Scalar(Value::I8(-3)),
            Type::Reference(_) => Const::Zero,
            Type::String(it) => Const::Text(self.chars(it)),
            Type::Array(id) if self.random.one_in(2) => {
                let array = self.arrays[id.index()];
                let first = self.initial(array.element);
                let rest = self.initial(array.element);
                if array.len() == 1 {
                    Const::Array(vec![(1, first)])
                } else {
                    Const::Array(vec![(1, first), (array.len() - 1, rest)])
                }
            }
            Type::Struct(id) if self.random.one_in(2) => {
                let types: Vec<_> = self.structs[id.index()].fields.iter().map(|field| field.ty).collect();
                Const::Struct(types.into_iter().map(|ty| self.initial(ty)).collect())
            }
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => Const::Zero,
        }
    }

    fn value(&mut self, repr: Repr) -> Value {
        if repr.is_integer() && self.random.one_in(2) {
            return repr.integer(i128::from(self.random.next() % 5)).unwrap();
        }
        let edges = edges(repr);
        // The bits of a NaN are the machine's choice.
        match self.random.of(&edges) {
            Value::F32(it) if it.is_nan() => Value::F32(2.5),
            Value::F64(it) if it.is_nan() => Value::F64(2.5),
            other => other,
        }
    }

    fn chars(&mut self, ty: StringType) -> Chars {
        let len = self.random.below(usize::from(ty.capacity.min(6)) + 1);
        if ty.wide {
            // Half of a surrogate pair, too.
            Chars::Wide((0..len).map(|_| self.random.of(&[0x61, 0x78, 0x20AC, 0xD83D, 0xDE00])).collect())
        } else {
            Chars::Narrow((0..len).map(|_| self.random.of(b"abcx\xC3\xA9")).collect())
        }
    }

    /// A type of strings of one kind.
    fn string_type(&mut self, wide: bool) -> StringType {
        let of_kind: Vec<_> = STRINGS.into_iter().filter(|it| it.wide == wide).collect();
        self.random.of(&of_kind)
    }

    fn at(&mut self) -> Location {
        self.line += 1;
        line(self.line)
    }

    // Routines.

    fn function(&mut self, globals: StructId) {
        self.open(globals);
        let mut params = Vec::new();
        for _ in 0..4 {
            if self.random.one_in(2) {
                let ty = self.copied_part();
                let local = self.local(ty);
                params.push(param("p", ty, Mode::Value(local)));
            } else {
                let ty = self.part();
                let place = Place::root(Root::Param(ParamId::next(params.len())), ty);
                params.push(param("p", ty, Mode::Reference));
                self.know(place, true);
            }
        }
        let ty = self.copied_part();
        let result = self.local(ty);
        self.more_locals();
        let body = self.statements(5, 2);
        let routine = routine(RoutineKind::Function, "Function", None);
        self.close(Routine { params, result: Some(result), body, ..routine });
    }

    fn class(&mut self, kind: ClassKind, globals: StructId) {
        let name = if kind == ClassKind::Program { "Main" } else { "Fb" };
        let state = self.state(name, 7);
        // Instances of the function blocks that there are, and of standard blocks.
        let blocks: Vec<_> = self.classes.iter().filter(|it| it.kind == ClassKind::FunctionBlock).collect();
        for id in blocks.into_iter().map(|it| it.state) {
            self.structs[state.index()].fields.push(zero("fb", Type::Struct(id)));
        }
        for _ in 0..3 {
            let ty = self.block();
            self.structs[state.index()].fields.push(zero("block", ty));
        }
        let prescan = self.random.one_in(2).then(|| self.prescan(name, state, globals));
        self.open(globals);
        self.know(Place::root(Root::Instance, Type::Struct(state)), true);
        self.more_locals();
        let mut params = Vec::new();
        if kind == ClassKind::FunctionBlock {
            for _ in 0..2 {
                let ty = self.part();
                self.know(Place::root(Root::Param(ParamId::next(params.len())), ty), true);
                params.push(param("p", ty, Mode::Reference));
            }
        }
        let body = self.statements(12, 3);
        self.close(Routine { params, body, ..routine(RoutineKind::Body, name, Some(state)) });
        let body = RoutineId::next(self.routines.len() - 1);
        self.classes.push(class(kind, &self.routines, body, prescan));
    }

    fn prescan(&mut self, name: &str, state: StructId, globals: StructId) -> RoutineId {
        self.open(globals);
        self.know(Place::root(Root::Instance, Type::Struct(state)), true);
        self.more_locals();
        self.plain = true;
        let body = self.statements(3, 1);
        self.plain = false;
        self.close(Routine { body, ..routine(RoutineKind::Prescan, name, Some(state)) });
        RoutineId::next(self.routines.len() - 1)
    }

    fn open(&mut self, globals: StructId) {
        self.known.clear();
        self.locals.clear();
        self.know(Place::root(Root::Globals, Type::Struct(globals)), true);
    }

    fn close(&mut self, routine: Routine) {
        let locals = core::mem::take(&mut self.locals);
        self.routines.push(Routine { locals, ..routine });
    }

    fn more_locals(&mut self) {
        for _ in 0..5 {
            let ty = self.part();
            self.local(ty);
        }
    }

    fn local(&mut self, ty: Type) -> LocalId {
        let initial = self.initial(ty);
        self.locals.push(local("local", ty, initial));
        let id = LocalId::next(self.locals.len() - 1);
        self.know(Place::local(id, ty), true);
        id
    }

    fn know(&mut self, place: Place, writable: bool) {
        self.known.push(Known { place, writable });
    }

    // Places.

    /// A part of what is known whose type is accepted; several tries, then none.
    fn place(&mut self, depth: usize, accepts: impl Fn(Type) -> bool) -> Option<Place> {
        for _ in 0..40 {
            let known = self.random.of(&self.known.clone());
            let mut place = known.place;
            loop {
                let stops = accepts(place.ty) && (known.writable || !place.projections.is_empty());
                if stops && self.random.one_in(2) {
                    return Some(place);
                }
                let Some(part) = self.step(place.clone(), depth) else { break };
                place = part;
            }
            if accepts(place.ty) {
                return Some(place);
            }
        }
        None
    }

    fn step(&mut self, place: Place, depth: usize) -> Option<Place> {
        match place.ty {
            Type::Struct(id) => {
                let types: Vec<_> = self.structs[id.index()].fields.iter().map(|field| field.ty).collect();
                let at = self.random.below(types.len());
                Some(place.field(FieldId::next(at), types[at]))
            }
            Type::Block(id) => {
                let at = FieldId::next(self.random.below(id.info().pins.len()));
                Some(place.field(at, id.pin_type(at).unwrap()))
            }
            Type::Array(id) => {
                let array = self.arrays[id.index()];
                let at = self.at();
                let index = self.index(array, depth);
                Some(place.index(index, array.element, at))
            }
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => None,
        }
    }

    fn index(&mut self, array: Array, depth: usize) -> Expr {
        let len = usize::try_from(array.len()).unwrap();
        let inside = lint(array.low + i64::try_from(self.random.below(len)).unwrap());
        match self.random.below(20) {
            0 => lint(array.high.wrapping_add(1)),
            1..4 if depth > 0 => self.expr(Type::LINT, depth - 1),
            4..13 if depth > 0 => {
                let value = self.expr(Type::LINT, depth - 1);
                Expr::apply(Op::Limit, Type::LINT, vec![lint(array.low), value, lint(array.high)], AT)
            }
            _ => inside,
        }
    }

    // Expressions.

    fn expr(&mut self, ty: Type, depth: usize) -> Expr {
        if self.random.one_in(3)
            && let Some(place) = self.place(depth, |it| it == ty)
        {
            return load(place);
        }
        match ty {
            Type::Elementary(it) if depth > 0 => self.computed(it, depth - 1),
            Type::Reference(_) => Expr::new(ty, ExprKind::Const(Value::U64(0)), AT),
            Type::Elementary(it) => {
                let value = self.value(it.repr());
                Expr::constant(it, value, AT)
            }
            Type::Subrange(it, _) => {
                let limit = |it: Elementary, number| Expr::constant(it, it.repr().integer(number).unwrap(), AT);
                let value = self.expr(Type::Elementary(it), depth.saturating_sub(1));
                Expr::apply(Op::InRange, ty, vec![limit(it, LIMITS.0), value, limit(it, LIMITS.1)], AT)
            }
            Type::Enum(_) => Expr::new(ty, ExprKind::Const(Value::I8(-3)), AT),
            Type::String(it) => self.text(it, depth),
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => match self.place(depth, |it| it == ty) {
                Some(place) => load(place),
                None => Expr::new(ty, ExprKind::Aggregate(self.initial(ty)), AT),
            },
        }
    }

    fn text(&mut self, string: StringType, depth: usize) -> Expr {
        let ty = Type::String(string);
        if depth == 0 || self.random.one_in(3) {
            return Expr::new(ty, ExprKind::Text(self.chars(string)), AT);
        }
        if self.random.one_in(3) {
            let from = Type::String(self.string_type(string.wide));
            let value = self.expr(from, depth - 1);
            return Expr::convert(Conversion::Value, ty, value, AT);
        }
        let made = if string.wide { Kind::Wstring } else { Kind::String };
        let makes = |op: &TextOp| [made, Kind::AnyString].contains(&op.signature().result);
        let texts: Vec<_> = TextOp::ALL.iter().copied().filter(makes).collect();
        let op = self.random.of(&texts);
        self.text_operation(op, ty, string.wide, depth - 1)
    }

    fn text_operation(&mut self, op: TextOp, ty: Type, wide: bool, depth: usize) -> Expr {
        let operands = op.signature().parameters.iter().map(|it| match it.kind {
            Kind::String | Kind::Wstring | Kind::AnyString => {
                let wide = if it.kind == Kind::AnyString { wide } else { it.kind == Kind::Wstring };
                let ty = Type::String(self.string_type(wide));
                self.expr(ty, depth)
            }
            Kind::T | Kind::Any(_) | Kind::Is(_) => self.expr(elementary(it.kind.repr().unwrap()), depth),
        });
        let operands = operands.collect();
        Expr::new(ty, ExprKind::ApplyText(op, operands), AT)
    }

    fn computed(&mut self, ty: Elementary, depth: usize) -> Expr {
        let result = Type::Elementary(ty);
        match self.random.below(10) {
            0 => return self.conversion(ty, depth),
            1 if ty.repr() == Repr::I16 => {
                let op = self.random.of(&[TextOp::Compare, TextOp::Len, TextOp::Find]);
                let wide = self.random.one_in(2);
                return self.text_operation(op, result, wide, depth);
            }
            _ => {}
        }
        let repr = ty.repr();
        let fits = |op: &Op| match op.result() {
            Some(result) => result == repr,
            None => op.allows(repr),
        };
        let ops: Vec<_> = Op::ALL.iter().copied().filter(fits).collect();
        let op = self.random.of(&ops);
        // Of a comparison any repr can be compared; else the result says it.
        let of = match op.result() {
            Some(_) => {
                let allowed: Vec<_> = Repr::ALL.iter().copied().filter(|it| op.allows(*it)).collect();
                self.random.of(&allowed)
            }
            None => repr,
        };
        let operands = op.operands().iter().map(|fixed| {
            let ty = elementary(fixed.unwrap_or(of));
            self.expr(ty, depth)
        });
        let operands = operands.collect();
        let at = self.at();
        without_nan(Expr::apply(op, result, operands, at))
    }

    fn conversion(&mut self, ty: Elementary, depth: usize) -> Expr {
        let from = self.random.of(&Elementary::ALL);
        let how = match (from.repr() == ty.repr(), from.is_real() && ty.repr().is_integer()) {
            (true, _) => Conversion::Same,
            (false, true) => self.random.of(&[Conversion::Value, Conversion::Truncate]),
            (false, false) => Conversion::Value,
        };
        let value = self.expr(Type::Elementary(from), depth);
        Expr::convert(how, Type::Elementary(ty), value, AT)
    }

    // Statements.

    fn statements(&mut self, count: usize, depth: usize) -> Block {
        let count = 1 + self.random.below(count);
        (0..count).map(|_| self.statement(depth)).collect()
    }

    fn statement(&mut self, depth: usize) -> Statement {
        let kind = match self.random.below(16) {
            0 | 1 if depth > 0 => StatementKind::If {
                condition: self.expr(Type::BOOL, 3),
                then: self.statements(4, depth - 1),
                otherwise: if self.random.one_in(2) { Vec::new() } else { self.statements(4, depth - 1) },
            },
            2 if depth > 0 => self.case(depth),
            3 if depth > 0 && self.loops < 2 => match self.random.below(3) {
                0 => self.counted(depth).unwrap_or_else(|| self.assignment()),
                1 => self.repetition(depth),
                _ => self.linear(depth),
            },
            4 if self.loops > 0 => StatementKind::Exit,
            5 if self.loops > 0 && !self.plain => StatementKind::Continue,
            6 if self.random.one_in(6) => StatementKind::Return,
            7 if self.random.one_in(8) => StatementKind::Fault(self.random.of(&FaultKind::ALL)),
            8..11 => self.call().unwrap_or_else(|| self.assignment()),
            11 | 12 => self.call_block().unwrap_or_else(|| self.assignment()),
            _ => self.assignment(),
        };
        let at = self.at();
        Statement::new(kind, at)
    }

    fn assignment(&mut self) -> StatementKind {
        let (arrays, structs) = (self.arrays.clone(), self.structs.clone());
        let target = self.place(2, |ty| !holds_instance(&arrays, &structs, ty)).unwrap();
        let value = self.expr(target.ty, 3);
        StatementKind::Assign { target, value }
    }

    fn case(&mut self, depth: usize) -> StatementKind {
        let integers: Vec<_> = Elementary::ALL.into_iter().filter(|it| it.repr().is_integer()).collect();
        let ty = self.random.of(&integers);
        let (min, max) = ty.repr().range().unwrap();
        let mut arms = Vec::new();
        // From the least on, so that labels do not overlap.
        let mut next = self.random.of(&[min, -3, 0]).max(min);
        for _ in 0..self.random.below(6) {
            let mut labels = Vec::new();
            for _ in 0..self.random.below(4) {
                let wide = i128::from(self.random.of(&[0, 0, 0, 1, 5, 40, 70]));
                let high = (next + wide).min(max);
                if next <= high {
                    labels.push((next, high));
                }
                next = high + 1 + i128::from(self.random.below(3) as u32);
            }
            arms.push(Arm { labels, body: self.statements(2, depth - 1) });
        }
        let selector = self.expr(Type::Elementary(ty), 3);
        StatementKind::Case { selector, arms, otherwise: self.statements(2, depth - 1) }
    }

    /// A FOR loop, also over a variable that its body may write.
    fn counted(&mut self, depth: usize) -> Option<StatementKind> {
        let is_counter = |ty: Type| match ty {
            Type::Elementary(it) => it.is_integer() || it.is_bits() && it != Elementary::Bool,
            _ => false,
        };
        // What nobody else knows is private.
        let is_private = self.random.one_in(2);
        let counter = if is_private {
            let reprs =
                [Type::INT, Type::LINT, Type::Elementary(Elementary::Usint), Type::Elementary(Elementary::Ulint)];
            let ty = self.random.of(&reprs);
            self.locals.push(local("counter", ty, Const::Zero));
            Place::local(LocalId::next(self.locals.len() - 1), ty)
        } else {
            self.place(0, is_counter)?
        };
        if counter.projections.iter().any(|it| matches!(it, Projection::Index { .. })) {
            return None;
        }
        let Type::Elementary(ty) = counter.ty else { return None };
        let range = ty.repr().range()?;
        let step = self.random.of(&[1, 1, -1, 3, -7, 100]);
        let step = match self.random.one_in(3) {
            true => Step::Variable(self.expr(counter.ty, 1)),
            false => Step::Constant(step),
        };
        let (first, last) = (self.expr(counter.ty, 1), self.expr(counter.ty, 1));
        self.loops += 1;
        let mut body = self.statements(4, depth - 1);
        self.loops -= 1;
        body.insert(0, stmt(StatementKind::Turn));
        Some(StatementKind::For(Box::new(For {
            counter,
            first,
            last,
            step,
            range,
            is_private,
            body,
            taking: Taking::Each,
            step_at: AT,
        })))
    }

    /// `LOOP … IF counter >= n THEN EXIT; counter := counter + 1`, where the counter is new.
    fn repetition(&mut self, depth: usize) -> StatementKind {
        let counter = Place::local(LocalId::next(self.locals.len()), Type::INT);
        self.locals.push(local("counter", Type::INT, Const::Zero));
        self.loops += 1;
        let mut body = self.statements(4, depth - 1);
        body.insert(0, stmt(StatementKind::Turn));
        let plain = core::mem::replace(&mut self.plain, true);
        let reached = Expr::apply(Op::Ge, Type::BOOL, vec![load(counter.clone()), int(4)], AT);
        let exit =
            StatementKind::If { condition: reached, then: vec![stmt(StatementKind::Exit)], otherwise: Vec::new() };
        let raised = Expr::apply(Op::Add, Type::INT, vec![load(counter.clone()), int(1)], AT);
        let mut continuing = vec![stmt(exit), assign(counter, raised)];
        continuing.extend(self.statements(1, 0));
        self.plain = plain;
        self.loops -= 1;
        StatementKind::Loop { body, continuing, count: None }
    }

    /// `WHILE counter < n AND … DO … counter := counter + 1; … END_WHILE`, where the counter is new, and the
    /// step may be in the midst of the body.
    fn linear(&mut self, depth: usize) -> StatementKind {
        let elementary = self.random.of(&[Elementary::Int, Elementary::Lint, Elementary::Usint]);
        let (ty, is_unsigned) = (Type::Elementary(elementary), elementary == Elementary::Usint);
        let counter = Place::local(LocalId::next(self.locals.len()), ty);
        let number = |value: i128| elementary.repr().integer(value).unwrap();
        let up = self.random.one_in(2);
        let start = number(if up { 0 } else { 20 });
        self.locals.push(local("counter", ty, Const::Scalar(start)));
        let (op, step) = if up { (self.random.of(&[Op::Lt, Op::Le]), Op::Add) } else { (Op::Gt, Op::Sub) };
        let by = if is_unsigned && !up { 1 } else { self.random.of(&[1, 1, 3]) };
        let bound = match self.random.one_in(2) && by == 1 && op == Op::Lt {
            true => self.expr(ty, 0),
            false => Expr::constant(elementary, number(self.random.of(&[3, 9, 15])), AT),
        };
        let mut condition = Expr::apply(op, Type::BOOL, vec![load(counter.clone()), bound], AT);
        if self.random.one_in(3) {
            let other = self.expr(Type::BOOL, 1);
            condition = Expr::apply(Op::And, Type::BOOL, vec![condition, other], AT);
        }
        let leave = Expr::apply(Op::Not, Type::BOOL, vec![condition], AT);
        let exit = StatementKind::If { condition: leave, then: vec![stmt(StatementKind::Exit)], otherwise: Vec::new() };
        let one = Expr::constant(elementary, number(by), AT);
        let raised = Expr::apply(step, ty, vec![load(counter.clone()), one], AT);
        self.loops += 1;
        let plain = core::mem::replace(&mut self.plain, true);
        let mut body = vec![stmt(exit), stmt(StatementKind::Turn)];
        body.extend(self.statements(3, depth - 1));
        body.push(assign(counter, raised));
        body.extend(self.statements(2, depth - 1));
        self.plain = plain;
        self.loops -= 1;
        StatementKind::Loop { body, continuing: Vec::new(), count: None }
    }

    fn call(&mut self) -> Option<StatementKind> {
        // A PROGRAM's routines are last, and nobody's calls reach them: their state is nowhere.
        let callees: Vec<_> = (0..self.routines.len()).collect();
        if callees.is_empty() {
            return None;
        }
        let callee = self.random.of(&callees);
        let routine = self.routines[callee].clone();
        let callee = RoutineId::next(callee);
        let instance = match routine.state {
            Some(id) => Some(self.place(1, |ty| ty == Type::Struct(id))?),
            None => None,
        };
        let mut arguments = Vec::new();
        for param in &routine.params {
            arguments.push(match param.mode {
                Mode::Value(_) => Argument::Value(self.expr(param.ty, 2)),
                Mode::Reference => Argument::Reference(self.place(2, |ty| ty == param.ty)?),
            });
        }
        let result = match routine.result {
            Some(id) if self.random.one_in(2) => {
                let wanted = routine.locals[id.index()].ty;
                (0..self.locals.len())
                    .find(|at| self.locals[*at].ty == wanted && self.locals[*at].name != "counter")
                    .map(|at| Place::local(LocalId::next(at), wanted))
            }
            _ => None,
        };
        Some(StatementKind::Call { callee, instance, arguments, result })
    }

    fn call_block(&mut self) -> Option<StatementKind> {
        let block = self.place(2, |ty| matches!(ty, Type::Block(_)))?;
        let Type::Block(id) = block.ty else { return None };
        let info = id.info();
        let instruction = self.random.below(info.instructions.len());
        if info.instructions[instruction].prescan.is_some() && self.random.one_in(3) {
            return Some(StatementKind::PrescanBlock { block, instruction });
        }
        let inputs = if info.instructions[instruction].takes_rung {
            vec![self.expr(Type::BOOL, 2)]
        } else {
            info.inputs().map(|pin| self.expr(elementary(pin.repr()), 2)).collect()
        };
        Some(StatementKind::CallBlock { block, instruction, inputs })
    }
}

/// Which NaN an operation gives is the machine's choice: LIMIT makes it a number.
/// What holds an instance of a block is not copied.
fn holds_instance(arrays: &[Array], structs: &[Struct], ty: Type) -> bool {
    match ty {
        Type::Block(_) => true,
        Type::Struct(id) => {
            let structure = &structs[id.index()];
            let is_state = ["Fb", "Main"].contains(&structure.name.as_str());
            is_state || structure.fields.iter().any(|it| holds_instance(arrays, structs, it.ty))
        }
        Type::Array(id) => holds_instance(arrays, structs, arrays[id.index()].element),
        Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => false,
    }
}

fn without_nan(expr: Expr) -> Expr {
    let Type::Elementary(ty) = expr.ty else { return expr };
    if !ty.is_real() {
        return expr;
    }
    let (low, high) = if ty == Elementary::Real {
        (Value::F32(-1e30), Value::F32(1e30))
    } else {
        (Value::F64(-1e300), Value::F64(1e300))
    };
    let [low, high] = [low, high].map(|value| Expr::constant(ty, value, AT));
    // A NaN second operand of MAX is passed over.
    let raised = Expr::apply(Op::Max, expr.ty, vec![low, expr.clone()], AT);
    Expr::apply(Op::Min, expr.ty, vec![high, raised], AT)
}

/// Which bytes of the state belong to a variable: the rest is padding, where anything may be.
fn meaningful(program: &Program, layout: &Layout) -> Vec<bool> {
    let mut counts = vec![false; usize_of(layout.machine.size)];
    mark(program, layout, Type::Struct(program.globals), layout.machine.globals, &mut counts);
    for (instance, offset) in program.instances.iter().zip(&layout.machine.instances) {
        mark(program, layout, Type::Struct(program.class(instance.program).state), *offset, &mut counts);
    }
    counts
}

fn mark(program: &Program, layout: &Layout, ty: Type, offset: u64, counts: &mut [bool]) {
    let members = match ty {
        Type::Struct(id) => program.structure(id).fields.len(),
        Type::Block(id) => id.info().pins.len(),
        Type::Array(id) => {
            for at in 0..program.array(id).len() {
                mark(program, layout, program.array(id).element, offset + at * layout.stride(id), counts);
            }
            return;
        }
        Type::String(it) => {
            let size = 2 + usize::from(it.capacity) * usize_of(it.unit_size().into());
            return counts[usize_of(offset)..][..size].fill(true);
        }
        Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => {
            return counts[usize_of(offset)..][..usize_of(layout.size(ty))].fill(true);
        }
    };
    for at in (0..members).map(FieldId::next) {
        mark(program, layout, program.member(ty, at).unwrap(), offset + layout.offset(ty, at), counts);
    }
}

/// That the programs are not all trivial.
#[derive(Debug, Default)]
struct Tally {
    /// Scans.
    complete: u64,
    faulted: u64,
    /// Programs.
    endless: u64,
}

fn check(seed: u64, tally: &mut Tally) {
    let mut program = Maker::program(seed);
    // Some take all turns one by one.
    if !seed.is_multiple_of(3) {
        taking::settle(&mut program);
        verify::verify(&program).unwrap_or_else(|it| panic!("seed {seed}: {}", it[0]));
    }
    let mut native = Native::new(&program);
    let mut interpreter = Interpreter::new(&program);
    interpreter.set_budget(Some(BUDGET));
    assert_eq!(interpreter.state(), native.state(), "initial state, seed {seed}");
    let counts = meaningful(&program, &native.layout);
    for scan in 0..SCANS {
        for instance in 0..program.instances.len() {
            // Every other program has few turns for its loops.
            let few = seed / 2 % 64 + if seed.is_multiple_of(4) { Context::FREE_TURNS } else { 0 };
            let turns = if seed.is_multiple_of(2) { few } else { Context::TURNS };
            let [cx, native_cx] = [(); 2].map(|()| Context::new(scan * 10_000_000, scan == 0).with_turns(turns));
            let expected = interpreter.scan(instance, &cx);
            if expected == Err(Stop::OutOfSteps) {
                tally.endless += 1;
                return;
            }
            if expected.is_ok() {
                tally.complete += 1
            } else {
                tally.faulted += 1
            }
            let found = native.scan(instance, &native_cx);
            assert_eq!(expected, found.map_err(Stop::Fault), "seed {seed}, scan {scan}\n{}", print(&program));
            if expected.is_ok() {
                assert_eq!(cx, native_cx, "seed {seed}, scan {scan}: turns\n{}", print(&program));
            }
            let pairs = interpreter.state().iter().zip(native.state()).zip(&counts);
            if let Some(at) = pairs.into_iter().position(|((a, b), counts)| *counts && a != b) {
                panic!("seed {seed}, scan {scan}, byte {at} of {:?}\n{}", native.layout.machine, print(&program));
            }
        }
    }
}

#[test]
fn random_programs_agree_with_the_interpreter() {
    // STAUNCH_SEEDS=first..end runs others.
    let range = std::env::var("STAUNCH_SEEDS").unwrap_or(format!("0..{PROGRAMS}"));
    let (first, end) = range.split_once("..").unwrap();
    let seeds = first.parse::<u64>().unwrap()..end.parse().unwrap();
    // Every second seed on a thread of its own.
    let tallies: Vec<Tally> = std::thread::scope(|scope| {
        let half = |part: usize| seeds.clone().skip(part).step_by(2);
        let parts = [half(0), half(1)].map(|seeds| {
            scope.spawn(move || {
                let mut tally = Tally::default();
                seeds.for_each(|it| check(it, &mut tally));
                tally
            })
        });
        parts.into_iter().map(|it| it.join().unwrap()).collect()
    });
    let sum = |of: fn(&Tally) -> u64| tallies.iter().map(of).sum();
    let tally = Tally { complete: sum(|it| it.complete), faulted: sum(|it| it.faulted), endless: sum(|it| it.endless) };
    println!("{tally:?}");
    assert!(tally.complete > tally.faulted / 4 && tally.endless * 4 < seeds.end - seeds.start, "{tally:?}");
}
