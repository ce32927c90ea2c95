//! Variables: the names that a statement sees, and where their values are.

use super::entries::{Entries, is_declared};
use super::notes::Homes;
use gimli::constants::{
    DW_AT_artificial, DW_AT_byte_size, DW_AT_location, DW_OP_and, DW_OP_dup, DW_OP_eq, DW_OP_minus, DW_OP_mul,
    DW_OP_plus, DW_OP_shr, DW_OP_stack_value, DW_OP_swap, DW_TAG_formal_parameter, DW_TAG_structure_type,
    DW_TAG_variable, DwTag,
};
use gimli::write::{Address, AttributeValue, Expression, UnitEntryId};
use staunch_ir::layout::Layout;
use staunch_ir::loops::constant_position;
use staunch_ir::{
    FieldId, HELD_PROGRAM, InterfaceId, LocalId, Mode, Place, Projection, RefKind, RefType, Root, Routine, RoutineKind,
    StructId, Type, Variable, View, visit,
};
use staunch_runtime::reference::{CLASS, ORIGIN};
use std::collections::{BTreeMap, BTreeSet};

/// Bytes of a pointer of the machine.
const POINTER: u64 = 8;

/// After the name of a type: the array that references are indices of. No identifier of Structured Text has two underscores.
const BY_ADDRESS: &str = "__at";

/// Where the storage begins that places of one root are in.
#[derive(Clone, Copy, Debug)]
enum Base {
    /// The state of the program.
    State,
    /// So far from the frame pointer.
    Frame(i64),
    /// Where the pointer leads that is so far from the frame pointer.
    Through(i64),
}

/// A list or namespace of global variables: what is in it by name, with its type and offset.
#[derive(Default)]
struct Listed {
    variables: BTreeMap<String, (Type, u64)>,
    lists: BTreeMap<String, Self>,
}

