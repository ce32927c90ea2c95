use crate::{Expr, FaultKind, Location, Place, PouId};

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
    /// an integer, bit string or enumeration; labels do not overlap.
    Case {
        selector: Expr,
        arms: Vec<Arm>,
        otherwise: Block,
    },
    /// Runs `body` and then `continuing`, forever. `Exit` leaves it; `Continue` goes on with
    /// `continuing`, which itself holds `Exit` but no `Continue`.
    Loop {
        body: Block,
        continuing: Block,
    },
    /// Leaves the innermost loop.
    Exit,
    /// Goes on with the innermost loop's `continuing`.
    Continue,
    /// Leaves the POU.
    Return,
    /// Calls a user's POU. A FUNCTION_BLOCK's inputs have been assigned to its instance before;
    /// `arguments` holds its VAR_IN_OUTs. A FUNCTION's `arguments` are its parameters, in
    /// declaration order. Places and values are evaluated left to right, before the call.
    Call {
        callee: PouId,
        /// The instance, for a FUNCTION_BLOCK.
        instance: Option<Place>,
        arguments: Vec<Argument>,
        /// Where a FUNCTION's result goes: a local of the result's type.
        result: Option<Place>,
    },
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
    /// Runs the prescan of a user's FUNCTION_BLOCK instance; its body has none of its in-outs.
    PrescanInstance {
        callee: PouId,
        instance: Place,
    },
    /// Stops the scan.
    Fault(FaultKind),
}

#[derive(Clone, Debug)]
pub enum Argument {
    /// For a parameter that is passed by value.
    Value(Expr),
    /// For a parameter that is passed by reference; of exactly the parameter's type.
    Reference(Place),
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
    /// The statements inside, in the order in which they stand.
    pub fn blocks(&self) -> Vec<&Block> {
        match self {
            Self::If { condition: _, then, otherwise } => vec![then, otherwise],
            Self::Case { selector: _, arms, otherwise } => {
                arms.iter().map(|arm| &arm.body).chain([otherwise]).collect()
            }
            Self::Loop { body, continuing } => vec![body, continuing],
            Self::Assign { .. }
            | Self::Exit
            | Self::Continue
            | Self::Return
            | Self::Call { .. }
            | Self::CallBlock { .. }
            | Self::PrescanBlock { .. }
            | Self::PrescanInstance { .. }
            | Self::Fault(_) => Vec::new(),
        }
    }

    pub fn blocks_mut(&mut self) -> Vec<&mut Block> {
        match self {
            Self::If { condition: _, then, otherwise } => vec![then, otherwise],
            Self::Case { selector: _, arms, otherwise } => {
                arms.iter_mut().map(|arm| &mut arm.body).chain([otherwise]).collect()
            }
            Self::Loop { body, continuing } => vec![body, continuing],
            Self::Assign { .. }
            | Self::Exit
            | Self::Continue
            | Self::Return
            | Self::Call { .. }
            | Self::CallBlock { .. }
            | Self::PrescanBlock { .. }
            | Self::PrescanInstance { .. }
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
