//! The order of evaluation: what is written first is evaluated first, and once. An expression that
//! comes out the same where the IR evaluates it stays there; any other is saved where it is written.

use super::checker::Checker;
use super::coverage::is_decision;
use staunch_ir::alias::{self, Frame};
use staunch_ir::faults::{Faults, op_faults};
use staunch_ir::loops::Known;
use staunch_ir::reference::followed;
use staunch_ir::{
    ArrayId, Conversion, Elementary, Expr, ExprKind, Local, LocalId, Location, Op, Place, Projection, Root, Statement,
    Type, Value,
};
use staunch_ir::{Part, Use};

/// What is evaluated where it is written, and used later.
#[derive(Clone, Debug)]
pub(crate) enum Held {
    Value(Expr),
    /// The variable itself: its indices are evaluated and checked.
    Place(Place),
}

/// When a statement of a call evaluates a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Turn {
    /// Places come first: the instance's, those of copies and of assignments.
    Place,
    /// What is passed, by its parameter; what is stored.
    Value(usize),
}

/// A part of a call, and where the call's statements evaluate it.
#[derive(Clone, Debug)]
pub(crate) struct Written {
    pub held: Held,
    /// The first statement that evaluates it, and its turn there.
    pub first: (usize, Turn),
    /// The last one.
    pub last: usize,
}

impl Written {
    pub fn new(held: Held) -> Self {
        Self { held, first: (0, Turn::Place), last: 0 }
    }

    pub fn value(&self) -> Option<&Expr> {
        match &self.held {
            Held::Value(value) => Some(value),
            Held::Place(_) => None,
        }
    }

    pub fn place(&self) -> Option<&Place> {
        match &self.held {
            Held::Place(place) => Some(place),
            Held::Value(_) => None,
        }
    }
}

impl Checker<'_, '_> {
    /// A local that the source does not name.
    pub(crate) fn temporary(&mut self, name: &str, ty: Type) -> Place {
        let id = LocalId::next(self.locals.len());
        let initial = self.decl.least(ty);
        self.locals.push(Local { name: name.to_owned(), ty, initial, doc: None });
        Place::local(id, ty)
    }

    /// Runs `next`. Its hoisted statements run before the expression that it is in, so of the values
    /// evaluated before, those are saved that would be different after it.
    pub(crate) fn after<T>(&mut self, done: &mut [&mut Expr], next: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let mark = self.block.len();
        let result = next(self);
        let hoisted = self.block.split_off(mark);
        if !hoisted.is_empty() {
            for expr in done {
                if self.changes(&hoisted, expr) {
                    self.decl.program.uses.note(Use::Part(Part::EvaluationOrder), expr.at);
                }
                self.save_parts(expr, &|this, it| this.can_fault(it) || this.changes(&hoisted, it));
            }
        }
        self.block.extend(hoisted);
        result
    }

    /// As [`after`](Self::after), for a place that was evaluated before.
    pub(crate) fn after_place<T>(&mut self, place: &mut Place, next: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        let mark = self.block.len();
        let result = next(self);
        let hoisted = self.block.split_off(mark);
        if !hoisted.is_empty() {
            self.freeze(place, &hoisted, true);
        }
        self.block.extend(hoisted);
        result
    }

    /// As [`after`](Self::after), for the parts of a call that are written before.
    pub(crate) fn after_parts<T>(
        &mut self,
        parts: &mut [Written],
        next: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        let mark = self.block.len();
        let result = next(self);
        let hoisted = self.block.split_off(mark);
        if !hoisted.is_empty() {
            for part in parts {
                self.hold(&mut part.held, &hoisted, true);
            }
        }
        self.block.extend(hoisted);
        result
    }

    /// Saves those parts of a call which its statements would evaluate too late: after a fault that
    /// is written later, or after a write to what they read.
    pub(crate) fn settle(&mut self, parts: &mut [Written], call: &[Statement]) {
        let faults: Vec<bool> = parts.iter().map(|it| self.held_can_fault(&it.held)).collect();
        let late = |at: usize| {
            let part: &Written = &parts[at];
            let overtaken = (at + 1..parts.len()).any(|it| faults[it] && parts[it].first < part.first);
            part.first.0 > 0 || overtaken || self.held_changes(&call[..part.last], &part.held)
        };
        let early = (0..parts.len()).rev().find(|at| faults[*at] && late(*at));
        for (at, part) in parts.iter_mut().enumerate() {
            let fault_first = early.is_some_and(|early| at <= early);
            self.hold(&mut part.held, &call[..part.last], fault_first);
        }
    }

