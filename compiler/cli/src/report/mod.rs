//! `staunch report`: what a program takes of a machine, before it runs.

mod task;

mod memory;
mod stack;
mod time;

mod figures;

mod budget;
mod json;
mod table;

use crate::args::{MessageFormat, Report};
use crate::session::Session;
use crate::{REJECTED, output, target};
use figures::Figures;
use staunch_build::Project;
use staunch_ir::Program;
use staunch_native::Target;

pub fn report(session: &Session, args: &Report) -> Result<u8, String> {
    let Some(program) = session.program_to_run(args.program.as_deref())? else { return Ok(REJECTED) };
    let target = target::of(args.target.as_deref(), args.opt.unwrap_or_default())?;
    let figures = Figures::of(&program, &target)?;
    let format = session.common.format();
    let text = match format {
        MessageFormat::Json => json::text(&figures),
        MessageFormat::Human | MessageFormat::Short => table::text(&figures),
    };
    output::print(text.as_bytes())?;
    Ok(say(format, &budget::exceeded(&figures, &session.project)))
}

/// Holds the budgets of the project file, which are for native code. Gives the exit code.
pub fn hold(session: &Session, program: &Program, target: &Target) -> Result<u8, String> {
    if !has_budget(&session.project) {
        return Ok(0);
    }
    let figures = Figures::of(program, target)?;
    Ok(say(session.common.format(), &budget::exceeded(&figures, &session.project)))
}

pub fn has_budget(project: &Project) -> bool {
    project.max_stack.is_some() || project.max_scan_instructions.is_some()
}

fn say(format: MessageFormat, problems: &[String]) -> u8 {
    problems.iter().for_each(|it| output::problem(format, it));
    if problems.is_empty() { 0 } else { REJECTED }
}
