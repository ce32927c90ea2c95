//! What is known of variables at one place of the statements.

use super::names::Names;
use staunch_ir::interval::{Interval, Range, result};
use staunch_ir::{Conversion, Expr, ExprKind, FieldId, Op, Place, Projection, Root, RoutineId, TextOp, Type, Value};
use std::collections::HashMap;

/// A variable without a subscript on the way, in one routine.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    pub root: Root,
    pub fields: Vec<FieldId>,
}

impl Key {
    /// Of what only places with the same root lead to: the variables of a routine and of its instance, and globals that stand
    /// alone.
    pub fn of(place: &Place) -> Option<Self> {
        let fields: Vec<FieldId> = members(place).collect::<Option<_>>()?;
        match place.root {
            Root::Instance | Root::Local(_) => {}
            Root::Globals if fields.len() == 1 => {}
            Root::Globals | Root::Param(_) => return None,
        }
        Some(Self { root: place.root, fields })
    }

    /// Whether it is a part of what a place leads to, or that of it.
    fn meets(&self, place: &Place) -> bool {
        self.root == place.root && meet(self.fields.iter().copied().map(Some), members(place))
    }
}

/// The member that each step from the root leads to; `None` where it may be any.
fn members(place: &Place) -> impl Iterator<Item = Option<FieldId>> {
    place.projections.iter().map(|it| match it {
        Projection::Field(id) => Some(*id),
        Projection::Index { .. } | Projection::Deref { .. } => None,
    })
}

/// Whether two ways from a root may lead to the same, or one to a part of what the other leads to.
fn meet(a: impl Iterator<Item = Option<FieldId>>, b: impl Iterator<Item = Option<FieldId>>) -> bool {
    a.zip(b).all(|(a, b)| a.zip(b).is_none_or(|(a, b)| a == b))
}

/// Whether two places may share storage. Members of one variable are distinguished by their names alone.
pub fn may_share(a: &Place, b: &Place) -> bool {
    if a.root != b.root {
        // A part of a global may be the instance, or a part of it.
        return is_far(a) && b.root == Root::Instance || is_far(b) && a.root == Root::Instance;
    }
    meet(members(a), members(b))
}

/// What is known where a statement begins.
#[derive(Clone, Debug)]
pub struct Known<'n, 'p> {
    pub names: &'n Names<'p>,
    pub routine: RoutineId,
    found: HashMap<Key, Interval>,
}

impl<'n, 'p> Known<'n, 'p> {
    pub fn new(names: &'n Names<'p>, routine: RoutineId) -> Self {
        Self { names, routine, found: HashMap::new() }
    }

    /// The numbers of a type; `None` where it has no whole numbers.
    pub fn whole(&self, ty: Type) -> Option<Range> {
        self.names.whole(ty)
    }

    /// What an expression of whole numbers may be.
    pub fn of(&self, expr: &Expr) -> Option<Interval> {
        let whole = self.whole(expr.ty)?;
        let found = match &expr.kind {
            ExprKind::Const(value) => value.as_integer().map(Interval::only),
            ExprKind::Load(place) => Some(self.of_place(place, whole)),
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => self.of(inner),
            ExprKind::Apply(Op::Sel, operands) => match operands.as_slice() {
                [_, a, b] => self.of(a).zip(self.of(b)).map(|(a, b)| a.or(b)),
                _ => None,
            },
            ExprKind::Apply(Op::CheckIndex | Op::InRange, operands) => match operands.as_slice() {
                // It faults else.
                [low, it, high] => self.of(it).and_then(|it| it.and((self.of(low)?.range.0, self.of(high)?.range.1))),
                _ => None,
            },
            ExprKind::Apply(op, operands) => {
                let op = self.standard(*op, operands);
                self.all(operands).and_then(|it| result(op, &it))
            }
            ExprKind::ApplyText(TextOp::Len, operands) => match operands.as_slice() {
                [Expr { kind: ExprKind::Load(place), ty: Type::String(ty), .. }] if !place.is_followed() => {
                    Some(Interval::new((0, ty.capacity.into())))
                }
                _ => None,
            },
            ExprKind::Convert(..)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::ApplyText(..) => None,
        };
        // What leaves the type wraps, and may be anything.
        Some(found.filter(|it| it.lies_in(whole)).unwrap_or(Interval::new(whole)))
    }

    /// What each of them may be.
    pub fn all(&self, operands: &[Expr]) -> Option<Vec<Interval>> {
        operands.iter().map(|it| self.of(it)).collect()
    }

    /// The standard's operation, where one of a system's own does the same with these operands.
    pub fn standard(&self, op: Op, operands: &[Expr]) -> Op {
        let divides = || matches!(operands, [_, by] if self.of(by).is_some_and(|it| it.is_not_zero));
        let is_in_order = || match operands {
            [low, _, high] => self.of(low).zip(self.of(high)).is_some_and(|(a, b)| a.range.1 <= b.range.0),
            _ => false,
        };
        match op {
            Op::DivOrZero if divides() => Op::Div,
            Op::ModOrZero if divides() => Op::Mod,
            Op::LimitLow | Op::LimitFirst | Op::LimitInOrder if is_in_order() => Op::Limit,
            other => other,
        }
    }

    fn of_place(&self, place: &Place, whole: Range) -> Interval {
        let here = Key::of(place).and_then(|it| self.found.get(&it)).copied();
        here.unwrap_or_else(|| {
            Interval::new(
                self.names
                    .of_place(self.routine, place)
                    .filter(|it| Interval::new(*it).lies_in(whole))
                    .unwrap_or(whole),
            )
        })
    }

