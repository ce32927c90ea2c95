//! Loops that shift a bit string by eight bits, and add a constant for each bit that leaves it: the inner loop of a cyclic redundancy
//! check. What eight turns do is the shift by a byte, and a number that depends on the byte that leaves: one of 256.
//!
//! ```text
//! FOR k := 1 TO 8 DO
//!     IF crc.0 THEN crc := SHR(crc, 1) XOR 16#A001;      crc := SHR(crc, 8) XOR added[crc AND 255];
//!     ELSE crc := SHR(crc, 1); END_IF
//! END_FOR
//! ```
//!
//! A turn is affine over the field of two elements if its bits are sums, by XOR, of constants and of bits of the bit string: then
//! what it does to a sum is the sum of what it does to the parts, and of a constant. That follows from the operations; that the bits that stay are
//! shifted by eight is tried with each of them.

use crate::evaluate::{Storage, scalar};
use crate::{
    Block, Chars, Conversion, Expr, ExprKind, For, Op, Place, Repr, Statement, StatementKind, Step, Taking, Type, Value,
};
use staunch_runtime::{Fault, FaultKind};

/// So many turns shift a byte out.
const TURNS: i128 = 8;

/// What all turns of a loop do.
#[derive(Clone, Debug)]
pub struct Shifted<'a> {
    pub register: &'a Place,
    pub repr: Repr,
    /// Whether the bits move toward the highest one.
    pub is_up: bool,
    /// What the byte that leaves adds to the shifted bits.
    pub added: Vec<u64>,
}

/// What the turns of a loop do, if it is such a loop.
pub fn shifted(it: &For) -> Option<Shifted<'_>> {
    let [first, last] = [&it.first, &it.last].map(|it| it.as_const().and_then(Value::as_integer));
    let Step::Constant(step) = it.step else { return None };
    let is_of_eight = last? - first? == (TURNS - 1) * step;
    let is_plain = it.is_private && matches!(it.taking, Taking::Each) && !it.may_leave_range();
    let [Statement { kind: StatementKind::If { condition, then, otherwise }, .. }] = it.body.as_slice() else {
        return None;
    };
    let turn = Turn::of(condition, then, otherwise).filter(|_| is_of_eight && is_plain)?;
    turn.is_affine()?.then_some(())?;
    let width = turn.repr.size() * 8;
    let constant = turn.all(0)?;
    let goes = |bit: u32, to: u32| turn.all(1 << bit).is_some_and(|it| it ^ constant == 1 << to);
    let is_down = (8..width).all(|it| goes(it, it - 8));
    let is_up = !is_down && (0..width - 8).all(|it| goes(it, it + 8));
    let shift = if is_up { width - 8 } else { 0 };
    let added = (0..256).map(|byte| turn.all(byte << shift)).collect::<Option<_>>()?;
    (is_down || is_up).then_some(Shifted { register: turn.register, repr: turn.repr, is_up, added })
}

struct Turn<'a> {
    register: &'a Place,
    repr: Repr,
    condition: &'a Expr,
    ways: [&'a Block; 2],
}

impl<'a> Turn<'a> {
    fn of(condition: &'a Expr, then: &'a Block, otherwise: &'a Block) -> Option<Self> {
        let StatementKind::Assign { target: register, .. } = &then.first()?.kind else { return None };
        let Type::Elementary(ty) = register.ty else { return None };
        let is_bits = matches!(ty.repr(), Repr::U8 | Repr::U16 | Repr::U32 | Repr::U64);
        is_bits.then_some(Self { register, repr: ty.repr(), condition, ways: [then, otherwise] })
    }

    /// Whether a turn is; `None` where something cannot be evaluated.
    fn is_affine(&self) -> Option<bool> {
        let mut are_plain = true;
        for statement in self.ways.into_iter().flatten() {
            let StatementKind::Assign { target, value } = &statement.kind else { return Some(false) };
            are_plain &= target.is_same_variable(self.register) && self.is_sum(value);
        }
        if !are_plain || !self.is_of_one_bit(self.condition)? {
            return Some(false);
        }
        // The two ways differ by a constant.
        let constants = [self.way(0, 0)?, self.way(1, 0)?];
        for bit in self.bits() {
            let moved = [self.way(0, bit)? ^ constants[0], self.way(1, bit)? ^ constants[1]];
            if moved[0] != moved[1] {
                return Some(false);
            }
        }
        Some(true)
    }

