//! Rules of values: where systems compute an ordinary operation in different ways, this table says which way each dialect
//! follows, and the page or program that shows it. Whoever checks an operation asks `Dialect::rules`; the operation itself
//! is in the runtime. `docs/dialects.md` has the same table, which a test holds equal.

use super::Dialect;
pub use staunch_ir::Use;
use staunch_runtime::{Class, Elementary};

/// How one dialect computes.
#[derive(Debug)]
pub struct Rules {
    pub narrow_integers: Followed<NarrowIntegers>,
    pub mixed_numbers: Followed<MixedNumbers>,
    pub real_to_integer: Followed<RealToInteger>,
    pub halves: Followed<Halves>,
    pub integer_to_bool: Followed<ToBool>,
    pub bits_to_bool: Followed<ToBool>,
    pub division_by_zero: Followed<ByZero>,
    pub modulo_by_zero: Followed<ByZero>,
    pub shr_of_signed: Followed<ShrOfSigned>,
    pub time_as_number: Followed<TimeAsNumber>,
    pub real_and_bits: Followed<RealAndBits>,
    pub default_string: Followed<DefaultString>,
    pub integer_text: Followed<IntegerText>,
    pub date_as_number: Followed<DateAsNumber>,
    pub real_of_text: Followed<RealOfText>,
    pub text_positions: Followed<TextPositions>,
    pub limit_crossed: Followed<LimitCrossed>,
    pub sqrt_of_negative: Followed<SqrtOfNegative>,
    pub modulo_of_reals: Followed<ModuloOfReals>,
    pub rotated_constant: Followed<RotatedConstant>,
    pub functions: Followed<Functions>,
    pub literals: Followed<Literals>,
}

impl Rules {
    /// Two numbers of different types are computed at the type that ranks higher.
    pub const fn ranks_numbers(&self) -> bool {
        matches!(self.mixed_numbers.choice, MixedNumbers::Ranked)
    }

    /// A division of integers by zero gives the dividend, and the program continues.
    pub const fn divides_by_zero(&self) -> bool {
        matches!(self.division_by_zero.choice, ByZero::Reported)
    }

    /// A real beyond an integer type becomes the low bits of its number.
    pub const fn keeps_low_bits(&self) -> bool {
        matches!(self.real_to_integer.choice, RealToInteger::LowBits)
    }

    /// A real and a bit string of as many bits have the same ones.
    pub const fn copies_bits(&self) -> bool {
        matches!(self.real_and_bits.choice, RealAndBits::Bits)
    }

    pub const fn reads_fixed_point(&self) -> bool {
        matches!(self.real_of_text.choice, RealOfText::FixedPoint)
    }

    pub const fn empties_texts_out_of_range(&self) -> bool {
        matches!(self.text_positions.choice, TextPositions::Empty)
    }

    pub const fn limits_only_in_order(&self) -> bool {
        matches!(self.limit_crossed.choice, LimitCrossed::Value)
    }

    pub const fn takes_root_of_magnitude(&self) -> bool {
        matches!(self.sqrt_of_negative.choice, SqrtOfNegative::RootOfMagnitude)
    }

    pub const fn has_modulo_of_reals(&self) -> bool {
        matches!(self.modulo_of_reals.choice, ModuloOfReals::Remainder)
    }

    pub const fn rotates_constants_at_least_bits(&self) -> bool {
        matches!(self.rotated_constant.choice, RotatedConstant::FewestBits)
    }

    /// Integers and bit strings of fewer than 32 bits are computed at 32, and cut where they are stored.
    pub const fn promotes_integers(&self) -> bool {
        !matches!(self.narrow_integers.choice, NarrowIntegers::AtTheirType)
    }

    /// Bit strings are promoted as well, and a function takes and gives values of its own type, which are cut.
    pub const fn promotes_as_c(&self) -> bool {
        matches!(self.narrow_integers.choice, NarrowIntegers::AsCPromotes | NarrowIntegers::MixedAsCPromotes)
    }

    /// NOT of a bit string of fewer than 32 bits has 32.
    pub const fn complements_as_c(&self) -> bool {
        matches!(self.narrow_integers.choice, NarrowIntegers::AsCPromotes)
    }