    /// Saves what `effects` change, and what can fault where its fault comes before them.
    pub(crate) fn hold(&mut self, held: &mut Held, effects: &[Statement], fault_first: bool) {
        match held {
            Held::Value(value) => {
                if fault_first && self.can_fault(value) || self.changes(effects, value) {
                    self.save("argument", value);
                }
            }
            Held::Place(place) => self.freeze(place, effects, fault_first),
        }
    }

    /// Where a reference leads is looked at when the value is known. An assignment finds a standard block's pin, and
    /// what it copies whole, before: of a value for these that is saved which can fault, and indices of what is
    /// copied.
    pub(crate) fn before_target(&mut self, target: &Place, value: &mut Expr) {
        if !target.is_followed() || !self.can_fault(value) {
            return;
        }
        match (&mut value.kind, target.ty) {
            (ExprKind::Load(place), Type::Array(_) | Type::Struct(_)) => self.freeze(place, &[], true),
            _ if followed(&self.decl.program, target).is_some_and(|it| it.pin.is_some()) => {
                self.save("assigned", value)
            }
            _ => {}
        }
    }

    /// Saves indices of a place, each checked against its bounds.
    pub(crate) fn freeze(&mut self, place: &mut Place, effects: &[Statement], fault_first: bool) {
        self.save_indices(place, &|this, index, faults| fault_first && faults || this.changes(effects, index));
    }

    /// Saves each index that is not a constant: the place stays what it is, whatever runs after this.
    pub(crate) fn fix(&mut self, place: &mut Place) {
        self.save_indices(place, &|_, index, _| index.as_const().is_none());
    }

    /// Saves the indices that `asked` accepts; it gets whether they can fault. Their locals are of a
    /// subrange with the array's bounds, so that nothing checks them again.
    fn save_indices(&mut self, place: &mut Place, asked: &dyn Fn(&Self, &Expr, bool) -> bool) {
        self.save_pointer(place, asked);
        let Some(mut ty) = self.root_type(place.root) else { return };
        let mut bounds = self.bounds_of(place.root).into_iter();
        for projection in &mut place.projections {
            ty = match (projection, ty) {
                (Projection::Index { index, at }, Type::Array(id)) => {
                    let bounds = bounds.next();
                    let inside = self.is_inside(index, id);
                    if asked(self, index, !inside || self.can_fault(index)) {
                        if !inside {
                            self.check_index(index, id, bounds, *at);
                        }
                        self.save("index", index);
                        index.ty = index.ty.read();
                    }
                    self.decl.program.array(id).element
                }
                (Projection::Field(field), ty) => match self.decl.program.member(ty, *field) {
                    Some(member) => member,
                    None => return,
                },
                (Projection::Deref { target, .. }, _) => *target,
                (Projection::Index { .. }, _) => return,
            };
        }
    }

    /// Saves the last reference on the way to a place, so that the place stays what it is.
    fn save_pointer(&mut self, place: &mut Place, asked: &dyn Fn(&Self, &Expr, bool) -> bool) {
        let Some(position) = place.projections.iter().rposition(|it| matches!(it, Projection::Deref { .. })) else {
            return;
        };
        let Projection::Deref { reference, at, .. } = place.projections[position] else { return };
        let mut pointer = Expr::load(place.before(position, reference), at);
        let faults = self.can_fault(&pointer);
        if asked(self, &pointer, faults) {
            self.save("pointer", &mut pointer);
            let ExprKind::Load(saved) = pointer.kind else { return };
            let way = place.projections.split_off(position);
            *place = Place { root: saved.root, projections: way, ty: place.ty };
        }
    }

