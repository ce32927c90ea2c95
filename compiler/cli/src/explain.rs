//! `staunch explain`: the long text of a diagnostic, and the list of all.

use crate::{args, output};
use staunch_frontend::{Code, Severity};

/// What the first two digits of a code say.
const SUBJECTS: [(&str, &str); 8] = [
    ("00", "Text and syntax"),
    ("01", "Names"),
    ("02", "Types and values"),
    ("03", "Calls and blocks"),
    ("04", "Declarations"),
    ("05", "Statements"),
    ("06", "What changes between systems"),
    ("09", "Limits, and what is not supported"),
];

/// Prints the long text of a diagnostic, or the list of all.
pub fn explain(args: &args::Explain) -> Result<u8, String> {
    match &args.code {
        Some(code) => one(code),
        None => output::print(list().as_bytes()).map(|()| 0),
    }
}

fn list() -> String {
    let mut text =
        String::from("E is an error, W a lint, which -W, -D and -A CODE, staunch.toml and {allow CODE} set.\n");
    for (digits, subject) in SUBJECTS {
        text += &format!("\n{subject}\n");
        for code in Code::ALL.iter().filter(|it| it.name()[1..].starts_with(digits)) {
            text += &format!("  {}  {}\n", code.name(), code.title());
        }
    }
    text
}

fn one(asked: &str) -> Result<u8, String> {
    let code = Code::named(asked).ok_or_else(|| {
        let near = nearest(asked).iter().map(|it| format!("`{it}`")).collect::<Vec<_>>();
        let help = if near.is_empty() {
            "a code is E for an error or W for a lint, and four digits: `E0101`".to_owned()
        } else {
            format!("did you mean {}?", near.join(" or "))
        };
        format!("there is no diagnostic `{}`; {help}", asked)
    })?;
    let kind = match code.severity() {
        Severity::Error => "error",
        Severity::Warning => "lint",
    };
    output::print(format!("{} ({kind}): {}\n\n{}", code.name(), code.title(), code.page()).as_bytes())?;
    Ok(0)
}

/// The codes that share most digits with `wrong`, of those with its first letter.
fn nearest(wrong: &str) -> Vec<&'static str> {
    let wrong = wrong.to_ascii_uppercase();
    let shared = |code: &str| code.bytes().zip(wrong.bytes()).filter(|(a, b)| a == b).count();
    let mut codes: Vec<_> =
        Code::ALL.iter().map(|it| it.name()).filter(|it| it.bytes().next() == wrong.bytes().next()).collect();
    codes.sort_by_key(|it| std::cmp::Reverse(shared(it)));
    codes.truncate(3);
    codes
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_wrong_code_has_neighbours() {
        assert_eq!(nearest("e0102x")[0], "E0102");
        assert_eq!(nearest("W0599").len(), 3);
        assert!(nearest("Z9").is_empty());
    }
}
