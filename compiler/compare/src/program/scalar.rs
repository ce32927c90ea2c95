//! The scalars of a program's state, by paths that two systems share.

mod shared;

use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{ArrayId, BlockId, FieldId, HELD_PROGRAM, Program, Retain, Section, StructId, Type, Value};
use staunch_runtime::reference::{ORIGIN, Reference};
use staunch_runtime::{Direction, Pin, PinRole};

/// Further elements of an array are not compared.
const MAX_ELEMENTS: u64 = 1024;
/// Further scalars of a program are not compared.
const MAX_SCALARS: usize = 1 << 16;

/// A scalar or a string.
#[derive(Clone, Debug)]
pub struct Scalar {
    /// As a user writes it.
    pub path: String,
    /// The same on both systems, whatever they call a pin.
    pub key: String,
    pub ty: Type,
    pub offset: usize,
    pub size: usize,
    pub role: Role,
    /// The innermost declared variable or member that it is, or is an element of; no pin is one.
    pub field: Option<(StructId, FieldId)>,
    /// The members from the PROGRAM's state, or from the globals, down to it.
    pub way: Way,
    pub at: Whereabouts,
    /// Its bytes are bits that others share: a string is stored there without its length, up to a zero.
    pub is_shared: bool,
}

/// Members from a structure down to a variable; elements of arrays are not distinguished.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Way {
    pub from: StructId,
    pub members: Vec<FieldId>,
}

impl Way {
    /// Whether one is of the other, or is the same.
    pub fn meets(&self, other: &Self) -> bool {
        self.from == other.from && self.members.iter().zip(&other.members).all(|(a, b)| a == b)
    }
}

/// What is known of a variable by where it is declared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Whereabouts {
    /// An output of a PROGRAM, or a variable at `%Q`.
    pub is_output: bool,
    /// In an instance of a FUNCTION_BLOCK.
    pub is_inner: bool,
    /// Declared RETAIN, itself or with what it is in.
    pub is_retained: bool,
    /// In a standard block that is itself an input.
    pub is_given: bool,
    /// Of an array or structure that nothing outside can be meant to write, since it has no address and is not RETAIN:
    /// how many members lead to the whole of it.
    pub table: Option<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The world outside writes it.
    Input,
    /// A variable of the program.
    Variable,
    /// An output of the standard block at this position of [`Scalars::blocks`].
    Output(usize),
    /// Another pin or the memory of a standard block, or a constant.
    Hidden,
}

/// An instance of a standard block.
#[derive(Clone, Debug)]
pub struct Instance {
    pub path: String,
    pub key: String,
    pub block: BlockId,
    pub offset: usize,
    /// Its declaration, or that of the array that it is in.
    pub field: Option<(StructId, FieldId)>,
}

#[derive(Clone, Debug, Default)]
pub struct Scalars {
    pub all: Vec<Scalar>,
    pub blocks: Vec<Instance>,
    /// There are more than are listed.
    pub truncated: bool,
    /// Where each lies, in the order of the state.
    by_offset: Vec<(usize, usize)>,
}

/// What is handed down from a variable to its parts.
#[derive(Clone)]
struct Whole {
    offset: usize,
    role: Role,
    field: Option<(StructId, FieldId)>,
    way: Way,
    at: Whereabouts,
    is_shared: bool,
}

struct Walk<'p> {
    program: &'p Program,
    layout: Layout,
    found: Scalars,
}

impl Scalars {
    /// Of all running instances and the globals, in the order of their declaration.
    pub fn of(program: &Program) -> Self {
        let layout = Layout::new(program);
        let machine = layout.machine.clone();
        let mut walk = Walk { program, layout, found: Self::default() };
        for (instance, offset) in program.instances.iter().zip(&machine.instances) {
            let prefix = if program.instances.len() > 1 { format!("{}.", instance.name) } else { String::new() };
            let state = program.class(instance.program).state;
            walk.structure(&prefix, state, usize_of(*offset), &Way { from: state, members: Vec::new() });
        }
        let globals = program.globals;
        walk.structure("", globals, usize_of(machine.globals), &Way { from: globals, members: Vec::new() });
        let mut found = walk.found;
        found.by_offset = found.all.iter().enumerate().map(|(at, it)| (it.offset, at)).collect();
        found.by_offset.sort_unstable();
        found
    }

