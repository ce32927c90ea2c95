//! What a program uses and the other system does not have, although Staunch runs it there: the comparison
//! continues, and each place is reported.

use staunch_frontend::{Dialect, Sources};
use staunch_ir::{Elementary, FieldId, Location, Program, Projection, Root, Section, StructId, Type, Variable};
use std::collections::BTreeMap;

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
    for (name, ty, location) in declared(program) {
        if let Some((what, instead)) = lacks(program, ty, to) {
            let source = sources.files().get(usize::from(location.file));
            let path = source.map_or_else(String::new, |it| it.path.clone());
            let at = format!("{path}:{}", location.line);
            found.push(Missing { subject: name.to_owned(), at, what, instead });
        }
    }
    found
}

/// The variables and members that are declared: where a field only keeps the bits of some, those.
fn declared(program: &Program) -> Vec<(&str, Type, Location)> {
    let mut found = Vec::new();
    for (number, structure) in program.structs.iter().enumerate() {
        for (at, field) in structure.fields.iter().enumerate() {
            let id = FieldId::next(at);
            if StructId::next(number) == program.globals && field.section == Section::Internal {
                let own = program.classes.iter().flat_map(|it| &it.variables);
                let is_in = |it: &&Variable| {
                    it.place.root == Root::Globals
                        && matches!(it.place.projections[..], [Projection::Field(it)] if it == id)
                };
                let views: BTreeMap<_, _> =
                    own.chain(&program.aliases).filter(is_in).map(|it| (&it.name, it)).collect();
                let views = views.into_values().filter_map(|it| Some((it.name.as_str(), it.view?.ty, field.location)));
                found.extend(views);
            } else if structure.is_storage(id) {
                let overlays = structure.overlays.iter().filter(|it| it.field == id);
                found.extend(overlays.map(|it| (it.name.as_str(), it.ty, it.location)));
            } else {
                found.push((field.name.as_str(), field.ty, field.location));
            }
        }
    }
    found
}

/// Variables of types of which no public document says whether the other system has them, with those.
pub fn unknown(program: &Program, to: Dialect) -> Vec<(String, String)> {
    if to != Dialect::Cscape {
        return Vec::new();
    }
    let all = declared(program).into_iter();
    all.filter_map(|(name, ty, _)| Some((name.to_owned(), uncommon(program, ty)?))).collect()
}

/// The name of a type that is not in a small controller's everyday set.
fn uncommon(program: &Program, ty: Type) -> Option<String> {
    match ty {
        Type::Elementary(it) => {
            (it.repr().size() > 4 && it != Elementary::Time || it.is_char()).then(|| it.name().to_owned())
        }
        Type::String(it) => it.wide.then(|| "WSTRING".to_owned()),
        Type::Reference(_) => Some("references".to_owned()),
        Type::Array(id) => uncommon(program, program.array(id).element),
        Type::Subrange(it, _) => uncommon(program, Type::Elementary(it)),
        Type::Enum(_) | Type::Struct(_) | Type::Block(_) => None,
    }
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
            (to == Dialect::Logix).then(|| ("subranges".to_owned(), "the whole type, with your own check"))
        }
        Type::Reference(_) => {
            (to == Dialect::Logix).then(|| ("references".to_owned(), "the variable itself, or an index into an array"))
        }
        Type::String(it) => (it.wide && to == Dialect::Openplc).then(|| ("WSTRING".to_owned(), "a STRING")),
        Type::Struct(_) => None,
    }
}
