//! What a name is, as text: for hover, completion and signatures.

use crate::project::Analysis;
use staunch_frontend::{DefId, Definition, DefinitionKind, Dialect, Meaning, ast::VarKind, standard_functions};
use staunch_runtime::{BLOCKS, BlockInfo, Class, Direction, Elementary, Facts, Kind, Signature};

/// A declaration in Structured Text, and what is said of it.
#[derive(Clone, Debug, Default)]
pub struct Description {
    pub code: String,
    /// In Markdown.
    pub text: String,
}

pub fn describe(analysis: &Analysis, name: &str, meaning: &Meaning) -> Option<Description> {
    let plain = |code: String| Description { code, ..Description::default() };
    Some(match meaning {
        Meaning::Definition(id) => {
            let text = analysis.index.get(*id).doc.clone().unwrap_or_default();
            Description { code: declaration(analysis, *id), text }
        }
        Meaning::Block(block) => of_block(block.info(), analysis.dialect()),
        Meaning::Pin(block, at) => plain(pin(&block.info().pins[*at])),
        Meaning::Function => functions(name, analysis.dialect())?,
        Meaning::Elementary(it) => Description { code: it.name().to_owned(), text: range_of(*it) },
        Meaning::Namespace(full) => plain(format!("NAMESPACE {full}")),
        Meaning::Instruction => Description { code: name.to_owned(), text: "An instruction of Logix.".to_owned() },
        Meaning::Parameter | Meaning::Word => return None,
    })
}

/// A declaration as its source has it, of a POU with its pins.
fn declaration(analysis: &Analysis, id: DefId) -> String {
    let definition = analysis.index.get(id);
    let (word, name) = (definition.kind.word(), analysis.name(id));
    let ty = definition.ty.map(|it| analysis.text(it)).filter(|it| !it.is_empty());
    let typed = |name: &str| ty.map_or_else(|| name.to_owned(), |ty| format!("{name} : {ty}"));
    match definition.kind {
        DefinitionKind::Variable(_) | DefinitionKind::Constant | DefinitionKind::Member => {
            let value = initial(analysis, definition).map_or_else(String::new, |it| format!(" := {it}"));
            let head = if definition.kind == DefinitionKind::Member { String::new() } else { format!("{word} ") };
            let address = address(analysis, definition).map_or_else(String::new, |it| format!(" AT {it}"));
            format!("{head}{}{value}", typed(&format!("{name}{address}")))
        }
        DefinitionKind::Structure | DefinitionKind::Union | DefinitionKind::Enumeration | DefinitionKind::Type => {
            let text = ty.unwrap_or_default();
            // The members of a long one are one by one in its own file.
            let shown: Vec<_> = text.lines().take(12).collect();
            let more = if text.lines().count() > shown.len() { "\n…" } else { "" };
            format!("TYPE {name} : {}{more}", shown.join("\n"))
        }
        DefinitionKind::Enumerator => {
            let owner = definition.owner.map_or("", |it| analysis.name(it));
            format!("{owner}.{name}")
        }
        DefinitionKind::Program
        | DefinitionKind::FunctionBlock
        | DefinitionKind::Class
        | DefinitionKind::Interface
        | DefinitionKind::Function
        | DefinitionKind::Method
        | DefinitionKind::Property
        | DefinitionKind::Action
        | DefinitionKind::Test => {
            let owner = definition.owner.map_or_else(String::new, |it| format!("{}.", analysis.name(it)));
            format!("{word} {}{}", typed(&format!("{owner}{name}")), pins(analysis, id))
        }
        DefinitionKind::Label
        | DefinitionKind::Step
        | DefinitionKind::Configuration
        | DefinitionKind::Resource
        | DefinitionKind::Task
        | DefinitionKind::Instance => format!("{word} {name}"),
    }
}

/// What is after `AT` in a declaration.
fn address<'a>(analysis: &'a Analysis, definition: &Definition) -> Option<&'a str> {
    let between = staunch_frontend::Span { start: definition.name.end, end: definition.ty?.start, ..definition.name };
    let text = analysis.text(between);
    let address = text.get(text.find('%')?..)?;
    address.split(|it: char| it == ':' || it.is_whitespace()).next()
}

/// What is after `:=` in a declaration.
fn initial<'a>(analysis: &'a Analysis, definition: &Definition) -> Option<&'a str> {
    let ty = definition.ty?;
    let rest = staunch_frontend::Span { start: ty.end, ..definition.extent };
    let text = analysis.text(rest).trim_start().strip_prefix(":=")?;
    Some(text.trim_end_matches(';').trim()).filter(|it| !it.contains('\n'))
}

/// The parameters of a POU, a block of variables each.
fn pins(analysis: &Analysis, id: DefId) -> String {
    let mut text = String::new();
    for (kind, word) in PARAMETERS {
        let own = analysis.members(id).into_iter().filter(|it| it.1.kind == DefinitionKind::Variable(kind));
        let own: Vec<_> = own
            .map(|(id, it)| format!("    {} : {};\n", analysis.name(id), it.ty.map_or("", |ty| analysis.text(ty))))
            .collect();
        if !own.is_empty() {
            text += &format!("\n{word}\n{}END_VAR", own.concat());
        }
    }
    text
}

/// What a call gives, in the order of a signature.
pub const PARAMETERS: [(VarKind, &str); 3] =
    [(VarKind::Input, "VAR_INPUT"), (VarKind::InOut, "VAR_IN_OUT"), (VarKind::Output, "VAR_OUTPUT")];

