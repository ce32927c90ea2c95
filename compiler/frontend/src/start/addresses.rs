//! Initial values that are addresses: nothing knows them before the program runs, so they are assigned. In a routine, and
//! in VAR_TEMP, that is at the start of each call, of VAR_STAT and VAR_INST of the first one; elsewhere with the start of
//! instances. What lives for one call is assigned the values of variables, too.

use super::computed::{Owner, When, is_computed_block};
use super::expected::{Bounds, By, Expected, Types};
use super::varying::Names;
use crate::Span;
use crate::added::ADDRESSED;
use crate::ast::{
    BinaryOp, Element, Expr, ExprKind, Initial, InitialKind, LiteralValue, Name, Pou, PouKind, Statement,
    StatementKind, TypeKind, TypeSpec, UnaryOp, VarBlock, VarDecl, VarKind, each_part,
};
use crate::spelling::Key;
use crate::testing::tree::{assign, literal, named, variables};

/// What is assigned before the instances start, whose FB_init may be given it, and after: values of their own
/// variables come after FB_init.
#[derive(Default)]
pub(super) struct Addresses<'s> {
    pub before: Vec<Statement<'s>>,
    pub after: Vec<Statement<'s>>,
    /// What is assigned once, when the instances have started: PROPERTYs, and what asks for them.
    pub late: Vec<Statement<'s>>,
}

impl<'s> Addresses<'s> {
    pub fn is_empty(&self) -> bool {
        self.before.is_empty() && self.after.is_empty() && self.late.is_empty()
    }

    /// Where the first of them is.
    pub fn first(&self) -> Option<Span> {
        self.before.first().or(self.late.first()).map(|it| it.span)
    }

    pub fn append(&mut self, other: Self) {
        self.before.extend(other.before);
        self.after.extend(other.after);
        self.late.extend(other.late);
    }

    /// `body` with what is assigned around it.
    pub fn around(self, body: Vec<Statement<'s>>) -> Vec<Statement<'s>> {
        let Self { mut before, after, late } = self;
        before.extend(body);
        before.extend(after);
        before.extend(late);
        before
    }

    /// All that is assigned where no instance starts in between.
    fn at_once(self) -> Vec<Statement<'s>> {
        let Self { mut before, after: _, late } = self;
        before.extend(late);
        before
    }

    /// A value that is computed; of a member when FB_init has been.
    fn compute(&mut self, target: Expr<'s>, value: Expr<'s>, when: When) {
        let span = value.span;
        let statement = Statement { kind: StatementKind::Assign { target, value }, span };
        match when {
            When::Before => self.before.push(statement),
            When::After => self.late.push(statement),
        }
    }

    fn add(&mut self, target: Expr<'s>, value: Expr<'s>, is_bound: bool, is_member: bool) {
        let span = value.span;
        let kind = match is_bound {
            true => StatementKind::Bind { target, value },
            false => StatementKind::Assign { target, value },
        };
        let statement = Statement { kind, span };
        if is_member {
            self.after.push(statement.clone());
        }
        self.before.push(statement);
    }
}

/// Takes out of a POU the addresses and the values of variables that its calls assign, and puts them before its statements.
pub(super) fn of_calls<'s>(pou: &mut Pou<'s>, types: &Types<'s>, around: &Names<'_, 's>) {
    let mut names = around.with(pou);
    for routine in &mut pou.routines {
        of_calls(routine, types, &names);
    }
    let kind = pou.kind;
    let is_of_calls = |block: &VarBlock<'_>| match kind {
        PouKind::Function | PouKind::Method | PouKind::Getter | PouKind::Setter => {
            matches!(block.kind, VarKind::Var | VarKind::Temp | VarKind::Output)
        }
        PouKind::Program | PouKind::FunctionBlock | PouKind::Test => block.kind == VarKind::Temp,
        PouKind::Class | PouKind::Interface | PouKind::Action => false,
    };
    let has_statements = pou.external.is_none() && !pou.is_stub && pou.modifiers.is_abstract.is_none();
    let names = has_statements.then_some(&mut names);
    let found = taken(pou.blocks.iter_mut().filter(|it| is_of_calls(it)), types, names, Owner::Other);
    pou.body.splice(0..0, found.at_once());
    if kind.is_function() {
        for lasting in [VarKind::Stat, VarKind::Inst] {
            let found = once(pou, lasting, types);
            pou.body.splice(0..0, found);
        }
    }
}

/// Takes out of a POU the addresses of variables that outlive its calls: they are assigned once after each start.
fn once<'s>(pou: &mut Pou<'s>, kind: VarKind, types: &Types<'s>) -> Vec<Statement<'s>> {
    let found = taken(pou.blocks.iter_mut().filter(|it| it.kind == kind), types, None, Owner::Other);
    let Some(first) = found.first() else { return Vec::new() };
    // The source has no name here, and a POU that inherits the block has the same mark.
    let at = pou.blocks.iter().find(|it| it.kind == kind).map_or(first, |it| it.span);
    let flag = ADDRESSED[usize::from(kind == VarKind::Inst)];
    pou.blocks.push(VarBlock { kind, ..variables(&[(flag, &["BOOL"])], at) });
    let open = Expr { kind: ExprKind::Unary(UnaryOp::Not, Box::new(named(flag, at))), span: at };
    let mut then = found.at_once();
    then.push(assign(flag, literal(LiteralValue::Bool(true), at)));
    let kind = StatementKind::If { branches: vec![(open, then)], otherwise: None };
    vec![Statement { kind, span: at }]
}

