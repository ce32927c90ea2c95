//! The library that is written in Structured Text: a unit becomes a source of the program where one of the program's
//! files names it, and costs nothing where none does. What a user declares by the same name wins.

mod index;
mod tcunit;
mod vendor;

use crate::automation_studio::EDGES;
use crate::dialect::Dialect;
use crate::dialect::library::{is_one_of, leads_to};
use crate::lex::{Kind, Known, Tokens, lex_with};
use crate::options::Options;
use crate::source::Habits;
use crate::{Code, Diagnostic, Severity, Source, Sources, Span};
use rustc_hash::FxHashSet;
use staunch_runtime::Class;

/// A unit of the library.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    pub name: &'static str,
    text: &'static str,
    pub declares: Declares,
    /// The dialects that have it by this name; none stands for all.
    pub dialects: &'static [Dialect],
    /// The libraries of CODESYS and TwinCAT that have it, whose names may be before its own.
    pub libraries: &'static [&'static str],
    needs: Needs,
    /// A vendor's declaration: what needs the machine has no body.
    pub is_declaration: bool,
}

/// Other units that one names.
#[derive(Clone, Copy, Debug)]
enum Needs {
    These(&'static [&'static str]),
    This(&'static str),
    /// Those that are named in its text.
    Read,
}

impl Unit {
    pub fn is_function(&self) -> bool {
        self.declares == Declares::Function
    }

    /// Whether what it declares is one thing by its own name. A data type is shared: what is handed to a block is of it, so
    /// the program's takes its place.
    fn has_own_name(&self) -> bool {
        match self.declares {
            Declares::Function | Declares::Value => true,
            Declares::Type => self.is_declaration || self.text.contains("FUNCTION_BLOCK"),
            Declares::Global | Declares::Space | Declares::Open => false,
        }
    }

    pub fn is_value(&self) -> bool {
        self.declares == Declares::Value
    }

    /// Whether the names of its values may be after its own.
    fn is_enumeration(&self) -> bool {
        self.is_declaration && self.declares == Declares::Type && self.text.contains(" : (\n")
    }

    fn is_interface(&self) -> bool {
        self.is_declaration && self.text.starts_with("INTERFACE")
    }

    fn needs(&self) -> Vec<&'static str> {
        match self.needs {
            Needs::These(names) => names.to_vec(),
            Needs::This(name) => vec![name],
            Needs::Read => {
                let others = words(self.text).filter(|it| !it.eq_ignore_ascii_case(self.name));
                let mut names: Vec<_> = others.flat_map(units).map(|it| it.name).collect();
                names.sort_unstable();
                names.dedup();
                names
            }
        }
    }

    /// By whose rules of values it computes: what the standard describes is written by the standard's. A unit test's
    /// framework is a part of the program that it tests.
    fn rules(&self, dialect: Dialect) -> Dialect {
        let is_standard = self.declares != Declares::Open && self.dialects.contains(&Dialect::Iec);
        if is_standard { Dialect::Iec } else { dialect }
    }
}

/// What a unit declares, and so where its name is its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declares {
    Type,
    Function,
    /// A global constant.
    Value,
    /// A global variable, or a list of them.
    Global,
    /// A NAMESPACE, `System.Timer`, with all that is in it.
    Space,
    /// The same, where a program adds to what is in it.
    Open,
}

const LINE_END: &str = "\n";

/// What the namespaces of the library are in.
const SYSTEM: &str = "System";

/// AxUnit's mocks, which are there where they are named: `AxUnit.Mocking`, or `Mocking` after `USING AxUnit`.
const MOCKING: &str = "AxUnit.Mocking";

/// TcUnit's functions that write to what others may only read, where the library's name is before them.
const WRITE_PROTECTED: &str = "TcUnit.WRITE_PROTECTED";

fn is_write_protected(name: &str) -> bool {
    const BEGINNING: &str = "WRITE_PROTECTED_";
    name.get(..BEGINNING.len()).is_some_and(|it| it.eq_ignore_ascii_case(BEGINNING))
}

/// The namespace of what is handed on for an input of ANY, and its members.
const ANY: &str = "__SYSTEM";
/// The list of global variables of TwinCAT's libraries.
pub(crate) const LIST: &str = "Global_Variables";

/// What begins a sequential function chart, and the units that one may need: one of them is of the dialect.
const INITIAL_STEP: &str = "INITIAL_STEP";
const CHARTS: [&str; 2] = ["__Chart", "__MatiecChart"];

const OF_ANY: [&str; 3] = [ASKING[2], ASKING[3], ASKING[4]];

macro_rules! units {
    ($($declares:ident $name:literal $file:tt $([$($dialect:ident)+ $(: $($library:ident)+)?])? $($need:literal)*;)*) => {
        &[$(Unit {
            name: $name,
            text: units!(@text $file),
            declares: Declares::$declares,
            dialects: &[$($(Dialect::$dialect),+)?],
            libraries: &[$($($(stringify!($library)),+)?)?],
            needs: Needs::These(&[$($need),*]),
            is_declaration: false,
        }),*]
    };
    (@text ($text:expr)) => {
        $text
    };
    (@text $file:literal) => {
        include_str!(concat!("prelude/", $file, ".st"))
    };
}

/// The text of a unit that is a constant.
macro_rules! constant {
    ($name:ident, $type:ident, $value:literal) => {
        concat!("VAR_GLOBAL CONSTANT ", stringify!($name), " : ", stringify!($type), " := ", $value, "; END_VAR\n")
    };
}

/// The text of a unit that makes a T_Arg of a whole number or of bits.
macro_rules! argument {
    ($name:ident, $type:ident, $kind:ident, $size:literal, $bits:literal) => {
        concat!(
            "FUNCTION ",
            stringify!($name),
            " : T_Arg\nVAR_INPUT\n    in : ",
            stringify!($type),
            ";\nEND_VAR\n",
            stringify!($name),
            ".eType := E_ArgType.",
            stringify!($kind),
            ";\n",
            stringify!($name),
            ".cbLen := ",
            $size,
            ";\n",
            stringify!($name),
            ".__bits := ",
            $bits,
            ";\nEND_FUNCTION\n"
        )
    };
}

