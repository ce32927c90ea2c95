//! AxUnit's mocks: `AxUnit.Mocking.Mock(NAME_OF(A), NAME_OF(B), payload)` lets B run in place of A. A's body begins with a
//! call of each B that some `Mock` names, under the condition that the library's `__mocks` has its number.

use super::tree::{is_named, literal, named, statement};
use crate::ast::{
    Argument, ArgumentKind, BinaryOp, Expr, ExprKind, File, Item, LiteralValue, Name, Pou, PouKind, Statement,
    StatementKind, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind, each_expr,
};
use crate::spelling::Key;
use crate::{Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};

/// The namespace, and the functions in it that change what runs.
const SPACE: [&str; 2] = ["AxUnit", "Mocking"];
pub(crate) const WITH: &str = "__exchange";
pub(crate) const ALONE: &str = "__exchange_alone";
const BACK: &str = "__exchange_back";
const MOCKS: &str = "__mocks";
const PAYLOAD: &str = "__payload";
const PAYLOADS: &str = "__payloads";
const KEPT: &str = "__kept_payload";
/// What the library has places for.
const MOST: u16 = 255;
/// The instances of FUNCTION_BLOCKs that run in place of one.
const INSTANCES: [&str; 8] =
    ["__mock_1", "__mock_2", "__mock_3", "__mock_4", "__mock_5", "__mock_6", "__mock_7", "__mock_8"];

/// What is exchanged.
#[derive(Clone, Debug, Default)]
pub(crate) struct Exchanged {
    /// The numbers by which the library knows what is exchanged and what runs in its place, by the places of their names.
    pub numbers: FxHashMap<(Span, Span), (u16, u16)>,
    /// Where what is added to bodies says that it is written.
    pub places: FxHashSet<Span>,
}

/// What a `Mock` names: the last name of what is exchanged, and the path to what runs in its place.
struct Mock<'s> {
    mockee: Name<'s>,
    mock: Vec<Name<'s>>,
}

/// What may run in place of something.
struct Head<'s> {
    name: Name<'s>,
    kind: PouKind,
    parameters: Vec<(VarKind, Key<'s>)>,
}

/// Puts the mocks before the bodies that they exchange.
pub(crate) fn expand<'s>(files: &mut [File<'s>], sources: &'s Sources) -> Exchanged {
    let mut exchanged = Exchanged::default();
    let mocks = mocks(files, sources);
    if mocks.is_empty() {
        return exchanged;
    }
    let head = |it: &Pou<'s>| Head { name: it.name, kind: it.kind, parameters: parameters(it) };
    let heads: Vec<_> = pous(files).map(head).collect();
    let bases: Vec<_> = pous(files).filter_map(|it| it.extends).map(|it| Key(it.text)).collect();
    let mut number = 0;
    for pou in files.iter_mut().flat_map(|it| &mut it.items).filter_map(pou_mut) {
        let is_of = |it: &&Mock<'s>| Key(it.mockee.text) == Key(pou.name.text);
        let own: Vec<_> = mocks.iter().filter(is_of).collect();
        if own.is_empty() || !can_be_exchanged(pou) || bases.contains(&Key(pou.name.text)) || number == MOST {
            continue;
        }
        number += 1;
        let mut fitting: Vec<(&Head<'s>, &Mock<'s>)> = Vec::new();
        for mock in own {
            let fits = |it: &&Head<'s>| it.fits(mock, pou);
            let known = |it: &&Head<'s>| fitting.iter().all(|known| known.0.name.span != it.name.span);
            let found: Vec<_> = heads.iter().filter(fits).filter(known).map(|it| (it, mock)).collect();
            fitting.extend(found.into_iter().take(1));
        }
        let mut first = Vec::new();
        for (((head, mock), instance), which) in fitting.into_iter().zip(INSTANCES).zip(1u16..) {
            exchanged.places.insert(mock.at());
            exchanged.numbers.insert((pou.name.span, head.name.span), (number, which));
            first.push(in_place(pou, mock, instance, (number, which)));
            if pou.kind == PouKind::FunctionBlock {
                pou.blocks.push(variable(VarKind::Var, instance, mock.mock.clone(), mock.at()));
            }
        }
        if let Some(at) = first.first().map(|it| it.span) {
            let payload = [SPACE[0], SPACE[1], "IPayload"].map(|text| Name { text, span: at });
            pou.blocks.push(variable(VarKind::Temp, KEPT, payload.to_vec(), at));
            pou.body.splice(0..0, first);
        }
    }
    exchanged
}

