//! The facts about a function block other than its code: pins, instructions, prescan, retention.

use crate::{Context, Elementary, Family, Repr, Scalar, Time, Value};

/// The direction of a member of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Written by the caller, in declaration order when arguments are positional.
    Input,
    /// Read by the caller after a call.
    Output,
    /// Edge and timer memory, which is part of an instance but not visible to a caller.
    Memory,
    /// Read and written by anyone: a member of a structure that instructions share (Logix).
    Member,
}

/// One member of a standard function block, as the compiler sees it.
#[derive(Clone, Copy, Debug)]
pub struct Pin {
    /// The vendor's spelling.
    pub name: &'static str,
    /// The Rust field.
    pub field: &'static str,
    pub direction: Direction,
    pub role: Option<PinRole>,
    pub ty: Elementary,
    /// TRUE for a BOOL whose initial value the vendor gives as TRUE. The all-zero start state
    /// cannot express this, so the compiler puts TRUE into the instance's initial value.
    pub starts_true: bool,
    pub offset: usize,
}

/// The role of a pin, whatever a system calls it: the same for its counterparts in other systems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PinRole {
    /// Counts up; in a structure that instructions share, the rung that did.
    Up,
    /// Counts down; in a structure that instructions share, the rung that did.
    Down,
    Set,
    Reset,
    /// Sets the count to the preset.
    Load,
    Preset,
    Count,
    /// The preset is reached; for a counter that only counts down, 0 is reached; for a bistable, it is set.
    Done,
    /// 0 is reached, for a counter that counts both ways.
    Empty,
}

impl PinRole {
    /// The role of a pin with this name, in whichever block has one.
    pub fn named(name: &str) -> Option<Self> {
        crate::BLOCKS.iter().flat_map(|it| it.pins).find_map(|it| it.role.filter(|_| it.is_named(name)))
    }
}

/// What a caller can do with a block: one unnamed instruction for a function block, several
/// named ones for a structure that instructions share (Logix `CTU`, `CTD`, `RES`).
#[derive(Clone, Copy)]
pub struct Instruction {
    /// Empty for a function block: it is called by its instance's name.
    pub name: &'static str,
    /// The Rust method; its arguments are the inputs (or the rung), by value, in order.
    pub method: &'static str,
    /// The C symbol: `extern "C" fn(block: *mut B, cx: *const Context, rung: bool)`.
    pub symbol: &'static str,
    /// TRUE when the instruction takes a rung condition as its one argument; otherwise its
    /// arguments are the block's input pins (none for an instruction of a shared structure).
    pub takes_rung: bool,
    /// TRUE when the Rust method takes a `&Context` as its last argument.
    pub needs_context: bool,
    /// Runs the instruction on an instance's bytes (the interpreter's way in).
    pub run: fn(bytes: &mut [u8], cx: &Context, rung: bool),
    /// Runs once for each instance that this instruction is used on, before the first scan:
    /// the method's name and the C symbol (`extern "C" fn(block: *mut B)`).
    pub prescan: Option<Prescan>,
}

/// What a Logix controller does with an instruction's structure before the first scan.
#[derive(Clone, Copy)]
pub struct Prescan {
    pub method: &'static str,
    pub symbol: &'static str,
    pub run: fn(bytes: &mut [u8]),
}

/// Everything the compiler knows about a standard function block.
#[derive(Clone, Copy)]
pub struct BlockInfo {
    pub family: Family,
    /// Its name in Structured Text, without the family: `CTU_DINT`.
    pub name: &'static str,
    /// The Rust type below the runtime's root: `iec::Ctu<i32>`.
    pub rust_path: &'static str,
    pub size: usize,
    pub align: usize,
    /// Inputs first, in positional order, then outputs, then the rest.
    pub pins: &'static [Pin],
    pub instructions: &'static [Instruction],
    pub retention: Retention,
    pub facts: Facts,
}

/// Further facts about some blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Facts {
    /// Another name in Structured Text, such as the standard's name for a timer of one type, `TON_TIME`.
    pub alias: Option<&'static str>,
    /// The standard overloads the block: pins of its type may have this type instead, which is stored in the same way.
    pub overload: Option<Elementary>,
    /// It has no name of its own: under an option it replaces another block.
    pub option: Option<Replacement>,
    /// A variable of the user keeps its count.
    pub kept: Option<KeptCount>,
    /// It counts in every call whose input is TRUE, instead of on edges.
    pub counts_levels: bool,
    /// It counts down on the falling edge.
    pub counts_falls: bool,
    /// It counts up only below its preset, and down only above 0.
    pub stops: bool,
    /// It is loaded when its input becomes TRUE, not as long as the input is TRUE.
    pub loads_on_edges: bool,
    /// Pins that have another name in some controllers of the system, or in its counter data.
    pub other_pins: &'static [OtherPin],
    /// A system that does not have this block, and what to use there instead.
    pub instead: Option<(Family, &'static str)>,
}

