//! What each rule is about, and its choices in words.

/// What a rule is about, and its choices in words.
pub(super) trait Choice: Copy {
    const RULE: &'static str;
    fn words(self) -> &'static str;
}

/// Where `+`, `-` and the like of integers and bit strings of fewer than 32 bits are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NarrowIntegers {
    AtTheirType,
    At32Bits,
    AsCPromotes,
    /// Two of one type stay at it; one with a number without a type, or with another type, is promoted.
    MixedAsCPromotes,
}

impl Choice for NarrowIntegers {
    const RULE: &'static str = "integers narrower than 32 bits";

    fn words(self) -> &'static str {
        match self {
            Self::AtTheirType => "at their type",
            Self::At32Bits => "at 32 bits",
            Self::AsCPromotes => "at 32 bits by operators, at their type by functions",
            Self::MixedAsCPromotes => {
                "two of one type at that type; with another type, or a number without one, at 32 bits"
            }
        }
    }
}

/// At which type two numbers of different types are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MixedNumbers {
    HoldsBoth,
    HoldsMost,
    Ranked,
}

impl Choice for MixedNumbers {
    const RULE: &'static str = "numbers of different types";

    fn words(self) -> &'static str {
        match self {
            Self::HoldsBoth => "at a type that holds all values of both; refused if there is none",
            Self::HoldsMost => "at a type that holds all values of both; LINT or LREAL if there is none",
            Self::Ranked => "at the higher of SINT, USINT, INT, UINT, DINT, UDINT, LINT, ULINT, REAL, LREAL",
        }
    }
}

/// What a real becomes that the integer type does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealToInteger {
    Saturates,
    LowBits,
    LowBitsOfLint,
    RoundedByC,
}

impl Choice for RealToInteger {
    const RULE: &'static str = "REAL to integer, out of range";

    fn words(self) -> &'static str {
        match self {
            Self::Saturates => "the nearest value of the type",
            Self::LowBits => "the low bits of the whole number",
            Self::LowBitsOfLint => "the low bits of a LINT; 0 for an unsigned type and a negative value",
            Self::RoundedByC => "the low bits of 32, or of 64 for longer types and UDINT, as C converts on x86-64",
        }
    }
}

/// What a real halfway between two integers becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halves {
    ToEven,
    /// With `LowBits` and `RoundedByC` alone: no other system is known to round so.
    AwayFromZero,
}

impl Choice for Halves {
    const RULE: &'static str = "REAL to integer, halves";

    fn words(self) -> &'static str {
        match self {
            Self::ToEven => "the even one: 2.5 is 2",
            Self::AwayFromZero => "away from zero: 2.5 is 3",
        }
    }
}

/// Which values become TRUE.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToBool {
    NotZero,
    RightmostBit,
}

impl ToBool {
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::NotZero => "`<> 0`",
            Self::RightmostBit => "rightmost bit",
        }
    }
}

/// What a division by zero does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByZero {
    Faults,
    /// The result is the dividend.
    Reported,
    GivesZero,
}

impl ByZero {
    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Faults => "a fault",
            Self::Reported => "for integers the dividend, for reals infinity or NaN; it is reported",
            Self::GivesZero => "0",
        }
    }
}

/// What SHR moves into a negative integer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShrOfSigned {
    Zeros,
    Sign,
}

impl Choice for ShrOfSigned {
    const RULE: &'static str = "SHR of a signed integer";

    fn words(self) -> &'static str {
        match self {
            Self::Zeros => "moves zeros in",
            Self::Sign => "keeps the sign",
        }
    }
}

/// What a number counts that becomes a TIME, or a TIME that becomes a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeAsNumber {
    Microseconds,
    Milliseconds,
    WholeMilliseconds,
    CutMilliseconds,
    Seconds,
}

impl Choice for TimeAsNumber {
    const RULE: &'static str = "TIME as a number";

    fn words(self) -> &'static str {
        match self {
            Self::Microseconds => "microseconds",
            Self::Milliseconds => "milliseconds",
            Self::WholeMilliseconds => "milliseconds; from a REAL, whole ones only",
            Self::CutMilliseconds => "milliseconds; the fraction of a REAL is cut off",
            Self::Seconds => "seconds",
        }
    }
}

/// What passes between a real and a bit string.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealAndBits {
    Value,
    Bits,
}

impl Choice for RealAndBits {
    const RULE: &'static str = "REAL and bit strings";

    fn words(self) -> &'static str {
        match self {
            Self::Value => "the value",
            Self::Bits => "the bits, if both have the same number of bits",
        }
    }
}

/// How many characters a STRING holds that is declared without a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DefaultString {
    Holds80,
    Holds82,
    Holds126,
    Holds254,
}

impl DefaultString {
    pub const fn capacity(self) -> u16 {
        match self {
            Self::Holds80 => 80,
            Self::Holds82 => 82,
            Self::Holds126 => 126,
            Self::Holds254 => 254,
        }
    }
}

