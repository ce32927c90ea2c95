//! Statements, and what each of them means.

use crate::interval::Range;
use crate::limits::limits;
use crate::stop::Stop;
use crate::{Expr, ExternalCall, FaultKind, Location, Place, RoutineId};
use staunch_runtime::Context;

pub type Block = Vec<Statement>;

#[derive(Clone, Debug)]
pub struct Statement {
    pub kind: StatementKind,
    pub at: Location,
}

#[derive(Clone, Debug)]
pub enum StatementKind {
    /// Indices in `target` are evaluated before `value`; both have one type.
    Assign {
        target: Place,
        value: Expr,
    },
    If {
        condition: Expr,
        then: Block,
        otherwise: Block,
    },
    /// The first arm with a label that holds `selector` runs, else `otherwise`. The selector is
    /// an integer, bit string or enumeration. Labels do not overlap: the front end cuts them.
    Case {
        selector: Expr,
        arms: Vec<Arm>,
        otherwise: Block,
    },
    /// WHILE and REPEAT: runs `body` and then `continuing`, forever. `Exit` leaves it; `Continue`
    /// continues with `continuing`, which itself holds `Exit` but no `Continue`. Each turn takes one
    /// of the scan's turns: `body` holds a `Turn` outside of inner blocks, unless each turn
    /// [divides](crate::turns::divides) what the loop ends for, or `count` has taken all of them.
    Loop {
        body: Block,
        continuing: Block,
        count: Option<Box<Count>>,
    },
    For(Box<For>),
    /// Runs `body`. A fault in it [that can be caught](FaultKind::can_be_caught) ends it there: `kind`, a local of type USINT, is
    /// given the number of the fault's kind, and `handler` runs.
    Try {
        body: Block,
        kind: Place,
        handler: Block,
    },
    /// Runs `body`, which control leaves at its end or by a fault; then `last` in either case: assignments that cannot fault. Only
    /// [`promote`](mod@crate::promote) makes it.
    Finally {
        body: Block,
        last: Block,
    },
    /// Takes one of the turns that the loops of a scan have; faults when none is left.
    Turn,
    /// Leaves the innermost loop.
    Exit,
    /// Goes on with the innermost loop's `continuing`.
    Continue,
    /// Leaves the routine.
    Return,
    /// Calls a routine. A FUNCTION_BLOCK's inputs have been assigned to its instance before;
    /// `arguments` holds its VAR_IN_OUTs. A FUNCTION's `arguments` are its parameters, in
    /// declaration order. Places and values are evaluated left to right, before the call.
    Call {
        callee: RoutineId,
        /// The instance, for a body or prescan.
        instance: Option<Place>,
        arguments: Vec<Argument>,
        /// Where a FUNCTION's result goes: a local of the result's type.
        result: Option<Place>,
    },
    /// Calls what is implemented outside of the program.
    External(Box<ExternalCall>),
    /// Runs an instruction of a standard block. `inputs` are evaluated left to right; then they
    /// become the block's input pins, in order (or the instruction's rung condition).
    CallBlock {
        block: Place,
        /// Index into the block's instructions: 0 for a function block.
        instruction: usize,
        inputs: Vec<Expr>,
    },
    /// Runs the prescan of a standard block's instruction (Logix).
    PrescanBlock {
        block: Place,
        instruction: usize,
    },
    /// Where a run under a debugger can stop. Other executors do nothing here.
    Stop(Box<Stop>),
    /// Ends the scan.
    Fault(FaultKind),
}

/// A FOR loop goes by its variable: `counter` is given `first`, then `last` and `step` are evaluated,
/// once. Before each turn the counter is compared with `last`; after it, it is stepped. What a body,
/// a callee or an alias writes to the counter, the loop continues from.
///
/// A step out of the counter's `range` ends the loop, with the counter as it is, if it is past `last`;
/// else it faults with SubrangeViolated. A variable step of 0 faults with ZeroStep before the first turn.
#[derive(Clone, Debug)]
pub struct For {
    /// An integer, bit string or enumeration; its indices do not change while the loop runs.
    pub counter: Place,
    /// Of the counter's type, and within `range`.
    pub first: Expr,
    /// Of the counter's type; of its base, where that is an enumeration.
    pub last: Expr,
    pub step: Step,
    /// The values that the counter may take: those of its type, or of its subrange.
    pub range: (i128, i128),
    /// Nothing but the loop itself writes the counter while the loop runs.
    pub is_private: bool,
    /// Begins with a `Turn`, unless the loop [is short](For::is_short), or has taken its turns before.
    pub body: Block,
    /// By [`taking::settle`](crate::taking::settle), which comes after all else that changes loops.
    pub taking: Taking,
    /// Where the step is written, for its faults.
    pub step_at: Location,
}

