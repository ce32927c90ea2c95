//! What `{IF …}` asks for: what is defined, and what is declared.

use super::declared::{Declared, Question, Subject};
use crate::source::Span;

/// A condition, as CODESYS and TwinCAT have them.
pub enum Condition<'s> {
    Defined(&'s str),
    /// `project_defined(X)`
    DefinedByProject(&'s str),
    /// `hasvalue(X, '1')`
    Value(&'s str, &'s str),
    Declared(Question<'s>),
    Not(Box<Condition<'s>>),
    And(Box<Condition<'s>>, Box<Condition<'s>>),
    Or(Box<Condition<'s>>, Box<Condition<'s>>),
}

/// What is known where a condition is read.
pub struct Facts<'f, 's> {
    /// Each name that `{define X 'value'}` or the project defines, with its value.
    pub defined: Vec<(&'s str, Option<&'s str>)>,
    pub by_project: &'s [String],
    pub declared: Option<&'f Declared<'s>>,
}

impl<'s> Condition<'s> {
    /// Nothing, where that is not known.
    pub fn holds(&self, facts: &Facts<'_, 's>, at: Span) -> Option<bool> {
        match self {
            Self::Defined(name) => Some(facts.is_defined(name)),
            Self::DefinedByProject(name) => {
                Some(facts.by_project.iter().any(|it| name_of(it).eq_ignore_ascii_case(name)))
            }
            Self::Value(name, value) => facts.has_value(name, value),
            Self::Declared(question) => facts.declared?.answer(question, at),
            Self::Not(it) => it.holds(facts, at).map(|it| !it),
            Self::And(a, b) => match (a.holds(facts, at), b.holds(facts, at)) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (a, b) => Some(a? && b?),
            },
            Self::Or(a, b) => match (a.holds(facts, at), b.holds(facts, at)) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (a, b) => Some(a? || b?),
            },
        }
    }

    /// Whether it asks for what is declared.
    pub fn asks(&self) -> bool {
        match self {
            Self::Declared(_) => true,
            Self::Defined(_) | Self::DefinedByProject(_) | Self::Value(..) => false,
            Self::Not(it) => it.asks(),
            Self::And(a, b) | Self::Or(a, b) => a.asks() || b.asks(),
        }
    }
}

/// What CODESYS defines by itself for a device as programs here see one.
const OF_THE_DEVICE: [(&str, bool); 3] =
    [("IsLittleEndian", true), ("IsFPUSupported", true), ("IsSimulationMode", false)];

/// What a device's description says of one: members are aligned to their sizes, integers are computed at 32 bits.
const VALUES_OF_THE_DEVICE: [(&str, &str); 2] = [("PackMode", "8"), ("RegisterSize", "32")];

impl<'s> Facts<'_, 's> {
    pub fn new(by_project: &'s [String]) -> Self {
        let defined = by_project.iter().map(|it| (name_of(it), it.split_once('=').map(|it| it.1)));
        Self { defined: defined.collect(), by_project, declared: None }
    }

    pub fn define(&mut self, name: &'s str, value: Option<&'s str>) {
        self.undefine(name);
        self.defined.push((name, value));
    }

    pub fn undefine(&mut self, name: &str) {
        self.defined.retain(|it| !it.0.eq_ignore_ascii_case(name));
    }

    fn is_defined(&self, name: &str) -> bool {
        let of_the_device = OF_THE_DEVICE.iter().any(|it| it.1 && it.0.eq_ignore_ascii_case(name));
        of_the_device || self.defined.iter().any(|it| it.0.eq_ignore_ascii_case(name))
    }

    fn has_value(&self, name: &str, value: &str) -> Option<bool> {
        if let Some((_, given)) = self.defined.iter().find(|it| it.0.eq_ignore_ascii_case(name)) {
            return Some(*given == Some(value));
        }
        let device = VALUES_OF_THE_DEVICE.iter().find(|it| it.0.eq_ignore_ascii_case(name));
        Some(device.is_some_and(|it| it.1 == value))
    }
}

