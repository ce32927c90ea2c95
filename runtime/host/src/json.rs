//! Texts as JSON writes them.

use staunch_runtime::json::Quoted;

/// `text` in quotes.
pub fn quote(text: &str) -> String {
    Quoted(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_reads_back() {
        assert_eq!(quote("a\"\\\n\t\u{1}</ä€"), "\"a\\\"\\\\\\n\\t\\u0001\\u003c/ä€\"");
    }
}
