//! How what lies at the address that a VAR_CONFIG gives starts: as the variable does that is bound to it, unless the
//! VAR_CONFIG has a value of its own. It is kept over a restart where the variable is.

use super::run::Run;
use crate::ast::{self, ExprKind};
use crate::types::address::parse;
use crate::types::declarations::Declarations;
use staunch_ir::{Const, Retain, Type};
use std::rc::Rc;

/// A part of a run's instance: its type, its initial value, and whether it is kept.
struct Start {
    ty: Type,
    initial: Const,
    is_kept: bool,
}

impl<'s> Declarations<'s> {
    pub(super) fn start_bindings(&mut self, runs: &[Run<'s>]) {
        let first = self.written_pous().len();
        for (slot, run) in (first..).zip(runs) {
            for (target, address) in &run.bound {
                let (Some(start), Some(at)) = (self.bound_start(slot, target), parse(address.text)) else { continue };
                let known = self.addresses.starts.entry(at).or_default();
                known.kept |= start.is_kept;
                known.initial.get_or_insert((start.initial, target.span));
            }
        }
    }

    fn bound_start(&mut self, slot: usize, path: &ast::Expr<'s>) -> Option<Start> {
        match &path.kind {
            // The instance that the run holds starts as its fields do.
            ExprKind::Name(_) => {
                let held = Rc::clone(self.signature(slot)?.scope.variables.first()?);
                Some(Start { ty: held.place.ty, initial: held.resolved.initial.clone(), is_kept: false })
            }
            ExprKind::Member(base, name) => {
                let base = self.bound_start(slot, base)?;
                let Type::Struct(id) = base.ty else { return None };
                let at = self.field_named(id, name.text)?;
                let field = self.program.structure(id).fields.get(at.index())?;
                let initial = match base.initial {
                    Const::Struct(fields) => fields.into_iter().nth(at.index())?,
                    Const::Zero => Const::Zero,
                    Const::Scalar(_) | Const::Text(_) | Const::Array(_) => return None,
                };
                let is_kept = match field.retain {
                    Retain::Inherited => base.is_kept,
                    Retain::Kept => true,
                    Retain::Anew => false,
                };
                Some(Start { ty: field.ty, initial, is_kept })
            }
            ExprKind::Index(base, indices) => {
                let mut part = self.bound_start(slot, base)?;
                for index in indices {
                    let Type::Array(id) = part.ty else { return None };
                    let low = self.program.array(id).low;
                    let index = self.constant_integer(index, &Rc::default())?;
                    let mut before = u64::try_from(index - i128::from(low)).ok()?;
                    let initial = match part.initial {
                        Const::Array(runs) => {
                            let holds = |(count, _): &(u64, Const)| {
                                let here = before < *count;
                                before = before.saturating_sub(*count);
                                here
                            };
                            runs.into_iter().find(holds)?.1
                        }
                        Const::Zero => Const::Zero,
                        Const::Scalar(_) | Const::Text(_) | Const::Struct(_) => return None,
                    };
                    part = Start { ty: self.program.array(id).element, initial, ..part };
                }
                Some(part)
            }
            _ => None,
        }
    }
}
