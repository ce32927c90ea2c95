//! Types, constants of them, and the ids of what a program holds.

use crate::{Chars, Field, FieldId, Location, StringType};
use staunch_runtime::{BLOCKS, BlockInfo, Value};

pub use staunch_runtime::Elementary;

/// The type of a variable or expression: small, copied freely, compared by identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    Elementary(Elementary),
    /// A STRING or WSTRING.
    String(StringType),
    Enum(EnumId),
    /// An integer type within limits. A value written to such a variable is checked, or constant.
    Subrange(Elementary, BoundsId),
    Array(ArrayId),
    /// A user's structure, or the state of a PROGRAM or FUNCTION_BLOCK, or the globals.
    Struct(StructId),
    /// An instance of a standard function block, or a structure of the standard (COUNTER).
    Block(BlockId),
    /// A reference: null, or an object of the program and a position in it
    /// ([`staunch_runtime::Reference`]).
    Reference(ReferenceId),
}

impl Type {
    pub const BOOL: Self = Self::Elementary(Elementary::Bool);
    pub const INT: Self = Self::Elementary(Elementary::Int);
    pub const DINT: Self = Self::Elementary(Elementary::Dint);
    pub const LINT: Self = Self::Elementary(Elementary::Lint);
    pub const LREAL: Self = Self::Elementary(Elementary::Lreal);
    pub const TIME: Self = Self::Elementary(Elementary::Time);

    /// A STRING of at most so many bytes.
    pub const fn string(capacity: u16) -> Self {
        Self::String(StringType::narrow(capacity))
    }

    /// A STRING or WSTRING.
    pub const fn string_type(self) -> Option<StringType> {
        match self {
            Self::String(it) => Some(it),
            Self::Elementary(_)
            | Self::Subrange(..)
            | Self::Enum(_)
            | Self::Array(_)
            | Self::Struct(_)
            | Self::Block(_)
            | Self::Reference(_) => None,
        }
    }

    /// The elementary type of its values: a subrange's is the type that it is made of.
    pub const fn elementary(self) -> Option<Elementary> {
        match self {
            Self::Elementary(it) | Self::Subrange(it, _) => Some(it),
            Self::String(_)
            | Self::Enum(_)
            | Self::Array(_)
            | Self::Struct(_)
            | Self::Block(_)
            | Self::Reference(_) => None,
        }
    }

    /// The type of the values of a variable of this type: a subrange's is the one that it is made of.
    #[must_use]
    pub const fn read(self) -> Self {
        match self {
            Self::Subrange(it, _) => Self::Elementary(it),
            Self::Elementary(_)
            | Self::String(_)
            | Self::Enum(_)
            | Self::Array(_)
            | Self::Struct(_)
            | Self::Block(_)
            | Self::Reference(_) => self,
        }
    }
}

/// The type of a reference. All are stored and dereferenced in the same way; the word says how the source uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RefType {
    pub kind: RefKind,
    /// What it is declared to point to.
    pub target: Type,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RefKind {
    /// `REF_TO`
    RefTo,
    /// `POINTER TO`
    PointerTo,
    /// `REFERENCE TO`: its name stands for what it refers to.
    ReferenceTo,
    /// A variable of an INTERFACE: it leads to instances of the classes that have it, whatever its target says.
    Interface(InterfaceId),
}

impl RefKind {
    /// As the source writes it, before what is pointed to.
    pub const fn word(self) -> &'static str {
        match self {
            Self::RefTo => "REF_TO",
            Self::PointerTo => "POINTER TO",
            Self::ReferenceTo => "REFERENCE TO",
            Self::Interface(_) => "INTERFACE",
        }
    }
}

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            pub struct $id(pub u32);

            impl $id {
                pub fn index(self) -> usize {
                    usize::try_from(self.0).expect("a u32 fits a usize on the compiler's hosts")
                }

                /// The id of the next element of a table that holds `len`.
                ///
                /// # Panics
                /// If a table outgrows 2^32 entries; the front end's limits are far below.
                pub fn next(len: usize) -> Self {
                    Self(u32::try_from(len).expect("tables stay below 2^32 entries"))
                }
            }
        )*
    };
}
pub(crate) use ids;

ids! {
    EnumId;
    /// Which type a reference is declared to point to; equal types have one id.
    ReferenceId;
    /// Index into the names of a program's INTERFACEs.
    InterfaceId;
    /// Bounds of subranges; equal bounds have one id.
    BoundsId;
    ArrayId;
    StructId;
    /// Index into the runtime's table of standard blocks.
    BlockId;
}

