//! Rust names for Structured Text names: in Rust's case, without collisions, the same in every
//! run. Structured Text ignores case, so two names that differ there may meet in snake_case.

use std::collections::{HashMap, HashSet};

use proc_macro2::{Ident, Span};
use staunch_ir::{External, FieldId, LocalId, Location, ParamId, Program, Routine, RoutineId, RoutineKind, StructId};

use crate::alias::Origin;

/// Type names that the emitted text uses itself, or that the prelude and derives give.
const TYPES: &[&str] = &[
    "Box",
    "Clone",
    "Context",
    "Copy",
    "Debug",
    "Default",
    "Eq",
    "Err",
    "Fault",
    "FaultKind",
    "From",
    "Hash",
    "Into",
    "Location",
    "None",
    "Ok",
    "Option",
    "OrFault",
    "Ord",
    "PartialEq",
    "PartialOrd",
    "Result",
    "Self",
    "Some",
    "String",
    "Text",
    "WideText",
    "Time",
    "ToString",
    "Vec",
    "Machine",
];

/// Local names with a meaning of their own.
const LOCALS: &[&str] = &["self", "cx", "globals", "out"];

/// Functions and constants of the emitted text's own.
const FUNCTIONS: &[&str] = &["save_retained", "load_retained", "retained_stamp", "carry_retained", "named"];
const CONSTANTS: &[&str] = &["FILES", "IO", "NAMES", "TASKS", "RETAINED_SIZE", "RETAINED_PROGRAM"];

/// What the functions for retained variables call their own.
const INSTANCES: &[&str] = &["globals", "bytes", "stamp", "carrier", "element", "number", "see"];

/// What every structure has.
const METHODS: &[&str] = &["new", "default", "scan", "prescan"];

/// Words that may not even be raw identifiers.
const NEVER: &[&str] = &["self", "super", "crate", "_"];

const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn", "else", "enum",
    "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod", "move",
    "mut", "override", "priv", "pub", "ref", "return", "static", "struct", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Names that are visible together.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    taken: HashSet<String>,
    /// For each name that was wanted again, the number to try next.
    next: HashMap<String, u32>,
}

impl Scope {
    pub fn with(reserved: &[&str]) -> Self {
        Self { taken: reserved.iter().map(|it| (*it).to_owned()).collect(), next: HashMap::new() }
    }

    /// A variable's name, in Rust's case.
    pub fn claim_variable(&mut self, name: &str) -> Ident {
        self.claim(&snake(name))
    }

    /// `wanted`, or `wanted_2` and so on where that is taken.
    pub fn claim(&mut self, wanted: &str) -> Ident {
        self.claim_numbered(wanted, "_")
    }

    /// `Wanted`, or `Wanted2` and so on: in a type's name rustc wants no underscore between a
    /// letter and a digit, and needs one between two digits.
    pub fn claim_type(&mut self, wanted: &str) -> Ident {
        let after_digit = wanted.ends_with(|it: char| it.is_ascii_digit());
        self.claim_numbered(wanted, if after_digit { "_" } else { "" })
    }

    fn claim_numbered(&mut self, wanted: &str, between: &str) -> Ident {
        if self.taken.insert(wanted.to_owned()) {
            return ident(wanted);
        }
        let number = self.next.entry(wanted.to_owned()).or_insert(2);
        loop {
            let name = format!("{wanted}{between}{number}");
            *number += 1;
            if self.taken.insert(name.clone()) {
                return ident(&name);
            }
        }
    }

    /// A name no member starts with, for variables the printer makes up.
    pub fn unused_prefix(&self, wanted: &str) -> String {
        let mut prefix = wanted.to_owned();
        while self.taken.iter().any(|name| name.starts_with(&prefix)) {
            prefix.push_str("_at");
        }
        prefix
    }
}

/// The names of everything that is visible in the whole emitted file.
#[derive(Debug)]
pub struct Names {
    enums: Vec<Ident>,
    enumerators: Vec<Vec<Ident>>,
    structs: Vec<Ident>,
    fields: Vec<Vec<Ident>>,
    routines: Vec<Ident>,
    files: Vec<Ident>,
    instances: Vec<Ident>,
    /// By where they are declared.
    externals: HashMap<Location, Ident>,
    /// What a local may not be called.
    locals: Scope,
}

/// The names inside one function.
#[derive(Debug)]
pub struct LocalNames {
    pub params: Vec<Ident>,
    pub locals: Vec<Ident>,
    pub scope: Scope,
}

