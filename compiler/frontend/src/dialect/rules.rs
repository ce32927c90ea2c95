//! Rules of values: where systems compute an ordinary operation in different ways, this table says which way each dialect
//! follows, and the page or program that shows it. Whoever checks an operation asks `Dialect::rules`; the operation itself
//! is in the runtime. `docs/dialects.md` has the same table, which a test holds equal.

mod choice;
mod followed;
mod not_followed;
mod systems;

use super::Dialect;
use choice::Choice;
pub use choice::{
    ByZero, CaseSelector, DateAsNumber, DefaultString, Functions, Halves, InitialValues, IntegerText, LimitCrossed,
    Literals, LongTime, LoopLimit, MixedNumbers, ModuloOfReals, NarrowIntegers, ProgramOrder, RealAndBits, RealOfText,
    RealToInteger, RotatedConstant, SecondBool, ShrOfSigned, SqrtOfNegative, TextPositions, TimeAsNumber, TimeUnit,
    ToBool,
};
pub use followed::{Followed, Rules};
pub use not_followed::{EDGES, Edge, NOT_FOLLOWED, NotFollowed, is_followed, otherwise};
pub use staunch_ir::{Part, Use};
use systems::{CODESYS, CSCAPE, IEC, LOGIX, OPENPLC, OPENPLC4, SIEMENS};

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
        row(|it| &it.second_bool),
        row(|it| &it.case_selector),
        row(|it| &it.loop_limit),
        row(|it| &it.time_unit),
        row(|it| &it.long_time),
        row(|it| &it.initial_values),
        row(|it| &it.program_order),
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
