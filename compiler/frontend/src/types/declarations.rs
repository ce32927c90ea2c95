//! What a program declares: what expressions and bodies are checked against.

use super::address::{self, Addresses};
use super::coverage::Coverage;
use super::generic::{Generics, Instance};
use super::image::Image;
use super::overloads::Overloads;
use super::pools::Pool;
use super::scope::{Scope, Variable};
use super::siblings::{Bodies, Own, Siblings};
use super::signature::Signature;
use super::starts::Starts;
use super::synthetic::{NamedProgram, Synthetic};
use super::table::{Resolved, Table};
use super::tests::Tests;
use crate::diagnostic::Missing;
use crate::dialect::rules::is_followed;
use crate::dialect::{self, Dialect, missing};
use crate::log::Log;
use crate::names::{Entry, Found, Meaning, Names, Sense, Site, SpaceId};
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, ast, start};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{
    BlockId, Location, Part, Program, RefKind, RefType, ReferenceId, Routine, RoutineId, Section, SourceFile, StructId,
    Type,
};
use staunch_runtime::Class;
use std::collections::BTreeMap;
use std::rc::Rc;

/// A declaration, and what it was resolved to.
#[derive(Debug)]
pub(crate) enum Slot<T> {
    /// Not resolved, or being resolved: then it depends on itself.
    Open,
    Done(T),
    /// It has been reported.
    Failed,
}

pub(crate) struct TypeSlot<'s> {
    pub decl: &'s ast::TypeDecl<'s>,
    pub slot: Slot<Resolved>,
}

pub(crate) struct PouSlot<'s> {
    pub ast: &'s ast::Pou<'s>,
    /// A FUNCTION whose body names its result.
    pub names_itself: bool,
    /// Of a METHOD or ACTION: the slot of the POU that it belongs to.
    pub owner: Option<usize>,
    /// Its own METHODs and ACTIONs, by their names.
    pub routines: FxHashMap<Key<'s>, Routines>,
    /// Those that only SUPER names, by where they are declared; a base's body by the base's name.
    pub hidden: FxHashMap<Span, Routines>,
    /// Of a run that a CONFIGURATION writes: where the CONFIGURATION names it.
    pub run: Option<Span>,
    /// Of a generic FUNCTION as it is written: the words that its declarations use.
    pub words: Vec<Class>,
    /// Of a generic FUNCTION as calls ask for it.
    pub instance: Option<Instance>,
    /// Of a routine that nobody writes: one that chooses, for many calls, by the class of an instance, or a copy for the next
    /// level of a chain of instances.
    pub dispatch: Option<Box<Routine>>,
    pub slot: Slot<Rc<Signature<'s>>>,
}

/// What one name means among the routines of a POU: their slots, and where each is declared.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Routines {
    /// A METHOD or ACTION.
    pub called: Option<(usize, Span)>,
    /// Of a PROPERTY.
    pub getter: Option<(usize, Span)>,
    pub setter: Option<(usize, Span)>,
}

impl Routines {
    /// Where what another routine of this kind would clash with is declared.
    pub fn first(&self, kind: ast::PouKind) -> Option<Span> {
        let clash = match kind {
            ast::PouKind::Getter => self.called.or(self.getter),
            ast::PouKind::Setter => self.called.or(self.setter),
            ast::PouKind::Program
            | ast::PouKind::FunctionBlock
            | ast::PouKind::Class
            | ast::PouKind::Interface
            | ast::PouKind::Function
            | ast::PouKind::Test
            | ast::PouKind::Action
            | ast::PouKind::Method => self.called.or(self.getter).or(self.setter),
        };
        clash.map(|it| it.1)
    }

    /// The routine of a kind.
    pub fn of(&self, kind: ast::PouKind) -> Option<(usize, Span)> {
        let mut routines = *self;
        *routines.place(kind)
    }

    pub fn set(&mut self, kind: ast::PouKind, slot: usize, span: Span) {
        *self.place(kind) = Some((slot, span));
    }

