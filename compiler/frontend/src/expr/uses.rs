//! Notes which counters the first scan after a start, a restart or IDLE -> RUN prepares.

use super::checker::Checker;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Expr, ExprKind, Location, Place, Projection, Root, Type};

/// What a POU does with counters, in places of the POU's own.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    /// Structures, each with an instruction that works on it.
    pub instructions: Vec<(Place, usize)>,
    pub counts: Vec<KeptCount>,
    pub assigned: Vec<Assigned>,
}

/// A variable that the body assigns as a whole.
#[derive(Debug)]
pub(crate) struct Assigned {
    pub place: Place,
    pub span: Span,
    /// It is passed for a VAR_IN_OUT, which is declared here.
    pub passed_for: Option<Span>,
}

/// An R_CTU or R_CTD, and the variable that keeps its count.
#[derive(Clone, Debug)]
pub(crate) struct KeptCount {
    pub counter: Place,
    pub kept: Place,
    /// Where it stands as RCV.
    pub span: Span,
    /// The call that reaches the counter, when it does not stand in the POU itself.
    pub through: Option<Location>,
    /// Whether the user knows that no restart restores it.
    pub told: bool,
}

impl<'s> Checker<'_, 's> {
    pub(crate) fn used_instruction(&mut self, place: &Place, instruction: usize) {
        let known = self.uses.instructions.iter().any(|(it, at)| *at == instruction && same_storage(it, place));
        if !known {
            self.uses.instructions.push((place.clone(), instruction));
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
        // The variable behind an in-out, or an instance around this one, may still be RETAIN.
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
            | ast::ExprKind::Binary(..) => false,
        }
    }

    pub(crate) fn note_assigned(&mut self, place: &Place, span: Span) {
        self.uses.assigned.push(Assigned { place: place.clone(), span, passed_for: None });
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
            if let Some(it) = uses.assigned.iter().find(|it| holds_storage(&it.place, &count.kept)) {
                self.report(assigned_count(it.span, count.span));
            }
        }
    }
}

/// A count that is kept in a variable that is not.
pub(crate) fn lost_count(span: Span) -> Diagnostic {
    Diagnostic::new(Code::W0301, span, "this count will not survive a restart")
        .label("the variable is not RETAIN")
        .help("declare it in VAR RETAIN")
}

pub(crate) fn assigned_count(span: Span, counter: Span) -> Diagnostic {
    Diagnostic::new(Code::E0315, span, "the variable that keeps a counter's count is assigned")
        .label("only the counter writes it")
        .other(counter, "given as RCV here")
        .help("to clear the count, call the counter with its RESET TRUE")
}

pub(crate) fn shared_count(span: Span, other: Span) -> Diagnostic {
    Diagnostic::new(Code::E0314, span, "two counters keep their count in one variable")
        .label("each counter needs an RCV of its own")
        .other(other, "the other counter's")
}

pub(crate) fn several_counts(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0314, span, "several counters may keep their count in one variable")
        .label("each element of an array needs an RCV of its own")
        .help("declare an array of counts, and give the element of the counter's index")
}

/// Whether elements of arrays are given the counts of the same indices.
pub(crate) fn is_element_by_element(counter: &Place, kept: &Place) -> bool {
    let (counters, counts) = (open_indices(counter), open_indices(kept));
    counters.len() == counts.len() && counters.iter().zip(counts).all(|(a, b)| is_same_value(a, b))
}

/// The indices of a place that are known in the call only.
fn open_indices(place: &Place) -> Vec<&Expr> {
    let indices = place.projections.iter().filter_map(|it| match it {
        Projection::Index { index, .. } => Some(&**index),
        Projection::Field(_) => None,
    });
    indices.filter(|it| it.as_const().is_none()).collect()
}

/// Whether two expressions are one, but for where they stand.
fn is_same_value(a: &Expr, b: &Expr) -> bool {
    match (&a.kind, &b.kind) {
        (ExprKind::Const(a), ExprKind::Const(b)) => a == b,
        (ExprKind::Load(a), ExprKind::Load(b)) => is_same_place(a, b),
        (ExprKind::Convert(how, a), ExprKind::Convert(other, b)) => how == other && is_same_value(a, b),
        (ExprKind::Apply(op, a), ExprKind::Apply(other, b)) => {
            op == other && a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same_value(a, b))
        }
        _ => false,
    }
}

fn is_same_place(a: &Place, b: &Place) -> bool {
    let same = |(a, b): (&Projection, &Projection)| match (a, b) {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { index: a, .. }, Projection::Index { index: b, .. }) => is_same_value(a, b),
        (Projection::Field(_), Projection::Index { .. }) | (Projection::Index { .. }, Projection::Field(_)) => false,
    };
    a.root == b.root && a.projections.len() == b.projections.len() && a.projections.iter().zip(&b.projections).all(same)
}

/// Whether two places surely are, or by an index may be, the same.
pub(crate) fn same_storage(a: &Place, b: &Place) -> bool {
    a.projections.len() == b.projections.len() && holds_storage(a, b)
}

/// Whether `part` surely is, or by an index may be, `whole` or a part of it.
pub(crate) fn holds_storage(whole: &Place, part: &Place) -> bool {
    let same = |(a, b): (&Projection, &Projection)| match (a, b) {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { index: a, .. }, Projection::Index { index: b, .. }) => {
            match (a.as_const(), b.as_const()) {
                (Some(a), Some(b)) => a == b,
                _ => true,
            }
        }
        (Projection::Field(_), Projection::Index { .. }) | (Projection::Index { .. }, Projection::Field(_)) => false,
    };
    whole.root == part.root
        && whole.projections.len() <= part.projections.len()
        && whole.projections.iter().zip(&part.projections).all(same)
}
