//! `__POUNAME()` and `__POSITION()` of CODESYS: texts that say where they are.

use super::checker::{Checker, Context};
use super::operand::Operand;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ExprKind as Ast, PouKind};
use staunch_ir::{Chars, Expr, ExprKind, Type};

impl<'s> Checker<'_, 's> {
    /// A call of one of them; the inner `None` says that it was reported.
    pub(crate) fn pou_text(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        let Ast::Name(name) = &callee.kind else { return None };
        let is_name = name.text.eq_ignore_ascii_case("__POUNAME");
        if !is_name && !name.text.eq_ignore_ascii_case("__POSITION") || !self.decl.dialect(span).has_pou_texts() {
            return None;
        }
        if let Some(first) = arguments.first() {
            self.report(
                Diagnostic::new(Code::E0302, first.span, format!("`{}` takes no arguments", name.text))
                    .label("it gives the position where it is written"),
            );
            return Some(None);
        }
        let text = if is_name { self.name_around(span) } else { Some(self.position(span)) };
        let Some(text) = text else {
            self.decl.not_supported(span, "`__POUNAME` outside of a POU");
            return Some(None);
        };
        let bytes = text.into_bytes();
        let length = u16::try_from(bytes.len()).unwrap_or(u16::MAX);
        let kind = ExprKind::Text(Chars::Narrow(bytes.into_iter().collect()));
        Some(Some(Operand::Typed(Expr::new(Type::string(length), kind, self.at(span)))))
    }

    /// The POU that a place is in; what is inherited is in the POU that wrote it.
    fn name_around(&self, span: Span) -> Option<String> {
        let head = |it: usize| self.decl.pous[it].ast.name.span;
        let before = (0..self.decl.written_pous().len())
            .filter(|it| head(*it).file == span.file && head(*it).start < span.start);
        let slot = self.slot.or_else(|| before.max_by_key(|it| head(*it).start))?;
        let title = self.decl.title(slot);
        Some(match self.decl.pous[slot].ast.kind {
            PouKind::Getter => format!("{title}.Get"),
            PouKind::Setter => format!("{title}.Set"),
            PouKind::Program
            | PouKind::FunctionBlock
            | PouKind::Class
            | PouKind::Interface
            | PouKind::Function
            | PouKind::Test
            | PouKind::Action
            | PouKind::Method => title,
        })
    }

    fn position(&mut self, span: Span) -> String {
        let at = self.decl.location(span);
        match self.context {
            Context::Body => format!("Line {}, Column {} (Impl)", at.line, at.column),
            _ => format!("Line {} (Decl)", at.line),
        }
    }
}