    fn bits(&self) -> impl Iterator<Item = u64> + use<> {
        (0..self.repr.size() * 8).map(|it| 1 << it)
    }

    /// Whether each bit of an expression is a sum of bits of the register and a constant.
    fn is_sum(&self, expr: &Expr) -> bool {
        let is_constant = |it: &Expr| it.as_const().is_some();
        match &expr.kind {
            ExprKind::Const(_) => true,
            ExprKind::Load(place) => place.is_same_variable(self.register),
            ExprKind::Convert(how, operand) => self.is_sum(operand) && keeps_bits(*how, operand.ty, expr.ty),
            ExprKind::Apply(Op::Xor, operands) => operands.iter().all(|it| self.is_sum(it)),
            ExprKind::Apply(Op::Not, operands) => self.is_sum(&operands[0]),
            ExprKind::Apply(Op::And, operands) => {
                operands.iter().all(|it| self.is_sum(it)) && operands.iter().any(is_constant)
            }
            ExprKind::Apply(Op::Shl | Op::Shr, operands) => self.is_sum(&operands[0]) && is_constant(&operands[1]),
            ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Text(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Aggregate(_) => false,
        }
    }

    /// Whether an expression depends on one bit alone, which is a sum of bits of the register.
    fn is_of_one_bit(&self, expr: &Expr) -> Option<bool> {
        if self.is_sum(expr) {
            let constant = number(self.value(expr, 0)?)?;
            let mut changes: Vec<u64> = Vec::new();
            for bit in self.bits() {
                changes.push(number(self.value(expr, bit)?)? ^ constant);
            }
            changes.retain(|it| *it != 0);
            return Some(changes.windows(2).all(|it| it[0] == it[1]));
        }
        let operands = match &expr.kind {
            ExprKind::Convert(_, operand) => std::slice::from_ref(&**operand),
            ExprKind::Apply(op, operands) if !op.can_fault() => operands,
            _ => return Some(false),
        };
        let mut varying = operands.iter().filter(|it| it.as_const().is_none());
        match (varying.next(), varying.next()) {
            (Some(only), None) => self.is_of_one_bit(only),
            _ => Some(false),
        }
    }

    fn value(&self, expr: &Expr, register: u64) -> Option<Value> {
        scalar(&Register(self.repr.integer(register.into())?), expr).ok()
    }

    /// What the register is after one of the two ways.
    fn way(&self, which: usize, register: u64) -> Option<u64> {
        self.ways[which].iter().try_fold(register, |register, statement| match &statement.kind {
            StatementKind::Assign { value, .. } => number(self.value(value, register)?),
            _ => None,
        })
    }

    /// What it is after all turns.
    fn all(&self, register: u64) -> Option<u64> {
        (0..TURNS).try_fold(register, |register, _| match self.value(self.condition, register)? {
            Value::Bool(holds) => self.way(usize::from(!holds), register),
            _ => None,
        })
    }
}

/// The one variable that is read.
struct Register(Value);

impl Storage for Register {
    fn load(&self, _: &Place) -> Result<Value, Fault> {
        Ok(self.0)
    }

    fn load_text(&self, place: &Place) -> Result<Chars, Fault> {
        self.address_of(place).map(|_| Chars::Narrow(Vec::new()))
    }

    fn address_of(&self, _: &Place) -> Result<Value, Fault> {
        Err(Fault { kind: FaultKind::NullReference, at: Default::default() })
    }
}

fn number(value: Value) -> Option<u64> {
    match value {
        Value::Bool(it) => Some(it.into()),
        _ => u64::try_from(value.as_integer()?).ok(),
    }
}

/// Whether a conversion keeps the low bits of a number that is not signed, and adds zeros.
fn keeps_bits(how: Conversion, from: Type, to: Type) -> bool {
    let (Type::Elementary(from), Type::Elementary(to)) = (from, to) else { return false };
    let is_bits = |it: Repr| matches!(it, Repr::U8 | Repr::U16 | Repr::U32 | Repr::U64);
    let are_bits = is_bits(from.repr()) && is_bits(to.repr());
    let is_wider = to.repr().size() >= from.repr().size();
    match how {
        Conversion::Same => from.repr() == to.repr(),
        Conversion::Bits => are_bits,
        Conversion::Value => are_bits && is_wider,
        Conversion::Truncate => false,
    }
}