    fn place(&mut self, kind: ast::PouKind) -> &mut Option<(usize, Span)> {
        match kind {
            ast::PouKind::Getter => &mut self.getter,
            ast::PouKind::Setter => &mut self.setter,
            ast::PouKind::Program
            | ast::PouKind::FunctionBlock
            | ast::PouKind::Class
            | ast::PouKind::Interface
            | ast::PouKind::Function
            | ast::PouKind::Test
            | ast::PouKind::Action
            | ast::PouKind::Method => &mut self.called,
        }
    }

    pub fn is_property(&self) -> bool {
        self.getter.is_some() || self.setter.is_some()
    }
}

impl<'s> PouSlot<'s> {
    pub fn open(ast: &'s ast::Pou<'s>) -> Self {
        Self {
            ast,
            names_itself: false,
            owner: None,
            routines: FxHashMap::default(),
            hidden: FxHashMap::default(),
            run: None,
            words: Vec::new(),
            instance: None,
            dispatch: None,
            slot: Slot::Open,
        }
    }

    /// Whether the source writes it, and once.
    pub fn is_written(&self) -> bool {
        self.run.is_none() && self.instance.is_none() && self.dispatch.is_none()
    }
}

/// Makes the signature of the POU in a slot.
type BuildSignature<'s> = fn(&mut Declarations<'s>, usize) -> Option<Rc<Signature<'s>>>;

pub(crate) struct GlobalSlot<'s> {
    /// The namespace, or list, that it is in.
    pub space: SpaceId,
    pub name: ast::Name<'s>,
    pub block: &'s ast::VarBlock<'s>,
    pub decl: &'s ast::VarDecl<'s>,
    pub slot: Slot<Rc<Variable<'s>>>,
}

/// The program while it is being declared and checked.
pub(crate) struct Declarations<'s> {
    pub log: Log<'s>,
    pub names: Names<'s>,
    pub types: Vec<TypeSlot<'s>>,
    pub pous: Vec<PouSlot<'s>>,
    /// The slots of classes, by where their names are declared.
    pub classes: FxHashMap<Span, usize>,
    /// The names of all PROPERTYs, of whatever class.
    pub properties: FxHashSet<Key<'s>>,
    pub globals: Vec<GlobalSlot<'s>>,
    pub addresses: Addresses,
    pub image: Image,
    pub synthetic: Synthetic<'s>,
    /// The symbols of what is implemented outside, and where each is declared.
    pub externals: FxHashMap<String, Span>,
    /// By their slots.
    pub named_programs: BTreeMap<usize, NamedProgram<'s>>,
    /// Calls within one expression, where the dialect's system may do them in another order.
    pub siblings: Vec<Siblings>,
    /// What the bodies touch that may have or be such calls.
    pub touched: Bodies,
    /// The CONSTANTs of POUs, by their slots, which others read by a POU's name.
    pub constants: FxHashMap<usize, Rc<Scope<'s>>>,
    pub tests: Tests,
    /// Where execution is counted, if it is.
    pub coverage: Option<Coverage>,
    pub program: Program,
    pub table: Table<'s>,
    pub generics: Generics,
    /// The routines that choose by a class: by the type of the reference, the class that this leads to, and what is
    /// called of that.
    pub dispatches: FxHashMap<(Type, Type, usize), usize>,
    pub overloads: Overloads,
    /// The variables and members that became fields: a field has its number here.
    pub declared: Vec<(ast::Name<'s>, &'s ast::VarDecl<'s>)>,
    /// What declarations say of the start of instances.
    pub starts: Starts,
    /// The pools that `__NEW` takes objects from, by their types; `None` for one that was refused.
    pub pools: FxHashMap<Type, Option<Pool>>,
    /// The types of which `__NEW` asks for arrays, and no pool has any: that was reported.
    pub pools_missing: FxHashSet<Type>,
    /// A call asks for an instance of a generic FUNCTION, whose signature is made as all are: by a layer above.
    pub build_signature: BuildSignature<'s>,
}