    /// Two operands of one type give that type, which they are cut to.
    pub const fn keeps_one_type(&self) -> bool {
        matches!(self.narrow_integers.choice, NarrowIntegers::MixedAsCPromotes)
    }

    pub const fn time_is_seconds(&self) -> bool {
        matches!(self.time_as_number.choice, TimeAsNumber::Seconds)
    }

    pub const fn rounds_to_lint(&self) -> bool {
        matches!(self.real_to_integer.choice, RealToInteger::LowBitsOfLint)
    }

    /// A real is converted as C does on x86-64, after it was rounded.
    pub const fn rounds_by_c(&self) -> bool {
        matches!(self.real_to_integer.choice, RealToInteger::RoundedByC)
    }

    pub const fn keeps_sign(&self) -> bool {
        matches!(self.shr_of_signed.choice, ShrOfSigned::Sign)
    }

    /// A number without a type is a double, an int or a long, as in C.
    pub const fn has_literals_of_c(&self) -> bool {
        matches!(self.literals.choice, Literals::OfC)
    }

    /// Integers without a type are DINTs together, and wrap.
    pub const fn has_immediates(&self) -> bool {
        matches!(self.literals.choice, Literals::Immediate)
    }

    pub const fn writes_plus(&self) -> bool {
        matches!(self.integer_text.choice, IntegerText::SignAndDigits)
    }
}

/// A choice, and the page or program that shows that the system makes it.
#[derive(Clone, Copy, Debug)]
pub struct Followed<T> {
    pub choice: T,
    pub evidence: &'static str,
}

const fn follows<T>(choice: T, evidence: &'static str) -> Followed<T> {
    Followed { choice, evidence }
}

/// What a rule is about, and its choices in words.
trait Choice: Copy {
    const RULE: &'static str;
    fn words(self) -> &'static str;
}

/// Where `+`, `-` and the like of integers and bit strings of fewer than 32 bits are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NarrowIntegers {
    AtTheirType,
    At32Bits,
    AsCPromotes,
    /// Two of one type stay at it; one beside a number without a type, or beside another type, is promoted.
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
                "two of one type at that; beside another type, or a number without one, at 32 bits"
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
            Self::HoldsBoth => "at one that holds all values of both; refused where there is none",
            Self::HoldsMost => "at one that holds all values of both; LINT or LREAL where there is none",
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

/// What a real becomes that lies in the middle of two integers.
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
    const fn words(self) -> &'static str {
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
    const fn words(self) -> &'static str {
        match self {
            Self::Faults => "a fault",
            Self::Reported => "the dividend; of integers, it is reported",
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
    Milliseconds,
    WholeMilliseconds,
    CutMilliseconds,
    Seconds,
}

impl Choice for TimeAsNumber {
    const RULE: &'static str = "TIME as a number";

    fn words(self) -> &'static str {
        match self {
            Self::Milliseconds => "milliseconds",
            Self::WholeMilliseconds => "milliseconds; of a REAL whole ones",
            Self::CutMilliseconds => "milliseconds; of a REAL the fraction is cut",
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
            Self::Bits => "the bits, where there are as many",
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
            Self::SignAndDigits => "`+207`",
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
            Self::DaysSince1990 => "days since 1990-01-01",
            Self::AsStored => "days since 1970-01-01; a TOD or DT is of nanoseconds, and becomes milliseconds",
        }
    }
}

/// Which numbers a text spells that becomes a real.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealOfText {
    WithExponent,
    FixedPoint,
}

impl Choice for RealOfText {
    const RULE: &'static str = "REAL of a text";

    fn words(self) -> &'static str {
        match self {
            Self::WithExponent => "with an exponent; a comma ends it",
            Self::FixedPoint => "without an exponent; commas are passed over",
        }
    }
}

/// What MID, DELETE and REPLACE give where P is below 1, DELETE and REPLACE where L is below 0, and INSERT where P is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextPositions {
    Nearest,
    Empty,
}

impl Choice for TextPositions {
    const RULE: &'static str = "P < 1 or L < 0 in MID, DELETE and REPLACE, P < 0 in INSERT";

