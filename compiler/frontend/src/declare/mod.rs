//! Names, types and signatures: everything that holds before a body is read.
//!
//! Declarations may stand in any order and in any file; they are resolved in the order of their needs.

mod address;
mod called_program;
mod configuration;
mod initial;
mod needs;
mod order;
mod pou;
mod prescan;
mod scope;
mod synthetic;
mod types;

pub(crate) use pou::{Formal, Signature, Target, pin_place};
pub(crate) use scope::{Scope, Variable};
pub(crate) use types::Resolved;

use crate::ast;
use crate::check;
use crate::dialect::{self, Dialect};
use crate::names::{Key, nearest};
use crate::{Bodies, Code, Diagnostic, Options, Severity, Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::layout::{Layout, TooLarge};
use staunch_ir::{
    Class, ClassId, ClassKind, Location, Place, Program, Root, RoutineId, SourceFile, Struct, StructId, Type,
};
use std::rc::Rc;

/// Stands for the globals' structure until it is made, when all declared globals are known.
pub(crate) const GLOBALS: StructId = StructId(u32::MAX);

/// Pragmas that change what a program means: to pass over them would compile another program.
const DECIDING_PRAGMAS: [&str; 7] = ["external", "if", "elsif", "else", "end_if", "define", "undefine"];
/// Pragmas for editors and other tools.
const HARMLESS_PRAGMAS: [&str; 12] = [
    "attribute",
    "region",
    "endregion",
    "end_region",
    "warning",
    "info",
    "text",
    "error",
    "flag",
    "analysis",
    "nobp",
    "bp",
];

/// A declaration, and what it was resolved to.
#[derive(Debug)]
pub(crate) enum Slot<T> {
    /// Not resolved, or while that goes on: it is needed in a circle.
    Open,
    Done(T),
    /// It has been reported.
    Failed,
}

/// What a name at file level means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Entry {
    Type(usize),
    Pou(usize),
    Global(usize),
}

pub(crate) struct TypeSlot<'s> {
    pub decl: &'s ast::TypeDecl<'s>,
    pub slot: Slot<Resolved>,
}

pub(crate) struct PouSlot<'s> {
    pub ast: &'s ast::Pou<'s>,
    pub slot: Slot<Rc<Signature<'s>>>,
}

pub(crate) struct GlobalSlot<'s> {
    pub name: ast::Name<'s>,
    pub block: &'s ast::VarBlock<'s>,
    pub decl: &'s ast::VarDecl<'s>,
    pub slot: Slot<Rc<Variable<'s>>>,
}

/// The program while it is being declared and checked.
pub(crate) struct Declarations<'s> {
    pub sources: &'s Sources,
    pub options: &'s Options,
    /// A dialect for each file.
    pub dialects: Vec<Dialect>,
    pub diagnostics: Vec<Diagnostic>,
    pub names: FxHashMap<Key<'s>, Entry>,
    /// The types and FUNCTION_BLOCKs whose name is a global's too: they are meant where a type is
    /// expected, the variable elsewhere.
    hidden_types: FxHashMap<Key<'s>, Entry>,
    /// The declarations in which a bare enumerator is named, with their type's slot.
    pub enumerators: FxHashMap<Key<'s>, Vec<usize>>,
    /// Names in type declarations that did not parse: they may be enumerators.
    pub unread: FxHashSet<Key<'s>>,
    pub types: Vec<TypeSlot<'s>>,
    pub pous: Vec<PouSlot<'s>>,
    /// The slots of FUNCTIONs that have no result type, but name their result.
    pub untyped: FxHashSet<usize>,
    pub globals: Vec<GlobalSlot<'s>>,
    /// The first statement that makes nothing, because something in it was refused.
    pub left_out: Option<Span>,
    pub configurations: Vec<&'s ast::Configuration<'s>>,
    pub addresses: address::Addresses,
    pub hidden: synthetic::Hidden<'s>,
    /// By their slots.
    named_programs: FxHashMap<usize, called_program::Named<'s>>,
    pub program: Program,
    /// For each array of `program`, what its elements are.
    pub elements: Vec<Resolved>,
    /// For each structure of `program`, about how many bytes it takes.
    pub sizes: Vec<u64>,
    /// For each anonymous or named enumeration, in order of declaration, the enumerators.
    pub anonymous_enumerators: FxHashMap<Key<'s>, (Type, staunch_ir::Value)>,
    /// The POU slot of each structure that is an instance's state.
    pub instances: FxHashMap<StructId, usize>,
    /// How many constants the initial values hold so far.
    constants: usize,
    line_cache: LineCache,
}

