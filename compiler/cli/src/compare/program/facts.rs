//! What a program's statements say of its inputs: the constants that each is compared with, and
//! whether it is compared with constants alone.
//!
//! Variables are told apart by their declarations. What is found for one holds for each.

use super::scalar::Way;
use super::walked::{Name, Walked};
use staunch_ir::{
    Argument, Block, Chars, Const, Conversion, Expr, ExprKind, FieldId, Mode, Op, ParamId, Place, Program, Projection,
    Root, Routine, RoutineId, Statement, StatementKind, Step, StructId, TextOp, Type, Value, visit,
};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Numbers that a variable is worth comparing with; reals keep their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers {
    pub integers: BTreeSet<i128>,
    pub reals: Vec<f64>,
}

#[derive(Debug, Default)]
pub struct Facts {
    near: HashMap<Name, Numbers>,
    /// Values of the first go to the second, as they are.
    flows: HashSet<(Name, Name)>,
    /// The texts that a string is compared with.
    texts: HashMap<Name, Vec<Chars>>,
    /// What is worth trying, and proves nothing: it is found by going back through what is computed.
    hints: HashMap<Name, Numbers>,
    /// Used in another way than compared with constants and handed on.
    computed: HashSet<Name>,
    /// By statements of others than the PROGRAM that holds it.
    written: HashSet<Name>,
    /// From the states of PROGRAMs and the globals.
    written_ways: HashSet<Way>,
    read: HashSet<Name>,
    /// Every constant of the program that is a whole number or a time.
    pub constants: BTreeSet<i128>,
    /// Every text of the program.
    pub all_texts: Vec<Chars>,
    /// Every time of the program, in nanoseconds.
    pub times: BTreeSet<i64>,
}

/// Assignments in a row, through which a limit of the last target is followed back.
const MAX_BACK: usize = 4;
/// Characters before those that are asked for.
const MAX_BEFORE: usize = 300;
/// Limits of one variable that are followed back.
const MAX_LIMITS: usize = 24;

impl Facts {
    pub fn of(program: &Program) -> Self {
        let mut facts = Self::default();
        let mut computed = Vec::new();
        for (at, routine) in program.routines.iter().enumerate() {
            let id = RoutineId::next(at);
            let mut walk = Walk { program, routine, id, facts: &mut facts, computed: Vec::new() };
            walk.block(&routine.body);
            computed.extend(walk.computed.into_iter().map(|(target, value)| (id, target, value)));
            routine.locals.iter().for_each(|it| facts.initial(Some(it.ty), &it.initial));
        }
        let fields = program.structs.iter().flat_map(|it| &it.fields);
        fields.for_each(|it| facts.initial(Some(it.ty), &it.initial));
        for (id, layout) in program.structs.iter().enumerate() {
            for (at, field) in layout.fields.iter().enumerate() {
                let name = Name::Field(StructId::next(id), FieldId::next(at));
                facts.unwritten(program, name, field.ty, &field.initial);
            }
        }
        facts.follow();
        for _ in 0..MAX_BACK {
            facts.go_back(program, &computed);
        }
        facts
    }

    /// The numbers that decide something about a variable.
    pub fn near(&self, name: Name) -> Numbers {
        self.near.get(&name).cloned().unwrap_or_default()
    }

    /// Those, and numbers for which what is computed of the variable comes near a limit.
    pub fn worth_trying(&self, name: Name) -> Numbers {
        let mut found = self.near(name);
        found.add_all(self.hints.get(&name).cloned().unwrap_or_default());
        found
    }

    pub fn texts(&self, name: Name) -> Vec<Chars> {
        self.texts.get(&name).cloned().unwrap_or_default()
    }

    /// Whether its value goes to another variable, as it is.
    pub fn is_handed_on(&self, name: Name) -> bool {
        self.flows.iter().any(|it| it.0 == name)
    }

    fn near_to_text(&mut self, name: Name, text: &Chars) -> bool {
        let known = self.texts.entry(name).or_default();
        let is_new = !known.contains(text);
        if is_new {
            known.push(text.clone());
        }
        is_new
    }

