//! Statements and lists of them. A statement that does not parse is reported where it breaks,
//! and reading continues at the next one.

use crate::{
    ast::{
        ArgumentKind, Arm, BinaryOp, Expr, ExprKind, Finally, Label, MAX_CHAIN, Name, Statement, StatementKind, Try,
        each_part,
    },
    diagnostic::Diagnostic,
    lex::Kind,
    source::Span,
};

use super::{
    block_ends, chart, declaration, diagnostics,
    expression::{condition, expression, is_latch, postfix, unary},
    foreign_block, foreign_expression, foreign_statement, foreign_syntax, misspelt, mock,
    parser::{Expected, In, Parsed, Problem, TokenReader, too_long},
    recovery, routine,
    token_class::{closes, ends_statements, opens_statement},
    unsupported,
};

/// Statements up to a keyword that ends or continues the block around them.
pub fn statements<'s>(input: &mut In<'_, '_, 's>) -> Vec<Statement<'s>> {
    let mut statements = Vec::new();
    list(input, &mut statements, |_| false);
    statements.shrink_to_fit();
    statements
}

fn list<'s>(
    input: &mut In<'_, '_, 's>,
    statements: &mut Vec<Statement<'s>>,
    ends: impl Fn(&mut In<'_, '_, 's>) -> bool,
) {
    loop {
        if foreign_statement::skip(input) || foreign_block::skip(input) {
            continue;
        }
        match input.kind() {
            // A run of `;` means no more than one.
            Kind::Semicolon => {
                let span = input.take();
                if !matches!(statements.last(), Some(Statement { kind: StatementKind::Empty, .. })) {
                    statements.push(Statement { kind: StatementKind::Empty, span });
                }
            }
            kind if ends_statements(kind) => {
                if !recovery::stray(input) {
                    return;
                }
            }
            _ if ends(input) || is_label_around(input) => return,
            Kind::Name if routine::begins(input).is_some() || chart::begins(input) => return,
            Kind::Name if unsupported::skip(input) || foreign_syntax::begin_or_end(input) => {}
            _ => statements.push(statement(input)),
        }
    }
}

/// Whether a label of a CASE is here that is around the block: that has no end of its own.
fn is_label_around(input: &mut In<'_, '_, '_>) -> bool {
    let is_within = matches!(input.state().open.as_slice(), [around @ .., (innermost, _)]
        if *innermost != Kind::EndCase && around.iter().any(|it| it.0 == Kind::EndCase));
    let may_begin = matches!(input.kind(), Kind::Integer | Kind::Based | Kind::Prefix | Kind::Name);
    is_within && may_begin && input.on_new_line() && is_clear_label(input)
}

/// Whether the tokens ahead are a label and a statement. `x : 5;` is an assignment with a misspelt sign.
fn is_clear_label(input: &mut In<'_, '_, '_>) -> bool {
    if is_jump_label(input) {
        return false;
    }
    let mut ahead = 0;
    while matches!(
        input.kind_ahead(ahead),
        Kind::Name | Kind::Dot | Kind::DotDot | Kind::Comma | Kind::Prefix | Kind::Integer | Kind::Based
    ) {
        ahead += 1;
    }
    let starts = matches!(
        input.kind_ahead(ahead + 1),
        Kind::Name | Kind::If | Kind::Case | Kind::For | Kind::While | Kind::Repeat | Kind::Semicolon
    );
    ahead > 0 && input.kind_ahead(ahead) == Kind::Colon && starts
}

fn statement<'s>(input: &mut In<'_, '_, 's>) -> Statement<'s> {
    let (before, start) = (input.save(), input.here());
    let depth = input.state().depth;
    let result = input.enter(1).and_then(|()| statement_kind(input));
    input.state().depth = depth;
    let kind = result.unwrap_or_else(|problem| {
        recovery::statement(input, problem, before);
        StatementKind::Error
    });
    Statement { kind, span: start.to(input.last()) }
}

