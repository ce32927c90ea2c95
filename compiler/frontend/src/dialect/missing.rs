//! What CODESYS, TwinCAT and Logix have by names that are known, and Staunch has not: it is refused by its name.

use super::Dialect;
use super::library::is_one_of;

/// Types and blocks, and the library that they are of.
const TYPES: [(&str, &[&str]); 1] =
    [("Tc2_Utilities", &["FB_MemRingBufferEx", "FB_FileRingBuffer", "RTC_EX", "FB_BasicPID"])];

/// What the blocks of PLCopen's motion control, `MC_Power`, are of.
const MOTION: &str = "`Tc2_MC2` of TwinCAT, or `SM3_Basic` of CODESYS";

/// Types of libraries that are not bundled, by which programs ask for these.
const NOT_BUNDLED: [(&str, &[&str]); 2] = [
    ("`SM3_Basic` of CODESYS", &["AXIS_REF_SM3"]),
    ("`Tc3_JsonXml` of TwinCAT", &["FB_JsonSaxReader", "FB_XmlDomParser"]),
];

/// Members of TwinCAT's types that describe the machine, which a program here knows nothing of.
const MEMBERS: [(&str, &[&str]); 2] = [
    (
        "PlcTaskSystemInfo",
        &[
            "ObjId",
            "AdsPort",
            "DcTaskTime",
            "LastExecTime",
            "CycleTimeExceeded",
            "InCallAfterOutputUpdate",
            "RTViolation",
        ],
    ),
    (
        "PlcAppSystemInfo",
        &[
            "ObjId",
            "Flags",
            "AdsPort",
            "BootDataLoaded",
            "OldBootData",
            "AppTimestamp",
            "KeepOutputsOnBP",
            "ShutdownInProgress",
            "LicensesPending",
            "BSODOccured",
            "LoggedIn",
            "PersistentStatus",
            "ActivePlcForces",
            "ActiveIoForces",
            "TComSrvPtr",
            "AppName",
        ],
    ),
];

/// Types that Logix has for instructions of ladder, charts and communication.
const OF_LOGIX: [&str; 8] =
    ["ALARM_ANALOG", "ALARM_DIGITAL", "CAM", "CAM_PROFILE", "DEADTIME", "MOTION_GROUP", "PHASE", "PID_ENHANCED"];

/// Functions of S7: why they are not there, and what to write for them.
const OF_S7: [(&str, &str, &str); 2] = [
    (
        "PRESET_TIMER",
        "it writes the PT of a timer, which takes its PT from each call here",
        "give the timer's next call the new time: `t(IN := x, PT := new_time)`",
    ),
    ("T_COMBINE", "it is `CONCAT_DATE_TOD` in SCL", "write `CONCAT_DATE_TOD(IN1 := day, IN2 := time)`"),
];

/// Operators, whose operands need not be values.
const OPERATORS: [&str; 4] = ["ADRINST", "BITADR", "INDEXOF", "__VARINFO"];

/// Variables that the system has.
const VARIABLES: [&str; 1] = ["__CURRENTTASK"];

/// The library that has a type with this name.
pub(crate) fn library_of_type(dialect: Dialect, name: &str) -> Option<&'static str> {
    if dialect == Dialect::Logix {
        return is_one_of(&OF_LOGIX, name).then_some("Logix Designer");
    }
    let found = TYPES.iter().find(|(_, names)| is_one_of(names, name)).map(|it| it.0);
    found.filter(|_| dialect == Dialect::Codesys)
}

/// Whether a name is that of a library of TwinCAT or CODESYS: their names begin with the same letters.
pub(crate) fn is_library(dialect: Dialect, name: &str) -> bool {
    const STARTS: [&str; 6] = ["Tc2_", "Tc3_", "SM3_", "CAA_", "IoDrv", "Cmp"];
    let starts_so = |it: &str| name.get(..it.len()).is_some_and(|start| start.eq_ignore_ascii_case(it));
    dialect == Dialect::Codesys && name.len() > 4 && STARTS.iter().any(|it| starts_so(it))
}

/// The libraries of TwinCAT and CODESYS that have a type with this name, if it is not bundled.
pub(crate) fn libraries_with(dialect: Dialect, name: &str) -> Option<&'static str> {
    if dialect != Dialect::Codesys {
        return None;
    }
    let is_motion = name.get(..3).is_some_and(|it| it.eq_ignore_ascii_case("MC_"));
    if is_motion {
        return Some(MOTION);
    }
    NOT_BUNDLED.iter().find(|(_, names)| is_one_of(names, name)).map(|it| it.0)
}

/// Whether TwinCAT's type has a member with this name, which is not available here.
pub(crate) fn is_member(dialect: Dialect, ty: &str, name: &str) -> bool {
    let is_it = |(of, names): &(&str, &[&str])| of.eq_ignore_ascii_case(ty) && is_one_of(names, name);
    dialect == Dialect::Codesys && MEMBERS.iter().any(is_it)
}

pub(crate) fn is_operator(dialect: Dialect, name: &str) -> bool {
    dialect == Dialect::Codesys && is_one_of(&OPERATORS, name)
}

pub(crate) fn is_variable(dialect: Dialect, name: &str) -> bool {
    dialect == Dialect::Codesys && is_one_of(&VARIABLES, name)
}

/// Siemens AX's mocks: a FUNCTION or FUNCTION_BLOCK that runs in place of another one.
pub(crate) const MOCKING: &str = "AxUnit.Mocking";

/// What a program of Siemens AX has from a namespace that is not there, and what to write for it.
pub(crate) fn namespace(full: &str) -> Option<&'static str> {
    full.eq_ignore_ascii_case(MOCKING)
        .then_some("write a TEST with `MOCK instance;`, or `MOCK_FUNCTION name RETURNS value;`")
}

/// The function that a type of a namespace is for, and without which it has no use.
pub(crate) fn function_of_type(space: &str, name: &str) -> Option<&'static str> {
    let is_it = space.eq_ignore_ascii_case("__SYSTEM") && name.eq_ignore_ascii_case("VAR_INFO");
    is_it.then_some("__VARINFO")
}

/// Why S7's function with this name is not available, and what to write instead.
pub(crate) fn function_of_s7(dialect: Dialect, name: &str) -> Option<(&'static str, &'static str)> {
    let found = OF_S7.iter().find(|it| it.0.eq_ignore_ascii_case(name)).filter(|_| dialect == Dialect::Siemens);
    found.map(|(_, why, instead)| (*why, *instead))
}
