//! The classes of a program as they are written, what the names after EXTENDS mean, and which METHODs have the same
//! parameters: as far as syntax and names show, before types are known.

use crate::ast::{
    BinaryOp, Bound, Expr, ExprKind, File, InitialKind, Item, Literal, LiteralValue, Name, Path, Pou, PouKind,
    TypeKind, TypeSpec, UnaryOp, VarBlock, VarDecl, VarKind,
};
use crate::dialect::Dialect;
use crate::log::Log;
use crate::names::{Entry, Found, Meaning, Names, Sense, Site};
use crate::source::{Sources, Span};
use crate::spelling::Key;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::Elementary;

/// Other names are followed no farther: those that lead back to themselves are reported later.
const MAX_ALIASES: usize = 100;

/// Constants in constants are followed no farther.
const MAX_CONSTANTS: usize = 100;

pub(super) struct Class<'s> {
    pub file: usize,
    pub item: usize,
    /// As it is written.
    pub pou: Pou<'s>,
}

/// What a name after EXTENDS means.
pub(super) enum Base {
    Class(usize),
    /// An INTERFACE, which is implemented.
    Interface,
    /// Nothing has the name.
    Unknown,
    /// What has it is not seen here, or there are several: that is reported when all is declared.
    NotHere,
}

pub(super) struct Classes<'s> {
    pub all: Vec<Class<'s>>,
    by_declaration: FxHashMap<Span, usize>,
    /// For each POU, the class that it is.
    pous: Vec<Option<usize>>,
    /// The POUs that are INTERFACEs.
    interfaces: FxHashSet<usize>,
    /// For each type, the one that it is another name for.
    aliases: Vec<Option<Path<'s>>>,
    /// The values of global CONSTANTs.
    constants: Vec<Expr<'s>>,
    names: Names<'s>,
    sources: &'s Sources,
    dialects: Vec<Dialect>,
}

