//! A line as its words, values and signs.

/// A line without its remark: `T#5s` is a value.
pub fn uncommented(line: &str) -> &str {
    let is_remark = |at: &usize| !line[..*at].ends_with(|it: char| it.is_alphanumeric());
    let remark = line.match_indices('#').map(|it| it.0).find(is_remark);
    line[..remark.unwrap_or(line.len())].trim()
}

/// Names as `s[3].part`, values as `-5`, `0.5`, `T#1m30s` and `Mode#Auto` are one token each, and so are `..` and each
/// operator.
pub fn tokens(line: &str) -> Result<Vec<String>, String> {
    let mut found: Vec<String> = Vec::new();
    let mut rest = line.trim_start();
    while let Some(first) = rest.chars().next() {
        let operator = ["..", "<=", ">=", "<>", "<", ">", "=", "(", ")"].iter().find(|it| rest.starts_with(**it));
        let length = if let Some(it) = operator {
            it.len()
        } else if matches!(first, '\'' | '"') {
            rest[1..]
                .find(first)
                .map(|it| it + 2)
                .ok_or_else(|| format!("a {first} that closes the text is missing"))?
        } else if first.is_alphanumeric() || matches!(first, '_' | '%' | '-') {
            word(rest)
        } else {
            return Err(format!("`{first}` is not expected"));
        };
        found.push(rest[..length].to_owned());
        rest = rest[length..].trim_start();
    }
    Ok(found)
}

/// The bytes of the name or value that a text begins with: it ends before `..`.
fn word(text: &str) -> usize {
    let is_number = text.starts_with(|it: char| it.is_ascii_digit() || it == '-');
    let mut is_typed = false;
    let mut before = ' ';
    for (at, it) in text.char_indices() {
        is_typed |= it == '#';
        let belongs = it.is_alphanumeric()
            || matches!(it, '_' | '%' | '#')
            || it == '.' && !text[at..].starts_with("..")
            || matches!(it, '[' | ']' | ',') && !is_number
            // `-5`, `1e-3`, `T#-5s`, `DT#2024-01-31-12:30:00`
            || it == '-' && (at == 0 || is_typed || is_number && matches!(before, 'e' | 'E'))
            || it == ':' && is_typed;
        if !belongs {
            return at;
        }
        before = it;
    }
    text.len()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_remark_is_no_value() {
        assert_eq!(uncommented(" Wait T#1s..T#5s  # the panel's"), "Wait T#1s..T#5s");
        assert_eq!(uncommented("# all"), "");
        assert_eq!(uncommented("Start # T#5s"), "Start");
    }

    #[test]
    fn values_are_one_token() {
        let line = "a T#-1m30s..T#2.5s DT#2024-01-31-12:30:00 Mode#Auto 16#FF -5..1e-3 s[1,2].x";
        let found =
            ["a", "T#-1m30s", "..", "T#2.5s", "DT#2024-01-31-12:30:00", "Mode#Auto", "16#FF", "-5", "..", "1e-3"];
        let expected: Vec<_> = found.into_iter().chain(["s[1,2].x"]).collect();
        assert_eq!(tokens(line).unwrap(), expected);
    }
}
