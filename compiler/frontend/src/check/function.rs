//! Calls of a user's own functions.

use super::Checker;
use super::call::{Given, Parameter};
use crate::declare::{Entry, Formal, Signature};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Argument, Expr, ExprKind, Mode, PouId, Section, StatementKind, Type};
use std::rc::Rc;

impl<'s> Checker<'_, 's> {
    pub(super) fn user_function(
        &mut self,
        slot: usize,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Expr>> {
        let signature = self.decl.signature(slot)?;
        let owner = self.decl.pous[slot].ast.name;
        let formals = &signature.formals;
        let arguments = &self.accepted(&signature, arguments)?;
        let parameters: Vec<_> =
            formals.iter().map(|it| Parameter { name: it.name.text, section: it.section }).collect();
        let given =
            self.bind(owner.text, &parameters, arguments, |name| Self::unknown_formal(owner.text, formals, name))?;
        let mut passed: Vec<Argument> = Vec::new();
        let copies = self.copies_back.len();
        let mut outputs = Vec::new();
        let mut complete = true;
        for (at, (formal, given)) in formals.iter().zip(given).enumerate() {
            match self.function_argument(&signature, at, formal, owner, given, span, &mut passed, &mut outputs) {
                Some(argument) => passed.push(argument),
                None => complete = false,
            }
        }
        if !complete {
            return None;
        }
        let result = signature.result.as_ref().map(|(_, resolved)| self.temporary(owner.text, resolved.ty));
        self.push(
            StatementKind::Call {
                callee: PouId::next(slot),
                instance: None,
                arguments: passed,
                result: result.clone(),
            },
            span,
        );
        self.block.extend(self.copies_back.split_off(copies));
        for (source, target, negated) in outputs {
            self.connect_output(source, target, negated)?;
        }
        let at = self.at(span);
        Some(result.map(|place| Expr::load(place, at)))
    }

    #[expect(clippy::too_many_arguments, reason = "one step of a loop, named for its length")]
    fn function_argument<'a>(
        &mut self,
        signature: &Rc<Signature<'s>>,
        at: usize,
        formal: &Formal<'s>,
        owner: ast::Name<'s>,
        given: Given<'a, 's>,
        span: Span,
        passed: &mut [Argument],
        outputs: &mut Vec<(staunch_ir::Place, &'a ast::Expr<'s>, bool)>,
    ) -> Option<Argument> {
        let ty = formal.resolved.ty;
        match (signature.params[at].mode, formal.section) {
            (Mode::Value(_), _) => {
                let Given::Value(expr) = given else {
                    self.input_left_out(formal, owner, span)?;
                    return Some(Argument::Value(self.default_argument(formal, span)));
                };
                let mut done = expressions(passed);
                self.after(&mut done, |this| this.value(expr, ty)).map(Argument::Value)
            }
            (Mode::Reference, Section::Output) => {
                let place = self.temporary(formal.name.text, ty);
                if let Given::Output { target: Some(target), negated } = given {
                    outputs.push((place.clone(), target, negated));
                }
                Some(Argument::Reference(place))
            }
            (Mode::Reference, _) => {
                let mut place = None;
                let mut done = expressions(passed);
                self.after(&mut done, |this| {
                    place = this.in_out(formal, owner.text, given, span);
                    Some(())
                })?;
                place.map(Argument::Reference)
            }
        }
    }

    /// Reports an input without an initial value of its own that a call leaves out. CODESYS refuses it.
    fn input_left_out(&mut self, formal: &Formal<'s>, owner: ast::Name<'s>, span: Span) -> Option<()> {
        if self.has_initial(formal, owner) {
            return Some(());
        }
        let (name, refused) = (formal.name.text, self.decl.dialect(span).wants_all_inputs());
        let ty = self.type_name(formal.resolved.ty);
        let code = if refused { Code::E0303 } else { Code::W0304 };
        let message = format!("this call of `{}` leaves out the input `{name}`", owner.text);
        self.report(
            Diagnostic::new(code, span, message)
                .label(if refused {
                    "a FUNCTION keeps no value from its last call"
                } else {
                    "it is 0, FALSE or empty then"
                })
                .other(formal.name.span, "declared here, without an initial value")
                .help(format!("write `{name} := …` in the call, or declare a default: `{name} : {ty} := …;`")),
        );
        (!refused).then_some(())
    }

    /// Whether a formal's declaration, or its type's, gives it a value.
    fn has_initial(&self, formal: &Formal<'s>, owner: ast::Name<'s>) -> bool {
        let Some(Entry::Pou(slot)) = self.decl.names.get(&crate::names::Key(owner.text)) else { return true };
        let pou = self.decl.pous[*slot].ast;
        let declared = pou.blocks.iter().flat_map(|it| &it.vars);
        let given = declared
            .filter(|it| it.names.iter().any(|name| name.span == formal.name.span))
            .any(|it| it.initial.is_some());
        given || !matches!(formal.resolved.initial, staunch_ir::Const::Zero)
    }

    /// An omitted input has its declared initial value.
    fn default_argument(&mut self, formal: &Formal<'s>, span: Span) -> Expr {
        use staunch_ir::Const;
        let at = self.at(span);
        let ty = formal.resolved.ty;
        let kind = match (&formal.resolved.initial, self.decl.program.lane(ty), ty) {
            (Const::Scalar(value), _, _) => ExprKind::Const(*value),
            (Const::Zero, Some(lane), _) => ExprKind::Const(lane.zero()),
            (Const::Text(bytes), _, _) => ExprKind::Text(bytes.clone()),
            (Const::Zero, None, Type::String(_)) => ExprKind::Text(Vec::new()),
            (other, _, _) => ExprKind::Aggregate(other.clone()),
        };
        Expr::new(ty, kind, at)
    }
}

fn expressions(arguments: &mut [Argument]) -> Vec<&mut Expr> {
    let mut found = Vec::new();
    for argument in arguments {
        match argument {
            Argument::Value(expr) => found.push(expr),
            Argument::Reference(place) => {
                for projection in &mut place.projections {
                    if let staunch_ir::Projection::Index { index, .. } = projection {
                        found.push(index);
                    }
                }
            }
        }
    }
    found
}
