//! PROGRAMs that others name: such a one has one instance, which the globals hold under its name. Where bodies call it,
//! it does not run by itself, unless a CONFIGURATION lists it.

use super::run::{Listing, Run, has_in_outs, listing};
use crate::dialect::missing;
use crate::names::{Entry, Found, Meaning, Sense, SpaceId};
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use crate::types::scope::Variable;
use crate::types::synthetic::NamedProgram;
use crate::types::table::instance_of;
use crate::{Span, ast};
use rustc_hash::FxHashSet;
use staunch_ir::{Field, Retain, Section};
use std::rc::Rc;

/// Whether a statement is empty, or one that starts the instances, which is done before any PROGRAM runs.
fn is_nothing(statement: &ast::Statement<'_>) -> bool {
    match &statement.kind {
        ast::StatementKind::Empty => true,
        ast::StatementKind::Expr(ast::Expr { kind: ast::ExprKind::Call(callee, _), .. }) => {
            callee.first_name().is_some_and(|it| it.text.starts_with(crate::start::START))
        }
        _ => false,
    }
}

/// Where statements are nothing but names, which calls those of PROGRAMs.
fn lone_names(statements: &[ast::Statement<'_>], found: &mut FxHashSet<Span>) {
    for statement in statements {
        if let ast::StatementKind::Expr(expr) = &statement.kind {
            found.insert(expr.bare().span);
        }
        ast::each_body(statement, &mut |inner| lone_names(inner, found));
    }
}

impl<'s> Declarations<'s> {
    /// Gives the PROGRAMs that bodies name their instances, before a body asks what the globals hold.
    pub(super) fn find_named_programs(&mut self, statements: &[Vec<ast::Statement<'s>>], runs: &'s [Run<'s>]) {
        for (at, body) in statements.iter().enumerate() {
            if !self.dialect(self.pous[at].ast.name.span).calls_programs() {
                continue;
            }
            let Some(signature) = self.signature(at) else { continue };
            let mut found = Vec::new();
            // What reads only a CONSTANT needs no instance, nor what an operator is given that is refused by its name.
            let dialect = self.dialect(self.pous[at].ast.name.span);
            let (mut passed_over, mut alone) = (FxHashSet::default(), FxHashSet::default());
            lone_names(body, &mut alone);
            ast::each_expr(body, &mut |it| {
                if let ast::ExprKind::Member(..) = &it.kind
                    && let Some(path) = it.path()
                    && self.constant_of_pou(&path).is_some()
                {
                    passed_over.insert(path[0].span);
                }
                if let ast::ExprKind::Call(callee, arguments) = &it.kind
                    && callee
                        .path()
                        .is_some_and(|it| matches!(it[..], [name] if missing::is_operator(dialect, name.text)))
                {
                    passed_over.extend(arguments.iter().map(|it| it.span));
                }
                let (callee, is_called) = match &it.kind {
                    ast::ExprKind::Call(callee, _) => (callee.bare(), true),
                    _ => (it, alone.contains(&it.span)),
                };
                if let Some(path) = callee.path()
                    && let [first, ..] = path.as_slice()
                    && signature.scope.get(first.text).is_none()
                    && !passed_over.contains(&first.span)
                    && !self.is_own_name(at, *first)
                    && let Found::One(Meaning::Declared(Entry::Pou(slot))) = self.lookup(&path, Sense::Value)
                    && self.pous[slot].ast.kind == ast::PouKind::Program
                {
                    found.push((slot, callee.span, is_called || self.is_action(slot, &path)));
                }
            });
            for (slot, span, is_called) in found {
                // A body without statements is as good as called: METHODs are all that there is.
                let body = statements.get(slot).map_or(&[][..], Vec::as_slice);
                let is_empty = body.iter().all(is_nothing);
                self.name_program(slot, span, is_called, is_empty, runs);
            }
        }
    }

    /// Whether a name in the body of a POU means its result, or a METHOD, ACTION or PROPERTY of the class around.
    fn is_own_name(&self, at: usize, name: ast::Name<'s>) -> bool {
        let pou = self.pous[at].ast;
        let is_result = pou.kind.is_function() && pou.result.is_some() && Key(pou.name.text) == Key(name.text);
        is_result || self.pous[self.home(at)].routines.contains_key(&Key(name.text))
    }

    /// Whether a path leads to an ACTION of a PROGRAM: naming it calls it.
    fn is_action(&self, program: usize, path: &[ast::Name<'s>]) -> bool {
        let last = path.last().and_then(|it| self.pous[program].routines.get(&Key(it.text))?.called);
        last.is_some_and(|it| self.pous[it.0].ast.kind == ast::PouKind::Action)
    }

    /// The names of those that run by themselves nevertheless. What a VAR_CONFIG binds is not among them: its run holds it.
    pub(crate) fn shared_programs(&self, files: &[ast::File<'s>]) -> FxHashSet<Span> {
        if self.log.options.tests {
            return FxHashSet::default();
        }
        let is_shared = |(slot, named): &(&usize, &NamedProgram<'s>)| {
            let pou = self.pous[**slot].ast;
            let runs = || match listing(files, self.log.sources, Key(pou.name.text)) {
                Listing::Absent => !named.is_called,
                Listing::One => true,
                Listing::Others | Listing::Several => false,
            };
            named.run.is_none() && !self.is_of_library(**slot) && !has_in_outs(pou) && runs()
        };
        self.named_programs.iter().filter(is_shared).map(|(slot, _)| self.pous[*slot].ast.name.span).collect()
    }

    fn name_program(&mut self, slot: usize, first: Span, runs: bool, is_empty: bool, wrapped: &'s [Run<'s>]) {
        let is_called = runs || is_empty;
        if let Some(named) = self.named_programs.get_mut(&slot) {
            named.is_called |= is_called;
            named.runs |= runs;
            return;
        }
        let run = self.run_of_program(slot);
        let Some(variable) = self.instance_of_program(slot, run) else { return };
        let bound = run.map(|it| (it, wrapped[it - self.written_pous().len()].bound.as_slice()));
        let named =
            NamedProgram { variable: Rc::new(variable), first, is_called, runs, run: bound, is_reported: false };
        self.named_programs.insert(slot, named);
    }

    /// The name of its instance. One of a library that others have as well is after the library's.
    fn field_of_program(&self, name: ast::Name<'s>) -> String {
        match self.names.home(name.span) {
            SpaceId::ROOT => name.text.to_owned(),
            _ => self.name_in_full(name).replace('.', "_"),
        }
    }

    /// The instance among the globals. It starts as what its run holds, to which a VAR_CONFIG gives initial values.
    fn instance_of_program(&mut self, slot: usize, run: Option<usize>) -> Option<Variable<'s>> {
        let state = self.signature(slot)?.state?;
        let mut resolved = instance_of(&self.program, state);
        if let Some(run) = run {
            let run = self.signature(run)?.state?;
            resolved.initial = self.program.structure(run).fields.first()?.initial.clone();
        }
        let pou: &'s ast::Pou<'s> = self.pous[slot].ast;
        let field = Field {
            name: self.field_of_program(pou.name),
            ty: resolved.ty,
            initial: resolved.initial.clone(),
            section: Section::Global,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: pou.doc.clone(),
            location: self.location(pou.name.span),
            declared: None,
        };
        let at = self.add_synthetic(field, None);
        Some(Variable {
            name: pou.name,
            declared: None,
            place: self.synthetic_place(at),
            resolved: Rc::new(resolved),
            section: Section::Global,
            constant: false,
            retain: false,
            used: Rc::default(),
        })
    }
}
