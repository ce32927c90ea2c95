//! FOR loops whose number of turns is not constant have several of them one after the other, as long as there are so many.
//!
//! ```text
//! FOR i := a TO b DO                i := a;
//!     s := s + x[i];                WHILE i <= b - 3 DO
//! END_FOR                               s := s + x[i]; … s := s + x[i + 3];
//!                                       i := i + 4;
//!                                   END_WHILE
//!                                   FOR i := i TO b DO s := s + x[i]; END_FOR
//! ```
//!
//! It applies to small bodies without other loops and checks of indices, and to counters that nothing else writes and that are at 64 bits while the loop runs, so that
//! the bound of a group does not wrap. The turns of the loop budget are taken before. The counter has its value of each turn wherever it can be seen, as in
//! [`unrolled`](crate::unrolled). It may not assume that there is a group.

use crate::control::{Control, Running};
use crate::function::{Flow, Function, LoopFrame};
use crate::target::Aim;
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC, types};
use staunch_ir::faults::{Faults, code_faults};
use staunch_ir::{ArrayId, Expr, Statement, StatementKind, Step, turns, visit};

/// Turns of a group.
const GROUP: usize = 4;
/// Operations of a body.
const MOST: usize = 24;

impl<'p> Function<'_, 'p> {
    /// How many turns of a loop are together, if there are several.
    pub(crate) fn grouping(&mut self, control: &Control<'p>, body: &[Statement]) -> Option<(Running<'p>, usize)> {
        let Control::Count(running) = control else { return None };
        let is_narrow = running.repr.size() < 8 && running.register.is_some();
        let is_constant = matches!(running.it.step, Step::Constant(_));
        let stays = !running.it.may_leave_range() || running.oversteps();
        let is_wanted = self.module.aim == Aim::Speed && self.noted.is_none() && !self.module.handles_faults;
        let is_small = turns::size_of(body) <= MOST && !has_others(body) && !self.has_checks(body);
        (is_wanted && is_narrow && is_constant && stays && is_small).then_some((*running, GROUP))
    }

    /// Whether an index is checked in a body: each copy would have the way to its fault.
    fn has_checks(&self, body: &[Statement]) -> bool {
        let root_type = |root| self.module.program.root_type(self.routine, root);
        let is_within = |index: &Expr, array: Option<ArrayId>| {
            index.as_const().is_some() || array.is_some_and(|it| self.known(&|known| known.is_within(index, it)))
        };
        let program = self.module.program;
        let faults = Faults { program, root_type: &root_type, is_within: &is_within, operation: &code_faults };
        let mut found = false;
        for statement in body {
            visit::accesses(statement, &mut |place, _| found |= faults.place(place));
        }
        found
    }

    /// A loop from its first turn on, whose block is open and not sealed. Whether control continues after it.
    pub(crate) fn groups_and_rest(
        &mut self,
        control: &Control<'p>,
        running: &Running<'p>,
        group: usize,
        [head, after]: [clif::Block; 2],
        body: &'p [Statement],
    ) -> bool {
        let Step::Constant(step) = running.it.step else { unreachable!("a step that is constant") };
        let [several, few, turn] = [(); 3].map(|()| self.builder.create_block());
        let start = self.counter_value(running);
        let last = self.last(running);
        let others = i128::try_from(group).expect("a few turns") - 1;
        let most = self.integer(types::I64, others * step);
        let most = self.ins().isub(last, most);
        let condition = if step > 0 { IntCC::SignedGreaterThan } else { IntCC::SignedLessThan };
        let is_past = self.ins().icmp(condition, start, most);
        self.ins().brif(is_past, few, &[], several, &[]);
        self.go_on_in(several);
        self.group(running, group, step, [head, after], body);
        self.builder.seal_block(head);

        self.go_on_in(few);
        self.at_most(group);
        let end = self.natural_end(control, after);
        self.further_turn(control, turn, end);
        self.close_end(control, end, after);
        self.builder.switch_to_block(turn);
        let frame = LoopFrame { next: self.builder.create_block(), ..LoopFrame::to(after) };
        self.one_by_one(control, frame, turn, body, &[]);
        true
    }

    fn group(
        &mut self,
        running: &Running<'p>,
        group: usize,
        step: i128,
        [head, after]: [clif::Block; 2],
        body: &'p [Statement],
    ) {
        let start = self.counter_value(running);
        let (mut is_left, mut further) = (false, 0);
        for _ in 0..group {
            let flow = self.turn_in_line(body, after, &mut is_left);
            if flow == Flow::Leaves {
                return;
            }
            further += step;
            self.set_further_counter(running, start, further);
        }
        self.ins().jump(head, &[]);
        self.leads_back(group);
    }
}

/// Whether the body contains something that cannot be duplicated.
fn has_others(body: &[Statement]) -> bool {
    let mut found = false;
    visit::statements(body, &mut |it| {
        found |= matches!(
            it.kind,
            StatementKind::For(_) | StatementKind::Loop { .. } | StatementKind::Turn | StatementKind::Call { .. }
        );
    });
    found
}
