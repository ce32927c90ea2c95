//! Rules of values: where systems compute an ordinary operation in different ways, this table says which way each dialect
//! follows, and the page or program that shows it. Whoever checks an operation asks `Dialect::rules`; the operation itself
//! is in the runtime. `docs/dialects.md` has the same table, which a test holds equal.

use super::Dialect;

/// How one dialect computes.
#[derive(Debug)]
pub struct Rules {
    pub narrow_integers: Followed<NarrowIntegers>,
    pub real_to_integer: Followed<RealToInteger>,
    pub integer_to_bool: Followed<ToBool>,
    pub bits_to_bool: Followed<ToBool>,
    pub division_by_zero: Followed<ByZero>,
    pub modulo_by_zero: Followed<ByZero>,
    pub shr_of_signed: Followed<ShrOfSigned>,
    pub time_as_number: Followed<TimeAsNumber>,
    pub real_and_bits: Followed<RealAndBits>,
    pub default_string: Followed<DefaultString>,
    pub integer_text: Followed<IntegerText>,
    pub functions: Followed<Functions>,
}

impl Rules {
    /// Integers and bit strings of fewer than 32 bits are computed at 32, and cut where they are stored.
    pub const fn promotes_integers(&self) -> bool {
        matches!(self.narrow_integers.choice, NarrowIntegers::At32Bits | NarrowIntegers::AsCPromotes)
    }

    /// Bit strings are promoted as well, and a function takes and gives values of its own type, which are cut.
    pub const fn promotes_as_c(&self) -> bool {
        matches!(self.narrow_integers.choice, NarrowIntegers::AsCPromotes)
    }

    pub const fn has_functions_of_matiec(&self) -> bool {
        matches!(self.functions.choice, Functions::OfMatiec)
    }

    pub const fn time_is_seconds(&self) -> bool {
        matches!(self.time_as_number.choice, TimeAsNumber::Seconds)
    }

    pub const fn rounds_to_lint(&self) -> bool {
        matches!(self.real_to_integer.choice, RealToInteger::LowBitsOfLint)
    }

    pub const fn keeps_sign(&self) -> bool {
        matches!(self.shr_of_signed.choice, ShrOfSigned::Sign)
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
}

impl Choice for NarrowIntegers {
    const RULE: &'static str = "integers narrower than 32 bits";

    fn words(self) -> &'static str {
        match self {
            Self::AtTheirType => "at their type",
            Self::At32Bits => "at 32 bits",
            Self::AsCPromotes => "at 32 bits by operators, at their type by functions",
        }
    }
}

/// What a real becomes that the integer type does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealToInteger {
    Saturates,
    LowBitsOfLint,
}

impl Choice for RealToInteger {
    const RULE: &'static str = "REAL to integer, out of range";

    fn words(self) -> &'static str {
        match self {
            Self::Saturates => "the nearest value of the type",
            Self::LowBitsOfLint => "the low bits of a LINT; 0 for an unsigned type and a negative value",
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
    GivesZero,
}

impl ByZero {
    const fn words(self) -> &'static str {
        match self {
            Self::Faults => "a fault",
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
    Seconds,
}

impl Choice for TimeAsNumber {
    const RULE: &'static str = "TIME as a number";

    fn words(self) -> &'static str {
        match self {
            Self::Milliseconds => "milliseconds",
            Self::Seconds => "seconds",
        }
    }
}

/// What passes between a real and a bit string.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RealAndBits {
    Value,
}

impl Choice for RealAndBits {
    const RULE: &'static str = "REAL and bit strings";

    fn words(self) -> &'static str {
        match self {
            Self::Value => "the value",
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

/// Which library the standard functions are of, where the standard leaves an edge open or a library departs from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functions {
    OfTheStandard,
    OfMatiec,
}

impl Choice for Functions {
    const RULE: &'static str = "standard functions";

    fn words(self) -> &'static str {
        match self {
            Self::OfTheStandard => "as the standard",
            Self::OfMatiec => "as MATIEC's library",
        }
    }
}

