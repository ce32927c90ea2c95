//! Files that are no Structured Text, known by what they hold: one diagnostic says what the file is and
//! what to do, in place of those that reading it as Structured Text gives.

use crate::diagnostic::{Code, Diagnostic};
use crate::source::{Source, Span};

/// What a file is, where that is seen, and what to do.
struct Kind {
    name: &'static str,
    at: usize,
    help: &'static str,
}

const EXPORT: &str = "export the program as text, and check that";

/// What a file that does not parse turns out to be.
pub fn recognise(file: u16, source: &Source) -> Option<Diagnostic> {
    let text = source.text.as_str();
    let kind = protected(&source.path, text)
        .or_else(|| binary(text))
        .or_else(|| xml(text))
        .or_else(|| json(text))
        .or_else(|| python(text))
        .or_else(|| logix(text))
        .or_else(|| rungs(text))
        .or_else(|| scl(text))
        .or_else(|| list(text))
        .or_else(|| statement_list(text))?;
    let line = text[kind.at..].lines().next().unwrap_or_default();
    let end = kind.at + line.trim_end().len();
    let offset = |it: usize| u32::try_from(it).unwrap_or(u32::MAX);
    let span = Span { file, start: offset(kind.at), end: offset(end) };
    // Of a binary file nothing can be shown.
    let span = if binary(text).is_some() { Span { end: span.start, ..span } } else { span };
    Some(Diagnostic::new(Code::E0032, span, format!("this is {}, not Structured Text", kind.name)).help(kind.help))
}

/// Files that no other program reads, since they are binary and have the name of a text, or of a project.
fn protected(path: &str, text: &str) -> Option<Kind> {
    const TWINCAT: [&str; 6] = ["tcpou", "tcgvl", "tcdut", "tcio", "tctleo", "tctto"];
    let extension = path.rsplit_once('.').map_or(String::new(), |it| it.1.to_ascii_lowercase());
    let of = |name, help| Some(Kind { name, at: 0, help });
    binary(text)?;
    match extension.as_str() {
        it if TWINCAT.contains(&it) => of(
            "an encrypted file of TwinCAT",
            "take the encryption off in the project's security settings, and save it",
        ),
        "project" => of("a project of CODESYS", "export it in CODESYS as PLCopen XML, and check that"),
        "library" | "compiled-library" | "compiled-library-v3" => of(
            "a library of CODESYS or TwinCAT",
            "name its sources, or declarations of what it holds, in `libraries` of staunch.toml",
        ),
        "acd" => of("a project of Logix Designer", "export it as L5X, and check that"),
        "scl" | "udt" | "db" => of(
            "a binary file",
            "generate a source from the blocks in TIA Portal, without know-how protection, and check that",
        ),
        it if it.starts_with("zap") || it.starts_with("ap1") || it.starts_with("ap2") => {
            of("a project of TIA Portal", "generate sources (.scl, .udt, .db) from its blocks, and check these")
        }
        _ => None,
    }
}

fn binary(text: &str) -> Option<Kind> {
    let name = match text {
        _ if text.starts_with("PK\u{3}\u{4}") => "an archive (zip), as project files of CODESYS and TwinCAT are",
        _ if text.starts_with("\u{7f}ELF") || text.starts_with("MZ") && has_nul(text) => "a binary program",
        _ if has_nul(text) => "a binary file, as the project files of CODESYS (.project), Logix (.ACD) and TIA are",
        _ => return None,
    };
    Some(Kind { name, at: 0, help: "export the program's text in its own system, and check that" })
}

fn has_nul(text: &str) -> bool {
    text.chars().take(4096).any(|it| it == '\0')
}

fn xml(text: &str) -> Option<Kind> {
    let start = text.len() - text.trim_start().len();
    let rest = text[start..].strip_prefix('<')?;
    rest.starts_with(|it: char| it == '?' || it == '!' || it.is_ascii_alphabetic()).then_some(())?;
    let (name, help) = match rest {
        _ if rest.contains("SW.Blocks.") => {
            ("XML of TIA Portal", "generate a source (.scl) from the block, and move that")
        }
        _ => ("XML", EXPORT),
    };
    Some(Kind { name, at: start, help })
}

/// Whether a text is JSON, also where the lexer takes all of it for a pragma.
pub fn is_json(source: &Source) -> bool {
    json(&source.text).is_some()
}

