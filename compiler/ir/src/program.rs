//! A whole program: its types, globals, classes, routines and instances.

use crate::types::ids;

use crate::{
    Array, ArrayId, Block, BoundsId, Const, Enum, EnumId, Location, Place, Projection, RefKind, RefType, ReferenceId,
    Root, StatementKind, Struct, StructId, Type, Uses, visit,
};
use core::fmt;
use staunch_runtime::Family;
use std::collections::BTreeSet;

ids! {
    ClassId;
    RoutineId;
    LocalId;
    ParamId;
    /// Position of a field in its structure, or of a pin in its standard block.
    FieldId;
    /// Index into the front end's table of the variables and members that the source declares.
    DeclarationId;
}

/// A whole checked program.
#[derive(Clone, Debug)]
pub struct Program {
    /// What `Location::file` counts.
    pub files: Vec<SourceFile>,
    pub enums: Vec<Enum>,
    /// The lower and upper limits of subranges, each pair once.
    pub bounds: Vec<(i128, i128)>,
    /// The least and the greatest TIME in milliseconds, where a TIME is a number of those; any nanoseconds without.
    pub milliseconds: Option<(i64, i64)>,
    /// Lines of the map of a project: the servers that a host reads inputs from, and writes outputs to.
    pub remotes: Vec<String>,
    pub arrays: Vec<Array>,
    /// The names of the INTERFACEs.
    pub interfaces: Vec<String>,
    /// Of each INTERFACE, the classes that something refers to, by the number that a reference has for it: their states.
    pub implementers: Vec<Vec<(u64, StructId)>>,
    /// The types of references. What they point to may be after what holds them.
    pub references: Vec<RefType>,
    /// A structure is after those it contains.
    pub structs: Vec<Struct>,
    /// The structure that holds the global variables; it may be empty.
    pub globals: StructId,
    /// Other names of global variables: a direct address that is declared again.
    pub aliases: Vec<Variable>,
    /// Of global variables that are in a NAMESPACE or a list: the name here, and that in full, `Plant.Panel.start`.
    pub global_paths: Vec<(String, String)>,
    /// What a VAR_CONFIG binds to inputs.
    pub bound: Vec<Bound>,
    pub classes: Vec<Class>,
    /// The states that METHODs or ACTIONs work on: while one routine of an instance runs, what it calls may
    /// come back to the instance by another.
    pub reentered: BTreeSet<StructId>,
    pub reach: Reach,
    /// Which variables references may lead to; `None` before all bodies are there.
    pub reached: Option<crate::reached::Reached>,
    /// Structures that are the places of pools: the first field says whether the second is an object in use. A reference
    /// into an object that is not is a fault.
    pub places: BTreeSet<StructId>,
    /// What the source uses that systems may compute otherwise.
    pub uses: Uses,
    /// In an order in which a callee is before its callers.
    pub routines: Vec<Routine>,
    /// The programs that run, in order.
    pub instances: Vec<Instance>,
    /// A CONFIGURATION says which these are.
    pub is_configured: bool,
}

/// A variable into which the value at an input's address is copied before each scan.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Of the PROGRAM whose instances hold it, unless the globals do.
    pub state: Option<StructId>,
    pub variable: Place,
    pub address: Address,
}

/// Who besides a class's own routines may write the variables of its instances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reach {
    /// Who has a reference to them: the program has references.
    pub references: bool,
    /// Who assigns an instance as a whole, or what holds one, or what is in one: the program does so.
    pub copies: bool,
}

#[derive(Clone, Debug)]
pub struct SourceFile {
    /// As the user named it.
    pub path: String,
    /// The system whose rules hold for what it declares.
    pub system: Family,
}

