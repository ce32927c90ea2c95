//! Adds an object to a static library, without a tool: GNU `ar` asks compiler plugins about the
//! bitcode in Rust's objects, and loses their symbols where it does not understand it.

const MAGIC: &[u8] = b"!<arch>\n";
const HEADER: usize = 60;

/// The archive `library` with `object` as its last member, which defines `symbols`. `None` if the
/// archive is none in GNU's form with an index of 32 bits.
pub fn with_object(library: &[u8], name: &str, object: &[u8], symbols: &[&str]) -> Option<Vec<u8>> {
    let index = library.strip_prefix(MAGIC)?;
    let header = index.get(..HEADER)?;
    if !header.starts_with(b"/ ") {
        return None;
    }
    let length: usize = std::str::from_utf8(header.get(48..58)?).ok()?.trim().parse().ok()?;
    let body = index.get(HEADER..HEADER + length)?;
    let members = index.get(HEADER + length.next_multiple_of(2)..)?;
    let (count, rest) = body.split_first_chunk::<4>()?;
    let count = usize::try_from(u32::from_be_bytes(*count)).ok()?;
    let (offsets, names) = rest.split_at_checked(count.checked_mul(4)?)?;
    let names = &names[..=names.iter().rposition(|it| *it == 0).filter(|_| count > 0)?];

    let new_names: Vec<u8> = symbols.iter().flat_map(|it| it.bytes().chain([0])).collect();
    let new_length = 4 + 4 * (count + symbols.len()) + names.len() + new_names.len();
    let start = MAGIC.len() + HEADER + new_length.next_multiple_of(2);
    let moved_by = u32::try_from(start).ok()?.wrapping_sub(u32::try_from(library.len() - members.len()).ok()?);
    let place = u32::try_from(start + members.len().next_multiple_of(2)).ok()?;

    let mut out = Vec::with_capacity(start + members.len() + object.len() + 2 * HEADER);
    out.extend(MAGIC);
    out.extend(member_header("/", new_length).bytes());
    out.extend(u32::try_from(count + symbols.len()).ok()?.to_be_bytes());
    for offset in offsets.as_chunks::<4>().0 {
        out.extend(u32::from_be_bytes(*offset).wrapping_add(moved_by).to_be_bytes());
    }
    symbols.iter().for_each(|_| out.extend(place.to_be_bytes()));
    out.extend(names);
    out.extend(new_names);
    pad(&mut out);
    out.extend(members);
    pad(&mut out);
    out.extend(member_header(&format!("{name}/"), object.len()).bytes());
    out.extend(object);
    pad(&mut out);
    Some(out)
}

/// Times and owners are 0, so that equal programs make equal libraries.
fn member_header(name: &str, length: usize) -> String {
    format!("{name:<16}{:<12}{:<6}{:<6}{:<8}{length:<10}`\n", 0, 0, 0, 644)
}

/// Members start at even offsets.
fn pad(out: &mut Vec<u8>) {
    if !out.len().is_multiple_of(2) {
        out.push(b'\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A library of one member `a.o`, which defines `one`.
    fn library() -> Vec<u8> {
        let index_length = 4 + 4 + 4;
        let place = u32::try_from(MAGIC.len() + HEADER + index_length).expect("small");
        let mut library = MAGIC.to_vec();
        library.extend(member_header("/", index_length).bytes());
        library.extend(1_u32.to_be_bytes());
        library.extend(place.to_be_bytes());
        library.extend(b"one\0");
        library.extend(member_header("a.o/", 3).bytes());
        library.extend(b"abc\n");
        library
    }

    /// The symbols, with the names of the members that the index leads to.
    fn index(library: &[u8]) -> Vec<(String, String)> {
        let body = &library[MAGIC.len() + HEADER..];
        let word = |at: usize| u32::from_be_bytes(body[at..at + 4].try_into().expect("four bytes"));
        let number = |at: usize| usize::try_from(word(at)).expect("small");
        let count = number(0);
        let names = body[4 + 4 * count..].split(|it| *it == 0).take(count);
        let member = |at: usize| String::from_utf8_lossy(&library[at..at + 16]).trim().to_owned();
        names
            .enumerate()
            .map(|(at, name)| (String::from_utf8_lossy(name).into_owned(), member(number(4 + 4 * at))))
            .collect()
    }

    #[test]
    fn the_index_leads_to_every_member() {
        for symbols in [&["two"][..], &["two", "three", "x"]] {
            let with = with_object(&library(), "b.o", b"defgh", symbols).expect("an archive");
            let mut expected = vec![("one".to_owned(), "a.o/".to_owned())];
            expected.extend(symbols.iter().map(|it| ((*it).to_owned(), "b.o/".to_owned())));
            assert_eq!(index(&with), expected);
            assert!(with.ends_with(b"defgh\n"));
            assert_eq!(with.len() % 2, 0);
        }
    }

    #[test]
    fn anything_else_is_refused() {
        assert_eq!(with_object(b"", "b.o", b"", &[]), None);
        assert_eq!(with_object(b"!<arch>\n", "b.o", b"", &[]), None);
        let cut = &library()[..70];
        assert_eq!(with_object(cut, "b.o", b"", &["x"]), None);
    }
}
