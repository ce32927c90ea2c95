//! The order in which declarations are resolved: what one needs comes before it. Needs are read off
//! the syntax, so that resolving one declaration never starts on another; one that meets another which
//! is not resolved yet has found a circle.

use crate::ast::{self, ExprKind, InitialKind, TypeKind};
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::Key;
use crate::types::declarations::Declarations;
use rustc_hash::FxHashSet;

/// What is resolved at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Step {
    Declaration(Entry),
    /// The CONSTANTs of the POU in this slot, which others may read by its name before it is resolved itself.
    Constants(usize),
}

/// All declarations at file level, each after those that it needs. Of those in a circle, the first in
/// the text comes last.
pub(super) fn order(declarations: &Declarations<'_>) -> Vec<Step> {
    let types = (0..declarations.types.len()).map(Entry::Type);
    let globals = (0..declarations.globals.len()).map(Entry::Global);
    let pous = (0..declarations.pous.len()).map(Entry::Pou);
    let mut seen = FxHashSet::default();
    let mut order = Vec::new();
    for entry in types.chain(globals).chain(pous) {
        visit(declarations, Step::Declaration(entry), &mut seen, &mut order);
    }
    order
}

/// Depth-first with its own stack: a chain of needs may be long.
fn visit(declarations: &Declarations<'_>, start: Step, seen: &mut FxHashSet<Step>, order: &mut Vec<Step>) {
    if !seen.insert(start) {
        return;
    }
    let mut stack = vec![(start, needs(declarations, start))];
    while let Some((entry, needed)) = stack.last_mut() {
        match needed.next() {
            Some(next) if seen.insert(next) => stack.push((next, needs(declarations, next))),
            Some(_) => {}
            None => {
                order.push(*entry);
                stack.pop();
            }
        }
    }
}

fn needs(declarations: &Declarations<'_>, step: Step) -> std::vec::IntoIter<Step> {
    let mut needs = Needs { declarations, own: FxHashSet::default(), found: Vec::new() };
    let entry = match step {
        Step::Declaration(entry) => entry,
        Step::Constants(at) => {
            let pou = declarations.pous[at].ast;
            needs.names_of(pou);
            pou.constants().flat_map(|it| &it.vars).for_each(|it| needs.declared(it));
            return needs.found.into_iter();
        }
    };
    match entry {
        Entry::Type(at) => {
            let decl = declarations.types[at].decl;
            decl.base.iter().for_each(|it| needs.path(it, Sense::Type));
            needs.spec(&decl.ty);
            decl.initial.iter().for_each(|it| needs.initial(it));
        }
        Entry::Global(at) => needs.declared(declarations.globals[at].decl),
        Entry::Pou(at) => {
            if let Some(owner) = declarations.pous[at].owner {
                needs.needs(Entry::Pou(owner));
                needs.names_of(declarations.pous[owner].ast);
            }
            let pou = declarations.pous[at].ast;
            if declarations.has_own_constants(at) {
                needs.found.push(Step::Constants(at));
            }
            needs.pou(pou);
        }
    }
    needs.found.into_iter()
}

/// What one declaration needs, in the order of its text.
struct Needs<'d, 's> {
    declarations: &'d Declarations<'s>,
    /// The variables of the POU itself: their names mean nothing outside.
    own: FxHashSet<Key<'s>>,
    found: Vec<Step>,
}

