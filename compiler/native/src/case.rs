//! CASE: few labels and wide ranges are compared for, all others become jump tables and search trees. A jump through a table
//! takes about ten instructions, and a processor guesses worse where it leads.

use crate::function::{Flow, Function};
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC};
use cranelift_frontend::Switch;
use staunch_ir::{Arm, Block, Expr};

/// A range with more values than this is compared for.
const WIDE: i128 = 16;

/// So many labels and ranges are compared for one by one.
const FEW: usize = 4;

impl<'p> Function<'_, 'p> {
    pub(crate) fn case(&mut self, selector: &Expr, arms: &'p [Arm], otherwise: &'p Block) -> Flow {
        let selector = self.scalar(selector);
        let blocks: Vec<_> = arms.iter().map(|_| self.builder.create_block()).collect();
        let (otherwise_block, after) = (self.builder.create_block(), self.builder.create_block());
        let mut switch = Switch::new();
        let are_few = arms.iter().map(|arm| arm.labels.len()).sum::<usize>() <= FEW;
        let widest = if are_few { 0 } else { WIDE };
        for (arm, block) in arms.iter().zip(&blocks) {
            for (low, high) in &arm.labels {
                if high - low < widest {
                    enter(&mut switch, self.builder.func.dfg.value_type(selector), (*low, *high), *block);
                } else {
                    self.compare_label(selector, (*low, *high), *block);
                }
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

    fn compare_label(&mut self, selector: clif::Value, (low, high): (i128, i128), arm: clif::Block) {
        let ty = self.builder.func.dfg.value_type(selector);
        let low_value = self.integer(ty, low);
        let is_inside = if low == high {
            self.ins().icmp(IntCC::Equal, selector, low_value)
        } else {
            let width = self.integer(ty, high - low);
            let distance = self.ins().isub(selector, low_value);
            self.ins().icmp(IntCC::UnsignedLessThanOrEqual, distance, width)
        };
        let next = self.builder.create_block();
        self.ins().brif(is_inside, arm, &[], next, &[]);
        self.go_on_in(next);
    }
}

/// Puts all values of a range into the switch.
fn enter(switch: &mut Switch, ty: clif::Type, (low, high): (i128, i128), arm: clif::Block) {
    let mask = (1_i128 << ty.bits()) - 1;
    for value in low..=high {
        switch.set_entry((value & mask).cast_unsigned(), arm);
    }
}
