use staunch_runtime::{FaultKind, Lane, Outcome, Scalar, Value, for_each_op, for_each_text_op, ops, text, with_lane};

macro_rules! declare_ops {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) $result:ident [$class:ident] $outcome:ident;)*) => {
        /// An operator or standard function on elementary values. What each one does stands in
        /// [`staunch_runtime::ops`], under its [`function`](Op::function) name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Op { $($op),* }

        impl Op {
            pub const ALL: &'static [Self] = &[$(Self::$op),*];

            /// The name it is called by in Structured Text; starts with `_` if it cannot be.
            pub const fn source_name(self) -> &'static str {
                match self { $(Self::$op => $source),* }
            }

            /// The runtime function, below `staunch_runtime::ops`.
            pub const fn function(self) -> &'static str {
                match self { $(Self::$op => stringify!($function)),* }
            }

            /// For each operand, the lane it must have when it is not the operation's own `T`.
            pub const fn operands(self) -> &'static [Option<Lane>] {
                match self { $(Self::$op => &[$(fixed_lane!($ty)),*]),* }
            }

            /// The result's lane when it is not the operation's own `T`.
            pub const fn result(self) -> Option<Lane> {
                match self { $(Self::$op => fixed_lane!($result)),* }
            }

            pub const fn can_fault(self) -> bool {
                match self { $(Self::$op => outcome!($outcome)),* }
            }

            /// Whether the operation exists at `lane`.
            pub const fn allows(self, lane: Lane) -> bool {
                match self { $(Self::$op => with_lane!($class lane, T => { let _: Option<T> = None; true }, false)),* }
            }
        }

        /// Applies `op` at `lane` with the runtime's own function. `None` when an operand is of
        /// the wrong lane, which verified IR excludes.
        pub fn apply(op: Op, lane: Lane, operands: &[Value]) -> Option<Result<Value, FaultKind>> {
            let mut operands = operands.iter().copied();
            match op {
                $(Op::$op => with_lane!($class lane, T => {
                    $(let $arg = <$ty as Scalar>::from_value(operands.next()?)?;)*
                    let _: Option<T> = None;
                    Some(ops::$function($($arg),*).outcome().map(Scalar::into_value))
                }, None),)*
            }
        }
    };
}

macro_rules! fixed_lane {
    (T) => {
        None
    };
    (bool) => {
        Some(Lane::Bool)
    };
    (i64) => {
        Some(Lane::I64)
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
    /// Finds an operation by the name it is called by, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| op.source_name().eq_ignore_ascii_case(name))
    }

    pub const fn arity(self) -> usize {
        self.operands().len()
    }
}

/// One operand or result of a text operation.
#[derive(Clone, Debug, PartialEq)]
pub enum TextValue {
    Text(Vec<u8>),
    Scalar(Value),
}

macro_rules! declare_text_ops {
    ($($op:ident $source:literal $function:ident ($($arg:ident: $ty:ident),*) $result:ident;)*) => {
        /// A function on character strings; see [`staunch_runtime::text`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum TextOp { $($op),* }

        impl TextOp {
            pub const ALL: &'static [Self] = &[$(Self::$op),*];

            pub const fn source_name(self) -> &'static str {
                match self { $(Self::$op => $source),* }
            }

            /// The runtime function, below `staunch_runtime::text`.
            pub const fn function(self) -> &'static str {
                match self { $(Self::$op => stringify!($function)),* }
            }

            /// For each operand, its lane, or `None` for a string.
            pub const fn operands(self) -> &'static [Option<Lane>] {
                match self { $(Self::$op => &[$(text_lane!($ty)),*]),* }
            }

            /// The result's lane, or `None` for a string.
            pub const fn result(self) -> Option<Lane> {
                match self { $(Self::$op => text_lane!($result)),* }
            }
        }

        /// Applies `op` with the runtime's own function; a string result is cut at `capacity`.
        /// `None` when an operand is of the wrong kind, which verified IR excludes.
        pub fn apply_text(op: TextOp, operands: &[TextValue], capacity: u16) -> Option<TextValue> {
            let mut operands = operands.iter();
            match op {
                $(TextOp::$op => {
                    $(let $arg = text_operand!($ty operands.next()?);)*
                    Some(text_result!($result capacity, $function ($($arg),*)))
                })*
            }
        }
    };
}

macro_rules! text_lane {
    (text) => {
        None
    };
    (i16) => {
        Some(Lane::I16)
    };
    (i64) => {
        Some(Lane::I64)
    };
}

macro_rules! text_operand {
    (text $operand:expr) => {{
        let TextValue::Text(bytes) = $operand else { return None };
        bytes.as_slice()
    }};
    ($ty:ident $operand:expr) => {{
        let TextValue::Scalar(value) = $operand else { return None };
        <$ty as Scalar>::from_value(*value)?
    }};
}

macro_rules! text_result {
    (text $capacity:expr, $function:ident ($($arg:ident),*)) => {{
        let mut bytes = vec![0; usize::from($capacity)];
        let mut length = 0;
        text::$function($($arg,)* &mut text::Destination::new(&mut length, &mut bytes));
        bytes.truncate(usize::from(length));
        TextValue::Text(bytes)
    }};
    ($ty:ident $capacity:expr, $function:ident ($($arg:ident),*)) => {
        TextValue::Scalar(text::$function($($arg),*).into_value())
    };
}

for_each_text_op!(declare_text_ops);

impl TextOp {
    /// Finds a function by the name it is called by, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| op.source_name().eq_ignore_ascii_case(name))
    }
}
