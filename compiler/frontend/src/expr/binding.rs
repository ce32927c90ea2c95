//! Which argument goes to which parameter.

use super::checker::Checker;
use crate::index::recorder::Named;
use crate::names::Sense;
use crate::types::signature::Formal;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::{BlockId, Section};
use staunch_runtime::Pin;

/// What a parameter was given.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Given<'a, 's> {
    Nothing,
    /// By position, or `IN := x`.
    Value(&'a ast::Expr<'s>),
    /// `OUT => x`
    Output {
        target: Option<&'a ast::Expr<'s>>,
        negated: bool,
    },
}

/// The parameters of something that can be called, for matching arguments to them.
pub(crate) struct Parameter<'n> {
    pub name: &'n str,
    pub section: Section,
    /// What its name means where an argument has it.
    pub meaning: Named,
}

impl<'n> Parameter<'n> {
    /// Of a standard function, or of an instruction.
    pub fn of_library(name: &'n str, section: Section) -> Self {
        Self { name, section, meaning: Named::Parameter }
    }

    pub fn of_pin(block: BlockId, pin: &'n Pin, section: Section) -> Self {
        let at = block.info().pins.iter().position(|it| it.name == pin.name);
        Self { name: pin.name, section, meaning: at.map_or(Named::Parameter, |at| Named::Pin(block, at)) }
    }

    pub fn of_formal(formal: &Formal<'n>) -> Self {
        Self { name: formal.name.text, section: formal.section, meaning: Named::Definition(formal.name.span) }
    }
}

