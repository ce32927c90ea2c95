//! A call of each standard function at each type that its signature takes, as programs: what "for every type" means.

use staunch_frontend::{Dialect, standard_functions};
use staunch_runtime::{Class, Elementary, Kind, Parameter, Signature};
use std::fmt::Write;

/// A standard function as a dialect has it.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub signature: &'static Signature,
}

/// The rows of a dialect, by name.
pub fn rows(dialect: Dialect) -> Vec<Row> {
    let mut rows: Vec<_> = standard_functions(dialect).map(|signature| Row { signature }).collect();
    rows.sort_by_key(|it| {
        (it.signature.name, it.signature.parameters.len(), it.signature.parameters[..].first().map(|it| it.name))
    });
    rows.retain(|it| !it.signature.parameters.is_empty());
    rows
}

/// A type that a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    Elementary(Elementary),
    String,
    Wstring,
}

impl Taken {
    pub fn all() -> impl Iterator<Item = Self> {
        // An LTIME without a sign is one of CODESYS, under the same name.
        let named = Elementary::ALL.into_iter().filter(|it| *it != Elementary::Ultime);
        named.map(Self::Elementary).chain([Self::String, Self::Wstring])
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Elementary(it) => it.name(),
            Self::String => "STRING",
            Self::Wstring => "WSTRING",
        }
    }

    fn class(self) -> Class {
        match self {
            Self::Elementary(it) => it.class(),
            Self::String | Self::Wstring => Class::String,
        }
    }

    /// A value of the type, another for each number.
    fn value(self, number: usize) -> String {
        let small = number + 2;
        let name = self.name();
        match self {
            Self::String => format!("'{}'", &"abcabc"[..small.min(6)]),
            Self::Wstring => format!("\"{}\"", &"abcabc"[..small.min(6)]),
            Self::Elementary(Elementary::Bool) => ["TRUE", "FALSE"][number % 2].to_owned(),
            Self::Elementary(Elementary::Char) => format!("'{}'", ["b", "a", "c"][number % 3]),
            Self::Elementary(Elementary::Wchar) => format!("\"{}\"", ["b", "a", "c"][number % 3]),
            Self::Elementary(it) if it.is_real() => format!("{name}#0.{small}5"),
            Self::Elementary(it) if it.is_duration() => format!("{name}#{small}s7ms"),
            Self::Elementary(it) if it.is_day() => format!("{name}#2024-02-0{small}"),
            Self::Elementary(it) if it.is_time_of_day() => format!("{name}#0{small}:30:15"),
            Self::Elementary(it) if it.is_date_and_time() => format!("{name}#2024-02-0{small}-01:02:03"),
            Self::Elementary(_) => format!("{name}#{small}"),
        }
    }
}

/// What operators take that is not the class of their row.
fn class_of(signature: &Signature) -> Class {
    match signature.name {
        // A TIME is multiplied and divided by a number (edition 3, table 35).
        "MUL" | "DIV" => Class::Num,
        _ => signature.class,
    }
}

/// Whether a value of a type outside the class is still accepted, as docs/semantics.md says.
fn is_allowed(class: Class, name: &str, ty: Taken) -> bool {
    let own = ty.class();
    match class {
        // Functions of reals take integers.
        Class::Real => Class::Int.contains(own),
        // Integers are shifted and turned.
        Class::Bit => ["SHL", "SHR", "ROL", "ROR"].contains(&name) && Class::Int.contains(own),
        // The difference of two dates is a duration.
        Class::Magnitude => name == "SUB" && Class::Date.contains(own),
        _ => false,
    }
}

impl Row {
    /// The types of the arguments in each call: one parameter, or all that are `T`, at each type it takes, the others at one.
    pub fn accepted(&self) -> Vec<Vec<Taken>> {
        let mut calls = Vec::new();
        for (at, varied) in self.varied() {
            for ty in Taken::all().filter(|it| self.takes(varied, *it)) {
                calls.push(self.call(at, ty));
            }
        }
        calls.retain(|it| self.has_values(it));
        calls.dedup();
        calls
    }

    /// The same at the types that it does not take.
    pub fn refused(&self) -> Vec<Vec<Taken>> {
        let mut calls = Vec::new();
        for (at, varied) in self.varied() {
            let allowed = |it: &Taken| match varied.kind {
                Kind::T => is_allowed(class_of(self.signature), self.signature.name, *it),
                _ => false,
            };
            for ty in Taken::all().filter(|it| !self.takes(varied, *it) && !allowed(it)) {
                calls.push(self.call(at, ty));
            }
        }
        calls
    }

    /// Each parameter whose type is open; `T` once.
    fn varied(&self) -> Vec<(usize, Parameter)> {
        let mut varied: Vec<(usize, Parameter)> = Vec::new();
        for (at, parameter) in self.signature.parameters.iter().enumerate() {
            let again =
                |it: &(usize, Parameter)| it.1.kind == parameter.kind && matches!(it.1.kind, Kind::T | Kind::AnyString);
            if !varied.iter().any(again) {
                varied.push((at, *parameter));
            }
        }
        varied
    }