fn statement_kind<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    match input.kind() {
        Kind::If => if_statement(input),
        Kind::Case => case(input),
        Kind::For => for_loop(input),
        Kind::While => while_loop(input),
        Kind::Repeat => repeat(input),
        Kind::Try => try_statement(input),
        Kind::Exit => word(input, StatementKind::Exit),
        Kind::Continue => word(input, StatementKind::Continue),
        Kind::Return => return_statement(input),
        Kind::Name if unsupported::begins_jump(input) => {
            input.take();
            let span = input.take();
            let name = Name { text: input.text(span), span };
            end(input)?;
            Ok(StatementKind::Jump(name))
        }
        Kind::Name if is_declaration(input) => stray_declaration(input),
        Kind::Name if mock::begins(input) => {
            let call = mock::mock(input)?;
            end(input)?;
            Ok(StatementKind::Expr(call))
        }
        _ => simple(input),
    }
}

fn word<'s>(input: &mut In<'_, '_, 's>, kind: StatementKind<'s>) -> Parsed<StatementKind<'s>> {
    input.take();
    end(input)?;
    Ok(kind)
}

fn return_statement<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let word = input.take();
    if !recovery::begins_statement(input) && input.kind() != Kind::Semicolon {
        let is_condition = input.kind() == Kind::OpenParen;
        if is_condition && input.kind_ahead(1) == Kind::CloseParen {
            let parentheses = input.take().to(input.take());
            input.report(diagnostics::return_called(parentheses));
            end(input)?;
            return Ok(StatementKind::Return);
        }
        let value = expression(input)?;
        if is_condition {
            end(input)?;
            return Ok(StatementKind::ReturnIf(value));
        }
        input.report(diagnostics::return_value(word.to(value.span), value.span));
    }
    end(input)?;
    Ok(StatementKind::Return)
}

/// Whether a declaration is here: names, `:`, and what can only be a type.
fn is_declaration(input: &mut In<'_, '_, '_>) -> bool {
    let mut ahead = 1;
    while input.kind_ahead(ahead) == Kind::Comma && input.kind_ahead(ahead + 1) == Kind::Name {
        ahead += 2;
    }
    if input.kind_ahead(ahead) != Kind::Colon {
        return false;
    }
    match input.kind_ahead(ahead + 1) {
        Kind::Array | Kind::Struct => true,
        Kind::Name => {
            let at = input.number() + ahead + 1;
            let span = input.state().place(at);
            let word = input.text(span);
            ["STRING", "WSTRING"].iter().any(|it| word.eq_ignore_ascii_case(it))
                || staunch_ir::Elementary::named(word).is_some()
                || (ahead > 1 && input.kind_ahead(ahead + 2) == Kind::Semicolon)
        }
        _ => false,
    }
}

/// A declaration among statements. Those that follow one another are one mistake.
fn stray_declaration<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let at = input.number();
    let told = input.state().told_at == Some(at);
    let mut names = Vec::new();
    let found = declaration::declaration(input, &mut names)?;
    if !told {
        let closed = is_closed(input);
        diagnostics::stray_declaration(input, found.span, closed);
    }
    input.state().strays.push(found);
    let after = input.number();
    input.state().told_at = Some(after);
    if input.kind() == Kind::EndVar {
        input.take();
        input.eat(Kind::Semicolon);
    }
    Ok(StatementKind::Error)
}

/// Whether an END_VAR follows before anything else is opened or assigned.
fn is_closed(input: &mut In<'_, '_, '_>) -> bool {
    let mut ahead = 0;
    loop {
        match input.kind_ahead(ahead) {
            Kind::EndVar => return true,
            kind if ends_statements(kind) || opens_statement(kind) => return false,
            _ => ahead += 1,
        }
    }
}

