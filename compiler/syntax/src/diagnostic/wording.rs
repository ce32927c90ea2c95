//! Words of messages: lists and articles.

/// `a`, `a or b`, `a, b or c`, each in backticks.
pub fn any_of(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [init @ .., last] => format!("{} or {last}", init.join(", ")),
    }
}

/// `a`, `a and b`, `a, b and c`: all of them.
pub fn all_of(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [init @ .., last] if !init.is_empty() => format!("{} and {last}", init.join(", ")),
        _ => any_of(names),
    }
}

/// `a word`, `an INT`, `an FBD_COUNTER`: an abbreviation without a vowel is read letter by letter.
pub fn article(word: &str) -> String {
    let first = word.split(|it: char| !it.is_ascii_alphanumeric()).next().unwrap_or_default();
    let spelled = matches!(first, "LREAL" | "LTIME" | "LWORD")
        || (!first.contains(|it: char| it.is_ascii_lowercase()) && !first.contains(['A', 'E', 'I', 'O', 'U']));
    let an = if spelled { word.starts_with(['F', 'H', 'L', 'M', 'N', 'R', 'S', 'X']) } else { starts_with_vowel(word) };
    format!("{} {word}", if an { "an" } else { "a" })
}

fn starts_with_vowel(word: &str) -> bool {
    word.starts_with(['a', 'e', 'i', 'o', 'A', 'E', 'I', 'O'])
}

#[cfg(test)]
mod tests {
    use super::article;

    #[test]
    fn articles_follow_the_sound() {
        for word in
            ["an INT", "a UINT", "an FBD_COUNTER", "a COUNTER", "an OF", "a DO", "an LREAL", "an R_TRIG", "a lamp"]
        {
            let (_, noun) = word.split_once(' ').expect("two words");
            assert_eq!(article(noun), word);
        }
    }
}
