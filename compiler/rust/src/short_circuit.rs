//! AND_THEN and OR_ELSE, which the IR has as statements about a temporary, printed as Rust's `&&` and `||` where one condition or
//! assignment reads what they come to.

use std::collections::HashMap;

use proc_macro2::TokenStream;
use quote::quote;
use staunch_ir::{Block, Expr, ExprKind, LocalId, Op, Place, Root, Statement, StatementKind};

use crate::function::Function;
use crate::precedence::{Code, Level};

/// Statements that one expression may be.
const MOST: usize = 16;

/// What the statements before one come to, and which that is.
pub struct Folded<'s> {
    value: Code,
    /// What is read is that, negated.
    negated: bool,
    pub reader: &'s Statement,
    pub after: &'s [Statement],
}

/// How often each temporary is mentioned in what is folded.
type Mentions = HashMap<LocalId, usize>;

impl Function<'_> {
    /// `both := a; IF both THEN both := b; END_IF IF both …`: the value that the last of these reads, where nothing else does.
    pub fn fold<'s>(&self, statements: &'s [Statement]) -> Option<Folded<'s>> {
        let [first, second, ..] = statements else { return None };
        let (started, _) = assigned(first)?;
        if deciding(second)? != started {
            return None;
        }
        (2..statements.len().min(MOST)).rev().find_map(|at| {
            let (before, reader) = (&statements[..at], &statements[at]);
            let (temporary, negated) = negations(self.read(reader)?)?;
            let mut mentions = Mentions::new();
            let value = self.choice(before, temporary, &mut mentions)?;
            *mentions.entry(temporary).or_default() += 1;
            let is_all = mentions.iter().all(|(id, count)| self.is_temporary(*id, *count));
            is_all.then_some(Folded { value, negated, reader, after: &statements[at + 1..] })
        })
    }

    /// What a block leaves in a temporary, where it does no more than that.
    fn choice(&self, block: &[Statement], wanted: LocalId, mentions: &mut Mentions) -> Option<Code> {
        let (last, before) = block.split_last()?;
        if let Some((target, value)) = assigned(last) {
            *mentions.entry(wanted).or_default() += 1;
            return match negations(value) {
                _ if target != wanted => None,
                Some((from, is_negated)) if !before.is_empty() => {
                    *mentions.entry(from).or_default() += 1;
                    let value = self.choice(before, from, mentions)?;
                    Some(if is_negated { not(value) } else { value })
                }
                Some(_) | None => before.is_empty().then(|| self.expr(value)),
            };
        }
        let StatementKind::If { then, otherwise, .. } = &last.kind else { return None };
        if deciding(last)? != wanted {
            return None;
        }
        *mentions.entry(wanted).or_default() += 1;
        let (level, other) = if otherwise.is_empty() { (Level::LazyAnd, then) } else { (Level::LazyOr, otherwise) };
        let first = self.choice(before, wanted, mentions)?.at_least(level);
        let second = self.choice(other, wanted, mentions)?.at_least(level);
        let both = if level == Level::LazyAnd { quote!(#first && #second) } else { quote!(#first || #second) };
        Some(Code::new(both, level))
    }

    /// Whether a local lives for these mentions alone.
    fn is_temporary(&self, id: LocalId, mentions: usize) -> bool {
        self.plan.locals[id.index()].mentions == mentions
            && self.routine.result != Some(id)
            && !self.borrowed[id.index()]
    }

    /// The condition, or what is assigned.
    fn read<'s>(&self, statement: &'s Statement) -> Option<&'s Expr> {
        match &statement.kind {
            StatementKind::If { condition, .. } => Some(condition),
            StatementKind::Assign { target, value } => (!self.place_faults(target)).then_some(value),
            _ => None,
        }
    }

    /// The statement that reads a folded value.
    pub fn reader(&mut self, it: &Folded<'_>) -> TokenStream {
        let value = it.condition().tokens;
        match &it.reader.kind {
            StatementKind::If { then, otherwise, .. } => self.if_so(&value, then, otherwise),
            StatementKind::Assign { target, .. } => self.assigned(it.reader, target, value),
            _ => unreachable!("nothing else reads a folded value"),
        }
    }
}

impl Folded<'_> {
    /// Whether a block is an IF and no more.
    pub fn is_all_and_an_if(&self) -> bool {
        self.after.is_empty() && matches!(self.reader.kind, StatementKind::If { .. })
    }

    fn condition(&self) -> Code {
        let value = self.value.clone();
        if self.negated { not(value) } else { value }
    }

    /// The condition for continuing in a loop that starts by leaving if the value is TRUE.
    pub fn stay(&self) -> Code {
        let value = self.value.clone();
        if self.negated { value } else { not(value) }
    }
}

/// The local that an expression is, and whether it is that negated.
fn negations(expr: &Expr) -> Option<(LocalId, bool)> {
    match &expr.kind {
        ExprKind::Apply(Op::Not, operands) => negations(&operands[0]).map(|it| (it.0, !it.1)),
        _ => Some((loaded(expr)?, false)),
    }
}

fn not(value: Code) -> Code {
    let value = value.at_least(Level::Unary);
    Code::new(quote!(!#value), Level::Unary)
}

fn local(place: &Place) -> Option<LocalId> {
    match place.root {
        Root::Local(id) if place.projections.is_empty() => Some(id),
        Root::Local(_) | Root::Instance | Root::Globals | Root::Param(_) => None,
    }
}

fn loaded(expr: &Expr) -> Option<LocalId> {
    let ExprKind::Load(place) = &expr.kind else { return None };
    local(place)
}

fn assigned(statement: &Statement) -> Option<(LocalId, &Expr)> {
    let StatementKind::Assign { target, value } = &statement.kind else { return None };
    Some((local(target)?, value))
}

/// The local on which an IF depends that has something on one side alone.
fn deciding(statement: &Statement) -> Option<LocalId> {
    let StatementKind::If { condition, then, otherwise } = &statement.kind else { return None };
    let is_one = |a: &Block, b: &Block| a.is_empty() != b.is_empty();
    is_one(then, otherwise).then(|| loaded(condition))?
}
