//! The order of bytes, `TO_BIG_ENDIAN` and its like (edition 3, table 37): of a number, or of each in an array or a
//! structure.

use super::checker::{Checker, Context};
use super::operand::{Operand, computed};
use super::overload::Resolved;
use super::unresolved::not_constant;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Conversion, Expr, FieldId, Op, Place, Type};

impl<'s> Checker<'_, 's> {
    pub(super) fn own_byte_order(&mut self, resolved: Resolved, name: ast::Name<'s>) -> Option<Operand> {
        let (value, ty) = self.with_byte_order(resolved, name)?;
        Some(computed(value, ty))
    }

    pub(super) fn other_byte_order(&mut self, resolved: Resolved, name: ast::Name<'s>) -> Option<Operand> {
        let (value, ty) = self.with_byte_order(resolved, name)?;
        let value = match ty {
            Type::Elementary(_) => self.apply(Op::SwapBytes, ty, vec![value], ty, name.span)?,
            _ if self.context != Context::Body => {
                self.report(not_constant(name.span));
                return None;
            }
            _ => {
                let copy = self.temporary("swapped", ty);
                self.assign(copy.clone(), value, name.span);
                self.swap(&copy, name.span)?;
                Expr::load(copy, self.at(name.span))
            }
        };
        Some(computed(value, ty))
    }

    /// A value at its own size, also where it is computed at more; what has no order of its bytes is reported.
    fn with_byte_order(&mut self, resolved: Resolved, name: ast::Name<'s>) -> Option<(Expr, Type)> {
        let Resolved { own: ty, mut operands, .. } = resolved;
        let value = operands.pop()?;
        let is_whole = matches!(ty, Type::Array(_) | Type::Struct(_));
        let without = match ty {
            Type::Enum(_) | Type::String(_) => Some(ty),
            _ => self.without_order(ty),
        };
        if without.is_none() && !is_whole {
            return Some((self.convert(Conversion::Value, ty, value), ty));
        }
        let Some(part) = without else { return Some((value, ty)) };
        let (found, part) = (self.type_name(ty), self.type_name(part));
        let wanted = "a number, a bit string, a time or a character, or an array or a structure of them";
        let label = if is_whole { format!("this contains {part}") } else { format!("this is {found}") };
        let message = format!("`{}` takes {wanted}, but this is {found}", name.text);
        self.report(Diagnostic::new(Code::E0204, name.span, message).label(label));
        None
    }

    /// What is in a type whose bytes have no order.
    fn without_order(&self, ty: Type) -> Option<Type> {
        match ty {
            // Other bytes would be no day, and no time of day.
            Type::Elementary(it) if it.is_day() || it.is_time_of_day() => Some(ty),
            Type::Elementary(_) | Type::Enum(_) => None,
            Type::String(it) => it.wide.then_some(ty),
            Type::Array(id) => self.without_order(self.decl.program.array(id).element),
            Type::Struct(id) if self.decl.is_instance(id) => Some(ty),
            Type::Struct(id) => {
                let structure = self.decl.program.structure(id);
                if !structure.overlays.is_empty() {
                    return Some(ty);
                }
                structure.fields.iter().find_map(|it| self.without_order(it.ty))
            }
            Type::Subrange(..) | Type::Block(_) | Type::Reference(_) => Some(ty),
        }
    }

    fn swap(&mut self, place: &Place, span: Span) -> Option<()> {
        let at = self.at(span);
        match place.ty {
            Type::Array(id) => {
                let array = self.decl.program.array(id);
                let mut done = Some(());
                let turns = self.each("element", array.low, array.high, at, |this, index| {
                    done = this.swap(&place.clone().index(index, array.element, at), span);
                });
                self.block.push(turns);
                done
            }
            Type::Struct(id) => {
                for number in 0..self.decl.program.structure(id).fields.len() {
                    let ty = self.decl.program.structure(id).fields[number].ty;
                    self.swap(&place.clone().field(FieldId::next(number), ty), span)?;
                }
                Some(())
            }
            Type::Enum(id) => {
                let base = Type::Elementary(self.decl.program.enumeration(id).base);
                let number = self.convert(Conversion::Same, base, Expr::load(place.clone(), at));
                let swapped = self.apply(Op::SwapBytes, base, vec![number], base, span)?;
                let value = self.convert(Conversion::Same, place.ty, swapped);
                self.assign(place.clone(), value, span);
                Some(())
            }
            Type::Elementary(_) => {
                let swapped =
                    self.apply(Op::SwapBytes, place.ty, vec![Expr::load(place.clone(), at)], place.ty, span)?;
                self.assign(place.clone(), swapped, span);
                Some(())
            }
            // The characters of a STRING are bytes.
            Type::String(_) | Type::Subrange(..) | Type::Block(_) | Type::Reference(_) => Some(()),
        }
    }
}
