//! What the files declare: types, POUs and global variables, resolved by name.

use crate::addresses::Address;
use crate::edges;
use crate::machine::{Outcome, unknown};
use crate::names::{Declared, Names};
use crate::types::{Array, Elementary, Enum, Record, RefKind, Reference, Slot, Text, Type};
use staunch_frontend::ast::{self, Initial, Item, Name, PouKind, TypeKind, VarKind};
use staunch_runtime::{BLOCKS, BlockInfo, Family};
use std::collections::HashMap;
use std::rc::Rc;

#[derive(Debug)]
pub(crate) struct Pou<'a> {
    pub name: &'a str,
    pub key: String,
    pub kind: PouKind,
    /// The POU that a METHOD, ACTION or accessor is of.
    pub owner: Option<usize>,
    /// What it EXTENDS.
    pub base: Option<usize>,
    /// What it IMPLEMENTS, or an INTERFACE EXTENDS.
    pub implements: Vec<usize>,
    /// Whether it has the attribute `call_after_init`.
    pub after_init: bool,
    /// Whether it has the attribute `startup`.
    pub starts_up: bool,
    /// How many variables its instances keep.
    pub fields: usize,
    pub result: Option<Slot<'a>>,
    pub variables: Vec<Variable<'a>>,
    pub body: &'a [ast::Statement<'a>],
}

#[derive(Debug)]
pub(crate) struct Variable<'a> {
    pub name: &'a str,
    /// Of a global variable.
    pub key: String,
    pub kind: VarKind,
    pub slot: Slot<'a>,
    /// Whether it has a trigger.
    pub is_edge: bool,
    /// Where it is in the process image.
    pub address: Option<Address>,
}

impl Variable<'_> {
    /// Whether a call can give it an argument.
    pub fn is_parameter(&self) -> bool {
        matches!(self.kind, VarKind::Input | VarKind::Output | VarKind::InOut)
    }
}

#[derive(Debug)]
pub(crate) struct Declarations<'a> {
    pub files: &'a [ast::File<'a>],
    pub names: Names<'a>,
    pub family: Family,
    /// The capacity of a STRING without one.
    capacity: usize,
    types: HashMap<String, Slot<'a>>,
    enumerations: Vec<Rc<Enum>>,
    instances: HashMap<usize, Type<'a>>,
    pub pous: Vec<Pou<'a>>,
    pub globals: Vec<Variable<'a>>,
}

