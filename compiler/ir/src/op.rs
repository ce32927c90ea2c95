//! The operations, made of the runtime's tables: their operands, results, and how the interpreter runs them.

use crate::{Chars, CharsOf, Expr};
use staunch_runtime::{FaultKind, Kind, Outcome, Repr, Scalar, Signature, Value};
use staunch_runtime::{carried, for_each_op, for_each_text_op, kind, ops, signature, text, with_repr, with_unit};
use std::convert::Infallible;

macro_rules! declare_ops {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident
        [$class:ident as $reprs:ident] $outcome:ident $($extensible:ident)?;)*) => {
        /// An operator or standard function on elementary values. What each one does is in
        /// [`staunch_runtime::ops`], under its [`function`](Op::function) name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Op { $($op),* }

        impl Op {
            pub const ALL: &'static [Self] = &[$(Self::$op),*];

            /// What it is called in Structured Text, and what it takes and gives.
            pub const fn signature(self) -> &'static Signature {
                match self {
                    $(Self::$op => const {
                        &signature!($source ($($arg: $ty),*) -> $result [$class] $($extensible)?)
                    },)*
                }
            }

            /// The runtime function, below `staunch_runtime::ops`.
            pub const fn function(self) -> &'static str {
                match self { $(Self::$op => stringify!($function)),* }
            }

            /// For each operand, the repr it must have when it is not the operation's own `T`.
            pub const fn operands(self) -> &'static [Option<Repr>] {
                match self { $(Self::$op => const { &[$(kind!($ty).repr()),*] }),* }
            }

            /// The result's repr when it is not the operation's own `T`.
            pub const fn result(self) -> Option<Repr> {
                self.signature().result.repr()
            }

            pub const fn can_fault(self) -> bool {
                match self { $(Self::$op => outcome!($outcome)),* }
            }

            /// Whether the operation exists at `repr`.
            pub const fn allows(self, repr: Repr) -> bool {
                match self { $(Self::$op => with_repr!($reprs repr, T => { let _: Option<T> = None; true }, false)),* }
            }
        }

        /// Applies `op` at `repr` with the runtime's own function. `None` when an operand is of
        /// the wrong repr, which verified IR excludes.
        #[allow(non_snake_case, reason = "operands have the standard's names")]
        pub fn apply(op: Op, repr: Repr, operands: &[Value]) -> Option<Result<Value, FaultKind>> {
            let mut operands = operands.iter().copied();
            match op {
                $(Op::$op => with_repr!($reprs repr, T => {
                    $(let $arg = <carried!($ty) as Scalar>::from_value(operands.next()?)?;)*
                    let _: Option<T> = None;
                    Some(ops::$function($($arg),*).outcome().map(Scalar::into_value))
                }, None),)*
            }
        }
    };
}

macro_rules! outcome {
    (total) => {
        false
    };
    (faults) => {
        true
    };
}

for_each_op!(declare_ops);

impl Op {
    /// The name it is called by in Structured Text; starts with `_` if it cannot be.
    pub const fn source_name(self) -> &'static str {
        self.signature().name
    }

    /// Finds an operation by the name it is called by, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| op.source_name().eq_ignore_ascii_case(name))
    }

    pub const fn arity(self) -> usize {
        self.operands().len()
    }
}

impl TextOp {
    /// The most characters of a value's text.
    pub const fn longest(self) -> Option<u16> {
        match self {
            Self::FromChar | Self::FromWchar => Some(1),
            Self::FromBool => Some(5),
            // -1.23457e-308
            Self::FromShort => Some(13),
            // -1.234567891e-308
            Self::FromGeneral => Some(17),
            // 16#ffffffffffffffff
            Self::FromBits => Some(19),
            // -1234567900000000.0
            Self::FromReal => Some(19),
            // -9223372036854775808
            Self::FromLint | Self::FromUlint => Some(20),
            // -2.2250738585072014e-308
            Self::FromLreal => Some(24),
            // LTIME#-106751d23h47m16s854ms775us808ns
            Self::FromTime | Self::FromSeconds => Some(40),
            _ => None,
        }
    }

    /// Whether it writes its result from the first character to the last, whatever room there is: a target of fewer
    /// characters gets the start of it.
    pub const fn writes_in_order(self) -> bool {
        !matches!(self, Self::WithChar | Self::WithWchar) && self.signature().result.repr().is_none()
    }
}

