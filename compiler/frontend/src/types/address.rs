//! Direct addresses, and where what lies at them is kept.

use crate::{Code, Diagnostic, Span, ast};
use rustc_hash::FxHashMap;
use staunch_ir::{Address, Area, Const, Field, Retain};

#[derive(Clone, Copy, Debug)]
pub(crate) enum Storage {
    /// A declared global variable.
    Global(usize),
    /// A hidden field of the globals.
    Hidden(usize),
}

/// What the declarations of one address say together of its start.
#[derive(Debug, Default)]
pub(crate) struct Start {
    pub initial: Option<(Const, Span)>,
    pub kept: bool,
}

/// A declaration of an address, or its use in a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Use {
    pub address: Address,
    /// All bits, also those of an array's other elements.
    pub bits: u64,
    pub span: Span,
    /// The scope in which a name is declared: a POU's span, or that of nothing for the globals.
    pub scope: Option<Span>,
}

/// Where the addresses are kept.
#[derive(Debug, Default)]
pub(crate) struct Addresses {
    pub storage: FxHashMap<Address, Storage>,
    pub starts: FxHashMap<Address, Start>,
    pub uses: Vec<Use>,
    /// The slots of the globals that have a field of their own: not a second name of an address.
    pub own_fields: Vec<usize>,
}

impl Addresses {
    /// The field of the global in slot `at`, unless it is another name of an earlier one.
    pub fn field_of_global(&self, at: usize) -> Option<usize> {
        self.own_fields.binary_search(&at).ok()
    }

    /// The global that a name of an address means.
    pub fn global_at(&self, name: ast::Name<'_>) -> Option<usize> {
        match self.storage.get(&parse(name.text)?)? {
            Storage::Global(at) => Some(*at),
            Storage::Hidden(_) => None,
        }
    }

    /// The globals with a field of their own.
    pub fn own_fields(&self) -> &[usize] {
        &self.own_fields
    }

    /// What lies at an address starts with the value that one of its declarations gives it.
    pub fn complete(&self, field: &mut Field) {
        let Some(start) = field.address.and_then(|it| self.starts.get(&it)) else { return };
        if let Some((initial, _)) = &start.initial {
            field.initial = initial.clone();
        }
        if start.kept {
            field.retain = Retain::Kept;
        }
    }
}

/// `%IX1.3`, `%QW10`, `%M5.1`. `None` for `%I*` and for what is no address.
pub(crate) fn parse(text: &str) -> Option<Address> {
    let text = text.strip_prefix('%')?.to_ascii_uppercase();
    let area = match text.chars().next()? {
        'I' => Area::Input,
        'Q' => Area::Output,
        'M' => Area::Memory,
        _ => return None,
    };
    let rest = &text[1..];
    let (width, numbers): (u8, &str) = match rest.chars().next()? {
        'X' => (1, &rest[1..]),
        'B' => (8, &rest[1..]),
        'W' => (16, &rest[1..]),
        'D' => (32, &rest[1..]),
        'L' => (64, &rest[1..]),
        _ => (1, rest),
    };
    let numbers: Option<Vec<u64>> = numbers.split('.').map(|it| it.parse::<u32>().ok().map(u64::from)).collect();
    let bit = match (width, numbers?.as_slice()) {
        (1, [byte]) => byte * 8,
        (1, [byte, bit]) if *bit < 8 => byte * 8 + bit,
        (width, [at]) if width > 1 => at * u64::from(width),
        _ => return None,
    };
    Some(Address { area, bit, width })
}

/// The name of a field: an address that has no other name is called by its letters and digits.
pub(crate) fn field_name(name: &str) -> String {
    name.trim_start_matches('%').replace('.', "_")
}

/// What is wrong with an address that cannot be read.
pub(crate) fn wrong(name: ast::Name<'_>) -> Diagnostic {
    if name.text.ends_with('*') {
        return Diagnostic::new(Code::E0409, name.span, format!("`{}` is not bound to an address", name.text))
            .label("a VAR_CONFIG gives the address")
            .help("bind it in the CONFIGURATION: `VAR_CONFIG run.variable AT %IX0.0 : BOOL; END_VAR`");
    }
    let message = if is_hierarchical(name.text) {
        format!("`{}` has more parts than are supported yet", name.text)
    } else {
        format!("`{}` is not a direct address", name.text)
    };
    Diagnostic::new(Code::E0409, name.span, message)
        .help("write an area (I, Q, M), a size (X, B, W, D, L) and a place: `%IX0.0`, `%QW3`")
}

/// `%IW0.1`, `%QX1.2.3`: an address through the parts of a station.
fn is_hierarchical(text: &str) -> bool {
    let bits = matches!(text.as_bytes().get(2), Some(b'X' | b'x' | b'0'..=b'9'));
    text.matches('.').count() > usize::from(bits)
}
