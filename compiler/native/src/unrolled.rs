//! FOR loops whose number of turns is constant have several of them one after the other.
//!
//! ```text
//! FOR i := 0 TO 2 DO                s := s + a[0];
//!     s := s + a[i];                s := s + a[1];
//! END_FOR                           s := s + a[2];
//!                                   i := 3;
//!
//! FOR i := 0 TO 99 DO               i := 0;
//!     a[i] := i;                    again: a[i] := i; … a[i + 9] := i + 9;
//! END_FOR                           i := i + 10; continues at `again` unless i > 99
//! ```
//!
//! It applies to a loop whose first and last value are constants, whose counter nothing else writes, and in which there is no
//! other loop. A loop of few operations in all is its turns, in which the counter is a constant. Another has groups of turns,
//! of a size that divides their number: so there is nothing to be tested in a group. The counter has its value of each turn
//! wherever it can be seen: in its storage, if a fault may show it or a callee may read it, and after EXIT. Turns that the body
//! takes of the loop budget stay.

use crate::control::Running;
use crate::function::{Flow, Function, LoopFrame};
use crate::target::Aim;
use cranelift_codegen::ir::{self as clif, InstBuilder, condcodes::IntCC, types};
use staunch_ir::loops::running;
use staunch_ir::shifted::shifted;
use staunch_ir::visit::{self, Access};
use staunch_ir::{For, Root, Statement, StatementKind, Step, Taking, Value, turns};

/// All turns of a loop that is gone come to no more operations than these.
const MOST: usize = 256;
const MOST_TURNS: usize = 32;
/// Operations of a group.
const MOST_OF_GROUP: usize = 256;
const LARGEST_GROUP: usize = 16;
/// The code generator loads all that straight code reads before it computes: of more values than these it keeps some in the
/// frame. Where machines have [operands in memory](crate::schedule) it does not.
const MOST_READ: usize = 16;
const MOST_IN_MEMORY: usize = 64;
/// Operations of turns in one routine, so that its code grows by no more.
const MOST_IN_A_ROUTINE: usize = 4096;

/// How a loop is unrolled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unrolling {
    first: i128,
    step: i128,
    count: usize,
    /// As many turns one after the other.
    group: usize,
}

