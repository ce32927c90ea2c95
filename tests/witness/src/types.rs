//! Types, and which of them widen to which.

use staunch_frontend::ast::{Construction, Initial, TypeSpec};
use staunch_runtime::{BlockInfo, Repr, Value as Scalar};
use std::rc::Rc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Elementary {
    Bool,
    Sint,
    Int,
    Dint,
    Lint,
    Usint,
    Uint,
    Udint,
    Ulint,
    Byte,
    Word,
    Dword,
    Lword,
    Real,
    Lreal,
    Time,
    Ltime,
    Date,
    Ldate,
    Tod,
    Ltod,
    Dt,
    Ldt,
    Char,
    Wchar,
}

use Elementary as E;

const ELEMENTARY: [(&str, E, Repr); 29] = [
    ("BOOL", E::Bool, Repr::Bool),
    ("SINT", E::Sint, Repr::I8),
    ("INT", E::Int, Repr::I16),
    ("DINT", E::Dint, Repr::I32),
    ("LINT", E::Lint, Repr::I64),
    ("USINT", E::Usint, Repr::U8),
    ("UINT", E::Uint, Repr::U16),
    ("UDINT", E::Udint, Repr::U32),
    ("ULINT", E::Ulint, Repr::U64),
    ("BYTE", E::Byte, Repr::U8),
    ("WORD", E::Word, Repr::U16),
    ("DWORD", E::Dword, Repr::U32),
    ("LWORD", E::Lword, Repr::U64),
    ("REAL", E::Real, Repr::F32),
    ("LREAL", E::Lreal, Repr::F64),
    ("TIME", E::Time, Repr::I64),
    ("LTIME", E::Ltime, Repr::I64),
    ("DATE", E::Date, Repr::I64),
    ("LDATE", E::Ldate, Repr::I64),
    ("TOD", E::Tod, Repr::I64),
    ("LTOD", E::Ltod, Repr::I64),
    ("DT", E::Dt, Repr::I64),
    ("LDT", E::Ldt, Repr::I64),
    ("CHAR", E::Char, Repr::U8),
    ("WCHAR", E::Wchar, Repr::U16),
    // Other names come after those that a table of types has first.
    ("TIME_OF_DAY", E::Tod, Repr::I64),
    ("LTIME_OF_DAY", E::Ltod, Repr::I64),
    ("DATE_AND_TIME", E::Dt, Repr::I64),
    ("LDATE_AND_TIME", E::Ldt, Repr::I64),
];

impl Elementary {
    pub fn named(name: &str) -> Option<Self> {
        ELEMENTARY.iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
    }

    pub fn repr(self) -> Repr {
        ELEMENTARY.iter().find(|it| it.1 == self).map_or(Repr::Bool, |it| it.2)
    }

    pub fn is_real(self) -> bool {
        self.repr().is_float()
    }

    pub fn is_time(self) -> bool {
        matches!(self, E::Time | E::Ltime)
    }

    /// Whether this is a day, a time of day or a point in time.
    pub fn is_date(self) -> bool {
        matches!(self, E::Date | E::Ldate | E::Tod | E::Ltod | E::Dt | E::Ldt)
    }

    pub fn is_char(self) -> bool {
        matches!(self, E::Char | E::Wchar)
    }

    /// Whether this is not a number, though its values are integers.
    fn is_other(self) -> bool {
        self.is_time() || self.is_date() || self.is_char()
    }

    pub fn is_bits(self) -> bool {
        matches!(self, E::Bool | E::Byte | E::Word | E::Dword | E::Lword)
    }

    /// The unsigned number of a bit string.
    pub fn as_number(self) -> Self {
        match self {
            E::Byte => E::Usint,
            E::Word => E::Uint,
            E::Dword => E::Udint,
            E::Lword => E::Ulint,
            other => other,
        }
    }

    /// Whether this is a number or a bit string of fewer than 32 bits.
    pub fn is_narrow(self) -> bool {
        self.repr().is_integer() && self.repr().size() < 4 && !self.is_char()
    }