impl<'s> Declarations<'s> {
    pub fn new(log: Log<'s>, build_signature: BuildSignature<'s>) -> Self {
        // A pragma may say another.
        let system = log.options.dialect.family();
        let files = log.sources.files().iter().map(|it| SourceFile { path: it.path.clone(), system }).collect();
        Self {
            log,
            names: Names::default(),
            types: Vec::new(),
            pous: Vec::new(),
            classes: FxHashMap::default(),
            properties: FxHashSet::default(),
            globals: Vec::new(),
            addresses: Addresses::default(),
            image: Image::default(),
            synthetic: Synthetic::default(),
            externals: FxHashMap::default(),
            named_programs: BTreeMap::new(),
            siblings: Vec::new(),
            touched: Bodies::default(),
            constants: FxHashMap::default(),
            tests: Tests::default(),
            coverage: None,
            program: empty_program(files),
            table: Table::default(),
            generics: Generics::default(),
            dispatches: FxHashMap::default(),
            overloads: Overloads::default(),
            declared: Vec::new(),
            starts: Starts::default(),
            pools: FxHashMap::default(),
            pools_missing: FxHashSet::default(),
            build_signature,
        }
    }

    /// Whether the POU in a slot has CONSTANTs that others may read by its name.
    pub fn has_own_constants(&self, slot: usize) -> bool {
        let PouSlot { ast: pou, owner, .. } = &self.pous[slot];
        owner.is_none() && self.dialect(pou.name.span).names_constants_of_units() && pou.constants().next().is_some()
    }