const IEC: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::AtTheirType, "IEC 61131-3, 6.6.2.5.4: a result has its operands' type"),
    real_to_integer: follows(RealToInteger::Saturates, "IEC 61131-3, table 22: left to the implementer"),
    integer_to_bool: follows(ToBool::RightmostBit, "IEC 61131-3, table 24"),
    bits_to_bool: follows(ToBool::RightmostBit, "IEC 61131-3, table 24"),
    division_by_zero: follows(ByZero::Faults, "IEC 61131-3, table A.1: an error"),
    modulo_by_zero: follows(ByZero::Faults, "IEC 61131-3, table A.1: an error"),
    shr_of_signed: follows(ShrOfSigned::Zeros, "IEC 61131-3, table 30: of bit strings"),
    time_as_number: follows(TimeAsNumber::Milliseconds, "left to the implementer"),
    real_and_bits: follows(RealAndBits::Value, "left to the implementer"),
    default_string: follows(DefaultString::Holds254, "left to the implementer"),
    integer_text: follows(IntegerText::Digits, "left to the implementer"),
    functions: follows(Functions::OfTheStandard, "IEC 61131-3, 6.6.2.5"),
};

const CSCAPE: Rules = Rules { default_string: follows(DefaultString::Holds80, "no page says it; as CODESYS"), ..IEC };

const CODESYS: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::At32Bits, "CODESYS help, \"Operands\""),
    integer_to_bool: follows(ToBool::NotZero, "CODESYS help, \"Integer conversion\""),
    bits_to_bool: follows(ToBool::NotZero, "CODESYS help, \"Integer conversion\""),
    shr_of_signed: follows(ShrOfSigned::Sign, "CODESYS help, \"SHR\""),
    default_string: follows(DefaultString::Holds80, "CODESYS help, \"STRING\""),
    ..IEC
};

/// MATIEC's C, as gcc compiles it for x86-64: programs were compiled by it and run.
const OPENPLC: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::AsCPromotes, MATIEC),
    real_to_integer: follows(RealToInteger::LowBitsOfLint, MATIEC),
    integer_to_bool: follows(ToBool::NotZero, MATIEC),
    bits_to_bool: follows(ToBool::NotZero, MATIEC),
    modulo_by_zero: follows(ByZero::GivesZero, MATIEC),
    time_as_number: follows(TimeAsNumber::Seconds, MATIEC),
    default_string: follows(DefaultString::Holds126, MATIEC),
    functions: follows(Functions::OfMatiec, MATIEC),
    ..IEC
};

/// The compiler whose programs were run, by its commit.
const MATIEC: &str = "thiagoralves/matiec f9ca9ba, run";

const LOGIX: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::At32Bits, "1756-RM006, \"Data conversions\""),
    default_string: follows(DefaultString::Holds82, "1756-RM003, \"String types\""),
    ..IEC
};

const SIEMENS: Rules = Rules {
    shr_of_signed: follows(ShrOfSigned::Sign, "S7-1200 manual, \"SHR\""),
    integer_text: follows(IntegerText::SignAndDigits, "S7-1200 manual, table 8-33"),
    ..IEC
};

impl Dialect {
    pub const fn rules(self) -> &'static Rules {
        match self {
            Self::Iec => &IEC,
            Self::Cscape => &CSCAPE,
            Self::Codesys => &CODESYS,
            Self::Openplc => &OPENPLC,
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
        row(|it| &it.real_to_integer),
        row_of("integer to BOOL", |it| &it.integer_to_bool, ToBool::words),
        row_of("bit string to BOOL", |it| &it.bits_to_bool, ToBool::words),
        row_of("division by zero", |it| &it.division_by_zero, ByZero::words),
        row_of("MOD by zero", |it| &it.modulo_by_zero, ByZero::words),
        row(|it| &it.shr_of_signed),
        row(|it| &it.time_as_number),
        row(|it| &it.real_and_bits),
        row(|it| &it.default_string),
        row(|it| &it.integer_text),
        row(|it| &it.functions),
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
