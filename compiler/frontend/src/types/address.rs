//! Direct addresses, and their storage.

use crate::{Code, Diagnostic, Span, ast};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Address, Area, Const, Field, Module, Retain, Type};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
    /// The type that it is declared with; a body takes what is declared.
    pub ty: Option<Type>,
    /// The scope in which a name is declared: a POU's span, or that of nothing for the globals.
    pub scope: Option<Span>,
}

/// Where the addresses are kept.
#[derive(Debug, Default)]
pub(crate) struct Addresses {
    pub storage: FxHashMap<Address, Storage>,
    /// What is declared at an address with another type than its storage: some bits of that.
    pub retyped: FxHashMap<(Address, Type), usize>,
    /// The fields of globals among these: what is shown of them has the global's name.
    pub second_names: FxHashSet<usize>,
    pub starts: FxHashMap<(Address, Type), Start>,
    pub uses: Vec<Use>,
    /// The slots of the globals that have a field of their own: not a second name of an address.
    pub own_fields: Vec<usize>,
}

impl Addresses {
    /// The storage at an address, as a variable of this type, or of the first one declared.
    pub fn storage_of(&self, address: Address, ty: Option<Type>) -> Option<Storage> {
        let retyped = ty.and_then(|ty| self.retyped.get(&(address, ty)));
        retyped.map(|at| Storage::Hidden(*at)).or_else(|| self.storage.get(&address).copied())
    }

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

    /// The storage at an address starts with the value that one of its declarations gives it.
    pub fn complete(&self, field: &mut Field) {
        let Some(start) = field.address.and_then(|it| self.starts.get(&(it, field.ty))) else { return };
        if let Some((initial, _)) = &start.initial {
            field.initial = initial.clone();
        }
        if start.kept {
            field.retain = Retain::Kept;
        }
    }
}

/// `%IX1.3`, `%QW10`, `%M5.1`, and through the levels of a station, `%IW1.2.3`. `None` for `%I*` and for text that is not an address.
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
    let numbers: Option<Vec<u32>> = numbers.split('.').map(|it| it.parse().ok()).collect();
    let (levels, bit) = match (width, numbers?.as_slice()) {
        (1, [byte]) => (Module::default(), u64::from(*byte) * 8),
        // See `beyond`.
        (1, [byte, bit]) => (Module::default(), u64::from(*byte) * 8 + u64::from(*bit)),
        (1, [levels @ .., byte, bit]) if *bit < 8 => (Module::new(levels)?, u64::from(*byte) * 8 + u64::from(*bit)),
        (2.., [levels @ .., at]) => (Module::new(levels)?, u64::from(*at) * u64::from(width)),
        _ => return None,
    };
    Some(Address { area, module: levels, bit, width })
}

/// Of `%QX0.16`, whose byte has no such bit, the address that it is in OpenPLC: `%QX2.0`.
pub(crate) fn beyond(text: &str) -> Option<String> {
    let (byte, bit) = text.split_once('.')?;
    let bit: u32 = bit.parse().ok().filter(|it| *it >= 8)?;
    let area = byte.trim_end_matches(|it: char| it.is_ascii_digit());
    let byte: u32 = byte[area.len()..].parse().ok()?;
    let is_bit = area.len() == 2 || area.ends_with(['X', 'x']);
    is_bit.then(|| format!("{area}{}.{}", byte.saturating_add(bit / 8), bit % 8))
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
            .help(format!(
                "write an address, `{0}X0.0`; a variable of an instance can have it from the CONFIGURATION: \
                 `VAR_CONFIG Run.variable AT {0}X0.0 : BOOL; END_VAR`",
                &name.text[..2]
            ));
    }
    let numbers = name.text.matches('.').count() + 1;
    let mut parts = name.text.split('.').skip(1);
    if let Some(part) = parts.find(|it| it.contains(|it: char| !it.is_ascii_digit())) {
        return Diagnostic::new(Code::E0409, name.span, format!("`{}` is not a direct address", name.text))
            .label(format!("`{part}` is not a number"))
            .help("expected numbers with points between them after the size: `%IX0.0`, `%IW1.2.3`");
    }
    let is_bit =
        name.text.get(2..3).is_some_and(|it| it.eq_ignore_ascii_case("X") || it.bytes().all(|it| it.is_ascii_digit()));
    let last = name.text.rsplit('.').next().and_then(|it| it.parse::<u32>().ok());
    if is_bit && numbers > 2 && last.is_some_and(|it| it > 7) {
        return Diagnostic::new(Code::E0409, name.span, format!("`{}` is beyond its byte", name.text))
            .label("the last number is a bit, 0 to 7, also after levels")
            .help("Beremiz numbers the points of a device there: write them by bytes and bits, `%QX0.0.1.7`, then `%QX0.0.2.0`");
    }
    if let (Some(meant), true) = (beyond(name.text), numbers == 2) {
        return Diagnostic::new(Code::E0409, name.span, format!("`{}` is beyond its byte", name.text))
            .label("the bits of a byte are 0 to 7")
            .in_this_dialect()
            .help(format!("the bit after bit 7 is in the next byte: `{meant}`"));
    }
    let message = if numbers > Module::LEVELS + 1 && !name.text.contains("..") {
        format!(
            "`{}` has {numbers} numbers, but at most {} levels above the place are supported",
            name.text,
            Module::LEVELS
        )
    } else {
        format!("`{}` is not a direct address", name.text)
    };
    Diagnostic::new(Code::E0409, name.span, message)
        .help("write an area (I, Q, M), a size (X, B, W, D, L) and a place: `%IX0.0`, `%QW3`")
}

/// `%IX0.0`: the program reads it alone.
pub(crate) fn is_input(address: ast::Name<'_>) -> bool {
    address.text.get(1..2).is_some_and(|it| it.eq_ignore_ascii_case("I"))
}
