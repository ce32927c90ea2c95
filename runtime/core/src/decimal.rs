//! Reals to decimal digits and back, exactly: as few digits as read back the same, and the nearest real to
//! any digits. `core` does the same with code that can panic.

/// An unsigned integer of as many bits as the fraction of any LREAL needs.
#[derive(Clone)]
struct Big([u32; Self::WORDS]);

impl Big {
    const WORDS: usize = 48;

    fn new(value: u128) -> Self {
        let mut words = [0; Self::WORDS];
        for (at, word) in words.iter_mut().take(4).enumerate() {
            *word = (value >> (32 * at)) as u32;
        }
        Self(words)
    }

    /// Times `factor`; what leaves the top is lost, and nothing that is computed here reaches it.
    fn times(&mut self, factor: u32) {
        let mut carry = 0_u64;
        for word in &mut self.0 {
            let product = u64::from(*word) * u64::from(factor) + carry;
            (*word, carry) = (product as u32, product >> 32);
        }
    }

    fn times_power_of_ten(&mut self, power: u32) {
        (0..power).for_each(|_| self.times(10));
    }

    fn doubled(&mut self, times: u32) {
        for _ in 0..times / 31 {
            self.times(1 << 31);
        }
        self.times(1 << (times % 31));
    }

    fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        let mut carry = 0_u64;
        for (word, other) in sum.0.iter_mut().zip(&other.0) {
            let both = u64::from(*word) + u64::from(*other) + carry;
            (*word, carry) = (both as u32, both >> 32);
        }
        sum
    }

    /// Less `other`, which is no greater.
    fn subtract(&mut self, other: &Self) {
        let mut borrow = 0_i64;
        for (word, other) in self.0.iter_mut().zip(&other.0) {
            let rest = i64::from(*word) - i64::from(*other) + borrow;
            (*word, borrow) = (rest as u32, rest >> 32);
        }
    }

    fn order(&self, other: &Self) -> core::cmp::Ordering {
        self.0.iter().rev().cmp(other.0.iter().rev())
    }

    fn is_below(&self, other: &Self) -> bool {
        self.order(other).is_lt()
    }

    fn bits(&self) -> i32 {
        let mut bits = 0;
        for (at, word) in (0..).zip(&self.0) {
            if *word != 0 {
                bits = at * 32 + 32 - word.leading_zeros() as i32;
            }
        }
        bits
    }
}

/// A format of reals: bits of the fraction, its leading one counted, and the least exponent.
#[derive(Clone, Copy)]
pub(crate) struct Format {
    precision: i32,
    least: i32,
    greatest: i32,
}

pub(crate) const REAL: Format = Format { precision: 24, least: -149, greatest: 104 };
pub(crate) const LREAL: Format = Format { precision: 53, least: -1074, greatest: 971 };

/// Digits of a real above 0, `0.d1d2d3… * 10^exponent`.
pub(crate) struct Digits {
    pub digits: [u8; 17],
    pub count: usize,
    pub exponent: i32,
}

/// The fewest digits that are nearer to `value` than to any other of its format; `value` is finite and above 0.
pub(crate) fn shortest(value: f64, format: Format) -> Digits {
    let bits = value.to_bits();
    let (raw, fraction) = ((bits >> 52) as i32 & 0x7FF, bits & ((1 << 52) - 1));
    let (mut mantissa, mut power) = if raw == 0 { (fraction, -1074) } else { (fraction | 1 << 52, raw - 1075) };
    // At the format's own width: a REAL has zeros where an LREAL has more bits.
    while power < format.least || (mantissa >> format.precision) > 0 {
        (mantissa, power) = (mantissa >> 1, power + 1);
    }
    // Dragon4: the rest over the scale is what is left to print, the margins are half the way to the neighbours.
    let is_even = mantissa % 2 == 0;
    let is_narrow = mantissa == 1 << (format.precision - 1) && power > format.least;
    let (mut rest, mut scale, mut margin) = (Big::new(u128::from(mantissa)), Big::new(1), Big::new(1));
    rest.doubled(power.max(0) as u32 + 1);
    margin.doubled(power.max(0) as u32);
    scale.doubled((-power).max(0) as u32 + 1);
    let mut upper = margin.clone();
    if is_narrow {
        upper.doubled(1);
        rest.doubled(1);
        scale.doubled(1);
    }
    let reaches = |rest: &Big, upper: &Big, scale: &Big| match rest.plus(upper).order(scale) {
        core::cmp::Ordering::Less => false,
        core::cmp::Ordering::Equal => is_even,
        core::cmp::Ordering::Greater => true,
    };
    let mut exponent = 0;
    while reaches(&rest, &upper, &scale) {
        scale.times(10);
        exponent += 1;
    }
    let grow = |rest: &mut Big, upper: &mut Big, margin: &mut Big| {
        rest.times(10);
        upper.times(10);
        margin.times(10);
    };
    loop {
        let (mut more, mut more_upper, mut more_margin) = (rest.clone(), upper.clone(), margin.clone());
        grow(&mut more, &mut more_upper, &mut more_margin);
        if reaches(&more, &more_upper, &scale) {
            break;
        }
        (rest, upper, margin) = (more, more_upper, more_margin);
        exponent -= 1;
    }
    let mut out = Digits { digits: [0; 17], count: 0, exponent };
    for place in &mut out.digits {
        grow(&mut rest, &mut upper, &mut margin);
        let mut digit = 0;
        while digit < 9 && !rest.is_below(&scale) {
            rest.subtract(&scale);
            digit += 1;
        }
        out.count += 1;
        let is_low = rest.is_below(&margin) || is_even && rest.order(&margin).is_eq();
        let is_high = reaches(&rest, &upper, &scale);
        let is_up = is_high && (!is_low || !rest.plus(&rest).is_below(&scale));
        *place = digit + u8::from(is_up);
        if is_low || is_high {
            break;
        }
    }
    out
}

