//! What runs before the first scan: METHODs FB_init and those with `call_after_init`, of all instances. The state of each
//! class gets a METHOD that starts the instances inside of it; a PROGRAM's runs before its body does, once after each
//! start, after a FUNCTION for the instances that are global. Which instances there are is known when types are: then
//! a call of [`MEMBERS`] becomes what is to be done.

mod addresses;
mod computed;
mod expected;
mod varying;

use crate::Span;
use crate::added::{KEPT, RETAINS, STARTED};
use crate::ast::{
    Expr, ExprKind, File, Item, LiteralValue, Name, Pou, PouKind, Statement, StatementKind, UnaryOp, VarBlock, VarKind,
    each_expr,
};
use crate::spelling::Key;
use crate::testing::tree::{assign, literal, named, variables};
pub(crate) use addresses::is_once;

use addresses::Addresses;
use computed::{Owner, blocks, has_state};
use expected::Types;
use varying::{Everywhere, Names};

/// METHODs that CODESYS calls by itself.
pub(crate) const INITIAL: [&str; 3] = [INIT, "FB_reinit", EXIT];
pub(crate) const INIT: &str = "FB_init";
pub(crate) const EXIT: &str = "FB_exit";
/// Of a METHOD that runs when its instance has its values.
pub(crate) const AFTER: &str = "call_after_init";
/// The METHOD that starts what is in an instance.
pub(crate) const START: &str = "__start";
/// The FUNCTION that starts what is global.
pub(crate) const GLOBALS: &str = "__start_globals";
/// Stands for the statements that start what a POU holds; in the body of a PROGRAM, for the call of what does.
pub(crate) const MEMBERS: &str = "__start_members";
/// Marks one of a class that assigns initial values.
pub(crate) const ADDRESSES: &str = "__addresses";
const ASKED: &str = "bInitRetains";

pub(crate) fn is_initial(name: Name<'_>) -> bool {
    Key(name.text) == Key(INIT)
}

/// Adds to all POUs what starts their instances, where a program has any that ask for it, and assigns the initial
/// values that are addresses. `binds` says where `r : REFERENCE TO INT := i` is `REF= i`.
pub(crate) fn expand(files: &mut [File<'_>], binds: &dyn Fn(Span) -> bool) {
    let mut states = Vec::new();
    let mut of_globals_alone = Addresses::default();
    let mut first = None;
    let types = Types::of(files, binds);
    let everywhere = Everywhere::of(files);
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        match item {
            Item::Pou(pou) => {
                addresses::of_calls(pou, &types, &Names::everywhere(&everywhere));
                let found = if has_state(pou.kind) { addresses::of_state(pou, &types) } else { Addresses::default() };
                first = first.or((!found.is_empty()).then_some(pou.name.span));
                states.push(found);
            }
            Item::Globals(_) | Item::Configuration(_) => {
                let found = addresses::taken(blocks_of(item).iter_mut(), &types, None, Owner::Globals);
                first = first.or(found.first());
                of_globals_alone.append(found);
            }
            Item::Types(declared) => {
                first = declared.iter_mut().fold(first, |first, it| first.or(addresses::of_members(&mut it.ty, &types)))
            }
            Item::Test(_) => {}
        }
    }
    let routines = || files.iter().flat_map(|it| &it.items).filter_map(pou).flat_map(|it| &it.routines);
    let asks = |it: &Pou<'_>| is_initial(it.name) || is_after(it);
    let Some(at) = routines().find(|it| asks(it)).map(|it| it.name.span).or(first) else { return };
    let is_asked = routines().filter(|it| is_initial(it.name)).any(|it| mentions(&it.body, ASKED));
    let keeps = files.iter().flat_map(|it| &it.items).any(|it| blocks(it).iter().any(is_retain));
    let pous = files.iter_mut().flat_map(|it| &mut it.items).filter_map(|it| match it {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    for (pou, addresses) in pous.zip(states) {
        starts(pou, addresses);
    }
    if let Some(file) = files.get_mut(usize::from(at.file)) {
        file.items.extend(of_globals(at, is_asked, keeps, of_globals_alone));
    }
}

pub(crate) fn is_after(routine: &Pou<'_>) -> bool {
    routine.kind == PouKind::Method && routine.attributes.iter().any(|it| it.eq_ignore_ascii_case(AFTER))
}

fn pou<'a, 's>(item: &'a Item<'s>) -> Option<&'a Pou<'s>> {
    match item {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    }
}

fn blocks_of<'a, 's>(item: &'a mut Item<'s>) -> &'a mut [VarBlock<'s>] {
    match item {
        Item::Globals(block) => std::slice::from_mut(block),
        Item::Configuration(it) => &mut it.globals,
        Item::Pou(_) | Item::Types(_) | Item::Test(_) => &mut [],
    }
}

fn is_retain(block: &VarBlock<'_>) -> bool {
    block.retain.or(block.persistent).is_some()
}

fn mentions(body: &[Statement<'_>], name: &str) -> bool {
    let mut found = false;
    each_expr(body, &mut |it| found |= matches!(&it.kind, ExprKind::Name(it) if it.text.eq_ignore_ascii_case(name)));
    found
}

/// Adds to a POU what starts the instances in it.
fn starts<'s>(pou: &mut Pou<'s>, addresses: Addresses<'s>) {
    let at = pou.name.span;
    let (flag, kept) = (STARTED[0], KEPT[0]);
    if has_state(pou.kind) {
        let retains = pou.blocks.iter().any(is_retain);
        pou.blocks.extend(retains.then(|| retained(&[(kept, &["BOOL"])], VarKind::Var, at)));
    }
    match pou.kind {
        PouKind::Program => {
            pou.blocks.push(variables(&[(flag, &["BOOL"])], at));
            // One that another calls starts as an instance does.
            let marks = marks(&addresses);
            pou.routines.push(Pou { attributes: marks, ..method(once(flag, at, addresses), at, OF_PROGRAM) });
            pou.body.insert(0, call(MEMBERS, at));
        }
        PouKind::Test => {
            pou.blocks.push(variables(&[(flag, &["BOOL"])], at));
            pou.body.splice(0..0, once(flag, at, addresses));
        }
        PouKind::FunctionBlock | PouKind::Class => {
            let marks = marks(&addresses);
            let body = addresses.around(vec![call(MEMBERS, at)]);
            pou.routines.push(Pou { attributes: marks, ..method(body, at, OF_INSTANCE) });
        }
        PouKind::Interface
        | PouKind::Function
        | PouKind::Action
        | PouKind::Method
        | PouKind::Getter
        | PouKind::Setter => {}
    }
}

fn marks(addresses: &Addresses<'_>) -> Vec<&'static str> {
    if addresses.is_empty() { Vec::new() } else { vec![ADDRESSES] }
}

/// What is said of the METHOD of an instance.
pub(crate) const OF_INSTANCE: &str = "Before the first scan: starts the instances inside.";
const OF_PROGRAM: &str = "Before the first scan: starts the global instances, and the instances in them, unless that has been done.\nEach scan begins with it; if several PROGRAMs run, call it for all of them before the first scan of any.";

fn method<'s>(body: Vec<Statement<'s>>, at: Span, doc: &str) -> Pou<'s> {
    let doc = Some(doc.to_owned());
    Pou { body, doc, ..Pou::new(PouKind::Method, Name { text: START, span: at }, at) }
}

