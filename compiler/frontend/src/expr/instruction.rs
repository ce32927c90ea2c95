//! Instructions of Logix on a structure, which ladder alone has: the condition of the rung is a parameter, and
//! what leaves the rung is the call's value.

use super::argument::{Parts, Role, as_written};
use super::binding::{Given, Parameter};
use super::checker::Checker;
use super::order::{Held, Written};
use crate::diagnostic::wording::{all_of, article};
use crate::names::{bit_instruction, instructions_in};
use crate::types::signature::pin_place;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{BlockId, Elementary, Expr, Op, Section, StatementKind, Type, Value};
use staunch_runtime::{Family, FaultKind};

/// A structure, and the position of the instruction in it.
type Instruction = (BlockId, usize);

impl<'s> Checker<'_, 's> {
    /// An instruction: its value is its rung-condition-out.
    pub(crate) fn instruction(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Expr> {
        match bit_instruction(name.text) {
            Some(it) => self.bit_instruction(it, name, arguments, span),
            None => self.structure_instruction(name, arguments, span),
        }
    }

    fn structure_instruction(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Expr> {
        let instructions = instructions_in(Family::Logix, name.text);
        let (id, instruction) = *instructions.first()?;
        let takes_rung = id.info().instructions[instruction].takes_rung;
        let tag = match takes_rung {
            true => tag_name(instructions, arguments).to_owned(),
            false => format!("{}_tag", id.info().instructions[instruction].name),
        };
        let mut parameters = vec![Parameter::of_library(&tag, Section::InOut)];
        if takes_rung {
            parameters.push(Parameter::of_library("RungIn", Section::Input));
        }
        let given = self.instruction_operands(name, &parameters, arguments)?;
        let Given::Value(operand) = given[0] else {
            let wants = structures(instructions);
            let help = match takes_rung {
                true => format!("write `{}({tag} := tag, RungIn := condition)`", name.text),
                false => format!("write `{}(tag)`", name.text),
            };
            self.report(Diagnostic::new(Code::E0303, name.span, format!("`{}` needs {wants}", name.text)).help(help));
            return None;
        };
        let mut parts = Parts::default();
        let (mut found, mut complete) = (None, true);
        for at in as_written(&given) {
            self.late_target_before(&mut parts, &given[at]);
            let made = match given[at] {
                Given::Value(_) if at == 0 => {
                    found = self.tag_part(&mut parts, operand, instructions, name, &tag);
                    found.map(drop)
                }
                Given::Value(rung) => self.value_part(&mut parts, rung, Type::BOOL, Role::Passed(0)),
                Given::Nothing | Given::Output { .. } => Some(()),
            };
            complete &= made.is_some();
        }
        if !complete || takes_rung && !self.has_rung(name, &given[1]) {
            return None;
        }
        let (id, instruction) = found?;
        let at = self.at(span);
        if takes_rung {
            self.keep_rung(&mut parts, span);
            self.check_timer(&parts, (id, instruction), span);
        }
        let call = |parts: &Parts| {
            let block = parts.written.iter().find_map(Written::place)?.clone();
            let inputs = parts.written.iter().filter_map(Written::value).cloned().collect();
            Some(StatementKind::CallBlock { block, instruction, inputs })
        };
        let parts = self.perform(parts, &call, span)?;
        match parts.written.iter().find_map(Written::value) {
            Some(rung) => Some(rung.clone()),
            None => {
                let tag = parts.written.iter().find_map(Written::place)?;
                Some(Expr::load(pin_place(tag.clone(), id, "EnableOut"), at))
            }
        }
    }

    /// What is given for the operands of an instruction.
    pub(super) fn instruction_operands<'a>(
        &mut self,
        name: ast::Name<'s>,
        parameters: &[Parameter<'_>],
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<Vec<Given<'a, 's>>> {
        let names: Vec<_> = parameters.iter().map(|it| it.name).collect();
        self.bind(name.text, parameters, arguments, |argument| {
            Diagnostic::new(Code::E0301, argument.span, format!("`{}` has no parameter `{}`", name.text, argument.text))
                .label("unknown parameter")
                .help(format!("its parameters are {}", all_of(&names)))
        })
    }

    /// Whether an instruction is given its rung.
    pub(super) fn has_rung(&mut self, name: ast::Name<'s>, given: &Given<'_, 's>) -> bool {
        let has = matches!(given, Given::Value(_));
        if !has {
            self.report(
                Diagnostic::new(Code::E0303, name.span, format!("`{}` needs its rung condition", name.text))
                    .help("write `RungIn := condition`; `RungIn := TRUE` for an unconditional rung"),
            );
        }
        has
    }

    /// Evaluates the next part, the structure that an instruction works on; its type says which one is meant.
    fn tag_part(
        &mut self,
        parts: &mut Parts,
        tag: &ast::Expr<'s>,
        instructions: &[Instruction],
        name: ast::Name<'s>,
        parameter: &str,
    ) -> Option<Instruction> {
        let found = self.after_parts(&mut parts.written, |this| this.variable_argument(tag, parameter))?;
        let meant = instructions.iter().copied().find(|(id, _)| found.place.ty == Type::Block(*id));
        let Some(instruction) = meant else {
            let (has, wants) = (self.type_name(found.place.ty), structures(instructions));
            let error =
                Diagnostic::new(Code::E0313, tag.span, format!("`{}` works on {wants}, found {has}", name.text))
                    .label(format!("expected {wants}"));
            let is_timer = matches!(found.place.ty, Type::Block(id) if id.info().pin("PT").is_some());
            self.report(match is_timer {
                true => error.help(format!(
                    "declare it as {wants}, or call it as the block that it is: `{}(IN := …, PT := …)`",
                    self.decl.log.sources.text(tag.span)
                )),
                false => self.help_on_other_tag(error, found.place.ty, name, tag.span),
            });
            return None;
        };
        self.used_instruction(&found.place, instruction.1);
        parts.push(Held::Place(found.place), Role::Instance, tag.span);
        Some(instruction)
    }

    /// What is called with a structure that another instruction works on.
    pub(super) fn help_on_other_tag(&self, error: Diagnostic, ty: Type, name: ast::Name<'s>, tag: Span) -> Diagnostic {
        let Type::Block(id) = ty else { return error };
        let (own, asked) = (id.info(), name.text.to_ascii_uppercase());
        let mut all = own.instructions.iter().filter(|it| !it.name.is_empty());
        let alike = all.clone().find(|it| it.name.starts_with(&asked) || asked.starts_with(it.name));
        let Some(meant) = alike.or_else(|| all.next()).filter(|_| own.family == Family::Logix && asked != "RES") else {
            return error;
        };
        let tag = self.decl.log.sources.text(tag);
        let call = if meant.takes_rung {
            format!("{}({tag}, RungIn := condition)", meant.name)
        } else {
            format!("{}({tag})", meant.name)
        };
        error.help(format!("{} is the operand of {}: write `{call};`", article(own.name), meant.name))
    }

    /// A timer whose PRE or ACC is below 0 is a fault where its rung lets it time.
    fn check_timer(&mut self, parts: &Parts, (id, instruction): Instruction, span: Span) -> Option<()> {
        let instruction = &id.info().instructions[instruction];
        if !(instruction.takes_rung && instruction.needs_context) {
            return None;
        }
        let at = self.at(span);
        let tag = parts.written.iter().find_map(Written::place)?;
        let rung = parts.written.iter().find_map(Written::value)?;
        let times_while = instruction.name != "TOF";
        let is_negative = |pin: &str| {
            let value = Expr::load(pin_place(tag.clone(), id, pin), at);
            let zero = Expr::constant(Elementary::Dint, Value::I32(0), at);
            Expr::apply(Op::Lt, Type::BOOL, vec![value, zero], at)
        };
        let negative = Expr::apply(Op::Or, Type::BOOL, vec![is_negative("PRE"), is_negative("ACC")], at);
        let condition = match rung.as_const() {
            Some(rung) if rung != Value::Bool(times_while) => return None,
            Some(_) => negative,
            None => {
                let rung = if times_while { rung.clone() } else { self.not(rung.clone(), span)? };
                Expr::apply(Op::And, Type::BOOL, vec![rung, negative], at)
            }
        };
        let fault = self.nested(|this| this.push(StatementKind::Fault(FaultKind::NegativeTimer), span));
        self.push(StatementKind::If { condition, then: fault, otherwise: Vec::new() }, span);
        Some(())
    }

    /// The rung condition is read again as the call's value.
    fn keep_rung(&mut self, parts: &mut Parts, span: Span) {
        let rung = parts.written.iter().position(|it| it.value().is_some_and(|it| it.as_const().is_none()));
        let Some(rung) = rung else { return };
        let (before, rest) = parts.written.split_at_mut(rung);
        let [written, ..] = rest else { return };
        let Held::Value(value) = &mut written.held else { return };
        let saved = self.temporary("rung", Type::BOOL);
        let at = value.at;
        let value = std::mem::replace(value, Expr::load(saved.clone(), at));
        // A tag that is written before it is evaluated before it.
        let fault_first = self.can_fault(&value);
        for part in before {
            self.hold(&mut part.held, &[], fault_first);
        }
        self.assign(saved, value, span);
    }
}

/// What the parameter for the structure is called: `Counter`, `Timer`, and for what resets several also `Structure`.
fn tag_name(instructions: &[Instruction], arguments: &[ast::Argument<'_>]) -> &'static str {
    let names = instructions.iter().map(|(id, _)| if id.info().name == "TIMER" { "Timer" } else { "Counter" });
    let mut names: Vec<_> = names.collect();
    if names.len() > 1 {
        names.push("Structure");
    }
    let is_given = |name: &&str| {
        let is_it = |it: &ast::Argument<'_>| matches!(&it.kind, ast::ArgumentKind::Input(it, _) if it.text.eq_ignore_ascii_case(name));
        arguments.iter().any(is_it)
    };
    names.iter().copied().find(is_given).unwrap_or(names[0])
}

/// What instructions with the same name work on: `a COUNTER or a TIMER`.
fn structures(instructions: &[Instruction]) -> String {
    let names: Vec<_> = instructions.iter().map(|(id, _)| article(id.info().name)).collect();
    names.join(" or ")
}
