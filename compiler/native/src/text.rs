//! Strings: pointers to a length and the units after it. A string that is made is written to its target itself where it reads
//! nothing of that, else to the frame, so no result overlaps an operand.

use crate::address::Address;
use crate::function::Function;
use crate::runtime_call::by_pointer;
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC, types};
use staunch_ir::alias::Frame;
use staunch_ir::layout::Shape;
use staunch_ir::pieces::{self, Piece, Start};
use staunch_ir::{Chars, Const, Expr, ExprKind, Place, Repr, StringType, TextOp, Type};

/// Up to this size a string is copied whole.
const WHOLE: u32 = 34;

/// A string that can be read, and the type of the storage it is in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text {
    pub(crate) address: Address,
    ty: StringType,
    /// Whether its units past its length are zero, as those of variables are.
    is_clear: bool,
}

/// A call that writes a piece of a string; the string and its capacity are its last arguments.
struct Write {
    symbol: String,
    arguments: Vec<(clif::AbiParam, clif::Value)>,
}

impl Function<'_, '_> {
    pub(crate) fn text(&mut self, expr: &Expr) -> Text {
        match &expr.kind {
            ExprKind::Text(text) => self.text_constant(text),
            ExprKind::Load(place) if place.is_followed() => {
                let ty = string_type(place.ty);
                let reached = self.reached(place).expect("a string reached through a reference");
                Text { address: self.load_reached_text(reached, ty), ty, is_clear: false }
            }
            ExprKind::Load(place) => Text { address: self.address(place), ty: string_type(place.ty), is_clear: true },
            ExprKind::Convert(_, operand) if matches!(operand.kind, ExprKind::Load(_)) => {
                self.text_cut(operand, expr.ty)
            }
            ExprKind::ApplyText(..) | ExprKind::Convert(..) => self.text_of_pieces(expr),
            ExprKind::Const(_) | ExprKind::AddressOf(_) | ExprKind::Apply(..) | ExprKind::Aggregate(_) => {
                unreachable!("verified IR: an expression of a string type")
            }
        }
    }

    /// A string for reading, where only its value counts.
    pub(crate) fn text_pointer(&mut self, expr: &Expr) -> clif::Value {
        let text = self.text(expr);
        self.pointer(text.address)
    }

    fn text_constant(&mut self, text: &Chars) -> Text {
        let capacity = u16::try_from(text.len()).expect("verified IR: a string fits its type");
        let ty = StringType { wide: text.is_wide(), capacity };
        let mut data = vec![0; staunch_ir::layout::usize_of(ty.size().into())];
        text.write(&mut data);
        Text { address: self.data(data), ty, is_clear: true }
    }

    /// A string of its pieces, in the frame.
    fn text_of_pieces(&mut self, expr: &Expr) -> Text {
        let ty = string_type(expr.ty);
        let capacity = u16::try_from(pieces::most(expr)).map_or(ty.capacity, |most| most.min(ty.capacity));
        let ty = ty.of_capacity(capacity);
        let writes = self.writes(&pieces::pieces(expr));
        let address = self.temporary(Shape { size: u64::from(ty.size()), align: u64::from(TEXT_ALIGN) });
        self.set_length(address, 0);
        self.write(writes, address, ty);
        Text { address, ty, is_clear: false }
    }

    /// Writes a string where there is none yet.
    pub(crate) fn write_copy(&mut self, value: &Expr, to: Address) {
        let writes = self.writes(&pieces::pieces(value));
        self.set_length(to, 0);
        self.write(writes, to, string_type(value.ty));
    }

    /// The calls that write pieces, with all operands evaluated.
    fn writes(&mut self, pieces: &[Piece<'_>]) -> Vec<Write> {
        let write = |piece: &Piece<'_>| match piece {
            Piece::Text(text) => {
                let wide = if string_type(text.ty).wide { "wide_" } else { "" };
                let arguments = vec![by_pointer(self.text_pointer(text))];
                Write { symbol: format!("staunch_{wide}text_append"), arguments }
            }
            Piece::Made(op, operands) => {
                Write { symbol: symbol(*op, operands), arguments: self.text_arguments(*op, operands) }
            }
        };
        pieces.iter().map(write).collect()
    }

    /// Writes after what the string at `to` holds.
    fn write(&mut self, writes: Vec<Write>, to: Address, ty: StringType) {
        for Write { symbol, mut arguments } in writes {
            let out = self.pointer(to);
            let limit = self.integer(types::I16, i128::from(ty.capacity));
            arguments.push(by_pointer(out));
            arguments.push(self.by_repr(Repr::U16, limit));
            self.call_runtime(&symbol, &arguments, None);
        }
    }

    pub(crate) fn set_length(&mut self, text: Address, length: u16) {
        let length = self.integer(types::I16, i128::from(length));
        self.store(length, text);
    }