/// The `;` of a statement, or a complaint that leaves what follows in place.
fn end(input: &mut In<'_, '_, '_>) -> Parsed<()> {
    foreign_syntax::extra_brackets(input, Kind::Semicolon);
    foreign_syntax::decimal_comma(input);
    if foreign_syntax::wrong_terminator(input) {
        return Ok(());
    }
    if input.eat(Kind::Semicolon).is_some() {
        return Ok(());
    }
    if recovery::begins_statement(input) {
        diagnostics::missing_semicolon(input);
        return Ok(());
    }
    Err(input.problem(Expected::Token(Kind::Semicolon)))
}

/// Assignments and calls.
fn simple<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let foreign = input.kind();
    let target = match foreign {
        Kind::Name | Kind::Address | Kind::OpenParen => postfix(input)?,
        _ => return Err(input.problem(Expected::Variable)),
    };
    let kind = match input.kind() {
        Kind::Assign => {
            input.take();
            assignment(input, target)?
        }
        Kind::Equal | Kind::EqualEqual => {
            let sign = input.take();
            let reversed = input.kind() == Kind::Colon && input.here().start == sign.end;
            let sign = if reversed { sign.to(input.take()) } else { sign };
            let it = diagnostics::equal_for_assign(sign, input.text(sign));
            input.report(it);
            assignment(input, target)?
        }
        Kind::OpenBracket => nonretentive(input, target)?,
        Kind::Colon => return split_assign(input, target),
        Kind::PlusEqual | Kind::MinusEqual | Kind::StarEqual | Kind::SlashEqual => combined(input, target)?,
        Kind::Attempt => {
            input.take();
            let value = expression(input)?;
            StatementKind::Attempt { target, value }
        }
        Kind::Name if input.state().has_access && input.is_word("ACCESS") => access(input, target)?,
        Kind::Name => latch(input, target)?,
        Kind::Semicolon if misspelt::is_misspelt(input, &target) => return Err(Problem::REPORTED),
        Kind::Semicolon => StatementKind::Expr(target),
        _ if matches!(target.kind, ExprKind::Call(..)) => StatementKind::Expr(target),
        _ => return without_effect(input, target),
    };
    end(input)?;
    Ok(kind)
}

/// `a += b` is `a := a + (b)`: `a` is found twice, so that no index of it may call anything.
fn combined<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    let op = match input.kind() {
        Kind::PlusEqual => BinaryOp::Add,
        Kind::MinusEqual => BinaryOp::Sub,
        Kind::StarEqual => BinaryOp::Mul,
        _ => BinaryOp::Div,
    };
    let problem = diagnostics::compound_assignment(input, &target);
    let sign = input.take();
    let mut calls = false;
    each_part(&target, &mut |it| calls |= matches!(it.kind, ExprKind::Call(..)));
    if calls {
        input.report(problem);
        return assignment(input, target);
    }
    input.state().combined.push(problem);
    let value = expression(input)?;
    let right = Expr { span: value.span, kind: ExprKind::Paren(Box::new(value)) };
    let span = target.span.to(right.span);
    let value = Expr { kind: ExprKind::Binary(Box::new([target.clone(), right]), op, sign), span };
    Ok(StatementKind::Assign { target, value })
}

/// `a [:=] b`
fn nonretentive<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    for _ in 0..3 {
        input.take();
    }
    input.state().nonretentive.push(target.span);
    let value = expression(input)?;
    Ok(StatementKind::Assign { target, value })
}

fn assignment<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    let mut value = expression(input)?;
    foreign_expression::cast_after(input, &mut value);
    if input.kind() != Kind::Assign {
        return Ok(StatementKind::Assign { target, value });
    }
    let mut targets = vec![target];
    while input.eat(Kind::Assign).is_some() {
        targets.push(std::mem::replace(&mut value, expression(input)?));
    }
    Ok(StatementKind::AssignAll { targets, value })
}

/// `x : = 1`, or a label to jump to.
fn split_assign<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    if input.kind_ahead(1) == Kind::Equal {
        let sign = input.take().to(input.last());
        let sign = sign.to(input.take());
        let it = diagnostics::equal_for_assign(sign, input.text(sign));
        input.report(it);
        let kind = assignment(input, target)?;
        end(input)?;
        return Ok(kind);
    }
    if let ExprKind::Name(name) = target.kind
        && (unsupported::is_jumped_to(input, name.text) || input.state().open.len() <= 1)
    {
        input.take();
        return Ok(StatementKind::Label(name));
    }
    Err(input.problem(Expected::Action))
}

