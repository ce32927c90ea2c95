//! Direct addresses. A variable with an address of its own is an ordinary variable that the map
//! lists with it; an address that several places name is one shared variable among the globals.

use super::types::Resolved;
use super::{Declarations, GlobalSlot};
use crate::ast;
use crate::dialect::Dialect;
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashMap;
use staunch_ir::{Address, Area, Elementary, Field, Place, Section, Type};

#[derive(Clone, Copy, Debug)]
enum Storage {
    /// A declared global variable.
    Global(usize),
    /// A hidden field of the globals; `None` until its type is known.
    Hidden(Option<usize>),
}

/// Where the shared addresses are kept.
#[derive(Debug, Default)]
pub(crate) struct Addresses {
    shared: FxHashMap<Address, Storage>,
}

#[derive(Clone, Copy)]
enum Use {
    Global(usize),
    Local,
    Direct,
}

/// Finds which addresses are shared; `bodies` are those of the POUs.
pub(super) fn collect<'s>(declarations: &mut Declarations<'s>, bodies: &[Vec<ast::Statement<'s>>]) -> Addresses {
    let mut uses: Vec<(Address, Span, Use)> = Vec::new();
    for at in 0..declarations.globals.len() {
        let GlobalSlot { decl, .. } = declarations.globals[at];
        let Some(name) = decl.address else { continue };
        if let Some(address) = parse(name.text) {
            uses.push((address, name.span, Use::Global(at)));
        }
    }
    let has_addresses: Vec<_> = declarations.sources.files().iter().map(|it| it.text.contains('%')).collect();
    for (pou, body) in declarations.pous.iter().zip(bodies) {
        if has_addresses[usize::from(pou.ast.span.file)] {
            collect_pou(pou.ast, body, &mut uses);
        }
    }
    uses.sort_by_key(|(address, span, _)| (*address, span.file, span.start));
    report_overlaps(declarations, &uses);
    let mut shared = FxHashMap::default();
    for group in uses.chunk_by(|a, b| a.0 == b.0) {
        if let Some(storage) = storage_of(group) {
            shared.insert(group[0].0, storage);
        }
    }
    Addresses { shared }
}

fn storage_of(group: &[(Address, Span, Use)]) -> Option<Storage> {
    let global = group.iter().find_map(|(_, _, it)| match it {
        Use::Global(at) => Some(*at),
        Use::Local | Use::Direct => None,
    });
    let direct = group.iter().any(|(_, _, it)| matches!(it, Use::Direct));
    match global {
        Some(at) => Some(Storage::Global(at)),
        None if direct || group.len() > 1 => Some(Storage::Hidden(None)),
        None => None,
    }
}

/// One area is addressed in several sizes, so that `%MB1` is a part of `%MW0`.
fn report_overlaps(declarations: &mut Declarations<'_>, uses: &[(Address, Span, Use)]) {
    let mut widest: Option<(Address, Span)> = None;
    for (address, span, _) in uses {
        let before = widest.filter(|(it, _)| it.area == address.area && address.bit < it.bit + u64::from(it.width));
        if let Some((other, first)) = before
            && other != *address
            && share_memory(declarations.dialect(*span), other, *address)
        {
            // A CODESYS program counts on the shared bits.
            let counted_on = declarations.dialect(*span) == Dialect::Codesys;
            let code = if counted_on { Code::E0410 } else { Code::W0410 };
            declarations.report(
                Diagnostic::new(code, *span, "two variables lie on overlapping addresses")
                    .label("this address shares bits with another one, but is kept apart from it")
                    .other(first, "the other address"),
            );
        }
        let reaches = |it: &Address| (it.area, it.bit + u64::from(it.width));
        if widest.is_none_or(|(it, _)| reaches(&it) < reaches(address)) {
            widest = Some((*address, *span));
        }
    }
}

/// OpenPLC keeps inputs and outputs of each size apart, so that %IX0.0 and %IW0 are two registers.
fn share_memory(dialect: Dialect, a: Address, b: Address) -> bool {
    dialect != Dialect::Iec || a.area == Area::Memory || a.width == b.width
}