    /// Writes a string in the place of the one at `to`.
    fn write_anew(&mut self, writes: Vec<Write>, to: Address, ty: StringType) {
        let before = self.load_as(types::I16, to);
        self.set_length(to, 0);
        self.write(writes, to, ty);
        let after = self.load_as(types::I16, to);
        let is_shorter = self.ins().icmp(IntCC::UnsignedLessThan, after, before);
        let (shorter, done) = (self.builder.create_block(), self.builder.create_block());
        self.ins().brif(is_shorter, shorter, &[], done, &[]);
        self.builder.switch_to_block(shorter);
        self.builder.seal_block(shorter);
        let out = self.pointer(to);
        let arguments = [by_pointer(out), self.by_repr(Repr::U16, before)];
        self.call_runtime(if ty.wide { "staunch_wide_text_clear" } else { "staunch_text_clear" }, &arguments, None);
        self.works_on(ty.capacity);
        self.ins().jump(done, &[]);
        self.builder.switch_to_block(done);
        self.builder.seal_block(done);
    }

    /// A string function with an elementary result.
    pub(crate) fn text_scalar(&mut self, op: TextOp, operands: &[Expr]) -> clif::Value {
        if let (TextOp::Len, [operand]) = (op, operands) {
            return self.text_length(operand);
        }
        let arguments = self.text_arguments(op, operands);
        let repr = op.result().expect("verified IR: a text operation with an elementary result");
        let result = self.c_param(repr);
        let value = self.call_runtime(&symbol(op, operands), &arguments, Some(result));
        value.expect("a function with a result")
    }

    /// `LEN`, of which an INT has no more than it can.
    fn text_length(&mut self, operand: &Expr) -> clif::Value {
        let text = self.text(operand);
        let length = self.load_as(types::I16, text.address);
        if text.ty.capacity <= i16::MAX.unsigned_abs() {
            return length;
        }
        let most = self.integer(types::I16, i128::from(i16::MAX));
        self.ins().umin(length, most)
    }

    fn text_arguments(&mut self, op: TextOp, operands: &[Expr]) -> Vec<(clif::AbiParam, clif::Value)> {
        let argument = |(repr, operand): (&Option<Repr>, &Expr)| match repr {
            Some(repr) => {
                let value = self.scalar(operand);
                self.by_repr(*repr, value)
            }
            None => by_pointer(self.text_pointer(operand)),
        };
        op.operands().iter().zip(operands).map(argument).collect()
    }

    /// A conversion between capacities: only one to a smaller capacity needs code.
    fn text_cut(&mut self, operand: &Expr, ty: Type) -> Text {
        let text = self.text(operand);
        if text.ty.capacity <= string_type(ty).capacity {
            return text;
        }
        let (from, ty) = (self.pointer(text.address), string_type(ty));
        let address = self.temporary(Shape { size: u64::from(ty.size()), align: u64::from(TEXT_ALIGN) });
        self.set_length(address, 0);
        self.copy_text(from, address, ty);
        Text { address, ty, is_clear: false }
    }

    /// Assigns to the variable `place`, which is at `target`.
    pub(crate) fn assign_text(&mut self, value: &Expr, place: &Place, target: Address) {
        let frame = Frame::of(self.module.program, self.routine);
        let is_made = matches!(value.kind, ExprKind::ApplyText(..) | ExprKind::Convert(..));
        if is_made && let Some((start, pieces)) = pieces::in_place(&frame, place, value) {
            let (writes, ty) = (self.writes(&pieces), string_type(value.ty));
            return match start {
                Start::Anew => self.write_anew(writes, target, ty),
                Start::AtEnd => self.write(writes, target, ty),
            };
        }
        self.copy_value_of_text(value, target);
    }

    fn copy_value_of_text(&mut self, value: &Expr, target: Address) {
        let ty = string_type(value.ty);
        if let ExprKind::Text(text) = &value.kind
            && ty.size() <= WHOLE
        {
            return self.store_const(value.ty, &Const::Text(text.clone()), target);
        }
        let text = self.text(value);
        if text.ty == ty && text.is_clear && ty.size() <= WHOLE {
            return self.copy(text.address, target, value.ty);
        }
        let from = self.pointer(text.address);
        self.copy_text(from, target, ty);
    }

    /// Copies a string out of storage of any capacity.
    pub(crate) fn copy_text(&mut self, from: clif::Value, to: Address, ty: StringType) {
        let out = self.pointer(to);
        let limit = self.integer(types::I16, i128::from(ty.capacity));
        let arguments = [by_pointer(from), by_pointer(out), self.by_repr(Repr::U16, limit)];
        let symbol = if ty.wide { "staunch_wide_text_copy" } else { "staunch_text_copy" };
        self.call_runtime(symbol, &arguments, None);
    }
}

/// In bytes: that of the length, and of a WSTRING's units.
const TEXT_ALIGN: u32 = 2;

fn symbol(op: TextOp, operands: &[Expr]) -> String {
    let wide = if op.is_wide(operands) { "wide_" } else { "" };
    format!("staunch_{wide}text_{}", op.function())
}

fn string_type(ty: Type) -> StringType {
    ty.string_type().expect("verified IR: an expression of a string type")
}
