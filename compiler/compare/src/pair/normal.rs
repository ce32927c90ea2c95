//! States that behave the same way have one normal form: a timer's start is how long ago it was, and that
//! only while it matters.

use crate::program::scalar::Instance;
use staunch_ir::{Program, Type};
use staunch_runtime::{Pin, Repr, Value};

/// Where a timer's pins are in a state.
#[derive(Clone, Copy, Debug)]
pub struct Timer {
    kind: Kind,
    input_before: usize,
    output: usize,
    start: usize,
    /// Of a timer that remembers whether it runs.
    runs: Option<usize>,
    /// Of a start longer ago than this, it does not matter when it was: the time of every call is over.
    longest: Option<i64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    OnDelay,
    OffDelay,
    Pulse,
    Running,
    /// A block that takes the time and is none of these: its start always matters.
    Other,
}

impl Timer {
    fn of(instance: &Instance, longest: Option<i64>) -> Option<Self> {
        let info = instance.block.info();
        if !info.instructions.iter().any(|it| it.needs_context) {
            return None;
        }
        // A path of tokens, which the table prints with spaces between.
        let kind = match info.rust_path.replace(' ', "").as_str() {
            "iec::Ton" | "openplc4::Ton" => Kind::OnDelay,
            "iec::Tof" | "openplc4::Tof" => Kind::OffDelay,
            "iec::Tp" | "openplc4::Tp" => Kind::Pulse,
            "openplc::Ton" | "openplc::Tof" | "openplc::Tp" => Kind::Running,
            _ => Kind::Other,
        };
        let at = |it: &'static Pin| instance.offset + it.offset;
        let pin = |name: &str| info.pin(name).map(at);
        let (input_before, output, start) = (pin("in_before")?, pin("Q")?, pin("start")?);
        Some(Self { kind, input_before, output, start, runs: pin("runs"), longest })
    }

    /// Whether the next calls measure from `start`, as the blocks are written.
    fn measures(self, state: &[u8]) -> bool {
        let (input, output) = (state[self.input_before] != 0, state[self.output] != 0);
        match self.kind {
            Kind::OnDelay => input && !output,
            Kind::OffDelay => output && !input,
            Kind::Pulse => output,
            Kind::Running => self.runs.is_some_and(|at| state[at] != 0),
            Kind::Other => true,
        }
    }

    /// Writes how long before `now` the timer started over when it did.
    pub fn settle(self, state: &mut [u8], now: i64) {
        let age = match Value::read(Repr::I64, &state[self.start..]) {
            Value::I64(start) if self.measures(state) => {
                let age = now.wrapping_sub(start);
                self.longest.filter(|_| self.kind != Kind::Other).map_or(age, |it| age.min(it))
            }
            _ => 0,
        };
        Value::I64(age).write(&mut state[self.start..]);
    }
}

/// Whether the program reads the time itself, or by a block whose start has no normal form, so that a state of it
/// means something else later.
pub fn reads_clock(program: &Program) -> bool {
    let locals = program.routines.iter().flat_map(|it| &it.locals).map(|it| it.ty);
    let fields = program.structs.iter().flat_map(|it| &it.fields).map(|it| it.ty);
    let elements = program.arrays.iter().map(|it| it.element);
    locals.chain(fields).chain(elements).any(keeps_time)
}

/// What a timer has whose start is settled.
const SETTLED_BY: [&str; 3] = ["IN", "Q", "start"];

/// Whether it is a block that takes the time, and none whose start is settled.
fn keeps_time(ty: Type) -> bool {
    let Type::Block(id) = ty else { return false };
    let info = id.info();
    let is_settled = SETTLED_BY.iter().all(|it| info.pin(it).is_some());
    !is_settled && info.instructions.iter().any(|it| it.needs_context)
}

/// The timers among the blocks. `longest` is the longest PT that any is given, if all are constant.
pub fn timers(blocks: &[Instance], longest: Option<i128>) -> Vec<Timer> {
    let longest = longest.and_then(|it| i64::try_from(it).ok());
    blocks.iter().filter_map(|it| Timer::of(it, longest)).collect()
}

/// Bytes of a state that are hashed together.
const CHUNK: usize = 256;

/// The hash of a state that changes little from one time to the next: only what has changed is hashed anew.
#[derive(Debug, Default)]
pub struct Digest {
    state: Vec<u8>,
    /// One for each chunk of the state.
    hashes: Vec<u128>,
    sum: u128,
    /// Chunks that were hashed so far.
    #[cfg(test)]
    hashed: usize,
}

impl Digest {
    pub fn of(&mut self, state: &[u8]) -> u128 {
        self.state.resize(state.len(), 0);
        let mut is_new = self.hashes.is_empty();
        self.hashes.resize(state.len().div_ceil(CHUNK), 0);
        is_new &= !self.hashes.is_empty();
        let chunks = self.state.chunks_mut(CHUNK).zip(state.chunks(CHUNK));
        for ((number, known), (before, now)) in (0_u64..).zip(&mut self.hashes).zip(chunks) {
            if before != now || is_new {
                before.copy_from_slice(now);
                let new = hash_from(number, now);
                self.sum = self.sum.wrapping_sub(*known).wrapping_add(new);
                *known = new;
                #[cfg(test)]
                {
                    self.hashed += 1;
                }
            }
        }
        self.sum
    }
}

/// 128 bits, so that two of many millions of states do not meet by chance.
pub fn hash(bytes: &[u8]) -> u128 {
    hash_from(0, bytes)
}

