//! Which values a trace shows, and under which heading.

use crate::map::{Map, Section, StructureKind, Type, Variable};
use crate::path::{self, Place};
use staunch_runtime::Repr;
use std::collections::HashSet;

/// One elementary value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    pub heading: String,
    pub place: Place,
}

/// What `vars` asks for, or the globals that the programs use, and then the variables of those that
/// run: each in the order of declaration.
///
/// The error is a sentence without a full stop.
pub(crate) fn columns(map: &Map, running: &[usize], vars: Option<&str>) -> Result<Vec<Column>, String> {
    let mut columns = Vec::new();
    match vars {
        Some(vars) => {
            for name in split(vars) {
                expand(map, name.to_owned(), path::resolve(map, running, name)?, &mut columns);
            }
        }
        None => {
            used_globals(map, running, &mut columns);
            for at in running {
                let instance = &map.instances[*at];
                let prefix = if running.len() > 1 { format!("{}.", instance.name) } else { String::new() };
                for variable in &instance.variables {
                    expand(map, format!("{prefix}{}", variable.name), Place::of(variable, 0), &mut columns);
                }
            }
        }
    }
    Ok(columns)
}

/// The most numbers that one lane shows: more cannot be distinguished.
const MOST_OVERLAID: usize = 3;

/// Which columns are drawn in one lane. The error is a sentence without a full stop.
pub(crate) fn overlays(columns: &[Column], wanted: &[String]) -> Result<Vec<Vec<usize>>, String> {
    let mut taken = HashSet::new();
    let mut place = |name: &str| {
        let found = columns.iter().position(|it| path::same(&it.heading, name.trim()));
        let at = found.ok_or_else(|| {
            let near = path::nearest(name.trim(), columns.iter().map(|it| it.heading.as_str()));
            format!("`{}` is not among the variables of the trace{near}", name.trim())
        })?;
        let is_number = matches!(columns[at].place.ty, Type::Elementary(it) if it.repr() != Repr::Bool);
        match (is_number, taken.insert(at)) {
            (false, _) => Err(format!("`{}` is not a number", columns[at].heading)),
            (true, false) => Err(format!("`{}` is named twice", columns[at].heading)),
            (true, true) => Ok(at),
        }
    };
    wanted
        .iter()
        .map(|names| match split(names) {
            names if (2..=MOST_OVERLAID).contains(&names.len()) => names.into_iter().map(&mut place).collect(),
            _ => Err(format!("`{names}` is not two or three names, separated by commas")),
        })
        .collect()
}

/// TwinCAT's information about tasks, which is shown only on request.
const TOLD: &str = "TwinCAT_SystemInfoVarList.";

/// Globals that a program names itself, as VAR_EXTERNAL or by the same address, are among its variables,
/// as are those of the PROGRAM of a name, and constants show nothing.
fn used_globals(map: &Map, running: &[usize], out: &mut Vec<Column>) {
    let (globals, base) = map.globals();
    let own = running.iter().flat_map(|at| &map.instances[*at].variables).map(|it| Place::of(it, 0));
    let own: HashSet<(usize, Type)> = own.map(|it| (it.offset, it.ty)).collect();
    // A name that begins so is the compiler's own.
    let is_own = |it: &Variable| it.name.starts_with("__") || it.section == Section::Memory;
    let is_told =
        |it: &Variable| map.global_paths.iter().any(|(name, path)| *name == it.name && path.starts_with(TOLD));
    let is_run = |it: &Variable| {
        let structure = map.structure(it.ty);
        let instances = running.iter().map(|at| &map.instances[*at]).filter(|it| !it.variables.is_empty());
        structure.is_some_and(|state| instances.clone().any(|it| path::same(&it.program, &state.name)))
    };
    let is_shown = |it: &&Variable| it.used && !it.constant && !is_own(it) && !is_told(it) && !is_run(it);
    for variable in globals.iter().filter(is_shown) {
        let place = Place::of(variable, base);
        if !own.contains(&(place.offset, place.ty)) {
            expand(map, global_heading(map, variable), place, out);
        }
    }
}

/// A variable that is only there for its address has the address as its name.
fn global_heading(map: &Map, variable: &Variable) -> String {
    match &variable.address {
        Some(address) if address[1..].replace('.', "_") == variable.name => address.clone(),
        _ => map.name_of_global(&variable.name).to_owned(),
    }
}

