//! The variables that a stopped routine sees, in declaration order.

use staunch_host::{Map, part_of, place_of, same_name, shown};
use staunch_ir::interpret::debug::{Ask, Stopped};
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text_with_locals;
use staunch_ir::{LocalId, Mode, ParamId, Place, Program, Root, RoutineKind, Type, Variable};

/// A variable with its value, as Structured Text writes them.
#[derive(Debug)]
pub(super) struct Shown {
    pub name: String,
    pub ty: String,
    pub value: String,
}

/// What is shown at a stop.
#[derive(Debug, Default)]
pub(super) struct Variables {
    /// They live for one call.
    pub locals: Vec<Shown>,
    /// Of the instance.
    pub members: Vec<Shown>,
}

/// Characters of a value among others, and of one that is asked for.
const SHORT: usize = 100;
const LONG: usize = 2000;

/// Where variables are, also those that live for one call.
pub(super) fn map_text(program: &Program) -> String {
    map_text_with_locals(program, &Layout::new(program))
}

/// All that the innermost routine declares, and the instance that it works on.
pub(super) fn variables<A: Ask>(stopped: &Stopped<'_, A>, map: &Map) -> Variables {
    let show = |it: &Variable| {
        let value = value(stopped, map, it, SHORT);
        Shown { name: it.name.clone(), ty: type_name(stopped.program(), it), value }
    };
    let (locals, members): (Vec<_>, Vec<_>) = in_scope(stopped).into_iter().partition(is_local);
    Variables { locals: locals.iter().map(show).collect(), members: members.iter().map(show).collect() }
}

/// The variable or part of one that a path names: `motor.Speed`, `THIS^.x`, `a[3]`. Nothing, where it names neither.
pub(super) fn by_path<A: Ask>(stopped: &Stopped<'_, A>, map: &Map, text: &str) -> Option<Shown> {
    let own = text.get(..6).filter(|it| it.eq_ignore_ascii_case("THIS^.")).map(|it| &text[it.len()..]);
    let path = own.unwrap_or(text).trim();
    let end = path.find(['.', '[']).unwrap_or(path.len());
    let (name, rest) = path.split_at(end);
    let mut scope = in_scope(stopped);
    if own.is_some() {
        scope.retain(|it| !is_local(it));
    }
    let variable = scope.into_iter().find(|it| same_name(&it.name, name.trim()))?;
    if rest.is_empty() {
        let value = value(stopped, map, &variable, LONG);
        return Some(Shown { name: text.to_owned(), ty: type_name(stopped.program(), &variable), value });
    }
    let part = part_of(map, host_type(variable.place.ty), rest).ok().filter(|_| variable.view.is_none())?;
    let bytes = stopped.bytes(&variable.place).ok()?.get(part.offset..)?;
    let value = shown(map, part.ty, bytes, LONG);
    Some(Shown { name: text.to_owned(), ty: map.type_name(part.ty), value })
}

/// A variable of the program by its path from a PROGRAM or a global, as `--vars` has it.
pub(super) fn of_program<A: Ask>(stopped: &Stopped<'_, A>, map: &Map, text: &str) -> Option<Shown> {
    let running: Vec<usize> = (0..map.instances.len()).collect();
    let place = place_of(map, &running, text).ok()?;
    let value = shown(map, place.ty, stopped.state().get(place.offset..)?, LONG);
    Some(Shown { name: text.to_owned(), ty: map.type_name(place.ty), value })
}

/// A value that the compiler has evaluated.
pub(super) fn evaluated(map: &Map, text: &str, ty: Type, name: String, bytes: &[u8]) -> Shown {
    Shown { name: text.to_owned(), ty: name, value: shown(map, host_type(ty), bytes, LONG) }
}

fn value<A: Ask>(stopped: &Stopped<'_, A>, map: &Map, variable: &Variable, room: usize) -> String {
    let bytes = match stopped.bytes(&variable.place) {
        Ok(bytes) => bytes,
        Err(fault) => return format!("({})", fault.kind),
    };
    let (ty, start) = match variable.view {
        Some(view) => {
            let bit = u8::try_from(view.bit % 8).unwrap_or_default();
            let ty = if view.ty == Type::BOOL { staunch_host::Type::Bit(bit) } else { host_type(view.ty) };
            (ty, usize::try_from(view.bit / 8).unwrap_or(usize::MAX))
        }
        None => (host_type(variable.place.ty), 0),
    };
    shown(map, ty, bytes.get(start..).unwrap_or_default(), room)
}

fn type_name(program: &Program, variable: &Variable) -> String {
    program.type_name(variable.view.map_or(variable.place.ty, |it| it.ty))
}

fn is_local(variable: &Variable) -> bool {
    match variable.place.root {
        Root::Local(_) | Root::Param(_) => true,
        Root::Instance | Root::Globals => false,
    }
}

/// The variables of a body are its class's. A METHOD has its own, and sees those of the instance.
fn in_scope<A: Ask>(stopped: &Stopped<'_, A>) -> Vec<Variable> {
    let Some(running) = stopped.running().last() else { return Vec::new() };
    let program = stopped.program();
    let routine = program.routine(running.routine());
    let class = routine.state.and_then(|it| program.class_of_state(it));
    let of_class = class.into_iter().flat_map(|it| it.variables.iter().cloned());
    match routine.kind {
        RoutineKind::Body => of_class.collect(),
        RoutineKind::Function | RoutineKind::Method | RoutineKind::Prescan => {
            let mut all = own(stopped);
            all.extend(of_class.filter(|it| !is_local(it)));
            all
        }
    }
}

/// What a FUNCTION or METHOD declares.
fn own<A: Ask>(stopped: &Stopped<'_, A>) -> Vec<Variable> {
    let Some(running) = stopped.running().last() else { return Vec::new() };
    let routine = stopped.program().routine(running.routine());
    let variable = |name: &String, root, ty| Variable {
        name: name.clone(),
        section: staunch_ir::Section::Temp,
        place: Place::root(root, ty),
        view: None,
    };
    let references = routine.params.iter().enumerate().filter(|(_, it)| it.mode == Mode::Reference);
    let params = references.map(|(at, it)| variable(&it.name, Root::Param(ParamId::next(at)), it.ty));
    let locals = routine.locals.iter().take(stopped.declared).enumerate();
    let locals = locals.map(|(at, it)| variable(&it.name, Root::Local(LocalId::next(at)), it.ty));
    // The compiler's own have names that nobody can declare.
    let is_declared =
        |it: &Variable| !it.name.starts_with("__") && it.name.chars().all(|it| it.is_alphanumeric() || it == '_');
    params.chain(locals).filter(is_declared).collect()
}

/// A type as the map has it.
fn host_type(ty: Type) -> staunch_host::Type {
    match ty {
        Type::Elementary(it) | Type::Subrange(it, _) => staunch_host::Type::Elementary(it),
        Type::String(it) => staunch_host::Type::String(it),
        Type::Enum(id) => staunch_host::Type::Enum(id.0),
        Type::Array(id) => staunch_host::Type::Array(id.0),
        Type::Struct(id) => staunch_host::Type::Struct(id.0),
        Type::Block(id) => staunch_host::Type::Block(id.0),
        Type::Reference(_) => staunch_host::Type::Reference,
    }
}
