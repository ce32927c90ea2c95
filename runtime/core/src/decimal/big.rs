//! Digits and reals by long division: exact for every number, and slow.

use super::digits::{Digits, Format, parts};

/// An unsigned integer of as many bits as the fraction of any LREAL needs.
#[derive(Clone)]
struct Big {
    words: [u32; Self::WORDS],
    /// How many of the words may be other than 0: from the lowest on.
    used: usize,
}

impl Big {
    const WORDS: usize = 48;

    fn new(value: u128) -> Self {
        let mut words = [0; Self::WORDS];
        for (at, word) in words.iter_mut().take(4).enumerate() {
            *word = (value >> (32 * at)) as u32;
        }
        Self { words, used: 4 }
    }

    fn lowest(&self, count: usize) -> &[u32] {
        self.words.get(..count).unwrap_or(&self.words)
    }

    fn used_mut(&mut self) -> &mut [u32] {
        self.words.get_mut(..self.used).unwrap_or_default()
    }

    /// Times `factor`; what leaves the top is lost, and nothing that is computed here reaches it.
    fn times(&mut self, factor: u32) {
        let mut carry = 0_u64;
        for word in self.used_mut() {
            let product = u64::from(*word) * u64::from(factor) + carry;
            (*word, carry) = (product as u32, product >> 32);
        }
        self.carried(carry);
    }

    /// One word more, where something is left to carry.
    fn carried(&mut self, carry: u64) {
        if let Some(word) = self.words.get_mut(self.used).filter(|_| carry > 0) {
            *word = carry as u32;
            self.used += 1;
        }
    }

    fn times_power_of_ten(&mut self, power: u32) {
        (0..power / 9).for_each(|_| self.times(1_000_000_000));
        (0..power % 9).for_each(|_| self.times(10));
    }

    fn doubled(&mut self, times: u32) {
        for _ in 0..times / 31 {
            self.times(1 << 31);
        }
        self.times(1 << (times % 31));
    }

    fn twice(&self) -> Self {
        let mut twice = self.clone();
        twice.times(2);
        twice
    }

    /// Subtracts `other`, which is at most as great.
    fn subtract(&mut self, other: &Self) {
        let mut borrow = 0_i64;
        for (word, other) in self.used_mut().iter_mut().zip(&other.words) {
            let rest = i64::from(*word) - i64::from(*other) + borrow;
            (*word, borrow) = (rest as u32, rest >> 32);
        }
    }

    fn order(&self, other: &Self) -> core::cmp::Ordering {
        let used = self.used.max(other.used);
        self.lowest(used).iter().rev().cmp(other.lowest(used).iter().rev())
    }

    fn is_below(&self, other: &Self) -> bool {
        self.order(other).is_lt()
    }

    fn is_zero(&self) -> bool {
        self.lowest(self.used).iter().all(|it| *it == 0)
    }

    fn bits(&self) -> i32 {
        let mut bits = 0;
        for (at, word) in (0..).zip(self.lowest(self.used)) {
            if *word != 0 {
                bits = at * 32 + 32 - word.leading_zeros() as i32;
            }
        }
        bits
    }
}

/// The first `count` digits, at most 17, the last one rounded, ties to even; `value` is an LREAL, finite and above 0.
pub(crate) fn rounded(value: f64, count: usize) -> Digits {
    let (mantissa, power) = parts(value);
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
    let half = rest.twice().order(&scale);
    if half.is_gt() || half.is_eq() && last % 2 == 1 {
        out.raise();
    }
    out
}

/// The real nearest to `digits * 10^exponent`, ties to even; infinity where it is beyond the greatest.
pub(super) fn nearest(digits: u128, exponent: i32, format: Format) -> f64 {
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
    let (mut quotient, mut power, mut is_rest) = (quotient, power, !over.is_zero());
    let mut half = over.twice().order(&under);
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
