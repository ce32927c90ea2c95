//! The target of an ENO, which is found among the arguments of its call.

use crate::types::window::Window;
use crate::{Span, ast};
use staunch_ir::Place;

/// What an ENO is connected with, where that is found among the arguments of its call, as it is written.
pub(crate) struct LateTarget<'s> {
    pub call: Span,
    arguments: Vec<Span>,
    pub target: ast::Expr<'s>,
    pub negated: bool,
    pub finding: Finding,
}

pub(crate) enum Finding {
    Open,
    /// It stays what it is, whatever runs after this.
    Found(Place, Option<Window>),
    /// That has been reported.
    Refused,
}

impl<'s> LateTarget<'s> {
    pub fn new(target: ast::Expr<'s>, negated: bool, call: Span, arguments: Vec<Span>) -> Self {
        Self { call, arguments, target, negated, finding: Finding::Open }
    }

    /// Whether it is written before this argument of its call.
    pub fn is_before(&self, argument: Span) -> bool {
        self.arguments.contains(&argument) && self.target.span.start < argument.start
    }

    /// Whether these are the arguments of its call.
    pub fn is_among(&self, arguments: &[&ast::Expr<'s>]) -> bool {
        arguments.iter().any(|it| self.arguments.contains(&it.span))
    }
}