impl Entries<'_> {
    /// The PROGRAMs that run, and the global variables.
    pub(crate) fn of_program(&mut self) {
        let program = self.program;
        for (instance, offset) in program.instances.iter().zip(&self.layout.machine.instances.clone()) {
            let (ty, held) = self.held(Type::Struct(program.class(instance.program).state));
            self.global(&instance.name, ty, offset + held);
        }
        let start = self.layout.machine.globals;
        let globals = program.structure(program.globals);
        let mut places = BTreeMap::new();
        for (at, field) in globals.fields.iter().enumerate() {
            let offset = start + self.layout.field(program.globals, FieldId::next(at));
            if is_declared(&field.name) {
                self.global(&field.name, field.ty, offset);
            }
            places.insert(field.name.as_str(), (field.ty, offset));
        }
        for alias in &program.aliases {
            self.variable(self.root(), DW_TAG_variable, alias, None);
        }
        self.by_address();
        let mut lists = Listed::default();
        for (name, path) in &program.global_paths {
            if let Some(place) = places.get(name.as_str()) {
                lists.add(path, *place);
            }
        }
        for (name, list) in &lists.lists {
            let ty = self.list(name, list);
            let start = list.extent(self.layout).0;
            self.located(self.root(), DW_TAG_variable, (name, ty), Base::State.at(start, self));
        }
    }

    /// For each type that references lead to, all of the state as an array of that type: what a reference in a structure has is an index.
    fn by_address(&mut self) {
        let program = self.program;
        let is_named = |it: &&RefType| !matches!(it.kind, RefKind::Interface(_));
        let mut targets: Vec<Type> = program.references.iter().filter(is_named).map(|it| it.target).collect();
        targets.extend(program.implementers.iter().flatten().map(|it| Type::Struct(it.1)));
        let mut seen = BTreeSet::new();
        for target in targets {
            let name = program.type_name(target);
            if is_declared(&name) && seen.insert(name.to_ascii_uppercase()) {
                let last = self.layout.machine.size + u64::from(ORIGIN);
                let ty = self.at_each_byte(target, last);
                let mut location = Base::State.at(0, self);
                location.op_constu(ORIGIN.into());
                location.op(DW_OP_minus);
                self.located(self.root(), DW_TAG_variable, (&format!("{name}{BY_ADDRESS}"), ty), location);
            }
        }
    }

    /// What runs by itself may hold the PROGRAM that the source declares.
    fn held(&self, ty: Type) -> (Type, u64) {
        let Type::Struct(id) = ty else { return (ty, 0) };
        let mut fields = self.program.structure(id).fields.iter().enumerate();
        match fields.find(|it| it.1.name == HELD_PROGRAM) {
            Some((at, field)) => (field.ty, self.layout.field(id, FieldId::next(at))),
            None => (ty, 0),
        }
    }

    fn global(&mut self, name: &str, ty: Type, offset: u64) {
        self.stored(self.root(), DW_TAG_variable, (name, ty), (Base::State, offset));
    }

    /// A list as a structure, from the first of its variables on.
    fn list(&mut self, name: &str, list: &Listed) -> UnitEntryId {
        let id = self.add_named(self.root(), DW_TAG_structure_type, name);
        let (start, end) = list.extent(self.layout);
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(end - start));
        for (name, (ty, offset)) in &list.variables {
            let ty = self.type_of(*ty);
            self.member(id, name, ty, offset - start);
        }
        for (name, inner) in &list.lists {
            let ty = self.list(name, inner);
            self.member(id, name, ty, inner.extent(self.layout).0 - start);
        }
        id
    }

    /// What a routine sees of its own, and of its instance.
    pub(crate) fn of_routine(&mut self, function: UnitEntryId, routine: &Routine, homes: &Homes) {
        self.this(function, routine, homes);
        let class = routine.state.and_then(|it| self.program.class_of_state(it));
        let of_class = class.map(|it| it.variables.as_slice()).unwrap_or_default();
        if routine.kind == RoutineKind::Body {
            for it in of_class {
                let is_param = matches!(it.place.root, Root::Param(_));
                let tag = if is_param { DW_TAG_formal_parameter } else { DW_TAG_variable };
                self.variable(function, tag, it, Some((routine, homes)));
            }
            return;
        }
        let own = self.own(function, routine, homes);
        let is_seen = |it: &&Variable| match it.place.root {
            Root::Local(_) | Root::Param(_) => false,
            Root::Instance | Root::Globals => !own.contains(&it.name.to_ascii_uppercase()),
        };
        for it in of_class.iter().filter(is_seen) {
            self.variable(function, DW_TAG_variable, it, Some((routine, homes)));
        }
    }

    fn this(&mut self, function: UnitEntryId, routine: &Routine, homes: &Homes) {
        if let (Some(state), Some(home)) = (routine.state, homes.instance) {
            let ty = self.pointer_to(Type::Struct(state));
            let id = self.located(function, DW_TAG_formal_parameter, ("THIS", ty), Base::Frame(home).at(0, self));
            self.set(id, DW_AT_artificial, AttributeValue::Flag(true));
        }
    }

    /// The parameters and variables of a FUNCTION or METHOD. Gives their names, in capitals.
    fn own(&mut self, function: UnitEntryId, routine: &Routine, homes: &Homes) -> BTreeSet<String> {
        let mut seen = BTreeSet::new();
        let mut params = BTreeSet::new();
        for (param, home) in routine.params.iter().zip(&homes.params) {
            let base = match (param.mode, home) {
                (Mode::Value(local), _) => {
                    params.insert(local);
                    Base::Frame(homes.locals[local.index()])
                }
                (Mode::Reference, Some(home)) => Base::Through(*home),
                (Mode::Reference, None) => continue,
            };
            if is_declared(&param.name) && seen.insert(param.name.to_ascii_uppercase()) {
                self.stored(function, DW_TAG_formal_parameter, (&param.name, param.ty), (base, 0));
            }
        }
        for (at, local) in routine.locals.iter().enumerate() {
            let id = LocalId::next(at);
            let is_own = is_declared(&local.name) && !params.contains(&id) && !was_bound(routine, id);
            if is_own && seen.insert(local.name.to_ascii_uppercase()) {
                let place = (Base::Frame(homes.locals[at]), 0);
                self.stored(function, DW_TAG_variable, (&local.name, local.ty), place);
            }
        }
        seen
    }

    fn located(
        &mut self,
        parent: UnitEntryId,
        tag: DwTag,
        (name, ty): (&str, UnitEntryId),
        location: Expression,
    ) -> UnitEntryId {
        let id = self.add_named(parent, tag, name);
        self.set_type(id, ty);
        self.set(id, DW_AT_location, AttributeValue::Exprloc(location));
        id
    }

    fn variable(&mut self, parent: UnitEntryId, tag: DwTag, it: &Variable, scope: Option<(&Routine, &Homes)>) {
        let Some((base, offset)) = self.place(&it.place, scope).filter(|_| is_declared(&it.name)) else { return };
        match it.view {
            None => self.stored(parent, tag, (&it.name, it.place.ty), (base, offset)),
            Some(View { ty: Type::BOOL, bit, .. }) => {
                let ty = self.type_of(Type::BOOL);
                self.located(parent, tag, (&it.name, ty), base.bit(offset, bit, self));
            }
            Some(View { ty, bit, .. }) => self.stored(parent, tag, (&it.name, ty), (base, offset + bit / 8)),
        }
    }

    /// A variable of a type. What a REFERENCE TO leads to has its name, and other references are pointers.
    fn stored(&mut self, parent: UnitEntryId, tag: DwTag, (name, ty): (&str, Type), (base, offset): (Base, u64)) {
        let at = base.at(offset, self);
        let Type::Reference(reference) = ty else {
            let ty = self.type_of(ty);
            self.located(parent, tag, (name, ty), at);
            return;
        };
        let RefType { kind, target } = self.program.references[reference.index()];
        let (ty, location) = match kind {
            RefKind::ReferenceTo => (self.type_of(target), led_to(at, self.state)),
            RefKind::RefTo | RefKind::PointerTo => (self.pointer_to(target), pointer(at, self.state)),
            RefKind::Interface(interface) => match self.leading(interface) {
                Some(classes) => (self.one_of(ty, &classes), instances(&classes, (base, offset), self)),
                None => (self.type_of(ty), at),
            },
        };
        self.located(parent, tag, (name, ty), location);
    }

    /// The classes that a variable of an INTERFACE may lead to, unless there are so many that nobody would read them.
    fn leading(&self, interface: InterfaceId) -> Option<Vec<(u64, StructId)>> {
        const MOST: usize = 32;
        self.program.implementers.get(interface.index()).filter(|it| (1..=MOST).contains(&it.len())).cloned()
    }

    /// What a variable of an INTERFACE is shown as: a pointer for each class, of which one leads somewhere.
    fn one_of(&mut self, ty: Type, classes: &[(u64, StructId)]) -> UnitEntryId {
        if let Some(known) = self.leads.get(&ty) {
            return *known;
        }
        let name = self.program.type_name(ty);
        let id = self.add_named(self.root(), DW_TAG_structure_type, &name);
        self.leads.insert(ty, id);
        let mut size = 0;
        for (_, state) in classes {
            let name = self.program.structure(*state).name.clone();
            let pointer = self.pointer_to(Type::Struct(*state));
            self.member(id, &name, pointer, size);
            size += POINTER;
        }
        self.set(id, DW_AT_byte_size, AttributeValue::Udata(size));
        id
    }

    /// Where a variable is, from where its root is.
    fn place(&self, place: &Place, scope: Option<(&Routine, &Homes)>) -> Option<(Base, u64)> {
        let globals = Type::Struct(self.program.globals);
        let (base, mut offset, mut ty) = match (place.root, scope) {
            (Root::Globals, _) => (Base::State, self.layout.machine.globals, globals),
            (root, Some((routine, homes))) => (base(root, homes)?, 0, self.program.root_type(routine, root)?),
            (Root::Instance | Root::Local(_) | Root::Param(_), None) => return None,
        };
        for projection in &place.projections {
            offset += match (projection, ty) {
                (Projection::Field(id), of) => self.layout.offset(of, *id),
                (Projection::Index { index, .. }, Type::Array(id)) => {
                    constant_position(self.program, index, id)? * self.layout.stride(id)
                }
                (Projection::Index { .. } | Projection::Deref { .. }, _) => return None,
            };
            ty = self.program.part(ty, projection)?;
        }
        Some((base, offset))
    }
}

