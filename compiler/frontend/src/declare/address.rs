//! Direct addresses. The storage of an address is one field of the globals, whoever declares it:
//! a global, several PROGRAMs, the instances of one PROGRAM, or a body that names the address.

use crate::ast::{self, PouKind, VarKind};
use crate::dialect::Dialect;
use crate::types::address::{Addresses, Storage, Use, field_name, parse};
use crate::types::declarations::{Declarations, GlobalSlot};
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashMap;
use staunch_ir::{Address, Elementary, Field, Place, Retain, Section, Type};

fn collect_body(body: &[ast::Statement<'_>], uses: &mut Vec<Use>) {
    ast::each_expr(body, &mut |expr| {
        if let ast::ExprKind::Address(name) = &expr.kind
            && let Some(address) = parse(name.text)
        {
            uses.push(Use { address, bits: u64::from(address.width), span: name.span, ty: None, scope: None });
        }
    });
}

/// Reports two names that one scope has for one address.
pub(super) fn report_second_names(declarations: &mut Declarations<'_>, uses: &[Use]) {
    let mut uses: Vec<&Use> = uses.iter().collect();
    uses.sort_by_key(|it| (it.address, it.span.file, it.span.start));
    let mut declared: FxHashMap<(Address, Span), Span> = FxHashMap::default();
    for it in uses {
        let Some(first) = it.scope.and_then(|scope| declared.insert((it.address, scope), it.span)) else { continue };
        // Two names in one declaration are refused by themselves.
        if first == it.span {
            continue;
        }
        let text = declarations.log.sources.text(it.span);
        declarations.report(
            Diagnostic::new(Code::W0411, it.span, format!("`{text}` has two names"))
                .label("assigning to one changes the other")
                .other(first, "the other one")
                .help("give this variable an address of its own, or use one name"),
        );
    }
}

impl<'s> Declarations<'s> {
    /// Finds the globals at addresses, and the addresses that bodies name.
    pub(super) fn collect_addresses(&mut self, bodies: &[Vec<ast::Statement<'s>>]) {
        let mut addresses = Addresses::default();
        for (at, GlobalSlot { decl, .. }) in self.globals.iter().enumerate() {
            let first = decl.address.and_then(|it| parse(it.text)).map(|it| addresses.storage.entry(it));
            let is_own = match first {
                Some(entry) => matches!(entry.or_insert(Storage::Global(at)), Storage::Global(first) if *first == at),
                None => true,
            };
            if is_own {
                addresses.own_fields.push(at);
            }
        }
        let has_addresses: Vec<_> = self.log.sources.files().iter().map(|it| it.text.contains('%')).collect();
        for (pou, body) in self.pous.iter().zip(bodies) {
            if has_addresses[usize::from(pou.ast.span.file)] {
                collect_body(body, &mut addresses.uses);
            }
        }
        self.addresses = addresses;
    }

    /// Reports an address that a declaration gives to several names.
    pub(super) fn check_one_name(&mut self, decl: &ast::VarDecl<'s>) {
        if let (Some(address), [_, second, ..]) = (decl.known_address(), decl.names.as_slice()) {
            self.report(
                Diagnostic::new(Code::E0409, second.span, "an address can have only one variable")
                    .label("a second name")
                    .other(address.span, "for this address")
                    .help("declare each name by itself: `a AT %IX0.0 : BOOL; b AT %IX0.1 : BOOL;`"),
            );
        }
    }

    /// Reports an address where a declaration has none.
    pub(super) fn check_address_here(
        &mut self,
        kind: Option<PouKind>,
        block: &ast::VarBlock<'s>,
        decl: &ast::VarDecl<'s>,
    ) {
        let Some(address) = decl.address else { return };
        let in_blocks = self.dialect(address.span) == Dialect::Codesys;
        let global = "declare it in VAR_GLOBAL, and list it in VAR_EXTERNAL here";
        let (message, help) = match (kind, block.kind) {
            (_, VarKind::Temp) => ("a VAR_TEMP has no address", "declare it in VAR"),
            (_, VarKind::InOut) => {
                ("a VAR_IN_OUT has no address", "it stands for a variable of the caller: delete `AT`")
            }
            (_, VarKind::External) => ("the address belongs to the global variable", "delete `AT` here"),
            _ if block.constant.is_some() => ("a CONSTANT has no address", "delete CONSTANT, or the address"),
            (Some(PouKind::Program) | None, _) => return,
            (Some(PouKind::FunctionBlock), VarKind::Var | VarKind::Stat) if in_blocks => return,
            // Each instance has its own address, which a VAR_CONFIG gives.
            (Some(PouKind::FunctionBlock), VarKind::Var | VarKind::Input | VarKind::Output)
                if decl.known_address().is_none() =>
            {
                return;
            }
            (Some(_), _) => ("only a PROGRAM's variables and globals have an address", global),
        };
        self.report(Diagnostic::new(Code::E0409, address.span, message).help(help));
    }

    /// The variable at the address of a declaration; the inner `None` says that it was refused.
    pub(super) fn located(
        &mut self,
        pou: Option<ast::Name<'s>>,
        block: &ast::VarBlock<'s>,
        decl: &ast::VarDecl<'s>,
        name: ast::Name<'s>,
        resolved: &Resolved,
    ) -> Option<Option<Place>> {
        let declared = decl.known_address()?;
        let address = parse(declared.text);
        let found = address.and_then(|it| self.addresses.storage_of(it, Some(resolved.ty)));
        let place = match found {
            Some(it) if self.type_in(it).is_some_and(|ty| self.is_retyped(ty, resolved.ty)) => {
                let address = self.address(declared)?;
                Some(self.new_view(address, resolved, pou, pou.map_or(declared, |_| name)))
            }
            Some(Storage::Global(at)) => {
                let Some(global) = self.global(at) else { return Some(None) };
                self.same_type(resolved.ty, global.resolved.ty, declared, Some(global.name))
                    .then(|| global.place.clone())
            }
            Some(Storage::Hidden(at)) => {
                let (ty, first) = (self.synthetic.field_type(at), self.synthetic.declared(at));
                self.same_type(resolved.ty, ty, declared, first).then(|| self.synthetic_place(at))
            }
            None => {
                let address = self.address(declared)?;
                let place = self.new_storage(address, resolved, pou.map_or("Globals", |it| it.text), name);
                if let Some(Storage::Hidden(at)) = self.addresses.storage.get(&address).copied() {
                    self.synthetic.document(at, decl.doc.clone());
                }
                Some(place)
            }
        };
        if place.is_some() {
            self.register_address(pou, block, decl, resolved);
        }
        Some(place)
    }

    /// Takes note of a declaration at an address; `pou` is `None` for a global.
    pub(super) fn register_address(
        &mut self,
        pou: Option<ast::Name<'s>>,
        block: &ast::VarBlock<'s>,
        decl: &ast::VarDecl<'s>,
        resolved: &Resolved,
    ) {
        let Some(name) = decl.known_address() else { return };
        let Some(address) = self.address(name) else { return };
        let bits = self.check_width(address, resolved, name.span);
        // What has no other name than its address is not one more name for it.
        let is_named = decl.names.iter().all(|it| !it.text.starts_with('%'));
        let scope = is_named.then(|| pou.map_or_else(Span::default, |it| it.span));
        let start = self.addresses.starts.entry((address, resolved.ty)).or_default();
        start.kept |= super::variable::is_declared_retain(block);
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
        self.addresses.uses.push(Use { address, bits, span: name.span, ty: Some(resolved.ty), scope });
    }

    fn type_in(&mut self, storage: Storage) -> Option<Type> {
        match storage {
            Storage::Global(at) => Some(self.global(at)?.resolved.ty),
            Storage::Hidden(at) => Some(self.synthetic.field_type(at)),
        }
    }

    /// Whether the types are two that can share the bits of one address.
    fn is_retyped(&self, first: Type, second: Type) -> bool {
        first != second && self.smallest_part(first).is_ok() && self.smallest_part(second).is_ok()
    }

    /// A declaration with another type than the storage at its address.
    fn new_view(
        &mut self,
        address: Address,
        resolved: &Resolved,
        pou: Option<ast::Name<'s>>,
        name: ast::Name<'s>,
    ) -> Place {
        let at = self.add_storage(address, resolved, pou.map_or("Globals", |it| it.text), name);
        self.addresses.retyped.insert((address, resolved.ty), at);
        if pou.is_none() {
            self.addresses.second_names.insert(self.addresses.own_fields().len() + at);
        }
        self.synthetic_place(at)
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

    /// The bits that a variable of the type takes at an address.
    fn check_width(&mut self, address: Address, resolved: &Resolved, span: Span) -> u64 {
        self.check_not_relative(resolved.ty, span);
        let ty = resolved.ty;
        let bits = if ty == Type::BOOL { 1 } else { self.sizeof(ty).saturating_mul(8) };
        let width = u64::from(address.width);
        if self.refuse_instance_at(ty, span) {
            return width;
        }
        let fits = match ty {
            Type::Array(_) => bits.is_multiple_of(width) && address.bit.is_multiple_of(8),
            // They begin there, and take what they need.
            Type::Struct(_) | Type::String(_) => address.bit.is_multiple_of(8),
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Reference(_) | Type::Block(_) => {
                bits == width
            }
        };
        if !fits {
            self.report_width(address, ty, bits, span);
        }
        if fits { bits } else { width }
    }

    fn report_width(&mut self, address: Address, ty: Type, bits: u64, span: Span) {
        let name = self.program.type_name(ty);
        let error = Diagnostic::new(Code::E0409, span, format!("{name} does not fit this address"));
        let plural = if address.width == 1 { "bit" } else { "bits" };
        if matches!(ty, Type::Array(_)) && !address.bit.is_multiple_of(8) {
            let byte = Address { bit: address.bit / 8 * 8, ..address };
            return self
                .report(error.label("it begins within a byte").help(format!("an array begins with a byte: `{byte}`")));
        }
        let error = error.label(format!("the address is {} {plural} wide, {name} is {bits}", address.width));
        let is_whole = matches!(ty, Type::Struct(_) | Type::String(_));
        self.report(match u8::try_from(bits).ok().filter(|it| [1, 8, 16, 32, 64].contains(it)) {
            _ if is_whole => error.help(format!("it begins with a byte: `{}`", at_width(address, 8))),
            Some(_) if matches!(ty, Type::Array(_)) => error,
            Some(width) if address.bit.is_multiple_of(bits) => {
                error.help(format!("the address of its width there is `{}`", at_width(address, width)))
            }
            Some(width) => {
                error.help(format!("choose an address of its width, such as `{}`", at_width(address, width)))
            }
            None => error,
        });
    }

    /// Reports what is, or holds, an instance: its variables have addresses of their own, or none.
    fn refuse_instance_at(&mut self, ty: Type, span: Span) -> bool {
        let Some((way, instance)) = self.instance_in(ty) else { return false };
        let (name, instance) = (self.program.type_name(ty), self.program.type_name(instance));
        let is = if way.is_empty() { "is an instance".to_owned() } else { format!("holds an instance of {instance}") };
        self.report(
            Diagnostic::new(Code::E0409, span, "an instance has no address")
                .label(format!("{name} {is}"))
                .help("give the address to a variable, and connect that in the call"),
        );
        true
    }

    /// Gives the addresses that only bodies name their storage.
    pub(super) fn declare_used_addresses(&mut self) {
        let spans: Vec<_> = self.addresses.uses.iter().map(|it| (it.address, it.span)).collect();
        for (address, span) in spans {
            if !self.addresses.storage.contains_key(&address) {
                let resolved = Resolved::plain(bit_string(address));
                let name = ast::Name { text: self.log.sources.text(span), span };
                self.new_storage(address, &resolved, "Globals", name);
            }
        }
    }

    fn new_storage(&mut self, address: Address, resolved: &Resolved, owner: &str, name: ast::Name<'s>) -> Place {
        let at = self.add_storage(address, resolved, owner, name);
        self.addresses.storage.insert(address, Storage::Hidden(at));
        self.synthetic_place(at)
    }

    /// A field of the globals as the storage of an address.
    pub(super) fn add_storage(
        &mut self,
        address: Address,
        resolved: &Resolved,
        owner: &str,
        name: ast::Name<'s>,
    ) -> usize {
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
            declared: None,
        };
        self.add_synthetic(field, is_named.then_some(name))
    }
}

/// The address of this width that the bit is in.
fn at_width(address: Address, width: u8) -> Address {
    let bit = address.bit / u64::from(width) * u64::from(width);
    Address { bit, width, ..address }
}

/// The bit string of an address' width.
pub(super) fn bit_string(address: Address) -> Type {
    Type::Elementary(match address.width {
        1 => Elementary::Bool,
        8 => Elementary::Byte,
        16 => Elementary::Word,
        32 => Elementary::Dword,
        _ => Elementary::Lword,
    })
}
