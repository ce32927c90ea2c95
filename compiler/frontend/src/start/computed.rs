//! Initial values that are computed as the program starts: in CODESYS one may be any expression. Calls, dereferences, the
//! values of references and PROPERTYs, and what asks for variables that start with such, are assigned by the start of
//! instances, as addresses are. Constants stay as they are declared.

use crate::ast::{
    Element, Expr, ExprKind, File, Initial, InitialKind, Item, PouKind, TypeDecl, TypeKind, TypeSpec, VarBlock,
    VarKind, each_part,
};
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::RefKind;

/// When a value is assigned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum When {
    /// Before the instances start, whose FB_init may be given it.
    Before,
    /// When they have: their METHODs and PROPERTYs are called.
    After,
}

/// Whose initial values these are.
#[derive(Clone, Copy)]
pub(super) enum Owner<'s> {
    Globals,
    Pou(Key<'s>),
    /// What has constants, or is computed at each call.
    Other,
}

impl<'s> Owner<'s> {
    fn pou(self) -> Option<Key<'s>> {
        match self {
            Self::Pou(name) => Some(name),
            Self::Globals | Self::Other => None,
        }
    }
}

/// What initial values name, as far as syntax shows.
#[derive(Default)]
pub(super) struct Computed<'s> {
    functions: FxHashSet<Key<'s>>,
    /// PROGRAMs, whose variables others may name.
    programs: FxHashSet<Key<'s>>,
    /// FUNCTION_BLOCKs and CLASSes, and the types that have one as a part.
    blocks: FxHashSet<Key<'s>>,
    methods: FxHashSet<Key<'s>>,
    getters: FxHashSet<Key<'s>>,
    /// Of each class, the PROPERTYs that can be assigned.
    setters: FxHashMap<Key<'s>, FxHashSet<Key<'s>>>,
    globals: Variables<'s>,
    /// By the POU that declares them, and of all POUs together.
    own: FxHashMap<Key<'s>, Variables<'s>>,
    members: FxHashMap<Key<'s>, When>,
}

/// The variables of a POU, or the global ones.
#[derive(Default)]
struct Variables<'s> {
    names: FxHashSet<Key<'s>>,
    /// Each REFERENCE TO.
    references: FxHashSet<Key<'s>>,
    /// The names of types, of variables that may be instances.
    types: FxHashMap<Key<'s>, Key<'s>>,
    computed: FxHashMap<Key<'s>, When>,
}

impl<'s> Variables<'s> {
    fn add(&mut self, block: &VarBlock<'s>) {
        for decl in &block.vars {
            let names = decl.names.iter().map(|it| Key(it.text));
            if matches!(decl.ty.kind, TypeKind::Reference { kind: RefKind::ReferenceTo, .. }) {
                self.references.extend(names.clone());
            }
            if let Some(ty) = named(&decl.ty) {
                self.types.extend(names.clone().map(|it| (it, ty)));
            }
            self.names.extend(names);
        }
    }

    fn when(&self, name: Key<'s>) -> Option<When> {
        self.computed.get(&name).copied().or_else(|| self.references.contains(&name).then_some(When::Before))
    }
}

