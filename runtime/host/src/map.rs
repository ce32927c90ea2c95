//! The map: which variable is where. The compiler writes it as text, one record per line.

use crate::Error;
use crate::pin::Pin;
use crate::remote::Remote;
use staunch_runtime::{Elementary, Repr, StringType};
use std::collections::BTreeMap;

/// The version of the text that this host reads.
const VERSION: &str = "1";

/// Types, instances and variables of one program.
#[derive(Clone, Debug, Default)]
pub struct Map {
    /// Bytes of the whole state.
    pub size: usize,
    pub align: usize,
    /// The version of the compiler.
    pub compiler: String,
    /// Source paths, as the user named them; a fault names one by its number.
    pub files: Vec<String>,
    /// The least and the greatest TIME in milliseconds, where a TIME is a whole number of those.
    pub(crate) milliseconds: Option<(i64, i64)>,
    pub(crate) enums: BTreeMap<u32, Enum>,
    pub(crate) arrays: BTreeMap<u32, Array>,
    pub(crate) structs: BTreeMap<u32, Structure>,
    pub(crate) blocks: BTreeMap<u32, Structure>,
    /// The structure of the global variables, and where it lies.
    pub(crate) globals: Option<(Type, usize)>,
    /// What references may name, by its number from 1: the offset and the size.
    pub(crate) objects: Vec<(usize, usize)>,
    /// Of globals in a NAMESPACE or a list: the name among the globals, and that in full.
    pub(crate) global_paths: Vec<(String, String)>,
    /// What takes its value from an input before each scan: the type, the offset and the input's address.
    pub(crate) bound: Vec<(Type, usize, String)>,
    /// What a run in real time reads from and writes to.
    pub(crate) remotes: Vec<Remote>,
    pub(crate) pins: Vec<Pin>,
    /// Of outputs, by name or address, and the values as they are written.
    pub(crate) safe: Vec<(String, String)>,
    pub instances: Vec<Instance>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    Elementary(Elementary),
    /// A BOOL that is this bit of a byte.
    Bit(u8),
    /// A string of at most this many bytes.
    String(StringType),
    /// One in a UNION: its characters, a zero and what follows.
    Characters(StringType),
    Enum(u32),
    Array(u32),
    Struct(u32),
    Block(u32),
    /// A reference to a variable.
    Reference,
}