/// The text of the data of a counter of S7, which is what it is called as: the CTUD has the count, whichever instruction works on it.
macro_rules! counter {
    ($name:ident, $type:ident) => {
        concat!(
            "FUNCTION_BLOCK ",
            stringify!($name),
            "\nVAR_INPUT CU, CD, R, LD : BOOL; PV : ",
            stringify!($type),
            "; END_VAR\nVAR_OUTPUT QU, QD : BOOL; CV : ",
            stringify!($type),
            "; END_VAR\nVAR count : S7.CTUD_",
            stringify!($type),
            "; END_VAR\n",
            counter!(@method "CTU", "CU, R", "Q", $type),
            "THIS.CTUD(CU := CU, CD := THIS.CD, R := R, LD := FALSE, PV := PV, QU => Q, CV => CV);\nEND_METHOD\n",
            counter!(@method "CTD", "CD, LD", "Q", $type),
            "THIS.CTUD(CU := THIS.CU, CD := CD, R := FALSE, LD := LD, PV := PV, QD => Q, CV => CV);\nEND_METHOD\n",
            counter!(@method "CTUD", "CU, CD, R, LD", "QU, QD", $type),
            "THIS.CU := CU; THIS.CD := CD; THIS.R := R; THIS.LD := LD; THIS.PV := PV;\n",
            "count(CU := CU, CD := CD, R := R, LD := LD, PV := PV, QU => QU, QD => QD, CV => CV);\n",
            "THIS.QU := QU; THIS.QD := QD; THIS.CV := CV;\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
        )
    };
    (@method $name:literal, $inputs:literal, $outputs:literal, $type:ident) => {
        concat!(
            "METHOD PUBLIC ",
            $name,
            "\nVAR_INPUT ",
            $inputs,
            " : BOOL; PV : ",
            stringify!($type),
            "; END_VAR\nVAR_OUTPUT ",
            $outputs,
            " : BOOL; CV : ",
            stringify!($type),
            "; END_VAR\n"
        )
    };
}