    /// An index that faults outside of the array's bounds; those of an `ARRAY[*]` are in locals.
    fn check_index(&mut self, index: &mut Expr, id: ArrayId, bounds: Option<(LocalId, LocalId)>, at: Location) {
        let array = self.decl.program.array(id);
        if let (Some((low, high)), true) = (bounds, array.is_open()) {
            let bound = |local| {
                let bound = Expr::load(Place::local(local, Type::DINT), at);
                Expr::convert(Conversion::Value, Type::LINT, bound, at)
            };
            let unchecked = std::mem::replace(index, bound(low));
            *index = Expr::apply(Op::CheckIndex, Type::LINT, vec![bound(low), unchecked, bound(high)], at);
            return;
        }
        let bound = |it| Expr::constant(Elementary::Lint, Value::I64(it), at);
        let (low, high) = (bound(array.low), bound(array.high));
        let checked = Type::Subrange(Elementary::Lint, self.decl.intern_bounds((array.low.into(), array.high.into())));
        let unchecked = std::mem::replace(index, bound(array.low));
        *index = Expr::apply(Op::CheckIndex, checked, vec![low, unchecked, high], at);
    }

    /// Replaces an expression by a local that holds its value from here on.
    pub(crate) fn save(&mut self, name: &str, expr: &mut Expr) {
        let at = expr.at;
        let place = self.temporary(name, expr.ty);
        let value = std::mem::replace(expr, Expr::load(place.clone(), at));
        if self.is_covered {
            self.count_value(&value);
        }
        self.block.push(Statement::assign(place, value, at));
    }

    /// Saves what is `asked` for: the expression, or, where it is a decision that is counted, those of its conditions, so that it
    /// stays one decision.
    pub(crate) fn save_parts(&mut self, expr: &mut Expr, asked: &dyn Fn(&Self, &Expr) -> bool) {
        if self.is_covered
            && is_decision(expr)
            && let ExprKind::Apply(_, operands) = &mut expr.kind
        {
            operands.iter_mut().for_each(|it| self.save_parts(it, asked));
        } else if asked(self, expr) {
            self.save("saved", expr);
        }
    }

    fn held_can_fault(&self, held: &Held) -> bool {
        match held {
            Held::Value(value) => self.can_fault(value),
            Held::Place(place) => self.place_can_fault(place),
        }
    }

    pub(crate) fn held_changes(&self, effects: &[Statement], held: &Held) -> bool {
        match held {
            Held::Value(value) => self.changes(effects, value),
            Held::Place(place) => {
                place.indices().any(|it| self.changes(effects, it))
                    || place.is_followed() && self.changes(effects, &Expr::load(place.clone(), Location::default()))
            }
        }
    }

    /// Whether running `effects` may change the value of `expr`.
    fn changes(&self, effects: &[Statement], expr: &Expr) -> bool {
        alias::changes(&self.frame(), effects, expr)
    }

    /// What the places of this body are places of.
    pub(crate) fn frame(&self) -> Frame<'_> {
        let signature = self.signature.as_deref();
        Frame {
            program: &self.decl.program,
            state: signature.and_then(|it| it.state),
            params: signature.map_or(&[], |it| it.params.as_slice()),
        }
    }

    pub(crate) fn can_fault(&self, expr: &Expr) -> bool {
        self.asked(&|faults| faults.expr(expr))
    }

    fn place_can_fault(&self, place: &Place) -> bool {
        self.asked(&|faults| faults.place(place))
    }

    /// What is known of faults here.
    fn asked(&self, question: &dyn Fn(Faults<'_>) -> bool) -> bool {
        question(Faults {
            program: &self.decl.program,
            root_type: &|root| self.root_type(root),
            is_within: &|index, array| array.is_none_or(|it| self.is_inside(index, it)),
            operation: &op_faults,
        })
    }

    /// Whether an index is known to lie within the array's bounds.
    fn is_inside(&self, index: &Expr, array: ArrayId) -> bool {
        let loops: Vec<_> = self.counters.iter().map(|it| &it.head).filter(|it| it.is_private).collect();
        let checked = |id: LocalId| matches!(self.locals[id.index()].ty, Type::Subrange(..));
        Known { program: &self.decl.program, loops: &loops, checked: &checked, seen: &[] }.is_within(index, array)
    }

    pub(crate) fn root_type(&self, root: Root) -> Option<Type> {
        match root {
            Root::Local(id) => self.locals.get(id.index()).map(|it| it.ty),
            Root::Instance | Root::Globals | Root::Param(_) => self.frame().root_type(root),
        }
    }
}