#[derive(Clone, Debug)]
pub(crate) struct Enum {
    pub name: String,
    pub repr: Repr,
    pub values: Vec<(String, i128)>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Array {
    pub low: i64,
    pub high: i64,
    pub element: Type,
    /// Bytes from one element to the next.
    pub stride: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StructureKind {
    /// A user's structure type.
    Structure,
    FunctionBlock,
    Program,
    Globals,
    /// A function block or structure of the standard.
    Standard,
}

#[derive(Clone, Debug)]
pub struct Structure {
    pub name: String,
    pub size: usize,
    pub kind: StructureKind,
    pub members: Vec<Variable>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    Input,
    Output,
    InOut,
    Var,
    Temp,
    Global,
    External,
    /// A standard block's edge and timer memory.
    Memory,
    /// What everyone may read and write in a standard structure.
    Member,
}

/// A member of a structure, or a variable of an instance.
#[derive(Clone, Debug)]
pub struct Variable {
    /// In the declaration's spelling.
    pub name: String,
    pub ty: Type,
    /// In its structure; in the whole state for a variable of an instance.
    pub offset: usize,
    pub section: Section,
    pub retain: bool,
    /// Kept with all that is inside.
    pub whole: bool,
    /// Kept so over IDLE -> RUN.
    pub stays: bool,
    /// Starts again, although the variable around it is retained.
    pub restarts: bool,
    pub constant: bool,
    /// Of a global: some instance uses it.
    pub used: bool,
    /// Some bits of another variable.
    pub view: bool,
    /// `%IX0.0`
    pub address: Option<String>,
    pub range: Option<(i128, i128)>,
}

/// One running PROGRAM.
#[derive(Clone, Debug)]
pub struct Instance {
    pub name: String,
    pub program: String,
    pub ty: Type,
    pub offset: usize,
    /// Nanoseconds between two scans, if a TASK says so.
    pub interval: Option<i64>,
    /// Lower runs first among those that are due together.
    pub priority: u32,
    /// In declaration order.
    pub variables: Vec<Variable>,
}

impl Map {
    /// Whether a run in real time reads from and writes to something.
    pub(crate) fn is_connected(&self) -> bool {
        !self.remotes.is_empty() || !self.pins.is_empty()
    }

    /// The same with these safe values of outputs, by name or address.
    #[must_use]
    pub fn with_safe(self, safe: Vec<(String, String)>) -> Self {
        Self { safe, ..self }
    }

    /// Reads the text that the compiler wrote.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let mut map = Self::default();
        let mut open: Option<Type> = None;
        for (number, line) in text.lines().enumerate() {
            let mut record = Record { line: number + 1, cells: line.split('\t') };
            map.record(&mut record, &mut open)?;
        }
        match map.size {
            0 if map.instances.is_empty() => Err(Error::Map { line: 1, text: "it is empty".to_owned() }),
            _ => map.checked(),
        }
    }

    fn record(&mut self, record: &mut Record<'_>, open: &mut Option<Type>) -> Result<(), Error> {
        match record.text()? {
            "map" => record.version(),
            "compiler" => {
                record.text()?.clone_into(&mut self.compiler);
                Ok(())
            }
            "machine" => {
                (self.size, self.align) = (record.number()?, record.number()?);
                Ok(())
            }
            "file" => record.file().map(|path| self.files.push(path)),
            "times" => {
                self.milliseconds = Some((record.number()?, record.number()?));
                Ok(())
            }
            "enum" => {
                let (id, enumeration) = record.enumeration()?;
                self.enums.insert(id, enumeration);
                Ok(())
            }
            "array" => {
                let (id, array) = record.array()?;
                self.arrays.insert(id, array);
                Ok(())
            }
            "struct" => {
                let (id, structure) = record.structure(StructureKind::Structure)?;
                *open = Some(Type::Struct(id));
                self.structs.insert(id, structure);
                Ok(())
            }
            "block" => {
                let (id, structure) = record.structure(StructureKind::Standard)?;
                *open = Some(Type::Block(id));
                self.blocks.insert(id, structure);
                Ok(())
            }
            "field" => self.field(record, *open),
            "object" => {
                self.objects.push((record.number()?, record.number()?));
                Ok(())
            }
            "path" => {
                let name = record.text()?.to_owned();
                self.global_paths.push((name, record.text()?.to_owned()));
                Ok(())
            }
            "bound" => {
                let (ty, offset) = (record.ty()?, record.number()?);
                self.bound.push((ty, offset, record.text()?.to_owned()));
                Ok(())
            }
            "remote" => {
                let remote =
                    Remote::parse(&mut record.cells).ok_or_else(|| record.error("a server that does not read"))?;
                self.remotes.push(remote);
                Ok(())
            }
            "register" => {
                let (name, place) = (record.text()?.to_owned(), record.text()?.to_owned());
                let remote = self.remotes.last_mut().ok_or_else(|| record.error("a register of no server"))?;
                remote.variables.push((name, place));
                Ok(())
            }
            "safe" => {
                let name = record.text()?.to_owned();
                self.safe.push((name, record.text()?.to_owned()));
                Ok(())
            }
            "gpio" => {
                let pin = Pin::parse(&mut record.cells).ok_or_else(|| record.error("a line that does not read"))?;
                self.pins.push(pin);
                Ok(())
            }
            "globals" => {
                self.globals = Some((record.ty()?, record.number()?));
                Ok(())
            }
            "instance" => record.instance().map(|it| self.instances.push(it)),
            "variable" => self.variable(record),
            // A later version may add records; what is known keeps its meaning.
            _ => Ok(()),
        }
    }

    fn field(&mut self, record: &mut Record<'_>, open: Option<Type>) -> Result<(), Error> {
        let name = record.text()?.to_owned();
        let (ty, offset, section) = (record.ty()?, record.number()?, record.section()?);
        let member = record.attributes(Variable::new(name, ty, offset, section))?;
        let structure = match open {
            Some(Type::Struct(id)) => self.structs.get_mut(&id),
            Some(Type::Block(id)) => self.blocks.get_mut(&id),
            _ => None,
        };
        structure.ok_or_else(|| record.error("a field outside a structure"))?.members.push(member);
        Ok(())
    }

    fn variable(&mut self, record: &mut Record<'_>) -> Result<(), Error> {
        let number: usize = record.number()?;
        let name = record.text()?.to_owned();
        let (section, ty, offset) = (record.section()?, record.ty()?, record.number()?);
        let variable = record.attributes(Variable::new(name, ty, offset, section))?;
        let instance = self.instances.get_mut(number);
        instance.ok_or_else(|| record.error("a variable of no instance"))?.variables.push(variable);
        Ok(())
    }

    /// Every type that is named exists, so that later look-ups need no errors.
    fn checked(self) -> Result<Self, Error> {
        let structures = self.structs.values().chain(self.blocks.values());
        let members = structures.flat_map(|it| &it.members).map(|it| it.ty);
        let variables = self.instances.iter().flat_map(|it| &it.variables).map(|it| it.ty);
        let roots = self.instances.iter().map(|it| it.ty).chain(self.globals.map(|it| it.0));
        let elements = self.arrays.values().map(|it| it.element);
        let bound = self.bound.iter().map(|it| it.0);
        let mut all = members.chain(variables).chain(roots).chain(elements).chain(bound);
        match all.find(|ty| !self.knows(*ty)) {
            Some(ty) => Err(Error::Map { line: 0, text: format!("{ty:?} is not in it") }),
            None => Ok(self),
        }
    }

    fn knows(&self, ty: Type) -> bool {
        match ty {
            Type::Elementary(_) | Type::Bit(_) | Type::Reference | Type::String(_) | Type::Characters(_) => true,
            Type::Enum(id) => self.enums.contains_key(&id),
            Type::Array(id) => self.arrays.contains_key(&id),
            Type::Struct(id) => self.structs.contains_key(&id),
            Type::Block(id) => self.blocks.contains_key(&id),
        }
    }

    /// The members of a structure, or of an instance of a block.
    pub fn structure(&self, ty: Type) -> Option<&Structure> {
        match ty {
            Type::Struct(id) => self.structs.get(&id),
            Type::Block(id) => self.blocks.get(&id),
            Type::Elementary(_)
            | Type::Bit(_)
            | Type::Reference
            | Type::String(_)
            | Type::Characters(_)
            | Type::Enum(_)
            | Type::Array(_) => None,
        }
    }

    pub(crate) fn array(&self, ty: Type) -> Option<Array> {
        match ty {
            Type::Array(id) => self.arrays.get(&id).copied(),
            Type::Elementary(_)
            | Type::Bit(_)
            | Type::String(_)
            | Type::Characters(_)
            | Type::Enum(_)
            | Type::Struct(_)
            | Type::Block(_)
            | Type::Reference => None,
        }
    }

    /// A global's name as a user would write it: in full, where several have the short one.
    pub(crate) fn name_of_global<'m>(&'m self, name: &'m str) -> &'m str {
        let path = self.global_paths.iter().find(|it| it.0 == name).map(|it| it.1.as_str());
        path.filter(|it| it.rsplit('.').next() != Some(name)).unwrap_or(name)
    }

    /// The members of the global variables' structure, and where it lies.
    pub(crate) fn globals(&self) -> (&[Variable], usize) {
        let found = self.globals.and_then(|(ty, offset)| Some((self.structure(ty)?, offset)));
        found.map_or((&[], 0), |(structure, offset)| (&structure.members, offset))
    }

    /// Size in bytes.
    pub fn size_of(&self, ty: Type) -> usize {
        match ty {
            Type::Elementary(it) => it.repr().size() as usize,
            Type::Bit(_) => 1,
            Type::String(it) => it.size() as usize,
            Type::Characters(it) => (usize::from(it.capacity) + 1) * it.unit_size() as usize,
            Type::Enum(id) => self.enums.get(&id).map_or(0, |it| it.repr.size() as usize),
            Type::Reference => size_of::<u64>(),
            Type::Array(_) => self.array(ty).map_or(0, |it| it.stride * it.len()),
            Type::Struct(_) | Type::Block(_) => self.structure(ty).map_or(0, |it| it.size),
        }
    }

    /// The type's name as a user writes it.
    pub fn type_name(&self, ty: Type) -> String {
        match ty {
            Type::Elementary(it) => it.name().to_owned(),
            Type::Bit(_) => Elementary::Bool.name().to_owned(),
            Type::Reference => "REFERENCE".to_owned(),
            Type::String(it) | Type::Characters(it) => it.to_string(),
            Type::Enum(id) => self.enums.get(&id).map_or_else(String::new, |it| it.name.clone()),
            Type::Array(_) => self.array(ty).map_or_else(String::new, |it| {
                format!("ARRAY[{}..{}] OF {}", it.low, it.high, self.type_name(it.element))
            }),
            Type::Struct(_) | Type::Block(_) => self.structure(ty).map_or_else(String::new, |it| it.name.clone()),
        }
    }

    /// Path of a source file by its number.
    pub(crate) fn file(&self, number: u16) -> &str {
        self.files.get(usize::from(number)).map_or("?", String::as_str)
    }
}

impl Array {
    pub fn len(self) -> usize {
        usize::try_from(self.high.abs_diff(self.low)).map_or(usize::MAX, |it| it.saturating_add(1))
    }
}

impl Variable {
    fn new(name: String, ty: Type, offset: usize, section: Section) -> Self {
        Self {
            name,
            ty,
            offset,
            section,
            retain: false,
            whole: false,
            stays: false,
            restarts: false,
            constant: false,
            used: false,
            view: false,
            address: None,
            range: None,
        }
    }

