//! Ladder (LD) and function block diagrams (FBD) of OpenPLC Editor 4 and Autonomy Edge: JSON of nodes and of edges between them.
//! They are executed as the ST is that its `xml2st` makes of them.

mod declared;
mod element;
mod fbd;
mod ladder;

use super::super::assembly::{Assembly, Chunk, Says};
use super::super::diagram::{Context, Diagram, Names, Refusal, Rules, Written, write};
use super::super::json::Value;
use super::object::Object;
pub use declared::{Pou, in_table, in_text};
use rustc_hash::FxHashSet;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    Ladder,
    Fbd,
}

impl Language {
    /// The editor's word for it.
    pub fn named(word: &str) -> Option<Self> {
        match word {
            "ld" => Some(Self::Ladder),
            "fbd" => Some(Self::Fbd),
            _ => None,
        }
    }
}

/// The statements of a diagram, and the variables that they need.
pub fn read(file: &str, value: &Value, language: Language, pou: &Pou<'_>, out: &mut Assembly) -> (Vec<Chunk>, String) {
    let Some(object) = Object::required(file, value, "a diagram", out) else { return (Vec::new(), String::new()) };
    let mut diagram = Diagram::default();
    match language {
        Language::Ladder => ladder::read(&object, &mut diagram, out),
        Language::Fbd => fbd::read(&object, &mut diagram, out),
    }
    number_apart(&mut diagram);
    let declared = declared::of(&object, pou, out);
    let context = Context { declared: &declared, pou: pou.name, action: "", rules: Rules::Editor4 };
    match write(file, &diagram, context, &mut Names::default()) {
        Ok(Written { statements, variables, groups: _ }) => {
            let lines: String = variables.iter().map(|(name, ty)| format!("{name} : {ty};\n")).collect();
            (statements, if lines.is_empty() { lines } else { format!("\nVAR\n{lines}END_VAR\n") })
        }
        Err(Refusal { place, trouble, message }) => {
            let message = format!("the diagram of `{}`: {message}", pou.name);
            (vec![Chunk { place, says: Says::Wrong(trouble, message) }], String::new())
        }
    }
}

/// Copies of an element may have its number.
fn number_apart(diagram: &mut Diagram) {
    let mut seen = FxHashSet::default();
    for (at, node) in diagram.nodes.iter_mut().enumerate() {
        if !seen.insert(node.number.clone()) {
            node.number = format!("{}_{at}", node.number);
        }
    }
}
