//! The export of CoDeSys 2 and TwinCAT 2, `.EXP`: Structured Text as it is, with what those systems note in comments;
//! between it are sections of other kinds, and bodies in other languages.

use super::assembly::{Assembly, Chunk, Trouble};
use core::ops::Range;

/// Sections that declare nothing, and how each ends.
const SECTIONS: [(&str, &str); 8] = [
    ("LIBRARY", "END_LIBRARY"),
    ("VISUALISATION", "END_VISUALISATION"),
    ("PLC_CONFIGURATION", "PLC_END"),
    ("PLC_CONFIG", "PLC_END"),
    ("RESOURCE", "END_RESOURCE"),
    ("TASKCONFIG", "END_TASKCONFIG"),
    ("_ALARMCONFIG", "_END_ALARMCONFIG"),
    ("_WORKSPACE", "_END_WORKSPACE"),
];

/// What begins a body in another language.
const BODIES: [(&str, &str); 5] = [
    ("_LD_BODY", "a ladder diagram (LD)"),
    ("_FBD_BODY", "a function block diagram (FBD)"),
    ("_CFC_BODY", "a continuous function chart (CFC)"),
    ("_SFC_BODY", "a sequential function chart (SFC)"),
    ("_IL_BODY", "Instruction List (IL)"),
];

/// The operators of Instruction List.
const OPERATORS: [&str; 33] = [
    "LD", "LDN", "ST", "STN", "S", "R", "AND", "ANDN", "OR", "ORN", "XOR", "XORN", "NOT", "ADD", "SUB", "MUL", "DIV",
    "MOD", "GT", "GE", "EQ", "NE", "LE", "LT", "JMP", "JMPC", "JMPCN", "CAL", "CALC", "CALCN", "RET", "RETC", "RETCN",
];

const ENDS: [&str; 5] = ["END_PROGRAM", "END_FUNCTION_BLOCK", "END_FUNCTION", "END_ACTION", "END_TRANSITION"];

/// Whether a text begins as an export does.
pub fn is_export(text: &str) -> bool {
    let first = text.trim_start().strip_prefix("(*").map(str::trim_start);
    let begins = text.trim_start().split_inclusive('\n').next().unwrap_or_default();
    let is_section = SECTIONS.iter().any(|it| it.0 == begins.trim_end());
    is_section || first.is_some_and(|it| it.starts_with("@NESTEDCOMMENTS") || it.starts_with("@PATH"))
}

pub fn read(text: &str) -> Assembly {
    let mut out = Assembly::default();
    out.write("{dialect 'codesys'}\n", &(0..0));
    // How what is passed over ends, and the text that is not yet taken.
    let mut until: Option<&[&str]> = None;
    let mut from = 0;
    let mut at = 0;
    let mut comments = 0;
    let mut is_first = false;
    for line in text.split_inclusive('\n') {
        let (place, word) = (at..at + line.trim_end().len(), first_word(line));
        at += line.len();
        let in_comment = comments > 0;
        if until.is_none() {
            comments = open_comments(line, comments);
        }
        if in_comment {
            continue;
        }
        if let Some(ends) = until {
            if ends.contains(&word) {
                until = None;
                // The end of a section is a part of it, the end of a body is one of its POU.
                from = if ENDS.contains(&word) { place.start } else { at };
            }
        } else if let Some((_, end)) =
            SECTIONS.iter().find(|it| it.0 == word).filter(|_| is_alone(line) || is_picture(line))
        {
            take(&mut out, text, from..place.start);
            until = Some(core::slice::from_ref(end));
        } else if let Some((_, language)) = BODIES.iter().find(|it| it.0 == word) {
            take(&mut out, text, from..place.start);
            out.problem(Trouble::OtherLanguage, format!("this body is {language}, not Structured Text"), &place);
            until = Some(&ENDS);
        } else if is_first && is_instruction(line) {
            // Its bodies begin with no word of their own.
            take(&mut out, text, from..place.start);
            let message = "this body is Instruction List (IL), which is not compiled".to_owned();
            out.problem(Trouble::OtherLanguage, message, &place);
            until = Some(&ENDS);
        } else if is_joined_head(line) {
            let start = place.start + (line.len() - line.trim_start().len());
            let keyword = start..start + word.len();
            take(&mut out, text, from..start);
            from = keyword.end;
            out.copy(text, &[Chunk::words("FUNCTION_BLOCK", &keyword)]);
        }
        is_first = line.contains("@END_DECLARATION") || is_first && word.is_empty();
    }
    if until.is_none() {
        take(&mut out, text, from..text.len());
    }
    out
}

fn take(out: &mut Assembly, text: &str, range: Range<usize>) {
    out.copy(text, &[Chunk::verbatim(range)]);
}

/// `VISUALISATION Tank _VISU_TYPES : 1,1`
fn is_picture(line: &str) -> bool {
    first_word(line) == "VISUALISATION" && line.contains("_VISU_TYPES")
}

/// How many comments are open after a line, where so many are before it.
fn open_comments(line: &str, before: usize) -> usize {
    let mut open = before;
    let mut in_text = false;
    let mut bytes = line.bytes().peekable();
    while let Some(byte) = bytes.next() {
        match (byte, bytes.peek()) {
            (b'\'', _) if open == 0 => in_text = !in_text,
            (b'$', Some(b'\'')) if in_text => drop(bytes.next()),
            (b'(', Some(b'*')) if !in_text => {
                open += 1;
                bytes.next();
            }
            (b'*', Some(b')')) if !in_text && open > 0 => {
                open -= 1;
                bytes.next();
            }
            _ => {}
        }
    }
    open
}

/// Whether the line is the head `FUNCTIONBLOCK Name`, as CoDeSys 2 keeps it where somebody has written it so.
fn is_joined_head(line: &str) -> bool {
    let name = line.trim().split_once(char::is_whitespace).filter(|it| it.0.eq_ignore_ascii_case("FUNCTIONBLOCK"));
    name.is_some_and(|it| it.1.trim_start().starts_with(|it: char| it.is_ascii_alphabetic() || it == '_'))
}

/// Whether an instruction is on the line, `LD a` or `next: JMPC back`, and no statement.
fn is_instruction(line: &str) -> bool {
    let line = line.split("(*").next().unwrap_or_default();
    let after_label = line.split_once(':').filter(|it| !it.1.starts_with('='));
    let line = after_label.map_or(line, |it| it.1).trim();
    let (word, operand) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let is_operand = |it: char| it.is_ascii_alphanumeric() || "_%'#-".contains(it);
    let takes_none = operand.is_empty() && word.to_ascii_uppercase().starts_with("RET");
    let has_one = operand.trim_start().starts_with(is_operand) && !line.ends_with(';');
    OPERATORS.iter().any(|it| it.eq_ignore_ascii_case(word)) && (takes_none || has_one)
}

fn first_word(line: &str) -> &str {
    line.trim_start().split(|it: char| !it.is_ascii_alphanumeric() && it != '_').next().unwrap_or_default()
}

/// Whether nothing but a name or a number follows the word, as no statement has it.
fn is_alone(line: &str) -> bool {
    line.trim().bytes().all(|it| it.is_ascii_alphanumeric() || it == b'_' || it == b' ')
}