/// When a loop takes turns of the scan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Taking {
    /// Each by the `Turn` in the body.
    #[default]
    Each,
    /// So too; but none, where the loop has [few](staunch_runtime::Context::FREE_TURNS) when it starts.
    EachOfMany,
    /// All before the first turn, with a fault at this place where they do not suffice. The body has no `Turn`.
    Ahead(Location),
    /// So too; but none, where the loop has few.
    AheadOfMany(Location),
}

impl Taking {
    pub fn is_ahead(self) -> bool {
        match self {
            Self::Each | Self::EachOfMany => false,
            Self::Ahead(_) | Self::AheadOfMany(_) => true,
        }
    }

    /// Whether a loop that has few turns takes none.
    pub fn is_of_many(self) -> bool {
        match self {
            Self::Each | Self::Ahead(_) => false,
            Self::EachOfMany | Self::AheadOfMany(_) => true,
        }
    }
}

/// How many turns a WHILE loop has at most, when it starts: those in which `counter` goes by `step` to `bound + offset`.
#[derive(Clone, Debug)]
pub struct Count {
    pub counter: Place,
    pub step: i128,
    /// Of the counter's type.
    pub bound: Expr,
    /// 0; or -1 or 1 where the loop continues while the counter is below or above its bound.
    pub offset: i128,
    pub taking: Taking,
}

/// By how much a FOR loop's counter changes.
#[derive(Clone, Debug)]
pub enum Step {
    /// Not 0, and no further than from 0 to the greatest value of the counter's type.
    Constant(i128),
    /// Of the type of `last`.
    Variable(Expr),
}

impl For {
    /// What the counter may be in the body, as far as constants and the capacities of strings say it. It holds for
    /// a private counter.
    pub fn bounds(&self) -> Range {
        let [first, last] = [&self.first, &self.last].map(|it| limits(it).unwrap_or(self.range));
        match self.step {
            Step::Constant(step) if step > 0 => (first.0, last.1),
            Step::Constant(_) => (last.0, first.1),
            Step::Variable(_) => self.range,
        }
    }

    /// Whether a step may lead out of the counter's range.
    pub fn may_leave_range(&self) -> bool {
        match (&self.step, limits(&self.last)) {
            (Step::Constant(step), Some((least, most))) if self.is_private => {
                let furthest = if *step > 0 { most } else { least };
                !(self.range.0..=self.range.1).contains(&(furthest + step))
            }
            (Step::Constant(_) | Step::Variable(_), _) => true,
        }
    }

    /// Whether a step may fault, where `whole` are the values of the counter's elementary type: a
    /// step out of those is always past `last`.
    pub fn step_may_fault(&self, whole: Option<(i128, i128)>) -> bool {
        let zero = matches!(self.step, Step::Variable(_));
        zero || self.may_leave_range() && whole != Some(self.range)
    }

    /// A loop over LINTs, `first` to `last`, whose body does not write the counter.
    pub fn over(counter: Place, first: Expr, last: Expr, body: Block, at: Location) -> Statement {
        let range = (i64::MIN.into(), i64::MAX.into());
        let is_private = true;
        let taking = Taking::default();
        Self { counter, first, last, step: Step::Constant(1), range, is_private, body, taking, step_at: at }
            .statement(at)
    }

    /// The loop, whose body takes a turn first where it has to.
    pub fn statement(mut self, at: Location) -> Statement {
        if !self.is_short() {
            self.body.insert(0, Statement::new(StatementKind::Turn, at));
        }
        Statement::new(StatementKind::For(Box::new(self)), at)
    }

    /// Whether the loop takes turns of the scan for its own.
    pub fn takes_turns(&self) -> bool {
        self.taking.is_ahead() || self.body.first().is_some_and(|it| matches!(it.kind, StatementKind::Turn))
    }

    /// Whether its [bounds](For::bounds) show that the loop ends after few turns, together with those of the loops in it. What
    /// it calls may have loops of its own, so that a loop with a call is not short.
    pub fn is_short(&self) -> bool {
        self.turns().is_some_and(|it| it < most_free()) && self.free_turns().is_some_and(|it| it <= most_free())
    }

