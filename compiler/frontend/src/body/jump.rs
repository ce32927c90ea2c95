//! JMP of CODESYS and GOTO of SCL: a list of statements with labels becomes a loop over its segments. A jump says where to go
//! on, and leaves what is between it and that loop.

use crate::expr::checker::Checker;
use crate::spelling::{Key, nearest};
use crate::types::jumps::Jumps;
use crate::{Code, Diagnostic, Span, ast};
use ast::StatementKind as Ast;
use staunch_ir::{Block, Elementary, Expr, ExprKind, Op, Place, Statement, StatementKind, Type, Value};

const NUMBER: Type = Type::Elementary(Elementary::Usint);
/// Labels of one list; the numbers above say what leaves it.
const MOST: usize = 250;
const EXIT: u8 = 254;
const CONTINUE: u8 = 255;

impl<'s> Checker<'_, 's> {
    /// A list in which labels are.
    pub(super) fn statements_with_labels(&mut self, statements: &[ast::Statement<'s>]) {
        let labels: Vec<_> = statements.iter().filter_map(label).collect();
        let Some(first) = labels.first().copied() else { return };
        self.check_labels(&labels);
        let next = self.temporary("next", NUMBER);
        self.jumps.push(Jumps {
            labels,
            next: next.clone(),
            loops: self.loops,
            is_used: false,
            passes_loops: false,
            left_by: Vec::new(),
        });
        let segments: Vec<_> = statements.split(|it| label(it).is_some()).map(|it| self.block_of(it)).collect();
        let Some(jumps) = self.jumps.pop() else { return };
        if !jumps.is_used {
            segments.into_iter().for_each(|it| self.block.extend(it));
            return;
        }
        let at = self.at(first.span);
        let mut body = vec![Statement::new(StatementKind::Turn, at)];
        let last = segments.len() - 1;
        for (number, mut segment) in segments.into_iter().enumerate() {
            segment.insert(0, Statement::assign(next.clone(), self.number(0, first.span), at));
            // From the first label on, the last segment runs wherever the loop began.
            if number == last {
                body.extend(segment);
            } else if segment.len() > 1 {
                let condition = self.compared(Op::Le, &next, number, first.span);
                body.push(Statement::new(StatementKind::If { condition, then: segment, otherwise: Block::new() }, at));
            }
        }
        body.push(Statement::new(StatementKind::Exit, at));
        // A jump by which the list is entered again has to end there.
        let start = self.number(0, first.span);
        self.block.push(Statement::assign(next.clone(), start, at));
        self.push(StatementKind::Loop { body, continuing: Block::new(), count: None }, first.span);
        for leaves in jumps.left_by {
            let condition = self.compared(Op::Eq, &next, usize::from(leaves), first.span);
            let then = self.nested(|this| match leaves {
                EXIT => this.leave_loop("EXIT", StatementKind::Exit, first.span),
                _ => this.leave_loop("CONTINUE", StatementKind::Continue, first.span),
            });
            self.push(StatementKind::If { condition, then, otherwise: Block::new() }, first.span);
        }
        self.pass_jumps(first.span);
    }

    fn check_labels(&mut self, labels: &[ast::Name<'s>]) {
        for (at, name) in labels.iter().enumerate() {
            if !self.decl.dialect(name.span).has_jumps() {
                self.report(
                    Diagnostic::new(Code::E0514, name.span, "this is a label, but only CODESYS and SCL have jumps")
                        .label("Structured Text has no jumps")
                        .help(WITHOUT),
                );
            } else if at >= MOST {
                self.report(Diagnostic::new(Code::E0514, name.span, format!("more than {MOST} labels in one list")));
            } else if !self.known_labels.insert(Key(name.text)) {
                self.report(
                    Diagnostic::new(Code::E0514, name.span, format!("the label `{}` is used twice", name.text))
                        .label("which one is meant?"),
                );
            }
        }
    }

    pub(super) fn jump(&mut self, name: ast::Name<'s>, span: Span) {
        if !self.decl.dialect(span).has_jumps() {
            self.report(
                Diagnostic::new(Code::E0514, span, "Structured Text has no jumps")
                    .label("JMP is an extension of CODESYS")
                    .help(WITHOUT),
            );
            return;
        }
        let found = self.jumps.iter().enumerate().rev().find_map(|(at, it)| {
            let number = it.labels.iter().position(|label| Key(label.text) == Key(name.text))?;
            self.decl.log.note_declared(name.span, it.labels[number].span);
            Some((at, number + 1))
        });
        let Some((list, number)) = found else {
            let labels = self.jumps.iter().flat_map(|it| &it.labels).map(|it| it.text);
            let error = Diagnostic::new(
                Code::E0514,
                name.span,
                format!("there is no label `{}` to jump to from here", name.text),
            )
            .label("the label must be in the same list of statements, or in one around it");
            let error = match nearest(name.text, labels) {
                Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
                None => error.help(format!("write `{}:` there; a jump cannot enter a block", name.text)),
            };
            self.report(error);
            return;
        };
        let Some(jumps) = self.jumps.get_mut(list) else { return };
        jumps.is_used = true;
        let next = jumps.next.clone();
        let number = self.number(u8::try_from(number).unwrap_or(EXIT - 1), span);
        self.assign(next, number, span);
        self.go_on(list, span);
    }

    /// To the next segment of a list, or out of what is between.
    fn go_on(&mut self, list: usize, span: Span) {
        let is_innermost =
            self.jumps.len() == list + 1 && self.jumps.get(list).is_some_and(|it| it.loops == self.loops);
        if is_innermost {
            return self.push(StatementKind::Continue, span);
        }
        match self.is_in_labels() {
            true => self.jumps.iter_mut().next_back().into_iter().for_each(|it| it.is_used = true),
            false => self.take_counter(span),
        }
        self.push(StatementKind::Exit, span);
        if let Some(it) = self.jumps.get_mut(list) {
            it.passes_loops = true;
        }
    }

    /// Whether the innermost loop is one over segments.
    pub(super) fn is_in_labels(&self) -> bool {
        self.jumps.last().is_some_and(|it| it.loops == self.loops)
    }

    /// After a loop that a jump may have left: the jump continues to its label.
    pub(super) fn pass_jumps(&mut self, span: Span) {
        for list in 0..self.jumps.len() {
            let Some(next) = self.jumps.get(list).filter(|it| it.passes_loops).map(|it| it.next.clone()) else {
                continue;
            };
            let condition = self.compared(Op::Ne, &next, 0, span);
            let then = self.nested(|this| this.go_on(list, span));
            self.push(StatementKind::If { condition, then, otherwise: Block::new() }, span);
        }
    }

    /// EXIT and CONTINUE of a loop around a list with labels leave the loop over its segments first.
    pub(super) fn leave_labels(&mut self, kind: &StatementKind, span: Span) {
        let leaves = if matches!(kind, StatementKind::Exit) { EXIT } else { CONTINUE };
        let Some(jumps) = self.jumps.last_mut() else { return };
        if !jumps.left_by.contains(&leaves) {
            jumps.left_by.push(leaves);
        }
        jumps.is_used = true;
        let next = jumps.next.clone();
        let number = self.number(leaves, span);
        self.assign(next, number, span);
        self.push(StatementKind::Exit, span);
    }

    fn number(&mut self, number: u8, span: Span) -> Expr {
        let at = self.at(span);
        Expr::new(NUMBER, ExprKind::Const(Value::U8(number)), at)
    }

    fn compared(&mut self, op: Op, next: &Place, number: usize, span: Span) -> Expr {
        let at = self.at(span);
        let number = self.number(u8::try_from(number).unwrap_or(EXIT - 1), span);
        Expr::apply(op, Type::BOOL, vec![Expr::load(next.clone(), at), number], at)
    }
}

const WITHOUT: &str = "put statements to skip into an IF, and statements to repeat into a WHILE or REPEAT; EXIT leaves a loop, and \
                       CONTINUE starts its next turn";

fn label<'s>(statement: &ast::Statement<'s>) -> Option<ast::Name<'s>> {
    match statement.kind {
        Ast::Label(name) => Some(name),
        _ => None,
    }
}
