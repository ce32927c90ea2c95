//! What can be declared where something is missing: a variable, and what the INTERFACEs of a class ask for.

use super::problems::shown;
use crate::project::Analysis;
use crate::uri;
use gen_lsp_types::{CodeAction, CodeActionKind, Range, TextEdit, WorkspaceEdit};
use staunch_frontend::ast::VarKind;
use staunch_frontend::{Code, DefId, Definition, DefinitionKind, Diagnostic, Missing, Span, Subject};
use std::collections::HashMap;

pub fn actions(analysis: &Analysis, file: u16, within: Range) -> Vec<CodeAction> {
    let is_near = |it: &&Diagnostic| {
        let range = analysis.range(it.span);
        it.span.file == file && range.start.line <= within.end.line && within.start.line <= range.end.line
    };
    let mut found: Vec<CodeAction> = Vec::new();
    for it in analysis.index.diagnostics.iter().filter(is_near) {
        let action = match &it.subject {
            Some(Subject::Missing { kind: Missing::Variable, name }) => variable(analysis, it, name),
            _ if it.code == Code::E0403 => members(analysis, it),
            _ => None,
        };
        // A class lacks several METHODs in one place.
        found.extend(action.filter(|it| found.iter().all(|known| known.title != it.title)));
    }
    found
}

fn action(analysis: &Analysis, title: String, of: &Diagnostic, at: Span, text: String) -> Option<CodeAction> {
    let uri = uri::of(analysis.path(at.file).filter(|_| analysis.is_own(at))?);
    let edit = TextEdit { range: analysis.range(at), new_text: text };
    Some(CodeAction {
        title,
        kind: Some(CodeActionKind::QuickFix),
        diagnostics: Some(vec![shown(analysis, of)]),
        edit: Some(WorkspaceEdit { changes: Some(HashMap::from([(uri, vec![edit])])), ..WorkspaceEdit::default() }),
        ..CodeAction::default()
    })
}

/// A place without length.
fn point(file: u16, at: usize) -> Option<Span> {
    let at = u32::try_from(at).ok()?;
    Some(Span { file, start: at, end: at })
}

fn text_of(analysis: &Analysis, file: u16) -> &str {
    &analysis.source(file).text
}

/// A byte of a text, by its place.
fn index(at: u32) -> usize {
    usize::try_from(at).unwrap_or(usize::MAX)
}

/// Declares a variable in the POU around the place that names it.
fn variable(analysis: &Analysis, of: &Diagnostic, name: &str) -> Option<CodeAction> {
    let is_name = name.chars().all(|it| it.is_ascii_alphanumeric() || it == '_');
    let (pou, definition) = around(analysis, of.span).filter(|_| is_name)?;
    let declared = format!("{name} : {};", guess(analysis, of.span));
    let (at, text) = match last_of(analysis, pou, |it| it.kind == DefinitionKind::Variable(VarKind::Var)) {
        Some((end, indent)) => (end, format!("\n{indent}{declared}")),
        None => (end_of_head(analysis, definition)?, format!("\nVAR\n    {declared}\nEND_VAR")),
    };
    action(analysis, format!("Declare `{}`", declared.trim_end_matches(';')), of, point(of.span.file, at)?, text)
}

/// The innermost POU around a place.
fn around(analysis: &Analysis, span: Span) -> Option<(DefId, &Definition)> {
    let holds = |it: &Definition| {
        let extent = it.extent;
        is_pou(it.kind) && extent.file == span.file && extent.start <= span.start && span.end <= extent.end
    };
    analysis.index.ids().filter(|it| holds(it.1)).min_by_key(|it| it.1.extent.end - it.1.extent.start)
}

fn is_pou(kind: DefinitionKind) -> bool {
    matches!(
        kind,
        DefinitionKind::Program
            | DefinitionKind::FunctionBlock
            | DefinitionKind::Class
            | DefinitionKind::Function
            | DefinitionKind::Method
            | DefinitionKind::Test
    )
}

