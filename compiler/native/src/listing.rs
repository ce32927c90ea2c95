//! What people and tests ask of the code: its text, and how much of the stack it takes.

use crate::{Error, Target, object, program};
use staunch_ir::Program;

/// The code of a verified program as text, before the code generator improves it: for golden
/// tests and for people.
///
/// # Errors
/// As [`object`](crate::object()).
pub fn clif(program: &Program, target: &Target) -> Result<String, Error> {
    let mut module = object::module(target)?;
    Ok(program::emit(program, &mut module, Some(String::new()))?.listing)
}

/// How many bytes of the stack a call of each routine takes, without those of the calls it makes.
///
/// # Errors
/// As [`object`](crate::object()).
pub fn frames(program: &Program, target: &Target) -> Result<Vec<u64>, Error> {
    let mut module = object::module(target)?;
    Ok(program::emit(program, &mut module, None)?.frames)
}
