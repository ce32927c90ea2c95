//! What is known of a system and not followed, and what its documents leave open.

use super::systems::{LOGIX_TIMES, MATIEC, SIEMENS_DATES};
use crate::dialect::Dialect;
use staunch_ir::{Part, Use};
use staunch_runtime::{Class, Elementary};

/// A rule of a system that its dialect does not follow: a program that has what uses it may compute otherwise there.
#[derive(Clone, Copy, Debug)]
pub struct NotFollowed {
    pub dialect: Dialect,
    /// What the system does.
    pub what: &'static str,
    pub evidence: &'static str,
    /// What a program has to have for the rule to matter.
    pub uses: Use,
    /// A lint says it where a program uses it: few do, and to most it matters.
    pub is_told: bool,
}

impl NotFollowed {
    const fn told(self) -> Self {
        Self { is_told: true, ..self }
    }
}

/// Whether a dialect does as its system with this part of the language.
pub fn is_followed(dialect: Dialect, part: Part) -> bool {
    otherwise(dialect, part).is_none()
}

/// What a dialect's system does otherwise with this part of the language.
pub fn otherwise(dialect: Dialect, part: Part) -> Option<&'static NotFollowed> {
    NOT_FOLLOWED.iter().find(|it| it.dialect == dialect && it.uses == Use::Part(part))
}

