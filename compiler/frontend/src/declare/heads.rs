//! What a class owes to what it IMPLEMENTS and overrides: the same parameters and results, by their types.

use crate::ast::{self, PouKind};
use crate::diagnostic::Missing;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::spelling::{Key, nearest};
use crate::start::INITIAL;
use crate::types::declarations::{Declarations, Slot};
use crate::types::signature::Signature;
use crate::{Code, Diagnostic, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{Section, Type};
use std::rc::Rc;

/// CODESYS's own INTERFACE, of those that can be asked what else an instance has. Here all can.
fn is_queryable(path: &[ast::Name<'_>]) -> bool {
    let wanted = ["__SYSTEM", "IQUERYINTERFACE"];
    path.len() == 2 && path.iter().zip(wanted).all(|(name, wanted)| name.text.eq_ignore_ascii_case(wanted))
}

impl<'s> Declarations<'s> {
    /// Checks all classes, when their signatures are known.
    pub(super) fn check_heads(&mut self) {
        for slot in 0..self.written_pous().len() {
            let pou = self.pous[slot].ast;
            if pou.home.is_none() {
                self.check_words(pou);
            }
            if pou.kind.has_routines() {
                pou.implements.iter().for_each(|name| self.check_is_interface(pou, *name));
            }
            if pou.kind == PouKind::Interface {
                self.check_interface(slot);
                self.check_joined_heads(slot);
            }
            if pou.kind == PouKind::Program {
                self.check_program_has_no_start(slot);
            }
            if pou.kind.is_block() {
                self.check_interfaces(slot);
                self.check_overrides(slot);
                self.check_started(slot);
            }
        }
    }

    /// Reports words before a name that contradict one another, and an INTERFACE that is named twice.
    fn check_words(&mut self, pou: &ast::Pou<'s>) {
        let ast::Modifiers { access, is_final, is_abstract, again, .. } = pou.modifiers;
        let name = pou.name.text;
        if let (Some(again), Some((first, span))) = (again, access) {
            let error = Diagnostic::new(Code::E0403, again, format!("`{name}` is already {}", first.word()));
            self.report(
                error.label("only one access specifier is allowed: delete this one").other(span, "the first one"),
            );
        }
        let private = access.filter(|it| it.0 == ast::Access::Private && pou.kind != PouKind::Interface);
        let other = is_final.map(|it| ("FINAL", it)).or(private.map(|it| ("PRIVATE", it.1)));
        if let (Some(span), Some((word, other))) = (is_abstract, other) {
            self.report(
                Diagnostic::new(Code::E0403, span, format!("`{name}` is ABSTRACT and {word}"))
                    .label("an ABSTRACT declaration must be overridden")
                    .other(other, "this forbids it"),
            );
        }
        for (at, again) in pou.implements.iter().enumerate() {
            if let Some(first) = pou.implements[..at].iter().find(|it| Key(it.text) == Key(again.text)) {
                let is_lint = self.dialect(again.span) == crate::dialect::Dialect::Codesys;
                let code = if is_lint { Code::W0405 } else { Code::E0403 };
                let error = Diagnostic::new(code, again.span, format!("`{}` is named twice", again.text));
                self.report(error.label("delete this one").other(first.span, "named here"));
            }
        }
    }

    /// Reports an INTERFACE that extends itself, and what has no place in one.
    fn check_interface(&mut self, slot: usize) {
        let pou = self.pous[slot].ast;
        let (mut asked, mut seen) = (self.own_interfaces(slot), FxHashSet::default());
        while let Some(at) = asked.pop() {
            if seen.insert(at) {
                asked.extend(self.own_interfaces(at));
            }
        }
        if seen.contains(&slot) {
            let error = Diagnostic::new(Code::E0402, pou.name.span, format!("`{}` extends itself", pou.name.text));
            self.report(error.label("its EXTENDS leads back to itself"));
        }
        let mut refuse = |span, what: &str| {
            self.report(
                Diagnostic::new(Code::E0403, span, what)
                    .label("an INTERFACE only declares METHODs and PROPERTYs: delete it"),
            );
        };
        if let Some(block) = pou.blocks.first() {
            refuse(block.span, "an INTERFACE has no variables");
        }
        for routine in &pou.routines {
            if let Some((access @ (ast::Access::Private | ast::Access::Protected), span)) = routine.modifiers.access {
                refuse(span, &format!("a METHOD of an INTERFACE is not {}", access.word()));
            }
        }
    }

    /// Reports an INTERFACE by which one name has several heads: no class could have it.
    fn check_joined_heads(&mut self, slot: usize) {
        if self.own_interfaces(slot).is_empty() {
            return;
        }
        let mut interfaces: Vec<_> = self.interfaces_of(slot).iter().copied().collect();
        interfaces.sort_unstable();
        let mut known: FxHashMap<Key<'s>, Vec<usize>> = FxHashMap::default();
        for interface in interfaces {
            let is_head = |it: &usize| self.pous[*it].owner == Some(interface);
            let heads: Vec<_> = (interface + 1..self.pous.len()).take_while(is_head).collect();
            for second in heads.iter().copied() {
                let others = known.entry(Key(self.pous[second].ast.name.text)).or_default().clone();
                let first = others.into_iter().find(|it| self.is_another_head(*it, second));
                if let Some(first) = first.filter(|it| !self.is_joined_in_a_base(slot, [*it, second])) {
                    self.report_joined_heads(slot, [first, second]);
                }
            }
            for head in heads {
                known.entry(Key(self.pous[head].ast.name.text)).or_default().push(head);
            }
        }
    }

    /// Whether two heads with the same name belong neither to one routine nor to two overloads.
    fn is_another_head(&self, first: usize, second: usize) -> bool {
        let is_overload = || self.has_overloads(second) && !self.have_same_parameters(first, second);
        self.pous[first].ast.kind == self.pous[second].ast.kind && !self.is_alike(first, second) && !is_overload()
    }

    fn report_joined_heads(&mut self, slot: usize, heads: [usize; 2]) {
        let (name, [first, second]) = (self.pous[slot].ast.name, heads.map(|it| self.title(it)));
        let message = format!("`{first}` and `{second}` differ, and `{}` has both", name.text);
        let [first, second] = heads.map(|it| self.pous[it].ast.name.span);
        self.report(
            Diagnostic::new(Code::E0403, name.span, message)
                .label("no class can implement both: their parameters and results must be the same")
                .other(first, "declared here")
                .other(second, "and declared differently here"),
        );
    }

    /// Whether an INTERFACE that this one extends has these two heads already.
    fn is_joined_in_a_base(&mut self, slot: usize, heads: [usize; 2]) -> bool {
        let bases = self.own_interfaces(slot);
        let owners = heads.map(|it| self.pous[it].owner);
        bases.into_iter().filter(|it| *it != slot).any(|base| {
            let all = self.interfaces_of(base);
            owners.iter().all(|it| it.is_some_and(|it| all.contains(&it)))
        })
    }

    /// Whether a routine is ABSTRACT where it is written: not the copy that an heir has of it.
    pub(crate) fn is_abstract_routine(&self, slot: usize) -> bool {
        let pou = &self.pous[slot];
        pou.owner.is_some() && pou.ast.home.is_none() && pou.ast.modifiers.is_abstract.is_some()
    }

    /// Reports statements in a METHOD of an INTERFACE, and in an ABSTRACT one.
    pub(crate) fn check_has_no_body(&mut self, body: &[ast::Statement<'s>], message: &str, label: &str) {
        let mut written = body.iter().filter(|it| !matches!(it.kind, ast::StatementKind::Empty));
        if let Some(first) = written.next() {
            self.report(Diagnostic::new(Code::E0403, first.span, message).label(label));
        }
    }

    /// Reports a name after IMPLEMENTS, or after the EXTENDS of an INTERFACE, that is no INTERFACE's.
    fn check_is_interface(&mut self, pou: &ast::Pou<'s>, name: ast::Name<'s>) {
        let Some(path) = pou.bases.iter().find(|it| it.last().is_some_and(|it| it.span == name.span)) else { return };
        if is_queryable(path) {
            return;
        }
        let error = |message| Diagnostic::new(Code::E0102, name.span, message).label("expected one");
        match self.lookup(path, Sense::Type) {
            Found::One(Meaning::Declared(Entry::Pou(at))) if self.pous[at].ast.kind == PouKind::Interface => {}
            Found::One(Meaning::Declared(entry)) => {
                let declared = self.span_of(entry);
                self.report(
                    error(format!("`{}` is not an INTERFACE", name.text))
                        .other(declared, "declared here")
                        .help("to inherit from a FUNCTION_BLOCK, name it after EXTENDS, before IMPLEMENTS"),
                );
            }
            Found::One(_) => self.report(error(format!("`{}` is not an INTERFACE", name.text))),
            Found::Nothing if self.names.root(name.text).is_none() && self.names.holders(name.text).is_empty() => {
                let names = self.table.interfaces.slots.iter().map(|it| self.pous[*it].ast.name.text);
                let near = nearest(name.text, names).map(str::to_owned);
                let error = Diagnostic::missing(Missing::Interface, name.text, name.span).label("expected one");
                self.report(match near {
                    Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
                    None => error,
                });
            }
            // That has been reported.
            Found::Nothing | Found::Several(_) => {}
        }
    }

    /// Reports what the INTERFACEs of a class want, and it does not have. An ABSTRACT one leaves it to its heirs.
    fn check_interfaces(&mut self, slot: usize) {
        let base = self.base_of(slot).filter(|it| self.pous[*it].ast.modifiers.is_abstract.is_none());
        let known = base.map(|it| self.interfaces_of(it)).unwrap_or_default();
        let mut interfaces: Vec<_> = self.interfaces_of(slot).difference(&known).copied().collect();
        interfaces.sort_unstable();
        for interface in interfaces {
            let is_head = |it: &usize| self.pous[*it].owner == Some(interface);
            let heads: Vec<_> = (interface + 1..self.pous.len()).take_while(is_head).collect();
            heads.into_iter().for_each(|head| self.check_head(slot, head));
        }
    }

    /// What a class writes for a routine of an INTERFACE.
    fn how_to_declare(&self, head: usize) -> String {
        let head = self.pous[head].ast;
        let text = |it: &ast::TypeSpec<'s>| self.log.sources.text(it.span);
        match (head.kind, &head.result) {
            (PouKind::Method, Some(ty)) => {
                format!("write `METHOD {} : {} … END_METHOD` in it", head.name.text, text(ty))
            }
            (PouKind::Method, None) => format!("write `METHOD {} … END_METHOD` in it", head.name.text),
            _ => "declare it here".to_owned(),
        }
    }

    fn check_head(&mut self, class: usize, head: usize) {
        let (name, wanted) = (self.pous[class].ast.name, self.pous[head].ast.name);
        let title = self.title(head);
        let routine = self.routine_for(class, head);
        if let Some((access, span)) = routine.and_then(|it| self.hidden_by(it)) {
            self.report(
                Diagnostic::new(Code::E0403, span, format!("`{title}` is {}", access.word()))
                    .label("the METHODs and PROPERTYs of an INTERFACE must be PUBLIC")
                    .other(wanted.span, "declared here"),
            );
            return;
        }
        let error = match routine {
            Some(routine) if self.is_alike(routine, head) => return,
            None if self.has_unknown_base(class) => return,
            Some(routine) => {
                let span = self.pous[routine].ast.name.span;
                Diagnostic::new(Code::E0403, span, format!("this does not match the declaration of `{title}`"))
                    .label("the parameters and the result must be those of the INTERFACE")
            }
            None if self.pous[class].ast.modifiers.is_abstract.is_some() || wanted.text.is_empty() => return,
            None => {
                let what = match self.pous[head].ast.kind {
                    PouKind::Getter => format!("GET of `{title}`"),
                    PouKind::Setter => format!("SET of `{title}`"),
                    PouKind::Method
                    | PouKind::Action
                    | PouKind::Program
                    | PouKind::FunctionBlock
                    | PouKind::Class
                    | PouKind::Interface
                    | PouKind::Function
                    | PouKind::Test => format!("`{title}`"),
                };
                Diagnostic::new(Code::E0403, name.span, format!("`{}` must implement {what}", name.text))
                    .label("it must have every METHOD and PROPERTY of the INTERFACEs that it IMPLEMENTS")
                    .help(format!("{}, or make `{}` ABSTRACT", self.how_to_declare(head), name.text))
            }
        };
        self.report(error.other(wanted.span, "declared here"));
    }

    /// The word by which a routine is not called from everywhere.
    fn hidden_by(&self, routine: usize) -> Option<(ast::Access, Span)> {
        let access = self.pous[routine].ast.modifiers.access;
        access.filter(|it| matches!(it.0, ast::Access::Private | ast::Access::Protected))
    }

    /// Reports routines of a class whose heads are others than those which they override.
    fn check_overrides(&mut self, slot: usize) {
        let Some(base) = self.base_of(slot) else { return };
        let is_own = |it: &usize| self.pous[*it].owner == Some(slot);
        let routines = (slot + 1..self.pous.len()).take_while(is_own);
        let own = routines.filter(|it| self.pous[*it].ast.home.is_none());
        // What the system calls takes more in an heir than in its base.
        let is_system = |it: &usize| INITIAL.iter().any(|name| Key(name) == Key(self.pous[*it].ast.name.text));
        let own: Vec<_> = own.filter(|it| !is_system(it)).collect();
        for new in own {
            // With other parameters it is one more of the name.
            let is_another = |it: &usize| self.has_overloads(*it) && !self.have_same_parameters(new, *it);
            // An ACTION has the parameters of its class, of which an heir may have more.
            let are_actions = |it: &usize| [new, *it].iter().all(|it| self.pous[*it].ast.kind == PouKind::Action);
            let is_other = |it: &usize| !self.is_alike(new, *it) && !is_another(it) && !are_actions(it);
            let old = self.routine_for(base, new).filter(is_other);
            let Some(old) = old else { continue };
            let (new, old) = (self.pous[new].ast.name, self.pous[old].ast.name);
            self.report(
                Diagnostic::new(
                    Code::E0403,
                    new.span,
                    format!("`{}` does not match the declaration that it overrides", new.text),
                )
                .label("the parameters and the result must be the same")
                .other(old.span, "overridden here"),
            );
        }
    }

    fn has_overloads(&self, slot: usize) -> bool {
        let pou = self.pous[slot].ast;
        pou.kind == PouKind::Method && self.dialect(pou.name.span).has_overloads()
    }

    /// Whether two routines have the same parameters and results. Of what was refused that is not known.
    fn is_alike(&self, a: usize, b: usize) -> bool {
        let known = |slot: usize| match &self.pous[slot].slot {
            Slot::Done(signature) => Some(Rc::clone(signature)).filter(|it| !it.scope.has_refused()),
            Slot::Open | Slot::Failed => None,
        };
        let (Some(a), Some(b)) = (known(a), known(b)) else { return true };
        let result = |it: &Signature<'_>| it.result.as_ref().map(|it| it.1.ty);
        let formals = |it: &Signature<'_>| -> Vec<(String, Section, bool, Type)> {
            let formal = |it: &crate::types::signature::Formal<'_>| {
                (it.name.text.to_ascii_uppercase(), it.section, it.constant, it.resolved.ty)
            };
            it.formals.iter().map(formal).collect()
        };
        result(&a) == result(&b) && formals(&a) == formals(&b)
    }
}