/// Whether a local has stood for a bound of an `ARRAY[*]`, which is a constant now: `list_low`.
fn was_bound(routine: &Routine, id: LocalId) -> bool {
    let name = &routine.locals[id.index()].name;
    let mut arrays = routine.params.iter().filter(|it| matches!(it.ty, Type::Array(_)));
    if !arrays.any(|it| name.strip_prefix(&it.name).is_some_and(|it| it.starts_with('_'))) {
        return false;
    }
    let mut is_used = routine.result == Some(id);
    visit::statements(&routine.body, &mut |it| {
        visit::accesses(it, &mut |place, _| is_used |= place.root == Root::Local(id));
    });
    !is_used
}

fn base(root: Root, homes: &Homes) -> Option<Base> {
    Some(match root {
        Root::Globals => Base::State,
        Root::Instance => Base::Through(homes.instance?),
        Root::Local(id) => Base::Frame(*homes.locals.get(id.index())?),
        Root::Param(id) => Base::Through((*homes.params.get(id.index())?)?),
    })
}

/// Where the reference leads that is at a place.
fn led_to(mut at: Expression, state: Address) -> Expression {
    at.op_deref();
    followed(&mut at, state);
    at
}

/// The same as a pointer; null leads nowhere.
fn pointer(mut at: Expression, state: Address) -> Expression {
    at.op_deref();
    at.op(DW_OP_dup);
    let leads = at.op_bra();
    let end = at.op_skip();
    let next = at.next_index();
    at.set_target(leads, next);
    followed(&mut at, state);
    let next = at.next_index();
    at.set_target(end, next);
    at.op(DW_OP_stack_value);
    at
}