impl<'s> Computed<'s> {
    /// Those of the files that `computes` names.
    pub fn of(files: &[File<'s>], computes: &dyn Fn(usize) -> bool) -> Self {
        let mut it = Self::default();
        let computing = || files.iter().enumerate().filter(|(at, _)| computes(*at)).map(|it| it.1);
        for item in files.iter().flat_map(|it| &it.items) {
            it.declare(item);
        }
        let types = || files.iter().flat_map(|it| &it.items).filter_map(type_decls).flatten();
        while types().filter(|decl| it.holds_instance(decl)).count() > 0 {}
        // What asks for a variable that is computed is, too.
        while computing().flat_map(|file| &file.items).filter(|item| it.find(item)).count() > 0 {}
        it
    }

    /// Notes a type that has an instance as a part; whether it was not known before.
    fn holds_instance(&mut self, decl: &TypeDecl<'s>) -> bool {
        let is_block = |it: &TypeSpec<'s>| named(it).is_some_and(|it| self.is_block(it));
        let holds = match &decl.ty.kind {
            TypeKind::Struct(fields) | TypeKind::Union(fields) => fields.iter().any(|it| is_block(&it.ty)),
            TypeKind::Named(_) | TypeKind::Array { .. } => is_block(&decl.ty),
            TypeKind::String { .. }
            | TypeKind::Subrange { .. }
            | TypeKind::Enum { .. }
            | TypeKind::Reference { .. }
            | TypeKind::Error => false,
        };
        holds && self.blocks.insert(Key(decl.name.text))
    }

    fn is_block(&self, ty: Key<'s>) -> bool {
        self.blocks.contains(&ty) || staunch_runtime::BLOCKS.iter().any(|it| it.is_named(ty.0))
    }

    fn declare(&mut self, item: &Item<'s>) {
        match item {
            Item::Pou(pou) => {
                if pou.kind == PouKind::Function && pou.external.is_none() {
                    self.functions.insert(Key(pou.name.text));
                }
                if pou.kind == PouKind::Program {
                    self.programs.insert(Key(pou.name.text));
                }
                if pou.kind.is_block() {
                    self.blocks.insert(Key(pou.name.text));
                }
                let own = self.own.entry(Key(pou.name.text)).or_default();
                pou.blocks.iter().for_each(|it| own.add(it));
                for routine in &pou.routines {
                    let name = Key(routine.name.text);
                    match routine.kind {
                        PouKind::Getter => drop(self.getters.insert(name)),
                        PouKind::Setter => drop(self.setters.entry(Key(pou.name.text)).or_default().insert(name)),
                        PouKind::Method => drop(self.methods.insert(name)),
                        PouKind::Program
                        | PouKind::FunctionBlock
                        | PouKind::Class
                        | PouKind::Interface
                        | PouKind::Function
                        | PouKind::Test
                        | PouKind::Action => {}
                    }
                }
            }
            Item::Globals(_) | Item::Configuration(_) => {
                blocks(item).iter().for_each(|it| self.globals.add(it));
            }
            Item::Types(_) | Item::Test(_) => {}
        }
    }

    /// Notes the variables of an item whose values are computed; whether there are more than before.
    fn find(&mut self, item: &Item<'s>) -> bool {
        let (pou, blocks) = match item {
            Item::Pou(pou) if has_state(pou.kind) => (Some(Key(pou.name.text)), pou.blocks.as_slice()),
            Item::Globals(_) | Item::Configuration(_) => (None, blocks(item)),
            Item::Pou(_) | Item::Types(_) | Item::Test(_) => return false,
        };
        let mut more = false;
        for decl in blocks.iter().filter(|it| is_computed_block(it)).flat_map(|it| &it.vars) {
            let Some(when) = decl.initial.as_ref().and_then(|it| self.when_of(it, pou)) else { continue };
            for name in decl.names.iter().map(|it| Key(it.text)) {
                let own = match pou {
                    Some(pou) => self.own.entry(pou).or_default(),
                    None => &mut self.globals,
                };
                more |= own.computed.insert(name, when) != Some(when);
                let known = self.members.entry(name).or_insert(when);
                *known = when.max(*known);
            }
        }
        more
    }

    /// When an initial value is assigned that is computed, or a part of it.
    fn when_of(&self, initial: &Initial<'s>, pou: Option<Key<'s>>) -> Option<When> {
        match &initial.kind {
            InitialKind::Value(value) => self.when(value, pou),
            // Nothing is computed from an address before the start.
            InitialKind::Bind(_) => None,
            InitialKind::Elements(elements) => {
                let values = elements.iter().flat_map(|it: &Element<'_>| &it.values);
                values.filter_map(|it| self.when_of(it, pou)).max()
            }
            InitialKind::Indexed(elements) => elements.iter().filter_map(|(_, it)| self.when_of(it, pou)).max(),
            InitialKind::Members(values) => values.iter().filter_map(|it| self.when_of(it, pou)).max(),
            InitialKind::Fields(fields) => {
                fields.iter().filter_map(|(_, it)| self.when_of(it, pou)).max().map(|_| When::After)
            }
        }
    }

    /// When a value is assigned; `None` for what may be a constant.
    pub fn when_computed(&self, value: &Expr<'s>, owner: Owner<'s>) -> Option<When> {
        match owner {
            Owner::Globals | Owner::Pou(_) => self.when(value, owner.pou()),
            Owner::Other => None,
        }
    }

    fn when(&self, value: &Expr<'s>, pou: Option<Key<'s>>) -> Option<When> {
        let mut found = None;
        each_part(value, &mut |it| {
            let own = match &it.kind {
                ExprKind::Call(callee, _) => self.when_called(callee),
                ExprKind::Deref(pointer) => Some(self.when_followed(pointer, pou)),
                ExprKind::Name(name) => self.when_named(Key(name.text), pou),
                ExprKind::Member(owner, _) if self.is_instance(owner, pou) => Some(When::After),
                ExprKind::Member(_, name) if self.getters.contains(&Key(name.text)) => Some(When::After),
                ExprKind::Member(_, name) => self.members.get(&Key(name.text)).copied(),
                ExprKind::Literal(_)
                | ExprKind::Address(_)
                | ExprKind::Part(..)
                | ExprKind::Unary(..)
                | ExprKind::Paren(_)
                | ExprKind::Index(..)
                | ExprKind::Error(_)
                | ExprKind::Binary(..)
                | ExprKind::Assign(..) => None,
            };
            found = found.max(own);
        });
        found
    }

    /// Whether an expression begins with an instance, whose variables have their values when it has started.
    fn is_instance(&self, expr: &Expr<'s>, pou: Option<Key<'s>>) -> bool {
        let Some(name) = expr.variable().map(|it| Key(it.text)) else { return false };
        let own = pou.and_then(|it| self.own.get(&it)).filter(|it| it.names.contains(&name));
        let ty = own.unwrap_or(&self.globals).types.get(&name);
        ty.is_some_and(|it| self.is_block(*it))
    }

    fn when_called(&self, callee: &Expr<'s>) -> Option<When> {
        match &callee.kind {
            ExprKind::Name(name) if self.functions.contains(&Key(name.text)) => Some(When::Before),
            ExprKind::Name(name) | ExprKind::Member(_, name) if self.methods.contains(&Key(name.text)) => {
                Some(When::After)
            }
            ExprKind::Member(_, name) if self.functions.contains(&Key(name.text)) => Some(When::Before),
            _ => None,
        }
    }

    /// A pointer of the POU has its address before others start.
    fn when_followed(&self, pointer: &Expr<'s>, pou: Option<Key<'s>>) -> When {
        let own = pou.and_then(|it| self.own.get(&it));
        let is_own = pointer.first_name().is_some_and(|it| own.is_some_and(|own| own.names.contains(&Key(it.text))));
        if is_own || pou.is_none() { When::Before } else { When::After }
    }

    fn when_named(&self, name: Key<'s>, pou: Option<Key<'s>>) -> Option<When> {
        match pou.and_then(|it| self.own.get(&it)).filter(|it| it.names.contains(&name)) {
            Some(own) => own.when(name),
            None if self.programs.contains(&name) && !self.globals.names.contains(&name) => Some(When::After),
            // Global variables start with the instances of a POU.
            None => self.globals.when(name).map(|when| if pou.is_some() { When::After } else { when }),
        }
    }

    /// Whether a class has a PROPERTY that an initial value of an instance can assign.
    pub fn is_property(&self, class: Key<'s>, name: Key<'s>) -> bool {
        self.setters.get(&class).is_some_and(|it| it.contains(&name))
    }
}

/// The type that is named, or that the elements of an array have.
fn named<'s>(ty: &TypeSpec<'s>) -> Option<Key<'s>> {
    match &ty.kind {
        TypeKind::Named(path) => path.last().map(|it| Key(it.text)),
        TypeKind::Array { element, .. } => named(element),
        TypeKind::String { .. }
        | TypeKind::Subrange { .. }
        | TypeKind::Struct(_)
        | TypeKind::Union(_)
        | TypeKind::Enum { .. }
        | TypeKind::Reference { .. }
        | TypeKind::Error => None,
    }
}

fn type_decls<'a, 's>(item: &'a Item<'s>) -> Option<&'a [TypeDecl<'s>]> {
    match item {
        Item::Types(it) => Some(it),
        Item::Globals(_) | Item::Configuration(_) | Item::Pou(_) | Item::Test(_) => None,
    }
}

/// Whether variables of a block may have computed values: a CONSTANT has none, and what is RETAIN keeps its own.
pub(super) fn is_computed_block(block: &VarBlock<'_>) -> bool {
    !block.has_values() && block.retain.is_none() && block.persistent.is_none() && block.kind != VarKind::InOut
}

/// The global variables in an item.
pub(super) fn blocks<'a, 's>(item: &'a Item<'s>) -> &'a [VarBlock<'s>] {
    match item {
        Item::Globals(block) => std::slice::from_ref(block),
        Item::Configuration(it) => &it.globals,
        Item::Pou(_) | Item::Types(_) | Item::Test(_) => &[],
    }
}

pub(super) fn has_state(kind: PouKind) -> bool {
    kind.is_block() || matches!(kind, PouKind::Program | PouKind::Test)
}
