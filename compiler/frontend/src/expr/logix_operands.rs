//! Counters and timers with their operands as Logix's pages list them, `CTU(counter_1, 10, 0)`: the
//! preset and the accumulated value are the structure's members in Structured Text.

use super::checker::Checker;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast, LiteralValue};
use staunch_ir::{BlockId, Const, Place, Projection, Root, Type, Value};
use staunch_runtime::{Family, PinRole};

const COUNTERS: [&str; 2] = ["CTU", "CTD"];
const TIMERS: [&str; 3] = ["TON", "TOF", "RTO"];

/// What is given in such a call.
struct Operands<'a, 's> {
    tag: &'a ast::Expr<'s>,
    preset: Option<&'a ast::Expr<'s>>,
    count: Option<&'a ast::Expr<'s>>,
    rung: Option<&'a ast::Expr<'s>>,
    /// Of the preset and the count.
    span: Span,
}

impl<'a, 's> Operands<'a, 's> {
    /// The members of a COUNTER or TIMER that they stand for; each starts at 0.
    fn members(&self) -> impl Iterator<Item = (&'static str, &'a ast::Expr<'s>)> {
        let count = self.count.filter(|it| integer(it) != Some(0));
        self.preset.map(|it| ("PRE", it)).into_iter().chain(count.map(|it| ("ACC", it)))
    }
}

