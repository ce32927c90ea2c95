//! References: what makes them, what they lead to, and how they count, compare and convert.
//!
//! An address counts as an integer: the lower half of what a reference holds. It compares with integers and
//! other addresses, and converts to one of 32 bits and more; an integer other than 0 does not convert back.

use super::checker::Checker;
use super::method::is_this;
use super::operand::Operand;
use super::operator::Sides;
use super::place::{Access, Found};
use super::unresolved::not_constant;
use crate::index::recorder::Named;
use crate::names::{Entry, Found as Meant, Meaning, Sense};
use crate::types::window::Window;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, BinaryOp, ExprKind as Ast};
use staunch_ir::{
    Conversion, Elementary, Expr, ExprKind, FaultKind, Op, Place, Projection, RefKind, RefType, ReferenceId, Section,
    Statement, StatementKind, Type, Value, reference::is_null,
};

/// The lower half of a reference's bits: its address.
const ADDRESS: u64 = 0xFFFF_FFFF;

/// The same, with the number of the class: an instance and its first member have the same address.
const INSTANCE: u64 = ADDRESS | u64::MAX << staunch_runtime::reference::CLASS;

/// What is called like a function, and takes a variable rather than its value.
#[derive(Clone, Copy)]
enum Function {
    /// `ADR(x)`, `REF(x)`
    Address(RefKind),
    /// `SIZEOF(x)`
    Size,
    /// `__ISVALIDREF(r)`
    IsValid,
}

fn function(name: &str) -> Option<Function> {
    let functions = [
        ("ADR", Function::Address(RefKind::PointerTo)),
        ("REF", Function::Address(RefKind::RefTo)),
        ("SIZEOF", Function::Size),
        ("XSIZEOF", Function::Size),
        ("__ISVALIDREF", Function::IsValid),
    ];
    functions.into_iter().find(|(it, _)| it.eq_ignore_ascii_case(name)).map(|(_, it)| it)
}

