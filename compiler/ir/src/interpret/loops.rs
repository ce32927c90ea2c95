//! Loops, and the turns that they take of the scan.

use super::execute::{Flow, integer};
use super::{Frame, Interpreter, Stop, Watch};
use crate::evaluate::scalar;
use crate::{Count, For, Location, Place, Statement, Step, Taking, Value};
use staunch_runtime::{Context, Fault, FaultKind, ops};

impl<'p, W: Watch> Interpreter<'p, W> {
    pub(super) fn turns(
        &mut self,
        frame: &Frame,
        body: &'p [Statement],
        continuing: &'p [Statement],
        count: Option<&'p Count>,
        cx: &Context,
    ) -> Result<Flow, Stop> {
        let Some(count) = count else { return self.turns_one_by_one(frame, body, continuing, cx) };
        let (_, first) = self.counter(frame, &count.counter)?;
        let bound = integer(scalar(&self.scope(frame), &count.bound)?);
        let few = take(
            count.taking,
            &Way { first: integer(first), last: bound, step: count.step, is_before: count.offset != 0 },
            cx,
        )?;
        let before = std::mem::replace(&mut self.has_few_turns, few);
        let flow = self.turns_one_by_one(frame, body, continuing, cx);
        self.has_few_turns = before;
        flow
    }

    fn turns_one_by_one(
        &mut self,
        frame: &Frame,
        body: &'p [Statement],
        continuing: &'p [Statement],
        cx: &Context,
    ) -> Result<Flow, Stop> {
        loop {
            self.step()?;
            for block in [body, continuing] {
                match self.block(frame, block, cx)? {
                    Flow::Next | Flow::Continue => {}
                    Flow::Exit => return Ok(Flow::Next),
                    Flow::Return => return Ok(Flow::Return),
                }
            }
        }
    }

    pub(super) fn for_loop(&mut self, frame: &Frame, it: &'p For, at: Location, cx: &Context) -> Result<Flow, Stop> {
        self.assign(frame, &it.counter, &it.first)?;
        let last = scalar(&self.scope(frame), &it.last)?;
        let step = match &it.step {
            Step::Constant(step) => *step,
            Step::Variable(step) => integer(scalar(&self.scope(frame), step)?),
        };
        if step == 0 {
            return Err(Fault { kind: FaultKind::ZeroStep, at: it.step_at }.into());
        }
        let (_, first) = self.counter(frame, &it.counter)?;
        let way = Way { first: integer(first), last: integer(last), step, is_before: false };
        let few = take(it.taking, &way, cx)?;
        let before = std::mem::replace(&mut self.has_few_turns, few);
        let flow = self.for_turns(frame, it, (last, step, at), cx);
        self.has_few_turns = before;
        flow
    }

    fn for_turns(
        &mut self,
        frame: &Frame,
        it: &'p For,
        (last, step, at): (Value, i128, Location),
        cx: &Context,
    ) -> Result<Flow, Stop> {
        loop {
            self.step()?;
            let (_, value) = self.counter(frame, &it.counter)?;
            let (value, last_turn) = (integer(value), integer(last));
            if if step > 0 { value > last_turn } else { value < last_turn } {
                return Ok(Flow::Next);
            }
            match self.block(frame, &it.body, cx)? {
                Flow::Next | Flow::Continue => {}
                Flow::Exit => return Ok(Flow::Next),
                Flow::Return => return Ok(Flow::Return),
            }
            let (offset, value) = self.counter(frame, &it.counter)?;
            match ops::step_value(value, step, last, it.range).map_err(|kind| Fault { kind, at })? {
                Some(next) => next.write(&mut self.memory[offset..]),
                None => return Ok(Flow::Next),
            }
        }
    }

    /// Where a loop's counter is, and its value.
    fn counter(&self, frame: &Frame, counter: &Place) -> Result<(usize, Value), Fault> {
        let offset = self.resolve(frame, counter)?;
        let repr = self.program.repr(counter.ty).expect("verified IR: an integer counter");
        Ok((offset, Value::read(repr, &self.memory[offset..])))
    }
}

/// The values that a loop's counter has.
struct Way {
    first: i128,
    last: i128,
    step: i128,
    /// Whether `last` is none of them.
    is_before: bool,
}

/// What a loop takes before its first turn. Whether its turns take none.
fn take(taking: Taking, way: &Way, cx: &Context) -> Result<bool, Fault> {
    // Two's complement of 64 bits holds either; where both are positive, as an unsigned number too.
    let few = match (u64::try_from(way.first), u64::try_from(way.last)) {
        (Ok(first), Ok(last)) => take_of(taking, first, last, way, cx)?,
        _ => take_of(taking, signed(way.first), signed(way.last), way, cx)?,
    };
    Ok(few && taking == Taking::EachOfMany)
}

fn take_of<T: ops::Integer>(taking: Taking, first: T, last: T, way: &Way, cx: &Context) -> Result<bool, Fault> {
    let few = if way.is_before {
        Context::has_few_turns_before(first, last, way.step)
    } else {
        Context::has_few_turns(first, last, way.step)
    };
    let (Taking::Ahead(at) | Taking::AheadOfMany(at)) = taking else { return Ok(few) };
    if taking.is_of_many() && few {
        return Ok(true);
    }
    let taken =
        if way.is_before { cx.take_turns_before(first, last, way.step) } else { cx.take_turns(first, last, way.step) };
    taken.map_err(|kind| Fault { kind, at })?;
    Ok(few)
}

fn signed(value: i128) -> i64 {
    i64::try_from(value).expect("verified IR: a counter of 64 bits")
}