    /// TRUE for a variable that is written from outside: it holds its value through a restart.
    pub fn is_input(&self) -> bool {
        self.section == Section::Input || self.address.as_deref().is_some_and(|it| it.starts_with("%I"))
    }
}

/// One line of the map.
struct Record<'a> {
    line: usize,
    cells: std::str::Split<'a, char>,
}

impl<'a> Record<'a> {
    fn error(&self, text: impl Into<String>) -> Error {
        Error::Map { line: self.line, text: text.into() }
    }

    fn text(&mut self) -> Result<&'a str, Error> {
        self.cells.next().ok_or_else(|| self.error("a record is cut off"))
    }

    fn number<T: std::str::FromStr>(&mut self) -> Result<T, Error> {
        let text = self.text()?;
        text.parse().map_err(|_| self.error(format!("`{text}` is not a number")))
    }

    fn version(&mut self) -> Result<(), Error> {
        match self.text()? {
            VERSION => Ok(()),
            other => Err(self.error(format!("version {other} is not {VERSION}"))),
        }
    }

    fn file(&mut self) -> Result<String, Error> {
        self.text()?;
        Ok(self.text()?.to_owned())
    }

    fn enumeration(&mut self) -> Result<(u32, Enum), Error> {
        let (id, name, repr) = (self.number()?, self.text()?.to_owned(), self.text()?);
        let repr = Repr::ALL.into_iter().find(|it| it.rust_name() == repr);
        let repr = repr.ok_or_else(|| self.error("an unknown repr"))?;
        let values = self.cells.by_ref().filter_map(|cell| {
            let (name, value) = cell.split_once('=')?;
            Some((name.to_owned(), value.parse().ok()?))
        });
        Ok((id, Enum { name, repr, values: values.collect() }))
    }

    fn array(&mut self) -> Result<(u32, Array), Error> {
        let (id, low, high) = (self.number()?, self.number()?, self.number()?);
        Ok((id, Array { low, high, element: self.ty()?, stride: self.number()? }))
    }

    fn structure(&mut self, kind: StructureKind) -> Result<(u32, Structure), Error> {
        let (id, name, size) = (self.number()?, self.text()?.to_owned(), self.number()?);
        let kind = match self.cells.next() {
            Some("function_block") => StructureKind::FunctionBlock,
            Some("program") => StructureKind::Program,
            Some("globals") => StructureKind::Globals,
            _ => kind,
        };
        Ok((id, Structure { name, size, kind, members: Vec::new() }))
    }

    fn instance(&mut self) -> Result<Instance, Error> {
        self.text()?;
        let (name, program) = (self.text()?.to_owned(), self.text()?.to_owned());
        let (ty, offset) = (self.ty()?, self.number()?);
        let interval = self.optional()?.map(|it| it.parse().map_err(|_| self.error("a bad interval")));
        let (interval, priority) = (interval.transpose()?, self.number()?);
        Ok(Instance { name, program, ty, offset, interval, priority, variables: Vec::new() })
    }

    fn optional(&mut self) -> Result<Option<&'a str>, Error> {
        Ok(Some(self.text()?).filter(|it| *it != "-"))
    }

    fn attributes(&mut self, mut variable: Variable) -> Result<Variable, Error> {
        for flag in self.optional()?.into_iter().flat_map(|it| it.split(',')) {
            match flag {
                "retain" => variable.retain = true,
                "whole" => variable.whole = true,
                "stays" => variable.stays = true,
                "restarts" => variable.restarts = true,
                "constant" => variable.constant = true,
                "used" => variable.used = true,
                "view" => variable.view = true,
                _ => {}
            }
        }
        variable.address = self.optional()?.map(str::to_owned);
        variable.range = self.optional()?.and_then(|it| {
            let (low, high) = it.split_once("..")?;
            Some((low.parse().ok()?, high.parse().ok()?))
        });
        Ok(variable)
    }

    fn section(&mut self) -> Result<Section, Error> {
        Ok(match self.text()? {
            "input" => Section::Input,
            "output" => Section::Output,
            "inout" => Section::InOut,
            "var" => Section::Var,
            "temp" => Section::Temp,
            "global" => Section::Global,
            "external" => Section::External,
            "memory" => Section::Memory,
            "member" => Section::Member,
            other => return Err(self.error(format!("`{other}` is not a section"))),
        })
    }

    fn ty(&mut self) -> Result<Type, Error> {
        let text = self.text()?;
        type_named(text).ok_or_else(|| self.error(format!("`{text}` is not a type")))
    }
}

fn type_named(text: &str) -> Option<Type> {
    if let Some((word, capacity)) = text.split_once('[') {
        let capacity = capacity.strip_suffix(']')?.parse().ok()?;
        let kinds = [StringType::narrow(capacity), StringType::wide(capacity)];
        return kinds.into_iter().find(|it| it.word() == word).map(Type::String);
    }
    match text.split_once(':') {
        Some(("bit", number)) => number.parse().ok().filter(|it| *it < 8).map(Type::Bit),
        Some(("enum", id)) => Some(Type::Enum(id.parse().ok()?)),
        Some(("array", id)) => Some(Type::Array(id.parse().ok()?)),
        Some(("struct", id)) => Some(Type::Struct(id.parse().ok()?)),
        Some(("block", id)) => Some(Type::Block(id.parse().ok()?)),
        Some(_) => None,
        None if text == "REFERENCE" => Some(Type::Reference),
        None => Elementary::by_own_name(text).map(Type::Elementary),
    }
}
