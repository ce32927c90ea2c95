//! What a CONFIGURATION does beside running a PROGRAM: it connects parameters, `Main(x := g)`, and a TASK's
//! SINGLE waits for an edge. Such a run is written as a PROGRAM of its own: it holds the other one as an
//! instance, and calls it.

use crate::spelling::Key;
use crate::{Span, ast};
use ast::{ExprKind, PouKind, StatementKind, VarKind};
use rustc_hash::{FxHashMap, FxHashSet};

// Keywords, which no declaration can take.
const PROGRAM: &str = "PROGRAM";
const EDGE: &str = "CONFIGURATION";

/// A run that is more than its PROGRAM's body.
pub(crate) struct Run<'s> {
    pub pou: ast::Pou<'s>,
    pub body: Vec<ast::Statement<'s>>,
    /// The name in the CONFIGURATION.
    pub instance: Span,
}

/// The runs of all configurations that take a PROGRAM of their own. Where one run of a PROGRAM does, its
/// other ones do as well.
pub(crate) fn runs<'s>(files: &[ast::File<'s>]) -> Vec<Run<'s>> {
    let items = || files.iter().flat_map(|it| &it.items);
    let resources = items().flat_map(|it| match it {
        ast::Item::Configuration(it) => it.resources.as_slice(),
        ast::Item::Pou(_) | ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Test(_) => &[],
    });
    let listed: Vec<_> =
        resources.flat_map(|resource| resource.programs.iter().map(move |it| (resource, it))).collect();
    if listed.is_empty() {
        return Vec::new();
    }
    let programs: FxHashMap<_, _> = items().filter_map(program).map(|it| (Key(it.name.text), it)).collect();
    let asks = |(resource, it): &&(&ast::Resource<'s>, &ast::ProgramInstance<'s>)| {
        let takes = programs.get(&Key(it.program.text)).is_some_and(|it| has_in_outs(it));
        takes || !it.connections.is_empty() || trigger(resource, it).is_some()
    };
    let wrapped: FxHashSet<_> = listed.iter().filter(asks).map(|(_, it)| Key(it.program.text)).collect();
    let known = |it: &&ast::ProgramInstance<'s>| {
        let key = Key(it.program.text);
        wrapped.contains(&key) && programs.contains_key(&key)
    };
    listed.into_iter().filter(|(_, it)| known(it)).map(|(resource, it)| run(it, trigger(resource, it))).collect()
}

fn program<'a, 's>(item: &'a ast::Item<'s>) -> Option<&'a ast::Pou<'s>> {
    match item {
        ast::Item::Pou(pou) if pou.kind == PouKind::Program => Some(pou),
        ast::Item::Pou(_) | ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Configuration(_) => None,
        ast::Item::Test(_) => None,
    }
}

pub(super) fn has_in_outs(pou: &ast::Pou<'_>) -> bool {
    pou.blocks.iter().any(|it| it.kind == VarKind::InOut)
}

/// What SINGLE of the instance's TASK says, unless that is FALSE.
fn trigger<'a, 's>(resource: &'a ast::Resource<'s>, instance: &ast::ProgramInstance<'s>) -> Option<&'a ast::Expr<'s>> {
    let name = instance.task?;
    let task = resource.tasks.iter().find(|it| it.name.text.eq_ignore_ascii_case(name.text))?;
    let single = task.properties.iter().find(|(name, _)| name.text.eq_ignore_ascii_case("SINGLE"));
    single.map(|(_, expr)| expr).filter(|it| !is_false(it))
}

/// SINGLE := FALSE: the TASK goes by its INTERVAL.
pub(crate) fn is_false(expr: &ast::Expr<'_>) -> bool {
    matches!(&expr.kind, ExprKind::Literal(it) if it.value == ast::LiteralValue::Bool(false))
}

fn run<'s>(instance: &ast::ProgramInstance<'s>, trigger: Option<&ast::Expr<'s>>) -> Run<'s> {
    let span = instance.program.span;
    let name = |text: &'static str| ast::Name { text, span };
    let variable = |text, path| {
        let ty = ast::TypeSpec { kind: ast::TypeKind::Named(path), span };
        ast::VarDecl { names: vec![name(text)], address: None, ty, edge: None, initial: None, doc: None, span }
    };
    let expr = |kind| ast::Expr { kind, span };
    let named = |text| expr(ExprKind::Name(name(text)));
    let statement = |kind| ast::Statement { kind, span };
    let call = |text, arguments| statement(StatementKind::Expr(expr(ExprKind::Call(Box::new(named(text)), arguments))));
    let mut vars = vec![variable(PROGRAM, [instance.namespace.as_slice(), &[instance.program]].concat())];
    let mut body = vec![call(PROGRAM, instance.connections.clone())];
    if let Some(trigger) = trigger {
        vars.push(variable(EDGE, vec![name("IEC"), name("R_TRIG")]));
        let clock = ast::ArgumentKind::Input(name("CLK"), trigger.clone());
        let rises = expr(ExprKind::Member(Box::new(named(EDGE)), name("Q")));
        body = vec![
            call(EDGE, vec![ast::Argument { kind: clock, span: trigger.span }]),
            statement(StatementKind::If { branches: vec![(rises, body)], otherwise: None }),
        ];
    }
    let blocks = vec![ast::VarBlock { vars, ..ast::VarBlock::new(VarKind::Var, span) }];
    let pou = ast::Pou { blocks, ..ast::Pou::new(PouKind::Program, instance.program, span) };
    Run { pou, body, instance: instance.name.span }
}
