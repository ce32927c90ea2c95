//! CODESYS' exceptions: `__TRY` and its parts, and what F_RaiseException does. (CODESYS Development System, "Operator: __TRY,
//! __CATCH, __FINALLY, __ENDTRY"; Beckhoff, Tc2_System, "F_RaiseException")

use crate::expr::checker::Checker;
use crate::spelling::Key;
use crate::{Code, Diagnostic, Span, ast};
use ast::StatementKind as Ast;
use staunch_ir::{Arm, Elementary, Expr, ExprKind, FaultKind, Location, Place, Statement, StatementKind, Type, Value};

/// What the body of F_RaiseException calls, and where it keeps the number of the exception for who catches it.
const RAISE: &str = "__raise";
const RAISED: &str = "__Raised";

const EXCEPTION: &str = "__SYSTEM.ExceptionCode";

/// The numbers of `__SYSTEM.ExceptionCode` that faults have; those that CODESYS has no exception for are unknown ones.
const UNKNOWN: u32 = 0xFFFF_FFFF;
const ACCESS_VIOLATION: u32 = 0x51;
const MISALIGNMENT: u32 = 0x100;
const ARRAY_BOUNDS: u32 = 0x101;
const DIVIDE_BY_ZERO: u32 = 0x102;

const fn exception(kind: FaultKind) -> u32 {
    match kind {
        FaultKind::DivideByZero => DIVIDE_BY_ZERO,
        FaultKind::IndexOutOfRange => ARRAY_BOUNDS,
        FaultKind::NullReference | FaultKind::OutsideObject | FaultKind::ForbiddenView | FaultKind::Deleted => {
            ACCESS_VIOLATION
        }
        FaultKind::MisalignedReference => MISALIGNMENT,
        FaultKind::SubrangeViolated
        | FaultKind::ZeroStep
        | FaultKind::NoSuchDate
        | FaultKind::NegativeTimer
        | FaultKind::NotOfPool
        | FaultKind::Raised
        | FaultKind::NotDecimal
        // Not caught.
        | FaultKind::LoopBudget
        | FaultKind::AssertionFailed
        | FaultKind::NotImplemented
        | FaultKind::Recursion => UNKNOWN,
    }
}