/// The first `count` digits, at most 17, the last one rounded, ties to even; `value` is an LREAL, finite and above 0.
pub(crate) fn rounded(value: f64, count: usize) -> Digits {
    let bits = value.to_bits();
    let (raw, fraction) = ((bits >> 52) as i32 & 0x7FF, bits & ((1 << 52) - 1));
    let (mantissa, power) = if raw == 0 { (fraction, -1074) } else { (fraction | 1 << 52, raw - 1075) };
    let (mut rest, mut scale) = (Big::new(u128::from(mantissa)), Big::new(1));
    rest.doubled(power.max(0) as u32);
    scale.doubled((-power).max(0) as u32);
    let mut exponent = 0;
    while !rest.is_below(&scale) {
        scale.times(10);
        exponent += 1;
    }
    loop {
        let mut more = rest.clone();
        more.times(10);
        if !more.is_below(&scale) {
            break;
        }
        (rest, exponent) = (more, exponent - 1);
    }
    let mut out = Digits { digits: [0; 17], count: count.min(17), exponent };
    for place in out.digits.iter_mut().take(count) {
        rest.times(10);
        while *place < 9 && !rest.is_below(&scale) {
            rest.subtract(&scale);
            *place += 1;
        }
    }
    let last = out.digits.iter().take(count).next_back().copied().unwrap_or_default();
    let half = rest.plus(&rest).order(&scale);
    if half.is_gt() || half.is_eq() && last % 2 == 1 {
        out.raise();
    }
    out
}

impl Digits {
    /// One more in the last place.
    fn raise(&mut self) {
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

/// The real nearest to `digits * 10^exponent`, ties to even; infinity where it is beyond the greatest.
pub(crate) fn nearest(digits: u128, exponent: i32, format: Format) -> f64 {
    if digits == 0 || exponent < -400 {
        return 0.0;
    }
    if exponent > 320 {
        return f64::INFINITY;
    }
    let (mut over, mut under) = (Big::new(digits), Big::new(1));
    over.times_power_of_ten(exponent.max(0) as u32);
    under.times_power_of_ten((-exponent).max(0) as u32);
    // So that the quotient has the format's bits, or one more.
    let power = (over.bits() - under.bits() - format.precision).max(format.least);
    over.doubled((-power).max(0) as u32);
    under.doubled(power.max(0) as u32);
    let mut quotient = 0_u64;
    for bit in (0..=format.precision as u32).rev() {
        let mut part = under.clone();
        part.doubled(bit);
        if !over.is_below(&part) {
            over.subtract(&part);
            quotient |= 1 << bit;
        }
    }
    let (mut quotient, mut power, mut is_rest) = (quotient, power, !over.is_below(&Big::new(1)));
    let mut half = over.plus(&over).order(&under);
    if quotient >> format.precision > 0 {
        let lost = quotient & 1 == 1;
        half = match (lost, is_rest) {
            (false, _) => core::cmp::Ordering::Less,
            (true, false) => core::cmp::Ordering::Equal,
            (true, true) => core::cmp::Ordering::Greater,
        };
        (quotient, power, is_rest) = (quotient >> 1, power + 1, is_rest || lost);
    }
    if is_rest && (half.is_gt() || half.is_eq() && quotient & 1 == 1) {
        quotient += 1;
    }
    if quotient >> format.precision > 0 {
        (quotient, power) = (quotient >> 1, power + 1);
    }
    if power > format.greatest {
        return f64::INFINITY;
    }
    assemble(quotient, power)
}

/// `mantissa * 2^power`, which an LREAL holds exactly.
fn assemble(mantissa: u64, power: i32) -> f64 {
    if mantissa == 0 {
        return 0.0;
    }
    let (mut mantissa, mut power) = (mantissa, power);
    while mantissa >> 52 == 0 && power > -1074 {
        (mantissa, power) = (mantissa << 1, power - 1);
    }
    let exponent = if mantissa >> 52 == 0 { 0 } else { (power + 1075) as u64 };
    f64::from_bits(exponent << 52 | mantissa & ((1 << 52) - 1))
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
