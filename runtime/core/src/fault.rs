//! Faults: what ends a scan, and where in the source.

use core::fmt;

/// Why a scan stopped. The discriminant is the low byte of what native code returns; 0 there
/// means that no fault happened.
#[repr(u8)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// An integer was divided by zero, by `/` or `MOD`.
    DivideByZero = 1,
    /// An array index, or the selector of `MUX`, is out of bounds.
    IndexOutOfRange = 2,
    /// A value does not fit the subrange of the variable it was assigned to.
    SubrangeViolated = 3,
    /// The step of a FOR loop is zero.
    ZeroStep = 4,
    /// The loops of a scan took more turns than its budget: one of them may be endless.
    LoopBudget = 5,
    /// A year, month, day or time of day is not valid, or out of range.
    NoSuchDate = 6,
    /// A null reference was followed.
    NullReference = 7,
    /// A reference was followed out of the object for which it was made.
    OutsideObject = 8,
    /// A WSTRING was read or written starting in the middle of a code unit.
    MisalignedReference = 9,
    /// The target of a reference may not be viewed as the requested type.
    ForbiddenView = 10,
    /// The condition of an ASSERT does not hold.
    AssertionFailed = 11,
    /// The called routine has no implementation here: it is outside Structured Text, or a library only declares it.
    NotImplemented = 12,
    /// The preset or the accumulated value of a Logix TIMER is negative while it times.
    NegativeTimer = 13,
    /// A reference was followed to an object that `__DELETE` has returned to its pool.
    Deleted = 14,
    /// The argument of `__DELETE` was not created by `__NEW`.
    NotOfPool = 15,
    /// The program raised an exception (TwinCAT's `F_RaiseException`).
    Raised = 16,
    /// A call through references came back to an instance whose METHOD had not returned yet.
    Recursion = 17,
    /// Four bits are not a decimal digit, or a number has more digits than a BCD number in S7 can hold.
    NotDecimal = 18,
}

impl FaultKind {
    pub const ALL: [Self; 18] = [
        Self::DivideByZero,
        Self::IndexOutOfRange,
        Self::SubrangeViolated,
        Self::ZeroStep,
        Self::LoopBudget,
        Self::NoSuchDate,
        Self::NullReference,
        Self::OutsideObject,
        Self::MisalignedReference,
        Self::ForbiddenView,
        Self::AssertionFailed,
        Self::NotImplemented,
        Self::NegativeTimer,
        Self::Deleted,
        Self::NotOfPool,
        Self::Raised,
        Self::Recursion,
        Self::NotDecimal,
    ];

    /// The fault with this code, as native code returns it.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == code)
    }

    /// What happened, in the words that the command prints.
    pub const fn text(self) -> &'static str {
        match self {
            Self::DivideByZero => "division by zero",
            Self::IndexOutOfRange => "index out of range",
            Self::SubrangeViolated => "value outside its subrange",
            Self::ZeroStep => "the step of a FOR loop is 0",
            Self::LoopBudget => "a loop went on past the scan's budget of turns",
            Self::NoSuchDate => "no such date or time of day",
            Self::NullReference => "a reference is null",
            Self::OutsideObject => "a reference points outside of its object",
            Self::MisalignedReference => "a reference is misaligned",
            Self::ForbiddenView => "a reference points to something of another type",
            Self::AssertionFailed => "an assertion does not hold",
            Self::NotImplemented => "what is called is not implemented here",
            Self::NegativeTimer => "the PRE or ACC of a TIMER is below 0",
            Self::Deleted => "a reference points to an object that was deleted",
            Self::NotOfPool => "`__DELETE` of an object that `__NEW` did not make",
            Self::Raised => "an exception was raised",
            Self::Recursion => "a METHOD was called again before it had ended",
            Self::NotDecimal => "not a BCD number with that many digits",
        }
    }

    /// Whether a program may handle it and continue (CODESYS' `__TRY`). It may not continue after an endless loop or recursion, as that
    /// would defeat the budget; nor after a failed test or a call of a routine that does not exist.
    pub const fn can_be_caught(self) -> bool {
        match self {
            Self::LoopBudget | Self::AssertionFailed | Self::NotImplemented | Self::Recursion => false,
            Self::DivideByZero
            | Self::IndexOutOfRange
            | Self::SubrangeViolated
            | Self::ZeroStep
            | Self::NoSuchDate
            | Self::NullReference
            | Self::OutsideObject
            | Self::MisalignedReference
            | Self::ForbiddenView
            | Self::NegativeTimer
            | Self::Deleted
            | Self::NotOfPool
            | Self::Raised
            | Self::NotDecimal => true,
        }
    }
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