    fn words(self) -> &'static str {
        match self {
            Self::Nearest => "acts as P = 1, L = 0",
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
            Self::BitsOfPlace => "bits of the type of its place",
            Self::FewestBits => "bits of the smallest type that holds it",
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
            Self::OfTheStandard => "as the standard",
            Self::OfMatiec => "as MATIEC's library",
            Self::OfStrucpp => "as STruC++'s library",
        }
    }
}

/// What a number is that has no type's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Literals {
    OfTheirPlace,
    OfC,
    Immediate,
}

impl Choice for Literals {
    const RULE: &'static str = "a number without a type";

    fn words(self) -> &'static str {
        match self {
            Self::OfTheirPlace => "of its place's type",
            Self::OfC => "C's `double`, `int` or `long`",
            Self::Immediate => "of its place's type; two integers together are DINTs",
        }
    }
}

const IEC: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::AtTheirType, "IEC 61131-3, 6.6.2.5.4: a result has its operands' type"),
    mixed_numbers: follows(MixedNumbers::HoldsBoth, "IEC 61131-3, figure 11"),
    real_to_integer: follows(RealToInteger::Saturates, "IEC 61131-3, table 22: left to the implementer"),
    halves: follows(Halves::ToEven, "IEC 61131-3, table 22: as IEC 60559 rounds"),
    integer_to_bool: follows(ToBool::NotZero, "left to the implementer; no system is known that does otherwise"),
    bits_to_bool: follows(ToBool::RightmostBit, "IEC 61131-3, table 24"),
    division_by_zero: follows(ByZero::Faults, "IEC 61131-3, table A.1: an error"),
    modulo_by_zero: follows(ByZero::Faults, "IEC 61131-3, table A.1: an error"),
    shr_of_signed: follows(ShrOfSigned::Zeros, "IEC 61131-3, table 30: of bit strings"),
    time_as_number: follows(TimeAsNumber::Milliseconds, "left to the implementer"),
    real_and_bits: follows(RealAndBits::Value, "left to the implementer"),
    default_string: follows(DefaultString::Holds254, "left to the implementer"),
    integer_text: follows(IntegerText::Digits, "left to the implementer"),
    date_as_number: follows(DateAsNumber::SecondsSince1970, "left to the implementer; as CODESYS help, \"DATE\""),
    real_of_text: follows(RealOfText::WithExponent, "left to the implementer"),
    text_positions: follows(TextPositions::Nearest, "IEC 61131-3, table 34, does not say it"),
    limit_crossed: follows(LimitCrossed::Maximum, "IEC 61131-3, table 32: MIN(MAX(IN, MN), MX)"),
    sqrt_of_negative: follows(SqrtOfNegative::NotANumber, "IEC 60559, as IEC 61131-3 has REAL"),
    modulo_of_reals: follows(ModuloOfReals::Refused, "IEC 61131-3, table 29: of ANY_INT"),
    rotated_constant: follows(RotatedConstant::BitsOfPlace, "no page says it"),
    functions: follows(Functions::OfTheStandard, "IEC 61131-3, 6.6.2.5"),
    literals: follows(Literals::OfTheirPlace, "IEC 61131-3, 6.3.3; REAL and LREAL are left to the implementer"),
};

/// The choice of another dialect, where no page of the vendor says anything.
const fn undocumented<T: Copy>(rule: Followed<T>) -> Followed<T> {
    Followed { choice: rule.choice, evidence: "no page of Horner says it; as `iec`" }
}

const CSCAPE: Rules = Rules {
    narrow_integers: undocumented(IEC.narrow_integers),
    mixed_numbers: undocumented(IEC.mixed_numbers),
    real_to_integer: undocumented(IEC.real_to_integer),
    halves: undocumented(IEC.halves),
    integer_to_bool: undocumented(IEC.integer_to_bool),
    bits_to_bool: undocumented(IEC.bits_to_bool),
    division_by_zero: undocumented(IEC.division_by_zero),
    modulo_by_zero: undocumented(IEC.modulo_by_zero),
    shr_of_signed: undocumented(IEC.shr_of_signed),
    time_as_number: undocumented(IEC.time_as_number),
    real_and_bits: undocumented(IEC.real_and_bits),
    default_string: follows(DefaultString::Holds80, "no page of Horner says it; as CODESYS"),
    integer_text: undocumented(IEC.integer_text),
    date_as_number: undocumented(IEC.date_as_number),
    real_of_text: undocumented(IEC.real_of_text),
    text_positions: undocumented(IEC.text_positions),
    limit_crossed: undocumented(IEC.limit_crossed),
    sqrt_of_negative: undocumented(IEC.sqrt_of_negative),
    modulo_of_reals: undocumented(IEC.modulo_of_reals),
    rotated_constant: undocumented(IEC.rotated_constant),
    functions: undocumented(IEC.functions),
    literals: undocumented(IEC.literals),
};

