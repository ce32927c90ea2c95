//! `{attribute 'startup'}`: a PROGRAM that runs once after each start, before the others, as a start-up OB of S7 does. Its body is in an IF
//! from then on; where the instances are, it is the first.

use crate::Span;
use crate::added::STARTED_UP;
use crate::ast::{Expr, ExprKind, File, Item, LiteralValue, Pou, PouKind, Statement, StatementKind, UnaryOp};
use crate::testing::tree::{assign, literal, named, variables};

const STARTUP: &str = "startup";

/// Has the bodies of start-up PROGRAMs run once.
pub(crate) fn expand(files: &mut [File<'_>]) {
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        if let Item::Pou(pou) = item
            && is_start_up(pou)
        {
            run_once(pou);
        }
    }
}

pub(crate) fn is_start_up(pou: &Pou<'_>) -> bool {
    pou.kind == PouKind::Program && pou.attributes.iter().any(|it| it.eq_ignore_ascii_case(STARTUP))
}

fn run_once(pou: &mut Pou<'_>) {
    let at = pou.name.span;
    pou.blocks.push(variables(&[(STARTED_UP, &["BOOL"])], at));
    pou.body = vec![once(std::mem::take(&mut pou.body), at)];
}

/// The statements in `IF NOT flag THEN flag := TRUE; … END_IF`.
pub(crate) fn once<'s>(mut body: Vec<Statement<'s>>, at: Span) -> Statement<'s> {
    let open = Expr { kind: ExprKind::Unary(UnaryOp::Not, Box::new(named(STARTED_UP, at))), span: at };
    let mut then = vec![assign(STARTED_UP, literal(LiteralValue::Bool(true), at))];
    then.append(&mut body);
    let kind = StatementKind::If { branches: vec![(open, then)], otherwise: None };
    Statement { kind, span: at }
}