    /// The POU of `Settings.MOST`, a CONSTANT by the name of its POU.
    pub fn pou_of_constant(&self, path: &[ast::Name<'s>]) -> Option<usize> {
        let (_, pou) = path.split_last()?;
        match self.lookup(pou, Sense::Value) {
            Found::One(Meaning::Declared(Entry::Pou(slot))) => Some(slot).filter(|it| self.has_own_constants(*it)),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        }
    }

    /// What a path means that is a CONSTANT by the name of its POU.
    pub fn constant_of_pou(&self, path: &[ast::Name<'s>]) -> Option<&Rc<Variable<'s>>> {
        let constants = self.constants.get(&self.pou_of_constant(path)?)?;
        constants.get(path.last()?.text).filter(|it| matches!(it.section, Section::Internal | Section::Output))
    }

    /// The POUs that the source writes, in its order; runs of a CONFIGURATION come after them, and then what calls ask
    /// for: instances of generic FUNCTIONs, and routines that choose by a class.
    pub fn written_pous(&self) -> &[PouSlot<'s>] {
        &self.pous[..self.pous.partition_point(PouSlot::is_written)]
    }

    /// The POUs that runs of a CONFIGURATION are.
    pub fn runs(&self) -> &[PouSlot<'s>] {
        let others = &self.pous[self.written_pous().len()..];
        &others[..others.partition_point(|it| it.run.is_some())]
    }

    /// The run that holds the PROGRAM in a slot, where nothing lists PROGRAMs.
    pub fn run_of_program(&self, slot: usize) -> Option<usize> {
        let first = self.written_pous().len();
        let name = self.pous[slot].ast.name.span;
        let is_it = |it: &PouSlot<'_>| it.run == Some(name) && !it.ast.blocks.is_empty();
        self.runs().iter().position(is_it).map(|at| first + at)
    }

    /// Whether a slot is that of a run that holds nothing: it calls the one instance of its PROGRAM.
    pub fn is_run_of_shared(&self, slot: usize) -> bool {
        self.pous[slot].run.is_some() && self.pous[slot].ast.blocks.is_empty()
    }

    /// Whether the POU in a slot is of a library: a PROGRAM of one does not run by itself.
    pub fn is_of_library(&self, slot: usize) -> bool {
        self.log.sources.get(self.pous[slot].ast.span.file).is_of_library()
    }

    /// Whether a name is that of the PROGRAM in a run of a CONFIGURATION.
    pub fn is_run(&self, program: Span) -> bool {
        self.runs().iter().any(|it| it.ast.name.span == program)
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.log.report(diagnostic);
    }

    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.log.error(code, span, message);
    }

    pub fn not_supported(&mut self, span: Span, what: &str) {
        self.log.not_supported(span, what);
    }

    pub fn dialect(&self, span: Span) -> Dialect {
        self.log.dialect(span)
    }

    pub fn location(&mut self, span: Span) -> Location {
        self.log.location(span)
    }

    /// The name that a POU has for back ends: a TEST has a title, which is none.
    pub fn emitted_name(&self, slot: usize) -> String {
        let PouSlot { ast: pou, instance, dispatch, .. } = &self.pous[slot];
        if let Some(dispatch) = dispatch {
            return dispatch.name.clone();
        }
        if let Some(instance) = instance {
            return instance.name.clone();
        }
        if let Some(name) = self.overloads.names.get(&slot) {
            return name.clone();
        }
        if let (Some(home), true) = (pou.home, pou.is_hidden) {
            return format!("{}_{}", home.text, pou.name.text);
        }
        match pou.kind {
            ast::PouKind::Test => format!("__test_{slot}"),
            ast::PouKind::Getter => format!("get_{}", pou.name.text),
            ast::PouKind::Setter => format!("set_{}", pou.name.text),
            ast::PouKind::Program
            | ast::PouKind::FunctionBlock
            | ast::PouKind::Class
            | ast::PouKind::Interface
            | ast::PouKind::Function
                if emitted(pou.name.text) != pou.name.text =>
            {
                emitted(pou.name.text).to_owned()
            }
            ast::PouKind::Program
            | ast::PouKind::FunctionBlock
            | ast::PouKind::Class
            | ast::PouKind::Interface
            | ast::PouKind::Function => self.name_in_full(pou.name),
            ast::PouKind::Action | ast::PouKind::Method => emitted(pou.name.text).to_owned(),
        }
    }

    /// The name of what is declared, with the namespaces around it.
    pub fn name_in_full(&self, name: ast::Name<'_>) -> String {
        self.names.in_full(self.names.space_of(name.span), name.text)
    }

    /// What to do about a library that the project refers to by a name, and that is not there.
    pub fn missing_library(&self, namespace: &str) -> Option<String> {
        let mut references = self.log.sources.references().iter();
        let library = &references.find(|it| it.namespace.eq_ignore_ascii_case(namespace))?.library;
        let is_there = self.names.libraries().any(|it| it.eq_ignore_ascii_case(library));
        let path = format!("`libraries = [\"…/{library}.plcproj\"]`");
        (!is_there)
            .then(|| format!("add its sources to staunch.toml, as a folder or project named `{library}`: {path}"))
    }

    /// A namespace by which the project refers to a library that is not there.
    pub fn not_there(&self, namespace: &str, place: Span) -> Option<Diagnostic> {
        let help = self.missing_library(namespace)?;
        let error = Diagnostic::missing(Missing::Namespace, namespace, place);
        Some(error.label("the project refers to a library by this name").help(help))
    }

    /// A library of TwinCAT's or CODESYS's, by its name, that is not there.
    pub fn library_not_there(&self, namespace: &str, place: Span) -> Option<Diagnostic> {
        if !missing::is_library(self.dialect(place), namespace) {
            return None;
        }
        let error = Diagnostic::missing(Missing::Library, namespace, place);
        let path = format!("`libraries = [\"…/{namespace}\"]`");
        let help = format!("add its sources to staunch.toml, as a folder or project named `{namespace}`: {path}");
        Some(error.label("it is not bundled with Staunch").help(help))
    }

    /// What a POU is called for people: `Class.Method`.
    pub fn title(&self, slot: usize) -> String {
        let name = self.pous[slot].ast.name;
        match self.pous[slot].owner {
            Some(owner) => {
                let class = self.pous[slot].ast.home.unwrap_or(self.pous[owner].ast.name);
                format!("{}.{}", class.text, name.text)
            }
            None => name.text.to_owned(),
        }
    }

    /// The routines with this name that instances with a state have.
    pub fn routines_of(&self, state: StructId, name: &str) -> Option<Routines> {
        self.pous[self.slot_of_instance(state)?].routines.get(&Key(name)).copied()
    }

    /// The slot of the class that a routine, or a body, is written in.
    pub fn home(&self, slot: usize) -> usize {
        let pou = &self.pous[slot];
        pou.ast.home.and_then(|it| self.class_named(it)).or(pou.owner).unwrap_or(slot)
    }

    /// Keeps what a routine touches, where the system of its dialect may do calls in another order: its body may be dropped.
    pub fn keep_touched(&mut self, slot: usize, routine: &Routine) {
        let dialect = self.dialect(self.pous[slot].ast.name.span);
        if !is_followed(dialect, Part::EvaluationOrder) {
            self.touched.insert(RoutineId::next(slot), Own::of(&routine.body));
        }
    }

    /// The declaration of a field, and the name in it.
    pub fn declaration_of(&self, field: &staunch_ir::Field) -> Option<(ast::Name<'s>, &'s ast::VarDecl<'s>)> {
        field.declared.map(|it| self.declared[it.index()])
    }

    /// The class whose declaration has a name.
    pub fn class_named(&self, name: ast::Name<'_>) -> Option<usize> {
        self.classes.get(&name.span).copied()
    }

    /// What SUPER names in a routine, or in a body: the base's body without a name.
    pub fn routines_of_base(&self, slot: usize) -> &'s [ast::Pou<'s>] {
        let base = self.pous[self.home(slot)].ast.extends.and_then(|it| self.class_named(it));
        base.map_or(&[], |it| &self.pous[it].ast.routines)
    }

    pub fn super_routines(&self, slot: usize, name: Option<ast::Name<'_>>) -> Option<Routines> {
        let Some(name) = name else {
            let base = self.class_named(self.pous[self.home(slot)].ast.extends?)?;
            let owner = self.pous[slot].owner.unwrap_or(slot);
            return self.pous[owner].hidden.get(&self.pous[base].ast.name.span).copied();
        };
        let mut found = Routines::default();
        for at in self.super_slots(slot, name) {
            let pou = self.pous[at].ast;
            if found.of(pou.kind).is_none() {
                found.set(pou.kind, at, pou.name.span);
            }
        }
        (found.called.is_some() || found.is_property()).then_some(found)
    }

    /// The routines that `SUPER^.name` may mean in a routine: copies of those that the base has, overridden or not.
    pub fn super_slots(&self, slot: usize, name: ast::Name<'_>) -> Vec<usize> {
        let base = self.pous[self.home(slot)].ast.extends.and_then(|it| self.class_named(it));
        let Some(base) = base else { return Vec::new() };
        let owner = &self.pous[self.pous[slot].owner.unwrap_or(slot)];
        let named = |it: &PouSlot<'_>| it.routines.get(&Key(name.text)).copied().unwrap_or_default();
        let own = named(owner);
        let copy = |it: &ast::Pou<'_>| {
            let hidden = owner.hidden.get(&it.name.span).and_then(|routines| routines.of(it.kind));
            let own = || own.of(it.kind).into_iter().flat_map(|first| self.all_of_a_name(first.0));
            let inherited = || own().find(|slot| self.pous[*slot].ast.name.span == it.name.span);
            hidden.map(|it| it.0).or_else(inherited)
        };
        let Routines { called, getter, setter } = named(&self.pous[base]);
        let bases = [called, getter, setter].into_iter().flatten().flat_map(|first| self.all_of_a_name(first.0));
        bases.filter_map(|it| copy(self.pous[it].ast)).collect()
    }

