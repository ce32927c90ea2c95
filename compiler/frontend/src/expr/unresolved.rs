//! Names that are not there, and what was probably meant.

use super::checker::{Checker, Context};
use crate::diagnostic::Missing;
use crate::diagnostic::wording::{all_of, any_of, article};
use crate::dialect::{Dialect, missing};
use crate::names::functions;
use crate::spelling::{Key, nearest};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::BlockId;
use staunch_runtime::{BLOCKS, Direction, Family, PinRole};

pub(crate) fn not_constant(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0205, span, "a constant is expected here")
        .label("its value is not known before the program runs")
}

impl Checker<'_, '_> {
    /// A call or a part of something that is known only as the program runs.
    pub(super) fn not_constant_here(&self, span: Span) -> Diagnostic {
        let error = not_constant(span);
        match self.context {
            Context::Initial => error.help("assign it at the start of a body, to a variable that is not CONSTANT"),
            Context::Body | Context::Constant => error,
        }
    }
}

/// `CSCAPE.CTUD`: the family has no such block.
pub(crate) fn no_such_block(family: Family, name: ast::Name<'_>) -> Diagnostic {
    let own = BLOCKS.iter().filter(|it| it.family == family && it.facts.option.is_none());
    let names: Vec<_> = own.map(|it| it.name).filter(|it| !it.starts_with("__")).collect();
    let owner = family.name();
    let error = Diagnostic::new(Code::E0309, name.span, format!("{owner} does not document `{}`", name.text))
        .label(format!("not a block of {owner}"));
    match nearest(name.text, names.iter().copied()).filter(|near| near.len() == name.text.len()) {
        Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
        None => error.help(format!("{owner} has {}", all_of(&names))),
    }
}

/// A block that exists, but not under the dialect's bare names. A program that moves here names no family.
pub(crate) fn block_of_another_dialect(dialect: Dialect, is_moved: bool, name: ast::Name<'_>) -> Option<Diagnostic> {
    let blocks: Vec<_> = BLOCKS.iter().filter(|it| it.is_named(name.text)).collect();
    let owners: Vec<_> = blocks.iter().map(|it| it.family).collect();
    let instruction = blocks.first()?.instructions[0].name;
    let without = format!("{} does not document `{}`", dialect.family().name(), name.text);
    let qualified: Vec<_> = owners.iter().map(|it| format!("{}.{}", it.name(), name.text)).collect();
    let qualified: Vec<_> = qualified.iter().map(String::as_str).collect();
    let others = dialects_of(&owners);
    let have = match others.as_slice() {
        [one] => format!("the dialect `{one}` has"),
        several => format!("the dialects {} have", all_of(several)),
    };
    let error = Diagnostic::new(Code::E0309, name.span, without)
        .label(format!("no block has this name under `--dialect {}`", dialect.name()))
        .note(format!("{have} it"));
    // Who names a structure of Logix calls its instructions too, which a family's name has to precede as well.
    Some(match (others.as_slice(), owners.as_slice()) {
        // What is written in their place is another call, which `compare` says.
        (_, [Family::Logix]) if is_moved => error,
        ([one], [Family::Logix]) => error.help(format!(
            "start the file with `{{dialect '{one}'}}`, or write `{}`, and `LOGIX.` before each instruction: `LOGIX.{instruction}(…)`",
            qualified[0],
        )),
        _ if is_moved => error.help(format!(
            "in a program for `{}`, which `--against` compares with this one, name the family: {}",
            dialect.name(),
            any_of(&qualified)
        )),
        _ => error.help(format!("name the family: {}", any_of(&qualified))),
    })
}