/// One running PROGRAM.
#[derive(Clone, Debug)]
pub struct Instance {
    pub name: String,
    pub program: ClassId,
    /// The TASK that runs it, where the source has one.
    pub task: Option<String>,
    /// Nanoseconds between two scans, where the source has a TASK that says so.
    pub interval: Option<i64>,
    /// Lower runs first among instances that are due together.
    pub priority: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClassKind {
    Program,
    FunctionBlock,
}

/// A PROGRAM or FUNCTION_BLOCK: the state that its instances have, and the routines that work on it.
#[derive(Clone, Debug)]
pub struct Class {
    pub kind: ClassKind,
    pub name: String,
    pub doc: Option<String>,
    pub location: Location,
    pub state: StructId,
    /// Every declared variable, in declaration order, for traces and emitted documentation.
    pub variables: Vec<Variable>,
    /// What a call of an instance runs.
    pub body: RoutineId,
    /// Runs at the start of the first scan, before the body of a PROGRAM: what some systems do to
    /// counters at a restart. It covers the instances that the state contains.
    pub prescan: Option<RoutineId>,
    /// Of a PROGRAM with instances that have a start: a METHOD that starts them, if that has not been done. The body calls
    /// it; where several PROGRAMs run, all of theirs run before the first scan of any.
    pub start: Option<RoutineId>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RoutineKind {
    Function,
    /// The body of a PROGRAM or FUNCTION_BLOCK.
    Body,
    /// The prescan of a class; it has no parameters.
    Prescan,
    /// A METHOD of a class, or an ACTION, which has the parameters of the body.
    Method,
}

/// Something that is called: parameters, variables that live for one call, and statements.
#[derive(Clone, Debug)]
pub struct Routine {
    pub kind: RoutineKind,
    /// Of the FUNCTION or METHOD, or of the class.
    pub name: String,
    pub doc: Option<String>,
    pub location: Location,
    /// The state of the instance that it works on; a FUNCTION has none.
    pub state: Option<StructId>,
    /// What a caller passes at each call: the inputs, outputs and in-outs of a FUNCTION or METHOD, a
    /// FUNCTION_BLOCK's in-outs.
    pub params: Vec<Param>,
    /// They start at their initial values.
    pub locals: Vec<Local>,
    /// The result of a FUNCTION or METHOD: one of `locals`.
    pub result: Option<LocalId>,
    pub body: Block,
}

#[derive(Clone, Debug)]
pub struct Param {
    pub name: String,
    pub ty: Type,
    pub doc: Option<String>,
    pub mode: Mode,
    /// Of an `ARRAY[*]`: for each dimension, the DINT locals that stand for its lower and its upper bound.
    pub bounds: Vec<(LocalId, LocalId)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The callee has its own copy, in this local.
    Value(LocalId),
    /// The callee works on the caller's variable.
    Reference,
}

#[derive(Clone, Debug)]
pub struct Local {
    /// As declared, or a made-up one for a temporary.
    pub name: String,
    pub ty: Type,
    pub initial: Const,
    pub doc: Option<String>,
}

/// The field of a run that is more than a PROGRAM's body: the PROGRAM that it holds. A keyword, which no
/// declaration can take.
pub const HELD_PROGRAM: &str = "PROGRAM";

/// A field of a structure, or a variable of a PROGRAM, FUNCTION_BLOCK or of the globals.
#[derive(Clone, Debug)]
pub struct Field {
    /// The declaration's spelling.
    pub name: String,
    pub ty: Type,
    pub initial: Const,
    pub section: Section,
    pub retain: Retain,
    /// Never written.
    pub constant: bool,
    pub address: Option<Address>,
    pub doc: Option<String>,
    pub location: Location,
    /// Which of the front end's declarations it is: the location is for people, and its column ends at 65,535.
    pub declared: Option<DeclarationId>,
}

/// What a declaration says of a restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Retain {
    /// It goes as what it is a part of; alone it starts anew.
    #[default]
    Inherited,
    /// RETAIN, or PERSISTENT: it is kept.
    Kept,
    /// NON_RETAIN: it starts anew, also inside of what is kept.
    Anew,
}

impl Retain {
    /// What holds for a part of something.
    #[must_use]
    pub fn within(self, whole: Self) -> Self {
        match self {
            Self::Inherited => whole,
            Self::Kept | Self::Anew => self,
        }
    }
}

/// Where a variable was declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Section {
    Input,
    Output,
    InOut,
    /// VAR, and a structure's members.
    Internal,
    Temp,
    Global,
    External,
}

/// A name under which a routine knows some storage.
#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub section: Section,
    pub place: Place,
    /// It is some of the place's bits, which others share.
    pub view: Option<View>,
}

/// Bits of a place that holds an integer, a bit string, or an array of them. The lowest come first, also
/// in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// BOOL for a single bit; else any type but subranges, references and instances, or what holds them.
    pub ty: Type,
    /// The first bit.
    pub bit: u64,
    pub address: Address,
}

/// A direct address, `%QX1.3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Address {
    pub area: Area,
    pub module: Module,
    /// First bit in the area, or in the module's part of it.
    pub bit: u64,
    /// Number of bits.
    pub width: u8,
}

/// The numbers before the place in an address of a hierarchy, the highest level first: 1 and 2 in `%IW1.2.3`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Module {
    numbers: [u32; Self::LEVELS],
    count: u8,
}

impl Module {
    /// The levels above the place are at most so many.
    pub const LEVELS: usize = 6;

    /// `None` where there are more levels.
    pub fn new(levels: &[u32]) -> Option<Self> {
        let mut numbers = [0; Self::LEVELS];
        numbers.get_mut(..levels.len())?.copy_from_slice(levels);
        Some(Self { numbers, count: u8::try_from(levels.len()).ok()? })
    }