    /// Its turns less one, at most.
    fn turns(&self) -> Option<i128> {
        let Step::Constant(step) = self.step else { return None };
        let (least, most) = self.bounds();
        self.is_private.then_some((most - least) / step.abs())
    }

    /// Turns that this and the loops in it may have without taking any; `None` where they are not known.
    fn free_turns(&self) -> Option<i128> {
        let own = self.turns()?.max(0).checked_add(1)?;
        own.checked_mul(free_turns(&self.body)?.max(1))
    }
}

/// Turns that a loop may have without taking any of the scan's.
fn most_free() -> i128 {
    Context::FREE_TURNS.into()
}

/// Of all loops in a block that take none of the scan's turns; `None` where a call is in it.
fn free_turns(block: &[Statement]) -> Option<i128> {
    let mut sum = 0_i128;
    for statement in block {
        let own = match &statement.kind {
            StatementKind::Call { .. } => return None,
            // A loop that takes turns has what is in it counted, and takes none itself where it has few.
            StatementKind::For(it) if it.takes_turns() => most_free(),
            StatementKind::For(it) => it.free_turns()?,
            StatementKind::Loop { .. } => most_free(),
            kind => {
                let inner: Option<Vec<i128>> = kind.blocks().into_iter().map(|it| free_turns(it)).collect();
                inner?.into_iter().sum()
            }
        };
        sum = sum.checked_add(own)?;
    }
    Some(sum)
}

#[derive(Clone, Debug)]
pub enum Argument {
    /// For a parameter that is passed by value.
    Value(Expr),
    /// For a parameter that is passed by reference; of exactly the parameter's type.
    Reference(Place),
}

impl Argument {
    /// What is passed by value.
    pub fn value(&self) -> Option<&Expr> {
        match self {
            Self::Value(value) => Some(value),
            Self::Reference(_) => None,
        }
    }

    /// What is passed by reference.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Value(_) => None,
            Self::Reference(place) => Some(place),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Arm {
    /// Inclusive ranges of the selector's numeric value; a single label is a range of one.
    pub labels: Vec<(i128, i128)>,
    pub body: Block,
}

/// A program of a million lines has about as many of each.
#[cfg(target_pointer_width = "64")]
const _: () = {
    assert!(size_of::<Statement>() <= 120);
    assert!(size_of::<Expr>() <= 56);
};

impl StatementKind {
    /// The statements inside, in the order in which they are.
    pub fn blocks(&self) -> Vec<&Block> {
        match self {
            Self::If { condition: _, then, otherwise } => vec![then, otherwise],
            Self::Case { selector: _, arms, otherwise } => {
                arms.iter().map(|arm| &arm.body).chain([otherwise]).collect()
            }
            Self::Loop { body, continuing, count: _ } => vec![body, continuing],
            Self::For(it) => vec![&it.body],
            Self::Try { body, kind: _, handler } => vec![body, handler],
            Self::Finally { body, last } => vec![body, last],
            Self::Assign { .. }
            | Self::Turn
            | Self::Exit
            | Self::Continue
            | Self::Return
            | Self::Call { .. }
            | Self::External(_)
            | Self::CallBlock { .. }
            | Self::PrescanBlock { .. }
            | Self::Stop(_)
            | Self::Fault(_) => Vec::new(),
        }
    }

    pub fn blocks_mut(&mut self) -> Vec<&mut Block> {
        match self {
            Self::If { condition: _, then, otherwise } => vec![then, otherwise],
            Self::Case { selector: _, arms, otherwise } => {
                arms.iter_mut().map(|arm| &mut arm.body).chain([otherwise]).collect()
            }
            Self::Loop { body, continuing, count: _ } => vec![body, continuing],
            Self::For(it) => vec![&mut it.body],
            Self::Try { body, kind: _, handler } => vec![body, handler],
            Self::Finally { body, last } => vec![body, last],
            Self::Assign { .. }
            | Self::Turn
            | Self::Exit
            | Self::Continue
            | Self::Return
            | Self::Call { .. }
            | Self::External(_)
            | Self::CallBlock { .. }
            | Self::PrescanBlock { .. }
            | Self::Stop(_)
            | Self::Fault(_) => Vec::new(),
        }
    }
}

impl Statement {
    pub fn new(kind: StatementKind, at: Location) -> Self {
        Self { kind, at }
    }

    pub fn assign(target: Place, value: Expr, at: Location) -> Self {
        Self::new(StatementKind::Assign { target, value }, at)
    }
}