/// The rules that are known, and not followed: a DATE, TOD or DT is 64 bits of nanoseconds in every dialect.
pub const NOT_FOLLOWED: &[NotFollowed] = &[
    not_followed(Dialect::Codesys, Elementary::Date, "32 bits of seconds since 1970: it ends in 2106", CODESYS_DATES),
    not_followed(
        Dialect::Codesys,
        Elementary::Dt,
        "32 bits of seconds since 1970: it ends in 2106, and has no parts of a second",
        CODESYS_DATES,
    ),
    not_followed(Dialect::Codesys, Elementary::Tod, "32 bits of milliseconds: it has no parts of one", CODESYS_DATES),
    NotFollowed {
        dialect: Dialect::Codesys,
        what: "ET is a whole number of milliseconds, as every TIME; here it has the parts that the time of the scan has",
        evidence: "CODESYS help, \"TIME, LTIME\"",
        uses: Use::Part(Part::PartsOfMillisecond),
        is_told: false,
    },
    NotFollowed {
        dialect: Dialect::Siemens,
        what: "ET is a whole number of milliseconds, as every TIME; here it has the parts that the time of the scan has",
        evidence: "S7-1200 manual, 11/2011, table 4-15",
        uses: Use::Part(Part::PartsOfMillisecond),
        is_told: false,
    },
    of_matiec(Use::Type(Elementary::Time), PARTS),
    of_matiec(
        Use::Part(Part::ComparedTimes),
        "a literal may lack a nanosecond, which the machine decides: on x86-64 `T#130ms` is 129999999 ns, and `T#1300ms = T#1.3s` is FALSE",
    ),
    of_matiec(Use::Type(Elementary::Dt), PARTS),
    of_matiec(Use::Type(Elementary::Tod), "it may be negative, or longer than a day: `TOD#00:00:00 - T#1s`"),
    of_matiec(Use::Type(Elementary::Date), "it may have a time of day: `DINT_TO_DATE(1)`"),
    of_matiec(Use::Function("DELETE"), BEFORE),
    of_matiec(Use::Function("REPLACE"), BEFORE),
    of_matiec(Use::Function("SIN"), LAST_DIGIT),
    of_matiec(Use::Function("COS"), LAST_DIGIT),
    of_matiec(Use::Function("TAN"), LAST_DIGIT),
    of_matiec(Use::Function("ASIN"), LAST_DIGIT),
    of_matiec(Use::Function("ACOS"), LAST_DIGIT),
    of_matiec(Use::Function("ATAN"), LAST_DIGIT),
    of_matiec(Use::Function("EXP"), LAST_DIGIT),
    of_matiec(Use::Function("LN"), LAST_DIGIT),
    of_matiec(Use::Function("LOG"), LAST_DIGIT),
    of_matiec(Use::Operator("**", Class::Num), LAST_DIGIT),
    of_strucpp(Use::Function("SIN"), LAST_DIGIT),
    of_strucpp(Use::Function("COS"), LAST_DIGIT),
    of_strucpp(Use::Function("TAN"), LAST_DIGIT),
    of_strucpp(Use::Function("ASIN"), LAST_DIGIT),
    of_strucpp(Use::Function("ACOS"), LAST_DIGIT),
    of_strucpp(Use::Function("ATAN"), LAST_DIGIT),
    of_strucpp(Use::Function("EXP"), LAST_DIGIT),
    of_strucpp(Use::Function("LN"), LAST_DIGIT),
    of_strucpp(Use::Function("LOG"), LAST_DIGIT),
    of_strucpp(Use::Operator("**", Class::Num), LAST_DIGIT),
    of_strucpp(Use::Function("INSERT"), TOO_LONG),
    of_strucpp(Use::Function("REPLACE"), TOO_LONG),
    of_strucpp(
        Use::Conversion(Class::String, Class::Real),
        "`inf`, `nan` and hexadecimal digits are read, and `_` ends it",
    ),
    of_strucpp(
        Use::Conversion(Class::String, Class::Duration),
        "each part may be missing: STRING_TO_TIME('12') is T#12ms",
    )
    .told(),
    of_strucpp(
        Use::Conversion(Class::Elementary, Class::Date),
        "a TOD may be negative, or longer than a day: INT_TO_TOD(-1); DT_TO_DATE and DT_TO_TOD leave the nanoseconds of the DT",
    ),
    of_strucpp(Use::Function("LEN"), NO_SIGN),
    of_strucpp(Use::Function("FIND"), NO_SIGN),
    of_strucpp(
        Use::Operator("-", Class::Date),
        "a DATE is a number of days, and the difference of two is that number in nanoseconds",
    )
    .told(),
    of_strucpp(
        Use::Part(Part::Enable),
        "a statement with a call whose EN is FALSE is skipped, so that its variable keeps its value; within an expression EN is \
         ignored, and a block's own input with that name is never set",
    )
    .told(),
    of_strucpp(Use::Part(Part::Temp), "it keeps its value from call to call"),
    of_matiec(Use::Part(Part::ShiftPastWidth), SHIFTED),
    of_strucpp(Use::Part(Part::ShiftPastWidth), SHIFTED),
    of_matiec(Use::Part(Part::Overflow), OVERFLOWN),
    of_strucpp(Use::Part(Part::Overflow), OVERFLOWN_CPP),
    of_matiec(
        Use::Part(Part::Index),
        "it is not checked: memory outside the array is read or written; here it is a fault",
    ),
    of_matiec(Use::Part(Part::Subrange), UNCHECKED),
    of_strucpp(Use::Part(Part::Subrange), UNCHECKED),
    NotFollowed {
        dialect: Dialect::Codesys,
        what: "it is stored, and the program continues, unless the application has CheckRangeSigned and its like; here it is a fault",
        evidence: "CODESYS help, \"Subrange type\": only these functions check it at run time",
        uses: Use::Part(Part::Subrange),
        is_told: false,
    },
    of_processor(Dialect::Openplc),
    of_processor(Dialect::Openplc4),
    NotFollowed {
        dialect: Dialect::Codesys,
        what: "the target decides whether it is an exception; here it is a fault",
        evidence: "CODESYS help, \"DIV\", \"MOD\"",
        uses: Use::Part(Part::DivisionByZero),
        is_told: false,
    },
    of_strucpp(Use::Part(Part::LimitOfType), ENDLESS),
    of_matiec(Use::Part(Part::LimitOfType), ENDLESS),
    NotFollowed {
        dialect: Dialect::Codesys,
        what: ENDLESS,
        evidence: "CODESYS help, \"FOR\", \"C0266\"",
        uses: Use::Part(Part::LimitOfType),
        is_told: false,
    },
    NotFollowed {
        dialect: Dialect::Siemens,
        what: "a timer keeps the PT that it started with",
        evidence: "S7-1200 manual, 11/2011, table 7-19",
        uses: Use::Part(Part::MovingPreset),
        is_told: false,
    },
    NotFollowed {
        dialect: Dialect::Codesys,
        what: "the parts have no zeros before them: `D#1970-1-1`",
        evidence: "CODESYS help, \"Conversion: DATE, DT, TOD\"",
        uses: Use::Conversion(Class::Date, Class::String),
        is_told: true,
    },
    of_strucpp(Use::Part(Part::EnumStart), "a variable without an initial value starts with number 0, whatever the TYPE says").told(),
    of_strucpp(Use::Part(Part::SubrangeStart), "a variable without an initial value starts with 0").told(),
    of_strucpp(
        Use::Part(Part::NamedNumber),
        "its variables are C++'s integers: 30000 + 10000 into a DINT is 40000, NOT of bits is C++'s `!`, and one in a FUNCTION starts with an arbitrary value",
    ),
    of_strucpp(Use::Part(Part::NamedText), "it holds 254 characters"),
    of_strucpp(
        Use::Part(Part::FunctionOutput),
        "it is the caller's variable: it starts with that variable's value, and keeps it if the body assigns nothing",
    ),
    of_strucpp(
        Use::Part(Part::FunctionDefault),
        "where a call names no input, those that it leaves out are 0 or FALSE",
    ),
    of_strucpp(
        Use::Part(Part::EvaluationOrder),
        "the right operand and the last argument are evaluated first: after `z := 5`, `z + Change(z)` adds the value that Change has given to `z`",
    )
    .told(),
    of_strucpp(Use::Part(Part::InOutCopied), COPIED),
    of_matiec(Use::Part(Part::InOutCopied), COPIED),
    of_matiec(Use::Part(Part::InOutOfFunctionCopied), COPIED),
    of_matiec(Use::Part(Part::InputReadInCall), ONE_BY_ONE),
    of_strucpp(Use::Part(Part::InputReadInCall), ONE_BY_ONE),
    of_strucpp(Use::Part(Part::TargetChanged), LOOKED_UP_AFTER).told(),
    NotFollowed {
        dialect: Dialect::Openplc,
        what: LOOKED_UP_AFTER,
        evidence: "beremiz/matiec 6bb2c33: the C that it writes",
        uses: Use::Part(Part::TargetChanged),
        is_told: true,
    },
    of_strucpp(
        Use::Part(Part::TimeByReal),
        "in an expression it is a double until it is stored: with `t` of 10 ms, `t / 3.0 * 3.0 = t` is TRUE",
    ),
    of_strucpp(Use::Part(Part::NamedOrder), "the names are ignored: the first argument goes to the first input").told(),
    of_strucpp(Use::Part(Part::PositionsOfBlock), "only inputs are counted, so arguments go to the wrong parameters").told(),
    of_strucpp(Use::Part(Part::NoTask), "it runs in the first TASK").told(),
    of_strucpp(Use::Part(Part::ComparedLiterals), "C++ compares addresses, and the linker decides").told(),
    not_followed(
        Dialect::Logix,
        Elementary::Dt,
        "64 bits of microseconds since 1970: it has no fractions of a microsecond",
        LOGIX_TIMES,
    ),
    not_followed(Dialect::Siemens, Elementary::Date, "16 bits of days: from 1990-01-01 to 2168-12-31", SIEMENS_DATES),
];

