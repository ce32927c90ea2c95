//! Calls of METHODs and ACTIONs, and uses of PROPERTYs: on which instance, and who may make them.

use super::checker::Checker;
use super::generic_call::Called;
use super::place::{Access, Found};
use crate::inherit::is_super;
use crate::names::{self, Entry, Meaning, Sense};
use crate::spelling::{Key, nearest};
use crate::types::declarations::{Routines, Slot};
use crate::{Code, Diagnostic, Span, ast};
use ast::{ExprKind as Ast, PouKind};
use staunch_ir::{Expr, ExprKind, Place, RefKind, Root, Section, Type};

impl<'s> Checker<'_, 's> {
    /// The METHOD or ACTION that a bare name means: one of the POU around.
    pub(crate) fn own_routine(&self, name: ast::Name<'s>) -> Option<usize> {
        Some(self.own_routines(name)?.called?.0)
    }

    /// The routines of the POU around that a name means. An inherited routine does not see what heirs add.
    fn own_routines(&self, name: ast::Name<'s>) -> Option<Routines> {
        let home = &self.decl.pous[self.decl.home(self.slot?)];
        home.routines.get(&Key(name.text))?;
        self.decl.routines_of(self.signature.as_ref()?.state?, name.text)
    }

    /// Whether the class around extends another, which SUPER then means.
    pub(crate) fn extends(&self) -> bool {
        self.slot.is_some_and(|it| self.decl.pous[self.decl.home(it)].ast.extends.is_some())
    }

    /// Whether the class around extends what is not known.
    pub(crate) fn is_of_unknown_base(&self) -> bool {
        self.slot.is_some_and(|it| self.decl.has_unknown_base(self.decl.pous[it].owner.unwrap_or(it)))
    }

    /// Of the METHODs that a call may mean, by the first of them, the one that its arguments fit.
    pub(crate) fn meant_routine(
        &mut self,
        first: usize,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<usize> {
        let all = self.methods_of_call(callee);
        let name = match &callee.kind {
            Ast::Member(_, name) => name.span,
            _ => callee.span,
        };
        match all.as_slice() {
            [] => Some(first),
            [one] => Some(*one),
            several => self.meant_of(several, name, arguments, expected),
        }
    }

    /// The METHODs that a call may mean by its name.
    fn methods_of_call(&self, callee: &ast::Expr<'s>) -> Vec<usize> {
        match &callee.kind {
            Ast::Member(base, name) if is_super(base) => {
                self.slot.map_or_else(Vec::new, |it| self.decl.super_slots(it, *name))
            }
            Ast::Member(base, name) if is_this_instance(base) && self.this_structure.is_none() => {
                self.own_methods(*name)
            }
            Ast::Member(base, name) => {
                self.static_type(base).map_or_else(Vec::new, |it| self.decl.methods_on(it, name.text))
            }
            Ast::Name(name) => self.own_methods(*name),
            _ => Vec::new(),
        }
    }

    /// The METHODs of the POU around that a name may mean: those that the routine's own class has, as the instance's
    /// class has them.
    fn own_methods(&self, name: ast::Name<'s>) -> Vec<usize> {
        let Some(slot) = self.slot else { return Vec::new() };
        let (home, class) = (self.decl.home(slot), self.decl.pous[slot].owner.unwrap_or(slot));
        let first = self.decl.pous[home].routines.get(&Key(name.text)).and_then(|it| it.called);
        let all = first.into_iter().flat_map(|it| self.decl.all_of_a_name(it.0));
        all.filter_map(|it| self.decl.routine_for(class, it)).collect()
    }

    /// What SUPER means, with or without a name after it.
    pub(crate) fn super_callee(&mut self, name: Option<ast::Name<'s>>, span: Span) -> Option<usize> {
        let slot = self.slot?;
        let found = self.decl.super_routines(slot, name).and_then(|it| it.called);
        if found.is_none() && !self.is_of_unknown_base() {
            let home = self.decl.pous[self.decl.home(slot)].ast;
            let error = match (home.extends, name) {
                (Some(base), Some(name)) => {
                    let error = Diagnostic::new(
                        Code::E0107,
                        name.span,
                        format!("`{}` has no METHOD `{}`", base.text, name.text),
                    )
                    .label("unknown member");
                    let inherited = self.decl.routines_of_base(slot);
                    match nearest(name.text, inherited.iter().map(|it| it.name.text)) {
                        Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
                        None => error,
                    }
                }
                (Some(base), None) => {
                    Diagnostic::new(Code::E0305, span, format!("`{}` has no body to call", base.text))
                }
                (None, _) => {
                    Diagnostic::new(Code::E0101, span, format!("`{}` does not extend anything", home.name.text))
                        .label("SUPER means the FUNCTION_BLOCK that this one extends")
                }
            };
            self.report(error);
        }
        let (routine, _) = found?;
        if self.decl.pous[routine].ast.modifiers.is_abstract.is_some() {
            self.report_abstract_super(routine, name.map_or(span, |it| it.span));
            return None;
        }
        if let Some(name) = name {
            self.decl.note_pou(name, routine);
        }
        Some(routine)
    }

    fn report_abstract_super(&mut self, routine: usize, span: Span) {
        let &ast::Pou { name: declared, kind, .. } = self.decl.pous[routine].ast;
        let word = if matches!(kind, PouKind::Getter | PouKind::Setter) { "PROPERTY" } else { "METHOD" };
        self.report(
            Diagnostic::new(Code::E0320, span, format!("`{}` is ABSTRACT, so SUPER cannot call it", declared.text))
                .label(format!("this {word} has no body"))
                .other(declared.span, "declared here without a body")
                .help(format!("delete the call, or declare the {word} without ABSTRACT and write its body")),
        );
    }

    /// Whether SUPER asks for the GET or SET of an ABSTRACT PROPERTY, which is reported.
    fn is_abstract_super(&mut self, accessor: usize, property: &ast::Expr<'s>, name: ast::Name<'s>) -> bool {
        let by_super = matches!(&property.bare().kind, Ast::Member(instance, _) if is_super(instance));
        let is_abstract = by_super && self.decl.pous[accessor].ast.modifiers.is_abstract.is_some();
        if is_abstract {
            self.report_abstract_super(accessor, name.span);
        }
        is_abstract
    }

    /// The PROPERTY that an expression means, with the instance that is written before its name.
    pub(crate) fn property<'a>(
        &self,
        expr: &'a ast::Expr<'s>,
    ) -> Option<(Routines, ast::Name<'s>, Option<&'a ast::Expr<'s>>)> {
        if self.decl.properties.is_empty() {
            return None;
        }
        let (ty, name, instance) = match &expr.kind {
            Ast::Name(name) | Ast::Member(_, name) if !self.decl.properties.contains(&Key(name.text)) => return None,
            Ast::Name(name) if self.scope.get(name.text).is_none() && !self.is_own_result(*name) => {
                let routines = self.own_routines(*name)?;
                return routines.is_property().then_some((routines, *name, None));
            }
            Ast::Member(instance, name) if is_super(instance) => {
                let routines = self.decl.super_routines(self.slot?, Some(*name))?;
                return routines.is_property().then_some((routines, *name, None));
            }
            Ast::Member(instance, name) => (self.static_type(instance)?, *name, Some(&**instance)),
            Ast::Paren(inner) => return self.property(inner),
            Ast::Name(_)
            | Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Index(..)
            | Ast::Deref(_)
            | Ast::Call(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Assign(..)
            | Ast::Error(_) => return None,
        };
        let routines = self.decl.routines_on(ty, name.text)?;
        routines.is_property().then_some((routines, name, instance))
    }

    fn is_own_result(&self, name: ast::Name<'s>) -> bool {
        let result = self.signature.as_ref().and_then(|it| it.result.as_ref());
        result.is_some_and(|(id, _)| self.locals[id.index()].name.eq_ignore_ascii_case(name.text))
    }

    /// What a PROPERTY gives; the inner `None` says that it was reported.
    pub(crate) fn property_value(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Found<'s>>> {
        let (routines, name, instance) = self.property(expr)?;
        let Some((slot, _)) = routines.getter else {
            self.report_no_accessor(name, "GET", "read", routines.setter);
            return Some(None);
        };
        if self.is_abstract_super(slot, expr, name) {
            return Some(None);
        }
        Some(self.accessor(slot, name, instance, &[], expr.span).and_then(|it| self.result_place(it?, expr.span)))
    }

    /// Assigns to a PROPERTY; `None` where the target is none, or what the reference that it gives leads to.
    pub(crate) fn assign_property(
        &mut self,
        target: &ast::Expr<'s>,
        value: &ast::Expr<'s>,
        span: Span,
    ) -> Option<Option<()>> {
        let (routines, ..) = self.property(target)?;
        if self.gives_reference(routines) {
            return None;
        }
        self.set_property(target, value, span)
    }

    /// Whether reading a PROPERTY gives a REFERENCE TO: `:=` writes what that refers to, `REF=` the PROPERTY.
    fn gives_reference(&self, routines: Routines) -> bool {
        let given = routines.getter.and_then(|it| self.decl.result_type(it.0));
        let Some(Type::Reference(id)) = given else { return false };
        self.decl.program.references[id.index()].kind == RefKind::ReferenceTo
    }

    /// Calls the SET of a PROPERTY; `None` where the target is none.
    pub(crate) fn set_property(
        &mut self,
        target: &ast::Expr<'s>,
        value: &ast::Expr<'s>,
        span: Span,
    ) -> Option<Option<()>> {
        let (routines, name, instance) = self.property(target)?;
        let Some((slot, _)) = routines.setter else {
            self.report_no_accessor(name, "SET", "assigned", routines.getter);
            self.operand(value, None);
            return Some(None);
        };
        if self.is_abstract_super(slot, target, name) {
            return Some(None);
        }
        let value = ast::Argument { kind: ast::ArgumentKind::Positional(value.clone()), span: value.span };
        Some(self.accessor(slot, name, instance, &[value], span).map(drop))
    }

    fn accessor(
        &mut self,
        slot: usize,
        name: ast::Name<'s>,
        instance: Option<&ast::Expr<'s>>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Expr>> {
        if self.signature.is_none() {
            self.report(self.not_constant_here(span));
            return None;
        }
        self.decl.note_pou(name, slot);
        self.may_call(slot, name)?;
        let found = match instance {
            Some(instance) if !self.is_this_of_program(instance) => self.place(instance)?,
            Some(_) | None => self.this()?,
        };
        if !(arguments.is_empty() && self.is_constant_in_out(&found)) {
            self.may_call_method(&found, span)?;
        }
        let called = Called { slot, name, expected: None, span };
        self.user_function(called, Some((found.place, span)), arguments)
    }

    pub(crate) fn may_call_method(&mut self, found: &Found<'s>, span: Span) -> Option<()> {
        match found.access {
            Access::Inner(_) if self.decl.dialect(span).calls_inner_methods() => Some(()),
            _ => self.callable(found, span),
        }
    }

    /// Whether it is an instance that is given for a VAR_IN_OUT CONSTANT: it is the caller's, with its METHODs.
    pub(super) fn is_constant_in_out(&self, found: &Found<'s>) -> bool {
        let Access::Constant(name) = found.access else { return false };
        let variable = self.scope.get(name.text).filter(|it| it.section == Section::InOut);
        variable.is_some_and(|it| it.place.root == found.place.root && !self.decl.program.is_open(it.place.ty))
    }

    fn report_no_accessor(&mut self, name: ast::Name<'s>, word: &str, use_: &str, other: Option<(usize, Span)>) {
        let class = other.and_then(|it| self.decl.pous[it.0].owner);
        if class.is_some_and(|it| self.decl.has_unknown_parts(it)) {
            // It may be the base's.
            return;
        }
        let mut error = Diagnostic::new(Code::E0504, name.span, format!("the PROPERTY `{}` has no {word}", name.text))
            .label(format!("so it cannot be {use_}"));
        if let Some((_, span)) = other {
            error = error.other(span, "declared here");
        }
        self.report(error.help(format!("add `{word} … END_{word}` to it")));
    }

    /// The place of what a call gave: it can be read, and what it refers to be followed.
    pub(super) fn result_place(&mut self, value: Expr, span: Span) -> Option<Found<'s>> {
        let place = match value.kind {
            ExprKind::Load(place) => place,
            ExprKind::Const(_)
            | ExprKind::Text(_)
            | ExprKind::Aggregate(_)
            | ExprKind::AddressOf(_)
            | ExprKind::Apply(..)
            | ExprKind::ApplyText(..)
            | ExprKind::Convert(..) => {
                let place = self.temporary("result", value.ty);
                self.assign(place.clone(), value, span);
                place
            }
        };
        Some(Found { place, view: None, access: Access::Result })
    }

    /// What a call of a FUNCTION or METHOD gives, as the start of a longer name: `a.b().c`.
    pub(crate) fn called_place(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Found<'s>>> {
        let Ast::Call(callee, arguments) = &expr.kind else { return None };
        self.static_type(expr)?;
        let value = self.call_value(expr, callee, arguments, None);
        Some(value.and_then(|it| self.materialise(it, None, expr.span)).and_then(|it| self.result_place(it, expr.span)))
    }

    /// The METHOD or ACTION that `instance.name` means.
    pub(crate) fn routine_of(&self, instance: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<usize> {
        Some(self.decl.routines_on(self.static_type(instance)?, name.text)?.called?.0)
    }

    /// Whether an expression is the name of a PROGRAM, which alone calls it.
    pub(crate) fn is_program_by_name(&self, expr: &ast::Expr<'s>) -> bool {
        let is_outside = expr.first_name().is_some_and(|it| self.scope.get(it.text).is_none());
        let Some(path) = is_outside.then(|| expr.path()).flatten() else { return false };
        match self.decl.lookup(&path, Sense::Value) {
            names::Found::One(Meaning::Declared(Entry::Pou(slot))) => {
                path.last().is_some_and(|it| self.is_callable_program(slot, *it))
            }
            names::Found::One(_) | names::Found::Several(_) | names::Found::Nothing => false,
        }
    }

    /// Whether an expression names an ACTION, in dialects that call one by that.
    pub(crate) fn is_action_by_name(&self, expr: &ast::Expr<'s>) -> bool {
        let slot = match &expr.kind {
            _ if !self.decl.dialect(expr.span).calls_actions_by_name() => None,
            Ast::Name(name) => self.own_routine(*name).filter(|_| self.scope.get(name.text).is_none()),
            Ast::Member(instance, name) => self.routine_of(instance, *name),
            _ => None,
        };
        slot.is_some_and(|it| self.decl.pous[it].ast.kind == PouKind::Action)
    }

    pub(crate) fn routine_call(
        &mut self,
        slot: usize,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Expr>> {
        let found = match &callee.bare().kind {
            Ast::Member(instance, name) => {
                self.decl.note_pou(*name, slot);
                self.may_call(slot, *name)?;
                match is_super(instance) || self.is_this_of_program(instance) {
                    true => self.this()?,
                    false => self.place(instance)?,
                }
            }
            Ast::Name(name) => {
                self.decl.note_pou(*name, slot);
                self.may_call(slot, *name)?;
                self.this()?
            }
            Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Index(..)
            | Ast::Deref(_)
            | Ast::Call(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Assign(..)
            | Ast::Paren(_)
            | Ast::Error(_) => self.this()?,
        };
        match self.decl.pous[slot].ast.kind {
            PouKind::Method => {
                if !self.is_constant_in_out(&found) {
                    self.may_call_method(&found, callee.span)?;
                }
                let name = ast::Name { text: self.decl.pous[slot].ast.name.text, span: callee.span };
                let called = Called { slot, name, expected: None, span };
                self.user_function(called, Some((found.place, callee.span)), arguments)
            }
            PouKind::Action
            | PouKind::Program
            | PouKind::FunctionBlock
            | PouKind::Class
            | PouKind::Interface
            | PouKind::Function
            | PouKind::Getter
            | PouKind::Setter
            | PouKind::Test => self.user_block(found, slot, arguments, callee.span, span).map(|()| None),
        }
    }

    /// The instance whose routine this is.
    pub(crate) fn this(&self) -> Option<Found<'s>> {
        let instance = || Some(Place::root(Root::Instance, Type::Struct(self.signature.as_ref()?.state?)));
        let place = self.this_structure.clone().or_else(instance)?;
        Some(Found { place, view: None, access: Access::Write })
    }

    /// The type of what a place holds, found without calling, reporting or noting anything; a REFERENCE TO is
    /// what it refers to.
    pub(crate) fn static_type(&self, expr: &ast::Expr<'s>) -> Option<Type> {
        let ty = match &expr.kind {
            Ast::Name(name) => self.type_of_name(*name)?,
            Ast::Paren(inner) => self.static_type(inner)?,
            Ast::Member(owner, name) => self.type_of_member(owner, *name)?,
            Ast::Index(base, indices) => {
                let first = self.static_type(base)?;
                indices.iter().try_fold(first, |ty, index| self.type_of_element(ty, index.span))?
            }
            Ast::Deref(inner) if is_this(inner) => self.this()?.place.ty,
            Ast::Deref(inner) => {
                let Type::Reference(id) = self.static_type(inner)? else { return None };
                self.decl.program.target(id)
            }
            Ast::Call(callee, _) => self.decl.result_type(self.called_slot(callee)?)?,
            Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Assign(..)
            | Ast::Error(_) => {
                return None;
            }
        };
        match ty {
            Type::Reference(id) if self.decl.program.references[id.index()].kind == RefKind::ReferenceTo => {
                Some(self.decl.program.target(id))
            }
            other => Some(other),
        }
    }

    /// The type of an element of an array, or of what a POINTER TO leads to, where a dialect takes an index there.
    fn type_of_element(&self, ty: Type, index: Span) -> Option<Type> {
        match ty {
            Type::Array(id) => Some(self.decl.program.array(id).element),
            Type::Reference(_) => self.target_by_index(ty, index).map(|it| it.1),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Struct(_)
            | Type::Block(_) => None,
        }
    }

    /// The FUNCTION or METHOD that is called.
    fn called_slot(&self, callee: &ast::Expr<'s>) -> Option<usize> {
        match &callee.kind {
            Ast::Member(..) => match self.methods_of_call(callee) {
                none if none.is_empty() => self.function_of_path(&callee.path()?),
                methods => self.one_of(&methods),
            },
            Ast::Name(name) if self.own_routine(*name).is_some() => self.one_of(&self.methods_of_call(callee)),
            Ast::Name(name) => self.function_of_path(&[*name]),
            Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Index(..)
            | Ast::Deref(_)
            | Ast::Call(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Assign(..)
            | Ast::Paren(_)
            | Ast::Error(_) => None,
        }
    }

    fn function_of_path(&self, path: &[ast::Name<'s>]) -> Option<usize> {
        let is_variable = path.len() > 1 && self.scope.get(path[0].text).is_some();
        let found = self.decl.lookup(path, Sense::Callee);
        let names::Found::One(Meaning::Declared(Entry::Pou(slot))) = found else { return None };
        let is_function = self.decl.pous[slot].ast.kind == PouKind::Function && !is_variable;
        self.one_of(&self.decl.all_of_a_name(slot)).filter(|_| is_function)
    }

    /// Any of several with one type of result: which one is meant is not known without looking at the arguments.
    fn one_of(&self, all: &[usize]) -> Option<usize> {
        let first = all.first().copied()?;
        let result = self.decl.result_type(first);
        all.iter().all(|it| self.decl.result_type(*it) == result).then_some(first)
    }

    /// The type of a PROPERTY that can be read.
    fn type_of_property(&self, ty: Type, name: ast::Name<'s>) -> Option<Type> {
        self.decl.result_type(self.decl.routines_on(ty, name.text)?.getter?.0)
    }

    fn type_of_name(&self, name: ast::Name<'s>) -> Option<Type> {
        let own =
            Some(name).filter(|it| self.scope.get(it.text).is_none()).and_then(|it| self.own_routines(it)?.getter);
        if let Some((slot, _)) = own {
            return self.decl.result_type(slot);
        }
        if let Some(variable) = self.scope.get(name.text) {
            return Some(variable.place.ty);
        }
        if let Some(result) = self.result_variable(name) {
            return Some(result.place.ty);
        }
        if is_word(name, "THIS") {
            return Some(self.this()?.place.ty);
        }
        match self.decl.lookup(&[name], Sense::Value) {
            names::Found::One(Meaning::Declared(Entry::Global(_))) => self.decl.type_of_global(name),
            names::Found::One(Meaning::Declared(Entry::Pou(slot))) if self.is_callable_program(slot, name) => {
                Some(self.decl.program_variable(slot)?.place.ty)
            }
            names::Found::One(_) | names::Found::Several(_) | names::Found::Nothing => None,
        }
    }

    fn type_of_member(&self, owner: &ast::Expr<'s>, name: ast::Name<'s>) -> Option<Type> {
        if owner.first_name().is_some_and(|it| self.scope.get(it.text).is_none())
            && let Some(mut path) = owner.path()
        {
            path.push(name);
            match self.decl.lookup(&path, Sense::Value) {
                names::Found::One(Meaning::Declared(Entry::Global(at))) => {
                    let Slot::Done(variable) = &self.decl.globals[at].slot else { return None };
                    return Some(variable.place.ty);
                }
                names::Found::One(Meaning::Declared(Entry::Pou(slot))) if self.is_callable_program(slot, name) => {
                    return Some(self.decl.program_variable(slot)?.place.ty);
                }
                names::Found::One(_) | names::Found::Several(_) | names::Found::Nothing => {}
            }
        }
        if is_super(owner) && self.extends() {
            return self.type_of_super(name);
        }
        let ty = self.static_type(owner)?;
        if let Some(ty) = self.type_of_property(ty, name) {
            return Some(ty);
        }
        // An inherited routine means its own class's, where an heir has another of the name.
        if is_this_instance(owner) && self.this_structure.is_none() {
            return self.type_of_own_variable(name);
        }
        let Type::Struct(id) = ty else { return None };
        let field = self.decl.field_named(id, name.text)?;
        self.decl.program.member(ty, field)
    }

    /// Whether `SUPER^.name` is a variable that can be called.
    pub(crate) fn is_instance_of_super(&self, name: ast::Name<'s>) -> bool {
        let ty = if self.extends() { self.type_of_own_variable(name) } else { None };
        matches!(ty, Some(Type::Struct(_) | Type::Block(_) | Type::Reference(_)))
    }

    /// The type of `SUPER^.name`.
    fn type_of_super(&self, name: ast::Name<'s>) -> Option<Type> {
        match self.decl.super_routines(self.slot?, Some(name)).and_then(|it| it.getter) {
            Some((getter, _)) => self.decl.result_type(getter),
            None => self.type_of_own_variable(name),
        }
    }

    /// The type of a variable of the POU around.
    fn type_of_own_variable(&self, name: ast::Name<'s>) -> Option<Type> {
        let scope = self.scope.outer.as_ref().unwrap_or(&self.scope);
        scope.get(name.text).map(|it| it.place.ty)
    }

    /// Whether an expression is `THIS^` in a PROGRAM, which has variables and METHODs, and no address.
    pub(crate) fn is_this_of_program(&self, expr: &ast::Expr<'s>) -> bool {
        let is_program = || self.slot.is_some_and(|it| self.decl.pous[self.decl.home(it)].ast.kind == PouKind::Program);
        is_this_instance(expr)
            && self.this_structure.is_none()
            && self.decl.dialect(expr.span).has_this_of_programs()
            && is_program()
    }

    /// `THIS^`, and the standard's `THIS`; the inner `None` says that it was reported.
    pub(crate) fn this_of(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Found<'s>>> {
        let word = if let Ast::Deref(inner) = &expr.kind { inner.bare() } else { expr };
        let Ast::Name(name) = &word.kind else { return None };
        if !is_word(*name, "THIS") {
            return None;
        }
        if self.scope.get(name.text).is_some() {
            return None;
        }
        let this = self.this().filter(|_| self.this_structure.is_some() || self.is_function_block());
        if this.is_none() {
            let error = Diagnostic::new(Code::E0101, name.span, "THIS exists only in a FUNCTION_BLOCK")
                .label("no instance exists here");
            let holds = |it: Span| it.file == name.span.file && (it.start..it.end).contains(&name.span.start);
            let is_in_type = self.decl.types.iter().any(|it| holds(it.decl.ty.span));
            self.report(match is_in_type {
                true => error.help("a variable of this TYPE is declared outside FUNCTION_BLOCKs: declare it in one"),
                false => error,
            });
        }
        Some(this)
    }
}

/// Whether an expression is the word THIS.
pub(crate) fn is_this(expr: &ast::Expr<'_>) -> bool {
    matches!(&expr.bare().kind, Ast::Name(name) if is_word(*name, "THIS"))
}

/// `THIS^`, and the standard's `THIS`.
fn is_this_instance(expr: &ast::Expr<'_>) -> bool {
    match &expr.bare().kind {
        Ast::Deref(inner) => is_this(inner),
        _ => is_this(expr),
    }
}

fn is_word(name: ast::Name<'_>, word: &str) -> bool {
    name.text.eq_ignore_ascii_case(word)
}
