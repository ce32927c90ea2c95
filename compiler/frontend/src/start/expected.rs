//! What types variables and their members are declared with, as far as initial values ask: whether `i` in `(i := a)` is of
//! an INTERFACE, or a REFERENCE TO.

use super::computed::{Computed, Owner, When};
use super::varying::Names;
use crate::Span;
use crate::ast::{Bound, Expr, ExprKind, File, Item, Name, PouKind, TypeKind, TypeSpec, UnaryOp, VarDecl};
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::RefKind;

/// By their names; of several with one name, the last.
#[derive(Default)]
pub(super) struct Types<'s> {
    interfaces: FxHashSet<Key<'s>>,
    /// Of structures and blocks, the members whose types have names or are references.
    members: FxHashMap<Key<'s>, FxHashMap<Key<'s>, TypeSpec<'s>>>,
    /// Other names of types.
    aliases: FxHashMap<Key<'s>, TypeSpec<'s>>,
    /// The files in which a REFERENCE TO is bound by `:=`.
    binding: FxHashSet<u16>,
    /// What initial values ask for that are computed.
    computed: Computed<'s>,
}

impl<'s> Types<'s> {
    pub fn of(files: &[File<'s>], binds: &dyn Fn(Span) -> bool) -> Self {
        let at = |file| Span { file, start: 0, end: 0 };
        let binding = (0..).take(files.len()).filter(|it| binds(at(*it))).collect();
        let computed = Computed::of(files, &|file| u16::try_from(file).is_ok_and(|it| binds(at(it))));
        let mut types = Self { binding, computed, ..Self::default() };
        let declared = names(files);
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Pou(pou) if pou.kind == PouKind::Interface => drop(types.interfaces.insert(Key(pou.name.text))),
                Item::Pou(pou) if pou.kind.is_block() => {
                    types.add(pou.name, pou.blocks.iter().flat_map(|it| &it.vars), &declared);
                }
                Item::Types(all) => {
                    for it in all {
                        match &it.ty.kind {
                            TypeKind::Struct(members) => types.add(it.name, members.iter(), &declared),
                            TypeKind::Named(_) | TypeKind::Array { .. } => {
                                types.aliases.insert(Key(it.name.text), it.ty.clone());
                            }
                            TypeKind::String { .. }
                            | TypeKind::Subrange { .. }
                            | TypeKind::Enum { .. }
                            | TypeKind::Reference { .. }
                            | TypeKind::Union(_)
                            | TypeKind::Error => {}
                        }
                    }
                }
                Item::Pou(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
            }
        }
        types
    }

    fn add<'a>(&mut self, name: Name<'s>, members: impl Iterator<Item = &'a VarDecl<'s>>, declared: &FxHashSet<Key<'s>>)
    where
        's: 'a,
    {
        let asked = members.filter(|it| may_hold_references(&it.ty, declared));
        let each = asked.flat_map(|it| it.names.iter().map(move |name| (Key(name.text), it.ty.clone())));
        let each: FxHashMap<_, _> = each.collect();
        if !each.is_empty() {
            self.members.insert(Key(name.text), each);
        }
    }
}

/// The names of all types that are declared.
fn names<'s>(files: &[File<'s>]) -> FxHashSet<Key<'s>> {
    let mut names = FxHashSet::default();
    for item in files.iter().flat_map(|it| &it.items) {
        match item {
            Item::Pou(pou) => drop(names.insert(Key(pou.name.text))),
            Item::Types(types) => names.extend(types.iter().map(|it| Key(it.name.text))),
            Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
        }
    }
    names
}

fn may_hold_references<'s>(ty: &TypeSpec<'s>, declared: &FxHashSet<Key<'s>>) -> bool {
    match &ty.kind {
        TypeKind::Named(path) => path.last().is_some_and(|it| declared.contains(&Key(it.text))),
        TypeKind::Reference { .. } => true,
        TypeKind::Array { element, .. } => may_hold_references(element, declared),
        TypeKind::String { .. }
        | TypeKind::Subrange { .. }
        | TypeKind::Struct(_)
        | TypeKind::Enum { .. }
        | TypeKind::Union(_)
        | TypeKind::Error => false,
    }
}

/// How an address is assigned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum By {
    Assignment,
    /// `REF=`
    Binding,
}

/// What an initial value is for.
#[derive(Clone, Copy)]
pub(super) struct Expected<'a, 's> {
    ty: Option<&'a TypeSpec<'s>>,
    types: &'a Types<'s>,
    /// Where values of variables are assigned, too.
    names: Option<&'a Names<'a, 's>>,
    owner: Owner<'s>,
    /// It is a part of an instance or a structure, `(i := a)`.
    pub is_member: bool,
}

/// The lower and the upper bound of a dimension.
pub(super) type Bounds<'a, 's> = (&'a Expr<'s>, &'a Expr<'s>);

/// Aliases of aliases that are followed.
const DEPTH: usize = 16;

impl<'a, 's> Expected<'a, 's> {
    pub fn variable(ty: &'a TypeSpec<'s>, types: &'a Types<'s>, names: Option<&'a Names<'a, 's>>) -> Self {
        Self { ty: Some(ty), types, names, owner: Owner::Other, is_member: false }
    }

    /// Where these are the values of a POU's state, or of global variables.
    #[must_use]
    pub fn of(self, owner: Owner<'s>) -> Self {
        Self { owner, ..self }
    }