const UNCHECKED: &str = "it is stored, and the program continues; here it is a fault";

const SHIFTED: &str = "C leaves it undefined, and the compiler and the processor decide: on x86-64 `SHR(DWORD#16#FFFF, n)` with \
                       n = 33 is 16#7FFF";

const OVERFLOWN: &str = "C leaves it undefined, and the compiler and the processor decide: on x86-64 `n + 1 > n` of a DINT is always \
                         TRUE, and its smallest value divided by -1 ends the program";

const OVERFLOWN_CPP: &str = "C++ leaves it undefined, and the compiler and the processor decide: on x86-64 `n + 1 > n` of a DINT may be \
                             TRUE with -O and is FALSE without, and its smallest value divided by -1 ends the program";

const COPIED: &str = "it is copied in before the call and back after it, each one separately: a value that the body writes to one does not show in the others";

const LOOKED_UP_AFTER: &str = "it is looked up after the call, and after the targets before it: the index of `x(i => i, o => list[i])` is the new `i`";

const ONE_BY_ONE: &str = "inputs are assigned one by one: in `x(a := 5, b := x.a)`, `b` is 5";

const NO_SIGN: &str = "arithmetic with its result is unsigned: `LEN(s) - 5 < 0` is FALSE";

const ENDLESS: &str = "the counter wraps, and the loop does not end";

