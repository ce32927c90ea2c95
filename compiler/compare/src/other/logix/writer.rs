//! The instructions in place of a file's counter blocks.

mod declarations;

use super::counter::{Counter, Direction, Input};
use super::edit::{Edit, bounds};
use super::instructions;
use super::shape::{Shape, Shapes, last_name};
use staunch_frontend::Span;
use staunch_frontend::ast::{
    Argument, ArgumentKind, BinaryOp, Expr, ExprKind, File, Item, Name, Pou, Statement, StatementKind,
};
use staunch_runtime::PinRole;
use std::collections::HashSet;

/// What is written for one file.
pub struct Writer<'t, 'f> {
    text: &'t str,
    pub shapes: Shapes<'f>,
    pub edits: Vec<Edit>,
    /// Names of counters that a call loads after the instruction.
    pub loaded: HashSet<String>,
}

impl<'t, 'f> Writer<'t, 'f> {
    pub fn new(text: &'t str, shapes: Shapes<'f>, loaded: HashSet<String>) -> Self {
        Self { text, shapes, edits: Vec::new(), loaded }
    }

    pub fn file(&mut self, file: &'f File<'f>) {
        for item in &file.items {
            match item {
                Item::Globals(block) => self.block(block),
                Item::Configuration(it) => it.globals.iter().for_each(|it| self.block(it)),
                Item::Types(decls) => decls.iter().for_each(|it| {
                    self.ty(&it.ty);
                    if let (Some(initial), Some(shape)) = (&it.initial, self.shapes.of_type(&it.ty)) {
                        self.initial(shape, initial);
                    }
                }),
                Item::Pou(_) | Item::Test(_) => {}
            }
        }
        for item in &file.items {
            if let Item::Pou(pou) = item {
                self.pou(pou);
            }
        }
    }

    fn pou(&mut self, pou: &'f Pou<'f>) {
        let outer = self.shapes.variables();
        self.shapes.inherited(pou).into_iter().for_each(|it| self.shapes.declare(it));
        for block in &pou.blocks {
            block.vars.iter().for_each(|it| self.shapes.declare(it));
            self.block(block);
        }
        self.statements(&pou.body);
        pou.routines.iter().for_each(|it| self.pou(it));
        self.shapes.go_back(outer);
    }

    fn edit(&mut self, span: Span, text: String) {
        let (start, end) = bounds(span);
        self.edits.push(Edit { start, end, text });
    }

    fn counter(&self, expr: &Expr<'_>) -> Option<Counter> {
        match self.shapes.of_expr(expr)? {
            Shape::Counter(counter) => Some(counter),
            Shape::Type(_) | Shape::Instance(_) => None,
        }
    }

