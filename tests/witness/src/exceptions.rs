//! CODESYS' exceptions, as its page and Beckhoff's describe them: a fault in `__TRY` goes to `__CATCH`, and `__FINALLY` comes last.

use crate::machine::{Frame, Machine, Outcome, Stop, unknown};
use crate::statements::Flow;
use crate::storage::{Cell, Value};
use staunch_frontend::Span;
use staunch_frontend::ast::{Argument, ArgumentKind, Expr, ExprKind, Try};
use staunch_runtime::{FaultKind, Value as Scalar};

impl<'a> Machine<'a> {
    pub(crate) fn try_statement(&mut self, frame: &Frame<'a>, it: &'a Try<'a>) -> Outcome<Flow<'a>> {
        let (memory, eno) = (self.memory.len(), self.eno.take());
        let mut flow = self.block(frame, &it.body);
        self.eno = eno;
        if let Err(Stop::Fault(fault)) = &flow
            && let Some(number) = self.number_of(fault.kind)
        {
            self.memory.truncate(memory);
            if let Some(exception) = &it.exception {
                let place = self.place(frame, exception)?;
                let place = self.checked(place)?;
                let value = Value { ty: place.ty.clone(), cells: vec![Cell::Scalar(Scalar::U32(number))] };
                self.write(&place, &value);
            }
            flow = self.block(frame, &it.handler);
        }
        let flow = flow?;
        match &it.finally {
            Some(_) if flow != Flow::Next => unknown("`__FINALLY` after what leaves `__TRY`"),
            Some(finally) => self.block(frame, &finally.body),
            None => Ok(flow),
        }
    }

    /// What `__SYSTEM.ExceptionCode` calls it; none for a fault after which no program continues.
    fn number_of(&self, kind: FaultKind) -> Option<u32> {
        let name = match kind {
            FaultKind::DivideByZero => "RTSEXCPT_DIVIDEBYZERO",
            FaultKind::IndexOutOfRange => "RTSEXCPT_ARRAYBOUNDS",
            FaultKind::MisalignedReference => "RTSEXCPT_MISALIGNMENT",
            FaultKind::NullReference | FaultKind::OutsideObject | FaultKind::ForbiddenView | FaultKind::Deleted => {
                "RTSEXCPT_ACCESS_VIOLATION"
            }
            FaultKind::Raised => return Some(self.raised),
            FaultKind::LoopBudget | FaultKind::AssertionFailed | FaultKind::NotImplemented | FaultKind::Recursion => {
                return None;
            }
            FaultKind::SubrangeViolated
            | FaultKind::ZeroStep
            | FaultKind::NoSuchDate
            | FaultKind::NegativeTimer
            | FaultKind::NotDecimal
            | FaultKind::NotOfPool => "RTSEXCPT_UNKNOWN",
        };
        CODES.iter().find(|it| it.0 == name).map(|it| it.1)
    }

    /// `F_RaiseException(number)`
    pub(crate) fn raise(
        &mut self,
        frame: &Frame<'a>,
        callee: &'a Expr<'a>,
        arguments: &'a [Argument<'a>],
        span: Span,
    ) -> Outcome<()> {
        let ExprKind::Name(name) = &callee.kind else { return Ok(()) };
        if !name.text.eq_ignore_ascii_case("F_RaiseException") {
            return Ok(());
        }
        let [Argument { kind: ArgumentKind::Positional(value) | ArgumentKind::Input(_, value), .. }] = arguments else {
            return unknown("F_RaiseException without a number");
        };
        let number = self.value(frame, value, None)?.as_integer()?;
        self.raised = u32::try_from(number).unwrap_or_default();
        Err(self.fault(FaultKind::Raised, span))
    }
}

/// Beckhoff, "Data type __SYSTEM.ExceptionCode".
const CODES: [(&str, u32); 5] = [
    ("RTSEXCPT_UNKNOWN", 0xFFFF_FFFF),
    ("RTSEXCPT_ACCESS_VIOLATION", 0x51),
    ("RTSEXCPT_MISALIGNMENT", 0x100),
    ("RTSEXCPT_ARRAYBOUNDS", 0x101),
    ("RTSEXCPT_DIVIDEBYZERO", 0x102),
];
