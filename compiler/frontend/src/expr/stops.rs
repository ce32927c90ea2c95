//! Where a run can stop: before each statement that a user wrote. A stop may evaluate an expression of the user's, in the scope of
//! the statement.

use crate::expr::checker::Checker;
use crate::options::AskedAt;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::stop::{Asked, Stop};
use staunch_ir::{Expr, Statement, StatementKind};

impl Declarations<'_> {
    /// Whether a run can stop in the POU of a slot: not in the library.
    pub(crate) fn has_stops(&self, slot: usize) -> bool {
        let pou = &self.pous[slot];
        self.log.options.stops.as_ref().is_some_and(|it| pou.ast.name.span.file < it.files && pou.run.is_none())
    }
}

impl<'s> Checker<'_, 's> {
    pub(crate) fn stop_before(&mut self, span: Span) {
        if self.is_made_up(span) {
            return;
        }
        let at = self.at(span);
        let options = self.decl.log.options;
        let asked = options.stops.iter().flat_map(|it| &it.asked).find(|it| it.at == at);
        let asked = asked.and_then(|it| self.asked_before(*it, span));
        let declared = self.signature.as_ref().map_or(0, |it| it.locals.len());
        self.block.push(Statement::new(StatementKind::Stop(Box::new(Stop { declared, asked })), at));
    }

    fn asked_before(&mut self, asked: AskedAt, statement: Span) -> Option<Asked> {
        let file = asked.expression;
        // It is read as the statement is.
        let dialect = self.decl.dialect(statement);
        if let Some(own) = self.decl.log.dialects.get_mut(usize::from(file)) {
            *own = dialect;
        }
        self.decl.names.read_as_at(file, statement);
        let sources = self.decl.log.sources;
        let written = crate::parse::parse_expression(file, &sources.get(file).text, &mut self.decl.log.diagnostics)?;
        let locals = self.locals.len();
        let mut value = None;
        let hoisted = self.nested(|this| value = this.asked_value(&written, asked.is_condition));
        if !hoisted.is_empty() {
            self.locals.truncate(locals);
            self.report(
                Diagnostic::new(Code::E0902, written.span, "a call in an expression of a breakpoint is not supported")
                    .label("it may change variables")
                    .help("compare variables; operators and most standard functions are allowed"),
            );
            return None;
        }
        Some(Asked { value: value?, is_condition: asked.is_condition })
    }

    fn asked_value(&mut self, written: &ast::Expr<'s>, is_condition: bool) -> Option<Expr> {
        if is_condition { self.condition(written) } else { self.typed(written, None) }
    }
}
