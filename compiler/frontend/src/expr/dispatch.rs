//! Calls on what a variable of an INTERFACE refers to, or a reference to a class that others extend: which routine
//! runs depends on the instance's class, whose number is a part of the reference. All classes that it may be of
//! are known, so that the call is a CASE of direct calls, and where there is one class a direct call.

use super::checker::Checker;
use crate::spelling::nearest;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Argument, Arm, Conversion, Elementary, Expr, FaultKind, Location, Op, Place, Projection, RoutineId, Statement,
    StatementKind, StructId, Type, Value,
};
use staunch_runtime::reference::CLASS;

/// The class that an instance may be of, and what is called then.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    number: u64,
    state: StructId,
    slot: usize,
}

/// Where more classes than this are possible, the CASE is in a routine that all such calls share. In native code such
/// a call takes 14 instructions more than the 59 of one in line, however many classes there are; in line each class
/// takes about 180 bytes at each call.
const MANY: usize = 8;

/// What a call that is not direct depends on.
#[derive(Clone, Debug)]
pub(crate) struct Dispatch {
    ways: Vec<Way>,
    at: Location,
    /// The routine that has the CASE, where that is not in line.
    shared: Option<RoutineId>,
}

impl Dispatch {
    /// Whether one of the routines that may run is such a one.
    pub fn calls(&self, is_it: impl Fn(usize) -> bool) -> bool {
        self.ways.iter().any(|it| is_it(it.slot))
    }

    /// The statement that makes the call on the instance that a reference leads to. A reference to none of the
    /// classes is null, or faults as it is followed.
    pub fn statement(&self, instance: &Place, call: &dyn Fn(RoutineId, Place) -> StatementKind) -> StatementKind {
        let called = |way: &Way| call(RoutineId::next(way.slot), seen_as(instance, way.state));
        let Some((last, others)) = self.ways.split_last() else {
            return StatementKind::Fault(FaultKind::NullReference);
        };
        if others.is_empty() {
            return called(last);
        }
        if let Some(shared) = self.shared.and_then(|it| shared_call(it, instance, called(last), self.at)) {
            return shared;
        }
        let arm = |way: &Way| Arm {
            labels: vec![(way.number.into(), way.number.into())],
            body: vec![Statement::new(called(way), self.at)],
        };
        StatementKind::Case {
            selector: class_of(&pointer_of(instance), self.at),
            arms: others.iter().map(arm).collect(),
            otherwise: vec![Statement::new(called(last), self.at)],
        }
    }
}

/// The call of the routine that has the CASE, for one of the class's. That finds the instance before variables that
/// references lead to; a routine is given these before it finds the instance. So such a call is made in line.
fn shared_call(shared: RoutineId, instance: &Place, direct: StatementKind, at: Location) -> Option<StatementKind> {
    let StatementKind::Call { arguments, result, .. } = direct else { return None };
    if arguments.iter().filter_map(Argument::place).any(Place::is_followed) {
        return None;
    }
    let reference = Argument::Value(Expr::load(pointer_of(instance), at));
    let arguments = std::iter::once(reference).chain(arguments).collect();
    Some(StatementKind::Call { callee: shared, instance: None, arguments, result })
}

/// The place that a reference leads to, of this class.
fn seen_as(instance: &Place, state: StructId) -> Place {
    let mut place = instance.clone();
    place.ty = Type::Struct(state);
    if let Some(Projection::Deref { target, .. }) = place.projections.last_mut() {
        *target = place.ty;
    }
    place
}

/// The variable that holds the reference which leads to an instance.
fn pointer_of(instance: &Place) -> Place {
    let reference = match instance.projections.last() {
        Some(Projection::Deref { reference, .. }) => *reference,
        Some(Projection::Field(_) | Projection::Index { .. }) | None => instance.ty,
    };
    instance.before(instance.projections.len().saturating_sub(1), reference)
}

/// The number of the class of what a variable refers to.
pub(super) fn class_of(pointer: &Place, at: Location) -> Expr {
    let lword = Type::Elementary(Elementary::Lword);
    let bits = Expr::convert(Conversion::Same, lword, Expr::load(pointer.clone(), at), at);
    let by = Expr::constant(Elementary::Lint, Value::I64(CLASS.into()), at);
    Expr::apply(Op::Shr, lword, vec![bits, by], at)
}

