//! Turns of a FOR are in the lanes of vectors.
//!
//! ```text
//! FOR j := 0 TO 15 DO               FOR j := 0 TO 15 BY 2 DO
//!     s := 0.0;                         s := [0.0, 0.0];
//!     FOR k := 0 TO 2 DO                s := s + [a[i, 0], a[i, 0]] * b[0, j .. j + 1];
//!         s := s + a[i, k] * b[k, j];   …
//!     END_FOR                           s := s + [a[i, 2], a[i, 2]] * b[2, j .. j + 1];
//!     c[i, j] := s;                     c[i, j .. j + 1] := s;
//! END_FOR                           END_FOR
//! ```
//!
//! It applies on x86-64 to loops of a constant number of turns, which the lanes divide, whose bodies are assignments of reals of one type, made of
//! sums, differences, products and quotients, and FOR loops of constant turns of such. A real that is read is the element at the counter, at
//! some constant distance, or the same in all turns, or a variable that the turn has assigned before. What a turn stores no other reads or
//! writes: the last index of what is stored names no counter of a loop within. So each lane computes what its turn does, in its order. Nothing
//! in the loop faults, and nobody sees its variables while it runs. It may not assume that an element is at a multiple of the vector's size.

mod body;

use crate::address::Address;
use crate::control::Running;
use crate::function::{Flow, Function};
use crate::place::PlaceValue;
use crate::target::Aim;
use crate::unrolled::values;
use body::Body;
use cranelift_codegen::ir::{self as clif, InstBuilder, MemFlagsData, condcodes::IntCC, types};
use staunch_ir::alias::Frame;
use staunch_ir::loops::Known;
use staunch_ir::{Expr, ExprKind, For, LocalId, Location, Op, Place, Repr, Statement, StatementKind, Taking};

/// The type of the lanes, and the counter whose turns they are.
type Of<'p> = (clif::Type, &'p Place);

/// A variable, and what it is in the lanes.
type Lane<'p> = (&'p Place, clif::Value);

