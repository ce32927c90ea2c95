//! The elementary types of IEC 61131-3, and the classes that its generic functions name.

use crate::Lane;

macro_rules! elementary {
    ($($(#[$doc:meta])* $ty:ident $name:ident $rust:ident $lane:ident $class:ident;)*) => {
        /// An elementary type that a scalar carries. Ordered as the standard lists them (table 10).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Elementary { $($(#[$doc])* $ty),* }

        impl Elementary {
            pub const ALL: [Self; { [$(Lane::$lane),*].len() }] = [$(Self::$ty),*];

            /// The IEC keyword.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$ty => stringify!($name)),* }
            }

            /// How its values are carried.
            pub const fn lane(self) -> Lane {
                match self { $(Self::$ty => Lane::$lane),* }
            }

            /// The narrowest class that it belongs to.
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
}

macro_rules! classes {
    ($($(#[$doc:meta])* $class:ident $name:literal $($parent:ident)?;)*) => {
        /// A class of types, as the standard's figure of them has it (edition 3, figure 5).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Class { $($(#[$doc])* $class),* }

        impl Class {
            pub const ALL: &'static [Self] = &[$(Self::$class),*];

            /// `ANY_NUM`
            pub const fn name(self) -> &'static str {
                match self { $(Self::$class => $name),* }
            }

            /// The class that this one is a part of.
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
    /// Every type, a user's own too.
    Any         "ANY";
    Elementary  "ANY_ELEMENTARY"  Any;
    /// What has a size: numbers and durations.
    Magnitude   "ANY_MAGNITUDE"   Elementary;
    Num         "ANY_NUM"         Magnitude;
    Real        "ANY_REAL"        Num;
    Int         "ANY_INT"         Num;
    Unsigned    "ANY_UNSIGNED"    Int;
    Signed      "ANY_SIGNED"      Int;
    Duration    "ANY_DURATION"    Magnitude;
    /// BOOL and the bit strings.
    Bit         "ANY_BIT"         Elementary;
    Chars       "ANY_CHARS"       Elementary;
    String      "ANY_STRING"      Chars;
}

impl Class {
    /// Whether `other` is this class or a part of it.
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
    /// Finds a type by its keyword, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(name))
    }

    /// The type that counts or calculates in a lane; BOOL for a `bool`.
    pub const fn number(lane: Lane) -> Self {
        match lane {
            Lane::Bool => Self::Bool,
            Lane::I8 => Self::Sint,
            Lane::I16 => Self::Int,
            Lane::I32 => Self::Dint,
            Lane::I64 => Self::Lint,
            Lane::U8 => Self::Usint,
            Lane::U16 => Self::Uint,
            Lane::U32 => Self::Udint,
            Lane::U64 => Self::Ulint,
            Lane::F32 => Self::Real,
            Lane::F64 => Self::Lreal,
        }
    }

    pub const fn is(self, class: Class) -> bool {
        class.contains(self.class())
    }

    /// BOOL or a bit string.
    pub const fn is_bits(self) -> bool {
        self.is(Class::Bit)
    }

    pub const fn is_time(self) -> bool {
        self.is(Class::Duration)
    }

    pub const fn is_integer(self) -> bool {
        self.is(Class::Int)
    }

    pub const fn is_real(self) -> bool {
        self.is(Class::Real)
    }
}
