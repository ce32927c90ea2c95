//! References that outlive what they refer to.

use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic};
use staunch_ir::reference::escape::{Escape, How, escapes};

impl Declarations<'_> {
    /// Refuses a program that keeps a reference to what lives for one call. Routines are in order here, and the
    /// variables of their calls have no fixed storage yet.
    pub(super) fn check_escapes(&mut self) -> Option<()> {
        let found = escapes(&self.program);
        for escape in &found {
            self.report_escape(escape);
        }
        found.is_empty().then_some(())
    }

    fn report_escape(&mut self, escape: &Escape) {
        let routine = self.program.routine(escape.routine);
        let target = routine.locals[escape.target.index()].name.clone();
        let label = match escape.how {
            How::Stored => "this exists after the call has ended".to_owned(),
            How::Returned => "the caller uses it after the call has ended".to_owned(),
            How::KeptBy(callee) => format!("`{}` keeps it", self.program.routine(callee).name),
        };
        let span = self.log.name_at(escape.at);
        self.report(
            Diagnostic::new(
                Code::E0212,
                span,
                format!("a reference to `{target}` outlives it: `{target}` exists only during one call"),
            )
            .label(label)
            .help(format!("declare `{target}` in VAR of a PROGRAM or FUNCTION_BLOCK, or in VAR_GLOBAL")),
        );
    }
}