/// Whether a statement is one that assigns such addresses.
pub(crate) fn is_once(statement: &Statement<'_>) -> bool {
    let StatementKind::If { branches, .. } = &statement.kind else { return false };
    let flag = branches.first().and_then(|it| match &it.0.kind {
        ExprKind::Unary(UnaryOp::Not, flag) => flag.first_name(),
        _ => None,
    });
    flag.is_some_and(|it| ADDRESSED.contains(&it.text))
}

/// Takes the addresses out of the members of a structure, for the start of its variables. Gives the first one.
pub(super) fn of_members<'s>(ty: &mut TypeSpec<'s>, types: &Types<'s>) -> Option<Span> {
    let TypeKind::Struct(members) = &mut ty.kind else { return None };
    let mut first = None;
    for member in members {
        let is_own = |it: &Initial<'_>| match &it.kind {
            InitialKind::Bind(_) => true,
            InitialKind::Value(value) => {
                is_address(value) || Expected::variable(&member.ty, types, None).by(value).is_some()
            }
            InitialKind::Elements(_) | InitialKind::Fields(_) | InitialKind::Indexed(_) | InitialKind::Members(_) => {
                false
            }
        };
        if member.initial.as_ref().is_some_and(is_own) {
            member.started = member.initial.take();
        }
        let own = member.started.as_ref().map(|it| it.span);
        first = first.or(own).or(of_members(&mut member.ty, types));
    }
    first
}

/// Takes out of a POU with a state the addresses that its start assigns.
pub(super) fn of_state<'s>(pou: &mut Pou<'s>, types: &Types<'s>) -> Addresses<'s> {
    // A PROGRAM has one set of variables, so all its calls share them.
    let is_lasting = matches!(pou.kind, PouKind::Program | PouKind::Test);
    let is_state = |it: &&mut VarBlock<'s>| {
        matches!(it.kind, VarKind::Var | VarKind::Input | VarKind::Output) || is_lasting && it.kind == VarKind::Stat
    };
    let owner = Owner::Pou(Key(pou.name.text));
    let mut found = taken(pou.blocks.iter_mut().filter(is_state), types, None, owner);
    let shared = once(pou, VarKind::Stat, types);
    found.before.splice(0..0, shared);
    found
}

/// Takes the addresses out of declarations, and what asks for variables by `names`.
pub(super) fn taken<'a, 's: 'a>(
    blocks: impl Iterator<Item = &'a mut VarBlock<'s>>,
    types: &Types<'s>,
    mut names: Option<&mut Names<'_, 's>>,
    owner: Owner<'s>,
) -> Addresses<'s> {
    let mut found = Addresses::default();
    // What writes to a CONSTANT is refused.
    for block in blocks.filter(|it| !it.has_values()) {
        let owner = if is_computed_block(block) { owner } else { Owner::Other };
        for decl in &mut block.vars {
            take(decl, types, (names.as_deref(), owner), &mut found);
            if let Some(names) = &mut names {
                names.give(&decl.names);
            }
        }
    }
    found
}

fn take<'s>(
    decl: &mut VarDecl<'s>,
    types: &Types<'s>,
    (names, owner): (Option<&Names<'_, 's>>, Owner<'s>),
    found: &mut Addresses<'s>,
) {
    let expected = Expected::variable(&decl.ty, types, names).of(owner);
    if decl.initial.as_ref().is_none_or(|it| !holds_address(it, expected)) {
        return;
    }
    let initial = decl.initial.take();
    if decl.starts_at_calls {
        decl.started = initial.clone();
    }
    for name in decl.names.clone() {
        let target = Expr { kind: ExprKind::Name(name), span: name.span };
        let expected = Expected::variable(&decl.ty, types, names).of(owner);
        decl.initial = initial.clone().and_then(|it| rest(it, &target, expected, found));
    }
}

fn holds_address<'s>(initial: &Initial<'s>, expected: Expected<'_, 's>) -> bool {
    match &initial.kind {
        InitialKind::Bind(_) => true,
        InitialKind::Value(value) => {
            is_address(value) || expected.by(value).is_some() || expected.when(value).is_some()
        }
        InitialKind::Elements(elements) => {
            let Some((_, element)) = expected.elements() else { return false };
            elements.iter().flat_map(|it| &it.values).any(|it| holds_address(it, element))
        }
        // The dialect that has these has no addresses as values.
        InitialKind::Indexed(_) | InitialKind::Members(_) => false,
        InitialKind::Fields(fields) => {
            fields.iter().any(|(name, it)| expected.is_property(*name) || holds_address(it, expected.member(*name)))
        }
    }
}

