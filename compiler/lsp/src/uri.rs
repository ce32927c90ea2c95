//! Files by their URIs (RFC 8089).

use gen_lsp_types::Uri;
use std::path::{Path, PathBuf};

const SCHEME: &str = "file://";

/// The file that a URI names; nothing for other schemes.
pub fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.as_ref().strip_prefix(SCHEME)?;
    // A host's name may be there, and may be empty.
    let path = &rest[rest.find('/')?..];
    let text = decoded(path)?;
    // `/C:/Users`
    let bytes = text.as_bytes();
    let is_drive = bytes.len() > 2 && bytes[1].is_ascii_alphabetic() && bytes[2] == b':';
    Some(PathBuf::from(if is_drive { &text[1..] } else { text.as_str() }))
}

pub fn of(path: &Path) -> Uri {
    let text = path.to_string_lossy().replace('\\', "/");
    let lead = if text.starts_with('/') { "" } else { "/" };
    Uri(format!("{SCHEME}{lead}{}", encoded(&text)))
}

fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        match (first, after) {
            (b'%', [high, low, after @ ..]) => {
                let digit = |it: &u8| char::from(*it).to_digit(16).and_then(|it| u8::try_from(it).ok());
                bytes.push(16 * digit(high)? + digit(low)?);
                rest = after;
            }
            (byte, after) => {
                bytes.push(*byte);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

fn encoded(text: &str) -> String {
    let mut encoded = String::with_capacity(text.len());
    for byte in text.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                encoded.push(char::from(byte));
            }
            _ => encoded.push_str(&format!("%{byte:02X}")),
        }
    }
    encoded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_come_back_from_their_uris() {
        for text in ["/a/b.st", "/a b/ü%20#?.st", "/c/x+y@z.st"] {
            assert_eq!(path(&of(Path::new(text))), Some(PathBuf::from(text)));
        }
        assert_eq!(path(&Uri::from("file:///c%3A/plc/main.st")), Some(PathBuf::from("c:/plc/main.st")));
        assert_eq!(path(&Uri::from("untitled:Untitled-1")), None);
    }
}
