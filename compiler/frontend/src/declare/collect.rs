//! The names at file level.

use super::list::Lists;
use crate::diagnostic::Missing;
use crate::dialect::{Dialect, missing};
use crate::names::{Entry, Found, Sense, SpaceId};
use crate::spelling::Key;
use crate::types::declarations::{Declarations, GlobalSlot, PouSlot, Slot, TypeSlot};
use crate::{Code, Diagnostic, Span, ast};

impl<'s> Declarations<'s> {
    /// The namespaces of all files, and what is used where.
    pub(super) fn collect_namespaces(&mut self, files: &'s [ast::File<'s>]) {
        let mut regions = Vec::new();
        for file in files {
            let lists = self.lists(file);
            regions.push(self.names.add_file(file, &lists));
        }
        for (region, id) in files.iter().zip(&regions).flat_map(|(file, ids)| file.regions.iter().zip(ids)) {
            self.note_space(&region.path);
            for path in &region.uses {
                let Some(last) = path.last() else { continue };
                self.note_space(path);
                let site = self.site(last.span);
                if !self.names.use_space(*id, site, path) {
                    self.report_unknown_namespace(path);
                }
            }
        }
    }

    /// Reports a base that exists, but not under the name that is written.
    pub(super) fn check_bases(&mut self) {
        let written: Vec<_> = self.pous.iter().filter(|it| it.owner.is_none()).flat_map(|it| &it.ast.bases).collect();
        for path in written {
            let Some((last, around)) = path.split_last() else { continue };
            let found = self.lookup(path, Sense::Type);
            self.note_path(path, &found);
            match found {
                Found::Several(meanings) => self.report_ambiguous(*last, &meanings),
                Found::Nothing if self.names.root(last.text).is_some() || !self.names.holders(last.text).is_empty() => {
                    let full = path.iter().map(|it| it.text).collect::<Vec<_>>().join(".");
                    let mut error = Diagnostic::missing(Missing::InFull, &full, last.span);
                    if around.is_empty()
                        && let Some(hint) = self.hint_of_namespace(*last)
                    {
                        error = error.help(hint);
                    }
                    self.report(error.label("not known by this name here"));
                }
                Found::Nothing | Found::One(_) => {}
            }
        }
    }

    /// Where each list of global variables is.
    fn lists(&mut self, file: &'s ast::File<'s>) -> Vec<(Span, SpaceId)> {
        let mut lists = Lists::of(self, file);
        let mut stretches = Vec::new();
        for item in &file.items {
            match item {
                ast::Item::Pou(pou) => lists.end(pou.span),
                ast::Item::Globals(block) => {
                    let last = block.vars.last().map_or(block.span, |it| it.span);
                    let list = lists.around(block.span).map(|it| self.names.list(it, block.span.file));
                    if let Some(list) = list.filter(|_| lists.is_qualified(block.span)) {
                        self.names.qualify(list);
                    }
                    stretches.extend(list.map(|it| (block.span.to(last), it)));
                }
                ast::Item::Types(_) | ast::Item::Configuration(_) | ast::Item::Test(_) => {}
            }
        }
        stretches
    }

    pub(super) fn collect(&mut self, file: &'s ast::File<'s>) {
        for item in &file.items {
            match item {
                ast::Item::Types(decls) => decls.iter().for_each(|decl| self.collect_type(decl)),
                ast::Item::Pou(pou) => {
                    self.pous.push(PouSlot::open(pou));
                    let slot = self.pous.len() - 1;
                    if pou.kind.is_block() {
                        self.classes.insert(pou.name.span, slot);
                    }
                    if pou.kind == ast::PouKind::Interface {
                        self.table.interfaces.slots.push(slot);
                        let name = self.name_in_full(pou.name);
                        self.program.interfaces.push(name);
                    }
                    // Nobody names a test.
                    if pou.kind != ast::PouKind::Test && !self.overloads_another(slot) {
                        let internal = matches!(pou.modifiers.access, Some((ast::Access::Internal, _)));
                        self.enter(pou.name, Entry::Pou(slot), internal);
                    }
                    pou.routines.iter().for_each(|it| self.collect_routine(slot, it));
                    if self.has_globals(pou) {
                        globals_of(pou).for_each(|it| self.collect_globals_of(pou, it));
                    }
                }
                ast::Item::Globals(block) => self.collect_globals(block),
                ast::Item::Configuration(it) => self.collect_configuration(it),
                // They have become POUs, or are not wanted.
                ast::Item::Test(_) => {}
            }
        }
    }

    /// A METHOD or ACTION of the POU in a slot: its name is one among the POU's.
    fn collect_routine(&mut self, owner: usize, routine: &'s ast::Pou<'s>) {
        let slot = self.pous.len();
        self.pous.push(PouSlot { owner: Some(owner), ..PouSlot::open(routine) });
        let name = routine.name;
        if name.text.is_empty() {
            return;
        }
        if matches!(routine.kind, ast::PouKind::Getter | ast::PouKind::Setter) {
            self.properties.insert(Key(name.text));
        }
        if routine.is_hidden {
            self.pous[owner].hidden.entry(name.span).or_default().set(routine.kind, slot, name.span);
            return;
        }
        let pou = self.pous[owner].ast;
        let variables = pou.blocks.iter().flat_map(|it| &it.vars).flat_map(|it| &it.names);
        let variable = variables.copied().find(|it| Key(it.text) == Key(name.text)).map(|it| it.span);
        if variable.is_none() && self.overloads_a_method(owner, slot) {
            return;
        }
        let own = &mut self.pous[owner];
        let known = variable.or_else(|| own.routines.get(&Key(name.text))?.first(routine.kind));
        if known.is_none() {
            own.routines.entry(Key(name.text)).or_default().set(routine.kind, slot, name.span);
        }
        self.check_spelling(name);
        if let Some(first) = known {
            self.report(declared_twice(name, first));
        }
    }

    fn collect_type(&mut self, decl: &'s ast::TypeDecl<'s>) {
        let slot = self.types.len();
        self.enter(decl.name, Entry::Type(slot), decl.internal);
        self.names.unread.extend(decl.unread.iter().map(|it| Key(it.text)));
        if let ast::TypeKind::Enum { values, .. } = &decl.ty.kind {
            let is_qualified = decl.attributes.iter().any(|it| it.eq_ignore_ascii_case("qualified_only"));
            let names = &mut self.names;
            let known = if is_qualified { &mut names.qualified_enumerators } else { &mut names.enumerators };
            for value in values {
                known.entry(Key(value.name.text)).or_default().push(slot);
            }
        }
        self.types.push(TypeSlot { decl, slot: Slot::Open });
    }

    fn collect_globals(&mut self, block: &'s ast::VarBlock<'s>) {
        self.check_retain_once(block);
        for decl in &block.vars {
            self.check_one_name(decl);
            for name in &decl.names {
                let space = self.names.space_of(name.span);
                self.enter(*name, Entry::Global(self.globals.len()), false);
                self.globals.push(GlobalSlot { space, name: *name, block, decl, slot: Slot::Open });
            }
        }
    }

    /// Those of a PROGRAM, whose names no other variable of it has.
    fn collect_globals_of(&mut self, pou: &'s ast::Pou<'s>, block: &'s ast::VarBlock<'s>) {
        self.collect_globals(block);
        let own = pou.blocks.iter().filter(|it| !matches!(it.kind, ast::VarKind::Global | ast::VarKind::External));
        let own: Vec<_> = own.flat_map(|it| &it.vars).flat_map(|it| &it.names).collect();
        for global in block.vars.iter().flat_map(|it| &it.names) {
            if let Some(other) = own.iter().find(|it| Key(it.text) == Key(global.text)) {
                self.report(declared_twice(**other, global.span));
            }
        }
    }

    /// Whether the POU's VAR_GLOBALs are global variables: those of a PROGRAM (edition 3, table 47).
    pub(crate) fn has_globals(&self, pou: &ast::Pou<'s>) -> bool {
        pou.kind == ast::PouKind::Program && self.dialect(pou.name.span).has_globals_of_programs()
    }

    fn collect_configuration(&mut self, configuration: &'s ast::Configuration<'s>) {
        let resources = configuration.resources.iter().flat_map(|it| &it.globals);
        configuration.globals.iter().chain(resources).for_each(|it| self.collect_globals(it));
    }

    /// Enters a name in the namespace around it; the first declaration of a name wins.
    fn enter(&mut self, name: ast::Name<'s>, entry: Entry, internal: bool) {
        if staunch_ir::Elementary::named(name.text).is_some() {
            self.error(Code::E0104, name.span, format!("`{}` is the name of an elementary type", name.text));
            return;
        }
        // The head of this declaration did not parse, which has been reported.
        if name.text.is_empty() {
            return;
        }
        self.check_spelling(name);
        let space = self.names.space_of(name.span);
        if self.names.inner_named(space, name.text) && !matches!(entry, Entry::Global(_)) {
            let full = self.names.in_full(space, name.text);
            self.report(
                Diagnostic::new(Code::E0103, name.span, format!("`{full}` is already a NAMESPACE"))
                    .label("another declaration cannot have the name of a namespace"),
            );
            return;
        }
        if self.is_program_of_library(entry) {
            self.names.giving_way.insert(entry);
        }
        let first = self.clash(space, name.text, entry);
        // A library brings its PROGRAMs along, and names are its user's first.
        if first.is_some() && self.is_program_of_library(entry) {
            return;
        }
        let Some(first) = first.filter(|it| !self.is_program_of_library(*it)) else {
            self.names.insert(space, name.text, entry, internal);
            return;
        };
        let first = self.span_of(first);
        self.report(declared_twice(name, first));
    }

    fn is_program_of_library(&self, entry: Entry) -> bool {
        matches!(entry, Entry::Pou(at) if self.pous[at].ast.kind == ast::PouKind::Program && self.is_of_library(at))
    }

    /// What is in the way of a new name. A global may have the name of a type, `motor : Motor`, and two
    /// lists may have variables with the same name; but one in the root does not hide a list's.
    fn clash(&self, space: SpaceId, name: &str, entry: Entry) -> Option<Entry> {
        // What is named after its list alone is in nobody's way.
        let is_seen = self.names.is_list(space) && !self.names.is_qualified(space);
        let around = is_seen.then(|| self.names.around_list(space));
        let root = around.and_then(|it| self.names.own(it, name)).unwrap_or_default();
        let own = self.names.own(space, name).unwrap_or_default();
        let lists = self.names.in_lists(space, name);
        let mut known = [own.value, own.ty, root.value, root.ty].into_iter().flatten().chain(lists);
        let is_global = |it| matches!(it, Entry::Global(_));
        let may_share = |it| is_global(it) && self.is_type(entry) || is_global(entry) && self.is_type(it);
        known.find(|it| !may_share(*it))
    }

    fn report_unknown_namespace(&mut self, path: &[ast::Name<'s>]) {
        let (Some(first), Some(last)) = (path.first(), path.last()) else { return };
        if let Some(hidden) = self.hidden_namespace(Code::E0102, path) {
            return self.report(hidden);
        }
        let full = path.iter().map(|it| it.text).collect::<Vec<_>>().join(".");
        if let Some(help) = missing::namespace(&full) {
            let error = Diagnostic::unavailable(&full, first.span.to(last.span), &format!("`{full}`"));
            return self.report(error.help(help));
        }
        let error = Diagnostic::missing(Missing::Used, &full, first.span.to(last.span))
            .label("no file of the program declares it");
        let near = crate::spelling::nearest(&full, self.names.namespaces()).map(str::to_owned);
        self.report(match near {
            Some(near) => error.help(format!("did you mean `{near}`?")).fix(first.span.to(last.span), near),
            None => error,
        });
    }

    /// Reports a name with underscores where the standard forbids them.
    pub(super) fn check_spelling(&mut self, name: ast::Name<'s>) {
        // The compiler's own name, one of Logix that is not a name here, or one that SCL has in quotes.
        let source = self.log.sources.get(name.span.file);
        let is_logix = self.dialect(name.span) == Dialect::Logix;
        let is_made = source.is_assembled() && (is_logix || !source.is_verbatim(name.span));
        if is_made || self.log.sources.text(name.span) != name.text {
            return;
        }
        let wrong = if name.text.contains("__") {
            "two underscores in a row"
        } else if name.text.ends_with('_') && self.dialect(name.span) != Dialect::Codesys {
            "an underscore at the end"
        } else {
            return;
        };
        self.report(
            Diagnostic::new(Code::W0101, name.span, format!("the name `{}` has {wrong}", name.text))
                .label("the standard has no such names, and other systems refuse them"),
        );
    }

    fn is_type(&self, entry: Entry) -> bool {
        match entry {
            Entry::Type(_) => true,
            Entry::Pou(at) => {
                let kind = self.pous.get(at).map(|it| it.ast.kind);
                kind.is_some_and(|it| it.is_block() || it == ast::PouKind::Interface)
            }
            Entry::Global(_) => false,
        }
    }
}

pub(super) fn declared_twice(name: ast::Name<'_>, first: Span) -> Diagnostic {
    Diagnostic::new(Code::E0103, name.span, format!("`{}` is declared twice", name.text))
        .label("declared again here")
        .other(first, "first declared here")
}

fn globals_of<'s>(pou: &'s ast::Pou<'s>) -> impl Iterator<Item = &'s ast::VarBlock<'s>> {
    pou.blocks.iter().filter(|it| it.kind == ast::VarKind::Global)
}