    /// The type of what a call of the POU in a slot gives, where its signature is known.
    pub fn result_type(&self, slot: usize) -> Option<Type> {
        let Slot::Done(signature) = &self.pous[slot].slot else { return None };
        signature.result.as_ref().map(|(_, resolved)| resolved.ty)
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
                        .label("its size would be infinite"),
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
                self.error(Code::E0402, name.span, format!("the declaration of `{}` depends on itself", name.text));
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
                let error = own_type(self.pous[at].ast, &self.pous);
                self.report(error);
                None
            }
        }
    }

    pub fn span_of(&self, entry: Entry) -> Span {
        match entry {
            Entry::Type(at) => self.types[at].decl.name.span,
            Entry::Pou(at) => self.pous[at].ast.name.span,
            Entry::Global(at) => self.globals[at].name.span,
        }
    }

    /// The type of references to `target`.
    pub fn reference_type(&mut self, kind: RefKind, target: Type) -> Type {
        let wanted = RefType { kind, target };
        Type::Reference(*self.table.index.references.entry(wanted).or_insert_with(|| {
            self.program.references.push(wanted);
            ReferenceId::next(self.program.references.len() - 1)
        }))
    }

    /// Whether the structure is the state of a PROGRAM or FUNCTION_BLOCK.
    pub fn is_instance(&self, id: StructId) -> bool {
        self.table.instances.contains_key(&id)
    }

    pub fn slot_of_instance(&self, id: StructId) -> Option<usize> {
        self.table.instances.get(&id).copied()
    }

    /// What a path means where it is, as the options have it.
    pub fn lookup(&self, path: &[ast::Name<'_>], sense: Sense) -> Found {
        let Some(last) = path.last() else { return Found::Nothing };
        match self.names.lookup(self.site(last.span), path, sense) {
            Found::One(Meaning::Block(block)) => {
                let block = dialect::as_options_have_it(block, |it| self.log.options.is_on(it));
                Found::One(Meaning::Block(block))
            }
            found @ (Found::Nothing | Found::One(_) | Found::Several(_)) => found,
        }
    }

    pub fn site(&self, span: Span) -> Site {
        Site { span, dialect: self.dialect(span), is_bundled: self.log.sources.get(span.file).is_bundled() }
    }

    /// What files declare by a name where a value is expected.
    pub fn declared(&self, name: ast::Name<'_>) -> Option<Entry> {
        match self.lookup(&[name], Sense::Value) {
            Found::One(Meaning::Declared(entry)) => Some(entry),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        }
    }

    /// The enumerations with a value that a bare name may mean: those of the library around, else the program's, else all.
    pub fn enumerations_with(&self, name: ast::Name<'_>) -> Vec<usize> {
        let all = self.names.enumerators.get(&Key(name.text)).map_or(&[][..], Vec::as_slice);
        let home = |slot: &usize| self.names.home(self.types[*slot].decl.name.span);
        let levels = [self.names.home(name.span), SpaceId::ROOT];
        let of_level = |level| all.iter().copied().filter(|it| home(it) == level).collect::<Vec<_>>();
        levels.into_iter().map(of_level).find(|it| !it.is_empty()).unwrap_or_else(|| all.to_vec())
    }

    /// The standard block that a bare name means.
    pub fn bare_block(&self, name: ast::Name<'_>) -> Option<BlockId> {
        match self.lookup(&[name], Sense::Type) {
            Found::One(Meaning::Block(block)) => Some(block),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        }
    }

    /// Reports a name that means several things, which are named in full.
    pub fn report_ambiguous(&mut self, name: ast::Name<'_>, meanings: &[String]) {
        let names: Vec<_> = meanings.iter().map(String::as_str).collect();
        self.report(
            Diagnostic::new(Code::E0108, name.span, format!("`{}` may mean several things here", name.text))
                .label("which one is meant?")
                .help(format!("write {}", crate::diagnostic::wording::any_of(&names))),
        );
    }

    /// The type of a global variable, where it is known: in its own declaration it is not yet.
    pub fn type_of_global(&self, name: ast::Name<'_>) -> Option<Type> {
        let Some(Entry::Global(at)) = self.declared(name) else { return None };
        match &self.globals[at].slot {
            Slot::Done(variable) => Some(variable.resolved.ty),
            Slot::Open | Slot::Failed => None,
        }
    }

    /// The type that a path names.
    pub fn type_of_path(&mut self, path: &[ast::Name<'_>]) -> Option<Type> {
        match self.lookup(path, Sense::Type) {
            Found::One(Meaning::Declared(Entry::Type(at))) => self.named_type(at).map(|it| it.ty),
            Found::One(Meaning::Declared(Entry::Pou(at))) => self.signature(at)?.state.map(Type::Struct),
            Found::One(Meaning::Block(block)) => Some(Type::Block(block)),
            Found::One(_) | Found::Nothing | Found::Several(_) => None,
        }
    }

    /// What the field of the global variable in a slot is called: a name that several namespaces have is
    /// after its own one's.
    pub fn global_field_name(&self, at: usize) -> String {
        let GlobalSlot { name, space, .. } = &self.globals[at];
        let own = address::field_name(name.text);
        if *space != SpaceId::ROOT && self.names.globals_named(name.text) > 1 {
            return self.names.in_full(*space, &own).replace('.', "_");
        }
        own
    }

    /// The instance that the name of the PROGRAM in a slot means.
    pub fn program_variable(&self, slot: usize) -> Option<Rc<Variable<'s>>> {
        self.named_programs.get(&slot).map(|it| Rc::clone(&it.variable))
    }

    /// Whether the PROGRAM in a slot has its instance among the globals.
    pub fn is_named_program(&self, slot: usize) -> bool {
        self.named_programs.contains_key(&slot)
    }

    /// Whether a slot is that of a run whose PROGRAM others call: the call does what the run would.
    pub fn is_run_of_named_program(&self, slot: usize) -> bool {
        self.named_programs.values().any(|it| it.run.is_some_and(|(run, _)| run == slot))
    }
}

