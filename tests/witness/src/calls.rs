//! Calls. Instance, arguments and the places of in-outs and outputs are found from left to right as
//! they are written, each once, before anything is passed.

use crate::classes::is_super;
use crate::declarations::Variable;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::places::pin_type;
use crate::starts::Assigns;
use crate::storage::{Cell, Place, Value};
use crate::types::Type;
use staunch_frontend::Span;
use staunch_frontend::ast::{Argument, ArgumentKind, Expr, ExprKind, Name, PouKind, VarKind};
use staunch_runtime::{BlockInfo, Direction, Family, Value as Scalar};

/// A parameter, and what a call gives it.
pub(crate) struct Passed<'a> {
    name: &'a str,
    given: Given<'a>,
}

enum Given<'a> {
    Value(Value<'a>),
    /// The caller's variable, for an in-out.
    Place(Place<'a>),
    /// Where an output goes after the call.
    Output {
        target: Place<'a>,
        negated: bool,
        span: Span,
    },
}

/// A parameter as the binding of arguments sees it.
struct Formal<'a> {
    name: &'a str,
    kind: VarKind,
    ty: Type<'a>,
}

impl<'a> Passed<'a> {
    pub fn value(name: &'a str, value: Value<'a>) -> Self {
        Self { name, given: Given::Value(value) }
    }
}

/// More calls of METHODs in one another than this are not followed.
const MOST_NESTED: u32 = 40;

