//! Machine instructions, as far as counting them needs: where they begin and end, and where control goes.

/// One instruction, from byte to byte of its function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Instruction {
    pub(crate) at: usize,
    pub(crate) end: usize,
    pub(crate) flow: Flow,
}

/// What comes after an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    Next,
    /// The next one, when the callee has returned.
    Call,
    Jump(usize),
    /// The target, or the next one.
    Branch(usize),
    /// A jump through the table that follows it.
    Table,
    /// A return or a trap.
    Ends,
}