    pub fn levels(&self) -> &[u32] {
        &self.numbers[..usize::from(self.count)]
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Area {
    Input,
    Output,
    Memory,
}

impl Program {
    /// What is to run before any PROGRAM does: for those that run, by their numbers, what starts their instances. One that
    /// runs alone does it itself.
    pub fn starts(&self) -> Vec<(usize, RoutineId)> {
        let starts = self.instances.iter().enumerate().filter_map(|(at, it)| Some((at, self.class(it.program).start?)));
        if self.instances.len() > 1 { starts.collect() } else { Vec::new() }
    }

    /// Whether a routine handles faults, so that a scan may continue after one: turns that a loop has had are taken then
    /// wherever it faults.
    pub fn handles_faults(&self) -> bool {
        let mut found = false;
        for routine in &self.routines {
            visit::statements(&routine.body, &mut |it| found |= matches!(it.kind, StatementKind::Try { .. }));
        }
        found
    }

    pub fn enumeration(&self, id: EnumId) -> &Enum {
        &self.enums[id.index()]
    }

    pub fn bounds(&self, id: BoundsId) -> (i128, i128) {
        self.bounds[id.index()]
    }

    /// The limits of a subrange.
    pub fn range(&self, ty: Type) -> Option<(i128, i128)> {
        match ty {
            Type::Subrange(_, id) => Some(self.bounds(id)),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => None,
        }
    }

    /// What a reference is declared to point to.
    pub fn target(&self, id: ReferenceId) -> Type {
        self.references[id.index()].target
    }

    /// Whether the type is an `ARRAY[*]`.
    pub fn is_open(&self, ty: Type) -> bool {
        matches!(ty, Type::Array(id) if self.array(id).is_open())
    }

    pub fn array(&self, id: ArrayId) -> Array {
        self.arrays[id.index()]
    }

    pub fn structure(&self, id: StructId) -> &Struct {
        &self.structs[id.index()]
    }

    pub fn routine(&self, id: RoutineId) -> &Routine {
        &self.routines[id.index()]
    }

    pub fn class(&self, id: ClassId) -> &Class {
        &self.classes[id.index()]
    }

    /// The class whose instances have the state `id`, if it is not a user's structure.
    pub fn class_of_state(&self, id: StructId) -> Option<&Class> {
        self.classes.iter().find(|class| class.state == id)
    }

    /// What a routine is called for people: `Class.Method`.
    pub fn title(&self, routine: &Routine) -> String {
        match routine.kind {
            RoutineKind::Function | RoutineKind::Body => routine.name.clone(),
            RoutineKind::Prescan => format!("{} (prescan)", routine.name),
            RoutineKind::Method => match routine.state.and_then(|it| self.class_of_state(it)) {
                Some(class) => format!("{}.{}", class.name, routine.name),
                None => routine.name.clone(),
            },
        }
    }

    /// The type of a place's root in a routine; `None` when the routine has no such storage.
    pub fn root_type(&self, routine: &Routine, root: Root) -> Option<Type> {
        match root {
            Root::Instance => routine.state.map(Type::Struct),
            Root::Globals => Some(Type::Struct(self.globals)),
            Root::Local(id) => routine.locals.get(id.index()).map(|local| local.ty),
            Root::Param(id) => routine.params.get(id.index()).map(|param| param.ty),
        }
    }

    /// The type of a structure's field or a standard block's pin; `None` for any other type, or
    /// if the type does not have the member.
    pub fn member(&self, ty: Type, id: FieldId) -> Option<Type> {
        match ty {
            Type::Struct(structure) => self.structure(structure).fields.get(id.index()).map(|field| field.ty),
            Type::Block(block) => block.pin_type(id),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => None,
        }
    }

    /// The type of a part of what has type `ty`: of a member, an element, or what a reference leads to.
    pub fn part(&self, ty: Type, projection: &Projection) -> Option<Type> {
        match (projection, ty) {
            (Projection::Field(field), _) => self.member(ty, *field),
            (Projection::Index { .. }, Type::Array(id)) => Some(self.array(id).element),
            (Projection::Index { .. }, _) => None,
            (Projection::Deref { target, .. }, _) => Some(*target),
        }
    }

    /// The first instance of a block that a variable of type `ty` is or holds, with the way to it:
    /// `.motor`, `[…].timer`. `is_state` distinguishes the states of POUs, which are instances, from
    /// structures, which are looked into.
    pub fn instance_in(&self, ty: Type, is_state: &impl Fn(StructId) -> bool) -> Option<(String, Type)> {
        match ty {
            Type::Block(_) => Some((String::new(), ty)),
            Type::Struct(id) if is_state(id) => Some((String::new(), ty)),
            Type::Struct(id) => self.structure(id).fields.iter().find_map(|field| {
                let (way, instance) = self.instance_in(field.ty, is_state)?;
                Some((format!(".{}{way}", field.name), instance))
            }),
            Type::Array(id) => {
                let (way, instance) = self.instance_in(self.array(id).element, is_state)?;
                Some((format!("[…]{way}"), instance))
            }
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => None,
        }
    }

    /// The state in `ty` that `is_state`, and the way to it: a block of the runtime's is passed over.
    pub fn state_in(&self, ty: Type, is_state: &impl Fn(StructId) -> bool) -> Option<(String, Type)> {
        match ty {
            Type::Struct(id) if is_state(id) => Some((String::new(), ty)),
            Type::Struct(id) => self.structure(id).fields.iter().find_map(|field| {
                let (way, instance) = self.state_in(field.ty, is_state)?;
                Some((format!(".{}{way}", field.name), instance))
            }),
            Type::Array(id) => {
                let (way, instance) = self.state_in(self.array(id).element, is_state)?;
                Some((format!("[…]{way}"), instance))
            }
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => None,
        }
    }

    /// What `look` finds first in a variable of type `ty`: of the type itself, else of its elements or members.
    pub fn find_in<T>(&self, ty: Type, look: &impl Fn(Type) -> Option<T>) -> Option<T> {
        look(ty).or_else(|| match ty {
            Type::Array(id) => self.find_in(self.array(id).element, look),
            Type::Struct(id) => self.structure(id).fields.iter().find_map(|it| self.find_in(it.ty, look)),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => None,
        })
    }

    /// Whether a variable of type `ty` is or holds one of a type that `is_wanted`.
    pub fn holds(&self, ty: Type, is_wanted: impl Fn(Type) -> bool) -> bool {
        self.find_in(ty, &|it| is_wanted(it).then_some(())).is_some()
    }

    /// The name of a standard block with a prescan that a variable of type `ty` is or holds.
    pub fn prescanned_in(&self, ty: Type) -> Option<&'static str> {
        self.find_in(ty, &|it| {
            let Type::Block(id) = it else { return None };
            id.info().instructions.iter().any(|it| it.prescan.is_some()).then_some(id.info().name)
        })
    }

    /// The type's name as a user writes it.
    pub fn type_name(&self, ty: Type) -> String {
        match ty {
            Type::Elementary(it) => it.name().to_owned(),
            Type::String(it) => it.to_string(),
            Type::Enum(id) => self.enumeration(id).name.clone(),
            Type::Subrange(base, id) => {
                let (low, high) = self.bounds(id);
                format!("{}({low}..{high})", base.name())
            }
            Type::Struct(id) => self.structure(id).name.clone(),
            Type::Block(id) => id.info().name.to_owned(),
            Type::Array(id) => self.array_name(id),
            Type::Reference(id) => match self.references[id.index()].kind {
                RefKind::Interface(interface) => self.interfaces[interface.index()].clone(),
                kind @ (RefKind::RefTo | RefKind::PointerTo | RefKind::ReferenceTo) => {
                    format!("{} {}", kind.word(), self.type_name(self.target(id)))
                }
            },
        }
    }

    fn array_name(&self, id: ArrayId) -> String {
        let mut bounds = Vec::new();
        let mut ty = Type::Array(id);
        while let Type::Array(id) = ty {
            let array = self.array(id);
            bounds.push(if array.is_open() { "*".to_owned() } else { format!("{}..{}", array.low, array.high) });
            ty = array.element;
        }
        format!("ARRAY[{}] OF {}", bounds.join(", "), self.type_name(ty))
    }

    /// The type that a FOR counts in: an enumeration's base, a subrange's, any other as it is.
    pub fn counted(&self, counter: Type) -> Type {
        let Type::Enum(id) = counter else { return counter.read() };
        Type::Elementary(self.enumeration(id).base)
    }

    /// The repr of an elementary, enumeration, subrange or reference type.
    pub fn repr(&self, ty: Type) -> Option<staunch_runtime::Repr> {
        match ty {
            Type::Elementary(it) | Type::Subrange(it, _) => Some(it.repr()),
            Type::Enum(id) => Some(self.enumeration(id).base.repr()),
            Type::Reference(_) => Some(staunch_runtime::Repr::U64),
            Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => None,
        }
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let area = match self.area {
            Area::Input => 'I',
            Area::Output => 'Q',
            Area::Memory => 'M',
        };
        let size = match self.width {
            8 => 'B',
            16 => 'W',
            32 => 'D',
            64 => 'L',
            _ => 'X',
        };
        write!(f, "%{area}{size}")?;
        self.module.levels().iter().try_for_each(|it| write!(f, "{it}."))?;
        match size {
            'X' => write!(f, "{}.{}", self.bit / 8, self.bit % 8),
            _ => write!(f, "{}", self.bit / u64::from(self.width.max(1))),
        }
    }
}
