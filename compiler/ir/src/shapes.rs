//! Parameters that are an `ARRAY[*]`: each routine that has some is copied for each shape of arrays that it is
//! given. What follows knows arrays of constant bounds alone, so that an index in a copy is checked as any
//! other is, and no executor learns of a second kind of array.

use crate::fold;
use crate::visit::{self, Rewrite};
use crate::{
    Argument, Array, Block, Const, Expr, ExprKind, Local, LocalId, Location, Place, Program, Projection, Root, Routine,
    RoutineId, RoutineKind, StatementKind, Type, Value,
};
use std::collections::HashMap;

/// Copies of a program's routines. Each level of calls may double their number.
const MAX_COPIES: usize = 10_000;

/// The program with a copy of each such routine for each shape.
///
/// # Errors
/// Where a routine is that would be copied once too often.
pub fn settle(mut program: Program) -> Result<Program, Location> {
    if !program.arrays.iter().any(|it| it.is_open()) {
        return Ok(program);
    }
    let mut shaper = Shaper { source: &program, known: HashMap::new(), routines: Vec::new(), too_many: None };
    let declared: Vec<_> = (0..program.routines.len()).map(RoutineId::next).map(|id| shaper.declared(id)).collect();
    let bodies: Vec<_> = program.classes.iter().map(|it| shaper.body(it.body)).collect();
    if let Some(id) = shaper.too_many {
        return Err(program.routine(id).location);
    }
    let routines = shaper.routines;
    for (class, body) in program.classes.iter_mut().zip(bodies) {
        class.body = body;
        class.prescan = class.prescan.and_then(|it| declared[it.index()]);
        class.start = class.start.and_then(|it| declared[it.index()]);
        let params = &routines[body.index()].params;
        for variable in &mut class.variables {
            if let (Root::Param(id), true) = (variable.place.root, variable.place.projections.is_empty()) {
                variable.place.ty = params[id.index()].ty;
            }
        }
    }
    program.routines = routines;
    // A body that nobody calls is made for one element.
    program.arrays.iter_mut().filter(|it| it.is_open()).for_each(|it| *it = Array { high: it.low, ..*it });
    Ok(program)
}

struct Shaper<'p> {
    source: &'p Program,
    /// By the routine of the source, and the types of its parameters.
    known: HashMap<(RoutineId, Vec<Type>), RoutineId>,
    /// A callee is before its callers.
    routines: Vec<Routine>,
    too_many: Option<RoutineId>,
}

impl Shaper<'_> {
    /// A routine without such parameters; others are made where they are called.
    fn declared(&mut self, id: RoutineId) -> Option<RoutineId> {
        let params = &self.source.routine(id).params;
        let types = params.iter().map(|it| it.ty).collect();
        params.iter().all(|it| it.bounds.is_empty()).then(|| self.shaped(id, types))
    }

    /// The body of a class: any copy, since only calls say which one they mean.
    fn body(&mut self, id: RoutineId) -> RoutineId {
        let made = self.known.iter().filter(|((source, _), _)| *source == id).map(|(_, made)| *made).min();
        made.unwrap_or_else(|| self.shaped(id, self.source.routine(id).params.iter().map(|it| it.ty).collect()))
    }

    fn shaped(&mut self, id: RoutineId, types: Vec<Type>) -> RoutineId {
        let key = (id, types);
        if let Some(made) = self.known.get(&key) {
            return *made;
        }
        if self.too_many.is_some() || self.known.len() >= self.source.routines.len() + MAX_COPIES {
            self.too_many = self.too_many.or(Some(id));
            return id;
        }
        let routine = self.copy(id, &key.1);
        let made = RoutineId::next(self.routines.len());
        self.routines.push(routine);
        self.known.insert(key, made);
        made
    }

    fn copy(&mut self, id: RoutineId, types: &[Type]) -> Routine {
        let source = self.source.routine(id);
        let mut routine = source.clone();
        for (param, ty) in routine.params.iter_mut().zip(types) {
            param.ty = *ty;
            param.bounds.clear();
        }
        let mut shape = Shape {
            program: self.source,
            state: source.state,
            params: types.to_vec(),
            locals: std::mem::take(&mut routine.locals),
            bounds: self.bounds(source, types),
        };
        shape.type_locals(&source.body);
        visit::rewrite(&mut routine.body, &mut shape);
        routine.locals = shape.locals;
        self.calls(&mut routine.body);
        if source.params.iter().any(|it| !it.bounds.is_empty()) {
            routine.name = self.name(source, types);
        }
        routine
    }

    /// The values of the locals that stand for bounds.
    fn bounds(&self, source: &Routine, types: &[Type]) -> HashMap<LocalId, i64> {
        let mut values = HashMap::new();
        for (param, ty) in source.params.iter().zip(types) {
            for (dimension, (low, high)) in self.dimensions(*ty).zip(&param.bounds) {
                values.insert(*low, dimension.low);
                values.insert(*high, dimension.high.max(dimension.low));
            }
        }
        values
    }

    fn dimensions(&self, ty: Type) -> impl Iterator<Item = Array> {
        let array = |ty| match ty {
            Type::Array(id) => Some(self.source.array(id)),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Struct(_)
            | Type::Block(_) => None,
        };
        std::iter::successors(array(ty), move |it| array(it.element))
    }

    /// `Sum_1_to_10`
    fn name(&self, source: &Routine, types: &[Type]) -> String {
        let mut name = match source.kind {
            RoutineKind::Function | RoutineKind::Method => source.name.clone(),
            RoutineKind::Body | RoutineKind::Prescan => "scan".to_owned(),
        };
        for (param, ty) in source.params.iter().zip(types) {
            for (dimension, _) in self.dimensions(*ty).zip(&param.bounds) {
                let bound = |it: i64| it.to_string().replace('-', "minus_");
                name.push_str(&format!("_{}_to_{}", bound(dimension.low), bound(dimension.high.max(dimension.low))));
            }
        }
        name
    }

    /// Calls go to the copies for what they pass.
    fn calls(&mut self, block: &mut Block) {
        for statement in block {
            if let StatementKind::Call { callee, arguments, .. } = &mut statement.kind {
                let params = &self.source.routine(*callee).params;
                let ty = |(param, argument): (&crate::Param, &Argument)| match argument {
                    Argument::Reference(place) if !param.bounds.is_empty() => place.ty,
                    Argument::Reference(_) | Argument::Value(_) => param.ty,
                };
                let types = params.iter().zip(arguments.iter()).map(ty).collect();
                *callee = self.shaped(*callee, types);
            }
            statement.kind.blocks_mut().into_iter().for_each(|it| self.calls(it));
        }
    }
}

