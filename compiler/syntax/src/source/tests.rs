//! Lines and columns, also of a text that is made of pieces of a file.

#![allow(clippy::unwrap_used)]

use super::Source;

#[test]
fn a_column_counts_characters_wherever_it_stands() {
    let text = format!("a\n{}x\n{}y", "ä€".repeat(900), "é".repeat(600));
    let source = Source::new("a.st", text.clone());
    for (offset, _) in text.char_indices() {
        let line = text[..offset].rfind('\n').map_or(0, |it| it + 1);
        let column = text[line..offset].chars().count() + 1;
        let found = source.line_column(u32::try_from(offset).unwrap());
        assert_eq!(usize::try_from(found.1).unwrap(), column, "{offset}");
    }
    assert_eq!(source.line_column(u32::MAX), (3, 602));
    let line = |offset: usize| u32::try_from(text[..offset].matches('\n').count() + 1).unwrap();
    let offsets: Vec<usize> = text.char_indices().map(|it| it.0).collect();
    // Back, and with steps that pass lines by.
    for offset in offsets.iter().rev().chain(offsets.iter().cycle().step_by(677).take(2000)) {
        assert_eq!(source.line_column(u32::try_from(*offset).unwrap()).0, line(*offset), "{offset}");
    }
}

#[test]
fn a_place_of_the_text_is_a_place_of_the_file() {
    let text = format!("{}x", "äö€".repeat(700));
    let marked = [b"\xEF\xBB\xBF", text.as_bytes()].concat();
    let windows = [[0xe4, 0xf6, 0x80].repeat(700), b"x".to_vec()].concat();
    for (bytes, at) in [(text.as_bytes(), 4900), (marked.as_slice(), 4903), (windows.as_slice(), 2100)] {
        let source = Source::decode("a.st", bytes);
        let offset = u32::try_from(source.text.find('x').unwrap()).unwrap();
        assert_eq!(source.file_offset(offset), at);
        assert_eq!(bytes[usize::try_from(at).unwrap()], b'x');
    }
}

#[test]
fn a_place_in_a_long_line_is_found_at_once() {
    let source = Source::new("a.st", "x".repeat(4_000_000));
    // Counting from the start of the line would take half a minute.
    for offset in (0..4_000_000).step_by(20) {
        assert_eq!(source.line_column(offset), (1, offset + 1));
    }
}
