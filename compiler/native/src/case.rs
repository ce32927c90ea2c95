//! CASE: wide ranges are compared for, all other labels become jump tables and search trees.

use crate::function::{Flow, Function};
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC};
use cranelift_frontend::Switch;
use staunch_ir::{Arm, Block, Expr};

/// A range with more values than this is compared for.
const WIDE: i128 = 16;

impl<'p> Function<'_, 'p> {
    pub(crate) fn case(&mut self, selector: &Expr, arms: &'p [Arm], otherwise: &'p Block) -> Flow {
        let selector = self.scalar(selector);
        let blocks: Vec<_> = arms.iter().map(|_| self.builder.create_block()).collect();
        let (otherwise_block, after) = (self.builder.create_block(), self.builder.create_block());
        let mut switch = Switch::new();
        for (arm, block) in arms.iter().zip(&blocks) {
            for (low, high) in &arm.labels {
                self.label(selector, (*low, *high), *block, &mut switch);
            }
        }
        switch.emit(&mut self.builder, selector, otherwise_block);
        let mut flow: Vec<_> = arms
            .iter()
            .zip(blocks)
            // No label, no way in.
            .filter(|(arm, _)| !arm.labels.is_empty())
            .map(|(arm, block)| self.arm(block, &arm.body, after))
            .collect();
        flow.push(self.arm(otherwise_block, otherwise, after));
        self.join(&flow, after)
    }

    fn label(&mut self, selector: clif::Value, (low, high): (i128, i128), arm: clif::Block, switch: &mut Switch) {
        let ty = self.builder.func.dfg.value_type(selector);
        if high - low < WIDE {
            let mask = (1_i128 << ty.bits()) - 1;
            for value in low..=high {
                switch.set_entry((value & mask).cast_unsigned(), arm);
            }
            return;
        }
        let low_value = self.integer(ty, low);
        let width = self.integer(ty, high - low);
        let distance = self.ins().isub(selector, low_value);
        let is_inside = self.ins().icmp(IntCC::UnsignedLessThanOrEqual, distance, width);
        let next = self.builder.create_block();
        self.ins().brif(is_inside, arm, &[], next, &[]);
        self.go_on_in(next);
    }
}
