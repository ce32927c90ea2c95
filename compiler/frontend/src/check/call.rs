//! Calls: what is called, and which argument goes to which parameter.

use super::Checker;
use super::enable::Enable;
use super::operand::Operand;
use crate::declare::{Entry, Formal};
use crate::diagnostic::wording::list;
use crate::names::{Key, nearest};
use crate::{Code, Diagnostic, Span, ast, dialect};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::{BlockId, Section, Type};
use staunch_runtime::Family;

/// What stands before the parentheses.
#[derive(Clone, Copy)]
pub(super) enum Callee<'s> {
    /// A user's FUNCTION, by its slot.
    Function(usize),
    /// An instruction of a structure that instructions share (Logix), by its name.
    Instruction(ast::Name<'s>),
    /// A standard function.
    Standard(ast::Name<'s>),
    /// An instance of a block.
    Instance,
}

/// What a parameter was given.
#[derive(Clone, Copy, Debug)]
pub(super) enum Given<'a, 's> {
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
pub(super) struct Parameter<'n> {
    pub name: &'n str,
    pub section: Section,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn call_value(
        &mut self,
        expr: &ast::Expr<'s>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
    ) -> Option<Operand> {
        let what = self.checked_callee(callee, arguments)?;
        if let Some((enable, rest)) = self.enable(&what, callee, arguments) {
            let value = self.call_if_enabled(what, enable, callee, &rest, expected, expr.span)?;
            if value.is_none() {
                self.report_no_value(callee, expr.span);
            }
            return value.map(Operand::Typed);
        }
        match what {
            Callee::Standard(name) => self.standard_function(name, arguments, expected, expr.span),
            other => {
                if self.signature.is_none() {
                    self.report(super::not_constant(expr.span));
                    return None;
                }
                let value = self.call(other, callee, arguments, expr.span)?;
                if value.is_none() {
                    self.report_no_value(callee, expr.span);
                }
                value.map(Operand::Typed)
            }
        }
    }

    pub(super) fn call_statement(
        &mut self,
        expr: &ast::Expr<'s>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
    ) {
        let what = self.checked_callee(callee, arguments);
        if let Some(what) = &what
            && !matches!(what, Callee::Standard(_))
            && let Some((enable, rest)) = self.enable(what, callee, arguments)
        {
            self.call_if_enabled(*what, enable, callee, &rest, None, expr.span);
            return;
        }
        match what {
            Some(Callee::Standard(name)) => {
                let value = self.standard_function(name, arguments, None, expr.span);
                if value.is_none() {
                    return;
                }
                self.report(
                    Diagnostic::new(Code::E0508, expr.span, format!("the result of `{}` is not used", name.text))
                        .label("this statement has no effect")
                        .help(format!("assign it: `result := {}(…);`", name.text)),
                );
            }
            Some(other) => {
                self.call(other, callee, arguments, expr.span);
            }
            None => {}
        }
    }

    /// A call with EN or ENO.
    fn call_if_enabled(
        &mut self,
        what: Callee<'s>,
        enable: Enable<'_, 's>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        expected: Option<Type>,
        span: Span,
    ) -> Option<Option<staunch_ir::Expr>> {
        if self.signature.is_none() {
            self.report(super::not_constant(span));
            return None;
        }
        let initial = match what {
            Callee::Function(slot) => self.initial_result(slot, span),
            Callee::Standard(_) | Callee::Instruction(_) | Callee::Instance => None,
        };
        self.enabled_call(enable, initial, span, |this| match what {
            Callee::Standard(name) => {
                let value = this.standard_function(name, arguments, expected, span)?;
                this.materialise(value.cut(), expected, span).map(Some)
            }
            Callee::Function(_) | Callee::Instruction(_) | Callee::Instance => this.call(what, callee, arguments, span),
        })
    }

    fn call(
        &mut self,
        what: Callee<'s>,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<staunch_ir::Expr>> {
        match what {
            Callee::Function(slot) => self.user_function(slot, arguments, span),
            Callee::Instruction(name) => self.instruction(name, arguments, span).map(Some),
            Callee::Instance => self.instance_call(callee, arguments, span).map(|()| None),
            Callee::Standard(_) => None,
        }
    }

    fn report_no_value(&mut self, callee: &ast::Expr<'s>, span: Span) {
        if let Ast::Name(name) = &callee.kind
            && self.lacks_result_type(*name)
        {
            return;
        }
        let text = self.decl.sources.text(callee.span).to_owned();
        self.report(
            Diagnostic::new(Code::E0311, span, format!("a call of `{text}` has no value"))
                .label("this cannot stand in an expression")
                .help("call it in a statement of its own, then read its outputs"),
        );
    }

    /// What is called. Where that is not known, the arguments may hold mistakes of their own.
    fn checked_callee(&mut self, callee: &ast::Expr<'s>, arguments: &[ast::Argument<'s>]) -> Option<Callee<'s>> {
        let found = self.callee(callee, arguments);
        if found.is_none() {
            self.check_arguments(arguments);
        }
        found
    }

    /// Reports what is wrong inside the arguments of a call that is wrong itself.
    pub(super) fn check_arguments(&mut self, arguments: &[ast::Argument<'s>]) {
        for argument in arguments {
            match &argument.kind {
                ArgumentKind::Positional(value) | ArgumentKind::Input(_, value) => drop(self.operand(value, None)),
                ArgumentKind::Output { target, .. } => {
                    if let Some(target) = target {
                        self.place(target);
                    }
                }
            }
        }
    }

    fn callee(&mut self, callee: &ast::Expr<'s>, arguments: &[ast::Argument<'s>]) -> Option<Callee<'s>> {
        match &callee.kind {
            Ast::Name(name) => self.named_callee(*name, arguments),
            Ast::Member(base, name) => {
                if let Ast::Name(family) = &base.kind
                    && self.scope.get(family.text).is_none()
                    && let Some(it) = Family::named(family.text)
                {
                    if is_instruction(it, name.text) {
                        return Some(Callee::Instruction(*name));
                    }
                    self.report_family_call(it, *name);
                    return None;
                }
                Some(Callee::Instance)
            }
            Ast::Index(..) | Ast::Paren(_) => Some(Callee::Instance),
            Ast::Error(_) => {
                self.operand(callee, None);
                None
            }
            Ast::Deref(_)
            | Ast::Literal(_)
            | Ast::Address(_)
            | Ast::Part(..)
            | Ast::Call(..)
            | Ast::Unary(..)
            | Ast::Binary(..) => {
                self.error(Code::E0305, callee.span, "this cannot be called");
                None
            }
        }
    }

    fn report_family_call(&mut self, family: Family, name: ast::Name<'s>) {
        let owner = family.name();
        if dialect::block_in(family, name.text).is_some() {
            self.report(
                Diagnostic::new(Code::E0305, name.span, format!("`{owner}.{}` is a type, not a function", name.text))
                    .label("an instance of it can be called")
                    .help(format!("declare one: `VAR c : {owner}.{}; END_VAR`, and call `c(…)`", name.text)),
            );
        } else {
            // An instance's type could be misspelt, but a type is not called either.
            self.report(Diagnostic { fix: None, ..super::no_such_block(family, name) });
        }
    }

    fn named_callee(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> Option<Callee<'s>> {
        if let Some(variable) = self.scope.get(name.text) {
            // A variable that cannot be called does not hide a function of its name.
            let callable = matches!(variable.place.ty, Type::Block(_) | Type::Struct(_));
            let function = super::standard::exists(name.text)
                || matches!(self.decl.names.get(&Key(name.text)), Some(Entry::Pou(_)));
            if callable || !function {
                return Some(Callee::Instance);
            }
        }
        if self.scope.is_refused(name.text) {
            return None;
        }
        match self.decl.names.get(&Key(name.text)).copied() {
            Some(Entry::Global(_)) => return Some(Callee::Instance),
            Some(Entry::Pou(slot)) => {
                let pou = self.decl.pous[slot].ast;
                if pou.kind == ast::PouKind::Function {
                    return Some(Callee::Function(slot));
                }
                if self.is_callable_program(slot, name) {
                    return Some(Callee::Instance);
                }
                return self.report_type_called(name, pou.kind);
            }
            Some(Entry::Type(_)) => {
                self.error(Code::E0305, name.span, format!("`{}` is a type; it cannot be called", name.text));
                return None;
            }
            None => {}
        }
        let own = self.decl.dialect(name.span);
        if is_instruction(own.family(), name.text) {
            return Some(Callee::Instruction(name));
        }
        if super::standard::exists(name.text) {
            return Some(Callee::Standard(name));
        }
        if !self.is_logix_call(name, arguments) {
            self.report_unknown_function(name);
        }
        None
    }

    /// An instruction of Logix under another dialect, recognised by the tag that it works on.
    fn is_logix_call(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> bool {
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
                    format!("`{}` is a tag of Logix, a bare `{text}` here no instruction of it", tag.text),
                )
                .label("expected an instruction of Logix")
                .help(format!("write `LOGIX.{text}(…)`, or start the file with `{{dialect 'logix'}}`"))
                .fix(name.span, format!("LOGIX.{text}")),
            );
        }
        logix
    }

    fn report_type_called(&mut self, name: ast::Name<'s>, kind: ast::PouKind) -> Option<Callee<'s>> {
        let mut error = Diagnostic::new(
            Code::E0305,
            name.span,
            match kind {
                ast::PouKind::Program => format!("the PROGRAM `{}` cannot be called", name.text),
                _ => format!("`{}` is a FUNCTION_BLOCK; an instance of it is called", name.text),
            },
        );
        if kind == ast::PouKind::FunctionBlock {
            error = error.help(format!("declare one: `VAR instance : {}; END_VAR`, and call `instance(…)`", name.text));
        }
        self.report(error);
        None
    }

    fn report_unknown_function(&mut self, name: ast::Name<'s>) {
        if self.decl.bare_block(name.text, name.span).is_some() {
            self.report_type_called(name, ast::PouKind::FunctionBlock);
            return;
        }
        if Family::ALL.into_iter().any(|it| is_instruction(it, name.text)) {
            if let Some(error) = super::block_of_another_dialect(self.decl.dialect(name.span), name) {
                self.report(error);
                return;
            }
            self.report(
                Diagnostic::new(Code::E0309, name.span, format!("`{}` is an instruction of LOGIX", name.text))
                    .help(format!("write `LOGIX.{}(…)`, or compile with `--dialect logix`", name.text)),
            );
            return;
        }
        if not_yet(name.text) {
            self.decl.not_supported(name.span, &format!("the function {}", name.text.to_ascii_uppercase()));
            return;
        }
        let own = self.decl.pous.iter().filter(|it| it.ast.kind == ast::PouKind::Function).map(|it| it.ast.name.text);
        let instances =
            self.scope.variables.iter().filter(|it| matches!(it.place.ty, Type::Block(_) | Type::Struct(_)));
        let standard = super::standard::names().map(|it| -> &str { it });
        let candidates = own.chain(instances.map(|it| it.name.text)).chain(standard);
        let near = nearest(name.text, candidates).map(str::to_owned);
        let mut error =
            Diagnostic::new(Code::E0307, name.span, format!("there is no function or instance `{}`", name.text))
                .label("unknown name");
        if staunch_ir::Elementary::named(name.text).is_some() {
            error = error.help(format!("a value is converted with `TO_{}(…)`", name.text.to_ascii_uppercase()));
        } else if name.text.eq_ignore_ascii_case("POW") {
            error = error.help("write `EXPT(base, exponent)`, or `base ** exponent`");
        } else if let Some(near) = near {
            error = error.help(format!("did you mean `{near}`?")).fix(name.span, near);
        }
        self.report(error);
    }

    /// Matches arguments to parameters. Positional ones take the next free parameter: inputs and
    /// in-outs first, then outputs.
    pub(super) fn bind<'a>(
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
        let order: Vec<_> = outputs_last(false).chain(outputs_last(true)).collect();
        let mut complete = true;
        let mut compared = false;
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
                        Some(at) if parameters[at].section == Section::Output && is_value(value) => {
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
                    .parameter(parameters, *name, &unknown)
                    .and_then(|at| self.direction(owner, &parameters[at], false, *name).map(|()| at))
                    .map(|at| (at, Given::Value(value))),
                ArgumentKind::Output { name, negated, target } => self
                    .parameter(parameters, *name, &unknown)
                    .and_then(|at| self.direction(owner, &parameters[at], true, *name).map(|()| at))
                    .map(|at| (at, Given::Output { target: target.as_ref(), negated: *negated })),
            };
            match slot {
                Ok((at, _)) if !matches!(given[at], Given::Nothing) => {
                    complete = false;
                    let name = parameters[at].name;
                    self.report(
                        Diagnostic::new(Code::E0304, argument.span, format!("`{name}` is given twice"))
                            .label("it has a value already"),
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
            self.check_arguments(arguments);
        }
        (complete && !compared).then_some(given)
    }

    /// `t(IN = x)`: a comparison with what is a parameter's name, and nothing else's.
    fn compared_parameter(
        &mut self,
        parameters: &[Parameter<'_>],
        value: &ast::Expr<'s>,
    ) -> Option<(usize, Diagnostic)> {
        let Ast::Binary(sides, ast::BinaryOp::Eq, sign) = &value.kind else { return None };
        let Ast::Name(name) = &sides[0].kind else { return None };
        let at = parameters.iter().position(|it| it.name.eq_ignore_ascii_case(name.text))?;
        if self.scope.get(name.text).is_some() || self.decl.names.contains_key(&Key(name.text)) {
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

    fn parameter(
        &self,
        parameters: &[Parameter<'_>],
        name: ast::Name<'s>,
        unknown: &impl Fn(ast::Name<'s>) -> Diagnostic,
    ) -> Result<usize, Box<Diagnostic>> {
        let found = parameters.iter().position(|it| it.name.eq_ignore_ascii_case(name.text));
        found.ok_or_else(|| Box::new(unknown(name)))
    }

    /// `:=` is for inputs, `=>` for outputs.
    fn direction(
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

    fn too_many(&self, owner: &str, parameters: &[Parameter<'_>], span: Span) -> Diagnostic {
        let names: Vec<_> = parameters.iter().map(|it| it.name).collect();
        let count = names.len();
        let error =
            Diagnostic::new(Code::E0302, span, format!("`{owner}` takes {}", plural(count))).label("one too many");
        match names.as_slice() {
            [] => error,
            [one] => error.note(format!("it is {one}")),
            names => error.note(format!("they are {}", names.join(", "))),
        }
    }

    /// A call that names no parameter gives all inputs: who counts them must not wonder which one is
    /// missing. Those with a declared value, which `is_optional` tells, may be left out behind the others.
    pub(super) fn require_all(
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

    pub(super) fn unknown_formal(owner: &str, formals: &[Formal<'s>], name: ast::Name<'s>) -> Diagnostic {
        let names: Vec<_> = formals.iter().map(|it| it.name.text).collect();
        let error = Diagnostic::new(Code::E0301, name.span, format!("`{owner}` has no parameter `{}`", name.text))
            .label("unknown parameter");
        match nearest(name.text, names.iter().copied()) {
            Some(near) => error.help(format!("did you mean `{near}`?")).fix(name.span, near),
            None if names.is_empty() => error,
            None if names.len() == 1 => error.help(format!("its parameter is {}", list(&names))),
            None => error.help(format!("its parameters are {}", list(&names))),
        }
    }
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

/// Functions of the standard's tables, and of CODESYS, that are known to be missing.
fn not_yet(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    let conversion = |part: &str| {
        let texts = ["STRING", "WSTRING", "DATE", "TOD", "DT", "LDATE", "LTOD", "LDT", "CHAR", "WCHAR", "BCD"];
        texts.iter().any(|it| part == *it || part.starts_with("BCD") || part.ends_with("BCD"))
    };
    let (from, to) = name.split_once("_TO_").or_else(|| Some(("", name.strip_prefix("TO_")?))).unwrap_or(("", ""));
    let others = [
        "ROUND",
        "CEIL",
        "FLOOR",
        "SIZEOF",
        "ASSERT",
        "LOWER_BOUND",
        "UPPER_BOUND",
        "ADR",
        "TIME",
        "CONCAT_DATE_TOD",
        "CONCAT_TIME",
        "UPPER_CASE",
    ];
    conversion(from) || conversion(to) || others.contains(&name.as_str())
}

/// Whether `name` is an instruction of a structure in `family`.
fn is_instruction(family: Family, name: &str) -> bool {
    instruction_in(family, name).is_some()
}

/// The first structure with the instruction `name`, and the instruction's position.
pub(super) fn instruction_in(family: Family, name: &str) -> Option<(BlockId, usize)> {
    let blocks = staunch_runtime::BLOCKS.iter().enumerate().filter(|(_, it)| it.family == family);
    blocks.into_iter().find_map(|(at, block)| {
        let found = block.instructions.iter().position(|it| !it.name.is_empty() && it.name.eq_ignore_ascii_case(name));
        found.map(|instruction| (BlockId::next(at), instruction))
    })
}

/// `1 argument`, `2 arguments`.
pub(super) fn plural(count: usize) -> String {
    if count == 1 { "1 argument".to_owned() } else { format!("{count} arguments") }
}

/// Nothing that an output could be connected with.
fn is_value(expr: &ast::Expr<'_>) -> bool {
    match &expr.kind {
        Ast::Literal(_) | Ast::Unary(..) | Ast::Binary(..) => true,
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