    fn statements(&mut self, statements: &[Statement<'_>]) {
        statements.iter().for_each(|it| self.statement(it));
    }

    fn statement(&mut self, statement: &Statement<'_>) {
        match &statement.kind {
            StatementKind::Assign { target, value }
            | StatementKind::SetReset { target, value, .. }
            | StatementKind::Bind { target, value }
            | StatementKind::Attempt { target, value } => {
                self.expr(target, false);
                self.expr(value, true);
            }
            StatementKind::AssignAll { targets, value } => {
                targets.iter().for_each(|it| self.expr(it, false));
                self.expr(value, true);
            }
            StatementKind::SetResetAll { targets, value } => {
                targets.iter().for_each(|it| self.expr(&it.0, false));
                self.expr(value, true);
            }
            StatementKind::Expr(expr) => match &expr.kind {
                ExprKind::Call(callee, arguments) => match self.counter(callee) {
                    Some(counter) => self.call(expr.span, callee, counter, arguments),
                    None => self.expr(expr, true),
                },
                _ => self.expr(expr, true),
            },
            StatementKind::If { branches, otherwise } => {
                for (condition, body) in branches {
                    self.expr(condition, true);
                    self.statements(body);
                }
                self.statements(otherwise.as_deref().unwrap_or_default());
            }
            StatementKind::Case { selector, arms, otherwise } => {
                self.expr(selector, true);
                arms.iter().for_each(|it| self.statements(&it.body));
                self.statements(otherwise.as_deref().unwrap_or_default());
            }
            StatementKind::For { from, to, by, body, .. } => {
                [from, to].into_iter().chain(by).for_each(|it| self.expr(it, true));
                self.statements(body);
            }
            StatementKind::While { condition, body } => {
                self.expr(condition, true);
                self.statements(body);
            }
            StatementKind::Repeat { body, until } => {
                self.statements(body);
                self.expr(until, true);
            }
            StatementKind::Try(it) => {
                self.statements(&it.body);
                self.statements(&it.handler);
                it.finally.iter().for_each(|it| self.statements(&it.body));
            }
            StatementKind::ReturnIf(condition) => self.expr(condition, true),
            StatementKind::Empty
            | StatementKind::Label(_)
            | StatementKind::Jump(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Error => {}
        }
    }

    /// Members of counters by their Logix names. `narrow`: a count takes its old type again.
    fn expr(&mut self, expr: &Expr<'_>, narrow: bool) {
        match &expr.kind {
            ExprKind::Literal(_) | ExprKind::Name(_) | ExprKind::Address(_) => {}
            ExprKind::Member(base, name) => match self.counter(base) {
                Some(counter) => self.member(expr, base, *name, counter, narrow),
                None => self.expr(base, narrow),
            },
            ExprKind::Part(inner, _) | ExprKind::Deref(inner) | ExprKind::Unary(_, inner) | ExprKind::Paren(inner) => {
                self.expr(inner, narrow);
            }
            ExprKind::Index(base, indices) => {
                self.expr(base, narrow);
                indices.iter().for_each(|it| self.expr(it, true));
            }
            ExprKind::Error(parts) => parts.iter().for_each(|it| self.expr(it, narrow)),
            ExprKind::Assign(sides, _) => {
                self.expr(&sides[0], false);
                self.expr(&sides[1], true);
            }
            ExprKind::Call(callee, arguments) => {
                self.expr(callee, narrow);
                arguments.iter().for_each(|it| self.argument(it));
            }
            ExprKind::Binary(sides, op, _) => {
                let compares = matches!(
                    op,
                    BinaryOp::Lt | BinaryOp::Gt | BinaryOp::Le | BinaryOp::Ge | BinaryOp::Eq | BinaryOp::Ne
                );
                sides.iter().for_each(|it| self.expr(it, narrow && !compares));
            }
        }
    }

    fn argument(&mut self, argument: &Argument<'_>) {
        match &argument.kind {
            ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => self.expr(value, true),
            ArgumentKind::Output { target, .. } => target.iter().for_each(|it| self.expr(it, false)),
        }
    }

    /// An argument of a counter's call. A preset is a DINT there: the count of another needs no conversion.
    fn argument_of(&mut self, counter: Counter, at: usize, argument: &Argument<'_>) {
        let (input, value) = match &argument.kind {
            ArgumentKind::Positional(value) => (counter.input_at(at), Some(value)),
            ArgumentKind::Input(name, value) => (counter.input_named(name.text), Some(value)),
            ArgumentKind::Output { .. } => (None, None),
        };
        let is_count = |it: &&Expr<'_>| match &it.kind {
            ExprKind::Member(base, _) => self.counter(base).is_some(),
            _ => false,
        };
        match value.filter(|_| input == Some(Input::Pin(PinRole::Preset))).filter(is_count) {
            Some(value) => self.expr(value, false),
            None => self.argument(argument),
        }
    }

    fn member(&mut self, expr: &Expr<'_>, base: &Expr<'_>, name: Name<'_>, counter: Counter, narrow: bool) {
        self.expr(base, true);
        let (start, end) = bounds(base.span);
        let owner = self.apply(start, end);
        if counter.is_empty(name.text) {
            return self.replace(expr.span, format!("({owner}.ACC <= 0)"));
        }
        if self.is_done_late(base, counter, name.text) {
            return self.replace(expr.span, format!("({owner}.ACC >= {owner}.PRE)"));
        }
        let text = match (counter.member(name.text), counter.narrow) {
            (Some(tag @ ("ACC" | "PRE")), Some(conversion)) if narrow => format!("{conversion}({owner}.{tag})"),
            (Some(tag), _) => format!("{owner}.{tag}"),
            // Nothing stands for it; the compiler says so at this place.
            (None, _) => return,
        };
        self.replace(expr.span, text);
    }

    /// A call as instructions. What its inputs are is decided before the first of them.
    fn call(&mut self, span: Span, callee: &Expr<'_>, counter: Counter, arguments: &[Argument<'_>]) {
        self.expr(callee, true);
        let (start, end) = bounds(callee.span);
        let owner = self.apply(start, end);
        if owner != self.text[start..end] {
            // The instructions would change the count that says which counter they are for. The compiler says that
            // a COUNTER is not called.
            return arguments.iter().for_each(|it| self.argument(it));
        }
        for (at, argument) in arguments.iter().enumerate() {
            self.argument_of(counter, at, argument);
        }
        let given = self.inputs(counter, arguments);
        let input = |input: Input| given.iter().find(|it| it.0 == input).map(|it| it.1.as_str());
        let get = |role: PinRole| input(Input::Pin(role));
        let mut lines = Vec::new();
        lines.extend(get(PinRole::Preset).map(|it| format!("{owner}.PRE := {it}")));
        match counter.direction {
            Direction::Up => lines.extend(instructions::up(&owner, get(PinRole::Up), get(PinRole::Reset))),
            Direction::Down => lines.extend(instructions::down(&owner, get(PinRole::Down), get(PinRole::Load))),
            Direction::Both => {
                for role in [PinRole::Up, PinRole::Down, PinRole::Reset] {
                    let member = counter.tag.pin_for(role);
                    lines.extend(get(role).zip(member).map(|(it, member)| format!("{owner}.{} := {it}", member.name)));
                }
                lines.extend(instructions::both(&owner, get(PinRole::Load)));
                if get(PinRole::Load).is_some_and(|it| !it.eq_ignore_ascii_case("FALSE")) {
                    self.loaded.extend(last_name(callee));
                }
            }
        }
        lines.extend(input(Input::Kept).map(|it| format!("{it} := DINT_TO_INT({owner}.ACC)")));
        for argument in arguments {
            if let ArgumentKind::Output { name, negated, target: Some(target) } = &argument.kind {
                let (start, end) = bounds(target.span);
                let value = match (name.text.to_ascii_uppercase().as_str(), counter.narrow) {
                    _ if counter.is_empty(name.text) => format!("{owner}.ACC <= 0"),
                    _ if self.is_done_late(callee, counter, name.text) => format!("{owner}.ACC >= {owner}.PRE"),
                    ("CV", Some(conversion)) => format!("{conversion}({owner}.ACC)"),
                    ("CV", None) => format!("{owner}.ACC"),
                    _ => format!("{owner}.DN"),
                };
                let value = if *negated { format!("NOT ({value})") } else { value };
                lines.push(format!("{} := {value}", self.apply(start, end)));
            }
        }
        self.replace(span, lines.join("; "));
    }