/// `a S= b`, `a R= b`, `a S= b R= c`, `a REF= b`
fn latch<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    if !is_latch(input, 0) {
        foreign_statement::split_latch(input)?;
        return match target.kind {
            ExprKind::Call(..) => Ok(StatementKind::Expr(target)),
            _ => without_effect(input, target),
        };
    }
    let word = input.take();
    input.take();
    let mut value = expression(input)?;
    let Some(set) = sets(input.text(word)) else { return Ok(StatementKind::Bind { target, value }) };
    if !is_latch(input, 0) {
        return Ok(StatementKind::SetReset { target, value, set });
    }
    let mut targets = vec![(target, set)];
    while is_latch(input, 0)
        && let here = input.here()
        && let Some(set) = sets(input.text(here))
    {
        input.take();
        input.take();
        targets.push((std::mem::replace(&mut value, expression(input)?), set));
    }
    Ok(StatementKind::SetResetAll { targets, value })
}

/// `a ACCESS ADR(b)`: Automation Studio's words for `a REF= b`.
fn access<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    let word = input.take();
    let value = expression(input)?;
    let span = value.span;
    if let ExprKind::Call(callee, arguments) = value.kind
        && matches!(callee.kind, ExprKind::Name(name) if name.text.eq_ignore_ascii_case("ADR"))
        && let [argument] = arguments.as_slice()
        && let ArgumentKind::Positional(value) = &argument.kind
    {
        return Ok(StatementKind::Bind { target, value: value.clone() });
    }
    input.report(
        Diagnostic::unsupported(span, "an address that is a number, after ACCESS,")
            .label("expected `ADR(…)` of a variable")
            .other(word, "what this refers to is not known before the program runs"),
    );
    Err(Problem::REPORTED)
}

/// Whether the word before `=` sets, or resets.
fn sets(word: &str) -> Option<bool> {
    match word {
        "S" | "s" => Some(true),
        "R" | "r" => Some(false),
        _ => None,
    }
}

/// Something that is neither an assignment nor a call.
fn without_effect<'s>(input: &mut In<'_, '_, 's>, target: Expr<'s>) -> Parsed<StatementKind<'s>> {
    if diagnostics::increment(input, &target) {
        return Err(Problem::REPORTED);
    }
    let alone = input.on_new_line() || closes(input.kind()) || input.kind() == Kind::End;
    if alone && !misspelt::is_misspelt(input, &target) && input.text(target.span).len() <= 40 {
        diagnostics::name_alone(input, target.span);
        return Err(Problem::REPORTED);
    }
    Err(input.problem(Expected::Action))
}

/// The part between a keyword and THEN, DO or OF. None when it did not parse.
fn header<'s, T>(
    input: &mut In<'_, '_, 's>,
    ends: Kind,
    part: impl FnOnce(&mut In<'_, '_, 's>) -> Parsed<T>,
) -> Option<T> {
    let opened = input.last();
    let result = part(input);
    let is_reported = matches!(&result, Err(problem) if problem.expected == Expected::Reported);
    match &result {
        Ok(_) if input.eat(ends).is_some() => {}
        _ if foreign_syntax::braces(input, opened, !is_reported) => {}
        Ok(_) if !recovery::missing_word(input, ends, opened) => return None,
        Ok(_) => {}
        Err(problem) => {
            diagnostics::report(input, *problem);
            recovery::skip_header(input, ends, opened);
        }
    }
    result.ok()
}

