//! What a program uses and the other system has not, although Staunch runs it there: the comparison
//! goes on, and the user is told at each place.

use staunch_frontend::{Dialect, Sources};
use staunch_ir::{Program, Type};

/// A variable whose type the other system has not.
#[derive(Clone, Debug)]
pub struct Missing {
    /// The variable.
    pub subject: String,
    /// `file:line`
    pub at: String,
    pub what: String,
    pub instead: &'static str,
}

/// In the order of the declarations.
pub fn find(sources: &Sources, program: &Program, to: Dialect) -> Vec<Missing> {
    let mut found = Vec::new();
    for structure in &program.structs {
        for field in &structure.fields {
            if let Some((what, instead)) = lacks(program, field.ty, to) {
                let source = sources.files().get(usize::from(field.location.file));
                let path = source.map_or_else(String::new, |it| it.path.clone());
                let at = format!("{path}:{}", field.location.line);
                found.push(Missing { subject: field.name.clone(), at, what, instead });
            }
        }
    }
    found
}

/// By what is known of the system as a whole, and of each block.
fn lacks(program: &Program, ty: Type, to: Dialect) -> Option<(String, &'static str)> {
    match ty {
        Type::Block(id) => {
            let (family, instead) = id.info().facts.instead?;
            (family == to.family()).then(|| (id.info().name.to_owned(), instead))
        }
        Type::Elementary(it) => Some((it.name().to_owned(), to.family().instead_of(it)?)),
        Type::Array(id) => lacks(program, program.array(id).element, to),
        Type::Enum(_) => {
            (to == Dialect::Logix).then(|| ("enumerations".to_owned(), "a DINT, and a constant for each name"))
        }
        Type::Subrange(..) => {
            (to == Dialect::Logix).then(|| ("subranges".to_owned(), "the whole type, with a check of your own"))
        }
        Type::Reference(_) => {
            (to == Dialect::Logix).then(|| ("references".to_owned(), "the variable itself, or an index into an array"))
        }
        Type::String(_) | Type::Struct(_) => None,
    }
}