/// The last line that was looked up: the next position is usually on it or just behind.
#[derive(Default)]
struct LineCache {
    file: u16,
    line: u32,
    start: u32,
    end: u32,
    /// The last position that was looked up on the line, and the characters before it.
    counted_to: u32,
    count: usize,
}

pub(crate) fn declare<'s>(
    sources: &'s Sources,
    files: &'s [ast::File<'s>],
    statements: Vec<Vec<ast::Statement<'s>>>,
    options: &'s Options,
    bodies: Bodies,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Program> {
    let mut declarations = Declarations::new(sources, options);
    for file in files {
        declarations.read_pragmas(file);
    }
    for file in files {
        declarations.collect(file);
    }
    declarations.addresses = address::collect(&mut declarations, &statements);
    declarations.resolve_all();
    declarations.find_named_programs(&statements);
    declarations.declare_globals();
    declarations.untyped = untyped(&declarations.pous, &statements);
    let unassigned = unassigned_results(&declarations.pous, &statements);
    let bodies = check::bodies(&mut declarations, statements, bodies);
    let program = declarations.finish(bodies);
    diagnostics.append(&mut declarations.diagnostics);
    // A program that is accepted has all its statements.
    let is_rejected = diagnostics.iter().any(|it| it.severity == Severity::Error);
    if !is_rejected {
        diagnostics.extend(unassigned);
    }
    if let (Some(span), false) = (declarations.left_out, is_rejected) {
        unreachable!("checked program: `{}` was left out without a word", sources.text(span));
    }
    program
}

fn untyped(pous: &[PouSlot<'_>], statements: &[Vec<ast::Statement<'_>>]) -> FxHashSet<usize> {
    let all = pous.iter().map(|it| it.ast).zip(statements).enumerate();
    let untyped = all.filter(|(_, (pou, _))| pou.kind == ast::PouKind::Function && pou.result.is_none());
    untyped.filter(|(_, (pou, body))| mentions(body, pou.name.text)).map(|(slot, _)| slot).collect()
}

/// The FUNCTIONs whose bodies do not name their result. What was refused may have assigned it.
fn unassigned_results(pous: &[PouSlot<'_>], statements: &[Vec<ast::Statement<'_>>]) -> Vec<Diagnostic> {
    let typed = pous.iter().map(|it| it.ast).zip(statements).filter(|(pou, _)| pou.result.is_some());
    let unassigned = typed.filter(|(pou, body)| !mentions(body, pou.name.text)).map(|(pou, _)| pou.name);
    let lint = |name: ast::Name<'_>| {
        Diagnostic::new(Code::W0516, name.span, format!("the result of `{}` is never assigned", name.text))
            .label("each call gives its type's initial value")
            .help(format!("assign it, `{} := …;`", name.text))
    };
    unassigned.map(lint).collect()
}