    /// A place has been given something.
    pub fn give(&mut self, place: &Place, value: Option<Interval>) {
        self.forget(place);
        if let (Some(key), Some(value)) = (Key::of(place), value) {
            self.found.insert(key, value);
        }
    }

    /// A place, and with it all that it is a part of, may have been written.
    pub fn forget(&mut self, place: &Place) {
        let is_reached = place.is_followed() || matches!(place.root, Root::Param(_));
        let is_far = is_far(place);
        match (is_reached, is_far) {
            (true, _) => self.found.clear(),
            // It may be a part of the instance.
            (false, true) => self.found.retain(|it, _| it.root != Root::Instance && !it.meets(place)),
            (false, false) => self.found.retain(|it, _| !it.meets(place)),
        }
    }

    /// Anything may have been written.
    pub fn forget_all(&mut self) {
        self.found.clear();
    }

    /// What is known where two ways meet.
    #[must_use]
    pub fn or(mut self, other: &Self) -> Self {
        self.found.retain(|key, value| match other.found.get(key) {
            Some(theirs) => {
                *value = value.or(*theirs);
                true
            }
            None => false,
        });
        self
    }

    /// Whether a condition is always or never met; and what else is known where it is, or is not. `None` where that is never.
    pub fn when(&self, condition: &Expr, holds: bool) -> Option<Self> {
        let ExprKind::Apply(op, operands) = &condition.kind else {
            return match condition.as_const() {
                Some(Value::Bool(it)) if it != holds => None,
                _ => Some(self.clone()),
            };
        };
        match (op, operands.as_slice()) {
            (Op::Not, [inner]) => self.when(inner, !holds),
            (Op::And, all) if holds => all.iter().try_fold(self.clone(), |known, it| known.when(it, true)),
            (Op::Or, all) if !holds => all.iter().try_fold(self.clone(), |known, it| known.when(it, false)),
            (Op::And | Op::Or, all) => {
                let ways = all.iter().filter_map(|it| self.when(it, holds));
                ways.reduce(|a, b| a.or(&b))
            }
            (op, [a, b]) => match compared(*op, holds) {
                Some(op) => self.compared(op, a, b).and_then(|it| it.compared(mirrored(op), b, a)),
                None => Some(self.clone()),
            },
            _ => Some(self.clone()),
        }
    }

    /// Where `a` is to `b` as a comparison says.
    fn compared(&self, op: Op, a: &Expr, b: &Expr) -> Option<Self> {
        let (Some(own), Some(other)) = (self.of(a), self.of(b)) else { return Some(self.clone()) };
        let (least, greatest) = (i128::MIN, i128::MAX);
        let new = match op {
            Op::Lt => own.and((least, other.range.1 - 1)),
            Op::Le => own.and((least, other.range.1)),
            Op::Gt => own.and((other.range.0 + 1, greatest)),
            Op::Ge => own.and((other.range.0, greatest)),
            Op::Eq => own.and(other.range).and_then(|it| if other.is_not_zero { it.without_zero() } else { Some(it) }),
            _ if other.number() == Some(0) => own.without_zero(),
            _ => match other.number() {
                Some(it) if own.range.0 == it => own.and((it + 1, greatest)),
                Some(it) if own.range.1 == it => own.and((least, it - 1)),
                _ => Some(own),
            },
        }?;
        let mut known = self.clone();
        if let Some(key) = self.read(a) {
            known.found.insert(key, new);
        }
        Some(known)
    }

    /// The variable whose number an expression is.
    fn read(&self, expr: &Expr) -> Option<Key> {
        match &expr.kind {
            ExprKind::Load(place) => Key::of(place),
            ExprKind::Convert(Conversion::Same | Conversion::Value, inner) => {
                let whole = self.whole(expr.ty)?;
                self.of(inner).filter(|it| it.lies_in(whole)).and_then(|_| self.read(inner))
            }
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => None,
        }
    }

    /// Where a selector is one of an arm's labels.
    pub fn selected(&self, selector: &Expr, labels: &[Range]) -> Option<Self> {
        let Some(own) = self.of(selector) else { return Some(self.clone()) };
        let found = labels.iter().filter_map(|it| own.and(*it)).reduce(Interval::or)?;
        let mut known = self.clone();
        if let Some(key) = self.read(selector) {
            known.found.insert(key, found);
        }
        Some(known)
    }
}

/// Whether a place is a part of a global, or has parts: it may be the instance whose statements these are, or a part of it.
pub fn is_far(place: &Place) -> bool {
    let has_parts = matches!(place.ty, Type::Struct(_) | Type::Array(_));
    place.root == Root::Globals && (has_parts || place.projections.len() > 1)
}

/// The comparison that holds where one does, or does not.
fn compared(op: Op, holds: bool) -> Option<Op> {
    let not = match op {
        Op::Lt => Op::Ge,
        Op::Le => Op::Gt,
        Op::Gt => Op::Le,
        Op::Ge => Op::Lt,
        Op::Eq => Op::Ne,
        Op::Ne => Op::Eq,
        _ => return None,
    };
    Some(if holds { op } else { not })
}

fn mirrored(op: Op) -> Op {
    match op {
        Op::Lt => Op::Gt,
        Op::Le => Op::Ge,
        Op::Gt => Op::Lt,
        Op::Ge => Op::Le,
        other => other,
    }
}
