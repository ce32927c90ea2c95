//! The values that rungs show of timers and counters: `TON(delay,5000,0)`. Logix keeps them in the tag, whose data say them
//! as well; a tag without data has them from here.

use super::super::names::{Shown, key};
use core::ops::Range;
use rustc_hash::FxHashMap;

const INSTRUCTIONS: [&str; 5] = ["TON(", "TOF(", "RTO(", "CTU(", "CTD("];

/// What the rungs of a file show, by the names of tags, and where the first does.
pub fn shown(file: &str) -> FxHashMap<String, (Shown, Range<usize>)> {
    let mut found: FxHashMap<_, (Shown, Range<usize>)> = FxHashMap::default();
    for name in INSTRUCTIONS {
        for (at, _) in file.match_indices(name) {
            let is_name = |it: char| it.is_ascii_alphanumeric() || it == '_';
            if file[..at].ends_with(is_name) {
                continue;
            }
            let Some((tag, values)) = operands(&file[at + name.len()..]) else { continue };
            let operands = &file[at + name.len()..];
            let start = at + name.len() + operands.len() - operands.trim_start().len();
            let kept = found.entry(key(tag)).or_insert((values, start..start + tag.len()));
            if kept.0 != values {
                kept.0 = Shown::Several;
            }
        }
    }
    found
}

/// The tag, and the numbers next to it; none where it shows none.
fn operands(text: &str) -> Option<(&str, Shown)> {
    let mut parts = text[..text.find(')')?].split(',').map(str::trim);
    let (tag, preset, accum) = (parts.next()?, parts.next()?, parts.next()?);
    let preset = preset.parse().ok()?;
    parts.next().is_none().then_some((tag, Shown::Values { preset, accum: accum.parse().unwrap_or(0) }))
}