impl<'a> Machine<'a> {
    /// A call of a function or an instance; the value of a function that has one.
    ///
    /// EN comes first; where it is FALSE, nothing else happens but that the target of ENO is found. Else that is found as
    /// it is written, by who evaluates the arguments.
    pub(crate) fn call(
        &mut self,
        frame: &Frame<'a>,
        callee: &'a Expr<'a>,
        arguments: &'a [Argument<'a>],
        asked: Option<&Type<'a>>,
    ) -> Outcome<Option<Value<'a>>> {
        let mut enabled = true;
        let mut eno = None;
        let declared = self.parameters_of(frame, callee);
        for argument in arguments.iter().filter(|it| is_enable(it) && !is_declared(&declared, it)) {
            match &argument.kind {
                ArgumentKind::Input(_, value) => enabled = self.value_as(frame, value, &Type::BOOL)?.as_bool()?,
                ArgumentKind::Output { target: Some(_), negated, .. } => eno = Some((argument, *negated)),
                ArgumentKind::Output { .. } | ArgumentKind::Positional(_) => {}
            }
        }
        let around = self.eno.take();
        // An ENO of the callee's own is set by the callee, where it is called.
        if !enabled && !self.declared.is_codesys() {
            let own = arguments.iter().find(|it| is_enable(it) && is_declared(&declared, it));
            if let Some((argument, ArgumentKind::Output { target: Some(_), negated, .. })) =
                own.map(|it| (it, &it.kind))
            {
                eno = Some((argument, *negated));
            }
        }
        let result =
            if enabled { self.call_enabled(frame, callee, arguments, asked)? } else { self.unset(frame, callee)? };
        let found = std::mem::replace(&mut self.eno, around);
        if let Some((argument, negated)) = eno {
            let target = match found {
                Some(target) => target,
                None => self.target_of_enable(frame, argument)?,
            };
            let target = self.checked(target)?;
            let told = self.converted(Value::bool(enabled != negated), &target.ty, argument.span)?;
            self.write(&target, &told);
        }
        Ok(result)
    }

    /// Where an ENO leads.
    fn target_of_enable(&mut self, frame: &Frame<'a>, eno: &'a Argument<'a>) -> Outcome<Place<'a>> {
        match &eno.kind {
            ArgumentKind::Output { target: Some(target), .. } => self.place(frame, target),
            ArgumentKind::Output { target: None, .. } | ArgumentKind::Input(..) | ArgumentKind::Positional(_) => {
                unknown("an ENO without a target")
            }
        }
    }

    /// Evaluates what an argument is for that no parameter takes: EN is known already, ENO leads somewhere.
    pub(crate) fn enable_argument(&mut self, frame: &Frame<'a>, argument: &'a Argument<'a>) -> Outcome<()> {
        if let ArgumentKind::Output { target: Some(_), .. } = &argument.kind {
            // The arguments between may be calls with an ENO of their own, which put this one back.
            self.eno = Some(self.target_of_enable(frame, argument)?);
        }
        Ok(())
    }

    /// The parameters of what has a name of its own.
    fn parameters_of(&self, frame: &Frame<'a>, callee: &Expr<'a>) -> Vec<Formal<'a>> {
        let ExprKind::Name(name) = &callee.kind else { return Vec::new() };
        let instance = self.variable(frame, name).and_then(|it| it.ty.class());
        let pou = instance.or_else(|| self.declared.pou_named(&[*name]));
        pou.map(|it| self.formals(it)).unwrap_or_default()
    }

    /// A body runs while an EN of its own is TRUE; an ENO of its own says so.
    fn body(&mut self, own: &Frame<'a>, pou: usize) -> Outcome<()> {
        let formals = self.formals(pou);
        let declares =
            |name| formals.iter().any(|it| it.name.eq_ignore_ascii_case(name)) && !self.declared.is_codesys();
        // Without an ENO it is like any other input of a PROGRAM, and of every POU in Cscape, Logix and SCL.
        let is_plain = !declares("ENO")
            && (self.declared.pous[pou].kind == PouKind::Program
                || matches!(self.declared.family, Family::Cscape | Family::Logix | Family::S7));
        let enable = own.names.get("EN").filter(|_| declares("EN") && !is_plain);
        let enabled = enable.map_or(Ok(true), |it| self.read(it).as_bool())?;
        if let Some(eno) = own.names.get("ENO").filter(|_| declares("ENO")) {
            self.write(eno, &Value::bool(enabled));
        }
        if enabled {
            self.pull_triggers(own);
            let mut own = own.clone();
            self.see_edges(&mut own);
            self.block(&own, self.declared.pous[pou].body)?;
        }
        Ok(())
    }

    /// The result of a function that does not run.
    fn unset(&mut self, frame: &Frame<'a>, callee: &Expr<'a>) -> Outcome<Option<Value<'a>>> {
        let ExprKind::Name(name) = &callee.kind else { return Ok(None) };
        let own = self.own_routine(frame, name.text).map(|it| it.0);
        let function =
            own.or_else(|| self.declared.pou_named(&[*name])).map(|it| self.declared.pous[it].result.clone());
        let Some(Some(slot)) = function else { return Ok(None) };
        let place = self.allocate(&slot.ty);
        self.start(&Frame::default(), &place, slot.initial)?;
        let value = self.read(&place);
        self.memory.truncate(place.at);
        Ok(Some(value))
    }

    fn call_enabled(
        &mut self,
        frame: &Frame<'a>,
        callee: &'a Expr<'a>,
        arguments: &'a [Argument<'a>],
        asked: Option<&Type<'a>>,
    ) -> Outcome<Option<Value<'a>>> {
        match &callee.kind {
            ExprKind::Name(name) => {
                if let Some((own, instance)) = self.own_routine(frame, name.text) {
                    return self.call_routine(frame, own, &instance, arguments);
                }
                let local = frame.names.contains_key(&name.text.to_ascii_uppercase());
                let function = self.declared.pou_named(&[*name]);
                let function = function.filter(|it| self.declared.pous[*it].kind == PouKind::Function);
                match function {
                    Some(function) => self.call_function(frame, function, arguments),
                    None if local || self.variable(frame, name).is_some() => {
                        let instance = self.place(frame, callee)?;
                        self.call_instance(frame, &instance, arguments)
                    }
                    None => self.standard(frame, name, arguments, asked).map(Some),
                }
            }
            ExprKind::Member(base, name) => match &base.kind {
                ExprKind::Name(family) if family.text.eq_ignore_ascii_case("LOGIX") => {
                    self.call_instruction(frame, name, arguments).map(Some)
                }
                _ => {
                    if let Some(path) = self.outer_path(frame, callee) {
                        match self.declared.pou_named(&path) {
                            Some(pou) if self.declared.pous[pou].kind == PouKind::Function => {
                                return self.call_function(frame, pou, arguments);
                            }
                            None if is_library(&path) => return self.standard(frame, name, arguments, asked).map(Some),
                            Some(_) | None => {}
                        }
                    }
                    let above = if is_super(base) { Some(self.above(frame)?) } else { None };
                    let base = self.receiver(frame, base)?;
                    if let Type::Record(record) = &base.ty
                        && let Some(class) = above.or(record.pou)
                        && let Some(routine) = self.declared.routine_of(class, name.text)
                    {
                        return self.call_routine(frame, routine, &base, arguments);
                    }
                    let Some(instance) = self.member(&base, name.text) else { return unknown("this callee") };
                    self.call_instance(frame, &instance, arguments)
                }
            },
            ExprKind::Deref(inner) if is_super(inner) && arguments.is_empty() => self.call_above(frame).map(|()| None),
            _ => {
                let instance = self.place(frame, callee)?;
                self.call_instance(frame, &instance, arguments)
            }
        }
    }

    /// A METHOD is a function that sees its instance; an ACTION is another body of its POU.
    fn call_routine(
        &mut self,
        frame: &Frame<'a>,
        routine: usize,
        instance: &Place<'a>,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Option<Value<'a>>> {
        let bearer = self.bearer(routine, instance);
        let named = instance.declared.filter(|_| bearer != routine);
        let formals = self.formals(named.unwrap_or(bearer));
        let passed = self.passed(frame, &formals, arguments)?;
        self.look_at_copied(&formals, &passed)?;
        let instance = self.checked(instance.clone())?;
        self.run_routine(frame, routine, &instance, passed)
    }

    /// Whose parameters a call of a routine has: an ACTION those of its instance's class.
    fn bearer(&self, routine: usize, instance: &Place<'a>) -> usize {
        instance.ty.class().filter(|_| self.declared.pous[routine].kind == PouKind::Action).unwrap_or(routine)
    }

    /// One call of a routine whose arguments have been found. A chain of instances that is this long may have no end.
    pub(crate) fn run_routine(
        &mut self,
        frame: &Frame<'a>,
        routine: usize,
        instance: &Place<'a>,
        passed: Vec<Passed<'a>>,
    ) -> Outcome<Option<Value<'a>>> {
        if self.nested >= MOST_NESTED {
            return unknown("a long chain of instances");
        }
        self.nested += 1;
        let result = self.routine(frame, routine, instance, passed);
        self.nested -= 1;
        result
    }

    fn routine(
        &mut self,
        frame: &Frame<'a>,
        routine: usize,
        instance: &Place<'a>,
        passed: Vec<Passed<'a>>,
    ) -> Outcome<Option<Value<'a>>> {
        let Some(owner) = self.declared.pous[routine].owner else { return unknown("a routine without an owner") };
        let method = self.declared.pous[routine].kind != PouKind::Action;
        let called = self.bearer(routine, instance);
        let formals = self.formals(called);
        let size = self.memory.len();
        let mut outer = Frame { class: Some(owner), ..self.frame_of(instance, if method { owner } else { called }) };
        self.name_addresses(&mut outer, owner)?;
        for variable in self.declared.pous[owner].variables.iter().filter(|it| it.kind == VarKind::Stat) {
            let key = variable.name.to_ascii_uppercase();
            outer.names.insert(key.clone(), self.statics[&(owner, key)].clone());
        }
        if !method && frame.this.as_ref().is_some_and(|it| it.1.at == instance.at) {
            // In its own POU it has the in-outs of the current call.
            for it in formals.iter().filter(|it| it.kind == VarKind::InOut) {
                let key = it.name.to_ascii_uppercase();
                outer.names.extend(frame.names.get(&key).map(|place| (key, place.clone())));
            }
        }
        if method {
            // Its own variables are new, and hide those of its POU.
            for variable in &self.declared.pous[routine].variables {
                outer.names.remove(&variable.name.to_ascii_uppercase());
            }
        }
        let (own, copies) = self.enter(called, outer, &passed)?;
        let mut seen = own.clone();
        self.see_edges(&mut seen);
        self.block(&seen, self.declared.pous[routine].body)?;
        self.copy_back(&copies);
        let result = own.names.get(&self.declared.pous[routine].name.to_ascii_uppercase());
        let result = result.filter(|_| method && self.declared.pous[routine].result.is_some()).map(|it| self.read(it));
        self.connect(&own, passed)?;
        self.memory.truncate(size);
        Ok(result)
    }

    fn call_function(
        &mut self,
        frame: &Frame<'a>,
        pou: usize,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Option<Value<'a>>> {
        let formals = self.formals(pou);
        let passed = self.passed(frame, &formals, arguments)?;
        let size = self.memory.len();
        let (own, copies) = self.enter(pou, Frame::default(), &passed)?;
        self.body(&own, pou)?;
        self.copy_back(&copies);
        // All is read before anything is assigned: what the call leaves is a value.
        let result = own.names.get(&self.declared.pous[pou].name.to_ascii_uppercase()).map(|it| self.read(it));
        self.connect(&own, passed)?;
        self.memory.truncate(size);
        Ok(result)
    }

    fn call_instance(
        &mut self,
        frame: &Frame<'a>,
        instance: &Place<'a>,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Option<Value<'a>>> {
        match &instance.ty {
            Type::Record(record) => {
                let Some(pou) = record.pou else { return unknown("a call of a structure") };
                // What a position means is known where the call is written.
                let formals = self.formals(instance.declared.unwrap_or(pou));
                let passed = self.passed(frame, &formals, arguments)?;
                if !passed.iter().any(|it| matches!(it.given, Given::Value(_))) {
                    self.look_at_copied(&formals, &passed)?;
                }
                let instance = &self.checked(instance.clone())?;
                self.run_instance(pou, instance, passed)?;
                Ok(None)
            }
            Type::Block(info) => self.call_block(frame, instance, info, arguments).map(|()| None),
            _ => unknown("a call of a variable"),
        }
    }

    /// One call of an instance whose arguments have been found.
    pub(crate) fn run_instance(&mut self, pou: usize, instance: &Place<'a>, passed: Vec<Passed<'a>>) -> Outcome<()> {
        let size = self.memory.len();
        let mut outer = self.instance_frame(instance);
        self.name_addresses(&mut outer, pou)?;
        let (own, copies) = self.enter(pou, outer, &passed)?;
        let is_program = self.declared.pous[pou].kind == PouKind::Program;
        if is_program {
            self.take_bound(instance);
        }
        self.body(&own, pou)?;
        if is_program {
            self.give_bound(instance);
        }
        self.copy_back(&copies);
        self.connect(&own, passed)?;
        self.memory.truncate(size);
        Ok(())
    }

    /// The callee's names: an instance's exist already; others are made anew for this call. A
    /// text of another capacity is passed as a copy, which is in the second list.
    pub(crate) fn enter(
        &mut self,
        pou: usize,
        mut own: Frame<'a>,
        passed: &[Passed<'a>],
    ) -> Outcome<(Frame<'a>, Vec<(Place<'a>, Place<'a>)>)> {
        // Each with the number of its argument: they come back in the order in which those are written.
        let mut copies: Vec<(usize, (Place<'a>, Place<'a>))> = Vec::new();
        let mut in_outs = Vec::new();
        // The arguments of a call are set before the initial values that use them.
        let is_given =
            |it: &usize| matches!(self.declared.pous[pou].variables[*it].kind, VarKind::Input | VarKind::InOut);
        let (mut order, others): (Vec<_>, Vec<_>) = (0..self.declared.pous[pou].variables.len()).partition(is_given);
        order.extend(others);
        for number in order {
            let Variable { name, kind, slot, .. } = &self.declared.pous[pou].variables[number];
            let (name, kind, slot) = (*name, *kind, slot.clone());
            let key = name.to_ascii_uppercase();
            let argument = passed.iter().position(|it| it.name.eq_ignore_ascii_case(name));
            let given = argument.map(|it| &passed[it].given);
            if kind == VarKind::Stat {
                own.names.insert(key.clone(), self.statics[&(pou, key)].clone());
            } else if let Some(Given::Place(place)) = given {
                in_outs.push((argument.unwrap_or(0), key, place, slot.ty));
            } else if !own.names.contains_key(&key) {
                // An ARRAY[*] is what the call gives.
                let ty = match given {
                    Some(Given::Value(value)) if is_open(&slot.ty) => value.ty.clone(),
                    Some(Given::Output { target, .. }) if is_open(&slot.ty) => target.ty.clone(),
                    Some(_) | None => slot.ty.clone(),
                };
                let place = self.allocate(&ty);
                if kind != VarKind::Input && self.is_constructed(&slot.ty) {
                    let before = std::mem::replace(&mut self.assigns, Assigns::VALUES);
                    let started = self.start(&own, &place, slot.initial);
                    self.assigns = before;
                    started?;
                    self.construct(&own, &place, &slot)?;
                } else {
                    self.start(&own, &place, slot.initial)?;
                }
                own.names.insert(key.clone(), place);
            }
            if let Some(Given::Value(value)) = given {
                let place = own.names[&name.to_ascii_uppercase()].clone();
                self.write(&place, value);
            }
        }
        // What is copied is so when the inputs have their values: an in-out may be a part of what they are stored in.
        for (argument, key, given, ty) in in_outs {
            let place = self.in_out(given, &ty);
            if place.at != given.at {
                copies.push((argument, (place.clone(), given.clone())));
            }
            own.names.insert(key, place);
        }
        // An in-out that a reference leads to is looked at then, too.
        for variable in &self.declared.pous[pou].variables {
            let given = passed.iter().find(|it| it.name.eq_ignore_ascii_case(variable.name));
            if let Some(Passed { given: Given::Place(place), .. }) = given {
                self.checked(place.clone())?;
            }
        }
        let pou = &self.declared.pous[pou];
        if let Some(slot) = pou.result.clone() {
            let name = pou.name.to_ascii_uppercase();
            let place = self.allocate(&slot.ty);
            self.start(&own, &place, slot.initial)?;
            own.names.insert(name, place);
        }
        copies.sort_by_key(|it| it.0);
        Ok((own, copies.into_iter().map(|it| it.1).collect()))
    }

    /// What is copied is read before the call looks at its instance, unless an input was stored there.
    fn look_at_copied(&self, formals: &[Formal<'a>], passed: &[Passed<'a>]) -> Outcome<()> {
        for Passed { name, given } in passed {
            let formal = formals.iter().find(|it| it.name == *name);
            if let (Given::Place(place), Some(formal)) = (given, formal)
                && is_copied(place, &formal.ty)
            {
                self.checked(place.clone())?;
            }
        }
        Ok(())
    }

    /// The variable that a VAR_IN_OUT stands for: the caller's, or a copy of it.
    fn in_out(&mut self, given: &Place<'a>, ty: &Type<'a>) -> Place<'a> {
        match (&given.ty, ty) {
            (Type::Text(from), Type::Text(to)) if from != to && given.window.is_none() => {
                let copy = self.allocate(ty);
                self.memory[copy.at] = cut(&self.memory[given.at], to.capacity);
                copy
            }
            // What shares its bytes goes in as a copy, and comes back when the call ends.
            _ if given.window.is_some() => {
                let copy = self.allocate(ty);
                let value = self.read(given);
                self.write(&copy, &value);
                copy
            }
            _ => Place { declared: ty.class(), ..given.clone() },
        }
    }

    pub(crate) fn copy_back(&mut self, copies: &[(Place<'a>, Place<'a>)]) {
        for (copy, given) in copies {
            match given.ty {
                Type::Text(text) if given.window.is_none() => {
                    self.memory[given.at] = cut(&self.memory[copy.at], text.capacity);
                }
                _ => self.write(given, &self.read(copy)),
            }
        }
    }

    /// Assigns the outputs to what they are connected with, in the order in which that is written.
    fn connect(&mut self, own: &Frame<'a>, passed: Vec<Passed<'a>>) -> Outcome<()> {
        for Passed { name, given } in passed {
            if let Given::Output { target, negated, span } = given {
                let value = self.read(&own.names[&name.to_ascii_uppercase()]);
                self.output(&target, value, negated, span)?;
            }
        }
        Ok(())
    }

    fn output(&mut self, target: &Place<'a>, value: Value<'a>, negated: bool, span: Span) -> Outcome<()> {
        let value = match (negated, value.ty.elementary()) {
            (true, Some(ty)) => self.applied("NOT", ty, &[value.as_scalar()?], span)?,
            _ => value,
        };
        let value = self.converted(value, &target.ty, span)?;
        let target = &self.checked(target.clone())?;
        self.write(target, &value);
        Ok(())
    }

    fn formals(&self, pou: usize) -> Vec<Formal<'a>> {
        let parameters = self.declared.pous[pou].variables.iter().filter(|it| it.is_parameter());
        parameters.map(|it| Formal { name: it.name, kind: it.kind, ty: it.slot.ty.clone() }).collect()
    }

    /// What the run of a PROGRAM is connected with.
    pub(crate) fn arguments_of(&mut self, pou: usize, arguments: &'a [Argument<'a>]) -> Outcome<Vec<Passed<'a>>> {
        let formals = self.formals(pou);
        self.passed(&Frame::default(), &formals, arguments)
    }

    /// The values of a routine's inputs but for some.
    pub(crate) fn values_of(
        &mut self,
        frame: &Frame<'a>,
        routine: usize,
        arguments: &'a [Argument<'a>],
        without: &[&str],
    ) -> Outcome<Vec<(&'a str, Value<'a>)>> {
        let mut formals = self.formals(routine);
        formals.retain(|it| !without.iter().any(|name| it.name.eq_ignore_ascii_case(name)));
        let values = self.passed(frame, &formals, arguments)?.into_iter().map(|it| match it.given {
            Given::Value(value) => Ok((it.name, value)),
            Given::Place(_) | Given::Output { .. } => unknown("an argument of FB_init that is not an input"),
        });
        values.collect()
    }

    /// What the arguments give, in the order in which they are written.
    fn passed(
        &mut self,
        frame: &Frame<'a>,
        formals: &[Formal<'a>],
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Vec<Passed<'a>>> {
        let mut passed: Vec<Passed<'a>> = Vec::new();
        // A named argument that comes later does not take a parameter from a positional one.
        let mut taken: Vec<&str> = Vec::new();
        for argument in arguments {
            if is_enable(argument) && !is_declared(formals, argument) {
                self.enable_argument(frame, argument)?;
                continue;
            }
            let (name, value, negated) = match &argument.kind {
                ArgumentKind::Positional(value) => {
                    let outputs_last =
                        |last: bool| formals.iter().filter(move |it| (it.kind == VarKind::Output) == last);
                    // The standard: "in exactly the same order" as they are declared.
                    let mut free: Vec<&Formal<'a>> = match self.declared.family {
                        Family::Iec | Family::Cscape | Family::Openplc | Family::Openplc4 => formals.iter().collect(),
                        Family::Codesys | Family::Logix | Family::S7 => {
                            outputs_last(false).chain(outputs_last(true)).collect()
                        }
                    };
                    let free = free.drain(..).find(|it| !taken.iter().any(|name| it.name.eq_ignore_ascii_case(name)));
                    let Some(free) = free else { return unknown("an argument too many") };
                    (free.name, Some(value), false)
                }
                ArgumentKind::Input(name, value) => (name.text, Some(value), false),
                ArgumentKind::Output { name, negated, target } => (name.text, target.as_ref(), *negated),
            };
            taken.push(name);
            let Some(formal) = formals.iter().find(|it| it.name.eq_ignore_ascii_case(name)) else {
                return unknown(&format!("the parameter {name}"));
            };
            let Some(value) = value else { continue };
            let given = match formal.kind {
                VarKind::InOut => Given::Place(self.place(frame, value)?),
                VarKind::Output => Given::Output { target: self.place(frame, value)?, negated, span: value.span },
                _ => Given::Value(self.value_as(frame, value, &formal.ty)?),
            };
            passed.push(Passed { name: formal.name, given });
        }
        Ok(passed)
    }

    fn call_block(
        &mut self,
        frame: &Frame<'a>,
        instance: &Place<'a>,
        info: &'static BlockInfo,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<()> {
        let pins = info.pins.iter().enumerate();
        let visible = pins.filter_map(|(at, pin)| {
            let kind = match pin.direction {
                Direction::Input => VarKind::Input,
                Direction::Output => VarKind::Output,
                Direction::Memory | Direction::Member => return None,
            };
            Some(Formal { name: pin.name, kind, ty: pin_type(info, at) })
        });
        let passed = self.passed(frame, &visible.collect::<Vec<_>>(), arguments)?;
        let instance = &self.checked(instance.clone())?;
        for it in &passed {
            if let (Some(pin), Given::Value(value)) = (self.member(instance, it.name), &it.given) {
                self.write(&pin, value);
            }
        }
        self.run_block(instance, info, 0, false);
        for Passed { name, given } in passed {
            if let (Some(pin), Given::Output { target, negated, span }) = (self.member(instance, name), given) {
                self.output(&target, self.read(&pin), negated, span)?;
            }
        }
        Ok(())
    }

    /// `LOGIX.CTU(Counter := tag, RungIn := condition)`: gives the rung condition back.
    fn call_instruction(
        &mut self,
        frame: &Frame<'a>,
        name: &Name<'a>,
        arguments: &'a [Argument<'a>],
    ) -> Outcome<Value<'a>> {
        let mut tag = None;
        let mut rung = false;
        for (at, argument) in arguments.iter().enumerate() {
            let (value, is_tag) = match &argument.kind {
                ArgumentKind::Positional(value) => (value, at == 0),
                ArgumentKind::Input(name, value) => (value, !name.text.eq_ignore_ascii_case("RungIn")),
                ArgumentKind::Output { .. } => return unknown("an output of an instruction"),
            };
            if is_tag {
                tag = Some(self.place(frame, value)?);
            } else {
                rung = self.value_as(frame, value, &Type::BOOL)?.as_bool()?;
            }
        }
        let Some(tag) = tag else { return unknown("an instruction without a tag") };
        let tag = self.checked(tag)?;
        let Type::Block(info) = tag.ty else { return unknown("an instruction on something other than a tag") };
        let instruction = info.instructions.iter().position(|it| it.name.eq_ignore_ascii_case(name.text));
        let Some(instruction) = instruction else { return unknown("this instruction") };
        self.run_block(&tag, info, instruction, rung);
        Ok(Value::bool(rung))
    }

    /// Runs the runtime's own block on an instance's pins.
    pub(crate) fn run_block(&mut self, instance: &Place<'a>, info: &BlockInfo, instruction: usize, rung: bool) {
        let mut bytes = vec![0; info.size];
        for (number, pin) in info.pins.iter().enumerate() {
            if let Cell::Scalar(value) = &self.memory[instance.at + number] {
                value.write(&mut bytes[pin.offset..]);
            }
        }
        (info.instructions[instruction].run)(&mut bytes, &self.context, rung);
        for (number, pin) in info.pins.iter().enumerate() {
            self.memory[instance.at + number] = Cell::Scalar(Scalar::read(pin.ty.repr(), &bytes[pin.offset..]));
        }
    }
}

