//! `inst.ENO` of a block that does not declare it: every block of MATIEC and STruC++ has ENO, which is what EN was in its last call, and TRUE
//! before. In MATIEC `inst.EN` is read as well, and is the same.
//! OpenPLC's editor reads it in the Structured Text that it generates. It becomes a variable of the POU, which the calls of the instance
//! write.

use crate::Span;
use crate::added::ENOS;
use crate::ast::{
    Argument, ArgumentKind, Bound, Element, Expr, ExprKind, File, Initial, InitialKind, Item, LiteralValue, Name, Pou,
    PouKind, Statement, StatementKind, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind, each_expr,
};
use crate::log::Log;
use crate::spelling::Key;
use crate::testing::tree;
use rustc_hash::{FxHashMap, FxHashSet};

const ENO: &str = "ENO";
const EN: &str = "EN";

/// Gives the POUs what they read of ENO.
pub(crate) fn expand(files: &mut [File<'_>], log: &Log<'_>) {
    let has_it = |file: u16| log.dialect(Span { file, start: 0, end: 0 }).has_enables_everywhere();
    let is_read = |it: &[u8]| it.eq_ignore_ascii_case(b".EN");
    let reads = |it: &crate::Source| it.text.as_bytes().windows(3).any(is_read);
    let files_read = log.sources.files().iter().zip(0u16..);
    let reading: Vec<bool> = files_read.map(|(it, number)| has_it(number) && reads(it)).collect();
    if !reading.contains(&true) {
        return;
    }
    let blocks = blocks(files);
    for (file, _) in files.iter_mut().zip(reading).filter(|it| it.1) {
        for item in &mut file.items {
            if let Item::Pou(pou) = item
                && matches!(pou.kind, PouKind::Program | PouKind::FunctionBlock)
                && log.dialect(pou.span).has_enables_everywhere()
            {
                of_pou(pou, &blocks, log.dialect(pou.span).has_enabling_inputs());
            }
        }
    }
}

/// The blocks without an ENO of their own.
fn blocks<'s>(files: &[File<'s>]) -> FxHashSet<Key<'s>> {
    let standard =
        staunch_runtime::BLOCKS.iter().filter(|it| it.pin(ENO).or(it.pin(EN)).is_none()).map(|it| Key(it.name));
    let mut blocks: FxHashSet<Key<'s>> = standard.collect();
    for item in files.iter().flat_map(|it| &it.items) {
        if let Item::Pou(pou) = item
            && pou.kind == PouKind::FunctionBlock
        {
            let variables = pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
            let mut names = variables.chain(pou.routines.iter().map(|it| &it.name));
            // What one inherits may be called so.
            match pou.extends.is_some() || names.any(|it| [ENO, EN].map(Key).contains(&Key(it.text))) {
                true => blocks.remove(&Key(pou.name.text)),
                false => blocks.insert(Key(pou.name.text)),
            };
        }
    }
    blocks
}

fn of_pou<'s>(pou: &mut Pou<'s>, blocks: &FxHashSet<Key<'s>>, reads_inputs: bool) {
    let mut instances: FxHashSet<Key<'s>> = FxHashSet::default();
    for decl in pou.blocks.iter().filter(|it| it.kind == VarKind::Var).flat_map(|it| &it.vars) {
        if let TypeKind::Named(path) = &decl.ty.kind
            && path.last().is_some_and(|it| blocks.contains(&Key(it.text)))
        {
            instances.extend(decl.names.iter().map(|it| Key(it.text)));
        }
    }
    let mut numbers = FxHashMap::default();
    each_expr(&pou.body, &mut |it| {
        if let Some(name) = instance_read(it, reads_inputs).filter(|it| instances.contains(&Key(it.text))) {
            let next = numbers.len();
            numbers.entry(Key(name.text)).or_insert(next);
        }
    });
    if numbers.is_empty() {
        return;
    }
    pou.blocks.push(kept(numbers.len(), pou.name.span));
    let rewriter = Rewriter { numbers, reads_inputs };
    rewriter.list(&mut pou.body);
}

/// The instance in `inst.ENO`, or in `inst.EN`.
fn instance_read<'s>(expr: &Expr<'s>, reads_inputs: bool) -> Option<Name<'s>> {
    let ExprKind::Member(owner, member) = &expr.kind else { return None };
    let ExprKind::Name(name) = &owner.kind else { return None };
    let is_input = reads_inputs && member.text.eq_ignore_ascii_case(EN);
    (is_input || member.text.eq_ignore_ascii_case(ENO)).then_some(*name)
}

/// `__enos : ARRAY[0..n] OF BOOL := [n(TRUE)];`
fn kept<'s>(count: usize, at: Span) -> VarBlock<'s> {
    let element = TypeSpec { kind: TypeKind::Named(vec![Name { text: "BOOL", span: at }]), span: at };
    let bounds = vec![Bound::Range(tree::number(0, at), tree::number(count - 1, at))];
    let ty = TypeSpec { kind: TypeKind::Array { bounds, element: Box::new(element) }, span: at };
    let value = Initial { kind: InitialKind::Value(tree::literal(LiteralValue::Bool(true), at)), span: at };
    let elements = InitialKind::Elements(vec![Element { count: Some(tree::number(count, at)), values: vec![value] }]);
    let initial = Some(Initial { kind: elements, span: at });
    let decl = VarDecl { initial, ..VarDecl::new(vec![Name { text: ENOS, span: at }], ty, at) };
    VarBlock { vars: vec![decl], ..VarBlock::new(VarKind::Var, at) }
}

