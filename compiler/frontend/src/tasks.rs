//! What TwinCAT provides about its tasks, in the list `TwinCAT_SystemInfoVarList`: where a program names it, each run of a
//! PROGRAM begins with a call that notes whose cycle it is. Tasks are numbered from 1, as they are declared; what has
//! none is in one more, after them.

use crate::Span;
use crate::ast::{
    Argument, ArgumentKind, Bound, Configuration, Expr, ExprKind, File, Item, LiteralValue, Pou, PouKind,
    ProgramInstance, Resource, Statement, StatementKind, Task, TypeKind, VarDecl,
};
use crate::spelling::Key;
use crate::start;
use crate::testing::tree::{literal, named, statement};

/// The FUNCTION that a run begins with: `__BeginCycle(task, run);`.
pub(crate) const BEGIN: &str = "__BeginCycle";
/// The array with an element for each task.
pub(crate) const OF_TASKS: &str = "_TaskInfo";
/// What holds for all of them together.
pub(crate) const OF_PROGRAM: &str = "_AppInfo";
/// Arrays with an element for each task.
const EACH: [&str; 2] = [OF_TASKS, "__TaskLeaders"];

/// The tasks of a program that asks for them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tasks {
    count: u64,
}

impl Tasks {
    /// Nothing, where the program does not ask. Unit tests run no PROGRAM by itself.
    pub fn of(files: &[File<'_>], tests: bool) -> Option<Self> {
        home(files)?;
        let listed: usize = resources(files).map(|it| it.tasks.len()).sum();
        let has_none = |resource: &Resource<'_>| resource.programs.iter().any(|it| task_of(resource, it).is_none());
        let lists_any = resources(files).any(|it| !it.programs.is_empty());
        let is_one_more = match (tests, lists_any) {
            (true, _) => listed == 0,
            (false, true) => resources(files).any(has_none),
            (false, false) => true,
        };
        Some(Self { count: u64::try_from(listed + usize::from(is_one_more)).unwrap_or(u64::MAX) })
    }

    /// What a run of a PROGRAM begins with; `number` is that of the run, from 1.
    pub fn begin<'s>(
        self,
        files: &[File<'_>],
        run: Option<Listed<'_, '_>>,
        number: usize,
        span: Span,
    ) -> Statement<'s> {
        let own = run.and_then(|(resource, it)| task_of(resource, it));
        let is_own = |it: &Task<'_>| own.is_some_and(|own| own.name.span == it.name.span);
        let place = resources(files).flat_map(|it| &it.tasks).position(is_own);
        let task = place.map_or(self.count, |it| u64::try_from(it + 1).unwrap_or(u64::MAX));
        begin(task, u64::try_from(number).unwrap_or(u64::MAX), span)
    }
}

type Listed<'a, 's> = (&'a Resource<'s>, &'a ProgramInstance<'s>);

/// Gives what holds something for each task its size. Each unit test is a task of its own, the first one.
pub(crate) fn expand(files: &mut [File<'_>], tests: bool) {
    let (Some(home), Some(Tasks { count })) = (home(files), Tasks::of(files, tests)) else { return };
    files[home].items.iter_mut().for_each(|it| size(it, count));
    for pou in files.iter_mut().flat_map(|it| &mut it.items).filter_map(pou_in) {
        if tests && pou.kind == PouKind::Test {
            prepend(pou, begin(1, 1, pou.name.span));
        }
    }
}

/// Puts a statement before all of a body but what starts its instances, which no task does.
pub(crate) fn prepend<'s>(pou: &mut Pou<'s>, statement: Statement<'s>) {
    let starts = pou.body.iter().take_while(|it| calls(it, |name| name.starts_with(start::START))).count();
    pou.body.insert(starts, statement);
}

fn calls(statement: &Statement<'_>, is_it: impl Fn(&str) -> bool) -> bool {
    match &statement.kind {
        StatementKind::Expr(Expr { kind: ExprKind::Call(callee, _), .. }) => {
            callee.first_name().is_some_and(|it| is_it(it.text))
        }
        _ => false,
    }
}

fn size(item: &mut Item<'_>, count: u64) {
    let Item::Globals(block) = item else { return };
    for it in block.vars.iter_mut().filter(|it| is_for_each(it)) {
        if let TypeKind::Array { bounds, .. } = &mut it.ty.kind
            && let [Bound::Range(_, high)] = bounds.as_mut_slice()
        {
            *high = integer(count, high.span);
        }
    }
}

fn is_for_each(decl: &VarDecl<'_>) -> bool {
    decl.names.iter().any(|it| EACH.contains(&it.text))
}

/// The file of the library that has what runs begin with.
fn home(files: &[File<'_>]) -> Option<usize> {
    let is_it = |it: &Item<'_>| matches!(it, Item::Pou(pou) if pou.name.text == BEGIN);
    files.iter().position(|it| it.items.iter().any(is_it))
}

fn resources<'a, 's>(files: &'a [File<'s>]) -> impl Iterator<Item = &'a Resource<'s>> {
    files.iter().flat_map(|it| &it.items).filter_map(configuration).flat_map(|it| &it.resources)
}

fn configuration<'a, 's>(item: &'a Item<'s>) -> Option<&'a Configuration<'s>> {
    match item {
        Item::Configuration(it) => Some(it),
        Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Test(_) => None,
    }
}

fn pou_in<'a, 's>(item: &'a mut Item<'s>) -> Option<&'a mut Pou<'s>> {
    match item {
        Item::Pou(pou) => Some(pou),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    }
}

fn task_of<'a, 's>(resource: &'a Resource<'s>, instance: &ProgramInstance<'_>) -> Option<&'a Task<'s>> {
    let name = instance.task?;
    resource.tasks.iter().find(|it| Key(it.name.text) == Key(name.text))
}

fn begin<'s>(task: u64, run: u64, span: Span) -> Statement<'s> {
    let argument = |value| Argument { kind: ArgumentKind::Positional(integer(value, span)), span };
    let call = ExprKind::Call(Box::new(named(BEGIN, span)), vec![argument(task), argument(run)]);
    statement(StatementKind::Expr(Expr { kind: call, span }), span)
}

fn integer<'s>(value: u64, span: Span) -> Expr<'s> {
    literal(LiteralValue::Integer { value, based: false }, span)
}