/// `AxUnit.Mocking.__exchange_back();`: what runs after a test.
pub(crate) fn back<'s>(at: Span) -> Statement<'s> {
    statement(StatementKind::Expr(call(function(BACK, at), Vec::new())), at)
}

/// `AxUnit.Mocking.name`
pub(crate) fn function<'s>(name: &'static str, at: Span) -> Expr<'s> {
    let of = |text: &'static str| Name { text, span: at };
    path([SPACE[0], SPACE[1], name].map(of).as_slice(), at)
}

pub(crate) fn number<'s>(value: u16, at: Span) -> Expr<'s> {
    literal(LiteralValue::Integer { value: u64::from(value), based: false }, at)
}

/// The path in `NAME_OF(A.B)`, or in the text `'A.B'`.
pub(crate) fn names<'s>(expr: &Expr<'s>, sources: &'s Sources) -> Option<Vec<Name<'s>>> {
    match &expr.kind {
        ExprKind::Call(callee, arguments) => match arguments.as_slice() {
            [Argument { kind: ArgumentKind::Positional(it), .. }] if is_named(callee, "NAME_OF") => it.path(),
            _ => None,
        },
        ExprKind::Literal(it) if matches!(it.value, LiteralValue::String(_)) => {
            let text = sources.text(expr.span);
            let inside = text.trim_matches(['\'', '"']);
            Some(inside.split('.').map(|text| Name { text, span: expr.span }).collect())
        }
        _ => None,
    }
}

impl Mock<'_> {
    fn at(&self) -> Span {
        self.mock.last().map_or(self.mockee.span, |it| it.span)
    }
}

impl Head<'_> {
    fn fits(&self, mock: &Mock<'_>, pou: &Pou<'_>) -> bool {
        let of = parameters(pou);
        let is_it = mock.mock.last().is_some_and(|it| Key(it.text) == Key(self.name.text));
        let has_all = self.parameters.len() == of.len() && of.iter().all(|it| self.parameters.contains(it));
        is_it && self.kind == pou.kind && has_all
    }
}

fn pous<'a, 's>(files: &'a [File<'s>]) -> impl Iterator<Item = &'a Pou<'s>> {
    files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Test(unit) => Some(&unit.pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) => None,
    })
}

fn pou_mut<'a, 's>(item: &'a mut Item<'s>) -> Option<&'a mut Pou<'s>> {
    match item {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    }
}

/// What all calls of `Mock` name.
fn mocks<'s>(files: &[File<'s>], sources: &'s Sources) -> Vec<Mock<'s>> {
    let mut found = Vec::new();
    for body in pous(files).flat_map(|it| it.routines.iter().chain([it])).map(|it| &it.body) {
        each_expr(body, &mut |it| {
            let ExprKind::Call(callee, arguments) = &it.kind else { return };
            let is_mock = callee.path().is_some_and(|it| it[it.len() - 1].text.eq_ignore_ascii_case("Mock"));
            let given = |at: usize, name: &str| {
                let named = arguments.iter().find_map(|it| match &it.kind {
                    ArgumentKind::Input(word, value) if word.text.eq_ignore_ascii_case(name) => Some(value),
                    ArgumentKind::Input(..) | ArgumentKind::Positional(_) | ArgumentKind::Output { .. } => None,
                });
                let by_place = arguments.get(at).and_then(|it| match &it.kind {
                    ArgumentKind::Positional(value) => Some(value),
                    ArgumentKind::Input(..) | ArgumentKind::Output { .. } => None,
                });
                named.or(by_place).and_then(|it| names(it, sources))
            };
            if is_mock
                && let (Some(mockee), Some(mock)) = (given(0, "mockeeFn"), given(1, "mockFn"))
                && let Some(mockee) = mockee.last()
            {
                found.push(Mock { mockee: *mockee, mock });
            }
        });
    }
    found
}