impl<'s> Classes<'s> {
    pub fn of(files: &[File<'s>], log: &Log<'s>) -> Self {
        let mut classes = Self {
            all: Vec::new(),
            by_declaration: FxHashMap::default(),
            pous: Vec::new(),
            interfaces: FxHashSet::default(),
            aliases: Vec::new(),
            constants: Vec::new(),
            names: Names::default(),
            sources: log.sources,
            dialects: log.dialects.clone(),
        };
        classes
            .names
            .add_libraries(log.sources, |it| classes.dialects.get(it).is_some_and(|it| it.has_own_libraries()));
        classes.collect_namespaces(files);
        for (file, it) in files.iter().enumerate() {
            for (item, it) in it.items.iter().enumerate() {
                classes.collect(file, item, it);
            }
        }
        classes
    }

    fn collect_namespaces(&mut self, files: &[File<'s>]) {
        let ids: Vec<_> = files.iter().map(|it| self.names.add_file(it, &[])).collect();
        for (region, id) in files.iter().zip(&ids).flat_map(|(file, ids)| file.regions.iter().zip(ids)) {
            for path in &region.uses {
                // What is not there is reported when names are declared.
                let _ = path.last().is_some_and(|it| self.names.use_space(*id, self.site(it.span), path));
            }
        }
    }

    fn collect(&mut self, file: usize, item: usize, it: &Item<'s>) {
        match it {
            Item::Pou(pou) => {
                let internal = matches!(pou.modifiers.access, Some((crate::ast::Access::Internal, _)));
                if pou.kind != PouKind::Test {
                    self.enter(pou.name, Entry::Pou(self.pous.len()), internal);
                }
                self.interfaces.extend(Some(self.pous.len()).filter(|_| pou.kind == PouKind::Interface));
                let class = pou.kind.is_block().then_some(self.all.len());
                self.pous.push(class);
                if pou.kind.is_block() {
                    self.by_declaration.insert(pou.name.span, self.all.len());
                    self.all.push(Class { file, item, pou: pou.clone() });
                }
            }
            Item::Types(types) => {
                for it in types {
                    self.enter(it.name, Entry::Type(self.aliases.len()), it.internal);
                    let path = if let TypeKind::Named(path) = &it.ty.kind { Some(path.clone()) } else { None };
                    self.aliases.push(path.filter(|_| it.base.is_none()));
                }
            }
            Item::Globals(block) => self.collect_constants(block),
            Item::Configuration(_) | Item::Test(_) => {}
        }
    }

    fn collect_constants(&mut self, block: &VarBlock<'s>) {
        for decl in block.vars.iter().filter(|_| block.constant.is_some()) {
            let Some(InitialKind::Value(value)) = decl.initial.as_ref().map(|it| &it.kind) else { continue };
            for name in &decl.names {
                let space = self.names.space_of(name.span);
                self.names.insert(space, name.text, Entry::Global(self.constants.len()), false);
                self.constants.push(value.clone());
            }
        }
    }

    /// The first declaration of a name wins.
    fn enter(&mut self, name: Name<'s>, entry: Entry, internal: bool) {
        let space = self.names.space_of(name.span);
        let is_known = self.names.own(space, name.text).is_some_and(|it| it.ty.is_some());
        if !name.text.is_empty() && !is_known {
            self.names.insert(space, name.text, entry, internal);
        }
    }

    pub fn text(&self, span: Span) -> &'s str {
        self.sources.text(span)
    }

    pub fn dialect(&self, span: Span) -> Dialect {
        self.dialects.get(usize::from(span.file)).copied().unwrap_or_default()
    }

    fn site(&self, span: Span) -> Site {
        Site { span, dialect: self.dialect(span), is_bundled: false }
    }

    fn lookup(&self, path: &[Name<'s>]) -> Found {
        let Some(last) = path.last() else { return Found::Nothing };
        self.names.lookup(self.site(last.span), path, Sense::Type)
    }

    /// The class whose declaration has a name.
    pub fn declared(&self, name: Name<'s>) -> Option<usize> {
        self.by_declaration.get(&name.span).copied()
    }

    /// What a class says that it extends.
    pub fn base_of(&self, pou: &Pou<'s>, base: Name<'s>) -> Base {
        let path = pou.bases.iter().find(|it| it.last().is_some_and(|it| it.span == base.span));
        match self.lookup(path.map_or(&[base], Vec::as_slice)) {
            Found::One(Meaning::Declared(Entry::Pou(at))) if self.interfaces.contains(&at) => Base::Interface,
            Found::One(Meaning::Declared(Entry::Pou(at))) => self.pous[at].map_or(Base::Unknown, Base::Class),
            Found::Several(_) => Base::NotHere,
            Found::Nothing if self.names.root(base.text).is_some() || !self.names.holders(base.text).is_empty() => {
                Base::NotHere
            }
            Found::One(_) | Found::Nothing => Base::Unknown,
        }
    }

    /// Whether METHODs with the same name may differ in their parameters.
    pub fn may_be_overloaded(&self, routine: &Pou<'s>) -> bool {
        routine.kind == PouKind::Method && self.dialect(routine.name.span).has_overloads()
    }

    /// Whether two METHODs take the same arguments, by what their declarations say.
    pub fn have_same_parameters(&self, a: &Pou<'s>, b: &Pou<'s>) -> bool {
        let (a, b) = (parameters(a), parameters(b));
        a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| a.0 == b.0 && self.is_one_type(&a.1.ty, &b.1.ty))
    }

    fn is_one_type(&self, a: &TypeSpec<'s>, b: &TypeSpec<'s>) -> bool {
        match (self.plain(&a.kind), self.plain(&b.kind)) {
            (TypeKind::Named(a), TypeKind::Named(b)) => self.is_one_name(&a, &b),
            (TypeKind::String { wide: a, .. }, TypeKind::String { wide: b, .. }) => a == b,
            (TypeKind::Array { bounds: a, element: x }, TypeKind::Array { bounds: b, element: y }) => {
                let same = |(a, b): (&Bound<'s>, &Bound<'s>)| self.is_one_bound(a, b);
                a.len() == b.len() && a.iter().zip(&b).all(same) && self.is_one_type(&x, &y)
            }
            (TypeKind::Reference { kind: a, target: x }, TypeKind::Reference { kind: b, target: y }) => {
                a == b && self.is_one_type(&x, &y)
            }
            _ => false,
        }
    }

    /// A type, without its range and by the name that other names are for.
    fn plain(&self, kind: &TypeKind<'s>) -> TypeKind<'s> {
        let mut kind = match kind {
            TypeKind::Subrange { base, .. } => TypeKind::Named(vec![*base]),
            other => other.clone(),
        };
        for _ in 0..MAX_ALIASES {
            let TypeKind::Named(path) = &kind else { break };
            let Found::One(Meaning::Declared(Entry::Type(at))) = self.lookup(path) else { break };
            let Some(alias) = &self.aliases[at] else { break };
            kind = TypeKind::Named(alias.clone());
        }
        kind
    }

    fn is_one_name(&self, a: &[Name<'s>], b: &[Name<'s>]) -> bool {
        let (Some(own), Some(other)) = (a.last(), b.last()) else { return false };
        match (self.lookup(a), self.lookup(b)) {
            (Found::One(a), Found::One(b)) => a == b,
            (Found::Nothing, Found::Nothing) => {
                let named = |it: &Name<'s>| Elementary::named(&it.text.to_ascii_uppercase());
                named(own).map_or(Key(own.text) == Key(other.text), |it| named(other) == Some(it))
            }
            _ => false,
        }
    }

    fn is_one_bound(&self, a: &Bound<'s>, b: &Bound<'s>) -> bool {
        let written = |it: &Expr<'s>| self.sources.text(it.span).split_whitespace().collect::<String>();
        match (a, b) {
            (Bound::Open(_), Bound::Open(_)) => true,
            (Bound::Range(a, b), Bound::Range(x, y)) => {
                let same = |a: &Expr<'s>, b: &Expr<'s>| match (self.number(a, 0), self.number(b, 0)) {
                    (Some(a), Some(b)) => a == b,
                    _ => Key(&written(a)) == Key(&written(b)),
                };
                same(a, x) && same(b, y)
            }
            _ => false,
        }
    }
}

impl<'s> Classes<'s> {
    /// What a bound is, where numbers and global CONSTANTs say it.
    fn number(&self, expr: &Expr<'s>, depth: usize) -> Option<i128> {
        if depth > MAX_CONSTANTS {
            return None;
        }
        match &expr.kind {
            ExprKind::Literal(Literal { value: LiteralValue::Integer { value, .. }, .. }) => Some(i128::from(*value)),
            ExprKind::Paren(inner) | ExprKind::Unary(UnaryOp::Plus, inner) => self.number(inner, depth),
            ExprKind::Unary(UnaryOp::Neg, inner) => self.number(inner, depth)?.checked_neg(),
            ExprKind::Binary(sides, op, _) => {
                let (a, b) = (self.number(&sides[0], depth)?, self.number(&sides[1], depth)?);
                match op {
                    BinaryOp::Add => a.checked_add(b),
                    BinaryOp::Sub => a.checked_sub(b),
                    BinaryOp::Mul => a.checked_mul(b),
                    _ => None,
                }
            }
            ExprKind::Name(_) | ExprKind::Member(..) => {
                let path = expr.path()?;
                let site = self.site(path.last()?.span);
                match self.names.lookup(site, &path, Sense::Value) {
                    Found::One(Meaning::Declared(Entry::Global(at))) => self.number(self.constants.get(at)?, depth + 1),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// The parameters of a METHOD, each with its section.
fn parameters<'a, 's>(routine: &'a Pou<'s>) -> Vec<(VarKind, &'a VarDecl<'s>)> {
    let is_parameter = |it: VarKind| matches!(it, VarKind::Input | VarKind::InOut | VarKind::Output);
    let blocks = routine.blocks.iter().filter(|it| is_parameter(it.kind));
    let declared = blocks.flat_map(|block| block.vars.iter().map(|it| (block.kind, it)));
    declared.flat_map(|it| it.1.names.iter().map(move |_| it)).collect()
}
