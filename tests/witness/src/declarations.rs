//! What the files declare: types, POUs and global variables, resolved by name.

use crate::classes::pou_of;
use crate::edges;
use crate::machine::{Outcome, unknown};
use crate::shared::{self, Window};
use crate::types::{Array, Elementary, Enum, Record, RefKind, Reference, Slot, Type};
use staunch_frontend::ast::{
    self, BinaryOp, Expr, ExprKind, Initial, InitialKind, Item, LiteralValue, TypeKind, UnaryOp,
};
use staunch_frontend::ast::{PouKind, VarKind};
use staunch_runtime::{BLOCKS, BlockInfo, Family};
use std::collections::HashMap;
use std::rc::Rc;

#[derive(Debug)]
pub(crate) struct Pou<'a> {
    pub name: &'a str,
    pub kind: PouKind,
    /// The POU that a METHOD, ACTION or accessor is of.
    pub owner: Option<usize>,
    /// What it EXTENDS.
    pub base: Option<usize>,
    /// What it IMPLEMENTS, or an INTERFACE EXTENDS.
    pub implements: &'a [ast::Name<'a>],
    /// How many variables its instances keep.
    pub fields: usize,
    pub result: Option<Slot<'a>>,
    pub variables: Vec<Variable<'a>>,
    pub body: &'a [ast::Statement<'a>],
}

#[derive(Debug)]
pub(crate) struct Variable<'a> {
    pub name: &'a str,
    pub kind: VarKind,
    pub slot: Slot<'a>,
    /// Whether it has a trigger.
    pub is_edge: bool,
    /// Where it lies in the process image: its area, and how it lies there.
    pub address: Option<(char, Window)>,
}

impl Variable<'_> {
    /// Whether a call can give it an argument.
    pub fn is_parameter(&self) -> bool {
        matches!(self.kind, VarKind::Input | VarKind::Output | VarKind::InOut)
    }
}

#[derive(Debug)]
pub(crate) struct Declarations<'a> {
    files: &'a [ast::File<'a>],
    pub family: Family,
    /// The capacity of a STRING without one.
    capacity: usize,
    types: HashMap<String, Slot<'a>>,
    enumerations: Vec<Rc<Enum>>,
    instances: HashMap<String, Type<'a>>,
    pub pous: Vec<Pou<'a>>,
    pub globals: Vec<Variable<'a>>,
}

