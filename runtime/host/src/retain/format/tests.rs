//! Retained states as bytes: damaged and forged ones are refused.

use super::*;

const VARIABLES: [(&str, &str, usize); 2] = [("main.count", "INT", 2), ("main.name", "STRING[700]", 702)];

fn layout() -> Layout {
    Layout::new("Main", VARIABLES.into_iter())
}

/// State `number` of a program: each byte shows the number.
fn values(number: u8) -> Vec<u8> {
    (0..704).map(|at| number.wrapping_mul(31).wrapping_add(u8::try_from(at % 251).unwrap())).collect()
}

/// A file in which state 7 was saved after state 6.
fn file() -> Vec<u8> {
    let layout = layout();
    let mut file = layout.encode_file(Record { sequence: 6, clock: 60, values: &values(6), fault: "" });
    let mut slot = Vec::new();
    layout.encode_slot(Record { sequence: 7, clock: 70, values: &values(7), fault: "" }, &mut slot);
    let at = layout.offset(Slot::Second);
    file[at..at + slot.len()].copy_from_slice(&slot);
    file
}

/// The number of the state that a file holds; `None` if it is refused. Any other state fails.
fn state_of(file: &[u8]) -> Option<u8> {
    let content = recover(file).ok()?;
    let found = content.found.expect("a file with slots");
    let number = u8::try_from(found.sequence).unwrap();
    assert_eq!((content.programs.as_str(), content.clock), ("Main", i64::from(number) * 10));
    assert_eq!(found.values, values(number));
    let bytes: Vec<u8> = content.variables.iter().flat_map(|it| it.2.clone().unwrap()).collect();
    assert_eq!(bytes, values(number));
    let names: Vec<(&str, &str)> = content.variables.iter().map(|it| (it.0.as_str(), it.1.as_str())).collect();
    assert_eq!(names, [("main.count", "INT"), ("main.name", "STRING[700]")]);
    Some(number)
}

#[test]
fn the_later_state_is_taken() {
    assert_eq!(state_of(&file()), Some(7));
    assert_eq!(file().len(), 3 * SECTOR);
    assert!(layout().is_of(&file()));
    let first = layout().encode_file(Record { sequence: 6, clock: 60, values: &values(6), fault: "" });
    assert_eq!(state_of(&first), Some(6));
    assert!(!recover(&first).unwrap().found.unwrap().other_is_broken);
}

#[test]
fn of_every_prefix_a_whole_state_is_taken_or_none() {
    let (file, layout) = (file(), layout());
    let ends = Slot::BOTH.map(|it| layout.offset(it) + SLOT_HEAD + 704 + FAULT);
    for length in 0..file.len() {
        let expected = if length >= ends[1] { Some(7) } else { (length >= ends[0]).then_some(6) };
        assert_eq!(state_of(&file[..length]), expected, "{length}");
    }
}

#[test]
fn of_every_flipped_byte_a_whole_state_is_taken_or_none() {
    let (file, layout) = (file(), layout());
    let [first, second] = Slot::BOTH.map(|it| layout.offset(it)..layout.offset(it) + SLOT_HEAD + 704 + FAULT);
    for at in 0..file.len() {
        for flip in [0x01, 0x20, 0x80, 0xFF] {
            let mut damaged = file.clone();
            damaged[at] ^= flip;
            let expected = match at {
                _ if at < layout.head.len() => None,
                _ if second.contains(&at) => Some(6),
                _ => Some(7),
            };
            assert_eq!(state_of(&damaged), expected, "{at}: {flip:02x}");
            if first.contains(&at) || second.contains(&at) {
                assert!(recover(&damaged).unwrap().found.unwrap().other_is_broken, "{at}");
            }
        }
    }
}

