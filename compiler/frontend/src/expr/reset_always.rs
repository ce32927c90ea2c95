//! W0507: a timer or counter that each scan resets which calls it. No time passes for it, and no count adds up.

use super::called_twice::{only_resets, resets_surely};
use super::checker::Checker;
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ExprKind as Ast, StatementKind};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Section, Type};
use staunch_runtime::PinRole;

/// How an instance is called in a list of statements, and in those within.
#[derive(Clone, Copy, Debug, Default)]
struct Calls {
    /// The first call of the list itself that resets it.
    resets: Option<Span>,
    /// The first call that gives it its input, without one that resets it whenever this one is executed.
    open: Option<Span>,
    /// The first two calls of which one takes back what the other gives.
    pair: Option<[Span; 2]>,
}

impl Calls {
    /// Whether all that is given is taken back: the call that does, and the one that gave.
    fn dead(&self) -> Option<[Span; 2]> {
        self.pair.filter(|_| self.open.is_none())
    }
}

impl<'s> Checker<'_, 's> {
    /// `t(IN := start, PT := T#1s); t(IN := FALSE);`: both calls in each scan, so that the timer never runs.
    pub(crate) fn reset_always(&mut self, slot: usize, body: &[ast::Statement<'s>]) {
        if self.is_test() || may_leave(body) {
            return;
        }
        let found = self.paired_calls(body).into_iter();
        let mut found: Vec<_> = found.filter_map(|(name, calls)| Some((name, calls.dead()?))).collect();
        // Whether another one EXTENDS this is found by asking all.
        if found.is_empty() || !self.is_whole(slot) {
            return;
        }
        let elsewhere = elsewhere(body);
        found.retain(|(name, _)| !elsewhere.contains(name));
        found.sort_by_key(|(_, [resets, _])| resets.start);
        for (name, [resets, gives]) in found {
            self.dead_calls.extend([resets, gives]);
            self.report_reset(name.0, resets, gives);
        }
    }

    fn report_reset(&mut self, name: &str, resets: Span, gives: Span) {
        let Some(Type::Block(block)) = self.scope.get(name).map(|it| it.place.ty) else { return };
        let resets_by = |role| block.info().inputs().find(|it| it.role == Some(role));
        let (effect, help) = match resets_by(PinRole::Reset).or_else(|| resets_by(PinRole::Load)) {
            None => (
                "no time passes for it",
                format!("reset it under a condition: `IF {name}.Q THEN {name}(IN := FALSE); END_IF`"),
            ),
            Some(pin) => (
                "its count is lost each time",
                format!("reset it in the call that counts, with a condition: `{} := stop`", pin.name),
            ),
        };
        let message = format!("`{name}` is reset in every scan that calls it: {effect}");
        self.report(
            Diagnostic::new(Code::W0507, resets, message)
                .label("this call resets it each time")
                .other(gives, "what this call starts is lost")
                .help(help),
        );
    }

    /// Whether no other text calls the POU's instances.
    fn is_whole(&self, slot: usize) -> bool {
        let pou = self.decl.pous[slot].ast;
        let name = Key(pou.name.text);
        let is_alone = pou.routines.is_empty() && pou.extends.is_none() && pou.external.is_none();
        let is_base = || self.decl.pous.iter().any(|it| it.ast.extends.is_some_and(|it| Key(it.text) == name));
        matches!(pou.kind, ast::PouKind::Program | ast::PouKind::FunctionBlock) && is_alone && !is_base()
    }

    fn paired_calls(&self, statements: &[ast::Statement<'s>]) -> FxHashMap<Key<'s>, Calls> {
        let mut found: FxHashMap<Key<'s>, Calls> = FxHashMap::default();
        for statement in statements {
            if let StatementKind::Expr(expr) = &statement.kind {
                self.note_direct(expr, &mut found);
            }
            ast::each_body(statement, &mut |body| {
                for (name, inner) in self.paired_calls(body) {
                    let calls = found.entry(name).or_default();
                    calls.open = calls.open.or(inner.open);
                    calls.pair = calls.pair.or(inner.pair);
                }
            });
        }
        for calls in found.values_mut() {
            if let (Some(resets), Some(open)) = (calls.resets, calls.open) {
                calls.pair.get_or_insert([resets, open]);
                calls.open = None;
            }
        }
        found
    }

    /// Notes what a statement of the list is.
    fn note_direct(&self, expr: &ast::Expr<'s>, found: &mut FxHashMap<Key<'s>, Calls>) {
        let Ast::Call(callee, arguments) = &expr.kind else { return };
        let Ast::Name(name) = callee.kind else { return };
        let Some(variable) = self.scope.get(name.text) else { return };
        if variable.section != Section::Internal {
            return;
        }
        let ty = variable.place.ty;
        let resets = match () {
            () if is_on_delay(ty) => only_resets(ty, arguments),
            () if is_counter(ty) => resets_surely(ty, arguments),
            () => return,
        };
        let calls = found.entry(Key(name.text)).or_default();
        let at = if resets { &mut calls.resets } else { &mut calls.open };
        at.get_or_insert(callee.span);
    }
}

/// Whether a scan may end, or leave a loop, before all statements of a list were executed.
fn may_leave(statements: &[ast::Statement<'_>]) -> bool {
    statements.iter().any(|it| {
        let mut inside = false;
        ast::each_body(it, &mut |body| inside |= may_leave(body));
        let leaves = match it.kind {
            StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::ReturnIf(_)
            // A fault leaves what comes after it.
            | StatementKind::Try(_)
            // What is jumped over, or to, is executed in some scans only.
            | StatementKind::Label(_)
            | StatementKind::Jump(_) => true,
            StatementKind::Error
            | StatementKind::Empty
            | StatementKind::Assign { .. }
            | StatementKind::AssignAll { .. }
            | StatementKind::SetReset { .. }
            | StatementKind::SetResetAll { .. }
            | StatementKind::Bind { .. }
            | StatementKind::Attempt { .. }
            | StatementKind::Expr(_)
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::For { .. }
            | StatementKind::While { .. }
            | StatementKind::Repeat { .. } => false,
        };
        inside || leaves
    })
}

/// The instances that are more than called and asked: passed on, referred to, or given an input by an assignment.
fn elsewhere<'s>(body: &[ast::Statement<'s>]) -> FxHashSet<Key<'s>> {
    let mut uses: FxHashMap<Key<'s>, usize> = FxHashMap::default();
    let mut known: FxHashMap<Key<'s>, usize> = FxHashMap::default();
    let name_of = |it: &ast::Expr<'s>| match it.kind {
        Ast::Name(name) => Some(Key(name.text)),
        _ => None,
    };
    ast::each_expr(body, &mut |it| {
        if let Some(name) = name_of(it) {
            *uses.entry(name).or_default() += 1;
        }
        let owner = match &it.kind {
            Ast::Call(callee, _) => name_of(callee),
            Ast::Member(base, member) if !is_input(member.text) => name_of(base),
            _ => None,
        };
        if let Some(name) = owner {
            *known.entry(name).or_default() += 1;
        }
    });
    uses.retain(|name, uses| known.get(name) != Some(uses));
    uses.into_keys().collect()
}

fn is_input(member: &str) -> bool {
    let role = PinRole::named(member);
    let of_counter = matches!(role, Some(PinRole::Up | PinRole::Down | PinRole::Reset | PinRole::Load));
    of_counter || member.eq_ignore_ascii_case("IN") || member.eq_ignore_ascii_case("PT")
}

/// Whether only calls with IN TRUE, and time between them, bring its output.
fn is_on_delay(ty: Type) -> bool {
    matches!(ty, Type::Block(id) if id.info().name.ends_with("TON") && id.info().pin("PT").is_some())
}

fn is_counter(ty: Type) -> bool {
    let Type::Block(id) = ty else { return false };
    let has = |role| id.info().inputs().any(|it| it.role == Some(role));
    (has(PinRole::Up) || has(PinRole::Down)) && (has(PinRole::Reset) || has(PinRole::Load))
}
