//! One pass that types each expression and builds its IR node.

mod argument;
mod block_call;
mod call;
mod call_tracking;
mod case;
mod coerce;
mod constant_comparison;
mod conversion;
mod enable;
mod expression;
mod function;
mod literal;
mod loops;
mod migration;
mod operand;
mod operator;
mod order;
mod overload;
mod place;
mod prescan;
mod promotion;
mod real;
mod standard;
mod statement;
mod string_compare;
mod unresolved;
mod variadic;

pub(crate) use prescan::{
    Assigned, KeptCount, Uses, assigned_count, holds_storage, is_element_by_element, lost_count, same_storage,
    several_counts, shared_count,
};
pub(crate) use standard::exists as is_function;
pub(crate) use unresolved::{block_of_another_dialect, no_such_block, not_constant};

use crate::ast;
use crate::declare::{Declarations, Resolved, Scope, Signature};
use crate::{Bodies, Code, Diagnostic, Span};
use staunch_ir::{Block, Expr, For, Local, Location, Place, Routine, RoutineKind, Statement, StatementKind, Type};
use std::rc::Rc;

/// Checks the body of one POU, or one constant expression.
pub(crate) struct Checker<'d, 's> {
    pub decl: &'d mut Declarations<'s>,
    scope: Rc<Scope<'s>>,
    signature: Option<Rc<Signature<'s>>>,
    /// The statements made so far for the innermost list; hoisted calls go to its end.
    block: Block,
    locals: Vec<Local>,
    /// The FOR loops around the statement.
    counters: Vec<For>,
    loops: usize,
    uses: Uses,
    context: Context,
    /// Instances called so far on the way to this statement.
    called: call_tracking::Called,
}

/// What a name of a variable stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Context {
    /// Its storage.
    Body,
    /// Nothing: a constant is wanted.
    Constant,
    /// Its initial value: another variable's initial value may use it.
    Initial,
}

/// The bodies of all POUs, in the order of their slots; `None` where there was an error.
pub(crate) fn bodies<'s>(
    decl: &mut Declarations<'s>,
    statements: Vec<Vec<ast::Statement<'s>>>,
    bodies: Bodies,
) -> Vec<Option<(Routine, Uses)>> {
    let checked = |(at, statements): (usize, Vec<_>)| {
        let (mut routine, uses) = body(decl, at, &statements)?;
        if bodies == Bodies::Dropped {
            routine.body = calls(routine.body);
        }
        Some((routine, uses))
    };
    let made = statements.into_iter().enumerate().map(checked).collect();
    // A variable may be read from outside as well.
    for at in 0..decl.pous.len() {
        report_unused(decl, at);
    }
    made
}

/// The calls in a block, which is what later checks ask of it.
fn calls(block: Block) -> Block {
    let mut calls = Block::new();
    move_calls(block, &mut calls);
    calls
}

fn move_calls(block: Block, calls: &mut Block) {
    for mut statement in block {
        let inner: Vec<_> = statement.kind.blocks_mut().into_iter().map(std::mem::take).collect();
        inner.into_iter().for_each(|it| move_calls(it, calls));
        if let StatementKind::Call { .. } = statement.kind {
            calls.push(statement);
        }
    }
}

fn body<'s>(decl: &mut Declarations<'s>, at: usize, statements: &[ast::Statement<'s>]) -> Option<(Routine, Uses)> {
    let pou = decl.pous[at].ast;
    let signature = decl.signature(at)?;
    let mut checker = Checker {
        scope: Rc::clone(&signature.scope),
        locals: signature.locals.clone(),
        signature: Some(Rc::clone(&signature)),
        block: Vec::new(),
        counters: Vec::new(),
        loops: 0,
        uses: Uses::default(),
        context: Context::Body,
        called: call_tracking::Called::default(),
        decl,
    };
    checker.initial_outputs(&signature);
    checker.own_enable(&signature, pou.name.span);
    checker.edge_inputs(&signature, pou.name.span);
    let mut body = checker.block_of(statements);
    checker.migration_lints(statements);
    let mut whole = std::mem::take(&mut checker.block);
    whole.append(&mut body);
    let uses = checker.finish_uses();
    let locals = std::mem::take(&mut checker.locals);
    let location = decl.location(pou.name.span);
    let kind = if pou.kind == ast::PouKind::Function { RoutineKind::Function } else { RoutineKind::Body };
    let body = Routine {
        kind,
        name: pou.name.text.to_owned(),
        doc: pou.doc.clone(),
        location,
        state: signature.state,
        params: signature.params.clone(),
        locals,
        result: signature.result.as_ref().map(|(id, _)| *id),
        body: whole,
    };
    Some((body, uses))
}