    /// Takes the limits of what is computed back to what it is computed from.
    fn go_back(&mut self, program: &Program, computed: &[(RoutineId, Name, &Expr)]) {
        let mut found = Self::default();
        for (id, target, value) in computed {
            let routine = program.routine(*id);
            let limits = self.worth_trying(*target);
            let integers = limits.integers.into_iter().map(Number::Integer);
            let limits: Vec<_> = integers.chain(limits.reals.into_iter().map(Number::Real)).take(MAX_LIMITS).collect();
            let texts = self.texts(*target);
            let mut walk = Walk { program, routine, id: *id, facts: &mut found, computed: Vec::new() };
            limits.iter().for_each(|it| walk.compared(value, *it));
            texts.iter().for_each(|it| walk.reaches(value, it));
        }
        // As they are: what is assigned, or handed to a call.
        for (from, to) in &self.flows {
            if let Some(more) = self.hints.get(to) {
                found.near.entry(*from).or_default().add_all(more.clone());
            }
        }
        for (name, numbers) in found.near {
            self.hints.entry(name).or_default().add_all(numbers);
        }
        for (name, texts) in found.texts {
            texts.iter().for_each(|it| _ = self.near_to_text(name, it));
        }
        for (from, to) in self.flows.clone() {
            self.texts(to).iter().for_each(|it| _ = self.near_to_text(from, it));
        }
    }

    /// Whether nothing but comparisons with those numbers depends on a variable's value.
    pub fn only_compared(&self, name: Name) -> bool {
        !self.computed.contains(&name)
    }

    /// Whether a statement writes a variable, or what it is in, or something in it.
    pub fn is_written(&self, name: Name, way: &Way) -> bool {
        self.written.contains(&name) || self.written_ways.iter().any(|it| it.meets(way))
    }

    /// Whether some statement writes the variable of this declaration, in whatever it is.
    fn is_written_somewhere(&self, name: Name) -> bool {
        let is_it = |way: &Way| match name {
            Name::Field(_, field) => way.members.contains(&field),
            Name::Local(..) | Name::Param(..) => false,
        };
        self.written.contains(&name) || self.written_ways.iter().any(is_it)
    }

    pub fn is_read(&self, name: Name) -> bool {
        self.read.contains(&name)
    }

    /// What is known of a variable is known of those whose values go to it.
    fn follow(&mut self) {
        let mut changed = true;
        while changed {
            changed = false;
            for (from, to) in self.flows.clone() {
                if self.computed.contains(&to) {
                    changed |= self.computed.insert(from);
                }
                let theirs = self.near(to);
                let ours = self.near.entry(from).or_default();
                let before = (ours.integers.len(), ours.reals.len());
                ours.add_all(theirs);
                changed |= before != (ours.integers.len(), ours.reals.len());
                for text in self.texts(to) {
                    changed |= self.near_to_text(from, &text);
                }
            }
        }
    }

    fn text(&mut self, text: &Chars) {
        if !self.all_texts.contains(text) {
            self.all_texts.push(text.clone());
        }
    }

    fn constant(&mut self, ty: Option<Type>, value: Value) {
        match value {
            Value::I64(time) if ty.and_then(Type::elementary).is_some_and(|it| it.is_time()) => {
                self.times.insert(time);
                self.constants.insert(i128::from(time));
            }
            Value::Bool(_) => {}
            other => self.constants.extend(other.as_integer()),
        }
    }

    fn initial(&mut self, ty: Option<Type>, value: &Const) {
        let pin = |at: usize| match ty {
            Some(Type::Block(id)) => id.pin_type(FieldId::next(at)),
            _ => None,
        };
        match value {
            Const::Scalar(it) => self.constant(ty, *it),
            Const::Zero | Const::Text(_) => {}
            Const::Array(runs) => runs.iter().for_each(|it| self.initial(None, &it.1)),
            Const::Struct(fields) => fields.iter().enumerate().for_each(|(at, it)| self.initial(pin(at), it)),
        }
    }

    /// What a variable holds that nothing writes is a constant of the program: what it is compared with is worth
    /// being that.
    fn unwritten(&mut self, program: &Program, name: Name, ty: Type, initial: &Const) {
        match (initial, ty) {
            (Const::Scalar(Value::Bool(_)) | Const::Zero, _) => {}
            (Const::Text(it), _) if !self.is_written_somewhere(name) => {
                self.near_to_text(name, it);
            }
            (Const::Text(_), _) => {}
            (Const::Scalar(it), _) if !self.is_written_somewhere(name) => self.near_to(name, *it),
            (Const::Scalar(_), _) => {}
            (Const::Array(runs), Type::Array(id)) => {
                let element = program.array(id).element;
                runs.iter().for_each(|it| self.unwritten(program, name, element, &it.1));
            }
            (Const::Struct(values), Type::Struct(id)) => {
                for (at, value) in values.iter().enumerate() {
                    let field = FieldId::next(at);
                    if let Some(ty) = program.member(ty, field) {
                        self.unwritten(program, Name::Field(id, field), ty, value);
                    }
                }
            }
            (Const::Array(_) | Const::Struct(_), _) => {}
        }
    }

