//! What a program uses and the other system has not, although Staunch runs it there: the comparison
//! goes on, and the user is told at each place.

use staunch_frontend::{Dialect, Sources};
use staunch_ir::{Elementary, Program, Type};

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

/// Blocks of the standard by their names, and what a Logix controller has in Structured Text.
const LOGIX_BLOCKS: [(&str, &str); 7] = [
    ("TON", "TONR with an FBD_TIMER"),
    ("TOF", "TOFR with an FBD_TIMER"),
    ("TP", "no pulse timer: build it of a TONR"),
    ("R_TRIG", "OSRI with an FBD_ONESHOT"),
    ("F_TRIG", "OSFI with an FBD_ONESHOT"),
    ("SR", "SETD with a DOMINANT_SET"),
    ("RS", "RESD with a DOMINANT_RESET"),
];

/// Bit strings, and the integers that Logix has in their place.
const LOGIX_TYPES: [(Elementary, &str); 4] =
    [(Elementary::Byte, "SINT"), (Elementary::Word, "INT"), (Elementary::Dword, "DINT"), (Elementary::Lword, "LINT")];

/// In the order of the declarations.
pub fn find(sources: &Sources, program: &Program, to: Dialect) -> Vec<Missing> {
    if to != Dialect::Logix {
        return Vec::new();
    }
    let mut found = Vec::new();
    for structure in &program.structs {
        for field in &structure.fields {
            if let Some((what, instead)) = lacks(program, field.ty) {
                let source = sources.files().get(usize::from(field.location.file));
                let path = source.map_or_else(String::new, |it| it.path.clone());
                let at = format!("{path}:{}", field.location.line);
                found.push(Missing { subject: field.name.clone(), at, what, instead });
            }
        }
    }
    found
}

fn lacks(program: &Program, ty: Type) -> Option<(String, &'static str)> {
    match ty {
        Type::Block(id) => {
            let name = id.info().name;
            let (_, instead) = LOGIX_BLOCKS.iter().find(|it| it.0 == name.trim_start_matches('L'))?;
            Some((name.to_owned(), instead))
        }
        Type::Elementary(it) => {
            let (_, instead) = LOGIX_TYPES.iter().find(|other| other.0 == it)?;
            Some((it.name().to_owned(), instead))
        }
        Type::Array(id) => lacks(program, program.array(id).element),
        Type::Enum(_) => Some(("enumerations".to_owned(), "a DINT, and a constant for each name")),
        Type::Subrange(..) => Some(("subranges".to_owned(), "the whole type, with a check of your own")),
        Type::String(_) | Type::Struct(_) => None,
    }
}