impl Names {
    pub fn new(program: &Program, origins: &[Origin]) -> Self {
        let shared = !program.references.is_empty();
        let mut types = Scope::with(TYPES);
        types.taken.extend(shared.then(|| "Cell".to_owned()));
        let externals = program.externals();
        if !externals.is_empty() {
            types.taken.extend(["External", "Externals"].map(str::to_owned));
        }
        let functions = claim_all(Scope::default(), externals.iter().map(|it| snake(&it.name)));
        let externals = externals.iter().map(|it| it.location).zip(functions).collect();
        let structs = program.structs.iter().map(|it| types.claim_type(&camel(&it.name))).collect();
        let enums = program.enums.iter().map(|it| types.claim_type(&camel(&it.name))).collect();
        let routines = routine_names(program, origins);
        let mut locals = Scope::with(LOCALS);
        locals.taken.extend(shared.then(|| "machine".to_owned()));
        // As they are claimed: a keyword without its `r#`.
        locals.taken.extend(routines.iter().map(|it| it.to_string().trim_start_matches("r#").to_owned()));
        Self {
            enums,
            enumerators: program
                .enums
                .iter()
                .map(|it| claim_all(Scope::default(), it.values.iter().map(|value| screaming(&value.name))))
                .collect(),
            structs,
            fields: program
                .structs
                .iter()
                .map(|it| claim_all(Scope::default(), it.fields.iter().map(|field| snake(&field.name))))
                .collect(),
            routines,
            files: claim_all(Scope::with(CONSTANTS), program.files.iter().map(|it| screaming(base_name(&it.path)))),
            instances: claim_all(Scope::with(INSTANCES), program.instances.iter().map(|it| snake(&it.name))),
            externals,
            locals,
        }
    }

    /// The function of the trait that the crate implements.
    pub fn external(&self, it: &External) -> &Ident {
        &self.externals[&it.location]
    }

    pub fn enumeration(&self, id: staunch_ir::EnumId) -> &Ident {
        &self.enums[id.index()]
    }

    pub fn enumerator(&self, id: staunch_ir::EnumId, position: usize) -> &Ident {
        &self.enumerators[id.index()][position]
    }

    pub fn structure(&self, id: StructId) -> &Ident {
        &self.structs[id.index()]
    }

    pub fn field(&self, id: StructId, field: FieldId) -> &Ident {
        &self.fields[id.index()][field.index()]
    }

    /// The function's name, or the method's.
    pub fn routine(&self, id: RoutineId) -> &Ident {
        &self.routines[id.index()]
    }

    pub fn file(&self, file: u16) -> &Ident {
        &self.files[usize::from(file)]
    }

    /// The machine's member.
    pub fn instance(&self, position: usize) -> &Ident {
        &self.instances[position]
    }

    pub fn locals(&self, routine: &Routine) -> LocalNames {
        let mut scope = self.locals.clone();
        let params: Vec<_> = routine.params.iter().map(|it| scope.claim(&snake(&it.name))).collect();
        let mut locals = Vec::with_capacity(routine.locals.len());
        for (position, local) in routine.locals.iter().enumerate() {
            let id = LocalId::next(position);
            let name = match by_value_param(routine, id) {
                Some(param) => params[param.index()].clone(),
                None if routine.result == Some(id) => scope.claim("result"),
                None => scope.claim(&snake(&local.name)),
            };
            locals.push(name);
        }
        LocalNames { params, locals, scope }
    }
}

/// The parameter whose value arrives in `local`.
pub fn by_value_param(routine: &Routine, local: LocalId) -> Option<ParamId> {
    let holds = |param: &staunch_ir::Param| matches!(param.mode, staunch_ir::Mode::Value(it) if it == local);
    routine.params.iter().position(holds).map(ParamId::next)
}

/// Free functions share one scope; the methods of a structure share another. Declared routines come
/// first, so that copies made for aliasing never change their names.
fn routine_names(program: &Program, origins: &[Origin]) -> Vec<Ident> {
    let mut functions = Scope::with(FUNCTIONS);
    let mut methods: HashMap<Option<StructId>, Scope> = HashMap::new();
    let mut names = vec![ident("scan"); program.routines.len()];
    let declared = |at: &usize| matches!(origins[*at], Origin::Declared);
    let (first, then): (Vec<_>, Vec<_>) = (0..program.routines.len()).partition(declared);
    for at in first.into_iter().chain(then) {
        let routine = &program.routines[at];
        names[at] = match (routine.kind, origins[at]) {
            (RoutineKind::Function, _) => functions.claim(&snake(&routine.name)),
            (RoutineKind::Body, Origin::Declared) if program.classes.iter().any(|it| it.body.index() == at) => {
                ident("scan")
            }
            (RoutineKind::Prescan, Origin::Declared) => ident("prescan"),
            // Another shape of the body, or a copy.
            (RoutineKind::Body, Origin::Declared)
            | (RoutineKind::Body | RoutineKind::Prescan, Origin::Apart | Origin::Copy)
            | (RoutineKind::Method, _) => {
                let scope = methods.entry(routine.state).or_insert_with(|| Scope::with(METHODS));
                scope.claim(&snake(&routine.name))
            }
        };
    }
    names
}