const CODESYS: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::At32Bits, "CODESYS help, \"Operands\""),
    mixed_numbers: follows(MixedNumbers::HoldsMost, "CODESYS help, \"C0195\", \"C0197\": warnings, not errors"),
    real_to_integer: follows(RealToInteger::LowBits, CODESYS_REALS),
    halves: follows(Halves::AwayFromZero, "CODESYS help, \"Conversion: REAL, LREAL\": 5 to 9 after the point round up"),
    integer_to_bool: follows(ToBool::NotZero, "CODESYS help, \"Integer conversion\""),
    bits_to_bool: follows(ToBool::NotZero, "CODESYS help, \"Integer conversion\""),
    division_by_zero: follows(ByZero::Faults, CODESYS_BY_ZERO),
    modulo_by_zero: follows(ByZero::Faults, CODESYS_BY_ZERO),
    shr_of_signed: follows(ShrOfSigned::Sign, "CODESYS help, \"SHR\""),
    default_string: follows(DefaultString::Holds80, "CODESYS help, \"STRING\""),
    time_as_number: follows(TimeAsNumber::WholeMilliseconds, "CODESYS help, \"REAL / LREAL conversion\""),
    limit_crossed: follows(LimitCrossed::Maximum, "CODESYS help and Beckhoff, \"LIMIT\": MIN(MAX(IN, Min), Max)"),
    rotated_constant: follows(RotatedConstant::FewestBits, "CODESYS help, \"ROL\", \"ROR\"; Beckhoff, \"ROL\""),
    ..IEC
};

const CODESYS_REALS: &str = "CODESYS help, \"Conversion: REAL, LREAL\": the first bytes are not taken into account; \
                             Beckhoff, \"REAL/LREAL_TO_<type>\", leaves it undefined";

const CODESYS_BY_ZERO: &str =
    "Beckhoff, \"DIV\", \"MOD\": an exception, which stops the task; CODESYS help leaves it to the target";

/// MATIEC's C, as gcc compiles it for x86-64: programs were compiled by it and run.
const OPENPLC: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::AsCPromotes, MATIEC),
    real_to_integer: follows(RealToInteger::LowBitsOfLint, MATIEC),
    integer_to_bool: follows(ToBool::NotZero, MATIEC),
    bits_to_bool: follows(ToBool::NotZero, MATIEC),
    modulo_by_zero: follows(ByZero::GivesZero, MATIEC),
    time_as_number: follows(TimeAsNumber::Seconds, MATIEC),
    limit_crossed: follows(LimitCrossed::Minimum, MATIEC),
    default_string: follows(DefaultString::Holds126, MATIEC),
    functions: follows(Functions::OfMatiec, MATIEC),
    literals: follows(Literals::OfC, MATIEC),
    ..IEC
};

/// The compiler whose programs were run, by its commit.
const MATIEC: &str = "thiagoralves/matiec f9ca9ba, run";