impl<'s> Checker<'_, 's> {
    /// Reports a call whose operands are written so; whether it did.
    pub(crate) fn has_logix_operands(&mut self, callee: &ast::Expr<'s>, arguments: &[ast::Argument<'s>]) -> bool {
        let (name, family) = match &callee.kind {
            Ast::Name(name) => (*name, self.decl.dialect(name.span).family()),
            Ast::Member(base, name) => match &base.kind {
                Ast::Name(owner) if owner.text.eq_ignore_ascii_case(Family::Logix.name()) => (*name, Family::Logix),
                _ => return false,
            },
            _ => return false,
        };
        let is_in = |names: &[&str]| names.iter().any(|it| it.eq_ignore_ascii_case(name.text));
        if !(is_in(&COUNTERS) || is_in(&TIMERS)) {
            return false;
        }
        let own = self.decl.lookup(&[name], Sense::Callee);
        let is_own = matches!(own, Found::One(Meaning::Declared(Entry::Pou(_) | Entry::Global(_))));
        if is_own || self.scope.get(name.text).is_some() || self.calls_own_routine(callee) {
            return false;
        }
        let Some(given) = operands(arguments, family == Family::Logix) else { return false };
        // What is not declared yet is a part of the advice.
        match &given.tag.kind {
            Ast::Name(tag) if self.scope.get(tag.text).is_none() => {}
            _ => drop(self.place(given.tag)),
        }
        for expr in given.preset.into_iter().chain(given.count).chain(given.rung) {
            self.operand(expr, None);
        }
        let error = match (is_in(&COUNTERS), family) {
            (true, Family::Logix) => self.of_structure("COUNTER", callee, &given, arguments),
            (true, _) => self.of_block(name, family, &given),
            (false, Family::Logix) => self.of_structure("TIMER", callee, &given, arguments),
            (false, _) => self.of_timer(name, &given),
        };
        self.report(error);
        true
    }

    fn source(&self, expr: &ast::Expr<'s>) -> &str {
        self.decl.log.sources.text(expr.span)
    }

    /// The declaration that holds what the operands say, as far as it is constant.
    fn declaration(&self, given: &Operands<'_, 's>, ty: &str) -> String {
        let text = |(name, expr): (&str, &ast::Expr<'s>)| format!("{name} := {}", self.source(expr));
        let members = given.members().filter(|it| integer(it.1).is_some());
        let members: Vec<_> = members.map(text).collect();
        let tag = self.source(given.tag);
        if members.is_empty() { format!("{tag} : {ty}") } else { format!("{tag} : {ty} := ({})", members.join(", ")) }
    }

    fn rung<'a>(&'a self, given: &Operands<'_, 's>) -> &'a str {
        given.rung.map_or("condition", |it| self.source(it))
    }

    fn of_structure(
        &self,
        structure: &str,
        callee: &ast::Expr<'s>,
        given: &Operands<'_, 's>,
        arguments: &[ast::Argument<'s>],
    ) -> Diagnostic {
        let (tag, name) = (self.source(given.tag), self.source(callee));
        let message = format!("in Structured Text, `{name}` has no operands for the preset and the accumulated value");
        let error = Diagnostic::new(Code::E0302, given.span, message).label(format!("the {structure} holds them"));
        if let (Some(_), Some(first), Some(last)) = (given.rung, arguments.first(), arguments.last())
            && self.is_declared_so(given)
        {
            let span = Span { end: last.span.end, ..first.span };
            let call = format!("{tag}, RungIn := {}", self.rung(given));
            return error.help(format!("the {structure} is declared with them; leave them out")).fix(span, call);
        }
        let is_name = matches!(given.tag.kind, Ast::Name(_));
        let before = given.members().filter(|it| !is_name || integer(it.1).is_none());
        let before = before.map(|(member, expr)| format!("{tag}.{member} := {}; ", self.source(expr)));
        let call = format!("`{}{name}({tag}, RungIn := {});`", before.collect::<String>(), self.rung(given));
        let owner = if matches!(callee.kind, Ast::Name(_)) { "" } else { "LOGIX." };
        error.help(match is_name {
            true => format!("declare `{}`, and write {call}", self.declaration(given, &format!("{owner}{structure}"))),
            false => format!("write {call}"),
        })
    }

    /// Whether the structure starts with what the operands say, so that they can be left out.
    fn is_declared_so(&self, given: &Operands<'_, 's>) -> bool {
        let Ast::Name(tag) = &given.tag.kind else { return false };
        let Some(variable) = self.scope.get(tag.text) else { return false };
        let Type::Block(block) = variable.place.ty else { return false };
        let Some(initial) = self.initial(&variable.place) else { return false };
        let holds = |pin: &str, expr: Option<&ast::Expr<'s>>| {
            expr.is_none_or(|it| integer(it).is_some() && integer(it) == member(block, initial, pin))
        };
        holds("PRE", given.preset) && holds("ACC", given.count)
    }

    fn initial(&self, place: &Place) -> Option<&Const> {
        let program = &self.decl.program;
        let owner = match place.root {
            Root::Instance => self.signature.as_ref()?.state?,
            Root::Globals => program.globals,
            Root::Local(_) | Root::Param(_) => return None,
        };
        match place.projections.as_slice() {
            [Projection::Field(field)] => Some(&program.structure(owner).fields[field.index()].initial),
            _ => None,
        }
    }

    /// Where the name is a block's: both ways to write it.
    fn of_block(&self, name: ast::Name<'s>, family: Family, given: &Operands<'_, 's>) -> Diagnostic {
        let (tag, text) = (self.source(given.tag), name.text);
        let error =
            Diagnostic::new(Code::E0305, name.span, format!("this call of `{text}` lists its operands as in Logix"))
                .label(format!("a bare `{text}` is a FUNCTION_BLOCK of {}", family.name()));
        let logix = format!(
            "for the counter of Logix declare `{}`, and write `LOGIX.{text}({tag}, RungIn := {})`",
            self.declaration(given, "LOGIX.COUNTER"),
            self.rung(given)
        );
        let Some(block) = self.decl.bare_block(name) else { return error.help(logix) };
        let info = block.info();
        let pins = [PinRole::Up, PinRole::Down, PinRole::Reset, PinRole::Load, PinRole::Preset];
        let value = |role: PinRole| match role {
            PinRole::Up | PinRole::Down => self.rung(given).to_owned(),
            PinRole::Preset => given.preset.map_or("preset", |it| self.source(it)).to_owned(),
            PinRole::Load => "load".to_owned(),
            _ => "clear".to_owned(),
        };
        let pins = pins.into_iter().filter_map(|role| Some(format!("{} := {}", info.pin_for(role)?.name, value(role))));
        let pins: Vec<_> = pins.collect();
        error.note(logix).help(format!("declare `{tag} : {};`, and call `{tag}({})`", info.name, pins.join(", ")))
    }

    /// A TIMER counts milliseconds.
    fn of_timer(&self, name: ast::Name<'s>, given: &Operands<'_, 's>) -> Diagnostic {
        let (tag, text) = (self.source(given.tag), name.text);
        let error =
            Diagnostic::new(Code::E0305, name.span, format!("this call of `{text}` lists its operands as in Logix"));
        let logix = format!(
            "for the timer of Logix declare `{}`, and write `LOGIX.{text}({tag}, RungIn := {})`",
            self.declaration(given, "LOGIX.TIMER"),
            self.rung(given)
        );
        if text.eq_ignore_ascii_case("RTO") {
            return error.label("no other system has a retentive timer").help(logix);
        }
        let preset = match given.preset {
            Some(it) if integer(it).is_some() => format!("T#{}ms", self.source(it)),
            Some(it) => format!("{} in milliseconds, as a TIME", self.source(it)),
            None => "T#1s".to_owned(),
        };
        error
            .label("a timer is a FUNCTION_BLOCK; its preset is a TIME")
            .note(logix)
            .help(format!("declare `{tag} : {text};`, and call `{tag}(IN := {}, PT := {preset})`", self.rung(given)))
    }
}

