// What is compared of a state, on both sides: the value of each variable, without padding, and without what follows a string's end. Of a NaN
// only that it is one: which, processors decide.

/// A part of the state: where, how many bytes or the kind, below.
#[derive(Clone, Copy)]
struct Part {
    at: usize,
    kind: u32,
}

/// Kinds from here on are these; those below are numbers of bytes.
const REAL: u32 = 0xFFFF_FFF0;
const LREAL: u32 = 0xFFFF_FFF1;
const STRING: u32 = 0xFFFF_FFF2;
const WSTRING: u32 = 0xFFFF_FFF3;

const START: u64 = 0xCBF2_9CE4_8422_2325;

fn stir(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3))
}

fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
    let mut taken = [0; N];
    taken.copy_from_slice(&bytes[..N]);
    taken
}

fn stir_part(hash: u64, state: &[u8], part: Part) -> u64 {
    let bytes = &state[part.at..];
    match part.kind {
        REAL if f32::from_le_bytes(first(bytes)).is_nan() => stir(hash, b"NaN"),
        LREAL if f64::from_le_bytes(first(bytes)).is_nan() => stir(hash, b"NaN"),
        REAL => stir(hash, &bytes[..4]),
        LREAL => stir(hash, &bytes[..8]),
        STRING => stir(hash, &bytes[..2 + usize::from(u16::from_le_bytes(first(bytes)))]),
        WSTRING => stir(hash, &bytes[..2 + 2 * usize::from(u16::from_le_bytes(first(bytes)))]),
        length => stir(hash, &bytes[..length as usize]),
    }
}