const PARTS: &str = "seconds and nanoseconds are separate: `T#500ms + T#500ms = T#1s` is FALSE, and a literal may lack a \
                     nanosecond: `T#1ms` is 999999 ns on x86-64";

const BEFORE: &str = "the process ends where P is 0";

const LAST_DIGIT: &str = "computed by the C library: the last digit of an LREAL may differ";

const TOO_LONG: &str = "if the result does not fit the first string, the end of the inserted text is dropped";

const fn of_matiec(uses: Use, what: &'static str) -> NotFollowed {
    NotFollowed { dialect: Dialect::Openplc, what, evidence: MATIEC, uses, is_told: false }
}

const fn of_strucpp(uses: Use, what: &'static str) -> NotFollowed {
    NotFollowed { dialect: Dialect::Openplc4, what, evidence: "STruC++ 0.6.1, run", uses, is_told: false }
}

const fn of_processor(dialect: Dialect) -> NotFollowed {
    NotFollowed {
        dialect,
        what: "the processor decides: x86 ends the program, ARM of 64 bits gives 0 and continues; here it is a fault",
        evidence: "C, 6.5.5: undefined; Arm, \"SDIV\", \"UDIV\": 0",
        uses: Use::Part(Part::DivisionByZero),
        is_told: false,
    }
}

const CODESYS_DATES: &str = "CODESYS help, \"DATE\"; Beckhoff Information System, \"Date and time data types\"";

const fn not_followed(dialect: Dialect, ty: Elementary, what: &'static str, evidence: &'static str) -> NotFollowed {
    NotFollowed { dialect, what, evidence, uses: Use::Type(ty), is_told: false }
}

/// An edge of a function, of which this is what every program does, and what vendors say of it.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    pub dialect: Dialect,
    pub what: &'static str,
    pub here: &'static str,
    pub documented: &'static str,
    /// What a program has that may come to it; nothing where too many programs would have it.
    pub uses: &'static [Use],
}

const fn edge(
    dialect: Dialect,
    what: &'static str,
    here: &'static str,
    documented: &'static str,
    uses: &'static [Use],
) -> Edge {
    Edge { dialect, what, here, documented, uses }
}

/// The sum, difference or product, where it is not compared, chosen or divided at once: that is `Part::Overflow`.
const PAST_RANGE: &str = "a DINT or LINT that passes its range";

/// Functions on texts by position.
const BY_POSITION: &[Use] =
    &[Use::Function("MID"), Use::Function("INSERT"), Use::Function("DELETE"), Use::Function("REPLACE")];