/// Where the last part of a POU ends that is of a kind, with its `;`, and what its line begins with.
fn last_of(analysis: &Analysis, pou: DefId, is: impl Fn(&Definition) -> bool) -> Option<(usize, &str)> {
    let parts = analysis.index.parts_of(pou).map(|it| it.1).filter(|it| is(it));
    let last = parts.max_by_key(|it| it.extent.end)?;
    let text = text_of(analysis, last.extent.file);
    let start = index(last.name.start);
    let end = index(last.extent.end).saturating_sub(1);
    let end = end + text.get(end..)?.find(';')? + 1;
    let line = text.get(..start)?.rfind('\n').map_or(0, |it| it + 1);
    let indent = text.get(line..start)?;
    let indent = &indent[..indent.len() - indent.trim_start().len()];
    Some((end, indent))
}

/// Where the line of a POU's name ends.
fn end_of_head(analysis: &Analysis, definition: &Definition) -> Option<usize> {
    let text = text_of(analysis, definition.name.file);
    let from = index(definition.ty.filter(|it| it.file == definition.name.file).unwrap_or(definition.name).end);
    let line = text.get(from..)?.find('\n').map_or(text.len(), |it| from + it);
    Some(line - usize::from(text[..line].ends_with('\r')))
}

/// A type for a variable, by what is next to it.
fn guess(analysis: &Analysis, span: Span) -> String {
    let text = text_of(analysis, span.file);
    let after = text.get(index(span.end)..).unwrap_or_default().trim_start();
    let before = text.get(..index(span.start)).unwrap_or_default().trim_end();
    let word = before.rsplit(|it: char| !it.is_ascii_alphanumeric() && it != '_').next().unwrap_or_default();
    let conditions = ["IF", "ELSIF", "WHILE", "UNTIL", "NOT", "AND", "OR", "XOR"];
    if let Some(value) = after.strip_prefix(":=") {
        let value = value.split(';').next().unwrap_or_default();
        let from = index(span.end) + text[index(span.end)..].find(":=").unwrap_or(0) + 2;
        return of_value(value.trim())
            .map(str::to_owned)
            .or_else(|| of_name(analysis, span.file, from, value))
            .unwrap_or_else(|| "INT".to_owned());
    }
    if conditions.iter().any(|it| it.eq_ignore_ascii_case(word))
        && !after.starts_with(['=', '<', '>', '+', '-', '*', '/'])
    {
        return "BOOL".to_owned();
    }
    let target = before.strip_suffix(":=").map(str::trim_end);
    let start = target.and_then(|it| it.rfind(|it: char| !it.is_ascii_alphanumeric() && it != '_').map(|at| at + 1));
    let named = target.zip(start).and_then(|(it, start)| of_name(analysis, span.file, start, &it[start..]));
    named.unwrap_or_else(|| "INT".to_owned())
}

/// The type of a value that is a literal or a condition.
fn of_value(value: &str) -> Option<&'static str> {
    let upper = value.to_ascii_uppercase();
    let digits = value.trim_start_matches('-').replace('_', "");
    if let Ok(number) = digits.parse::<i64>() {
        return Some(match number {
            0..=32_767 => "INT",
            ..=2_147_483_647 => "DINT",
            _ => "LINT",
        });
    }
    let starts = |all: &[&str]| all.iter().any(|it| upper.starts_with(it));
    if starts(&["TRUE", "FALSE", "NOT "]) || [" AND ", " OR ", "<", ">", " = "].iter().any(|it| upper.contains(it)) {
        Some("BOOL")
    } else if starts(&["T#", "TIME#"]) {
        Some("TIME")
    } else if value.starts_with('\'') {
        Some("STRING")
    } else if digits.parse::<f64>().is_ok() {
        Some("REAL")
    } else {
        None
    }
}

/// The type of what is named at a place, where that is all.
fn of_name(analysis: &Analysis, file: u16, from: usize, text: &str) -> Option<String> {
    let is_name =
        !text.trim().is_empty() && text.trim().chars().all(|it| it.is_ascii_alphanumeric() || "_.".contains(it));
    let last = (from + text.trim_end().len()).checked_sub(1)?;
    let at = u32::try_from(last).ok().filter(|_| is_name)?;
    let (_, meaning) = analysis.index.at(file, at)?;
    let staunch_frontend::Meaning::Definition(id) = meaning else { return None };
    let ty = analysis.text(analysis.index.get(id).ty?);
    (!ty.contains('\n')).then(|| ty.to_owned())
}

