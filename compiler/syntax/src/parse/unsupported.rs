//! Constructs that are known and refused by name: JMP and VAR_GENERIC.
//! Their words are names everywhere else.

use crate::{
    ast::{Expr, ExprKind, TypeKind, VarBlock},
    lex::{Kind, index},
    spelling::Key,
    vendor::controller_service,
};

use super::{
    combinator::{Rule, rule},
    diagnostics,
    parser::{In, TokenReader},
    recovery,
    token_class::{is_pou_end, opens_item},
};

/// Whether `JMP label` is here.
pub fn begins_jump(input: &mut In<'_, '_, '_>) -> bool {
    input.is_word("JMP") && input.kind_ahead(1) == Kind::Name
}

/// Refuses and skips such a construct, if one starts here.
pub fn skip(input: &mut In<'_, '_, '_>) -> bool {
    let span = input.here();
    let word = input.text(span);
    if let Some(service) = controller_service(word).filter(|_| has_operands_that_are_no_values(input)) {
        input.report(diagnostics::controller_service(span, word, service));
        recovery::skip_operands(input);
        return true;
    }
    if begins_generic(input) {
        generic_constants(input);
        recovery::skip_section(input);
        return true;
    }
    false
}

/// Whether `VAR_GENERIC CONSTANT` begins here.
pub fn begins_generic(input: &mut In<'_, '_, '_>) -> bool {
    input.is_word("VAR_GENERIC") && matches!(input.kind_ahead(1), Kind::Constant | Kind::Name)
}

/// Refuses generic constants, whose declarations are next.
pub fn generic_constants(input: &mut In<'_, '_, '_>) {
    let span = input.take();
    input.report(
        diagnostics::unsupported(span, "VAR_GENERIC CONSTANT")
            .help("declare a VAR_GLOBAL CONSTANT, or an `ARRAY[*]` in VAR_IN_OUT"),
    );
}

/// The variables of a section, whose types and values nobody knows.
pub fn unknown(mut section: VarBlock<'_>) -> VarBlock<'_> {
    section.constant = None;
    for decl in &mut section.vars {
        decl.ty.kind = TypeKind::Error;
        decl.initial = None;
    }
    section
}

/// Values of generic constants, which are refused where they are.
pub fn generic_values<'t, 's: 't>() -> impl Rule<'t, 's, ()> {
    rule(|input| {
        generic_arguments(input);
        Ok(())
    })
}

/// Refuses and passes over `<5, MOST>` after the name of a FUNCTION_BLOCK: what its generic constants are.
fn generic_arguments(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind() != Kind::Less {
        return false;
    }
    let first = input.here();
    let mut ahead = 0;
    while input.kind_ahead(ahead) != Kind::Greater {
        if matches!(input.kind_ahead(ahead), Kind::Semicolon | Kind::Assign | Kind::End) {
            return false;
        }
        ahead += 1;
    }
    for _ in 0..=ahead {
        input.take();
    }
    let span = first.to(input.last());
    input.report(
        diagnostics::unsupported(span, "VAR_GENERIC CONSTANT, which is given its values here,").help(
            "write a FUNCTION_BLOCK with a VAR CONSTANT for each of these values, or an `ARRAY[*]` in VAR_IN_OUT",
        ),
    );
    true
}

/// Refuses and passes over `POINTER TO T` where a value is asked for: `__NEW(POINTER TO T, 4)`.
pub fn reference_type<'s>(input: &mut In<'_, '_, 's>) -> Option<Expr<'s>> {
    let start = input.here();
    let word = input.text(start);
    let is_word = ["POINTER", "REFERENCE"].iter().any(|it| word.eq_ignore_ascii_case(it));
    if input.kind() != Kind::Name || input.kind_ahead(1) != Kind::To || !is_word {
        return None;
    }
    while !matches!(input.kind(), Kind::Comma | Kind::CloseParen | Kind::Semicolon | Kind::End) {
        input.take();
    }
    let span = start.to(input.last());
    input.report(
        diagnostics::unsupported(span, "the type of a reference as an argument")
            .help("declare a STRUCT with the reference as its member, and name that"),
    );
    Some(Expr { kind: ExprKind::Error(Vec::new()), span })
}

/// Whether a JMP of the file names this label.
pub fn is_jumped_to<'s>(input: &mut In<'_, '_, 's>, label: &'s str) -> bool {
    let state = input.state();
    let tokens = state.tokens;
    let text = state.text;
    let targets = state.jumped_to.get_or_insert_with(|| {
        let word = |at: usize| {
            let (start, end) = *tokens.places.get(at)?;
            text.get(index(start)..index(end))
        };
        let is_jump = |at: &usize| word(*at).is_some_and(|it| it.eq_ignore_ascii_case("JMP"));
        let names = (0..tokens.kinds.len()).filter(|it| tokens.kinds[*it] == Kind::Name);
        names.filter(is_jump).filter_map(|it| word(it + 1)).map(Key).collect()
    });
    targets.contains(&Key(label))
}

/// `GSV(WallClockTime,, LocalDateTime, now[0])`, `GSV(Program, THIS, …)`: an operand is left out, or a keyword.
fn has_operands_that_are_no_values(input: &mut In<'_, '_, '_>) -> bool {
    let mut depth = 0;
    for at in 1.. {
        let kind = input.kind_ahead(at);
        match kind {
            Kind::OpenParen | Kind::OpenBracket => depth += 1,
            Kind::CloseParen | Kind::CloseBracket => depth -= 1,
            _ => {}
        }
        if depth == 0 || matches!(kind, Kind::End | Kind::Semicolon) {
            return false;
        }
        let is_end = |it: Kind| matches!(it, Kind::Comma | Kind::CloseParen);
        let starts_operand = depth == 1 && matches!(kind, Kind::OpenParen | Kind::Comma);
        let (next, after) = (input.kind_ahead(at + 1), input.kind_ahead(at + 2));
        // `Mag();` is a call of an instance: all of these instructions that are written so have operands.
        if at == 1 && next == Kind::CloseParen {
            return false;
        }
        if starts_operand && (is_end(next) || next.keyword().is_some() && is_end(after)) {
            return true;
        }
    }
    false
}

/// Behind the construct's end; a construct without one ends before the next POU.
pub fn skip_construct(input: &mut In<'_, '_, '_>, end: Kind) {
    loop {
        let kind = input.kind();
        let leaves = opens_item(kind) || is_pou_end(kind);
        if kind == Kind::End || leaves {
            return;
        }
        input.take();
        if kind == end {
            input.eat(Kind::Semicolon);
            return;
        }
    }
}
