//! `[fmt]` of a project file: how `staunch fmt` lays out.

use super::{choice, flag, nearest, number};
use staunch_frontend::format::{Indent, Letters, Style};

const KEYS: [&str; 4] = ["indent", "width", "keywords", "indent-pous"];

/// The allowed line widths.
const WIDTHS: core::ops::RangeInclusive<u64> = 40..=400;

pub fn read(value: &toml::Value) -> Result<Style, String> {
    let table = value.as_table().ok_or("`fmt` must be a table: write `[fmt]`, and its settings below it")?;
    let mut style = Style::default();
    for (key, value) in table {
        match key.as_str() {
            "indent" => style.indent = indent(value)?,
            "width" => {
                let width = number(key, value)?;
                if !WIDTHS.contains(&width) {
                    return Err(format!("`width` is {width}: expected {} to {} columns", WIDTHS.start(), WIDTHS.end()));
                }
                style.width = usize::try_from(width).map_err(|it| it.to_string())?;
            }
            "keywords" => {
                style.keywords = match choice(key, value, &["upper", "lower", "as-written"])?.as_str() {
                    "lower" => Letters::Lower,
                    "as-written" => Letters::AsWritten,
                    _ => Letters::Upper,
                };
            }
            "indent-pous" => style.indents_pous = flag(key, value)?,
            _ => {
                return Err(match nearest(key, KEYS.into_iter()) {
                    Some(near) => format!("`[fmt]` has no setting `{key}`; did you mean `{near}`?"),
                    None => format!("`[fmt]` has no setting `{key}`; its settings are {}", KEYS.join(", ")),
                });
            }
        }
    }
    Ok(style)
}

fn indent(value: &toml::Value) -> Result<Indent, String> {
    let count = value.as_integer().and_then(|it| u8::try_from(it).ok()).filter(|it| (1..=16).contains(it));
    match (count, value.as_str()) {
        (Some(count), _) => Ok(Indent::Spaces(count)),
        (None, Some("tab")) => Ok(Indent::Tab),
        _ => Err("`indent` must be a number of spaces, 1 to 16, or \"tab\"".to_owned()),
    }
}