const OPENPLC4: Rules = Rules {
    narrow_integers: follows(
        NarrowIntegers::MixedAsCPromotes,
        "STruC++ 0.6.1, run: INT 30000 + 10000 into a DINT is -25536; `SINT#127 + 1 > 100` is TRUE",
    ),
    mixed_numbers: follows(MixedNumbers::Ranked, "STruC++ 0.6.1: the usual arithmetic conversions of C++"),
    real_to_integer: follows(RealToInteger::RoundedByC, "STruC++ 0.6.1, run: REAL_TO_INT(40000.0) is -25536"),
    halves: follows(Halves::AwayFromZero, "STruC++ 0.6.1, run: REAL_TO_INT(2.5) is 3"),
    integer_to_bool: follows(ToBool::NotZero, "STruC++ 0.6.1, run: INT_TO_BOOL(256) is TRUE"),
    bits_to_bool: follows(ToBool::NotZero, "STruC++ 0.6.1, run: BYTE_TO_BOOL(16#02) is TRUE"),
    division_by_zero: follows(ByZero::Faults, "STruC++ 0.6.1, run: the process ends"),
    modulo_by_zero: follows(ByZero::Faults, "STruC++ 0.6.1: as the division"),
    shr_of_signed: follows(ShrOfSigned::Sign, "STruC++ 0.6.1, run: SHR(-8, 1) is -4"),
    time_as_number: follows(TimeAsNumber::CutMilliseconds, "STruC++ 0.6.1, run: REAL_TO_TIME(2.9) is T#2ms"),
    real_and_bits: follows(RealAndBits::Value, "STruC++ 0.6.1, run: REAL_TO_DWORD(1.5) is 2"),
    default_string: follows(DefaultString::Holds254, "STruC++ 0.6.1: STRING_LENGTH"),
    integer_text: follows(IntegerText::Digits, "STruC++ 0.6.1, run: INT_TO_STRING(207)"),
    date_as_number: follows(DateAsNumber::AsStored, "STruC++ 0.6.1, run: DATE_TO_DINT(D#1999-03-01) is 10651"),
    limit_crossed: follows(LimitCrossed::MinimumFirst, "STruC++ 0.6.1, run: LIMIT(7, 1, 1) is 7"),
    functions: follows(Functions::OfStrucpp, "STruC++ 0.6.1, run: INSERT('ABC', 'X', 1) is 'XABC'"),
    literals: follows(Literals::OfC, "STruC++ 0.6.1, run: `REAL#0.1 - 0.30000001` is -0.200000003"),
    ..IEC
};

const LOGIX: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::At32Bits, "1756-RM006K, p. 541: SINT and INT are made DINT"),
    mixed_numbers: follows(MixedNumbers::Ranked, "1756-RM006K, p. 541"),
    default_string: follows(DefaultString::Holds82, "1756-RM003, \"String types\""),
    real_to_integer: follows(RealToInteger::LowBits, "1756-RM006K, p. 544: the bits that fit are stored"),
    halves: follows(Halves::ToEven, "1756-RM006K, p. 544; 1756-RM003N, p. 653"),
    division_by_zero: follows(
        ByZero::Reported,
        "1756-RM003N, p. 277: a minor fault of type 4, code 4; the quotient is on no page",
    ),
    modulo_by_zero: follows(ByZero::Reported, "1756-RM003N, p. 281: a minor fault; A - TRN(A / B) * B"),
    sqrt_of_negative: follows(SqrtOfNegative::RootOfMagnitude, "1756-RM003, \"Square Root\""),
    modulo_of_reals: follows(ModuloOfReals::Remainder, "1756-RM003N, p. 279, \"Modulo\""),
    literals: follows(Literals::Immediate, "1756-RM006K, p. 545: immediate values are DINTs"),
    ..IEC
};

const SIEMENS: Rules = Rules {
    halves: follows(Halves::ToEven, "S7-1200 manual, \"ROUND\""),
    division_by_zero: follows(ByZero::GivesZero, SIEMENS_BY_ZERO),
    modulo_by_zero: follows(ByZero::GivesZero, SIEMENS_BY_ZERO),
    shr_of_signed: follows(ShrOfSigned::Sign, "S7-1200 manual, \"SHR\""),
    integer_text: follows(IntegerText::SignAndDigits, "S7-1200 manual, 11/2011, p. 247, table 8-33"),
    real_and_bits: follows(RealAndBits::Bits, "S7-1200 manual, \"CONV\""),
    date_as_number: follows(DateAsNumber::DaysSince1990, SIEMENS_DATES),
    real_of_text: follows(RealOfText::FixedPoint, "S7-1200 manual, 11/2011, p. 247, table 8-33"),
    text_positions: follows(TextPositions::Empty, "S7-1200 manual, 03/2014, tables 8-57, 8-60, 8-63 and 8-66"),
    limit_crossed: follows(LimitCrossed::Value, "S7-1200 manual, \"LIMIT\", ENO status"),
    ..IEC
};

const SIEMENS_BY_ZERO: &str = "S7-1200 manual, \"DIV\", \"MOD\", ENO status: 0 is returned";

