//! Notes which counters the first scan after a start, a restart or IDLE -> RUN prepares.

use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashSet;
use staunch_ir::{Expr, ExprKind, FieldId, Location, Place, Projection, Root, alias};

/// What a POU does with counters, in places of the POU's own.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    /// Structures and bits, each with what the instruction that works on it does before the first scan.
    pub instructions: Vec<(Place, Preparation)>,
    pub counts: Vec<KeptCount>,
    pub assigned: Vec<Assigned>,
    /// The variables, and members of such, that are among these.
    pub noted: FxHashSet<(Root, Vec<FieldId>)>,
}

/// What an instruction does before the first scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Preparation {
    /// What the structure's instruction at this position does.
    Instruction(usize),
    /// A BOOL, or a bit of an integer, is given a value.
    Bit { shift: Option<u32>, value: bool },
    /// A number is set to 0, a text to an empty one.
    Zero,
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
    /// Where it is as RCV.
    pub span: Span,
    /// The call that reaches the counter, when it is not in the POU itself.
    pub through: Option<Location>,
    /// Whether the user knows that no restart restores it.
    pub told: bool,
}

/// A count that is kept in a variable that is not.
pub(crate) fn lost_count(span: Span) -> Diagnostic {
    Diagnostic::new(Code::W0301, span, "this count will not survive a restart")
        .label("the variable is not RETAIN")
        .help("declare it in VAR RETAIN")
}

pub(crate) fn assigned_count(span: Span, counter: Span) -> Diagnostic {
    Diagnostic::new(Code::E0315, span, "the variable that keeps a counter's count is assigned")
        .label("only the counter may write it")
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
        Projection::Field(_) | Projection::Deref { .. } => None,
    });
    indices.filter(|it| it.as_const().is_none()).collect()
}

/// Whether two expressions are one, but for where they are.
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

/// Whether two places are one, whatever their indices are.
pub(crate) fn is_same_place(a: &Place, b: &Place) -> bool {
    let same = |(a, b): (&Projection, &Projection)| match (a, b) {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { index: a, .. }, Projection::Index { index: b, .. }) => is_same_value(a, b),
        (Projection::Deref { .. }, Projection::Deref { .. }) => true,
        (Projection::Field(_) | Projection::Index { .. } | Projection::Deref { .. }, _) => false,
    };
    a.root == b.root && a.projections.len() == b.projections.len() && a.projections.iter().zip(&b.projections).all(same)
}

/// Whether two places surely are, or by an index may be, the same.
pub(crate) fn same_storage(a: &Place, b: &Place) -> bool {
    a.projections.len() == b.projections.len() && alias::may_hold(a, b)
}