impl<'a> Declarations<'a> {
    pub fn new(files: &'a [ast::File<'a>], family: Family) -> Outcome<Self> {
        let family = family_of(files, family)?;
        let capacity =
            if matches!(family, Family::Iec | Family::Openplc | Family::Openplc4 | Family::S7) { 254 } else { 80 };
        let mut this = Self {
            files,
            names: Names::new(files)?,
            family,
            capacity,
            types: HashMap::new(),
            enumerations: Vec::new(),
            instances: HashMap::new(),
            pous: Vec::new(),
            globals: Vec::new(),
        };
        // Bare enumerators are known only when every enumeration is.
        for item in files.iter().flat_map(|it| &it.items) {
            if let Item::Types(types) = item {
                types.iter().try_for_each(|it| this.declared(it).map(drop))?;
            }
        }
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Globals(block) => this.add_globals(block)?,
                Item::Pou(pou) => this.pou(pou, None)?,
                Item::Configuration(it) => {
                    let mut blocks = it.globals.iter().chain(it.resources.iter().flat_map(|it| &it.globals));
                    blocks.try_for_each(|it| this.add_globals(it))?;
                }
                Item::Types(_) | Item::Test(_) => {}
            }
        }
        // They come last: instances know their POUs by number.
        let pous = files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
            Item::Pou(pou) => Some(pou),
            Item::Globals(_) | Item::Types(_) | Item::Configuration(_) | Item::Test(_) => None,
        });
        for (owner, pou) in pous.enumerate() {
            pou.routines.iter().try_for_each(|it| this.pou(it, Some(owner)))?;
        }
        this.refuse_overloads()?;
        Ok(this)
    }

    fn add_globals(&mut self, block: &'a ast::VarBlock<'a>) -> Outcome<()> {
        let mut variables = self.variables(block)?;
        self.globals.append(&mut variables);
        Ok(())
    }

    fn pou(&mut self, pou: &'a ast::Pou<'a>, owner: Option<usize>) -> Outcome<()> {
        let key = self.names.key(&pou.name);
        let (name, kind, body) = (pou.name.text, pou.kind, pou.body.as_slice());
        if pou.attributes.iter().any(|it| it.eq_ignore_ascii_case("initialize_on_call")) {
            return unknown("inputs that start anew at each call");
        }
        if pou.chart.is_some() {
            return unknown("a sequential function chart");
        }
        let (base, implements) = self.bases(pou)?;
        let starts_up = pou.attributes.iter().any(|it| it.eq_ignore_ascii_case("startup"));
        let after_init = pou.attributes.iter().any(|it| it.eq_ignore_ascii_case("call_after_init"));
        if kind == PouKind::Interface {
            let (base, result, variables) = (None, None, Vec::new());
            self.pous.push(Pou {
                name,
                key,
                kind,
                owner,
                base,
                implements,
                fields: 0,
                after_init,
                starts_up,
                result,
                variables,
                body,
            });
            return Ok(());
        }
        let variables = self.variables_of(pou)?;
        let fields = variables
            .iter()
            .filter(|it| is_field(it.kind) && it.address.is_none())
            .map(|it| 1 + usize::from(it.is_edge))
            .sum();
        let result = pou.result.as_ref().map(|it| self.slot(it, None)).transpose()?;
        self.pous.push(Pou {
            name,
            key,
            kind,
            owner,
            base,
            implements,
            fields,
            after_init,
            starts_up,
            result,
            variables,
            body,
        });
        Ok(())
    }

    /// What a class EXTENDS, and what it IMPLEMENTS, or an INTERFACE EXTENDS.
    fn bases(&self, pou: &'a ast::Pou<'a>) -> Outcome<(Option<usize>, Vec<usize>)> {
        let base = self.base_of(pou)?.map(|it| it.0);
        let mut implements = Vec::new();
        for path in pou.bases.iter().skip(usize::from(base.is_some())) {
            let Some((number, _)) = self.names.pou(path) else { return unknown("this INTERFACE") };
            implements.push(number);
        }
        Ok((base, implements))
    }

    fn base_of(&self, pou: &'a ast::Pou<'a>) -> Outcome<Option<(usize, &'a ast::Pou<'a>)>> {
        match (&pou.extends, pou.bases.first()) {
            (Some(_), Some(path)) => self.names.pou(path).map_or_else(|| unknown("this base"), |it| Ok(Some(it))),
            (Some(_), None) => unknown("this base"),
            (None, _) => Ok(None),
        }
    }

    /// A POU's variables, after those of its base.
    fn variables_of(&mut self, pou: &'a ast::Pou<'a>) -> Outcome<Vec<Variable<'a>>> {
        let mut variables = match self.base_of(pou)? {
            Some((_, base)) => self.variables_of(base)?,
            None => Vec::new(),
        };
        if variables.iter().any(|it| it.kind == VarKind::Stat) {
            return unknown("VAR_STAT of a base");
        }
        for block in &pou.blocks {
            if block.kind == VarKind::Inst {
                return unknown("VAR_INST");
            }
            if block.kind == VarKind::InOut && block.constant.is_some() {
                // What is CONSTANT goes into it as a copy.
                return unknown("VAR_IN_OUT CONSTANT");
            }
            // An external variable is the global with its name.
            if block.kind != VarKind::External {
                variables.extend(self.variables(block)?);
            }
        }
        Ok(variables)
    }

    fn variables(&mut self, block: &'a ast::VarBlock<'a>) -> Outcome<Vec<Variable<'a>>> {
        let mut variables = Vec::new();
        for declared in &block.vars {
            let address = declared.known_address().map(|it| Address::read(it.text, self.family)).transpose()?;
            if declared.instance_path.is_some() {
                return unknown("the path of an instance");
            }
            let slot = self.slot(&declared.ty, declared.initial.as_ref())?;
            let is_kept = block.retain.is_some() || block.persistent.is_some();
            let slot = Slot { construction: declared.construction.as_deref(), is_kept, ..slot };
            if address.is_some() && slot.ty.bytes().is_none() {
                return unknown("this type at an address");
            }
            let is_edge = declared.edge.is_some();
            let names = declared.names.iter();
            for it in names {
                let (name, key, slot, address) = (it.text, self.names.key(it), slot.clone(), address.clone());
                variables.push(Variable { name, key, kind: block.kind, slot, is_edge, address });
            }
        }
        Ok(variables)
    }

    /// A declaration's own initial value comes before its type's.
    fn slot(&mut self, ty: &'a ast::TypeSpec<'a>, initial: Option<&'a Initial<'a>>) -> Outcome<Slot<'a>> {
        let slot = self.spec(ty)?;
        Ok(Slot { initial: initial.or(slot.initial), ..slot })
    }

    fn spec(&mut self, spec: &'a ast::TypeSpec<'a>) -> Outcome<Slot<'a>> {
        let ty = match &spec.kind {
            TypeKind::Named(path) => match self.names.pou(path) {
                Some((_, pou)) if pou.kind == PouKind::Interface => {
                    Type::Reference(Reference { kind: RefKind::Interface, target: Some(spec) })
                }
                Some(_) | None => return self.named(path),
            },
            TypeKind::String { wide, capacity } => {
                let capacity = capacity.as_ref().map(|it| self.number(it)).transpose()?;
                let capacity = capacity.map_or(self.capacity, |it| usize::try_from(it).unwrap_or(0));
                Type::Text(Text { capacity, wide: *wide })
            }
            TypeKind::Subrange { base, low, high } => match self.named(&[*base])?.ty.elementary() {
                Some(base) => Type::Subrange(base, self.number(low)?, self.number(high)?),
                None => return unknown("a subrange of something other than an integer"),
            },
            TypeKind::Array { bounds, element } => self.array(bounds, element)?,
            TypeKind::Struct(declared) => {
                Type::Record(Rc::new(Record { pou: None, fields: self.fields(declared)?, edges: Vec::new() }))
            }
            TypeKind::Enum { base, values } => Type::Enum(self.enumeration(base.as_ref(), values)?),
            TypeKind::Reference { kind, target } => {
                let kind = match kind {
                    ast::RefKind::RefTo | ast::RefKind::PointerTo => RefKind::Pointer,
                    ast::RefKind::ReferenceTo => RefKind::Alias,
                    ast::RefKind::Interface(_) => RefKind::Interface,
                };
                Type::Reference(Reference { kind, target: Some(target) })
            }
            TypeKind::Union(declared) => {
                if declared.iter().any(|it| it.known_address().is_some()) {
                    return unknown("the location of a member");
                }
                let is_bit =
                    |it: &ast::VarDecl<'_>| matches!(path_of(&it.ty), [it] if it.text.eq_ignore_ascii_case("BIT"));
                if declared.iter().any(is_bit) {
                    return unknown("a BIT in a UNION");
                }
                let shared =
                    Type::Union(Rc::new(Record { pou: None, fields: self.fields(declared)?, edges: Vec::new() }));
                if shared.bytes().is_none() {
                    return unknown("this type in a UNION");
                }
                shared
            }
            TypeKind::Error => return unknown("this type"),
        };
        Ok(Slot::of(ty))
    }

    /// `ARRAY[a, b] OF t` is an array of arrays.
    fn array(&mut self, bounds: &'a [ast::Bound<'a>], element: &'a ast::TypeSpec<'a>) -> Outcome<Type<'a>> {
        let mut slot = self.spec(element)?;
        if bounds.is_empty() {
            return unknown("an array without bounds");
        }
        for (bound, dimensions) in bounds.iter().rev().zip(1..) {
            let (low, high, is_open) = match bound {
                ast::Bound::Range(low, high) => (self.number(low)?, self.number(high)?, false),
                ast::Bound::Open(_) => (0, -1, true),
            };
            slot = Slot::of(Type::Array(Rc::new(Array { low, high, element: slot, dimensions, is_open })));
        }
        Ok(slot.ty)
    }

    fn fields(&mut self, declared: impl IntoIterator<Item = &'a ast::VarDecl<'a>>) -> Outcome<Vec<(String, Slot<'a>)>> {
        let mut fields = Vec::new();
        for it in declared {
            let slot = self.slot(&it.ty, it.initial.as_ref())?;
            let slot = Slot { construction: it.construction.as_deref(), ..slot };
            let trigger = it.edge.map(|(edge, _)| self.block(edges::block_of(edge))).transpose()?;
            let trigger = trigger.map(|it| Slot::of(Type::Block(it)));
            for name in &it.names {
                fields.push((name.text.to_owned(), slot.clone()));
                fields.extend(trigger.clone().map(|it| (edges::trigger_of(name.text), it)));
            }
        }
        Ok(fields)
    }

    fn enumeration(&mut self, base: Option<&Name<'a>>, values: &'a [ast::EnumValue<'a>]) -> Outcome<Rc<Enum>> {
        let base = base.map_or(Some(Elementary::Int), |it| Elementary::named(it.text));
        let Some(base) = base else { return unknown("this base of an enumeration") };
        let mut next = 0;
        let mut numbered = Vec::new();
        for value in values {
            next = value.value.as_ref().map_or(Ok(next), |it| self.number(it))?;
            numbered.push((value.name.text.to_owned(), base.repr().integer(next).unwrap_or(base.repr().zero())));
            next += 1;
        }
        let made = Rc::new(Enum { base, values: numbered });
        self.enumerations.push(made.clone());
        Ok(made)
    }

    /// The type with this name: elementary, declared, a POU's instance, or a standard block.
    pub(crate) fn named(&mut self, path: &[Name<'a>]) -> Outcome<Slot<'a>> {
        let slot = |ty| Ok(Slot::of(ty));
        match (path, self.names.find(path)) {
            (_, Some((_, Declared::Type(declared)))) => self.declared(declared),
            (_, Some((_, Declared::Pou(number, pou)))) => slot(self.instance(pou, number)?),
            ([name], _) => match Elementary::named(name.text) {
                Some(it) => slot(Type::Elementary(it)),
                // CODESYS: a BOOL, whichever bit of a byte it has.
                None if name.text.eq_ignore_ascii_case("BIT") => slot(Type::BOOL),
                None => slot(Type::Block(self.block(name.text)?)),
            },
            ([library, name], _) => match library_of(library.text) {
                Some(family) => slot(Type::Block(block(family, name.text).or_else(|_| block(Family::Iec, name.text))?)),
                None => unknown("a qualified type"),
            },
            _ => unknown("a qualified type"),
        }
    }

    /// The dialect's own block, or else one that all systems share.
    fn block(&self, name: &str) -> Outcome<&'static BlockInfo> {
        block(self.family, name).or_else(|_| block(Family::Iec, name))
    }

    pub(crate) fn declared(&mut self, declared: &'a ast::TypeDecl<'a>) -> Outcome<Slot<'a>> {
        let key = self.names.key(&declared.name);
        if let Some(known) = self.types.get(&key) {
            return Ok(known.clone());
        }
        let slot = match &declared.ty.kind {
            TypeKind::Enum { base, values } => {
                let made = self.enumeration(base.as_ref(), values)?;
                Slot::of(Type::Enum(made))
            }
            TypeKind::Struct(own) => {
                let mut fields = match &declared.base {
                    None => Vec::new(),
                    Some(base) => match self.named(base)?.ty {
                        Type::Record(base) => base.fields.clone(),
                        _ => return unknown("this base of a structure"),
                    },
                };
                fields.extend(self.fields(own)?);
                Slot::of(Type::Record(Rc::new(Record { pou: None, fields, edges: Vec::new() })))
            }
            _ => self.spec(&declared.ty)?,
        };
        let slot = Slot { initial: declared.initial.as_ref().or(slot.initial), ..slot };
        self.types.insert(key, slot.clone());
        Ok(slot)
    }

    /// What an instance of a POU keeps. `number` counts the POUs in the order of their files.
    fn instance(&mut self, pou: &'a ast::Pou<'a>, number: usize) -> Outcome<Type<'a>> {
        if let Some(known) = self.instances.get(&number) {
            return Ok(known.clone());
        }
        let (mut fields, mut edges) = match self.base_of(pou)? {
            Some((base, ast)) => match self.instance(ast, base)? {
                Type::Record(record) => (record.fields.clone(), record.edges.clone()),
                _ => return unknown("this base"),
            },
            None => (Vec::new(), Vec::new()),
        };
        for block in pou.blocks.iter().filter(|it| is_field(it.kind)) {
            // A variable at an address is not part of an instance.
            let own = self.fields(block.vars.iter().filter(|it| it.known_address().is_none()))?;
            let is_kept = block.retain.is_some() || block.persistent.is_some();
            fields.extend(own.into_iter().map(|(name, slot)| (name, Slot { is_kept, ..slot })));
            let own = block.vars.iter().filter(|it| it.edge.is_some()).flat_map(|it| &it.names);
            edges.extend(own.map(|it| it.text.to_owned()));
        }
        let ty = Type::Record(Rc::new(Record { pou: Some(number), fields, edges }));
        self.instances.insert(number, ty.clone());
        Ok(ty)
    }

    /// The instance type of the POU with this number.
    pub fn instance_of(&mut self, number: usize) -> Outcome<Type<'a>> {
        let pous = self.files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
            Item::Pou(pou) => Some(pou),
            Item::Globals(_) | Item::Types(_) | Item::Configuration(_) | Item::Test(_) => None,
        });
        let pou = pous.enumerate().find(|it| it.0 == number);
        pou.map_or_else(|| unknown("this POU"), |(number, pou)| self.instance(pou, number))
    }

    /// `Color#Red`, `Color.Red`.
    pub fn enumerator(&mut self, ty: &[Name<'a>], name: &str) -> Option<crate::storage::Value<'a>> {
        let (_, Declared::Type(declared)) = self.names.find(ty)? else { return None };
        match self.declared(declared).ok()?.ty {
            Type::Enum(it) => member(&it, name),
            _ => None,
        }
    }

    /// `Red`, of the enumeration that is asked for, or else of the only one that has it.
    pub fn bare_enumerator(&self, name: &str, asked: Option<&Type<'a>>) -> Option<crate::storage::Value<'a>> {
        if let Some(Type::Enum(asked)) = asked
            && let Some(found) = member(asked, name)
        {
            return Some(found);
        }
        let mut found = self.enumerations.iter().filter_map(|it| member(it, name));
        found.next().filter(|_| found.next().is_none())
    }

    pub fn is_codesys(&self) -> bool {
        self.family == Family::Codesys
    }

    pub fn pou_named(&self, path: &[Name<'a>]) -> Option<usize> {
        self.names.pou(path).map(|it| it.0)
    }

    /// The type that a reference's target is declared with.
    pub fn type_of(&mut self, spec: &'a ast::TypeSpec<'a>) -> Outcome<Type<'a>> {
        Ok(self.spec(spec)?.ty)
    }
}

/// What a file's pragma says, or else this family.
fn family_of(files: &[ast::File<'_>], family: Family) -> Outcome<Family> {
    let named = |it: &ast::File<'_>| {
        let name = it.pragmas.iter().find_map(|it| it.text.trim().strip_prefix("dialect"));
        name.and_then(|it| Family::named(it.trim().trim_matches('\'')))
    };
    let mut families = files.iter().map(|it| named(it).unwrap_or(family));
    let first = families.next().unwrap_or(family);
    if families.all(|it| it == first) { Ok(first) } else { unknown("files of several dialects") }
}

/// Whether instances keep a variable of this section.
fn is_field(kind: VarKind) -> bool {
    matches!(kind, VarKind::Input | VarKind::Output | VarKind::Var)
}

/// The names that a type is written with, if they are ones.
pub(crate) fn path_of<'a>(spec: &'a ast::TypeSpec<'a>) -> &'a [Name<'a>] {
    match &spec.kind {
        TypeKind::Named(names) => names,
        _ => &[],
    }
}

/// Whose blocks a name before a block's means: a family's, or one of the libraries of CODESYS and TwinCAT.
fn library_of(name: &str) -> Option<Family> {
    let libraries = ["Standard", "Standard64", "Tc2_Standard"];
    let codesys = libraries.iter().any(|it| it.eq_ignore_ascii_case(name));
    if codesys { Some(Family::Codesys) } else { Family::named(name) }
}

fn member<'a>(of: &Rc<Enum>, name: &str) -> Option<crate::storage::Value<'a>> {
    let (_, value) = of.values.iter().find(|it| it.0.eq_ignore_ascii_case(name))?;
    Some(crate::storage::Value { ty: Type::Enum(of.clone()), cells: vec![crate::storage::Cell::Scalar(*value)] })
}

fn block(family: Family, name: &str) -> Outcome<&'static BlockInfo> {
    let found = BLOCKS.iter().find(|it| it.family == family && it.name.eq_ignore_ascii_case(name));
    found.map_or_else(|| unknown(&format!("the type {name}")), Ok)
}
