//! A loop that fills a part of an array, or copies it from another place, is one operation on a block of memory.
//!
//! ```text
//! FOR i := 0 TO 63 DO                fill a[0] … a[63] with zeros;
//!     a[i] := 0;                     i := 64;
//! END_FOR
//!
//! FOR i := 63 TO 1 BY -1 DO          copy a[0] … a[62] to a[1] … a[63];
//!     a[i] := a[i - 1];              i := 0;
//! END_FOR
//! ```
//!
//! It applies to a FOR of constant bounds, by 1 or -1, whose counter nothing else writes, which takes its turns before the first one or none, and whose body is one
//! assignment to the element at the counter, or at a constant distance from it. None of its indices can fault. The assigned value is a constant of equal bytes, or such an
//! element of an array of the same type. It may not assume that two arrays are different storage: where `alias` does not say so, the loop
//! stays. Within one array the loop must read each element before it writes it; a loop that reads what it has written repeats it.

use crate::control::Known;
use crate::function::{Flow, Function};
use cranelift_codegen::ir::{self as clif, MemFlagsData, types};
use staunch_ir::alias::{Alias, Frame, alias};
use staunch_ir::layout::Shape;
use staunch_ir::loops::running;
use staunch_ir::{
    ArrayId, Const, Conversion, Expr, ExprKind, For, Location, Op, Place, Projection, Statement, StatementKind, Step,
    Taking, Type, Value, visit,
};

/// The calls of the C library for less than this take longer than the loop.
const LEAST_TURNS: u64 = 32;
const LEAST_BYTES: u64 = 64;
/// So many bytes are a few instructions, if they are whole words.
const MOST_OF_FEW: u64 = 32;
const WORD: u64 = 8;

/// Elements of an array, one for each turn.
struct Elements {
    array: Place,
    id: ArrayId,
    /// The index of the first turn's less the counter.
    distance: i128,
}

enum What {
    Byte(u8),
    Elements(Elements),
}

struct BlockLoop {
    target: Elements,
    what: What,
    /// The counter's least value.
    least: i128,
    end: i128,
    bytes: u64,
}