/// `Standard.LEN`
fn is_library(path: &[Name<'_>]) -> bool {
    matches!(path, [library, _] if ["Standard", "Tc2_Standard"].iter().any(|it| it.eq_ignore_ascii_case(library.text)))
}

fn is_open(ty: &Type<'_>) -> bool {
    matches!(ty, Type::Array(it) if it.is_open)
}

/// Whether an in-out of this type is a copy: a text of another capacity, and what shares its bytes.
fn is_copied(given: &Place<'_>, ty: &Type<'_>) -> bool {
    matches!((&given.ty, ty), (Type::Text(from), Type::Text(to)) if from != to) || given.window.is_some()
}

/// `EN := …` and `ENO => …`, which every call can have.
pub(crate) fn is_enable(argument: &Argument<'_>) -> bool {
    match &argument.kind {
        ArgumentKind::Positional(_) => false,
        ArgumentKind::Input(name, _) => name.text.eq_ignore_ascii_case("EN"),
        ArgumentKind::Output { name, .. } => name.text.eq_ignore_ascii_case("ENO"),
    }
}

/// Whether the callee has a parameter of its own for it.
fn is_declared(formals: &[Formal<'_>], enable: &Argument<'_>) -> bool {
    let name = match &enable.kind {
        ArgumentKind::Positional(_) => return false,
        ArgumentKind::Input(name, _) | ArgumentKind::Output { name, .. } => name.text,
    };
    formals.iter().any(|it| it.name.eq_ignore_ascii_case(name))
}

fn cut<'a>(text: &Cell<'a>, capacity: usize) -> Cell<'a> {
    match text {
        Cell::Text(units) => Cell::Text(units.iter().copied().take(capacity).collect()),
        Cell::Scalar(_) | Cell::Reference(_) | Cell::Bytes(_) => text.clone(),
    }
}
