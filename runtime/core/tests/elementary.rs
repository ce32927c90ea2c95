//! The figure of the types, and the types of the blocks' pins.

use staunch_runtime::{BLOCKS, Class, Elementary, Family};

#[test]
fn the_classes_are_the_standards_figure() {
    let members = |class: Class| -> Vec<_> {
        // An LTIME without a sign is the LTIME of a system.
        let named = Elementary::ALL.into_iter().filter(|it| *it != Elementary::Ultime);
        named.filter(|it| it.is(class)).map(Elementary::name).collect()
    };
    assert_eq!(members(Class::Bit), ["BOOL", "BYTE", "WORD", "DWORD", "LWORD"]);
    assert_eq!(members(Class::Signed), ["SINT", "INT", "DINT", "LINT"]);
    assert_eq!(members(Class::Unsigned), ["USINT", "UINT", "UDINT", "ULINT"]);
    assert_eq!(members(Class::Int), [members(Class::Signed), members(Class::Unsigned)].concat());
    assert_eq!(members(Class::Num), [members(Class::Int), vec!["REAL", "LREAL"]].concat());
    assert_eq!(members(Class::Magnitude), [members(Class::Num), vec!["TIME", "LTIME"]].concat());
    assert_eq!(members(Class::Char), ["CHAR", "WCHAR"]);
    assert_eq!(members(Class::Chars), members(Class::Char), "strings are not scalars");
    assert_eq!(members(Class::Elementary).len() + 1, Elementary::ALL.len());
    assert!(Class::ALL.iter().all(|it| Class::Any.contains(*it) && it.name().starts_with("ANY")));
    assert!(Class::Chars.contains(Class::String) && !Class::String.contains(Class::Chars));
}

#[test]
fn a_pin_has_the_type_that_its_vendor_documents() {
    let pin = |family: Family, block: &str, name: &str| {
        let block = BLOCKS.iter().find(|it| it.family == family && it.name == block).expect("a block");
        block.pin(name).expect("a pin").ty.name()
    };
    assert_eq!(pin(Family::Iec, "CTU", "PV"), "INT");
    assert_eq!(pin(Family::Iec, "CTUD_ULINT", "CV"), "ULINT");
    assert_eq!(pin(Family::Iec, "TON", "PT"), "TIME");
    assert_eq!(pin(Family::Iec, "LTON", "ET"), "LTIME");
    assert_eq!(pin(Family::Codesys, "CTU", "PV"), "WORD");
    assert_eq!(pin(Family::Codesys, "LCTUD", "CV"), "LWORD");
    assert_eq!(pin(Family::Codesys, "LCTU_STOP_AT_PV", "PV"), "LWORD");
    assert_eq!(pin(Family::Logix, "COUNTER", "PRE"), "DINT");
    assert_eq!(pin(Family::Logix, "COUNTER", "DN"), "BOOL");
}
