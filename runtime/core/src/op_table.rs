//! The operations on elementary values and on strings, one row each, as macros over all rows.

/// Every operator and standard function on elementary values, one row each.
///
/// The compiler expands the table into its `Op` enum and the interpreter's dispatch;
/// `staunch-runtime-abi` expands it into the C symbols that native code calls.
///
/// The parameters are named as in the standard's tables. `T` is the common type of all operands that
/// are `T`. Its class is in brackets, with the reprs for which the operation exists (`with_repr!`
/// lists them; they go beyond the class if a dialect does). `faults` marks a function that
/// returns `Result<_, FaultKind>`; a `total` one returns its value. An `extensible` one takes more
/// operands of its last parameter's kind.
#[macro_export]
macro_rules! for_each_op {
    ($expand:ident) => {
        $expand! {
            // IR name  source     function       parameters                   result  T at reprs                 outcome
            Add         "ADD"      add        (IN1: T, IN2: T) -> T                  [ANY_MAGNITUDE as number]    total extensible;
            Sub         "SUB"      sub        (IN1: T, IN2: T) -> T                  [ANY_MAGNITUDE as number]    total;
            Mul         "MUL"      mul        (IN1: T, IN2: T) -> T                  [ANY_MAGNITUDE as number]    total extensible;
            Div         "DIV"      div        (IN1: T, IN2: T) -> T                  [ANY_MAGNITUDE as number]    faults;
            Mod         "MOD"      modulo     (IN1: T, IN2: T) -> T                  [ANY_INT as integer]         faults;
            // Those of S7, of OpenPLC the second alone.
            DivOrZero   "_DIV_0"   div_or_zero (IN1: T, IN2: T) -> T                 [ANY_NUM as number]          total;
            ModOrZero   "_MOD_0"   modulo_or_zero (IN1: T, IN2: T) -> T              [ANY_INT as integer]         total;
            Neg         "NEG"      neg        (IN: T) -> T                           [ANY_MAGNITUDE as number]    total;
            Abs         "ABS"      abs        (IN: T) -> T                           [ANY_NUM as number]          total;
            Expt        "EXPT"     expt       (IN1: T, IN2: T) -> T                  [ANY_REAL as real]           total;
            Sqrt        "SQRT"     sqrt       (IN: T) -> T                           [ANY_REAL as real]           total;
            Ln          "LN"       ln         (IN: T) -> T                           [ANY_REAL as real]           total;
            Log         "LOG"      log        (IN: T) -> T                           [ANY_REAL as real]           total;
            Exp         "EXP"      exp        (IN: T) -> T                           [ANY_REAL as real]           total;
            Sin         "SIN"      sin        (IN: T) -> T                           [ANY_REAL as real]           total;
            Cos         "COS"      cos        (IN: T) -> T                           [ANY_REAL as real]           total;
            Tan         "TAN"      tan        (IN: T) -> T                           [ANY_REAL as real]           total;
            Asin        "ASIN"     asin       (IN: T) -> T                           [ANY_REAL as real]           total;
            Acos        "ACOS"     acos       (IN: T) -> T                           [ANY_REAL as real]           total;
            Atan        "ATAN"     atan       (IN: T) -> T                           [ANY_REAL as real]           total;
            Atan2       "ATAN2"    atan2      (Y: T, X: T) -> T                      [ANY_REAL as real]           total;
            // Whole numbers of the same type; TRUNC and the conversions make integers.
            Ceil        "_CEIL"    ceil       (IN: T) -> T                           [ANY_REAL as real]           total;
            Floor       "_FLOOR"   floor      (IN: T) -> T                           [ANY_REAL as real]           total;
            Whole       "_WHOLE"   whole      (IN: T) -> T                           [ANY_REAL as real]           total;
            Nearest     "_NEAREST" nearest    (IN: T) -> T                           [ANY_REAL as real]           total;
            // Conversions to integers that keep the low bits of a number which the type does not hold.
            BitsOfNearest "_BITS_EVEN" low_bits_of_nearest (IN: T) -> LINT           [ANY_REAL as real]           total;
            BitsOfHalfAway "_BITS_AWAY" low_bits_of_half_away (IN: T) -> LINT        [ANY_REAL as real]           total;
            BitsOfWhole "_BITS_WHOLE" low_bits_of_whole (IN: T) -> LINT              [ANY_REAL as real]           total;
            // Conversions of OpenPLC, by way of LINT or seconds.
            RoundToLint "_LINT_OF" round_to_lint (IN: T) -> LINT                     [ANY_REAL as real]           total;
            RoundToUlint "_ULINT_OF" round_to_ulint (IN: T) -> LINT                  [ANY_REAL as real]           total;
            TimeOfSeconds "_TIME_OF" time_of_seconds (IN: T) -> LINT                 [ANY_REAL as real]           total;
            TimeTimes   "_TIME_MUL" time_times (IN: T, BY: LREAL) -> LINT            [ANY_INT as long]            total;
            TimeOver    "_TIME_DIV" time_over (IN: T, BY: LREAL) -> LINT             [ANY_INT as long]            total;
            LimitLow    "_LIMIT_LOW" limit_low_first (MN: T, IN: T, MX: T) -> T      [ANY_ELEMENTARY as any]      total;
            // LIMIT of OpenPLC from v4.1 on.
            LimitFirst  "_LIMIT_FIRST" limit_first (MN: T, IN: T, MX: T) -> T        [ANY_ELEMENTARY as any]      total;
            // LIMIT on S7.
            LimitInOrder "_LIMIT_IN" limit_in_order (MN: T, IN: T, MX: T) -> T       [ANY_ELEMENTARY as any]      total;
            TimePlus    "_TIME_ADD" time_plus (IN1: T, IN2: T) -> T                  [ANY_INT as long]            total;
            TimeMinus   "_TIME_SUB" time_minus (IN1: T, IN2: T) -> T                 [ANY_INT as long]            total;
            AbsIfBelow  "_ABS"     abs_if_below (IN: T) -> T                         [ANY_NUM as number]          total;
            // Conversions of both systems that compile to C, as x86-64 makes them.
            AwayFromZero "_AWAY"   away_from_zero (IN: T) -> LREAL                   [ANY_REAL as real]           total;
            TruncDint   "_TRUNC_DINT" trunc_to_dint (IN: T) -> LINT                  [ANY_REAL as real]           total;
            TruncLint   "_TRUNC_LINT" trunc_to_lint (IN: T) -> LINT                  [ANY_REAL as real]           total;
            TruncUlint  "_TRUNC_ULINT" trunc_to_ulint (IN: T) -> LINT                [ANY_REAL as real]           total;
            OfBcdOrZero "_OF_BCD"  from_bcd_or_zero (IN: T) -> T                     [ANY_INT as long]            total;
            BcdOf       "_BCD_OF"  bcd_of     (IN: T) -> T                           [ANY_INT as long]            total;
            SecondsOf   "_SECONDS_OF" seconds_of (IN: T) -> LREAL                    [ANY_INT as long]            total;
            And         "AND"      and        (IN1: T, IN2: T) -> T                  [ANY_BIT as bits]            total extensible;
            Or          "OR"       or         (IN1: T, IN2: T) -> T                  [ANY_BIT as bits]            total extensible;
            Xor         "XOR"      xor        (IN1: T, IN2: T) -> T                  [ANY_BIT as bits]            total extensible;
            Not         "NOT"      not        (IN: T) -> T                           [ANY_BIT as bits]            total;
            Shl         "SHL"      shl        (IN: T, N: ANY_INT) -> T               [ANY_BIT as integer]         total;
            Shr         "SHR"      shr        (IN: T, N: ANY_INT) -> T               [ANY_BIT as integer]         total;
            // SHR of a signed integer in CODESYS.
            Sar         "_SAR"     sar        (IN: T, N: ANY_INT) -> T               [ANY_BIT as integer]         total;
            Rol         "ROL"      rol        (IN: T, N: ANY_INT) -> T               [ANY_BIT as integer]         total;
            Ror         "ROR"      ror        (IN: T, N: ANY_INT) -> T               [ANY_BIT as integer]         total;
            // The bytes in the other order.
            SwapBytes   "_SWAP"    swap_bytes (IN: T) -> T                           [ANY_ELEMENTARY as any]      total;
            // Decimal digits of four bits each.
            FromBcd     "_FROM_BCD" from_bcd  (IN: T) -> T                           [ANY_INT as long]            total;
            ToBcd       "_TO_BCD"  to_bcd     (IN: T) -> T                           [ANY_INT as long]            total;
            // Those of S7: so many digits, and a sign in four bits above them.
            FromSignedBcd "_FROM_BCD_S" from_signed_bcd (IN: T, DIGITS: ANY_INT) -> T [ANY_INT as long]           faults;
            ToSignedBcd "_TO_BCD_S" to_signed_bcd (IN: T, DIGITS: ANY_INT) -> T      [ANY_INT as long]            faults;
            // ENCO and FRAC of S7.
            FirstBit    "_ENCO"    first_bit  (IN: T) -> INT                         [ANY_BIT as integer]         total;
            Fraction    "_FRAC"    fraction   (IN: T) -> T                           [ANY_REAL as real]           total;
            Eq          "EQ"       eq         (IN1: T, IN2: T) -> BOOL               [ANY_ELEMENTARY as any]      total extensible;
            Ne          "NE"       ne         (IN1: T, IN2: T) -> BOOL               [ANY_ELEMENTARY as any]      total;
            Lt          "LT"       lt         (IN1: T, IN2: T) -> BOOL               [ANY_ELEMENTARY as any]      total extensible;
            Le          "LE"       le         (IN1: T, IN2: T) -> BOOL               [ANY_ELEMENTARY as any]      total extensible;
            Gt          "GT"       gt         (IN1: T, IN2: T) -> BOOL               [ANY_ELEMENTARY as any]      total extensible;
            Ge          "GE"       ge         (IN1: T, IN2: T) -> BOOL               [ANY_ELEMENTARY as any]      total extensible;
            Max         "MAX"      max        (IN1: T, IN2: T) -> T                  [ANY_ELEMENTARY as any]      total extensible;
            Min         "MIN"      min        (IN1: T, IN2: T) -> T                  [ANY_ELEMENTARY as any]      total extensible;
            Limit       "LIMIT"    limit      (MN: T, IN: T, MX: T) -> T             [ANY_ELEMENTARY as any]      total;
            Sel         "SEL"      sel        (G: BOOL, IN0: T, IN1: T) -> T         [ANY as any]                 total;
            // A subrange check: IN if it is in MN..MX, else a fault.
            InRange     "_RANGE"   in_range   (MN: T, IN: T, MX: T) -> T             [ANY_INT as integer]         faults;
            // What a reference is after a step of N bytes: only the lower half changes.
            Advance     "_ADVANCE" advance    (IN: T, N: ANY_INT) -> T               [ANY_BIT as integer]         total;
            // An index that is checked before its element: IN if it is in MN..MX, else a fault.
            CheckIndex  "_INDEX"   checked_index (MN: T, IN: T, MX: T) -> T          [ANY_INT as integer]         faults;
            // Points in time and what they are made of, in nanoseconds.
            WholeUnits  "_UNITS"   whole_units (IN: T, UNIT: T) -> T                 [ANY_DATE as long]           total;
            StartOfDay  "_DATE"    start_of_day (IN: T) -> T                         [ANY_DATE as long]           total;
            TimeOfDay   "_TOD"     time_of_day (IN: T) -> T                          [ANY_DATE as long]           total;
            DayOf       "_DAY_OF"  day_of     (YEAR: T, MONTH: T, DAY: T) -> T       [ANY_INT as long]            faults;
            ClockOf     "_CLOCK_OF" clock_of  (HOUR: T, MINUTE: T, SECOND: T, MILLISECOND: T) -> T [ANY_INT as long] faults;
            PointOf     "_POINT_OF" point_of  (DAY: T, CLOCK: T) -> T                [ANY_DATE as long]           faults;
            YearOf      "_YEAR"    year       (IN: T) -> T                           [ANY_DATE as long]           total;
            MonthOf     "_MONTH"   month      (IN: T) -> T                           [ANY_DATE as long]           total;
            DayOfMonth  "_DAY"     day        (IN: T) -> T                           [ANY_DATE as long]           total;
            Weekday     "_WEEKDAY" weekday    (IN: T) -> T                           [ANY_DATE as long]           total;
        }
    };
}

