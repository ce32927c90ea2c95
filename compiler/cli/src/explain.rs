use crate::{args, output};
use staunch_frontend::{Code, Severity};

/// Prints the long text of a diagnostic.
pub fn explain(args: &args::Explain) -> Result<u8, String> {
    let code = Code::named(&args.code).ok_or_else(|| {
        let first = args.code.chars().next().map_or('E', |it| it.to_ascii_uppercase());
        let near = Code::ALL.iter().map(|it| it.name()).filter(|it| it.starts_with(first));
        format!("there is no diagnostic `{}`; there are {}", args.code, near.collect::<Vec<_>>().join(", "))
    })?;
    let kind = match code.severity() {
        Severity::Error => "error",
        Severity::Warning => "lint",
    };
    output::print(format!("{} ({kind}): {}\n\n{}", code.name(), code.title(), code.explanation()).as_bytes())?;
    Ok(0)
}
