//! What a project declares, as far as the types of wires need it: the variables of its POUs, what its functions return, and the
//! members of its structures.

use rustc_hash::FxHashMap;
use staunch_runtime::{BLOCKS, BlockInfo, Direction, Family};

/// Variables, pins or members, by their names in capitals, with the types as they are written.
pub type Typed = FxHashMap<String, String>;

#[derive(Debug, Default)]
pub struct Declared {
    /// POUs and structures.
    units: FxHashMap<String, Unit>,
    globals: Typed,
}

#[derive(Debug, Default)]
pub struct Unit {
    /// Of a function.
    pub result: Option<String>,
    pub variables: Typed,
}

/// Blocks of the library that is in Structured Text, with their pins.
const OF_LIBRARY: [(&str, &[(&str, &str)]); 2] = [
    ("SEMA", &[("CLAIM", "BOOL"), ("RELEASE", "BOOL"), ("BUSY", "BOOL")]),
    ("HYSTERESIS", &[("XIN1", "REAL"), ("XIN2", "REAL"), ("EPS", "REAL"), ("Q", "BOOL")]),
];

/// Whether a name is that of a standard block, which has instances.
pub fn is_standard_block(name: &str) -> bool {
    standard_block(name).is_some()
}

fn standard_block(name: &str) -> Option<&'static BlockInfo> {
    BLOCKS.iter().find(|it| it.family == Family::Iec && it.name.eq_ignore_ascii_case(name))
}

/// The type of a pin of a standard block.
fn standard_pin(block: &str, pin: &str) -> Option<&'static str> {
    if let Some(block) = standard_block(block) {
        return block.pin(pin).filter(|it| it.direction != Direction::Memory).map(|it| it.ty.name());
    }
    let (_, pins) = OF_LIBRARY.iter().find(|it| it.0.eq_ignore_ascii_case(block))?;
    pins.iter().find(|it| it.0.eq_ignore_ascii_case(pin)).map(|it| it.1)
}

impl Declared {
    /// Adds a POU or a structure.
    pub fn add(&mut self, name: &str, unit: Unit) {
        self.units.insert(name.to_ascii_uppercase(), unit);
    }

    pub fn add_globals(&mut self, variables: Typed) {
        self.globals.extend(variables);
    }

    /// The type of a function's result.
    pub fn result(&self, function: &str) -> Option<&str> {
        self.units.get(&function.to_ascii_uppercase())?.result.as_deref()
    }

    /// The type of a pin of a block, or of a member of a structure.
    pub fn member(&self, ty: &str, name: &str) -> Option<&str> {
        let ty = ty.to_ascii_uppercase();
        if let Some(unit) = self.units.get(&ty) {
            return unit.variables.get(&name.to_ascii_uppercase()).map(String::as_str);
        }
        standard_pin(&ty, name)
    }

    /// The type of what an expression names in a POU, `motor.speeds[2].actual`.
    pub fn variable(&self, pou: &str, path: &str) -> Option<String> {
        let mut parts = path.split('.');
        let (name, depth) = element(parts.next()?)?;
        let own = self.units.get(&pou.to_ascii_uppercase());
        let is_result = name.eq_ignore_ascii_case(pou);
        let first = match own.filter(|_| is_result).and_then(|it| it.result.clone()) {
            Some(result) => result,
            None => {
                let name = name.to_ascii_uppercase();
                own.and_then(|it| it.variables.get(&name)).or_else(|| self.globals.get(&name))?.clone()
            }
        };
        parts.try_fold(element_type(&first, depth)?.to_owned(), |ty, part| {
            let (name, depth) = element(part)?;
            element_type(self.member(&ty, name)?, depth).map(ToOwned::to_owned)
        })
    }

    /// Whether a POU has a variable with this name.
    pub fn has(&self, pou: &str, name: &str) -> bool {
        let found = self.units.get(&pou.to_ascii_uppercase());
        found.is_some_and(|it| it.variables.contains_key(&name.to_ascii_uppercase()))
    }
}

/// A name, and how many indices follow it.
fn element(part: &str) -> Option<(&str, usize)> {
    let (name, rest) = part.split_once('[').unwrap_or((part, ""));
    let is_name = |it: &str| !it.is_empty() && it.chars().all(|it| it.is_alphanumeric() || it == '_');
    let depth = if rest.is_empty() { 0 } else { 1 + rest.matches('[').count() };
    is_name(name.trim()).then_some((name.trim(), depth))
}

/// The type of an array's elements, `depth` arrays deep.
fn element_type(ty: &str, depth: usize) -> Option<&str> {
    (0..depth).try_fold(ty, |ty, _| {
        let is_array = ty.get(..5).is_some_and(|it| it.eq_ignore_ascii_case("ARRAY"));
        let (_, of) = ty.split_once("] OF ").filter(|_| is_array)?;
        Some(of.trim())
    })
}