impl<'p> Function<'_, 'p> {
    pub(crate) fn unrolling(&mut self, it: &For) -> Option<Unrolling> {
        let is_wanted = self.module.aim == Aim::Speed;
        let is_plain = is_wanted && it.is_private && matches!(it.taking, Taking::Each) && !it.may_leave_range();
        let (first, step, count) = values(it).filter(|_| is_plain && !has_loop(it))?;
        let size = turns::size_of(&it.body).max(1);
        let most_read = if self.module.has_operands_in_memory { MOST_IN_MEMORY } else { MOST_READ };
        let group = group(count, size, (reads(it, &self.counters), most_read));
        let made = self.unrolled + group * size;
        if group < 2 && count > 1 || made > MOST_IN_A_ROUTINE {
            return None;
        }
        self.unrolled = made;
        Some(Unrolling { first, step, count, group })
    }

    /// The turns of a loop that has begun.
    pub(crate) fn turns_in_line(&mut self, running: &Running<'p>, it: Unrolling) -> Flow {
        let after = self.builder.create_block();
        let is_left = if it.group == it.count {
            self.all_in_line(running, it, after)
        } else {
            self.groups_in_line(running, it, after)
        };
        self.join(&[if is_left { Flow::Continues } else { Flow::Leaves }], after)
    }

    /// Whether control continues after it.
    fn all_in_line(&mut self, running: &Running<'p>, it: Unrolling, after: clif::Block) -> bool {
        let mut is_left = false;
        let mut value = it.first;
        for at in 0..it.count {
            self.set_fixed_counter(running, value, at > 0);
            value += it.step;
            if self.turn_in_line(&running.it.body, after, &mut is_left) == Flow::Leaves {
                return is_left;
            }
        }
        self.set_fixed_counter(running, value, true);
        self.ins().jump(after, &[]);
        true
    }

    fn groups_in_line(&mut self, running: &Running<'p>, it: Unrolling, after: clif::Block) -> bool {
        let head = self.builder.create_block();
        self.ins().jump(head, &[]);
        self.builder.switch_to_block(head);
        let start = self.counter_value(running);
        let (mut is_left, mut flow, mut further) = (false, Flow::Continues, 0);
        for at in 0..it.group {
            if at > 0 {
                self.set_further_counter(running, start, further);
            }
            further += it.step;
            flow = self.turn_in_line(&running.it.body, after, &mut is_left);
            if flow == Flow::Leaves {
                break;
            }
        }
        if flow == Flow::Continues {
            let end = self.set_further_counter(running, start, further);
            let last = self.last(running);
            let condition = if it.step > 0 { IntCC::SignedGreaterThan } else { IntCC::SignedLessThan };
            let is_past = self.ins().icmp(condition, end, last);
            let done = self.builder.create_block();
            self.ins().brif(is_past, done, &[], head, &[]);
            self.leads_back(it.group);
            self.go_on_in(done);
            self.set_end(running, running.end().expect("the loop's ends are constant"));
            self.ins().jump(after, &[]);
            is_left = true;
        }
        self.builder.seal_block(head);
        is_left
    }

    /// One turn; the next one begins where the code continues.
    pub(crate) fn turn_in_line(&mut self, body: &'p [Statement], after: clif::Block, is_left: &mut bool) -> Flow {
        self.release_temporaries();
        self.loops.push(LoopFrame { next: self.builder.create_block(), ..LoopFrame::to(after) });
        let flow = self.block(body);
        let frame = self.loops.pop().expect("pushed above");
        *is_left |= frame.is_left;
        if !frame.is_continued {
            return flow;
        }
        if flow == Flow::Continues {
            self.ins().jump(frame.next, &[]);
        }
        self.go_on_in(frame.next);
        Flow::Continues
    }

    pub(crate) fn set_fixed_counter(&mut self, running: &Running<'p>, value: i128, is_stored: bool) {
        let value = self.integer(types::I64, value);
        self.set_counter(running, value, is_stored);
    }

    pub(crate) fn set_further_counter(
        &mut self,
        running: &Running<'p>,
        start: clif::Value,
        further: i128,
    ) -> clif::Value {
        let further = self.integer(types::I64, further);
        let value = self.ins().iadd(start, further);
        self.set_counter(running, value, true);
        value
    }
}

/// How many turns are one after the other: all, or a number that divides theirs; 1 where it is not worth while.
fn group(count: usize, size: usize, (reads, most_read): (usize, usize)) -> usize {
    if count <= MOST_TURNS && count * size <= MOST && count * reads <= most_read {
        return count;
    }
    let fits = |it: &usize| count.is_multiple_of(*it) && it * size <= MOST_OF_GROUP && it * reads <= most_read;
    (2..=LARGEST_GROUP).rev().find(fits).unwrap_or(1)
}

/// The first value, the step, and how many there are; `None` where they are not constant, or none.
pub(crate) fn values(it: &For) -> Option<(i128, i128, usize)> {
    let [first, last] = [&it.first, &it.last].map(|it| it.as_const().and_then(Value::as_integer));
    let (first, last, Step::Constant(step)) = (first?, last?, &it.step) else { return None };
    // As signed numbers of 64 bits.
    let is_narrow = [first, last + step].iter().all(|it| i64::try_from(*it).is_ok());
    let is_past = if *step > 0 { first > last } else { first < last };
    let further = usize::try_from((last - first).checked_div(*step)?).ok()?;
    (is_narrow && !is_past).then_some((first, *step, further + 1))
}

/// How many values straight code of one turn reads; 0 where its branches part the turns.
fn reads(it: &For, around: &[&For]) -> usize {
    let (mut count, mut branches) = (0, false);
    visit::statements(&it.body, &mut |statement| {
        branches |= !matches!(statement.kind, StatementKind::Assign { .. });
        visit::accesses(statement, &mut |place, access| {
            let is_counter = place.is_same_variable(&it.counter) || running(around, place).is_some();
            let is_stored = !matches!(place.root, Root::Local(_)) && !is_counter;
            count += usize::from(is_stored && access == Access::Read);
        });
    });
    if branches { 0 } else { count }
}

fn has_loop(it: &For) -> bool {
    let mut found = false;
    visit::statements(&it.body, &mut |it| {
        found |= match &it.kind {
            // It is a look-up.
            StatementKind::For(inner) => shifted(inner).is_none(),
            kind => matches!(kind, StatementKind::Loop { .. }),
        };
    });
    found
}