fn collect_pou(pou: &ast::Pou<'_>, body: &[ast::Statement<'_>], uses: &mut Vec<(Address, Span, Use)>) {
    for name in pou.blocks.iter().flat_map(|it| &it.vars).filter_map(|it| it.address) {
        if let Some(address) = parse(name.text) {
            uses.push((address, name.span, Use::Local));
        }
    }
    ast::each_expr(body, &mut |expr| {
        if let ast::ExprKind::Address(name) = &expr.kind
            && let Some(address) = parse(name.text)
        {
            uses.push((address, name.span, Use::Direct));
        }
    });
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

    /// The shared variable at the address of a declaration, if other places name the address too.
    pub fn shared_address(
        &mut self,
        name: ast::Name<'s>,
        resolved: &Resolved,
        variable: ast::Name<'s>,
    ) -> Option<Place> {
        let address = parse(name.text)?;
        self.check_width(address, resolved, name.span);
        match self.addresses.shared.get(&address).copied()? {
            Storage::Global(at) => {
                let global = self.global(at)?;
                self.same_type(resolved.ty, global.resolved.ty, name, Some(global.name));
                Some(global.place.clone())
            }
            Storage::Hidden(Some(at)) => {
                let (ty, first) = (self.hidden.field_type(at), self.hidden.declared(at));
                self.same_type(resolved.ty, ty, name, first);
                Some(self.hidden_place(at))
            }
            Storage::Hidden(None) => Some(self.share_address(address, resolved, variable.text, Some(variable))),
        }
    }

    fn same_type(&mut self, ours: Type, theirs: Type, name: ast::Name<'s>, first: Option<ast::Name<'s>>) {
        if ours == theirs {
            return;
        }
        let (ours, theirs) = (self.program.type_name(ours), self.program.type_name(theirs));
        let mut error = Diagnostic::new(Code::E0409, name.span, format!("`{}` has two types", name.text))
            .label(format!("{ours} here"));
        if let Some(first) = first {
            error = error.other(first.span, format!("{theirs} here"));
        }
        self.report(error);
    }

    pub fn check_width(&mut self, address: Address, resolved: &Resolved, span: Span) {
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
        }
    }

    /// The variable at an address that a body names directly.
    pub fn direct_address(&mut self, name: ast::Name<'s>) -> Option<Place> {
        let address = self.address(name)?;
        match self.addresses.shared.get(&address).copied() {
            Some(Storage::Global(at)) => Some(self.global(at)?.place.clone()),
            Some(Storage::Hidden(Some(at))) => Some(self.hidden_place(at)),
            Some(Storage::Hidden(None)) | None => {
                let elementary = match address.width {
                    1 => Elementary::Bool,
                    8 => Elementary::Byte,
                    16 => Elementary::Word,
                    32 => Elementary::Dword,
                    _ => Elementary::Lword,
                };
                let resolved = Resolved::plain(Type::Elementary(elementary));
                let text = name.text.trim_start_matches('%').replace('.', "_");
                Some(self.share_address(address, &resolved, &text, None))
            }
        }
    }

    fn share_address(
        &mut self,
        address: Address,
        resolved: &Resolved,
        name: &str,
        declared: Option<ast::Name<'s>>,
    ) -> Place {
        let location = declared.map(|it| self.location(it.span)).unwrap_or_default();
        let field = Field {
            name: name.to_owned(),
            ty: resolved.ty,
            initial: resolved.initial.clone(),
            section: Section::Global,
            retain: staunch_ir::Retain::Inherited,
            constant: false,
            address: Some(address),
            doc: None,
            location,
        };
        let at = self.add_hidden(field, declared);
        self.addresses.shared.insert(address, Storage::Hidden(Some(at)));
        self.hidden_place(at)
    }
}

/// `%IW0.1`, `%QX1.2.3`: an address through the parts of a station.
fn is_hierarchical(text: &str) -> bool {
    let bits = matches!(text.as_bytes().get(2), Some(b'X' | b'x' | b'0'..=b'9'));
    text.matches('.').count() > usize::from(bits)
}
