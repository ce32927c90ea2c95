//! Where reading goes on after a mistake. Each list skips to its own next item, and never over a
//! keyword that an enclosing list waits for.

use crate::{lex::Kind, source::Span};

use super::{
    block_ends, diagnostics,
    parser::{In, Moves, Problem, Start},
};

/// Keywords that open a POU, a TYPE block or a configuration.
pub fn opens_item(kind: Kind) -> bool {
    matches!(kind, Kind::Program | Kind::Function | Kind::FunctionBlock | Kind::Type | Kind::Configuration)
}

/// VAR and its relatives.
pub fn opens_section(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Var
            | Kind::VarInput
            | Kind::VarOutput
            | Kind::VarInOut
            | Kind::VarTemp
            | Kind::VarStat
            | Kind::VarGlobal
            | Kind::VarExternal
            | Kind::VarConfig
            | Kind::VarAccess
            | Kind::VarInst
    )
}

/// Keywords that open a statement.
pub fn opens_statement(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::If | Kind::Case | Kind::For | Kind::While | Kind::Repeat | Kind::Exit | Kind::Continue | Kind::Return
    )
}

/// Keywords that close or continue a block.
pub fn closes(kind: Kind) -> bool {
    matches!(kind, Kind::Else | Kind::Elsif | Kind::Until) || kind.keyword().is_some_and(|it| it.starts_with("END_"))
}

pub fn ends_statements(kind: Kind) -> bool {
    kind == Kind::End || closes(kind) || opens_section(kind) || opens_item(kind)
}

/// The ends of the blocks that a keyword closes or continues.
fn partners(kind: Kind) -> [Kind; 2] {
    match kind {
        Kind::Else => [Kind::EndIf, Kind::EndCase],
        Kind::Elsif => [Kind::EndIf; 2],
        Kind::Until => [Kind::EndRepeat; 2],
        kind => [kind; 2],
    }
}

/// Takes and reports a closing keyword that no open block waits for.
pub fn stray(input: &mut In<'_, '_, '_>) -> bool {
    let kind = input.kind();
    if !closes(kind) || is_pou_end(kind) {
        return false;
    }
    let partners = partners(kind);
    let open = &input.state().open;
    let ends = kind.keyword().is_some_and(|it| it.starts_with("END_"));
    if ends {
        let awaited = open.last().is_some_and(|(end, _)| *end == kind);
        if awaited || block_ends::judge(input, None) != block_ends::Verdict::Stray {
            return false;
        }
    } else if open.iter().any(|(end, _)| partners.contains(end)) {
        return false;
    }
    let span = input.take();
    let told = kind == Kind::EndIf && std::mem::take(&mut input.state().orphaned);
    if !told {
        let it = diagnostics::stray(span, kind);
        input.report(it);
    }
    input.state().orphaned |= matches!(kind, Kind::Else | Kind::Elsif);
    input.eat(Kind::Semicolon);
    true
}

pub fn is_pou_end(kind: Kind) -> bool {
    matches!(kind, Kind::EndProgram | Kind::EndFunction | Kind::EndFunctionBlock)
}

/// Whether the next token starts a statement of its own, so that only a `;` is missing.
pub fn begins_statement(input: &mut In<'_, '_, '_>) -> bool {
    let kind = input.kind();
    ends_statements(kind)
        || opens_statement(kind)
        || starts_action(input)
        || (input.on_new_line() && matches!(kind, Kind::Name | Kind::Address | Kind::Integer))
}

/// A name with `:=` directly behind it.
fn starts_action(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::Name && input.kind_ahead(1) == Kind::Assign
}

/// Reports what broke the statement that starts at `start`, and skips what is left of it.
pub fn statement<'t, 'p>(input: &mut In<'t, 'p, '_>, problem: Problem, start: Start<'t, 'p>) {
    let first = *start.cursor().inner();
    if respell(input, start) {
        return;
    }
    diagnostics::report(input, problem);
    let start = input.state().place(first);
    let block_as_value = input.number() == problem.at && problem.at != first && !input.on_new_line();
    if block_as_value && opens_statement(input.kind()) {
        skip_block(input);
    }
    skip_statement(input, start);
}

/// Behind the END_ of the block that starts here.
fn skip_block(input: &mut In<'_, '_, '_>) {
    let mut depth = 0usize;
    loop {
        let kind = input.kind();
        if kind == Kind::End || is_pou_end(kind) || opens_item(kind) {
            return;
        }
        let opens = matches!(kind, Kind::If | Kind::Case | Kind::For | Kind::While | Kind::Repeat);
        let ends = kind.keyword().is_some_and(|it| it.starts_with("END_"));
        input.take();
        depth += usize::from(opens);
        depth = depth.saturating_sub(usize::from(ends));
        if depth == 0 {
            return;
        }
    }
}

/// As [`statement`], for a declaration. Whether it was one at all, and no misspelt keyword.
pub fn declaration<'t, 'p>(input: &mut In<'t, 'p, '_>, problem: Problem, start: Start<'t, 'p>) -> bool {
    let first = *start.cursor().inner();
    if respell(input, start) {
        return false;
    }
    diagnostics::report(input, problem);
    let start = input.state().place(first);
    if input.kind() == Kind::Struct {
        skip_structure(input);
    }
    skip_declaration(input, start);
    true
}

