//! `staunch run --break`: an interpreted run that stops before statements, and shows the variables.

mod call_path;
mod commands;
mod console;
mod places;
mod stop;
mod variables;

use crate::args::Run;
use crate::session::{Asked, Session};
use crate::{USAGE, output};
use commands::Commands;
use console::Console;
use places::{Found, Places};
use staunch_host::{Map, Options, json_text};
use staunch_ir::Program;
use staunch_ir::interpret::debug::Debugger;
use staunch_machine::Interpreted;
use std::collections::HashSet;
use variables::map_text;

/// The name of the condition in diagnostics.
const CONDITION: &str = "--when";

pub fn run(session: &Session, args: &Run, options: Options) -> Result<u8, String> {
    let (program, errors) = session.with_stops(&[])?;
    let program = program.ok_or_else(|| errors.concat())?;
    let program = session.choose(&program, args.program.as_deref())?;
    let found = Places::of(&program, &session.sources).find(&args.debug.breakpoints)?;
    let program = match &args.debug.when {
        Some(condition) => match with_condition(session, args, &found, condition)? {
            Some(program) => program,
            None => return Ok(USAGE),
        },
        None => program,
    };
    let options = Options { debugged: true, ..options };
    let commands = Commands::of(&args.debug)?;
    let map = Map::parse(&map_text(&program)).map_err(|it| it.to_string())?;
    let notes = Notes { options: &options };
    found.iter().flat_map(|it| &it.notes).try_for_each(|it| notes.tell(it))?;
    let breakpoints: HashSet<_> = found.iter().flat_map(|it| it.at.iter().copied()).collect();
    let console = Console::new(session, args, &map, commands, &options);
    let mut machine = Interpreted::watched(&program, &map, Debugger::new(breakpoints, console));
    let ended = staunch_host::run(&mut machine, &map, &options);
    let stopped = machine.interpreter().watch().asks().map(|it| it.stopped_at()).unwrap_or_default();
    for it in found.iter().filter(|it| it.is_reachable && it.at.is_disjoint(&stopped.places)) {
        // A run that ended at a stop says nothing of the rest.
        if !stopped.is_over {
            notes.tell(&it.never())?;
        }
    }
    match ended {
        Ok(_) => Ok(0),
        Err(error) => {
            options.report(&error);
            Ok(error.exit_code())
        }
    }
}

/// The program with the condition at each of the breakpoints; `None` where it is wrong, which has been said.
fn with_condition(session: &Session, args: &Run, found: &[Found], text: &str) -> Result<Option<Program>, String> {
    let places: HashSet<_> = found.iter().flat_map(|it| it.at.iter().copied()).collect();
    let ask = |at| Asked { at, name: CONDITION, text, is_condition: true };
    let asked: Vec<_> = places.into_iter().map(ask).collect();
    let (program, errors) = session.with_stops(&asked)?;
    let Some(program) = program else {
        for error in errors {
            match session.common.format() == crate::args::MessageFormat::Json {
                true => output::print(error.as_bytes())?,
                false => output::tell(error),
            }
        }
        return Ok(None);
    };
    session.choose(&program, args.program.as_deref()).map(Some)
}

/// What there is to say besides the stops.
struct Notes<'a> {
    options: &'a Options,
}

impl Notes<'_> {
    fn tell(&self, text: &str) -> Result<(), String> {
        if self.options.json {
            let object = format!("{{\"reason\":\"note\",\"message\":{}}}", json_text(text));
            return self.options.print_json(&object).map_err(|it| it.to_string());
        }
        output::tell(format_args!("note: {text}"));
        Ok(())
    }
}
