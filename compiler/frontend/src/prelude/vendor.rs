//! What vendors' libraries declare: each library is a file of declarations, in which a unit is found by its name. The
//! tables are made when the compiler is compiled, and hold places in the texts: a program that names no unit pays nothing.

use crate::dialect::Dialect;

/// The declarations of a library.
struct Library {
    names: &'static [&'static str],
    dialects: &'static [Dialect],
    text: &'static str,
}

macro_rules! libraries {
    ($($file:literal [$($dialect:ident)+] [$($name:literal)+];)*) => {
        &[$(Library {
            names: &[$($name),+],
            dialects: &[$(Dialect::$dialect),+],
            text: include_str!(concat!("vendor/", $file, ".st")),
        }),*]
    };
}

static LIBRARIES: &[Library] = TABLE;
const TABLE: &[Library] = libraries! {
    "tc2_system" [Codesys] ["Tc2_System"];
    "tc2_utilities" [Codesys] ["Tc2_Utilities"];
    "tc2_mc2" [Codesys] ["Tc2_MC2"];
    "tc2_ethercat" [Codesys] ["Tc2_EtherCAT"];
    "tc2_serialcom" [Codesys] ["Tc2_SerialCom"];
    "tc2_tcpip" [Codesys] ["Tc2_TcpIp"];
    "tc2_controllertoolbox" [Codesys] ["Tc2_ControllerToolbox"];
    "tc2_mc2_drive" [Codesys] ["Tc2_MC2_Drive"];
    "tc2_iofunctions" [Codesys] ["Tc2_IoFunctions"];
    "tc2_modbussrv" [Codesys] ["Tc2_ModbusSrv"];
    "siemens" [Siemens] ["S7"];
    "tc3_module" [Codesys] ["Tc3_Module"];
    "tc3_eventlogger" [Codesys] ["Tc3_EventLogger"];
    "tc3_jsonxml" [Codesys] ["Tc3_JsonXml"];
    "tc3_iotbase" [Codesys] ["Tc3_IotBase"];
};

/// Where a unit is: bytes of a library's text.
#[derive(Clone, Copy)]
struct Entry {
    library: usize,
    kind: Kind,
    name: (usize, usize),
    text: (usize, usize),
    /// Of an enumerator, the number of its type.
    of: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Type,
    Enumeration,
    Interface,
    Function,
    Value,
    Enumerator,
}

/// What each line begins with that begins a unit.
const HEADS: [(&[u8], Kind); 5] = [
    (b"TYPE ", Kind::Type),
    (b"FUNCTION_BLOCK ", Kind::Type),
    (b"INTERFACE ", Kind::Interface),
    (b"FUNCTION ", Kind::Function),
    (b"VAR_GLOBAL CONSTANT ", Kind::Value),
];
/// A line with an attribute belongs to the unit after it.
const ATTRIBUTE: &[u8] = b"{";
const QUALIFIED: &[u8] = b"{attribute 'qualified_only'}";
/// An enumerator is alone in its line.
const INDENT: &[u8] = b"    ";

pub(super) const COUNT: usize = parsed::<0>().1;
static ENTRIES: [Entry; COUNT] = parsed::<COUNT>().0;

/// A unit, and where its text is.
pub(super) struct Declaration {
    pub name: &'static str,
    /// Of an enumerator, nothing.
    pub text: &'static str,
    pub kind: Kind,
    pub dialects: &'static [Dialect],
    pub libraries: &'static [&'static str],
    /// Of an enumerator, its type.
    pub of: Option<&'static str>,
}

/// The declaration with this number, from 0.
pub(super) fn declaration(number: usize) -> Option<Declaration> {
    let entry = ENTRIES.get(number)?;
    let library = LIBRARIES.get(entry.library)?;
    let part = |(start, end): (usize, usize)| library.text.get(start..end).unwrap_or_default();
    let of = (entry.kind == Kind::Enumerator).then(|| ENTRIES.get(entry.of).map(|it| part(it.name))).flatten();
    Some(Declaration {
        name: part(entry.name),
        text: part(entry.text),
        kind: entry.kind,
        dialects: library.dialects,
        libraries: library.names,
        of,
    })
}

/// The bytes of the text of a declaration's library, and where its name is in them.
pub(super) const fn name_at(number: usize) -> (&'static [u8], usize, usize) {
    let entry = &ENTRIES[number];
    (TABLE[entry.library].text.as_bytes(), entry.name.0, entry.name.1)
}

/// The units of all libraries, up to `N`, and how many there are.
const fn parsed<const N: usize>() -> ([Entry; N], usize) {
    let none = Entry { library: 0, kind: Kind::Type, name: (0, 0), text: (0, 0), of: 0 };
    let mut all = Entries { entries: [none; N], count: 0 };
    let mut library = 0;
    while library < TABLE.len() {
        all = with_library(all, library);
        library += 1;
    }
    (all.entries, all.count)
}

struct Entries<const N: usize> {
    entries: [Entry; N],
    count: usize,
}

const fn with_library<const N: usize>(mut all: Entries<N>, library: usize) -> Entries<N> {
    let text = TABLE[library].text.as_bytes();
    let (mut at, mut begin, mut last, mut is_qualified, mut in_enumeration) = (0, None, None, false, false);
    while at < text.len() {
        let end = line_end(text, at);
        let start = match begin {
            Some(start) => start,
            None => at,
        };
        if starts_with(text, at, ATTRIBUTE) {
            begin = Some(start);
            is_qualified |= starts_with(text, at, QUALIFIED);
        } else if let Some((kind, head)) = kind_at(text, at) {
            close(&mut all, last, start);
            in_enumeration = end > at && text[end - 1] == b'(';
            last = Some(all.count);
            let kind = if in_enumeration { Kind::Enumeration } else { kind };
            push(&mut all, Entry { library, kind, name: word(text, at + head), text: (start, text.len()), of: 0 });
            in_enumeration &= !is_qualified;
            (begin, is_qualified) = (None, false);
        } else if let (true, true, Some(of)) = (in_enumeration, starts_with(text, at, INDENT), last) {
            let name = word(text, at + INDENT.len());
            push(&mut all, Entry { library, kind: Kind::Enumerator, name, text: (end, end + 1), of });
        }
        at = end + 1;
    }
    all
}

const fn push<const N: usize>(all: &mut Entries<N>, entry: Entry) {
    if all.count < N {
        all.entries[all.count] = entry;
    }
    all.count += 1;
}

/// A unit ends where the next one begins.
const fn close<const N: usize>(all: &mut Entries<N>, last: Option<usize>, end: usize) {
    if let Some(last) = last
        && last < N
    {
        all.entries[last].text.1 = end;
    }
}

const fn kind_at(text: &[u8], at: usize) -> Option<(Kind, usize)> {
    let mut head = 0;
    while head < HEADS.len() {
        if starts_with(text, at, HEADS[head].0) {
            return Some((HEADS[head].1, HEADS[head].0.len()));
        }
        head += 1;
    }
    None
}

const fn starts_with(text: &[u8], at: usize, prefix: &[u8]) -> bool {
    let mut length = 0;
    while length < prefix.len() {
        if at + length >= text.len() || text[at + length] != prefix[length] {
            return false;
        }
        length += 1;
    }
    true
}

const fn line_end(text: &[u8], mut at: usize) -> usize {
    while at < text.len() && text[at] != b'\n' {
        at += 1;
    }
    at
}

const fn word(text: &[u8], start: usize) -> (usize, usize) {
    let mut end = start;
    while end < text.len() && (text[end].is_ascii_alphanumeric() || text[end] == b'_') {
        end += 1;
    }
    (start, end)
}
