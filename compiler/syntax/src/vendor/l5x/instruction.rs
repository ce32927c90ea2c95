//! Add-On Instructions as FUNCTION_BLOCKs: the routine `Logic` is the body.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::xml::{Broken, Element, Part, Reader};
use super::data;
use super::logic::Logic;
use super::names::{Names, Operand, Scope, key, legal};
use super::program::{Body, Routine, in_words, routines, subroutines};
use super::tag;
use core::ops::Range;
use rustc_hash::FxHashMap;

struct Instruction<'t> {
    name: &'t str,
    end: Range<usize>,
    declaration: Vec<Chunk>,
    scope: Scope,
    operands: Vec<Operand>,
    routines: Vec<Routine<'t>>,
    /// It has a routine for the prescan.
    is_prescanned: bool,
    /// It has a routine for rungs that are false.
    runs_when_false: bool,
    /// Parameters that are other names of parts of local tags, and that calls have to give.
    alias_operands: Vec<Range<usize>>,
    /// All of these, which others read, and write where they are inputs.
    alias_parameters: Vec<Alias<'t>>,
}

struct Alias<'t> {
    name: &'t str,
    is_input: bool,
    place: Range<usize>,
}

/// The instructions in an element that was opened, to its end. One may call another that comes after it.
pub fn all<'t>(file: &'t str, reader: &mut Reader<'t>, names: &mut Names, out: &mut Assembly) -> Result<(), Broken> {
    let mut all = Vec::new();
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if element.name == "AddOnInstructionDefinition" => {
                let it = instruction(file, reader, &element, names)?;
                names.instructions.insert(key(it.name), it.operands.clone());
                names.alias_parameters.extend(it.scope.aliases.keys().map(|alias| (key(it.name), alias.clone())));
                let members = it.scope.types.iter().map(|(tag, ty)| ((key(it.name), tag.clone()), ty.clone()));
                names.members.extend(members);
                if it.runs_when_false {
                    names.runs_when_false.insert(key(it.name));
                }
                all.push(it);
            }
            Part::Open(element) => {
                if element.name == "EncodedData" {
                    let name = element.attribute(file, "Name").unwrap_or_default();
                    let message = format!("the Add-On Instruction `{name}` is protected: its source is encrypted");
                    out.problem(Trouble::NotSupported, message, &element.place);
                }
                reader.skip()?;
            }
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    all.into_iter().for_each(|it| it.write(file, names, out));
    Ok(())
}

fn instruction<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    element: &Element<'t>,
    names: &Names,
) -> Result<Instruction<'t>, Broken> {
    let mut it = Instruction {
        name: element.attribute(file, "Name").unwrap_or_default(),
        end: 0..0,
        declaration: Vec::new(),
        scope: Scope::default(),
        operands: Vec::new(),
        routines: Vec::new(),
        is_prescanned: element.attribute(file, "ExecutePrescan") == Some("true"),
        runs_when_false: element.attribute(file, "ExecuteEnableInFalse") == Some("true"),
        alias_operands: Vec::new(),
        alias_parameters: Vec::new(),
    };
    it.declaration.push(Chunk::words("FUNCTION_BLOCK ", &element.place));
    it.declaration.extend(element.attribute_text(file, "Name"));
    it.declaration.push(Chunk::words("\n", &element.place));
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(part) => match part.name {
                "Parameters" => it.parameters(file, reader, names)?,
                "LocalTags" => it.declaration.extend(tag::tags(file, reader, "VAR", names, &mut it.scope)?),
                "Routines" => it.routines = routines(file, reader)?,
                _ => reader.skip()?,
            },
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    it.end = reader.last();
    Ok(it)
}

impl<'t> Instruction<'t> {
    fn parameters(&mut self, file: &'t str, reader: &mut Reader<'t>, names: &Names) -> Result<(), Broken> {
        while let Some(part) = reader.part()? {
            match part {
                Part::Open(element) => self.parameter(file, reader, &element, names)?,
                Part::Text(_) => {}
                Part::Close => break,
            }
        }
        Ok(())
    }

