//! Sequential function charts as text (IEC 61131-3, edition 2, B.1.6): INITIAL_STEP, STEP and TRANSITION, with the ACTIONs of the
//! POU. Their words are names everywhere else.

use crate::{
    ast::{Association, Chart, Name, Pou, PouKind, Qualifier, Step, Transition},
    lex::Kind,
};

use super::{
    diagnostics,
    expression::expression,
    parser::{Expected, In, Parsed, Problem, TokenReader},
    routine,
    token_class::{is_pou_end, opens_item},
};

const INITIAL: &str = "INITIAL_STEP";
const STEP: &str = "STEP";
const END_STEP: &str = "END_STEP";
const TRANSITION: &str = "TRANSITION";
const END_TRANSITION: &str = "END_TRANSITION";

/// Whether a step or a transition begins here. Statements rarely have a name or a keyword as their second word.
pub fn begins(input: &mut In<'_, '_, '_>) -> bool {
    match input.kind_ahead(1) {
        Kind::Assign | Kind::Dot | Kind::Semicolon | Kind::OpenBracket | Kind::Caret | Kind::Colon => false,
        Kind::OpenParen => input.is_word(TRANSITION) && has_priority(input),
        Kind::Name => [INITIAL, STEP, TRANSITION].iter().any(|it| input.is_word(it)) || begins_in_two_words(input),
        Kind::To => input.is_word(TRANSITION),
        next => {
            let is_named = next.keyword().is_some() && input.kind_ahead(2) == Kind::Colon;
            is_named && (input.is_word(INITIAL) || input.is_word(STEP))
        }
    }
}

/// Whether `TRANSITION (PRIORITY …` is here, and no call.
fn has_priority(input: &mut In<'_, '_, '_>) -> bool {
    let ahead = if input.kind_ahead(1) == Kind::OpenParen { 2 } else { 1 };
    is_word_ahead(input, ahead, "PRIORITY") || input.kind() == Kind::OpenParen && is_word_ahead(input, 1, "PRIORITY")
}

/// `INITIAL STEP`
fn begins_in_two_words(input: &mut In<'_, '_, '_>) -> bool {
    input.is_word("INITIAL") && is_word_ahead(input, 1, STEP)
}

fn is_word_ahead(input: &mut In<'_, '_, '_>, ahead: usize, word: &str) -> bool {
    input.kind_ahead(ahead) == Kind::Name && {
        let at = input.number() + ahead;
        let place = input.state().place(at);
        input.text(place).eq_ignore_ascii_case(word)
    }
}

/// Takes a step or a transition that begins here into its POU.
pub fn element<'s>(input: &mut In<'_, '_, 's>, owner: &mut Pou<'s>) -> bool {
    if !begins(input) {
        return false;
    }
    let span = input.here();
    if !matches!(owner.kind, PouKind::Program | PouKind::FunctionBlock) {
        input.report(diagnostics::chart_outside(span, owner.kind));
        skip_chart(input);
        return true;
    }
    let empty = || Box::new(Chart { steps: Vec::new(), transitions: Vec::new(), span });
    let chart = owner.chart.get_or_insert_with(empty);
    let is_transition = input.is_word(TRANSITION);
    let read = match is_transition {
        true => transition(input).map(|it| chart.transitions.push(it)),
        false => step(input, &mut chart.steps),
    };
    if let Err(problem) = read {
        diagnostics::report(input, problem);
        skip_element(input, if is_transition { END_TRANSITION } else { END_STEP });
    }
    true
}

/// What is read of a step is kept, so that it is known where something after it is wrong.
fn step<'s>(input: &mut In<'_, '_, 's>, steps: &mut Vec<Step<'s>>) -> Parsed<()> {
    let in_two_words = begins_in_two_words(input);
    let is_initial = in_two_words || input.is_word(INITIAL);
    let mut opened = input.take();
    if in_two_words {
        opened = opened.to(input.take());
        input.report(diagnostics::initial_step_in_two_words(opened));
    }
    let name = input.name()?;
    let at = steps.len();
    steps.push(Step { name, is_initial, associations: Vec::new() });
    input.expect(Kind::Colon)?;
    while !input.is_word(END_STEP) {
        if input.eat(Kind::Semicolon).is_some() {
            continue;
        }
        if is_outside(input) {
            input.report(diagnostics::open_element(opened, END_STEP));
            return Ok(());
        }
        steps[at].associations.push(association(input)?);
    }
    input.take();
    input.eat(Kind::Semicolon);
    Ok(())
}

