//! The names at file level.

use crate::dialect::Dialect;
use crate::names::Entry;
use crate::spelling::Key;
use crate::types::declarations::{Declarations, GlobalSlot, PouSlot, Slot, TypeSlot};
use crate::{Code, Diagnostic, ast};

impl<'s> Declarations<'s> {
    pub(super) fn collect(&mut self, file: &'s ast::File<'s>) {
        for item in &file.items {
            match item {
                ast::Item::Types(decls) => decls.iter().for_each(|decl| self.collect_type(decl)),
                ast::Item::Pou(pou) => {
                    self.pous.push(PouSlot { ast: pou, names_itself: false, slot: Slot::Open });
                    self.enter(pou.name, Entry::Pou(self.pous.len() - 1));
                }
                ast::Item::Globals(block) => self.collect_globals(block),
                ast::Item::Configuration(it) => self.collect_configuration(it),
            }
        }
    }

    fn collect_type(&mut self, decl: &'s ast::TypeDecl<'s>) {
        let slot = self.types.len();
        self.enter(decl.name, Entry::Type(slot));
        self.names.unread.extend(decl.unread.iter().map(|it| Key(it.text)));
        if let ast::TypeKind::Enum { values, .. } = &decl.ty.kind {
            for value in values {
                self.names.enumerators.entry(Key(value.name.text)).or_default().push(slot);
            }
        }
        self.types.push(TypeSlot { decl, slot: Slot::Open });
    }

    fn collect_globals(&mut self, block: &'s ast::VarBlock<'s>) {
        self.check_retain_once(block);
        for decl in &block.vars {
            self.check_one_name(decl);
            for name in &decl.names {
                self.enter(*name, Entry::Global(self.globals.len()));
                self.globals.push(GlobalSlot { name: *name, block, decl, slot: Slot::Open });
            }
        }
    }

    fn collect_configuration(&mut self, configuration: &'s ast::Configuration<'s>) {
        let resources = configuration.resources.iter().flat_map(|it| &it.globals);
        for block in configuration.globals.iter().chain(resources) {
            self.collect_globals(block);
        }
    }

    /// Enters a name at file level; the first declaration of a name wins.
    fn enter(&mut self, name: ast::Name<'s>, entry: Entry) {
        if staunch_ir::Elementary::named(name.text).is_some() {
            self.error(Code::E0104, name.span, format!("`{}` is the name of an elementary type", name.text));
            return;
        }
        // The head of this declaration did not parse, which has been reported.
        if name.text.is_empty() {
            return;
        }
        self.check_spelling(name);
        if let Some(first) = self.names.get(name.text) {
            if self.enter_beside(name, first, entry) {
                return;
            }
            let first = self.span_of(first);
            self.report(
                Diagnostic::new(Code::E0103, name.span, format!("`{}` is declared twice", name.text))
                    .label("declared again here")
                    .other(first, "first declared here"),
            );
            return;
        }
        self.names.names.insert(Key(name.text), entry);
    }

    /// Reports a name with underlines where the standard has none.
    pub(super) fn check_spelling(&mut self, name: ast::Name<'s>) {
        let wrong = if name.text.contains("__") {
            "two underlines in a row"
        } else if name.text.ends_with('_') && self.dialect(name.span) != Dialect::Codesys {
            "an underline at the end"
        } else {
            return;
        };
        self.report(
            Diagnostic::new(Code::W0101, name.span, format!("the name `{}` has {wrong}", name.text))
                .label("the standard has no such names, and other systems refuse them"),
        );
    }

    /// A global may have the name of a type: `motor : Motor`. FALSE for any other pair of equal names.
    fn enter_beside(&mut self, name: ast::Name<'s>, first: Entry, second: Entry) -> bool {
        let key = Key(name.text);
        let (global, ty) = match (first, second) {
            (global @ Entry::Global(_), ty) if self.is_type(ty) => (global, ty),
            (ty, global @ Entry::Global(_)) if self.is_type(ty) => (global, ty),
            _ => return false,
        };
        if self.names.hidden_types.contains_key(&key) {
            return false;
        }
        self.names.hidden_types.insert(key, ty);
        self.names.names.insert(key, global);
        true
    }

    fn is_type(&self, entry: Entry) -> bool {
        match entry {
            Entry::Type(_) => true,
            Entry::Pou(at) => self.pous.get(at).is_some_and(|it| it.ast.kind == ast::PouKind::FunctionBlock),
            Entry::Global(_) => false,
        }
    }
}
