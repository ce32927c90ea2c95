//! The formats of reals, and a real as its digits.

/// A format of reals: bits of the fraction, its leading one counted, and the least exponent.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Format {
    pub precision: i32,
    pub least: i32,
    pub greatest: i32,
}

pub(crate) const REAL: Format = Format { precision: 24, least: -149, greatest: 104 };
pub(crate) const LREAL: Format = Format { precision: 53, least: -1074, greatest: 971 };

/// Digits of a real above 0, `0.d1d2d3… * 10^exponent`.
pub(crate) struct Digits {
    pub digits: [u8; 17],
    pub count: usize,
    pub exponent: i32,
}

/// A finite number that is not below 0, as a whole number times a power of two.
pub(super) fn parts(value: f64) -> (u64, i32) {
    let bits = value.to_bits();
    let (raw, fraction) = ((bits >> 52) as i32 & 0x7FF, bits & ((1 << 52) - 1));
    if raw == 0 { (fraction, -1074) } else { (fraction | 1 << 52, raw - 1075) }
}

impl Digits {
    /// Of a number as it is spelled: digits with a point among them, and perhaps an exponent.
    pub(super) fn of(spelled: &[u8]) -> Self {
        let mut parts = spelled.split(|it| *it == b'e');
        let (mantissa, exponent) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
        let mut out = Self { digits: [0; 17], count: 0, exponent: whole(exponent) };
        let mut is_fraction = false;
        for byte in mantissa {
            match (*byte, out.digits.get_mut(out.count)) {
                (b'.', _) => is_fraction = true,
                (b'0', _) if out.count == 0 => out.exponent -= i32::from(is_fraction),
                (digit, Some(place)) => {
                    *place = digit.wrapping_sub(b'0');
                    out.count += 1;
                    out.exponent += i32::from(!is_fraction);
                }
                (_, None) => {}
            }
        }
        out.count = out.digits.iter().rposition(|it| *it != 0).map_or(0, |it| it + 1);
        out
    }

    /// Whether `value` is in the middle between the digits and the next ones. ryu takes the even ones of the two; `core`,
    /// and so the digits of a trace, are the greater ones.
    pub(super) fn are_half_below(&self, value: f64) -> bool {
        let (mantissa, power) = parts(value);
        let (odd, power) = (mantissa >> mantissa.trailing_zeros(), power + mantissa.trailing_zeros() as i32);
        // Twice the value is a whole number of the last place: mantissa * 2^(power + 1) * 10^places. From places of 0 down
        // the distance of two reals is greater than that.
        let places = self.count as i32 - self.exponent;
        if places < 0 || power + 1 + places != 0 {
            return false;
        }
        let number = self.digits.iter().take(self.count).fold(0_u64, |number, digit| number * 10 + u64::from(*digit));
        let twice = 5_u64.checked_pow(places as u32).and_then(|it| it.checked_mul(odd));
        twice == Some(2 * number + 1)
    }

    /// One more in the last place.
    pub(super) fn raise(&mut self) {
        for place in self.digits.iter_mut().take(self.count).rev() {
            if *place < 9 {
                *place += 1;
                return;
            }
            *place = 0;
        }
        self.digits = [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        self.exponent += 1;
    }
}

/// A whole number of few digits.
fn whole(spelled: &[u8]) -> i32 {
    let digits = spelled.iter().filter(|it| it.is_ascii_digit());
    let magnitude = digits.fold(0_i32, |number, digit| number * 10 + i32::from(*digit - b'0'));
    if spelled.starts_with(b"-") { -magnitude } else { magnitude }
}