/// One operand or result of a text operation.
#[derive(Clone, Debug, PartialEq)]
pub enum TextValue {
    Text(Chars),
    Scalar(Value),
}

macro_rules! declare_text_ops {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) -> $result:ident [$units:ident] $($extensible:ident)?;)*) => {
        /// A function on character strings; see [`staunch_runtime::text`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum TextOp { $($op),* }

        impl TextOp {
            pub const ALL: &'static [Self] = &[$(Self::$op),*];

            /// What it is called in Structured Text, and what it takes and gives.
            pub const fn signature(self) -> &'static Signature {
                match self {
                    $(Self::$op => const {
                        &signature!($source ($($arg: $ty),*) -> $result [ANY_STRING] $($extensible)?)
                    },)*
                }
            }

            /// The runtime function, below `staunch_runtime::text`.
            pub const fn function(self) -> &'static str {
                match self { $(Self::$op => stringify!($function)),* }
            }

            /// For each operand, its repr, or `None` for a string.
            pub const fn operands(self) -> &'static [Option<Repr>] {
                match self { $(Self::$op => const { &[$(kind!($ty).repr()),*] }),* }
            }

            /// The result's repr, or `None` for a string.
            pub const fn result(self) -> Option<Repr> {
                self.signature().result.repr()
            }
        }

        /// Applies `op` with the runtime's own function; a string result is cut at `capacity`.
        /// `None` when an operand is of the wrong kind, which verified IR excludes.
        #[allow(non_snake_case, reason = "operands have the standard's names")]
        pub fn apply_text(op: TextOp, operands: &[TextValue], capacity: u16) -> Option<TextValue> {
            let wide = operands.iter().any(|it| matches!(it, TextValue::Text(text) if text.is_wide()));
            let mut operands = operands.iter();
            match op {
                $(TextOp::$op => with_unit!($units wide, U => {
                    $(let $arg = text_operand!($ty U operands.next()?);)*
                    Some(text_result!($result U capacity, $function ($($arg),*)))
                }),)*
            }
        }
    };
}

macro_rules! text_operand {
    (ANY_STRING $unit:ident $operand:expr) => {
        units::<$unit>($operand)?
    };
    (STRING $unit:ident $operand:expr) => {
        units::<u8>($operand)?
    };
    (WSTRING $unit:ident $operand:expr) => {
        units::<u16>($operand)?
    };
    ($ty:ident $unit:ident $operand:expr) => {{
        let TextValue::Scalar(value) = $operand else { return None };
        <carried!($ty) as Scalar>::from_value(*value)?
    }};
}

fn units<U: CharsOf>(operand: &TextValue) -> Option<&[U]> {
    match operand {
        TextValue::Text(text) => U::units(text),
        TextValue::Scalar(_) => None,
    }
}

macro_rules! text_result {
    (ANY_STRING $unit:ident $($rest:tt)*) => {
        built!($unit $($rest)*)
    };
    (STRING $unit:ident $($rest:tt)*) => {
        built!(u8 $($rest)*)
    };
    (WSTRING $unit:ident $($rest:tt)*) => {
        built!(u16 $($rest)*)
    };
    ($ty:ident $unit:ident $capacity:expr, $function:ident ($($arg:ident),*)) => {
        TextValue::Scalar(text::$function($($arg),*).into_value())
    };
}

macro_rules! built {
    ($unit:ident $capacity:expr, $function:ident ($($arg:ident),*)) => {
        TextValue::Text(Chars::build::<$unit, Infallible>($capacity, |out| {
            text::$function($($arg,)* out);
            Ok(())
        }).unwrap_or_else(|never| match never {}))
    };
}

for_each_text_op!(declare_text_ops);

impl TextOp {
    pub const fn source_name(self) -> &'static str {
        self.signature().name
    }

    /// Whether the function is applied to WSTRINGs, by its operands.
    pub fn is_wide(self, operands: &[Expr]) -> bool {
        let strings = self.signature().parameters.iter().zip(operands);
        strings
            .filter(|(it, _)| it.kind == Kind::AnyString)
            .any(|(_, it)| it.ty.string_type().is_some_and(|it| it.wide))
    }

    /// Finds a function by the name it is called by, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| op.source_name().eq_ignore_ascii_case(name))
    }
}