fn claim_all(mut scope: Scope, wanted: impl Iterator<Item = String>) -> Vec<Ident> {
    wanted.map(|name| scope.claim(&name)).collect()
}

/// The part of a path after its last slash.
pub fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

pub fn ident(name: &str) -> Ident {
    if NEVER.contains(&name) {
        Ident::new(&format!("{name}_"), Span::call_site())
    } else if KEYWORDS.contains(&name) {
        Ident::new_raw(name, Span::call_site())
    } else {
        Ident::new(name, Span::call_site())
    }
}

/// `entrySensor`, `Entry_Sensor` -> `entry_sensor`; `PV` -> `pv`; `HTTPServer` -> `http_server`.
pub fn snake(name: &str) -> String {
    let joined = words(name).join("_");
    // An identifier does not start with a digit.
    if joined.starts_with(|first: char| first.is_ascii_digit()) || joined.is_empty() {
        return format!("v{joined}");
    }
    joined
}

pub fn screaming(name: &str) -> String {
    snake(name).to_uppercase()
}

/// `parking_garage` -> `ParkingGarage`; `FB_MOTOR` -> `FbMotor`.
pub fn camel(name: &str) -> String {
    let mut camel = String::new();
    for word in words(name) {
        // `Axis1_2` and `Axis12` stay different.
        if camel.ends_with(|it: char| it.is_ascii_digit()) && word.starts_with(|it: char| it.is_ascii_digit()) {
            camel.push('_');
        }
        let mut letters = word.chars();
        camel.extend(letters.next().into_iter().flat_map(char::to_uppercase));
        camel.extend(letters);
    }
    if camel.starts_with(|first: char| first.is_ascii_digit()) || camel.is_empty() {
        camel.insert(0, 'T');
    }
    camel
}

/// The words of a name, in lower case.
fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![String::new()];
    for (at, letter) in letters.iter().enumerate() {
        let before = at.checked_sub(1).map(|it| letters[it]);
        let after = letters.get(at + 1);
        let starts = letter.is_uppercase()
            && before.is_some_and(|it| {
                it.is_lowercase()
                    || it.is_ascii_digit() && after.is_some_and(|it| it.is_lowercase())
                    || it.is_uppercase() && after.is_some_and(|it| it.is_lowercase())
            });
        if starts || *letter == '_' || !fits(*letter) {
            words.push(String::new());
        }
        if fits(*letter) && *letter != '_' {
            let word = words.last_mut().expect("there is always a word");
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Whether a letter may be in a Rust identifier.
fn fits(letter: char) -> bool {
    letter.is_ascii_alphanumeric()
        || letter == '_'
        || !letter.is_ascii() && syn::parse_str::<Ident>(&format!("a{letter}")).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases() {
        for (st, rust) in [
            ("entrySensor", "entry_sensor"),
            ("Entry_Sensor", "entry_sensor"),
            ("PV", "pv"),
            ("HTTPServer", "http_server"),
            ("CTU_1", "ctu_1"),
            ("__t", "t"),
            ("$3", "v3"),
            ("Größe", "größe"),
        ] {
            assert_eq!(snake(st), rust);
        }
        assert_eq!(camel("FB_MOTOR"), "FbMotor");
        assert_eq!(camel("ParkingGarage"), "ParkingGarage");
        assert_eq!(camel("Axis1_2"), "Axis1_2");
        assert_eq!(screaming("parking_garage.st"), "PARKING_GARAGE_ST");
    }

    #[test]
    fn collisions_and_keywords() {
        let mut scope = Scope::default();
        assert_eq!(scope.claim(&snake("fooBar")).to_string(), "foo_bar");
        assert_eq!(scope.claim(&snake("foo_bar")).to_string(), "foo_bar_2");
        assert_eq!(scope.claim(&snake("Type")).to_string(), "r#type");
        assert_eq!(scope.claim(&snake("Self")).to_string(), "self_");
    }

    #[test]
    fn types_that_rust_has_already() {
        let mut types = Scope::with(TYPES);
        for (st, rust) in [
            ("Option2", "Option2"),
            ("OPTION", "Option3"),
            ("Result", "Result2"),
            ("Self", "Self2"),
            ("Globals", "Globals"),
            ("globals", "Globals2"),
            ("Axis1", "Axis1"),
            ("AXIS1", "Axis1_2"),
        ] {
            assert_eq!(types.claim_type(&camel(st)).to_string(), rust);
        }
    }
}
