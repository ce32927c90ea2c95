//! `MOCK instance` and `MOCK_FUNCTION name RETURNS value`, the statements that only unit tests have. They
//! become calls of those words.

use crate::{
    ast::{Argument, ArgumentKind, Expr, ExprKind, Name},
    lex::Kind,
};

use super::{
    expression::{expression, postfix},
    parser::{In, Parsed, TokenReader},
};

/// Whether one begins here: no other statement has two names in a row.
pub fn begins(input: &mut In<'_, '_, '_>) -> bool {
    let word = input.here();
    let word = input.text(word);
    let is_mock = ["MOCK", "MOCK_FUNCTION"].iter().any(|it| word.eq_ignore_ascii_case(it));
    is_mock && input.kind_ahead(1) == Kind::Name
}

pub fn mock<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Expr<'s>> {
    let span = input.take();
    let callee = Expr { kind: ExprKind::Name(Name { text: input.text(span), span }), span };
    let mut arguments = vec![argument(postfix(input)?)];
    if input.is_word("RETURNS") {
        input.take();
        arguments.push(argument(expression(input)?));
    }
    Ok(Expr { kind: ExprKind::Call(Box::new(callee), arguments), span: span.to(input.last()) })
}

fn argument(value: Expr<'_>) -> Argument<'_> {
    Argument { span: value.span, kind: ArgumentKind::Positional(value) }
}
