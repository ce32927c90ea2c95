//! The variables that a body can name, and places among them.

use super::Writer;
use super::call::{Parameter, Section};
use super::types::{Catalogue, Piece, Shape, Ty};

#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub ty: Ty,
    pub writable: bool,
    /// Whether it has a direct address that others may overlap.
    pub located: bool,
    /// Whether it exists from scan to scan, so that references may be kept of it.
    pub lasts: bool,
}

#[derive(Clone, Default)]
pub struct Scope {
    variables: Vec<Variable>,
}

impl Scope {
    pub fn new(globals: &[Variable]) -> Self {
        Self { variables: globals.to_vec() }
    }

    /// Without the variables of some names.
    pub fn without(&self, hidden: impl Fn(&str) -> bool) -> Self {
        Self { variables: self.variables.iter().filter(|it| !hidden(&it.name)).cloned().collect() }
    }

    /// The types of those variables and of their parts.
    pub fn types(&self, types: &Catalogue, chosen: impl Fn(&Variable) -> bool) -> Vec<Ty> {
        let shapes = self.variables.iter().filter(|it| chosen(it)).flat_map(|it| types.shapes(&it.ty));
        shapes
            .filter(|it| !it.through && !it.is_pin && !it.is_shared && it.writable && !matches!(it.ty, Ty::Pointer(_)))
            .map(|it| it.ty)
            .collect()
    }

    /// The variables that are references, and to what.
    pub fn pointers(&self) -> Vec<(String, Ty)> {
        let pointers = self.variables.iter().filter_map(|it| match &it.ty {
            Ty::Pointer(to) if it.writable => Some((it.name.clone(), (**to).clone())),
            _ => None,
        });
        pointers.collect()
    }

    pub fn len(&self) -> usize {
        self.variables.len()
    }

    /// The variables after the first so many.
    pub fn from(&self, first: usize) -> Vec<Variable> {
        self.variables[first..].to_vec()
    }

    pub fn add_in_outs(&mut self, parameters: &[Parameter]) {
        for it in parameters.iter().filter(|it| it.section == Section::InOut) {
            self.add(Variable {
                name: it.name.clone(),
                ty: it.ty.clone(),
                writable: true,
                lasts: false,
                located: false,
            });
        }
    }

    pub fn add(&mut self, variable: Variable) {
        self.variables.push(variable);
    }
}

impl Writer {
    /// A place whose type fits, with its type; `None` where there is none.
    pub(super) fn some_place(
        &mut self,
        to_write: bool,
        depth: usize,
        fits: impl Fn(&Self, &Ty) -> bool,
    ) -> Option<(String, Ty)> {
        self.some_shape(to_write, depth, |this, _, shape| fits(this, &shape.ty))
    }

    /// A variable or part of one that is named without a reference, and has bits of its own.
    pub(super) fn direct_place(&mut self, depth: usize, fits: impl Fn(&Self, &Ty) -> bool) -> Option<(String, Ty)> {
        self.some_shape(true, depth, |this, variable, shape| {
            !shape.through && !shape.is_shared && !variable.located && fits(this, &shape.ty)
        })
    }

    /// `REF(x)`, where something of the type lasts.
    pub(super) fn address_of(&mut self, ty: &Ty, depth: usize) -> Option<String> {
        let place = self
            .some_shape(true, depth, |_, variable, it| {
                variable.lasts && !it.through && !it.is_pin && !it.is_shared && it.ty == *ty
            })?
            .0;
        Some(format!("{}({place})", if self.codesys { "ADR" } else { "REF" }))
    }

    /// What can be given to an in-out: not a pin, in a program with references.
    pub(super) fn in_out_place(&mut self, depth: usize, fits: impl Fn(&Self, &Ty) -> bool) -> Option<String> {
        self.some_shape(true, depth, |this, variable, shape| {
            !variable.located && !shape.is_pin && fits(this, &shape.ty)
        })
        .map(|it| it.0)
    }

    fn some_shape(
        &mut self,
        to_write: bool,
        depth: usize,
        fits: impl Fn(&Self, &Variable, &Shape) -> bool,
    ) -> Option<(String, Ty)> {
        let mut found: Vec<(String, Shape)> = Vec::new();
        for variable in &self.scope.variables {
            if to_write && (!variable.writable || self.counters.contains(&variable.name)) {
                continue;
            }
            for shape in self.types.shapes(&variable.ty) {
                if fits(self, variable, &shape) && (shape.writable || !to_write) {
                    found.push((variable.name.clone(), shape));
                }
            }
        }
        if found.is_empty() {
            return None;
        }
        let at = self.random.below(found.len());
        let (name, shape) = found.swap_remove(at);
        let text = self.shown(name, &shape, depth);
        Some((text, shape.ty))
    }

    pub(super) fn place_of(&mut self, ty: &Ty, to_write: bool, depth: usize) -> Option<String> {
        self.some_place(to_write, depth, |_, it| it == ty).map(|it| it.0)
    }

    fn shown(&mut self, name: String, shape: &Shape, depth: usize) -> String {
        let mut text = name;
        for piece in &shape.pieces {
            match piece {
                Piece::Member(name) => {
                    text.push('.');
                    text.push_str(name);
                }
                Piece::Deref => text.push('^'),
                Piece::Index(bounds) => {
                    let indices: Vec<_> = bounds.iter().map(|it| self.index(*it, depth)).collect();
                    text.push_str(&format!("[{}]", indices.join(", ")));
                }
            }
        }
        text
    }

    /// An index that is in range, but for a few: a program that always faults tests little.
    pub(super) fn index(&mut self, (low, high): (i64, i64), depth: usize) -> String {
        let span = usize::try_from(high - low + 1).unwrap_or(1);
        let constant = |this: &mut Self| (low + i64::try_from(this.random.below(span)).unwrap_or(0)).to_string();
        if depth == 0 || self.fuel == 0 {
            return constant(self);
        }
        let ty = Ty::Number(*self.random.one_of(&[0, 1, 1, 2]));
        match self.random.below(12) {
            0..=4 => constant(self),
            5 => {
                let counter = self.counting.last().filter(|it| low >= 0 || it.1).map(|it| it.0.clone());
                match counter {
                    Some(it) if self.random.once_in(6) => it,
                    Some(it) => format!("LIMIT({low}, {it}, {high})"),
                    None => constant(self),
                }
            }
            6..=10 => {
                let value = self.operand(&ty, depth - 1);
                format!("LIMIT({low}, {value}, {high})")
            }
            _ => {
                let value = self.operand(&ty, depth - 1);
                // A constant that is out of range is refused.
                let checked = value.contains(['#', 'k']) || !self.random.once_in(4);
                if checked { format!("ABS({value} MOD 2) + {low}") } else { value }
            }
        }
    }
}
