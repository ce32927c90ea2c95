//! What a project's names stand for where they are written, in any case.

use core::ops::Range;
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::Elementary;
use staunch_runtime::{BLOCKS, Family};

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
    /// The types of members, by those of their structures: data types and instructions.
    pub members: FxHashMap<(String, String), String>,
    pub controller: Scope,
    /// Programs that are not disabled, and what they are called in Structured Text.
    pub programs: FxHashMap<String, String>,
    pub disabled_programs: FxHashSet<String>,
    /// Add-On Instructions that do something where their rung is false.
    pub runs_when_false: FxHashSet<String>,
    /// The preset and the accumulated value that rungs show of a timer or counter, and where.
    pub shown: FxHashMap<String, (Shown, Range<usize>)>,
}

/// What rungs show of a timer or counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    Values {
        preset: i32,
        accum: i32,
    },
    /// Rungs differ: several have this name.
    Several,
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
    /// Tags that are arrays.
    pub arrays: FxHashSet<String>,
    /// The types of tags, and of an instruction's parameters.
    pub types: FxHashMap<String, String>,
}

pub fn key(name: &str) -> String {
    name.to_ascii_lowercase()
}

/// A name of modules and their types as a name of Structured Text.
pub fn plain(name: &str) -> String {
    name.replace(':', "_")
}

/// Words of Structured Text that are names in Logix, in addition to those of types.
const WORDS: [&str; 39] = [
    "ACTION",
    "AND_THEN",
    "ARRAY",
    "AT",
    "CLASS",
    "CONFIGURATION",
    "CONSTANT",
    "END_VAR",
    "FUNCTION",
    "FUNCTION_BLOCK",
    "GET",
    "INTERFACE",
    "METHOD",
    "NAMESPACE",
    "NON_RETAIN",
    "NULL",
    "OR_ELSE",
    "PERSISTENT",
    "PROGRAM",
    "PROPERTY",
    "RETAIN",
    "SET",
    "STRUCT",
    "SUPER",
    "TASK",
    "TEST",
    "THIS",
    "TO",
    "TYPE",
    "UNION",
    "USING",
    "VAR",
    "VAR_ACCESS",
    "VAR_CONFIG",
    "VAR_EXTERNAL",
    "VAR_GLOBAL",
    "VAR_INPUT",
    "VAR_OUTPUT",
    "VAR_TEMP",
];

/// Words of expressions and statements, which are names of members, and of tags that no Structured Text uses.
const STATEMENT_WORDS: [&str; 27] = [
    "AND",
    "BY",
    "CASE",
    "CONTINUE",
    "DO",
    "ELSE",
    "ELSIF",
    "END_CASE",
    "END_FOR",
    "END_IF",
    "END_REPEAT",
    "END_WHILE",
    "EXIT",
    "FALSE",
    "FOR",
    "IF",
    "MOD",
    "NOT",
    "OF",
    "OR",
    "REPEAT",
    "RETURN",
    "THEN",
    "TRUE",
    "UNTIL",
    "WHILE",
    "XOR",
];

/// Whether a word means something in expressions and statements.
pub fn is_of_statements(name: &str) -> bool {
    STATEMENT_WORDS.iter().any(|it| it.eq_ignore_ascii_case(name))
}

/// What a tag or member is called whose name means something else in Structured Text. Logix has no names that end so.
pub fn legal(name: &str) -> Option<String> {
    let is_word = WORDS.iter().any(|it| it.eq_ignore_ascii_case(name));
    (is_word || is_of_statements(name) || Elementary::named(name).is_some()).then(|| format!("{name}_"))
}

/// Whether a text is a tag or a part of one: `Line.Speeds[1].3`, `Local:1:I.Data.0`, `\\Filling.Level`.
pub fn is_operand(text: &str) -> bool {
    let (base, mut rest) = split(text.strip_prefix('\\').unwrap_or(text));
    if !base.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_') {
        return false;
    }
    while !rest.is_empty() {
        let part = if let Some(inner) = rest.strip_prefix('[') {
            let Some((indices, after)) = inner.split_once(']') else { return false };
            rest = after;
            indices.split(',').all(|it| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit()))
        } else if let Some(inner) = rest.strip_prefix('.') {
            let end = inner.find(['.', '[']).unwrap_or(inner.len());
            rest = &inner[end..];
            end > 0 && inner[..end].bytes().all(|it| it.is_ascii_alphanumeric() || it == b'_')
        } else {
            false
        };
        if !part {
            return false;
        }
    }
    true
}

/// A path with each name in it as it is called in Structured Text.
fn legal_path(path: &str) -> String {
    let name = |it: &str| legal(it).unwrap_or_else(|| it.to_owned());
    path.split('.').map(name).collect::<Vec<_>>().join(".")
}

/// A name that no tag has.
pub fn free(name: &str, kind: &str, tags: &FxHashSet<String>) -> String {
    if tags.contains(&key(name)) { format!("{name}_{kind}") } else { name.to_owned() }
}

impl Names {
    /// Whether an alias stands for itself, by others.
    pub fn leads_to_itself(&self, alias: &str, scope: &Scope) -> bool {
        let mut name = alias.to_owned();
        for _ in 0..=scope.aliases.len() {
            let Some(target) = scope.aliases.get(&name) else { return false };
            name = key(split(target).0);
            if name == alias {
                return true;
            }
        }
        false
    }

    /// The type of a part of an instruction's tags, or of an element of one: `Status.Counts[2].DN`, `Flags.3`.
    pub fn type_of(&self, operand: &str, scope: &Scope) -> Option<String> {
        self.type_by_way_of(operand, scope, scope.aliases.len())
    }

    /// The same by way of so many aliases: some may stand for one another.
    fn type_by_way_of(&self, operand: &str, scope: &Scope, aliases: usize) -> Option<String> {
        let (base, mut rest) = split(operand);
        let mut ty = match scope.aliases.get(&key(base)) {
            Some(target) => self.type_by_way_of(target, scope, aliases.checked_sub(1)?)?,
            None => scope.types.get(&key(base))?.clone(),
        };
        while !rest.is_empty() {
            if let Some(inner) = rest.strip_prefix('[') {
                rest = inner.split_once(']')?.1;
                continue;
            }
            let inner = rest.strip_prefix('.')?;
            let end = inner.find(['.', '[']).unwrap_or(inner.len());
            let is_bit = inner[..end].bytes().all(|it| it.is_ascii_digit());
            ty = if is_bit { "BOOL".to_owned() } else { self.type_of_member(&ty, &inner[..end])? };
            rest = &inner[end..];
        }
        Some(ty)
    }

    fn type_of_member(&self, ty: &str, member: &str) -> Option<String> {
        let own = || BLOCKS.iter().find(|it| it.family == Family::Logix && it.is_named(ty))?.pin(member);
        let declared = self.members.get(&(key(ty), key(member))).cloned();
        declared.or_else(|| own().map(|it| it.ty.name().to_owned()))
    }

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
            let own = || legal(base).unwrap_or_else(|| plain(base));
            let shown = self.modules.get(&key(base)).cloned().unwrap_or_else(own);
            said = Some(format!("{prefix}{shown}{}{path}", legal_path(rest)));
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

/// How many bits an integer type has.
pub fn bits_of(ty: &str) -> Option<usize> {
    let repr = Elementary::named(ty)?.repr();
    usize::try_from(repr.size() * 8).ok().filter(|_| repr.is_integer())
}