impl Choice for DefaultString {
    const RULE: &'static str = "a STRING without a length";

    fn words(self) -> &'static str {
        match self {
            Self::Holds80 => "80 characters",
            Self::Holds82 => "82 characters",
            Self::Holds126 => "126 characters",
            Self::Holds254 => "254 characters",
        }
    }
}

/// How an integer is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegerText {
    Digits,
    SignAndDigits,
}

impl Choice for IntegerText {
    const RULE: &'static str = "text of an integer";

    fn words(self) -> &'static str {
        match self {
            Self::Digits => "`207`",
            Self::SignAndDigits => "`+207`; `207` from an unsigned type",
        }
    }
}

/// What a number counts that becomes a DATE, or a DATE that becomes a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DateAsNumber {
    SecondsSince1970,
    DaysSince1990,
    /// As STruC++ keeps it, but that a TOD or DT becomes a number of milliseconds.
    AsStored,
}

impl Choice for DateAsNumber {
    const RULE: &'static str = "DATE as a number";

    fn words(self) -> &'static str {
        match self {
            Self::SecondsSince1970 => "seconds since 1970-01-01",
            Self::DaysSince1990 => "days since 1990-01-01, where a DATE or DT starts",
            Self::AsStored => "days since 1970-01-01; a TOD or DT is of nanoseconds, and becomes milliseconds",
        }
    }
}

/// Which numbers a text spells that becomes a real.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealOfText {
    WithExponent,
    /// As C reads it, where it has a point.
    AfterPoint,
    FixedPoint,
}

impl Choice for RealOfText {
    const RULE: &'static str = "REAL of a text";

    fn words(self) -> &'static str {
        match self {
            Self::WithExponent => "with an exponent; a comma ends it",
            Self::AfterPoint => {
                "with an exponent, if it has a point; otherwise an integer, in which commas are ignored"
            }
            Self::FixedPoint => "without an exponent; commas are ignored",
        }
    }
}

/// What MID, DELETE and REPLACE give where P is below 1, DELETE and REPLACE where L is below 0, and INSERT where P is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextPositions {
    Nearest,
    OfLibrary,
    Empty,
}

impl Choice for TextPositions {
    const RULE: &'static str = "P < 1 or L < 0 in MID, DELETE and REPLACE, P < 0 in INSERT";

    fn words(self) -> &'static str {
        match self {
            Self::Nearest => "acts as P = 1, L = 0",
            Self::OfLibrary => "as its library of standard functions",
            Self::Empty => "an empty text",
        }
    }
}

/// What LIMIT gives where MN is above MX.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitCrossed {
    Maximum,
    Value,
    Minimum,
    MinimumFirst,
}

impl Choice for LimitCrossed {
    const RULE: &'static str = "LIMIT with MN > MX";

    fn words(self) -> &'static str {
        match self {
            Self::Maximum => "MX",
            Self::Value => "IN; NaN where one is NaN",
            Self::Minimum => "MN, or MX where IN is above MN",
            Self::MinimumFirst => "MN where IN is below it, else MX",
        }
    }
}

/// What SQRT gives below 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SqrtOfNegative {
    NotANumber,
    RootOfMagnitude,
}

impl Choice for SqrtOfNegative {
    const RULE: &'static str = "SQRT of a negative number";

    fn words(self) -> &'static str {
        match self {
            Self::NotANumber => "NaN",
            Self::RootOfMagnitude => "the root of its absolute value",
        }
    }
}

/// Whether MOD takes reals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModuloOfReals {
    Refused,
    Remainder,
}

impl Choice for ModuloOfReals {
    const RULE: &'static str = "MOD of REALs";

    fn words(self) -> &'static str {
        match self {
            Self::Refused => "refused",
            Self::Remainder => "`a - TRUNC(a / b) * b`",
        }
    }
}

/// How many bits ROL and ROR turn of a constant without a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotatedConstant {
    BitsOfPlace,
    FewestBits,
}

impl Choice for RotatedConstant {
    const RULE: &'static str = "ROL and ROR of a constant";

    fn words(self) -> &'static str {
        match self {
            Self::BitsOfPlace => "the bits of the type that is expected in its place",
            Self::FewestBits => "the bits of the smallest type that holds it",
        }
    }
}

/// Which library the standard functions are of, where the standard leaves an edge open or a library departs from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functions {
    OfTheStandard,
    OfMatiec,
    OfStrucpp,
}

impl Functions {
    /// SIN, SQRT and the like of a REAL are computed at LREAL.
    pub const fn computes_at_lreal(self) -> bool {
        matches!(self, Self::OfMatiec | Self::OfStrucpp)
    }
}

impl Choice for Functions {
    const RULE: &'static str = "standard functions";