impl Dialect {
    pub const fn rules(self) -> &'static Rules {
        match self {
            Self::Iec => &IEC,
            Self::Cscape => &CSCAPE,
            Self::Codesys => &CODESYS,
            Self::Openplc => &OPENPLC,
            Self::Openplc4 => &OPENPLC4,
            Self::Logix => &LOGIX,
            Self::Siemens => &SIEMENS,
        }
    }
}

/// A rule in words: what it is about, and for each dialect its choice and what shows it.
#[derive(Debug)]
pub struct Row {
    pub rule: &'static str,
    pub followed: [(&'static str, &'static str); Dialect::ALL.len()],
}

/// All rules, for people.
pub fn table() -> Vec<Row> {
    vec![
        row(|it| &it.narrow_integers),
        row(|it| &it.mixed_numbers),
        row(|it| &it.real_to_integer),
        row(|it| &it.halves),
        row_of("integer to BOOL", |it| &it.integer_to_bool, ToBool::words),
        row_of("bit string to BOOL", |it| &it.bits_to_bool, ToBool::words),
        row_of("division by zero", |it| &it.division_by_zero, ByZero::words),
        row_of("MOD by zero", |it| &it.modulo_by_zero, ByZero::words),
        row(|it| &it.shr_of_signed),
        row(|it| &it.time_as_number),
        row(|it| &it.real_and_bits),
        row(|it| &it.default_string),
        row(|it| &it.integer_text),
        row(|it| &it.date_as_number),
        row(|it| &it.real_of_text),
        row(|it| &it.text_positions),
        row(|it| &it.limit_crossed),
        row(|it| &it.sqrt_of_negative),
        row(|it| &it.modulo_of_reals),
        row(|it| &it.rotated_constant),
        row(|it| &it.functions),
        row(|it| &it.literals),
    ]
}

fn row<T: Choice>(of: fn(&'static Rules) -> &'static Followed<T>) -> Row {
    row_of(T::RULE, of, T::words)
}

fn row_of<T: Copy + 'static>(
    rule: &'static str,
    of: fn(&'static Rules) -> &'static Followed<T>,
    words: fn(T) -> &'static str,
) -> Row {
    let followed = Dialect::ALL.map(|it| of(it.rules())).map(|it| (words(it.choice), it.evidence));
    Row { rule, followed }
}

/// A rule of a system that its dialect does not follow: a program that has what uses it may compute otherwise there.
#[derive(Clone, Copy, Debug)]
pub struct NotFollowed {
    pub dialect: Dialect,
    /// What the system does.
    pub what: &'static str,
    pub evidence: &'static str,
    /// What a program has to have for the rule to matter.
    pub uses: Use,
}

/// The rules that are known, and not followed: a TIME, DATE, TOD or DT is 64 bits of nanoseconds in every dialect.
pub const NOT_FOLLOWED: &[NotFollowed] = &[
    not_followed(
        Dialect::Codesys,
        Elementary::Time,
        "32 bits of milliseconds without a sign: less than `T#0s` or more than `T#49d17h2m47s295ms` wraps",
        CODESYS_TIMES,
    ),
    not_followed(
        Dialect::Codesys,
        Elementary::Ltime,
        "64 bits of nanoseconds without a sign: less than `LTIME#0ns` wraps, and it reaches to twice what it reaches to here",
        CODESYS_TIMES,
    ),
    not_followed(Dialect::Codesys, Elementary::Date, "32 bits of seconds since 1970: it ends in 2106", CODESYS_DATES),
    not_followed(
        Dialect::Codesys,
        Elementary::Dt,
        "32 bits of seconds since 1970: it ends in 2106, and has no parts of a second",
        CODESYS_DATES,
    ),
    not_followed(Dialect::Codesys, Elementary::Tod, "32 bits of milliseconds: it has no parts of one", CODESYS_DATES),
    not_followed(
        Dialect::Siemens,
        Elementary::Time,
        "32 bits of milliseconds with a sign: from `T#-24d20h31m23s648ms` to `T#24d20h31m23s647ms`",
        SIEMENS_DATES,
    ),
    of_matiec(Use::Type(Elementary::Time), PARTS),
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
    ),
    of_strucpp(
        Use::Conversion(Class::Elementary, Class::Date),
        "a TOD may be negative, or longer than a day: INT_TO_TOD(-1)",
    ),
    not_followed(Dialect::Siemens, Elementary::Date, "16 bits of days: from 1990-01-01 to 2168-12-31", SIEMENS_DATES),
];