fn if_statement<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let opened = input.take();
    input.state().open.push((Kind::EndIf, opened));
    let mut branches = Vec::with_capacity(1);
    loop {
        let condition = header(input, Kind::Then, condition).unwrap_or_else(|| unread(opened));
        branches.push((condition, body(input, opened)));
        if branches.len() > MAX_CHAIN {
            return Err(input.state().stop(opened, too_long()));
        }
        if input.eat(Kind::Elsif).is_none() {
            break;
        }
    }
    let mut nested_if = None;
    let mut otherwise = None;
    while let kind @ (Kind::Else | Kind::Elsif) = input.kind() {
        let word = input.take();
        if otherwise.is_some() {
            input.report(diagnostics::behind_else(word, kind));
        }
        if kind == Kind::Elsif {
            header(input, Kind::Then, condition);
        } else if input.kind() == Kind::If && !input.on_new_line() {
            nested_if = Some(word.to(input.here()));
        } else if input.kind() == Kind::Colon {
            let colon = input.take();
            input.report(diagnostics::colon_behind_else(colon));
        } else if input.state().braced.contains(&opened) {
            foreign_syntax::braces(input, opened, true);
        }
        let body = body(input, opened);
        otherwise.get_or_insert(body);
    }
    input.state().open.pop();
    match nested_if {
        Some(words) if input.kind() != Kind::EndIf => diagnostics::else_if(input, words, opened),
        _ => close(input, Kind::EndIf, opened),
    }
    Ok(StatementKind::If { branches, otherwise })
}

/// Stands for an expression that did not parse: what is around it is still checked.
fn unread<'s>(span: Span) -> Expr<'s> {
    Expr { kind: ExprKind::Error(Vec::new()), span }
}

/// The statements of a body; one in braces has been passed over.
fn body<'s>(input: &mut In<'_, '_, 's>, opened: Span) -> Vec<Statement<'s>> {
    if input.state().braced.contains(&opened) { Vec::new() } else { statements(input) }
}

/// The END_ of a block, with the `;` that may follow it.
fn close(input: &mut In<'_, '_, '_>, end: Kind, opened: Span) {
    block_ends::close_block(input, end, opened);
    input.eat(Kind::Semicolon);
}

/// Statements of a block that `end` closes.
fn block<'s>(input: &mut In<'_, '_, 's>, end: Kind, opened: Span) -> Vec<Statement<'s>> {
    input.state().open.push((end, opened));
    let body = body(input, opened);
    input.state().open.pop();
    body
}

fn case<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let opened = input.take();
    let selector = header(input, Kind::Of, expression).unwrap_or_else(|| unread(opened));
    input.state().open.push((Kind::EndCase, opened));
    let mut arms = Vec::new();
    loop {
        match input.kind() {
            Kind::Semicolon => {
                input.take();
            }
            kind if ends_statements(kind) => {
                if !recovery::stray(input) {
                    break;
                }
            }
            _ => arms.extend(arm(input)),
        }
    }
    let otherwise = input.eat(Kind::Else).map(|_| {
        input.eat(Kind::Colon);
        statements(input)
    });
    input.state().open.pop();
    close(input, Kind::EndCase, opened);
    Ok(StatementKind::Case { selector, arms, otherwise })
}

fn arm<'s>(input: &mut In<'_, '_, 's>) -> Option<Arm<'s>> {
    if at_case_word(input) {
        let it = diagnostics::case_before_label(input.take());
        input.report(it);
    }
    let start = input.here();
    let labels = labels(input);
    if let Err(problem) = labels {
        diagnostics::report(input, problem);
        recovery::skip_label(input, start);
    }
    let mut body = Vec::new();
    list(input, &mut body, at_label);
    body.shrink_to_fit();
    Some(Arm { labels: labels.ok()?, body })
}

