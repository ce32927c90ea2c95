//! How instances start, as CODESYS has it: what is inside, FB_init of the bases and its own, the values of the
//! declaration, METHODs with `call_after_init`. Initial values that are addresses are assigned then, too.

use crate::calls::Passed;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::starts::Assigns;
use crate::storage::{Place, Value};
use crate::types::{Slot, Type};
use staunch_frontend::ast::{Argument, Initial, InitialKind, PouKind, VarKind};

impl<'a> Machine<'a> {
    /// All instances, before the first scan of any PROGRAM: global ones first, then those of PROGRAMs.
    pub(crate) fn start_instances(&mut self) -> Outcome<()> {
        let globals = self.declared.globals.iter().map(|it| (self.globals[&it.key].clone(), it.slot.clone()));
        let statics = self.declared.pous.iter().enumerate().flat_map(|(number, pou)| {
            let own = pou.variables.iter().filter(|it| it.kind == VarKind::Stat);
            own.map(move |it| ((number, it.name.to_ascii_uppercase()), it.slot.clone()))
        });
        let statics = statics.map(|(key, slot)| (self.statics[&key].clone(), slot));
        // Those that others call come before those that run.
        let (called, running): (Vec<_>, Vec<_>) = self.runs.iter().partition(|it| !it.runs);
        let programs = called.into_iter().chain(running).map(|it| (it.place.clone(), Slot::of(it.place.ty.clone())));
        for (place, slot) in globals.chain(statics).chain(programs).collect::<Vec<_>>() {
            self.construct(&Frame::default(), &place, &slot)?;
        }
        Ok(())
    }

    /// The start of a variable that has its initial values. The frame has what its declaration sees.
    pub(crate) fn construct(&mut self, frame: &Frame<'a>, place: &Place<'a>, slot: &Slot<'a>) -> Outcome<()> {
        if slot.is_kept && self.is_again {
            return Ok(());
        }
        self.assign_references(frame, place, slot)?;
        if let Some(initial) = slot.initial.filter(|_| self.has_fb_init(&place.ty)) {
            self.unassign(place, initial)?;
        }
        let lists = slot.construction.map_or(&[][..], |it| &it.lists);
        if let (Type::Array(array), None) = (&place.ty, slot.initial) {
            // One element starts after the other.
            for number in 0..array.elements() {
                let Some(element) = place.flat(number) else { continue };
                let own = if lists.len() > 1 { lists.get(number..=number).unwrap_or_default() } else { lists };
                self.construct_inside(frame, &element, own)?;
                self.call_after_init(&element)?;
            }
            return Ok(());
        }
        self.construct_inside(frame, place, lists)?;
        if slot.initial.is_some() && self.has_fb_init(&place.ty) {
            let before = std::mem::replace(&mut self.assigns, Assigns::NAMED);
            let assigned = self.start(frame, place, slot.initial);
            self.assigns = before;
            assigned?;
        }
        self.call_after_init(place)
    }

    fn assign_references(&mut self, frame: &Frame<'a>, place: &Place<'a>, slot: &Slot<'a>) -> Outcome<()> {
        if slot.initial.is_none() {
            return Ok(());
        }
        let before = std::mem::replace(&mut self.assigns, Assigns::REFERENCES);
        let assigned = self.start(frame, place, slot.initial);
        self.assigns = before;
        assigned
    }

    /// FB_init sees what the class says, not what the declaration gives the instance.
    fn unassign(&mut self, place: &Place<'a>, initial: &'a Initial<'a>) -> Outcome<()> {
        match &initial.kind {
            InitialKind::Fields(fields) => {
                let Type::Record(record) = place.ty.clone() else { return Ok(()) };
                for (name, initial) in fields {
                    let number = record.fields.iter().position(|it| it.0.eq_ignore_ascii_case(name.text));
                    let Some((number, field)) = number.and_then(|it| Some((it, place.field(it)?))) else { continue };
                    match (&field.ty, record.pou) {
                        (Type::Record(_) | Type::Array(_), _) => self.unassign(&field, initial)?,
                        (Type::Reference(_), _) => {}
                        (_, Some(_)) => {
                            let own = self.instance_frame(place);
                            self.restart_field(&own, &field, record.fields[number].1.initial)?;
                        }
                        (_, None) => {}
                    }
                }
                Ok(())
            }
            InitialKind::Elements(elements) => {
                let mut at = 0;
                for element in elements {
                    let count = element.count.as_ref().map_or(Ok(1), |it| self.declared.number(it))?;
                    for _ in 0..count {
                        at += usize::from(element.values.is_empty());
                        for value in &element.values {
                            if let Some(element) = place.flat(at) {
                                self.unassign(&element, value)?;
                            }
                            at += 1;
                        }
                    }
                }
                Ok(())
            }
            InitialKind::Indexed(_) | InitialKind::Members(_) => {
                unknown("initial values of SCL, by index and by position")
            }
            InitialKind::Value(_) | InitialKind::Bind(_) => Ok(()),
        }
    }

    fn restart_field(&mut self, frame: &Frame<'a>, field: &Place<'a>, initial: Option<&'a Initial<'a>>) -> Outcome<()> {
        let before = std::mem::replace(&mut self.assigns, Assigns::VALUES);
        let started = self.start(frame, field, initial);
        self.assigns = before;
        started
    }

