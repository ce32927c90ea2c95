//! Ladder diagrams (LD) and function block diagrams (FBD) of PLCopen XML, as statements. They are executed as the ST is that Beremiz'
//! and OpenPLC's editors make of them; what CODESYS has written, as CODESYS does.

mod context;
mod declared;
mod dispute;
mod expression;
mod functions;
mod node;
mod order;
mod parse;
mod types;
mod write;

use super::super::assembly::{Chunk, Says, Trouble};
use super::super::xml::{Broken, Reader};
pub use context::{Context, Names};
pub use declared::Declared;
use dispute::dispute;
pub use expression::Expression;
pub use node::{Diagram, Name, Wire};
pub use parse::{diagram, node, wires};
pub use types::Types;
pub use write::{Refusal, Writer, Written};

/// A diagram that was opened, to its end.
pub fn read<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    context: Context<'_>,
    names: &mut Names,
) -> Result<Result<Written, Refusal>, Broken> {
    let drawn = diagram(file, reader)?;
    let types = Types::of(file, &drawn, context.declared, context.pou);
    let mut written = Writer::new(file, &drawn, &types, context, names).run();
    if let (Ok(written), false) = (&mut written, context.is_codesys)
        && let Some((first, then)) = dispute(file, &drawn, &written.statements, &written.groups)
    {
        let [first, then] = [first, then].map(|it| &drawn.nodes[it]);
        let [is_first, is_later] = [first, then].map(|it| it.shown(file));
        let message = format!(
            "{is_first} is executed before {is_later}, which is above it or to its left: the order is that of the file"
        );
        let says = Says::Wrong(Trouble::OtherOrder, message);
        written.statements.push(Chunk { place: first.place.clone(), says });
    }
    Ok(written)
}
