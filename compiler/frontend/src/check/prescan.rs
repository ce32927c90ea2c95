//! What happens to counters before the first scan after a start, a restart or IDLE -> RUN.

use super::Checker;
use super::block_call::is_retentive_counter;
use super::call::Given;
use crate::declare::pin_place;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Block, Elementary, Expr, Location, Op, Place, Projection, Root, Statement, StatementKind, Type, Value,
};

/// Places whose state is set before the first scan, with what sets it.
#[derive(Debug, Default)]
pub(crate) struct Uses {
    instructions: Vec<(Place, usize)>,
    counts: Vec<KeptCount>,
    /// Whole variables that the body assigns, with where.
    pub assigned: Vec<(Place, Span)>,
}

/// An R_CTU or R_CTD, and the variable that keeps its count.
#[derive(Debug)]
struct KeptCount {
    counter: Place,
    kept: Place,
    retained: bool,
    span: Span,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn used_instruction(&mut self, place: &Place, instruction: usize) {
        let known = self.uses.instructions.iter().any(|(it, at)| *at == instruction && same_storage(it, place));
        if !known {
            self.uses.instructions.push((place.clone(), instruction));
        }
    }

    /// Checks the actual of RCV: a variable of its own, kept by RETAIN.
    pub(super) fn retained_count(&mut self, counter: &Place, given: Given<'_, 's>, callee: Span) -> Option<Place> {
        let Given::Value(expr) = given else {
            self.report(
                Diagnostic::new(Code::E0303, callee, "a retentive counter needs a variable for `RCV`")
                    .label("it keeps the count there")
                    .help("declare `VAR RETAIN count : INT; END_VAR` and write `RCV := count`"),
            );
            return None;
        };
        let found = self.variable_argument(expr, "RCV")?;
        if found.place.ty != Type::INT {
            let ty = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(Code::E0201, expr.span, format!("`RCV` is an INT, found {ty}"))
                    .label("expected an INT variable"),
            );
            return None;
        }
        let retained = self.is_retained(expr);
        if !retained {
            self.report(
                Diagnostic::new(Code::W0301, expr.span, "this count will not survive a restart")
                    .label("the variable is not RETAIN")
                    .help("declare it in VAR RETAIN"),
            );
        }
        let shared = self
            .uses
            .counts
            .iter()
            .find(|it| same_storage(&it.kept, &found.place) && !same_storage(&it.counter, counter));
        if let Some(other) = shared {
            let first = other.span;
            self.report(
                Diagnostic::new(Code::E0314, expr.span, "two counters keep their count in one variable")
                    .label("each counter needs an RCV of its own")
                    .other(first, "the other counter's"),
            );
            return None;
        }
        self.uses.counts.push(KeptCount {
            counter: counter.clone(),
            kept: found.place.clone(),
            retained,
            span: expr.span,
        });
        Some(found.place)
    }

    /// Whether the variable that `expr` names is RETAIN.
    fn is_retained(&mut self, expr: &ast::Expr<'s>) -> bool {
        match &expr.kind {
            ast::ExprKind::Name(name) => {
                matches!(self.find_variable(*name), Some(Some(variable)) if variable.retain)
            }
            ast::ExprKind::Member(base, _) | ast::ExprKind::Index(base, _) | ast::ExprKind::Paren(base) => {
                self.is_retained(base)
            }
            ast::ExprKind::Literal(_)
            | ast::ExprKind::Address(_)
            | ast::ExprKind::Part(..)
            | ast::ExprKind::Deref(_)
            | ast::ExprKind::Call(..)
            | ast::ExprKind::Unary(..)
            | ast::ExprKind::Binary(..) => false,
        }
    }

    pub(super) fn note_assigned(&mut self, place: &Place, span: Span) {
        self.uses.assigned.push((place.clone(), span));
    }

    /// The statements that run before the POU's first body.
    pub(super) fn prescan(&mut self, pou: &ast::Pou<'s>) -> Block {
        let uses = std::mem::take(&mut self.uses);
        self.refuse_assigned_counts(&uses);
        let at = self.at(pou.name.span);
        let mut block = Block::new();
        for (place, instruction) in &uses.instructions {
            let Type::Block(id) = place.ty else { continue };
            if id.info().instructions[*instruction].prescan.is_none() || !lasts(place) {
                continue;
            }
            let kind = |block| StatementKind::PrescanBlock { block, instruction: *instruction };
            let mut made = self.everywhere(place.clone(), at, &mut |_, place| vec![Statement::new(kind(place), at)]);
            block.append(&mut made);
        }
        for it in &uses.counts {
            if !lasts(&it.counter) || !lasts(&it.kept) {
                continue;
            }
            block.append(&mut self.restore(it, at));
        }
        block
    }

    /// CV starts at the kept count where that is retained, else at 0.
    fn restore(&mut self, it: &KeptCount, at: Location) -> Block {
        let Type::Block(id) = it.counter.ty else { return Block::new() };
        debug_assert!(is_retentive_counter(id));
        let dynamic = [&it.counter, &it.kept].into_iter().any(has_index);
        if dynamic {
            // Which element keeps which count is known in the call only; constant indices are fields.
            return self.restore_elements(it, at);
        }
        let cv = pin_place(it.counter.clone(), id, "CV");
        let value = if it.retained {
            Expr::load(it.kept.clone(), at)
        } else {
            Expr::constant(Elementary::Int, Value::I16(0), at)
        };
        vec![Statement::assign(cv, value, at)]
    }

    /// `c[i](…, RCV := kept[i])`: element by element, where both have one index and one range.
    fn restore_elements(&mut self, it: &KeptCount, at: Location) -> Block {
        let Type::Block(id) = it.counter.ty else { return Block::new() };
        let kept = it.kept.clone();
        let retained = it.retained;
        self.everywhere(it.counter.clone(), at, &mut |indices, counter| {
            let cv = pin_place(counter, id, "CV");
            let mut source = kept.clone();
            let mut given = indices.iter();
            for projection in &mut source.projections {
                if let Projection::Index { index, .. } = projection
                    && index.as_const().is_none()
                    && let Some(expr) = given.next()
                {
                    **index = expr.clone();
                }
            }
            let value =
                if retained { Expr::load(source, at) } else { Expr::constant(Elementary::Int, Value::I16(0), at) };
            vec![Statement::assign(cv, value, at)]
        })
    }

    /// Runs `make` on the place; where an index is not constant, on every element.
    fn everywhere(&mut self, place: Place, at: Location, make: &mut dyn FnMut(&[Expr], Place) -> Block) -> Block {
        self.elements(place, 0, &mut Vec::new(), at, make)
    }

    fn elements(
        &mut self,
        mut place: Place,
        from: usize,
        indices: &mut Vec<Expr>,
        at: Location,
        make: &mut dyn FnMut(&[Expr], Place) -> Block,
    ) -> Block {
        let open = (from..place.projections.len()).find(|position| {
            matches!(&place.projections[*position], Projection::Index { index, .. } if index.as_const().is_none())
        });
        let Some(position) = open else { return make(indices, place) };
        let Some((low, high)) = self.bounds_at(&place, position) else { return Block::new() };
        let counter = self.temporary("element", Type::LINT);
        let index = Expr::load(counter.clone(), at);
        place.projections[position] = Projection::Index { index: Box::new(index.clone()), at };
        indices.push(index.clone());
        let mut body = self.elements(place, position + 1, indices, at, make);
        indices.pop();
        let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
        let test = |op, a, b| Expr::apply(op, Type::BOOL, vec![a, b], at);
        let leave = |condition| {
            let then = vec![Statement::new(StatementKind::Exit, at)];
            Statement::new(StatementKind::If { condition, then, otherwise: Vec::new() }, at)
        };
        let mut inside = vec![leave(test(Op::Gt, index.clone(), lint(high)))];
        inside.append(&mut body);
        let next = Expr::apply(Op::Add, Type::LINT, vec![index, lint(1)], at);
        let continuing = vec![Statement::assign(counter.clone(), next, at)];
        vec![
            Statement::assign(counter, lint(low), at),
            Statement::new(StatementKind::Loop { body: inside, continuing }, at),
        ]
    }

    /// The bounds of the array that projection `position` indexes.
    fn bounds_at(&self, place: &Place, position: usize) -> Option<(i64, i64)> {
        let mut ty = self.root_type(place)?;
        for projection in &place.projections[..position] {
            ty = match projection {
                Projection::Field(field) => self.field_type(ty, *field)?,
                Projection::Index { .. } => match ty {
                    Type::Array(id) => self.decl.program.array(id).element,
                    _ => return None,
                },
            };
        }
        match ty {
            Type::Array(id) => Some((self.decl.program.array(id).low, self.decl.program.array(id).high)),
            Type::Elementary(_) | Type::String(_) | Type::Enum(_) | Type::Struct(_) | Type::Block(_) => None,
        }
    }

    fn root_type(&self, place: &Place) -> Option<Type> {
        match place.root {
            Root::Instance => self.signature.as_ref()?.state.map(Type::Struct),
            // The globals have no structure yet; their first projection is a variable's.
            Root::Globals => Some(Type::Struct(crate::declare::GLOBALS)),
            Root::Local(id) => Some(self.locals[id.index()].ty),
            Root::Param(_) => None,
        }
    }

    fn field_type(&self, ty: Type, field: staunch_ir::FieldId) -> Option<Type> {
        match ty {
            Type::Struct(id) if id == crate::declare::GLOBALS => self.decl.global_type(field),
            _ => self.decl.program.member(ty, field),
        }
    }

    fn refuse_assigned_counts(&mut self, uses: &Uses) {
        for count in &uses.counts {
            let Some((_, span)) = uses.assigned.iter().find(|(place, _)| same_storage(place, &count.kept)) else {
                continue;
            };
            self.decl.report(
                Diagnostic::new(Code::E0315, *span, "the variable that keeps a counter's count is assigned")
                    .label("only the counter writes it")
                    .other(count.span, "given as RCV here")
                    .help("to clear the count, call the counter with its RESET TRUE"),
            );
        }
    }
}

/// Whether the place is storage that lasts from scan to scan and has one name.
fn lasts(place: &Place) -> bool {
    matches!(place.root, Root::Instance | Root::Globals)
}

fn has_index(place: &Place) -> bool {
    place.projections.iter().any(|it| matches!(it, Projection::Index { index, .. } if index.as_const().is_none()))
}

/// Whether two places surely are, or by an index may be, the same.
fn same_storage(a: &Place, b: &Place) -> bool {
    let same = |(a, b): (&Projection, &Projection)| match (a, b) {
        (Projection::Field(a), Projection::Field(b)) => a == b,
        (Projection::Index { index: a, .. }, Projection::Index { index: b, .. }) => {
            match (a.as_const(), b.as_const()) {
                (Some(a), Some(b)) => a == b,
                _ => true,
            }
        }
        _ => false,
    };
    a.root == b.root && a.projections.len() == b.projections.len() && a.projections.iter().zip(&b.projections).all(same)
}