/// `Fill(L, T#5s);`, which may name variables that show something of it.
fn association<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Association<'s>> {
    let action = input.name()?;
    input.expect(Kind::OpenParen)?;
    let mut qualifier = None;
    let mut time = None;
    if input.kind() != Kind::CloseParen {
        let word = input.name()?;
        let named = Qualifier::named(word.text);
        if named.is_none() {
            input.report(diagnostics::unknown_qualifier(word));
        }
        qualifier = Some(named.unwrap_or(Qualifier::While));
        if named.is_some_and(Qualifier::is_timed) {
            if input.eat(Kind::Comma).is_none() {
                input.report(diagnostics::qualifier_without_time(word));
            } else {
                time = Some(expression(input)?);
            }
        } else if input.kind() == Kind::Comma && named.is_some() && has_duration(input) {
            let comma = input.take();
            let value = expression(input)?;
            input.report(diagnostics::qualifier_with_time(word, comma.to(value.span)));
        }
        while input.eat(Kind::Comma).is_some() {
            expression(input)?;
        }
    }
    input.expect(Kind::CloseParen)?;
    let span = action.span.to(input.last());
    if input.eat(Kind::Semicolon).is_none() {
        end(input, END_STEP)?;
    }
    Ok(Association { action, qualifier, time, span })
}

/// Whether what follows the comma is a duration, and no variable.
fn has_duration(input: &mut In<'_, '_, '_>) -> bool {
    input.kind_ahead(1) != Kind::Name
}

fn transition<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Transition<'s>> {
    let span = input.take();
    // Its own name says nothing, and may be FROM.
    let next = input.kind_ahead(1);
    let is_name = !input.is_word("FROM") || next == Kind::OpenParen && has_priority(input);
    if input.kind() == Kind::Name && is_name {
        input.take();
    }
    let mut priority = None;
    if input.eat(Kind::OpenParen).is_some() {
        if !input.is_word("PRIORITY") {
            return Err(input.problem(Expected::Name));
        }
        let word = input.take();
        priority = priority_after(input);
        if priority.is_none() {
            input.report(diagnostics::wrong_priority(word));
            while !matches!(input.kind(), Kind::CloseParen | Kind::Semicolon | Kind::End) {
                input.take();
            }
        }
        input.expect(Kind::CloseParen)?;
    }
    if !input.is_word("FROM") {
        let here = input.here();
        input.report(diagnostics::transition_without_steps(here));
        return Err(Problem::REPORTED);
    }
    input.take();
    let from = steps(input)?;
    input.expect(Kind::To)?;
    let to = steps(input)?;
    if input.kind() == Kind::Colon {
        let colon = input.here();
        input.report(
            diagnostics::unsupported(colon, "a condition in Instruction List (IL)").help("write `:= condition;`"),
        );
        return Err(Problem::REPORTED);
    }
    input.expect(Kind::Assign)?;
    let condition = expression(input)?;
    if input.eat(Kind::Semicolon).is_none() {
        end(input, END_TRANSITION)?;
    }
    if input.is_word(END_TRANSITION) {
        input.take();
        input.eat(Kind::Semicolon);
    } else {
        input.report(diagnostics::open_element(span, END_TRANSITION));
        if !is_outside(input) {
            skip_element(input, END_TRANSITION);
        }
    }
    Ok(Transition { priority, from, to, condition, span })
}

/// `:= 1`
fn priority_after(input: &mut In<'_, '_, '_>) -> Option<u64> {
    input.eat(Kind::Assign)?;
    let number = input.eat(Kind::Integer)?;
    input.text(number).replace('_', "").parse().ok()
}

/// `a`, or `(a, b)`.
fn steps<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Vec<Name<'s>>> {
    if input.eat(Kind::OpenParen).is_none() {
        return Ok(vec![input.name()?]);
    }
    let mut names = vec![input.name()?];
    while input.eat(Kind::Comma).is_some() {
        names.push(input.name()?);
    }
    input.expect(Kind::CloseParen)?;
    Ok(names)
}

/// The `;` before what ends an element is missing.
fn end(input: &mut In<'_, '_, '_>, end: &str) -> Parsed<()> {
    if !input.is_word(end) && !input.on_new_line() {
        return Err(input.problem(Expected::Token(Kind::Semicolon)));
    }
    diagnostics::missing_semicolon(input);
    Ok(())
}

/// Whether the POU continues with something else, or ends.
fn is_outside(input: &mut In<'_, '_, '_>) -> bool {
    let kind = input.kind();
    kind == Kind::End || is_pou_end(kind) || opens_item(kind) || begins(input) || routine::begins(input).is_some()
}

/// Behind the end of an element that is not read.
fn skip_element(input: &mut In<'_, '_, '_>, end: &str) {
    while !is_outside(input) {
        let is_end = input.is_word(end);
        input.take();
        if is_end {
            input.eat(Kind::Semicolon);
            return;
        }
    }
}

/// To the end of what a chart cannot be in.
fn skip_chart(input: &mut In<'_, '_, '_>) {
    let end = input.state().open.last().map(|it| it.0);
    while !matches!(input.kind(), Kind::End) && !opens_item(input.kind()) && !is_pou_end(input.kind()) {
        if Some(input.kind()) == end {
            break;
        }
        input.take();
    }
}