impl BlockId {
    pub fn info(self) -> &'static BlockInfo {
        &BLOCKS[self.index()]
    }

    /// The type of a pin, by its position.
    pub fn pin_type(self, pin: FieldId) -> Option<Type> {
        Some(Type::Elementary(self.info().pins.get(pin.index())?.ty))
    }
}

/// An enumeration: named values of an integer type.
#[derive(Clone, Debug)]
pub struct Enum {
    pub name: String,
    pub doc: Option<String>,
    pub location: Location,
    /// INT unless the declaration says otherwise.
    pub base: Elementary,
    pub values: Vec<Enumerator>,
}

#[derive(Clone, Debug)]
pub struct Enumerator {
    pub name: String,
    pub doc: Option<String>,
    pub value: Value,
}

/// One dimension of an array: elements `low..=high`. Several dimensions are nested arrays,
/// the first subscript outermost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Array {
    pub low: i64,
    pub high: i64,
    pub element: Type,
}

impl Array {
    /// A dimension of `ARRAY[*]`: its bounds are those of the array that a caller passes. There are such
    /// parameters until [`crate::shapes::settle`] copies their routines.
    pub const fn open(element: Type) -> Self {
        Self { low: 0, high: -1, element }
    }

    pub const fn is_open(self) -> bool {
        self.low > self.high
    }

    /// Number of elements; 2^64 of them count as one less.
    pub fn len(self) -> u64 {
        self.high.abs_diff(self.low).saturating_add(1)
    }

    /// An array always has an element.
    pub const fn is_empty(self) -> bool {
        false
    }
}

/// A structure, or the state of a PROGRAM or FUNCTION_BLOCK, or the globals.
#[derive(Clone, Debug)]
pub struct Struct {
    pub name: String,
    pub doc: Option<String>,
    pub location: Location,
    pub fields: Vec<Field>,
    /// What the source declares that is some bits of a field: the members of a UNION, and BITs. Such a
    /// field is an integer or bit string, or an array of them, and has a name of its own.
    pub overlays: Vec<Overlay>,
    /// Its address is a multiple of so many bytes, also where its fields ask for less; a power of two.
    pub align: u64,
}

/// A member of a structure that is some bits of a field, which other members may share.
#[derive(Clone, Debug)]
pub struct Overlay {
    /// The declaration's spelling.
    pub name: String,
    pub ty: Type,
    pub field: FieldId,
    /// The first bit in the field, counted from the lowest of its first byte.
    pub bit: u64,
    /// One bit, of type BOOL.
    pub is_bit: bool,
    /// Its structure is packed: no other member has these bits.
    pub is_packed: bool,
    pub doc: Option<String>,
    pub location: Location,
}

impl Struct {
    pub fn new(name: String, doc: Option<String>, location: Location, fields: Vec<Field>) -> Self {
        Self { name, doc, location, fields, overlays: Vec::new(), align: 1 }
    }

    /// Whether a field is only there to hold the bits of overlays.
    pub fn is_storage(&self, field: FieldId) -> bool {
        self.overlays.iter().any(|it| it.field == field)
    }
}

/// A constant of any type: an initial value.
#[derive(Clone, Debug, PartialEq)]
pub enum Const {
    /// All bytes zero: FALSE, 0, an empty string, a standard block's start state.
    Zero,
    /// Of an elementary or enumeration type.
    Scalar(Value),
    Text(Chars),
    /// Runs of equal elements: `[4(0), 1]`. The counts add up to the array's length.
    Array(Vec<(u64, Const)>),
    /// A value for every field of a structure, or for every pin of a standard block.
    Struct(Vec<Const>),
}

impl Const {
    /// The value of a field or an element, counted from 0.
    pub fn part(&self, at: usize) -> Self {
        match self {
            Self::Struct(values) => values.get(at).cloned().unwrap_or(Self::Zero),
            Self::Array(runs) => {
                let mut left = u64::try_from(at).unwrap_or(u64::MAX);
                for (count, value) in runs {
                    if left < *count {
                        return value.clone();
                    }
                    left -= count;
                }
                Self::Zero
            }
            Self::Zero | Self::Scalar(_) | Self::Text(_) => Self::Zero,
        }
    }
}