impl<'p> Function<'_, 'p> {
    /// The loop as an operation on a block, where it is one.
    pub(crate) fn block_at_once(&mut self, it: &'p For, at: Location) -> Option<Flow> {
        self.counters.push(it);
        let found = self.block_loop(it);
        self.counters.pop();
        let found = found?;
        let running = self.start_for(it, at);
        if let Taking::Ahead(at) | Taking::AheadOfMany(at) = it.taking {
            let way = self.way_of(&Known::For(running), true);
            self.take_ahead(&way, it.taking.is_of_many(), at);
        }
        let to = self.start_of(&found.target, found.least);
        let align = u8::try_from(self.module.layout.shape(self.element_type(&found.target)).align)
            .expect("alignments are small");
        let (config, flags) = (self.module.output.target_config(), MemFlagsData::trusted());
        match &found.what {
            What::Byte(byte) => {
                self.builder.emit_small_memset(config, to, *byte, found.bytes, align, flags);
            }
            What::Elements(from) => {
                let from = self.start_of(from, found.least);
                self.builder.emit_small_memory_copy(config, to, from, found.bytes, align, align, false, flags);
            }
        }
        let end = self.integer(types::I64, found.end);
        self.set_counter(&running, end, true);
        self.set_late(&running);
        Some(Flow::Continues)
    }

    fn element_type(&self, of: &Elements) -> Type {
        self.module.program.array(of.id).element
    }

    /// A pointer to the element that has the least index.
    fn start_of(&mut self, elements: &Elements, least: i128) -> clif::Value {
        let low = i128::from(self.module.program.array(elements.id).low);
        let position = u64::try_from(least + elements.distance - low).expect("the index is within its bounds");
        let stride = self.module.layout.stride(elements.id);
        let array = self.address(&elements.array).plus(position * stride);
        self.read_any();
        self.pointer(array)
    }

    fn block_loop(&self, it: &For) -> Option<BlockLoop> {
        let is_plain = it.is_private && !matches!(it.taking, Taking::EachOfMany) && self.noted.is_none();
        let [first, last] = [&it.first, &it.last].map(|it| it.as_const().and_then(Value::as_integer));
        let (first, last, Step::Constant(step @ (1 | -1))) = (first?, last?, &it.step) else { return None };
        let turns = u64::try_from((last - first) * step + 1).ok().filter(|it| *it > 0)?;
        let [Statement { kind: StatementKind::Assign { target, value }, .. }] = it.body.as_slice() else { return None };
        if !is_plain || it.may_leave_range() {
            return None;
        }
        let target_at = self.elements(it, target)?;
        let shape = self.module.layout.shape(target.ty);
        let bytes = turns.checked_mul(shape.size)?;
        let is_short = bytes <= MOST_OF_FEW && bytes.is_multiple_of(WORD);
        let is_dense = self.module.layout.stride(target_at.id) == shape.size && shape.size > 0;
        if !is_dense || !is_short && (turns < LEAST_TURNS || bytes < LEAST_BYTES) {
            return None;
        }
        let what = match &value.kind {
            ExprKind::Load(source) if source.ty == target.ty && !matches!(source.ty, Type::String(_)) => {
                let source = self.elements(it, source)?;
                self.are_read_first(&target_at, &source, *step).then_some(What::Elements(source))?
            }
            _ => What::Byte(self.byte(value, shape)?),
        };
        Some(BlockLoop { target: target_at, what, least: first.min(last), end: last + step, bytes })
    }

    /// The elements that a place is in the turns, if none of its indices can fault.
    fn elements(&self, it: &For, place: &Place) -> Option<Elements> {
        let (Projection::Index { index, .. }, around) = place.projections.split_last()? else { return None };
        let program = self.module.program;
        let mut ty = program.root_type(self.routine, place.root)?;
        for projection in around {
            match (projection, ty) {
                (Projection::Field(_), _) => {}
                (Projection::Index { index, .. }, Type::Array(id)) if self.stays(it, index, id) => {}
                (Projection::Index { .. } | Projection::Deref { .. }, _) => return None,
            }
            ty = program.part(ty, projection)?;
        }
        let Type::Array(id) = ty else { return None };
        let distance = self.distance_from_counter(index, it)?;
        self.known(&|known| known.is_within(index, id)).then_some(())?;
        Some(Elements { array: place.before(around.len(), ty), id, distance })
    }

    /// Whether an index is within its bounds and the same in all turns: it reads counters of the loops around alone.
    fn stays(&self, it: &For, index: &Expr, id: ArrayId) -> bool {
        let mut stays = self.known(&|known| known.is_within(index, id));
        visit::reads(index, &mut |place| {
            stays &= running(&self.counters, place).is_some() && !place.is_same_variable(&it.counter);
        });
        stays
    }

    /// An index less the counter, if that is constant.
    fn distance_from_counter(&self, index: &Expr, it: &For) -> Option<i128> {
        match &index.kind {
            ExprKind::Load(place) if place.is_same_variable(&it.counter) => Some(0),
            ExprKind::Convert(Conversion::Value, operand) if self.keeps_value(operand, index) => {
                self.distance_from_counter(operand, it)
            }
            ExprKind::Apply(op @ (Op::Add | Op::Sub), operands) if self.known(&|known| known.is_exact(index)) => {
                let [a, b] = operands.as_slice() else { return None };
                let number = |it: &Expr| it.as_const().and_then(Value::as_integer);
                match (op, number(a), number(b)) {
                    (Op::Add, Some(a), None) => Some(self.distance_from_counter(b, it)? + a),
                    (Op::Add, None, Some(b)) => Some(self.distance_from_counter(a, it)? + b),
                    (Op::Sub, None, Some(b)) => Some(self.distance_from_counter(a, it)? - b),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Whether no turn reads what one before it has written.
    fn are_read_first(&self, target: &Elements, source: &Elements, step: i128) -> bool {
        let frame = Frame::of(self.module.program, self.routine);
        if alias(&frame, &target.array, &source.array) == Alias::No {
            return true;
        }
        let is_ahead = (source.distance - target.distance) * step >= 0;
        target.array.is_same_variable(&source.array) && is_ahead
    }

    /// The byte that a constant repeats.
    fn byte(&self, value: &Expr, shape: Shape) -> Option<u8> {
        let constant = match &value.kind {
            ExprKind::Const(value) => Const::Scalar(*value),
            ExprKind::Aggregate(value) => value.clone(),
            _ => return None,
        };
        if matches!(constant, Const::Zero) {
            return Some(0);
        }
        let mut bytes = vec![0; usize::try_from(shape.size).ok()?];
        self.module.layout.write_const(self.module.program, value.ty, &constant, &mut bytes);
        let first = *bytes.first()?;
        bytes.iter().all(|it| *it == first).then_some(first)
    }
}