    fn takes(&self, parameter: Parameter, ty: Taken) -> bool {
        match parameter.kind {
            Kind::T => class_of(self.signature).contains(ty.class()) && !self.leaves_out(ty),
            Kind::Any(class) => class.contains(ty.class()),
            Kind::Is(it) => widens(ty, it),
            Kind::String => is_text(ty, false),
            Kind::Wstring => is_text(ty, true),
            Kind::AnyString => is_text(ty, false) || is_text(ty, true),
        }
    }

    /// Strings have no order of their bytes, and other bytes of days and times of day are none.
    fn leaves_out(&self, ty: Taken) -> bool {
        let has_no_order = match ty {
            Taken::String | Taken::Wstring => true,
            Taken::Elementary(it) => it.is_day() || it.is_time_of_day(),
        };
        self.signature.name.contains("ENDIAN") && has_no_order
    }

    /// The arguments' types with that of one parameter, and of all of its kind where that is one type in a call.
    fn call(&self, at: usize, ty: Taken) -> Vec<Taken> {
        let varied = self.signature.parameters[at].kind;
        let of = |(number, parameter): (usize, &Parameter)| {
            let together = matches!(varied, Kind::T | Kind::AnyString) && parameter.kind == varied;
            if number == at || together { ty } else { self.usual(*parameter) }
        };
        self.signature.parameters.iter().enumerate().map(of).collect()
    }

    /// The type of a parameter while another one's is looked at.
    fn usual(&self, parameter: Parameter) -> Taken {
        let first = |it: &Taken| self.takes(parameter, *it);
        match parameter.kind {
            Kind::Is(it) => Taken::Elementary(it),
            Kind::Any(Class::Int | Class::Num) => Taken::Elementary(Elementary::Int),
            Kind::String | Kind::AnyString => Taken::String,
            Kind::Wstring => Taken::Wstring,
            Kind::T | Kind::Any(_) => Taken::all().find(first).unwrap_or(Taken::String),
        }
    }

    /// A year needs more than a byte.
    fn has_values(&self, types: &[Taken]) -> bool {
        let narrow = |it: &Taken| matches!(it, Taken::Elementary(it) if it.repr().size() == 1);
        self.signature.parameters.iter().zip(types).all(|(it, ty)| it.name != "YEAR" || !narrow(ty))
    }

    /// The type of the variable that gets the result.
    fn result(&self, types: &[Taken]) -> &'static str {
        let of = |kind: Kind| {
            let at = self.signature.parameters.iter().position(|it| it.kind == kind);
            at.map_or("STRING", |at| types[at].name())
        };
        match self.signature.result {
            Kind::T => of(Kind::T),
            Kind::AnyString => match of(Kind::AnyString) {
                "CHAR" => "STRING",
                "WCHAR" => "WSTRING",
                name => name,
            },
            Kind::Is(it) => it.name(),
            Kind::String => "STRING",
            Kind::Wstring => "WSTRING",
            Kind::Any(_) => "DINT",
        }
    }

    /// A PROGRAM with a line for each call.
    pub fn program(&self, name: &str, calls: &[Vec<Taken>]) -> String {
        let (mut variables, mut body) = (String::new(), String::new());
        for (number, types) in calls.iter().enumerate() {
            let mut arguments = Vec::new();
            for (at, (parameter, ty)) in self.signature.parameters.iter().zip(types).enumerate() {
                let value = match parameter.name {
                    "YEAR" => format!("{}#1984", ty.name()),
                    "K" => format!("{}#1", ty.name()),
                    _ => ty.value(at),
                };
                let _ = writeln!(variables, "    v{number}_{at} : {} := {value};", ty.name());
                arguments.push(format!("v{number}_{at}"));
            }
            let _ = writeln!(variables, "    r{number} : {};", self.result(types));
            let _ = writeln!(body, "r{number} := {}({});", self.signature.name, arguments.join(", "));
        }
        format!("PROGRAM {name}\nVAR\n{variables}END_VAR\n{body}END_PROGRAM\n")
    }
}

/// Whether a value of the type is one of a parameter's, by the standard's figure of implicit conversions.
fn widens(from: Taken, to: Elementary) -> bool {
    let Taken::Elementary(from) = from else { return false };
    let long = |ty: Elementary| match ty {
        Elementary::Time => Elementary::Ltime,
        Elementary::Date => Elementary::Ldate,
        Elementary::Tod => Elementary::Ltod,
        Elementary::Dt => Elementary::Ldt,
        other => other,
    };
    from == to || long(from) == to
}

fn is_text(ty: Taken, wide: bool) -> bool {
    match ty {
        Taken::String | Taken::Elementary(Elementary::Char) => !wide,
        Taken::Wstring | Taken::Elementary(Elementary::Wchar) => wide,
        Taken::Elementary(_) => false,
    }
}

/// All rows of the standard in one program, a PROGRAM each.
pub fn program() -> String {
    let rows = rows(Dialect::Iec).into_iter().enumerate();
    rows.map(|(number, row)| row.program(&format!("Row{number}"), &row.accepted())).collect()
}
