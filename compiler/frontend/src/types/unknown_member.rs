//! A member that a structure, an enumeration or an instance does not have, and what was probably meant.

use super::declarations::Declarations;
use crate::diagnostic::wording::{all_of, article};
use crate::dialect::{Dialect, missing};
use crate::spelling::{Key, nearest};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::Type;

impl<'s> Declarations<'s> {
    pub fn unknown_member(&mut self, name: ast::Name<'s>, ty: Type, near: Option<&str>) {
        if self.class_of(ty).is_some_and(|it| self.has_unknown_parts(it) || self.has_unknown_base(it)) {
            return;
        }
        let owner = self.program.type_name(ty);
        // A data block's own structure has no name in S7.
        let of_data_block = owner.strip_suffix("_data").filter(|_| self.dialect(name.span) == Dialect::Siemens);
        let owner = of_data_block.map_or(owner.clone(), str::to_owned);
        if missing::is_member(self.dialect(name.span), &owner, name.text) {
            return self.report(
                Diagnostic::new(Code::E0902, name.span, format!("`{}` of {owner} is not supported yet", name.text))
                    .label("a program does not know the machine that runs it"),
            );
        }
        match self.routine_as_variable(name, ty, &owner) {
            Some(error) => self.report(error),
            None => self.report_no_member(name, ty, near, &owner),
        }
    }

    /// A PROPERTY or a METHOD that is named as if it were a variable.
    fn routine_as_variable(&self, name: ast::Name<'s>, ty: Type, owner: &str) -> Option<Diagnostic> {
        let routines = self.routines_on(ty, name.text)?;
        if let Some((_, declared)) = routines.setter.or(routines.getter) {
            return Some(
                Diagnostic::new(Code::E0107, name.span, format!("the PROPERTY `{}` is not a variable", name.text))
                    .label("nothing can call its SET here")
                    .other(declared, "declared here")
                    .help("give it a value where a variable of the type is declared, or assign it before it is used"),
            );
        }
        let (slot, declared) = routines.called?;
        let kind = article(self.pous[slot].ast.kind.word());
        let message = format!("`{}` is {kind} of `{owner}`, but is not called", name.text);
        Some(
            Diagnostic::new(Code::E0107, name.span, message)
                .label("a call needs parentheses, even without arguments")
                .other(declared, "declared here")
                .help(format!("call it: `{}(…)`", name.text)),
        )
    }

    fn report_no_member(&mut self, name: ast::Name<'s>, ty: Type, near: Option<&str>, owner: &str) {
        let class = self.class_of(ty);
        let after = Span { start: name.span.end, end: name.span.end + 1, ..name.span };
        let is_called = self.log.sources.text(after) == "(";
        let near = nearest(name.text, self.routines_like(class, is_called).map(|it| -> &str { it }).chain(near));
        let internal = class.filter(|_| !is_called && name.text.len() > 2).and_then(|it| {
            let own = self.pous[it].ast.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
            nearest(name.text, own.map(|it| it.text).chain(near))
        });
        let internal = internal.filter(|it| near.is_none_or(|near| Key(it) != Key(near)));
        let is_readable = self.dialect(name.span).shows_inner_variables();
        let mut error = Diagnostic::new(Code::E0107, name.span, format!("`{owner}` has no member `{}`", name.text))
            .label("unknown member");
        if let Some(internal) = internal {
            let help = format!("did you mean `{internal}`?");
            error = match is_readable {
                true => error.help(help).fix(name.span, internal),
                false => error.help(format!("{help} It is internal to `{owner}`")),
            };
        } else if let Some(near) = near {
            error = error.help(format!("did you mean `{near}`?")).fix(name.span, near);
        } else if let Some(members) = self.member_names(ty) {
            error = error.help(format!("it has {members}"));
        }
        self.report(error);
    }

    /// The class or the INTERFACE that a type is of.
    pub(crate) fn class_of(&self, ty: Type) -> Option<usize> {
        let class = if let Type::Struct(id) = ty { self.slot_of_instance(id) } else { None };
        class.or_else(|| self.interface_of(ty))
    }

    /// The names of a class's PROPERTYs, or of what can be called of it.
    fn routines_like(&self, class: Option<usize>, is_called: bool) -> impl Iterator<Item = &'s str> {
        let all = class.map_or(&[][..], |it| &self.pous[it].ast.routines).iter();
        let is_property = |it: &&ast::Pou<'s>| matches!(it.kind, ast::PouKind::Getter | ast::PouKind::Setter);
        all.filter(move |it| is_property(it) != is_called).map(|it| it.name.text)
    }

    /// What can be named of a structure, enumeration or instance, for a message.
    fn member_names(&self, ty: Type) -> Option<String> {
        let names: Vec<&str> = match ty {
            Type::Struct(id) => self.members_of(id).collect(),
            Type::Enum(id) => self.program.enumeration(id).values.iter().map(|it| it.name.as_str()).collect(),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Array(_)
            | Type::Block(_) => Vec::new(),
        };
        (1..=12).contains(&names.len()).then(|| all_of(&names))
    }
}