/// Writes state 8 over state 6, of which any byte is the last that got to the disk.
#[test]
fn of_every_torn_write_the_state_before_is_taken() {
    let (file, layout) = (file(), layout());
    let mut slot = Vec::new();
    layout.encode_slot(Record { sequence: 8, clock: 80, values: &values(8), fault: "" }, &mut slot);
    let at = layout.offset(Slot::First);
    for written in 0..=slot.len() {
        let mut torn = file.clone();
        torn[at..at + written].copy_from_slice(&slot[..written]);
        // Some bytes of the two states are the same, so that a write may be whole before its end.
        let whole = torn[at..at + slot.len()] == slot;
        assert_eq!(state_of(&torn), Some(if whole { 8 } else { 7 }), "{written} bytes");
        let mut backwards = file.clone();
        backwards[at + written..at + slot.len()].copy_from_slice(&slot[written..]);
        let whole = backwards[at..at + slot.len()] == slot;
        assert_eq!(state_of(&backwards), Some(if whole { 8 } else { 7 }), "all but {written} bytes");
    }
    for sector in (0..slot.len()).step_by(512) {
        let mut torn = file.clone();
        let end = (sector + 512).min(slot.len());
        torn[at + sector..at + end].copy_from_slice(&slot[sector..end]);
        assert_eq!(state_of(&torn), Some(7), "sector {sector}");
    }
}

#[test]
fn a_slot_of_another_file_is_none_of_this() {
    let mut file = file();
    let other = Layout::new("Main", [("main.count", "INT", 2), ("main.name", "BYTES[702]", 702)].into_iter());
    let mut slot = Vec::new();
    other.encode_slot(Record { sequence: 9, clock: 90, values: &values(9), fault: "" }, &mut slot);
    let at = layout().offset(Slot::First);
    file[at..at + slot.len()].copy_from_slice(&slot);
    assert_eq!(state_of(&file), Some(7));
}

#[test]
fn a_head_that_promises_too_much_is_refused() {
    for sizes in [[usize::MAX, 2], [usize::MAX / 2, usize::MAX / 2], [1 << 40, 0]] {
        let mut text = format!("{TITLE}{VERSION}\nprogram\tMain\n");
        sizes.iter().for_each(|it| text += &format!("main.x\tINT\t{it}\n"));
        text += &format!("{CHECKSUM}{:08x}\n", crc32(text.as_bytes()));
        let mut file = text.into_bytes();
        file.resize(1 << 16, 0);
        assert!(matches!(recover(&file), Err(Refusal::Damaged(_))), "{sizes:?}");
    }
    // The same size, written otherwise.
    let text = format!("{TITLE}{VERSION}\nprogram\tMain\nmain.x\tINT\t+2\n");
    let file = format!("{text}{CHECKSUM}{:08x}\n", crc32(text.as_bytes()));
    assert!(matches!(recover(file.as_bytes()), Err(Refusal::Damaged(_))));
}

#[test]
fn nothing_to_keep_is_kept_too() {
    let layout = Layout::new("Main", std::iter::empty());
    let file = layout.encode_file(Record { sequence: 1, clock: 5, values: &[], fault: "" });
    let content = recover(&file).unwrap();
    assert_eq!((content.clock, content.variables.len()), (5, 0));
}

#[test]
fn foreign_files_are_told_from_damaged_ones() {
    assert_eq!(recover(b""), Err(Refusal::Foreign));
    assert_eq!(recover(&[0xFF; 9000]), Err(Refusal::Foreign));
    let newer = [TITLE.as_bytes(), b"5\n"].concat();
    assert_eq!(recover(&newer).unwrap_err().text(), "its format is version 5, and this Staunch reads versions 2 to 4");
}

#[test]
fn a_fault_is_kept_and_a_long_one_by_its_end() {
    let layout = layout();
    let kept = |fault: &str| {
        let file = layout.encode_file(Record { sequence: 1, clock: 0, values: &values(1), fault });
        recover(&file).unwrap().found.unwrap().fault
    };
    assert_eq!(kept("p.st:7:10: fault: division by zero"), "p.st:7:10: fault: division by zero");
    let long = "ä".repeat(FAULT);
    assert_eq!(kept(&format!("{long}:7:10")), format!("{}:7:10", "ä".repeat((FAULT - 5) / 2)));
}

/// What an older Staunch wrote.
#[test]
fn a_file_of_version_3_is_read_and_made_anew() {
    let old = Layout::of_version(WITHOUT_FAULT, "Main", VARIABLES.into_iter());
    let file = old.encode_file(Record { sequence: 6, clock: 60, values: &values(6), fault: "not kept" });
    assert_eq!(state_of(&file), Some(6));
    assert_eq!(recover(&file).unwrap().found.unwrap().fault, "");
    assert!(!layout().is_of(&file));
}
