/// Every operator and standard function on elementary values, one row each.
///
/// The compiler expands the table into its `Op` enum and the interpreter's dispatch;
/// `staunch-runtime-abi` expands it into the C symbols that native code calls.
///
/// `T` is the lane an operation is instantiated at; the class in brackets says which lanes
/// those are (`with_lane!` lists them). `faults` marks a function that returns
/// `Result<_, FaultKind>`; a `total` one returns its value.
#[macro_export]
macro_rules! for_each_op {
    ($expand:ident) => {
        $expand! {
            // IR name  source     function       operands                     result  lanes       outcome
            Add         "ADD"      add            (a: T, b: T)                  T      [number]    total;
            Sub         "SUB"      sub            (a: T, b: T)                  T      [number]    total;
            Mul         "MUL"      mul            (a: T, b: T)                  T      [number]    total;
            Div         "DIV"      div            (a: T, b: T)                  T      [number]    faults;
            Mod         "MOD"      modulo         (a: T, b: T)                  T      [integer]   faults;
            Neg         "NEG"      neg            (value: T)                    T      [number]    total;
            Abs         "ABS"      abs            (value: T)                    T      [number]    total;
            Expt        "EXPT"     expt           (base: T, exponent: T)        T      [real]      total;
            Sqrt        "SQRT"     sqrt           (value: T)                    T      [real]      total;
            Ln          "LN"       ln             (value: T)                    T      [real]      total;
            Log         "LOG"      log            (value: T)                    T      [real]      total;
            Exp         "EXP"      exp            (value: T)                    T      [real]      total;
            Sin         "SIN"      sin            (value: T)                    T      [real]      total;
            Cos         "COS"      cos            (value: T)                    T      [real]      total;
            Tan         "TAN"      tan            (value: T)                    T      [real]      total;
            Asin        "ASIN"     asin           (value: T)                    T      [real]      total;
            Acos        "ACOS"     acos           (value: T)                    T      [real]      total;
            Atan        "ATAN"     atan           (value: T)                    T      [real]      total;
            Atan2       "ATAN2"    atan2          (y: T, x: T)                  T      [real]      total;
            And         "AND"      and            (a: T, b: T)                  T      [bits]      total;
            Or          "OR"       or             (a: T, b: T)                  T      [bits]      total;
            Xor         "XOR"      xor            (a: T, b: T)                  T      [bits]      total;
            Not         "NOT"      not            (value: T)                    T      [bits]      total;
            Shl         "SHL"      shl            (value: T, count: i64)        T      [integer]   total;
            Shr         "SHR"      shr            (value: T, count: i64)        T      [integer]   total;
            Rol         "ROL"      rol            (value: T, count: i64)        T      [integer]   total;
            Ror         "ROR"      ror            (value: T, count: i64)        T      [integer]   total;
            Eq          "EQ"       eq             (a: T, b: T)                  bool   [any]       total;
            Ne          "NE"       ne             (a: T, b: T)                  bool   [any]       total;
            Lt          "LT"       lt             (a: T, b: T)                  bool   [any]       total;
            Le          "LE"       le             (a: T, b: T)                  bool   [any]       total;
            Gt          "GT"       gt             (a: T, b: T)                  bool   [any]       total;
            Ge          "GE"       ge             (a: T, b: T)                  bool   [any]       total;
            Max         "MAX"      max            (a: T, b: T)                  T      [any]       total;
            Min         "MIN"      min            (a: T, b: T)                  T      [any]       total;
            Limit       "LIMIT"    limit          (min: T, value: T, max: T)    T      [any]       total;
            Sel         "SEL"      sel            (g: bool, in0: T, in1: T)     T      [any]       total;
            // A subrange check: `value` if it lies in `min..=max`, else a fault.
            InRange     "_RANGE"   in_range       (min: T, value: T, max: T)    T      [integer]   faults;
        }
    };
}

/// Runs `$body` with `type $T` set to the lane's primitive, for the lanes of a class; `$other`
/// for every other lane.
#[macro_export]
macro_rules! with_lane {
    (any $lane:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_lane!(@ $lane, $T, $body, $other, []
            Bool bool, I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64, F32 f32, F64 f64)
    };
    (number $lane:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_lane!(@ $lane, $T, $body, $other, [Bool]
            I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64, F32 f32, F64 f64)
    };
    (integer $lane:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_lane!(@ $lane, $T, $body, $other, [Bool F32 F64]
            I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64)
    };
    (real $lane:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_lane!(@ $lane, $T, $body, $other, [Bool I8 I16 I32 I64 U8 U16 U32 U64]
            F32 f32, F64 f64)
    };
    (bits $lane:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_lane!(@ $lane, $T, $body, $other, [F32 F64]
            Bool bool, I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64)
    };
    (@ $lane:expr, $T:ident, $body:expr, $other:expr, [$($without:ident)*] $($name:ident $rust:ident),*) => {
        match $lane {
            $($crate::Lane::$name => { type $T = $rust; $body })*
            $($crate::Lane::$without => $other,)*
        }
    };
}

/// Every function on character strings, one row each. A `text` operand is a byte slice; a `text`
/// result is written to a destination that cuts it at its capacity.
#[macro_export]
macro_rules! for_each_text_op {
    ($expand:ident) => {
        $expand! {
            // IR name   source      function   operands                                  result
            Compare      "_COMPARE"  compare    (a: text, b: text)                        i16;
            Len          "LEN"       len        (text: text)                              i16;
            Find         "FIND"      find       (text: text, pattern: text)               i16;
            Left         "LEFT"      left       (text: text, count: i64)                  text;
            Right        "RIGHT"     right      (text: text, count: i64)                  text;
            Mid          "MID"       mid        (text: text, count: i64, position: i64)   text;
            Concat       "CONCAT"    concat     (a: text, b: text)                        text;
            Insert       "INSERT"    insert     (text: text, inserted: text, position: i64) text;
            Delete       "DELETE"    delete     (text: text, count: i64, position: i64)   text;
            Replace      "REPLACE"   replace    (text: text, by: text, count: i64, position: i64) text;
        }
    };
}
