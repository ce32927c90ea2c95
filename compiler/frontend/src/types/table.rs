//! Types: what a declaration's type is, what it holds, and how large it is.

use super::in_outs::Polymorphic;
use super::index::Index;
use crate::Span;
use crate::ast::Name;
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Const, EnumId, RefKind, ReferenceId, StructId, Type, Value};
use staunch_runtime::Class;
use std::cell::Cell;
use std::rc::Rc;

/// Stands for the globals' structure until it is made, when all declared globals are known.
pub(crate) const GLOBALS: StructId = StructId(u32::MAX);

/// What a type specification means for a variable declared with it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Resolved {
    pub ty: Type,
    /// The initial value of a variable that is declared without one.
    pub initial: Const,
}

impl Resolved {
    pub fn plain(ty: Type) -> Self {
        Self { ty, initial: Const::Zero }
    }
}

/// The inputs of ANY and the like that get the argument's class, address and size.
#[derive(Debug, Default)]
pub(crate) struct AnyInputs {
    /// The slot of the structure that they get.
    pub structure: Option<usize>,
    /// Where the words are that are their types.
    pub words: FxHashSet<Span>,
    /// What each may be given, by where its name is declared.
    pub classes: FxHashMap<Span, Class>,
}

/// What is known of the types of a program in addition to the program itself.
#[derive(Debug, Default)]
pub(crate) struct Table<'s> {
    pub index: Index,
    /// For each array, what its elements are.
    pub elements: Vec<Resolved>,
    /// For each structure, about how many bytes it takes.
    pub sizes: Vec<u64>,
    /// And no fewer than these, whatever its alignment adds.
    pub sizes_at_most: Vec<u64>,
    /// The bits of each structure whose members have relative locations.
    pub relative: FxHashMap<StructId, u64>,
    /// The structures that others EXTEND, by these, which begin with their members.
    pub bases: FxHashMap<StructId, StructId>,
    /// The POU slot of each structure that is an instance's state.
    pub instances: FxHashMap<StructId, usize>,
    pub interfaces: Interfaces,
    pub polymorphic: Polymorphic,
    /// Whether a body assigns what is or holds an instance.
    pub copies: Cell<bool>,
    /// The VAR_IN_OUTs of FUNCTION_BLOCKs that METHODs use, by where their names are declared: the instance keeps them.
    pub kept_in_outs: FxHashSet<Span>,
    /// For each name of a CONSTANT whose address is taken, the copy that has it among what the globals hold.
    pub constant_copies: FxHashMap<Span, usize>,
    /// The enumerations that take and give no numbers: `{attribute 'strict'}`.
    pub strict: FxHashSet<EnumId>,
    /// Those whose values are named after the type's name alone: `{attribute 'qualified_only'}`.
    pub qualified: FxHashSet<EnumId>,
    /// Those that name values of the type before them, `WORD (A := 16#1)`: they are values of that type.
    pub named_values: FxHashSet<EnumId>,
    /// Those whose values TO_STRING spells by their names: `{attribute 'to_string'}`.
    pub spelled: FxHashSet<EnumId>,
    /// What a program hands on for inputs of ANY as CODESYS does.
    pub any: AnyInputs,
    /// How many constants the initial values hold so far.
    pub constants: usize,
    /// The references to types with names.
    pub pending_references: Vec<PendingReference<'s>>,
    /// Their positions by their kinds and names.
    pub references_to: FxHashMap<(RefKind, Vec<Key<'s>>), Vec<usize>>,
    /// Those whose targets are not known; that was reported.
    pub unknown_references: FxHashSet<ReferenceId>,
}

/// What is known of INTERFACEs, and of the classes that have them.
#[derive(Debug, Default)]
pub(crate) struct Interfaces {
    /// The slots of the INTERFACEs, in their order.
    pub slots: Vec<usize>,
    /// For the slots of classes and INTERFACEs that were asked for: all that they have.
    pub closures: FxHashMap<usize, Rc<FxHashSet<usize>>>,
    /// For those INTERFACEs that were asked for: the slots of the classes whose instances have them.
    pub implementers: FxHashMap<usize, Rc<[usize]>>,
    /// The slots of the classes to whose instances something refers.
    pub referred: FxHashSet<usize>,
    /// Calls by INTERFACEs are of these alone.
    pub only: Option<FxHashSet<usize>>,
    /// The numbers of the classes that references distinguish.
    pub numbers: FxHashMap<StructId, u64>,
    pub is_too_many: bool,
    /// When they were asked for: the classes that extend others, by these.
    pub heirs: Option<Rc<FxHashMap<usize, Vec<usize>>>>,
}

/// A reference to a type that is looked up when all are declared: it may hold such a reference itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PendingReference<'s> {
    pub id: ReferenceId,
    pub path: &'s [Name<'s>],
    pub span: Span,
}

/// An instance of the POU with this state.
pub(crate) fn instance_of(program: &staunch_ir::Program, state: StructId) -> Resolved {
    Resolved { ty: Type::Struct(state), initial: struct_initial(&program.structure(state).fields) }
}

/// The initial value of a structure: all zero where every field's is.
pub(crate) fn struct_initial(fields: &[staunch_ir::Field]) -> Const {
    if fields.iter().all(|it| it.initial == Const::Zero) {
        return Const::Zero;
    }
    Const::Struct(fields.iter().map(|it| it.initial.clone()).collect())
}

/// A scalar constant, in its shortest form.
pub(crate) fn scalar_initial(value: Value) -> Const {
    // -0.0 equals 0.0 but has other bytes.
    let is_zero = match value {
        Value::F32(it) => it.to_bits() == 0,
        Value::F64(it) => it.to_bits() == 0,
        other => other == other.repr().zero(),
    };
    if is_zero { Const::Zero } else { Const::Scalar(value) }
}
