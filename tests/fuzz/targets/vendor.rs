//! Files of other systems, after a byte that picks which.
#![no_main]

use staunch_frontend::{Dialect, Source};

const FILES: [(&str, Dialect); 14] = [
    ("Main.TcPOU", Dialect::Codesys),
    ("List.TcGVL", Dialect::Codesys),
    ("Type.TcDUT", Dialect::Codesys),
    ("Face.TcIO", Dialect::Codesys),
    ("Main.TcTTO", Dialect::Codesys),
    ("Plc.plcproj", Dialect::Codesys),
    ("project.xml", Dialect::Codesys),
    ("project.L5X", Dialect::Logix),
    ("block.scl", Dialect::Siemens),
    ("type.udt", Dialect::Siemens),
    ("data.db", Dialect::Siemens),
    ("project.json", Dialect::Openplc4),
    ("Package.var", Dialect::Codesys),
    ("Library.fun", Dialect::Codesys),
];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Some((first, rest)) = bytes.split_first() {
        let (name, dialect) = FILES[usize::from(*first) % FILES.len()];
        let _ = (Source::listed(rest), Source::references(rest), Source::definitions(rest), Source::project_name(rest));
        staunch_fuzz::held(name, rest, dialect);
    }
});
