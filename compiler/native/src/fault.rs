//! Faults: a branch to a block away from the common path, which returns the fault's code.

use crate::function::Function;
use crate::signature::CODE;
use cranelift_codegen::ir::{self as clif, BlockArg, InstBuilder, condcodes::IntCC};
use staunch_ir::{FaultKind, Location};
use staunch_runtime::Fault;

/// How many codes one block is given: what allocating a register for them costs is the square of their number.
const PASSING: usize = 64;

impl Function<'_, '_> {
    pub(crate) fn fault_if(&mut self, condition: clif::Value, kind: FaultKind, at: Location) {
        let fault = self.fault_block(kind, at);
        let next = self.builder.create_block();
        self.ins().brif(condition, fault, &[], next, &[]);
        self.seen.goes_on(self.builder.current_block(), next);
        self.go_on_in(next);
    }

    pub(crate) fn fault(&mut self, kind: FaultKind, at: Location) {
        let fault = self.fault_block(kind, at);
        self.ins().jump(fault, &[]);
    }

    /// Returns `code` if it is a fault's.
    pub(crate) fn pass_fault(&mut self, code: clif::Value) {
        let passing = self.passing_block();
        let next = self.builder.create_block();
        self.ins().brif(code, passing, &[BlockArg::Value(code)], next, &[]);
        self.go_on_in(next);
    }

    /// As `pass_fault`, for the code of what is called at `at` and has faults that are there.
    pub(crate) fn pass_fault_of_call(&mut self, code: clif::Value, at: Location) {
        let faulted = self.cold_block();
        let next = self.builder.create_block();
        self.ins().brif(code, faulted, &[], next, &[]);
        self.go_on_in(faulted);
        // The kind is the lowest byte of a code, the rest its place: none where it is the caller's.
        let place = self.ins().ushr_imm_u(code, 8);
        let is_callers = self.ins().icmp_imm_u(IntCC::Equal, place, 0);
        let here = self.code(Fault { kind: FaultKind::DivideByZero, at }.code() & !0xFF);
        let here = self.ins().bor(code, here);
        let code = self.ins().select(is_callers, here, code);
        let passing = self.passing_block();
        self.ins().jump(passing, &[BlockArg::Value(code)]);
        self.go_on_in(next);
    }

    /// Returns a fault if `kind`, a byte from the runtime, is not 0.
    pub(crate) fn fault_of_kind(&mut self, kind: clif::Value, at: Location) {
        // The kind is the lowest byte of a code, and DivideByZero one that a code can hold.
        let any = Fault { kind: FaultKind::DivideByZero, at }.code();
        let rest = self.code(any & !0xFF);
        let wide = self.ins().uextend(CODE, kind);
        let code = self.ins().bor(wide, rest);
        let passing = self.passing_block();
        let next = self.builder.create_block();
        let is_fault = self.ins().icmp_imm_u(IntCC::NotEqual, kind, 0);
        self.ins().brif(is_fault, passing, &[BlockArg::Value(code)], next, &[]);
        self.go_on_in(next);
    }

    /// Continues in a block whose only way in has been emitted.
    pub(crate) fn go_on_in(&mut self, block: clif::Block) {
        if self.is_elsewhere() {
            self.builder.set_cold_block(block);
        }
        self.builder.switch_to_block(block);
        self.builder.seal_block(block);
    }

    fn fault_block(&mut self, kind: FaultKind, at: Location) -> clif::Block {
        let code = Fault { kind, at }.code();
        if let Some(known) = self.faults.known.get(&code) {
            return *known;
        }
        let block = self.cold_block();
        self.faults.known.insert(code, block);
        block
    }

    pub(crate) fn passing_block(&mut self) -> clif::Block {
        if let Some(known) = self.faults.passing.last()
            && self.faults.passing_to_last < PASSING
        {
            self.faults.passing_to_last += 1;
            return *known;
        }
        let block = self.cold_block();
        self.builder.append_block_param(block, CODE);
        self.faults.passing.push(block);
        self.faults.passing_to_last = 1;
        block
    }

    fn cold_block(&mut self) -> clif::Block {
        let block = self.builder.create_block();
        self.builder.set_cold_block(block);
        block
    }

    pub(crate) fn close_faults(&mut self) {
        self.end_faults(&mut |this, code| this.return_fault(code));
    }

    /// Fills the blocks that faults lead to: each ends by what `end` emits.
    pub(crate) fn end_faults(&mut self, end: &mut dyn FnMut(&mut Self, clif::Value)) {
        for (code, block) in core::mem::take(&mut self.faults.known) {
            self.go_on_in(block);
            let code = self.code(code);
            end(self, code);
        }
        for block in core::mem::take(&mut self.faults.passing) {
            self.go_on_in(block);
            let code = self.builder.block_params(block)[0];
            end(self, code);
        }
    }

    fn return_fault(&mut self, code: clif::Value) {
        let mut values = vec![code];
        values.extend(self.no_result());
        self.ins().return_(&values);
    }
}
