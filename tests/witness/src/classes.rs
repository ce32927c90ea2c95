//! Classes: what one EXTENDS, which METHOD, ACTION or PROPERTY a name means there, and SUPER.
//!
//! Where a variable lies, its type is the one it was declared with: a reference or an in-out of a base leads to
//! a place of the heir's type. So what is called is what the place's own type has.

use crate::calls::Passed;
use crate::declarations::{Declarations, Pou, path_of};
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::storage::{Place, Value};
use crate::types::{RefKind, Type};
use staunch_frontend::ast::{Expr, ExprKind, PouKind, TypeSpec, VarKind};

impl<'a> Declarations<'a> {
    /// A class, and those above it.
    fn line(&self, class: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(class), |it| self.pous[*it].base)
    }

    /// A class after those above it.
    pub fn line_down(&self, class: usize) -> Vec<usize> {
        let mut line: Vec<usize> = self.line(class).collect();
        line.reverse();
        line
    }

    /// The witness finds METHODs only by their names: overloads, which CODESYS does not have, are not supported.
    pub fn refuse_overloads(&self) -> Outcome<()> {
        if self.is_codesys() {
            return Ok(());
        }
        let parameters = |it: &Pou<'a>| {
            let all = it.variables.iter().filter(|it| it.is_parameter());
            let ty = |it: &Type<'a>| if let Type::Reference(_) = it { String::new() } else { format!("{it:?}") };
            all.map(|it| format!("{:?} {}", it.kind, ty(&it.slot.ty))).collect::<Vec<_>>()
        };
        let methods = || self.pous.iter().enumerate().filter(|it| it.1.kind == PouKind::Method);
        for (at, method) in methods() {
            let Some(class) = method.owner.filter(|it| self.pous[*it].kind != PouKind::Interface) else { continue };
            let line: Vec<usize> = self.line(class).collect();
            let mut beside = methods().filter(|it| it.0 != at && it.1.owner.is_some_and(|it| line.contains(&it)));
            let is_one =
                |it: &Pou<'a>| it.name.eq_ignore_ascii_case(method.name) && parameters(it) != parameters(method);
            if beside.any(|it| it.1.owner == Some(class) && it.1.name.eq_ignore_ascii_case(method.name) || is_one(it.1))
            {
                return unknown("METHODs with the same name");
            }
        }
        Ok(())
    }

    /// The METHOD with this name that a class itself declares.
    pub fn own_routine(&self, class: usize, name: &str) -> Option<usize> {
        self.pous
            .iter()
            .position(|it| it.owner == Some(class) && it.kind == PouKind::Method && it.name.eq_ignore_ascii_case(name))
    }

    fn routine_where(&self, class: usize, name: &str, fits: impl Fn(PouKind) -> bool) -> Option<usize> {
        self.line(class).find_map(|class| {
            let own = |it: &Pou<'a>| it.owner == Some(class) && fits(it.kind);
            self.pous.iter().position(|it| own(it) && it.name.eq_ignore_ascii_case(name))
        })
    }

    /// The METHOD or ACTION with this name, its own or inherited.
    pub fn routine_of(&self, class: usize, name: &str) -> Option<usize> {
        self.routine_where(class, name, |it| matches!(it, PouKind::Method | PouKind::Action))
    }

    /// The GET or SET of a PROPERTY.
    pub fn accessor_of(&self, class: usize, name: &str, kind: PouKind) -> Option<usize> {
        self.routine_where(class, name, |it| it == kind)
    }

    pub fn has_property(&self, class: usize, name: &str) -> bool {
        self.routine_where(class, name, |it| matches!(it, PouKind::Getter | PouKind::Setter)).is_some()
    }

    /// Whether a class is, extends or implements the other.
    pub fn is_a(&self, class: usize, other: usize) -> bool {
        self.line(class)
            .any(|it| it == other || self.pous[it].implements.iter().any(|it| self.interface_is(*it, other)))
    }

    /// A class that has an interface, for what a call through it is given.
    pub fn implementer(&mut self, interface: &'a TypeSpec<'a>) -> Outcome<Type<'a>> {
        let Some(interface) = self.pou_named(path_of(interface)) else { return unknown("this INTERFACE") };
        let mut classes = (0..self.pous.len()).filter(|it| self.pous[*it].owner.is_none());
        let found = classes.find(|it| self.pous[*it].kind != PouKind::Interface && self.is_a(*it, interface));
        found.map_or_else(|| unknown("an interface that no class has"), |it| self.instance_of(it))
    }

    fn interface_is(&self, interface: usize, other: usize) -> bool {
        interface == other || self.pous[interface].implements.iter().any(|it| self.interface_is(*it, other))
    }
}

impl<'a> Machine<'a> {
    /// A routine that a body names without an instance: of its own instance, and what that instance's class has.
    pub(crate) fn own_routine(&self, frame: &Frame<'a>, name: &str) -> Option<(usize, Place<'a>)> {
        self.declared.routine_of(frame.class?, name)?;
        let (class, instance) = frame.this.as_ref()?;
        Some((self.declared.routine_of(*class, name)?, instance.clone()))
    }

    /// What `SUPER` is: the class above the one whose text this is.
    pub(crate) fn above(&self, frame: &Frame<'a>) -> Outcome<usize> {
        let above = frame.class.and_then(|it| self.declared.pous[it].base);
        above.map_or_else(|| unknown("SUPER without a base"), Ok)
    }

