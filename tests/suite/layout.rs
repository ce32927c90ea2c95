//! What `staunch fmt` makes of every case: the same program, and the same text when it is laid out again.

use staunch_frontend::format::{self, Refusal, Style};
use staunch_frontend::{Source, Sources, compile};
use staunch_ir::print_without_places;
use staunch_tests::case::{self, Case};
use staunch_tests::cases;

/// Cases whose programs know the lines of their text.
const KNOW_LINES: [&str; 2] = ["codesys/pou_texts", "testing/fixture"];

#[test]
fn a_case_is_the_same_program_laid_out() {
    let (cases, _) = case::discover(&cases());
    let (mut same, mut wrong) = (0, Vec::new());
    for case in &cases {
        match is_same(case) {
            Some(Ok(())) => same += 1,
            Some(Err(_)) if KNOW_LINES.contains(&case.name.as_str()) => {}
            Some(Err(why)) => wrong.push(format!("{}: {why}", case.name)),
            None => {}
        }
    }
    assert!(wrong.is_empty(), "{} are others:\n{}", wrong.len(), wrong.join("\n"));
    assert!(same > 800, "{same}");
}

/// `None` where a case has no program.
fn is_same(case: &Case) -> Option<Result<(), String>> {
    let options = case.settings().options;
    let (sources, compilation) = case.compile();
    let (mut laid_out, mut others) = (Sources::default(), 0);
    for (source, path) in sources.files().iter().zip(&case.sources) {
        let bytes = match twice(&source.path, &std::fs::read(path).ok()?) {
            Ok(bytes) => bytes,
            Err(why) => return Some(Err(why)),
        };
        others += usize::from(bytes.is_none());
        let changed = Source::decode(source.path.clone(), &bytes.unwrap_or_default());
        laid_out.add(if source.is_of_library() { source.clone() } else { changed });
    }
    let program = compilation.program.filter(|_| others == 0)?;
    let Some(other) = compile(&laid_out, &options).program else { return Some(Err("it is rejected".to_owned())) };
    let (program, other) = (print_without_places(&program), print_without_places(&other));
    let differ = || program.lines().zip(other.lines()).find(|(a, b)| a != b);
    Some(if program == other { Ok(()) } else { Err(format!("{:?}", differ())) })
}

/// A file laid out; `None` for another editor's.
fn twice(path: &str, bytes: &[u8]) -> Result<Option<Vec<u8>>, String> {
    let style = Style::default();
    let once = match format::bytes(path, bytes, &style) {
        Ok(once) => once,
        Err(Refusal::Foreign | Refusal::Broken | Refusal::Encoding) => return Ok(None),
        Err(Refusal::Internal) => return Err("its tokens change".to_owned()),
    };
    match format::bytes(path, &once, &style).as_ref() == Ok(&once) {
        true => Ok(Some(once)),
        false => Err("it changes when it is laid out again".to_owned()),
    }
}

#[test]
fn a_text_with_mistakes_is_laid_out_too() {
    let (cases, _) = case::discover(&cases());
    let mut tried = 0;
    for (number, case) in cases.iter().enumerate() {
        let sources = case.sources();
        let text = &sources.files()[0].text;
        // A part is left out, another one for each case.
        for part in 0..4 {
            let cut = |of: usize| (0..=text.len() * of / 97).rev().find(|it| text.is_char_boundary(*it)).unwrap_or(0);
            let start = (number * 31 + part * 23) % 90;
            let broken = format!("{}{}", &text[..cut(start)], &text[cut(start + 1 + part)..]);
            let style = Style::default();
            let once = format::whole(&broken, &style);
            let once = once.unwrap_or_else(|| panic!("{}: the tokens of this change:\n{broken}", case.name));
            assert_eq!(format::whole(&once, &style).as_ref(), Some(&once), "{}: laid out again:\n{broken}", case.name);
            tried += 1;
        }
    }
    assert!(tried > 4000, "{tried}");
}