    /// What a reference leads to, and how many bytes into it: two programs number and place their variables for themselves.
    pub(super) fn denoted(&self, bytes: &[u8]) -> Option<(&Scalar, usize)> {
        let bits = u64::from_ne_bytes(bytes.try_into().ok()?);
        let address = usize_of(Reference::from_bits(bits).address.into());
        let offset = address.checked_sub(usize_of(ORIGIN.into()))?;
        let at = self.by_offset.partition_point(|it| it.0 <= offset).checked_sub(1)?;
        let scalar = &self.all[self.by_offset[at].1];
        Some((scalar, offset - scalar.offset))
    }
}

impl Walk<'_> {
    /// The members of a PROGRAM or of the globals, `to` which a way leads.
    fn structure(&mut self, prefix: &str, id: StructId, base: usize, to: &Way) {
        for (at, field) in self.program.structure(id).fields.iter().enumerate() {
            let number = FieldId::next(at);
            let mut way = to.clone();
            way.members.push(number);
            if let (Type::Struct(program), true) = (field.ty, field.name == HELD_PROGRAM) {
                let base = base + usize_of(self.layout.field(id, number));
                self.structure(prefix, program, base, &way);
                continue;
            }
            let from_outside =
                field.section == Section::Input || field.address.is_some_and(|it| it.area == staunch_ir::Area::Input);
            // What the compiler adds is nobody's variable.
            let is_hidden = field.constant || field.name.starts_with("__");
            let role = match (is_hidden, from_outside) {
                (true, _) => Role::Hidden,
                (false, true) => Role::Input,
                (false, false) => Role::Variable,
            };
            let offset = base + usize_of(self.layout.field(id, number));
            let path = format!("{prefix}{}", field.name);
            let at_output = field.address.is_some_and(|it| it.area == staunch_ir::Area::Output);
            let at = Whereabouts {
                is_output: field.section == Section::Output || at_output,
                is_inner: false,
                is_retained: field.retain == Retain::Kept,
                is_given: false,
                table: None,
            };
            let mut whole = Whole { offset, role, field: Some((id, number)), way, at, is_shared: false };
            let views = self.views_of_global(id, number);
            let is_ours = field.address.is_none() && views.is_empty() && field.retain != Retain::Kept;
            if is_ours && matches!(field.ty, Type::Array(_) | Type::Struct(_)) {
                whole.at.table = Some(whole.way.members.len());
            }
            if !views.is_empty() {
                let area = |area| views.iter().any(|it| it.area == Some(area));
                whole.at.is_output |= area(staunch_ir::Area::Output);
                if role == Role::Variable && area(staunch_ir::Area::Input) {
                    whole.role = Role::Input;
                }
            }
            self.kept(&path, field.ty, &views, whole);
        }
    }

    /// For how long a step of a chart is active counts where something asks for it: in `openplc` it lacks a nanosecond at times.
    fn is_time_of_a_step(&self, id: StructId, name: &str) -> bool {
        ["__Step", "__MatiecStep"].contains(&self.program.structure(id).name.as_str()) && name == "T"
    }

    fn part(&mut self, path: &str, ty: Type, whole: Whole) {
        match ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => {
                self.scalar(path, path, ty, whole)
            }
            Type::Array(id) => self.array(path, id, whole),
            Type::Struct(id) => self.members(path, id, whole),
            Type::Block(id) => self.block(path, id, whole),
        }
    }

    fn scalar(&mut self, path: &str, key: &str, ty: Type, whole: Whole) {
        if self.found.all.len() >= MAX_SCALARS {
            self.found.truncated = true;
            return;
        }
        let Whole { offset, role, field, way, at, is_shared } = whole;
        let whole_from = way.from;
        let size = if is_shared { shared::size(ty) } else { None };
        let size = size.unwrap_or_else(|| usize_of(self.layout.size(ty)));
        let (path, key) = (path.to_owned(), self.key(key, whole_from));
        self.found.all.push(Scalar { path, key, ty, offset, size, role, field, way, at, is_shared });
    }

    /// The name by which the two systems' variables are matched: a local one may be called as a global one is.
    fn key(&self, path: &str, from: StructId) -> String {
        let path = path.to_ascii_lowercase();
        if from == self.program.globals { format!("globals.{path}") } else { path }
    }

    fn array(&mut self, path: &str, id: ArrayId, whole: Whole) {
        let array = self.program.array(id);
        self.found.truncated |= array.len() > MAX_ELEMENTS;
        let stride = usize_of(self.layout.stride(id));
        let mut offset = whole.offset;
        for index in (array.low..=array.high).take(usize_of(MAX_ELEMENTS.min(array.len()))) {
            self.part(&format!("{path}[{index}]"), array.element, Whole { offset, ..whole.clone() });
            offset += stride;
        }
    }

    fn members(&mut self, path: &str, id: StructId, whole: Whole) {
        let is_class = self.program.classes.iter().any(|it| it.state == id);
        let is_inner = whole.at.is_inner || is_class;
        for (at, field) in self.program.structure(id).fields.iter().enumerate() {
            // Of an instance, no one but itself writes what is neither input nor output.
            let is_inside = is_class && !matches!(field.section, Section::Input | Section::Output);
            let role = match whole.role {
                _ if field.constant || self.is_time_of_a_step(id, &field.name) => Role::Hidden,
                Role::Input if is_inside => Role::Variable,
                role => role,
            };
            let number = FieldId::next(at);
            let offset = whole.offset + usize_of(self.layout.field(id, number));
            let is_retained = match field.retain {
                Retain::Inherited => whole.at.is_retained,
                Retain::Kept => true,
                Retain::Anew => false,
            };
            let table = whole.at.table.filter(|_| !is_class && !is_retained);
            let at = Whereabouts { is_inner, is_retained, table, ..whole.at };
            let mut way = whole.way.clone();
            way.members.push(number);
            let field_of = Some((id, number));
            let views = self.views_of_member(path, id, number);
            let whole = Whole { offset, role, field: field_of, way, at, is_shared: whole.is_shared };
            self.kept(&format!("{path}.{}", field.name), field.ty, &views, whole);
        }
    }

    fn block(&mut self, path: &str, id: BlockId, whole: Whole) {
        let number = self.found.blocks.len();
        let key = self.key(path, whole.way.from);
        let Whole { offset, field, .. } = whole.clone();
        self.found.blocks.push(Instance { path: path.to_owned(), key: key.clone(), block: id, offset, field });
        for (at, pin) in id.info().pins.iter().enumerate() {
            let Some(ty) = id.pin_type(FieldId::next(at)) else { continue };
            let role = match (shows(pin), whole.role) {
                (true, _) => Role::Output(number),
                // A block that is itself an input is given what its pins take.
                (false, Role::Input) if pin.direction == Direction::Input => Role::Input,
                (false, _) => Role::Hidden,
            };
            let at = Whereabouts { is_given: whole.role == Role::Input, ..whole.at };
            let part = Whole {
                offset: whole.offset + pin.offset,
                role,
                field: None,
                way: whole.way.clone(),
                at,
                is_shared: false,
            };
            self.scalar(&format!("{path}.{}", pin.name), &format!("{path}.{}", common_key(pin)), ty, part);
        }
    }
}

