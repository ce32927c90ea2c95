//! What a UNION's members are made of: the parts of one, and members that are read and assigned whole. Storage has
//! no texts and no gaps between bytes that mean anything else: a text is its characters and a zero.

use super::checker::Checker;
use super::place::Found;
use crate::types::window::Window;
use crate::{Span, ast};
use staunch_ir::{
    ArrayId, Block, Chars, Elementary, Expr, ExprKind, For, Location, Op, Place, Statement, StatementKind, StringType,
    StructId, TextOp, Type, Value,
};

/// Arrays of no more elements are read and assigned without a loop.
const FEW: u64 = 8;

/// Which way values go.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Read,
    Write,
}

impl<'s> Checker<'_, 's> {
    /// The member of a structure that shares its bits with others, if the name is one's.
    pub(super) fn overlay(&self, found: &Found<'s>, id: StructId, name: ast::Name<'s>) -> Option<Found<'s>> {
        let structure = self.decl.program.structure(id);
        let overlay = structure.overlays.iter().find(|it| it.name.eq_ignore_ascii_case(name.text))?;
        let window = Window::from(overlay);
        let access = found.access;
        let Some(outer) = found.view else {
            let storage = structure.fields[overlay.field.index()].ty;
            let place = found.place.clone().field(overlay.field, storage);
            return Some(Found { place, view: Some(window), access });
        };
        let bit = outer.bit + 8 * self.decl.offset_of(id, overlay.field) + window.bit;
        Some(Found { place: found.place.clone(), view: Some(Window { bit, ..window }), access })
    }

    /// A member of a structure that shares its bits.
    pub(super) fn member_of_view(&self, found: Found<'s>, id: StructId, at: staunch_ir::FieldId) -> Found<'s> {
        let ty = self.decl.program.structure(id).fields[at.index()].ty;
        let bit = 8 * self.decl.offset_of(id, at);
        let view = found.view.map(|it| Window { ty, bit: it.bit + bit, ..it });
        Found { view, ..found }
    }

    /// An element of an array that shares its bits; the index is a LINT.
    pub(super) fn element_of_view(&mut self, found: Found<'s>, id: ArrayId, index: Expr, at: Location) -> Found<'s> {
        let Some(view) = found.view else { return found };
        let array = self.decl.program.array(id);
        let stride = self.decl.sizeof_element(id);
        if let Some(number) = index.as_const().and_then(Value::as_integer) {
            let position = u64::try_from(number - i128::from(array.low)).unwrap_or_default();
            let view = Window { ty: array.element, bit: view.bit + 8 * stride * position, ..view };
            return Found { view: Some(view), ..found };
        }
        let lint = |it| Expr::constant(Elementary::Lint, Value::I64(it), at);
        let unit = self.unit_size(&found.place);
        let by = i64::try_from(stride / unit.max(1)).unwrap_or(i64::MAX);
        let checked = Expr::apply(Op::CheckIndex, Type::LINT, vec![lint(array.low), index, lint(array.high)], at);
        let position = match array.low {
            0 => checked,
            low => Expr::apply(Op::Sub, Type::LINT, vec![checked, lint(low)], at),
        };
        let steps = match by {
            1 => position,
            by => Expr::apply(Op::Mul, Type::LINT, vec![position, lint(by)], at),
        };
        let place = self.moved(&found.place, steps, at);
        Found { place, view: Some(Window { ty: array.element, ..view }), ..found }
    }

    /// How many bytes after the start of its first unit a view begins.
    pub(super) fn bytes_in_unit(&self, place: &Place, view: Window) -> u64 {
        view.bit / 8 % self.unit_size(place).max(1)
    }

    /// The bytes of a place's elements, or of the place where it has none.
    fn unit_size(&self, place: &Place) -> u64 {
        match place.ty {
            Type::Array(id) => self.decl.size_of(self.decl.program.array(id).element),
            ty => self.decl.size_of(ty),
        }
    }

    /// An array or structure, as a local that holds its parts.
    pub(super) fn read_whole(&mut self, place: &Place, view: Window, span: Span) -> Option<Expr> {
        let mut place = place.clone();
        self.fix(&mut place);
        let copy = self.temporary("whole", view.ty);
        self.transfer(&place, view, &copy, Way::Read, span)?;
        Some(Expr::load(copy, self.at(span)))
    }

    pub(super) fn write_whole(&mut self, place: &Place, view: Window, mut value: Expr, span: Span) -> Option<()> {
        let mut place = place.clone();
        self.fix(&mut place);
        // Its parts may be what the value is read from.
        self.save("whole", &mut value);
        let ExprKind::Load(copy) = value.kind else { return None };
        self.transfer(&place, view, &copy, Way::Write, span)
    }

    /// Reads each part of a view to a variable of the same type, or assigns it from there.
    fn transfer(&mut self, storage: &Place, view: Window, copy: &Place, way: Way, span: Span) -> Option<()> {
        match view.ty {
            Type::Array(id) => self.transfer_elements(storage, view, copy, id, way, span),
            Type::Struct(id) => {
                for at in 0..self.decl.program.structure(id).fields.len() {
                    let field = staunch_ir::FieldId::next(at);
                    let ty = self.decl.program.structure(id).fields[at].ty;
                    let bit = view.bit + 8 * self.decl.offset_of(id, field);
                    let part = copy.clone().field(field, ty);
                    self.transfer(storage, Window { ty, bit, ..view }, &part, way, span)?;
                }
                Some(())
            }
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Enum(_)
            | Type::String(_)
            | Type::Block(_)
            | Type::Reference(_) => match way {
                Way::Read => {
                    let value = self.read(storage.clone(), Some(view), span)?;
                    self.assign(copy.clone(), value, span);
                    Some(())
                }
                Way::Write => {
                    let value = Expr::load(copy.clone(), self.at(span));
                    self.write(storage.clone(), Some(view), value, span)
                }
            },
        }
    }

    fn transfer_elements(
        &mut self,
        storage: &Place,
        view: Window,
        copy: &Place,
        id: ArrayId,
        way: Way,
        span: Span,
    ) -> Option<()> {
        let (array, at) = (self.decl.program.array(id), self.at(span));
        let stride = self.decl.sizeof_element(id);
        let lint = |it| Expr::constant(Elementary::Lint, Value::I64(it), at);
        if array.len() <= FEW {
            for position in 0..array.len() {
                let index = array.low.checked_add_unsigned(position)?;
                let part = copy.clone().index(lint(index), array.element, at);
                let view = Window { ty: array.element, bit: view.bit + 8 * stride * position, ..view };
                self.transfer(storage, view, &part, way, span)?;
            }
            return Some(());
        }
        let by = i64::try_from(stride / self.unit_size(storage).max(1)).ok()?;
        let mut made = Some(());
        let turns = self.each("element", array.low, array.high, at, |this, index| {
            let position = Expr::apply(Op::Sub, Type::LINT, vec![index.clone(), lint(array.low)], at);
            let steps = Expr::apply(Op::Mul, Type::LINT, vec![position, lint(by)], at);
            let place = this.moved(storage, steps, at);
            let part = copy.clone().index(index, array.element, at);
            made = this.transfer(&place, Window { ty: array.element, ..view }, &part, way, span);
        });
        self.block.push(turns);
        made
    }

    /// A loop over all LINTs from one to another.
    pub(super) fn each(
        &mut self,
        name: &str,
        first: i64,
        last: i64,
        at: Location,
        body: impl FnOnce(&mut Self, Expr),
    ) -> Statement {
        let counter = self.temporary(name, Type::LINT);
        let body: Block = self.nested(|this| body(this, Expr::load(counter.clone(), at)));
        let bound = |it| Expr::constant(Elementary::Lint, Value::I64(it), at);
        For::over(counter, bound(first), bound(last), body, at)
    }

    /// The characters before the first zero.
    pub(super) fn read_text(&mut self, place: &Place, view: Window, ty: StringType, span: Span) -> Option<Expr> {
        let (whole, at) = (Type::String(ty), self.at(span));
        let mut place = place.clone();
        self.fix(&mut place);
        let text = self.temporary("text", whole);
        let empty = Expr::new(whole, ExprKind::Text(Chars::empty(ty)), at);
        self.assign(text.clone(), empty, span);
        let (character, from, _) = characters(ty);
        let one = Type::String(ty.of_capacity(1));
        let found = self.temporary("character", Type::Elementary(character));
        let mut read = Some(());
        let turns = self.each("position", 0, i64::from(ty.capacity) - 1, at, |this, index| {
            let place = this.character(&place, character, index, at);
            let Some(value) = this.read(place, Some(Window { ty: found.ty, ..view }), span) else {
                read = None;
                return;
            };
            this.assign(found.clone(), value, span);
            let zero = Expr::constant(character, character.repr().zero(), at);
            let ends = Expr::apply(Op::Eq, Type::BOOL, vec![Expr::load(found.clone(), at), zero], at);
            let then = vec![Statement::new(StatementKind::Exit, at)];
            this.push(StatementKind::If { condition: ends, then, otherwise: Vec::new() }, span);
            let last = Expr::new(one, ExprKind::ApplyText(from, vec![Expr::load(found, at)]), at);
            let parts = vec![Expr::load(text.clone(), at), last];
            this.assign(text.clone(), Expr::new(whole, ExprKind::ApplyText(TextOp::Concat, parts), at), span);
        });
        self.block.push(turns);
        read.map(|()| Expr::load(text, at))
    }

    /// The characters, and zeros to the end.
    pub(super) fn write_text(
        &mut self,
        place: &Place,
        view: Window,
        ty: StringType,
        value: Expr,
        span: Span,
    ) -> Option<()> {
        let at = self.at(span);
        let mut place = place.clone();
        self.fix(&mut place);
        let text = self.temporary("text", value.ty);
        self.assign(text.clone(), value, span);
        let (character, _, to) = characters(ty);
        let one = Type::String(ty.of_capacity(1));
        let mut written = Some(());
        let turns = self.each("position", 0, i64::from(ty.capacity), at, |this, index| {
            let lint = |it| Expr::constant(Elementary::Lint, Value::I64(it), at);
            let place = this.character(&place, character, index.clone(), at);
            let position = Expr::apply(Op::Add, Type::LINT, vec![index, lint(1)], at);
            let part = vec![Expr::load(text, at), lint(1), position];
            let part = Expr::new(one, ExprKind::ApplyText(TextOp::Mid, part), at);
            let value = Expr::new(Type::Elementary(character), ExprKind::ApplyText(to, vec![part]), at);
            written = this.write(place, Some(Window { ty: value.ty, ..view }), value, span);
        });
        self.block.push(turns);
        written
    }

    /// Where a text's character is, by its number from 0.
    fn character(&self, place: &Place, character: Elementary, index: Expr, at: Location) -> Place {
        let units = u64::from(character.repr().size()) / self.unit_size(place).max(1);
        let by = Expr::constant(Elementary::Lint, Value::I64(i64::try_from(units).unwrap_or(1)), at);
        let steps = if units > 1 { Expr::apply(Op::Mul, Type::LINT, vec![index, by], at) } else { index };
        self.moved(place, steps, at)
    }
}

/// The type of a string's characters, and what makes a string of one, and one of a string.
fn characters(ty: StringType) -> (Elementary, TextOp, TextOp) {
    if ty.wide {
        (Elementary::Wchar, TextOp::FromWchar, TextOp::ToWchar)
    } else {
        (Elementary::Char, TextOp::FromChar, TextOp::ToChar)
    }
}