impl<'p> Function<'_, 'p> {
    /// The loop, whose counter has begun, in lanes, if it can be.
    pub(crate) fn in_lanes(&mut self, of: &Running<'p>) -> Option<Flow> {
        let it = of.it;
        let is_plain = it.is_private && matches!(it.taking, Taking::Each) && !it.may_leave_range();
        let is_wanted = self.module.aim == Aim::Speed && self.module.has_operands_in_memory && self.noted.is_none();
        let (_, step, count) = values(it).filter(|_| is_plain && is_wanted && !self.module.handles_faults)?;
        let body = self.body_in_lanes(it).filter(|_| step == 1)?;
        let frame = Frame::of(self.module.program, self.routine);
        let (ty, lanes) = match body.repr? {
            Repr::F64 => (types::F64X2, 2),
            Repr::F32 => (types::F32X4, 4),
            _ => return None,
        };
        let fits = count.is_multiple_of(lanes) && body.is_separate(&frame);
        fits.then(|| self.groups_in_lanes(of, (ty, lanes), count, &body))
    }

    fn body_in_lanes(&self, it: &'p For) -> Option<Body<'p>> {
        let checked = |id: LocalId| self.checked[id.index()];
        let known = Known { program: self.module.program, loops: &self.counters, checked: &checked, seen: &[] };
        Body::of(it, &self.counters, self.routine, known)
    }

    fn groups_in_lanes(
        &mut self,
        of: &Running<'p>,
        (ty, lanes): (clif::Type, usize),
        count: usize,
        body: &Body<'p>,
    ) -> Flow {
        let head = self.builder.create_block();
        self.ins().jump(head, &[]);
        self.builder.switch_to_block(head);
        let start = self.counter_value(of);
        let vectors = body.vectors(count / lanes);
        let mut known: Vec<Lane<'p>> = Vec::new();
        let (mut end, mut further) = (start, 0);
        for _ in 0..vectors {
            self.lane_statements(&of.it.body, (ty, &of.it.counter), &mut known);
            further += i128::try_from(lanes).expect("a few lanes");
            end = self.set_further_counter(of, start, further);
        }
        let last = self.last(of);
        let is_past = self.ins().icmp(IntCC::SignedGreaterThan, end, last);
        let done = self.builder.create_block();
        self.ins().brif(is_past, done, &[], head, &[]);
        self.leads_back(lanes * vectors);
        self.builder.seal_block(head);
        self.go_on_in(done);
        self.set_end(of, of.end().expect("the loop's ends are constant"));
        let last = u8::try_from(lanes - 1).expect("a few lanes");
        for variable in &body.variables {
            let lane = known.iter().rev().find(|it| it.0.is_same_variable(variable)).expect("each turn assigns it").1;
            let value = self.ins().extractlane(lane, last);
            match self.place_value(variable) {
                PlaceValue::Variable(variable) => self.builder.def_var(variable, value),
                PlaceValue::Memory(address) => self.store(value, address),
            }
        }
        Flow::Continues
    }

    fn lane_statements(&mut self, body: &'p [Statement], of: Of<'p>, known: &mut Vec<Lane<'p>>) {
        for statement in body {
            if let StatementKind::For(inner) = &statement.kind {
                self.lanes_of_turns(inner, statement.at, of, known);
                continue;
            }
            let StatementKind::Assign { target, value } = &statement.kind else {
                unreachable!("a body that was looked at");
            };
            let value = self.lanes_of(value, of, known);
            if is_element(target) {
                let address = self.address(target);
                let flags = self.writing(address);
                self.ins().store(anywhere(flags), value, address.base, address.displacement());
            } else {
                known.retain(|it| !it.0.is_same_variable(target));
                known.push((target, value));
            }
        }
    }

    fn lanes_of_turns(&mut self, inner: &'p For, at: Location, of: Of<'p>, known: &mut Vec<Lane<'p>>) {
        let running = self.start_for(inner, at);
        let (first, step, count) = values(inner).expect("a loop that was looked at");
        self.counters.push(inner);
        self.registers.push(running.register.expect("a private counter"));
        let mut value = first;
        for turn in 0..count {
            self.set_fixed_counter(&running, value, turn > 0);
            self.lane_statements(&inner.body, of, known);
            value += step;
        }
        self.set_fixed_counter(&running, value, true);
        self.registers.pop();
        self.counters.pop();
        self.set_late(&running);
    }

    fn lanes_of(&mut self, expr: &'p Expr, of: Of<'p>, known: &[Lane<'p>]) -> clif::Value {
        if let ExprKind::Apply(op, operands) = &expr.kind {
            let [a, b] = [&operands[0], &operands[1]].map(|it| self.lanes_of(it, of, known));
            return match op {
                Op::Add => self.ins().fadd(a, b),
                Op::Sub => self.ins().fsub(a, b),
                Op::Mul => self.ins().fmul(a, b),
                Op::Div => self.ins().fdiv(a, b),
                _ => unreachable!("a body that was looked at"),
            };
        }
        if let ExprKind::Load(place) = &expr.kind {
            if let Some((_, value)) = known.iter().find(|it| it.0.is_same_variable(place)) {
                return *value;
            }
            if body::follows(place, of.1) {
                let address = self.address(place);
                return self.load_lanes(of.0, address);
            }
        }
        let value = self.scalar(expr);
        self.ins().splat(of.0, value)
    }

    fn load_lanes(&mut self, ty: clif::Type, address: Address) -> clif::Value {
        let flags = self.reading(address);
        self.ins().load(ty, anywhere(flags), address.base, address.displacement())
    }
}

/// A real number that lies anywhere, with the class of its flags.
fn anywhere(flags: MemFlagsData) -> MemFlagsData {
    MemFlagsData::new().with_notrap().with_alias_region(flags.alias_region())
}

fn is_element(place: &Place) -> bool {
    place.indices().next().is_some()
}