/// Adds what the INTERFACEs of a class ask for.
fn members(analysis: &Analysis, of: &Diagnostic) -> Option<CodeAction> {
    let (class, definition) = analysis.index.ids().find(|it| it.1.name == of.span)?;
    let has =
        |name: &str, all: &[(DefId, &Definition)]| all.iter().any(|it| analysis.name(it.0).eq_ignore_ascii_case(name));
    let known: Vec<_> = classes(analysis, class).into_iter().flat_map(|it| analysis.index.parts_of(it)).collect();
    let mut asked: Vec<(DefId, &Definition)> = Vec::new();
    for interface in interfaces(analysis, class) {
        let own = analysis.index.parts_of(interface);
        let own = own.filter(|it| matches!(it.1.kind, DefinitionKind::Method | DefinitionKind::Property));
        for it in own.filter(|it| !has(analysis.name(it.0), &known)) {
            if !has(analysis.name(it.0), &asked) {
                asked.push(it);
            }
        }
    }
    let text: String = asked.iter().filter_map(|it| written(analysis, it.1)).map(|it| format!("\n{it}")).collect();
    let is_variable = |it: &Definition| matches!(it.kind, DefinitionKind::Variable(_));
    let at = match last_of(analysis, class, is_variable) {
        Some((end, _)) => {
            let rest = text_of(analysis, of.span.file).get(end..)?;
            end + rest.to_ascii_uppercase().find("END_VAR")? + "END_VAR".len()
        }
        None => end_of_head(analysis, definition)?,
    };
    if text.is_empty() || analysis.source(of.span.file).is_assembled() {
        return None;
    }
    let title = match asked.as_slice() {
        [(one, _)] => format!("Implement `{}`", analysis.name(*one)),
        all => format!("Implement {} METHODs and PROPERTYs", all.len()),
    };
    action(analysis, title, of, point(of.span.file, at)?, text)
}

/// A class and those that it extends.
fn classes(analysis: &Analysis, class: DefId) -> Vec<DefId> {
    let mut all = vec![class];
    let mut at = 0;
    while at < all.len() {
        let bases = analysis.bases(all[at]).into_iter();
        let new: Vec<_> = bases.filter(|it| !is_interface(analysis, *it) && !all.contains(it)).collect();
        all.extend(new);
        at += 1;
    }
    all
}

/// The INTERFACEs of a class and of those that it extends, and what these extend.
fn interfaces(analysis: &Analysis, class: DefId) -> Vec<DefId> {
    let own = classes(analysis, class).into_iter().flat_map(|it| analysis.bases(it));
    let mut all: Vec<_> = own.filter(|it| is_interface(analysis, *it)).collect();
    let mut at = 0;
    while at < all.len() {
        let new: Vec<_> = analysis.bases(all[at]).into_iter().filter(|it| !all.contains(it)).collect();
        all.extend(new);
        at += 1;
    }
    all
}

fn is_interface(analysis: &Analysis, id: DefId) -> bool {
    analysis.index.get(id).kind == DefinitionKind::Interface
}

/// A METHOD or PROPERTY as an INTERFACE declares it, with its last word.
fn written(analysis: &Analysis, it: &Definition) -> Option<String> {
    if analysis.source(it.name.file).is_assembled() {
        return None;
    }
    let (word, end) = match it.kind {
        DefinitionKind::Method => ("METHOD", "END_METHOD"),
        _ => ("PROPERTY", "END_PROPERTY"),
    };
    let text = text_of(analysis, it.name.file);
    let upper = text.to_ascii_uppercase();
    let start = upper.get(..index(it.name.start))?.rfind(word)?;
    let last = index(it.name.end) + upper.get(index(it.name.end)..)?.find(end)? + end.len();
    text.get(start..last).map(str::to_owned)
}
