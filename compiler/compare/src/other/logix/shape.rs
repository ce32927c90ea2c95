//! What a variable's parts are, as the text declares them: which of them are counters.

use super::counter::Counter;
use staunch_frontend::Dialect;
use staunch_frontend::ast::{Expr, ExprKind, File, Item, Name, Pou, TypeKind, TypeSpec, VarBlock, VarDecl};
use std::collections::HashMap;

/// What a variable, or a part of one, is.
#[derive(Clone, Copy, Debug)]
pub enum Shape<'f> {
    Counter(Counter),
    Type(&'f TypeSpec<'f>),
    /// An instance of a FUNCTION_BLOCK.
    Instance(&'f Pou<'f>),
}

/// What names mean, without regard to case.
#[derive(Debug)]
pub struct Shapes<'f> {
    from: Dialect,
    types: HashMap<String, &'f TypeSpec<'f>>,
    blocks: HashMap<String, &'f Pou<'f>>,
    variables: HashMap<String, Shape<'f>>,
}

/// A type that names another is that one, through as many names.
const MOST_NAMES: usize = 64;

impl<'f> Shapes<'f> {
    /// The types and blocks of all files, which declare them in any order.
    pub fn of(files: &'f [File<'f>], from: Dialect) -> Self {
        let (mut types, mut blocks) = (HashMap::new(), HashMap::new());
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Types(decls) => types.extend(decls.iter().map(|it| (key(it.name), &it.ty))),
                Item::Pou(pou) => drop(blocks.insert(key(pou.name), pou)),
                Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
            }
        }
        Self { from, types, blocks, variables: HashMap::new() }
    }

    pub fn dialect(&self) -> Dialect {
        self.from
    }

    /// What is known before a POU, to go back to after it.
    pub fn variables(&self) -> HashMap<String, Shape<'f>> {
        self.variables.clone()
    }

    pub fn go_back(&mut self, variables: HashMap<String, Shape<'f>>) {
        self.variables = variables;
    }

    pub fn declare(&mut self, decl: &'f VarDecl<'f>) {
        for name in &decl.names {
            match self.of_type(&decl.ty) {
                Some(shape) => drop(self.variables.insert(key(*name), shape)),
                None => drop(self.variables.remove(&key(*name))),
            }
        }
    }

    /// The variables of what a block or program EXTENDS, the outermost class first.
    pub fn inherited(&self, pou: &'f Pou<'f>) -> Vec<&'f VarDecl<'f>> {
        let mut bases = Vec::new();
        let mut base = pou.extends.and_then(|it| self.blocks.get(&key(it)).copied());
        while let Some(it) = base.filter(|_| bases.len() < MOST_NAMES) {
            bases.push(it);
            base = it.extends.and_then(|it| self.blocks.get(&key(it)).copied());
        }
        bases.into_iter().rev().flat_map(|it| vars(&it.blocks)).collect()
    }

    pub fn of_type(&self, ty: &'f TypeSpec<'f>) -> Option<Shape<'f>> {
        let mut ty = ty;
        for _ in 0..MOST_NAMES {
            let TypeKind::Named(names) = &ty.kind else { return Some(Shape::Type(ty)) };
            let [name] = names.as_slice() else { return None };
            if let Some(counter) = Counter::named(name.text, self.from) {
                return Some(Shape::Counter(counter));
            }
            if let Some(pou) = self.blocks.get(&key(*name)) {
                return Some(Shape::Instance(pou));
            }
            ty = self.types.get(&key(*name))?;
        }
        None
    }

    pub fn of_expr(&self, expr: &Expr<'_>) -> Option<Shape<'f>> {
        match &expr.kind {
            ExprKind::Name(name) => self.variables.get(&key(*name)).copied(),
            ExprKind::Paren(inner) => self.of_expr(inner),
            ExprKind::Index(base, _) => self.element(self.of_expr(base)?),
            ExprKind::Member(base, name) => self.member(self.of_expr(base)?, *name),
            ExprKind::Literal(_)
            | ExprKind::Address(_)
            | ExprKind::Part(..)
            | ExprKind::Deref(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Call(..)
            | ExprKind::Assign(..)
            | ExprKind::Error(_) => None,
        }
    }

    pub fn element(&self, shape: Shape<'f>) -> Option<Shape<'f>> {
        match shape {
            Shape::Type(TypeSpec { kind: TypeKind::Array { element, .. }, .. }) => self.of_type(element),
            Shape::Type(_) | Shape::Counter(_) | Shape::Instance(_) => None,
        }
    }

    pub fn member(&self, shape: Shape<'f>, name: Name<'_>) -> Option<Shape<'f>> {
        let declares = |it: &&'f VarDecl<'f>| it.names.iter().any(|it| key(*it) == key(name));
        let decl = match shape {
            Shape::Type(TypeSpec { kind: TypeKind::Struct(members), .. }) => members.iter().find(declares),
            Shape::Instance(pou) => {
                vars(&pou.blocks).find(declares).or_else(|| self.inherited(pou).into_iter().find(|it| declares(it)))
            }
            Shape::Type(_) | Shape::Counter(_) => None,
        };
        self.of_type(&decl?.ty)
    }
}

fn vars<'f>(blocks: &'f [VarBlock<'f>]) -> impl Iterator<Item = &'f VarDecl<'f>> {
    blocks.iter().flat_map(|it| &it.vars)
}

/// The name of a variable or member, or of the array that an element is of.
pub fn last_name(expr: &Expr<'_>) -> Option<String> {
    match &expr.kind {
        ExprKind::Name(name) | ExprKind::Member(_, name) => Some(key(*name)),
        ExprKind::Index(inner, _) | ExprKind::Paren(inner) | ExprKind::Deref(inner) => last_name(inner),
        ExprKind::Literal(_)
        | ExprKind::Address(_)
        | ExprKind::Part(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::Call(..)
        | ExprKind::Assign(..)
        | ExprKind::Error(_) => None,
    }
}

fn key(name: Name<'_>) -> String {
    name.text.to_ascii_uppercase()
}
