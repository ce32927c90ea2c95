//! What a program calls that is implemented outside of Structured Text, in Rust or C.

use crate::{Argument, Location, Place, Program, StatementKind, StructId, Type, visit};

/// A FUNCTION or FUNCTION_BLOCK that is declared `{external}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct External {
    /// As declared, with its namespaces.
    pub name: String,
    /// What C calls it.
    pub symbol: String,
    pub doc: Option<String>,
    pub location: Location,
    /// The state of a FUNCTION_BLOCK's instances, which is handed over by reference, with the context.
    pub state: Option<StructId>,
    /// A FUNCTION's parameters, a FUNCTION_BLOCK's in-outs.
    pub params: Vec<ExternalParam>,
    /// Of a FUNCTION.
    pub result: Option<Type>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExternalParam {
    pub name: String,
    pub ty: Type,
    /// What is outside may write it: an output or an in-out.
    pub by_reference: bool,
}

/// The call of one, which is in the routine that is declared so. The arguments share no storage: where they might, the
/// routine passes copies and writes them back.
#[derive(Clone, Debug)]
pub struct ExternalCall {
    pub external: External,
    pub instance: Option<Place>,
    pub arguments: Vec<Argument>,
    pub result: Option<Place>,
}

impl Program {
    /// Each that is called, once, in the order of the sources.
    pub fn externals(&self) -> Vec<&External> {
        let mut found = Vec::new();
        for routine in &self.routines {
            visit::statements(&routine.body, &mut |statement| {
                if let StatementKind::External(it) = &statement.kind {
                    found.push(&it.external);
                }
            });
        }
        found.sort_by_key(|it| (it.location.file, it.location.line, it.location.column));
        found.dedup_by_key(|it| it.location);
        found
    }
}
