//! What outputs are before the first scan and at the end of a run, where the project states it: `[safe]` of staunch.toml, which the map carries.

use super::client::values;
use super::points::{Area, Point, Points};
use crate::map::Map;
use crate::path;
use crate::stimulus::Write;

/// What is wrong with the safe values of a map: the number of one, from 0, and why.
pub fn check_safe(map: &Map) -> Result<(), (usize, String)> {
    let points = Points::of(map);
    let mut before: Vec<Write> = Vec::new();
    for (number, (name, value)) in map.safe.iter().enumerate() {
        let write = output(map, &points, name, value).map_err(|text| (number, text))?;
        if before.iter().any(|it| it.overlaps(&write)) {
            return Err((number, "another entry has a value for the same bits".to_owned()));
        }
        before.push(write);
    }
    Ok(())
}

/// The values at addresses, outputs with their safe values. [`check_safe`] reports mistakes in them.
pub(super) fn points_of(map: &Map) -> Points {
    let mut points = Points::of(map);
    let stated: Vec<Write> =
        map.safe.iter().filter_map(|(name, value)| output(map, &points, name, value).ok()).collect();
    let mut state = vec![0; if stated.is_empty() { 0 } else { map.size }];
    for write in &stated {
        let bytes = write.over(&state).into_owned();
        state[write.offset..write.offset + bytes.len()].copy_from_slice(&bytes);
    }
    for point in &mut points.all {
        if point.area == Area::Output && stated.iter().any(|it| shares(it, point)) {
            point.safe = Some(point.read(&state));
        }
    }
    points
}

fn output(map: &Map, points: &Points, name: &str, value: &str) -> Result<Write, String> {
    if values(map, points, name)?.iter().any(|it| it.area != Area::Output) {
        return Err("it is an input, and safe values are of outputs: name a variable at %Q".to_owned());
    }
    let running: Vec<usize> = (0..map.instances.len()).collect();
    Write::parse(map, path::resolve(map, &running, name)?, value)
}

/// Whether a point has bits that are written.
fn shares(write: &Write, point: &Point) -> bool {
    let (start, end) = (point.offset(), point.offset() + point.width.size());
    let is_apart = end <= write.offset || write.offset + write.bytes.len() <= start;
    let are_bits = write.bit.is_some() && point.bit().is_some() && write.bit != point.bit();
    !is_apart && !are_bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachments::AtEnd;
    use crate::fixture::map_with;

    fn stated(entries: &[(&str, &str)]) -> Map {
        let fields = [
            ("BOOL", 0, "-", "%QX0.0"),
            ("INT", 2, "-", "%QW1"),
            ("bit:3", 2, "view", "%QX2.3"),
            ("array:0", 8, "-", "%QW8"),
            ("INT", 20, "-", "%IW0"),
            ("INT", 22, "-", "-"),
            ("enum:0", 24, "-", "%QW20"),
            ("TIME", 32, "-", "%QL3"),
        ];
        let mut map = map_with(&fields);
        map.safe = entries.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        map
    }

    fn at_end(entries: &[(&str, &str)], at_end: AtEnd) -> Vec<u64> {
        let map = stated(entries);
        assert_eq!(check_safe(&map), Ok(()));
        points_of(&map).all.iter().filter(|it| it.area == Area::Output).map(|it| it.at_end(at_end, 7)).collect()
    }

    #[test]
    fn a_stated_value_is_an_output_s_at_the_end() {
        let entries = [("v0", "TRUE"), ("%QW1", "9"), ("v6", "a"), ("v7", "T#1us")];
        assert_eq!(at_end(&entries, AtEnd::Zero), [1, 9, 1, 0, 0, 0, 0, 0, 1000]);
        assert_eq!(at_end(&entries, AtEnd::Hold), [1, 9, 1, 7, 7, 7, 7, 0, 1000]);
        assert_eq!(at_end(&[("%QX2.3", "TRUE"), ("v3[2]", "5")], AtEnd::Hold), [7, 8, 1, 7, 5, 7, 7, 7, 7]);
    }

    #[test]
    fn mistakes_are_told() {
        for (entries, number, expected) in [
            (&[("v0", "TRUE"), ("lamp", "1")][..], 1, "there is no variable `lamp`"),
            (&[("v0", "2")], 0, "`2`"),
            (&[("v4", "2")], 0, "it is an input, and safe values are of outputs"),
            (&[("v5", "2")], 0, "only variables at addresses are connected"),
            (&[("v1", "70000")], 0, "70000"),
            (&[("v1", "1"), ("%QX2.3", "TRUE")], 1, "another entry has a value for the same bits"),
        ] {
            let (at, text) = check_safe(&stated(entries)).unwrap_err();
            assert!(at == number && text.contains(expected), "{at}: {text}");
        }
    }
}
