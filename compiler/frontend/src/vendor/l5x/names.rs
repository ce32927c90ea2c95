//! What a project's names stand for where they are written, in any case.

use rustc_hash::{FxHashMap, FxHashSet};

/// What is known of a project when its logic is read.
#[derive(Debug, Default)]
pub struct Names {
    /// Module-defined tags, `Local:1:I`, and the variables that they are.
    pub modules: FxHashMap<String, String>,
    /// Types that modules define and that have been declared.
    pub module_types: FxHashSet<String>,
    /// Of each Add-On Instruction the operands that a call gives, after its tag.
    pub instructions: FxHashMap<String, Vec<Operand>>,
    /// Of an instruction, by its name: parameters that are other names of parts of its local tags.
    pub alias_parameters: FxHashSet<(String, String)>,
    pub controller: Scope,
    /// Programs that are not disabled, and what they are called in Structured Text.
    pub programs: FxHashMap<String, String>,
}

/// A parameter that each call gives.
#[derive(Clone, Debug)]
pub struct Operand {
    pub name: String,
    pub is_output: bool,
}

/// The tags of a controller, a program or an instruction.
#[derive(Debug, Default)]
pub struct Scope {
    pub tags: FxHashSet<String>,
    /// What they are other names of.
    pub aliases: FxHashMap<String, String>,
}

pub fn key(name: &str) -> String {
    name.to_ascii_lowercase()
}

/// A name of modules and their types as a name of Structured Text.
pub fn plain(name: &str) -> String {
    name.replace(':', "_")
}

/// A name that no tag has.
pub fn free(name: &str, kind: &str, tags: &FxHashSet<String>) -> String {
    if tags.contains(&key(name)) { format!("{name}_{kind}") } else { name.to_owned() }
}

impl Names {
    /// What a name in a program's or an instruction's logic stands for, where that is another name.
    pub fn meaning(&self, name: &str, scope: &Scope) -> Option<String> {
        let mut name = key(name);
        let mut said: Option<String> = None;
        // An alias of an alias, and so on; those that name one another are nothing.
        for _ in 0..=(scope.aliases.len() + self.controller.aliases.len()) {
            let (target, is_controllers) = match scope.aliases.get(&name) {
                Some(target) => (target, false),
                None if scope.tags.contains(&name) => return said,
                None => match self.controller.aliases.get(&name) {
                    Some(target) => (target, true),
                    None => return said,
                },
            };
            let (base, rest) = split(target);
            let path = said.as_deref().map_or("", |it| split(it).1);
            let base_is_hidden = is_controllers && scope.tags.contains(&key(base));
            let prefix = if base_is_hidden { "Globals." } else { "" };
            let shown = self.modules.get(&key(base)).cloned().unwrap_or_else(|| plain(base));
            said = Some(format!("{prefix}{shown}{rest}{path}"));
            if base_is_hidden {
                return said;
            }
            name = key(base);
        }
        said
    }
}

/// The tag that an operand begins with, and what follows it.
pub fn split(operand: &str) -> (&str, &str) {
    let end = operand.find(|it: char| !it.is_ascii_alphanumeric() && it != '_' && it != ':');
    operand.split_at(end.unwrap_or(operand.len()))
}
