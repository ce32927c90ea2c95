//! Calls of instances: standard blocks, a user's FUNCTION_BLOCKs, and Logix instructions.

use super::Checker;
use super::call::{Given, Parameter};
use super::place::Found;
use crate::declare::{Formal, Target, pin_place};
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Argument, BlockId, Expr, FieldId, Place, PouId, Section, StatementKind, StructId, Type};
use staunch_runtime::{Direction, Family};

impl<'s> Checker<'_, 's> {
    pub(super) fn instance_call(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        let found = self.place(callee)?;
        if !super::migration::only_resets(arguments) {
            self.note_called(&found.place, callee.span);
        }
        match found.place.ty {
            Type::Block(id) => self.standard_block(found, id, arguments, callee.span, span),
            Type::Struct(id) if self.decl.is_instance(id) => self.user_block(found, id, arguments, callee.span, span),
            Type::Array(_) => {
                self.report_array_called(callee, arguments);
                None
            }
            other => {
                let ty = self.type_name(other);
                self.report(
                    Diagnostic::new(Code::E0305, callee.span, format!("a variable of type {ty} cannot be called"))
                        .label("this is not an instance of a block"),
                );
                None
            }
        }
    }

    /// A counter or timer that is called twice in a scan sees two edges, or none.
    fn note_called(&mut self, place: &Place, span: Span) {
        if let Some(first) = self.called.note(place, span) {
            let text = self.decl.sources.text(span).to_owned();
            let error = Diagnostic::new(Code::W0507, span, format!("`{text}` is called twice in a scan"))
                .label("called again here")
                .other(first, "first called here")
                .help("declare a second instance, or call it once and use its outputs");
            self.report(error);
        }
    }

    fn callable(&mut self, found: &Found<'s>, span: Span) -> Option<()> {
        if let super::place::Access::Constant(name) = found.access {
            self.error(Code::E0501, span, format!("`{}` is a CONSTANT and cannot be called", name.text));
            return None;
        }
        Some(())
    }

    fn standard_block(
        &mut self,
        found: Found<'s>,
        id: BlockId,
        arguments: &[ast::Argument<'s>],
        callee: Span,
        span: Span,
    ) -> Option<()> {
        self.callable(&found, callee)?;
        let info = id.info();
        if info.instructions.iter().any(|it| !it.name.is_empty()) {
            let names: Vec<_> = info.instructions.iter().map(|it| it.name).collect();
            self.report(
                Diagnostic::new(
                    Code::E0305,
                    callee,
                    format!("{} is not called itself", crate::diagnostic::wording::article(info.name)),
                )
                .label(format!("it is worked on by {}", crate::diagnostic::wording::list(&names)))
                .help(format!("write `{}({}, …)`", names[0], self.decl.sources.text(callee))),
            );
            return None;
        }
        let keeps_count = is_retentive_counter(id);
        let mut parameters: Vec<_> = info
            .pins
            .iter()
            .filter(|it| matches!(it.direction, Direction::Input | Direction::Output))
            .map(|it| Parameter { name: it.name, section: section(it.direction) })
            .collect();
        if keeps_count {
            let at = info.inputs().count();
            parameters.insert(at, Parameter { name: "RCV", section: Section::InOut });
        }
        let moved = self.arguments_by_own_names(id, arguments);
        let arguments = moved.as_deref().unwrap_or(arguments);
        let given = self.bind(info.name, &parameters, arguments, |name| super::unknown::unknown_pin(id, name))?;
        let mut place = found.place;
        let mut inputs: Vec<Expr> = Vec::new();
        let mut outputs = Vec::new();
        let mut rcv = None;
        let mut complete = true;
        for (parameter, given) in parameters.iter().zip(given) {
            match (parameter.section, given) {
                (Section::InOut, given) => rcv = Some(given),
                (Section::Output, Given::Output { target: Some(target), negated }) => {
                    outputs.push((parameter.name, target, negated));
                }
                (Section::Output, _) => {}
                (_, given) => match self.pin_input(&mut place, &mut inputs, id, parameter.name, given, span) {
                    Some(value) => inputs.push(value),
                    None => complete = false,
                },
            }
        }
        if !complete {
            return None;
        }
        let kept = match rcv {
            Some(given) => Some(self.retained_count(&place, given, callee)?),
            None => None,
        };
        self.push(StatementKind::CallBlock { block: place.clone(), instruction: 0, inputs }, span);
        if let Some(kept) = kept {
            let count = pin_place(place.clone(), id, "CV");
            let at = self.at(span);
            self.assign(kept, Expr::load(count, at), span);
        }
        for (name, target, negated) in outputs {
            let at = info.pins.iter().position(|it| it.name == name)?;
            let source = pin_place(place.clone(), id, info.pins[at].name);
            self.connect_output(source, target, negated)?;
        }
        Some(())
    }

    /// The value for one input pin: the argument, or what the pin holds from the last call.
    fn pin_input(
        &mut self,
        place: &mut Place,
        before: &mut [Expr],
        id: BlockId,
        name: &str,
        given: Given<'_, 's>,
        span: Span,
    ) -> Option<Expr> {
        let pins = id.info().pins;
        let at = pins.iter().position(|it| it.name == name)?;
        let ty = id.pin_type(FieldId::next(at))?;
        match given {
            Given::Value(expr) => {
                let mut done: Vec<&mut Expr> = Vec::new();
                for projection in &mut place.projections {
                    if let staunch_ir::Projection::Index { index, .. } = projection {
                        done.push(index);
                    }
                }
                done.extend(before.iter_mut());
                self.after(&mut done, |this| this.value(expr, ty))
            }
            Given::Nothing | Given::Output { .. } => {
                let at_location = self.at(span);
                Some(Expr::load(place.clone().field(FieldId::next(at), ty), at_location))
            }
        }
    }

    /// `OUT => target`, after the call.
    pub(super) fn connect_output(&mut self, source: Place, target: &ast::Expr<'s>, negated: bool) -> Option<()> {
        let found = self.place(target)?;
        if !self.writable(&found, target.span) {
            return None;
        }
        let at = self.at(target.span);
        let mut value = Expr::load(source, at).read();
        if negated {
            value = self.not(value, target.span)?;
        }
        let value = self.coerce(super::operand::Operand::Typed(value), found.place.ty, target.span)?;
        self.note_assigned(&found.place, target.span);
        self.assign(found.place, value, target.span);
        Some(())
    }

    fn user_block(
        &mut self,
        found: Found<'s>,
        id: StructId,
        arguments: &[ast::Argument<'s>],
        callee: Span,
        span: Span,
    ) -> Option<()> {
        self.callable(&found, callee)?;
        let slot = self.decl.slot_of_instance(id)?;
        let signature = self.decl.signature(slot)?;
        let owner = self.decl.pous[slot].ast.name.text;
        let formals = &signature.formals;
        let arguments = &self.accepted(&signature, arguments)?;
        let parameters: Vec<_> =
            formals.iter().map(|it| Parameter { name: it.name.text, section: it.section }).collect();
        let given = self.bind(owner, &parameters, arguments, |name| Self::unknown_formal(owner, formals, name))?;
        let mut place = found.place;
        let mut inputs: Vec<Expr> = Vec::new();
        let mut assigned = Vec::new();
        let mut references = Vec::new();
        let copies = self.copies_back.len();
        let mut outputs = Vec::new();
        let mut complete = true;
        for (formal, given) in formals.iter().zip(given) {
            match (formal.section, given) {
                (Section::Output, Given::Output { target: Some(target), negated }) => {
                    outputs.push((formal, target, negated))
                }
                (Section::Output, _) => {}
                (Section::InOut, given) => match self.in_out(formal, owner, given, callee) {
                    Some(place) => references.push(Argument::Reference(place)),
                    None => complete = false,
                },
                (_, Given::Value(expr)) => {
                    let ty = formal.resolved.ty;
                    let mut done: Vec<&mut Expr> = index_exprs(&mut place);
                    done.extend(inputs.iter_mut());
                    match self.after(&mut done, |this| this.value(expr, ty)) {
                        Some(value) => {
                            inputs.push(value);
                            assigned.push((formal, expr.span));
                        }
                        None => complete = false,
                    }
                }
                (_, Given::Nothing | Given::Output { .. }) => {}
            }
        }
        if !complete {
            return None;
        }
        self.assign_inputs(&place, inputs, &assigned);
        let instance = Some(place.clone());
        self.push(
            StatementKind::Call { callee: PouId::next(slot), instance, arguments: references, result: None },
            span,
        );
        self.block.extend(self.copies_back.split_off(copies));
        for (formal, target, negated) in outputs {
            let Target::Field(field) = formal.target else { continue };
            self.connect_output(place.clone().field(field, formal.resolved.ty), target, negated)?;
        }
        Some(())
    }

    /// The arguments but those for parameters whose declarations were refused; `None` where it is not
    /// known which those are.
    pub(super) fn accepted<'a>(
        &mut self,
        signature: &crate::declare::Signature<'s>,
        arguments: &'a [ast::Argument<'s>],
    ) -> Option<std::borrow::Cow<'a, [ast::Argument<'s>]>> {
        let positional = |it: &ast::Argument<'s>| matches!(it.kind, ast::ArgumentKind::Positional(_));
        if signature.scope.has_refused() && arguments.iter().any(positional) {
            self.check_arguments(arguments);
            return None;
        }
        let refused = |it: &ast::Argument<'s>| match &it.kind {
            ast::ArgumentKind::Positional(_) => false,
            ast::ArgumentKind::Input(name, _) | ast::ArgumentKind::Output { name, .. } => {
                signature.scope.is_refused(name.text)
            }
        };
        if arguments.iter().any(refused) {
            Some(arguments.iter().filter(|it| !refused(it)).cloned().collect::<Vec<_>>().into())
        } else {
            Some(arguments.into())
        }
    }

    /// All arguments are evaluated before the first is assigned: one may read the instance.
    fn assign_inputs(&mut self, place: &Place, inputs: Vec<Expr>, formals: &[(&Formal<'s>, Span)]) {
        let several = inputs.len() > 1;
        let mut ready = Vec::new();
        for (value, (_, span)) in inputs.into_iter().zip(formals) {
            if several && reads(&value, place) {
                let saved = self.temporary("argument", value.ty);
                let at = value.at;
                self.assign(saved.clone(), value, *span);
                ready.push(Expr::load(saved, at));
            } else {
                ready.push(value);
            }
        }
        for (value, (formal, span)) in ready.into_iter().zip(formals) {
            let Target::Field(field) = formal.target else { continue };
            self.assign(place.clone().field(field, formal.resolved.ty), value, *span);
        }
    }

    /// The variable given for a VAR_IN_OUT.
    pub(super) fn in_out(
        &mut self,
        formal: &Formal<'s>,
        owner: &str,
        given: Given<'_, 's>,
        span: Span,
    ) -> Option<Place> {
        let name = formal.name.text;
        let Given::Value(expr) = given else {
            self.report(
                Diagnostic::new(Code::E0303, span, format!("`{owner}` needs a variable for `{name}`"))
                    .label("a VAR_IN_OUT is given at every call")
                    .other(formal.name.span, "declared here")
                    .help(format!("write `{name} := variable`")),
            );
            return None;
        };
        let found = self.variable_argument(expr, name)?;
        if let (Type::String(_), Type::String(_)) = (found.place.ty, formal.resolved.ty)
            && found.place.ty != formal.resolved.ty
        {
            return Some(self.string_of_another_length(found.place, formal.resolved.ty, expr.span));
        }
        if found.place.ty != formal.resolved.ty {
            let wants = self.type_name(formal.resolved.ty);
            let has = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(
                    Code::E0201,
                    expr.span,
                    format!("`{name}` is {}, found {has}", crate::diagnostic::wording::article(&wants)),
                )
                .label("a VAR_IN_OUT takes a variable of exactly its own type")
                .other(formal.name.span, "declared here"),
            );
            return None;
        }
        self.note_passed(&found.place, expr.span, formal.name.span);
        Some(found.place)
    }

    /// A string of another capacity goes in by a copy, cut where it is too long, and comes back so.
    fn string_of_another_length(&mut self, place: Place, ty: Type, span: Span) -> Place {
        self.note_assigned(&place, span);
        let at = self.at(span);
        let copy = self.temporary("text", ty);
        let value = Expr::load(place.clone(), at);
        let value = self.convert(staunch_ir::Conversion::Value, ty, value);
        self.assign(copy.clone(), value, span);
        let back = Expr::load(copy.clone(), at);
        let back = self.convert(staunch_ir::Conversion::Value, place.ty, back);
        self.copies_back.push(staunch_ir::Statement::assign(place, back, at));
        copy
    }

    /// An argument that must be a variable which may be written.
    pub(super) fn variable_argument(&mut self, expr: &ast::Expr<'s>, name: &str) -> Option<Found<'s>> {
        use ast::ExprKind as Ast;
        let names_storage = matches!(
            expr.kind,
            Ast::Name(_) | Ast::Member(..) | Ast::Index(..) | Ast::Address(_) | Ast::Paren(_) | Ast::Deref(_)
        );
        if !names_storage {
            self.report(
                Diagnostic::new(Code::E0306, expr.span, format!("`{name}` needs a variable"))
                    .label("this is a value; the call writes to what is given here"),
            );
            return None;
        }
        let found = self.place(expr)?;
        self.may_be_given_away(&found, expr.span).then_some(found)
    }

    /// A Logix instruction on a structure: returns its rung-condition-out.
    pub(super) fn instruction(
        &mut self,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Expr> {
        let (id, instruction) = super::call::instruction_in(Family::Logix, name.text)?;
        let info = id.info();
        let takes_rung = info.instructions[instruction].takes_rung;
        let mut parameters = vec![Parameter { name: "Counter", section: Section::InOut }];
        if takes_rung {
            parameters.push(Parameter { name: "RungIn", section: Section::Input });
        } else {
            parameters[0].name = "CTUD_tag";
        }
        let names: Vec<_> = parameters.iter().map(|it| it.name).collect();
        let given = self.bind(name.text, &parameters, arguments, |argument| {
            Diagnostic::new(Code::E0301, argument.span, format!("`{}` has no parameter `{}`", name.text, argument.text))
                .label("unknown parameter")
                .help(format!("its parameters are {}", crate::diagnostic::wording::list(&names)))
        })?;
        let Given::Value(tag) = given[0] else {
            self.report(
                Diagnostic::new(
                    Code::E0303,
                    name.span,
                    format!("`{}` needs {}", name.text, crate::diagnostic::wording::article(info.name)),
                )
                .help(format!("write `{}(Counter := tag, RungIn := condition)`", name.text)),
            );
            return None;
        };
        let mut found = self.variable_argument(tag, names[0])?;
        if found.place.ty != Type::Block(id) {
            let has = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(
                    Code::E0313,
                    tag.span,
                    format!("`{}` works on {}, found {has}", name.text, crate::diagnostic::wording::article(info.name)),
                )
                .label(format!("expected {}", crate::diagnostic::wording::article(info.name))),
            );
            return None;
        }
        let rung = match given.get(1) {
            None => None,
            Some(Given::Value(rung)) => {
                let mut done = index_exprs(&mut found.place);
                Some(self.after(&mut done, |this| this.value(rung, Type::BOOL))?)
            }
            Some(Given::Nothing | Given::Output { .. }) => {
                self.report(
                    Diagnostic::new(Code::E0303, name.span, format!("`{}` needs its rung condition", name.text))
                        .help("write `RungIn := condition`; `RungIn := TRUE` for an unconditional rung"),
                );
                return None;
            }
        };
        self.used_instruction(&found.place, instruction);
        let at = self.at(span);
        let Some(rung) = rung else {
            let enabled = pin_place(found.place.clone(), id, "EnableOut");
            self.push(StatementKind::CallBlock { block: found.place, instruction, inputs: Vec::new() }, span);
            return Some(Expr::load(enabled, at));
        };
        // The rung condition is read again as the call's value.
        let condition = if rung.as_const().is_some() {
            rung
        } else {
            let saved = self.temporary("rung", Type::BOOL);
            self.assign(saved.clone(), rung, span);
            Expr::load(saved, at)
        };
        self.push(StatementKind::CallBlock { block: found.place, instruction, inputs: vec![condition.clone()] }, span);
        Some(condition)
    }

    /// The statements that feed the triggers of R_EDGE and F_EDGE inputs.
    pub(super) fn edge_inputs(&mut self, signature: &crate::declare::Signature<'s>, span: Span) {
        for edge in &signature.edges {
            let at = self.at(span);
            let inputs = vec![Expr::load(edge.input.clone(), at)];
            self.push(StatementKind::CallBlock { block: edge.trigger.clone(), instruction: 0, inputs }, span);
        }
    }
}

/// R_CTU and R_CTD keep their count in a variable of the user's.
pub(super) fn is_retentive_counter(id: BlockId) -> bool {
    let info = id.info();
    info.family == Family::Cscape && matches!(info.name, "R_CTU" | "R_CTD")
}

fn section(direction: Direction) -> Section {
    match direction {
        Direction::Input => Section::Input,
        Direction::Output => Section::Output,
        Direction::Memory | Direction::Member => Section::Internal,
    }
}

fn index_exprs(place: &mut Place) -> Vec<&mut Expr> {
    let mut found = Vec::new();
    for projection in &mut place.projections {
        if let staunch_ir::Projection::Index { index, .. } = projection {
            found.push(index.as_mut());
        }
    }
    found
}

/// Whether `expr` may read the instance at `place`.
fn reads(expr: &Expr, place: &Place) -> bool {
    use staunch_ir::ExprKind;
    match &expr.kind {
        ExprKind::Const(_) | ExprKind::Text(_) | ExprKind::Aggregate(_) => false,
        ExprKind::Load(it) => it.root == place.root && may_overlap(it, place),
        ExprKind::Apply(_, operands) | ExprKind::ApplyText(_, operands) => operands.iter().any(|it| reads(it, place)),
        ExprKind::Convert(_, inner) => reads(inner, place),
    }
}

fn may_overlap(a: &Place, b: &Place) -> bool {
    use staunch_ir::Projection;
    let differs =
        |pair: (&Projection, &Projection)| matches!(pair, (Projection::Field(x), Projection::Field(y)) if x != y);
    !a.projections.iter().zip(&b.projections).any(differs)
}
