//! The libraries of CODESYS and TwinCAT, whose names may be before those of what is built in: which name is of which.

use super::{Dialect, bare_block};

/// Those whose names are known: what they have needs none before it.
const LIBRARIES: [&str; 19] = [
    "Standard",
    "Standard64",
    "Util",
    "Tc2_Standard",
    "Tc2_System",
    "Tc2_Utilities",
    "Tc2_Math",
    "Tc2_MC2",
    "Tc2_MC2_Drive",
    "Tc2_EtherCAT",
    "Tc2_SerialCom",
    "Tc2_TcpIp",
    "Tc2_ControllerToolbox",
    "Tc2_IoFunctions",
    "Tc2_ModbusSrv",
    "Tc3_Module",
    "Tc3_EventLogger",
    "Tc3_JsonXml",
    "Tc3_IotBase",
];

/// Libraries that are not bundled, and those that they refer to, whose names may be after theirs:
/// `Tc2_EtherCAT.Tc2_Utilities.TIMESTRUCT`.
const THROUGH: [(&str, &[&str]); 1] = [("Tc2_EtherCAT", &["Tc2_Standard", "Tc2_System", "Tc2_Utilities"])];

const BLOCKS: &[&str] = &["Standard", "Standard64", "Tc2_Standard"];
const TEXTS: &[&str] = &["Standard", "Standard64", "Tc2_Standard"];
const MEMORY: &[&str] = &["Tc2_System"];

/// Functions that are of a library; all others are operators, or of the standard.
const FUNCTIONS: [(&[&str], &[&str]); 3] = [
    (
        TEXTS,
        &[
            "LEN", "LEFT", "RIGHT", "MID", "CONCAT", "INSERT", "DELETE", "REPLACE", "FIND", "WLEN", "WLEFT", "WRIGHT",
            "WMID", "WCONCAT", "WINSERT", "WDELETE", "WREPLACE", "WFIND",
        ],
    ),
    (MEMORY, &["MEMCPY", "MEMMOVE", "MEMSET", "MEMCMP"]),
    (&["Tc2_Math"], &["CEIL", "FLOOR", "LTRUNC"]),
];

/// Whether a name is that of a library whose blocks and functions need no qualification.
pub(crate) fn is_library(dialect: Dialect, name: &str) -> bool {
    dialect == Dialect::Codesys && is_one_of(&LIBRARIES, name)
}

/// Whether a library of the first name leads to that of the second one.
pub(crate) fn leads_to(dialect: Dialect, library: &str, inner: &str) -> bool {
    let is_it = |(name, refers): &(&str, &[&str])| name.eq_ignore_ascii_case(library) && is_one_of(refers, inner);
    dialect == Dialect::Codesys && THROUGH.iter().any(is_it)
}

/// The libraries that have a block or function which is not written in Structured Text.
pub(crate) fn of_built_in(name: &str) -> &'static [&'static str] {
    let function = FUNCTIONS.iter().find(|(_, names)| is_one_of(names, name)).map(|it| it.0);
    let block = || bare_block(Dialect::Codesys, name).map(|_| BLOCKS);
    function.or_else(block).unwrap_or_default()
}

pub(crate) fn is_one_of(names: &[&str], name: &str) -> bool {
    names.iter().any(|it| it.eq_ignore_ascii_case(name))
}