impl Facts {
    pub(crate) const NONE: Self = Self {
        alias: None,
        overload: None,
        option: None,
        kept: None,
        counts_levels: false,
        counts_falls: false,
        stops: false,
        loads_on_edges: false,
        other_pins: &[],
        instead: None,
    };
}

/// The block of its family that a block replaces while an option is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replacement {
    pub option: BlockOption,
    pub of: &'static str,
}

/// Behaviour that a vendor does not specify.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BlockOption {
    /// CODESYS: `CTU` stops at its preset, as some of its documents say.
    CtuStopAtPv,
    /// OpenPLC from v4.1: `CTD`, and `CD` of a `CTUD`, count on the rising edge.
    CdRises,
    /// S7: `CTD` and `CTUD` are loaded when LD becomes TRUE, not as long as it is TRUE.
    LdEdge,
    /// OpenPLC: `F_TRIG` sees an edge in a first call with FALSE, as before 2024-12.
    FTrigBefore202412,
}

/// A second name of a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherPin {
    pub name: &'static str,
    pub pin: &'static str,
}

/// A counter with one more pin, for the variable that keeps its count over a restart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeptCount {
    /// The pin's name; it follows the inputs.
    pub pin: &'static str,
    /// The block of its family that counts in the same way, without the pin.
    pub plain: &'static str,
}

/// What a restart keeps of the instances of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Retention {
    /// RETAIN instances keep their values, the others start again.
    Declared,
    /// All instances keep their values, whatever their declaration says.
    Always,
    /// RETAIN instances keep their inputs; their counts and outputs start again.
    Inputs,
}

impl Retention {
    /// Whether a pin starts again although its instance is RETAIN.
    pub fn restarts(self, pin: &Pin) -> bool {
        match self {
            Self::Declared | Self::Always => false,
            Self::Inputs => pin.direction != Direction::Input,
        }
    }
}

/// A standard function block: a plain `repr(C)` struct whose all-zero state is its start state.
pub trait Block: Copy + Default {
    const PINS: &'static [Pin];
    /// The instance held in `bytes`, laid out as `repr(C)` lays it out.
    fn load(bytes: &[u8]) -> Self;
    fn store(&self, bytes: &mut [u8]);
}

impl Pin {
    /// How its values are carried.
    pub const fn repr(&self) -> Repr {
        self.ty.repr()
    }

    pub fn is_named(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }
}

impl BlockInfo {
    pub fn pin(&self, name: &str) -> Option<&'static Pin> {
        self.pins.iter().find(|pin| pin.is_named(name))
    }

    /// The pin with this role, whatever this system calls it.
    pub fn pin_for(&self, role: PinRole) -> Option<&'static Pin> {
        self.pins.iter().find(|pin| pin.role == Some(role))
    }

    /// Whether it is a counter: then its name belongs only to its family.
    pub fn is_counter(&self) -> bool {
        self.pin_for(PinRole::Count).is_some()
    }

    /// Whether a bare name means it in every system that has no block with that name.
    pub fn is_shared(&self) -> bool {
        self.family == Family::Iec && !self.is_counter()
    }

    /// Whether `name` is one of its names in its family.
    pub fn is_named(&self, name: &str) -> bool {
        let names = [Some(self.name), self.facts.alias];
        self.facts.option.is_none() && names.into_iter().flatten().any(|it| it.eq_ignore_ascii_case(name))
    }

    pub fn inputs(&self) -> impl Iterator<Item = &'static Pin> {
        self.pins.iter().filter(|pin| pin.direction == Direction::Input)
    }

    pub fn outputs(&self) -> impl Iterator<Item = &'static Pin> {
        self.pins.iter().filter(|pin| pin.direction == Direction::Output)
    }
}

impl core::fmt::Debug for BlockInfo {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{:?}.{}", self.family, self.name)
    }
}

impl core::fmt::Debug for Instruction {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.method)
    }
}

impl core::fmt::Debug for Prescan {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.method)
    }
}