    /// `SUPER^()`: the base's body, with the inputs and in-outs that this call has.
    pub(crate) fn call_above(&mut self, frame: &Frame<'a>) -> Outcome<()> {
        let above = self.above(frame)?;
        let Some((_, instance)) = frame.this.clone() else { return unknown("SUPER without an instance") };
        let size = self.memory.len();
        let mut outer = self.frame_of(&instance, above);
        self.name_addresses(&mut outer, above)?;
        for variable in self.declared.pous[above].variables.iter().filter(|it| it.kind == VarKind::InOut) {
            let key = variable.name.to_ascii_uppercase();
            outer.names.extend(frame.names.get(&key).map(|place| (key, place.clone())));
        }
        let (mut own, copies) = self.enter(above, outer, &[])?;
        self.see_edges(&mut own);
        self.block(&own, self.declared.pous[above].body)?;
        self.copy_back(&copies);
        self.memory.truncate(size);
        Ok(())
    }

    /// The PROPERTY that an expression names, with its instance and the class where it is looked for.
    pub(crate) fn property(
        &mut self,
        frame: &Frame<'a>,
        expr: &'a Expr<'a>,
    ) -> Outcome<Option<(&'a str, usize, Place<'a>)>> {
        match &expr.kind {
            ExprKind::Paren(inner) => self.property(frame, inner),
            ExprKind::Name(name) => {
                let hidden = self.variable(frame, name).is_some();
                let own = frame.class.is_some_and(|it| self.declared.has_property(it, name.text));
                Ok(frame.this.clone().filter(|_| own && !hidden).map(|(class, it)| (name.text, class, it)))
            }
            ExprKind::Member(base, name) if self.may_be_property(name.text) && !self.is_type(frame, base) => {
                let above = is_super(base);
                let instance = self.receiver(frame, base)?;
                let Type::Record(record) = &instance.ty else { return Ok(None) };
                let class = if above { Some(self.above(frame)?) } else { record.pou };
                let class = class.filter(|it| self.declared.has_property(*it, name.text));
                Ok(class.map(|it| (name.text, it, instance)))
            }
            _ => Ok(None),
        }
    }

    fn is_type(&self, frame: &Frame<'a>, base: &Expr<'a>) -> bool {
        matches!(&base.kind, ExprKind::Name(name) if self.variable(frame, name).is_none())
            && !is_this(base)
            && !is_super(base)
    }

    fn may_be_property(&self, name: &str) -> bool {
        let mut routines = self.declared.pous.iter().filter(|it| it.owner.is_some());
        routines.any(|it| matches!(it.kind, PouKind::Getter | PouKind::Setter) && it.name.eq_ignore_ascii_case(name))
    }

    /// What a PROPERTY's GET gives.
    pub(crate) fn got(&mut self, name: &str, class: usize, instance: &Place<'a>) -> Outcome<Value<'a>> {
        let getter = self.declared.accessor_of(class, name, PouKind::Getter);
        let Some(getter) = getter else { return unknown("a PROPERTY without GET") };
        let instance = self.checked(instance.clone())?;
        match self.run_routine(&Frame::default(), getter, &instance, Vec::new())? {
            Some(value) => Ok(value),
            None => unknown("a GET without a value"),
        }
    }

    /// `fb.p := value`
    pub(crate) fn set(
        &mut self,
        frame: &Frame<'a>,
        (name, class, instance): (&str, usize, Place<'a>),
        value: &'a Expr<'a>,
    ) -> Outcome<()> {
        let setter = self.declared.accessor_of(class, name, PouKind::Setter);
        let Some(setter) = setter else { return unknown("a PROPERTY without SET") };
        let input = self.declared.pous[setter].variables.iter().find(|it| it.name.eq_ignore_ascii_case(name));
        let Some((input, ty)) = input.map(|it| (it.name, it.slot.ty.clone())) else { return unknown("this SET") };
        let value = self.value_as(frame, value, &ty)?;
        let instance = self.checked(instance)?;
        self.run_routine(&Frame::default(), setter, &instance, vec![Passed::value(input, value)])?;
        Ok(())
    }

    /// The instance or structure before a point. A variable of an INTERFACE leads on to its instance; what a call or a
    /// GET gives is kept until the call around it ends.
    pub(crate) fn receiver(&mut self, frame: &Frame<'a>, expr: &'a Expr<'a>) -> Outcome<Place<'a>> {
        let value = match (&expr.kind, self.property(frame, expr)?) {
            (_, Some((name, class, instance))) => self.got(name, class, &instance)?,
            (ExprKind::Paren(inner), None) => return self.receiver(frame, inner),
            (ExprKind::Call(..), None) => self.value(frame, expr, None)?,
            _ => {
                let place = self.place(frame, expr)?;
                return match place.ty {
                    Type::Reference(it) if it.kind == RefKind::Interface => {
                        let place = self.checked(place)?;
                        let cell = self.memory[place.at].clone();
                        self.followed(cell, it, expr.span)
                    }
                    _ => Ok(place),
                };
            }
        };
        match &value.ty {
            Type::Reference(it) if it.kind != RefKind::Pointer => {
                let cell = value.cells[0].clone();
                self.followed(cell, *it, expr.span)
            }
            ty => {
                let place = self.allocate(ty);
                self.write(&place, &value);
                Ok(place)
            }
        }
    }
}

pub(crate) fn is_this(expr: &Expr<'_>) -> bool {
    names(expr, "THIS")
}

pub(crate) fn is_super(expr: &Expr<'_>) -> bool {
    match &expr.kind {
        ExprKind::Deref(inner) | ExprKind::Paren(inner) => is_super(inner),
        _ => names(expr, "SUPER"),
    }
}

fn names(expr: &Expr<'_>, word: &str) -> bool {
    matches!(&expr.kind, ExprKind::Name(name) if name.text.eq_ignore_ascii_case(word))
}
