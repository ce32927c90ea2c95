//! Forced variables: they have a fixed value before and after each scan, whatever the program, its inputs and the stimulus
//! write to them.

use crate::map::Map;
use crate::stimulus::Write;
use crate::{Error, Machine, path};

/// The values, in the order of the command line.
#[derive(Debug, Default)]
pub(crate) struct Forces {
    names: Vec<String>,
    writes: Vec<Write>,
}

impl Forces {
    /// Reads `NAME=VALUE`, each value as a stimulus has it.
    pub fn parse(map: &Map, running: &[usize], texts: &[String]) -> Result<Self, Error> {
        let mut forces = Self::default();
        for text in texts {
            forces.add(map, running, text).map_err(|it| Error::Usage(format!("--force: {it}")))?;
        }
        Ok(forces)
    }

    fn add(&mut self, map: &Map, running: &[usize], text: &str) -> Result<(), String> {
        let (name, value) = text.split_once('=').ok_or_else(|| format!("`{text}` has no value: write `NAME=VALUE`"))?;
        let (name, value) = (name.trim().trim_end_matches(':').trim_end(), value.trim());
        let place = path::resolve(map, running, name)?;
        if place.constant {
            return Err(format!("`{name}` is CONSTANT and cannot be forced"));
        }
        let write = Write::parse(map, path::written(map, running, place), value)?;
        if let Some(at) = self.writes.iter().position(|it| it.overlaps(&write)) {
            return Err(match path::same(&self.names[at], name) {
                true => format!("`{name}` has two values"),
                false => format!("`{}` and `{name}` are the same variable", self.names[at]),
            });
        }
        self.names.push(name.to_owned());
        self.writes.push(write);
        Ok(())
    }

    pub fn is_empty(&self) -> bool {
        self.writes.is_empty()
    }

    /// Neither waits nor allocates.
    pub fn put(&self, machine: &mut dyn Machine) {
        self.writes.iter().for_each(|it| it.put(machine));
    }

    /// A note, so that everyone who sees the run knows that these values are not the program's.
    pub fn note(&self) -> Option<String> {
        let names: Vec<String> = self.names.iter().map(|it| format!("`{it}`")).collect();
        let verb = if names.len() == 1 { "is" } else { "are" };
        (!names.is_empty()).then(|| format!("note: {} {verb} forced", names.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{Garage, map, offset_of};

    fn forces(texts: &[&str]) -> Result<Forces, String> {
        let texts: Vec<String> = texts.iter().map(|it| (*it).to_owned()).collect();
        Forces::parse(&map(), &[0], &texts).map_err(|it| it.to_string())
    }

    #[test]
    fn values_are_those_of_a_stimulus() {
        let forces = forces(&["level=7", "main.colour := Green", "m[1,2]=-3", "name=a=b"]).unwrap();
        let mut machine = Garage::new();
        machine.init();
        forces.put(&mut machine);
        let byte = |path| machine.state()[offset_of(path)];
        assert_eq!((byte("level"), byte("colour"), byte("m[1,2]")), (7, 5, 253));
        assert_eq!(forces.note().unwrap(), "note: `level`, `main.colour`, `m[1,2]`, `name` are forced");
    }

    #[test]
    fn mistakes_say_what_to_write() {
        for (texts, expected) in [
            (&["level"][..], "--force: `level` has no value: write `NAME=VALUE`"),
            (&["limit=1"], "--force: `limit` is CONSTANT and cannot be forced"),
            (&["Level=1", "level=2"], "--force: `level` has two values"),
            (&["total=1", "main.total=2"], "--force: `total` and `main.total` are the same variable"),
            (&["levl=1"], "--force: there is no variable `levl`; did you mean `level`?"),
        ] {
            assert_eq!(forces(texts).unwrap_err(), expected);
        }
        assert!(forces(&["level=11"]).unwrap_err().starts_with("--force: `11`"));
    }
}
