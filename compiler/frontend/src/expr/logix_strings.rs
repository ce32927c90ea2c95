//! Instructions of Logix whose last operand is a destination, by Rockwell 1756-RM003, *ASCII String Instructions*, *ASCII
//! Conversion Instructions* and *Move/Logical Instructions*: each is answered with what is written for it here.

use super::checker::Checker;
use crate::names::{Found, Meaning, Sense};
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast, LiteralValue};
use staunch_runtime::Family;

/// The name, the operands in their order, and what is written: `{1}` is the first operand.
type Instruction = (&'static str, &'static [&'static str], &'static str);

const INSTRUCTIONS: [Instruction; 14] = [
    ("CONCAT", &["SourceA", "SourceB", "Dest"], "write `{3} := CONCAT({1}, {2});`"),
    ("MID", &["Source", "Qty", "Start", "Dest"], "write `{4} := MID({1}, {2}, {3});`"),
    ("DELETE", &["Source", "Qty", "Start", "Dest"], "write `{4} := DELETE({1}, {2}, {3});`"),
    ("INSERT", &["SourceA", "SourceB", "Start", "Dest"], "write `{4} := INSERT({1}, {2}, {3-1});`"),
    ("FIND", &["Source", "Search", "Start", "Result"], "write `{4} := FIND({1}, {2});`{from}"),
    ("DTOS", &["Source", "Dest"], "write `{2} := DINT_TO_STRING({1});`"),
    ("STOD", &["Source", "Dest"], "write `{2} := STRING_TO_DINT({1});`"),
    ("RTOS", &["Source", "Dest"], "write `{2} := REAL_TO_STRING({1});`"),
    ("STOR", &["Source", "Dest"], "write `{2} := STRING_TO_REAL({1});`"),
    ("UPPER", &["Source", "Dest"], "replace its characters one by one, with `MID` and `REPLACE`"),
    ("LOWER", &["Source", "Dest"], "replace its characters one by one, with `MID` and `REPLACE`"),
    (
        "SWPB",
        &["Source", "Order", "Dest"],
        "rotate the bytes; for an INT: `{3} := WORD_TO_INT(ROL(INT_TO_WORD({1}), 8));`",
    ),
    ("BTDT", &["BTDT_tag"], "assign the bits: `dest := target; dest.4 := source.0;`"),
    ("MVMT", &["MVMT_tag"], "combine the operands: `dest := (dest AND NOT mask) OR (source AND mask);`"),
];

impl<'s> Checker<'_, 's> {
    /// Answers a statement that is such an instruction; whether it is one.
    pub(super) fn has_destination(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>], span: Span) -> bool {
        let Some((word, operands, form)) = INSTRUCTIONS.iter().find(|it| it.0.eq_ignore_ascii_case(name.text)) else {
            return false;
        };
        let given: Option<Vec<_>> = arguments.iter().map(positional).collect();
        let is_function = match self.decl.lookup(&[name], Sense::Function) {
            Found::One(Meaning::Function) => true,
            Found::Nothing => false,
            Found::One(_) | Found::Several(_) => return false,
        };
        let is_own = self.is_callable_variable(name) || self.own_routine(name).is_some();
        if is_own || self.decl.dialect(name.span).family() != Family::Logix {
            return false;
        }
        let given = given.filter(|it| it.len() == operands.len());
        if is_function && given.is_none() {
            return false;
        }
        let takes = operands.join(", ");
        let message = format!("the instruction `{word}({takes})` of Logix is not supported");
        let label = if is_function { "`{}` is a function here" } else { "this dialect has no such function" };
        let mut error = Diagnostic::new(Code::E0902, if is_function { span } else { name.span }, message)
            .label(label.replace("{}", word));
        let help = match given {
            Some(given) => Some(self.written(form, &given)),
            None => Some((*form).to_owned()).filter(|it| !it.contains('{')),
        };
        if let Some(help) = help {
            error = error.help(help);
        }
        self.report(error);
        true
    }

    /// What is written for an instruction with these operands.
    fn written(&self, form: &str, given: &[&ast::Expr<'s>]) -> String {
        let text = |at: usize| given.get(at).map_or("", |it| self.decl.log.sources.text(it.span));
        let start = given.get(2).and_then(|it| number(it));
        // Where Logix begins with the character at a position, the standard begins after it.
        let before = start.map_or_else(|| format!("{} - 1", text(2)), |it| it.saturating_sub(1).to_string());
        let from = match start {
            Some(1) => "",
            Some(_) | None => ", which searches from the first character on",
        };
        let mut help = form.replace("{3-1}", &before).replace("{from}", from);
        for at in 0..given.len() {
            help = help.replace(&format!("{{{}}}", at + 1), text(at));
        }
        help
    }
}

fn positional<'a, 's>(argument: &'a ast::Argument<'s>) -> Option<&'a ast::Expr<'s>> {
    match &argument.kind {
        ArgumentKind::Positional(value) => Some(value),
        ArgumentKind::Input(..) | ArgumentKind::Output { .. } => None,
    }
}

fn number(expr: &ast::Expr<'_>) -> Option<u64> {
    match &expr.kind {
        Ast::Literal(ast::Literal { value: LiteralValue::Integer { value, .. }, .. }) => Some(*value),
        _ => None,
    }
}
