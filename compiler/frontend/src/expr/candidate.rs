//! Which of several FUNCTIONs or METHODs with the same name a call means.
//!
//! Those are candidates to which each argument can be given as it is written. One is better than another where at
//! some argument its parameter is closer to what is given, and at none is it farther: a parameter of the argument's
//! own type is closest, then an integer, real or bit string for one of the same kind; of two others, one whose values
//! the other has too; one with a type before a generic one.
//! A number that is written without a type decides where nothing else does, as the type that it has by itself; if the
//! call's place does not take what that gives, the one that gives the place's type is meant.
//! Candidates that are given all their inputs go before those that are not. The call means the one that is better
//! than all others.

use super::argument::Parts;
use super::binding::{Given, Parameter};
use super::checker::{Checker, Choice};
use super::enable::is_en;
use crate::diagnostic::wording::all_of;
use crate::types::coercion::widens;
use crate::types::signature::{Formal, Signature};
use crate::{Code, Diagnostic, Span, ast};
use ast::ArgumentKind;
use staunch_ir::{Elementary, Section, Type};
use std::rc::Rc;

/// A FUNCTION that takes the arguments of a call.
struct Candidate {
    slot: usize,
    /// What each argument is given to.
    takes: Vec<Option<Taker>>,
    leaves_out: bool,
    /// So many inputs keep their own initial values.
    defaults: usize,
}

/// A parameter, as far as it decides.
#[derive(Clone, Copy)]
struct Taker {
    ty: Type,
    is_generic: bool,
    /// It gives a value to what the argument names.
    is_output: bool,
}

