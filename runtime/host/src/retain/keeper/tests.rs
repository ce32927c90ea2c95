//! Which states are written, and when.

use super::super::format::recover;
use super::super::tests::faulty::{Faults, Faulty, Random};
use super::*;

const SIZE: usize = 1500;

fn layout() -> Layout {
    Layout::new("Main", [("main.x", "ARRAY", SIZE)].into_iter())
}

/// State `number` of a program: each of its words shows the number.
fn values(number: u32) -> Vec<u8> {
    number.to_le_bytes().repeat(SIZE / 4)
}

/// What the state says of a fault, in every other one.
fn fault(number: u32) -> String {
    if number % 2 == 0 { String::new() } else { format!("p.st:{number}:1: fault: division by zero") }
}

/// What a start finds: the number of the state, 0 without a file, and what the keeper gets of it.
fn start(file: Option<&[u8]>) -> (u32, Option<(Time, Found)>) {
    let Some(file) = file else { return (0, None) };
    let content = recover(file).expect("a file that was once saved can be recovered");
    let found = content.found.unwrap();
    let number = u32::from_le_bytes(*found.values.first_chunk().unwrap());
    assert_eq!(found.values, values(number), "a state is whole");
    assert_eq!(content.clock, i64::from(number));
    assert!(found.fault.is_empty() || found.fault == fault(number), "{}", found.fault);
    assert!(layout().is_of(file));
    (number, Some((content.clock, found)))
}

/// Saves until the power goes; how it went on before that is by chance. Holds that each start finds the state
/// that was saved last, or one whose saving began after that.
fn live(seed: u64) -> usize {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let (mut number, mut saved) = (0, 0);
    let mut file: Option<Vec<u8>> = None;
    let mut starts = 0;
    for life in 0..4 {
        let mut rare = |percent| if random.chance(50) { 0 } else { random.below(percent) };
        let faults =
            Faults { errors: rare(30), short_writes: rare(90), failing_syncs: rare(40), room: None, power: None };
        let room = random.chance(30).then(|| random.below(4 * SIZE));
        let faults = Faults { room, power: Some(1 + random.below(60)), ..faults };
        let disk = Faulty::new(seed ^ life << 40, faults, file.as_deref());
        // Processes that are killed come and go while the power is on.
        while disk.has_power() {
            let cached = disk.cached();
            let (found, known) = start(cached.as_deref());
            starts += 1;
            assert!((saved..=number).contains(&found), "seed {seed}: {found} after {saved}, {number} begun");
            let mut keeper = Keeper::new(disk.clone(), layout(), known);
            for _ in 0..random.below(12) {
                number += 1;
                if keeper.save(number.into(), &values(number), &fault(number)).is_ok() {
                    saved = number;
                }
            }
        }
        file = disk.after_power_cut();
        let (found, _) = start(file.as_deref());
        assert!((saved..=number).contains(&found), "seed {seed}: {found} after {saved}, {number} begun");
        // From now on the disk holds what it holds.
        saved = found;
    }
    starts
}

/// `STAUNCH_SEEDS=0..100000` for more.
fn seeds() -> std::ops::Range<u64> {
    let text = std::env::var("STAUNCH_SEEDS").unwrap_or_else(|_| "0..1000".to_owned());
    let (from, to) = text.split_once("..").unwrap();
    from.parse().unwrap()..to.parse().unwrap()
}

#[test]
#[cfg_attr(miri, ignore = "it takes long")]
fn whenever_the_power_goes_the_last_state_is_found() {
    let lives = seeds();
    let least = (lives.end - lives.start) * 4;
    let starts: usize = lives.map(live).sum();
    assert!(starts as u64 >= least, "{starts} starts");
}

#[test]
fn a_disk_that_is_full_is_still_written_inside() {
    let disk = Faulty::new(1, Faults::default(), None);
    let mut keeper = Keeper::new(disk.clone(), layout(), None);
    keeper.save(1, &values(1), "").unwrap();
    disk.set(Faults { room: Some(0), ..Faults::default() });
    keeper.save(2, &values(2), "").unwrap();
    // A start finds the file, and continues inside it.
    let (_, found) = start(disk.cached().as_deref());
    Keeper::new(disk.clone(), layout(), found).save(3, &values(3), "").unwrap();
    assert_eq!(start(disk.after_power_cut().as_deref()).0, 3);
    let full = Faulty::new(2, Faults { room: Some(100), ..Faults::default() }, None);
    let error = Keeper::new(full.clone(), layout(), None).save(1, &values(1), "").unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    assert_eq!(full.cached(), None);
}

#[test]
fn a_file_that_cannot_be_written_inside_is_made_anew() {
    let disk = Faulty::new(1, Faults::default(), None);
    let mut keeper = Keeper::new(disk.clone(), layout(), None);
    keeper.save(1, &values(1), "").unwrap();
    keeper.layout = Layout::new("Main", [("main.x", "ANOTHER", SIZE)].into_iter());
    keeper.good = None;
    keeper.save(2, &values(2), "").unwrap();
    assert!(keeper.layout.is_of(&disk.cached().unwrap()));
}

#[test]
fn a_file_with_the_last_of_all_sequence_numbers_is_made_anew() {
    for sequence in [u64::MAX, u64::MAX - 1, u64::MAX / 2] {
        let old = layout().encode_file(Record { sequence, clock: 1, values: &values(1), fault: "" });
        let (number, found) = start(Some(&old));
        assert_eq!(number, 1);
        let disk = Faulty::new(1, Faults::default(), None);
        let mut keeper = Keeper::new(disk.clone(), layout(), found);
        for number in 2..5 {
            keeper.save(i64::from(number), &values(number), &fault(number)).unwrap();
            assert_eq!(start(disk.after_power_cut().as_deref()).0, number, "after {sequence}");
        }
    }
}
