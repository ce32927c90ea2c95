//! Ladder diagrams (LD) and function block diagrams (FBD), as statements. They are executed as the ST is that Beremiz' and OpenPLC's
//! editors make of them; what CODESYS has written, as CODESYS does.

mod context;
mod declared;
mod dispute;
mod expression;
mod functions;
mod node;
mod order;
mod types;
mod write;

use super::assembly::{Chunk, Says, Trouble};
pub use context::{Context, Names, Rules};
pub use declared::{Declared, Unit};
use dispute::dispute;
pub use functions::is_function;
pub use node::{Diagram, Edge, Input, Kind, Modifier, Name, Node, Output, Position, Storage, Wire};
pub use types::Types;
pub use write::{Refusal, Writer, Written, is_one_expression};

/// The statements of a diagram.
pub fn write(file: &str, diagram: &Diagram, context: Context<'_>, names: &mut Names) -> Result<Written, Refusal> {
    let types = Types::of(file, diagram, context.declared, context.pou);
    let mut written = Writer::new(file, diagram, &types, context, names).run()?;
    if context.rules == Rules::Beremiz
        && let Some((first, then)) = dispute(file, diagram, &written.statements, &written.groups)
    {
        let [first, then] = [first, then].map(|it| &diagram.nodes[it]);
        let [is_first, is_later] = [first, then].map(|it| it.shown(file));
        let message = format!(
            "{is_first} is executed before {is_later}, which is above it or to its left: the order is that of the file"
        );
        let says = Says::Wrong(Trouble::OtherOrder, message);
        written.statements.push(Chunk { place: first.place.clone(), says });
    }
    Ok(written)
}
