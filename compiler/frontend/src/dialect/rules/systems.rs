//! The rules of each system, with the page or program that shows them.

use super::choice::{
    ByZero, CaseSelector, DateAsNumber, DefaultString, Functions, Halves, InitialValues, IntegerText, LimitCrossed,
    Literals, LongTime, LoopLimit, MixedNumbers, ModuloOfReals, NarrowIntegers, ProgramOrder, RealAndBits, RealOfText,
    RealToInteger, RotatedConstant, SecondBool, ShrOfSigned, SqrtOfNegative, TextPositions, TimeAsNumber, TimeUnit,
    ToBool,
};
use super::followed::{Followed, Rules};

pub(super) const IEC: Rules = Rules {
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
    rotated_constant: follows(RotatedConstant::BitsOfPlace, "no page documents it"),
    functions: follows(Functions::OfTheStandard, "IEC 61131-3, 6.6.2.5"),
    literals: follows(Literals::OfTheirPlace, "IEC 61131-3, 6.3.3; REAL and LREAL are left to the implementer"),
    second_bool: follows(SecondBool::Always, "IEC 61131-3, 7.3.2: the implementer may say otherwise"),
    case_selector: follows(CaseSelector::AsComputed, "IEC 61131-3, table 72"),
    loop_limit: follows(LoopLimit::Once, "IEC 61131-3, 7.3.3.4.2: the body changes none of them"),
    time_unit: follows(TimeUnit::Nanoseconds, "IEC 61131-3, 6.3.3.2: left to the implementer"),
    long_time: follows(LongTime::Signed, "IEC 61131-3, table 10: 64 bits of nanoseconds"),
    initial_values: follows(InitialValues::Everywhere, "IEC 61131-3, 6.5.1.3"),
    program_order: follows(ProgramOrder::ByPriority, "IEC 61131-3, 6.8.2"),
};

/// The choice of another dialect, where no page of the vendor says anything.
const fn undocumented<T: Copy>(rule: Followed<T>) -> Followed<T> {
    Followed { choice: rule.choice, evidence: "no Horner page documents it; as `iec`" }
}

pub(super) const CSCAPE: Rules = Rules {
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
    default_string: follows(DefaultString::Holds80, "no Horner page documents it; as CODESYS"),
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
    second_bool: undocumented(IEC.second_bool),
    case_selector: undocumented(IEC.case_selector),
    loop_limit: undocumented(IEC.loop_limit),
    time_unit: undocumented(IEC.time_unit),
    long_time: undocumented(IEC.long_time),
    initial_values: undocumented(IEC.initial_values),
    program_order: undocumented(IEC.program_order),
};

pub(super) const CODESYS: Rules = Rules {
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
    literals: follows(
        Literals::Smallest,
        "CODESYS help and Beckhoff, \"Typed Literals\": the smallest possible data type",
    ),
    time_unit: follows(TimeUnit::Milliseconds, CODESYS_TIMES),
    long_time: follows(LongTime::Unsigned, CODESYS_TIMES),
    ..IEC
};

const CODESYS_REALS: &str = "CODESYS help, \"Conversion: REAL, LREAL\": the first bytes are not taken into account; \
                             Beckhoff, \"REAL/LREAL_TO_<type>\", leaves it undefined";

const CODESYS_BY_ZERO: &str =
    "Beckhoff, \"DIV\", \"MOD\": an exception, which stops the task; CODESYS help leaves it to the target";