fn pin(pin: &staunch_runtime::Pin) -> String {
    format!("{} {} : {}", direction(pin.direction), pin.name, pin.ty.name())
}

const fn direction(it: Direction) -> &'static str {
    match it {
        Direction::Input => "VAR_INPUT",
        Direction::Output => "VAR_OUTPUT",
        Direction::Member => "member",
        Direction::Memory => "VAR",
    }
}

/// A standard block: its pins, what it does here, and how those of other systems differ.
fn of_block(info: &BlockInfo, dialect: Dialect) -> Description {
    let mut code = format!("FUNCTION_BLOCK {}.{}", info.family.name(), info.name);
    for it in [Direction::Input, Direction::Output, Direction::Member] {
        let own: Vec<_> = info.pins.iter().filter(|pin| pin.direction == it).collect();
        if !own.is_empty() {
            let lines = own.iter().map(|pin| format!("    {} : {};\n", pin.name, pin.ty.name()));
            code += &format!("\n{}\n{}END_VAR", direction(it), lines.collect::<String>());
        }
    }
    let mut text = habits(&info.facts).join(" ");
    let others = BLOCKS.iter().filter(|it| it.family != info.family && it.facts.option.is_none());
    let others = others.filter(|it| it.name.eq_ignore_ascii_case(info.name) && differs(it, info));
    let others: Vec<_> = others.map(|it| format!("- {}: {}", it.family.name(), difference(it, info))).collect();
    if info.is_counter() && !others.is_empty() {
        let page = "`staunch compare` shows where a program differs.";
        text += &format!(
            "\n\n`{}` of other systems than `{}`:\n{}\n\n{page}",
            info.name,
            dialect.name(),
            others.join("\n")
        );
    }
    Description { code, text: text.trim().to_owned() }
}

/// What a block does otherwise than the standard's, in sentences.
fn habits(facts: &Facts) -> Vec<String> {
    let mut all = Vec::new();
    if facts.counts_levels {
        all.push("It counts in every call whose input is TRUE, not on edges.".to_owned());
    }
    if facts.counts_falls {
        all.push("It counts down on the falling edge.".to_owned());
    }
    if facts.stops {
        all.push("It counts up only below its preset, and down only above 0.".to_owned());
    }
    if facts.loads_on_edges {
        all.push("It is loaded when its input becomes TRUE, and not while it is.".to_owned());
    }
    if let Some(kept) = facts.kept {
        all.push(format!("The variable at `{}` keeps its count over a restart.", kept.pin));
    }
    all
}

fn differs(other: &BlockInfo, info: &BlockInfo) -> bool {
    habits(&other.facts) != habits(&info.facts) || names(other) != names(info)
}

fn difference(other: &BlockInfo, info: &BlockInfo) -> String {
    let mut parts = habits(&other.facts);
    if parts.is_empty() && !habits(&info.facts).is_empty() {
        parts.push("It does not do so.".to_owned());
    }
    if names(other) != names(info) {
        parts.push(format!("Its pins are {}.", names(other).join(", ")));
    }
    parts.join(" ")
}

/// The pins with their types.
fn names(info: &BlockInfo) -> Vec<String> {
    let seen = info.pins.iter().filter(|it| it.direction != Direction::Memory);
    seen.map(|it| format!("{} : {}", it.name, it.ty.name())).collect()
}

/// The standard functions of a name.
pub fn signatures(name: &str, dialect: Dialect) -> Vec<&'static Signature> {
    standard_functions(dialect).filter(|it| it.name.eq_ignore_ascii_case(name)).collect()
}

fn functions(name: &str, dialect: Dialect) -> Option<Description> {
    let lines: Vec<_> = signatures(name, dialect).into_iter().map(head).collect();
    let text = if lines.is_empty() { "A standard function.".to_owned() } else { String::new() };
    let code = if lines.is_empty() { format!("FUNCTION {name}") } else { lines.join("\n") };
    Some(Description { code, text })
}

fn head(it: &Signature) -> String {
    let parameters: Vec<_> = it.parameters.iter().map(|at| parameter(it, at)).collect();
    let more = if it.extensible { ", …" } else { "" };
    format!("FUNCTION {}({}{more}) : {}", it.name, parameters.join(", "), kind(it, it.result))
}

pub fn parameter(it: &Signature, parameter: &staunch_runtime::Parameter) -> String {
    format!("{} : {}", parameter.name, kind(it, parameter.kind))
}

fn kind(signature: &Signature, kind: Kind) -> String {
    match kind {
        Kind::T => class(signature.class),
        Kind::Any(it) => class(it),
        Kind::Is(it) => it.name().to_owned(),
        Kind::String => "STRING".to_owned(),
        Kind::Wstring => "WSTRING".to_owned(),
        Kind::AnyString => "ANY_STRING".to_owned(),
    }
}

fn class(it: Class) -> String {
    it.name().to_owned()
}

/// What an elementary type holds.
fn range_of(it: Elementary) -> String {
    let bits = 8 * it.repr().size();
    match it.repr().range() {
        _ if it == Elementary::Bool => "FALSE or TRUE".to_owned(),
        Some((low, high)) if it.is_integer() => format!("{bits} bits: {low} to {high}"),
        _ => format!("{bits} bits"),
    }
}