/// `IF NOT flag THEN __start_members(); flag := TRUE; END_IF`, with the addresses that are assigned.
fn once<'s>(flag: &'static str, at: Span, addresses: Addresses<'s>) -> Vec<Statement<'s>> {
    let done = assign(flag, literal(LiteralValue::Bool(true), at));
    let open = Expr { kind: ExprKind::Unary(UnaryOp::Not, Box::new(named(flag, at))), span: at };
    let mut then = addresses.around(vec![call(MEMBERS, at)]);
    then.push(done);
    let kind = StatementKind::If { branches: vec![(open, then)], otherwise: None };
    vec![Statement { kind, span: at }]
}

fn call<'s>(name: &'static str, span: Span) -> Statement<'s> {
    let kind = ExprKind::Call(Box::new(named(name, span)), Vec::new());
    Statement { kind: StatementKind::Expr(Expr { kind, span }), span }
}

fn retained<'s>(wanted: &[(&'static str, &[&'static str])], kind: VarKind, at: Span) -> VarBlock<'s> {
    VarBlock { kind, retain: Some(at), ..variables(wanted, at) }
}

/// The FUNCTION that starts the global instances, and its variables. `is_asked`: whether a body reads `bInitRetains`,
/// `keeps`: whether some global variables are RETAIN.
fn of_globals(at: Span, is_asked: bool, keeps: bool, addresses: Addresses<'_>) -> Vec<Item<'_>> {
    let ([_, flag], [_, kept]) = (STARTED, KEPT);
    let mut own = variables(&[(flag, &["BOOL"])], at);
    let mut body = once(flag, at, addresses);
    if is_asked {
        own.vars.extend(variables(&[(RETAINS, &["BOOL"])], at).vars);
        let fresh = Expr { kind: ExprKind::Unary(UnaryOp::Not, Box::new(named(kept, at))), span: at };
        let told = assign(RETAINS, fresh);
        if let Some(Statement { kind: StatementKind::If { branches, .. }, .. }) = body.first_mut()
            && let Some((_, statements)) = branches.first_mut()
        {
            statements.insert(0, told);
            statements.push(assign(kept, literal(LiteralValue::Bool(true), at)));
        }
    }
    own.kind = VarKind::Global;
    let function = Pou { body, ..Pou::new(PouKind::Function, Name { text: GLOBALS, span: at }, at) };
    let mut items = vec![Item::Globals(own), Item::Pou(function)];
    items.extend((is_asked || keeps).then(|| Item::Globals(retained(&[(kept, &["BOOL"])], VarKind::Global, at))));
    items
}