const PARTS: &str = "seconds and nanoseconds are kept apart: `T#500ms + T#500ms = T#1s` is FALSE, and a literal may lack a \
                     nanosecond: `T#1ms` is 999999 ns on x86-64";

const BEFORE: &str = "the process ends where P is 0";

const LAST_DIGIT: &str = "the C library's: the last digit of an LREAL may be another";

const TOO_LONG: &str = "where the result is longer than the first text may be, the end of what is put in is dropped";

const fn of_matiec(uses: Use, what: &'static str) -> NotFollowed {
    NotFollowed { dialect: Dialect::Openplc, what, evidence: MATIEC, uses }
}

const fn of_strucpp(uses: Use, what: &'static str) -> NotFollowed {
    NotFollowed { dialect: Dialect::Openplc4, what, evidence: "STruC++ 0.6.1, run", uses }
}

const CODESYS_TIMES: &str = "CODESYS help, \"TIME, LTIME\"; Beckhoff Information System, \"TIME/LTIME\"";
const CODESYS_DATES: &str = "CODESYS help, \"DATE\"; Beckhoff Information System, \"Date and time data types\"";

const SIEMENS_DATES: &str = "S7-1200 manual V4.2, table 5-32";

const fn not_followed(dialect: Dialect, ty: Elementary, what: &'static str, evidence: &'static str) -> NotFollowed {
    NotFollowed { dialect, what, evidence, uses: Use::Type(ty) }
}

/// An edge of a function, of which this is what every program does, and what vendors say of it.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    pub dialect: Dialect,
    pub what: &'static str,
    pub here: &'static str,
    pub documented: &'static str,
}

const fn edge(dialect: Dialect, what: &'static str, here: &'static str, documented: &'static str) -> Edge {
    Edge { dialect, what, here, documented }
}

/// Where a vendor leaves a value open, or where no page was found: what is done here is a choice.
pub const EDGES: &[Edge] = &[
    edge(
        Dialect::Codesys,
        "`MOD` of a negative number",
        "the dividend's sign, as processors divide",
        "CODESYS help, \"MOD\": \"a non-negative integer\", without an example; Beckhoff, \"MOD\": the integer remainder",
    ),
    edge(
        Dialect::Codesys,
        "`SHL`, `SHR` by the type's bits or more",
        "zeros come in, the sign in `SHR` of a signed one",
        "CODESYS help and Beckhoff, \"SHL\", \"SHR\": zeros, or `N MOD` the register's bits, as the target has it",
    ),
    edge(
        Dialect::Codesys,
        "`TRUNC`, `TRUNC_INT` beyond the type",
        "the low bits",
        "CODESYS help, \"TRUNC\", \"TRUNC_INT\": undefined, depends on the platform",
    ),
    edge(
        Dialect::Codesys,
        "`MID`, `INSERT`, `DELETE`, `REPLACE` with a position or count out of range",
        "acts as the nearest one",
        "CODESYS, library Standard: nothing",
    ),
    edge(
        Dialect::Logix,
        "the quotient of an integer and 0",
        "the dividend",
        "1756-RM003N, pp. 277 and 281: only the minor fault",
    ),
    edge(
        Dialect::Logix,
        "`MID`, `INSERT`, `DELETE` with an invalid Start or Quantity",
        "acts as the nearest one",
        "Rockwell, \"String Delete (DELETE)\": a minor fault of type 4, code 56; the destination is on no page",
    ),
    edge(
        Dialect::Logix,
        "an integer with more digits than the real beside it",
        "the nearest real, of two the even one",
        "1756-RM006K, p. 543: so; p. 546: the lower bits are truncated",
    ),
    edge(
        Dialect::Siemens,
        "a conversion to an integer type that does not hold the number",
        "of a real the nearest value, of an integer the low bits",
        "no page read says the value; ENO is FALSE",
    ),
    edge(Dialect::Cscape, "all of them", "as `iec`", "no page of Horner was found"),
];
