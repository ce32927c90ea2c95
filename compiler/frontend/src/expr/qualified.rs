//! Names with a namespace before them: `GVL.x`, `Plant.level`, `Plant.Colour.Red`, `Plant.Scale(x)`.

use super::callee::Callee;
use super::checker::Checker;
use crate::diagnostic::Holder;
use crate::dialect::{library, missing};
use crate::names::{Entry, Found, Meaning, Sense, SpaceId, functions};
use crate::prelude;
use crate::spelling::nearest;
use crate::types::scope::Variable;
use crate::{Code, Diagnostic, Fix, Span, ast};
use staunch_ir::Type;
use std::rc::Rc;

impl<'s> Checker<'_, 's> {
    /// Whether a path begins with a variable, or means something that is declared. A variable that cannot be called
    /// is none where something is called.
    pub(crate) fn means_anything(&self, path: &[ast::Name<'s>], sense: Sense) -> bool {
        if let ([name], Sense::Callee) = (path, sense) {
            return self.is_callable_variable(*name) || self.decl.lookup(path, Sense::Function) != Found::Nothing;
        }
        path.first().is_some_and(|it| self.scope.get(it.text).is_some())
            || self.decl.lookup(path, sense) != Found::Nothing
    }

    /// The path that an expression is, if its first name is not a variable or any other declaration.
    fn namespace_path(&self, expr: &ast::Expr<'s>) -> Option<ast::Path<'s>> {
        let first = expr.first_name()?;
        if self.scope.get(first.text).is_some() || self.decl.declared(first).is_some() {
            return None;
        }
        expr.path().filter(|it| it.len() > 1)
    }

    /// A global variable by its namespace, or a PROGRAM. The inner `None` says that it was reported.
    pub(crate) fn global_of_namespace(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Rc<Variable<'s>>>> {
        let path = self.namespace_path(expr)?;
        let (last, around) = path.split_last()?;
        self.decl.offer_in(around, *last, Sense::Value);
        let found = self.decl.lookup(&path, Sense::Value);
        self.decl.note_path(&path, &found);
        match found {
            Found::One(Meaning::Declared(Entry::Global(at))) => {
                self.without_list(&path, &found);
                Some(self.global(at))
            }
            Found::One(Meaning::Declared(Entry::Pou(slot))) if self.is_callable_program(slot, *last) => {
                Some(self.decl.program_variable(slot))
            }
            Found::Several(meanings) => {
                self.decl.report_ambiguous(*last, &meanings);
                Some(None)
            }
            Found::Nothing if self.decl.names.space_at(self.decl.site(last.span), around).is_some() => {
                self.not_in_namespace(around, *last);
                Some(None)
            }
            Found::Nothing => {
                let error = self.decl.not_in_library(Code::E0101, around, *last)?;
                self.report(error);
                Some(None)
            }
            Found::One(Meaning::Declared(Entry::Type(_) | Entry::Pou(_))) => {
                self.report(
                    Diagnostic::new(Code::E0101, last.span, format!("`{}` is not a variable", last.text))
                        .label("a variable or a value is expected here"),
                );
                Some(None)
            }
            Found::One(_) => None,
        }
    }

    /// In a program that moves to a system whose lists have no names: the variable is written without that of its list, where
    /// nothing else has its name.
    fn without_list(&mut self, path: &[ast::Name<'s>], found: &Found) {
        let &[list, name] = path else { return };
        let log = &self.decl.log;
        if log.options.moved_from.is_none() || log.dialect(list.span).names_lists() {
            return;
        }
        let bare = self.decl.lookup(&[name], Sense::Value);
        if self.scope.get(name.text).is_none() && (bare == Found::Nothing || bare == *found) {
            let span = Span { end: name.span.start, ..list.span };
            self.decl.log.readdressed.push(Fix { span, replacement: String::new() });
        }
    }

    /// A CONSTANT by the name of its POU, `Settings.MOST`. The inner `None` says that it was reported.
    pub(crate) fn constant_of_pou(&mut self, expr: &ast::Expr<'s>) -> Option<Option<Rc<Variable<'s>>>> {
        let path = expr.path().filter(|it| it.len() > 1 && self.scope.get(it[0].text).is_none())?;
        if let Some(constant) = self.decl.constant_of_pou(&path) {
            constant.used.set(true);
            let (constant, declared) = (Rc::clone(constant), constant.name.span);
            if let [pou @ .., name] = path.as_slice() {
                self.decl.note_path(pou, &self.decl.lookup(pou, Sense::Value));
                self.decl.log.note_declared(name.span, declared);
            }
            return Some(Some(constant));
        }
        let slot = self.decl.pou_of_constant(&path)?;
        let own = self.decl.pous[slot].ast.constants().flat_map(|it| &it.vars).flat_map(|it| &it.names);
        let name = path.last()?;
        own.into_iter().any(|it| it.text.eq_ignore_ascii_case(name.text)).then(|| {
            self.report_unknown_constant(*name);
            None
        })
    }

    /// The path of an enumerator. A variable hides a type with its name, unless it is an enumeration, which
    /// has no members: `state := State.Idle`.
    pub(crate) fn path_of_enumerator(&mut self, expr: &ast::Expr<'s>) -> Option<ast::Path<'s>> {
        let first = expr.first_name()?;
        let hides = |it| !matches!(it, Type::Enum(_));
        if self.scope.is_refused(first.text) || self.type_of_variable(first).is_some_and(hides) {
            return None;
        }
        let path = expr.path().filter(|it| it.len() > 1)?;
        matches!(self.decl.lookup(&path, Sense::Value), Found::One(Meaning::Enumerator(_))).then_some(path)
    }

    fn type_of_variable(&mut self, name: ast::Name<'s>) -> Option<Type> {
        let own = self.scope.get(name.text).map(|it| it.place.ty);
        own.or_else(|| self.decl.type_of_global(name))
    }

    /// What a call names by a path; `None` where the path starts with a variable or leads to an instance,
    /// and an inner `None` where it was reported.
    pub(crate) fn qualified_callee(&mut self, callee: &ast::Expr<'s>) -> Option<Option<Callee<'s>>> {
        let first = callee.first_name()?;
        if self.scope.get(first.text).is_some() {
            return None;
        }
        if self.scope.is_refused(first.text) {
            return Some(None);
        }
        let path = callee.path()?;
        let (last, around) = path.split_last()?;
        let found = self.decl.lookup(&path, Sense::Callee);
        self.decl.note_path(&path, &found);
        match found {
            Found::One(Meaning::Instruction) => Some(Some(Callee::Instruction(*last))),
            Found::One(Meaning::Function) => Some(Some(Callee::Standard(*last))),
            Found::One(Meaning::Declared(Entry::Pou(slot))) => Some(self.called_pou(slot, *last)),
            Found::Several(meanings) => {
                self.decl.report_ambiguous(*last, &meanings);
                Some(None)
            }
            Found::Nothing if self.namespace_path(callee).is_some() => {
                if let [family] = around
                    && let Some(family) = staunch_runtime::Family::named(family.text)
                {
                    self.report_family_call(family, *last);
                    return Some(None);
                }
                if let Some(error) = self.decl.not_in_library(Code::E0307, around, *last) {
                    self.report(error);
                    return Some(None);
                }
                self.decl.names.space_at(self.decl.site(last.span), around)?;
                self.not_in_namespace(around, *last);
                Some(None)
            }
            Found::One(_) | Found::Nothing => None,
        }
    }

    /// `GVL.x`, where the namespace has no `x`.
    fn not_in_namespace(&mut self, around: &[ast::Name<'s>], name: ast::Name<'s>) {
        let error = self.decl.not_in_namespace(Code::E0101, around, name);
        self.report(error);
    }
}

impl<'s> crate::types::declarations::Declarations<'s> {
    /// That a name stands for a namespace, where something in it is meant.
    pub(crate) fn only_a_namespace(&self, code: Code, space: SpaceId, full: &str, span: Span) -> Diagnostic {
        let what = match space {
            it if it == SpaceId::ROOT || self.names.is_of_library(it) => "a library",
            it if self.names.is_list(it) => "a list of global variables",
            _ => "a namespace",
        };
        Diagnostic::new(code, span, format!("`{full}` is {what}"))
            .label("expected a name declared in it")
            .help(format!("write its name after it: `{full}.name`"))
    }

    /// That a namespace, or a list of global variables, holds nothing of a name.
    pub(crate) fn not_in_namespace(&self, code: Code, around: &[ast::Name<'s>], name: ast::Name<'s>) -> Diagnostic {
        let full = around.iter().map(|it| it.text).collect::<Vec<_>>().join(".");
        let space = self.names.space_at(self.site(name.span), around);
        if let Some(hidden) = self.hidden_namespace(code, around) {
            return hidden;
        }
        if let Some(function) = missing::function_of_type(&full, name.text) {
            return Diagnostic::unavailable(function, name.span, &format!("the function {function}"));
        }
        let in_full = format!("{full}.{}", name.text);
        if let Some(help) = missing::namespace(&in_full) {
            return Diagnostic::unavailable(&in_full, name.span, &format!("`{in_full}`")).help(help);
        }
        let path: Vec<_> = around.iter().copied().chain([name]).collect();
        if let Some(space) = self.names.space_at(self.site(name.span), &path) {
            return self.only_a_namespace(code, space, &in_full, name.span);
        }
        let holder = match space {
            Some(it) if self.names.is_list(it) => Holder::GlobalList,
            Some(it) if self.names.is_of_library(it) => Holder::Library,
            Some(_) | None => Holder::Namespace,
        };
        let error = Diagnostic::missing_inside(code, (holder, &full), name.text, name.span).label("unknown name");
        if self.names.holders(name.text).iter().any(|(it, internal)| *internal && it.eq_ignore_ascii_case(&full)) {
            return error.help(format!("`{full}.{}` is INTERNAL, and not visible here", name.text));
        }
        match space.and_then(|it| nearest(name.text, self.names.names_in(it))) {
            Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
            None => error,
        }
    }

    /// That a library of CODESYS or TwinCAT has nothing of a name here: which one has it, or that none is bundled.
    pub(crate) fn not_in_library(
        &self,
        code: Code,
        around: &[ast::Name<'s>],
        name: ast::Name<'s>,
    ) -> Option<Diagnostic> {
        let site = self.site(name.span);
        let (mut owner, mut between) = around.split_first()?;
        if let [inner, rest @ ..] = between
            && library::leads_to(site.dialect, owner.text, inner.text)
        {
            (owner, between) = (inner, rest);
        }
        let is_list = matches!(between, [it] if it.text.eq_ignore_ascii_case(prelude::LIST));
        if !between.is_empty() && !is_list {
            return None;
        }
        if !self.names.is_library(site, owner.text) {
            return None;
        }
        let place = around.first()?.span.to(name.span);
        let (library, text) = (owner.text, name.text);
        let is_value = code == Code::E0101;
        let unit = prelude::unit(text, site.dialect).filter(|it| it.is_value() == is_value);
        let built_in = if is_value { &[] } else { library::of_built_in(text) };
        let libraries = unit.map_or(built_in, |it| it.libraries);
        let error = Diagnostic::missing_inside(code, (Holder::Library, library), text, place);
        if let Some(right) = libraries.first() {
            let meant = format!("{right}.{text}");
            return Some(
                error
                    .label(format!("it is in `{right}`"))
                    .help(format!("write `{meant}`, or `{text}`"))
                    .fix(place, meant),
            );
        }
        if unit.is_some() || !is_value && functions::exists_in(text, site.dialect) {
            return Some(error.label("no library has it").help(format!("write `{text}`")).fix(place, text));
        }
        Some(
            error
                .label("the part of the library that is bundled with Staunch does not have it")
                .help("name its source, or a declaration of it, in `libraries` of staunch.toml"),
        )
    }

    /// That the namespace of a path is INTERNAL in another one, and not seen from here.
    pub(crate) fn hidden_namespace(&self, code: Code, path: &[ast::Name<'s>]) -> Option<Diagnostic> {
        let (first, last) = (path.first()?, path.last()?);
        let site = self.site(first.span);
        let hidden = self.names.hidden(site, self.names.space_at(site, path)?)?;
        let around = hidden.rsplit_once('.').map_or(hidden, |it| it.0);
        let error = Diagnostic::new(code, first.span.to(last.span), format!("the namespace `{hidden}` is INTERNAL"));
        Some(error.label(format!("it is visible only inside `{around}`")))
    }

    /// Where a name that means nothing by itself is declared.
    pub(crate) fn hint_of_namespace(&self, name: ast::Name<'_>) -> Option<String> {
        let holders = self.names.holders(name.text);
        let (space, internal) = holders.first()?;
        Some(if *internal {
            format!("`{space}.{}` is INTERNAL, and not visible here", name.text)
        } else {
            format!("write `{space}.{}`, or `USING {space};` before it", name.text)
        })
    }
}