impl<'s> Checker<'_, 's> {
    /// The instance that a call is made on: what a variable of an INTERFACE refers to as the call begins.
    pub(crate) fn receiver(&mut self, place: Place, span: Span) -> Option<Place> {
        let Some(interface) = self.decl.interface_of(place.ty) else { return Some(place) };
        let at = self.at(span);
        let pointer = self.temporary("instance", place.ty);
        self.assign(pointer.clone(), Expr::load(place, at), span);
        let first = self.decl.implementers(interface).first().copied();
        let state = match first {
            Some(class) => self.decl.signature(class)?.state.map(Type::Struct)?,
            None => Type::Elementary(Elementary::Byte),
        };
        Some(pointer.deref(state, at))
    }

    /// What a call of a routine on an instance depends on; `None` where it is a direct one.
    pub(crate) fn dispatch(&mut self, instance: &Place, slot: usize, callee: Span, span: Span) -> Option<Dispatch> {
        let Some(Projection::Deref { reference, at: followed, .. }) = instance.projections.last() else { return None };
        let classes = match (self.decl.interface_of(*reference), instance.ty) {
            (Some(interface), _) => self.decl.implementers(interface).to_vec(),
            (None, Type::Struct(state)) => {
                let class = self.decl.slot_of_instance(state)?;
                let kin = self.decl.kin(class);
                if kin == [class] {
                    return None;
                }
                kin
            }
            (None, _) => return None,
        };
        let mut ways = Vec::new();
        for class in classes {
            let state = self.decl.signature(class).and_then(|it| it.state);
            let (Some(state), Some(slot)) = (state, self.decl.routine_for(class, slot)) else { continue };
            let number = self.decl.class_number(state, callee);
            ways.push(Way { number, state, slot });
        }
        let mut dispatch = Dispatch { ways, at: self.at(callee), shared: None };
        // A fault at the call is where the reference is followed, as it is in line.
        if dispatch.ways.len() > MANY && *followed == self.at(span) && !self.is_without_body(&dispatch) {
            dispatch.shared = self.shared_dispatch((*reference, instance.ty, slot), &dispatch);
        }
        Some(dispatch)
    }

    /// Whether a library only declares what may run: this is reported at the call.
    fn is_without_body(&self, dispatch: &Dispatch) -> bool {
        dispatch.calls(|slot| self.decl.pous[slot].ast.is_stub)
    }

    /// The routine that has the CASE for all calls of what is in a slot on instances of these classes.
    fn shared_dispatch(&mut self, called: (Type, Type, usize), inner: &Dispatch) -> Option<RoutineId> {
        let inner = Dispatch { at: Location::CALLER, ..inner.clone() };
        let made = self.decl.dispatch_routine(called, |handed| {
            let instance = handed.pointer.deref(called.1, Location::CALLER);
            let call = |callee, instance| {
                let (arguments, result) = (handed.arguments.clone(), handed.result.clone());
                StatementKind::Call { callee, instance: Some(instance), arguments, result }
            };
            vec![Statement::new(inner.statement(&instance, &call), Location::CALLER)]
        });
        made.map(RoutineId::next)
    }

    /// Reports a body that takes more variables than a call by its base gives.
    pub(crate) fn check_in_outs(&mut self, dispatch: &Dispatch, base: usize, span: Span) -> Option<()> {
        let wanted = self.decl.signature(base)?.params.len();
        for way in &dispatch.ways {
            if self.decl.signature(way.slot)?.params.len() == wanted {
                continue;
            }
            let heir = self.decl.pous[way.slot].ast.name;
            let message = format!("this call lacks variables that `{}` needs", heir.text);
            self.report(
                Diagnostic::new(Code::E0303, span, message)
                    .label("this may be an instance of that class")
                    .other(heir.span, "it declares VAR_IN_OUTs that its base does not have"),
            );
            return None;
        }
        Some(())
    }

    /// A reference to an instance, or to what begins with one, with the number of its class where calls may depend on
    /// that.
    pub(crate) fn told_apart(&mut self, reference: Expr, place: &Place, span: Span) -> Expr {
        // What a reference leads to has its number there.
        let is_whole = matches!(place.projections.last(), Some(Projection::Deref { .. }));
        let Some(state) = self.decl.first_instance(place.ty).filter(|_| !is_whole) else { return reference };
        let (ty, at, lword) = (reference.ty, reference.at, Type::Elementary(Elementary::Lword));
        let number = self.decl.class_number(state, span) << CLASS;
        let constant = |value| Expr::constant(Elementary::Lword, Value::U64(value), at);
        let mut bits = self.convert(Conversion::Same, lword, reference);
        if place.is_followed() {
            bits = Expr::apply(Op::And, lword, vec![bits, constant((1 << CLASS) - 1)], at);
        }
        let bits = Expr::apply(Op::Or, lword, vec![bits, constant(number)], at);
        self.convert(Conversion::Same, ty, bits)
    }

    /// A reference to an instance, for a variable of an INTERFACE; the inner `None` says that it was reported.
    pub(crate) fn interface_value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<Option<Expr>> {
        let Type::Struct(state) = self.static_type(expr)? else { return None };
        let class = self.decl.slot_of_instance(state)?;
        let interface = self.decl.interface_of(ty)?;
        if !self.decl.interfaces_of(class).contains(&interface) {
            if self.decl.has_unknown_parts(class) {
                return Some(None);
            }
            let (wanted, found) = (self.type_name(ty), self.type_name(Type::Struct(state)));
            let declared = self.decl.pous[class].ast.name.span;
            self.report(
                Diagnostic::new(Code::E0201, expr.span, format!("`{found}` does not implement `{wanted}`"))
                    .label(format!("expected an instance of a class that does, or another `{wanted}`"))
                    .other(declared, format!("write `IMPLEMENTS {wanted}` here")),
            );
            return Some(None);
        }
        let reference = self.reference_to(expr, staunch_ir::RefKind::RefTo);
        Some(reference.map(|it| self.convert(Conversion::Same, ty, it)))
    }

    /// A value of one INTERFACE for a variable of another: each instance has all that its own one extends.
    pub(crate) fn coerce_interface(&mut self, value: Expr, ty: Type, span: Span) -> Option<Expr> {
        let (from, to) = (self.decl.interface_of(value.ty), self.decl.interface_of(ty));
        if let (Some(from), Some(to)) = (from, to)
            && self.decl.interfaces_of(from).contains(&to)
        {
            return Some(self.convert(Conversion::Same, ty, value));
        }
        if to.is_some() && from.is_some_and(|it| self.decl.has_unknown_parts(it)) {
            return None;
        }
        let (expected, found) = (self.type_name(ty), self.type_name(value.ty));
        let error = Diagnostic::new(Code::E0201, span, format!("expected {expected}, found {found}"))
            .label(format!("this is {found}"));
        let text = self.decl.log.sources.text(span).to_owned();
        self.report(match (from, to) {
            (Some(_), Some(_)) => error.help(format!(
                "`{found}` does not extend `{expected}`: write `__QUERYINTERFACE({text}, variable)`, which asks the instance"
            )),
            (None, Some(_)) => error.help(format!("the instance that it points to is `{text}^`")),
            (Some(_) | None, None) => error.help("call the METHODs of the instance through the variable of the INTERFACE"),
        });
        None
    }

    /// Reports a name that an INTERFACE does not have, where a variable of one is before it.
    pub(crate) fn is_unknown_head(&mut self, ty: Type, name: ast::Name<'s>) -> bool {
        let Some(interface) = self.decl.interface_of(ty) else { return false };
        let mut all: Vec<_> = self.decl.interfaces_of(interface).iter().copied().collect();
        all.sort_unstable();
        let routines = all.iter().flat_map(|it| &self.decl.pous[*it].ast.routines);
        let near = nearest(name.text, routines.map(|it| it.name.text)).map(str::to_owned);
        let (called, title) = (self.decl.routines_on(ty, name.text), self.type_name(ty));
        if called.is_none() && self.decl.has_unknown_parts(interface) {
            return true;
        }
        let error = match called {
            Some(_) => Diagnostic::new(Code::E0306, name.span, format!("`{}` is a METHOD of `{title}`", name.text))
                .label("write parentheses to call it")
                .help(format!("write `{}()`", name.text)),
            None => Diagnostic::new(Code::E0107, name.span, format!("`{title}` has no member `{}`", name.text))
                .label("unknown member"),
        };
        self.report(match near {
            Some(near) if called.is_none() => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
            Some(_) | None => error,
        });
        true
    }

    /// Reports what only other references are for.
    pub(crate) fn report_interface(&mut self, ty: Type, what: &str, span: Span) {
        let ty = self.type_name(ty);
        self.report(
            Diagnostic::new(Code::E0211, span, format!("{what}, but this is a variable of the INTERFACE `{ty}`"))
                .label("its METHODs are called through its name, `variable.Method()`"),
        );
    }
}