impl<'s> Checker<'_, 's> {
    /// Matches arguments to parameters. Positional ones take the next free parameter: in the order in which
    /// they are declared, or inputs and in-outs first, then outputs.
    pub(crate) fn bind<'a>(
        &mut self,
        owner: &str,
        parameters: &[Parameter<'_>],
        arguments: &'a [ast::Argument<'s>],
        unknown: impl Fn(ast::Name<'s>) -> Diagnostic,
    ) -> Option<Vec<Given<'a, 's>>> {
        let mut given = vec![Given::Nothing; parameters.len()];
        let outputs_last = |output: bool| {
            let is_output = move |it: &Section| (*it == Section::Output) == output;
            (0..parameters.len()).filter(move |at| is_output(&parameters[*at].section))
        };
        let as_declared = arguments.first().is_some_and(|it| self.decl.dialect(it.span).binds_outputs_in_order());
        let order: Vec<_> = if as_declared {
            (0..parameters.len()).collect()
        } else {
            outputs_last(false).chain(outputs_last(true)).collect()
        };
        let mut complete = true;
        let mut compared = false;
        let mut has_value_for_output = false;
        self.offer_parameters(parameters, arguments);
        for (number, argument) in arguments.iter().enumerate() {
            if let ArgumentKind::Positional(value) = &argument.kind
                && let Some((at, error)) = self.compared_parameter(parameters, value)
            {
                self.report(error);
                let Ast::Binary(sides, ..) = &value.kind else { continue };
                given[at] = Given::Value(&sides[1]);
                compared = true;
                continue;
            }
            let slot = match &argument.kind {
                ArgumentKind::Positional(value) => {
                    let free = order.iter().copied().find(|at| matches!(given[*at], Given::Nothing));
                    match free {
                        // The values after it are as many too many.
                        Some(at) if parameters[at].section == Section::Output && is_value(value) => {
                            complete = false;
                            if std::mem::replace(&mut has_value_for_output, true) {
                                continue;
                            }
                            Err(Box::new(value_for_output(owner, number + 1, parameters[at].name, value.span)))
                        }
                        Some(at) if parameters[at].section == Section::Output => {
                            Ok((at, Given::Output { target: Some(value), negated: false }))
                        }
                        Some(at) => Ok((at, Given::Value(value))),
                        None => Err(Box::new(self.too_many(owner, parameters, argument.span))),
                    }
                }
                ArgumentKind::Input(name, value) => self
                    .noted_parameter(parameters, *name, &unknown)
                    .and_then(|at| self.direction(owner, &parameters[at], false, *name).map(|()| at))
                    .map(|at| (at, Given::Value(value))),
                ArgumentKind::Output { name, negated, target } => self
                    .noted_parameter(parameters, *name, &unknown)
                    .and_then(|at| self.direction(owner, &parameters[at], true, *name).map(|()| at))
                    .map(|at| (at, Given::Output { target: target.as_ref(), negated: *negated })),
            };
            match slot {
                Ok((at, _)) if !matches!(given[at], Given::Nothing) => {
                    complete = false;
                    let name = parameters[at].name;
                    self.report(
                        Diagnostic::new(Code::E0304, argument.span, format!("`{name}` is given twice"))
                            .label("it already has a value"),
                    );
                }
                Ok((at, value)) => given[at] = value,
                Err(error) => {
                    complete = false;
                    self.report(without_given(*error, arguments));
                }
            }
        }
        if !complete && !compared {
            // Of `IN => 5`, the sign is the mistake, and not the value.
            let is_checked = |it: &&ast::Argument<'s>| !matches!(&it.kind, ArgumentKind::Output { target: Some(value), .. } if matches!(value.kind, Ast::Literal(_)));
            let checked: Vec<_> = arguments.iter().filter(is_checked).cloned().collect();
            self.check_arguments(&checked);
        }
        (complete && !compared).then_some(given)
    }

    /// `t(IN = x)`: a comparison with what is a parameter's name, and nothing else's.
    pub(crate) fn compared_parameter(
        &mut self,
        parameters: &[Parameter<'_>],
        value: &ast::Expr<'s>,
    ) -> Option<(usize, Diagnostic)> {
        let Ast::Binary(sides, ast::BinaryOp::Eq, sign) = &value.kind else { return None };
        let Ast::Name(name) = &sides[0].kind else { return None };
        let at = parameters.iter().position(|it| it.name.eq_ignore_ascii_case(name.text))?;
        if self.means_anything(&[*name], Sense::Value) {
            return None;
        }
        let arrow = if parameters[at].section == Section::Output { "=>" } else { ":=" };
        let error =
            Diagnostic::new(Code::E0312, *sign, format!("`=` compares; an argument is connected with `{arrow}`"))
                .label(format!("expected `{arrow}`"))
                .help(format!("write `{} {arrow} …`", name.text))
                .fix(*sign, arrow);
        Some((at, error))
    }

    /// Offers the parameters that a call does not give yet, where an argument begins.
    fn offer_parameters(&self, parameters: &[Parameter<'_>], arguments: &[ast::Argument<'s>]) {
        let name = |it: &ast::Argument<'s>| match &it.kind {
            ArgumentKind::Positional(value) => value.first_name(),
            ArgumentKind::Input(name, _) | ArgumentKind::Output { name, .. } => Some(*name),
        };
        let names: Vec<_> = arguments.iter().filter_map(name).collect();
        if !names.iter().any(|it| self.decl.log.is_asked(it.span)) {
            return;
        }
        for it in parameters.iter().filter(|it| !names.iter().any(|name| name.text.eq_ignore_ascii_case(it.name))) {
            self.decl.log.offer_expected(it.name, it.meaning.clone());
        }
    }

    fn noted_parameter(
        &self,
        parameters: &[Parameter<'_>],
        name: ast::Name<'s>,
        unknown: &impl Fn(ast::Name<'s>) -> Diagnostic,
    ) -> Result<usize, Box<Diagnostic>> {
        let at = self.parameter(parameters, name, unknown)?;
        self.decl.log.note(name.span, || parameters[at].meaning.clone());
        Ok(at)
    }

    pub(crate) fn parameter(
        &self,
        parameters: &[Parameter<'_>],
        name: ast::Name<'s>,
        unknown: &impl Fn(ast::Name<'s>) -> Diagnostic,
    ) -> Result<usize, Box<Diagnostic>> {
        let found = parameters.iter().position(|it| it.name.eq_ignore_ascii_case(name.text));
        found.ok_or_else(|| Box::new(unknown(name)))
    }

    /// `:=` is for inputs, `=>` for outputs.
    pub(crate) fn direction(
        &self,
        owner: &str,
        parameter: &Parameter<'_>,
        arrow: bool,
        name: ast::Name<'s>,
    ) -> Result<(), Box<Diagnostic>> {
        let is_output = parameter.section == Section::Output;
        if is_output == arrow {
            return Ok(());
        }
        let (what, right, wrong) = if is_output { ("an output", "=>", ":=") } else { ("an input", ":=", "=>") };
        let error = Diagnostic::new(Code::E0312, name.span, format!("`{}` is {what} of `{owner}`", parameter.name))
            .label(format!("connected with `{right}`, not with `{wrong}`"))
            .help(format!("write `{} {right} …`", name.text));
        Err(Box::new(error))
    }

    pub(crate) fn too_many(&self, owner: &str, parameters: &[Parameter<'_>], span: Span) -> Diagnostic {
        let names: Vec<_> = parameters.iter().map(|it| it.name).collect();
        let count = names.len();
        let error = Diagnostic::new(Code::E0302, span, format!("`{owner}` takes {}", plural(count)))
            .label("this is one too many");
        match names.as_slice() {
            [] => error,
            [one] => error.note(format!("it is {one}")),
            names => error.note(format!("they are {}", names.join(", "))),
        }
    }

    /// A call that names no parameter gives all inputs: who counts them must not wonder which one is
    /// missing. Those with a declared value (`is_optional`) may be left out after the others.
    pub(crate) fn require_all(
        &mut self,
        owner: &str,
        parameters: &[Parameter<'_>],
        given: &[Given<'_, 's>],
        arguments: &[ast::Argument<'s>],
        is_optional: impl Fn(&Self, usize) -> bool,
        span: Span,
    ) -> Option<()> {
        let positional = arguments.iter().all(|it| matches!(it.kind, ArgumentKind::Positional(_)));
        if arguments.is_empty() || !positional {
            return Some(());
        }
        let inputs = || (0..parameters.len()).filter(|at| parameters[*at].section != Section::Output);
        let is_missing = |this: &Self, at: usize| {
            parameters[at].section == Section::Input && matches!(given[at], Given::Nothing) && !is_optional(this, at)
        };
        let missing: Vec<_> = inputs().filter(|at| is_missing(self, *at)).map(|at| parameters[at].name).collect();
        if missing.is_empty() {
            return Some(());
        }
        let names: Vec<_> = inputs().map(|at| parameters[at].name).collect();
        let left_out =
            if let [one] = missing.as_slice() { format!("`{one}` is left out") } else { "too few".to_owned() };
        let message = format!("`{owner}` takes {}, this call gives {}", plural(names.len()), arguments.len());
        self.report(
            Diagnostic::new(Code::E0302, span, message)
                .label(left_out)
                .note(format!("they are {}", names.join(", ")))
                .help(if self.decl.dialect(span).wants_all_inputs() {
                    "give all of them".to_owned()
                } else {
                    format!("give all of them, or name those that you give: `{} := …`", names[0])
                }),
        );
        None
    }
}

/// `1 argument`, `2 arguments`.
pub(crate) fn plural(count: usize) -> String {
    if count == 1 { "1 argument".to_owned() } else { format!("{count} arguments") }
}

/// Nothing that an output could be connected with.
fn is_value(expr: &ast::Expr<'_>) -> bool {
    match &expr.kind {
        Ast::Literal(_) | Ast::Unary(..) | Ast::Binary(..) | Ast::Assign(..) => true,
        Ast::Paren(inner) => is_value(inner),
        Ast::Name(_)
        | Ast::Member(..)
        | Ast::Index(..)
        | Ast::Address(_)
        | Ast::Part(..)
        | Ast::Deref(_)
        | Ast::Call(..)
        | Ast::Error(_) => false,
    }
}

fn value_for_output(owner: &str, number: usize, name: &str, span: Span) -> Diagnostic {
    let message = format!("argument {number} of `{owner}` is its output `{name}`, which needs a variable");
    Diagnostic::new(Code::E0306, span, message)
        .label("this is a value")
        .help(format!("outputs are connected as `{name} => variable`, or read after the call"))
}

/// A fix that renames a parameter to one that the call gives too would bring the next error.
fn without_given(error: Diagnostic, arguments: &[ast::Argument<'_>]) -> Diagnostic {
    let named = |argument: &ast::Argument<'_>, name: &str| match &argument.kind {
        ArgumentKind::Positional(_) => false,
        ArgumentKind::Input(it, _) | ArgumentKind::Output { name: it, .. } => it.text.eq_ignore_ascii_case(name),
    };
    let is_given = error.fix.as_ref().is_some_and(|fix| arguments.iter().any(|it| named(it, &fix.replacement)));
    if is_given { Diagnostic { fix: None, ..error } } else { error }
}