impl<'a> Declarations<'a> {
    pub fn new(files: &'a [ast::File<'a>], family: Family) -> Outcome<Self> {
        let family = family_of(files, family)?;
        let capacity = if matches!(family, Family::Iec | Family::Openplc) { 254 } else { 80 };
        let mut this = Self {
            files,
            family,
            capacity,
            types: HashMap::new(),
            enumerations: Vec::new(),
            instances: HashMap::new(),
            pous: Vec::new(),
            globals: Vec::new(),
        };
        if files.iter().any(|it| it.regions.len() > 1) {
            return unknown("a NAMESPACE, or a USING");
        }
        // Bare enumerators are known only when every enumeration is.
        for item in files.iter().flat_map(|it| &it.items) {
            if let Item::Types(types) = item {
                types.iter().try_for_each(|it| this.named(it.name.text).map(drop))?;
            }
        }
        for item in files.iter().flat_map(|it| &it.items) {
            match item {
                Item::Globals(block) => {
                    let mut variables = this.variables(block)?;
                    this.globals.append(&mut variables);
                }
                Item::Pou(pou) => this.pou(pou, None)?,
                Item::Types(_) => {}
                Item::Configuration(it) => {
                    for block in it.globals.iter().chain(it.resources.iter().flat_map(|it| &it.globals)) {
                        let mut variables = this.variables(block)?;
                        this.globals.append(&mut variables);
                    }
                }
                Item::Test(_) => return unknown("a TEST"),
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
        Ok(this)
    }

    fn pou(&mut self, pou: &'a ast::Pou<'a>, owner: Option<usize>) -> Outcome<()> {
        let (name, kind, body, implements) = (pou.name.text, pou.kind, pou.body.as_slice(), pou.implements.as_slice());
        if kind == PouKind::Method && name.eq_ignore_ascii_case("FB_init") {
            return unknown("FB_init");
        }
        if pou.attributes.iter().any(|it| it.eq_ignore_ascii_case("call_after_init")) {
            return unknown("call_after_init");
        }
        if kind == PouKind::Interface {
            let (base, result, variables) = (None, None, Vec::new());
            self.pous.push(Pou { name, kind, owner, base, implements, fields: 0, result, variables, body });
            return Ok(());
        }
        let variables = self.variables_of(pou)?;
        let base = match &pou.extends {
            Some(base) => Some(pou_of(self.files, base.text).map_or_else(|| unknown("this base"), |it| Ok(it.0))?),
            None => None,
        };
        let fields = variables.iter().filter(|it| is_field(it.kind)).map(|it| 1 + usize::from(it.is_edge)).sum();
        let result = pou.result.as_ref().map(|it| self.slot(it, None)).transpose()?;
        self.pous.push(Pou { name, kind, owner, base, implements, fields, result, variables, body });
        Ok(())
    }

    /// A POU's variables, after those of its base.
    fn variables_of(&mut self, pou: &'a ast::Pou<'a>) -> Outcome<Vec<Variable<'a>>> {
        let mut variables = match &pou.extends {
            Some(base) => match pou_of(self.files, base.text) {
                Some((_, base)) => self.variables_of(base)?,
                None => return unknown("this base"),
            },
            None => Vec::new(),
        };
        if variables.iter().any(|it| it.kind == VarKind::Stat) {
            return unknown("VAR_STAT of a base");
        }
        for block in &pou.blocks {
            if block.kind == VarKind::Inst {
                return unknown("VAR_INST");
            }
            // An external variable is the global of its name.
            if block.kind != VarKind::External {
                variables.extend(self.variables(block)?);
            }
        }
        Ok(variables)
    }

    fn variables(&mut self, block: &'a ast::VarBlock<'a>) -> Outcome<Vec<Variable<'a>>> {
        let mut variables = Vec::new();
        for declared in &block.vars {
            let at = declared.address.map(|it| shared::address(it.text)).transpose()?;
            if at.is_some() && block.kind != VarKind::Global {
                return unknown("an address in a POU");
            }
            let slot = self.slot(&declared.ty, declared.initial.as_ref())?;
            if at.is_some() && slot.ty.bytes().is_none() {
                return unknown("this type at an address");
            }
            let address = at.map(|it| (it.0, it.1));
            let is_edge = declared.edge.is_some();
            let names = declared.names.iter();
            let made =
                names.map(|it| Variable { name: it.text, kind: block.kind, slot: slot.clone(), is_edge, address });
            variables.extend(made);
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
            TypeKind::Named(names) => match names.as_slice() {
                [name] if self.is_interface(name.text) => {
                    Type::Reference(Reference { kind: RefKind::Interface, target: Some(spec) })
                }
                [name] => return self.named(name.text),
                [family, name] => match Family::named(family.text) {
                    Some(family) => Type::Block(block(family, name.text)?),
                    None => return unknown("a qualified type"),
                },
                _ => return unknown("a qualified type"),
            },
            TypeKind::String { wide: false, capacity } => {
                let capacity = capacity.as_ref().map(|it| self.number(it)).transpose()?;
                Type::Text(capacity.map_or(self.capacity, |it| usize::try_from(it).unwrap_or(0)))
            }
            TypeKind::Subrange { base, low, high } => match self.named(base.text)?.ty.elementary() {
                Some(base) => Type::Subrange(base, self.number(low)?, self.number(high)?),
                None => return unknown("a subrange of what is no integer"),
            },
            TypeKind::Array { bounds, element } => self.array(bounds, element)?,
            TypeKind::Struct(declared) => {
                Type::Record(Rc::new(Record { pou: None, fields: self.fields(declared)?, edges: Vec::new() }))
            }
            TypeKind::Enum { base, values } => Type::Enum(self.enumeration("", base.as_ref(), values)?),
            TypeKind::Reference { kind, target } => {
                let kind = match kind {
                    ast::RefKind::RefTo | ast::RefKind::PointerTo => RefKind::Pointer,
                    ast::RefKind::ReferenceTo => RefKind::Alias,
                    ast::RefKind::Interface(_) => RefKind::Interface,
                };
                Type::Reference(Reference { kind, target: Some(target) })
            }
            TypeKind::Union(declared) => {
                if declared.iter().any(|it| it.address.is_some()) {
                    return unknown("the location of a member");
                }
                let shared =
                    Type::Union(Rc::new(Record { pou: None, fields: self.fields(declared)?, edges: Vec::new() }));
                if shared.bytes().is_none() {
                    return unknown("this type in a UNION");
                }
                shared
            }
            TypeKind::String { wide: true, .. } | TypeKind::Error => return unknown("this type"),
        };
        Ok(Slot { ty, initial: None })
    }

    /// `ARRAY[a, b] OF t` is an array of arrays.
    fn array(&mut self, bounds: &'a [ast::Bound<'a>], element: &'a ast::TypeSpec<'a>) -> Outcome<Type<'a>> {
        let mut slot = self.spec(element)?;
        for bound in bounds.iter().rev() {
            let ast::Bound::Range(low, high) = bound else { return unknown("ARRAY[*]") };
            let (low, high) = (self.number(low)?, self.number(high)?);
            slot = Slot { ty: Type::Array(Rc::new(Array { low, high, element: slot })), initial: None };
        }
        Ok(slot.ty)
    }

    fn fields(&mut self, declared: &'a [ast::VarDecl<'a>]) -> Outcome<Vec<(String, Slot<'a>)>> {
        let mut fields = Vec::new();
        for it in declared {
            let slot = self.slot(&it.ty, it.initial.as_ref())?;
            let trigger = it.edge.map(|(edge, _)| self.named(edges::block_of(edge))).transpose()?;
            for name in &it.names {
                fields.push((name.text.to_owned(), slot.clone()));
                fields.extend(trigger.clone().map(|it| (edges::trigger_of(name.text), it)));
            }
        }
        Ok(fields)
    }

    fn enumeration(
        &mut self,
        name: &str,
        base: Option<&ast::Name<'a>>,
        values: &'a [ast::EnumValue<'a>],
    ) -> Outcome<Rc<Enum>> {
        let base = base.map_or(Some(Elementary::Int), |it| Elementary::named(it.text));
        let Some(base) = base else { return unknown("this base of an enumeration") };
        let mut next = 0;
        let mut numbered = Vec::new();
        for value in values {
            next = value.value.as_ref().map_or(Ok(next), |it| self.number(it))?;
            numbered.push((value.name.text.to_owned(), base.repr().integer(next).unwrap_or(base.repr().zero())));
            next += 1;
        }
        let made = Rc::new(Enum { name: name.to_owned(), base, values: numbered });
        self.enumerations.push(made.clone());
        Ok(made)
    }

    /// The type of this name: elementary, declared, a POU's instance, or a standard block.
    fn named(&mut self, name: &str) -> Outcome<Slot<'a>> {
        let slot = |ty| Ok(Slot { ty, initial: None });
        let key = name.to_ascii_uppercase();
        if let Some(it) = Elementary::named(name) {
            return slot(Type::Elementary(it));
        }
        if let Some(known) = self.types.get(&key) {
            return Ok(known.clone());
        }
        if let Some(known) = self.instances.get(&key) {
            return slot(known.clone());
        }
        let items = self.files.iter().flat_map(|it| &it.items);
        let mut pous = 0;
        for item in items {
            match item {
                Item::Types(types) => {
                    if let Some(declared) = types.iter().find(|it| it.name.text.eq_ignore_ascii_case(name)) {
                        let found = self.declared(declared)?;
                        self.types.insert(key, found.clone());
                        return Ok(found);
                    }
                }
                Item::Pou(pou) if pou.name.text.eq_ignore_ascii_case(name) => {
                    let ty = self.instance(pou, pous)?;
                    self.instances.insert(key, ty.clone());
                    return slot(ty);
                }
                Item::Pou(_) => pous += 1,
                Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
            }
        }
        slot(Type::Block(block(self.family, name).or_else(|_| block(Family::Iec, name))?))
    }

    fn declared(&mut self, declared: &'a ast::TypeDecl<'a>) -> Outcome<Slot<'a>> {
        let slot = match &declared.ty.kind {
            TypeKind::Enum { base, values } => {
                let made = self.enumeration(declared.name.text, base.as_ref(), values)?;
                Slot { ty: Type::Enum(made), initial: None }
            }
            TypeKind::Struct(_) if declared.base.is_some() => return unknown("a structure with a base"),
            _ => self.spec(&declared.ty)?,
        };
        Ok(Slot { initial: declared.initial.as_ref().or(slot.initial), ..slot })
    }

    /// What an instance of a POU keeps. `number` counts the POUs in the order of their files.
    fn instance(&mut self, pou: &'a ast::Pou<'a>, number: usize) -> Outcome<Type<'a>> {
        let (mut fields, mut edges) = match &pou.extends {
            Some(base) => match self.named(base.text)?.ty {
                Type::Record(record) => (record.fields.clone(), record.edges.clone()),
                _ => return unknown("this base"),
            },
            None => (Vec::new(), Vec::new()),
        };
        for block in pou.blocks.iter().filter(|it| is_field(it.kind)) {
            fields.extend(self.fields(&block.vars)?);
            let own = block.vars.iter().filter(|it| it.edge.is_some()).flat_map(|it| &it.names);
            edges.extend(own.map(|it| it.text.to_owned()));
        }
        Ok(Type::Record(Rc::new(Record { pou: Some(number), fields, edges })))
    }

    /// The instance type of the POU with this number.
    pub fn instance_of(&mut self, number: usize) -> Outcome<Type<'a>> {
        let name = self.pous[number].name;
        Ok(self.named(name)?.ty)
    }

    /// The constant number of a bound, a capacity or an enumerator.
    fn number(&self, expr: &Expr<'a>) -> Outcome<i128> {
        match &expr.kind {
            ExprKind::Literal(it) => match it.value {
                LiteralValue::Integer { value, .. } => Ok(i128::from(value)),
                _ => unknown("a bound that is no number"),
            },
            ExprKind::Paren(inner) => self.number(inner),
            ExprKind::Unary(UnaryOp::Neg, inner) => Ok(-self.number(inner)?),
            ExprKind::Binary(sides, op, _) => {
                let (a, b) = (self.number(&sides[0])?, self.number(&sides[1])?);
                match op {
                    BinaryOp::Add => Ok(a + b),
                    BinaryOp::Sub => Ok(a - b),
                    BinaryOp::Mul => Ok(a * b),
                    _ => unknown("this operator in a bound"),
                }
            }
            ExprKind::Name(name) => match self.global_constant(name.text) {
                Some(InitialKind::Value(expr)) => self.number(expr),
                _ => unknown("this name in a bound"),
            },
            _ => unknown("this expression in a bound"),
        }
    }

    fn global_constant(&self, name: &str) -> Option<&'a InitialKind<'a>> {
        let blocks = self.files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
            Item::Globals(block) if block.constant.is_some() => Some(block),
            _ => None,
        });
        let mut declared = blocks.flat_map(|it| &it.vars);
        let found = declared.find(|it| it.names.iter().any(|it| it.text.eq_ignore_ascii_case(name)))?;
        Some(&found.initial.as_ref()?.kind)
    }

    /// `Color#Red`, `Color.Red`.
    pub fn enumerator(&self, ty: &str, name: &str) -> Option<crate::storage::Value<'a>> {
        let found = self.enumerations.iter().find(|it| it.name.eq_ignore_ascii_case(ty))?;
        member(found, name)
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

    pub fn pou_named(&self, name: &str) -> Option<usize> {
        self.pous.iter().position(|it| it.owner.is_none() && it.name.eq_ignore_ascii_case(name))
    }

    fn is_interface(&self, name: &str) -> bool {
        pou_of(self.files, name).is_some_and(|it| it.1.kind == PouKind::Interface)
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

/// The name that a type is written with, if it is one.
pub(crate) fn name_of<'a>(spec: &'a ast::TypeSpec<'a>) -> Option<&'a str> {
    match &spec.kind {
        TypeKind::Named(names) => names.last().map(|it| it.text),
        _ => None,
    }
}

fn member<'a>(of: &Rc<Enum>, name: &str) -> Option<crate::storage::Value<'a>> {
    let (_, value) = of.values.iter().find(|it| it.0.eq_ignore_ascii_case(name))?;
    Some(crate::storage::Value { ty: Type::Enum(of.clone()), cells: vec![crate::storage::Cell::Scalar(*value)] })
}

fn block(family: Family, name: &str) -> Outcome<&'static BlockInfo> {
    let found = BLOCKS.iter().find(|it| it.family == family && it.name.eq_ignore_ascii_case(name));
    found.map_or_else(|| unknown(&format!("the type {name}")), Ok)
}