    /// What is inside of a variable; of an instance also its own FB_init.
    fn construct_inside(
        &mut self,
        frame: &Frame<'a>,
        place: &Place<'a>,
        lists: &'a [Vec<Argument<'a>>],
    ) -> Outcome<()> {
        match &place.ty {
            Type::Array(array) => {
                for number in 0..array.elements() {
                    let Some(element) = place.flat(number) else { continue };
                    let own = if lists.len() > 1 { lists.get(number..=number).unwrap_or_default() } else { lists };
                    self.construct_inside(frame, &element, own)?;
                }
                Ok(())
            }
            Type::Record(record) => match record.pou {
                Some(class) => self.construct_instance(frame, place, class, lists.first().map_or(&[][..], |it| it)),
                None => {
                    // A TYPE sees what is global.
                    for (number, (_, slot)) in record.fields.clone().iter().enumerate() {
                        if let Some(field) = place.field(number) {
                            self.construct(&Frame::default(), &field, slot)?;
                        }
                    }
                    Ok(())
                }
            },
            _ => Ok(()),
        }
    }

    pub(crate) fn construct_instance(
        &mut self,
        frame: &Frame<'a>,
        place: &Place<'a>,
        class: usize,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<()> {
        let Type::Record(record) = place.ty.clone() else { return Ok(()) };
        let line = self.declared.line_down(class);
        let seen_by = |number: usize| line.iter().find(|it| number < self.declared.pous[**it].fields).unwrap_or(&class);
        let mut fields = Vec::new();
        for (number, (_, slot)) in record.fields.iter().enumerate() {
            if let Some(field) = place.field(number) {
                fields.push((self.frame_of(place, *seen_by(number)), field, slot.clone()));
            }
        }
        for (own, field, slot) in fields.iter().filter(|it| !(it.2.is_kept && self.is_again)).collect::<Vec<_>>() {
            self.assign_references(own, field, slot)?;
        }
        for (own, field, slot) in &fields {
            self.construct(own, field, slot)?;
        }
        let inits: Vec<usize> = line.iter().filter_map(|it| self.declared.own_routine(*it, "FB_init")).collect();
        let Some(last) = inits.last() else { return Ok(()) };
        let given = self.given_to_init(frame, *last, arguments)?;
        for init in inits {
            let known =
                |name: &str| self.declared.pous[init].variables.iter().any(|it| it.name.eq_ignore_ascii_case(name));
            let passed = given.iter().filter(|it| known(it.0)).map(|it| Passed::value(it.0, it.1.clone())).collect();
            self.run_routine(&Frame::default(), init, place, passed)?;
        }
        Ok(())
    }

    /// The inputs of FB_init: those that the declaration writes, and those that each has.
    fn given_to_init(
        &mut self,
        frame: &Frame<'a>,
        init: usize,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Vec<(&'a str, Value<'a>)>> {
        let mut given = self.values_of(frame, init, arguments, &["bInitRetains", "bInCopyCode"])?;
        given.push(("bInitRetains", Value::bool(!self.is_again)));
        given.push(("bInCopyCode", Value::bool(false)));
        Ok(given)
    }

    /// METHODs with the attribute of a class that has it, the bases' first.
    pub(crate) fn call_after_init(&mut self, place: &Place<'a>) -> Outcome<()> {
        if let Type::Array(array) = &place.ty {
            for number in 0..array.count() {
                if let Some(element) = place.nth(number) {
                    self.call_after_init(&element)?;
                }
            }
            return Ok(());
        }
        let Some(class) = place.ty.class().filter(|it| self.declared.pous[*it].after_init) else { return Ok(()) };
        let mut called: Vec<usize> = Vec::new();
        for owner in self.declared.line_down(class) {
            let own = (0..self.declared.pous.len()).filter(|it| self.declared.pous[*it].owner == Some(owner));
            let methods = own.filter(|it| self.declared.pous[*it].kind == PouKind::Method);
            let here = methods.filter_map(|it| self.declared.routine_of(class, self.declared.pous[it].name));
            for method in here.collect::<Vec<_>>() {
                if self.declared.pous[method].after_init && !called.contains(&method) {
                    called.push(method);
                    self.run_routine(&Frame::default(), method, place, Vec::new())?;
                }
            }
        }
        Ok(())
    }

    /// Whether an instance of this type, or one inside of it, has an FB_init, which may see and write its variables.
    fn has_fb_init(&self, ty: &Type<'a>) -> bool {
        match ty {
            Type::Array(it) => self.has_fb_init(&it.element.ty),
            Type::Record(it) => {
                let mut line = it.pou.into_iter().flat_map(|class| self.declared.line_down(class));
                line.any(|it| self.declared.own_routine(it, "FB_init").is_some())
                    || it.fields.iter().any(|it| self.has_fb_init(&it.1.ty))
            }
            _ => false,
        }
    }

    /// Whether an instance of this type, or one inside of it, starts by METHODs of its own.
    pub(crate) fn is_constructed(&self, ty: &Type<'a>) -> bool {
        match ty {
            Type::Array(it) => self.is_constructed(&it.element.ty),
            Type::Record(it) => {
                let own = it.pou.is_some_and(|class| {
                    let mut line = self.declared.line_down(class).into_iter();
                    self.declared.pous[class].after_init
                        || line.any(|it| self.declared.own_routine(it, "FB_init").is_some())
                });
                own || it.fields.iter().any(|it| self.is_constructed(&it.1.ty))
            }
            _ => false,
        }
    }
}