/// A place in Structured Text: the file's number in the program, and 1-based line and column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Location {
    pub file: u16,
    pub column: u16,
    pub line: u32,
}

impl Location {
    /// The place of a fault that belongs to the caller: the call replaces it with its own place.
    pub const CALLER: Self = Self { file: 0, column: 0, line: 0 };
}

/// A fault and where in the source it happened: the only unexpected way out of a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    pub kind: FaultKind,
    pub at: Location,
}

impl Fault {
    /// The fault as native code returns it, never 0: from the low bit, 8 bits of kind, 16 of
    /// file, 16 of column, 24 of line. A line that needs more bits is saturated.
    pub const fn code(self) -> u64 {
        let line = if self.at.line > LINE_MAX { LINE_MAX } else { self.at.line };
        self.kind as u64 | (self.at.file as u64) << 8 | (self.at.column as u64) << 24 | (line as u64) << 40
    }

    /// The fault as a call passes it on: a fault of [the caller](Location::CALLER) gets the place of the call.
    #[must_use]
    pub const fn of_call(self, at: Location) -> Self {
        let is_callers = self.at.file == 0 && self.at.line == 0 && self.at.column == 0;
        if is_callers { Self { kind: self.kind, at } } else { self }
    }

    /// The number of its kind, for a program that handles the fault.
    ///
    /// # Errors
    /// The fault itself, if it [cannot be caught](FaultKind::can_be_caught).
    pub const fn caught(self) -> Result<u8, Self> {
        if self.kind.can_be_caught() { Ok(self.kind as u8) } else { Err(self) }
    }

    /// The fault with this code; `None` for 0, and for values that [`code`](Self::code) never returns.
    #[inline]
    pub fn from_code(code: u64) -> Option<Self> {
        let kind = FaultKind::from_code(code as u8)?;
        let at = Location { file: (code >> 8) as u16, column: (code >> 24) as u16, line: (code >> 40) as u32 };
        Some(Self { kind, at })
    }
}

impl Fault {
    /// The fault together with the names of its program's files, for display: `line.st:12:5: division by zero`.
    /// Generated Rust has them as `FILES`.
    ///
    /// ```
    /// use staunch_runtime::{Fault, FaultKind, Location};
    ///
    /// let fault = Fault { kind: FaultKind::DivideByZero, at: Location { file: 1, line: 12, column: 5 } };
    /// assert_eq!(fault.of(&["main.st", "line.st"]).to_string(), "line.st:12:5: division by zero");
    /// ```
    pub const fn of<'f>(self, files: &'f [&'f str]) -> FaultOf<'f> {
        FaultOf { fault: self, files }
    }
}

/// A fault of a program with these files; a file number out of range is displayed as `?`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultOf<'f> {
    pub fault: Fault,
    pub files: &'f [&'f str],
}

impl fmt::Display for FaultOf<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { kind, at } = self.fault;
        let file = self.files.get(usize::from(at.file)).unwrap_or(&"?");
        write!(f, "{file}:{}:{}: {kind}", at.line, at.column)
    }
}

impl core::error::Error for FaultOf<'_> {}

/// The greatest line that a fault's code can carry.
const LINE_MAX: u32 = 0xFF_FFFF;

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at line {}, column {}", self.kind, self.at.line, self.at.column)
    }
}

impl core::error::Error for Fault {}

/// Adds the place in the source to the bare [`FaultKind`] of an operation, and to a fault of a call that has no place yet.
pub trait OrFault<T> {
    /// `file` is the file's number in the program; `line` and `column` count from 1.
    fn at(self, file: u16, line: u32, column: u16) -> Result<T, Fault>;
}

impl<T> OrFault<T> for Result<T, FaultKind> {
    #[inline]
    fn at(self, file: u16, line: u32, column: u16) -> Result<T, Fault> {
        match self {
            Ok(value) => Ok(value),
            Err(kind) => Err(Fault { kind, at: Location { file, column, line } }),
        }
    }
}

impl<T> OrFault<T> for Result<T, Fault> {
    #[inline]
    fn at(self, file: u16, line: u32, column: u16) -> Result<T, Fault> {
        match self {
            Ok(value) => Ok(value),
            Err(fault) => Err(fault.of_call(Location { file, column, line })),
        }
    }
}

/// The result of an operation: a value, or a value unless it faults.
pub trait Outcome {
    type Value;
    fn outcome(self) -> Result<Self::Value, FaultKind>;
}

impl<T> Outcome for Result<T, FaultKind> {
    type Value = T;
    fn outcome(self) -> Self {
        self
    }
}

impl<T: crate::Scalar> Outcome for T {
    type Value = T;
    fn outcome(self) -> Result<T, FaultKind> {
        Ok(self)
    }
}
