//! States that behave alike have one normal form: a timer's start is how long ago it was, and that
//! only while it matters.

use super::scalar::Instance;
use staunch_runtime::{Lane, Pin, Value};

/// Where a timer's pins lie in a state.
#[derive(Clone, Copy, Debug)]
pub struct Timer {
    kind: Kind,
    input_before: usize,
    output: usize,
    start: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    OnDelay,
    OffDelay,
    Pulse,
    /// A block that takes the time and is none of these: its start always matters.
    Other,
}

impl Timer {
    fn of(instance: &Instance) -> Option<Self> {
        let info = instance.block.info();
        if !info.instructions.iter().any(|it| it.needs_context) {
            return None;
        }
        let kind = match info.rust_path {
            "iec::Ton" => Kind::OnDelay,
            "iec::Tof" => Kind::OffDelay,
            "iec::Tp" => Kind::Pulse,
            _ => Kind::Other,
        };
        let at = |it: &'static Pin| instance.offset + it.offset;
        let pin = |name: &str| info.pin(name).map(at);
        Some(Self { kind, input_before: pin("in_before")?, output: pin("Q")?, start: pin("start")? })
    }

    /// Whether the next calls measure from `start`, as the blocks are written.
    fn measures(self, state: &[u8]) -> bool {
        let (input, output) = (state[self.input_before] != 0, state[self.output] != 0);
        match self.kind {
            Kind::OnDelay => input && !output,
            Kind::OffDelay => output && !input,
            Kind::Pulse => output,
            Kind::Other => true,
        }
    }

    /// Writes how long before `now` the timer started over when it did.
    pub fn settle(self, state: &mut [u8], now: i64) {
        let age = match Value::read(Lane::I64, &state[self.start..]) {
            Value::I64(start) if self.measures(state) => now.wrapping_sub(start),
            _ => 0,
        };
        Value::I64(age).write(&mut state[self.start..]);
    }
}

pub fn timers(blocks: &[Instance]) -> Vec<Timer> {
    blocks.iter().filter_map(Timer::of).collect()
}

/// 128 bits, so that two of many millions of states do not meet by chance.
pub fn hash(bytes: &[u8]) -> u128 {
    let (mut low, mut high) = (0x9E37_79B9_7F4A_7C15_u64, 0xC2B2_AE3D_27D4_EB4F_u64);
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
