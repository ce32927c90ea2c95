//! Direct addresses. What lies at an address is one field of the globals, whoever declares it:
//! a global, several PROGRAMs, the instances of one PROGRAM, or a body that names the address.

use super::types::Resolved;
use super::{Declarations, GlobalSlot};
use crate::ast::{self, PouKind, VarKind};
use crate::check;
use crate::dialect::Dialect;
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashMap;
use staunch_ir::{Address, Area, Const, Elementary, Field, Place, Retain, Section, Type};

#[derive(Clone, Copy, Debug)]
enum Storage {
    /// A declared global variable.
    Global(usize),
    /// A hidden field of the globals.
    Hidden(usize),
}

/// What the declarations of one address say together of its start.
#[derive(Debug, Default)]
struct Start {
    initial: Option<(Const, Span)>,
    kept: bool,
}

/// A declaration of an address, or its use in a body.
#[derive(Clone, Copy, Debug)]
struct Use {
    address: Address,
    /// All bits, also those of an array's other elements.
    bits: u64,
    span: Span,
    /// The scope in which a name is declared: a POU's span, or that of nothing for the globals.
    scope: Option<Span>,
}

/// Where the addresses are kept.
#[derive(Debug, Default)]
pub(crate) struct Addresses {
    storage: FxHashMap<Address, Storage>,
    starts: FxHashMap<Address, Start>,
    uses: Vec<Use>,
    /// The slots of the globals that have a field of their own: not a second name of an address.
    own_fields: Vec<usize>,
}

impl Addresses {
    /// The field of the global in slot `at`, unless it is another name of an earlier one.
    pub fn field_of_global(&self, at: usize) -> Option<usize> {
        self.own_fields.binary_search(&at).ok()
    }

