//! What an emitted loop says for the count of its instructions: how often it is repeated at most, or why that is not known.

use crate::count::{Mark, Repeats, Why};
use crate::function::Function;
use staunch_ir::alias::Frame;
use staunch_ir::{Block, For, Location, turns};

/// Every turn divides a number by 2 or more, and there are none of more bits.
const MOST_DIVIDING: u64 = 65;

impl Function<'_, '_> {
    /// How often a FOR is repeated at most, where it begins.
    pub(crate) fn repeats_of_for(&self, it: &For, at: Location) -> Repeats {
        let most = it.is_private.then(|| self.known(&|known| it.most_further(&known)));
        let why = match most {
            None => Why::Written,
            Some(None) => Why::Limits,
            Some(Some(_)) => Why::Constant,
        };
        Repeats { most: most.flatten(), why, at }
    }

    /// How often a WHILE or REPEAT is repeated at most, where it begins. A test in its body is in one turn more than
    /// the rest.
    pub(crate) fn repeats_of_loop(&self, body: &Block, continuing: &Block, at: Location) -> Repeats {
        let frame = Frame::of(self.module.program, self.routine);
        let linear = if continuing.is_empty() { turns::linear(&frame, body) } else { None };
        let counted = linear.and_then(|it| self.known(&|known| it.most_turns(&frame, self.before, &known)));
        let divides = || turns::divides(&frame, body, continuing).then_some(MOST_DIVIDING);
        let most = counted.or_else(divides);
        Repeats { most, why: if most.is_some() { Why::Constant } else { Why::Condition }, at }
    }

    /// The instruction that ends the open block leads back to the start of the innermost loop, `by` turns later than before.
    pub(crate) fn leads_back(&mut self, by: usize) {
        let Some(block) = self.builder.current_block() else { return };
        let last = self.builder.func.layout.last_inst(block);
        let (Some(turning), Some(last)) = (self.turning.last(), last) else { return };
        let by = u64::try_from(by.max(1)).expect("a usize fits a u64");
        let repeats = Repeats { most: turning.most.map(|it| it / by), ..*turning };
        self.marks.push((last, Mark::Repeats(repeats)));
    }

    /// The call that has just been emitted, which has no result, works on so many characters at most.
    pub(crate) fn works_on(&mut self, characters: u16) {
        let block = self.builder.current_block();
        let call = block.and_then(|it| self.builder.func.layout.last_inst(it));
        self.marks.extend(call.map(|it| (it, Mark::Size(characters.into()))));
    }

    /// From here on, the innermost loop has at most so many turns.
    pub(crate) fn at_most(&mut self, turns: usize) {
        let most = u64::try_from(turns).expect("a usize fits a u64");
        if let Some(turning) = self.turning.last_mut() {
            turning.most = turning.most.map(|it| it.min(most));
        }
    }
}