    pub fn is_integer(self) -> bool {
        self.repr().is_integer() && !self.is_other() && !self.is_bits()
    }

    /// Whether an integer literal can have this type.
    pub fn takes_integers(self) -> bool {
        self.is_real() || (self.repr().is_integer() && !self.is_other())
    }

    pub fn holds(self, number: i128) -> bool {
        self.is_real() || self.repr().integer(number).is_some()
    }

    pub fn range(self) -> (i128, i128) {
        self.repr().range().unwrap_or_default()
    }

    /// Whether each value of `self` is one of `to`: the standard's figure of implicit conversions.
    pub fn widens_to(self, to: Self) -> bool {
        let bits = |it: Self| it.repr().size();
        match (self, to) {
            _ if self == to => true,
            (E::Time, E::Ltime) | (E::Real, E::Lreal) => true,
            (E::Date, E::Ldate) | (E::Tod, E::Ltod) | (E::Dt, E::Ldt) => true,
            _ if self.is_other() || to.is_other() => false,
            (E::Bool, _) => to.is_bits(),
            _ if self.is_bits() || to.is_bits() => self.is_bits() && to.is_bits() && bits(self) < bits(to),
            // A REAL holds integers of 16 bits, an LREAL of 32.
            _ if to.is_real() => self.is_integer() && bits(self) * 2 <= bits(to),
            _ if self.is_real() => false,
            _ => self.range().0 >= to.range().0 && self.range().1 <= to.range().1,
        }
    }

    /// The type itself, or a wider one that holds a literal next to it.
    pub fn that_holds(self, number: i128) -> Self {
        let own = [E::Int, E::Dint, E::Lint, E::Ulint].into_iter().find(|it| it.holds(number));
        if self.holds(number) { self } else { own.and_then(|it| self.meets(it)).unwrap_or(self) }
    }

    /// The type at which two operands meet.
    pub fn meets(self, other: Self) -> Option<Self> {
        let all = [self, other, E::Int, E::Dint, E::Lint, E::Real, E::Lreal];
        all.into_iter().find(|it| self.widens_to(*it) && other.widens_to(*it))
    }
}

