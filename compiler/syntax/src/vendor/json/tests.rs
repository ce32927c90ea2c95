//! What is JSON and what is not, and where.

use super::{Kind, parse};

#[test]
fn values_know_their_places() {
    let file = " {\"a\": [1, -2.5e3, true, null], \"b\" : \"x\\ny\\u00e4\\ud83d\\ude00\\ud83d\"}\n";
    let value = parse(file).unwrap();
    let Kind::Object(members) = &value.kind else { panic!("{value:?}") };
    let names: Vec<_> = members.iter().map(|it| it.name.raw(file)).collect();
    assert_eq!(names, ["a", "b"]);
    let Kind::List(items) = &members[0].value.kind else { panic!("{value:?}") };
    let items: Vec<_> = items.iter().map(|it| (it.raw(file), it.what())).collect();
    assert_eq!(items, [("1", "a number"), ("-2.5e3", "a number"), ("true", "a truth value"), ("null", "null")]);
    assert_eq!(members[1].value.text(file), "x\nyä😀\u{fffd}");
    assert_eq!(&file[value.place], file.trim());
}

#[test]
fn what_is_not_json_is_refused_at_its_place() {
    let cases = [
        ("", 0, "the file ends where a value is expected"),
        ("{\"a\": 1", 0, "this is not closed"),
        ("[1,", 2, "the file ends where a value is expected"),
        ("[1 2]", 3, "`,` or `]` is expected"),
        ("[,]", 1, "a value is expected"),
        ("{a: 1}", 1, "the name of a member, in quotes, is expected"),
        ("{\"a\" 1}", 5, "`:` is expected after the name of a member"),
        ("{\"a\": 1, \"a\": 2}", 9, "\"a\" is in this object twice"),
        ("[\"a]", 1, "this text is not closed"),
        ("\"a\\x\"", 2, "no character is written like this"),
        ("\"\\u12g4\"", 1, "no character is written like this"),
        ("\"a\nb\"", 2, "a control character in a string"),
        ("01", 0, "this is not a number"),
        ("[1.]", 1, "this is not a number"),
        ("{} {}", 3, "text after the end of the value"),
        ("ä", 0, "a value is expected"),
    ];
    for (file, at, why) in cases {
        let broken = parse(file).unwrap_err();
        assert_eq!((broken.place.start, broken.why.as_str()), (at, why), "{file}");
        assert!(file.get(broken.place).is_some(), "{file}");
    }
}

#[test]
fn nesting_has_a_limit() {
    let nested = |levels: usize| "[".repeat(levels) + &"]".repeat(levels);
    parse(&nested(100)).unwrap();
    assert_eq!(parse(&nested(100_000)).unwrap_err().why, "values are nested too deeply");
    let objects = "{\"a\":".repeat(100_000);
    assert_eq!(parse(&objects).unwrap_err().why, "values are nested too deeply");
}

/// No text makes reading panic, wherever it is cut, and whatever a byte is replaced by.
#[test]
fn any_text_is_read_or_refused() {
    let file = "{\"ä\": [1, \"\\u00e4\\n😀\", {\"b\": false}], \"c\": -1.5e-3}";
    for (at, symbol) in file.char_indices() {
        let (before, after) = (&file[..at], &file[at + symbol.len_utf8()..]);
        for changed in ["", "\"", "\\", "{", "]", ",", "ä", "\\u", "9"] {
            let changed = format!("{before}{changed}{after}");
            if let Err(broken) = parse(&changed) {
                assert!(changed.get(broken.place).is_some(), "{changed}");
            }
        }
        assert!(parse(before).is_err(), "{before}");
    }
}
