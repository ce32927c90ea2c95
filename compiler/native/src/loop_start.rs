//! What a loop does before its first turn: it finds whether there is one, and takes the turns of the budget that it
//! takes at once.

use crate::control::{Control, Known, Running};
use crate::function::{Few, Flow, Function, LoopFrame};
use crate::turns::{Size, Way};
use cranelift_codegen::ir::{self as clif, InstBuilder};
use staunch_ir::{Count, Statement, Step, Taking};

impl<'p> Function<'_, 'p> {
    pub(crate) fn loop_under(
        &mut self,
        control: &Control<'p>,
        known: Known<'p>,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> Flow {
        let [start, after] = [(); 2].map(|()| self.builder.create_block());
        let may_copy = self.may_copy(body, continuing);
        let free = if known.taking().is_ahead() || may_copy { self.free_before_all(&known) } else { None };
        self.further_turn(control, start, after);
        self.builder.switch_to_block(start);
        let is_tested = !matches!(control, Control::Always);
        let is_left = match known.taking() {
            Taking::Each => self.first_turn_on(control, start, after, body, continuing),
            Taking::EachOfMany => {
                self.builder.seal_block(start);
                if may_copy {
                    let blocks = self.free_or_counted(&known, is_tested, free);
                    self.free_and_counted(control, blocks, after, body, continuing)
                } else {
                    let few = self.way_of(&known, is_tested);
                    let few = self.is_few(&few);
                    self.counted_unless(few, control, after, body, continuing)
                }
            }
            taking @ (Taking::Ahead(at) | Taking::AheadOfMany(at)) => {
                self.builder.seal_block(start);
                let way = self.way_of(&known, is_tested);
                self.take_ahead(&way, taking.is_of_many(), at);
                let turn = self.builder.create_block();
                self.ins().jump(turn, &[]);
                if let Some(free) = free {
                    self.go_on_in(free);
                    self.ins().jump(turn, &[]);
                }
                self.builder.switch_to_block(turn);
                self.first_turn_on(control, turn, after, body, continuing)
            }
        };
        self.join(&[if is_left { Flow::Continues } else { Flow::Leaves }], after)
    }

    /// Where control is if a loop of many turns has few, and at least one: found before all else, so that the usual loop
    /// starts with one test.
    fn free_before_all(&mut self, known: &Known<'p>) -> Option<clif::Block> {
        if !known.taking().is_of_many() || !known.is_all_that_is_tested() {
            return None;
        }
        let way = self.way_of(known, true);
        let is_few = self.is_few_and_some(&way)?;
        Some(self.free_if(is_few))
    }

    /// The block where control is if `few`; what is emitted next is for the other case.
    fn free_if(&mut self, few: clif::Value) -> clif::Block {
        let [free, many] = [(); 2].map(|()| self.builder.create_block());
        self.builder.set_cold_block(many);
        self.ins().brif(few, free, &[], many, &[]);
        self.go_on_in(many);
        free
    }

    pub(crate) fn way_of(&mut self, known: &Known<'p>, is_tested: bool) -> Way {
        match known {
            Known::Nothing => unreachable!("only loops whose turns are known take them by their way"),
            Known::While(it) => self.way_of_while(it, is_tested),
            Known::For(it) => self.way_of_for(it),
        }
    }

    fn way_of_while(&mut self, count: &'p Count, is_tested: bool) -> Way {
        let repr = self.module.program.repr(count.counter.ty).expect("verified IR: an integer counter");
        let first = self.load_place(&count.counter);
        let first = self.widened(repr, first);
        let last = self.wide_scalar(repr, &count.bound);
        Way { first, last, repr, step: Size::Constant(count.step), is_before: count.offset != 0, is_tested }
    }

    fn way_of_for(&mut self, running: &Running<'p>) -> Way {
        let (first, last) = (self.counter_value(running), self.last(running));
        let step = match (&running.it.step, running.step) {
            (_, Some(step)) => Size::Variable(step),
            (Step::Constant(step), None) => Size::Constant(*step),
            (Step::Variable(_), None) => unreachable!("a variable step is evaluated before the loop"),
        };
        Way { first, last, repr: running.repr, step, is_before: false, is_tested: true }
    }

    /// The blocks where the loop without turns starts, and the one with them.
    fn free_or_counted(&mut self, known: &Known<'p>, is_tested: bool, free: Option<clif::Block>) -> [clif::Block; 2] {
        let free = free.unwrap_or_else(|| {
            let way = self.way_of(known, is_tested);
            let few = self.is_few(&way);
            self.free_if(few)
        });
        let counted = self.builder.create_block();
        self.ins().jump(counted, &[]);
        [free, counted]
    }

    fn free_and_counted(
        &mut self,
        control: &Control<'p>,
        [free, counted]: [clif::Block; 2],
        after: clif::Block,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        self.builder.switch_to_block(free);
        let frame = LoopFrame { next: self.builder.create_block(), few: Few::Yes, ..LoopFrame::to(after) };
        let is_left = self.one_by_one(control, frame, free, body, continuing);
        self.builder.switch_to_block(counted);
        self.first_turn_on(control, counted, after, body, continuing) || is_left
    }

    /// A large body exists once: where `few` is true, it takes no turns.
    fn counted_unless(
        &mut self,
        few: clif::Value,
        control: &Control<'p>,
        after: clif::Block,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        let turn = self.builder.create_block();
        let [none, one] = [0, 1].map(|it| self.integer(clif::types::I64, it));
        let taken = self.ins().select(few, none, one);
        self.ins().jump(turn, &[]);
        self.builder.switch_to_block(turn);
        let frame = LoopFrame { next: self.builder.create_block(), few: Few::Taken(taken), ..LoopFrame::to(after) };
        self.one_by_one(control, frame, turn, body, continuing)
    }

    /// A loop from its first turn on, whose block is open and not sealed. Whether control continues after it.
    fn first_turn_on(
        &mut self,
        control: &Control<'p>,
        turn: clif::Block,
        after: clif::Block,
        body: &'p [Statement],
        continuing: &'p [Statement],
    ) -> bool {
        if let Some(copies) = self.copies(body, continuing) {
            return self.turns_at_once(control, copies, [turn, after], body, continuing);
        }
        if let Some((running, group)) = self.grouping(control, body) {
            return self.groups_and_rest(control, &running, group, [turn, after], body);
        }
        let frame = LoopFrame { next: self.builder.create_block(), ..LoopFrame::to(after) };
        self.one_by_one(control, frame, turn, body, continuing)
    }
}