/// Runs `$body` with `type $T` set to the repr's primitive, for the reprs of a class; `$other`
/// for every other repr.
#[macro_export]
macro_rules! with_repr {
    (any $repr:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_repr!(@ $repr, $T, $body, $other, []
            Bool bool, I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64, F32 f32, F64 f64)
    };
    (number $repr:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_repr!(@ $repr, $T, $body, $other, [Bool]
            I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64, F32 f32, F64 f64)
    };
    (integer $repr:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_repr!(@ $repr, $T, $body, $other, [Bool F32 F64]
            I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64)
    };
    (real $repr:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_repr!(@ $repr, $T, $body, $other, [Bool I8 I16 I32 I64 U8 U16 U32 U64]
            F32 f32, F64 f64)
    };
    (long $repr:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_repr!(@ $repr, $T, $body, $other, [Bool I8 I16 I32 U8 U16 U32 U64 F32 F64] I64 i64)
    };
    (bits $repr:expr, $T:ident => $body:expr, $other:expr) => {
        $crate::with_repr!(@ $repr, $T, $body, $other, [F32 F64]
            Bool bool, I8 i8, I16 i16, I32 i32, I64 i64, U8 u8, U16 u16, U32 u32, U64 u64)
    };
    (@ $repr:expr, $T:ident, $body:expr, $other:expr, [$($without:ident)*] $($name:ident $rust:ident),*) => {
        match $repr {
            $($crate::Repr::$name => { type $T = $rust; $body })*
            $($crate::Repr::$without => $other,)*
        }
    };
}

