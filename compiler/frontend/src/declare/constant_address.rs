//! Addresses of CONSTANTs, in dialects that give them: a constant is its value wherever it is read, so that what has an
//! address is a copy of it, which the globals hold. Writing to it changes no constant. So has a text that is written where its
//! address is taken.

use crate::Span;
use crate::ast;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::types::declarations::Declarations;
use crate::types::scope::Variable;
use crate::types::table::Resolved;
use rustc_hash::FxHashMap;
use staunch_ir::{Chars, Const, Field, Retain, Root, Section, StringType, Type};
use std::rc::Rc;

/// The names that an expression begins with: `List.table` of `List.table[1].x`.
fn head<'s>(expr: &ast::Expr<'s>) -> Option<Vec<ast::Name<'s>>> {
    match &expr.kind {
        ast::ExprKind::Name(_) | ast::ExprKind::Member(..) if expr.path().is_some() => expr.path(),
        ast::ExprKind::Member(base, _) | ast::ExprKind::Index(base, _) | ast::ExprKind::Paren(base) => head(base),
        _ => None,
    }
}

/// What `ADR(…)` and `REF(…)` take the address of.
fn addressed<'a, 's>(expr: &'a ast::Expr<'s>) -> Option<&'a ast::Expr<'s>> {
    let ast::ExprKind::Call(callee, arguments) = &expr.kind else { return None };
    let ast::ExprKind::Name(name) = &callee.kind else { return None };
    let takes = ["ADR", "REF"].iter().any(|it| it.eq_ignore_ascii_case(name.text));
    match arguments.as_slice() {
        [ast::Argument { kind: ast::ArgumentKind::Positional(it), .. }] if takes => Some(it),
        _ => None,
    }
}

/// The text that an expression is, and its place.
fn text<'a>(expr: &'a ast::Expr<'_>) -> Option<(&'a Chars, Span)> {
    match &expr.kind {
        ast::ExprKind::Literal(ast::Literal { prefix: None, value: ast::LiteralValue::String(chars) }) => {
            Some((chars, expr.span))
        }
        _ => None,
    }
}

impl<'s> Declarations<'s> {
    /// Gives the CONSTANTs whose addresses bodies take their copies, before a body asks what the globals hold.
    pub(super) fn find_addresses_of_constants(&mut self, statements: &[Vec<ast::Statement<'s>>]) {
        let mut copies = FxHashMap::default();
        for (at, body) in statements.iter().enumerate() {
            if !self.dialect(self.pous[at].ast.name.span).has_addresses_of_constants() {
                continue;
            }
            let (mut found, mut texts) = (Vec::new(), Vec::new());
            ast::each_expr(body, &mut |it| {
                found.extend(addressed(it).and_then(head));
                texts.extend(addressed(it).and_then(text));
            });
            for (chars, span) in texts {
                let copy = self.copy_of_text(chars, span);
                self.table.constant_copies.insert(span, copy);
            }
            for path in found {
                let Some((name, variable)) = self.constant_at(at, &path) else { continue };
                let copy = *copies.entry(variable.name.span).or_insert_with(|| self.copy_of_constant(&variable));
                self.table.constant_copies.insert(name.span, copy);
            }
        }
    }

    /// The CONSTANT with storage of its own that a path in a body begins with, and the name that means it.
    fn constant_at(&mut self, slot: usize, path: &[ast::Name<'s>]) -> Option<(ast::Name<'s>, Rc<Variable<'s>>)> {
        let first = *path.first()?;
        let own = self.signature(slot)?.scope.get(first.text).cloned();
        let found = match own {
            Some(own) => Some((first, own)),
            None => (1..=path.len()).find_map(|count| match self.lookup(&path[..count], Sense::Value) {
                Found::One(Meaning::Declared(Entry::Global(at))) => Some((path[count - 1], self.global(at)?)),
                Found::One(_) | Found::Several(_) | Found::Nothing => None,
            }),
        };
        // One of a FUNCTION is a variable of each call.
        found.filter(|(_, it)| it.constant_value().is_some() && !matches!(it.place.root, Root::Local(_)))
    }

    fn copy_of_constant(&mut self, constant: &Variable<'s>) -> usize {
        let Resolved { ty, initial } = Resolved::clone(&constant.resolved);
        self.add_copy(constant.name.text, ty, initial, constant.name.span)
    }

    fn copy_of_text(&mut self, chars: &Chars, span: Span) -> usize {
        let capacity = u16::try_from(chars.len()).unwrap_or(u16::MAX);
        let ty = Type::String(StringType { wide: chars.is_wide(), capacity });
        self.add_copy("__text", ty, Const::Text(chars.clone()), span)
    }

    fn add_copy(&mut self, name: &str, ty: Type, initial: Const, span: Span) -> usize {
        let field = Field {
            name: name.to_owned(),
            ty,
            initial,
            section: Section::Global,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: None,
            location: self.location(span),
            declared: None,
        };
        self.add_synthetic(field, None)
    }
}
