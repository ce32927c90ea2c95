//! Ladder diagrams (LD) and function block diagrams (FBD) of PLCopen XML, as statements. They are executed as the ST is that Beremiz'
//! and OpenPLC's editors make of them; what CODESYS has written, as CODESYS does.

mod declared;
mod dispute;
mod expression;
mod functions;
mod node;
mod order;
mod parse;
mod types;
mod write;

use super::super::assembly::{Chunk, Trouble};
use super::super::xml::{Broken, Reader};
pub use declared::Declared;
use dispute::dispute;
use rustc_hash::FxHashSet;
pub use write::{Refusal, Written};

/// What a diagram is in.
#[derive(Clone, Copy)]
pub struct Says<'s> {
    pub declared: &'s Declared,
    pub pou: &'s str,
    pub is_codesys: bool,
}

impl Says<'_> {
    /// Whether the project has a function of this name.
    fn has_function(&self, name: &str) -> bool {
        self.declared.result(name).is_some()
    }
}

/// The instances that the diagrams of one POU have added.
#[derive(Debug, Default)]
pub struct Names {
    taken: FxHashSet<String>,
}

impl Names {
    /// A name that begins so, has a number, and is not one of the POU's own.
    fn free(&mut self, ty: &str, says: Says<'_>) -> String {
        let mut number = 1;
        loop {
            let name = format!("{ty}{number}");
            if !says.declared.has(says.pou, &name) && self.taken.insert(name.clone()) {
                return name;
            }
            number += 1;
        }
    }
}

/// A diagram that was opened, to its end.
pub fn read<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    says: Says<'_>,
    names: &mut Names,
) -> Result<Result<Written, Refusal>, Broken> {
    let diagram = parse::diagram(file, reader)?;
    let types = types::Types::of(file, &diagram, says.declared, says.pou);
    let mut written = write::Writer::new(file, &diagram, &types, says, names).run();
    if let (Ok(written), false) = (&mut written, says.is_codesys)
        && let Some((first, then)) = dispute(file, &diagram, &written.statements, &written.groups)
    {
        let [first, then] = [first, then].map(|it| &diagram.nodes[it]);
        let [is_first, is_later] = [first, then].map(|it| it.shown(file));
        let message = format!(
            "{is_first} is executed before {is_later}, which is above it or to its left: the order is that of the file"
        );
        let says = super::super::assembly::Says::Wrong(Trouble::OtherOrder, message);
        written.statements.push(Chunk { place: first.place.clone(), says });
    }
    Ok(written)
}