impl Scalar {
    /// The name with the NAMESPACE or list, of a global variable that is in one.
    pub fn full_name(&self, program: &Program) -> Option<String> {
        program.global_paths.iter().filter(|_| self.way.from == program.globals).find_map(|(short, full)| {
            let rest = self.path.strip_prefix(short.as_str())?;
            (rest.is_empty() || rest.starts_with(['.', '['])).then(|| format!("{full}{rest}"))
        })
    }
}

/// Whether a pin shows what the block has done.
fn shows(pin: &Pin) -> bool {
    let tells = matches!(pin.role, Some(PinRole::Done | PinRole::Empty | PinRole::Count));
    pin.direction == Direction::Output || tells && pin.direction == Direction::Member
}

/// What a pin's counterparts share: its role, which no name of a pin looks like, or its name.
fn common_key(pin: &Pin) -> String {
    pin.role.map_or_else(|| pin.name.to_owned(), |role| format!("<{role:?}>"))
}

impl Instance {
    /// Whether it is a counter.
    pub fn counts(&self) -> bool {
        self.has(PinRole::Count)
    }

    pub fn has(&self, role: PinRole) -> bool {
        self.block.info().pin_for(role).is_some()
    }

    /// Whether the other system calls a pin of it otherwise.
    pub fn is_renamed(&self, other: &Self) -> bool {
        let there = other.block.info();
        self.block.info().pins.iter().any(|it| there.pin(it.name).is_none())
    }

    /// The value of the pin with a role.
    pub fn pin(&self, role: PinRole, state: &[u8]) -> Option<i128> {
        let pin = self.block.info().pin_for(role)?;
        as_number(Value::read(pin.repr(), &state[self.offset + pin.offset..]))
    }
}

/// A BOOL counts as 0 or 1.
pub(super) fn as_number(value: Value) -> Option<i128> {
    match value {
        Value::Bool(it) => Some(i128::from(it)),
        other => other.as_integer(),
    }
}
