//! The choices of one dialect, each with what shows it.

use super::choice::{
    ByZero, CaseSelector, DateAsNumber, DefaultString, Functions, Halves, InitialValues, IntegerText, LimitCrossed,
    Literals, LongTime, LoopLimit, MixedNumbers, ModuloOfReals, NarrowIntegers, ProgramOrder, RealAndBits, RealOfText,
    RealToInteger, RotatedConstant, SecondBool, ShrOfSigned, SqrtOfNegative, TextPositions, TimeAsNumber, TimeUnit,
    ToBool,
};
use staunch_runtime::time::{MICROSECOND, MILLISECOND, SECOND};
use staunch_runtime::{Elementary, Time, Value};

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
    pub second_bool: Followed<SecondBool>,
    pub case_selector: Followed<CaseSelector>,
    pub loop_limit: Followed<LoopLimit>,
    pub time_unit: Followed<TimeUnit>,
    pub long_time: Followed<LongTime>,
    pub initial_values: Followed<InitialValues>,
    pub program_order: Followed<ProgramOrder>,
}

impl Rules {
    /// What a variable of the type starts with where nothing says it: a date that is a number of days is the first day.
    pub fn first_value(&self, ty: Elementary) -> Value {
        let counts_days = self.date_as_number.choice == DateAsNumber::DaysSince1990;
        match counts_days && matches!(ty, Elementary::Date | Elementary::Dt) {
            true => Value::I64(staunch_runtime::time::date(1990, 1, 1)),
            false => ty.repr().zero(),
        }
    }

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

    /// AND and OR evaluate the second of two BOOLs only where it decides.
    pub const fn skips_second_side(&self) -> bool {
        matches!(self.second_bool.choice, SecondBool::IfItDecides)
    }

    /// The value that CASE selects by is cut to the type that it counts as.
    pub const fn cuts_selectors(&self) -> bool {
        matches!(self.case_selector.choice, CaseSelector::Cut)
    }

    /// What a type of the standard is in the dialect.
    pub const fn own(&self, ty: Elementary) -> Elementary {
        match (ty, self.long_time.choice) {
            (Elementary::Ltime, LongTime::Unsigned) => Elementary::Ultime,
            _ => ty,
        }
    }

    /// The elementary type that a name means, in any case.
    pub fn named(&self, name: &str) -> Option<Elementary> {
        Elementary::named(name).map(|it| self.own(it))
    }

    /// The least and the greatest duration of a type, in nanoseconds.
    pub fn limits(&self, duration: Elementary) -> Option<(i128, i128)> {
        let (counted, unit, parts) = match (duration, self.time_unit.choice) {
            (Elementary::Time, TimeUnit::SecondsAndNanoseconds) => (Elementary::Dint, SECOND, SECOND - 1),
            (Elementary::Time, _) if let Some(count) = self.time_count() => (count.ty, count.unit, 0),
            _ => (duration, 1, 0),
        };
        let unit = i128::from(unit);
        let (mut least, mut greatest) = counted.repr().range()?;
        if unit > 1 {
            // Here it is kept in nanoseconds.
            let (first, last) = Elementary::Lint.repr().range()?;
            (least, greatest) = (least.max(first / unit), greatest.min(last / unit));
        }
        Some((least * unit, greatest * unit + i128::from(parts)))
    }

    /// What a TIME is a number of, where that is not nanoseconds.
    pub const fn time_count(&self) -> Option<TimeCount> {
        let (ty, unit, words) = match self.time_unit.choice {
            TimeUnit::Nanoseconds | TimeUnit::SecondsAndNanoseconds => return None,
            TimeUnit::Microseconds => (Elementary::Lint, MICROSECOND, "microseconds"),
            TimeUnit::Milliseconds => (Elementary::Udint, MILLISECOND, "milliseconds"),
            TimeUnit::SignedMilliseconds => (Elementary::Dint, MILLISECOND, "milliseconds"),
        };
        Some(TimeCount { ty, unit, words })
    }

    /// Integers without a type are DINTs together, and wrap.
    pub const fn has_immediates(&self) -> bool {
        matches!(self.literals.choice, Literals::Immediate)
    }

    pub const fn writes_plus(&self) -> bool {
        matches!(self.integer_text.choice, IntegerText::SignAndDigits)
    }
}

/// A whole number of units of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeCount {
    pub ty: Elementary,
    /// In nanoseconds.
    pub unit: Time,
    pub words: &'static str,
}

/// A choice, and the page or program that shows that the system makes it.
#[derive(Clone, Copy, Debug)]
pub struct Followed<T> {
    pub choice: T,
    pub evidence: &'static str,
}
