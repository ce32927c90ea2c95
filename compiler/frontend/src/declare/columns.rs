//! Lines that are longer than the columns of a [`Location`](staunch_ir::Location): everything after that is at the last one. Tables
//! that find a declaration by its place cannot distinguish two of these, so the second is refused.

use super::starts::members;
use crate::Span;
use crate::ast::VarDecl;
use crate::types::declarations::Declarations;
use rustc_hash::FxHashSet;

impl<'s> Declarations<'s> {
    /// Reports the second of two declarations beyond the columns of one line, of those that are found by their places: what
    /// instances start with, what has an instance's path, and what is called outside.
    pub(super) fn check_columns(&mut self) {
        let mut variables: Vec<&'s VarDecl<'s>> = self.globals.iter().map(|it| it.decl).collect();
        variables.extend(self.pous.iter().flat_map(|it| &it.ast.blocks).flat_map(|it| &it.vars));
        self.types.iter().for_each(|it| members(&it.decl.ty, &mut variables));
        let has_paths = variables.iter().any(|it| it.instance_path.is_some());
        let starts = self.starts.is_any;
        let is_found = |it: &&&VarDecl<'s>| {
            has_paths || starts && (it.construction.is_some() || it.initial.is_some() || it.started.is_some())
        };
        let mut places: Vec<Span> =
            variables.iter().filter(is_found).flat_map(|it| &it.names).map(|it| it.span).collect();
        places.extend(self.pous.iter().filter(|it| it.ast.external.is_some()).map(|it| it.ast.name.span));
        let mut seen = FxHashSet::default();
        for place in places {
            let at = self.location(place);
            if at.column == u16::MAX && !seen.insert((at.file, at.line)) {
                self.not_supported(place, "a second declaration after column 65534 of its line");
            }
        }
    }
}
