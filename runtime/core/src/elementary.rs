//! The elementary types of IEC 61131-3, and the classes that its generic functions name.

use crate::{Repr, time};

macro_rules! elementary {
    ($($(#[$doc:meta])* $ty:ident $name:ident $rust:ident $repr:ident $class:ident;)*) => {
        /// An elementary type. The order is that of the standard's list (table 10).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Elementary { $($(#[$doc])* $ty),* }

        impl Elementary {
            pub const ALL: [Self; { [$(Repr::$repr),*].len() }] = [$(Self::$ty),*];

            /// Its unique name.
            pub const fn own_name(self) -> &'static str {
                match self { $(Self::$ty => stringify!($name)),* }
            }

            /// How its values are represented.
            pub const fn repr(self) -> Repr {
                match self { $(Self::$ty => Repr::$repr),* }
            }

            /// The smallest class that contains it.
            pub const fn class(self) -> Class {
                match self { $(Self::$ty => Class::$class),* }
            }
        }

        /// The types and their Rust primitives, by keyword: what a block's pins are declared with.
        #[allow(dead_code, clippy::upper_case_acronyms, reason = "keywords, some of which are the type of no pin")]
        pub(crate) mod keyword {
            use super::Elementary;
            $(
                pub(crate) type $name = $rust;
                pub(crate) const $name: Elementary = Elementary::$ty;
            )*
        }
    };
}

elementary! {
    Bool    BOOL    bool  Bool  Bit;
    Byte    BYTE    u8    U8    Bit;
    Word    WORD    u16   U16   Bit;
    Dword   DWORD   u32   U32   Bit;
    Lword   LWORD   u64   U64   Bit;
    Sint    SINT    i8    I8    Signed;
    Int     INT     i16   I16   Signed;
    Dint    DINT    i32   I32   Signed;
    Lint    LINT    i64   I64   Signed;
    Usint   USINT   u8    U8    Unsigned;
    Uint    UINT    u16   U16   Unsigned;
    Udint   UDINT   u32   U32   Unsigned;
    Ulint   ULINT   u64   U64   Unsigned;
    Real    REAL    f32   F32   Real;
    Lreal   LREAL   f64   F64   Real;
    /// Nanoseconds, signed 64-bit, as LTIME.
    Time    TIME    i64   I64   Duration;
    Ltime   LTIME   i64   I64   Duration;
    /// Unsigned nanoseconds: the LTIME of CODESYS, and `LTIME` is its name in programs.
    Ultime  ULTIME  u64   U64   Duration;
    /// The midnight at which the day starts, in nanoseconds since 1970-01-01; as LDATE.
    Date    DATE    i64   I64   Date;
    Ldate   LDATE   i64   I64   Date;
    /// Nanoseconds since midnight, less than a day; as LTOD.
    Tod     TOD     i64   I64   Date;
    Ltod    LTOD    i64   I64   Date;
    /// Nanoseconds since 1970-01-01; as LDT.
    Dt      DT      i64   I64   Date;
    Ldt     LDT     i64   I64   Date;
    /// A character by its number: a byte, as in a STRING.
    Char    CHAR    u8    U8    Char;
    /// A UTF-16 code unit, as in a WSTRING.
    Wchar   WCHAR   u16   U16   Char;
}

/// The types' long names.
const LONG_NAMES: [(&str, Elementary); 4] = [
    ("TIME_OF_DAY", Elementary::Tod),
    ("LTIME_OF_DAY", Elementary::Ltod),
    ("DATE_AND_TIME", Elementary::Dt),
    ("LDATE_AND_TIME", Elementary::Ldt),
];

macro_rules! classes {
    ($($(#[$doc:meta])* $class:ident $name:literal $($parent:ident)?;)*) => {
        /// A class of types, as in the standard's figure (edition 3, figure 5).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Class { $($(#[$doc])* $class),* }

        impl Class {
            pub const ALL: &'static [Self] = &[$(Self::$class),*];

            /// `ANY_NUM`
            pub const fn name(self) -> &'static str {
                match self { $(Self::$class => $name),* }
            }

            /// The class that contains this one.
            pub const fn parent(self) -> Option<Self> {
                match self { $(Self::$class => classes!(@parent $($parent)?)),* }
            }
        }
    };
    (@parent) => {
        None
    };
    (@parent $parent:ident) => {
        Some(Self::$parent)
    };
}

classes! {
    /// Every type, including user-defined types.
    Any         "ANY";
    Elementary  "ANY_ELEMENTARY"  Any;
    /// Types with a magnitude: numbers and durations.
    Magnitude   "ANY_MAGNITUDE"   Elementary;
    Num         "ANY_NUM"         Magnitude;
    Real        "ANY_REAL"        Num;
    Int         "ANY_INT"         Num;
    Unsigned    "ANY_UNSIGNED"    Int;
    Signed      "ANY_SIGNED"      Int;
    Duration    "ANY_DURATION"    Magnitude;
    /// Days, times of day, and points in time.
    Date        "ANY_DATE"        Elementary;
    /// BOOL and the bit strings.
    Bit         "ANY_BIT"         Elementary;
    Chars       "ANY_CHARS"       Elementary;
    String      "ANY_STRING"      Chars;
    Char        "ANY_CHAR"        Chars;
}

impl Class {
    /// Whether `other` is this class or is contained in it.
    pub const fn contains(self, other: Self) -> bool {
        let mut at = Some(other);
        while let Some(class) = at {
            if class as u8 == self as u8 {
                return true;
            }
            at = class.parent();
        }
        false
    }
}

impl Elementary {
    /// The IEC keyword.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ultime => Self::Ltime.own_name(),
            _ => self.own_name(),
        }
    }

    /// Finds a type by its [own name](Self::own_name).
    pub fn by_own_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|it| it.own_name() == name)
    }

    /// Finds a type by its keyword, in upper or lower case.
    pub fn named(name: &str) -> Option<Self> {
        // Most names differ in their first letter or their length.
        let first = name.as_bytes().first()?.to_ascii_uppercase();
        let is_it = |own: &str| own.len() == name.len() && own.as_bytes()[0] == first && own.eq_ignore_ascii_case(name);
        let short = || Self::ALL.iter().copied().find(|it| is_it(it.name()));
        let long = || LONG_NAMES.iter().find(|it| is_it(it.0)).map(|it| it.1);
        short().or_else(long)
    }

    /// The numeric type with this repr; BOOL for a `bool`.
    pub const fn number(repr: Repr) -> Self {
        match repr {
            Repr::Bool => Self::Bool,
            Repr::I8 => Self::Sint,
            Repr::I16 => Self::Int,
            Repr::I32 => Self::Dint,
            Repr::I64 => Self::Lint,
            Repr::U8 => Self::Usint,
            Repr::U16 => Self::Uint,
            Repr::U32 => Self::Udint,
            Repr::U64 => Self::Ulint,
            Repr::F32 => Self::Real,
            Repr::F64 => Self::Lreal,
        }
    }

    pub const fn is(self, class: Class) -> bool {
        class.contains(self.class())
    }

    /// BOOL or a bit string.
    pub const fn is_bits(self) -> bool {
        self.is(Class::Bit)
    }

    /// A duration.
    pub const fn is_duration(self) -> bool {
        self.is(Class::Duration)
    }

    /// A duration, a date or a time of day: the types that are stored as a [`Time`](crate::Time).
    pub const fn is_time(self) -> bool {
        self.is_duration() || self.is(Class::Date)
    }

    /// A day, stored as its midnight.
    pub const fn is_day(self) -> bool {
        matches!(self, Self::Date | Self::Ldate)
    }

    /// A time of day.
    pub const fn is_time_of_day(self) -> bool {
        matches!(self, Self::Tod | Self::Ltod)
    }

    /// A point in time.
    pub const fn is_date_and_time(self) -> bool {
        matches!(self, Self::Dt | Self::Ldt)
    }

    /// The unit, in nanoseconds, of a number that is converted to or from this type, if it is stored as a
    /// [`Time`](crate::Time): as CODESYS documents it, milliseconds for durations and times of day, seconds for dates,
    /// and nanoseconds for the long forms of these.
    pub const fn counted_in(self) -> Option<crate::Time> {
        match self {
            Self::Time | Self::Tod => Some(time::MILLISECOND),
            Self::Date | Self::Dt => Some(time::SECOND),
            Self::Ltime | Self::Ultime | Self::Ldate | Self::Ltod | Self::Ldt => Some(1),
            _ => None,
        }
    }

    /// An integer, BOOL or a bit string.
    pub const fn is_integral(self) -> bool {
        self.is_integer() || self.is_bits()
    }

    pub const fn is_integer(self) -> bool {
        self.is(Class::Int)
    }

    /// CHAR or WCHAR.
    pub const fn is_char(self) -> bool {
        self.is(Class::Char)
    }

    pub const fn is_real(self) -> bool {
        self.is(Class::Real)
    }
}