impl<'s> Checker<'_, 's> {
    pub(super) fn try_statement(&mut self, it: &ast::Try<'s>, span: Span) {
        if !self.decl.dialect(span).handles_exceptions() {
            self.report(
                Diagnostic::new(Code::E0513, it.word, "`__TRY` is an extension of CODESYS")
                    .label("a fault ends the scan")
                    .help("test before what would fault: a divisor, an index, `__ISVALIDREF(…)`"),
            );
            return;
        }
        if let Some(finally) = &it.finally {
            self.refuse_to_pass(&it.body, finally.word);
            self.refuse_to_pass(&it.handler, finally.word);
        }
        let body = self.block_of(&it.body);
        let kind = self.temporary("caught", Type::Elementary(Elementary::Usint));
        let mut handler = self.nested(|this| {
            if let Some(exception) = &it.exception {
                this.give_exception(exception, &kind);
            }
        });
        handler.extend(self.block_of(&it.handler));
        self.push(StatementKind::Try { body, kind, handler }, span);
        if let Some(finally) = &it.finally {
            let statements = self.block_of(&finally.body);
            self.block.extend(statements);
        }
    }

    /// What `__CATCH` names gets the number of the exception.
    fn give_exception(&mut self, target: &ast::Expr<'s>, kind: &Place) {
        let Some(found) = self.place_or_view(target).filter(|it| self.writable(it, target.span)) else { return };
        let ty = self.type_of(&found);
        if !self.is_exception(ty) {
            let ty = self.type_name(ty);
            self.report(
                Diagnostic::new(Code::E0513, target.span, format!("`__CATCH` needs an exception, but this is {ty}"))
                    .label("expected a variable of `__SYSTEM.ExceptionCode`")
                    .help("declare it so: `exc : __SYSTEM.ExceptionCode;`"),
            );
            return;
        }
        self.note_assigned(&found.place, target.span);
        let at = self.at(target.span);
        let raised = self.raised().map(|it| Expr::load(it, at));
        let write = |this: &mut Self, value: Expr| {
            this.nested(|this| {
                let _ = this.write(found.place.clone(), found.view, value, target.span);
            })
        };
        let mut arms = Vec::new();
        for known in [ACCESS_VIOLATION, MISALIGNMENT, ARRAY_BOUNDS, DIVIDE_BY_ZERO] {
            let labels = labels(|it| exception(it) == known);
            arms.push(Arm { labels, body: write(self, number(known, ty, at)) });
        }
        if let Some(raised) = raised {
            arms.push(Arm { labels: labels(|it| it == FaultKind::Raised), body: write(self, raised) });
        }
        let otherwise = write(self, number(UNKNOWN, ty, at));
        self.push(StatementKind::Case { selector: Expr::load(kind.clone(), at), arms, otherwise }, target.span);
    }

    fn is_exception(&self, ty: Type) -> bool {
        let Type::Enum(id) = ty else { return false };
        let it = self.decl.program.enumeration(id);
        it.name == EXCEPTION
    }

    /// The number of the exception that was raised last, in a program that raises some.
    fn raised(&mut self) -> Option<Place> {
        let at = self.decl.globals.iter().position(|it| it.name.text == RAISED)?;
        Some(self.decl.global(at)?.place.clone())
    }

    /// What F_RaiseException does: the fault is at the place of its call.
    pub(super) fn raise(&mut self, arguments: &[ast::Argument<'s>], span: Span) {
        let [ast::Argument { kind: ast::ArgumentKind::Positional(number), .. }] = arguments else { return };
        let Some(place) = self.raised() else { return };
        if let Some(value) = self.value(number, place.ty) {
            self.assign(place, value, span);
        }
        self.block.push(Statement::new(StatementKind::Fault(FaultKind::Raised), Location::CALLER));
    }

    /// The vendors do not say whether what is left by RETURN, EXIT or CONTINUE passes `__FINALLY`.
    fn refuse_to_pass(&mut self, statements: &[ast::Statement<'s>], finally: Span) {
        let mut labels = Vec::new();
        ast::each_statement(statements, &mut |it| labels.extend(label(it)));
        for leaving in leaving(statements, &labels, true) {
            let text = self.decl.log.sources.text(leaving);
            let word = text.split(|it: char| !it.is_ascii_alphabetic()).next().unwrap_or_default().to_uppercase();
            self.report(
                Diagnostic::new(Code::E0513, leaving, format!("{word} leaves a `__TRY` that has a `__FINALLY`"))
                    .label("whether `__FINALLY` runs then is not documented")
                    .other(finally, "this may have to run")
                    .help("set a BOOL here, and test it after `__ENDTRY`"),
            );
        }
    }
}

pub(super) fn is_raise(callee: &ast::Expr<'_>) -> bool {
    matches!(&callee.kind, ast::ExprKind::Name(name) if name.text == RAISE)
}

fn labels(is: impl Fn(FaultKind) -> bool) -> Vec<(i128, i128)> {
    FaultKind::ALL.into_iter().filter(|it| is(*it)).map(|it| (i128::from(it as u8), i128::from(it as u8))).collect()
}

fn number(value: u32, ty: Type, at: Location) -> Expr {
    Expr::new(ty, ExprKind::Const(Value::U32(value)), at)
}

/// The statements that leave those, or a loop around them.
fn leaving(statements: &[ast::Statement<'_>], labels: &[Key<'_>], own: bool) -> Vec<Span> {
    let mut found = Vec::new();
    for statement in statements {
        match statement.kind {
            Ast::Return | Ast::ReturnIf(_) => found.push(statement.span),
            Ast::Exit | Ast::Continue if own => found.push(statement.span),
            Ast::Jump(name) if !labels.contains(&Key(name.text)) => found.push(statement.span),
            _ => {}
        }
        let is_loop = matches!(statement.kind, Ast::For { .. } | Ast::While { .. } | Ast::Repeat { .. });
        ast::each_body(statement, &mut |body| found.extend(leaving(body, labels, own && !is_loop)));
    }
    found
}

fn label<'s>(statement: &ast::Statement<'s>) -> Option<Key<'s>> {
    match statement.kind {
        Ast::Label(name) => Some(Key(name.text)),
        _ => None,
    }
}