/// Whether the statements name something `name`.
fn mentions(body: &[ast::Statement<'_>], name: &str) -> bool {
    let mut found = false;
    ast::each_expr(body, &mut |it| {
        found |= matches!(&it.kind, ast::ExprKind::Name(it) if it.text.eq_ignore_ascii_case(name));
    });
    found
}

impl<'s> Declarations<'s> {
    fn new(sources: &'s Sources, options: &'s Options) -> Self {
        let files = sources.files().iter().map(|it| SourceFile { path: it.path.clone() }).collect();
        Self {
            sources,
            options,
            dialects: Vec::new(),
            diagnostics: Vec::new(),
            names: FxHashMap::default(),
            hidden_types: FxHashMap::default(),
            enumerators: FxHashMap::default(),
            unread: FxHashSet::default(),
            types: Vec::new(),
            pous: Vec::new(),
            untyped: FxHashSet::default(),
            globals: Vec::new(),
            left_out: None,
            configurations: Vec::new(),
            addresses: address::Addresses::default(),
            hidden: synthetic::Hidden::default(),
            named_programs: FxHashMap::default(),
            program: empty_program(files),
            elements: Vec::new(),
            sizes: Vec::new(),
            anonymous_enumerators: FxHashMap::default(),
            instances: FxHashMap::default(),
            constants: 0,
            line_cache: LineCache::default(),
        }
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.report(Diagnostic::new(code, span, message));
    }

    /// Whether errors were reported since there were `reported` diagnostics.
    fn has_errors_since(&self, reported: usize) -> bool {
        self.diagnostics[reported..].iter().any(|it| it.severity == Severity::Error)
    }

    pub fn dialect(&self, span: Span) -> Dialect {
        self.dialects.get(usize::from(span.file)).copied().unwrap_or(self.options.dialect)
    }

    /// Where `span` starts, for people.
    pub fn location(&mut self, span: Span) -> Location {
        let source = self.sources.get(span.file);
        let cache = &self.line_cache;
        let cached = cache.file == span.file && (cache.start..cache.end).contains(&span.start);
        if !cached {
            let line = source.line(span.start);
            let (start, end) = source.line_bounds(line);
            self.line_cache = LineCache { file: span.file, line, start, end, counted_to: start, count: 0 };
        }
        let cache = &mut self.line_cache;
        if source.is_ascii() {
            let column = u16::try_from(span.start - cache.start + 1).unwrap_or(u16::MAX);
            return Location { file: span.file, line: cache.line, column };
        }
        // A line may be long: what was counted is not counted again.
        if span.start < cache.counted_to {
            (cache.counted_to, cache.count) = (cache.start, 0);
        }
        let between = Span { file: span.file, start: cache.counted_to, end: span.start };
        cache.count += self.sources.text(between).chars().count();
        cache.counted_to = span.start;
        let (line, column) = (cache.line, u16::try_from(cache.count + 1).unwrap_or(u16::MAX));
        Location { file: span.file, line, column }
    }

    fn read_pragmas(&mut self, file: &ast::File<'s>) {
        let mut found: Option<(Dialect, Span)> = None;
        for pragma in &file.pragmas {
            let Some(name) = dialect_pragma(pragma.text) else {
                self.check_pragma(*pragma);
                continue;
            };
            let Some(dialect) = Dialect::named(name) else {
                let names: Vec<_> = Dialect::ALL.iter().map(|it| it.name()).collect();
                let mut error = Diagnostic::new(Code::E0105, pragma.span, format!("there is no dialect `{name}`"))
                    .label("unknown dialect");
                let near = nearest(name, names.iter().copied());
                error = error.help(match near {
                    Some(near) => format!("did you mean `{{dialect '{near}'}}`?"),
                    None => format!("the dialects are {}", crate::diagnostic::wording::list(&names)),
                });
                self.report(error);
                continue;
            };
            if let Some((_, first)) = found {
                self.report(
                    Diagnostic::new(Code::E0106, pragma.span, "a file has one dialect")
                        .label("a second dialect pragma")
                        .other(first, "the first one")
                        .help("keep one of them; a block of another system is named in full, `CODESYS.CTU`"),
                );
                continue;
            }
            found = Some((dialect, pragma.span));
        }
        let own = found.map(|(dialect, _)| dialect).filter(|it| self.options.moved_from != Some(*it));
        self.dialects.push(own.unwrap_or(self.options.dialect));
    }

    /// What a pragma that does not name a dialect is good for.
    fn check_pragma(&mut self, pragma: ast::Name<'s>) {
        let word: String =
            pragma.text.trim().chars().take_while(|it| it.is_ascii_alphanumeric() || *it == '_').collect();
        let word = word.to_ascii_lowercase();
        if DECIDING_PRAGMAS.contains(&word.as_str()) {
            self.not_supported(pragma.span, &format!("the pragma `{word}`"));
        } else if !HARMLESS_PRAGMAS.contains(&word.as_str()) {
            self.report(
                Diagnostic::new(Code::W0102, pragma.span, format!("the pragma `{word}` is not known"))
                    .label("it has no effect"),
            );
        }
    }

    fn collect(&mut self, file: &'s ast::File<'s>) {
        for item in &file.items {
            match item {
                ast::Item::Types(decls) => decls.iter().for_each(|decl| self.collect_type(decl)),
                ast::Item::Pou(pou) => {
                    self.pous.push(PouSlot { ast: pou, slot: Slot::Open });
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
        self.unread.extend(decl.unread.iter().map(|it| Key(it.text)));
        if let ast::TypeKind::Enum { values, .. } = &decl.ty.kind {
            for value in values {
                self.enumerators.entry(Key(value.name.text)).or_default().push(slot);
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
        self.configurations.push(configuration);
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
        if let Some(first) = self.names.get(&Key(name.text)).copied() {
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
        self.names.insert(Key(name.text), entry);
    }

    /// Reports a name with underlines where the standard has none.
    pub fn check_spelling(&mut self, name: ast::Name<'s>) {
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
        if self.hidden_types.contains_key(&key) {
            return false;
        }
        self.hidden_types.insert(key, ty);
        self.names.insert(key, global);
        true
    }

    fn is_type(&self, entry: Entry) -> bool {
        match entry {
            Entry::Type(_) => true,
            Entry::Pou(at) => self.pous.get(at).is_some_and(|it| it.ast.kind == ast::PouKind::FunctionBlock),
            Entry::Global(_) => false,
        }
    }

    /// What a name means where a type is expected.
    pub fn type_named(&self, name: &str) -> Option<Entry> {
        let hidden = self.hidden_types.get(&Key(name));
        hidden.or_else(|| self.names.get(&Key(name))).copied().filter(|it| !matches!(it, Entry::Global(_)))
    }

    /// The names of all types and POUs.
    pub fn type_names(&self) -> impl Iterator<Item = &'s str> {
        let own = self.names.iter().filter(|(_, entry)| !matches!(entry, Entry::Global(_)));
        own.chain(&self.hidden_types).map(|(key, _)| key.0)
    }

    /// The type of the global variable of that name; in its own declaration it is not known yet.
    pub fn type_of_global(&self, name: &str) -> Option<Type> {
        let Some(Entry::Global(at)) = self.names.get(&Key(name)).copied() else { return None };
        match &self.globals[at].slot {
            Slot::Done(variable) => Some(variable.resolved.ty),
            Slot::Open | Slot::Failed => None,
        }
    }

    pub fn span_of(&self, entry: Entry) -> Span {
        match entry {
            Entry::Type(at) => self.types[at].decl.name.span,
            Entry::Pou(at) => self.pous[at].ast.name.span,
            Entry::Global(at) => self.globals[at].name.span,
        }
    }

    fn resolve_all(&mut self) {
        for entry in needs::order(self) {
            match entry {
                Entry::Type(at) => self.types[at].slot = self.resolve_type_slot(at).map_or(Slot::Failed, Slot::Done),
                Entry::Global(at) => {
                    let variable = self.global_variable(at).map(Rc::new);
                    self.globals[at].slot = variable.map_or(Slot::Failed, Slot::Done);
                }
                Entry::Pou(at) => {
                    let signature = self.build_signature(at).map(Rc::new);
                    self.pous[at].slot = signature.map_or(Slot::Failed, Slot::Done);
                }
            }
        }
        self.declare_used_addresses();
        address::report_overlaps(self);
    }

    /// The named type in slot `at`.
    pub fn named_type(&mut self, at: usize) -> Option<Resolved> {
        match &self.types[at].slot {
            Slot::Done(resolved) => Some(resolved.clone()),
            Slot::Failed => None,
            Slot::Open => {
                let name = self.types[at].decl.name;
                self.report(
                    Diagnostic::new(Code::E0402, name.span, format!("the type `{}` contains itself", name.text))
                        .label("its size would be endless"),
                );
                None
            }
        }
    }

    /// The global variable in slot `at`.
    pub fn global(&mut self, at: usize) -> Option<Rc<Variable<'s>>> {
        match &self.globals[at].slot {
            Slot::Done(variable) => Some(Rc::clone(variable)),
            Slot::Failed => None,
            Slot::Open => {
                let name = self.globals[at].name;
                self.error(Code::E0402, name.span, format!("the declaration of `{}` needs itself", name.text));
                None
            }
        }
    }

    /// The signature of the POU in slot `at`.
    pub fn signature(&mut self, at: usize) -> Option<Rc<Signature<'s>>> {
        match &self.pous[at].slot {
            Slot::Done(signature) => Some(Rc::clone(signature)),
            Slot::Failed => None,
            Slot::Open => {
                let name = self.pous[at].ast.name;
                self.report(
                    Diagnostic::new(Code::E0402, name.span, format!("`{}` contains an instance of itself", name.text))
                        .label("its size would be endless"),
                );
                None
            }
        }
    }

    fn global_variable(&mut self, at: usize) -> Option<Variable<'s>> {
        let GlobalSlot { name, block, decl, .. } = self.globals[at];
        let reported = self.diagnostics.len();
        let resolved = self.declared_type(decl, &Rc::new(Scope::default()), name.text)?;
        if block.constant.is_some() && self.has_errors_since(reported) {
            return None;
        }
        self.check_retain(block, resolved.ty, name);
        let place = match self.addresses.field_of_global(at) {
            Some(field) => {
                self.check_address_here(None, block, decl);
                self.register_address(None, block, decl, &resolved);
                let field = staunch_ir::FieldId::next(field);
                Place::root(Root::Globals, Type::Struct(GLOBALS)).field(field, resolved.ty)
            }
            None => self.located(None, block, decl, name, &resolved)??,
        };
        Some(self.variable(name, block, Rc::new(resolved), place))
    }

    /// Whether the structure is the state of a PROGRAM or FUNCTION_BLOCK.
    pub fn is_instance(&self, id: StructId) -> bool {
        self.instances.contains_key(&id)
    }

    pub fn slot_of_instance(&self, id: StructId) -> Option<usize> {
        self.instances.get(&id).copied()
    }

    /// The direct address of a field of the globals.
    pub fn address_of_global(&self, field: staunch_ir::FieldId) -> Option<staunch_ir::Address> {
        match self.addresses.global_of_field(field.index()) {
            Some(at) => address::parse(self.globals[at].decl.address?.text),
            None => self.hidden.address_of(field.index() - self.addresses.own_fields().len()),
        }
    }

    /// The standard block that a bare `name` means where `span` stands.
    pub fn bare_block(&self, name: &str, span: Span) -> Option<staunch_ir::BlockId> {
        let block = dialect::bare_block(self.dialect(span), name)?;
        Some(dialect::as_options_have_it(block, |it| self.options.is_on(it)))
    }

    /// The block called `name` in `family`, as the options have it.
    pub fn block_in(&self, family: staunch_runtime::Family, name: &str) -> Option<staunch_ir::BlockId> {
        let block = dialect::block_in(family, name)?;
        Some(dialect::as_options_have_it(block, |it| self.options.is_on(it)))
    }

    /// Makes the globals' structure, so that places in bodies have their types.
    fn declare_globals(&mut self) {
        let fields = self.global_fields();
        self.program.globals = StructId::next(self.program.structs.len());
        let location = Location::default();
        self.program.structs.push(Struct { name: "Globals".to_owned(), doc: None, location, fields });
    }

    fn global_fields(&mut self) -> Vec<staunch_ir::Field> {
        let fields: Vec<_> = (0..self.globals.len()).filter_map(|at| self.global_field(at)).collect();
        fields.into_iter().chain(self.hidden.fields()).collect()
    }

    /// Puts the parts together: the globals' structure, the instances, the order of the POUs.
    fn finish(&mut self, bodies: Vec<Option<(staunch_ir::Routine, check::Uses)>>) -> Option<Program> {
        let mut fields = self.global_fields();
        fields.iter_mut().for_each(|it| self.addresses.complete(it));
        self.program.aliases = (0..self.globals.len()).filter_map(|at| self.alias(at)).collect();
        let globals = self.program.globals.index();
        self.program.structs[globals].fields = fields;
        let (routines, uses) = bodies.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
        self.program.routines = routines;
        self.program.classes = (0..self.pous.len()).filter_map(|slot| self.class(slot)).collect();
        self.check_named_programs();
        configuration::instances(self);
        order::order(self, uses)?;
        self.check_size()?;
        Some(std::mem::replace(&mut self.program, empty_program(Vec::new())))
    }

    /// The PROGRAM or FUNCTION_BLOCK in a slot. Its body has the slot's number until routines are put in order.
    fn class(&mut self, slot: usize) -> Option<Class> {
        let pou = self.pous[slot].ast;
        let kind = match pou.kind {
            // Who is called has an instance, as a FUNCTION_BLOCK has.
            ast::PouKind::Program if self.is_named_program(slot) => ClassKind::FunctionBlock,
            ast::PouKind::Program => ClassKind::Program,
            ast::PouKind::FunctionBlock => ClassKind::FunctionBlock,
            ast::PouKind::Function => return None,
        };
        let signature = self.signature(slot)?;
        let variable = |it: &Rc<Variable<'_>>| staunch_ir::Variable {
            name: it.name.text.to_owned(),
            section: it.section,
            place: it.place.clone(),
        };
        Some(Class {
            kind,
            name: pou.name.text.to_owned(),
            doc: pou.doc.clone(),
            location: self.location(pou.name.span),
            state: signature.state?,
            variables: signature.scope.variables.iter().map(variable).collect(),
            body: RoutineId::next(slot),
            prescan: None,
        })
    }

    /// The class of the PROGRAM or FUNCTION_BLOCK in a slot, while bodies have their slots' numbers.
    fn class_of_slot(&self, slot: usize) -> Option<ClassId> {
        let body = RoutineId::next(slot);
        self.program.classes.iter().position(|it| it.body == body).map(ClassId::next)
    }

    /// Whether all variables together, and each type, fit into memory.
    fn check_size(&mut self) -> Option<()> {
        let Err(TooLarge { at, .. }) = Layout::try_new(&self.program) else { return Some(()) };
        let program = self.program.instances.last().map(|it| self.program.class(it.program).location);
        let span = self.name_at(at.or(program).unwrap_or_default());
        self.report(
            Diagnostic::new(Code::E0901, span, "the variables up to this one take more than 1 GiB")
                .label("too large together"),
        );
        None
    }

    /// The name that stands at a location.
    fn name_at(&self, at: Location) -> Span {
        let source = self.sources.get(at.file);
        let range = source.line_range(at.line);
        let (start, line) = (range.start, &source.text[range]);
        let before = usize::from(at.column).saturating_sub(1);
        let before: usize = line.chars().take(before).map(char::len_utf8).sum();
        let name = line[before..].chars().take_while(|it| it.is_ascii_alphanumeric() || *it == '_').count();
        let offset = |length: usize| u32::try_from(start + length).unwrap_or(u32::MAX);
        Span { file: at.file, start: offset(before), end: offset(before + name) }
    }

    fn global_field(&mut self, at: usize) -> Option<staunch_ir::Field> {
        let variable = self.global(at)?;
        self.addresses.field_of_global(at)?;
        let GlobalSlot { name, block, decl, .. } = self.globals[at];
        Some(self.field(name, &variable.resolved, block, decl))
    }

    /// The global in slot `at`, if it is another name of an earlier one's address.
    fn alias(&mut self, at: usize) -> Option<staunch_ir::Variable> {
        if self.addresses.field_of_global(at).is_some() {
            return None;
        }
        let variable = self.global(at)?;
        Some(staunch_ir::Variable {
            name: address::field_name(variable.name.text),
            section: variable.section,
            place: variable.place.clone(),
        })
    }
}

fn empty_program(files: Vec<SourceFile>) -> Program {
    Program {
        files,
        enums: Vec::new(),
        bounds: Vec::new(),
        arrays: Vec::new(),
        structs: Vec::new(),
        globals: StructId(0),
        classes: Vec::new(),
        routines: Vec::new(),
        aliases: Vec::new(),
        instances: Vec::new(),
    }
}

/// The quoted name in `dialect 'codesys'`.
fn dialect_pragma(text: &str) -> Option<&str> {
    let text = text.trim();
    let (word, rest) = text.split_at_checked("dialect".len())?;
    let rest = rest.trim_start().trim_start_matches(":=").trim();
    let quoted = rest.strip_prefix('\'')?.strip_suffix('\'');
    word.eq_ignore_ascii_case("dialect").then_some(quoted).flatten()
}