/// The fields of a block are scalars; these functions read and write a field through its repr.
pub(crate) fn load_field<T: Scalar>(bytes: &[u8], offset: usize) -> T {
    T::from_value(Value::read(T::LANE, &bytes[offset..])).unwrap_or_default()
}

pub(crate) fn store_field<T: Scalar>(value: T, bytes: &mut [u8], offset: usize) {
    value.into_value().write(&mut bytes[offset..]);
}

/// Declares a block's members once, in the order of its struct: the [`Block`] implementation
/// and a `const fn new`. If a member is missing here, that is a compile error.
///
/// A row is `field: TYPE = "name in Structured Text"`, `true` after it if it starts TRUE, and
/// `as Role` if it has one.
/// The type is IEC's; `T` is the block's own parameter, and means the type that counts in it
/// (INT for `i16`), unless the block's row in the table says another.
macro_rules! pins {
    ([$($generics:tt)*] $block:ty {
        $($direction:ident { $($field:ident: $ty:ident = $name:literal $($initial:literal)? $(as $role:ident)?),* $(,)? })*
    }) => {
        impl<$($generics)*> $block {
            /// The start state: all zero.
            #[inline]
            pub const fn new() -> Self {
                Self { $($($field: <$crate::block::pin_type!($ty) as $crate::Scalar>::ZERO,)*)* }
            }
        }

        impl<$($generics)*> $crate::reference::Raw for $block {}

        impl<$($generics)*> $crate::Block for $block {
            const PINS: &'static [$crate::Pin] = &[$($($crate::Pin {
                name: $name,
                field: stringify!($field),
                direction: $crate::Direction::$direction,
                role: $crate::block::pin_role!($($role)?),
                ty: $crate::block::pin_elementary!($ty),
                starts_true: false $(|| $initial)?,
                offset: core::mem::offset_of!($block, $field),
            },)*)*];

            fn load(bytes: &[u8]) -> Self {
                Self { $($($field: $crate::block::load_field(bytes, core::mem::offset_of!($block, $field)),)*)* }
            }

            fn store(&self, bytes: &mut [u8]) {
                $($($crate::block::store_field(self.$field, bytes, core::mem::offset_of!($block, $field));)*)*
            }
        }
    };
}
pub(crate) use pins;

/// The Rust primitive of a pin.
macro_rules! pin_type {
    (T) => {
        T
    };
    ($keyword:ident) => {
        $crate::elementary::keyword::$keyword
    };
}
pub(crate) use pin_type;

/// The role of a pin.
macro_rules! pin_role {
    () => {
        None
    };
    ($role:ident) => {
        Some($crate::PinRole::$role)
    };
}
pub(crate) use pin_role;

/// The IEC type of a pin.
macro_rules! pin_elementary {
    (T) => {
        $crate::Elementary::number(<T as $crate::Scalar>::LANE)
    };
    ($keyword:ident) => {
        $crate::elementary::keyword::$keyword
    };
}
pub(crate) use pin_elementary;

/// `pins` with one type replaced by another that is stored in the same way: a UINT that a vendor
/// documents as WORD. `N` is their number.
pub(crate) const fn retyped<const N: usize>(pins: &[Pin], types: &[(Elementary, Elementary)]) -> [Pin; N] {
    assert!(pins.len() == N);
    let mut retyped = [pins[0]; N];
    let mut used = 0;
    let mut at = 0;
    while at < N {
        retyped[at] = pins[at];
        let mut row = 0;
        while row < types.len() {
            let (from, to) = types[row];
            assert!(from.repr() as u8 == to.repr() as u8, "a type is carried otherwise");
            if pins[at].ty as u8 == from as u8 {
                retyped[at].ty = to;
                used += 1;
            }
            row += 1;
        }
        at += 1;
    }
    assert!(used >= types.len(), "no pin is of that type");
    retyped
}

/// `pins` with other names in Structured Text. `N` is their number.
pub(crate) const fn renamed<const N: usize>(pins: &[Pin], names: &[(&str, &'static str)]) -> [Pin; N] {
    assert!(pins.len() == N);
    let mut renamed = [pins[0]; N];
    let mut used = 0;
    let mut at = 0;
    while at < N {
        renamed[at] = pins[at];
        let mut row = 0;
        while row < names.len() {
            if same(pins[at].name, names[row].0) {
                renamed[at].name = names[row].1;
                used += 1;
            }
            row += 1;
        }
        at += 1;
    }
    assert!(used == names.len(), "a renamed pin does not exist");
    renamed
}

/// `a == b`, in constants.
const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

const _: () = assert!(size_of::<Time>() == 8);