    fn near_to(&mut self, name: Name, value: Value) {
        self.near.entry(name).or_default().add(value);
    }
}

impl Numbers {
    pub fn add(&mut self, value: Value) {
        match value {
            Value::F32(it) => self.add_real(f64::from(it)),
            Value::F64(it) => self.add_real(it),
            other => self.integers.extend(other.as_integer()),
        }
    }

    pub fn add_all(&mut self, more: Self) {
        self.integers.extend(more.integers);
        more.reals.into_iter().for_each(|it| self.add_real(it));
    }

    fn add_real(&mut self, number: f64) {
        if number.is_finite() && !self.reals.contains(&number) {
            self.reals.push(number);
            self.reals.sort_by(f64::total_cmp);
        }
    }
}

struct Walk<'p, 'f> {
    program: &'p Program,
    routine: &'p Routine,
    id: RoutineId,
    facts: &'f mut Facts,
    /// Variables, and what each is assigned that is more than another variable.
    computed: Vec<(Name, &'p Expr)>,
}

impl<'p> Walk<'p, '_> {
    /// The innermost declaration that a place is an element of; a pin of a block is none.
    fn name(&self, place: &Place) -> Option<Name> {
        Walked::of(self.program, (self.routine, self.id), place).variable()
    }

    /// The variable whose value an expression is, unchanged but for a wider type.
    fn variable(&self, expr: &Expr) -> Option<Name> {
        match &expr.kind {
            ExprKind::Load(place) => self.name(place),
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) if self.widens(inner.ty, expr.ty) => {
                self.variable(inner)
            }
            ExprKind::Convert(..)
            | ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..) => None,
        }
    }

    fn widens(&self, from: Type, to: Type) -> bool {
        if let (Some(from), Some(to)) = (from.string_type(), to.string_type()) {
            return from.wide == to.wide && from.capacity <= to.capacity;
        }
        let range = |ty| self.program.repr(ty).and_then(staunch_runtime::Repr::range);
        match (range(from), range(to)) {
            (Some(from), Some(to)) => to.0 <= from.0 && from.1 <= to.1,
            _ => from == to,
        }
    }

    fn block(&mut self, block: &'p Block) {
        let mut found = Vec::new();
        visit::statements(block, &mut |it| found.push(it));
        found.into_iter().for_each(|it| self.statement(it));
    }

    fn statement(&mut self, statement: &'p Statement) {
        visit::targets(statement, &mut |place| {
            self.note_written(place);
            self.indices(place);
        });
        match &statement.kind {
            StatementKind::Assign { target, value } => self.assign(self.name(target), value),
            StatementKind::Case { selector, arms, .. } => {
                for (low, high) in arms.iter().flat_map(|it| &it.labels) {
                    [*low, *high].into_iter().for_each(|it| self.compared(selector, Number::Integer(it)));
                }
                self.operand(selector);
            }
            StatementKind::If { condition, .. } => self.expr(condition),
            StatementKind::For(it) => {
                let step = if let Step::Variable(step) = &it.step { Some(step) } else { None };
                [Some(&it.first), Some(&it.last), step].into_iter().flatten().for_each(|it| self.expr(it));
            }
            StatementKind::Call { callee, arguments, result, .. } => {
                arguments.iter().enumerate().for_each(|(at, it)| self.argument(*callee, at, it));
                let returned = self.program.routine(*callee).result.map(|it| Name::Local(*callee, it));
                let target = result.as_ref().and_then(|it| self.name(it));
                self.facts.flows.extend(returned.zip(target));
            }
            StatementKind::CallBlock { inputs, .. } => inputs.iter().for_each(|it| self.expr(it)),
            StatementKind::Loop { .. }
            | StatementKind::Turn
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::External(_)
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Fault(_) => {}
        }
    }

    fn assign(&mut self, target: Option<Name>, value: &'p Expr) {
        match (self.variable(value), target) {
            (Some(from), Some(to)) => {
                self.facts.flows.insert((from, to));
                self.note_read(from);
                visit::reads(value, &mut |it| self.indices(it));
            }
            (_, target) => {
                self.computed.extend(target.map(|it| (it, value)));
                self.expr(value);
            }
        }
    }

    fn argument(&mut self, callee: RoutineId, at: usize, argument: &'p Argument) {
        let Some(param) = self.program.routine(callee).params.get(at) else { return };
        let name = match param.mode {
            Mode::Value(local) => Name::Local(callee, local),
            Mode::Reference => Name::Param(callee, ParamId::next(at)),
        };
        match argument {
            Argument::Value(value) => self.assign(Some(name), value),
            Argument::Reference(place) => {
                if let Some(own) = self.name(place) {
                    self.facts.flows.extend([(own, name), (name, own)]);
                    self.note_read(own);
                }
            }
        }
    }

    /// A statement writes a place, and with it all that is in it.
    fn note_written(&mut self, place: &Place) {
        match self.way(place) {
            Some(way) => {
                self.facts.written_ways.insert(way);
            }
            None => {
                let found = self.all_in(place);
                self.facts.written.extend(found);
            }
        }
    }

    /// The members down to a place, from the globals or the state of a PROGRAM.
    fn way(&self, place: &Place) -> Option<Way> {
        let is_program =
            |state: StructId| self.program.instances.iter().any(|it| self.program.class(it.program).state == state);
        let from = match place.root {
            Root::Globals => self.program.globals,
            Root::Instance => self.routine.state.filter(|it| is_program(*it))?,
            Root::Local(_) | Root::Param(_) => return None,
        };
        let mut members = Vec::new();
        for projection in &place.projections {
            match projection {
                Projection::Field(field) => members.push(*field),
                Projection::Index { .. } => {}
                Projection::Deref { .. } => return None,
            }
        }
        Some(Way { from, members })
    }

    fn note_read(&mut self, name: Name) {
        self.facts.read.insert(name);
    }

    /// What an array is indexed with is worth being at its ends, and beyond.
    fn indices(&mut self, place: &Place) {
        let mut ty = self.program.root_type(self.routine, place.root);
        for projection in &place.projections {
            ty = match (projection, ty) {
                (Projection::Field(field), Some(owner)) => self.program.member(owner, *field),
                (Projection::Index { index, .. }, Some(Type::Array(id))) => {
                    let array = self.program.array(id);
                    for edge in [array.low - 1, array.low, array.high, array.high.saturating_add(1)] {
                        self.compared(index, Number::Integer(i128::from(edge)));
                    }
                    self.expr(index);
                    Some(array.element)
                }
                (_, other) => other,
            };
        }
    }

    /// An expression whose value matters as a whole.
    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(value) => self.facts.constant(Some(expr.ty), *value),
            ExprKind::Text(text) => self.facts.text(text),
            ExprKind::Aggregate(value) => self.facts.initial(Some(expr.ty), value),
            ExprKind::AddressOf(place) => {
                self.indices(place);
                self.lent(place);
            }
            ExprKind::Load(place) => {
                self.indices(place);
                if let Some(name) = self.name(place) {
                    self.note_read(name);
                    self.facts.computed.insert(name);
                }
            }
            ExprKind::Apply(op, operands) => match operands.as_slice() {
                [a, b] if let (ExprKind::ApplyText(TextOp::Compare, texts), Some(_)) = (&a.kind, number(b)) => {
                    let is_exact = matches!(op, Op::Eq | Op::Ne);
                    self.texts(&texts[0], &texts[1], is_exact);
                    self.texts(&texts[1], &texts[0], is_exact);
                }
                [a, b] if compares(*op) => {
                    self.comparison(a, b);
                    self.comparison(b, a);
                }
                _ => {
                    for limit in operands.iter().filter_map(number) {
                        operands.iter().for_each(|it| self.compared(it, limit));
                    }
                    operands.iter().for_each(|it| self.expr(it));
                }
            },
            ExprKind::ApplyText(_, operands) => {
                operands.iter().for_each(|it| self.expr(it));
                self.together(operands);
            }
            ExprKind::Convert(_, inner) => self.expr(inner),
        }
    }

    /// What a text is sought in, or joined with, is worth being that text.
    fn together(&mut self, operands: &[Expr]) {
        for (at, operand) in operands.iter().enumerate() {
            let ExprKind::Text(text) = &operand.kind else { continue };
            let others = operands.iter().enumerate().filter(|it| it.0 != at);
            others.for_each(|it| self.reaches(it.1, text));
        }
    }

    /// Notes for which texts of its variables an expression is, or has in it, a text.
    fn reaches(&mut self, expr: &Expr, text: &Chars) {
        match &expr.kind {
            ExprKind::Load(place) => {
                if let Some(name) = self.name(place) {
                    self.facts.near_to_text(name, text);
                }
            }
            ExprKind::Convert(_, inner) => self.reaches(inner, text),
            ExprKind::ApplyText(TextOp::Mid, operands) => {
                let before = operands.last().and_then(Expr::as_const).and_then(Value::as_integer).unwrap_or(1) - 1;
                self.reaches(&operands[0], &text.after(few(before)));
            }
            ExprKind::ApplyText(TextOp::FromChar | TextOp::FromWchar, operands) => {
                if let (1, Some(unit)) = (text.len(), text.unit(0)) {
                    self.compared(&operands[0], Number::Integer(unit.into()));
                }
            }
            ExprKind::ApplyText(TextOp::Widen, operands) => {
                text.of_width(false).iter().for_each(|it| self.reaches(&operands[0], it));
            }
            ExprKind::ApplyText(TextOp::Narrow, operands) => {
                text.of_width(true).iter().for_each(|it| self.reaches(&operands[0], it));
            }
            ExprKind::ApplyText(_, operands) => operands.iter().for_each(|it| self.reaches(it, text)),
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..) => {}
        }
    }

    /// A number is a character of a text, after so many others.
    fn is_character(&mut self, op: TextOp, operands: &[Expr], limit: Number) {
        let Number::Integer(limit) = limit else { return };
        let before = match op {
            TextOp::CharAt | TextOp::WcharAt => {
                let at = operands.get(1).and_then(Expr::as_const).and_then(Value::as_integer);
                few(at.unwrap_or(0))
            }
            TextOp::ToChar | TextOp::ToWchar => 0,
            _ => return,
        };
        let text = match op {
            TextOp::WcharAt | TextOp::ToWchar => u16::try_from(limit).ok().map(|it| Chars::Wide(vec![it])),
            _ => u8::try_from(limit).ok().map(|it| Chars::Narrow(vec![it])),
        };
        if let (Some(text), Some(from)) = (text, operands.first()) {
            self.reaches(from, &text.after(before));
        }
    }

    /// What a reference leads to may be used in any way, and with it all that is in it.
    fn lent(&mut self, place: &Place) {
        let found = self.all_in(place);
        self.facts.read.extend(found.iter().copied());
        self.facts.written.extend(found.iter().copied());
        self.facts.computed.extend(found);
    }

    /// The variable that a place is a part of, and all that are in the place.
    fn all_in(&self, place: &Place) -> HashSet<Name> {
        let mut open: Vec<Type> = vec![place.ty];
        let mut found: HashSet<Name> = self.name(place).into_iter().collect();
        while let Some(ty) = open.pop() {
            match ty {
                Type::Array(id) => open.push(self.program.array(id).element),
                Type::Struct(id) => {
                    for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                        if found.insert(Name::Field(id, FieldId::next(at))) {
                            open.push(field.ty);
                        }
                    }
                }
                Type::Elementary(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Block(_)
                | Type::Reference(_) => {}
            }
        }
        found
    }

    /// A text as it is compared with another.
    fn texts(&mut self, a: &Expr, b: &Expr, is_exact: bool) {
        match (self.variable(a), &b.kind) {
            (Some(name), ExprKind::Text(text)) => {
                self.facts.near_to_text(name, text);
                if is_exact { self.operand(a) } else { self.expr(a) }
            }
            (name, other) => {
                self.facts.flows.extend(name.zip(self.variable(b)));
                self.expr(a);
                if let ExprKind::Text(text) = other {
                    self.reaches(a, text);
                }
            }
        }
    }

    /// `a` as it is compared with `b`.
    fn comparison(&mut self, a: &Expr, b: &Expr) {
        match number(b) {
            Some(limit) => {
                self.compared(a, limit);
                self.operand(a);
            }
            None => {
                if let (Some(x), Some(y)) = (self.variable(a), self.variable(b)) {
                    self.facts.flows.insert((x, y));
                }
                self.expr(a);
            }
        }
    }

    /// An operand of which only a comparison with a constant is seen.
    fn operand(&mut self, expr: &Expr) {
        match self.variable(expr) {
            Some(name) => {
                self.note_read(name);
                visit::reads(expr, &mut |it| self.indices(it));
            }
            None => self.expr(expr),
        }
    }

    /// Notes for which values of its variables an expression comes near a limit.
    fn compared(&mut self, expr: &Expr, limit: Number) {
        match &expr.kind {
            ExprKind::Load(place) => {
                if let (Some(name), Some(value)) = (self.name(place), limit.value()) {
                    self.facts.near_to(name, value);
                }
            }
            ExprKind::Convert(_, inner) => self.compared(inner, limit.of_type(self.program, inner.ty)),
            ExprKind::Apply(op, operands) => {
                for (at, operand) in operands.iter().enumerate() {
                    let other = operands.get(1 - at.min(1)).and_then(number);
                    for limit in limit.before(*op, at, other) {
                        self.compared(operand, limit);
                    }
                }
            }
            ExprKind::ApplyText(op, operands) => self.is_character(*op, operands, limit),
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) | ExprKind::AddressOf(_) => {}
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Number {
    Integer(i128),
    Real(f64),
}

impl Number {
    fn value(self) -> Option<Value> {
        match self {
            Self::Integer(it) => i64::try_from(it).map(Value::I64).or_else(|_| it.try_into().map(Value::U64)).ok(),
            Self::Real(it) => Some(Value::F64(it)),
        }
    }

    fn of_type(self, program: &Program, ty: Type) -> Self {
        let real = program.repr(ty).is_some_and(staunch_runtime::Repr::is_float);
        match (self, real) {
            (Self::Integer(it), true) => Self::Real(real_of(it)),
            (Self::Real(it), false) => Self::Integer(whole(it)),
            (same, _) => same,
        }
    }

    /// What an operand is near to where the operation's result is near to this.
    fn before(self, op: Op, at: usize, other: Option<Self>) -> Vec<Self> {
        match (self, other) {
            (Self::Integer(limit), Some(Self::Integer(other))) => {
                integers_before(op, at, limit, other).into_iter().map(Self::Integer).collect()
            }
            (Self::Real(limit), Some(Self::Real(other))) => {
                reals_before(op, at, limit, other).into_iter().map(Self::Real).collect()
            }
            (same, _) => vec![same],
        }
    }
}

fn integers_before(op: Op, at: usize, limit: i128, other: i128) -> Vec<i128> {
    // A quotient is the same for several dividends; a product is near for the factors around.
    let (exact, width) = match (op, at) {
        (Op::Add, _) => (limit.checked_sub(other), 1),
        (Op::Sub, 0) => (limit.checked_add(other), 1),
        (Op::Sub, _) => (other.checked_sub(limit), 1),
        (Op::Mul, _) => (limit.checked_div(other), 2),
        (Op::Div, 0) => (limit.checked_mul(other), other),
        _ => (Some(limit), 1),
    };
    exact.into_iter().flat_map(|it| [it, it.saturating_add(width.saturating_sub(1))]).collect()
}

fn reals_before(op: Op, at: usize, limit: f64, other: f64) -> Vec<f64> {
    vec![match (op, at) {
        (Op::Add, _) => limit - other,
        (Op::Sub, 0) => limit + other,
        (Op::Sub, _) => other - limit,
        (Op::Mul, _) => limit / other,
        (Op::Div, 0) => limit * other,
        _ => limit,
    }]
}

fn number(expr: &Expr) -> Option<Number> {
    match expr.as_const()? {
        Value::F32(it) => Some(Number::Real(f64::from(it))),
        Value::F64(it) => Some(Number::Real(it)),
        Value::Bool(_) => None,
        other => other.as_integer().map(Number::Integer),
    }
}

/// Characters before others: of far ones a string is too short.
fn few(count: i128) -> usize {
    usize::try_from(count).unwrap_or(0).min(MAX_BEFORE)
}

fn compares(op: Op) -> bool {
    matches!(op, Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne)
}

/// The nearest real: a limit need not be exact to be near.
fn real_of(number: i128) -> f64 {
    number.to_string().parse().unwrap_or(0.0)
}

/// The whole part of a real, or 0 where it is none.
fn whole(number: f64) -> i128 {
    format!("{:.0}", number.trunc()).parse().unwrap_or(0)
}
