//! Values and subscripts evaluated before a call, and the parameters of a copy.

use staunch_ir::{
    Block, Const, Elementary, Expr, ExprKind, FaultKind, Local, LocalId, Location, Mode, Op, Param, ParamId, Place,
    Projection, Root, Statement, StatementKind, Type, Value,
};

use super::key::{Binding, SharedRoot, Step};
use super::rewrite::{Base, Body};

impl Body {
    /// Reads `value` now if reading it at the call could fault, or read what is borrowed then.
    pub fn fix_value(&mut self, value: Expr, out: &mut Block) -> Expr {
        let mut reads = false;
        staunch_ir::visit::reads(&value, &mut |_| reads = true);
        if reads { self.hoist("value", value, out) } else { value }
    }

    /// Evaluates a subscript and faults unless it is within its bounds.
    pub fn fix_index(&mut self, index: Expr, (low, high): (i64, i64), at: Location, out: &mut Block) -> Expr {
        if self.is_subscript(&index) {
            return index;
        }
        let index = self.hoist("at", index, out);
        let outside = |op, bound| {
            let bound = Expr::constant(Elementary::Lint, Value::I64(bound), at);
            Expr::apply(op, Type::BOOL, vec![index.clone(), bound], at)
        };
        let condition = Expr::apply(Op::Or, Type::BOOL, vec![outside(Op::Lt, low), outside(Op::Gt, high)], at);
        let then = vec![Statement::new(StatementKind::Fault(FaultKind::IndexOutOfRange), at)];
        let kind = StatementKind::If { condition, then, otherwise: Block::new() };
        out.push(Statement::new(kind, at));
        index
    }

    /// Whether `index` is a parameter for a subscript: checked at the call, never written.
    fn is_subscript(&self, index: &Expr) -> bool {
        let ExprKind::Load(place) = &index.kind else { return false };
        matches!(place.root, Root::Local(id) if self.subscripts.contains(&id))
    }

    fn hoist(&mut self, name: &str, value: Expr, out: &mut Block) -> Expr {
        let (ty, at) = (value.ty, value.at);
        let local = self.local(name, ty);
        out.push(Statement::assign(Place::local(local, ty), value, at));
        Expr::load(Place::local(local, ty), at)
    }

    fn local(&mut self, name: &str, ty: Type) -> LocalId {
        let id = LocalId::next(self.locals.len());
        self.locals.push(Local { name: name.to_owned(), ty, initial: Const::Zero, doc: None });
        id
    }

    /// Makes a by-value LINT parameter for a subscript, and returns how to read it.
    fn index_param(&mut self, name: &str, at: Location) -> Expr {
        let name = format!("{name}_at");
        let local = self.local(&name, Type::LINT);
        self.subscripts.push(local);
        self.params.push(Param { name, ty: Type::LINT, doc: None, mode: Mode::Value(local), bounds: Vec::new() });
        Expr::load(Place::local(local, Type::LINT), at)
    }

    pub fn keep(&mut self, param: &Param) -> Base {
        let id = ParamId::next(self.params.len());
        self.params.push(param.clone());
        Base { root: Root::Param(id), projections: Vec::new(), group: None }
    }

    pub fn bind(&mut self, binding: &Binding, name: &str, at: Location) -> Base {
        let Binding::Within { root, steps } = binding else {
            return Base { root: Root::Instance, projections: Vec::new(), group: None };
        };
        let projections = steps
            .iter()
            .map(|step| match step {
                Step::Field(field) => Projection::Field(*field),
                Step::Index => Projection::Index { index: Box::new(self.index_param(name, at)), at },
            })
            .collect();
        let (root, group) = match root {
            SharedRoot::Instance => (Root::Instance, None),
            SharedRoot::Group(number) => (Root::Instance, Some(*number)),
        };
        Base { root, projections, group }
    }
}