fn is_address(value: &Expr<'_>) -> bool {
    let mut found = false;
    each_part(value, &mut |it| {
        found |= matches!(&it.kind, ExprKind::Call(callee, _)
            if matches!(&callee.kind, ExprKind::Name(it) if ["ADR", "REF"].iter().any(|name| name.eq_ignore_ascii_case(it.text))));
    });
    found
}

/// What is left of an initial value without its addresses, which are assigned to parts of `target`.
fn rest<'s>(
    initial: Initial<'s>,
    target: &Expr<'s>,
    expected: Expected<'_, 's>,
    found: &mut Addresses<'s>,
) -> Option<Initial<'s>> {
    let (span, is_member) = (initial.span, expected.is_member);
    let kind = match initial.kind {
        InitialKind::Bind(value) => {
            found.add(target.clone(), value, true, is_member);
            return None;
        }
        InitialKind::Value(value) => match expected.by(&value) {
            None if !is_address(&value) => match expected.when(&value) {
                None => InitialKind::Value(value),
                Some(when) => {
                    found.compute(target.clone(), value, if is_member { When::After } else { when });
                    return None;
                }
            },
            by => {
                found.add(target.clone(), value, by == Some(By::Binding), is_member);
                return None;
            }
        },
        InitialKind::Fields(fields) => InitialKind::Fields(of_fields(fields, target, expected, found)),
        InitialKind::Elements(elements) => match expected.elements() {
            Some((bounds, element)) if elements.iter().all(|it| count(it).is_some()) => {
                InitialKind::Elements(of_elements(elements, target, (&bounds, element), found))
            }
            _ => InitialKind::Elements(elements),
        },
        kind @ (InitialKind::Indexed(_) | InitialKind::Members(_)) => kind,
    };
    match &kind {
        InitialKind::Fields(fields) if fields.is_empty() => None,
        _ => Some(Initial { kind, span }),
    }
}

fn of_fields<'s>(
    fields: Vec<(Name<'s>, Initial<'s>)>,
    target: &Expr<'s>,
    expected: Expected<'_, 's>,
    found: &mut Addresses<'s>,
) -> Vec<(Name<'s>, Initial<'s>)> {
    let one = |(name, initial): (Name<'s>, Initial<'s>)| {
        let member = Expr { kind: ExprKind::Member(Box::new(target.clone()), name), span: name.span };
        match initial.kind {
            InitialKind::Value(value) if expected.is_property(name) => {
                found.compute(member, value, expected.when_property());
                None
            }
            _ => Some((name, rest(initial, &member, expected.member(name), found)?)),
        }
    };
    fields.into_iter().filter_map(one).collect()
}

fn of_elements<'s>(
    elements: Vec<Element<'s>>,
    target: &Expr<'s>,
    (bounds, expected): (&[Bounds<'_, 's>], Expected<'_, 's>),
    found: &mut Addresses<'s>,
) -> Vec<Element<'s>> {
    let mut at = 0;
    let mut left = Vec::new();
    for element in elements {
        if !element.values.iter().any(|it| holds_address(it, expected)) {
            at += count(&element).unwrap_or_default() * u64::try_from(element.values.len().max(1)).unwrap_or_default();
            left.push(element);
            continue;
        }
        for _ in 0..count(&element).unwrap_or_default() {
            for value in &element.values {
                let span = value.span;
                let one = Expr { kind: ExprKind::Index(Box::new(target.clone()), indices(bounds, at, span)), span };
                let values: Vec<_> = rest(value.clone(), &one, expected, found).into_iter().collect();
                // A repeat without values has those of the element's type.
                let single = literal(LiteralValue::Integer { value: 1, based: false }, span);
                left.push(Element { count: values.is_empty().then_some(single), values });
                at += 1;
            }
        }
    }
    left
}

/// The element `at` places after the first: the last index changes first. The bounds may be names.
fn indices<'s>(bounds: &[Bounds<'_, 's>], at: u64, span: Span) -> Vec<Expr<'s>> {
    let number = |value| literal(LiteralValue::Integer { value, based: false }, span);
    let apply = |a: Expr<'s>, op, b: Expr<'s>| Expr { kind: ExprKind::Binary(Box::new([a, b]), op, span), span };
    let mut places = number(at);
    let mut found = Vec::new();
    // The first index comes round, too: a value past the array is reported with the others that are too many.
    for (low, high) in bounds.iter().rev() {
        let (low, high) = ((*low).clone(), (*high).clone());
        let length = apply(apply(high, BinaryOp::Sub, low.clone()), BinaryOp::Add, number(1));
        found.push(apply(low, BinaryOp::Add, apply(places.clone(), BinaryOp::Mod, length.clone())));
        places = apply(places, BinaryOp::Div, length);
    }
    found.reverse();
    found
}

/// How often the values of an element are there, where a number says it.
fn count(element: &Element<'_>) -> Option<u64> {
    match &element.count {
        None => Some(1),
        Some(Expr { kind: ExprKind::Literal(it), .. }) => match it.value {
            LiteralValue::Integer { value, .. } => Some(value).filter(|it| *it <= MOST),
            _ => None,
        },
        Some(_) => None,
    }
}

/// Repeats of an address that are written out.
const MOST: u64 = 1000;
