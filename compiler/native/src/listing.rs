//! The code as text.

use crate::{Error, Target, object, unit};
use staunch_ir::Program;

/// The code of a verified program as text, before the code generator improves it: for golden
/// tests and for people.
///
/// # Errors
/// As [`object`](crate::object()).
pub fn clif(program: &Program, target: &Target) -> Result<String, Error> {
    let mut module = object::module(target)?;
    let (_, text) = unit::emit(program, &mut module, Some(String::new()))?;
    Ok(text)
}
