use crate::{Field, FieldId, Location};
use staunch_runtime::{BLOCKS, BlockInfo, Family, Lane, Pin, Value};

/// The type of a variable or expression: small, copied freely, compared by identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    Elementary(Elementary),
    /// A string of at most this many bytes.
    String(u16),
    Enum(EnumId),
    Array(ArrayId),
    /// A user's structure, or the state of a PROGRAM or FUNCTION_BLOCK, or the globals.
    Struct(StructId),
    /// An instance of a standard function block, or a structure of the standard (COUNTER).
    Block(BlockId),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Elementary {
    Bool,
    Byte,
    Word,
    Dword,
    Lword,
    Sint,
    Int,
    Dint,
    Lint,
    Usint,
    Uint,
    Udint,
    Ulint,
    Real,
    Lreal,
    /// Nanoseconds, signed 64-bit, as LTIME.
    Time,
    Ltime,
}

impl Elementary {
    pub const ALL: [Self; 17] = [
        Self::Bool,
        Self::Byte,
        Self::Word,
        Self::Dword,
        Self::Lword,
        Self::Sint,
        Self::Int,
        Self::Dint,
        Self::Lint,
        Self::Usint,
        Self::Uint,
        Self::Udint,
        Self::Ulint,
        Self::Real,
        Self::Lreal,
        Self::Time,
        Self::Ltime,
    ];

    /// The IEC keyword.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bool => "BOOL",
            Self::Byte => "BYTE",
            Self::Word => "WORD",
            Self::Dword => "DWORD",
            Self::Lword => "LWORD",
            Self::Sint => "SINT",
            Self::Int => "INT",
            Self::Dint => "DINT",
            Self::Lint => "LINT",
            Self::Usint => "USINT",
            Self::Uint => "UINT",
            Self::Udint => "UDINT",
            Self::Ulint => "ULINT",
            Self::Real => "REAL",
            Self::Lreal => "LREAL",
            Self::Time => "TIME",
            Self::Ltime => "LTIME",
        }
    }

    /// How its values are carried.
    pub const fn lane(self) -> Lane {
        match self {
            Self::Bool => Lane::Bool,
            Self::Sint => Lane::I8,
            Self::Int => Lane::I16,
            Self::Dint => Lane::I32,
            Self::Lint | Self::Time | Self::Ltime => Lane::I64,
            Self::Byte | Self::Usint => Lane::U8,
            Self::Word | Self::Uint => Lane::U16,
            Self::Dword | Self::Udint => Lane::U32,
            Self::Lword | Self::Ulint => Lane::U64,
            Self::Real => Lane::F32,
            Self::Lreal => Lane::F64,
        }
    }

    /// Finds a type by its keyword, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(name))
    }

    /// The type of a standard block's pin.
    pub const fn of_pin(info: &BlockInfo, pin: &Pin) -> Self {
        let family = info.family;
        match pin.lane {
            Lane::Bool => Self::Bool,
            Lane::I8 => Self::Sint,
            Lane::I16 => Self::Int,
            Lane::I32 => Self::Dint,
            Lane::I64 if pin.is_time && info.is_long() => Self::Ltime,
            Lane::I64 if pin.is_time => Self::Time,
            Lane::I64 => Self::Lint,
            Lane::U8 => Self::Usint,
            // CODESYS documents its counts as bit strings.
            Lane::U16 if matches!(family, Family::Codesys) => Self::Word,
            Lane::U64 if matches!(family, Family::Codesys) => Self::Lword,
            Lane::U16 => Self::Uint,
            Lane::U32 => Self::Udint,
            Lane::U64 => Self::Ulint,
            Lane::F32 => Self::Real,
            Lane::F64 => Self::Lreal,
        }
    }

    pub const fn is_bits(self) -> bool {
        matches!(self, Self::Bool | Self::Byte | Self::Word | Self::Dword | Self::Lword)
    }

    pub const fn is_time(self) -> bool {
        matches!(self, Self::Time | Self::Ltime)
    }

    pub const fn is_integer(self) -> bool {
        self.lane().is_integer() && !self.is_bits() && !self.is_time()
    }

    pub const fn is_real(self) -> bool {
        self.lane().is_float()
    }
}

impl Type {
    pub const BOOL: Self = Self::Elementary(Elementary::Bool);
    pub const INT: Self = Self::Elementary(Elementary::Int);
    pub const DINT: Self = Self::Elementary(Elementary::Dint);
    pub const LINT: Self = Self::Elementary(Elementary::Lint);
    pub const LREAL: Self = Self::Elementary(Elementary::Lreal);
    pub const TIME: Self = Self::Elementary(Elementary::Time);

    pub const fn elementary(self) -> Option<Elementary> {
        match self {
            Self::Elementary(it) => Some(it),
            Self::String(_) | Self::Enum(_) | Self::Array(_) | Self::Struct(_) | Self::Block(_) => None,
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
        let info = self.info();
        let pin = info.pins.get(pin.index())?;
        Some(Type::Elementary(Elementary::of_pin(info, pin)))
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
}

/// A constant of any type: an initial value.
#[derive(Clone, Debug, PartialEq)]
pub enum Const {
    /// All bytes zero: FALSE, 0, an empty string, a standard block's start state.
    Zero,
    /// Of an elementary or enumeration type.
    Scalar(Value),
    Text(Vec<u8>),
    /// Runs of equal elements: `[4(0), 1]`. The counts add up to the array's length.
    Array(Vec<(u64, Const)>),
    /// A value for every field of a structure, or for every pin of a standard block.
    Struct(Vec<Const>),
}