    fn words(self) -> &'static str {
        match self {
            Self::OfTheStandard => "as in the standard",
            Self::OfMatiec => "as in MATIEC's library",
            Self::OfStrucpp => "as in STruC++'s library",
        }
    }
}

/// What a number is that has no type's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Literals {
    OfTheirPlace,
    OfC,
    Immediate,
    /// Of its place's type, as long as that holds it.
    Smallest,
}

impl Choice for Literals {
    const RULE: &'static str = "a number without a type";

    fn words(self) -> &'static str {
        match self {
            Self::OfTheirPlace => "the type that is expected in its place",
            Self::OfC => "C's `double`, `int` or `long`",
            Self::Immediate => "the type that is expected in its place; in an operation on two such integers, DINT",
            Self::Smallest => {
                "the type that is expected in its place; with an unsigned number or bits that do not hold it, the smallest unsigned type"
            }
        }
    }
}

/// When AND and OR evaluate the second of two BOOLs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SecondBool {
    Always,
    IfItDecides,
}

impl Choice for SecondBool {
    const RULE: &'static str = "the right side of AND and OR of BOOLs";

    fn words(self) -> &'static str {
        match self {
            Self::Always => "evaluated",
            Self::IfItDecides => "evaluated only if the left side does not decide; in `AND(…)` and `OR(…)` always",
        }
    }
}

/// What CASE compares with its labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaseSelector {
    AsComputed,
    Cut,
}

impl Choice for CaseSelector {
    const RULE: &'static str = "what CASE selects by";

    fn words(self) -> &'static str {
        match self {
            Self::AsComputed => "the value as it is computed",
            Self::Cut => "the value cut to its own type",
        }
    }
}

/// What a TIME is a number of. A result that does not fit that number wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    Nanoseconds,
    SecondsAndNanoseconds,
    Microseconds,
    Milliseconds,
    SignedMilliseconds,
}

impl Choice for TimeUnit {
    const RULE: &'static str = "what a TIME is";

    fn words(self) -> &'static str {
        match self {
            Self::Nanoseconds => "64 bits of nanoseconds with a sign",
            Self::SecondsAndNanoseconds => {
                "32 bits of seconds with a sign, and nanoseconds: a day after `T#24855d` is `T#-24854d6h28m16s`"
            }
            Self::Microseconds => "64 bits of microseconds with a sign: `T#3us / 2` is `T#1us`",
            Self::Milliseconds => {
                "32 bits of milliseconds without a sign: `t - T#1ms` of a `t` that is 0 is `T#49d17h2m47s295ms`, `T#5ms / 2` is `T#2ms`"
            }
            Self::SignedMilliseconds => {
                "32 bits of milliseconds with a sign: `t + T#1ms` of the greatest `t` is `T#-24d20h31m23s648ms`, `T#5ms / 2` is `T#2ms`"
            }
        }
    }
}

/// What an LTIME is a number of. A result that does not fit that number wraps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LongTime {
    Signed,
    Unsigned,
}

impl Choice for LongTime {
    const RULE: &'static str = "what an LTIME is";

    fn words(self) -> &'static str {
        match self {
            Self::Signed => "64 bits of nanoseconds with a sign",
            Self::Unsigned => {
                "64 bits of nanoseconds without a sign: none is less than `LTIME#0ns`, and the greatest is `LTIME#213503d23h34m33s709ms551us615ns`"
            }
        }
    }
}

/// When FOR looks at its limit and its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopLimit {
    Once,
    EachTurn,
    EachTurnUpward,
}

impl Choice for LoopLimit {
    const RULE: &'static str = "limit and step of FOR";

    fn words(self) -> &'static str {
        match self {
            Self::Once => "evaluated once",
            Self::EachTurn => "evaluated in each iteration",
            Self::EachTurnUpward => {
                "evaluated in each iteration; it counts down only by a negative number, not by a variable or CONSTANT"
            }
        }
    }
}

/// What starts with the value that its declaration gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialValues {
    Everywhere,
    OfStrucpp,
}

impl Choice for InitialValues {
    const RULE: &'static str = "initial values";

    fn words(self) -> &'static str {
        match self {
            Self::Everywhere => "applied",
            Self::OfStrucpp => {
                "not applied to arrays in a PROGRAM, a STRUCT and VAR_GLOBAL, nor an expression in a PROGRAM and VAR_GLOBAL: these start with 0 (lint W0415)"
            }
        }
    }
}

/// Which PROGRAM of a RESOURCE runs first, where several are due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramOrder {
    ByPriority,
    OfText,
}

impl Choice for ProgramOrder {
    const RULE: &'static str = "order of PROGRAMs in a scan";

    fn words(self) -> &'static str {
        match self {
            Self::ByPriority => "by the PRIORITY of their TASKs",
            Self::OfText => "the order in the RESOURCE's source, whatever the PRIORITY",
        }
    }
}
