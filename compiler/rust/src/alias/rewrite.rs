//! A body whose places move to other roots.

use std::collections::HashMap;

use staunch_ir::{
    Argument, Expr, ExprKind, FieldId, Local, LocalId, Param, ParamId, Place, Program, Projection, Root, Routine,
    StructId, Type,
};

/// What stands for a root of the source's.
#[derive(Clone, Debug)]
pub struct Base {
    pub root: Root,
    pub projections: Vec<Projection>,
    /// The shared parameter that is the root, until it has its number.
    pub group: Option<usize>,
}

/// The POU being written: its signature so far, and where its source's roots have gone.
#[derive(Debug)]
pub struct Body {
    pub params: Vec<Param>,
    pub locals: Vec<Local>,
    pub state: Option<StructId>,
    pub instance: Base,
    /// For each of the source's parameters.
    pub bases: Vec<Base>,
    /// What stands for each of the globals, where they are handed over one by one.
    pub globals: Option<HashMap<FieldId, Base>>,
    /// The parameters that hold subscripts.
    pub subscripts: Vec<LocalId>,
}

impl Body {
    /// Every root stays what it is.
    pub fn declared(source: &Routine) -> Self {
        let same = |root| Base { root, projections: Vec::new(), group: None };
        Self {
            params: source.params.clone(),
            locals: source.locals.clone(),
            state: source.state,
            globals: None,
            subscripts: Vec::new(),
            instance: same(Root::Instance),
            bases: (0..source.params.len()).map(|at| same(Root::Param(ParamId::next(at)))).collect(),
        }
    }

    /// Gives the shared parameters their numbers.
    pub fn place_groups(&mut self, first: usize) {
        let globals = self.globals.iter_mut().flat_map(HashMap::values_mut);
        for base in self.bases.iter_mut().chain([&mut self.instance]).chain(globals) {
            if let Some(group) = base.group {
                base.root = Root::Param(ParamId::next(first + group));
            }
        }
    }

    pub fn root_type(&self, program: &Program, root: Root) -> Type {
        match root {
            Root::Instance => Type::Struct(self.state.expect("verified IR: an instance has a state")),
            Root::Globals => Type::Struct(program.globals),
            Root::Local(id) => self.locals[id.index()].ty,
            Root::Param(id) => self.params[id.index()].ty,
        }
    }

    pub fn place(&self, place: &Place) -> Place {
        let mut after = place.projections.iter().map(|it| self.projection(it));
        if let (Root::Globals, Some(globals)) = (place.root, &self.globals) {
            let Some(Projection::Field(field)) = after.next() else {
                unreachable!("verified IR: the globals are used one by one")
            };
            return below(&globals[&field], after, place.ty);
        }
        match place.root {
            Root::Instance => below(&self.instance, after, place.ty),
            Root::Param(id) => below(&self.bases[id.index()], after, place.ty),
            Root::Globals | Root::Local(_) => Place { root: place.root, projections: after.collect(), ty: place.ty },
        }
    }

    fn projection(&self, projection: &Projection) -> Projection {
        match projection {
            Projection::Field(_) | Projection::Deref { .. } => projection.clone(),
            Projection::Index { index, at } => Projection::Index { index: Box::new(self.expr(index)), at: *at },
        }
    }

    pub fn expr(&self, expr: &Expr) -> Expr {
        let all = |operands: &[Expr]| operands.iter().map(|it| self.expr(it)).collect();
        let kind = match &expr.kind {
            ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => return expr.clone(),
            ExprKind::Load(place) => ExprKind::Load(self.place(place)),
            ExprKind::AddressOf(place) => ExprKind::AddressOf(Box::new(self.place(place))),
            ExprKind::Apply(op, operands) => ExprKind::Apply(*op, all(operands)),
            ExprKind::ApplyText(op, operands) => ExprKind::ApplyText(*op, all(operands)),
            ExprKind::Convert(how, value) => ExprKind::Convert(*how, Box::new(self.expr(value))),
        };
        Expr::new(expr.ty, kind, expr.at)
    }

    pub fn argument(&self, argument: &Argument) -> Argument {
        match argument {
            Argument::Value(value) => Argument::Value(self.expr(value)),
            Argument::Reference(place) => Argument::Reference(self.place(place)),
        }
    }
}

fn below(base: &Base, after: impl Iterator<Item = Projection>, ty: Type) -> Place {
    Place { root: base.root, projections: base.projections.iter().cloned().chain(after).collect(), ty }
}