/// `c.RST` or `c(RESET := …)` on a block that has no such pin.
pub(crate) fn unknown_pin(dialect: Dialect, block: BlockId, name: ast::Name<'_>) -> Diagnostic {
    let info = block.info();
    // The family is named where a bare name would mean another block.
    let is_bare = crate::dialect::bare_block(dialect, info.name) == Some(block);
    let pins: Vec<_> = info.pins.iter().filter(|it| it.direction != Direction::Memory).map(|it| it.name).collect();
    let full = if is_bare { info.name.to_owned() } else { format!("{}.{}", info.family.name(), info.name) };
    let error =
        Diagnostic::new(Code::E0301, name.span, format!("`{full}` has no pin `{}`", name.text)).label("unknown pin");
    let meant = other_dialects_pin(block, name.text).or_else(|| nearest(name.text, pins.iter().copied()));
    let error = match meant {
        Some(pin) => error.help(format!("did you mean `{pin}`?")).fix(name.span, pin),
        None => error.help(format!("its pins are {}", all_of(&pins))),
    };
    let dialects = dialects_with_pin(block, name.text);
    if dialects.is_empty() {
        return error;
    }
    let pin = name.text.to_ascii_uppercase();
    error.note(format!(
        "the pin is called `{pin}` where a bare `{}` means the block of {}",
        info.name,
        any_of(&dialects)
    ))
}

/// This block's name for a pin that another system calls `name`.
pub(super) fn other_dialects_pin(block: BlockId, name: &str) -> Option<&'static str> {
    let pin = block.info().pin_for(PinRole::named(name).or_else(|| spelled_out(name))?)?;
    Some(pin.name).filter(|it| !it.eq_ignore_ascii_case(name))
}

/// This block's name for a pin that the data of the same counter calls `name` in the system that the program comes from.
pub(super) fn pin_of_data(from: Dialect, block: BlockId, name: &str) -> Option<&'static str> {
    let theirs = crate::dialect::bare_block(from, block.info().name)?.info();
    let other = theirs.facts.other_pins.iter().find(|it| it.name.eq_ignore_ascii_case(name))?;
    block.info().pin_for(theirs.pin(other.pin)?.role?).map(|it| it.name)
}

/// What Logix's pages call the operands of its instructions.
fn spelled_out(name: &str) -> Option<PinRole> {
    let words = [("Preset", PinRole::Preset), ("Accum", PinRole::Count), ("Accumulated", PinRole::Count)];
    words.iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
}

/// The dialects whose block of the same name has a pin `name`.
fn dialects_with_pin(block: BlockId, name: &str) -> Vec<&'static str> {
    let info = block.info();
    let same = BLOCKS.iter().filter(|it| it.family != info.family && it.name.eq_ignore_ascii_case(info.name));
    let owners: Vec<_> = same.filter(|it| it.pin(name).is_some()).map(|it| it.family).collect();
    dialects_of(&owners)
}

/// The dialects whose bare names mean the blocks of one of these families.
fn dialects_of(families: &[Family]) -> Vec<&'static str> {
    let owns = |it: &&Dialect| families.contains(&it.family());
    Dialect::ALL.iter().filter(owns).map(|it| it.name()).collect()
}

/// Values that are not names, for suggestions.
const CONSTANTS: [&str; 2] = ["TRUE", "FALSE"];

/// Words that do something in other languages, or in other places.
const FOREIGN: [(&str, &str); 13] = [
    ("DEFAULT", "the CASE branch for all other values is written `ELSE`"),
    ("OTHERS", "the CASE branch for all other values is written `ELSE`"),
    ("OTHERWISE", "the CASE branch for all other values is written `ELSE`"),
    ("BREAK", "a loop is left with `EXIT;`, and a branch of a CASE ends before the next label"),
    ("PASS", "the empty statement is written `;`"),
    ("NOP", "the empty statement is written `;`"),
    ("STOP", "a POU is left with `RETURN;`"),
    ("HIGH", "write `TRUE`"),
    ("LOW", "write `FALSE`"),
    ("ON", "write `TRUE`"),
    ("OFF", "write `FALSE`"),
    ("YES", "write `TRUE`"),
    ("NO", "write `FALSE`"),
];

/// `FFh` as this language has it.
fn hexadecimal(name: &str) -> Option<String> {
    let digits = name.strip_suffix(['h', 'H'])?;
    let is_number = digits.len() > 1 && digits.bytes().all(|it| it.is_ascii_hexdigit());
    is_number.then(|| format!("16#{}", digits.to_ascii_uppercase()))
}

