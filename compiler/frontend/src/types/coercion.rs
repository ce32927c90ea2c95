//! Which types become which by themselves, and the type at which two meet.

use crate::dialect::Dialect;
use staunch_ir::Elementary;
use staunch_ir::narrow::is_narrow;

/// Whether every value of `from` is one of `to`, by the standard's figure of implicit conversions.
pub(crate) fn widens(from: Elementary, to: Elementary) -> bool {
    if from == to {
        return true;
    }
    if from.is_bits() || to.is_bits() {
        return from.is_bits() && to.is_bits() && from.repr().size() < to.repr().size()
            || (from == Elementary::Bool && to == Elementary::Byte);
    }
    if from.is_char() || to.is_char() {
        return false;
    }
    if from.is_time() || to.is_time() {
        return LONG_FORMS.contains(&(from, to));
    }
    match (from.repr().range(), to.repr().range()) {
        (Some(from), Some((low, high))) => (low..=high).contains(&from.0) && (low..=high).contains(&from.1),
        // A REAL holds 24 bits exactly, an LREAL 53.
        (_, None) => from.repr().size() < to.repr().size(),
        (None, Some(_)) => false,
    }
}

/// Each type of 64 bits with the one that the standard has for fewer.
const LONG_FORMS: [(Elementary, Elementary); 6] = [
    (Elementary::Time, Elementary::Ltime),
    (Elementary::Time, Elementary::Ultime),
    (Elementary::Ltime, Elementary::Ultime),
    (Elementary::Date, Elementary::Ldate),
    (Elementary::Tod, Elementary::Ltod),
    (Elementary::Dt, Elementary::Ldt),
];

/// The type at which two operands meet.
pub(crate) fn join(a: Elementary, b: Elementary) -> Option<Elementary> {
    if widens(a, b) {
        return Some(b);
    }
    if widens(b, a) {
        return Some(a);
    }
    let meeting = [Elementary::Int, Elementary::Dint, Elementary::Lint, Elementary::Real, Elementary::Lreal];
    meeting.into_iter().find(|it| widens(a, *it) && widens(b, *it))
}

/// The type that two operands give, where a dialect computes.
pub(crate) type Join = fn(Elementary, Elementary) -> Option<Elementary>;

pub(crate) fn join_in(dialect: Dialect) -> Join {
    let rules = dialect.rules();
    match () {
        () if rules.ranks_numbers() => join_ranked,
        () if rules.promotes_as_c() => join,
        () if rules.promotes_integers() => join_promoted,
        () => join,
    }
}

/// The types of numbers in Logix, from the lowest to the highest (1756-RM006K, p. 541).
const RANKS: [Elementary; 10] = [
    Elementary::Sint,
    Elementary::Usint,
    Elementary::Int,
    Elementary::Uint,
    Elementary::Dint,
    Elementary::Udint,
    Elementary::Lint,
    Elementary::Ulint,
    Elementary::Real,
    Elementary::Lreal,
];

/// The one of two types that ranks higher. Those of fewer than 32 bits count as the type that they have elsewhere: they are computed at
/// DINT.
fn join_ranked(a: Elementary, b: Elementary) -> Option<Elementary> {
    if is_narrow(a) && is_narrow(b) {
        return join_promoted(a, b);
    }
    let rank = |it: Elementary| RANKS.iter().position(|ranked| *ranked == it);
    match rank(a).zip(rank(b)) {
        Some((first, second)) => RANKS.get(first.max(second)).copied(),
        None => join_promoted(a, b),
    }
}

/// The integer type that a bit string counts as where bits and integers mix.
pub(crate) fn as_number(ty: Elementary) -> Elementary {
    match ty {
        Elementary::Byte => Elementary::Usint,
        Elementary::Word => Elementary::Uint,
        Elementary::Dword => Elementary::Udint,
        Elementary::Lword => Elementary::Ulint,
        other => other,
    }
}

/// The type that two operands give a value which is computed at more bits: that of more bits, the
/// signed one of as many.
fn join_promoted(a: Elementary, b: Elementary) -> Option<Elementary> {
    let numbers = !(a.is_bits() && b.is_bits());
    if numbers && is_narrow(a) && is_narrow(b) {
        return [as_number(a), as_number(b)].into_iter().max_by_key(|it| (it.repr().size(), !it.repr().is_unsigned()));
    }
    join(a, b).or_else(|| join_long_with_real(a, b))
}

/// 64 bits with a real: an LREAL, which may round them. (CODESYS only warns of that: C0197)
fn join_long_with_real(a: Elementary, b: Elementary) -> Option<Elementary> {
    let is_long = |it: Elementary| as_number(it).is_integer() && it.repr().size() == 8;
    (a.is_real() && is_long(b) || is_long(a) && b.is_real()).then_some(Elementary::Lreal)
}
