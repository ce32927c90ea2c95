//! What the Rust back end printed for cases, vectors and operations, compiled into this crate.

use staunch_host::{Compiled, Init, Map, Scan};

mod modules {
    #![allow(
        missing_debug_implementations,
        unused_qualifications,
        clippy::empty_line_after_doc_comments,
        reason = "generated"
    )]

    use super::Entry;

    include!(concat!(env!("OUT_DIR"), "/generated.rs"));
}

/// The C entry points of one program.
pub(crate) struct Entry {
    name: &'static str,
    map: &'static [u8],
    map_len: usize,
    init: Init,
    scan: Scan,
}

/// The program that the Rust back end printed under this name; `None` where there is none with this
/// map.
pub(crate) fn machine(module: &str, map: &str) -> Option<Compiled> {
    let entry = modules::ENTRIES.iter().find(|it| it.name == module)?;
    let same = entry.map == map.as_bytes() && entry.map_len == map.len();
    let map = Map::parse(map).ok().filter(|_| same)?;
    // SAFETY: they are the entry points of the program whose map this is.
    Some(unsafe { Compiled::new(&map, entry.init, entry.scan) })
}
