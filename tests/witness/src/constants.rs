//! Numbers that declarations are made of: bounds, capacities, the values of enumerators.

use crate::declarations::Declarations;
use crate::machine::{Outcome, unknown};
use staunch_frontend::Span;
use staunch_frontend::ast::{
    BinaryOp, Expr, ExprKind, Initial, InitialKind, Item, LiteralValue, Name, Pou, UnaryOp, VarBlock, VarDecl, VarKind,
};

impl<'a> Declarations<'a> {
    pub(crate) fn number(&mut self, expr: &'a Expr<'a>) -> Outcome<i128> {
        match &expr.kind {
            ExprKind::Literal(it) => match &it.value {
                LiteralValue::Integer { value, .. } => Ok(i128::from(*value)),
                LiteralValue::Enumerator(name) => match &it.prefix {
                    Some(ty) => self.enumerated(&[**ty], name),
                    None => unknown("an enumerator without its type"),
                },
                _ => unknown("a bound that is not a number"),
            },
            ExprKind::Paren(inner) => self.number(inner),
            ExprKind::Unary(UnaryOp::Neg, inner) => Ok(-self.number(inner)?),
            ExprKind::Binary(sides, op, _) => {
                let (a, b) = (self.number(&sides[0])?, self.number(&sides[1])?);
                match op {
                    BinaryOp::Add => Ok(a + b),
                    BinaryOp::Sub => Ok(a - b),
                    BinaryOp::Mul => Ok(a * b),
                    BinaryOp::Div if b != 0 => Ok(a / b),
                    BinaryOp::Mod if b != 0 => Ok(a % b),
                    _ => unknown("this operator in a bound"),
                }
            }
            ExprKind::Name(_) | ExprKind::Member(..) => {
                let Some(path) = path(expr) else { return unknown("this expression in a bound") };
                self.named_number(&path)
            }
            _ => unknown("this expression in a bound"),
        }
    }

    /// A CONSTANT, or an enumerator.
    fn named_number(&mut self, path: &[Name<'a>]) -> Outcome<i128> {
        let Some((last, before)) = path.split_last() else { return unknown("no name") };
        match self.constant(path).map(|it| &it.kind) {
            Some(InitialKind::Value(expr)) => self.number(expr),
            Some(_) => unknown("a constant that is not a number"),
            None if !before.is_empty() => self.enumerated(before, last),
            None => match self.bare_enumerator(last.text, None) {
                Some(value) => value.as_integer(),
                None => unknown(&format!("the name {} in a bound", last.text)),
            },
        }
    }

    fn enumerated(&mut self, ty: &[Name<'a>], name: &Name<'a>) -> Outcome<i128> {
        match self.enumerator(ty, name.text) {
            Some(value) => value.as_integer(),
            None => unknown(&format!("the name {} in a bound", name.text)),
        }
    }

    /// What a CONSTANT of a POU around, or a global one, is.
    fn constant(&self, path: &[Name<'a>]) -> Option<&'a Initial<'a>> {
        if let [name] = path
            && let Some(own) = self.constant_around(name)
        {
            return own.initial.as_ref();
        }
        let key = self.names.variable(path)?;
        let blocks = self.files.iter().flat_map(|it| &it.items).flat_map(|it| match it {
            Item::Globals(block) => vec![block],
            Item::Configuration(it) => {
                it.globals.iter().chain(it.resources.iter().flat_map(|it| &it.globals)).collect()
            }
            Item::Pou(_) | Item::Types(_) | Item::Test(_) => Vec::new(),
        });
        let mut declared = blocks.filter(|it| it.constant.is_some()).flat_map(|it| &it.vars);
        declared.find(|it| it.names.iter().any(|it| self.names.key(it) == key))?.initial.as_ref()
    }

    /// The CONSTANT of the routine or POU that a name is in.
    fn constant_around(&self, name: &Name<'a>) -> Option<&'a VarDecl<'a>> {
        let pous = self.files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
            Item::Pou(pou) if holds(pou, name.span) => Some(pou),
            Item::Pou(_) | Item::Globals(_) | Item::Types(_) | Item::Configuration(_) | Item::Test(_) => None,
        });
        let routines = |pou: &'a Pou<'a>| pou.routines.iter().filter(|it| holds(it, name.span)).chain([pou]);
        let blocks = pous.flat_map(routines).flat_map(|it| &it.blocks);
        let blocks = blocks.filter(|it: &&VarBlock<'a>| it.has_values() && it.kind != VarKind::External);
        let declares = |it: &&VarDecl<'a>| it.names.iter().any(|it| it.text.eq_ignore_ascii_case(name.text));
        blocks.flat_map(|it| &it.vars).find(declares)
    }
}

fn holds(pou: &Pou<'_>, at: Span) -> bool {
    let extent = pou.extent;
    extent.file == at.file && extent.start <= at.start && at.start < extent.end
}

/// `a.b.c`
pub(crate) fn path<'a>(expr: &Expr<'a>) -> Option<Vec<Name<'a>>> {
    match &expr.kind {
        ExprKind::Name(name) => Some(vec![*name]),
        ExprKind::Member(base, name) => {
            let mut path = path(base)?;
            path.push(*name);
            Some(path)
        }
        _ => None,
    }
}
