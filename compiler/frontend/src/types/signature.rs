//! Signatures: what callers of a POU see, and where its variables live.

use super::scope::Scope;
use super::table::Resolved;
use crate::{Span, ast};
use rustc_hash::FxHashMap;
use staunch_ir::{BlockId, FieldId, Local, LocalId, Param, Place, Section, StructId};
use staunch_runtime::Class;
use std::rc::Rc;

/// A formal parameter, in declaration order.
#[derive(Clone, Debug)]
pub(crate) struct Formal<'s> {
    pub name: ast::Name<'s>,
    pub section: Section,
    /// Of a VAR_IN_OUT CONSTANT, which is only read.
    pub constant: bool,
    pub resolved: Rc<Resolved>,
    /// Of a generic FUNCTION: the word that its type is.
    pub word: Option<Class>,
    pub target: Target,
}

/// How an argument reaches its parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// A field of the instance.
    Field(FieldId),
    /// A parameter of the call.
    Param(usize),
}

/// An input declared R_EDGE or F_EDGE: the body sees the trigger's output.
#[derive(Clone, Debug)]
pub(crate) struct EdgeInput {
    pub input: Place,
    pub trigger: Place,
}

#[derive(Clone, Debug)]
pub(crate) struct Signature<'s> {
    pub scope: Rc<Scope<'s>>,
    /// The structure of an instance, for a PROGRAM or FUNCTION_BLOCK.
    pub state: Option<StructId>,
    pub formals: Vec<Formal<'s>>,
    pub params: Vec<Param>,
    pub locals: Vec<Local>,
    pub result: Option<(LocalId, Resolved)>,
    pub edges: Vec<EdgeInput>,
    /// VAR_INST of its METHODs, by where each is declared.
    pub instance_variables: FxHashMap<Span, (Place, Rc<Resolved>)>,
}

/// The pin `name` of the block at `place`.
pub(crate) fn pin_place(place: Place, block: BlockId, name: &str) -> Place {
    let at = block.info().pins.iter().position(|pin| pin.name.eq_ignore_ascii_case(name));
    let at = at.expect("the runtime's own pin names");
    let field = FieldId::next(at);
    let ty = block.pin_type(field).expect("the pin was found above");
    place.field(field, ty)
}
