//! The standard's typed functions, `ADD_INT(a, b)`: the overloaded one, with operands of one type (edition 3, table 21).

use super::checker::Checker;
use super::operand::Operand;
use super::operator::compares;
use super::overload::{Resolved, Takes, kind, parameter_name};
use crate::ast;
use crate::names::functions::Meaning;
use staunch_ir::{Block, Expr, Type};
use staunch_runtime::{Kind, Signature};

impl<'s> Checker<'_, 's> {
    pub(super) fn typed_function(
        &mut self,
        signature: &Signature,
        meaning: Meaning,
        ty: Type,
        values: &[&ast::Expr<'s>],
        name: ast::Name<'s>,
    ) -> Option<Operand> {
        let compared = matches!(meaning, Meaning::Operator(op) if compares(op));
        let operands = self.as_written(values, |this, at, _| {
            let takes = match kind(signature, at) {
                Kind::T => Takes::Type(ty),
                other => Takes::of(other, None, this.decl.dialect(name.span).rules()),
            };
            let operand = this.taken(takes, values[at], &parameter_name(signature, at), name)?;
            Some(if compared { this.kept_between(operand, at, values.len()) } else { operand })
        })?;
        match meaning {
            Meaning::Operator(op) if compared => self.compare_neighbours(op, &operands, values, name),
            Meaning::Operator(op) => self.fold_left(op, operands, values, Some(ty), name),
            Meaning::Operation(op) => {
                let resolved = Resolved { ty, own: ty, operands: typed(operands)? };
                self.operation(op, resolved, name.span)
            }
            Meaning::Mux => {
                let before = vec![Block::new(); operands.len()];
                self.mux(Resolved { ty, own: ty, operands: typed(operands)? }, before, name.span)
            }
            Meaning::Move | Meaning::LittleEndian => operands.into_iter().next(),
            Meaning::Text(_)
            | Meaning::Round(_)
            | Meaning::Assert
            | Meaning::Clock(_)
            | Meaning::Date(_)
            | Meaning::S7(_) => None,
        }
    }
}

fn typed(operands: Vec<Operand>) -> Option<Vec<Expr>> {
    let typed = |it| match it {
        Operand::Typed(expr) | Operand::Promoted(expr, _) => Some(expr),
        Operand::Integer(_) | Operand::Real { .. } => None,
    };
    operands.into_iter().map(typed).collect()
}