/// Behind the END_STRUCT of a structure that is not read.
fn skip_structure(input: &mut In<'_, '_, '_>) {
    let mut ahead = 0;
    while input.kind_ahead(ahead) != Kind::EndStruct {
        let kind = input.kind_ahead(ahead);
        if kind == Kind::End || kind == Kind::EndType || opens_item(kind) || is_pou_end(kind) {
            return;
        }
        ahead += 1;
    }
    for _ in 0..=ahead {
        input.take();
    }
}

/// If what broke is a misspelt keyword: goes back to it, and reads it as that keyword.
fn respell<'t, 'p>(input: &mut In<'t, 'p, '_>, start: Start<'t, 'p>) -> bool {
    let now = input.save();
    input.rewind(start);
    let Some((kind, words)) = diagnostics::misspelt(input) else {
        input.rewind(now);
        return false;
    };
    let span = input.here();
    for _ in 0..words {
        input.take();
    }
    let span = span.to(input.last());
    diagnostics::misspelt_keyword(input, kind, span);
    input.state().instead = Some(kind);
    true
}

/// Behind the next `;`, or before a keyword or a line that starts another statement.
pub fn skip_statement(input: &mut In<'_, '_, '_>, start: Span) {
    loop {
        let kind = input.kind();
        if ends_statements(kind) {
            return;
        }
        let fresh = input.here().start == start.start;
        if !fresh && (opens_statement(kind) || (input.on_new_line() && starts_line(input))) {
            return;
        }
        input.take();
        if kind == Kind::Semicolon {
            return;
        }
    }
}

fn starts_line(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::Name
        && matches!(input.kind_ahead(1), Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket | Kind::Colon)
}

/// Behind `ends`, if it stands before the next statement.
pub fn skip_header(input: &mut In<'_, '_, '_>, ends: Kind, opened: Span) {
    loop {
        let kind = input.kind();
        if kind == ends || kind == Kind::Semicolon {
            input.take();
            return;
        }
        let away = input.last().start != opened.start && input.on_new_line();
        if ends_statements(kind) || opens_statement(kind) || (away && starts_line(input)) {
            return;
        }
        input.take();
    }
}

/// Behind the `:` of a broken label on its line, or at the next statement.
pub fn skip_label(input: &mut In<'_, '_, '_>, start: Span) {
    while input.here().start == start.start || !input.on_new_line() {
        let kind = input.kind();
        if ends_statements(kind) {
            return;
        }
        if opens_statement(kind) && input.here().start != start.start {
            return;
        }
        input.take();
        if matches!(kind, Kind::Colon | Kind::Semicolon) {
            return;
        }
    }
}

/// Behind the next `;`, or before a line that starts another declaration, or a guard.
pub fn skip_declaration(input: &mut In<'_, '_, '_>, start: Span) {
    loop {
        let kind = input.kind();
        let fresh = input.here().start == start.start;
        if ends_declarations(kind) || (!fresh && input.on_new_line() && starts_declaration(input)) {
            return;
        }
        input.take();
        if kind == Kind::Semicolon {
            return;
        }
    }
}

pub fn ends_declarations(kind: Kind) -> bool {
    ends_statements(kind) || opens_statement(kind)
}

pub fn starts_declaration(input: &mut In<'_, '_, '_>) -> bool {
    input.kind() == Kind::Name && matches!(input.kind_ahead(1), Kind::Colon | Kind::Comma | Kind::At)
}

/// Whether what stands in a VAR block is a statement, and the block's end is missing before it.
pub fn is_statement_in_section(input: &mut In<'_, '_, '_>) -> bool {
    let looks = input.kind() == Kind::Name
        && matches!(input.kind_ahead(1), Kind::Assign | Kind::OpenParen | Kind::Dot | Kind::OpenBracket);
    looks && {
        let mut ahead = 0;
        while !ends_statements(input.kind_ahead(ahead)) {
            ahead += 1;
        }
        input.kind_ahead(ahead) != Kind::EndVar
    }
}

/// Behind the END_VAR of a section that is not read.
pub fn skip_section(input: &mut In<'_, '_, '_>) {
    loop {
        let kind = input.kind();
        if kind == Kind::EndVar {
            input.take();
            input.eat(Kind::Semicolon);
            return;
        }
        if ends_statements(kind) {
            return;
        }
        input.take();
    }
}

/// Before the next POU, TYPE, VAR_GLOBAL or CONFIGURATION.
pub fn skip_to_item(input: &mut In<'_, '_, '_>) {
    loop {
        let kind = input.kind();
        if kind == Kind::End || kind == Kind::VarGlobal || opens_item(kind) {
            return;
        }
        input.take();
    }
}

/// Behind the first line of a POU whose head does not parse.
pub fn skip_head(input: &mut In<'_, '_, '_>) {
    while !ends_statements(input.kind()) && !input.on_new_line() {
        input.take();
    }
}
