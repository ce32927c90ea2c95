//! FOR loops of a few turns, whose number and counter's values are constant, are their turns one after the other.
//!
//! ```text
//! FOR i := 0 TO 2 DO                s := s + a[0];
//!     s := s + a[i];                s := s + a[1];
//! END_FOR                           s := s + a[2];
//!                                   i := 3;
//! ```
//!
//! It applies to a loop whose first and last value are constants, whose counter nothing else writes, and whose turns come to
//! few operations in all; in it there is no other loop. The counter has its value of each turn wherever it can be seen: in its
//! storage, if a fault may show it or a callee may read it, and after EXIT. Turns that the body takes of the loop budget stay.

use crate::control::Running;
use crate::function::{Flow, Function, LoopFrame};
use cranelift_codegen::ir::{InstBuilder, types};
use staunch_ir::{For, StatementKind, Step, Taking, Value, turns, visit};

/// All turns come to no more operations than these.
const MOST: usize = 512;
const MOST_TURNS: usize = 32;
/// Operations of turns in one routine, so that its code grows by no more.
const MOST_IN_A_ROUTINE: usize = 4096;

impl<'p> Function<'_, 'p> {
    /// The values that the counter has in the turns of a loop that is unrolled.
    pub(crate) fn fixed_turns(&mut self, it: &For) -> Option<Vec<i128>> {
        let is_plain = it.is_private && matches!(it.taking, Taking::Each) && !it.may_leave_range();
        let values = values(it).filter(|_| is_plain && !has_loop(it))?;
        let size = values.len() * turns::size_of(&it.body).max(1);
        let made = self.unrolled + size;
        if size > MOST || made > MOST_IN_A_ROUTINE {
            return None;
        }
        self.unrolled = made;
        Some(values)
    }

    /// The turns of a loop that has begun, for these values of its counter.
    pub(crate) fn turns_in_line(&mut self, running: &Running<'p>, values: &[i128]) -> Flow {
        let after = self.builder.create_block();
        let (mut is_left, mut flow) = (false, Flow::Continues);
        for (at, value) in values.iter().enumerate() {
            self.release_temporaries();
            self.set_fixed_counter(running, *value, at > 0);
            self.loops.push(LoopFrame { next: self.builder.create_block(), ..LoopFrame::to(after) });
            flow = self.block(&running.it.body);
            let frame = self.loops.pop().expect("pushed above");
            is_left |= frame.is_left;
            if frame.is_continued {
                if flow == Flow::Continues {
                    self.ins().jump(frame.next, &[]);
                }
                self.go_on_in(frame.next);
                flow = Flow::Continues;
            }
            if flow == Flow::Leaves {
                break;
            }
        }
        if let (Flow::Continues, Step::Constant(step), Some(last)) = (flow, &running.it.step, values.last()) {
            self.set_fixed_counter(running, last + step, true);
            self.ins().jump(after, &[]);
            is_left = true;
        }
        self.join(&[if is_left { Flow::Continues } else { Flow::Leaves }], after)
    }

    fn set_fixed_counter(&mut self, running: &Running<'p>, value: i128, is_stored: bool) {
        let value = self.integer(types::I64, value);
        self.set_counter(running, value, is_stored);
    }
}

/// `None` where they are not constant, none or many.
fn values(it: &For) -> Option<Vec<i128>> {
    let [first, last] = [&it.first, &it.last].map(|it| it.as_const().and_then(Value::as_integer));
    let (first, last, Step::Constant(step)) = (first?, last?, &it.step) else { return None };
    let further = (last - first).checked_div(*step).filter(|it| (0..128).contains(it))?;
    let is_past = if *step > 0 { first > last } else { first < last };
    let count = usize::try_from(further).ok()? + 1;
    let values = || (0..=further).map(|turn| first + turn * step).collect();
    (!is_past && count <= MOST_TURNS).then(values)
}

fn has_loop(it: &For) -> bool {
    let mut found = false;
    visit::statements(&it.body, &mut |it| {
        found |= matches!(it.kind, StatementKind::For(_) | StatementKind::Loop { .. });
    });
    found
}