    /// When a value is assigned that is computed as the program starts.
    pub fn when(&self, value: &Expr<'s>) -> Option<When> {
        let is_reference = matches!(self.kind(), Some(TypeKind::Reference { kind: RefKind::ReferenceTo, .. }));
        let may_be = !is_reference && self.types.binding.contains(&value.span.file);
        may_be.then(|| self.types.computed.when_computed(value, self.owner)).flatten()
    }

    /// Whether a name in the value of an instance is a PROPERTY's, which is assigned when the instance has started.
    pub fn is_property(&self, name: Name<'s>) -> bool {
        let has_start = match self.owner {
            Owner::Globals | Owner::Pou(_) => true,
            Owner::Other => self.names.is_some(),
        };
        let Some(TypeKind::Named(path)) = self.kind() else { return false };
        has_start && path.last().is_some_and(|it| self.types.computed.is_property(Key(it.text), Key(name.text)))
    }

    /// When a PROPERTY is assigned: what lives for one call gets its values one after the other.
    pub fn when_property(&self) -> When {
        match self.owner {
            Owner::Globals | Owner::Pou(_) => When::After,
            Owner::Other => When::Before,
        }
    }

    /// The type with the names of others resolved.
    fn kind(&self) -> Option<&'a TypeKind<'s>> {
        let mut ty = self.ty?;
        for _ in 0..DEPTH {
            let TypeKind::Named(path) = &ty.kind else { break };
            let Some(alias) = path.last().and_then(|it| self.types.aliases.get(&Key(it.text))) else { break };
            ty = alias;
        }
        Some(&ty.kind)
    }

    /// How a value is assigned that is known when the program runs.
    pub fn by(&self, value: &Expr<'s>) -> Option<By> {
        self.by_type(value).or_else(|| self.varies(value).then_some(By::Assignment))
    }

    /// Whether a value asks for a variable. What a REFERENCE TO refers to is none.
    fn varies(&self, value: &Expr<'s>) -> bool {
        self.names.is_some_and(|it| it.vary(value))
            && !matches!(self.kind(), Some(TypeKind::Reference { kind: RefKind::ReferenceTo, .. }))
    }

    /// The same of what is an address by the type of what it is for: 0 and NULL have no name.
    fn by_type(&self, value: &Expr<'s>) -> Option<By> {
        let is_place = matches!(value.kind, ExprKind::Name(_) | ExprKind::Member(..) | ExprKind::Index(..));
        if !is_place && !is_own_instance(value) {
            return None;
        }
        match self.kind()? {
            TypeKind::Named(path) => {
                let is_interface = path.last().is_some_and(|it| self.types.interfaces.contains(&Key(it.text)));
                is_interface.then_some(By::Assignment)
            }
            // As an input of a call; `me : REFERENCE TO Pump := THIS^`.
            TypeKind::Reference { kind: RefKind::ReferenceTo, .. } => {
                let binds = self.types.binding.contains(&value.span.file) && !is_null(value);
                (self.is_member || binds || is_own_instance(value)).then_some(By::Binding)
            }
            // `p : POINTER TO Pump := THIS`
            TypeKind::Reference { .. } => is_this(value).then_some(By::Assignment),
            TypeKind::Array { .. }
            | TypeKind::String { .. }
            | TypeKind::Subrange { .. }
            | TypeKind::Struct(_)
            | TypeKind::Enum { .. }
            | TypeKind::Union(_)
            | TypeKind::Error => None,
        }
    }

    pub fn member(&self, name: Name<'s>) -> Self {
        let ty = match self.kind() {
            Some(TypeKind::Named(path)) => {
                let members = path.last().and_then(|it| self.types.members.get(&Key(it.text)));
                members.and_then(|it| it.get(&Key(name.text)))
            }
            Some(TypeKind::Struct(members)) => {
                let is_it = |it: &&VarDecl<'s>| it.names.iter().any(|it| Key(it.text) == Key(name.text));
                members.iter().find(is_it).map(|it| &it.ty)
            }
            _ => None,
        };
        Self { ty, is_member: true, ..*self }
    }

    /// The bounds and the elements of an array. What a bound's names mean is known where the array is declared.
    pub fn elements(&self) -> Option<(Vec<Bounds<'a, 's>>, Self)> {
        let TypeKind::Array { bounds, element } = self.kind()? else { return None };
        let is_own = !self.is_member && matches!(self.ty?.kind, TypeKind::Array { .. });
        let known = |it: &'a Bound<'s>| match it {
            Bound::Range(low, high) if is_own || is_number(low) && is_number(high) => Some((low, high)),
            Bound::Range(..) | Bound::Open(_) => None,
        };
        let bounds = bounds.iter().map(known).collect::<Option<_>>()?;
        Some((bounds, Self { ty: Some(element), ..*self }))
    }
}

/// `THIS^`
fn is_own_instance(value: &Expr<'_>) -> bool {
    matches!(&value.kind, ExprKind::Deref(inner) if is_this(inner))
}

fn is_this(value: &Expr<'_>) -> bool {
    matches!(&value.kind, ExprKind::Name(name) if name.text.eq_ignore_ascii_case("THIS"))
}

fn is_null(value: &Expr<'_>) -> bool {
    matches!(&value.kind, ExprKind::Name(name) if name.text.eq_ignore_ascii_case("NULL"))
}

fn is_number(bound: &Expr<'_>) -> bool {
    match &bound.kind {
        ExprKind::Literal(_) => true,
        ExprKind::Unary(UnaryOp::Neg, inner) => matches!(inner.kind, ExprKind::Literal(_)),
        _ => false,
    }
}
