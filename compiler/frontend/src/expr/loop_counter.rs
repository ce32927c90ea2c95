//! The counters of FOR loops. One without its own storage, a member of a UNION or the target of a reference, is
//! counted in a local: that is given to the variable before each turn, and taken from it after it.

use super::checker::Checker;
use crate::Span;
use crate::types::counter::Shown;
use crate::types::window::Window;
use staunch_ir::{Expr, Place};

impl Checker<'_, '_> {
    pub(super) fn is_counter(&self, place: &Place, view: Option<Window>) -> bool {
        let frame = self.frame();
        self.counters.iter().any(|it| it.is(&frame, place, view))
    }

    /// Gives the variable the value of the loop's local.
    pub(crate) fn show_counter(&mut self, shown: &Shown, local: &Place, span: Span) {
        let value = Expr::load(local.clone(), self.at(span));
        self.write(shown.place.clone(), shown.view, value, span);
    }

    /// Before a turn of the innermost loop ends: the loop continues from the variable's value.
    pub(crate) fn take_counter(&mut self, span: Span) {
        let Some(innermost) = self.counters.last().filter(|it| it.depth == self.loops) else { return };
        let Some(shown) = innermost.shown.clone() else { return };
        let local = innermost.head.counter.clone();
        if let Some(value) = self.read(shown.place, shown.view, span) {
            self.assign(local, value, span);
        }
    }
}
