//! What a VAR_CONFIG says about how variables start. The storage at the address that it gives starts like the variable
//! bound to it, unless the VAR_CONFIG has a value of its own, and is kept over a restart where the variable
//! is. Where it has a value and no address, the variable of that one instance starts with it.

use super::run::Run;
use crate::ast::{self, ExprKind};
use crate::spelling::Key;
use crate::types::address::parse;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};
use staunch_ir::{Const, FieldId, Retain, StructId, Type};
use std::rc::Rc;

/// A step on the way to a part of an initial value: which of how many parts.
#[derive(Clone, Copy)]
struct Step {
    part: u64,
    parts: u64,
    is_element: bool,
}

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
                let known = self.addresses.starts.entry((at, start.ty)).or_default();
                known.kept |= start.is_kept;
                known.initial.get_or_insert((start.initial, target.span));
            }
        }
    }

    /// Gives variables of single instances the initial values that a VAR_CONFIG has for them.
    pub(super) fn start_values(&mut self, runs: &'s [Run<'s>]) {
        let first = self.written_pous().len();
        for (slot, run) in (first..).zip(runs) {
            for (target, decl) in &run.valued {
                self.start_value(slot, target, decl);
            }
        }
    }

    fn start_value(&mut self, slot: usize, target: &ast::Expr<'s>, decl: &'s ast::VarDecl<'s>) -> Option<()> {
        let (state, held) = self.held(slot)?;
        // What has no value is reported where the VAR_CONFIG is checked.
        let given = decl.initial.as_ref()?;
        let mut steps = Vec::new();
        let ty = self.steps(slot, target, &mut steps)?;
        let wanted = self.resolve_spec(&decl.ty, &Rc::default(), "")?;
        if wanted.ty != ty {
            let (is, says) = (self.program.type_name(ty), self.program.type_name(wanted.ty));
            self.report(
                Diagnostic::new(Code::E0409, target.span, format!("this variable is {is}"))
                    .label(format!("the VAR_CONFIG says {says}"))
                    .help(format!("write `{is}` here, or change the variable")),
            );
            return None;
        }
        let value = self.initial(given, &wanted, &Rc::default())?;
        let field = self.program.structs.get_mut(state.index())?.fields.get_mut(held.index())?;
        field.initial = replaced(&field.initial, &steps, value);
        Some(())
    }

    /// The state of a run, and where in it the PROGRAM is that it holds.
    fn held(&mut self, slot: usize) -> Option<(StructId, FieldId)> {
        let state = self.signature(slot)?.state?;
        Some((state, FieldId::next(0)))
    }

    /// The type of a part of what a run holds, and the way to it.
    fn steps(&mut self, slot: usize, path: &ast::Expr<'s>, steps: &mut Vec<Step>) -> Option<Type> {
        match &path.kind {
            ExprKind::Name(_) => {
                let (state, held) = self.held(slot)?;
                Some(self.program.structure(state).fields.get(held.index())?.ty)
            }
            ExprKind::Member(base, name) => {
                let owner = self.steps(slot, base, steps)?;
                self.report_constant(owner, *name)?;
                let found = match owner {
                    Type::Struct(id) => self.field_named(id, name.text).and_then(|at| {
                        let fields = &self.program.structure(id).fields;
                        Some((at.index(), fields.len(), fields.get(at.index())?.ty))
                    }),
                    Type::Block(id) => id
                        .info()
                        .pins
                        .iter()
                        .position(|it| it.is_named(name.text))
                        .and_then(|at| Some((at, id.info().pins.len(), id.pin_type(FieldId::next(at))?))),
                    _ => None,
                };
                let Some((part, parts, ty)) = found else {
                    let owner = self.program.type_name(owner);
                    self.report(
                        Diagnostic::new(
                            Code::E0101,
                            name.span,
                            format!("{owner} has no variable `{}` that keeps its value", name.text),
                        )
                        .label("expected a variable that keeps its value from scan to scan"),
                    );
                    return None;
                };
                let count = |it: usize| u64::try_from(it).unwrap_or(u64::MAX);
                steps.push(Step { part: count(part), parts: count(parts), is_element: false });
                Some(ty)
            }
            ExprKind::Index(base, indices) => {
                let mut ty = self.steps(slot, base, steps)?;
                for index in indices {
                    let Type::Array(id) = ty else {
                        let found = self.program.type_name(ty);
                        self.error(Code::E0201, index.span, format!("{found} has no elements"));
                        return None;
                    };
                    let array = self.program.array(id);
                    let at = self.constant_integer(index, &Rc::default())?;
                    let part = u64::try_from(at - i128::from(array.low)).ok().filter(|it| *it < array.len());
                    let Some(part) = part else {
                        let bounds = format!("the elements are {} to {}", array.low, array.high);
                        self.report(
                            Diagnostic::new(Code::E0208, index.span, format!("there is no element {at}")).label(bounds),
                        );
                        return None;
                    };
                    steps.push(Step { part, parts: array.len(), is_element: true });
                    ty = array.element;
                }
                Some(ty)
            }
            _ => None,
        }
    }

    /// Reports a CONSTANT, whose value is part of the code of all instances.
    fn report_constant(&mut self, owner: Type, name: ast::Name<'s>) -> Option<()> {
        let Type::Struct(id) = owner else { return Some(()) };
        let Some(slot) = self.slot_of_instance(id) else { return Some(()) };
        let is_it = |it: &ast::VarDecl<'_>| it.names.iter().any(|it| Key(it.text) == Key(name.text));
        let mut constants = self.pous[slot].ast.blocks.iter().filter(|it| it.constant.is_some());
        if !constants.any(|it| it.vars.iter().any(is_it)) {
            return Some(());
        }
        self.report(
            Diagnostic::new(Code::E0501, name.span, format!("`{}` is a CONSTANT", name.text))
                .label("it has one value in all instances")
                .help("declare it in VAR, or change its value where it is declared"),
        );
        None
    }

    fn bound_start(&mut self, slot: usize, path: &ast::Expr<'s>) -> Option<Start> {
        match &path.kind {
            // The instance that the run holds starts as its fields do.
            ExprKind::Name(_) => {
                let (state, held) = self.held(slot)?;
                let held = self.program.structure(state).fields.get(held.index())?;
                Some(Start { ty: held.ty, initial: held.initial.clone(), is_kept: false })
            }
            ExprKind::Member(base, name) => {
                let base = self.bound_start(slot, base)?;
                let Type::Struct(id) = base.ty else { return None };
                let at = self.field_named(id, name.text)?;
                let field = self.program.structure(id).fields.get(at.index())?;
                let initial = base.initial.part(at.index());
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
                    let initial = part.initial.part(usize::try_from(index - i128::from(low)).ok()?);
                    part = Start { ty: self.program.array(id).element, initial, ..part };
                }
                Some(part)
            }
            _ => None,
        }
    }
}

