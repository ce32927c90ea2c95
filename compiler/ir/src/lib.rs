//! The typed intermediate representation: what the front end proves, and all a back end sees.
//!
//! A [`Program`] is a set of types, the global variables, and the program organisation units
//! (POUs) with their bodies. What holds in it is in [`verify`](mod@verify), and carries a
//! contract: **verified IR cannot make a back end fail or panic.**
//!
//! 1. Every expression has one concrete type: no ANY, no untyped literal.
//! 2. No implicit conversion: operands already have the type their operation wants.
//! 3. Ids, never names. Names are kept for people: messages, traces, emitted code.
//! 4. Expressions are pure: they read, compute or fault. A call is a statement.
//! 5. Evaluation goes left to right, and the first fault wins.
//! 6. WHILE and REPEAT are one [`StatementKind::Loop`]; a [`For`] goes by its variable.
//! 7. Calls carry every argument, in declaration order.
//! 8. A [`Place`] is a root and projections; an index outside its bounds faults.
//! 9. A fault is the only unexpected exit, and has a location.
//! 10. Constants are folded as the interpreter computes, with the functions that run later.
#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod program;
mod types;
mod uses;

mod chars;
mod expression;
mod external;
pub mod interval;
mod limits;
mod op;
mod place;
mod statement;
pub mod visit;

mod evaluate;
mod fold;

mod print;
pub mod verify;

pub mod alias;
pub mod byte_copy;
pub mod effects;
pub mod faults;
pub mod in_threads;
pub mod interpret;
pub mod layout;
pub mod loops;
pub mod narrow;
pub mod overwritten;
pub mod pieces;
pub mod promote;
pub mod reached;
pub mod reference;
pub mod shapes;
pub mod shifted;
pub mod stack;
pub mod startup;
pub mod stop;
pub mod symbols;
pub mod taking;
pub mod turns;
pub mod usage;

#[cfg(test)]
mod fixture;

pub use chars::{Chars, CharsOf};
pub use expression::{Conversion, Expr, ExprKind};
pub use external::{External, ExternalCall, ExternalParam};
pub use fold::fold;
pub use op::{Op, TextOp, apply, apply_text};
pub use place::{Place, Projection, Root};
pub use print::{print, print_without_places};
pub use program::{
    Address, Area, Bound, Class, ClassId, ClassKind, DeclarationId, Field, FieldId, HELD_PROGRAM, Instance, Local,
    LocalId, Mode, Module, Param, ParamId, Program, Reach, Retain, Routine, RoutineId, RoutineKind, Section,
    SourceFile, Variable, View,
};
pub use statement::{Argument, Arm, Block, Count, For, Statement, StatementKind, Step, Taking};
pub use uses::{Part, Use, Uses};

pub use types::{
    Array, ArrayId, BlockId, BoundsId, Const, Elementary, Enum, EnumId, Enumerator, InterfaceId, Overlay, RefKind,
    RefType, ReferenceId, Struct, StructId, Type,
};

pub use staunch_runtime::{FaultKind, Location, Repr, StringType, Value};