/// A name of the compiler's own, as those may read it who read what is emitted.
fn emitted(name: &str) -> &str {
    match name {
        start::START => "start",
        start::GLOBALS => "start_globals",
        _ => name,
    }
}

pub(crate) fn empty_program(files: Vec<SourceFile>) -> Program {
    Program {
        files,
        enums: Vec::new(),
        bounds: Vec::new(),
        milliseconds: None,
        remotes: Vec::new(),
        arrays: Vec::new(),
        interfaces: Vec::new(),
        implementers: Vec::new(),
        references: Vec::new(),
        structs: Vec::new(),
        globals: StructId(0),
        classes: Vec::new(),
        routines: Vec::new(),
        aliases: Vec::new(),
        global_paths: Vec::new(),
        bound: Vec::new(),
        reentered: std::collections::BTreeSet::new(),
        reach: staunch_ir::Reach::default(),
        reached: None,
        places: std::collections::BTreeSet::new(),
        uses: staunch_ir::Uses::default(),
        is_configured: false,
        instances: Vec::new(),
    }
}

/// A block that needs its own type, in a variable that is part of it or in an in-out: its own, or one of a block that it
/// holds, or that holds it.
fn own_type(pou: &ast::Pou<'_>, all: &[PouSlot<'_>]) -> Diagnostic {
    let name = pou.name;
    if let Some(in_out) = of_type(pou, name, true) {
        let message = format!("`{}` cannot have a VAR_IN_OUT of its own type", name.text);
        return Diagnostic::new(Code::E0402, in_out, message)
            .label("the block is not declared yet here")
            .help(format!("take a reference to the other instance: a VAR_INPUT of `REF_TO {}`", name.text));
    }
    let others = || all.iter().map(|it| it.ast).filter(|it| it.kind.is_block());
    let pairs = others().flat_map(|it| [(pou, it), (it, pou)]);
    for (outer, inner) in pairs {
        if let (Some(in_out), Some(held)) = (of_type(inner, outer.name, true), of_type(outer, inner.name, false)) {
            let (outer, inner) = (outer.name.text, inner.name.text);
            let message = format!("`{inner}`, which `{outer}` holds, cannot have a VAR_IN_OUT of `{outer}`");
            return Diagnostic::new(Code::E0402, in_out, message)
                .label(format!("`{outer}` is not declared yet here"))
                .other(held, "held here")
                .help(format!("take a reference to the instance: a VAR_INPUT of `REF_TO {outer}`"));
        }
    }
    Diagnostic::new(Code::E0402, name.span, format!("`{}` contains an instance of itself", name.text))
        .label("its size would be infinite")
}

/// Where a block has a variable of the named type: an in-out, or one that it holds.
fn of_type(pou: &ast::Pou<'_>, name: ast::Name<'_>, is_in_out: bool) -> Option<Span> {
    let blocks = pou.blocks.iter().filter(|it| (it.kind == ast::VarKind::InOut) == is_in_out);
    let is_it = |it: &ast::Name<'_>| Key(it.text) == Key(name.text);
    let is_of_it =
        |it: &&ast::VarDecl<'_>| matches!(&it.ty.kind, ast::TypeKind::Named(path) if path.last().is_some_and(is_it));
    blocks.flat_map(|it| &it.vars).find(is_of_it).map(|it| it.ty.span)
}