/// Where a vendor leaves a value open, or where no page was found: what is done here is a choice.
pub const EDGES: &[Edge] = &[
    edge(
        Dialect::Codesys,
        "`MOD` of a negative number",
        "the dividend's sign, as processors divide",
        "CODESYS help, \"MOD\": \"a non-negative integer\", without an example; Beckhoff, \"MOD\": the integer remainder",
        &[Use::Operator("MOD", Class::Signed)],
    ),
    edge(
        Dialect::Codesys,
        "`SHL`, `SHR` by the type's bits or more",
        "zeros come in, the sign in `SHR` of a signed one",
        "CODESYS help and Beckhoff, \"SHL\", \"SHR\": zeros, or `N MOD` the register's bits, as the target has it",
        &[Use::Function("SHL"), Use::Function("SHR")],
    ),
    edge(
        Dialect::Codesys,
        "`SHL`, `SHR` of a constant without a type",
        "the type that is expected in its place",
        "CODESYS help, \"SHL\": nothing; Beckhoff, TwinCAT 2, \"SHL\": of the smallest type that holds it, so that `SHL(16#F0, 4)` is 0",
        &[Use::Part(Part::ShiftOfConstant)],
    ),
    edge(
        Dialect::Codesys,
        "`TRUNC`, `TRUNC_INT` beyond the type",
        "the low bits",
        "CODESYS help, \"TRUNC\", \"TRUNC_INT\": undefined, depends on the platform",
        &[Use::Function("TRUNC"), Use::Function("TRUNC_INT")],
    ),
    edge(
        Dialect::Codesys,
        "`MID`, `INSERT`, `DELETE`, `REPLACE` with a position or count out of range",
        "acts as the nearest one",
        "CODESYS, library Standard: nothing",
        BY_POSITION,
    ),
    edge(
        Dialect::Codesys,
        "a number with a fraction in an operation with a REAL",
        "a REAL, or an LREAL with `codesys-real-literals = \"lreal\"`",
        "CODESYS help and Beckhoff, \"Typed Literals\": always LREAL, so that `r = 0.1` is FALSE; SA0024: typed by its use",
        // Both are tried.
        &[],
    ),
    edge(
        Dialect::Logix,
        "an integer operation in an expression that has a REAL elsewhere: `d / 2 + 0.5`",
        "of integers",
        "1756-RM003N, p. 649: with a REAL among the operands, those of an instruction convert to REAL; of expressions of ST no page says it",
        &[Use::Conversion(Class::Int, Class::Real)],
    ),
    edge(
        Dialect::Logix,
        "the quotient of an integer and 0",
        "the dividend",
        "1756-RM003N, pp. 277 and 281: only the minor fault",
        &[],
    ),
    edge(
        Dialect::Logix,
        "`MID`, `INSERT`, `DELETE` with an invalid Start or Quantity",
        "acts as the nearest one",
        "Rockwell, \"String Delete (DELETE)\": a minor fault of type 4, code 56; the destination is on no page",
        BY_POSITION,
    ),
    edge(
        Dialect::Logix,
        "an integer with more digits than the real operand",
        "the nearest real, of two the even one",
        "1756-RM006K, p. 543: the same; p. 546: the lower bits are truncated",
        &[Use::Conversion(Class::Int, Class::Real)],
    ),
    edge(
        Dialect::Siemens,
        "a conversion to an integer type that does not hold the number",
        "the nearest value of a real, the low bits of an integer",
        "no page that we read gives the value; ENO is FALSE",
        &[Use::Conversion(Class::Real, Class::Int), Use::Conversion(Class::Int, Class::Int)],
    ),
    edge(
        Dialect::Siemens,
        "the text of a REAL, and spaces before the text of a number",
        "as in `iec`, without spaces",
        "S7-1200 manual, 03/2014, p. 295: no leading `+`, and examples with one, right-justified; 11/2011, table 8-34: '123'",
        &[Use::Conversion(Class::Num, Class::String)],
    ),
    edge(
        Dialect::Siemens,
        "`/` and `MOD` by zero; `LIMIT` with MN above MX",
        "0; IN",
        "the S7-1200 manual's tables of ENO say it, but the pages could not be read again for this table",
        &[Use::Function("LIMIT")],
    ),
    edge(
        Dialect::Siemens,
        "`BCD16_TO_INT` of four bits above 9, `INT_TO_BCD16` of more than three digits",
        "a fault",
        "S7-400 Instruction List, p. 82: only the range",
        &[Use::Function("BCD16_TO_INT"), Use::Function("INT_TO_BCD16")],
    ),
    edge(
        Dialect::Siemens,
        "`TONR` in the call in which IN falls; IN still TRUE after R, or after `RESET_TIMER`",
        "the time up to that call counts; it starts timing again",
        "S7-1200 manual, 11/2011, table 7-19: does not say",
        &[],
    ),
    edge(
        Dialect::Openplc,
        PAST_RANGE,
        "wraps",
        "C11, 6.5: undefined; without -O, as OpenPLC v3 compiles, a stored one wraps; Runtime 4.0 compiles with -O3",
        &[Use::Part(Part::StoredOverflow)],
    ),
    edge(
        Dialect::Openplc4,
        PAST_RANGE,
        "wraps",
        "C++17, 7.1: undefined; Runtime 4.1 compiles with -O1, whose optimizer may assume that it never happens",
        &[Use::Part(Part::StoredOverflow)],
    ),
    edge(
        Dialect::Cscape,
        "every value of an operation, function or conversion on this page",
        "as `iec`",
        "no Horner page was found",
        &[
            Use::Function("MID"),
            Use::Function("INSERT"),
            Use::Function("DELETE"),
            Use::Function("REPLACE"),
            Use::Conversion(Class::Num, Class::String),
            Use::Conversion(Class::Real, Class::Int),
            Use::Operator("/", Class::Int),
            Use::Operator("MOD", Class::Int),
            Use::Type(Elementary::Time),
            Use::Part(Part::FractionBesideReal),
        ],
    ),
];