    /// Whether an output is DN of a counter that is loaded after its instruction: DN says so one scan late.
    fn is_done_late(&self, counter: &Expr<'_>, kind: Counter, pin: &str) -> bool {
        let is_loaded = || last_name(counter).is_some_and(|it| self.loaded.contains(&it));
        kind.direction == Direction::Both && kind.is_done(pin) && is_loaded()
    }

    /// Replaces a call; the replacements inside it are part of this one.
    fn replace(&mut self, span: Span, text: String) {
        let (from, to) = bounds(span);
        self.edits.retain(|it| it.start < from || it.end > to);
        self.edits.push(Edit { start: from, end: to, text });
    }

    /// The inputs with the replacements inside them.
    fn inputs(&self, counter: Counter, arguments: &[Argument<'_>]) -> Vec<(Input, String)> {
        let mut found = Vec::new();
        for (at, argument) in arguments.iter().enumerate() {
            let (input, value) = match &argument.kind {
                ArgumentKind::Positional(value) => (counter.input_at(at), value),
                ArgumentKind::Input(name, value) => (counter.input_named(name.text), value),
                ArgumentKind::Output { .. } => continue,
            };
            let (start, end) = bounds(value.span);
            found.extend(input.map(|it| (it, self.apply(start, end))));
        }
        found
    }

    /// The text from `start` to `end` with the replacements in it.
    pub fn apply(&self, start: usize, end: usize) -> String {
        let mut edits: Vec<&Edit> = self.edits.iter().filter(|it| it.start >= start && it.end <= end).collect();
        edits.sort_by_key(|it| it.start);
        let mut out = String::new();
        let mut at = start;
        for edit in edits {
            out.push_str(&self.text[at..edit.start]);
            out.push_str(&edit.text);
            at = edit.end;
        }
        out.push_str(&self.text[at..end]);
        out
    }

    /// The lines that change, before and after.
    pub fn notes(&self) -> Vec<(String, String)> {
        let mut notes: Vec<(String, String)> = Vec::new();
        let mut edits: Vec<&Edit> = self.edits.iter().collect();
        edits.sort_by_key(|it| it.start);
        for edit in edits {
            let start = self.text[..edit.start].rfind('\n').map_or(0, |it| it + 1);
            let end = self.text[edit.end..].find('\n').map_or(self.text.len(), |it| edit.end + it);
            let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
            let note = (one_line(&self.text[start..end]), one_line(&self.apply(start, end)));
            if notes.last() != Some(&note) {
                notes.push(note);
            }
        }
        notes
    }
}
