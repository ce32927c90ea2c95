//! The grammar of rungs, and the table of instructions.

use super::parse::{self, Element, Path};
use super::rows::{ANY, Does, ROWS};

fn shape(text: &str, path: &Path) -> String {
    let one = |it: &Element| match it {
        Element::Instruction(it) => {
            let operands: Vec<_> = it.operands.iter().map(|it| &text[it.clone()]).collect();
            format!("{}<{}>", &text[it.name.clone()], operands.join("|"))
        }
        Element::Branch(it) => {
            let paths: Vec<_> = it.paths.iter().map(|it| shape(text, it)).collect();
            format!("[{}]", paths.join(" / "))
        }
    };
    path.iter().map(one).collect::<Vec<_>>().join(" ")
}

#[test]
fn rungs_are_instructions_and_branches() {
    for (text, expected) in [
        (";", ""),
        ("XIC(a)OTE(b);", "XIC<a> OTE<b>"),
        (
            " XIC ( a ) [ XIO(b) , [XIC(c) ,XIC(d) ]ONS(e) , ] OTE(f) ; ",
            "XIC<a> [XIO<b> / [XIC<c> / XIC<d>] ONS<e> / ] OTE<f>",
        ),
        ("TON(t[i,2].x,?,?)NOP();", "TON<t[i,2].x|?|?> NOP<>"),
        ("CPT(d,(a+b)*MAX(c,1))MOVE('a)$',;',s);", "CPT<d|(a+b)*MAX(c,1)> MOVE<'a)$',;'|s>"),
        ("XIC()OTE(,);", "XIC<> OTE<|>"),
    ] {
        let found = parse::rung(text).map(|it| shape(text, &it));
        assert_eq!(found.as_deref(), Ok(expected), "{text}");
    }
}

#[test]
fn what_is_no_rung_is_reported_at_its_place() {
    for (text, place, message) in [
        ("", 0..0, "`;` is missing at the end of the rung"),
        ("XIC(a)", 5..6, "`;` is missing at the end of the rung"),
        ("XIC(a)OTE(b;", 6..9, "`)` is missing after the operands of `OTE`"),
        ("XIC(a)OTE(b", 6..9, "`)` is missing after the operands of `OTE`"),
        ("XIC(a)OTE('b;", 6..9, "`)` is missing after the operands of `OTE`"),
        ("XIC(a)[OTE(b);", 6..7, "this branch is not closed: `]` is missing"),
        ("XIC(a)]OTE(b);", 6..7, "an instruction or a branch was expected, found `]`"),
        ("XIC(a)ü;", 6..8, "an instruction or a branch was expected, found `ü`"),
        ("XIC(a),OTE(b);", 6..7, "an instruction or a branch was expected, found `,`"),
        ("XIC(a)OTE b;", 6..9, "`OTE` is not an instruction: its operands in parentheses are missing"),
        ("XIC(a)OTE(b);NOP();", 13..14, "something follows the `;` that ends the rung"),
    ] {
        let found = parse::rung(text).map_err(|it| (it.place, it.message));
        assert_eq!(found, Err((place, message.to_owned())), "{text}");
    }
    let deep = format!("{}XIC(a){};", "[".repeat(65), "]".repeat(65));
    assert!(parse::rung(&deep).is_err_and(|it| it.message == "branches are nested too deep"));
}

#[test]
fn statements_of_the_table_use_each_operand_that_is_no_more_than_shown() {
    for row in ROWS {
        let (Does::Tests(text)
        | Does::Compares(text)
        | Does::Always(text)
        | Does::WhereTrue(text)
        | Does::Computes(text)
        | Does::Gives(text)) = row.does
        else {
            continue;
        };
        assert_ne!(row.operands, ANY, "{:?}", row.names);
        for (at, operand) in row.operands.iter().enumerate() {
            let is_shown = ["Preset", "Accum"].contains(operand);
            assert_eq!(text.contains(&format!("{{{at}}}")), !is_shown, "{:?} {operand}", row.names);
        }
        assert_eq!(text.contains("{rung}"), matches!(row.does, Does::Always(_) | Does::Gives(_)), "{:?}", row.names);
    }
    let names: Vec<_> = ROWS.iter().flat_map(|it| it.names).collect();
    let mut unique = names.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), names.len());
}