/// The name in `X=1`, as a project defines it.
fn name_of(definition: &str) -> &str {
    definition.split('=').next().unwrap_or_default()
}

/// `defined(A) AND NOT defined(B)`; `None` for what asks for anything else.
pub fn condition(text: &str) -> Option<Condition<'_>> {
    if text.len() > LONGEST {
        return None;
    }
    let (condition, rest) = disjunction(text, 0)?;
    rest.trim().is_empty().then_some(condition)
}

/// No condition of a program has more bytes.
const LONGEST: usize = 4096;
/// No real condition has parentheses that are nested deeper.
const DEEPEST: usize = 50;

fn disjunction(text: &str, depth: usize) -> Option<(Condition<'_>, &str)> {
    let (mut left, mut rest) = conjunction(text, depth)?;
    while let Some(after) = after_word(rest, "or") {
        let (right, then) = conjunction(after, depth)?;
        (left, rest) = (Condition::Or(Box::new(left), Box::new(right)), then);
    }
    Some((left, rest))
}

fn conjunction(text: &str, depth: usize) -> Option<(Condition<'_>, &str)> {
    let (mut left, mut rest) = operand(text, depth)?;
    while let Some(after) = after_word(rest, "and") {
        let (right, then) = operand(after, depth)?;
        (left, rest) = (Condition::And(Box::new(left), Box::new(right)), then);
    }
    Some((left, rest))
}

fn operand(text: &str, depth: usize) -> Option<(Condition<'_>, &str)> {
    if depth > DEEPEST {
        return None;
    }
    if let Some(after) = after_word(text, "not") {
        let (inner, rest) = operand(after, depth + 1)?;
        return Some((Condition::Not(Box::new(inner)), rest));
    }
    for (word, read) in OPERATORS {
        if let Some(after) = after_word(text, word) {
            let (parts, rest) = arguments(after)?;
            return Some((read(&parts)?, rest));
        }
    }
    let (inner, rest) = disjunction(text.trim_start().strip_prefix('(')?, depth + 1)?;
    Some((inner, rest.trim_start().strip_prefix(')')?))
}

type Read = for<'s> fn(&[&'s str]) -> Option<Condition<'s>>;

const OPERATORS: [(&str, Read); 6] = [
    ("defined", defined),
    ("project_defined", |it| Some(Condition::DefinedByProject(only_name(it)?))),
    ("hasvalue", |it| Some(Condition::Value(name(it.first()?)?, quoted(it.get(1)?)?)).filter(|_| it.len() == 2)),
    ("hasattribute", has_attribute),
    ("hastype", has_type),
    ("hasconstantvalue", has_constant_value),
];

fn defined<'s>(parts: &[&'s str]) -> Option<Condition<'s>> {
    let [part] = parts else { return None };
    if let Some(name) = name(part) {
        return Some(Condition::Defined(name));
    }
    let (subject, name) = subject(part)?;
    Some(Condition::Declared(Question::Is(subject, name)))
}

fn has_attribute<'s>(parts: &[&'s str]) -> Option<Condition<'s>> {
    let [of, attribute] = parts else { return None };
    let (subject @ (Subject::Variable | Subject::Pou), name) = subject(of)? else { return None };
    Some(Condition::Declared(Question::HasAttribute(subject, name, quoted(attribute)?)))
}

fn has_type<'s>(parts: &[&'s str]) -> Option<Condition<'s>> {
    let [of, ty] = parts else { return None };
    let (Subject::Variable, variable) = subject(of)? else { return None };
    Some(Condition::Declared(Question::HasType(variable, name(ty)?)))
}

fn has_constant_value<'s>(parts: &[&'s str]) -> Option<Condition<'s>> {
    let [constant, value, operator] = parts else { return None };
    COMPARISONS.contains(operator).then_some(Condition::Declared(Question::HasConstantValue(
        path(constant)?,
        value,
        operator,
    )))
}