struct Rewriter<'s> {
    numbers: FxHashMap<Key<'s>, usize>,
    reads_inputs: bool,
}

impl<'s> Rewriter<'s> {
    fn kept(&self, number: usize, span: Span) -> Expr<'s> {
        let base = Expr { kind: ExprKind::Name(Name { text: ENOS, span }), span };
        Expr { kind: ExprKind::Index(Box::new(base), vec![tree::number(number, span)]), span }
    }

    fn list(&self, statements: &mut Vec<Statement<'s>>) {
        let mut written = Vec::with_capacity(statements.len());
        for mut statement in std::mem::take(statements) {
            self.statement(&mut statement);
            let given = self.call(&mut statement);
            written.push(statement);
            written.extend(given);
        }
        *statements = written;
    }

    /// Has a call of one of the instances write its ENO; gives the assignment to what the call gave it to.
    fn call(&self, statement: &mut Statement<'s>) -> Option<Statement<'s>> {
        let StatementKind::Expr(Expr { kind: ExprKind::Call(callee, arguments), .. }) = &mut statement.kind else {
            return None;
        };
        let ExprKind::Name(name) = &callee.kind else { return None };
        let kept = self.kept(*self.numbers.get(&Key(name.text))?, name.span);
        let own = arguments.iter_mut().find_map(|it| match &mut it.kind {
            ArgumentKind::Output { name, negated, target: Some(target) } if name.text.eq_ignore_ascii_case(ENO) => {
                Some((negated, target))
            }
            ArgumentKind::Output { .. } | ArgumentKind::Positional(_) | ArgumentKind::Input(..) => None,
        });
        let Some((negated, target)) = own else {
            let output = Name { text: ENO, span: name.span };
            let kind = ArgumentKind::Output { name: output, negated: false, target: Some(kept) };
            arguments.push(Argument { kind, span: name.span });
            return None;
        };
        let given = std::mem::replace(target, kept.clone());
        let value = match std::mem::take(negated) {
            true => Expr { kind: ExprKind::Unary(crate::ast::UnaryOp::Not, Box::new(kept)), span: given.span },
            false => kept,
        };
        Some(Statement { span: given.span, kind: StatementKind::Assign { target: given, value } })
    }

    fn statement(&self, statement: &mut Statement<'s>) {
        match &mut statement.kind {
            StatementKind::Empty
            | StatementKind::Label(_)
            | StatementKind::Jump(_)
            | StatementKind::Exit
            | StatementKind::Continue
            | StatementKind::Return
            | StatementKind::Error => {}
            // What is given to an input is not what it was in the last call.
            StatementKind::Assign { target, value } if instance_read(target, true).is_some() => self.expr(value),
            StatementKind::Assign { target, value }
            | StatementKind::SetReset { target, value, .. }
            | StatementKind::Bind { target, value }
            | StatementKind::Attempt { target, value } => [target, value].into_iter().for_each(|it| self.expr(it)),
            StatementKind::AssignAll { targets, value } => {
                targets.iter_mut().chain([value]).for_each(|it| self.expr(it))
            }
            StatementKind::SetResetAll { targets, value } => {
                targets.iter_mut().map(|it| &mut it.0).chain([value]).for_each(|it| self.expr(it));
            }
            StatementKind::ReturnIf(it) | StatementKind::Expr(it) => self.expr(it),
            StatementKind::If { branches, otherwise } => {
                for (condition, body) in branches {
                    self.expr(condition);
                    self.list(body);
                }
                otherwise.iter_mut().for_each(|it| self.list(it));
            }
            StatementKind::Case { selector, arms, otherwise } => {
                self.expr(selector);
                arms.iter_mut().for_each(|it| self.list(&mut it.body));
                otherwise.iter_mut().for_each(|it| self.list(it));
            }
            StatementKind::For { counter, from, to, by, body } => {
                [counter, from, to].into_iter().chain(by).for_each(|it| self.expr(it));
                self.list(body);
            }
            StatementKind::While { condition: it, body } | StatementKind::Repeat { body, until: it } => {
                self.expr(it);
                self.list(body);
            }
            StatementKind::Try(it) => {
                self.list(&mut it.body);
                self.list(&mut it.handler);
                it.finally.iter_mut().for_each(|it| self.list(&mut it.body));
            }
        }
    }

    fn expr(&self, expr: &mut Expr<'s>) {
        if let Some(number) = instance_read(expr, self.reads_inputs).and_then(|it| self.numbers.get(&Key(it.text))) {
            *expr = self.kept(*number, expr.span);
            return;
        }
        match &mut expr.kind {
            ExprKind::Literal(_) | ExprKind::Name(_) | ExprKind::Address(_) => {}
            ExprKind::Member(inner, _)
            | ExprKind::Part(inner, _)
            | ExprKind::Deref(inner)
            | ExprKind::Unary(_, inner)
            | ExprKind::Paren(inner) => self.expr(inner),
            ExprKind::Index(base, indices) => {
                self.expr(base);
                indices.iter_mut().for_each(|it| self.expr(it));
            }
            ExprKind::Call(callee, arguments) => {
                self.expr(callee);
                for argument in arguments {
                    match &mut argument.kind {
                        ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => self.expr(value),
                        ArgumentKind::Output { target, .. } => target.iter_mut().for_each(|it| self.expr(it)),
                    }
                }
            }
            ExprKind::Binary(sides, ..) | ExprKind::Assign(sides, _) => sides.iter_mut().for_each(|it| self.expr(it)),
            ExprKind::Error(parts) => parts.iter_mut().for_each(|it| self.expr(it)),
        }
    }
}
