//! Functions that look for what a reference leads to where it is expected: at the variables of its type whose
//! addresses are taken. The table of objects decides about targets elsewhere, or seen as another type.

use proc_macro2::Ident;
use staunch_ir::reference::{Target, Targets, looked_up};
use staunch_ir::{Program, Type};

use crate::names::{Names, Scope, snake};

/// A function of the whole state.
pub struct LookUp {
    /// What it looks for.
    pub ty: Type,
    pub name: Ident,
    /// Where that may be.
    pub targets: Vec<Target>,
}

/// One for each type that is looked for and that references may lead to.
pub fn look_ups(program: &Program, names: &Names, targets: &Targets<'_>) -> Vec<LookUp> {
    let mut scope = Scope::with(&["new", "default"]);
    let found = looked_up(program).into_iter().map(|ty| (ty, targets.lead_to(ty)));
    let found = found.filter(|(_, targets)| !targets.is_empty());
    found.map(|(ty, targets)| LookUp { ty, name: scope.claim(&name(program, names, ty)), targets }).collect()
}

fn name(program: &Program, names: &Names, ty: Type) -> String {
    let of = match ty {
        Type::Elementary(it) => it.name().to_lowercase(),
        Type::Subrange(base, _) => format!("range_of_{}", base.name().to_lowercase()),
        Type::Reference(_) => "reference".to_owned(),
        Type::String(it) => format!("{}_{}", if it.wide { "wstring" } else { "string" }, it.capacity),
        Type::Enum(id) => snake(&names.enumeration(id).to_string()),
        Type::Array(id) => format!("{}s", name(program, names, program.array(id).element).trim_end_matches("_at")),
        Type::Struct(id) => snake(&names.structure(id).to_string()),
        Type::Block(id) => snake(id.info().name),
    };
    format!("{of}_at")
}
