//! Loops whose bodies are small: turns are taken for several of them at once, and the body is there as often.
//! Where fewer are left than that, a loop of single turns continues, up to the one that faults. So the turn of a
//! fault is the same, and what is left of the turns is right wherever somebody looks.

use crate::control::Control;
use crate::function::{Flow, Function, LoopFrame};
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC};
use staunch_ir::{RoutineId, Statement, turns};

/// Operations that the turns taken at once should come to, so that taking them is a small part.
const ENOUGH: usize = 256;
const MOST_COPIES: usize = 32;
/// Operations of copies in one routine, so that its code grows by no more.
const MOST_IN_A_ROUTINE: usize = 8192;

impl<'p> Function<'_, 'p> {
    /// How many turns the loop takes at once; `None` where it takes them one by one.
    pub(crate) fn copies(&mut self, body: &[Statement], continuing: &[Statement]) -> Option<usize> {
        // A fault among copies would leave the turns that were had, and a debugger shows a statement at one place.
        if self.module.handles_faults || self.noted.is_some() {
            return None;
        }
        let callee_does = |callee: RoutineId| self.module.effects(callee).turns;
        let size = turns::size_of_single(body, continuing, &callee_does)?;
        let copies = (ENOUGH / size.max(1)).min(MOST_COPIES);
        let made = self.copied + copies * size;
        if copies < 2 || made > MOST_IN_A_ROUTINE {
            return None;
        }
        self.copied = made;
        Some(copies)
    }

    /// Whether a loop's body may be there twice.
    pub(crate) fn may_copy(&mut self, body: &[Statement], continuing: &[Statement]) -> bool {
        if self.noted.is_some() {
            return false;
        }
        let callee_does = |callee: RoutineId| self.module.effects(callee).turns;
        let size = turns::size_of_single(body, continuing, &callee_does).filter(|it| *it <= 2 * ENOUGH);
        let Some(made) = size.map(|it| self.copied + it).filter(|it| *it <= MOST_IN_A_ROUTINE) else { return false };
        self.copied = made;
        true
    }

    /// From the first turn on, which exists, in the block `head`. Whether control continues in `after`.
    pub(crate) fn turns_at_once(
        &mut self,
        control: &Control<'p>,
        copies: usize,
        [head, after]: [clif::Block; 2],
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        let [enough, few] = [(); 2].map(|()| self.builder.create_block());
        self.builder.switch_to_block(head);
        let turns = self.turns.expect("verified IR: a turn is a loop's");
        let left = self.builder.use_var(turns);
        let all = i64::try_from(copies).expect("a few copies");
        let suffice = self.ins().icmp_imm_u(IntCC::UnsignedGreaterThanOrEqual, left, all);
        self.builder.set_cold_block(few);
        self.ins().brif(suffice, enough, &[], few, &[]);

        self.go_on_in(enough);
        let mut is_left = !matches!(control, Control::Always);
        let mut taken = 0;
        for _ in 0..copies {
            let frame = LoopFrame { next: self.builder.create_block(), taken: Some(taken), ..LoopFrame::to(after) };
            let goes_on = self.one_of_several(control, frame, body, continuing);
            let frame = self.loops.pop().expect("the copy's");
            is_left |= frame.is_left;
            taken = frame.taken.unwrap_or(taken);
            if goes_on == Flow::Leaves {
                break;
            }
            if taken == all {
                self.subtract_turns(all);
                self.ins().jump(head, &[]);
                self.leads_back(copies);
            }
        }
        self.close_exits(after);
        self.builder.seal_block(head);

        self.builder.switch_to_block(few);
        // There are fewer left than that, and a turn that finds none faults.
        self.at_most(copies);
        let frame = LoopFrame { next: self.builder.create_block(), ..LoopFrame::to(after) };
        self.one_by_one(control, frame, few, body, continuing) || is_left
    }

    /// One turn, after which the next one begins where the code continues.
    fn one_of_several(
        &mut self,
        control: &Control<'p>,
        frame: LoopFrame,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> Flow {
        self.loops.push(frame);
        // A block less, where there is no CONTINUE: Cranelift computes again in each block what is a sum with a constant.
        match (self.block(body), self.innermost().is_continued) {
            (Flow::Continues, false) => {}
            (Flow::Leaves, false) => return Flow::Leaves,
            (flow, true) => {
                if flow == Flow::Continues {
                    self.continue_loop();
                }
                self.go_on_in(frame.next);
            }
        }
        if self.end_of_turn(control, continuing) == Flow::Leaves {
            return Flow::Leaves;
        }
        let further = self.builder.create_block();
        let after = if matches!(control, Control::Always) { frame.after } else { self.turn_end() };
        let end = self.natural_end(control, after);
        self.further_turn(control, further, end);
        self.close_end(control, end, after);
        self.go_on_in(further);
        Flow::Continues
    }

    /// Where a copy leaves the loop: it takes the turns that were had.
    pub(crate) fn exit_after(&mut self, taken: i64, after: clif::Block) -> clif::Block {
        match self.exits.last() {
            _ if taken == 0 => after,
            Some((known, block)) if *known == taken => *block,
            Some(_) | None => {
                let block = self.builder.create_block();
                self.builder.set_cold_block(block);
                self.exits.push((taken, block));
                block
            }
        }
    }

    fn close_exits(&mut self, after: clif::Block) {
        for (taken, block) in std::mem::take(&mut self.exits) {
            self.go_on_in(block);
            self.subtract_turns(taken);
            self.ins().jump(after, &[]);
        }
    }

    pub(crate) fn subtract_turns(&mut self, taken: i64) {
        let Some(turns) = self.turns.filter(|_| taken > 0) else { return };
        let left = self.builder.use_var(turns);
        let left = self.ins().iadd_imm_s(left, -taken);
        self.builder.def_var(turns, left);
    }
}
