//! Conversion between reals and decimal digits, exactly: the fewest digits that read back as the same real, and the real
//! nearest to up to 38 digits.

mod big;
mod digits;

pub(crate) use big::rounded;
pub(crate) use digits::{Digits, Format, LREAL, REAL};

/// The fewest digits that are nearer to `value` than to any other number of its format; `value` is finite and above 0.
pub(crate) fn shortest(value: f64, format: Format) -> Digits {
    let mut buffer = ryu::Buffer::new();
    let spelled = match format {
        REAL => buffer.format_finite(value as f32),
        _ => buffer.format_finite(value),
    };
    let mut digits = Digits::of(spelled.as_bytes());
    if digits.are_half_below(value) {
        digits.raise();
    }
    digits
}

/// The real nearest to `digits * 10^exponent`, ties to even; infinity beyond the greatest real.
pub(crate) fn nearest(digits: u128, exponent: i32, format: Format) -> f64 {
    at_once(digits, exponent, format).unwrap_or_else(|| big::nearest(digits, exponent, format))
}

/// The powers of ten that an LREAL holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// Clinger's fast path: where the digits and the power are LREALs, one operation rounds only once.
fn at_once(digits: u128, exponent: i32, format: Format) -> Option<f64> {
    let number = u64::try_from(digits).ok().filter(|it| *it <= 1 << LREAL.precision)? as f64;
    let power = POWERS.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 { number / power } else { number * power };
    // To a REAL it is rounded again: right, but where rounding has led to the middle between two of them.
    let is_middle = value.to_bits() & 0x1FFF_FFFF == 0x1000_0000;
    match format {
        REAL if is_middle => None,
        REAL => Some(f64::from(value as f32)),
        _ => Some(value),
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::format;
    use std::string::String;

    #[test]
    fn rounded_digits_are_those_of_core() {
        for value in samples().map(f64::from_bits).filter(|it| it.is_finite() && *it > 0.0) {
            for count in [1, 2, 6, 10, 17] {
                let found = rounded(value, count);
                let digits: String = found.digits.iter().take(count).map(|it| char::from(b'0' + it)).collect();
                let text = format!("{value:.*e}", count - 1);
                let (core, exponent) = text.split_once('e').unwrap_or_default();
                assert_eq!(digits, core.replace('.', ""), "{value:e}, {count}");
                assert_eq!(Ok(found.exponent - 1), exponent.parse(), "{value:e}, {count}");
            }
        }
    }

    /// Reals without order, and the edges.
    fn samples() -> impl Iterator<Item = u64> {
        let mut random = 88_172_645_463_325_252_u64;
        let edges = [
            1.0_f64,
            0.1,
            1e22,
            1e23,
            9_007_199_254_740_993.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            1e-5,
            0.3,
            123.456,
            f64::from(f32::MAX),
            2.0,
            4.0,
            1.5e-45,
            9.5e-321,
        ];
        let more = (0..if cfg!(miri) { 10 } else { 4000 }).map(move |_| {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            random & !(1 << 63)
        });
        // Where the neighbour below is nearer than the one above: the powers of two, of an LREAL and of a REAL.
        let step = if cfg!(miri) { 500 } else { 1 };
        let powers = (1..2047).step_by(step).map(|it| it << 52).chain((1..255).step_by(step).map(|it| it << (23 + 16)));
        edges.into_iter().map(f64::to_bits).chain(powers).chain(more)
    }

    fn text(digits: &Digits) -> String {
        let figures: String = digits.digits[..digits.count].iter().map(|it| char::from(b'0' + it)).collect();
        format!("0.{figures}e{}", digits.exponent)
    }

    /// `core` reads and writes the same, which is the model: as few digits, and the same real.
    #[test]
    fn digits_are_those_of_core() {
        for bits in samples() {
            let value = f64::from_bits(bits);
            if value.is_finite() && value > 0.0 {
                let ours = shortest(value, LREAL);
                let written = text(&ours);
                assert_eq!(written.parse::<f64>().map(f64::to_bits), Ok(bits), "{written}");
                let core: String = format!("{value:e}").split('e').next().unwrap_or_default().replace('.', "");
                assert_eq!(written.split(['.', 'e']).nth(1), Some(core.as_str()), "{value:e}");
            }
            let small = f32::from_bits((bits >> 16) as u32 & 0x7FFF_FFFF);
            if small.is_finite() && small > 0.0 {
                let ours = text(&shortest(f64::from(small), REAL));
                let core: String = format!("{small:e}").split('e').next().unwrap_or_default().replace('.', "");
                assert_eq!(ours.split(['.', 'e']).nth(1), Some(core.as_str()), "{small:e}");
            }
        }
    }

    #[test]
    fn reals_are_read_as_core_reads_them() {
        for bits in samples() {
            let digits = u128::from(bits) * 999_983 % 10_000_000_000_000_000_000_000;
            for exponent in [0, -1, -5, 3, -30, 20, -345, 290, -323, 305, -60, 25] {
                let spelled = format!("{digits}e{exponent}");
                let model: f64 = spelled.parse().expect("digits");
                assert_eq!(nearest(digits, exponent, LREAL).to_bits(), model.to_bits(), "{spelled}");
                let model: f32 = spelled.parse().expect("digits");
                assert_eq!(nearest(digits, exponent, REAL).to_bits(), f64::from(model).to_bits(), "{spelled}");
            }
        }
        // Half the way between two reals, and a little more.
        assert_eq!(nearest(9_007_199_254_740_993, 0, LREAL), 9_007_199_254_740_992.0);
        assert_eq!(nearest(90_071_992_547_409_930_001, -4, LREAL), 9_007_199_254_740_994.0);
        assert_eq!(nearest(17, 400, LREAL), f64::INFINITY);
    }
}
