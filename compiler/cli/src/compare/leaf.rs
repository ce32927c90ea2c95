//! The scalars of a program's state, by paths that two systems share.

use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::visit::{self, Access};
use staunch_ir::{ArrayId, BlockId, Elementary, FieldId, Program, Retain, Section, StructId, Type, Value};
use staunch_runtime::{Direction, Pin, PinRole, Retention};

/// Further elements of an array are not compared.
const MAX_ELEMENTS: u64 = 1024;
/// Further scalars of a program are not compared.
const MAX_LEAVES: usize = 1 << 16;

/// A scalar or a string.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// As a user writes it.
    pub path: String,
    /// The same on both systems, whatever they call a pin.
    pub key: String,
    pub ty: Type,
    pub offset: usize,
    pub size: usize,
    pub role: Role,
    /// It keeps its value over a restart.
    pub retain: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The world outside writes it.
    Input,
    /// A variable of the program; for a PROGRAM's own or a global, its structure and field.
    Variable(Option<(StructId, FieldId)>),
    /// An output of the standard block at this position of [`Leaves::blocks`].
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
}

#[derive(Clone, Debug, Default)]
pub struct Leaves {
    pub all: Vec<Leaf>,
    pub blocks: Vec<Instance>,
}

/// What is handed down from a variable to its parts.
#[derive(Clone, Copy)]
struct Whole {
    offset: usize,
    role: Role,
    retain: Retain,
}

struct Walk<'p> {
    program: &'p Program,
    layout: Layout,
    found: Leaves,
}

impl Leaves {
    /// Of all running instances and the globals, in the order of their declaration.
    pub fn of(program: &Program) -> Self {
        let layout = Layout::new(program);
        let machine = layout.machine.clone();
        let mut walk = Walk { program, layout, found: Self::default() };
        for (instance, offset) in program.instances.iter().zip(&machine.instances) {
            let prefix = if program.instances.len() > 1 { format!("{}.", instance.name) } else { String::new() };
            walk.structure(&prefix, program.class(instance.program).state, usize_of(*offset));
        }
        walk.structure("", program.globals, usize_of(machine.globals));
        walk.found
    }
}

impl Walk<'_> {
    /// The members of a PROGRAM or of the globals.
    fn structure(&mut self, prefix: &str, id: StructId, base: usize) {
        for (at, field) in self.program.structure(id).fields.iter().enumerate() {
            let number = FieldId::next(at);
            let from_outside =
                field.section == Section::Input || field.address.is_some_and(|it| it.area == staunch_ir::Area::Input);
            let role = match (field.constant, from_outside) {
                (true, _) => Role::Hidden,
                (false, true) => Role::Input,
                (false, false) => Role::Variable(Some((id, number))),
            };
            let offset = base + usize_of(self.layout.field(id, number));
            let path = format!("{prefix}{}", field.name);
            self.part(&path, field.ty, Whole { offset, role, retain: field.retain });
        }
    }

    fn part(&mut self, path: &str, ty: Type, whole: Whole) {
        match ty {
            Type::Elementary(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => {
                self.leaf(path, path, ty, whole)
            }
            Type::Array(id) => self.array(path, id, whole),
            Type::Struct(id) => self.members(path, id, whole),
            Type::Block(id) => self.block(path, id, whole),
        }
    }

    fn leaf(&mut self, path: &str, key: &str, ty: Type, whole: Whole) {
        if self.found.all.len() >= MAX_LEAVES {
            return;
        }
        let Whole { offset, role, retain } = whole;
        let size = usize_of(self.layout.size(ty));
        let (path, key, retain) = (path.to_owned(), key.to_ascii_lowercase(), retain == Retain::Kept);
        self.found.all.push(Leaf { path, key, ty, offset, size, role, retain });
    }

    fn array(&mut self, path: &str, id: ArrayId, whole: Whole) {
        let array = self.program.array(id);
        let stride = usize_of(self.layout.stride(id));
        let role = part_of(whole.role);
        let mut offset = whole.offset;
        for index in (array.low..=array.high).take(usize_of(MAX_ELEMENTS.min(array.len()))) {
            self.part(&format!("{path}[{index}]"), array.element, Whole { offset, role, ..whole });
            offset += stride;
        }
    }

    fn members(&mut self, path: &str, id: StructId, whole: Whole) {
        for (at, field) in self.program.structure(id).fields.iter().enumerate() {
            let role = if field.constant { Role::Hidden } else { part_of(whole.role) };
            let offset = whole.offset + usize_of(self.layout.field(id, FieldId::next(at)));
            let retain = field.retain.within(whole.retain);
            self.part(&format!("{path}.{}", field.name), field.ty, Whole { offset, role, retain });
        }
    }

    fn block(&mut self, path: &str, id: BlockId, whole: Whole) {
        let (number, info) = (self.found.blocks.len(), id.info());
        let key = path.to_ascii_lowercase();
        self.found.blocks.push(Instance { path: path.to_owned(), key: key.clone(), block: id, offset: whole.offset });
        for (at, pin) in info.pins.iter().enumerate() {
            let Some(ty) = id.pin_type(FieldId::next(at)) else { continue };
            let role = if shows(pin) { Role::Output(number) } else { Role::Hidden };
            let retain = match info.retention {
                Retention::Always => Retain::Kept,
                it if it.restarts(pin) => Retain::Anew,
                Retention::Declared | Retention::Inputs => whole.retain,
            };
            let part = Whole { offset: whole.offset + pin.offset, role, retain };
            self.leaf(&format!("{path}.{}", pin.name), &format!("{key}.{}", common_key(pin)), ty, part);
        }
    }
}

