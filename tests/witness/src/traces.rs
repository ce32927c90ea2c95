//! What traces name: each variable by its path, to be read and to be given a value from outside.

use crate::machine::{Machine, Stop, unknown};
use crate::places::pin_type;
use crate::shared::Window;
use crate::storage::{Cell, Place, Value};
use crate::types::Type;
use staunch_frontend::ast::VarKind;
use staunch_runtime::Value as Scalar;

/// A value that comes from outside.
#[derive(Clone, Debug)]
pub enum Input {
    Scalar(Scalar),
    Text(Vec<u8>),
}

impl<'a> Machine<'a> {
    /// Path and value of each variable, as the executors' traces name them.
    pub fn variables(&self) -> Vec<(String, String)> {
        self.places().into_iter().map(|(path, place)| (path, shown(&self.read(&place).cells[0]))).collect()
    }

    /// Gives a variable a value from outside.
    ///
    /// # Errors
    /// Where there is no such variable.
    pub fn put(&mut self, path: &str, value: Input) -> Result<(), Stop> {
        let places = self.places();
        let named = |path: &str| places.iter().find(|it| it.0.eq_ignore_ascii_case(path));
        // Which PROGRAMs run is known when they have.
        let Some((_, place)) = named(path).or_else(|| named(&format!("Globals.{path}"))) else {
            return unknown(&format!("a variable {path}"));
        };
        let cell = match value {
            Input::Scalar(it) => Cell::Scalar(it),
            Input::Text(it) => Cell::Text(it),
        };
        self.write(place, &Value { ty: place.ty.clone(), cells: vec![cell] });
        Ok(())
    }

    /// Path and place of each variable that is no whole of others.
    fn places(&self) -> Vec<(String, Place<'a>)> {
        let mut found = Vec::new();
        for it in &self.declared.globals {
            self.leaves(&format!("Globals.{}", it.name), &self.globals[&it.name.to_ascii_uppercase()], &mut found);
        }
        for (number, pou) in self.declared.pous.iter().enumerate() {
            for it in pou.variables.iter().filter(|it| it.kind == VarKind::Stat) {
                let place = &self.statics[&(number, it.name.to_ascii_uppercase())];
                let owner = pou.owner.map_or(String::new(), |it| format!("{}_", self.declared.pous[it].name));
                let name = format!("{owner}{}_{}", pou.name, it.name);
                // A global of this name makes the executors take another.
                if !self.globals.contains_key(&name.to_ascii_uppercase()) {
                    self.leaves(&format!("Globals.{name}"), place, &mut found);
                }
            }
        }
        for run in &self.runs {
            // The globals hold a PROGRAM that only others call.
            let path = if run.runs { run.name.to_owned() } else { format!("Globals.{}", run.name) };
            self.leaves(&path, &run.place, &mut found);
        }
        found
    }

    fn leaves(&self, path: &str, place: &Place<'a>, found: &mut Vec<(String, Place<'a>)>) {
        match &place.ty {
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Text(_) => {
                found.push((path.to_owned(), place.clone()));
            }
            Type::Array(array) => {
                for (number, at) in (array.low..=array.high).zip(0..) {
                    if let Some(element) = place.nth(at) {
                        self.leaves(&format!("{path}[{number}]"), &element, found);
                    }
                }
            }
            // The executors keep an array of the smallest of its parts.
            Type::Union(_) => {
                let (Some(unit), Some(bytes)) = (place.ty.smallest_part(), place.ty.bytes()) else { return };
                let start = Window { bit: 0, single: false };
                let size = usize::try_from(unit.repr().size()).unwrap_or(1);
                for number in 0..bytes.div_ceil(size) {
                    let part = place.further(start, number * size, &Type::Elementary(unit));
                    self.leaves(&format!("{path}.bytes[{number}]"), &part, found);
                }
            }
            Type::Record(record) => {
                for (number, (name, _)) in record.fields.iter().enumerate() {
                    if let Some(field) = place.field(number) {
                        self.leaves(&format!("{path}.{name}"), &field, found);
                    }
                }
            }
            // The executors' own numbers are not compared.
            Type::Reference(_) => {}
            Type::Block(info) => {
                for (number, pin) in info.pins.iter().enumerate() {
                    found.push((format!("{path}.{}", pin.name), place.part(number, &pin_type(info, number))));
                }
            }
        }
    }
}

/// A value as its bits, but for a NaN: which one it is, processors decide.
fn shown(cell: &Cell<'_>) -> String {
    match cell {
        Cell::Scalar(Scalar::F32(it)) if it.is_nan() => "NaN".to_owned(),
        Cell::Scalar(Scalar::F64(it)) if it.is_nan() => "NaN".to_owned(),
        Cell::Scalar(it) => format!("{it:?}"),
        Cell::Reference(_) => "a reference".to_owned(),
        Cell::Bytes(it) => format!("{it:?}"),
        Cell::Text(bytes) => format!("{:?}", String::from_utf8_lossy(bytes)),
    }
}
