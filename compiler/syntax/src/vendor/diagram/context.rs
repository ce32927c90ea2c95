//! What a diagram is in: whose rules hold, and which names there are.

use super::declared::Declared;
use rustc_hash::FxHashSet;

/// What a diagram is in.
#[derive(Clone, Copy)]
pub struct Context<'s> {
    pub declared: &'s Declared,
    pub pou: &'s str,
    /// The action, where the diagram is one's.
    pub action: &'s str,
    pub rules: Rules,
}

/// How a diagram is executed, by the editor that drew it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// Beremiz, and OpenPLC Editor before v4.
    Beremiz,
    /// OpenPLC Editor 4 and Autonomy Edge.
    Editor4,
    Codesys,
}

impl Context<'_> {
    pub fn is_codesys(&self) -> bool {
        self.rules == Rules::Codesys
    }

    /// Whether the project declares a function with this name.
    pub fn has_function(&self, name: &str) -> bool {
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
    pub fn free(&mut self, ty: &str, context: Context<'_>) -> String {
        let mut number = 1;
        loop {
            let name = format!("{ty}{number}");
            if !context.declared.has(context.pou, &name) && self.taken.insert(name.clone()) {
                return name;
            }
            number += 1;
        }
    }
}