impl<'s> Checker<'_, 's> {
    /// What a place stands for: a REFERENCE TO stands for what it refers to.
    pub(crate) fn referred(&mut self, found: Found<'s>, span: Span) -> Option<Found<'s>> {
        match self.ref_type(self.type_of(&found)) {
            Some((id, RefType { kind: RefKind::ReferenceTo, .. })) => self.followed(found, id, span),
            Some(_) | None => Some(found),
        }
    }

    /// The value of a call: one that gives a REFERENCE TO gives what that refers to, but where a reference is wanted.
    pub(super) fn referred_result(&mut self, value: Operand, wanted: Option<Type>, span: Span) -> Option<Operand> {
        let is_reference = |ty| self.ref_type(ty).is_some_and(|(_, it)| it.kind == RefKind::ReferenceTo);
        match value {
            Operand::Typed(value) if is_reference(value.ty) && !wanted.is_some_and(is_reference) => {
                let found = self.result_place(value, span)?;
                let found = self.referred(found, span)?;
                self.read(found.place, found.view, span).map(Operand::Typed)
            }
            value => Some(value),
        }
    }

    fn ref_type(&self, ty: Type) -> Option<(ReferenceId, RefType)> {
        let Type::Reference(id) = ty else { return None };
        Some((id, self.decl.program.references[id.index()]))
    }

    fn followed(&mut self, found: Found<'s>, id: ReferenceId, span: Span) -> Option<Found<'s>> {
        if self.decl.table.unknown_references.contains(&id) {
            return None;
        }
        let at = self.at(span);
        let target = self.decl.program.target(id);
        Some(Found { place: found.place.deref(target, at), view: None, access: Access::Write })
    }

    /// `p^`
    pub(crate) fn dereferenced(&mut self, inner: &ast::Expr<'s>, span: Span) -> Option<Found<'s>> {
        let found = self.place_or_view(inner)?;
        let found = match found.view {
            Some(view) if matches!(view.ty, Type::Reference(_)) => self.pointer_of_union(found, view.ty, inner.span)?,
            Some(_) | None => self.whole(found, inner.span)?,
        };
        if self.decl.interface_of(found.place.ty).is_some() {
            self.report_interface(found.place.ty, "`^` needs a reference", span);
            return None;
        }
        if self.signature.is_none() {
            // Where it points, and with what type there, is known when the program runs.
            self.report(not_constant(span));
            return None;
        }
        let Type::Reference(id) = found.place.ty else {
            let ty = self.type_name(found.place.ty);
            let error = Diagnostic::new(Code::E0211, span, format!("`^` needs a reference, but this is {ty}"));
            let is_followed = matches!(found.place.projections.last(), Some(Projection::Deref { .. }));
            self.report(match (is_followed, &inner.kind) {
                (true, ast::ExprKind::Name(name)) => {
                    let name = name.text;
                    error
                        .label("a REFERENCE TO is dereferenced automatically")
                        .help(format!("write `{name}` without `^`"))
                        .fix(span, name)
                }
                _ => error.label("this cannot be dereferenced"),
            });
            return None;
        };
        self.followed(found, id, span)
    }

    /// A copy of a UNION's pointer, which is followed.
    fn pointer_of_union(&mut self, found: Found<'s>, ty: Type, span: Span) -> Option<Found<'s>> {
        let value = self.read(found.place, found.view, span)?;
        let place = self.temporary("pointer", ty);
        self.assign(place.clone(), value, span);
        Some(Found { place, view: None, access: found.access })
    }

    /// A call of what takes a variable rather than its value; `None` where `callee` is something else.
    pub(crate) fn reference_function(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        let Ast::Name(name) = &callee.kind else { return None };
        let function = function(name.text)?;
        if self.means_anything(&[*name], Sense::Callee) {
            return None;
        }
        let [ast::Argument { kind: ArgumentKind::Positional(argument), .. }] = arguments else {
            self.report(
                Diagnostic::new(Code::E0302, span, format!("`{}` takes 1 argument", name.text))
                    .label("expected one variable"),
            );
            return Some(None);
        };
        Some(match function {
            Function::Address(kind) => self.reference_to(argument, kind).map(Operand::Typed),
            Function::Size => self.size(argument),
            Function::IsValid => self.is_valid(argument, span).map(Operand::Typed),
        })
    }

    /// A reference to a variable.
    pub(crate) fn reference_to(&mut self, expr: &ast::Expr<'s>, kind: RefKind) -> Option<Expr> {
        if let (Ast::Literal(_), Some(copy)) = (&expr.kind, self.decl.table.constant_copies.get(&expr.span)) {
            let place = self.decl.synthetic_place(*copy);
            let ty = place.ty;
            return self.reference_at(place, ty, (kind, 0), expr.span);
        }
        let mut found = self.place_or_view(expr)?;
        if let Some(view) = found.view.as_mut().filter(|it| it.is_bit)
            && self.is_of_a_union(expr)
        {
            (view.ty, view.is_bit) = (Type::Elementary(Elementary::Byte), false);
        }
        let target = self.type_of(&found);
        let mut bytes = 0;
        let found = match found.view {
            Some(view) if Self::has_address(view) => {
                bytes = self.bytes_in_unit(&found.place, view);
                Found { place: self.first_unit(&found.place, view, expr.span), view: None, ..found }
            }
            Some(_) | None => self.whole(found, expr.span)?,
        };
        if self.decl.program.is_open(found.place.ty) {
            self.decl.not_supported(expr.span, "the address of a whole ARRAY[*]");
            return None;
        }
        if self.signature.is_none() {
            self.decl.not_supported(expr.span, "an address as an initial value here");
            return None;
        }
        // CODESYS replaces a constant by its value where it is read, so what is written to its address changes none.
        let found = self.copy_of_constant(found);
        let has_address = self.decl.dialect(expr.span).has_addresses_of_constants() && self.is_no_constant(&found);
        if let Access::Constant(name) = found.access
            && !has_address
        {
            self.report(
                Diagnostic::new(Code::E0501, expr.span, format!("`{}` is a CONSTANT", name.text))
                    .label("it has no address: a reference could change it"),
            );
            return None;
        }
        if self.is_pin(&found) {
            self.report(
                Diagnostic::new(Code::E0211, expr.span, "a pin of a standard block has no address of its own")
                    .label("only the block writes it")
                    .help("take the address of the block itself, or copy the value to a variable"),
            );
            return None;
        }
        if self.is_counter(&found.place, found.view) {
            self.report(
                Diagnostic::new(Code::E0211, expr.span, "the counter of an enclosing loop has no address")
                    .label("the loop controls it"),
            );
            return None;
        }
        // Whoever has its address may read and write it.
        self.note_passed(&found.place, expr.span, expr.span);
        self.reference_at(found.place, target, (kind, bytes), expr.span)
    }

    /// A reference to what lies so many bytes after where a place begins.
    fn reference_at(&mut self, place: Place, target: Type, (kind, bytes): (RefKind, u64), span: Span) -> Option<Expr> {
        let ty = self.decl.reference_type(kind, target);
        let at = self.at(span);
        let mut reference = Expr::new(ty, ExprKind::AddressOf(Box::new(place.clone())), at);
        if bytes > 0 {
            let bytes = Operand::Integer(bytes.into());
            reference = self.advance(Operand::Typed(reference), (bytes, span), BinaryOp::Add, span)?;
        }
        self.decl.note_referred(place.ty);
        Some(self.told_apart(reference, &place, span))
    }

    /// A pointer to a copy of a loop's counter, which has no address of its own; `None` of anything else.
    pub(crate) fn pointer_to_counter(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Expr>> {
        let Ast::Name(name) = &expr.bare().kind else { return None };
        if self.counters.is_empty() || self.static_type(expr).is_none() || self.own_routine(*name).is_some() {
            return None;
        }
        let found = self.place_or_view(expr)?;
        if !self.is_counter(&found.place, found.view) {
            return None;
        }
        let value = self.read(found.place, found.view, expr.span)?;
        let (ty, copy) = (value.ty, self.temporary("counter", value.ty));
        self.assign(copy.clone(), value, expr.span);
        Some(self.reference_at(copy, ty, (RefKind::PointerTo, 0), expr.span))
    }

    /// Whether it is a BIT that starts where another member does, as in a UNION: CODESYS gives it the address of its byte.
    fn is_of_a_union(&self, expr: &ast::Expr<'s>) -> bool {
        let Ast::Member(owner, name) = &expr.bare().kind else { return false };
        let Some(Type::Struct(id)) = self.static_type(owner) else { return false };
        let overlays = &self.decl.program.structure(id).overlays;
        let own = overlays.iter().find(|it| it.name.eq_ignore_ascii_case(name.text));
        let is_shared = own.is_some_and(|own| overlays.iter().any(|it| it.name != own.name && it.bit == own.bit));
        is_shared && self.decl.dialect(expr.span).has_addresses_of_constants()
    }

    /// Whether a reference may lead to a view: it begins with a byte.
    fn has_address(view: Window) -> bool {
        !view.is_bit && !view.is_selected
    }

    /// The copy that has the address of a CONSTANT; others are themselves.
    fn copy_of_constant(&self, found: Found<'s>) -> Found<'s> {
        let Access::Constant(name) = found.access else { return found };
        let Some(copy) = self.decl.table.constant_copies.get(&name.span) else { return found };
        let mut place = self.decl.synthetic_place(*copy);
        place.projections.extend(found.place.projections.iter().skip(1).cloned());
        Found { place: Place { ty: found.place.ty, ..place }, access: Access::Write, ..found }
    }

    /// Whether what is declared CONSTANT is a variable that lives for a call: a FUNCTION's, or what is given for
    /// a VAR_IN_OUT CONSTANT, which is a variable of the caller's or a copy.
    fn is_no_constant(&self, found: &Found<'s>) -> bool {
        matches!(found.place.root, staunch_ir::Root::Local(_) | staunch_ir::Root::Param(_))
    }

    pub(crate) fn is_pin(&self, found: &Found<'s>) -> bool {
        let Some(mut ty) = self.root_type(found.place.root) else { return false };
        for projection in &found.place.projections {
            if matches!(ty, Type::Block(_)) {
                return true;
            }
            match self.decl.program.part(ty, projection) {
                Some(part) => ty = part,
                None => return false,
            }
        }
        false
    }

    /// `SIZEOF(x)`, also of a type: a number that takes the type of its place.
    fn size(&mut self, argument: &ast::Expr<'s>) -> Option<Operand> {
        let ty = match self.type_meant(argument) {
            Some(ty) => ty?,
            None => {
                let found = self.place_of_reference(argument)?;
                self.type_of(&found)
            }
        };
        let ty = self.sized(ty, argument.span)?;
        if self.decl.program.is_open(ty) {
            self.decl.not_supported(argument.span, "SIZEOF of an ARRAY[*]");
            return None;
        }
        Some(Operand::Integer(i128::from(self.size_seen(ty, argument.span))))
    }

    /// What SIZEOF says of a type. Where an address counts as an integer of 32 bits, a pointer has its size, and so have the
    /// elements of an array: code divides by one or the other. In memory it still takes 8 bytes.
    fn size_seen(&self, ty: Type, span: Span) -> u64 {
        let is_pointer = |ty| {
            let kind = self.ref_type(ty).map(|it| it.1.kind);
            matches!(kind, Some(RefKind::PointerTo | RefKind::RefTo | RefKind::ReferenceTo))
        };
        let (mut element, mut count) = (ty, 1_u64);
        while let Type::Array(id) = element {
            let array = self.decl.program.array(id);
            (element, count) = (array.element, count.saturating_mul(array.len()));
        }
        if self.decl.dialect(span).counts_addresses_as_dwords() && is_pointer(element) {
            return count.saturating_mul(4);
        }
        self.decl.sizeof(ty)
    }

    /// The type whose size is asked for: a REFERENCE TO stands for what it refers to.
    fn sized(&mut self, ty: Type, span: Span) -> Option<Type> {
        let Some((id, RefType { kind, .. })) = self.ref_type(ty) else { return Some(ty) };
        if self.decl.table.unknown_references.contains(&id) {
            return None;
        }
        let target = self.decl.program.target(id);
        match kind {
            RefKind::ReferenceTo => return Some(target),
            RefKind::Interface(_) => {}
            RefKind::PointerTo | RefKind::RefTo => self.report_size_of_pointer(ty, target, span),
        }
        Some(ty)
    }

    fn report_size_of_pointer(&mut self, ty: Type, target: Type, span: Span) {
        let text = self.decl.log.sources.text(span).to_owned();
        let (of, ty) = (ty, self.type_name(ty));
        let warning = Diagnostic::new(Code::W0520, span, format!("this is the size of the {ty} itself"))
            .label(format!("{} bytes, whatever it refers to", self.size_seen(of, span)));
        self.report(match target {
            Type::Array(id) => {
                let first = self.decl.program.array(id).low;
                warning
                    .help(format!("write `SIZEOF({text}^)` for the array, `SIZEOF({text}^[{first}])` for an element"))
            }
            _ => warning.help(format!("write `SIZEOF({text}^)` for the size of what it refers to")),
        });
    }

    /// The type that a name means, with namespaces before it or none, where no variable has it. The inner `None` says that
    /// its declaration was reported.
    fn type_meant(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Type>> {
        let path = expr.path().filter(|it| it.first().is_some_and(|it| self.scope.get(it.text).is_none()))?;
        if let [name] = path.as_slice()
            && let Some(elementary) = self.decl.dialect(name.span).rules().named(name.text)
        {
            self.decl.log.note(name.span, || Named::Elementary(elementary));
            return Some(Some(Type::Elementary(elementary)));
        }
        let is_value = path.len() > 1
            && matches!(
                self.decl.lookup(&path, Sense::Value),
                Meant::One(Meaning::Declared(Entry::Global(_)) | Meaning::Enumerator(_))
            );
        let is_declared = matches!(self.decl.lookup(&path, Sense::Type), Meant::One(Meaning::Declared(Entry::Type(_))));
        let ty = if is_value { None } else { self.decl.type_of_path(&path) };
        if ty.is_some() {
            self.decl.note_path(&path, &self.decl.lookup(&path, Sense::Type));
        }
        (ty.is_some() || is_declared && !is_value).then_some(ty)
    }

    /// `__ISVALIDREF(r)`: whether it refers to anything.
    fn is_valid(&mut self, argument: &ast::Expr<'s>, span: Span) -> Option<Expr> {
        let found = self.place_of_reference(argument)?;
        if self.is_given_in_out(argument) {
            // Who calls gives a variable, or there is a fault before the first statement.
            return Some(Expr::bool(true, self.at(span)));
        }
        if !matches!(found.place.ty, Type::Reference(_)) {
            let ty = self.type_name(found.place.ty);
            self.error(Code::E0211, argument.span, format!("`__ISVALIDREF` takes a reference, but this is {ty}"));
            return None;
        }
        let reference = Expr::load(found.place, self.at(span));
        self.against_null(Op::Ne, reference, span)
    }

    /// Whether an expression is a VAR_IN_OUT that the routine itself is given, in CODESYS, where that is a reference.
    fn is_given_in_out(&self, argument: &ast::Expr<'s>) -> bool {
        let Ast::Name(name) = &argument.bare().kind else { return false };
        let variable = self.scope.get(name.text).filter(|it| it.section == Section::InOut);
        let is_given = variable.is_some_and(|it| matches!(it.place.root, staunch_ir::Root::Param(_)));
        is_given && self.decl.dialect(argument.span).has_in_outs_that_are_references()
    }

    fn against_null(&mut self, op: Op, reference: Expr, span: Span) -> Option<Expr> {
        let bits = self.address_bits(reference);
        let null = Expr::constant(Elementary::Lword, Value::U64(0), self.at(span));
        self.apply(op, Type::Elementary(Elementary::Lword), vec![bits, null], Type::BOOL, span)
    }

    /// The argument of a VAR_IN_OUT must exist when it is called: a reference that is null, or a variable it leads to, is
    /// a fault here.
    pub(crate) fn fault_at_null(&mut self, reference: &mut Expr, span: Span) -> Option<()> {
        if let ExprKind::AddressOf(place) = &reference.kind
            && !place.is_followed()
        {
            return Some(());
        }
        self.save("referred", reference);
        let condition = self.against_null(Op::Eq, reference.clone(), span)?;
        let then = vec![Statement::new(StatementKind::Fault(FaultKind::NullReference), self.at(span))];
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        Some(())
    }

    /// `r REF= x`
    pub(crate) fn bind_reference(&mut self, target: &ast::Expr<'s>, value: &ast::Expr<'s>, span: Span) -> Option<()> {
        if let Some(made) = self.set_property(target, value, span) {
            return made;
        }
        let found = self.place_of_reference(target);
        let Some(found) = found.filter(|it| self.writable(it, target.span)) else {
            self.operand(value, None);
            return None;
        };
        let Some((_, RefType { kind, .. })) = self.ref_type(found.place.ty) else {
            let ty = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(Code::E0211, target.span, format!("`REF=` sets a reference, but this is {ty}"))
                    .label("expected a REFERENCE TO"),
            );
            self.operand(value, None);
            return None;
        };
        if matches!(kind, RefKind::Interface(_)) {
            self.report_interface(found.place.ty, "`REF=` sets a reference", target.span);
            self.operand(value, None);
            return None;
        }
        if self.refuse_to_bind_instance(target).is_some() {
            self.operand(value, None);
            return None;
        }
        if kind != RefKind::ReferenceTo {
            self.report_bound_pointer(found.place.ty, kind, value, target.span);
            self.operand(value, None);
            return None;
        }
        let mut place = found.place;
        let ty = place.ty;
        let value = self.after_place(&mut place, |this| {
            if this.is_null_word(value) {
                return this.value(value, ty);
            }
            // `r REF= s` of another reference takes over what that refers to.
            let bound = this.reference_to(value, kind)?;
            this.coerce(Operand::Typed(bound), ty, value.span)
        })?;
        self.assign(place, value, span);
        Some(())
    }

    /// Reports `REF=` of what is assigned an address.
    fn report_bound_pointer(&mut self, ty: Type, kind: RefKind, value: &ast::Expr<'s>, span: Span) {
        let function = if kind == RefKind::RefTo { "REF" } else { "ADR" };
        let (ty, value) = (self.type_name(ty), self.decl.log.sources.text(value.span));
        let error = Diagnostic::new(Code::E0211, span, format!("`REF=` sets a REFERENCE TO, but this is {ty}"))
            .label("it is assigned an address")
            .help(format!("write `{} := {function}({value});`", self.decl.log.sources.text(span)));
        self.report(error);
    }

    /// Reports a VAR_IN_OUT that is a reference because heirs are passed for it: it is the caller's instance.
    fn refuse_to_bind_instance(&mut self, target: &ast::Expr<'s>) -> Option<()> {
        let Ast::Name(name) = &target.bare().kind else { return None };
        let variable = self.scope.get(name.text).filter(|it| it.section == Section::InOut)?;
        let declared = self.decl.pous.iter().flat_map(|it| &it.ast.blocks).flat_map(|it| &it.vars);
        let decl = declared.into_iter().find(|it| it.names.iter().any(|it| it.span == variable.name.span))?;
        let is_kept = self.decl.table.kept_in_outs.contains(&variable.name.span);
        let ty = match &decl.ty.kind {
            _ if is_kept => self.type_name(self.decl.referred_type(variable.place.ty)?),
            ast::TypeKind::Named(path) => {
                let meant = self.decl.lookup(path, Sense::Type);
                let Meant::One(Meaning::Declared(Entry::Pou(_))) = meant else { return None };
                path.last().map(|it| it.text.to_owned())?
            }
            _ => return None,
        };
        self.report(
            Diagnostic::new(Code::E0211, target.span, format!("`REF=` sets a reference, but this is {ty}"))
                .label("a VAR_IN_OUT is the caller's variable")
                .other(decl.span, "declared here")
                .help(format!("declare it as `REFERENCE TO {ty}` in VAR_INPUT")),
        );
        Some(())
    }

    fn is_null_word(&self, expr: &ast::Expr<'s>) -> bool {
        match &expr.bare().kind {
            Ast::Name(name) => self.is_null(*name),
            Ast::Literal(literal) => matches!(literal.value, ast::LiteralValue::Integer { value: 0, .. }),
            _ => false,
        }
    }

    /// Whether the name is NULL, and no variable has that name.
    pub(crate) fn is_null(&self, name: ast::Name<'s>) -> bool {
        name.text.eq_ignore_ascii_case("NULL") && self.scope.get(name.text).is_none()
    }

    pub(crate) fn null(&mut self, expected: Option<Type>, span: Span) -> Expr {
        let ty = match expected {
            Some(ty @ Type::Reference(_)) => ty,
            Some(_) | None => self.decl.reference_type(RefKind::RefTo, Type::Elementary(Elementary::Byte)),
        };
        let at = self.at(span);
        Expr::new(ty, ExprKind::Const(Value::U64(0)), at)
    }

    /// The value of an expression where a REFERENCE TO is wanted: a variable binds to it by its name.
    pub(crate) fn bound_value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<Option<Expr>> {
        let (_, RefType { kind, .. }) = self.ref_type(ty)?;
        if self.is_null_word(expr) {
            return None;
        }
        match kind {
            RefKind::Interface(_) => return self.interface_value(expr, ty),
            RefKind::RefTo | RefKind::PointerTo if is_this(expr) => {}
            RefKind::ReferenceTo if !matches!(expr.bare().kind, Ast::Call(..)) => {}
            RefKind::RefTo | RefKind::PointerTo | RefKind::ReferenceTo => return None,
        }
        let bound = self.reference_to(expr, kind);
        Some(bound.and_then(|it| self.coerce(Operand::Typed(it), ty, expr.span)))
    }

    /// A reference where another one is declared. CODESYS gives the address of anything to any pointer; each
    /// access is checked in any case.
    pub(crate) fn coerce_reference(&mut self, value: Expr, to: ReferenceId, span: Span) -> Option<Expr> {
        let ty = Type::Reference(to);
        // What it leads to was reported.
        if [ty, value.ty].into_iter().any(|it| self.leads_to_unknown(it)) {
            return None;
        }
        let Type::Reference(from) = value.ty else { return self.no_reference(value.ty, ty, span) };
        if is_null(&value) {
            return Some(Expr { ty, ..value });
        }
        if self.decl.interface_of(ty).or(self.decl.interface_of(value.ty)).is_some() {
            return self.coerce_interface(value, ty, span);
        }
        let targets = (self.decl.program.target(from), self.decl.program.target(to));
        let same = targets.0 == targets.1 || self.decl.extends(targets.0, targets.1);
        if same && value.as_const().is_some() {
            return Some(Expr { ty, ..value });
        }
        if !same && !self.may_refer(value.ty, ty, span) {
            return self.refuse_other_target(value.ty, ty, span);
        }
        Some(self.convert(Conversion::Same, ty, value))
    }

    pub(super) fn leads_to_unknown(&self, ty: Type) -> bool {
        matches!(ty, Type::Reference(id) if self.decl.table.unknown_references.contains(&id))
    }

    /// Whether a reference may lead to what is of another type. CODESYS gives any address to any pointer, but checks the type
    /// of what a REFERENCE TO is bound to: the same, or one that EXTENDS it. A STRING of another length is a STRING.
    fn may_refer(&self, from: Type, to: Type, span: Span) -> bool {
        if !self.decl.dialect(span).mixes_bits_and_integers() {
            return false;
        }
        let (Some((id, from)), Some((wanted, to))) = (self.ref_type(from), self.ref_type(to)) else { return false };
        let unknown = &self.decl.table.unknown_references;
        let is_of_studio = self.decl.log.sources.is_of_automation_studio();
        if is_of_studio || to.kind != RefKind::ReferenceTo || unknown.contains(&id) || unknown.contains(&wanted) {
            return true;
        }
        match (from.target, to.target) {
            (Type::String(from), Type::String(to)) => from.wide == to.wide,
            // What its base would be is not known, which has been reported.
            (Type::Struct(heir), _)
                if self.decl.slot_of_instance(heir).is_some_and(|it| self.decl.has_unknown_base(it)) =>
            {
                true
            }
            (heir, base) => self.decl.extends_structure(heir, base),
        }
    }

    fn refuse_other_target(&mut self, from: Type, to: Type, span: Span) -> Option<Expr> {
        let (expected, found) = (self.type_name(to), self.type_name(from));
        let help = match self.ref_type(to) {
            Some((_, RefType { kind: RefKind::ReferenceTo, target }))
                if self.decl.dialect(span).mixes_bits_and_integers() =>
            {
                let pointer = self.type_name(target);
                format!("a REFERENCE TO keeps its type; a `POINTER TO {pointer}` may look at the bytes of another")
            }
            Some(_) | None => {
                "a reference keeps its type; in `codesys` an address may be given to any pointer".to_owned()
            }
        };
        self.report(
            Diagnostic::new(Code::E0201, span, format!("expected {expected}, found {found}"))
                .label(format!("this is {found}"))
                .help(help),
        );
        None
    }

    /// `r := REF(x)` to a REFERENCE TO, which means the variable that it refers to.
    pub(crate) fn refuse_address_assigned(&mut self, target: &ast::Expr<'s>, value: &ast::Expr<'s>) -> Option<()> {
        let span = target.span.to(value.span);
        let Ast::Call(callee, arguments) = &value.kind else { return Some(()) };
        let takes_address = matches!(&callee.kind, Ast::Name(it) if it.text.eq_ignore_ascii_case("REF"));
        let [argument] = arguments.as_slice() else { return Some(()) };
        if !takes_address || !self.leads_to_a_value(target) {
            return Some(());
        }
        let [to, from] = [target.span, argument.span].map(|it| self.decl.log.sources.text(it).to_owned());
        self.report(
            Diagnostic::new(Code::E0201, span, format!("`{to} := …` assigns to the variable that `{to}` refers to"))
                .label("an address is given here")
                .help(format!("to make `{to}` refer to `{from}`, write `{to} REF= {from}`"))
                .fix(span, format!("{to} REF= {from}")),
        );
        None
    }

    /// `inst.axis := ADR(x)` of Automation Studio, where `axis` is a REFERENCE TO: what it refers to is set. A variable of a
    /// program's is set so by ACCESS, and an address is a number that may be assigned to what it refers to.
    pub(crate) fn address_for_reference(
        &mut self,
        target: &ast::Expr<'s>,
        value: &'_ ast::Expr<'s>,
        span: Span,
    ) -> Option<Option<()>> {
        if !self.decl.log.sources.is_of_automation_studio() {
            return None;
        }
        let (Ast::Call(callee, arguments), Ast::Member(owner, _)) = (&value.kind, &target.kind) else { return None };
        let is_address = matches!(&callee.kind, Ast::Name(it) if it.text.eq_ignore_ascii_case("ADR"));
        let [ast::Argument { kind: ArgumentKind::Positional(argument), .. }] = arguments.as_slice() else {
            return None;
        };
        let Some(Type::Struct(state)) = self.static_type(owner).filter(|_| is_address) else { return None };
        self.decl.slot_of_instance(state)?;
        let found = self.place_of_reference(target).and_then(|it| self.ref_type(it.place.ty));
        found.filter(|it| it.1.kind == RefKind::ReferenceTo)?;
        Some(self.bind_reference(target, argument, span))
    }

    /// Whether it is a REFERENCE TO what is not a reference itself.
    fn leads_to_a_value(&mut self, target: &ast::Expr<'s>) -> bool {
        // What is not known is reported elsewhere, and an index is not evaluated twice.
        if !matches!(target.kind, Ast::Name(_)) || self.static_type(target).is_none() {
            return false;
        }
        let found = self.place_of_reference(target).and_then(|it| self.ref_type(it.place.ty));
        found.is_some_and(|(_, it)| it.kind == RefKind::ReferenceTo && !matches!(it.target, Type::Reference(_)))
    }

    fn no_reference(&mut self, found: Type, wanted: Type, span: Span) -> Option<Expr> {
        let (expected, name) = (self.type_name(wanted), self.type_name(found));
        let error = Diagnostic::new(Code::E0201, span, format!("expected {expected}, found {name}"))
            .label(format!("this is {name}"));
        let text = self.decl.log.sources.text(span).to_owned();
        self.report(match found {
            found if self.ref_type(wanted).is_some_and(|(_, it)| it.target == found) => {
                let word = if self.decl.dialect(span).mixes_bits_and_integers() { "ADR" } else { "REF" };
                error.help(format!("write `{word}({text})`")).fix(span, format!("{word}({text})"))
            }
            Type::Elementary(it) if it.repr().is_integer() => {
                error.help("an integer cannot become a reference: keep the reference itself, and add to it")
            }
            _ => error,
        });
        None
    }

    /// An address where an integer is declared, in dialects that let it be one.
    pub(crate) fn address_as(&mut self, value: Expr, into: Elementary, span: Span) -> Option<Expr> {
        if self.leads_to_unknown(value.ty) {
            return None;
        }
        let holds = into.repr().is_integer() && into.repr().size() >= 4 && !into.is_time();
        if !holds || !self.decl.dialect(span).mixes_bits_and_integers() {
            let (expected, found) = (into.name(), self.type_name(value.ty));
            let error = Diagnostic::new(Code::E0201, span, format!("expected {expected}, found {found}"))
                .label(format!("this is {found}"));
            let text = self.decl.log.sources.text(span);
            let is_null = text.eq_ignore_ascii_case("NULL");
            let is_followed = text.len() < 40 && !is_null && self.decl.interface_of(value.ty).is_none();
            let error = if is_followed { error.help(format!("what it refers to is `{text}^`")) } else { error };
            self.report(error);
            return None;
        }
        let bits = self.address_bits(value);
        Some(self.convert(Conversion::Value, Type::Elementary(into), bits))
    }

    /// The address as an LWORD.
    pub(super) fn address_bits(&mut self, value: Expr) -> Expr {
        self.masked(value, ADDRESS)
    }

    fn masked(&mut self, value: Expr, mask: u64) -> Expr {
        let (lword, at) = (Type::Elementary(Elementary::Lword), value.at);
        if is_null(&value) {
            return Expr::constant(Elementary::Lword, Value::U64(0), at);
        }
        let bits = self.convert(Conversion::Same, lword, value);
        let mask = Expr::constant(Elementary::Lword, Value::U64(mask), at);
        Expr::apply(Op::And, lword, vec![bits, mask], at)
    }

    /// Comparison and arithmetic where one side is a reference.
    pub(crate) fn reference_operation(&mut self, sides: Sides) -> Option<Operand> {
        let Sides { op, a, b, left, right, span, op_span: _, hint: _ } = sides;
        let of_interface = |it: &Operand| it.ty().is_some_and(|ty| self.decl.interface_of(ty).is_some());
        if super::operator::compares(op) && (of_interface(&a) || of_interface(&b)) {
            let fits = |it: &Operand| match it {
                Operand::Typed(value) => is_null(value) || of_interface(it),
                Operand::Integer(number) => *number == 0,
                _ => false,
            };
            if !matches!(op, BinaryOp::Eq | BinaryOp::Ne) || !fits(&a) || !fits(&b) {
                return self.refuse_interface_operation(op, [&a, &b], span);
            }
        }
        let made = match (a.is_reference(), b.is_reference(), op) {
            (_, _, BinaryOp::Eq | BinaryOp::Ne | BinaryOp::Lt | BinaryOp::Le | BinaryOp::Gt | BinaryOp::Ge) => {
                self.compare_addresses(op, (a, left), (b, right), span)
            }
            (true, true, BinaryOp::Sub) => {
                let distance = self.distance(a, b, span)?;
                return Some(match self.decl.dialect(span).mixes_bits_and_integers() {
                    // It counts as a DWORD, which a LINT holds whole.
                    true => Operand::Promoted(distance, Elementary::Dword),
                    false => Operand::Typed(distance),
                });
            }
            (true, false, BinaryOp::Add | BinaryOp::Sub) => self.advance(a, (b, right), op, span),
            (false, true, BinaryOp::Add) => self.advance(b, (a, left), op, span),
            _ => {
                let operands = [&a, &b].map(|it| it.ty().map_or("a number".to_owned(), |ty| self.type_name(ty)));
                let message = format!("`{}` does not take {} and {}", op.text(), operands[0], operands[1]);
                self.report(
                    Diagnostic::new(Code::E0204, span, message)
                        .label("references are compared, moved by a number of bytes, or subtracted from each other"),
                );
                None
            }
        };
        made.map(Operand::Typed)
    }

    fn refuse_interface_operation(&mut self, op: BinaryOp, sides: [&Operand; 2], span: Span) -> Option<Operand> {
        let operands = sides.map(|it| it.ty().map_or("a number".to_owned(), |ty| self.type_name(ty)));
        let message = format!("`{}` does not take {} and {}", op.text(), operands[0], operands[1]);
        self.report(
            Diagnostic::new(Code::E0204, span, message)
                .label("a variable of an INTERFACE is compared with another one or NULL, by `=` and `<>`"),
        );
        None
    }

    /// An operand as an address, for a comparison; of a reference, what the mask leaves of it.
    fn as_address(&mut self, operand: Operand, mask: u64, span: Span) -> Option<Expr> {
        let lword = Elementary::Lword;
        match operand.cut() {
            Operand::Typed(value) if matches!(value.ty, Type::Reference(_)) => Some(self.masked(value, mask)),
            Operand::Typed(value) => match value.ty {
                Type::Elementary(it) if it.repr().is_integer() && !it.is_time() => {
                    Some(self.convert(Conversion::Value, Type::Elementary(lword), value))
                }
                _ => self.coerce(Operand::Typed(value), Type::Elementary(lword), span),
            },
            number => self.coerce(number, Type::Elementary(lword), span),
        }
    }

    fn compare_addresses(&mut self, op: BinaryOp, a: (Operand, Span), b: (Operand, Span), span: Span) -> Option<Expr> {
        let of_interface = |it: &Operand| it.ty().is_some_and(|ty| self.decl.interface_of(ty).is_some());
        let mask = if of_interface(&a.0) && of_interface(&b.0) { INSTANCE } else { ADDRESS };
        let (a, b) = (self.as_address(a.0, mask, a.1)?, self.as_address(b.0, mask, b.1)?);
        let op = super::operator::comparison(op);
        self.apply(op, Type::Elementary(Elementary::Lword), vec![a, b], Type::BOOL, span)
    }

    /// How many bytes lie between two addresses.
    fn distance(&mut self, a: Operand, b: Operand, span: Span) -> Option<Expr> {
        let mut number = |operand| {
            let bits = self.as_address(operand, ADDRESS, span)?;
            Some(self.convert(Conversion::Value, Type::LINT, bits))
        };
        let (a, b) = (number(a)?, number(b)?);
        self.apply(Op::Sub, Type::LINT, vec![a, b], Type::LINT, span)
    }

    /// `p[i]` of a POINTER TO in CODESYS: what lies so many variables of its type after where it points.
    pub(crate) fn element_of_pointer(&mut self, found: &Found<'s>, index: &ast::Expr<'s>) -> Option<Option<Found<'s>>> {
        let target = self.target_by_index(self.type_of(found), index.span)?;
        Some(self.indexed_pointer(found.clone(), target, index))
    }

    /// The type of `p[i]` where `p` is a POINTER TO.
    pub(super) fn target_by_index(&self, ty: Type, index: Span) -> Option<(ReferenceId, Type)> {
        let (id, RefType { kind, target }) = self.ref_type(ty)?;
        (kind == RefKind::PointerTo && self.decl.dialect(index).indexes_pointers()).then_some((id, target))
    }

    fn indexed_pointer(
        &mut self,
        found: Found<'s>,
        (id, target): (ReferenceId, Type),
        index: &ast::Expr<'s>,
    ) -> Option<Found<'s>> {
        let (ty, at) = (found.place.ty, self.at(index.span));
        let mut pointer = self.read(found.place, found.view, index.span)?;
        let steps = self.after(&mut [&mut pointer], |this| this.operand(index, Some(Type::DINT)))?;
        let size = i128::from(self.decl.sizeof(target));
        let steps = match steps.cut() {
            Operand::Integer(count) => Operand::Integer(count.checked_mul(size)?),
            Operand::Typed(count) => {
                let count = self.coerce(Operand::Typed(count), Type::LINT, index.span)?;
                let size = Expr::constant(Elementary::Lint, Value::I64(i64::try_from(size).ok()?), at);
                Operand::Typed(Expr::apply(Op::Mul, Type::LINT, vec![count, size], at))
            }
            other => other,
        };
        let mut moved = self.advance(Operand::Typed(pointer), (steps, index.span), BinaryOp::Add, index.span)?;
        self.save("pointer", &mut moved);
        let ExprKind::Load(place) = moved.kind else { return None };
        self.followed(Found { place: Place { ty, ..place }, view: None, access: Access::Write }, id, index.span)
    }

    /// A reference moved by a number of bytes.
    fn advance(&mut self, reference: Operand, (by, place): (Operand, Span), op: BinaryOp, span: Span) -> Option<Expr> {
        let Operand::Typed(reference) = reference else { return None };
        if self.decl.interface_of(reference.ty).is_some() {
            self.report_interface(reference.ty, "only a reference can be moved by bytes", span);
            return None;
        }
        let by = match by.cut() {
            Operand::Typed(value) if matches!(value.ty, Type::Elementary(it) if it.repr().is_integer() && !it.is_time()) => {
                self.convert(Conversion::Value, Type::LINT, value)
            }
            other => self.coerce(other, Type::LINT, place)?,
        };
        let by = match op {
            BinaryOp::Sub => self.apply(Op::Neg, Type::LINT, vec![by], Type::LINT, span)?,
            _ => by,
        };
        let (ty, lword) = (reference.ty, Type::Elementary(Elementary::Lword));
        let bits = self.convert(Conversion::Same, lword, reference);
        let moved = self.apply(Op::Advance, lword, vec![bits, by], lword, span)?;
        Some(self.convert(Conversion::Same, ty, moved))
    }
}