/// What Structured Text has for an instruction of ladder.
pub(super) fn of_ladder(name: &str) -> Option<&'static str> {
    const MEANT: &[(&[&str], &str)] = &[
        (&["XIC", "XIO"], "read the tag: `tag`, or `NOT tag`"),
        (&["OTE"], "assign the condition: `tag := condition;`"),
        (&["MOV"], "write `destination := source;`"),
        (&["CPT"], "write `destination := expression;`"),
        (&["JSR"], "declare the routine as a FUNCTION_BLOCK or an ACTION, and call it by its name: `Routine();`"),
    ];
    let is_it = |names: &[&str]| names.iter().any(|it| it.eq_ignore_ascii_case(name));
    MEANT.iter().find(|(names, _)| is_it(names)).map(|(_, meant)| *meant)
}

/// The operator that Structured Text has for an instruction of ladder with a destination: `ADD(a, b, sum)`.
pub(super) fn computed_in_ladder(name: &str) -> Option<&'static str> {
    let signs = [
        ("ADD", "+"),
        ("SUB", "-"),
        ("MUL", "*"),
        ("DIV", "/"),
        ("MOD", "MOD"),
        ("AND", "AND"),
        ("OR", "OR"),
        ("XOR", "XOR"),
    ];
    signs.iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
}

/// The operands, where there is a preset or a count among them. Without `instructions` a bare name is a
/// block, and only a number where a block has a BOOL says that Logix's are meant.
fn operands<'a, 's>(arguments: &'a [ast::Argument<'s>], instructions: bool) -> Option<Operands<'a, 's>> {
    let mut named: [Option<&ast::Expr<'s>>; 4] = [None; 4];
    let mut positional = Vec::new();
    let mut span: Option<Span> = None;
    for argument in arguments {
        match &argument.kind {
            ArgumentKind::Positional(value) => positional.push(value),
            ArgumentKind::Input(name, value) => {
                let at = NAMES.iter().position(|it| it.iter().any(|it| it.eq_ignore_ascii_case(name.text)))?;
                named[at] = Some(value);
            }
            ArgumentKind::Output { .. } => return None,
        }
    }
    let [tag, mut preset, mut count, mut rung] = named;
    let mut values = positional.into_iter();
    let tag = tag.or_else(|| values.next())?;
    let mut rest: Vec<_> = values.collect();
    if rest.len() > 2 && rung.is_none() {
        // Counter, Preset, Accum is the vendor's order: the rung is what follows, unless numbers follow it.
        let is_number = |at: usize| integer(rest[at]).is_some();
        rung = Some(rest.remove(if !is_number(0) && is_number(2) { 0 } else { 2 }));
    }
    let number = |at: usize| rest.get(at).and_then(|it| integer(it));
    // 0 or 1 alone is a rung.
    let is_preset = number(0).is_some_and(|it| rest.len() > 1 || !instructions || !matches!(it, 0 | 1));
    let is_value = is_preset || instructions && number(1).is_some();
    if is_value {
        preset = preset.or_else(|| rest.first().copied());
        count = count.or_else(|| rest.get(1).copied());
    }
    for value in preset.into_iter().chain(count) {
        let to = |it: Span| Span { start: it.start.min(value.span.start), end: it.end.max(value.span.end), ..it };
        span = Some(span.map_or(value.span, to));
    }
    Some(Operands { tag, preset, count, rung, span: span? })
}

/// What the parts of an instruction are called.
const NAMES: [&[&str]; 4] =
    [&["Counter", "Timer"], &["Preset", "PRE"], &["Accum", "ACC", "Accumulated", "Accumulator"], &["RungIn"]];

fn integer(expr: &ast::Expr<'_>) -> Option<i128> {
    match &expr.kind {
        Ast::Literal(ast::Literal { value: LiteralValue::Integer { value, .. }, .. }) => Some(i128::from(*value)),
        Ast::Unary(ast::UnaryOp::Neg, inner) => integer(inner).map(|it| -it),
        Ast::Paren(inner) => integer(inner),
        _ => None,
    }
}

fn member(block: BlockId, initial: &Const, pin: &str) -> Option<i128> {
    let at = block.info().pins.iter().position(|it| it.is_named(pin))?;
    match initial {
        Const::Zero => Some(0),
        Const::Struct(pins) => match pins.get(at)? {
            Const::Zero => Some(0),
            Const::Scalar(value) => Value::as_integer(*value),
            Const::Text(_) | Const::Array(_) | Const::Struct(_) => None,
        },
        Const::Scalar(_) | Const::Text(_) | Const::Array(_) => None,
    }
}
