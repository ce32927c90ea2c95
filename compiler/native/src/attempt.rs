//! Statements whose faults are handled.

use crate::function::{Flow, Function};
use crate::place::PlaceValue;
use crate::signature::CODE;
use cranelift_codegen::ir::{self as clif, BlockArg, InstBuilder, condcodes::IntCC, types};
use staunch_ir::{Block, FaultKind, Place};

impl<'p> Function<'_, 'p> {
    /// Statements whose faults are handled: they lead to a block of their own, which passes on what may not be caught.
    pub(crate) fn attempt(&mut self, body: &'p Block, kind: &'p Place, handler: &'p Block) -> Flow {
        let [caught, after] = [(); 2].map(|()| self.builder.create_block());
        let (flow, is_reached) = self.with_faults_to(caught, after, &mut |this| this.block(body));
        let mut flow = [flow, Flow::Leaves];
        if is_reached {
            self.go_on_in(caught);
            flow[1] = self.handle(caught, kind, handler);
            if flow[1] == Flow::Continues {
                self.ins().jump(after, &[]);
            }
        }
        self.join(&flow, after)
    }

    /// Statements after which `last` comes in any case.
    pub(crate) fn finally(&mut self, body: &'p Block, last: &'p Block) -> Flow {
        self.endings += 1;
        let before = self.before;
        let run = &mut |this: &mut Self| this.block_after(before, body);
        let flow = self.before_faults_pass(run, &mut |this| {
            this.block(last);
        });
        self.endings -= 1;
        if flow == Flow::Continues {
            self.block(last);
        }
        flow
    }

    /// What `run` emits, whose faults lead to what `end` emits, and on from there.
    pub(crate) fn before_faults_pass(
        &mut self,
        run: &mut dyn FnMut(&mut Self) -> Flow,
        end: &mut dyn FnMut(&mut Self),
    ) -> Flow {
        let [faulted, after] = [(); 2].map(|()| self.builder.create_block());
        self.builder.set_cold_block(faulted);
        let (flow, is_reached) = self.with_faults_to(faulted, after, run);
        if is_reached {
            self.go_on_in(faulted);
            let code = self.builder.block_params(faulted)[0];
            end(self);
            let passing = self.passing_block();
            self.ins().jump(passing, &[BlockArg::Value(code)]);
        }
        if flow == Flow::Continues {
            self.go_on_in(after);
        }
        flow
    }

    /// Emits what leads to `after` at its end, and to `faulted`, with the code, by a fault. Whether either is reached.
    fn with_faults_to(
        &mut self,
        faulted: clif::Block,
        after: clif::Block,
        run: &mut dyn FnMut(&mut Self) -> Flow,
    ) -> (Flow, bool) {
        let around = core::mem::take(&mut self.faults);
        let flow = run(self);
        if flow == Flow::Continues {
            self.ins().jump(after, &[]);
        }
        let mut is_reached = false;
        self.builder.append_block_param(faulted, CODE);
        self.end_faults(&mut |this, code| {
            is_reached = true;
            this.ins().jump(faulted, &[BlockArg::Value(code)]);
        });
        self.faults = around;
        (flow, is_reached)
    }

    fn handle(&mut self, caught: clif::Block, kind: &Place, handler: &'p Block) -> Flow {
        let code = self.builder.block_params(caught)[0];
        let number = self.ins().ireduce(types::I8, code);
        for fatal in FaultKind::ALL.into_iter().filter(|it| !it.can_be_caught()) {
            let is_it = self.ins().icmp_imm_u(IntCC::Equal, number, i64::from(fatal as u8));
            let (passing, next) = (self.passing_block(), self.builder.create_block());
            self.ins().brif(is_it, passing, &[BlockArg::Value(code)], next, &[]);
            self.go_on_in(next);
        }
        match self.place_value(kind) {
            PlaceValue::Variable(variable) => self.builder.def_var(variable, number),
            PlaceValue::Memory(address) => self.store(number, address),
        }
        self.block(handler)
    }
}
