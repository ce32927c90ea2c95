//! Counters whose count a variable keeps, and what a body notes of all counters for the prescan.

use super::checker::Checker;
use super::uses::{
    Assigned, KeptCount, Preparation, Uses, assigned_count, is_element_by_element, is_same_place, lost_count,
    same_storage, several_counts, shared_count,
};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::alias::may_hold;
use staunch_ir::{FieldId, Place, Projection, Root, Type};

impl<'s> Checker<'_, 's> {
    pub(crate) fn used_instruction(&mut self, place: &Place, instruction: usize) {
        self.prepared(place, Preparation::Instruction(instruction));
    }

    /// Notes what an instruction does before the first scan.
    pub(crate) fn prepared(&mut self, place: &Place, preparation: Preparation) {
        let known = self.uses.instructions.iter().any(|(it, at)| *at == preparation && is_same_place(it, place));
        if !known {
            self.uses.instructions.push((place.clone(), preparation));
        }
    }

    pub(crate) fn report_no_count(&mut self, callee: Span) {
        self.report(
            Diagnostic::new(Code::E0303, callee, "a retentive counter needs a variable for `RCV`")
                .label("it keeps the count there")
                .help("declare `VAR RETAIN count : INT; END_VAR` and write `RCV := count`"),
        );
    }

    /// Checks the actual of RCV: a variable of its own, kept by RETAIN.
    pub(crate) fn retained_count(&mut self, counter: &Place, expr: &ast::Expr<'s>) -> Option<Place> {
        let found = self.variable_argument(expr, "RCV")?;
        if found.place.ty != Type::INT {
            let ty = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(Code::E0201, expr.span, format!("`RCV` is an INT, found {ty}"))
                    .label("expected an INT variable"),
            );
            return None;
        }
        if !is_element_by_element(counter, &found.place) {
            self.report(several_counts(expr.span));
            return None;
        }
        // The variable that an in-out stands for, or an instance around this one, may still be RETAIN.
        let is_open = match found.place.root {
            Root::Param(_) => true,
            Root::Instance => self.is_function_block(),
            Root::Globals | Root::Local(_) => false,
        };
        let told = !is_open && !self.is_retained(expr);
        if told {
            self.report(lost_count(expr.span));
        }
        let shared = self
            .uses
            .counts
            .iter()
            .find(|it| same_storage(&it.kept, &found.place) && !same_storage(&it.counter, counter));
        if let Some(other) = shared {
            let first = other.span;
            self.report(shared_count(expr.span, first));
            return None;
        }
        self.uses.counts.push(KeptCount {
            counter: counter.clone(),
            kept: found.place.clone(),
            span: expr.span,
            through: None,
            told,
        });
        Some(found.place)
    }

    /// Whether the variable that `expr` names is RETAIN.
    fn is_retained(&mut self, expr: &ast::Expr<'s>) -> bool {
        match &expr.kind {
            ast::ExprKind::Name(name) => {
                matches!(self.find_variable(*name), Some(Some(variable)) if variable.retain)
            }
            ast::ExprKind::Member(base, _) | ast::ExprKind::Index(base, _) | ast::ExprKind::Paren(base) => {
                self.is_retained(base)
            }
            ast::ExprKind::Literal(_)
            | ast::ExprKind::Address(_)
            | ast::ExprKind::Part(..)
            | ast::ExprKind::Deref(_)
            | ast::ExprKind::Error(_)
            | ast::ExprKind::Call(..)
            | ast::ExprKind::Unary(..)
            | ast::ExprKind::Binary(..)
            | ast::ExprKind::Assign(..) => false,
        }
    }

    /// A variable is noted where it is assigned first: large programs assign the same ones over and over.
    pub(crate) fn note_assigned(&mut self, place: &Place, span: Span) {
        if members_of(place).is_none_or(|members| self.uses.noted.insert((place.root, members))) {
            self.uses.assigned.push(Assigned { place: place.clone(), span, passed_for: None });
        }
    }

    pub(crate) fn note_passed(&mut self, place: &Place, span: Span, declared: Span) {
        self.uses.assigned.push(Assigned { place: place.clone(), span, passed_for: Some(declared) });
    }

    /// What the first scan prepares, for the whole program to be put together.
    pub(crate) fn finish_uses(&mut self) -> Uses {
        let uses = std::mem::take(&mut self.uses);
        self.refuse_assigned_counts(&uses);
        uses
    }

    fn refuse_assigned_counts(&mut self, uses: &Uses) {
        for count in &uses.counts {
            if let Some(it) = uses.assigned.iter().find(|it| may_hold(&it.place, &count.kept)) {
                self.report(assigned_count(it.span, count.span));
            }
        }
    }
}

/// The members that lead to a part of a variable; `None` for what has subscripts or leads through a reference.
fn members_of(place: &Place) -> Option<Vec<FieldId>> {
    let member = |it: &Projection| match it {
        Projection::Field(id) => Some(*id),
        Projection::Index { .. } | Projection::Deref { .. } => None,
    };
    place.projections.iter().map(member).collect()
}
