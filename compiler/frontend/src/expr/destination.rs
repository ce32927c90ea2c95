//! Instructions of Logix whose last operand is a destination, by Rockwell 1756-RM003, *ASCII String Instructions*, *ASCII
//! Conversion Instructions* and *Move/Logical Instructions*: each assigns the value of a function. An instruction that is not
//! supported is answered with the text that replaces it.

use super::checker::Checker;
use crate::index::recorder::Named;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast, LiteralValue};
use staunch_ir::{Elementary, Type};
use staunch_runtime::Family;
use std::slice::from_ref;

/// Where the value of an instruction comes from.
#[derive(Clone, Copy)]
enum Value {
    /// A function of the operands before the destination.
    Of(&'static str),
    /// `FIND`: the function begins at the first character, the instruction at `Start`.
    FoundFrom(&'static str),
    /// `INSERT`: the function inserts after a position, the instruction before it.
    InsertedBefore,
    /// A function of texts up to a length.
    OfText(&'static str),
    /// `SWPB`: a function of 32 bits, and of the order by its number.
    Swapped { wide: &'static str, narrow: &'static str },
    /// What is written instead: `{1}` is the first operand.
    NotSupported(&'static str),
}

struct Instruction {
    name: &'static str,
    operands: &'static [&'static str],
    value: Value,
}

const fn row(name: &'static str, operands: &'static [&'static str], value: Value) -> Instruction {
    Instruction { name, operands, value }
}

const INSTRUCTIONS: [Instruction; 14] = [
    row("CONCAT", &["SourceA", "SourceB", "Dest"], Value::Of("CONCAT")),
    row("MID", &["Source", "Qty", "Start", "Dest"], Value::Of("MID")),
    row("DELETE", &["Source", "Qty", "Start", "Dest"], Value::Of("DELETE")),
    row("INSERT", &["SourceA", "SourceB", "Start", "Dest"], Value::InsertedBefore),
    row("FIND", &["Source", "Search", "Start", "Result"], Value::FoundFrom("__FindFrom")),
    row("DTOS", &["Source", "Dest"], Value::Of("DINT_TO_STRING")),
    row("STOD", &["Source", "Dest"], Value::OfText("STOD")),
    row("RTOS", &["Source", "Dest"], Value::NotSupported("write `{2} := REAL_TO_STRING({1});`")),
    row("STOR", &["Source", "Dest"], Value::NotSupported("write `{2} := STRING_TO_REAL({1});`")),
    row("UPPER", &["Source", "Dest"], Value::OfText("UPPER")),
    row("LOWER", &["Source", "Dest"], Value::OfText("LOWER")),
    row("SWPB", &["Source", "Order", "Dest"], Value::Swapped { wide: "SWPB", narrow: "__SwapTwo" }),
    row("BTDT", &["BTDT_tag"], Value::NotSupported("assign the bits: `dest := target; dest.4 := source.0;`")),
    row(
        "MVMT",
        &["MVMT_tag"],
        Value::NotSupported("combine the operands: `dest := (dest AND NOT mask) OR (source AND mask);`"),
    ),
];

/// The orders of `SWPB`, each at its number.
const ORDERS: [&str; 3] = ["REVERSE", "WORD", "HIGHLOW"];

/// Texts that the library's functions take whole.
const LONGEST: u16 = 255;

impl<'s> Checker<'_, 's> {
    /// Checks a statement that is such an instruction; whether it is one.
    pub(super) fn has_destination(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>], span: Span) -> bool {
        let Some(instruction) = INSTRUCTIONS.iter().find(|it| it.name.eq_ignore_ascii_case(name.text)) else {
            return false;
        };
        if self.decl.dialect(name.span).family() != Family::Logix || self.is_declared_otherwise(name) {
            return false;
        }
        let given: Option<Vec<_>> = arguments.iter().map(positional).collect();
        let given = given.filter(|it| it.len() == instruction.operands.len());
        // Its value may be wanted, with the operands that the function has.
        let is_function = !matches!(self.decl.lookup(&[name], Sense::Function), Found::Nothing);
        match (instruction.value, given) {
            (Value::NotSupported(form), given) => self.refuse_instruction(name, instruction, form, given),
            (_, None) if is_function => return false,
            (_, None) => {
                let message = format!("`{}` takes {} operands", instruction.name, instruction.operands.len());
                let operands = instruction.operands.join(", ");
                self.report(Diagnostic::new(Code::E0302, span, message).label(format!("its operands are {operands}")));
                self.check_arguments(arguments);
            }
            (value, Some(given)) => drop(self.assign_value(value, name, &given, span)),
        }
        true
    }

    /// Whether a program has something of its own under the instruction's name.
    fn is_declared_otherwise(&mut self, name: ast::Name<'s>) -> bool {
        let is_own = match self.decl.lookup(&[name], Sense::Function) {
            Found::One(Meaning::Function) | Found::Nothing => false,
            Found::One(Meaning::Declared(Entry::Pou(slot))) => {
                !self.decl.log.sources.get(self.decl.pous[slot].ast.span.file).is_bundled()
            }
            Found::One(_) | Found::Several(_) => true,
        };
        is_own || self.is_callable_variable(name) || self.own_routine(name).is_some()
    }

    /// Assigns the value of an instruction to its last operand.
    fn assign_value(&mut self, value: Value, name: ast::Name<'s>, given: &[&ast::Expr<'s>], span: Span) -> Option<()> {
        let (target, operands) = given.split_last()?;
        let mut operands: Vec<ast::Expr<'s>> = operands.iter().map(|it| (*it).clone()).collect();
        let function = match value {
            Value::Of(function) => function,
            Value::OfText(function) => {
                self.takes_whole(&operands[0], name)?;
                function
            }
            Value::FoundFrom(function) => match number(&operands[2]) {
                Some(1) => {
                    operands.pop();
                    name.text
                }
                _ => {
                    self.takes_whole(&operands[0], name)?;
                    self.takes_whole(&operands[1], name)?;
                    function
                }
            },
            Value::InsertedBefore => {
                operands[2] = one_less(&operands[2]);
                name.text
            }
            Value::Swapped { wide, narrow } => {
                let order = self.order(&operands[1])?;
                let source = operands.swap_remove(0);
                match self.static_type(&source)? {
                    Type::Elementary(Elementary::Int) => {
                        operands = vec![source];
                        narrow
                    }
                    Type::Elementary(Elementary::Dint) => {
                        operands = vec![source, integer(order, given[1].span)];
                        wide
                    }
                    other => {
                        let ty = self.type_name(other);
                        let message = format!("`SWPB` swaps the bytes of an INT or a DINT, but this is {ty}");
                        self.report(Diagnostic::new(Code::E0201, source.span, message).label("expected INT or DINT"));
                        return None;
                    }
                }
            }
            Value::NotSupported(_) => return None,
        };
        let callee = ast::Expr { kind: Ast::Name(ast::Name { text: function, span: name.span }), span: name.span };
        let argument = |it: ast::Expr<'s>| ast::Argument { span: it.span, kind: ArgumentKind::Positional(it) };
        let call = Ast::Call(Box::new(callee), operands.into_iter().map(argument).collect());
        self.assigned(from_ref(*target), &ast::Expr { kind: call, span }, span, false).map(drop)
    }

    /// Refuses a text that is longer than the library's function takes.
    fn takes_whole(&mut self, text: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<()> {
        let capacity = self.static_type(text).and_then(Type::string_type).map_or(0, |it| it.capacity);
        if capacity <= LONGEST {
            return Some(());
        }
        let what = format!("`{}` of a text of more than {LONGEST} characters", name.text.to_ascii_uppercase());
        self.decl.not_supported(text.span, &what);
        None
    }

    /// The number of an order of `SWPB`.
    fn order(&mut self, written: &ast::Expr<'s>) -> Option<u64> {
        let named = match &written.kind {
            Ast::Name(name) => ORDERS.iter().position(|it| it.eq_ignore_ascii_case(name.text)),
            _ => None,
        };
        if named.is_some() {
            self.decl.log.note(written.span, || Named::Word);
        }
        let order = named.and_then(|it| u64::try_from(it).ok()).or_else(|| number(written).filter(|it| *it < 3));
        if order.is_none() {
            let text = self.decl.log.sources.text(written.span);
            let message = format!("`{text}` is not an order of bytes");
            self.report(
                Diagnostic::new(Code::E0201, written.span, message).label("expected `REVERSE`, `WORD` or `HIGHLOW`"),
            );
        }
        order
    }

    fn refuse_instruction(
        &mut self,
        name: ast::Name<'s>,
        instruction: &Instruction,
        form: &str,
        given: Option<Vec<&ast::Expr<'s>>>,
    ) {
        let (word, takes) = (instruction.name, instruction.operands.join(", "));
        let message = format!("the instruction `{word}({takes})` of Logix is not supported");
        let error = Diagnostic::new(Code::E0902, name.span, message).label("this dialect has no such function");
        let text = |it: &&ast::Expr<'s>| self.decl.log.sources.text(it.span);
        let help = match given {
            Some(given) => Some((1..).zip(&given).fold(form.to_owned(), |help, (number, operand)| {
                help.replace(&format!("{{{number}}}"), text(operand))
            })),
            None => Some(form.to_owned()).filter(|it| !it.contains('{')),
        };
        self.report(match help {
            Some(help) => error.help(help),
            None => error,
        });
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

fn integer<'s>(value: u64, span: Span) -> ast::Expr<'s> {
    let literal = ast::Literal { prefix: None, value: LiteralValue::Integer { value, based: false } };
    ast::Expr { kind: Ast::Literal(literal), span }
}

fn one_less<'s>(expr: &ast::Expr<'s>) -> ast::Expr<'s> {
    let span = expr.span;
    match number(expr).and_then(|it| it.checked_sub(1)) {
        Some(value) => integer(value, span),
        None => {
            let sides = Box::new([expr.clone(), integer(1, span)]);
            ast::Expr { kind: Ast::Binary(sides, ast::BinaryOp::Sub, span), span }
        }
    }
}