impl<'s> Needs<'_, 's> {
    fn needs(&mut self, entry: Entry) {
        self.found.push(Step::Declaration(entry));
    }

    fn pou(&mut self, pou: &ast::Pou<'s>) {
        self.names_of(pou);
        // A VAR_INST of its METHODs is a variable of the instance.
        let kept = pou.routines.iter().flat_map(|it| &it.blocks).filter(|it| it.kind == ast::VarKind::Inst);
        kept.flat_map(|it| &it.vars).for_each(|it| self.declared(it));
        pou.result.iter().for_each(|it| self.spec(it));
        for block in &pou.blocks {
            let is_external = block.kind == ast::VarKind::External;
            for decl in block.vars.iter().filter(|it| !is_external || self.declarations.is_early_external(it)) {
                self.declared(decl);
                if is_external {
                    decl.names.iter().for_each(|it| self.value(*it));
                }
            }
        }
    }

    fn names_of(&mut self, pou: &ast::Pou<'s>) {
        let own = pou.blocks.iter().filter(|it| it.kind != ast::VarKind::External).flat_map(|it| &it.vars);
        self.own.extend(own.flat_map(|it| &it.names).map(|it| Key(it.text)));
    }

    fn declared(&mut self, decl: &ast::VarDecl<'s>) {
        // All variables at the same address must have the same type.
        let located = decl.address.and_then(|it| self.declarations.addresses.global_at(it));
        self.found.extend(located.map(Entry::Global).map(Step::Declaration));
        self.spec(&decl.ty);
        decl.initial.iter().for_each(|it| self.initial(it));
    }

    fn spec(&mut self, spec: &ast::TypeSpec<'s>) {
        match &spec.kind {
            TypeKind::Named(path) => self.path(path, Sense::Type),
            TypeKind::String { capacity, .. } => capacity.iter().for_each(|it| self.expr(it)),
            TypeKind::Subrange { base, low, high } => {
                self.type_name(*base);
                [low, high].into_iter().for_each(|it| self.expr(it));
            }
            TypeKind::Array { bounds, element } => {
                self.spec(element);
                for bound in bounds {
                    match bound {
                        ast::Bound::Range(low, high) => [low, high].into_iter().for_each(|it| self.expr(it)),
                        ast::Bound::Open(_) => {}
                    }
                }
            }
            TypeKind::Struct(members) | TypeKind::Union(members) => members.iter().for_each(|it| self.declared(it)),
            TypeKind::Enum { values, .. } => {
                values.iter().filter_map(|it| it.value.as_ref()).for_each(|it| self.expr(it));
            }
            // A named type may hold references to itself: it is looked up when all are declared.
            TypeKind::Reference { target, .. } => match &target.kind {
                TypeKind::Named(_) => {}
                _ => self.spec(target),
            },
            TypeKind::Error => {}
        }
    }

    fn initial(&mut self, initial: &ast::Initial<'s>) {
        match &initial.kind {
            InitialKind::Value(expr) | InitialKind::Bind(expr) => self.expr(expr),
            InitialKind::Elements(elements) => {
                for element in elements {
                    element.count.iter().for_each(|it| self.expr(it));
                    element.values.iter().for_each(|it| self.initial(it));
                }
            }
            InitialKind::Fields(fields) => fields.iter().for_each(|(_, it)| self.initial(it)),
            InitialKind::Indexed(elements) => {
                for (indices, value) in elements {
                    indices.iter().for_each(|it| self.expr(it));
                    self.initial(value);
                }
            }
            InitialKind::Members(values) => values.iter().for_each(|it| self.initial(it)),
        }
    }

    fn expr(&mut self, expr: &ast::Expr<'s>) {
        // The POUs whose CONSTANTs are read need not be resolved themselves.
        let mut around = FxHashSet::default();
        ast::each_part(expr, &mut |it| match &it.kind {
            ExprKind::Name(name) if self.own.contains(&Key(name.text)) || around.contains(&name.span) => {}
            ExprKind::Name(name) => {
                self.value(*name);
                self.type_name(*name);
            }
            ExprKind::Literal(ast::Literal { prefix: Some(prefix), .. }) => self.type_name(**prefix),
            // `GVL.x`, `Plant.Color.Red`
            ExprKind::Member(..) => {
                if let Some(path) = it.path() {
                    match self.declarations.pou_of_constant(&path) {
                        Some(slot) => {
                            self.found.push(Step::Constants(slot));
                            around.insert(path[0].span);
                        }
                        None => self.value_path(&path),
                    }
                }
            }
            ExprKind::Literal(_)
            | ExprKind::Address(_)
            | ExprKind::Part(..)
            | ExprKind::Index(..)
            | ExprKind::Deref(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Assign(..)
            | ExprKind::Paren(_)
            | ExprKind::Error(_) => {}
        });
    }

    fn type_name(&mut self, name: ast::Name<'s>) {
        self.path(&[name], Sense::Type);
    }

    fn path(&mut self, path: &[ast::Name<'s>], sense: Sense) {
        match self.declarations.lookup(path, sense) {
            Found::One(Meaning::Declared(entry)) => self.needs(entry),
            Found::Nothing => {
                let any = &self.declarations.table.any;
                let is_any = path.first().is_some_and(|it| any.words.contains(&it.span));
                any.structure.filter(|_| is_any).into_iter().for_each(|it| self.needs(Entry::Type(it)));
            }
            Found::One(_) | Found::Several(_) => {}
        }
    }

    fn value_path(&mut self, path: &[ast::Name<'s>]) {
        match self.declarations.lookup(path, Sense::Value) {
            Found::One(Meaning::Declared(entry)) => self.needs(entry),
            Found::One(Meaning::Enumerator(slot)) => self.needs(Entry::Type(slot)),
            Found::One(_) | Found::Nothing | Found::Several(_) => {}
        }
    }

    /// A global variable, or the enumerations that have an enumerator with this name.
    fn value(&mut self, name: ast::Name<'s>) {
        let key = Key(name.text);
        if self.own.contains(&key) {
            return;
        }
        let global = self.declarations.declared(name).filter(|it| matches!(it, Entry::Global(_)));
        let types = self.declarations.names.enumerators.get(&key).into_iter().flatten();
        let found = global.into_iter().chain(types.map(|at| Entry::Type(*at)));
        self.found.extend(found.map(Step::Declaration));
    }
}
