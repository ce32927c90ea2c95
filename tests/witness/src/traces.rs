//! What traces name: each variable by its path, to be read and to be given a value from outside.

use crate::machine::{Machine, Stop, unknown};
use crate::places::pin_type;
use crate::shared::Window;
use crate::storage::{Cell, Place, Value};
use crate::texts;
use crate::types::Type;
use staunch_frontend::ast::VarKind;
use staunch_runtime::Value as Scalar;

/// A value that comes from outside.
#[derive(Clone, Debug)]
pub enum Input {
    Scalar(Scalar),
    Text(Vec<u16>),
}

impl<'a> Machine<'a> {
    /// Path and value of each variable, as the executors' traces name them.
    pub fn variables(&self) -> Vec<(String, String)> {
        self.places().into_iter().map(|(path, place)| (path, shown(&place.ty, &self.read(&place).cells[0]))).collect()
    }

    /// Gives a variable a value from outside.
    ///
    /// # Errors
    /// If the variable does not exist.
    pub fn put(&mut self, path: &str, value: Input) -> Result<(), Stop> {
        let own = path.rsplit('.').next().unwrap_or_default();
        if own.starts_with("__") {
            // An event that keeps all keeps that instances have started.
            self.has_started |= own.ends_with("started") && matches!(value, Input::Scalar(Scalar::Bool(true)));
            return Ok(());
        }
        let places = self.places();
        let place = places.iter().find(|it| it.0.eq_ignore_ascii_case(path)).map(|it| it.1.clone());
        let size = match &value {
            Input::Scalar(Scalar::Bool(_)) => 0,
            Input::Scalar(it) => it.repr().size(),
            Input::Text(_) => 1,
        };
        let Some(place) = place.or_else(|| self.address_of(path, size)) else {
            return unknown(&format!("a variable {path}"));
        };
        let cell = match value {
            Input::Scalar(it) => Cell::Scalar(it),
            Input::Text(it) => Cell::Text(it),
        };
        self.write(&place, &Value { ty: place.ty.clone(), cells: vec![cell] });
        Ok(())
    }

    /// The variable at a direct address to which the executors gave their own name, of so many bytes, or of one bit.
    pub fn addressed(&self, path: &str, size: u32) -> Option<String> {
        let place = self.address_of(path, size)?;
        Some(shown(&place.ty, &self.read(&place).cells[0]))
    }

    /// `Globals.IX0_3` is `%IX0.3`; `Globals.bits_of_MB8[2]` comes two after what is at `%MB8`.
    fn address_of(&self, path: &str, size: u32) -> Option<Place<'a>> {
        let name = path.strip_prefix("Globals.")?;
        let Some(bits) = name.strip_prefix("bits_of_") else {
            return self.at_name(&name.replace('_', ".")).ok();
        };
        let (start, index) = bits.split_once('[')?;
        let start: usize = start.trim_start_matches(|it: char| it.is_ascii_alphabetic()).parse().ok()?;
        let index: usize = index.trim_end_matches(']').parse().ok()?;
        let units = [(1, "B"), (2, "W"), (4, "D"), (8, "L")];
        let (bytes, letter) = units.into_iter().find(|it| it.0 == size)?;
        let bytes = usize::try_from(bytes).ok()?;
        self.at_name(&format!("{}{letter}{}", bits.get(..1)?, start / bytes + index)).ok()
    }

    /// Path and place of each variable that does not consist of others.
    fn places(&self) -> Vec<(String, Place<'a>)> {
        let mut found = Vec::new();
        for it in &self.declared.globals {
            let place = &self.globals[&it.key];
            self.leaves(&format!("Globals.{}", it.key.replace('.', "_")), place, &mut found);
            if !self.globals.contains_key(&it.name.to_ascii_uppercase()) {
                self.leaves(&format!("Globals.{}", it.name), place, &mut found);
            }
        }
        for (number, pou) in self.declared.pous.iter().enumerate() {
            for it in pou.variables.iter().filter(|it| it.kind == VarKind::Stat) {
                let place = &self.statics[&(number, it.name.to_ascii_uppercase())];
                let owner = pou.owner.map_or(String::new(), |it| format!("{}_", self.declared.pous[it].name));
                let name = format!("{owner}{}_{}", pou.name, it.name);
                // A global with this name makes the executors take another.
                if !self.globals.contains_key(&name.to_ascii_uppercase()) {
                    self.leaves(&format!("Globals.{name}"), place, &mut found);
                }
            }
            for it in &pou.variables {
                if let Some(place) = it.address.as_ref().and_then(|at| self.at_address(at, &it.slot.ty).ok())
                    && !self.globals.contains_key(&it.name.to_ascii_uppercase())
                {
                    self.leaves(&format!("Globals.{}", it.name), &place, &mut found);
                }
            }
        }
        for run in &self.runs {
            // The globals hold a PROGRAM that only others call.
            let path = if run.runs { run.name.to_owned() } else { format!("Globals.{}", run.name) };
            self.leaves(&path, &run.place, &mut found);
            // The connected variables are next to it.
            self.leaves(&format!("{path}.program"), &run.place, &mut found);
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
fn shown(ty: &Type<'_>, cell: &Cell<'_>) -> String {
    match cell {
        Cell::Scalar(Scalar::F32(it)) if it.is_nan() => "NaN".to_owned(),
        Cell::Scalar(Scalar::F64(it)) if it.is_nan() => "NaN".to_owned(),
        Cell::Scalar(it) => format!("{it:?}"),
        Cell::Reference(_) => "a reference".to_owned(),
        Cell::Bytes(it) => format!("{it:?}"),
        Cell::Text(units) => texts::shown(units, matches!(ty, Type::Text(it) if it.wide)),
    }
}
