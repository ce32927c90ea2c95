//! Storage that an expression names.

use super::character::has_characters;
use super::checker::Checker;
use super::part::Part;
use super::unresolved::not_constant;
use crate::diagnostic::Missing;
use crate::index::recorder::Named;
use crate::inherit::is_super;
use crate::names::{self, Entry, Meaning, Sense};
use crate::spelling::nearest;
use crate::types::scope::Variable;
use crate::types::signature::Target;
use crate::types::window::Window;
use crate::{Code, Diagnostic, Span, ast};
use ast::ExprKind as Ast;
use staunch_ir::{
    Address, Area, Array, ArrayId, BlockId, Elementary, Expr, FieldId, Op, ParamId, Place, Root, Section, StructId,
    Type, Value,
};
use staunch_runtime::Direction;
use std::rc::Rc;

/// A place, and what may be done with it.
#[derive(Clone, Debug)]
pub(crate) struct Found<'s> {
    pub place: Place,
    /// The bits of the place that it is.
    pub view: Option<Window>,
    pub access: Access<'s>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Access<'s> {
    Write,
    Constant(ast::Name<'s>),
    /// An input of the POU itself.
    OwnInput(ast::Name<'s>),
    /// An output of a block, seen from outside.
    Output(ast::Name<'s>),
    /// An internal variable of an instance, or what is part of one, seen from outside.
    Inner(ast::Name<'s>),
    /// What a call or a PROPERTY gave.
    Result,
}

/// Some bits of what is found.
fn selected(found: Found<'_>, part: Part) -> Found<'_> {
    let (before, address) = found.view.map_or((0, None), |it| (it.bit, it.address));
    let is_bit = part.ty == Elementary::Bool;
    let (ty, bit) = (Type::Elementary(part.ty), before + u64::from(part.shift));
    Found { view: Some(Window { ty, bit, is_bit, address, is_selected: true, is_packed: false }), ..found }
}

impl<'s> Checker<'_, 's> {
    /// The place that `expr` names, for reading or writing, or for being handed on.
    pub(crate) fn place(&mut self, expr: &ast::Expr<'s>) -> Option<Found<'s>> {
        let found = self.place_or_view(expr)?;
        self.whole(found, expr.span)
    }

    /// The place that `expr` names, or the bits of it, for reading or writing.
    pub(crate) fn place_or_view(&mut self, expr: &ast::Expr<'s>) -> Option<Found<'s>> {
        let found = self.place_of_reference(expr)?;
        self.referred(found, expr.span)
    }

    /// The place that `expr` names; a REFERENCE TO is itself.
    pub(crate) fn place_of_reference(&mut self, expr: &ast::Expr<'s>) -> Option<Found<'s>> {
        self.place_sought(expr, Missing::Variable)
    }

    /// The place of what has a member.
    pub(super) fn owner(&mut self, expr: &ast::Expr<'s>) -> Option<Found<'s>> {
        let found = self.place_sought(expr, Missing::Owner)?;
        self.referred(found, expr.span)
    }

    fn place_sought(&mut self, expr: &ast::Expr<'s>, sought: Missing) -> Option<Found<'s>> {
        if let Some(found) =
            self.this_of(expr).or_else(|| self.property_value(expr)).or_else(|| self.called_place(expr))
        {
            return found;
        }
        match &expr.kind {
            Ast::Name(name) => self.variable_place(*name, sought),
            Ast::Paren(inner) => self.place_sought(inner, sought),
            Ast::Address(name) => {
                let address = self.decl.address(*name)?;
                let Some(place) = self.decl.at_address(address) else {
                    self.report(not_constant(name.span));
                    return None;
                };
                let (place, view) = self.decl.image.stored(&place);
                Some(Found { place, view: view.map(Window::from), access: Access::Write })
            }
            Ast::Member(base, name) => self.member(expr, base, *name),
            Ast::Index(base, indices) => self.index(base, indices),
            Ast::Deref(inner) => self.dereferenced(inner, expr.span),
            Ast::Part(base, part) => {
                let found = self.place_or_view(base)?;
                let part = self.find_part(self.type_of(&found).read(), *part)?;
                Some(selected(found, part))
            }
            Ast::Error(_) => {
                self.operand(expr, None);
                None
            }
            Ast::Call(callee, arguments) if self.is_array(callee) => {
                self.report_array_called(callee, arguments);
                None
            }
            Ast::Call(callee, arguments)
                if self.static_type(callee).is_none() && self.call_value(expr, callee, arguments, None).is_none() =>
            {
                // What is called, or what it would give, is not known: that has been reported.
                None
            }
            Ast::Literal(_) | Ast::Call(..) | Ast::Unary(..) | Ast::Binary(..) | Ast::Assign(..) => {
                self.report_value(expr);
                None
            }
        }
    }

    /// Reports a value where a variable is expected.
    fn report_value(&mut self, expr: &ast::Expr<'s>) {
        let error = Diagnostic::new(Code::E0306, expr.span, "a variable is expected here").label("this is a value");
        let help = if let Ast::Call(callee, _) = &expr.kind {
            let name = self.decl.log.sources.text(callee.span);
            Some(match self.static_type(callee) {
                Some(Type::Struct(_) | Type::Block(_)) => {
                    format!("call it first, `{name}(…);`, then read its output: `{name}.…`")
                }
                Some(_) | None => "assign its result to a variable first, and use that here".to_owned(),
            })
        } else {
            None
        };
        self.report(match help {
            Some(help) => error.help(help),
            None => error,
        });
    }

    /// Whether `callee` is the name of an array.
    fn is_array(&self, callee: &ast::Expr<'s>) -> bool {
        let Ast::Name(name) = &callee.kind else { return false };
        self.scope.get(name.text).is_some_and(|it| matches!(it.place.ty, Type::Array(_)))
    }

    /// `a(1)` for `a[1]`
    pub(crate) fn report_array_called(&mut self, callee: &ast::Expr<'s>, arguments: &[ast::Argument<'s>]) {
        let text = self.decl.log.sources.text(callee.span);
        let index = match arguments {
            [first, .., last] => self.decl.log.sources.text(first.span.to(last.span)),
            [one] => self.decl.log.sources.text(one.span),
            [] => "1",
        };
        let has_pins = arguments.iter().any(|it| !matches!(it.kind, ast::ArgumentKind::Positional(_)));
        let meant = match has_pins {
            true => format!("{text}[1]({index})"),
            false => format!("{text}[{index}]"),
        };
        self.report(
            Diagnostic::new(Code::E0305, callee.span, format!("the array `{text}` cannot be called"))
                .label("an element is chosen in brackets")
                .help(format!("write `{meant}`")),
        );
    }

    /// The variable that a name means; the inner `None` says that it was reported.
    pub(crate) fn find_variable(&mut self, name: ast::Name<'s>) -> Option<Option<Rc<Variable<'s>>>> {
        self.offer_values(name, Sense::Value);
        if let Some(variable) = self.scope.get(name.text) {
            variable.used.set(true);
            let variable = Rc::clone(variable);
            self.decl.log.note_declared(name.span, variable.name.span);
            let is_outer = !self.scope.is_own(name.text);
            let is_within_reach = !is_outer || self.is_within_reach(&variable, name);
            return Some((is_within_reach && self.may_use(&variable, name)).then_some(variable));
        }
        if let Some(result) = self.result_variable(name) {
            self.note_own_pou(name);
            return Some(Some(Rc::new(result)));
        }
        if self.scope.is_refused(name.text) {
            return Some(None);
        }
        let unknown_constant = self.scope.constants.as_ref().is_some_and(|it| it.is_refused(name.text));
        if unknown_constant && self.context != super::checker::Context::Body {
            self.report_unknown_constant(name);
            return Some(None);
        }
        let found = self.decl.lookup(&[name], Sense::Value);
        self.decl.note_path(&[name], &found);
        match found {
            names::Found::Several(meanings) => {
                self.decl.report_ambiguous(name, &meanings);
                Some(None)
            }
            names::Found::One(Meaning::Declared(Entry::Global(at))) => Some(self.global(at)),
            names::Found::One(Meaning::Declared(Entry::Pou(slot))) if self.is_callable_program(slot, name) => {
                Some(self.decl.program_variable(slot))
            }
            names::Found::One(_) | names::Found::Nothing => {
                // A variable whose declaration was refused is not reported again at every use.
                self.declared_but_refused(name).then_some(None)
            }
        }
    }

    pub(crate) fn report_unknown_constant(&mut self, name: ast::Name<'s>) {
        self.report(
            Diagnostic::new(Code::E0402, name.span, format!("the value of `{}` is not known here", name.text))
                .label("it depends on itself, or its declaration is wrong"),
        );
    }

    /// Reports a variable of the POU around that a METHOD or ACTION cannot reach: it exists while the POU's
    /// own body runs.
    fn is_within_reach(&mut self, variable: &Variable<'s>, name: ast::Name<'s>) -> bool {
        if self.scope.outer.is_none() {
            return true;
        }
        let (section, help) = match variable.place.root {
            Root::Instance
                if variable.section == Section::InOut
                    && !self.is_action()
                    && !self.decl.table.kept_in_outs.contains(&variable.name.span) =>
            {
                ("VAR_IN_OUT", "declare a VAR_IN_OUT in the METHOD, and pass the variable on")
            }
            Root::Instance | Root::Globals => return true,
            Root::Param(_) if self.passed_on(variable.name).is_some() => return true,
            Root::Param(_) => ("VAR_IN_OUT", "declare a VAR_IN_OUT in the METHOD, and pass the variable on"),
            Root::Local(_) => ("VAR_TEMP", "declare it in VAR, or in the METHOD"),
        };
        self.report(
            Diagnostic::new(Code::E0109, name.span, format!("`{}` is a {section} of the enclosing POU", name.text))
                .label("it exists only during a call of the POU itself")
                .other(variable.name.span, "declared here")
                .help(help),
        );
        false
    }

    fn is_action(&self) -> bool {
        self.slot.is_some_and(|it| self.decl.pous[it].ast.kind == ast::PouKind::Action)
    }

    /// What the routine was given for a VAR_IN_OUT that is declared at `name`.
    pub(crate) fn passed_on(&self, name: ast::Name<'s>) -> Option<Place> {
        let mut formals = self.signature.as_ref()?.formals.iter();
        let formal = formals.find(|it| it.name.span == name.span)?;
        let Target::Param(at) = formal.target else { return None };
        Some(Place::root(Root::Param(ParamId::next(at)), formal.resolved.ty))
    }

    /// `THIS^.x`: a variable of the POU around.
    fn member_of_this(&mut self, name: ast::Name<'s>) -> Option<Found<'s>> {
        let this = self.this()?.place;
        self.offer_members(name, this.ty);
        let scope = self.scope.outer.as_ref().unwrap_or(&self.scope);
        if self.decl.log.is_asked(name.span) {
            let own = scope.variables.iter().map(|it| it.name).filter(|it| !it.text.starts_with("__"));
            own.for_each(|it| self.decl.log.offer_expected(it.text, Named::Definition(it.span)));
        }
        let Some(variable) = scope.get(name.text).cloned() else {
            // A METHOD that is inherited has been looked at before.
            let is_reported = self.decl.log.diagnostics.iter().any(|it| it.span == name.span);
            if !scope.is_refused(name.text) && !is_reported {
                let near = nearest(name.text, scope.variables.iter().map(|it| it.name.text));
                self.decl.unknown_member(name, this.ty, near);
            }
            return None;
        };
        variable.used.set(true);
        self.decl.log.note_declared(name.span, variable.name.span);
        let may_use = self.is_within_reach(&variable, name) && self.may_use(&variable, name);
        may_use.then(|| self.found(&variable, name))
    }

    /// The global variable in a slot, which is used by that.
    pub(super) fn global(&mut self, at: usize) -> Option<Rc<Variable<'s>>> {
        let variable = self.decl.global(at)?;
        variable.used.set(true);
        Some(variable)
    }

    /// Whether a name means a PROGRAM that may be called, or read, by it.
    pub(crate) fn is_callable_program(&self, slot: usize, name: ast::Name<'s>) -> bool {
        self.signature.is_some()
            // What the POU itself has of the name is meant.
            && self.own_routine(name).is_none()
            && self.decl.pous[slot].ast.kind == ast::PouKind::Program
            && self.decl.dialect(name.span).calls_programs()
    }

    /// A FUNCTION's own name is its result.
    pub(super) fn result_variable(&self, name: ast::Name<'s>) -> Option<Variable<'s>> {
        let signature = self.signature.as_ref()?;
        let (id, resolved) = signature.result.as_ref()?;
        let local = &self.locals[id.index()];
        local.name.eq_ignore_ascii_case(name.text).then(|| Variable {
            name,
            declared: None,
            place: Place::local(*id, resolved.ty),
            resolved: Rc::new(resolved.clone()),
            section: Section::Internal,
            constant: false,
            retain: false,
            used: Rc::default(),
        })
    }

    /// Notes that a name means the POU around: its result.
    fn note_own_pou(&self, name: ast::Name<'s>) {
        if let Some(slot) = self.slot {
            self.decl.note_pou(name, slot);
        }
    }

    fn declared_but_refused(&self, name: ast::Name<'s>) -> bool {
        // The variables of a block are in the order of the source.
        let place = |span: Span| (span.file, span.start);
        let own = self.decl.written_pous().iter().filter(|it| self.signature.is_none() && it.ast.home.is_none());
        let pou = own.filter(|it| place(it.ast.span) <= place(name.span)).max_by_key(|it| place(it.ast.span));
        pou.is_some_and(|pou| {
            pou.ast.blocks.iter().any(|block| {
                let after = block.vars.partition_point(|it| place(it.span) <= place(name.span));
                let variable = after.checked_sub(1).map(|at| &block.vars[at]);
                variable.is_some_and(|it| it.names.iter().any(|it| it.span == name.span))
            })
        })
    }

    fn variable_place(&mut self, name: ast::Name<'s>, sought: Missing) -> Option<Found<'s>> {
        let Some(found) = self.find_variable(name) else {
            self.unknown_name(name, sought);
            return None;
        };
        let variable = found?;
        Some(self.found(&variable, name))
    }

    fn found(&self, variable: &Variable<'s>, name: ast::Name<'s>) -> Found<'s> {
        let access = match variable.section {
            _ if variable.constant => Access::Constant(name),
            Section::Input if self.signature.is_some() => Access::OwnInput(name),
            Section::Input
            | Section::Output
            | Section::InOut
            | Section::Internal
            | Section::Temp
            | Section::Global
            | Section::External => Access::Write,
        };
        let (place, view) = self.decl.image.stored(&variable.place);
        Found { place, view: view.map(Window::from), access }
    }

    fn member(&mut self, whole: &ast::Expr<'s>, base: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<Found<'s>> {
        if let Some(variable) = self.global_of_namespace(whole) {
            return variable.map(|it| self.found(&it, name));
        }
        if is_super(base) && self.extends() || self.is_this_of_program(base) {
            return self.member_of_this(name);
        }
        if let Some(this) = self.this_of(base) {
            return match (self.this_structure.is_some(), this?) {
                (true, structure) => {
                    let Type::Struct(id) = structure.place.ty else { return None };
                    self.struct_member(structure, id, name)
                }
                (false, _) => self.member_of_this(name),
            };
        }
        let found = self.owner(base)?;
        self.offer_members(name, self.type_of(&found));
        if self.is_unknown_head(self.type_of(&found), name) {
            return None;
        }
        if let Some(part) = self.bit_by_name(self.type_of(&found), name) {
            return part.map(|it| selected(found, it));
        }
        match self.type_of(&found) {
            Type::Struct(id) => self.struct_member(found, id, name),
            Type::Block(id) => self.pin(found, id, name),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => {
                let of_text = matches!(self.type_of(&found), Type::String(_)).then(|| self.help_on_text_member(name));
                let ty = self.type_name(self.type_of(&found));
                let error = Diagnostic::new(Code::E0107, name.span, format!("{ty} has no members"))
                    .label(format!("{ty} cannot have a member `{}`", name.text));
                let length = self.function_for_length(base, name, self.type_of(&found));
                let whole = Span { start: base.span.start, ..name.span };
                self.report(match (of_text.flatten(), length) {
                    (Some(help), _) => error.help(help),
                    (None, Some(length)) => error.help(format!("write `{length}`")).fix(whole, length),
                    (None, None) => self.through_reference(error, self.type_of(&found), base, name),
                });
                None
            }
        }
    }

    /// `p.x` of a POINTER TO or REF_TO what has an `x`: how to follow it.
    fn through_reference(&self, error: Diagnostic, ty: Type, base: &ast::Expr<'s>, name: ast::Name<'s>) -> Diagnostic {
        let Type::Reference(id) = ty else { return error };
        if self.decl.interface_of(ty).is_some() {
            return error;
        }
        let target = self.decl.program.target(id);
        if !matches!(target, Type::Struct(_) | Type::Block(_)) {
            return error;
        }
        let text = self.decl.log.sources.text(base.span);
        let (to, target) = (Span { start: base.span.end, end: name.span.start, ..name.span }, self.type_name(target));
        let error = error.help(format!("what it refers to, a {target}, has them: write `{text}^.{}`", name.text));
        error.fix(to, "^.")
    }

    fn struct_member(&mut self, found: Found<'s>, id: StructId, name: ast::Name<'s>) -> Option<Found<'s>> {
        let instance = self.decl.is_instance(id);
        if self.is_refused_member(id, name) {
            return None;
        }
        if let Some(declared) = self.in_out_of(id, name) {
            let owner = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(Code::E0109, name.span, format!("`{}` is a VAR_IN_OUT of `{owner}`", name.text))
                    .label("it stands for a variable of the caller, and only during a call")
                    .other(declared, "declared here")
                    .help(format!("use the variable that the call is given: `{} := variable`", name.text)),
            );
            return None;
        }
        self.decl.note_member(name, id);
        if let Some(overlay) = self.overlay(&found, id, name) {
            return Some(overlay);
        }
        let Some(at) = self.decl.field_named(id, name.text).map(FieldId::index) else {
            if let Some(shared) = self.shared_member(&found.place, id, name) {
                return shared;
            }
            let near = nearest(name.text, self.decl.members_of(id)).map(str::to_owned);
            self.decl.unknown_member(name, Type::Struct(id), near.as_deref());
            return None;
        };
        if found.view.is_some() {
            return Some(self.member_of_view(found, id, FieldId::next(at)));
        }
        let fields = &self.decl.program.structure(id).fields;
        let (ty, section, constant) = (fields[at].ty, fields[at].section, fields[at].constant);
        let is_own = instance && !is_pin(section);
        if is_own {
            self.note_used(id, name);
        }
        let declared = if is_own { self.declared_member(id, name) } else { None };
        if let Some(declared) = declared {
            self.may_reach(declared, name)?;
        }
        let inner = is_own && declared.is_none();
        let sees_all = self.sees_all();
        if inner && !sees_all && self.seen_from_outside(id, name).is_none() {
            if self.is_refused_routine(id, name) {
                return None;
            }
            let owner = self.type_name(found.place.ty);
            let message = format!("`{}` is an internal variable of `{owner}`", name.text);
            let error = Diagnostic::new(Code::E0109, name.span, message)
                .label("only inputs and outputs can be reached from outside");
            let declared = self.decl.slot_of_instance(id).map(|it| self.decl.pous[it].ast.name.span.file);
            let is_own = declared.is_some_and(|it| !self.decl.log.sources.get(it).is_bundled());
            let help = "declare it in VAR_OUTPUT to read it from outside, or in VAR_INPUT to set it";
            self.report(if is_own { error.help(help) } else { error });
            return None;
        }
        let access = match section {
            _ if matches!(found.access, Access::Inner(_) | Access::Result) => found.access,
            _ if constant => Access::Constant(name),
            _ if sees_all => Access::Write,
            _ if inner && self.decl.dialect(name.span).writes_inner_variables() => {
                // Others than the class's own routines may write them.
                self.decl.table.copies.set(true);
                Access::Write
            }
            _ if inner => Access::Inner(name),
            Section::Output if instance => Access::Output(name),
            // A structure in a constant stays constant; an instance's input is for its callers.
            _ if instance => Access::Write,
            _ => found.access,
        };
        Some(Found { place: found.place.field(FieldId::next(at), ty), view: None, access })
    }

    /// Whether a METHOD was refused since a variable has its name.
    fn is_refused_routine(&self, id: StructId, name: ast::Name<'s>) -> bool {
        let slot = self.decl.slot_of_instance(id);
        let mut routines = slot.into_iter().flat_map(|it| &self.decl.pous[it].ast.routines);
        routines.any(|it| it.name.text.eq_ignore_ascii_case(name.text))
    }

    /// A variable is used that is reached from outside of its class.
    fn note_used(&mut self, id: StructId, name: ast::Name<'s>) -> Option<()> {
        let slot = self.decl.slot_of_instance(id)?;
        self.decl.signature(slot)?.scope.get(name.text)?.used.set(true);
        Some(())
    }

    /// A variable of an instance that a dialect lets others read, or that a test sees.
    fn seen_from_outside(&mut self, id: StructId, name: ast::Name<'s>) -> Option<Rc<Variable<'s>>> {
        let dialect = self.decl.dialect(name.span);
        if !dialect.shows_inner_variables() && !dialect.writes_inner_variables() && !self.sees_all() {
            return None;
        }
        let slot = self.decl.slot_of_instance(id)?;
        let variable = Rc::clone(self.decl.signature(slot)?.scope.get(name.text)?);
        let own = !matches!(variable.section, Section::External | Section::InOut | Section::Temp);
        variable.used.set(true);
        own.then_some(variable)
    }

    /// A member that all instances share: it has an address, or is VAR_STAT.
    fn shared_member(&mut self, instance: &Place, id: StructId, name: ast::Name<'s>) -> Option<Option<Found<'s>>> {
        let variable = self.seen_from_outside(id, name).filter(|it| it.place.root == Root::Globals)?;
        // Nothing would check the index of an element whose own storage is not looked at.
        if instance.indices().any(|it| it.as_const().is_none()) {
            let owner = self.type_name(Type::Struct(id));
            self.report(
                Diagnostic::new(
                    Code::E0902,
                    name.span,
                    format!("`{}` cannot be read through an element whose index is not constant", name.text),
                )
                .label(format!("all instances of `{owner}` share it"))
                .other(variable.name.span, "declared here")
                .help("read it through an instance by itself, or an element with a constant index"),
            );
            return Some(None);
        }
        let access = match variable.section {
            _ if variable.constant => Access::Constant(name),
            _ if self.sees_all() => Access::Write,
            Section::Input => Access::Write,
            Section::Output => Access::Output(name),
            Section::Internal | Section::Global | Section::InOut | Section::Temp | Section::External => {
                Access::Inner(name)
            }
        };
        self.decl.log.note_declared(name.span, variable.name.span);
        let (place, view) = self.decl.image.stored(&variable.place);
        Some(Some(Found { place, view: view.map(Window::from), access }))
    }

    /// Where the VAR_IN_OUT `name` of an instance is declared.
    fn in_out_of(&mut self, id: StructId, name: ast::Name<'s>) -> Option<Span> {
        let slot = self.decl.slot_of_instance(id)?;
        let signature = self.decl.signature(slot)?;
        let is_meant = |it: &&crate::types::signature::Formal<'s>| {
            it.section == Section::InOut && it.name.text.eq_ignore_ascii_case(name.text)
        };
        signature.formals.iter().find(is_meant).map(|it| it.name.span)
    }

    /// Whether the member was declared, but refused.
    pub(crate) fn is_refused_member(&mut self, id: StructId, name: ast::Name<'s>) -> bool {
        let signature = self.decl.slot_of_instance(id).and_then(|slot| self.decl.signature(slot));
        signature.is_some_and(|it| it.scope.is_refused(name.text))
    }

    fn pin(&mut self, found: Found<'s>, id: BlockId, name: ast::Name<'s>) -> Option<Found<'s>> {
        let pins = id.info().pins;
        let visible = |pin: &&staunch_runtime::Pin| pin.direction != Direction::Memory;
        let own = self.own_pin_name(id, name);
        let at = pins.iter().position(|it| visible(&it) && it.name.eq_ignore_ascii_case(own.text));
        let Some(at) = at else {
            self.report(super::unresolved::unknown_pin(self.decl.dialect(name.span), id, name));
            return None;
        };
        let access = match found.access {
            Access::Inner(_) | Access::Result => found.access,
            _ if pins[at].direction == Direction::Output && !self.is_test() => Access::Output(name),
            Access::Write | Access::Constant(_) | Access::OwnInput(_) | Access::Output(_) => Access::Write,
        };
        self.decl.log.note(name.span, || Named::Pin(id, at));
        let field = FieldId::next(at);
        Some(Found { place: found.place.field(field, id.pin_type(field)?), view: None, access })
    }

    fn index(&mut self, base: &ast::Expr<'s>, indices: &[ast::Expr<'s>]) -> Option<Found<'s>> {
        let mut found = self.place_or_view(base)?;
        for index in indices {
            if let Some(element) = self.element_of_pointer(&found, index) {
                found = element?;
                continue;
            }
            let Type::Array(id) = self.type_of(&found) else {
                let ty = self.type_name(self.type_of(&found));
                let error = Diagnostic::new(Code::E0302, index.span, format!("{ty} cannot be indexed here"))
                    .label("one index too many, or not an array");
                let (text, at) = (self.decl.log.sources.text(base.span), self.decl.log.sources.text(index.span));
                self.report(match self.type_of(&found) {
                    Type::String(_) if indices.len() == 1 && has_characters(self.decl.dialect(index.span)) => {
                        Diagnostic::new(Code::E0306, index.span, format!("`{text}[{at}]` is not a separate variable"))
                            .label("a character of a string can only be read, or assigned with `:=`")
                            .help("use a separate variable here, and assign it")
                    }
                    Type::String(_) => {
                        let at = character(at);
                        let reads = format!("read one character with `MID({text}, 1, {at})`");
                        error.help(format!("{reads}, change it with `{text} := REPLACE({text}, 'x', 1, {at})`"))
                    }
                    Type::Elementary(it) if it.is_bits() && it != Elementary::Bool => {
                        error.help(match at.bytes().all(|it| it.is_ascii_digit()) {
                            true => format!("a bit is written `{text}.{at}`"),
                            false => format!(
                                "the number of a bit is constant, `{text}.0`; with a variable write `(SHR({text}, {at}) AND {0}#1) = {0}#1`",
                                it.name()
                            ),
                        })
                    }
                    Type::Elementary(_)
                    | Type::Reference(_)
                    | Type::Subrange(..)
                    | Type::Enum(_)
                    | Type::Struct(_)
                    | Type::Block(_)
                    | Type::Array(_) => error,
                });
                return None;
            };
            let Found { place, access, view } = found;
            let mut place = place;
            let (mark, written) = (self.block.len(), self.kept_order(&place));
            let index_value = self.after_place(&mut place, |this| this.index_value(index, id))?;
            self.note_siblings(mark, Some(&index_value));
            self.note_reordered(mark, written.as_ref(), index.span);
            let at = self.at(index.span);
            if view.is_some() {
                found = self.element_of_view(Found { place, view, access }, id, index_value, at);
                continue;
            }
            let element = self.decl.program.array(id).element;
            found = Found { place: place.index(index_value, element, at), view: None, access };
        }
        Some(found)
    }

    /// An index as LINT; a constant one is checked now.
    pub(super) fn index_value(&mut self, index: &ast::Expr<'s>, id: ArrayId) -> Option<Expr> {
        let array = self.decl.program.array(id);
        let value = self.integer_index(index)?;
        if array.is_open() {
            return self.as_lint(value, index.span);
        }
        if let Some(number) = value.as_const().and_then(Value::as_integer)
            && !(i128::from(array.low)..=i128::from(array.high)).contains(&number)
        {
            self.report(
                Diagnostic::new(Code::E0208, index.span, format!("the index {number} is out of range"))
                    .label(format!("the array goes from {} to {}", array.low, array.high)),
            );
            return None;
        }
        self.index_of_subrange(&value, array, index.span);
        self.as_lint(value, index.span)
    }

    /// An integer that chooses something.
    pub(super) fn integer_index(&mut self, index: &ast::Expr<'s>) -> Option<Expr> {
        let value = self.typed(index, None)?;
        match value.ty {
            Type::Elementary(it) if it.is_integer() || (it.is_bits() && it != Elementary::Bool) => Some(value),
            Type::Enum(id) if self.is_counted_by(id, index.span) => {
                let base = Type::Elementary(self.decl.program.enumeration(id).base);
                Some(self.convert(staunch_ir::Conversion::Same, base, value))
            }
            other => {
                let found = self.type_name(other);
                self.report(
                    Diagnostic::new(
                        Code::E0201,
                        index.span,
                        format!("an index must be an integer, but this is {found}"),
                    )
                    .label("expected an integer"),
                );
                None
            }
        }
    }

    /// Reports an index whose subrange holds values that the array has not.
    fn index_of_subrange(&mut self, index: &Expr, array: Array, span: Span) {
        let Some((low, high)) = self.decl.program.range(index.declared()) else { return };
        if i128::from(array.low) <= low && high <= i128::from(array.high) {
            return;
        }
        let ty = self.type_name(index.declared());
        self.report(
            Diagnostic::new(Code::W0515, span, format!("the index is {}", crate::diagnostic::wording::article(&ty)))
                .label(format!("the array goes from {} to {}: an index outside is a fault", array.low, array.high))
                .help("give the subrange and the array the same limits"),
        );
    }

    /// Any integer as LINT; a ULINT beyond LINT becomes the largest LINT, which no array holds.
    pub(super) fn as_lint(&mut self, value: Expr, span: Span) -> Option<Expr> {
        let value = if self.decl.program.repr(value.ty) == Some(staunch_ir::Repr::U64) {
            let (ty, at) = (value.ty, value.at);
            let most = Expr::new(ty, staunch_ir::ExprKind::Const(Value::U64(u64::MAX >> 1)), at);
            self.apply(Op::Min, ty, vec![value, most], ty, span)?
        } else {
            value
        };
        Some(self.convert(staunch_ir::Conversion::Value, Type::LINT, value))
    }

    /// Refuses a write where the place may not be written.
    pub(crate) fn writable(&mut self, found: &Found<'s>, span: Span) -> bool {
        self.may_be_given_away(found, span) && self.is_no_input_address(found, span)
    }

    /// Reports an assignment to what the hardware sets before each scan.
    pub(crate) fn is_no_input_address(&mut self, found: &Found<'s>, span: Span) -> bool {
        let address = found.view.and_then(|it| it.address).or_else(|| self.address_of(&found.place));
        let Some(address) = address.filter(|it| it.area == Area::Input) else { return true };
        let refused = self.decl.dialect(span).protects_inputs();
        // A test is what sets the inputs; in TwinCAT a suite may not.
        if self.is_test() || !refused && self.is_of_tests() {
            return true;
        }
        let code = if refused { Code::E0511 } else { Code::W0509 };
        self.report(
            Diagnostic::new(code, span, format!("this assigns to the input address `{address}`"))
                .label("the next scan's input overwrites it")
                .help("assign to a variable without an address, or to an output, `%Q`"),
        );
        !refused
    }

    /// The direct address of the variable that a place is, or is a part of.
    fn address_of(&self, place: &Place) -> Option<Address> {
        let Some(staunch_ir::Projection::Field(field)) = place.projections.first() else { return None };
        match place.root {
            Root::Globals => self.decl.program.structure(self.decl.program.globals).fields.get(field.index())?.address,
            Root::Instance => {
                let state = self.signature.as_ref()?.state?;
                self.decl.program.structure(state).fields.get(field.index())?.address
            }
            Root::Local(_) | Root::Param(_) => None,
        }
    }

    /// Whether the body is that of FB_init, which gives an instance its first values.
    fn is_start(&self) -> bool {
        self.slot.is_some_and(|it| crate::start::is_initial(self.decl.pous[it].ast.name))
    }

    /// In the METHOD that the compiler makes to start an instance.
    fn is_start_of_instance(&self) -> bool {
        self.slot.is_some_and(|it| self.decl.pous[it].ast.name.text == crate::start::START)
    }

    /// Whether a place may be given to a call that may write to it.
    pub(crate) fn may_be_given_away(&mut self, found: &Found<'s>, span: Span) -> bool {
        if self.is_counter(&found.place, found.view) {
            return self.report_counter(span);
        }
        match found.access {
            Access::Write => true,
            // The address that its declaration gives it.
            Access::OwnInput(_) if self.is_start_of_instance() => true,
            Access::Constant(name) => {
                self.report(
                    Diagnostic::new(Code::E0501, span, format!("`{}` is a CONSTANT", name.text))
                        .label("a constant cannot be assigned to")
                        .help("assign to another variable, or delete CONSTANT where it is declared"),
                );
                false
            }
            // A FUNCTION's input is a copy, and CODESYS code uses it as a variable.
            Access::OwnInput(_) if self.decl.dialect(span).uses_inputs() && (is_copy(found) || self.is_start()) => true,
            Access::OwnInput(name) => {
                self.report(
                    Diagnostic::new(Code::W0504, span, format!("the input `{}` is assigned inside its POU", name.text))
                        .label("the caller's value is lost")
                        .help("assign to a variable of your own, or declare it VAR_IN_OUT"),
                );
                true
            }
            Access::Output(name) => {
                self.report(
                    Diagnostic::new(Code::E0504, span, format!("`{}` is an output", name.text))
                        .label("only the block itself sets its outputs"),
                );
                false
            }
            Access::Result => {
                self.report(
                    Diagnostic::new(Code::E0306, span, "a variable is expected here")
                        .label("this is a value, the result of a call")
                        .help("copy it to a variable first"),
                );
                false
            }
            Access::Inner(name) => {
                self.report(
                    Diagnostic::new(Code::E0109, span, format!("`{}` is an internal variable", name.text))
                        .label("from outside it can only be read"),
                );
                false
            }
        }
    }

    fn report_counter(&mut self, span: Span) -> bool {
        let lint = self.decl.dialect(span).assigns_counters();
        let code = if lint { Code::W0505 } else { Code::E0503 };
        self.report(
            Diagnostic::new(code, span, "the counter of a FOR loop is assigned inside the loop")
                .label("the loop itself advances it")
                .help("use WHILE to decide the next value yourself, or EXIT to leave the loop"),
        );
        lint
    }
}

/// Whether an input is the callee's own copy.
fn is_copy(found: &Found<'_>) -> bool {
    matches!(found.place.root, Root::Local(_))
}

fn is_pin(section: Section) -> bool {
    matches!(section, Section::Input | Section::Output)
}

/// The place that functions on text count from 1, for an index: 0 stands for the first character.
fn character(index: &str) -> &str {
    if index.trim() == "0" { "1" } else { index }
}
