//! What a call calls.

use super::checker::Checker;
use super::unresolved::no_such_block;
use crate::inherit::is_super;
use crate::names::{Entry, Found, Meaning, Sense, is_instruction};
use crate::{Code, Diagnostic, ast, dialect};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::Type;
use staunch_runtime::Family;

/// What is before the parentheses.
#[derive(Clone, Copy)]
pub(crate) enum Callee<'s> {
    /// A user's FUNCTION, by its slot.
    Function(usize),
    /// An instruction of Logix, by its name.
    Instruction(ast::Name<'s>),
    /// A standard function.
    Standard(ast::Name<'s>),
    /// An instance of a block.
    Instance,
    /// A METHOD or ACTION of an instance, by its slot.
    Routine(usize),
}

impl<'s> Checker<'_, 's> {
    pub(crate) fn callee(&mut self, callee: &ast::Expr<'s>, arguments: &[ast::Argument<'s>]) -> Option<Callee<'s>> {
        match &callee.kind {
            Ast::Name(_) | Ast::Deref(_) if is_super(callee) => {
                self.super_callee(None, callee.span).map(Callee::Routine)
            }
            Ast::Member(base, name) if is_super(base) && self.is_instance_of_super(*name) => Some(Callee::Instance),
            Ast::Member(base, name) if is_super(base) => self.super_callee(Some(*name), base.span).map(Callee::Routine),
            Ast::Name(name) => self.named_callee(*name, arguments),
            Ast::Member(base, name) => match self.qualified_callee(callee) {
                Some(callee) => callee,
                None => match self.routine_of(base, *name) {
                    Some(slot) => Some(Callee::Routine(slot)),
                    None if self.static_type(base).is_some_and(|it| self.is_unknown_head(it, *name)) => None,
                    None => Some(Callee::Instance),
                },
            },
            Ast::Index(..) | Ast::Paren(_) | Ast::Deref(_) => Some(Callee::Instance),
            Ast::Error(_) => {
                self.operand(callee, None);
                None
            }
            Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Call(..)
            | Ast::Unary(..)
            | Ast::Binary(..)
            | Ast::Assign(..) => {
                self.error(Code::E0305, callee.span, "this cannot be called");
                None
            }
        }
    }

    pub(crate) fn report_family_call(&mut self, family: Family, name: ast::Name<'s>) {
        let owner = family.name();
        if dialect::block_in(family, name.text).is_some() {
            self.report(
                Diagnostic::new(Code::E0305, name.span, format!("`{owner}.{}` is a type, not a function", name.text))
                    .label("an instance of it can be called")
                    .help(format!("declare one: `VAR c : {owner}.{}; END_VAR`, and call `c(…)`", name.text)),
            );
        } else {
            // An instance's type could be misspelt, but a type is not called either.
            self.report(Diagnostic { fix: None, ..no_such_block(family, name) });
        }
    }

    pub(crate) fn named_callee(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> Option<Callee<'s>> {
        self.offer_values(name, Sense::Callee);
        let own = self.own_routine(name).filter(|_| !self.scope.is_own(name.text));
        if let Some(slot) = own.filter(|it| !self.is_function_in_method(*it, name)) {
            return Some(Callee::Routine(slot));
        }
        let Some(found) = self.meant_by_call(name) else { return Some(Callee::Instance) };
        if self.scope.is_refused(name.text) {
            return None;
        }
        self.decl.note_path(&[name], &found);
        match found {
            Found::One(Meaning::Declared(Entry::Global(_))) => Some(Callee::Instance),
            Found::One(Meaning::Declared(Entry::Pou(slot))) => self.called_pou(slot, name),
            Found::One(Meaning::Declared(Entry::Type(_)) | Meaning::Enumerator(_)) => {
                self.error(Code::E0305, name.span, format!("`{}` is a type; it cannot be called", name.text));
                None
            }
            Found::One(Meaning::Instruction) => Some(Callee::Instruction(name)),
            Found::One(Meaning::Function) => Some(Callee::Standard(name)),
            Found::Several(meanings) => {
                self.decl.report_ambiguous(name, &meanings);
                None
            }
            Found::One(Meaning::Block(_)) | Found::Nothing => {
                if !self.is_logix_call(name, arguments) {
                    self.report_unknown_function(name, arguments);
                }
                None
            }
        }
    }

    /// What a bare name before parentheses means, where that is not the variable with this name: one that cannot be called
    /// does not hide what is.
    fn meant_by_call(&self, name: ast::Name<'s>) -> Option<Found> {
        if self.is_callable_variable(name) {
            return None;
        }
        let found = self.decl.lookup(&[name], Sense::Function);
        let is_function = match &found {
            Found::One(Meaning::Declared(Entry::Pou(slot))) => self.decl.pous[*slot].ast.kind == ast::PouKind::Function,
            found => matches!(found, Found::One(Meaning::Function | Meaning::Instruction)),
        };
        if is_function {
            return Some(found);
        }
        self.scope.get(name.text).is_none().then(|| self.decl.lookup(&[name], Sense::Callee))
    }

    /// Whether a bare name is that of a variable that can be called.
    pub(super) fn is_callable_variable(&self, name: ast::Name<'s>) -> bool {
        let ty = match self.scope.get(name.text) {
            Some(variable) => Some(variable.place.ty),
            None => self.decl.type_of_global(name),
        };
        matches!(ty, Some(Type::Block(_) | Type::Struct(_)))
    }

    /// Whether a bare name before parentheses is that of a METHOD or ACTION around, which goes before all that is known
    /// here by its name. In that METHOD itself it is not: it would be recursion.
    pub(crate) fn calls_own_routine(&self, callee: &ast::Expr<'s>) -> bool {
        let Ast::Name(name) = &callee.kind else { return false };
        let own = self.own_routine(*name).filter(|_| !self.scope.is_own(name.text));
        own.is_some_and(|it| !self.is_itself(it))
    }

    /// Whether a METHOD's own name, in its body, means a FUNCTION: the METHOD itself would be recursion.
    fn is_function_in_method(&self, slot: usize, name: ast::Name<'s>) -> bool {
        self.is_itself(slot) && self.decl.dialect(name.span).calls_own_by_this() && self.is_function(name)
    }

    /// Whether it is the METHOD that is being checked, and the only one with its name.
    fn is_itself(&self, slot: usize) -> bool {
        self.slot == Some(slot) && self.decl.all_of_a_name(slot).len() == 1
    }

    fn is_function(&self, name: ast::Name<'s>) -> bool {
        match self.decl.lookup(&[name], Sense::Callee) {
            Found::One(Meaning::Function) => true,
            Found::One(Meaning::Declared(Entry::Pou(slot))) => self.decl.pous[slot].ast.kind == ast::PouKind::Function,
            Found::One(_) | Found::Several(_) | Found::Nothing => false,
        }
    }

    pub(super) fn called_pou(&mut self, slot: usize, name: ast::Name<'s>) -> Option<Callee<'s>> {
        match self.decl.pous[slot].ast.kind {
            ast::PouKind::Function => Some(Callee::Function(slot)),
            ast::PouKind::Program if self.is_callable_program(slot, name) => Some(Callee::Instance),
            kind @ (ast::PouKind::Program
            | ast::PouKind::FunctionBlock
            | ast::PouKind::Class
            | ast::PouKind::Interface
            | ast::PouKind::Test
            | ast::PouKind::Action
            | ast::PouKind::Method
            | ast::PouKind::Getter
            | ast::PouKind::Setter) => self.report_type_called(name, kind),
        }
    }

    /// An instruction of Logix under another dialect, recognised by the tag that it works on.
    pub(crate) fn is_logix_call(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> bool {
        if !is_instruction(Family::Logix, name.text) {
            return false;
        }
        let tag = arguments.first().map(|it| &it.kind);
        let Some(ArgumentKind::Positional(tag) | ArgumentKind::Input(_, tag)) = tag else { return false };
        let Ast::Name(tag) = &tag.kind else { return false };
        if self.scope.is_refused(tag.text) {
            return true;
        }
        let Some(variable) = self.scope.get(tag.text) else { return false };
        let logix = matches!(variable.place.ty, Type::Block(id) if id.info().family == Family::Logix);
        if logix {
            let text = name.text;
            self.report(
                Diagnostic::new(
                    Code::E0309,
                    name.span,
                    format!(
                        "`{}` is a tag of Logix, but a bare `{text}` is not an instruction of Logix here",
                        tag.text
                    ),
                )
                .label("expected an instruction of Logix")
                .help(format!("write `LOGIX.{text}(…)`, or start the file with `{{dialect 'logix'}}`"))
                .fix(name.span, format!("LOGIX.{text}")),
            );
        }
        logix
    }

    pub(crate) fn report_type_called(&mut self, name: ast::Name<'s>, kind: ast::PouKind) -> Option<Callee<'s>> {
        let mut error = Diagnostic::new(
            Code::E0305,
            name.span,
            match kind {
                ast::PouKind::Program => format!("the PROGRAM `{}` cannot be called", name.text),
                _ => format!("`{}` is a FUNCTION_BLOCK; only an instance of it can be called", name.text),
            },
        );
        let declared = format!("`VAR instance : {}; END_VAR`, and call `instance(…)`", name.text);
        if kind == ast::PouKind::FunctionBlock {
            error = error.help(format!("declare one: {declared}"));
        } else if kind == ast::PouKind::Program && !self.decl.dialect(name.span).calls_programs() {
            error = error
                .label("PROGRAMs can be called only in `codesys`")
                .note("it is accepted with `--dialect codesys`")
                .help(format!(
                    "write it as FUNCTION_BLOCK {} … END_FUNCTION_BLOCK, declare an instance of it: {declared}",
                    name.text
                ));
        }
        self.report(error);
        None
    }
}
