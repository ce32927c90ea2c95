//! The signature of a standard function, as in the standard's tables.

use crate::{Class, Elementary, Repr};

/// The signature of a standard function.
#[derive(Clone, Copy, Debug)]
pub struct Signature {
    /// The name by which it is called; a name that starts with `_` is for the compiler only.
    pub name: &'static str,
    pub parameters: &'static [Parameter],
    /// Whether IN3, IN4, … may follow the last parameter.
    pub extensible: bool,
    pub result: Kind,
    /// The types that `T` may be.
    pub class: Class,
}

/// One parameter: its name in the standard's tables, and what it accepts.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub name: &'static str,
    pub kind: Kind,
}

/// The type of a parameter or a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The common type of all parameters of type `T` in a call.
    T,
    /// Any type of the class, whatever the other operands are.
    Any(Class),
    Is(Elementary),
    /// A STRING of any length.
    String,
    /// A WSTRING of any length.
    Wstring,
    /// A STRING or a WSTRING of any length, the same kind for all such parameters in a call.
    AnyString,
}

impl Kind {
    /// The repr of a parameter that is neither `T` nor a string. If any integer is accepted, it is passed as a LINT.
    pub const fn repr(self) -> Option<Repr> {
        match self {
            Self::Is(ty) => Some(ty.repr()),
            Self::Any(_) => Some(Repr::I64),
            Self::T | Self::String | Self::Wstring | Self::AnyString => None,
        }
    }
}

/// A signature, from the notation of the tables' rows.
#[doc(hidden)]
#[macro_export]
macro_rules! signature {
    ($name:literal ($($parameter:ident: $kind:ident),*) -> $result:ident $([$class:ident])? $($extensible:ident)?) => {
        $crate::Signature {
            name: $name,
            parameters: &[$($crate::Parameter {
                name: stringify!($parameter),
                kind: $crate::kind!($kind),
            }),*],
            extensible: $crate::signature!(@extensible $($extensible)?),
            result: $crate::kind!($result),
            class: $crate::signature!(@class $($class)?),
        }
    };
    (@class) => {
        $crate::Class::Any
    };
    (@class $class:ident) => {
        $crate::class!($class)
    };
    (@extensible) => {
        false
    };
    (@extensible extensible) => {
        true
    };
}

/// The kind that a word in a row stands for.
#[doc(hidden)]
#[macro_export]
macro_rules! kind {
    (T) => {
        $crate::Kind::T
    };
    (STRING) => {
        $crate::Kind::String
    };
    (WSTRING) => {
        $crate::Kind::Wstring
    };
    (ANY_STRING) => {
        $crate::Kind::AnyString
    };
    (BOOL) => {
        $crate::Kind::Is($crate::Elementary::Bool)
    };
    (INT) => {
        $crate::Kind::Is($crate::Elementary::Int)
    };
    (DINT) => {
        $crate::Kind::Is($crate::Elementary::Dint)
    };
    (LINT) => {
        $crate::Kind::Is($crate::Elementary::Lint)
    };
    (WORD) => {
        $crate::Kind::Is($crate::Elementary::Word)
    };
    (DWORD) => {
        $crate::Kind::Is($crate::Elementary::Dword)
    };
    (ULINT) => {
        $crate::Kind::Is($crate::Elementary::Ulint)
    };
    (REAL) => {
        $crate::Kind::Is($crate::Elementary::Real)
    };
    (LREAL) => {
        $crate::Kind::Is($crate::Elementary::Lreal)
    };
    (TIME) => {
        $crate::Kind::Is($crate::Elementary::Time)
    };
    (LTIME) => {
        $crate::Kind::Is($crate::Elementary::Ltime)
    };
    (CHAR) => {
        $crate::Kind::Is($crate::Elementary::Char)
    };
    (WCHAR) => {
        $crate::Kind::Is($crate::Elementary::Wchar)
    };
    (DATE) => {
        $crate::Kind::Is($crate::Elementary::Date)
    };
    (LDATE) => {
        $crate::Kind::Is($crate::Elementary::Ldate)
    };
    (TOD) => {
        $crate::Kind::Is($crate::Elementary::Tod)
    };
    (LTOD) => {
        $crate::Kind::Is($crate::Elementary::Ltod)
    };
    (DT) => {
        $crate::Kind::Is($crate::Elementary::Dt)
    };
    (LDT) => {
        $crate::Kind::Is($crate::Elementary::Ldt)
    };
    ($class:ident) => {
        $crate::Kind::Any($crate::class!($class))
    };
}

/// The class that a word in a row stands for.
#[doc(hidden)]
#[macro_export]
macro_rules! class {
    (ANY) => {
        $crate::Class::Any
    };
    (ANY_ELEMENTARY) => {
        $crate::Class::Elementary
    };
    (ANY_MAGNITUDE) => {
        $crate::Class::Magnitude
    };
    (ANY_NUM) => {
        $crate::Class::Num
    };
    (ANY_INT) => {
        $crate::Class::Int
    };
    (ANY_REAL) => {
        $crate::Class::Real
    };
    (ANY_BIT) => {
        $crate::Class::Bit
    };
    (ANY_DATE) => {
        $crate::Class::Date
    };
    (ANY_DURATION) => {
        $crate::Class::Duration
    };
    (ANY_STRING) => {
        $crate::Class::String
    };
}

/// The Rust type for a word in a row: in a shim, or in the interpreter.
#[doc(hidden)]
#[macro_export]
macro_rules! carried {
    (T) => {
        T
    };
    (BOOL) => {
        bool
    };
    (INT) => {
        i16
    };
    (ANY_INT) => {
        i64
    };
    (LINT) => {
        i64
    };
    (ULINT) => {
        u64
    };
    (REAL) => {
        f32
    };
    (LREAL) => {
        f64
    };
    (CHAR) => {
        u8
    };
    (WCHAR) => {
        u16
    };
}