/// Every unit. Units with the same name are of different dialects.
pub const UNITS: &[Unit] = units! {
    Type     "BLINK"            "blink"            [Codesys: Util];
    Type     "GEN_MODE"         "gen_mode"         [Codesys: Util];
    Type     "GEN"              "gen"              [Codesys: Util] "GEN_MODE";
    Type     "FREQ_MEASURE"     "freq_measure"     [Codesys: Util];
    Type     "HYSTERESIS"       "hysteresis"       [Codesys: Util];
    Type     "LIMITALARM"       "limitalarm"       [Codesys: Util];
    Type     "DERIVATIVE"       "derivative"       [Codesys: Util];
    Type     "INTEGRAL"         "integral"         [Codesys: Util];
    Type     "LIN_TRAFO"        "lin_trafo"        [Codesys: Util];
    Type     "STATISTICS_INT"   "statistics_int"   [Codesys: Util];
    Type     "STATISTICS_REAL"  "statistics_real"  [Codesys: Util];
    Type     "POINT"            "point"            [Codesys: Util];
    Type     "CHARCURVE"        "charcurve"        [Codesys: Util] "POINT";
    Type     "RAMP_INT"         "ramp_int"         [Codesys: Util];
    Type     "RAMP_REAL"        "ramp_real"        [Codesys: Util];
    Type     "PD"               "pd"               [Codesys: Util] "DERIVATIVE";
    Type     "PID"              "pid"              [Codesys: Util] "DERIVATIVE" "INTEGRAL";
    Type     "UNPACK"           "unpack"           [Codesys: Util];
    Function "PACK"             "pack"             [Codesys: Util];
    Function "EXTRACT"          "extract"          [Codesys: Util];
    Function "PUTBIT"           "putbit"           [Codesys: Util];
    Function "BCD_TO_INT"       "bcd_to_int"       [Codesys: Util];
    Function "INT_TO_BCD"       "int_to_bcd"       [Codesys: Util];
    Function "BYTE_TO_BCD"      "byte_to_bcd"      [Codesys: Util];
    Function "BCD_TO_BYTE"      "bcd_to_byte"      [Codesys: Util];
    Function "WORD_TO_BCD"      "word_to_bcd"      [Codesys: Util];
    Function "BCD_TO_WORD"      "bcd_to_word"      [Codesys: Util];
    Function "DWORD_TO_BCD"     "dword_to_bcd"     [Codesys: Util];
    Function "BCD_TO_DWORD"     "bcd_to_dword"     [Codesys: Util];
    Type     "PID_FIXCYCLE"     "pid_fixcycle"     [Codesys: Util] "DERIVATIVE" "INTEGRAL";
    Type     "VARIANCE"         "variance"         [Codesys: Util];
    Type     "BIT_AS_BYTE"      "bit_as_byte"      [Codesys: Util];
    Type     "BYTE_AS_BIT"      "byte_as_bit"      [Codesys: Util];
    Type     "BIT_AS_WORD"      "bit_as_word"      [Codesys: Util];
    Type     "WORD_AS_BIT"      "word_as_bit"      [Codesys: Util];
    Type     "BIT_AS_DWORD"     "bit_as_dword"     [Codesys: Util];
    Type     "DWORD_AS_BIT"     "dword_as_bit"     [Codesys: Util];
    Function "GETBIT"           "getbit"           [Codesys: Util];
    Function "SETBIT"           "setbit"           [Codesys: Util] "__SYSTEM";
    Function "SWITCHBIT"        "switchbit"        [Codesys: Util];
    Function "BYTE_TO_GRAY"     "byte_to_gray"     [Codesys: Util];
    Function "GRAY_TO_BYTE"     "gray_to_byte"     [Codesys: Util];
    Function "WORD_TO_GRAY"     "word_to_gray"     [Codesys: Util];
    Function "GRAY_TO_WORD"     "gray_to_word"     [Codesys: Util];
    Function "DWORD_TO_GRAY"    "dword_to_gray"    [Codesys: Util];
    Function "GRAY_TO_DWORD"    "gray_to_dword"    [Codesys: Util];
    Function "BYTE_TO_HEXinASCII" "byte_to_hexinascii" [Codesys: Util];
    Function "HEXinASCII_TO_BYTE" "hexinascii_to_byte" [Codesys: Util] "HEXASCNIBBLE_TO_BYTE";
    Function "WORD_AS_STRING"   "word_as_string"   [Codesys: Util];
    Type     "T_MaxString"      "t_maxstring"      [Codesys: Tc2_System];
    Function "F_ToUCase"        "f_toucase"        [Codesys: Tc2_Utilities] "T_MaxString";
    Function "F_ToLCase"        "f_tolcase"        [Codesys: Tc2_Utilities] "T_MaxString";
    Function "F_LTrim"          "f_ltrim"          [Codesys: Tc2_Utilities] "T_MaxString";
    Function "F_RTrim"          "f_rtrim"          [Codesys: Tc2_Utilities] "T_MaxString";
    Function "LEN2"             "len2"             [Codesys: Tc2_Utilities];
    Function "CONCAT2"          "concat2"          [Codesys: Tc2_Utilities] "LEN2";
    Function "WLEN2"            "wlen2"            [Codesys: Tc2_Utilities];
    Function "WCONCAT2"         "wconcat2"         [Codesys: Tc2_Utilities] "WLEN2";
    Function "STRNCPY"          "strncpy"          [Codesys: Tc2_Utilities] "LEN2";
    Function "WSTRNCPY"         "wstrncpy"         [Codesys: Tc2_Utilities] "WLEN2";
    Function "LrealIsNaN"       "lrealisnan"       [Codesys: Tc2_Utilities];
    Function "BYTE_TO_HEXSTR"   "byte_to_hexstr"   [Codesys: Tc2_Utilities] "LWORD_TO_HEXSTR";
    Function "WORD_TO_HEXSTR"   "word_to_hexstr"   [Codesys: Tc2_Utilities] "LWORD_TO_HEXSTR";
    Function "DWORD_TO_HEXSTR"  "dword_to_hexstr"  [Codesys: Tc2_Utilities] "LWORD_TO_HEXSTR";
    Function "LWORD_TO_HEXSTR"  "lword_to_hexstr"  [Codesys: Tc2_Utilities] "T_MaxString";
    Type     "HRESULT"          "hresult"          [Codesys: Tc2_System];
    Function "SUCCEEDED"        "succeeded"        [Codesys: Tc2_System] "HRESULT";
    Function "FAILED"           "failed"           [Codesys: Tc2_System] "HRESULT";
    Type     "ST_LibVersion"    "st_libversion"    [Codesys: Tc2_System];
    Type     "T_AmsNetId"       "t_amsnetid"       [Codesys: Tc2_System];
    Type     "DRAND"            "drand"            [Codesys: Tc2_System];
    Function "HOST_TO_BE16"     "host_to_be16"     [Codesys: Tc2_Utilities];
    Function "HOST_TO_BE32"     "host_to_be32"     [Codesys: Tc2_Utilities];
    Function "BE16_TO_HOST"     "be16_to_host"     [Codesys: Tc2_Utilities];
    Function "BE32_TO_HOST"     "be32_to_host"     [Codesys: Tc2_Utilities];
    Type     "PVOID"            "pvoid"            [Codesys];
    Type     "UXINT"            "uxint"            [Codesys];
    Type     "XINT"             "xint"             [Codesys];
    Type     "XWORD"            "xword"            [Codesys];
    Function "TEST_AND_SET"     "test_and_set"     [Codesys];
    Function "__XADD"           "xadd"             [Codesys];
    Function "__COMPARE_AND_SWAP" "compare_and_swap" [Codesys] "__XWORD";
    Type     "__UXINT"          "own_uxint"        [Codesys];
    Type     "__XINT"           "own_xint"         [Codesys];
    Type     "__XWORD"          "own_xword"        [Codesys];
    Function "TestAndSet"       "testandset"       [Codesys: Tc2_System];
    Type     "T_AmsNetIdArr"    "t_amsnetidarr"    [Codesys: Tc2_System];
    Type     "T_AmsPort"        "t_amsport"        [Codesys: Tc2_System];
    Type     "ST_AmsAddr"       "st_amsaddr"       [Codesys: Tc2_System] "T_AmsNetIdArr" "T_AmsPort";
    Function "F_CreateAmsNetId" "f_createamsnetid" [Codesys: Tc2_System] "T_AmsNetId" "T_AmsNetIdArr";
    Function "F_ToCHR"          "f_tochr"          [Codesys: Tc2_System];
    Function "F_ToASC"          "f_toasc"          [Codesys: Tc2_System];
    Function "HEXASCNIBBLE_TO_BYTE" "hexascnibble_to_byte" [Codesys: Tc2_Utilities];
    Function "HEXCHRNIBBLE_TO_BYTE" "hexchrnibble_to_byte" [Codesys: Tc2_Utilities] "HEXASCNIBBLE_TO_BYTE";
    Type     "TIMESTRUCT"       "timestruct"       [Codesys: Tc2_Utilities];
    Function "DT_TO_SYSTEMTIME" "dt_to_systemtime" [Codesys: Tc2_Utilities] "TIMESTRUCT" "SPLIT_DT";
    Function "SYSTEMTIME_TO_DT" "systemtime_to_dt" [Codesys: Tc2_Utilities] "TIMESTRUCT";
    Function "FRAC"             "frac"             [Codesys: Tc2_Math];
    Function "LMOD"             "lmod"             [Codesys: Tc2_Math];
    Function "MODABS"           "modabs"           [Codesys: Tc2_Math] "LMOD";
    Function "MODTURNS"         "modturns"         [Codesys: Tc2_Math] "MODABS";
    Function "ADSLOGSTR"        "adslogstr"        [Codesys: Tc2_System] "__AdsLog";
    Function "ADSLOGDINT"       "adslogdint"       [Codesys: Tc2_System] "__AdsLog";
    Function "ADSLOGLREAL"      "adsloglreal"      [Codesys: Tc2_System] "__AdsLog";
    Function "__AdsLog"         "adslog"           [Codesys];
    Value "ADSLOG_MSGTYPE_HINT"     (constant!(ADSLOG_MSGTYPE_HINT, DWORD, "16#01"))     [Codesys: Tc2_System];
    Value "ADSLOG_MSGTYPE_WARN"     (constant!(ADSLOG_MSGTYPE_WARN, DWORD, "16#02"))     [Codesys: Tc2_System];
    Value "ADSLOG_MSGTYPE_ERROR"    (constant!(ADSLOG_MSGTYPE_ERROR, DWORD, "16#04"))    [Codesys: Tc2_System];
    Value "ADSLOG_MSGTYPE_LOG"      (constant!(ADSLOG_MSGTYPE_LOG, DWORD, "16#10"))      [Codesys: Tc2_System];
    Value "ADSLOG_MSGTYPE_MSGBOX"   (constant!(ADSLOG_MSGTYPE_MSGBOX, DWORD, "16#20"))   [Codesys: Tc2_System];
    Value "ADSLOG_MSGTYPE_RESOURCE" (constant!(ADSLOG_MSGTYPE_RESOURCE, DWORD, "16#40")) [Codesys: Tc2_System];
    Value "ADSLOG_MSGTYPE_STRING"   (constant!(ADSLOG_MSGTYPE_STRING, DWORD, "16#80"))   [Codesys: Tc2_System];
    Value "DEFAULT_ADS_TIMEOUT"     (constant!(DEFAULT_ADS_TIMEOUT, TIME, "T#5s"))       [Codesys: Tc2_System];
    Value "MAX_STRING_LENGTH"       (constant!(MAX_STRING_LENGTH, UDINT, "255"))         [Codesys: Tc2_System];
    Value "PI"                      (constant!(PI, LREAL, "3.1415926535897932384626433832795")) [Codesys: Tc2_System];
    Type     "E_ArgType"        "e_argtype"        [Codesys: Tc2_Utilities];
    Type     "T_Arg"            "t_arg"            [Codesys: Tc2_Utilities] "E_ArgType";
    Function "F_BYTE"           (argument!(F_BYTE, BYTE, ARGTYPE_BYTE, "1", "BYTE_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_WORD"           (argument!(F_WORD, WORD, ARGTYPE_WORD, "2", "WORD_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_DWORD"          (argument!(F_DWORD, DWORD, ARGTYPE_DWORD, "4", "DWORD_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_LWORD"          (argument!(F_LWORD, LWORD, ARGTYPE_LWORD, "8", "in")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_SINT"           (argument!(F_SINT, SINT, ARGTYPE_SINT, "1", "LINT_TO_LWORD(SINT_TO_LINT(in))")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_INT"            (argument!(F_INT, INT, ARGTYPE_INT, "2", "LINT_TO_LWORD(INT_TO_LINT(in))")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_DINT"           (argument!(F_DINT, DINT, ARGTYPE_DINT, "4", "LINT_TO_LWORD(DINT_TO_LINT(in))")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_LINT"           (argument!(F_LINT, LINT, ARGTYPE_LARGE, "8", "LINT_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_USINT"          (argument!(F_USINT, USINT, ARGTYPE_USINT, "1", "USINT_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_UINT"           (argument!(F_UINT, UINT, ARGTYPE_UINT, "2", "UINT_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_UDINT"          (argument!(F_UDINT, UDINT, ARGTYPE_UDINT, "4", "UDINT_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_ULINT"          (argument!(F_ULINT, ULINT, ARGTYPE_ULARGE, "8", "ULINT_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_BOOL"           (argument!(F_BOOL, BOOL, ARGTYPE_BOOL, "1", "BOOL_TO_LWORD(in)")) [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_REAL"           "f_real"           [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_LREAL"          "f_lreal"          [Codesys: Tc2_Utilities] "T_Arg";
    Function "F_STRING"         "f_string"         [Codesys: Tc2_Utilities] "T_Arg";
    Type     "FB_FormatString"  "fb_formatstring"  [Codesys: Tc2_Utilities] "__FormatBase";
    Type     "FB_FormatString2" "fb_formatstring2" [Codesys: Tc2_Utilities] "__FormatBase";
    Type     "FB_MemRingBuffer" "fb_memringbuffer" [Codesys: Tc2_Utilities];
    Type     "__FormatBase"     "formatted"        [Codesys] "T_Arg";
    Type     "ALARM"            "logix_alarm"      [Logix];
    Type     "CONTROL"          "logix_control"    [Logix];
    Type     "MESSAGE"          "logix_message"    [Logix];
    Type     "PID"              "logix_pid"        [Logix];
    Type     "SERIAL_PORT_CONTROL" "logix_serial_port_control" [Logix];
    Type     "SFC_ACTION"       "logix_sfc_action" [Logix];
    Type     "SFC_STEP"         "logix_sfc_step"   [Logix];
    Type     "SFC_STOP"         "logix_sfc_stop"   [Logix];
    Global   "TwinCAT_SystemInfoVarList" "taskinfo" [Codesys];
    // Without its list.
    Global   "_TaskInfo"        (LINE_END)         [Codesys] "TwinCAT_SystemInfoVarList";
    Global   "_AppInfo"         (LINE_END)         [Codesys] "TwinCAT_SystemInfoVarList";
    Type     "PlcTaskSystemInfo" (LINE_END)        [Codesys] "TwinCAT_SystemInfoVarList";
    Type     "PlcAppSystemInfo" (LINE_END)         [Codesys] "TwinCAT_SystemInfoVarList";
    Type     "GETCURTASKINDEX"  "getcurtaskindex"  [Codesys: Tc2_System] "TwinCAT_SystemInfoVarList";
    Function "GETCURTASKINDEXEX" "getcurtaskindexex" [Codesys: Tc2_System] "TwinCAT_SystemInfoVarList";
    Function "F_GetTaskInfo"    "f_gettaskinfo"    [Codesys: Tc2_System] "TwinCAT_SystemInfoVarList";
    Function "F_RaiseException" "f_raiseexception" [Codesys: Tc2_System] "__SYSTEM";
    Type     "GETCPUCOUNTER"    "getcpucounter"    [Codesys: Tc2_System];
    Type     "INTEGRAL"         "iec_integral"     [Iec Openplc Openplc4];
    Type     "DERIVATIVE"       "iec_derivative"   [Iec Openplc Openplc4];
    Type     "PID"              "iec_pid"          [Iec Openplc Openplc4] "INTEGRAL" "DERIVATIVE";
    Type     "RAMP"             "iec_ramp"         [Iec Openplc Openplc4];
    Type     "HYSTERESIS"       "iec_hysteresis"   [Iec Openplc Openplc4];
    Type     "SEMA"             "iec_sema"         [Iec Openplc Openplc4];
    Type     "__Chart"          "chart"            [Iec Cscape Codesys Openplc4 Logix Siemens] "__Step" "__Action";
    Type     "__Step"           "chart_step"       [Iec Cscape Codesys Openplc4 Logix Siemens];
    Type     "__Action"         "chart_action"     [Iec Cscape Codesys Openplc4 Logix Siemens];
    Type     "__MatiecChart"    "matiec_chart"     [Openplc] "__MatiecStep" "__MatiecAction";
    Type     "__MatiecStep"     "matiec_chart_step" [Openplc];
    Type     "__MatiecAction"   "matiec_chart_action" [Openplc];
    Function "__EDGEPOS"        "edgepos";
    Function "__EDGENEG"        "edgeneg";
    Function "__EDGE"           "edge";
    Type     "IEC_TIMER"        "iec_timer"        [Siemens];
    Function "RESET_TIMER"      "reset_timer"      [Siemens] "IEC_TIMER";
    Type     "IEC_COUNTER"      (counter!(IEC_COUNTER, INT))       [Siemens];
    Type     "IEC_SCOUNTER"     (counter!(IEC_SCOUNTER, SINT))     [Siemens];
    Type     "IEC_DCOUNTER"     (counter!(IEC_DCOUNTER, DINT))     [Siemens];
    Type     "IEC_LCOUNTER"     (counter!(IEC_LCOUNTER, LINT))     [Siemens];
    Type     "IEC_USCOUNTER"    (counter!(IEC_USCOUNTER, USINT))   [Siemens];
    Type     "IEC_UCOUNTER"     (counter!(IEC_UCOUNTER, UINT))     [Siemens];
    Type     "IEC_UDCOUNTER"    (counter!(IEC_UDCOUNTER, UDINT))   [Siemens];
    Type     "IEC_ULCOUNTER"    (counter!(IEC_ULCOUNTER, ULINT))   [Siemens];
    Function "NORM_X"           "norm_x"           [Siemens];
    Function "SCALE_X"          "scale_x"          [Siemens];
    Type     "RTC"              "rtc"              [Iec Cscape Openplc Openplc4 Logix Siemens];
    Type     "RTC"              "codesys_rtc"      [Codesys: Standard];
    Function "SQR"              "sqr"              [Siemens];
    Function "DEG"              "logix_deg"        [Logix];
    Function "RAD"              "logix_rad"        [Logix];
    Function "UPPER"            "logix_upper"      [Logix];
    Function "LOWER"            "logix_lower"      [Logix];
    Function "STOD"             "logix_stod"       [Logix];
    Function "SWPB"             "logix_swpb"       [Logix] "__SwapTwo";
    Function "__SwapTwo"        "logix_swap_two"   [Logix];
    // The instruction; the function is the standard's.
    Function "FIND"             (LINE_END)         [Logix] "__FindFrom";
    Function "__FindFrom"       "logix_find_from"  [Logix];
    Function "SPLIT_DATE"       "split_date" [Iec Cscape Codesys Openplc Openplc4 Logix Siemens];
    Function "SPLIT_TOD"        "split_tod" [Iec Cscape Codesys Openplc Openplc4 Logix Siemens];
    Function "SPLIT_LTOD"       "split_ltod" [Iec Cscape Codesys Openplc Openplc4 Logix Siemens];
    Function "SPLIT_DT"         "split_dt"        [Iec Cscape Codesys Openplc Openplc4 Logix Siemens] "SPLIT_DATE" "SPLIT_TOD";
    Function "SPLIT_LDT"        "split_ldt"       [Iec Cscape Codesys Openplc Openplc4 Logix Siemens] "SPLIT_DATE" "SPLIT_LTOD";
    Function "IS_VALID"         "is_valid";
    Function "IS_VALID_BCD"     "is_valid_bcd";
    Space    "System.Timer"     "system_timer";
    Space    "System.Counters"  "system_counters";
    Space    "System.Strings"   "system_strings";
    Space    "System.Math"      "system_math";
    Space    "System.DateTime"  "system_datetime"  "SPLIT_LDT" "SPLIT_DATE" "SPLIT_LTOD";
    Open     "AxUnit"           "axunit"           [Iec Siemens];
    Open     "AxUnit.Mocking"   "axunit_mocking"   [Iec Siemens] "AxUnit";
    Space    "TcUnit"           (tcunit::TEXT);
    Space    "IBaseLibrary"     "ibaselibrary"     [Codesys];
    Space    "__SYSTEM"         "system_any"       [Codesys];
    // Without its namespace, as TwinCAT takes it.
    Type     "FB_TestSuite"     (LINE_END) "TcUnit";
    Space    "TcUnit.WRITE_PROTECTED" (tcunit::WRITE_PROTECTED);
    Function "TCUNIT_ADSLOGSTR" "tcunit_adslogstr" [Codesys] "ADSLOGSTR";
    Function "WRITE_PROTECTED_BOOL" (tcunit::write_protected!("BOOL")) [Codesys];
    Function "WRITE_PROTECTED_BYTE" (tcunit::write_protected!("BYTE")) [Codesys];
    Function "WRITE_PROTECTED_WORD" (tcunit::write_protected!("WORD")) [Codesys];
    Function "WRITE_PROTECTED_DWORD" (tcunit::write_protected!("DWORD")) [Codesys];
    Function "WRITE_PROTECTED_LWORD" (tcunit::write_protected!("LWORD")) [Codesys];
    Function "WRITE_PROTECTED_SINT" (tcunit::write_protected!("SINT")) [Codesys];
    Function "WRITE_PROTECTED_INT" (tcunit::write_protected!("INT")) [Codesys];
    Function "WRITE_PROTECTED_DINT" (tcunit::write_protected!("DINT")) [Codesys];
    Function "WRITE_PROTECTED_LINT" (tcunit::write_protected!("LINT")) [Codesys];
    Function "WRITE_PROTECTED_USINT" (tcunit::write_protected!("USINT")) [Codesys];
    Function "WRITE_PROTECTED_UINT" (tcunit::write_protected!("UINT")) [Codesys];
    Function "WRITE_PROTECTED_UDINT" (tcunit::write_protected!("UDINT")) [Codesys];
    Function "WRITE_PROTECTED_ULINT" (tcunit::write_protected!("ULINT")) [Codesys];
    Function "WRITE_PROTECTED_REAL" (tcunit::write_protected!("REAL")) [Codesys];
    Function "WRITE_PROTECTED_LREAL" (tcunit::write_protected!("LREAL")) [Codesys];
    Function "WRITE_PROTECTED_TIME" (tcunit::write_protected!("TIME")) [Codesys];
    Function "WRITE_PROTECTED_DATE" (tcunit::write_protected!("DATE")) [Codesys];
    Function "WRITE_PROTECTED_TIME_OF_DAY" (tcunit::write_protected!("TIME_OF_DAY")) [Codesys];
    Function "WRITE_PROTECTED_DATE_AND_TIME" (tcunit::write_protected!("DATE_AND_TIME")) [Codesys];
    Function "WRITE_PROTECTED_STRING" (tcunit::write_protected!("STRING")) [Codesys];
    Function "WRITE_PROTECTED_WSTRING" (tcunit::write_protected!("WSTRING")) [Codesys];
};

/// What asks for a unit by another name than its own; so do the names of classes of types.
const ASKING: [&str; 8] = [SYSTEM, INITIAL_STEP, "TypeClass", "pValue", "diSize", EDGES[0].0, EDGES[1].0, EDGES[2].0];

static LENGTHS: index::Lengths = {
    let mut lengths = [0; 1024];
    let mut at = 0;
    while at < UNITS.len() {
        let name = UNITS[at].name.as_bytes();
        index::with_name(&mut lengths, name, 0, name.len());
        at += 1;
    }
    at = 0;
    while at < vendor::COUNT {
        let (text, start, end) = vendor::name_at(at);
        index::with_name(&mut lengths, text, start, end);
        at += 1;
    }
    at = 0;
    while at < ASKING.len() {
        index::with_name(&mut lengths, ASKING[at].as_bytes(), 0, ASKING[at].len());
        at += 1;
    }
    at = 0;
    while at < Class::ALL.len() {
        let name = Class::ALL[at].name().as_bytes();
        index::with_name(&mut lengths, name, 0, name.len());
        at += 1;
    }
    lengths
};

/// The units, and after them the vendors' declarations, by their names.
static NUMBERS: index::Numbers = {
    let mut numbers: index::Numbers = [0; index::PLACES];
    let mut at = 0;
    while at < UNITS.len() {
        let name = UNITS[at].name.as_bytes();
        index::with_number(&mut numbers, name, 0, name.len(), at as u16 + 1);
        at += 1;
    }
    at = 0;
    while at < vendor::COUNT {
        let (text, start, end) = vendor::name_at(at);
        index::with_number(&mut numbers, text, start, end, (UNITS.len() + at) as u16 + 1);
        at += 1;
    }
    numbers
};

/// The units of a name, each in other dialects.
pub(crate) fn units(name: &str) -> impl Iterator<Item = Unit> {
    let numbers = index::places(name).map(|it| usize::from(NUMBERS[it])).take_while(|it| *it > 0);
    numbers.filter_map(|it| unit_at(it - 1)).filter(move |it| it.name.eq_ignore_ascii_case(name))
}

/// Every unit, also those of vendors' declarations.
pub fn every_unit() -> impl Iterator<Item = Unit> {
    (0..UNITS.len() + vendor::COUNT).filter_map(unit_at)
}

fn unit_at(number: usize) -> Option<Unit> {
    if let Some(unit) = UNITS.get(number) {
        return Some(*unit);
    }
    let it = vendor::declaration(number - UNITS.len())?;
    let declares = match it.kind {
        vendor::Kind::Type | vendor::Kind::Enumeration | vendor::Kind::Interface => Declares::Type,
        vendor::Kind::Function => Declares::Function,
        vendor::Kind::Value | vendor::Kind::Enumerator => Declares::Value,
    };
    Some(Unit {
        name: it.name,
        text: it.text,
        declares,
        dialects: it.dialects,
        libraries: it.libraries,
        needs: it.of.map_or(Needs::Read, Needs::This),
        is_declaration: true,
    })
}

/// Whether a namespace is the standard library's, in which standard functions are, too: `System.Math`.
pub(crate) fn is_standard_space(name: &str) -> bool {
    let is_in_system = name.split_once('.').is_some_and(|it| it.0.eq_ignore_ascii_case(SYSTEM));
    is_in_system && units(name).any(|it| it.declares == Declares::Space)
}

/// The unit that a dialect has by this name.
pub(crate) fn unit(name: &str, dialect: Dialect) -> Option<Unit> {
    units(name).find(|it| it.dialects.is_empty() || it.dialects.contains(&dialect))
}

/// One of the dialects that have a unit with this name, if not all do.
pub(crate) fn owner(name: &str) -> Option<Dialect> {
    units(name).find_map(|it| it.dialects.first().copied())
}

/// A unit that a program names, and where it does first.
#[derive(Clone, Copy, Debug)]
struct Named {
    unit: Unit,
    at: Span,
    dialect: Dialect,
    /// After the name of its library: it is available whatever the program declares.
    is_qualified: bool,
    /// The program declares its name: the unit has [another](renamed).
    is_taken: bool,
}

/// What the name of a unit begins with whose own name the program has.
pub(crate) const RENAMED: &str = "__own_";

pub(crate) fn renamed(name: &str) -> String {
    format!("{RENAMED}{name}")
}

/// A unit's text, with other names for units whose names the program has. Names after a point are members.
fn with_own_names(text: &str, taken: &[&str]) -> String {
    if taken.is_empty() {
        return text.to_owned();
    }
    let tokens = lex_with(0, text, Habits::default(), Known::Never);
    let mut made = String::with_capacity(text.len());
    let mut copied = 0;
    for (at, (kind, place)) in tokens.kinds.iter().zip(&tokens.places).enumerate() {
        let place = range(*place);
        let is_member = at > 0 && tokens.kinds[at - 1] == Kind::Dot;
        let word = text.get(place.clone()).unwrap_or_default();
        if *kind == Kind::Name && !is_member && is_one_of(taken, word) {
            made.push_str(&text[copied..place.start]);
            made.push_str(&renamed(word));
            copied = place.end;
        }
    }
    made + &text[copied..]
}

/// The sources with what they name of the library after them.
pub(crate) struct Extended {
    pub sources: Sources,
    named: Vec<Named>,
}

impl Extended {
    /// `None` where the sources name nothing of the library.
    pub fn of(sources: &Sources, options: &Options) -> Option<Self> {
        let mut uses = Uses::default();
        for (source, number) in sources.files().iter().zip(0u16..) {
            if mentions_any(&source.text, options.dialect) {
                uses.read(number, source, options.habits(sources, source), options);
            }
        }
        let named = uses.needed();
        if named.is_empty() {
            return None;
        }
        let mut sources = sources.clone();
        let taken: Vec<_> = named.iter().filter(|it| it.is_taken).map(|it| it.unit.name).collect();
        for it in &named {
            let text =
                format!("{{dialect '{}'}} {}", it.unit.rules(it.dialect).name(), with_own_names(it.unit.text, &taken));
            let source = Source::new(format!("library/{}.st", it.unit.name.to_ascii_lowercase()), text);
            sources.add(if it.unit.is_declaration { source.declarations() } else { source.bundled() });
        }
        Some(Self { sources, named })
    }

    /// What is reported of the user's own files. A unit that does not fit what the user declares is reported
    /// where it is named.
    pub fn of_the_user(&self, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let own = self.sources.files().len() - self.named.len();
        let mut kept: Vec<Diagnostic> = Vec::new();
        for mut it in diagnostics {
            it.others.retain(|label| usize::from(label.span.file) < own);
            match usize::from(it.span.file).checked_sub(own) {
                None => kept.push(it),
                Some(unit) if it.severity == Severity::Error => {
                    let error = self.named[unit].unfit(&it);
                    if !kept.iter().any(|known| known.span == error.span && known.repeats(&error)) {
                        kept.push(error);
                    }
                }
                Some(_) => {}
            }
        }
        kept
    }
}

impl Named {
    fn unfit(&self, error: &Diagnostic) -> Diagnostic {
        let name = self.unit.name;
        Diagnostic::new(Code::E0902, self.at, format!("the library's `{name}` conflicts with your declarations"))
            .label("named here")
            .note(format!("in it: {}", error.message))
            .help(format!("declare your own `{name}`, or rename your declaration that it uses"))
    }
}

/// The units that files name, and the names that they declare.
#[derive(Default)]
struct Uses {
    named: Vec<Named>,
    declared: FxHashSet<&'static str>,
    /// In a NAMESPACE, which others see by its name, or by USING.
    declared_in_spaces: FxHashSet<&'static str>,
    uses_spaces: bool,
}

impl Uses {
    fn read(&mut self, file: u16, source: &Source, habits: Habits<'_>, options: &Options) {
        let text = source.text.as_str();
        let is_of_studio = habits.is_of_studio;
        let tokens = lex_with(file, text, habits, Known::Never);
        let dialect = dialect_of(&tokens, options);
        let mut types = TypeBlock::default();
        let mut heads = Heads::default();
        for (at, kind) in tokens.kinds.iter().enumerate() {
            types.see(*kind);
            if *kind == Kind::VarGlobal {
                types.is_qualified = is_qualified_only(&tokens, at);
            }
            heads.enter(*kind);
            let word = |at: usize| tokens.places.get(at).and_then(|it| text.get(range(*it))).unwrap_or_default();
            if *kind != Kind::Name {
                continue;
            }
            let (start, end) = tokens.places[at];
            let before = at.checked_sub(1).map(|it| tokens.kinds[it]);
            heads.see(word(at), (1..5).map(|it| word(at + it)));
            types.spaces += u32::from(word(at).eq_ignore_ascii_case("NAMESPACE"));
            self.uses_spaces |= word(at).eq_ignore_ascii_case("USING");
            let hands_on_any = dialect == Dialect::Codesys && heads.hand_on_any(word(at), before);
            let begins_chart =
                word(at).eq_ignore_ascii_case(INITIAL_STEP) && tokens.kinds.get(at + 1) == Some(&Kind::Name);
            let any = hands_on_any.then_some(ANY);
            let is_edge = |it: &(&str, &str)| is_of_studio && word(at).eq_ignore_ascii_case(it.0);
            let edge = EDGES.iter().find(|it| is_edge(it)).map(|it| it.1);
            for name in any.into_iter().chain(edge).chain(CHARTS.into_iter().filter(|_| begins_chart)) {
                self.named.extend(unit(name, dialect).map(|unit| Named {
                    unit,
                    at: Span { file, start, end },
                    dialect,
                    is_qualified: false,
                    is_taken: false,
                }));
            }
            let is_space = is_system(word(at)) && tokens.kinds.get(at + 1) == Some(&Kind::Dot);
            let writes = word(at).eq_ignore_ascii_case("TcUnit") && is_write_protected(word(at + 2));
            let space = is_space.then(|| format!("{SYSTEM}.{}", word(at + 2)));
            let space = space.or_else(|| writes.then(|| WRITE_PROTECTED.to_owned()));
            let names_mocking = word(at).eq_ignore_ascii_case("Mocking") && before != Some(Kind::Dot)
                || word(at).eq_ignore_ascii_case("AxUnit") && word(at + 2).eq_ignore_ascii_case("Mocking");
            let name = if names_mocking { MOCKING } else { space.as_deref().unwrap_or(word(at)) };
            let Some(any) = units(name).next() else { continue };
            let unit = unit(name, dialect);
            // `Tc2_System.DRAND`, `Tc2_System.Global_Variables.PI`
            let is_after = |at: usize| at >= 2 && tokens.kinds[at - 1] == Kind::Dot;
            let is_of = |owner: usize| unit.is_some_and(|it| is_one_of(it.libraries, word(owner)));
            let owner = at.checked_sub(2).filter(|_| dialect == Dialect::Codesys && is_after(at));
            let list = owner.filter(|it| any.is_value() && is_after(*it) && word(*it).eq_ignore_ascii_case(LIST));
            let first = owner.filter(|it| is_of(*it)).or(list.map(|it| it - 2).filter(|it| is_of(*it))).unwrap_or(at);
            let outer = first
                .checked_sub(2)
                .filter(|it| first < at && is_after(first) && leads_to(dialect, word(*it), word(first)));
            let first = outer.unwrap_or(first);
            let before = first.checked_sub(1).map(|it| (tokens.kinds[it], word(it)));
            let after = tokens.kinds.get(at + 1).copied();
            let is_declared = match any.declares {
                // In Logix a tag may have the name of a type.
                Declares::Type if dialect == Dialect::Logix && types.is_list => false,
                Declares::Type | Declares::Function | Declares::Space => declares(before, after, &types),
                Declares::Value | Declares::Global => {
                    declares(before, after, &types) || types.declare_value(before, after)
                }
                Declares::Open => false,
            };
            if is_declared && types.spaces > 0 && any.declares != Declares::Space {
                self.declared_in_spaces.insert(any.name);
            } else if is_declared {
                self.declared.insert(any.name);
            } else if let Some(unit) = unit.filter(|it| names(it, before, after) || is_operand(it, &word, first)) {
                let is_qualified = first < at;
                self.named.push(Named { unit, at: Span { file, start, end }, dialect, is_qualified, is_taken: false });
            }
        }
    }

    /// Each once, with what it needs.
    fn needed(mut self) -> Vec<Named> {
        if self.uses_spaces {
            self.declared.extend(&self.declared_in_spaces);
        }
        let mut needed: Vec<Named> = Vec::new();
        let mut waiting: Vec<Named> = self.named.into_iter().rev().collect();
        while let Some(it) = waiting.pop() {
            let known = needed.iter().any(|known| known.unit.name == it.unit.name);
            let is_taken = self.declared.contains(it.unit.name);
            let stays = it.is_qualified && it.unit.has_own_name();
            if known || is_taken && !stays {
                continue;
            }
            needed.push(Named { is_taken, ..it });
            // What the library needs is the library's.
            let inner = |name: &str| Some(Named { unit: unit(name, it.dialect)?, is_qualified: true, ..it });
            waiting.extend(it.unit.needs().into_iter().filter_map(inner));
        }
        needed
    }
}

/// Whether a TYPE block is open, and how deep in structures.
#[derive(Default)]
struct TypeBlock {
    open: bool,
    structures: u32,
    /// It is a VAR_GLOBAL.
    is_list: bool,
    /// What it declares has no name without its list's.
    is_qualified: bool,
    /// After the colon of a declaration, up to its semicolon: types and values.
    in_value: bool,
    /// How many NAMESPACEs are open.
    spaces: u32,
}

impl TypeBlock {
    fn see(&mut self, kind: Kind) {
        match kind {
            Kind::Type | Kind::VarGlobal => {
                *self = Self { open: true, is_list: kind == Kind::VarGlobal, spaces: self.spaces, ..Self::default() };
            }
            Kind::Colon => self.in_value = true,
            Kind::Semicolon => self.in_value = false,
            Kind::EndType | Kind::EndVar => self.open = false,
            Kind::EndNamespace => self.spaces = self.spaces.saturating_sub(1),
            Kind::Struct => self.structures += 1,
            Kind::EndStruct => self.structures = self.structures.saturating_sub(1),
            _ => {}
        }
    }

    /// Whether a name between these tokens is a global variable, or a member of an enumeration.
    fn declare_value(&self, before: Option<(Kind, &str)>, after: Option<Kind>) -> bool {
        let before = before.map(|it| it.0);
        if !self.open || self.structures > 0 || self.is_qualified {
            false
        } else if self.is_list {
            !self.in_value && matches!(after, Some(Kind::Colon | Kind::Comma | Kind::At))
        } else {
            matches!(before, Some(Kind::OpenParen | Kind::Comma))
        }
    }
}

/// What has the variables that come next.
#[derive(Default)]
struct Heads {
    in_interface: bool,
    /// Its inputs of ANY are handed on, whatever its body says: a FUNCTION_BLOCK, or a METHOD without a body.
    is_one: bool,
}

impl Heads {
    fn enter(&mut self, kind: Kind) {
        match kind {
            Kind::FunctionBlock => self.is_one = true,
            Kind::Function | Kind::Program => self.is_one = false,
            Kind::EndInterface => (self.in_interface, self.is_one) = (false, false),
            _ => {}
        }
    }

    fn see<'t>(&mut self, word: &str, mut next: impl Iterator<Item = &'t str>) {
        if word.eq_ignore_ascii_case("INTERFACE") {
            self.in_interface = true;
        } else if word.eq_ignore_ascii_case("METHOD") {
            self.is_one = self.in_interface || next.any(|it| it.eq_ignore_ascii_case("ABSTRACT"));
        }
    }

    /// Whether a word is about an input of ANY that is handed on: `x.TypeClass`, `x : ANY`.
    fn hand_on_any(&self, word: &str, before: Option<Kind>) -> bool {
        match before {
            Some(Kind::Dot) => is_of_any(word),
            Some(Kind::Colon) => self.is_one && is_generic(word),
            _ => false,
        }
    }
}

/// Whether what a VAR_GLOBAL declares is named by its list alone: `{attribute 'qualified_only'}` is before it.
fn is_qualified_only(tokens: &Tokens<'_>, at: usize) -> bool {
    let from = at.checked_sub(1).map_or(0, |it| tokens.places[it].1);
    let here = tokens.pragmas.iter().filter(|it| (from..tokens.places[at].0).contains(&it.span.start));
    here.into_iter().any(|it| it.text.to_ascii_lowercase().contains("qualified_only"))
}

/// Whether a name between these tokens is declared there.
fn declares(before: Option<(Kind, &str)>, after: Option<Kind>, types: &TypeBlock) -> bool {
    let Some((before, word)) = before else { return false };
    match before {
        Kind::Function | Kind::FunctionBlock | Kind::Program => true,
        // `FUNCTION_BLOCK PUBLIC x`, `CLASS x`
        Kind::Name => {
            let words =
                ["PUBLIC", "INTERNAL", "PRIVATE", "PROTECTED", "FINAL", "ABSTRACT", "CLASS", "INTERFACE", "NAMESPACE"];
            words.iter().any(|it| word.eq_ignore_ascii_case(it))
        }
        _ => {
            let is_open = types.open && types.structures == 0 && !types.is_qualified;
            is_open && after == Some(Kind::Colon) && before != Kind::Comma
        }
    }
}

/// Whether a name between these tokens means the unit.
fn names(unit: &Unit, before: Option<(Kind, &str)>, after: Option<Kind>) -> bool {
    let is_after = |kind: Kind| before.is_some_and(|it| it.0 == kind);
    match unit.declares {
        Declares::Space | Declares::Open => !is_after(Kind::Dot),
        Declares::Function => after == Some(Kind::OpenParen) && !is_after(Kind::Dot),
        // A variable of the name, `PI : REAL`, is another one.
        Declares::Value => !is_after(Kind::Dot) && !matches!(after, Some(Kind::Colon | Kind::OpenParen | Kind::Dot)),
        Declares::Global => !is_after(Kind::Dot) && !matches!(after, Some(Kind::Colon | Kind::OpenParen)),
        Declares::Type => {
            let is_type = is_after(Kind::Colon) || is_after(Kind::Of) || is_after(Kind::To);
            let extends = before.is_some_and(|it| is_one_of(&["EXTENDS", "IMPLEMENTS"], it.1));
            let is_owner = after == Some(Kind::Dot) && !is_after(Kind::Dot) && unit.is_enumeration();
            let is_listed = unit.is_interface() && is_after(Kind::Comma);
            (is_type || extends || is_listed) && after != Some(Kind::OpenParen) || is_owner
        }
    }
}

/// Whether a name is that of a type whose size is asked for, or of which an instance is made.
fn is_operand<'t>(unit: &Unit, word: &impl Fn(usize) -> &'t str, at: usize) -> bool {
    let operator = at.checked_sub(2).map(word).unwrap_or_default();
    unit.declares == Declares::Type && is_one_of(&["SIZEOF", "XSIZEOF", "__NEW"], operator)
}

fn dialect_of(tokens: &Tokens<'_>, options: &Options) -> Dialect {
    let named = |text: &str| {
        let rest = text.trim().strip_prefix("dialect")?.trim();
        Dialect::named(rest.trim_matches(|it| it == '\'' || it == '"'))
    };
    let own = tokens.pragmas.iter().find_map(|it| named(it.text)).filter(|it| options.moved_from != Some(*it));
    own.unwrap_or(options.dialect)
}

/// Whether a text has a word that is the name of a unit in its dialect: the one that is given, or what it says itself.
fn mentions_any(text: &str, dialect: Dialect) -> bool {
    let mut names_dialect = None;
    words(text).filter(|it| may_name(it)).any(|it| {
        // A vendor's declaration is of few dialects.
        let is_elsewhere = units(it).next().is_some() && unit(it, dialect).is_none();
        !is_elsewhere || *names_dialect.get_or_insert_with(|| text.contains("dialect"))
    })
}

/// The words of a text that are as long as some unit's name with the same first and last letter.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let bytes = text.as_bytes();
    let mut at = 0;
    core::iter::from_fn(move || {
        while let Some(first) = bytes.get(at) {
            let start = at;
            at += 1;
            if !is_word(*first) {
                continue;
            }
            while bytes.get(at).is_some_and(|it| is_word(*it)) {
                at += 1;
            }
            if index::may_be(&LENGTHS, *first, bytes[at - 1], at - start) {
                return text.get(start..at);
            }
        }
        None
    })
}

/// Whether a word may be a unit's name, or what its name begins with.
fn may_name(word: &str) -> bool {
    is_one_of(&ASKING, word) || units(word).next().is_some() || is_generic(word)
}

/// By a table: each character of a program is looked at.
fn is_word(byte: u8) -> bool {
    const WORD: [bool; 256] = {
        let mut word = [false; 256];
        let mut at = 0;
        while at < 128 {
            word[at] = (at as u8).is_ascii_alphanumeric() || at as u8 == b'_';
            at += 1;
        }
        word
    };
    WORD[usize::from(byte)]
}

/// ANY, ANY_INT and the like.
fn is_generic(word: &str) -> bool {
    Class::ALL.iter().any(|it| word.eq_ignore_ascii_case(it.name()))
}

/// Whether a word is the name of a member of what is handed on for an input of ANY.
fn is_of_any(word: &str) -> bool {
    OF_ANY.iter().any(|it| word.eq_ignore_ascii_case(it))
}

fn is_system(word: &str) -> bool {
    word.eq_ignore_ascii_case(SYSTEM)
}

fn range((start, end): (u32, u32)) -> core::ops::Range<usize> {
    let offset = |it: u32| usize::try_from(it).unwrap_or(usize::MAX);
    offset(start)..offset(end)
}