/// An initial value with another one in its place.
fn replaced(whole: &Const, steps: &[Step], value: Const) -> Const {
    let Some((step, rest)) = steps.split_first() else { return value };
    if step.is_element {
        let runs = match whole {
            Const::Array(runs) => runs.clone(),
            Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Struct(_) => vec![(step.parts, Const::Zero)],
        };
        let mut left = step.part;
        let mut parts = Vec::new();
        let mut value = Some(value);
        for (count, part) in runs {
            match value.take() {
                Some(given) if left < count => {
                    let there = replaced(&part, rest, given);
                    parts.extend([(left, part.clone()), (1, there), (count - left - 1, part)]);
                }
                waiting => {
                    left = left.saturating_sub(count);
                    value = waiting;
                    parts.push((count, part));
                }
            }
        }
        parts.retain(|(count, _)| *count > 0);
        return Const::Array(parts);
    }
    let mut parts = match whole {
        Const::Struct(parts) => parts.clone(),
        Const::Zero | Const::Scalar(_) | Const::Text(_) | Const::Array(_) => {
            (0..step.parts).map(|_| Const::Zero).collect()
        }
    };
    if let Some(part) = usize::try_from(step.part).ok().and_then(|it| parts.get_mut(it)) {
        *part = replaced(part, rest, value);
    }
    Const::Struct(parts)
}
