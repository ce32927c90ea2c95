//! Generic FUNCTIONs and METHODs: which there are, and what their declarations must contain so that each call determines the types.

use crate::ast::{self, PouKind, VarKind};
use crate::diagnostic::wording::article;
use crate::dialect::Dialect;
use crate::types::declarations::Declarations;
use crate::types::generic::names_in;
use crate::types::instances::is_about_types;
use crate::types::signature::Signature;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic};
use staunch_runtime::Class;
use std::rc::Rc;

impl<'s> Declarations<'s> {
    /// Which FUNCTIONs and METHODs are generic: those whose declarations use ANY, ANY_NUM and the like.
    pub(super) fn note_generics(&mut self) {
        for slot in 0..self.pous.len() {
            let pou = self.pous[slot].ast;
            let owner = self.pous[slot].owner.map(|it| self.pous[it].ast);
            // A METHOD of an INTERFACE has no routine of its own, and nobody calls one that was not written.
            let is_method =
                owner.is_some_and(|it| it.kind != PouKind::Interface) && pou.modifiers.is_abstract.is_none();
            if pou.kind == PouKind::Function || pou.kind == PouKind::Method && is_method {
                self.pous[slot].words = self.words_in(pou);
            }
        }
    }

    fn words_in(&self, pou: &ast::Pou<'s>) -> Vec<Class> {
        let declared = pou.blocks.iter().flat_map(|it| &it.vars).map(|it| &it.ty);
        let mut names = Vec::new();
        declared.chain(&pou.result).for_each(|it| names_in(it, &mut names));
        let mut words = Vec::new();
        for word in names.into_iter().filter_map(|it| self.class_word(*it)) {
            if !words.contains(&word) {
                words.push(word);
            }
        }
        words
    }

    /// The signature of an instance of a generic FUNCTION, which is made when all declarations are resolved.
    pub(super) fn build_instance(&mut self, slot: usize) -> Option<Rc<Signature<'s>>> {
        let signature = self.build_signature(slot)?;
        Some(self.with_externals(slot, Rc::new(signature)))
    }

    /// The signature of the POU in a slot, in which words mean what they do there.
    pub(super) fn build_signature(&mut self, slot: usize) -> Option<Signature<'s>> {
        let pou = self.pous[slot].ast;
        let words = self.words_of(slot);
        if words.is_empty() {
            return self.signature_of(slot);
        }
        let is_generic = self.is_generic(slot);
        if is_generic {
            self.check_generic(pou)?;
        }
        let reported = self.log.diagnostics.len();
        self.generics.words = words;
        let signature = self.signature_of(slot);
        self.generics.words = Vec::new();
        if is_generic {
            // Whether a value fits is known when a type is.
            self.say_of_generic(reported, |it| !is_about_types(it.code));
        }
        signature
    }

    /// Reports the first word that no call gives a type, or that is where it cannot be.
    fn check_generic(&mut self, pou: &ast::Pou<'s>) -> Option<()> {
        let told: Vec<_> = pou
            .blocks
            .iter()
            .filter(|it| it.kind == VarKind::Input || it.kind == VarKind::InOut && it.constant.is_none())
            .flat_map(|it| &it.vars)
            .filter_map(|it| self.word(&it.ty))
            .collect();
        let result = pou.result.iter().map(|it| (None, it));
        let declared = pou.blocks.iter().flat_map(|block| block.vars.iter().map(move |it| (Some(block), &it.ty)));
        for (block, ty) in declared.chain(result) {
            let mut names = Vec::new();
            names_in(ty, &mut names);
            let Some((name, class)) = names.into_iter().find_map(|it| Some((*it, self.class_word(*it)?))) else {
                continue;
            };
            if let Some(wrong) = self.wrong_word(block, ty, name, class, &told) {
                self.report(wrong);
                return None;
            }
        }
        Some(())
    }

    fn wrong_word(
        &self,
        block: Option<&ast::VarBlock<'s>>,
        ty: &ast::TypeSpec<'s>,
        name: ast::Name<'s>,
        class: Class,
        told: &[Class],
    ) -> Option<Diagnostic> {
        let kind = block.map(|it| it.kind);
        let error = |message: String| Diagnostic::new(Code::E0411, name.span, message);
        let is_seen = kind.is_none_or(|it| matches!(it, VarKind::Input | VarKind::Output | VarKind::InOut));
        if is_seen && self.word(ty).is_none() {
            let error = error(format!("`{}` can only be the type of a whole parameter or result", name.text));
            let help = if self.dialect(name.span) == Dialect::Codesys {
                "write a FUNCTION with its own name for each type"
            } else {
                "write a FUNCTION with the same name for each type: a call uses the one that fits its arguments"
            };
            return Some(error.label("here it is only part of a type").help(help));
        }
        if let Some(VarKind::Stat | VarKind::External | VarKind::Global) = kind {
            let word = self.log.sources.text(block.map_or(name.span, |it| it.span));
            let error = error(format!("a variable of {word} must have the same type in all calls"));
            return Some(error.label(format!("`{}` may differ from call to call", name.text)));
        }
        if kind == Some(VarKind::InOut) && block.is_some_and(|it| it.constant.is_some()) {
            let error = error(format!("a VAR_IN_OUT CONSTANT cannot have the type {}", name.text));
            return Some(error.label("only an input can have a generic type here").help("declare it in VAR_INPUT"));
        }
        if !told.contains(&class) {
            let error = error(format!("a call cannot determine which type `{}` is", name.text));
            let error = error.label("no VAR_INPUT or VAR_IN_OUT has this type");
            return Some(match told.first() {
                Some(told) => {
                    error.help(format!("write `{}`, or give the FUNCTION an input of this type", told.name()))
                }
                None => error.help("give the FUNCTION an input of this type"),
            });
        }
        None
    }

    /// The type that a word means in the FUNCTION that is declared; elsewhere it means none.
    pub(super) fn generic_type(&mut self, class: Class, name: ast::Name<'s>) -> Option<Resolved> {
        if self.table.any.words.contains(&name.span) {
            return self.named_type(self.table.any.structure?);
        }
        if let Some(ty) = self.type_of_word(class) {
            return Some(Resolved { ty, initial: self.start_of(ty) });
        }
        let what = article(class.name());
        self.report(
            Diagnostic::new(
                Code::E0411,
                name.span,
                format!("`{}` is a generic type, which only a FUNCTION or a METHOD with a body can use", name.text),
            )
            .label(format!("nothing determines which type {what} is here"))
            .help("write the type that is meant, or make this a FUNCTION whose inputs are generic"),
        );
        None
    }
}