fn labels<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Vec<Label<'s>>> {
    if !at_label(input) {
        return Err(input.problem(Expected::Label));
    }
    let mut labels = Vec::with_capacity(1);
    loop {
        if is_arrow_label(input) {
            let low = unary(input)?;
            labels.push(Label { low, high: None });
            let it = diagnostics::arrow_for_colon(input.take());
            input.report(it);
            return Ok(labels);
        }
        let low = expression(input)?;
        let high = match input.eat(Kind::DotDot) {
            Some(_) => Some(expression(input)?),
            None => None,
        };
        labels.push(Label { low, high });
        if input.eat(Kind::Comma).is_none() {
            break;
        }
    }
    if let Some(sign) = input.eat(Kind::Semicolon) {
        input.report(diagnostics::semicolon_for_colon(sign));
    } else if input.eat(Kind::Colon).is_none() {
        if !recovery::begins_statement(input) {
            return Err(input.problem(Expected::Token(Kind::Colon)));
        }
        diagnostics::missing_colon(input);
    }
    Ok(labels)
}

/// `CASE 1:` among the arms of a CASE, as other languages begin one.
fn at_case_word(input: &mut In<'_, '_, '_>) -> bool {
    if input.kind() != Kind::Case {
        return false;
    }
    let mut ahead = 1;
    while matches!(
        input.kind_ahead(ahead),
        Kind::Name | Kind::Dot | Kind::DotDot | Kind::Comma | Kind::Prefix | Kind::Integer | Kind::Based | Kind::Minus
    ) {
        ahead += 1;
    }
    ahead > 1 && input.kind_ahead(ahead) == Kind::Colon && input.kind_ahead(ahead + 1) != Kind::Equal
}

/// `1 =>`, `Idle =>`, as other languages end a label.
fn is_arrow_label(input: &mut In<'_, '_, '_>) -> bool {
    let first = usize::from(input.kind() == Kind::Minus);
    let mut ahead = first + 1;
    while input.kind_ahead(ahead) == Kind::Dot && input.kind_ahead(ahead + 1) == Kind::Name {
        ahead += 2;
    }
    matches!(input.kind_ahead(first), Kind::Name | Kind::Integer | Kind::Based)
        && input.kind_ahead(ahead) == Kind::Arrow
}

/// Whether the name that is next is one that a JMP names.
fn is_jump_label(input: &mut In<'_, '_, '_>) -> bool {
    let span = input.here();
    let text = input.text(span);
    input.kind() == Kind::Name && unsupported::is_jumped_to(input, text)
}

/// Whether the tokens ahead are labels: constants up to a `:`. No statement starts with a number.
fn at_label(input: &mut In<'_, '_, '_>) -> bool {
    if matches!(input.kind(), Kind::Integer | Kind::Based | Kind::Minus | Kind::Prefix) || at_case_word(input) {
        return true;
    }
    let mut ahead = 0;
    loop {
        match input.kind_ahead(ahead) {
            Kind::Colon if ahead == 1 && is_jump_label(input) => return false,
            Kind::Colon => return ahead > 0 && input.kind_ahead(ahead + 1) != Kind::Equal,
            Kind::Arrow => return ahead > 0,
            Kind::Name | Kind::Dot | Kind::DotDot | Kind::Comma | Kind::Prefix => {}
            Kind::Integer | Kind::Based | Kind::Real | Kind::Time | Kind::Date => {}
            Kind::Text | Kind::WideText | Kind::True | Kind::False => {}
            Kind::Plus | Kind::Minus | Kind::Star | Kind::Slash | Kind::Mod | Kind::Not => {}
            // `table[2]:`
            Kind::OpenBracket | Kind::CloseBracket if ahead > 0 => {}
            _ => return false,
        }
        ahead += 1;
    }
}

fn for_loop<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let opened = input.take();
    let range = header(input, Kind::Do, |input| {
        if foreign_syntax::counting_loop(input) {
            return Err(Problem::REPORTED);
        }
        let counter = postfix(input)?;
        if foreign_syntax::loop_over_a_list(input, opened) {
            return Err(Problem::REPORTED);
        }
        if let Some(sign) = input.eat(Kind::Equal) {
            let it = diagnostics::equal_for_assign(sign, "=");
            input.report(it);
        } else {
            input.expect(Kind::Assign)?;
        }
        let from = expression(input)?;
        let is_down = foreign_syntax::down_to(input);
        if !is_down {
            input.expect(Kind::To)?;
        }
        let to = expression(input)?;
        let by = match input.eat(Kind::By).is_some() || foreign_syntax::step(input) {
            true => Some(expression(input)?),
            false => is_down.then(|| unread(opened)),
        };
        let by = by.map(Box::new);
        Ok((Box::new(counter), Box::new(from), Box::new(to), by))
    });
    let body = block(input, Kind::EndFor, opened);
    close(input, Kind::EndFor, opened);
    let (counter, from, to, by) = range.unwrap_or_else(|| {
        let [counter, from, to] = [(); 3].map(|()| Box::new(unread(opened)));
        (counter, from, to, None)
    });
    Ok(StatementKind::For { counter, from, to, by, body })
}