#[derive(Clone, Debug)]
pub(crate) enum Type<'a> {
    Elementary(Elementary),
    /// An integer between bounds, which each write checks.
    Subrange(Elementary, i128, i128),
    Enum(Rc<Enum>),
    Text(Text),
    Array(Rc<Array<'a>>),
    /// A structure, or an instance of a user's POU.
    Record(Rc<Record<'a>>),
    /// Its members share their bytes.
    Union(Rc<Record<'a>>),
    Block(&'static BlockInfo),
    Reference(Reference<'a>),
}

/// A STRING or WSTRING, and how many bytes or code units it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Text {
    pub capacity: usize,
    pub wide: bool,
}

impl Text {
    /// Bytes of a unit.
    pub fn unit(self) -> usize {
        if self.wide { 2 } else { 1 }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference<'a> {
    pub kind: RefKind,
    /// What it refers to as that is declared: an INTERFACE, where it is a variable of one.
    pub target: Option<&'a TypeSpec<'a>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RefKind {
    /// REF_TO, POINTER TO: `^` leads on.
    Pointer,
    /// REFERENCE TO: its name stands for what it refers to.
    Alias,
    /// A variable of an INTERFACE.
    Interface,
}

#[derive(Debug)]
pub(crate) struct Enum {
    pub base: Elementary,
    pub values: Vec<(String, Scalar)>,
}

#[derive(Debug)]
pub(crate) struct Array<'a> {
    pub low: i128,
    pub high: i128,
    pub element: Slot<'a>,
    /// Of `ARRAY[a, b] OF t` 2: its elements, and their elements, are written in one row.
    pub dimensions: usize,
    /// Of `ARRAY[*]`: each call gives an array of its own bounds.
    pub is_open: bool,
}

#[derive(Debug)]
pub(crate) struct Record<'a> {
    /// The POU whose instance this is.
    pub pou: Option<usize>,
    pub fields: Vec<(String, Slot<'a>)>,
    /// The inputs that are edges: the field after each is its trigger.
    pub edges: Vec<String>,
}

/// What is declared: a type, and what it starts with.
#[derive(Clone, Debug)]
pub(crate) struct Slot<'a> {
    pub ty: Type<'a>,
    pub initial: Option<&'a Initial<'a>>,
    /// What its instances' FB_init is given.
    pub construction: Option<&'a Construction<'a>>,
    /// Whether it is RETAIN.
    pub is_kept: bool,
}

impl<'a> Slot<'a> {
    pub fn of(ty: Type<'a>) -> Self {
        Self { ty, initial: None, construction: None, is_kept: false }
    }
}

impl Type<'_> {
    pub const BOOL: Self = Self::Elementary(E::Bool);
    pub const LINT: Self = Self::Elementary(E::Lint);

    /// Cells of memory that a value takes.
    pub fn size(&self) -> usize {
        match self {
            Self::Elementary(_) | Self::Subrange(..) | Self::Enum(_) | Self::Text(_) => 1,
            Self::Reference(_) | Self::Union(_) => 1,
            Self::Array(it) => it.element.ty.size() * it.count(),
            Self::Record(it) => it.fields.iter().map(|(_, slot)| slot.ty.size()).sum(),
            Self::Block(info) => info.pins.len(),
        }
    }

    /// Whether a reference that is declared with this type sees in the other what it is.
    pub fn looks_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Array(a), Self::Array(b)) => {
                (a.low, a.high) == (b.low, b.high) && a.element.ty.looks_like(&b.element.ty)
            }
            (Self::Elementary(a), Self::Elementary(b)) => a == b,
            (Self::Subrange(a, ..), Self::Subrange(b, ..)) => a == b,
            (Self::Enum(a), Self::Enum(b)) => Rc::ptr_eq(a, b),
            (Self::Text(a), Self::Text(b)) => a == b,
            // Of an heir what a base has.
            (Self::Record(a), Self::Record(b)) => a.pou.is_some() == b.pou.is_some(),
            (Self::Union(_), Self::Union(_)) | (Self::Reference(_), Self::Reference(_)) => true,
            (Self::Block(a), Self::Block(b)) => std::ptr::eq(*a, *b),
            _ => false,
        }
    }

    /// The POU that this is an instance of.
    pub fn class(&self) -> Option<usize> {
        match self {
            Self::Record(it) => it.pou,
            _ => None,
        }
    }

    /// The type that a value read from here has in an expression, if it is elementary.
    pub fn elementary(&self) -> Option<Elementary> {
        match self {
            Self::Elementary(it) | Self::Subrange(it, ..) => Some(*it),
            Self::Enum(_) | Self::Text(_) | Self::Array(_) | Self::Record(_) | Self::Union(_) => None,
            Self::Block(_) | Self::Reference(_) => None,
        }
    }

    /// The least and the greatest number that a variable can hold.
    pub fn range(&self) -> (i128, i128) {
        match self {
            Self::Subrange(_, low, high) => (*low, *high),
            other => other.elementary().map_or((0, 0), Elementary::range),
        }
    }

    /// The elementary type of the values of this type.
    pub fn base(&self) -> Option<Elementary> {
        match self {
            Self::Enum(it) => Some(it.base),
            other => other.elementary(),
        }
    }
}

impl Array<'_> {
    pub fn count(&self) -> usize {
        usize::try_from(self.high - self.low + 1).unwrap_or(0)
    }

    /// How many elements are written in one row.
    pub fn elements(&self) -> usize {
        match &self.element.ty {
            Type::Array(inner) if self.dimensions > 1 => self.count() * inner.elements(),
            _ => self.count(),
        }
    }
}
