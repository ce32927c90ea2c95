//! Sequential function charts (SFC) of PLCopen XML, as the standard's text: steps, transitions and ACTIONs, in the order in which
//! Beremiz' and OpenPLC's editors write them, which is that of execution.

mod element;
mod network;
mod parse;
mod write;

use super::super::assembly::Chunk;
use super::super::diagram::{Context, Diagram, Names, Refusal};
use super::super::unit::{Body, Unit, What};
use super::super::xml::{Broken, Reader};
use rustc_hash::FxHashMap;

/// What a chart becomes.
#[derive(Debug, Default)]
pub struct Written {
    pub text: Vec<Chunk>,
    /// Variables that its conditions need, with their types.
    pub variables: Vec<(String, String)>,
}

/// A condition that transitions name.
#[derive(Debug)]
pub enum Transition {
    Text(Vec<Chunk>),
    Diagram(Diagram),
    /// In a language that is not read.
    Other(&'static str),
}

/// What a POU has in addition to its chart.
pub struct Parts<'p> {
    pub transitions: &'p FxHashMap<String, Transition>,
    /// Those with text are taken out where a step names them.
    pub actions: Vec<(String, Vec<Chunk>)>,
}

impl<'p> Parts<'p> {
    /// Takes the ACTIONs with text out of a POU.
    pub fn of(unit: &mut Unit<'_>, transitions: &'p FxHashMap<String, Transition>) -> Self {
        let mut actions = Vec::new();
        unit.parts.retain_mut(|part| match &mut part.body {
            Body::Text(text) if part.what == What::Action => {
                actions.push((part.name.to_owned(), std::mem::take(text)));
                false
            }
            Body::Text(_) | Body::None | Body::Other(..) => true,
        });
        Self { transitions, actions }
    }
}

/// A chart that was opened, to its end.
pub fn read<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    context: Context<'_>,
    names: &mut Names,
    parts: Parts<'_>,
) -> Result<Result<Written, Refusal>, Broken> {
    let chart = parse::chart(file, reader)?;
    let networks = match network::Networks::of(&chart) {
        Ok(networks) => networks,
        Err(refusal) => return Ok(Err(refusal)),
    };
    Ok(write::write(file, &chart, &networks, context, names, parts))
}
