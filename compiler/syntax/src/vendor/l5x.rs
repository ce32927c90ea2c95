//! The L5X of Rockwell's Logix Designer: tags, types, Add-On Instructions, programs and tasks are elements, routines in
//! Structured Text are lines, those in ladder are made statements. Operands that Structured Text has no words for (aliases, modules' tags, JSR, calls of
//! Add-On Instructions) are written in its words.

mod data;
mod instruction;
mod ladder;
mod logic;
mod module;
mod names;
mod program;
mod service;
mod tag;
mod task;

use super::assembly::{Assembly, Trouble};
use super::xml::{Broken, Part, Reader};
pub use ladder::described as ladder_instructions;
pub use ladder::{Ladder, Text, is_rung, shown, starts_as_rung, statements};
pub use logic::Logic;
pub use names::{Names, Scope, Shown};
pub use service::controller_service;

/// Reads what follows the root.
pub fn read<'t>(file: &'t str, mut reader: Reader<'t>) -> Assembly {
    let mut out = Assembly::default();
    out.write("{dialect 'logix'}\n", &reader.last());
    let mut names = Names { shown: shown(file), ..Names::default() };
    if let Err(broken) = controller(file, &mut reader, &mut names, &mut out) {
        let message = format!("this L5X is not well-formed XML: {}", broken.why);
        out.problem(Trouble::Broken, message, &broken.place);
    }
    out
}

/// Each part of a controller is before those that name it, as the format has them.
fn controller<'t>(file: &'t str, reader: &mut Reader<'t>, names: &mut Names, out: &mut Assembly) -> Result<(), Broken> {
    let mut tasks = Vec::new();
    while let Some(part) = reader.part()? {
        let Part::Open(element) = part else { continue };
        match element.name {
            "DataType" => out.copy(file, &tag::data_type(file, reader, &element, names)?),
            "Module" => module::read(file, reader, &element, names, out)?,
            "AddOnInstructionDefinitions" => instruction::all(file, reader, names, out)?,
            "Tags" => tag::controller_tags(file, reader, names, out)?,
            "Program" => program::read(file, reader, &element, names, out)?,
            "Task" => task::read(file, reader, &element, names, &mut tasks, out)?,
            "ParameterConnection" => {
                let end = |it: &str| element.attribute(file, it).unwrap_or_default();
                let message = format!(
                    "`{}` is connected to `{}`: such connections are not supported",
                    end("EndPoint1"),
                    end("EndPoint2")
                );
                out.problem(Trouble::NotSupported, message, &element.place);
                reader.skip()?;
            }
            "Controller" | "DataTypes" | "Modules" | "Programs" | "Tasks" | "ParameterConnections" => {}
            // What else there is says nothing of the program.
            _ => reader.skip()?,
        }
    }
    task::close(&mut tasks, &reader.last());
    out.copy(file, &tasks);
    Ok(())
}