/// MATIEC's C, as gcc compiles it for x86-64: programs were compiled by it and run.
pub(super) const OPENPLC: Rules = Rules {
    narrow_integers: follows(NarrowIntegers::AsCPromotes, MATIEC),
    real_to_integer: follows(RealToInteger::LowBitsOfLint, MATIEC),
    integer_to_bool: follows(ToBool::NotZero, MATIEC),
    bits_to_bool: follows(ToBool::NotZero, MATIEC),
    modulo_by_zero: follows(ByZero::GivesZero, MATIEC),
    time_as_number: follows(TimeAsNumber::Seconds, MATIEC),
    time_unit: follows(TimeUnit::SecondsAndNanoseconds, MATIEC),
    limit_crossed: follows(LimitCrossed::Minimum, MATIEC),
    default_string: follows(DefaultString::Holds126, MATIEC),
    functions: follows(Functions::OfMatiec, MATIEC),
    real_of_text: follows(RealOfText::AfterPoint, MATIEC),
    text_positions: follows(TextPositions::OfLibrary, MATIEC),
    program_order: follows(ProgramOrder::OfText, MATIEC),
    literals: follows(Literals::OfC, MATIEC),
    second_bool: follows(SecondBool::IfItDecides, MATIEC),
    case_selector: follows(CaseSelector::Cut, MATIEC),
    loop_limit: follows(LoopLimit::EachTurn, MATIEC),
    ..IEC
};

/// The compiler whose programs were run, by its commit.
pub(super) const MATIEC: &str = "thiagoralves/matiec f9ca9ba, run";

pub(super) const OPENPLC4: Rules = Rules {
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
    text_positions: follows(
        TextPositions::OfLibrary,
        "STruC++ 0.6.1, run: REPLACE('abcdef', 'XY', -1, 3) is 'abXYbcdef'",
    ),
    initial_values: follows(
        InitialValues::OfStrucpp,
        "STruC++ 0.6.1, run: `a : ARRAY[0..1] OF INT := [5, 6]` of a PROGRAM is 0, 0, `n : INT := 2 * 3` is 0",
    ),
    literals: follows(Literals::OfC, "STruC++ 0.6.1, run: `REAL#0.1 - 0.30000001` is -0.200000003"),
    second_bool: follows(SecondBool::Always, "STruC++ 0.6.1: C++'s `&` and `|`"),
    loop_limit: follows(LoopLimit::EachTurnUpward, "STruC++ 0.6.1, run: `FOR i := 5 TO 1 BY STEP` does not run"),
    ..IEC
};

pub(super) const LOGIX: Rules = Rules {
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
    time_as_number: follows(TimeAsNumber::Microseconds, LOGIX_TIMES),
    time_unit: follows(TimeUnit::Microseconds, LOGIX_TIMES),
    ..IEC
};

pub(super) const SIEMENS: Rules = Rules {
    halves: follows(Halves::ToEven, "S7-1200 manual, \"ROUND\""),
    division_by_zero: follows(ByZero::GivesZero, SIEMENS_BY_ZERO),
    modulo_by_zero: follows(ByZero::GivesZero, SIEMENS_BY_ZERO),
    shr_of_signed: follows(ShrOfSigned::Sign, "S7-1200 manual, \"SHR\""),
    integer_text: follows(IntegerText::SignAndDigits, "S7-1200 manual, 11/2011, pp. 247 and 248, tables 8-33 and 8-34"),
    real_and_bits: follows(RealAndBits::Bits, "S7-1200 manual, \"CONV\""),
    date_as_number: follows(DateAsNumber::DaysSince1990, SIEMENS_DATES),
    real_of_text: follows(RealOfText::FixedPoint, "S7-1200 manual, 11/2011, p. 247, table 8-33"),
    text_positions: follows(TextPositions::Empty, "S7-1200 manual, 03/2014, tables 8-57, 8-60, 8-63 and 8-66"),
    limit_crossed: follows(LimitCrossed::Value, "S7-1200 manual, \"LIMIT\", ENO status"),
    time_unit: follows(TimeUnit::SignedMilliseconds, SIEMENS_DATES),
    ..IEC
};

pub(super) const LOGIX_TIMES: &str = "Rockwell, Logix Designer help, \"Time and date data types\"";

pub(super) const SIEMENS_DATES: &str = "S7-1200 manual V4.2, table 5-32";

pub(super) const CODESYS_TIMES: &str = "CODESYS help, \"TIME, LTIME\"; Beckhoff Information System, \"TIME/LTIME\"";

const SIEMENS_BY_ZERO: &str = "S7-1200 manual, \"DIV\", \"MOD\", ENO status: 0 is returned";

const fn follows<T>(choice: T, evidence: &'static str) -> Followed<T> {
    Followed { choice, evidence }
}