/// The constant `expr`, converted to `target` where there is one; other expressions are refused.
pub(crate) fn constant<'s>(
    decl: &mut Declarations<'s>,
    scope: &Rc<Scope<'s>>,
    expr: &ast::Expr<'s>,
    target: Option<&Resolved>,
) -> Option<Expr> {
    let mut checker = Checker {
        decl,
        scope: Rc::clone(scope),
        signature: None,
        block: Vec::new(),
        locals: Vec::new(),
        counters: Vec::new(),
        loops: 0,
        uses: Uses::default(),
        called: call_tracking::Called::default(),
        context: if target.is_some() { Context::Initial } else { Context::Constant },
    };
    let value = match target {
        Some(target) => checker.value(expr, target.ty)?,
        None => checker.typed(expr, None)?,
    };
    if !is_constant(&value) {
        checker.decl.report(not_constant(expr.span));
        return None;
    }
    Some(value)
}

fn is_constant(expr: &Expr) -> bool {
    use staunch_ir::ExprKind;
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => true,
        ExprKind::Load(_) | ExprKind::Apply(..) | ExprKind::ApplyText(..) | ExprKind::Convert(..) => false,
    }
}

impl<'s> Declarations<'s> {
    /// A constant whole number: an array bound, a string's length, an enumerator's value.
    pub fn constant_integer(&mut self, expr: &ast::Expr<'s>, scope: &Rc<Scope<'s>>) -> Option<i128> {
        let value = constant(self, scope, expr, None)?;
        let number = value.as_const().and_then(staunch_ir::Value::as_integer);
        if number.is_none() || value.ty == Type::BOOL {
            self.report(
                Diagnostic::new(Code::E0201, expr.span, "a whole number is expected here")
                    .label(format!("this is {}", self.program.type_name(value.ty))),
            );
            return None;
        }
        number
    }
}

impl<'s> Checker<'_, 's> {
    fn report(&mut self, diagnostic: Diagnostic) {
        self.decl.report(diagnostic);
    }

    fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.decl.error(code, span, message);
    }

    fn is_function_body(&self) -> bool {
        self.signature.as_ref().is_some_and(|it| it.state.is_none())
    }

    fn is_function_block(&self) -> bool {
        let slot = self.signature.as_ref().and_then(|it| it.state).and_then(|it| self.decl.slot_of_instance(it));
        slot.is_some_and(|slot| self.decl.pous[slot].ast.kind == ast::PouKind::FunctionBlock)
    }

    fn at(&mut self, span: Span) -> Location {
        self.decl.location(span)
    }

    fn type_name(&self, ty: Type) -> String {
        self.decl.program.type_name(ty)
    }

    fn push(&mut self, kind: StatementKind, span: Span) {
        let at = self.at(span);
        self.block.push(Statement::new(kind, at));
    }

    fn assign(&mut self, target: Place, value: Expr, span: Span) {
        self.push(StatementKind::Assign { target, value }, span);
    }

    /// The statements that `make` adds, as a list of their own.
    fn nested(&mut self, make: impl FnOnce(&mut Self)) -> Block {
        let outer = std::mem::take(&mut self.block);
        make(self);
        std::mem::replace(&mut self.block, outer)
    }
}

fn report_unused(decl: &mut Declarations<'_>, slot: usize) {
    use staunch_ir::Section;
    let Some(signature) = decl.signature(slot) else { return };
    for variable in &signature.scope.variables {
        let internal = matches!(variable.section, Section::Internal | Section::Temp | Section::External);
        if internal && !variable.used.get() && !variable.name.text.starts_with(['_', '%']) {
            decl.report(
                Diagnostic::new(Code::W0501, variable.name.span, format!("`{}` is never used", variable.name.text))
                    .label("declared here, read and written nowhere"),
            );
        }
    }
}