/// A pointer for each class, in the place of a reference: null for those whose number it does not have.
fn instances(classes: &[(u64, StructId)], (base, offset): (Base, u64), entries: &Entries<'_>) -> Expression {
    let mut all = Expression::new();
    for (number, _) in classes {
        base.begin(offset, entries, &mut all);
        all.op_deref();
        all.op(DW_OP_dup);
        followed(&mut all, entries.state);
        all.op(DW_OP_swap);
        all.op_constu(CLASS.into());
        all.op(DW_OP_shr);
        all.op_constu(*number);
        all.op(DW_OP_eq);
        all.op(DW_OP_mul);
        all.op(DW_OP_stack_value);
        all.op_piece(POINTER);
    }
    all
}

/// The address in a reference is that in the state.
fn followed(at: &mut Expression, state: Address) {
    at.op_constu(u64::from(u32::MAX));
    at.op(DW_OP_and);
    at.op_constu(u64::from(ORIGIN));
    at.op(DW_OP_minus);
    at.op_addr(state);
    at.op_deref();
    at.op(DW_OP_plus);
}

impl Base {
    fn at(self, offset: u64, entries: &Entries<'_>) -> Expression {
        let mut it = Expression::new();
        self.begin(offset, entries, &mut it);
        it
    }

    fn begin(self, offset: u64, entries: &Entries<'_>, it: &mut Expression) {
        match self {
            Self::State => {
                it.op_addr(entries.state);
                it.op_deref();
            }
            Self::Frame(home) => it.op_fbreg(home),
            Self::Through(home) => {
                it.op_fbreg(home);
                it.op_deref();
            }
        }
        if offset > 0 {
            it.op_plus_uconst(offset);
        }
    }

    /// The value of a single bit.
    fn bit(self, offset: u64, bit: u64, entries: &Entries<'_>) -> Expression {
        let mut it = self.at(offset + bit / 8, entries);
        it.op_deref_size(1);
        it.op_constu(bit % 8);
        it.op(DW_OP_shr);
        it.op_constu(1);
        it.op(DW_OP_and);
        it.op(DW_OP_stack_value);
        it
    }
}

impl Listed {
    /// From the first byte of its variables to the end of the last.
    fn extent(&self, layout: &Layout) -> (u64, u64) {
        let own = self.variables.values().map(|(ty, offset)| (*offset, offset + layout.size(*ty)));
        let inner = self.lists.values().map(|it| it.extent(layout));
        let all = own.chain(inner).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        all.unwrap_or_default()
    }

    fn add(&mut self, path: &str, place: (Type, u64)) {
        match path.split_once('.') {
            None => {
                self.variables.insert(path.to_owned(), place);
            }
            Some((list, rest)) => self.lists.entry(list.to_owned()).or_default().add(rest, place),
        }
    }
}