/// An element of an input is one too; an element of a variable is not assigned as a whole.
fn part_of(role: Role) -> Role {
    match role {
        Role::Variable(_) => Role::Variable(None),
        Role::Input | Role::Output(_) | Role::Hidden => role,
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
    /// The value of the pin with a role.
    pub fn pin(&self, role: PinRole, state: &[u8]) -> Option<i128> {
        let pin = self.block.info().pin_for(role)?;
        number(Value::read(pin.lane(), &state[self.offset + pin.offset..]))
    }
}

/// A BOOL counts as 0 or 1.
fn number(value: Value) -> Option<i128> {
    match value {
        Value::Bool(it) => Some(i128::from(it)),
        other => other.as_integer(),
    }
}

/// Whether two systems hold the same value, by its number and not by its bits.
pub fn equal(programs: [&Program; 2], leaves: [&Leaf; 2], states: [&[u8]; 2]) -> bool {
    let [a, b] = [0, 1].map(|side| &states[side][leaves[side].offset..leaves[side].offset + leaves[side].size]);
    let lanes = [0, 1].map(|side| programs[side].lane(leaves[side].ty));
    match lanes {
        [Some(x), Some(y)] if x != y => {
            let (a, b) = (Value::read(x, a), Value::read(y, b));
            number(a).is_some() && number(a) == number(b)
        }
        [Some(_), Some(_)] => a == b,
        _ => a == b || text(a) == text(b),
    }
}

fn text(bytes: &[u8]) -> &[u8] {
    let Some((length, rest)) = bytes.split_first_chunk::<2>() else { return bytes };
    rest.get(..usize::from(u16::from_ne_bytes(*length))).unwrap_or(rest)
}

/// The value as a trace shows it.
pub fn show(program: &Program, leaf: &Leaf, state: &[u8]) -> String {
    let bytes = &state[leaf.offset..leaf.offset + leaf.size];
    match (leaf.ty, program.lane(leaf.ty)) {
        (Type::Enum(id), Some(lane)) => {
            let value = Value::read(lane, bytes);
            let named = program.enumeration(id).values.iter().find(|it| it.value == value);
            named.map_or_else(|| spell(value), |it| it.name.clone())
        }
        (Type::Elementary(it) | Type::Subrange(it, _), Some(lane)) => match Value::read(lane, bytes) {
            Value::I64(time) if it.is_time() => staunch_host::format_time(time),
            value => spell(value),
        },
        _ => String::from_utf8_lossy(text(bytes)).into_owned(),
    }
}

fn spell(value: Value) -> String {
    match value {
        Value::Bool(it) => if it { "TRUE" } else { "FALSE" }.to_owned(),
        Value::F32(it) => format!("{it:?}"),
        Value::F64(it) => format!("{it:?}"),
        other => other.as_integer().map_or_else(String::new, |it| it.to_string()),
    }
}

/// The PROGRAMs' and globals' variables that some statement writes.
pub fn written(program: &Program) -> Vec<(StructId, FieldId)> {
    let mut found = Vec::new();
    for routine in &program.routines {
        writes(program, routine, &routine.body, &mut found);
    }
    found
}

fn writes(
    program: &Program,
    routine: &staunch_ir::Routine,
    block: &[staunch_ir::Statement],
    found: &mut Vec<(StructId, FieldId)>,
) {
    visit::statements(block, &mut |statement| {
        visit::accesses(statement, &mut |place, access| {
            let owner = match place.root {
                staunch_ir::Root::Instance => routine.state,
                staunch_ir::Root::Globals => Some(program.globals),
                staunch_ir::Root::Local(_) | staunch_ir::Root::Param(_) => None,
            };
            if let (Access::Write | Access::Borrow, Some(owner), Some(staunch_ir::Projection::Field(field))) =
                (access, owner, place.projections.first())
            {
                found.push((owner, *field));
            }
        });
    });
}

/// Values of an input that are worth trying, the initial one first.
pub fn interesting(program: &Program, leaf: &Leaf, initial: Value) -> Vec<Value> {
    let mut values = vec![initial];
    let more: Vec<Value> = match (leaf.ty, program.lane(leaf.ty)) {
        (Type::Enum(id), _) => program.enumeration(id).values.iter().map(|it| it.value).collect(),
        (Type::Elementary(Elementary::Bool), _) => vec![Value::Bool(false), Value::Bool(true)],
        (Type::Elementary(it), _) if it.is_time() => [0, 10_000_000, 1_000_000_000].map(Value::I64).to_vec(),
        (Type::Elementary(Elementary::Real), _) => [0.0, 1.0, -1.0].map(Value::F32).to_vec(),
        (Type::Elementary(Elementary::Lreal), _) => [0.0, 1.0, -1.0].map(Value::F64).to_vec(),
        (Type::Elementary(_) | Type::Subrange(..), Some(lane)) => {
            let (low, high) = program.range(leaf.ty).or(lane.range()).unwrap_or((0, 0));
            let inside = [1, 2, 3, 0, -1, high, low].into_iter().filter(|it| (low..=high).contains(it));
            inside.filter_map(|it| lane.integer(it)).collect()
        }
        _ => Vec::new(),
    };
    values.extend(more);
    let mut kept: Vec<Value> = Vec::new();
    for value in values {
        if !kept.contains(&value) {
            kept.push(value);
        }
    }
    kept
}
