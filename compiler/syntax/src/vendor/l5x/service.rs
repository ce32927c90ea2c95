//! Instructions that ask the controller, its modules or its axes for something: a program that runs without one has
//! nothing that could answer.

use rustc_hash::FxHashMap;
use std::sync::LazyLock;

/// What an instruction is about, where it is one of these.
pub fn controller_service(name: &str) -> Option<&'static str> {
    BY_NAME.get(&packed(name)?).copied()
}

/// Every call of a program is looked up here.
static BY_NAME: LazyLock<FxHashMap<[u8; LONGEST], &'static str>> = LazyLock::new(|| {
    let each = SERVICES.iter().flat_map(|(what, names)| names.iter().map(move |it| (packed(it), *what)));
    each.filter_map(|(name, what)| Some((name?, what))).collect()
});

const LONGEST: usize = 8;

/// A short name in upper case.
fn packed(name: &str) -> Option<[u8; LONGEST]> {
    let mut packed = [0; LONGEST];
    let letters = packed.get_mut(..name.len())?;
    letters.copy_from_slice(name.as_bytes());
    letters.make_ascii_uppercase();
    Some(packed)
}

const SERVICES: &[(&str, &[&str])] = &[
    ("it reads an object of the controller", &["GSV"]),
    ("it sets an object of the controller", &["SSV"]),
    ("it sends a message to another device", &["MSG"]),
    ("it writes to a module before the scan ends", &["IOT"]),
    ("it starts a task of the controller", &["EVENT"]),
    ("it works on alarms of the controller", &["ALMA", "ALMD"]),
    ("it works on an equipment phase", &["PSC", "PCMD", "POVR", "PFL", "PCLF", "PXRQ", "PRNP", "PPD", "PATT", "PDET"]),
    (
        "it works on an axis",
        &[
            "MSO", "MSF", "MASD", "MASR", "MDO", "MDF", "MAFR", "MAS", "MAH", "MAJ", "MAM", "MAG", "MCD", "MRP",
            "MCCP", "MAPC", "MATC", "MDAC", "MGS", "MGSD", "MGSR", "MGSP", "MAW", "MDW", "MAR", "MDR", "MAOC", "MDOC",
            "MCLM", "MCCM", "MCCD", "MCS", "MCSD", "MCSR", "MCT", "MCTP",
        ],
    ),
];