/// A body that is being given its shape.
struct Shape<'p> {
    program: &'p Program,
    state: Option<crate::StructId>,
    params: Vec<Type>,
    locals: Vec<Local>,
    bounds: HashMap<LocalId, i64>,
}

impl Shape<'_> {
    /// A local that holds a copy of such an array is what it is assigned first.
    fn type_locals(&mut self, body: &Block) {
        visit::statements(body, &mut |statement| {
            let StatementKind::Assign { target, value } = &statement.kind else { return };
            let (Root::Local(id), ExprKind::Load(from)) = (target.root, &value.kind) else { return };
            if target.projections.is_empty() && self.program.is_open(target.ty) {
                self.locals[id.index()].ty = self.type_of(from);
            }
        });
    }

    fn type_of(&self, place: &Place) -> Type {
        let mut ty = self.root(place.root);
        for projection in &place.projections {
            ty = self.program.part(ty, projection).expect("verified IR: each part exists");
        }
        ty
    }

    fn root(&self, root: Root) -> Type {
        match root {
            Root::Instance => Type::Struct(self.state.expect("verified IR: a routine with an instance")),
            Root::Globals => Type::Struct(self.program.globals),
            Root::Local(id) => self.locals[id.index()].ty,
            Root::Param(id) => self.params[id.index()],
        }
    }

    /// An index that is a constant has been checked: one that is none of this array's becomes a variable.
    fn check(&mut self, ty: Type, index: &mut Expr) {
        let (Type::Array(id), Some(Value::I64(value))) = (ty, index.as_const()) else { return };
        let array = self.program.array(id);
        if (array.low..=array.high.max(array.low)).contains(&value) {
            return;
        }
        let local = LocalId::next(self.locals.len());
        let initial = Const::Scalar(Value::I64(value));
        self.locals.push(Local { name: "index".to_owned(), ty: Type::LINT, initial, doc: None });
        *index = Expr::load(Place::local(local, Type::LINT), index.at);
    }
}

impl Rewrite for Shape<'_> {
    fn expr(&mut self, expr: &mut Expr) {
        if let ExprKind::Load(place) = &expr.kind
            && self.program.is_open(expr.ty)
        {
            expr.ty = place.ty;
        }
        if let ExprKind::Load(Place { root: Root::Local(id), .. }) = &expr.kind
            && let Some(bound) = self.bounds.get(id)
        {
            let value = expr.ty.elementary().and_then(|it| it.repr().integer(i128::from(*bound)));
            expr.kind = ExprKind::Const(value.expect("the front end takes no array whose bounds are no DINTs"));
        } else if let Some(Ok(Const::Scalar(value))) = fold(expr) {
            expr.kind = ExprKind::Const(value);
        }
    }

    fn place(&mut self, place: &mut Place) {
        let mut ty = self.root(place.root);
        for projection in &mut place.projections {
            if let Projection::Index { index, .. } = projection {
                self.check(ty, index);
            }
            ty = self.program.part(ty, projection).expect("verified IR: each part exists");
        }
        if self.program.is_open(place.ty) {
            place.ty = ty;
        }
    }
}

/// Whether an array may be given for an `ARRAY[*]`: as many dimensions, of the same elements.
pub fn fits(program: &Program, open: Type, given: Type) -> bool {
    match (open, given) {
        (Type::Array(open), Type::Array(given)) if program.array(open).is_open() => {
            fits(program, program.array(open).element, program.array(given).element)
        }
        _ => open == given,
    }
}