/// Parts at commas outside brackets.
fn split(vars: &str) -> Vec<&str> {
    let mut depth = 0_usize;
    let parts = vars.split(|character| {
        match character {
            '[' => depth += 1,
            ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        character == ',' && depth == 0
    });
    parts.map(str::trim).filter(|it| !it.is_empty()).collect()
}

fn expand(map: &Map, heading: String, place: Place, out: &mut Vec<Column>) {
    match place.ty {
        Type::Elementary(_)
        | Type::Bit(_)
        | Type::Reference
        | Type::String(_)
        | Type::Characters(_)
        | Type::Enum(_) => out.push(Column { heading, place }),
        Type::Array(_) => elements(map, &heading, String::new(), place, out),
        Type::Struct(_) | Type::Block(_) => members(map, &heading, place, out),
    }
}

/// The indices of nested arrays are in one pair of brackets.
fn elements(map: &Map, heading: &str, indices: String, place: Place, out: &mut Vec<Column>) {
    let Some(array) = map.array(place.ty) else {
        return expand(map, format!("{heading}[{indices}]"), place, out);
    };
    let comma = if indices.is_empty() { "" } else { "," };
    for (position, index) in (array.low..=array.high).enumerate() {
        let element = place.part(array.element, position * array.stride);
        elements(map, heading, format!("{indices}{comma}{index}"), element, out);
    }
}

fn members(map: &Map, heading: &str, place: Place, out: &mut Vec<Column>) {
    let Some(structure) = map.structure(place.ty) else { return };
    // A PROGRAM inside of the globals is one that another program calls.
    let all = match structure.kind {
        StructureKind::Structure | StructureKind::Globals | StructureKind::Program => true,
        StructureKind::FunctionBlock | StructureKind::Standard => false,
    };
    for member in &structure.members {
        let shown = match member.section {
            Section::Input | Section::Output | Section::Member => true,
            Section::Var | Section::Global => all,
            Section::InOut | Section::Temp | Section::External | Section::Memory => false,
        };
        if shown {
            let inner = Place { range: None, ..place.member(member) };
            expand(map, format!("{heading}.{}", member.name), inner, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{MAP, map};

    fn headings(vars: Option<&str>) -> Vec<String> {
        columns(&map(), &[0], vars).unwrap().into_iter().map(|it| it.heading).collect()
    }

    #[test]
    fn every_variable_in_declaration_order() {
        let expected = "up c.CU c.R c.PV c.Q c.CV m[1,-1] m[1,0] m[1,1] m[1,2] m[2,-1] m[2,0] m[2,1] m[2,2] speed \
                        colour name pause level limit mixer.run corner.x corner.y total";
        assert_eq!(headings(None).join(" "), expected);
    }

    #[test]
    fn globals_in_use_come_first_and_once() {
        let globals = "field\ttotal\tDINT\t0\tglobal\tretain,used\t-\t-
field\tlamp\tBOOL\t4\tglobal\tused\t%QX0.1\t-
field\tQX0_5\tBOOL\t5\tglobal\tused\t%QX0.5\t-
field\tspare\tBOOL\t6\tglobal\t-\t-\t-
field\tfixed\tBOOL\t7\tglobal\tconstant,used\t-\t-\t-
";
        let (before, after) = MAP.split_at(MAP.find("field\ttotal").unwrap());
        let map = Map::parse(&format!("{before}{globals}{}", &after[after.find("block").unwrap()..])).unwrap();
        let columns = columns(&map, &[0], None).unwrap();
        let headings: Vec<&str> = columns.iter().map(|it| it.heading.as_str()).collect();
        assert_eq!(headings[..3], ["lamp", "%QX0.5", "up"]);
        assert_eq!(headings.iter().filter(|it| **it == "total").count(), 1);
        assert!(!headings.contains(&"spare") && !headings.contains(&"fixed"), "{headings:?}");
    }

    #[test]
    fn asked_for_variables_keep_their_text() {
        assert_eq!(headings(Some("C.cv, m[2,-1],c.m,globals.LAMP")), ["C.cv", "m[2,-1]", "c.m", "globals.LAMP"]);
        assert_eq!(headings(Some("corner,")), ["corner.x", "corner.y"]);
        assert!(columns(&map(), &[0], Some("nothing")).is_err());
    }

    #[test]
    fn several_programs_have_prefixes() {
        let mut map = map();
        map.instances.push(map.instances[0].clone());
        map.instances[1].name = "other".to_owned();
        let columns = columns(&map, &[0, 1], None).unwrap();
        assert_eq!(columns[0].heading, "main.up");
        assert_eq!(columns.last().unwrap().heading, "other.total");
    }
}