impl<'s> Checker<'_, 's> {
    /// Of the FUNCTIONs that a name leads to, by the first of them, the one that a call means.
    pub(crate) fn meant(
        &mut self,
        slot: usize,
        name: Span,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<usize> {
        match self.decl.overloads.of(slot) {
            Some(all) => self.meant_of(&all, name, arguments, expected),
            None => Some(slot),
        }
    }

    /// The one of several that a call means.
    pub(super) fn meant_of(
        &mut self,
        all: &[usize],
        name: Span,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<usize> {
        let whole = arguments.last().map_or(name, |it| name.to(it.span));
        let expected = expected.and_then(Type::elementary);
        let choice = match self.choices.get(&(name, expected)) {
            Some(known) => known.clone(),
            None => {
                let choice = self.choice(all, name, whole, arguments, expected);
                self.choices.insert((name, expected), choice.clone());
                choice
            }
        };
        match choice {
            Ok(slot) => Some(slot),
            Err(error) => {
                // What is wrong in an argument by itself is said by whoever looks at the arguments.
                if self.tried(whole, |this| this.check_arguments(arguments)).is_some() {
                    self.report(*error);
                }
                None
            }
        }
    }

    fn choice(
        &mut self,
        all: &[usize],
        name: Span,
        whole: Span,
        arguments: &[ast::Argument<'s>],
        expected: Option<Elementary>,
    ) -> Choice {
        let mut candidates = Vec::new();
        for slot in all {
            candidates.extend(self.candidate(*slot, whole, arguments));
        }
        if candidates.iter().any(|it| !it.leaves_out) {
            candidates.retain(|it| !it.leaves_out);
        }
        let given: Vec<_> = arguments.iter().map(|it| self.own_type(it)).collect();
        let typed: Vec<_> = given.iter().map(|it| it.filter(|it| !it.1).map(|it| it.0)).collect();
        let all_types: Vec<_> = given.iter().map(|it| it.map(|it| it.0)).collect();
        match candidates.as_slice() {
            [] => Err(Box::new(self.none_fits(all, name))),
            [one] => Ok(one.slot),
            several => {
                let found = best(several, &typed).or_else(|| {
                    let by_numbers = best(several, &all_types).or_else(|| fewest_defaults(several, &all_types))?;
                    Some(self.for_its_place(several, by_numbers, expected))
                });
                found.ok_or_else(|| Box::new(self.several_fit(several, name)))
            }
        }
    }

    /// Where only numbers without a type chose, and what was chosen gives what its place does not take: the one
    /// candidate that gives the place's type.
    fn for_its_place(&mut self, candidates: &[Candidate], chosen: usize, expected: Option<Elementary>) -> usize {
        let Some(expected) = expected else { return chosen };
        let mut gives = |slot: usize| self.decl.signature(slot)?.result.as_ref()?.1.ty.read().elementary();
        if gives(chosen).is_none_or(|it| widens(it, expected)) {
            return chosen;
        }
        let mut fitting = candidates.iter().map(|it| it.slot).filter(|it| gives(*it) == Some(expected));
        match (fitting.next(), fitting.next()) {
            (Some(only), None) => only,
            _ => chosen,
        }
    }

    /// A FUNCTION as a candidate, if it takes the arguments.
    fn candidate(&mut self, slot: usize, whole: Span, arguments: &[ast::Argument<'s>]) -> Option<Candidate> {
        let signature = self.decl.signature(slot)?;
        let formals = &signature.formals;
        let is_own = |it: &&ast::Argument<'s>| !is_en(it) || formals.iter().any(|formal| is_named(it, formal.name));
        let own: Vec<_> = arguments.iter().filter(is_own).cloned().collect();
        let parameters: Vec<_> = formals.iter().map(Parameter::of_formal).collect();
        let owner = self.decl.pous[slot].ast.name;
        let given = self.tried(whole, |this| {
            let given =
                this.bind(owner.text, &parameters, &own, |name| Self::unknown_formal(owner.text, formals, name))?;
            let is_optional = |this: &Self, at: usize| this.has_initial(&formals[at], slot);
            this.require_all(owner.text, &parameters, &given, &own, is_optional, whole)?;
            Some(given)
        })??;
        let (mut leaves_out, mut defaults) = (false, 0);
        let mut takes = vec![None; arguments.len()];
        for (at, given) in given.iter().enumerate() {
            let formal = &formals[at];
            let place = match given {
                Given::Nothing if formal.section == Section::InOut => return None,
                Given::Nothing => {
                    let has_initial = self.has_initial(formal, slot);
                    leaves_out |= formal.section == Section::Input && !has_initial;
                    defaults += usize::from(formal.section == Section::Input && has_initial);
                    continue;
                }
                Given::Output { target: None, .. } => continue,
                Given::Output { target: Some(target), .. } => {
                    self.gives(formal, target)?;
                    target.span
                }
                Given::Value(value) => {
                    self.accepts(&signature, at, value)?;
                    value.span
                }
            };
            let argument = arguments.iter().position(|it| within(place, it.span))?;
            let (ty, is_output) = (formal.resolved.ty.read(), formal.section == Section::Output);
            takes[argument] = Some(Taker { ty, is_generic: formal.word.is_some(), is_output });
        }
        Some(Candidate { slot, takes, leaves_out, defaults })
    }

    /// Whether a parameter takes a value or variable as it is written.
    fn accepts(&mut self, signature: &Rc<Signature<'s>>, at: usize, value: &ast::Expr<'s>) -> Option<()> {
        let word = signature.formals[at].word;
        let accepted = self.tried(value.span, |this| match word {
            Some(class) => {
                let ty = this.typed(value, None)?.ty;
                this.admits(class, ty, value.span).then_some(())
            }
            None => this.given_part(&mut Parts::default(), signature, at, value),
        });
        accepted.flatten()
    }

    /// Whether an output's value can be stored where an argument says.
    fn gives(&mut self, formal: &Formal<'s>, target: &ast::Expr<'s>) -> Option<()> {
        let into = self.type_of_target(target)?;
        let from = formal.resolved.ty.read();
        let becomes = match (from, into) {
            (Type::Elementary(from), Type::Elementary(into)) => widens(from, into),
            _ => is_one(from, into),
        };
        (becomes || formal.word.is_some()).then_some(())
    }

    fn type_of_target(&mut self, target: &ast::Expr<'s>) -> Option<Type> {
        let ty = self.tried(target.span, |this| {
            let found = this.place(target)?;
            Some(found.view.map_or(found.place.ty, |it| it.ty))
        });
        ty.flatten().map(Type::read)
    }

    /// The type that an argument has by itself, and whether it is a number written without one.
    fn own_type(&mut self, argument: &ast::Argument<'s>) -> Option<(Type, bool)> {
        let value = match &argument.kind {
            ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => value,
            ArgumentKind::Output { target, .. } => return Some((self.type_of_target(target.as_ref()?)?, false)),
        };
        let operand = self.tried(value.span, |this| {
            let operand = this.operand(value, None)?;
            let own = operand.ty();
            let ty = own.or_else(|| Some(this.materialise(operand, None, value.span)?.ty))?;
            Some((ty.read(), own.is_none()))
        });
        operand.flatten()
    }

    /// Does what has no consequence but its result; `None` where something is reported of what is at `place`.
    pub(super) fn tried<T>(&mut self, place: Span, what: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let reported = self.decl.log.diagnostics.len();
        let (locals, called) = (self.locals.len(), self.called.len());
        let uses = std::mem::take(&mut self.uses);
        let left_out = self.left_out;
        let late = self.late.take();
        let outer = std::mem::take(&mut self.block);
        let result = what(self);
        self.block = outer;
        self.locals.truncate(locals);
        self.called.split_off(called);
        self.uses = uses;
        self.left_out = left_out;
        self.late = late;
        let has_errors = self.decl.log.has_errors_since(reported);
        // What is said elsewhere is of an instance of a generic FUNCTION, and is said once.
        let said = self.decl.log.diagnostics.split_off(reported);
        self.decl.log.diagnostics.extend(said.into_iter().filter(|it| !within(it.span, place)));
        (!has_errors).then_some(result)
    }

    /// What the candidates are called.
    fn word(&self, slots: &[usize]) -> &'static str {
        slots.first().map_or("FUNCTION", |it| self.decl.pous[*it].ast.kind.word())
    }

    fn none_fits(&self, all: &[usize], name: Span) -> Diagnostic {
        let (word, text) = (self.word(all), self.decl.log.sources.text(name));
        let error = Diagnostic::new(Code::E0317, name, format!("no {word} `{text}` takes these arguments"));
        self.with_candidates(error.label("none of the declarations fits"), all)
    }

    fn several_fit(&self, candidates: &[Candidate], name: Span) -> Diagnostic {
        let slots: Vec<_> = candidates.iter().map(|it| it.slot).collect();
        let (word, text) = (self.word(&slots), self.decl.log.sources.text(name));
        let message =
            format!("{} {word}s `{text}` take these arguments, and none fits better than the others", candidates.len());
        let error = Diagnostic::new(Code::E0317, name, message).label("which one is meant?");
        self.with_candidates(error, &slots).help("convert an argument to the intended type: `TO_INT(…)`, `INT#5`")
    }

    /// Names FUNCTIONs with the types that they take.
    fn with_candidates(&self, error: Diagnostic, slots: &[usize]) -> Diagnostic {
        let shown = |slot: &usize| format!("({})", self.decl.parameter_types(*slot).join(", "));
        let shown: Vec<_> = slots.iter().take(8).map(shown).collect();
        let shown: Vec<_> = shown.iter().map(String::as_str).collect();
        error.note(format!("the candidates are those of {}", all_of(&shown)))
    }
}

/// The candidate that is better than all others.
fn best(candidates: &[Candidate], given: &[Option<Type>]) -> Option<usize> {
    let beats = |it: &Candidate, other: &Candidate| std::ptr::eq(it, other) || is_better(it, other, given);
    candidates.iter().find(|it| candidates.iter().all(|other| beats(it, other))).map(|it| it.slot)
}

/// The one that leaves the fewest inputs to their initial values, where none other is closer.
fn fewest_defaults(candidates: &[Candidate], given: &[Option<Type>]) -> Option<usize> {
    let fewest = candidates.iter().map(|it| it.defaults).min()?;
    let mut found = candidates.iter().filter(|it| it.defaults == fewest);
    let one = found.next().filter(|_| found.next().is_none())?;
    candidates.iter().all(|other| !is_better(other, one, given)).then_some(one.slot)
}

fn is_better(a: &Candidate, b: &Candidate, given: &[Option<Type>]) -> bool {
    let mut is_closer_somewhere = false;
    for ((own, a), b) in given.iter().zip(&a.takes).zip(&b.takes) {
        let (Some(own), Some(a), Some(b)) = (own, a, b) else { continue };
        if is_closer(*own, *b, *a) {
            return false;
        }
        is_closer_somewhere |= is_closer(*own, *a, *b);
    }
    is_closer_somewhere
}

/// Whether what is of the type `own` is closer to `a` than to `b`.
fn is_closer(own: Type, a: Taker, b: Taker) -> bool {
    if a.is_generic != b.is_generic {
        return !a.is_generic;
    }
    if is_one(a.ty, b.ty) || is_one(b.ty, own) {
        return false;
    }
    match (own, a.ty, b.ty) {
        _ if is_one(a.ty, own) => true,
        (Type::Elementary(own), Type::Elementary(a_ty), Type::Elementary(b_ty)) => {
            let (a_is_alike, b_is_alike) = (is_alike(own, a_ty), is_alike(own, b_ty));
            // The least that a value becomes; the most that becomes a variable.
            let (narrow, wide) = if a.is_output { (b_ty, a_ty) } else { (a_ty, b_ty) };
            a_is_alike && !b_is_alike || a_is_alike == b_is_alike && widens(narrow, wide) && !widens(wide, narrow)
        }
        _ => false,
    }
}

/// Both are reals, bit strings, or neither: a LINT is closer to a DINT than an LREAL is.
fn is_alike(a: Elementary, b: Elementary) -> bool {
    (a.is_real(), a.is_bits()) == (b.is_real(), b.is_bits())
}

/// Whether two types are one but for a capacity.
fn is_one(a: Type, b: Type) -> bool {
    a == b || matches!((a, b), (Type::String(_), Type::String(_)))
}

fn within(inner: Span, outer: Span) -> bool {
    inner.file == outer.file && outer.start <= inner.start && inner.end <= outer.end
}

fn is_named(argument: &ast::Argument<'_>, name: ast::Name<'_>) -> bool {
    match &argument.kind {
        ArgumentKind::Positional(_) => false,
        ArgumentKind::Input(it, _) | ArgumentKind::Output { name: it, .. } => it.text.eq_ignore_ascii_case(name.text),
    }
}