const COMPARISONS: [&str; 6] = ["<", "<=", "=", "<>", ">=", ">"];

/// The operator in a condition whose arguments are not written as it takes them, and how it takes these.
pub fn miswritten(text: &str) -> Option<(&'static str, String)> {
    let lower = text.to_ascii_lowercase();
    ["hasvalue", "hasconstantvalue", "hastype", "hasattribute"].into_iter().find_map(|word| {
        let after = after_word(text.get(lower.find(word)?..)?, word)?;
        let parts = arguments(after).map(|it| it.0).unwrap_or_default();
        let part = |at: usize, otherwise| parts.get(at).copied().filter(|it| !it.is_empty()).unwrap_or(otherwise);
        let text = |otherwise| part(1, otherwise).trim_matches(['\'', '"']);
        let form = match (word, parts.as_slice()) {
            ("hasvalue", [_, value]) if quoted(value).is_some() => return None,
            ("hasvalue", _) => format!("hasvalue({}, '{}')", part(0, "NAME"), text("1")),
            ("hasconstantvalue", [_, _, operator]) if COMPARISONS.contains(operator) => return None,
            ("hasconstantvalue", _) => format!("hasconstantvalue({}, {}, =)", part(0, "NAME"), part(1, "1")),
            ("hastype", [_, _]) => return None,
            ("hastype", _) => format!("hastype({}, {})", part(0, "variable: NAME"), part(1, "INT")),
            (_, [_, attribute]) if quoted(attribute).is_some() => return None,
            _ => format!("hasattribute({}, '{}')", part(0, "pou: NAME"), text("attribute")),
        };
        Some((word, form))
    })
}

/// `pou: P`
fn subject(part: &str) -> Option<(Subject, &str)> {
    let (kind, name) = part.split_once(':')?;
    let kind = match kind.trim().to_ascii_lowercase().as_str() {
        "variable" => Subject::Variable,
        "type" => Subject::Type,
        "pou" => Subject::Pou,
        "task" => Subject::Task,
        _ => return None,
    };
    Some((kind, path(name.trim())?))
}

fn only_name<'s>(parts: &[&'s str]) -> Option<&'s str> {
    let [part] = parts else { return None };
    name(part)
}

fn name(text: &str) -> Option<&str> {
    let is_name = !text.is_empty() && text.bytes().all(|it| it.is_ascii_alphanumeric() || it == b'_');
    is_name.then_some(text)
}

/// `A.B`
fn path(text: &str) -> Option<&str> {
    text.split('.').all(|it| name(it).is_some()).then_some(text)
}

fn quoted(text: &str) -> Option<&str> {
    text.strip_prefix('\'')?.strip_suffix('\'')
}

/// What is between parentheses, by commas, and what follows them.
fn arguments(text: &str) -> Option<(Vec<&str>, &str)> {
    let text = text.trim_start().strip_prefix('(')?;
    let (mut parts, mut first, mut in_quotes) = (Vec::new(), 0, false);
    for (at, character) in text.char_indices() {
        match character {
            '\'' => in_quotes = !in_quotes,
            ',' if !in_quotes => {
                parts.push(text[first..at].trim());
                first = at + 1;
            }
            ')' if !in_quotes => {
                parts.push(text[first..at].trim());
                return Some((parts, &text[at + 1..]));
            }
            _ => {}
        }
    }
    None
}

/// What follows a word that the text begins with.
fn after_word<'s>(text: &'s str, word: &str) -> Option<&'s str> {
    let text = text.trim_start();
    let (start, rest) = text.split_at_checked(word.len())?;
    let ends = !rest.starts_with(|it: char| it.is_ascii_alphanumeric() || it == '_');
    (start.eq_ignore_ascii_case(word) && ends).then_some(rest)
}