fn while_loop<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let opened = input.take();
    let condition = header(input, Kind::Do, condition).unwrap_or_else(|| unread(opened));
    let body = block(input, Kind::EndWhile, opened);
    close(input, Kind::EndWhile, opened);
    Ok(StatementKind::While { condition, body })
}

fn repeat<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let opened = input.take();
    let body = block(input, Kind::EndRepeat, opened);
    let Some(_) = input.eat(Kind::Until) else {
        if input.kind() == Kind::EndRepeat {
            let next = usize::from(input.kind_ahead(1) == Kind::Semicolon) + 1;
            if input.kind_ahead(next) == Kind::Until {
                let until = until_after_end(input, opened)?;
                return Ok(StatementKind::Repeat { body, until });
            }
            let it = diagnostics::no_until(input.here());
            input.report(it);
        }
        close(input, Kind::EndRepeat, opened);
        return Ok(StatementKind::Repeat { body, until: unread(opened) });
    };
    let until = condition(input);
    if let Err(problem) = until {
        diagnostics::report(input, problem);
        recovery::skip_header(input, Kind::Semicolon, opened);
    }
    input.eat(Kind::Semicolon);
    close(input, Kind::EndRepeat, opened);
    Ok(StatementKind::Repeat { body, until: until.unwrap_or_else(|_| unread(opened)) })
}

/// `END_REPEAT UNTIL x;`, whose two ends are in the other order.
fn until_after_end<'s>(input: &mut In<'_, '_, 's>, opened: Span) -> Parsed<Expr<'s>> {
    let end = input.take();
    input.eat(Kind::Semicolon);
    input.take();
    let until = condition(input)?;
    let whole = end.to(until.span);
    let it = diagnostics::until_after_end(whole, opened, input.text(until.span));
    input.report(it);
    input.eat(Kind::Semicolon);
    Ok(until)
}

fn try_statement<'s>(input: &mut In<'_, '_, 's>) -> Parsed<StatementKind<'s>> {
    let opened = input.take();
    input.state().open.push((Kind::EndTry, opened));
    let body = statements(input);
    let mut exception = None;
    let mut handler = Vec::new();
    if input.eat(Kind::Catch).is_some() {
        match caught(input) {
            Ok(found) => exception = found,
            Err(problem) => {
                diagnostics::report(input, problem);
                recovery::skip_header(input, Kind::CloseParen, opened);
            }
        }
        handler = statements(input);
    } else if matches!(input.kind(), Kind::Finally | Kind::EndTry) {
        let problem = input.problem(Expected::Token(Kind::Catch));
        diagnostics::report(input, problem);
    }
    let finally = input.eat(Kind::Finally).map(|word| Finally { word, body: statements(input) });
    input.state().open.pop();
    close(input, Kind::EndTry, opened);
    Ok(StatementKind::Try(Box::new(Try { word: opened, body, exception, handler, finally })))
}

/// `(exception)` after `__CATCH`, which may have none.
fn caught<'s>(input: &mut In<'_, '_, 's>) -> Parsed<Option<Expr<'s>>> {
    if input.eat(Kind::OpenParen).is_none() || input.eat(Kind::CloseParen).is_some() {
        return Ok(None);
    }
    let exception = postfix(input)?;
    input.expect(Kind::CloseParen)?;
    Ok(Some(exception))
}
