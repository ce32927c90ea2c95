//! Lines that are longer than the columns of a [`Location`](staunch_ir::Location): everything after that is at the last one. Back
//! ends find what is implemented outside by its place, so the second of these is refused.

use crate::types::declarations::Declarations;
use rustc_hash::FxHashSet;

impl Declarations<'_> {
    /// Reports the second of two `{external}` POUs beyond the columns of one line.
    pub(super) fn check_columns(&mut self) {
        let external = self.pous.iter().filter(|it| it.ast.external.is_some());
        let places: Vec<_> = external.map(|it| it.ast.name.span).collect();
        let mut seen = FxHashSet::default();
        for place in places {
            let at = self.location(place);
            if at.column == u16::MAX && !seen.insert((at.file, at.line)) {
                self.not_supported(place, "a second declaration after column 65534 of its line");
            }
        }
    }
}
