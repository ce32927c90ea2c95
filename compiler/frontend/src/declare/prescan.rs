//! A prescan reaches the instances inside: each POU's runs those of the blocks it contains.

use super::Declarations;
use staunch_ir::{
    Block, Elementary, Expr, FieldId, Local, LocalId, Location, Op, Place, Pou, PouId, Root, Statement, StatementKind,
    StructId, Type, Value,
};

/// Adds the prescans of contained instances.
pub(super) fn nest(declarations: &mut Declarations<'_>) {
    if declarations.program.pous.iter().all(|it| it.prescan.is_empty()) {
        return;
    }
    // Structures stand in the order of containment, so one pass over them sees parts first.
    let pous = declarations.program.pous.iter().enumerate();
    let mut owners: Vec<_> = pous.filter_map(|(at, pou)| Some((pou.state?, at))).collect();
    owners.sort_unstable();
    for (state, at) in owners {
        let fields = fields_of(declarations, state);
        extend(declarations, at, Root::Instance, &fields);
    }
    let first = declarations.program.instances.first().map(|it| it.program.index());
    if let Some(at) = first {
        let globals = declarations.program.globals;
        let fields = fields_of(declarations, globals);
        extend(declarations, at, Root::Globals, &fields);
    }
}

fn fields_of(declarations: &Declarations<'_>, id: StructId) -> Vec<(FieldId, Type)> {
    let fields = &declarations.program.structure(id).fields;
    fields.iter().enumerate().map(|(at, field)| (FieldId::next(at), field.ty)).collect()
}

fn extend(declarations: &mut Declarations<'_>, at: usize, root: Root, fields: &[(FieldId, Type)]) {
    let mut locals = std::mem::take(&mut declarations.program.pous[at].locals);
    let mut added = Block::new();
    for (field, ty) in fields {
        let place = Place::root(root, *ty).field(*field, *ty);
        added.append(&mut contained(declarations, place, &mut locals));
    }
    let pou: &mut Pou = &mut declarations.program.pous[at];
    pou.locals = locals;
    pou.prescan.append(&mut added);
}

/// The prescans of the instances at `place`: itself, or its elements or members.
fn contained(declarations: &Declarations<'_>, place: Place, locals: &mut Vec<Local>) -> Block {
    match place.ty {
        Type::Struct(id) => match declarations.slot_of_instance(id) {
            Some(slot) if declarations.program.pous[slot].prescan.is_empty() => Block::new(),
            Some(slot) => {
                let kind = StatementKind::PrescanInstance { callee: PouId::next(slot), instance: place };
                vec![Statement::new(kind, Location::default())]
            }
            None => {
                let fields = fields_of(declarations, id);
                let member = |(field, ty)| contained(declarations, place.clone().field(field, ty), locals);
                fields.into_iter().flat_map(member).collect()
            }
        },
        Type::Array(id) => {
            let array = declarations.program.array(id);
            let at = Location::default();
            let counter = LocalId::next(locals.len());
            let index = Expr::load(Place::local(counter, Type::LINT), at);
            locals.push(Local {
                name: "element".to_owned(),
                ty: Type::LINT,
                initial: staunch_ir::Const::Zero,
                doc: None,
            });
            let element = place.index(index.clone(), array.element, at);
            let body = contained(declarations, element, locals);
            if body.is_empty() {
                locals.truncate(counter.index());
                return Block::new();
            }
            for_each(counter, index, array.low, array.high, body)
        }
        Type::Elementary(_) | Type::String(_) | Type::Enum(_) | Type::Block(_) => Block::new(),
    }
}

fn for_each(counter: LocalId, index: Expr, low: i64, high: i64, mut body: Block) -> Block {
    let at = Location::default();
    let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
    let counter = Place::local(counter, Type::LINT);
    let over = Expr::apply(Op::Gt, Type::BOOL, vec![index.clone(), lint(high)], at);
    let exit = vec![Statement::new(StatementKind::Exit, at)];
    let mut inside = vec![Statement::new(StatementKind::If { condition: over, then: exit, otherwise: Vec::new() }, at)];
    inside.append(&mut body);
    let next = Expr::apply(Op::Add, Type::LINT, vec![index, lint(1)], at);
    vec![
        Statement::assign(counter.clone(), lint(low), at),
        Statement::new(
            StatementKind::Loop { body: inside, continuing: vec![Statement::assign(counter, next, at)] },
            at,
        ),
    ]
}