/// `{"a": …`, `[{ …`: no pragma begins with a text in quotes, and no Structured Text with a bracket.
fn json(text: &str) -> Option<Kind> {
    let start = text.len() - text.trim_start().len();
    let rest = &text[start..];
    let member = |it: &str| {
        let (name, after) = it.strip_prefix('"')?.split_once('"')?;
        (!name.contains('\n') && after.trim_start().starts_with(':')).then_some(())
    };
    let is_object = rest.strip_prefix('{').is_some_and(|it| member(it.trim_start()).is_some());
    let is_list = rest.strip_prefix('[').is_some_and(|it| it.trim_start().starts_with(['{', '"', '[']));
    (is_object || is_list).then_some(Kind {
        name: "JSON",
        at: start,
        help: "name the program's sources: `.st` files, or their folder",
    })
}

/// A file whose first line of code is one of Python's: `import x`, `def f(x):`, `class X:`.
fn python(text: &str) -> Option<Kind> {
    let is_code = |line: &str| !line.starts_with(['#', '"', '\'', '@']);
    let (at, line) = lines(text).find(|(_, line)| is_code(line))?;
    let ends_block = line.split(" #").next().is_some_and(|it| it.trim_end().ends_with(':'));
    let (word, rest) = line.split_once(' ')?;
    let (is_it, help) = match word {
        "def" | "async" => (
            ends_block && rest.contains('('),
            "write `FUNCTION Add : INT VAR_INPUT a, b : INT; END_VAR Add := a + b; END_FUNCTION`",
        ),
        "class" => (
            ends_block,
            "write `FUNCTION_BLOCK Motor VAR speed : INT; END_VAR METHOD Start … END_METHOD END_FUNCTION_BLOCK`",
        ),
        "import" => (!line.ends_with(';'), PYTHON),
        "from" => (rest.contains(" import "), PYTHON),
        _ => (false, PYTHON),
    };
    is_it.then_some(Kind { name: "Python", at, help })
}

const PYTHON: &str = "write `PROGRAM Main VAR x : INT; END_VAR x := x + 1; END_PROGRAM`";

/// Logix's neutral text: a version, and then a CONTROLLER.
fn logix(text: &str) -> Option<Kind> {
    let (at, _) = lines(text).find(|(_, line)| line.starts_with("IE_VER") || line.starts_with("CONTROLLER "))?;
    text.contains("END_CONTROLLER").then_some(Kind {
        name: "neutral text of Logix (L5K)",
        at,
        help: "export it as L5X, and check that",
    })
}

/// Rungs of Logix's ladder as text: `XIC(a)OTE(b);`, `N: XIC(a)OTE(b);`, `SOR XIC a OTE b EOR`.
fn rungs(text: &str) -> Option<Kind> {
    const CONTACTS: [&str; 2] = ["XIC", "XIO"];
    const COILS: [&str; 14] =
        ["OTE", "OTL", "OTU", "ONS", "OSR", "TON", "TOF", "RTO", "CTU", "CTD", "RES", "MOV", "JSR", "JMP"];
    let is_rung = |line: &str| {
        let mut words = line.split(|it: char| !it.is_alphanumeric() && it != '_');
        let names = |words: &[&str], word: &str| words.contains(&word);
        words.any(|it| names(&CONTACTS, it)) && words.any(|it| names(&COILS, it)) && !line.contains(":=")
    };
    let at = lines(text).find(|(_, line)| is_rung(line))?.0;
    Some(Kind {
        name: "neutral text of Logix (rungs of ladder)",
        at,
        help: "put them into a PROGRAM that declares their tags, one rung a line: `XIC(a)OTE(b);`",
    })
}

/// Siemens' language: quoted names of blocks, `#` before local names, REGION.
fn scl(text: &str) -> Option<Kind> {
    const HEADS: [&str; 6] =
        ["ORGANIZATION_BLOCK", "DATA_BLOCK", "FUNCTION_BLOCK \"", "FUNCTION \"", "TYPE \"", "{ S7_Optimized_Access"];
    let is_head = |line: &str| HEADS.iter().any(|it| line.starts_with(it));
    let head = lines(text).find(|(_, line)| is_head(line)).map(|it| it.0);
    let first = |sign: fn(&str) -> bool| lines(text).find(|(_, line)| sign(line)).map(|it| it.0);
    let signs = [first(has_local), first(has_block), first(|line| line == "REGION" || line.starts_with("REGION "))];
    let seen: Vec<usize> = signs.into_iter().flatten().collect();
    let has_locals = lines(text).filter(|(_, line)| has_local(line)).nth(1).is_some();
    let at = head.or_else(|| (seen.len() > 1 || has_locals).then(|| seen.iter().copied().min()).flatten())?;
    Some(Kind {
        name: "Siemens SCL",
        at,
        help: "write names without `#` and quotes, pass the contents of data blocks as variables, and delete REGION",
    })
}

