//! How values of elementary types are represented, and one such value of any type.

use core::fmt::Debug;

/// How an elementary value is represented: a Rust primitive. Several IEC types share a repr
/// (BYTE and USINT; LINT, TIME and LTIME).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Repr {
    Bool,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
}

/// One value in its repr, for executors that learn the type at run time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    Bool(bool),
    I8(i8),
    I16(i16),
    I32(i32),
    I64(i64),
    U8(u8),
    U16(u16),
    U32(u32),
    U64(u64),
    F32(f32),
    F64(f64),
}

/// A Rust primitive that represents an elementary IEC value.
pub trait Scalar: Copy + Default + PartialEq + PartialOrd + Debug + 'static {
    const LANE: Repr;
    /// Zero, or FALSE.
    const ZERO: Self;
    fn into_value(self) -> Value;
    /// `None` if `value` has another repr.
    fn from_value(value: Value) -> Option<Self>;
}

macro_rules! reprs {
    ($($rust:ident $repr:ident $size:literal;)*) => {
        $(impl Scalar for $rust {
            const LANE: Repr = Repr::$repr;
            const ZERO: Self = zero!($rust);
            #[inline]
            fn into_value(self) -> Value { Value::$repr(self) }
            #[inline]
            fn from_value(value: Value) -> Option<Self> {
                if let Value::$repr(it) = value { Some(it) } else { None }
            }
        })*

        impl Repr {
            pub const ALL: [Self; 11] = [$(Self::$repr),*];

            /// Size in bytes, which is also the alignment.
            pub const fn size(self) -> u32 {
                match self { $(Self::$repr => $size),* }
            }

            /// The Rust primitive's name.
            pub const fn rust_name(self) -> &'static str {
                match self { $(Self::$repr => stringify!($rust)),* }
            }

            /// Zero, or FALSE.
            pub const fn zero(self) -> Value {
                match self { $(Self::$repr => Value::$repr(zero!($rust))),* }
            }
        }

        impl Value {
            pub const fn repr(self) -> Repr {
                match self { $(Self::$repr(_) => Repr::$repr),* }
            }

            /// Reads a value of `repr` from the start of `bytes`, in the machine's byte order.
            /// Zero if there are too few bytes, which is a mistake of the caller.
            pub fn read(repr: Repr, bytes: &[u8]) -> Self {
                debug_assert!(bytes.len() >= repr.size() as usize);
                match repr {
                    $(repr_arm!(@pat $repr) => repr_arm!(@read $rust $repr bytes),)*
                }
            }

            /// Writes the value to the start of `bytes`, in the machine's byte order.
            /// Writes nothing if there are too few bytes, which is a mistake of the caller.
            pub fn write(self, bytes: &mut [u8]) {
                debug_assert!(bytes.len() >= self.repr().size() as usize);
                match self {
                    $(repr_arm!(@bind $repr it) => repr_arm!(@write $rust it bytes),)*
                }
            }
        }
    };
}

macro_rules! zero {
    (bool) => {
        false
    };
    (f32) => {
        0.0
    };
    (f64) => {
        0.0
    };
    ($int:ident) => {
        0
    };
}

// BOOL's bytes are read and written separately: any other bit pattern is not a `bool`.
macro_rules! repr_arm {
    (@pat Bool) => {
        Repr::Bool
    };
    (@pat $repr:ident) => {
        Repr::$repr
    };
    (@bind Bool $it:ident) => {
        Self::Bool($it)
    };
    (@bind $repr:ident $it:ident) => {
        Self::$repr($it)
    };
    (@read bool $repr:ident $bytes:ident) => {
        Self::Bool($bytes.first().is_some_and(|it| *it != 0))
    };
    (@read $rust:ident $repr:ident $bytes:ident) => {
        Self::$repr($bytes.first_chunk().map_or($rust::ZERO, |it| $rust::from_ne_bytes(*it)))
    };
    (@write bool $it:ident $bytes:ident) => {
        $bytes.iter_mut().take(1).for_each(|it| *it = $it.into())
    };
    (@write $rust:ident $it:ident $bytes:ident) => {
        $bytes.first_chunk_mut().into_iter().for_each(|it| *it = $it.to_ne_bytes())
    };
}

reprs! {
    bool Bool 1;
    i8 I8 1;
    i16 I16 2;
    i32 I32 4;
    i64 I64 8;
    u8 U8 1;
    u16 U16 2;
    u32 U32 4;
    u64 U64 8;
    f32 F32 4;
    f64 F64 8;
}

impl Repr {
    pub const fn is_signed(self) -> bool {
        matches!(self, Self::I8 | Self::I16 | Self::I32 | Self::I64)
    }

    pub const fn is_unsigned(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32 | Self::U64)
    }

    pub const fn is_integer(self) -> bool {
        self.is_signed() || self.is_unsigned()
    }

    pub const fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The least and greatest value of an integer repr; FALSE and TRUE count as 0 and 1.
    pub const fn range(self) -> Option<(i128, i128)> {
        Some(match self {
            Self::Bool => (0, 1),
            Self::I8 => (i8::MIN as i128, i8::MAX as i128),
            Self::I16 => (i16::MIN as i128, i16::MAX as i128),
            Self::I32 => (i32::MIN as i128, i32::MAX as i128),
            Self::I64 => (i64::MIN as i128, i64::MAX as i128),
            Self::U8 => (0, u8::MAX as i128),
            Self::U16 => (0, u16::MAX as i128),
            Self::U32 => (0, u32::MAX as i128),
            Self::U64 => (0, u64::MAX as i128),
            Self::F32 | Self::F64 => return None,
        })
    }

    /// The value of an integer repr (or BOOL) that equals `number`; `None` if it does not fit.
    pub fn integer(self, number: i128) -> Option<Value> {
        Some(match self {
            Self::Bool => Value::Bool(match number {
                0 => false,
                1 => true,
                _ => return None,
            }),
            Self::I8 => Value::I8(number.try_into().ok()?),
            Self::I16 => Value::I16(number.try_into().ok()?),
            Self::I32 => Value::I32(number.try_into().ok()?),
            Self::I64 => Value::I64(number.try_into().ok()?),
            Self::U8 => Value::U8(number.try_into().ok()?),
            Self::U16 => Value::U16(number.try_into().ok()?),
            Self::U32 => Value::U32(number.try_into().ok()?),
            Self::U64 => Value::U64(number.try_into().ok()?),
            Self::F32 | Self::F64 => return None,
        })
    }
}

impl Value {
    /// An integer or BOOL value as a number.
    pub fn as_integer(self) -> Option<i128> {
        Some(match self {
            Self::Bool(it) => i128::from(it),
            Self::I8(it) => i128::from(it),
            Self::I16(it) => i128::from(it),
            Self::I32(it) => i128::from(it),
            Self::I64(it) => i128::from(it),
            Self::U8(it) => i128::from(it),
            Self::U16(it) => i128::from(it),
            Self::U32(it) => i128::from(it),
            Self::U64(it) => i128::from(it),
            Self::F32(_) | Self::F64(_) => return None,
        })
    }
}