    pub fn global_of_field(&self, field: usize) -> Option<usize> {
        self.own_fields.get(field).copied()
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

/// Finds the globals at addresses, and the addresses that `bodies`, those of the POUs, name.
pub(super) fn collect<'s>(declarations: &mut Declarations<'s>, bodies: &[Vec<ast::Statement<'s>>]) -> Addresses {
    let mut addresses = Addresses::default();
    for (at, GlobalSlot { decl, .. }) in declarations.globals.iter().enumerate() {
        let first = decl.address.and_then(|it| parse(it.text)).map(|it| addresses.storage.entry(it));
        let is_own = match first {
            Some(entry) => matches!(entry.or_insert(Storage::Global(at)), Storage::Global(first) if *first == at),
            None => true,
        };
        if is_own {
            addresses.own_fields.push(at);
        }
    }
    let has_addresses: Vec<_> = declarations.sources.files().iter().map(|it| it.text.contains('%')).collect();
    for (pou, body) in declarations.pous.iter().zip(bodies) {
        if has_addresses[usize::from(pou.ast.span.file)] {
            collect_body(body, &mut addresses.uses);
        }
    }
    addresses
}

fn collect_body(body: &[ast::Statement<'_>], uses: &mut Vec<Use>) {
    ast::each_expr(body, &mut |expr| {
        if let ast::ExprKind::Address(name) = &expr.kind
            && let Some(address) = parse(name.text)
        {
            uses.push(Use { address, bits: u64::from(address.width), span: name.span, scope: None });
        }
    });
}

/// Reports what shares bits, when all declarations are known. One area is addressed in several sizes,
/// so that `%MB1` is a part of `%MW0`.
pub(super) fn report_overlaps(declarations: &mut Declarations<'_>) {
    let mut uses = std::mem::take(&mut declarations.addresses.uses);
    uses.sort_by_key(|it| (it.address, it.span.file, it.span.start));
    report_second_names(declarations, &uses);
    let mut widest: Option<Use> = None;
    for it in uses {
        let end = it.address.bit + it.bits;
        let before = widest.filter(|w| w.address.area == it.address.area && it.address.bit < w.address.bit + w.bits);
        if let Some(other) = before
            && other.address != it.address
        {
            report_overlap(declarations, &it, &other);
        }
        if widest.is_none_or(|w| (w.address.area, w.address.bit + w.bits) < (it.address.area, end)) {
            widest = Some(it);
        }
    }
}

fn report_overlap(declarations: &mut Declarations<'_>, it: &Use, other: &Use) {
    let error = |code| Diagnostic::new(code, it.span, "two variables lie on overlapping addresses");
    let diagnostic = if !are_registers(declarations.dialect(it.span), other.address, it.address) {
        error(Code::E0410).label("this address shares bits with another one, which is not supported yet")
    } else if it.address.area == Area::Memory {
        error(Code::W0410).label("this address shares bits with another one, but is kept apart from it")
    } else {
        return;
    };
    declarations.report(diagnostic.other(other.span, "the other address"));
}

/// Reports two names that one scope has for one address.
fn report_second_names(declarations: &mut Declarations<'_>, uses: &[Use]) {
    let mut declared: FxHashMap<(Address, Span), Span> = FxHashMap::default();
    for it in uses {
        let Some(first) = it.scope.and_then(|scope| declared.insert((it.address, scope), it.span)) else { continue };
        // Two names in one declaration are refused by themselves.
        if first == it.span {
            continue;
        }
        let text = declarations.sources.text(it.span);
        declarations.report(
            Diagnostic::new(Code::W0411, it.span, format!("`{text}` has two names"))
                .label("what is assigned to one of them is read from the other")
                .other(first, "the other one")
                .help("give this variable an address of its own, or use one name"),
        );
    }
}

/// OpenPLC keeps each size apart, so that %IX0.0 and %IW0 are two registers.
fn are_registers(dialect: Dialect, a: Address, b: Address) -> bool {
    dialect == Dialect::Iec && a.width != b.width
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

impl<'s> Declarations<'s> {
    /// Reports an address that a declaration gives to several names.
    pub fn check_one_name(&mut self, decl: &ast::VarDecl<'s>) {
        if let (Some(address), [_, second, ..]) = (decl.address, decl.names.as_slice()) {
            self.report(
                Diagnostic::new(Code::E0409, second.span, "one address has one variable")
                    .label("a second name")
                    .other(address.span, "for this address")
                    .help("declare each name by itself: `a AT %IX0.0 : BOOL; b AT %IX0.1 : BOOL;`"),
            );
        }
    }

    /// The address that a declaration names.
    pub fn address(&mut self, name: ast::Name<'s>) -> Option<Address> {
        let address = parse(name.text);
        if address.is_none() {
            let message = if name.text.ends_with('*') {
                format!("`{}` is not bound to an address", name.text)
            } else if is_hierarchical(name.text) {
                format!("`{}` has more parts than are supported yet", name.text)
            } else {
                format!("`{}` is not a direct address", name.text)
            };
            self.report(
                Diagnostic::new(Code::E0409, name.span, message)
                    .help("write an area (I, Q, M), a size (X, B, W, D, L) and a place: `%IX0.0`, `%QW3`"),
            );
        }
        address
    }

    /// Reports an address where a declaration has none.
    pub fn check_address_here(&mut self, kind: Option<PouKind>, block: &ast::VarBlock<'s>, decl: &ast::VarDecl<'s>) {
        let Some(address) = decl.address else { return };
        let in_blocks = self.dialect(address.span) == Dialect::Codesys;
        let global = "declare it in VAR_GLOBAL and name it in VAR_EXTERNAL here";
        let (message, help) = match (kind, block.kind) {
            (_, VarKind::Temp) => ("a VAR_TEMP has no address", "declare it in VAR"),
            (_, VarKind::InOut) => {
                ("a VAR_IN_OUT has no address", "it stands for a variable of the caller: delete `AT`")
            }
            (_, VarKind::External) => ("the address belongs to the global variable", "delete `AT` here"),
            _ if block.constant.is_some() => ("a CONSTANT has no address", "delete CONSTANT, or the address"),
            (Some(PouKind::Program) | None, _) => return,
            (Some(PouKind::FunctionBlock), VarKind::Var | VarKind::Stat) if in_blocks => return,
            (Some(PouKind::FunctionBlock | PouKind::Function), _) => {
                ("only a PROGRAM's variables and globals have an address", global)
            }
        };
        self.report(Diagnostic::new(Code::E0409, address.span, message).help(help));
    }

    /// The variable at the address of a declaration; the inner `None` says that it was refused.
    pub fn located(
        &mut self,
        pou: Option<ast::Name<'s>>,
        block: &ast::VarBlock<'s>,
        decl: &ast::VarDecl<'s>,
        name: ast::Name<'s>,
        resolved: &Resolved,
    ) -> Option<Option<Place>> {
        let declared = decl.address?;
        let address = parse(declared.text);
        let found = address.and_then(|it| self.addresses.storage.get(&it).copied());
        let place = match found {
            Some(Storage::Global(at)) => {
                let Some(global) = self.global(at) else { return Some(None) };
                self.same_type(resolved.ty, global.resolved.ty, declared, Some(global.name))
                    .then(|| global.place.clone())
            }
            Some(Storage::Hidden(at)) => {
                let (ty, first) = (self.hidden.field_type(at), self.hidden.declared(at));
                self.same_type(resolved.ty, ty, declared, first).then(|| self.hidden_place(at))
            }
            None => {
                let address = self.address(declared)?;
                Some(self.new_storage(address, resolved, pou.map_or("Globals", |it| it.text), name))
            }
        };
        if place.is_some() {
            self.register_address(pou, block, decl, resolved);
        }
        Some(place)
    }

    /// Takes note of a declaration at an address; `pou` is `None` for a global.
    pub fn register_address(
        &mut self,
        pou: Option<ast::Name<'s>>,
        block: &ast::VarBlock<'s>,
        decl: &ast::VarDecl<'s>,
        resolved: &Resolved,
    ) {
        let Some(name) = decl.address else { return };
        let Some(address) = self.address(name) else { return };
        let bits = self.check_width(address, resolved, name.span);
        // What has no other name than its address is not one more name for it.
        let is_named = decl.names.iter().all(|it| !it.text.starts_with('%'));
        let scope = is_named.then(|| pou.map_or_else(Span::default, |it| it.span));
        let start = self.addresses.starts.entry(address).or_default();
        start.kept |= super::scope::is_declared_retain(block);
        let given = decl.initial.as_ref().map(|it| (resolved.initial.clone(), it.span));
        if let (Some((first, other)), Some((value, span))) = (&start.initial, &given)
            && first != value
        {
            let error = Diagnostic::new(Code::E0409, *span, format!("`{}` has two initial values", name.text))
                .label("another value for the same address")
                .other(*other, "the first one")
                .help("give the value in one of the declarations");
            self.report(error);
            return;
        }
        start.initial = start.initial.take().or(given);
        self.addresses.uses.push(Use { address, bits, span: name.span, scope });
    }

    fn same_type(&mut self, ours: Type, theirs: Type, name: ast::Name<'s>, first: Option<ast::Name<'s>>) -> bool {
        if ours == theirs {
            return true;
        }
        let (ours, theirs) = (self.program.type_name(ours), self.program.type_name(theirs));
        let mut error = Diagnostic::new(Code::E0409, name.span, format!("`{}` has two types", name.text))
            .label(format!("{ours} here"));
        if let Some(first) = first {
            error = error.other(first.span, format!("{theirs} here"));
        }
        self.report(error);
        false
    }

    fn check_width(&mut self, address: Address, resolved: &Resolved, span: Span) -> u64 {
        let bits = match resolved.ty {
            Type::Elementary(Elementary::Bool) => 1,
            other => self.size_of(other).saturating_mul(8),
        };
        let fits = bits == u64::from(address.width)
            || (matches!(resolved.ty, Type::Array(_)) && bits % u64::from(address.width) == 0);
        if !fits {
            let ty = self.program.type_name(resolved.ty);
            self.report(
                Diagnostic::new(Code::E0409, span, format!("{ty} does not fit this address"))
                    .label(format!("the address is {} bits wide, {ty} is {bits}", address.width)),
            );
            return u64::from(address.width);
        }
        bits
    }

    /// Gives the addresses that only bodies name their storage.
    pub fn declare_used_addresses(&mut self) {
        let spans: Vec<_> = self.addresses.uses.iter().map(|it| (it.address, it.span)).collect();
        for (address, span) in spans {
            if !self.addresses.storage.contains_key(&address) {
                let elementary = match address.width {
                    1 => Elementary::Bool,
                    8 => Elementary::Byte,
                    16 => Elementary::Word,
                    32 => Elementary::Dword,
                    _ => Elementary::Lword,
                };
                let resolved = Resolved::plain(Type::Elementary(elementary));
                let name = ast::Name { text: self.sources.text(span), span };
                self.new_storage(address, &resolved, "Globals", name);
            }
        }
    }

    /// The variable at an address that a body names directly.
    pub fn direct_address(&mut self, name: ast::Name<'s>) -> Option<Place> {
        let address = self.address(name)?;
        match self.addresses.storage.get(&address).copied() {
            Some(Storage::Global(at)) => Some(self.global(at)?.place.clone()),
            Some(Storage::Hidden(at)) => Some(self.hidden_place(at)),
            None => {
                self.report(check::not_constant(name.span));
                None
            }
        }
    }

    fn new_storage(&mut self, address: Address, resolved: &Resolved, owner: &str, name: ast::Name<'s>) -> Place {
        let is_named = !name.text.starts_with('%');
        let mut spelling = field_name(name.text);
        if self.is_global_name(&spelling) {
            spelling = format!("{owner}_{spelling}");
        }
        let field = Field {
            name: spelling,
            ty: resolved.ty,
            initial: resolved.initial.clone(),
            section: Section::Global,
            retain: Retain::Inherited,
            constant: false,
            address: Some(address),
            doc: None,
            location: if is_named { self.location(name.span) } else { staunch_ir::Location::default() },
        };
        let at = self.add_hidden(field, is_named.then_some(name));
        self.addresses.storage.insert(address, Storage::Hidden(at));
        self.hidden_place(at)
    }
}

/// The name of a field: an address that has no other name is called by its letters and digits.
pub(super) fn field_name(name: &str) -> String {
    name.trim_start_matches('%').replace('.', "_")
}

/// `%IW0.1`, `%QX1.2.3`: an address through the parts of a station.
fn is_hierarchical(text: &str) -> bool {
    let bits = matches!(text.as_bytes().get(2), Some(b'X' | b'x' | b'0'..=b'9'));
    text.matches('.').count() > usize::from(bits)
}
