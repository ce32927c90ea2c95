//! Whatever reference, distance and view compiled code hands to the runtime, it stays within the objects. Miri
//! sees what a processor would let pass.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use staunch_runtime::reference::{ORIGIN, Reference, View, Wanted, encode};
use staunch_runtime::{FaultKind, Repr, StringType, Text};

use staunch_runtime_abi as _;

unsafe extern "C" {
    fn staunch_reference_load(
        words: *const u32,
        state: *mut u8,
        reference: u64,
        distance: u64,
        view: u32,
        size: u32,
        out: *mut u8,
    ) -> u8;
    fn staunch_reference_store(
        words: *const u32,
        state: *mut u8,
        reference: u64,
        distance: u64,
        view: u32,
        size: u32,
        value: *const u8,
    ) -> u8;
    fn staunch_reference_load_text(
        words: *const u32,
        state: *mut u8,
        reference: u64,
        distance: u64,
        out: *mut u8,
        capacity: u16,
    ) -> u8;
    fn staunch_reference_store_text(
        words: *const u32,
        state: *mut u8,
        reference: u64,
        distance: u64,
        value: *const u8,
    ) -> u8;
    fn staunch_reference_find(
        words: *const u32,
        state: *mut u8,
        reference: u64,
        distance: u64,
        wanted: u32,
        out: *mut u64,
    ) -> u8;
}

fn index(number: u64) -> usize {
    usize::try_from(number).unwrap()
}

/// As much as an EXACT variable's number.
const SECRET: u32 = 9;

/// Offsets and sizes of the objects: four numbers, a BOOL, a STRING[6], what has no bytes. Bytes 17, 26 and 27 are
/// nobody's.
const OBJECTS: [(u32, u32); 4] = [(0, 16), (16, 1), (18, 8), (28, 4)];

fn words() -> Vec<u32> {
    let mut words = vec![4, 46, 58];
    let nodes = [23, 34, 38, 42];
    words.extend(
        OBJECTS
            .iter()
            .zip(nodes)
            .flat_map(|((offset, size), node)| [*offset, *size, if *size == 16 { 16 } else { 0 }, 0, node]),
    );
    words.extend([encode::ARRAY, 16, 5, 4, 30, encode::NUMBERS, encode::repr(Repr::U32)]);
    words.extend([encode::NUMBERS, 4, encode::repr(Repr::U32), 0]);
    words.extend([encode::TRUTHS, 1, encode::repr(Repr::Bool), 0]);
    words.extend([encode::TEXT, 8, 6, 0]);
    words.extend([encode::EXACT, 4, SECRET, 0]);
    words.extend([encode::STRUCTURE, 32, u32::MAX, 4, 0, 23, 16, 34, 18, 38, 28, 42]);
    assert_eq!(words.len(), 58);
    words
}

#[test]
fn no_access_leaves_the_objects() {
    let words = words();
    let mut random = 7_u64;
    let mut next = move |limit: u64| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) % limit
    };
    let mut state = [0_u64; 4];
    let bytes = state.as_mut_ptr().cast::<u8>();
    let mut done = 0;
    for _ in 0..if cfg!(miri) { 3_000 } else { 300_000 } {
        // Mostly in one of the objects or near it.
        let object = u32::try_from([1, 1, 2, 3, 3, 4, 0, 5][index(next(8))]).unwrap();
        let start = OBJECTS.get(index(u64::from(object)).wrapping_sub(1)).map_or(0, |it| it.0);
        let near = ORIGIN + start + u32::try_from(next(18)).unwrap();
        let address = [near, near, near - 8, ORIGIN + start, u32::MAX, 0][index(next(6))];
        let bits = Reference { object, address }.bits();
        let distance = [0, 0, 0, next(12), u64::from(u32::MAX), u64::MAX >> 1][index(next(6))];
        let size = [1, 2, 4, 8][index(next(4))];
        let (view, size) = match next(4) {
            0 => (View::Truth, 1),
            1 => (View::Exact(SECRET + u32::try_from(next(2)).unwrap()), 4),
            _ => (View::Number(size), size),
        };
        let mut out = [0_u8; 8];
        let value = next(u64::MAX).to_ne_bytes();
        let mut text = Text::<5>::default();
        let written = Text::<9>::new(&b"ABCDEFGHI"[..index(next(10))]);
        let mut found = 0;
        // SAFETY: the words are a table's, the state has the 32 bytes that it says, and the others are variables of
        // their own.
        let fault = unsafe {
            match next(5) {
                0 => staunch_reference_load(words.as_ptr(), bytes, bits, distance, view.code(), size, out.as_mut_ptr()),
                1 => staunch_reference_store(words.as_ptr(), bytes, bits, distance, view.code(), size, value.as_ptr()),
                2 => staunch_reference_load_text(words.as_ptr(), bytes, bits, distance, (&raw mut text).cast(), 5),
                3 => staunch_reference_store_text(words.as_ptr(), bytes, bits, distance, (&raw const written).cast()),
                _ => {
                    let wanted = [Wanted::Repr(Repr::U32), Wanted::Text(StringType::narrow(6)), Wanted::Exact(SECRET)];
                    let wanted = wanted[index(next(3))].code();
                    staunch_reference_find(words.as_ptr(), bytes, bits, distance, wanted, &mut found)
                }
            }
        };
        done += u32::from(fault == 0);
        assert!(fault == 0 || FaultKind::from_code(fault).is_some());
        assert!(found < 32);
        // SAFETY: no reference to the state lives; what is nobody's is as it was, and the string and BOOL are whole.
        let now: [u8; 32] = unsafe { bytes.cast::<[u8; 32]>().read() };
        assert_eq!([now[17], now[26], now[27]], [0; 3]);
        assert!(now[16] <= 1);
        assert!(u16::from_ne_bytes([now[18], now[19]]) <= 6);
    }
    assert!(done > 100, "{done} accesses succeeded");
}