/// Every function on character strings, one row each, as in [`for_each_op!`]. A string operand is a
/// slice of units; a string result is written to a destination that cuts it at its capacity. The
/// brackets show for which strings the function exists: `each` for STRINGs and for WSTRINGs, where
/// ANY_STRING is the common type of all operands and the result; `one` for those that the row names.
#[macro_export]
macro_rules! for_each_text_op {
    ($expand:ident) => {
        $expand! {
            // IR name   source      function   parameters                                            result
            Compare      "_COMPARE"  compare    (IN1: ANY_STRING, IN2: ANY_STRING) -> INT [each];
            Len          "LEN"       len        (IN: ANY_STRING) -> INT [each];
            Find         "FIND"      find       (IN1: ANY_STRING, IN2: ANY_STRING) -> INT [each];
            Left         "LEFT"      left       (IN: ANY_STRING, L: ANY_INT) -> ANY_STRING [each];
            Right        "RIGHT"     right      (IN: ANY_STRING, L: ANY_INT) -> ANY_STRING [each];
            Mid          "MID"       mid        (IN: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            Concat       "CONCAT"    concat     (IN1: ANY_STRING, IN2: ANY_STRING) -> ANY_STRING [each] extensible;
            Insert       "INSERT"    insert     (IN1: ANY_STRING, IN2: ANY_STRING, P: ANY_INT) -> ANY_STRING [each];
            Delete       "DELETE"    delete     (IN: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            Replace      "REPLACE"   replace    (IN1: ANY_STRING, IN2: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            // Those of OpenPLC.
            CompareStart "_COMPARE_START" compare_start (IN1: ANY_STRING, IN2: ANY_STRING) -> INT [each];
            FindOrEnd    "_FIND_OR_END" find_or_end (IN1: ANY_STRING, IN2: ANY_STRING) -> INT [each];
            ReplaceUpTo  "_REPLACE_UP_TO" replace_up_to (IN1: ANY_STRING, IN2: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            MidOrLength  "_MID_OR_LENGTH" mid_or_length (IN: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            InsertFrom   "_INSERT_FROM" insert_from (IN1: ANY_STRING, IN2: ANY_STRING, P: ANY_INT) -> ANY_STRING [each];
            DeleteFrom   "_DELETE_FROM" delete_from (IN: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            FromBits     "_FROM_BITS"  from_bits  (IN: ULINT) -> STRING [one];
            FromGeneral  "_FROM_GENERAL" from_general (IN: LREAL) -> STRING [one];
            FromSeconds  "_FROM_SECONDS" from_seconds (IN: LINT, KIND: LINT) -> STRING [one];
            ToBoolWord   "_TO_BOOL_WORD" to_bool_word (IN: STRING) -> BOOL [one];
            ToLintBack   "_TO_LINT_BACK" to_lint_back (IN: STRING) -> LINT [one];
            ToLrealDot   "_TO_LREAL_DOT" to_lreal_dot (IN: STRING) -> LREAL [one];
            // Those of OpenPLC from v4.1 on.
            LeftOrAll    "_LEFT_OR_ALL" left_or_all (IN: ANY_STRING, L: ANY_INT) -> ANY_STRING [each];
            RightOrAll   "_RIGHT_OR_ALL" right_or_all (IN: ANY_STRING, L: ANY_INT) -> ANY_STRING [each];
            MidWithin    "_MID_WITHIN" mid_within (IN: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            InsertBefore "_INSERT_BEFORE" insert_before (IN1: ANY_STRING, IN2: ANY_STRING, P: ANY_INT) -> ANY_STRING [each];
            DeleteWithin "_DELETE_WITHIN" delete_within (IN: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            ReplaceWithin "_REPLACE_WITHIN" replace_within (IN1: ANY_STRING, IN2: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING [each];
            FromShort    "_FROM_SHORT" from_short (IN: LREAL) -> STRING [one];
            ToBoolLetter "_TO_BOOL_LETTER" to_bool_letter (IN: STRING) -> BOOL [one];
            ToLintFront  "_TO_LINT_FRONT" to_lint_front (IN: STRING) -> LINT [one];
            ToUlintFront "_TO_ULINT_FRONT" to_ulint_front (IN: STRING) -> ULINT [one];
            // Text of values, and values of text.
            FromBool     "_FROM_BOOL"  from_bool  (IN: BOOL) -> STRING [one];
            FromLint     "_FROM_LINT"  from_lint  (IN: LINT) -> STRING [one];
            FromUlint    "_FROM_ULINT" from_ulint (IN: ULINT) -> STRING [one];
            FromReal     "_FROM_REAL"  from_real  (IN: REAL) -> STRING [one];
            FromLreal    "_FROM_LREAL" from_lreal (IN: LREAL) -> STRING [one];
            FromTime     "_FROM_TIME"  from_time  (IN: LINT, KIND: LINT) -> STRING [one];
            ToBool       "_TO_BOOL"    to_bool    (IN: STRING) -> BOOL [one];
            ToLint       "_TO_LINT"    to_lint    (IN: STRING) -> LINT [one];
            ToUlint      "_TO_ULINT"   to_ulint   (IN: STRING) -> ULINT [one];
            // Those of S7.
            ToLintOr0    "_TO_LINT_0"  to_lint_or_0   (IN: STRING) -> LINT [one];
            ToUlintOr0   "_TO_ULINT_0" to_ulint_or_0  (IN: STRING) -> ULINT [one];
            ToReal       "_TO_REAL"    to_real    (IN: STRING) -> REAL [one];
            ToLreal      "_TO_LREAL"   to_lreal   (IN: STRING) -> LREAL [one];
            ToFixedReal  "_TO_FIXED_REAL"  to_fixed_real  (IN: STRING) -> REAL [one];
            ToFixedLreal "_TO_FIXED_LREAL" to_fixed_lreal (IN: STRING) -> LREAL [one];
            ToTime       "_TO_TIME"    to_time    (IN: STRING, KIND: LINT) -> LINT [one];
            // Between STRING and WSTRING.
            Widen        "_WIDEN"      widen      (IN: STRING) -> WSTRING [one];
            Narrow       "_NARROW"     narrow     (IN: WSTRING) -> STRING [one];
            // Characters and strings of one of them.
            FromChar     "_FROM_CHAR"  from_char  (IN: CHAR) -> STRING [one];
            FromWchar    "_FROM_WCHAR" from_wchar (IN: WCHAR) -> WSTRING [one];
            ToChar       "_TO_CHAR"    to_char    (IN: STRING) -> CHAR [one];
            ToWchar      "_TO_WCHAR"   to_wchar   (IN: WSTRING) -> WCHAR [one];
            // A character by the number of those before it, and the string with another one there.
            CharAt       "_CHAR_AT"    char_at    (IN: STRING, P: LINT) -> CHAR [one];
            WcharAt      "_WCHAR_AT"   wchar_at   (IN: WSTRING, P: LINT) -> WCHAR [one];
            WithChar     "_WITH_CHAR"  with_char  (IN: STRING, P: LINT, C: CHAR) -> STRING [one];
            WithWchar    "_WITH_WCHAR" with_wchar (IN: WSTRING, P: LINT, C: WCHAR) -> WSTRING [one];
            NarrowChar   "_NARROW_CHAR" narrow_char (IN: WCHAR) -> CHAR [one];
        }
    };
}

/// Runs `$body` with `type $U` set to the unit of a row's strings. `$wide` selects it for rows of `each`; a row of
/// `one` names its own.
#[doc(hidden)]
#[macro_export]
macro_rules! with_unit {
    (each $wide:expr, $U:ident => $body:expr) => {
        if $wide {
            type $U = u16;
            $body
        } else {
            type $U = u8;
            $body
        }
    };
    (one $wide:expr, $U:ident => $body:expr) => {
        $body
    };
}
