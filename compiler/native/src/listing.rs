//! What people and tests ask of the code: its text, how large it is, and how much of the stack it takes.

use crate::program::{self, Also};
use crate::{Error, Measures, Target, object};
use staunch_ir::Program;

/// The code of a verified program as text, before the code generator improves it: for golden
/// tests and for people.
///
/// # Errors
/// As [`object`](crate::object()).
pub fn clif(program: &Program, target: &Target) -> Result<String, Error> {
    let mut module = object::module(target)?;
    Ok(program::emit(program, &mut module, Also::Listing)?.listing)
}

/// How many bytes of the stack a call of each routine takes, without those of the calls it makes.
///
/// # Errors
/// As [`object`](crate::object()).
pub fn frames(program: &Program, target: &Target) -> Result<Vec<u64>, Error> {
    let mut module = object::module(target)?;
    let measures = program::emit(program, &mut module, Also::Nothing)?.measures;
    Ok(measures.functions.iter().take(program.routines.len()).map(|it| it.frame).collect())
}

/// What is known of the code of a verified program: that of [`object`](crate::object()), function by function.
///
/// # Errors
/// As [`object`](crate::object()).
pub fn measures(program: &Program, target: &Target) -> Result<Measures, Error> {
    let mut module = object::module(target)?;
    Ok(program::emit(program, &mut module, Also::Counts)?.measures)
}
