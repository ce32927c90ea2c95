//! Instructions that ask the controller, its modules or its axes for something: a program that runs without one has
//! nothing that could answer.

/// What an instruction is about, where it is one of these.
pub(crate) fn controller_service(name: &str) -> Option<&'static str> {
    let is_one = |names: &[&str]| names.iter().any(|it| it.eq_ignore_ascii_case(name));
    SERVICES.iter().find(|(_, names)| is_one(names)).map(|(what, _)| *what)
}

const SERVICES: &[(&str, &[&str])] = &[
    ("it reads an object of the controller", &["GSV"]),
    ("it sets an object of the controller", &["SSV"]),
    ("it sends a message to another device", &["MSG"]),
    ("it writes to a module before the scan ends", &["IOT"]),
    ("it starts a task of the controller", &["EVENT"]),
    ("it changes which tasks of the controller interrupt", &["UID", "UIE"]),
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