/// `#x` where no number and no type is before it; C's `#include` is none.
fn has_local(line: &str) -> bool {
    let is_preprocessor = line.strip_prefix('#').is_some_and(crate::spelling::is_preprocessor);
    !is_preprocessor
        && line.match_indices('#').any(|(at, _)| {
            let before = line[..at].chars().next_back();
            let after = line[at + 1..].chars().next();
            !before.is_some_and(|it| it.is_alphanumeric() || it == '_') && after.is_some_and(char::is_alphabetic)
        })
}

/// `"DB".x`
fn has_block(line: &str) -> bool {
    line.match_indices("\".").any(|(at, _)| line[..at].contains('"'))
}

/// Instruction List: an operator and its operand on a line of their own. `LD x` is never Structured Text.
fn list(text: &str) -> Option<Kind> {
    let operators = lines(text).filter(|(_, line)| is_instruction(line, &["LD", "LDN", "ST", "STN"]));
    let mut found = operators.map(|it| it.0);
    let (at, second) = (found.next()?, found.next());
    let others = ["CAL", "CALC", "JMPC", "JMPCN", "RETC", "S", "R"];
    let more = || lines(text).any(|(_, line)| is_instruction(line, &others));
    (second.is_some() || more()).then_some(Kind {
        name: "Instruction List",
        at,
        help: "write what it does in Structured Text: `LD a`, `AND b`, `ST c` is `c := a AND b;`",
    })
}

/// Siemens' STL: an operation on bits of the image, `U E 0.0`, `= A 4.0`, or on what it holds, `L MW 10`.
fn statement_list(text: &str) -> Option<Kind> {
    let mut found = lines(text).filter(|(_, line)| is_statement_of_list(line)).map(|it| it.0);
    let at = found.next()?;
    found.next().map(|_| Kind {
        name: "Siemens Statement List (STL, AWL)",
        at,
        help: "write what it does in Structured Text: `U E 0.0`, `UN E 0.1`, `= A 4.0` is `a := e0 AND NOT e1;`",
    })
}

fn is_statement_of_list(line: &str) -> bool {
    const BITS: [&str; 13] = ["U", "UN", "O", "ON", "A", "AN", "X", "XN", "S", "R", "=", "FP", "FN"];
    const AREAS: [&str; 5] = ["E", "A", "I", "Q", "M"];
    let line = line.split("//").next().unwrap_or_default().trim().trim_end_matches(';');
    let words: Vec<&str> = without_label(line).split_whitespace().collect();
    let digits = |it: &str| !it.is_empty() && it.chars().all(|it| it.is_ascii_digit());
    let is_bit = |it: &str| it.split_once('.').is_some_and(|(byte, bit)| digits(byte) && bit.len() == 1 && digits(bit));
    let is_wide = |it: &str| ["B", "W", "D"].iter().any(|width| it.len() == 2 && it.ends_with(width));
    match words.as_slice() {
        [operation, area, bit] if BITS.contains(operation) => AREAS.contains(area) && is_bit(bit),
        [operation, place] if BITS.contains(operation) => {
            AREAS.iter().filter_map(|it| place.strip_prefix(it)).any(is_bit)
        }
        ["L" | "T", area, number] => is_wide(area) && digits(number),
        _ => false,
    }
}

/// What is after `again:`.
fn without_label(line: &str) -> &str {
    let (label, rest) = match line.split_once(':') {
        Some((label, rest)) if !rest.starts_with('=') => (label.trim(), rest.trim_start()),
        _ => return line,
    };
    if label.chars().all(|it| it.is_alphanumeric() || it == '_') { rest } else { line }
}

fn is_instruction(line: &str, operators: &[&str]) -> bool {
    let line = without_label(line);
    let line = line.split("(*").next().unwrap_or_default().split("//").next().unwrap_or_default();
    let mut words = line.split_whitespace();
    let operator = words.next().is_some_and(|it| operators.iter().any(|of| of.eq_ignore_ascii_case(it)));
    let operand = words.next().is_some_and(|it| it.starts_with(|it: char| it.is_alphanumeric() || "%_#".contains(it)));
    operator && operand && !line.trim_end().ends_with(';')
}

/// The lines with something on them, each where it begins.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut start = 0;
    let place = move |line: &str| {
        let at = start + line.len() - line.trim_start().len();
        start += line.len();
        at
    };
    text.split_inclusive('\n').scan(place, |place, line| Some((place(line), line.trim()))).filter(|it| !it.1.is_empty())
}