    fn parameter(
        &mut self,
        file: &'t str,
        reader: &mut Reader<'t>,
        element: &Element<'t>,
        names: &Names,
    ) -> Result<(), Broken> {
        let attribute = |it: &str| element.attribute(file, it).unwrap_or_default();
        let (name, usage) = (attribute("Name"), attribute("Usage"));
        if attribute("TagType") == "Alias" {
            self.scope.aliases.insert(key(name), attribute("AliasFor").to_owned());
            self.alias_parameters.push(Alias { name, is_input: usage == "Input", place: element.place.clone() });
            if attribute("Required") == "true" {
                self.alias_operands.push(element.place.clone());
            }
            return reader.skip();
        }
        self.scope.tags.insert(key(name));
        self.scope.types.insert(key(name), tag::type_name(file, element));
        let is_output = usage == "Output";
        if attribute("Required") == "true" || usage == "InOut" {
            self.operands.push(Operand { name: legal(name).unwrap_or_else(|| name.to_owned()), is_output });
        }
        let head = match usage {
            "Output" => "VAR_OUTPUT ",
            "InOut" => "VAR_IN_OUT ",
            _ => "VAR_INPUT ",
        };
        if name.eq_ignore_ascii_case("EnableIn") {
            // In Structured Text an instruction that is called is enabled.
            self.declaration.push(Chunk::words("VAR_INPUT EnableIn : BOOL := TRUE; END_VAR\n", &element.place));
            return reader.skip();
        }
        self.declaration.extend(tag::tag(file, reader, element, head.to_owned(), names)?);
        Ok(())
    }

    /// A parameter that is an alias, as a PROPERTY: what it stands for is seen from inside alone.
    fn property(&self, alias: &Alias<'t>, names: &Names, out: &mut Assembly) {
        let Alias { name, is_input, place } = alias;
        let (Some(target), Some(ty)) = (names.meaning(name, &self.scope), names.type_of(name, &self.scope)) else {
            return;
        };
        let (name, ty) = (legal(name).unwrap_or_else(|| (*name).to_owned()), data::ty_text(&ty).unwrap_or(ty));
        out.write(&format!("PROPERTY {name} : {ty}\nGET\n{name} := {target};\nEND_GET\n"), place);
        if *is_input {
            out.write(&format!("SET\n{target} := {name};\nEND_SET\n"), place);
        }
        out.write("END_PROPERTY\n", place);
    }

    fn write(mut self, file: &'t str, names: &Names, out: &mut Assembly) {
        let mut routines = core::mem::take(&mut self.routines);
        let logic = Logic {
            file,
            names,
            scope: &self.scope,
            actions: FxHashMap::default(),
            subroutines: subroutines(&routines),
            first_scan: None,
            main: "",
        };
        out.copy(file, &self.declaration);
        in_words(&mut routines, "Logic", &logic, &self.end, out);
        self.alias_parameters.iter().for_each(|it| self.property(it, names, out));
        for place in &self.alias_operands {
            let message = format!("an operand of `{}` is an alias of a part of a local tag", self.name);
            out.problem(Trouble::NotSupported, message, place);
        }
        let named = |name: &str| routines.iter().find(|it| it.name.eq_ignore_ascii_case(name));
        if self.scope.tags.contains("enableout") {
            out.write("EnableOut := EnableIn;\n", &self.end);
        }
        if let Some(routine) = named("EnableInFalse").filter(|_| self.runs_when_false) {
            out.write("IF NOT EnableIn THEN\n", &routine.place);
            routine.write(self.name, &logic, out);
            out.write("RETURN;\nEND_IF;\n", &routine.place);
        }
        for routine in &routines {
            if routine.name.eq_ignore_ascii_case("Logic") {
                routine.write(self.name, &logic, out);
            } else if self.is_prescanned && routine.name.eq_ignore_ascii_case("Prescan") && routine.holds_any(file) {
                let message = format!("the routine `Prescan` of `{}` would run before the first scan", self.name);
                out.problem(Trouble::NotSupported, message, &routine.place);
            }
            // A postscan is one of charts.
        }
        out.write("END_FUNCTION_BLOCK\n", &self.end);
    }
}

impl Routine<'_> {
    fn holds_any(&self, file: &str) -> bool {
        match &self.body {
            Body::Text(chunks) => chunks.iter().any(|it| !file[it.place.clone()].trim().is_empty()),
            Body::Rungs(rungs) => !rungs.is_empty(),
            Body::Other(..) => true,
        }
    }
}
