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
    let mut text = String::from(
        "E is an error, and W a lint; set lints with -W, -D or -A CODE, in staunch.toml, or with {allow CODE}.\n",
    );
    for (digits, subject) in SUBJECTS {
        text += &format!("\n{subject}\n");
        for code in Code::ALL.iter().filter(|it| it.name()[1..].starts_with(digits)) {
            text += &format!("  {}  {}\n", code.name(), code.title());
        }
    }
    text
}

fn one(asked: &str) -> Result<u8, String> {
    let code = Code::named(asked).ok_or_else(|| match Code::meant(asked) {
        Some(meant) => format!("there is no diagnostic `{asked}`; did you mean `{}`?", meant.name()),
        None => format!(
            "there is no diagnostic `{asked}`; a code is E for an error or W for a lint, and four digits, such as E0101; \
             `staunch explain` lists them"
        ),
    })?;
    let kind = match code.severity() {
        Severity::Error => "error",
        Severity::Warning => "lint",
    };
    output::print(format!("{} ({kind}): {}\n\n{}", code.name(), code.title(), code.page()).as_bytes())?;
    Ok(0)
}