/// Another function of the bytes for each seed.
fn hash_from(seed: u64, bytes: &[u8]) -> u128 {
    let (mut low, mut high) = (0x9E37_79B9_7F4A_7C15_u64, 0xC2B2_AE3D_27D4_EB4F_u64);
    (low, high) = (fold(low ^ seed, 0x1656_67B1_9E37_79F9), high.wrapping_add(seed));
    let (words, rest) = bytes.as_chunks::<8>();
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    for word in words.iter().chain([&last, &bytes.len().to_ne_bytes()]) {
        let word = u64::from_ne_bytes(*word);
        low = fold(low ^ word, 0xA076_1D64_78BD_642F);
        high = fold(high.rotate_left(23) ^ word, 0xE703_7ED1_A0B4_28DB).wrapping_add(low);
    }
    u128::from(low) << 64 | u128::from(high)
}

/// Both halves of a product, which mixes every bit into every other.
fn fold(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b | 1);
    let bytes = product.to_ne_bytes();
    let half = |at: usize| u64::from_ne_bytes(std::array::from_fn(|it| bytes[at + it]));
    half(0) ^ half(8).rotate_left(17) ^ a.rotate_left(32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use staunch_ir::BlockId;
    use staunch_runtime::{BLOCKS, BlockInfo, Context};

    const STEP: i64 = 10_000_000;

    /// Numbers without order, the same in every run.
    struct Numbers(u64);

    impl Numbers {
        fn below(&mut self, limit: i64) -> i64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            i64::try_from(self.0 >> 33).map_or(0, |it| it % limit)
        }
    }

    /// The same number for the same state, whatever came before; and a large state costs no more than a small one
    /// where as much of it changes.
    #[test]
    fn what_stays_is_not_hashed_again() {
        let hashed = |size: usize| {
            let (mut digest, mut state, mut numbers) = (Digest::default(), vec![0; size], Numbers(1));
            digest.of(&state);
            let first = digest.hashed;
            for _ in 0..500 {
                let at = usize::try_from(numbers.below(4000)).unwrap_or(0);
                state[at] = u8::try_from(numbers.below(3)).unwrap_or(0);
                assert_eq!(digest.of(&state), Digest::default().of(&state));
            }
            digest.hashed - first
        };
        let (small, large) = (hashed(4 << 10), hashed(400 << 10));
        assert!(0 < small && small == large, "{small} and {large} chunks");
        let moved = |at: usize| {
            let mut state = vec![0; 1024];
            state[at] = 1;
            Digest::default().of(&state)
        };
        assert!(moved(0) != moved(CHUNK) && moved(0) != moved(1));
    }

    fn set(info: &BlockInfo, state: &mut [u8], pin: &str, value: Value) {
        let at = info.pin(pin).map_or(0, |it| it.offset);
        value.write(&mut state[at..]);
    }

    /// A call with an input, a delay, and the time since the last one.
    fn call(info: &BlockInfo, state: &mut [u8], now: i64, (input, delay, _): (bool, i64, i64)) {
        set(info, state, "IN", Value::Bool(input));
        set(info, state, "PT", Value::I64(delay));
        (info.instructions[0].run)(state, &Context::new(now, false), false);
    }

    fn inputs(numbers: &mut Numbers) -> (bool, i64, i64) {
        (numbers.below(2) == 1, (numbers.below(5) - 1) * STEP, numbers.below(3) * STEP)
    }

    fn settled(timer: Timer, state: &[u8], now: i64) -> Vec<u8> {
        let mut state = state.to_vec();
        timer.settle(&mut state, now);
        state
    }

    /// A state and another one of its normal form, at another time and with another start where that
    /// should not matter, go the same way.
    #[test]
    fn states_of_one_normal_form_behave_alike() {
        let mut compared = 0;
        // What else takes the time has not all of them: a program with it is never taken for settled.
        let timed = |it: &BlockInfo| {
            let has_all = SETTLED_BY.iter().all(|pin| it.pin(pin).is_some());
            has_all && it.instructions.iter().any(|it| it.needs_context)
        };
        let blocks = || BLOCKS.iter().enumerate().filter(|(_, it)| timed(it));
        // No preset is more than three steps.
        for ((number, info), longest) in blocks().flat_map(|it| [(it, None), (it, Some(3 * STEP))]) {
            let (path, key, block) = (String::new(), String::new(), BlockId::next(number));
            let timer = Timer::of(&Instance { path, key, block, offset: 0, field: None }, longest);
            let timer = timer.expect("a block that takes the time is a timer");
            assert_ne!(timer.kind, Kind::Other, "{}", info.name);
            let mut numbers = Numbers(u64::try_from(number).unwrap_or(0));
            for _ in 0..2000 {
                let (mut state, mut now) = (vec![0; info.size], 0);
                for _ in 0..numbers.below(12) {
                    let given = inputs(&mut numbers);
                    now += given.2;
                    call(info, &mut state, now, given);
                }
                let shift = numbers.below(1000) * STEP;
                let (mut other, form) = (state.clone(), settled(timer, &state, now));
                let start = match Value::read(Repr::I64, &form[timer.start..]) {
                    Value::I64(age) if timer.measures(&state) => now + shift - age,
                    _ => numbers.below(1000) * STEP,
                };
                Value::I64(start).write(&mut other[timer.start..]);
                for _ in 0..8 {
                    assert_eq!(settled(timer, &state, now), settled(timer, &other, now + shift), "{}", info.name);
                    let given = inputs(&mut numbers);
                    now += given.2;
                    call(info, &mut state, now, given);
                    call(info, &mut other, now + shift, given);
                    compared += 1;
                }
            }
        }
        assert!(compared > 40_000, "{compared}");
    }
}
