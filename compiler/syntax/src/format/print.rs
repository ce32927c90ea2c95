//! The text of all lines.

use super::columns::Line;
use super::style::{Indent, Style};

/// All lines.
pub fn print(lines: &[Line], style: &Style) -> String {
    let mut text = String::new();
    for (at, line) in lines.iter().enumerate() {
        if at > 0 {
            text.push('\n');
        }
        if line.blank_before && at > 0 {
            text.push('\n');
        }
        for _ in 0..line.level {
            match style.indent {
                Indent::Tab => text.push('\t'),
                Indent::Spaces(count) => text.extend(core::iter::repeat_n(' ', count.into())),
            }
        }
        text += &line.text();
    }
    text
}