fn can_be_exchanged(pou: &Pou<'_>) -> bool {
    let is_kind = matches!(pou.kind, PouKind::Function | PouKind::FunctionBlock);
    is_kind && pou.extends.is_none() && pou.external.is_none()
}

fn parameters<'s>(pou: &Pou<'s>) -> Vec<(VarKind, Key<'s>)> {
    let of = |block: &VarBlock<'s>| {
        let names: Vec<_> = block.vars.iter().flat_map(|it| &it.names).map(|it| (block.kind, Key(it.text))).collect();
        names
    };
    let is_one = |it: &&VarBlock<'s>| matches!(it.kind, VarKind::Input | VarKind::Output | VarKind::InOut);
    pou.blocks.iter().filter(is_one).flat_map(of).collect()
}

fn variable<'s>(kind: VarKind, name: &'static str, ty: Vec<Name<'s>>, at: Span) -> VarBlock<'s> {
    let ty = TypeSpec { kind: TypeKind::Named(ty), span: at };
    VarBlock { vars: vec![VarDecl::new(vec![Name { text: name, span: at }], ty, at)], ..VarBlock::new(kind, at) }
}

fn path<'s>(names: &[Name<'s>], at: Span) -> Expr<'s> {
    let expr = |kind| Expr { kind, span: at };
    let mut names = names.iter();
    let first = names.next().map_or(expr(ExprKind::Error(Vec::new())), |it| expr(ExprKind::Name(*it)));
    names.fold(first, |base, it| expr(ExprKind::Member(Box::new(base), *it)))
}

fn call<'s>(callee: Expr<'s>, arguments: Vec<Argument<'s>>) -> Expr<'s> {
    let span = callee.span;
    Expr { kind: ExprKind::Call(Box::new(callee), arguments), span }
}

fn element<'s>(array: &'static str, index: u16, at: Span) -> Expr<'s> {
    Expr { kind: ExprKind::Index(Box::new(named(array, at)), vec![number(index, at)]), span: at }
}

/// ```text
/// IF __mocks[number] = which THEN
///     __kept_payload := __payload;
///     __payload := __payloads[number];
///     A := B(a := a, b => b);
///     __payload := __kept_payload;
///     RETURN;
/// END_IF
/// ```
fn in_place<'s>(
    pou: &Pou<'s>,
    mock: &Mock<'s>,
    instance: &'static str,
    (exchanged, which): (u16, u16),
) -> Statement<'s> {
    let at = mock.at();
    let assign = |target: Expr<'s>, value: Expr<'s>| statement(StatementKind::Assign { target, value }, at);
    let own = |name: Name<'s>| Name { span: at, ..name };
    let argument = |(kind, name): (VarKind, Name<'s>)| {
        let value = path(&[own(name)], at);
        let kind = match kind {
            VarKind::Output => ArgumentKind::Output { name: own(name), negated: false, target: Some(value) },
            _ => ArgumentKind::Input(own(name), value),
        };
        Argument { kind, span: at }
    };
    let is_one = |it: &&VarBlock<'s>| matches!(it.kind, VarKind::Input | VarKind::Output | VarKind::InOut);
    let blocks = pou.blocks.iter().filter(is_one);
    let parameters = blocks.flat_map(|block| block.vars.iter().flat_map(|it| &it.names).map(|it| (block.kind, *it)));
    let callee = if pou.kind == PouKind::Function { path(&mock.mock, at) } else { named(instance, at) };
    let called = call(callee, parameters.map(argument).collect());
    let runs = match pou.result {
        Some(_) => assign(path(&[own(pou.name)], at), called),
        None => statement(StatementKind::Expr(called), at),
    };
    let then = vec![
        assign(named(KEPT, at), named(PAYLOAD, at)),
        assign(named(PAYLOAD, at), element(PAYLOADS, exchanged, at)),
        runs,
        assign(named(PAYLOAD, at), named(KEPT, at)),
        statement(StatementKind::Return, at),
    ];
    let sides = Box::new([element(MOCKS, exchanged, at), number(which, at)]);
    let condition = Expr { kind: ExprKind::Binary(sides, BinaryOp::Eq, at), span: at };
    statement(StatementKind::If { branches: vec![(condition, then)], otherwise: None }, at)
}