impl<'s> Checker<'_, 's> {
    fn not_a_variable(&mut self, name: ast::Name<'s>) {
        let error = Diagnostic::new(Code::E0101, name.span, format!("`{}` is not a variable", name.text));
        if !self.lacks_result_type(name) {
            let error = error.label("a variable or a value is expected here");
            let kind = match self.decl.declared(name) {
                Some(crate::names::Entry::Pou(slot)) => Some(self.decl.pous[slot].ast.kind),
                Some(crate::names::Entry::Type(_) | crate::names::Entry::Global(_)) | None => None,
            };
            self.report(match kind {
                Some(ast::PouKind::Function) => error.help(format!("call the FUNCTION: `{}(…)`", name.text)),
                Some(ast::PouKind::FunctionBlock | ast::PouKind::Class) => {
                    error.help(format!("declare an instance: `VAR instance : {}; END_VAR`", name.text))
                }
                Some(ast::PouKind::Program) => error.help("share the value in a VAR_GLOBAL"),
                Some(
                    ast::PouKind::Test
                    | ast::PouKind::Action
                    | ast::PouKind::Interface
                    | ast::PouKind::Method
                    | ast::PouKind::Getter
                    | ast::PouKind::Setter,
                )
                | None => error,
            });
            return;
        }
        if self.signature.as_ref().is_some_and(|it| it.result.is_none() && it.state.is_none()) {
            self.report(
                error
                    .label("this FUNCTION has no result type")
                    .help(format!("write the type after the function's name: `FUNCTION {} : INT`", name.text)),
            );
        }
    }

    /// Whether `name` is a FUNCTION that assigns to its own name, but has no result type.
    pub(crate) fn lacks_result_type(&self, name: ast::Name<'s>) -> bool {
        let Some(crate::names::Entry::Pou(slot)) = self.decl.declared(name) else {
            return false;
        };
        self.decl.pous[slot].names_itself && self.decl.pous[slot].ast.result.is_none()
    }

    /// Reports a name that means nothing here.
    pub(crate) fn unknown_name(&mut self, name: ast::Name<'s>, sought: Missing) {
        if self.decl.names.unread.contains(&Key(name.text)) {
            return;
        }
        if let Some(slot) = self.own_routine(name) {
            let (word, call) = (self.decl.pous[slot].ast.kind.word(), format!("{}()", name.text));
            self.report(
                Diagnostic::new(Code::E0101, name.span, format!("`{}` is {}", name.text, article(word)))
                    .label("a variable or a value is expected here")
                    .help(format!("call it: `{call}`"))
                    .fix(name.span, call),
            );
            return;
        }
        if let Some(crate::names::Entry::Type(_) | crate::names::Entry::Pou(_)) = self.decl.declared(name) {
            self.not_a_variable(name);
            return;
        }
        if self.is_of_unknown_base() {
            return;
        }
        if missing::is_variable(self.decl.dialect(name.span), name.text) {
            return self.report(Diagnostic::unavailable(name.text, name.span, &format!("`{}`", name.text)));
        }
        if let Some(error) = self.decl.not_there(name.text, name.span) {
            self.report(error);
            return;
        }
        if let Some(space) = self.decl.names.space_at(self.decl.site(name.span), &[name]) {
            self.report(self.decl.only_a_namespace(Code::E0101, space, name.text, name.span));
            return;
        }
        let block = self.decl.bare_block(name).is_some();
        let known = |what: &str| Diagnostic::new(Code::E0101, name.span, format!("`{}` is {what}", name.text));
        let mut error = if block {
            known("a FUNCTION_BLOCK, not an instance of one")
        } else if functions::exists(name.text) {
            known("a function, not a variable")
        } else {
            Diagnostic::missing(sought, name.text, name.span)
        }
        .label("unknown name");
        if block {
            self.report(
                error
                    .label("only an instance has pins and can be called")
                    .help(format!("declare one: `VAR instance : {}; END_VAR`", name.text)),
            );
            return;
        }
        if let Some(later) = self.declared_later(name) {
            let message = format!("`{}` is declared after this", name.text);
            self.report(
                Diagnostic::new(Code::E0101, name.span, message)
                    .label("variables start in the order of their declarations")
                    .other(later, "declared here")
                    .help("move that declaration before this one"),
            );
            return;
        }
        if let Some(list) = self.decl.names.qualified_list_with(name.text) {
            let full = format!("{list}.{}", name.text);
            let help = format!("the list has the attribute 'qualified_only': write `{full}`");
            self.report(error.help(help).fix(name.span, full));
            return;
        }
        if self.decl.names.nameless_lists.contains(&Key(name.text)) {
            self.report(self.list_without_a_name(name, error));
            return;
        }
        if let Some(slots) = self.decl.names.qualified_enumerators.get(&Key(name.text)) {
            let full: Vec<_> =
                slots.iter().map(|it| format!("{}.{}", self.decl.types[*it].decl.name.text, name.text)).collect();
            let names: Vec<_> = full.iter().map(String::as_str).collect();
            let help = format!("the enumeration has the attribute 'qualified_only': write {}", any_of(&names));
            let error = error.help(help);
            self.report(match full.as_slice() {
                [one] => error.fix(name.span, one.clone()),
                _ => error,
            });
            return;
        }
        let own = self.scope.variables.iter().map(|it| it.name.text);
        // Each search goes through all names: where there are as many mistakes, no one reads what each may have meant.
        let searched = if self.decl.log.diagnostics.len() < 1000 { usize::MAX } else { 0 };
        let others = own.chain(self.decl.names.all()).take(searched).filter(|it| Key(it) != Key(name.text));
        let near = nearest(name.text, others);
        let enumerators = self.decl.names.enumerators.keys().map(|key| key.0);
        let near = self
            .enumerator_of_beginning(name, near)
            .or(near)
            .or_else(|| nearest(name.text, enumerators))
            .or_else(|| nearest(name.text, CONSTANTS.into_iter()));
        if let Some(helped) = self.help_on_s7_name(name, &error) {
            error = match near {
                Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
                None => helped,
            };
        } else if let Some((_, help)) = FOREIGN.iter().find(|(it, _)| it.eq_ignore_ascii_case(name.text)) {
            error = error.help(*help);
        } else if let Some(hint) = self.decl.hint_of_namespace(name) {
            error = error.help(hint);
        } else if let Some(near) = near {
            error = error.help(format!("did you mean `{near}`?")).fix(name.span, near);
        } else if let Some(number) = hexadecimal(name.text) {
            error = error.help(format!("a number of base 16 is written `{number}`")).fix(name.span, number);
        } else if functions::exists(name.text) {
            error = error.help(format!("call the function: `{}(…)`", name.text));
        }
        self.report(error);
    }

    /// The one enumerator that begins with the name, if no nearer name has the same first letter: `Draining` for `Drain`.
    fn enumerator_of_beginning(&self, name: ast::Name<'s>, near: Option<&str>) -> Option<&'s str> {
        let begins = |long: &str, start: &str| long.get(..start.len()).is_some_and(|it| it.eq_ignore_ascii_case(start));
        let first = name.text.get(..1)?;
        if name.text.len() < 3 || near.is_some_and(|it| begins(it, first)) {
            return None;
        }
        let mut longer = self.decl.names.enumerators.keys().map(|it| it.0).filter(|it| begins(it, name.text));
        longer.next().filter(|_| longer.next().is_none())
    }

    /// Where a variable of the POU has the name, after the initial value that names it.
    fn declared_later(&self, name: ast::Name<'s>) -> Option<Span> {
        let is_before = |it: Span| it.file == name.span.file && it.start < name.span.start;
        let around = self.decl.pous.iter().filter(|it| is_before(it.ast.name.span));
        let pou = around.max_by_key(|it| it.ast.name.span.start).filter(|_| self.context != Context::Body)?;
        let names = pou.ast.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
        let mut later = names.filter(|it| !is_before(it.span) && it.span.file == name.span.file);
        later.find(|it| Key(it.text) == Key(name.text)).map(|it| it.span)
    }

    /// `GVL.x`, where lists of global variables have no names.
    fn list_without_a_name(&self, name: ast::Name<'s>, error: Diagnostic) -> Diagnostic {
        let dialect = self.decl.dialect(name.span).name();
        let help = format!(
            "lists of global variables have names in `codesys`, not in `{dialect}`: write the variable without `{}.`",
            name.text
        );
        let with_point = Span { end: name.span.end + 1, ..name.span };
        let is_before_point = self.decl.log.sources.text(with_point).ends_with('.');
        let error = error.help(help);
        if is_before_point { error.fix(with_point, "") } else { error }
    }
}
