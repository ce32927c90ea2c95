//! The parts of a call: its instance, arguments and targets. They are evaluated in the order in which
//! they are written, each once, before the first input is stored or passed; what the callee does
//! changes none of them.

use super::binding::Given;
use super::checker::Checker;
use super::operand::Operand;
use super::order::{Held, Turn, Written};
use super::place::Found;
use crate::diagnostic::wording::article;
use crate::types::signature::{Formal, Target};
use crate::types::table::Resolved;
use crate::types::window::Window;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Argument, Block, Conversion, Expr, ExprKind, FieldId, Location, Place, Projection, RefKind, Root, Section,
    Statement, StatementKind, Type,
};
use std::rc::Rc;

/// What a call does with one of its parts.
#[derive(Clone, Debug)]
pub(crate) enum Role {
    Instance,
    /// It is stored in this field of the instance before the call.
    Stored(FieldId, Type),
    /// The statement of the call evaluates it, for this parameter.
    Passed(usize),
    /// A string of another capacity than the VAR_IN_OUT's, which is cut where it is too long, or what shares its
    /// bits with others: it goes in by a copy, and comes back so.
    Copied(Place, Option<Window>),
    /// It, or bits of it, is assigned after the call.
    Target(Source, bool, Option<Window>),
    /// It keeps a standard block's count, which is assigned to it after the call.
    Count(FieldId, Type),
}

/// What is assigned to a target.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A field of the instance.
    Field(FieldId, Type),
    /// What a FUNCTION was given for its output.
    Variable(Place),
}

/// What until a call's outputs is made of the copies of in-outs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Copies {
    /// One statement each, which reads and writes what the copy does.
    Drafted,
    Made,
}

#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub role: Role,
    pub span: Span,
}

/// The parts of a call, as written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    pub written: Vec<Written>,
    pub parts: Vec<Part>,
    /// How many statements there are before those that evaluate the parts.
    pub before: usize,
}

impl Parts {
    pub fn push(&mut self, held: Held, role: Role, span: Span) {
        self.written.push(Written::new(held));
        self.parts.push(Part { role, span });
    }

    /// The instance, which is first.
    pub fn instance(&self) -> Option<&Place> {
        self.written.first().and_then(Written::place)
    }

    /// What is passed to the callee for a part.
    pub fn argument(&self, at: usize) -> Argument {
        match (&self.parts[at].role, &self.written[at].held) {
            (Role::Copied(copy, _), _) => Argument::Reference(copy.clone()),
            (_, Held::Value(value)) => Argument::Value(value.clone()),
            (_, Held::Place(place)) => Argument::Reference(place.clone()),
        }
    }

    /// The parts with a role that `is` picks, in the order in which they are written.
    fn with(&self, is: impl Fn(&Role) -> bool) -> Vec<usize> {
        (0..self.parts.len()).filter(|at| is(&self.parts[*at].role)).collect()
    }

    /// Says where the statements of the call evaluate each part: stores, copies, the call, copies
    /// back, and assignments of outputs.
    fn schedule(&mut self) {
        let stored = self.with(|it| matches!(it, Role::Stored(..)));
        let copied = self.with(|it| matches!(it, Role::Copied(..)));
        let targets = self.with(|it| matches!(it, Role::Target(..) | Role::Count(..)));
        let call = stored.len() + copied.len();
        // A statement finds what a reference to the instance leads to before it evaluates what it passes or copies
        // whole, and that may be null.
        let follows = self.with(|it| matches!(it, Role::Instance)).first().and_then(|it| self.written[*it].place());
        let follows = usize::from(follows.is_some_and(Place::is_followed));
        for (at, part) in self.parts.iter().enumerate() {
            let number = |list: &[usize]| list.iter().position(|it| *it == at).unwrap_or_default();
            let (first, last) = match part.role {
                // Copies come before the call, and need no instance.
                Role::Instance => {
                    ((if stored.is_empty() { call } else { 0 }, Turn::Place), call + copied.len() + targets.len())
                }
                Role::Stored(_, Type::Array(_) | Type::Struct(_)) => {
                    ((number(&stored) + follows, Turn::Value(0)), number(&stored))
                }
                Role::Stored(..) => ((number(&stored), Turn::Value(0)), number(&stored)),
                Role::Passed(parameter) => ((call + follows, Turn::Value(parameter)), call),
                Role::Copied(..) => ((stored.len() + number(&copied), Turn::Place), call + 1 + number(&copied)),
                Role::Target(..) | Role::Count(..) => {
                    let at = call + 1 + copied.len() + number(&targets);
                    ((at, Turn::Place), at)
                }
            };
            self.written[at].first = first;
            self.written[at].last = last;
        }
    }
}

/// The parameters that a call gives, in the order in which it writes them.
pub(crate) fn as_written(given: &[Given<'_, '_>]) -> Vec<usize> {
    let start = |at: &usize| match given[*at] {
        Given::Nothing | Given::Output { target: None, .. } => None,
        Given::Value(expr) | Given::Output { target: Some(expr), .. } => Some(expr.span.start),
    };
    let mut order: Vec<_> = (0..given.len()).filter(|at| start(at).is_some()).collect();
    order.sort_by_key(start);
    order
}

impl<'s> Checker<'_, 's> {
    /// Evaluates the next part, a value of this type.
    pub(crate) fn value_part(&mut self, parts: &mut Parts, expr: &ast::Expr<'s>, ty: Type, role: Role) -> Option<()> {
        // C++ orders the arguments of its functions as it likes; inputs are stored one after the other.
        let is_unordered = self.statement_from.is_some() && matches!(role, Role::Passed(_));
        let before = if is_unordered { parts.written.clone() } else { Vec::new() };
        let mark = self.block.len();
        let value = self.after_parts(&mut parts.written, |this| match this.any_value(expr, ty) {
            Some(any) => any,
            None => this.given_value(expr, ty),
        })?;
        if is_unordered {
            self.note_siblings(mark, Some(&value));
            if before.iter().any(|it| self.held_changes(&self.block[mark..], &it.held)) {
                self.note_use(staunch_ir::Use::Part(staunch_ir::Part::EvaluationOrder), expr.span);
            }
        }
        parts.push(Held::Value(value), role, expr.span);
        Some(())
    }

    /// What an input of type `ty` gets. In CODESYS an instance of what EXTENDS the input's class gives a copy of what it has of
    /// that.
    fn given_value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<Expr> {
        let is_instance = matches!(ty, Type::Struct(it) if self.decl.is_instance(it));
        if !is_instance || !self.decl.dialect(expr.span).gives_bases_of_instances() {
            return self.value(expr, ty);
        }
        match self.operand(expr, Some(ty))? {
            Operand::Typed(heir) if heir.ty != ty && self.decl.extends(heir.ty, ty) => {
                if let Some(message) = self.decl.held_not_copied(ty, expr.span) {
                    return self.instance_is_no_value(&heir, message, expr.span);
                }
                let base = self.temporary("base", ty);
                self.assign_part(&base, heir);
                Some(Expr::load(base, self.at(expr.span)))
            }
            operand => self.coerce(operand, ty, expr.span),
        }
    }

    /// Evaluates the next part, what an output is connected with.
    pub(crate) fn target_part(
        &mut self,
        parts: &mut Parts,
        target: &ast::Expr<'s>,
        negated: bool,
        source: Source,
    ) -> Option<()> {
        let found = self.after_parts(&mut parts.written, |this| this.place_or_view(target))?;
        if !self.writable(&found, target.span) {
            return None;
        }
        self.note_assigned(&found.place, target.span);
        parts.push(Held::Place(found.place), Role::Target(source, negated, found.view), target.span);
        Some(())
    }

    /// Evaluates the next part, the variable given for a VAR_IN_OUT.
    pub(crate) fn in_out_part(
        &mut self,
        parts: &mut Parts,
        formal: &Formal<'s>,
        parameter: usize,
        expr: &ast::Expr<'s>,
    ) -> Option<()> {
        if formal.constant {
            return self.constant_in_out_part(parts, formal, parameter, expr);
        }
        let Found { place, view, .. } = self.after_parts(&mut parts.written, |this| {
            let mut found = this.variable_or_view(expr, formal.name.text)?;
            if found.view.is_some() {
                // It is read before the call, and written after it.
                this.fix(&mut found.place);
            }
            Some(found)
        })?;
        let role = match view {
            Some(view) if view.is_selected => {
                self.report_shared(expr.span, view);
                return None;
            }
            Some(view) => self.shared_in_out(formal, &place, view, expr.span)?,
            None => self.in_out_role(formal, &place, parameter, expr.span)?,
        };
        parts.push(Held::Place(place), role, expr.span);
        Some(())
    }

    /// What shares its bits has no storage of its own, which could be handed on.
    fn shared_in_out(&mut self, formal: &Formal<'s>, place: &Place, view: Window, span: Span) -> Option<Role> {
        let ty = formal.resolved.ty;
        if self.decl.program.is_open(ty) {
            self.decl.not_supported(span, "passing a variable that shares its bits as an ARRAY[*]");
            return None;
        }
        if view.ty != ty {
            self.report_other_type(formal, view.ty, span);
            return None;
        }
        self.note_assigned(place, span);
        Some(Role::Copied(self.temporary("shared", ty), Some(view)))
    }

    /// What a call does with the variable given for a VAR_IN_OUT.
    pub(crate) fn in_out_role(
        &mut self,
        formal: &Formal<'s>,
        place: &Place,
        parameter: usize,
        span: Span,
    ) -> Option<Role> {
        let ty = formal.resolved.ty;
        if let (Type::String(from), Type::String(to)) = (place.ty, ty)
            && from.wide == to.wide
            && from != to
        {
            return Some(Role::Copied(self.temporary("text", ty), None));
        }
        if self.decl.extends_structure(place.ty, ty) {
            self.note_assigned(place, span);
            return Some(Role::Copied(self.temporary("base", ty), None));
        }
        if self.decl.program.is_open(ty) {
            self.takes(formal, place.ty, span)?;
        } else if place.ty != ty {
            if self.decl.extends(place.ty, ty) {
                self.decl.table.polymorphic.ask(formal.name.span);
            }
            self.report_other_type(formal, place.ty, span);
            return None;
        }
        self.note_kin(formal, place);
        self.note_passed(place, span, formal.name.span);
        Some(Role::Passed(parameter))
    }

    /// Notes an instance that may be of another class than is declared, or comes to be if others are.
    fn note_kin(&mut self, formal: &Formal<'s>, place: &Place) {
        let Type::Struct(state) = place.ty else { return };
        let Some(class) = self.decl.slot_of_instance(state) else { return };
        match (place.root, place.projections.as_slice()) {
            (_, [.., Projection::Deref { .. }]) if self.decl.kin(class) != [class] => {
                self.decl.table.polymorphic.ask(formal.name.span);
            }
            (Root::Param(param), []) => {
                let formals = self.signature.as_ref().map(|it| it.formals.as_slice()).unwrap_or_default();
                let own = formals.iter().find(|it| it.target == Target::Param(param.index()));
                if let Some(own) = own.map(|it| it.name.span) {
                    self.decl.table.polymorphic.pass(own, formal.name.span);
                }
            }
            _ => {}
        }
    }

    /// Evaluates the next part, what is given for a VAR_IN_OUT that stands for instances of several classes.
    pub(crate) fn polymorphic_part(
        &mut self,
        parts: &mut Parts,
        formal: &Formal<'s>,
        role: Role,
        expr: &ast::Expr<'s>,
    ) -> Option<()> {
        let ty = formal.resolved.ty;
        let class = self.decl.referred_type(ty)?;
        let is_instance = matches!(class, Type::Struct(id) if self.decl.is_instance(id));
        let value = self.after_parts(&mut parts.written, |this| {
            if !is_instance {
                return this.kept_variable(formal, class, expr);
            }
            let place = this.static_type(expr);
            if !place.is_some_and(|it| this.decl.extends(it, class)) {
                let place = this.variable_argument(expr, formal.name.text)?;
                let wanted = Formal { resolved: Rc::new(Resolved::plain(class)), ..formal.clone() };
                this.report_other_type(&wanted, place.place.ty, expr.span);
                return None;
            }
            let reference = this.reference_to(expr, RefKind::ReferenceTo)?;
            let mut reference = this.coerce(Operand::Typed(reference), ty, expr.span)?;
            this.fault_at_null(&mut reference, expr.span)?;
            Some(reference)
        })?;
        parts.push(Held::Value(value), role, expr.span);
        Some(())
    }

    /// A reference to the variable that is given for a VAR_IN_OUT which the instance keeps.
    fn kept_variable(&mut self, formal: &Formal<'s>, target: Type, expr: &ast::Expr<'s>) -> Option<Expr> {
        let found = self.variable_or_view(expr, formal.name.text)?;
        if found.view.is_some() {
            self.decl.not_supported(expr.span, "passing shared bits to a VAR_IN_OUT that METHODs use");
            return None;
        }
        let is_text = match (found.place.ty, target) {
            (Type::String(from), Type::String(to)) => from.wide == to.wide,
            _ => false,
        };
        if found.place.ty != target && !is_text {
            let wanted = Formal { resolved: Rc::new(Resolved::plain(target)), ..formal.clone() };
            self.report_other_type(&wanted, found.place.ty, expr.span);
            return None;
        }
        if self.is_pin(&found) {
            self.decl.not_supported(expr.span, "passing a pin of a standard block to a VAR_IN_OUT that METHODs use");
            return None;
        }
        self.note_passed(&found.place, expr.span, formal.name.span);
        let at = self.at(expr.span);
        let mut reference = Expr::new(formal.resolved.ty, ExprKind::AddressOf(Box::new(found.place)), at);
        self.fault_at_null(&mut reference, expr.span)?;
        Some(reference)
    }

    /// Evaluates the next part, what is given for a VAR_IN_OUT CONSTANT: a variable of its type itself, else
    /// a copy of the value.
    fn constant_in_out_part(
        &mut self,
        parts: &mut Parts,
        formal: &Formal<'s>,
        parameter: usize,
        expr: &ast::Expr<'s>,
    ) -> Option<()> {
        let ty = formal.resolved.ty;
        if self.decl.program.is_open(ty) {
            return self.open_input_part(parts, formal, parameter, expr);
        }
        let given = self.after_parts(&mut parts.written, |this| {
            let value = this.operand(expr, Some(ty))?;
            let place = match &value {
                Operand::Typed(Expr { kind: ExprKind::Load(place), .. }) if place.ty == ty => Some(place.clone()),
                Operand::Typed(_) | Operand::Promoted(..) | Operand::Integer(_) | Operand::Real { .. } => None,
            };
            // An instance is copied where it is CONSTANT alone: its METHODs may be called.
            let is_instance = this.decl.held_instance(ty).is_some();
            let may_be_lent = |it: &Place| this.may_be_lent(it) || is_instance && !this.is_in_constant(it);
            if let Some(place) = place.filter(may_be_lent) {
                return Some(place);
            }
            let copy = this.temporary(formal.name.text, ty);
            if let Operand::Typed(Expr { kind: ExprKind::Load(heir), .. }) = &value
                && this.decl.extends_structure(heir.ty, ty)
            {
                let at = this.at(expr.span);
                let members = this.copied_members(heir, &copy, at);
                this.block.extend(members);
                return Some(copy);
            }
            let value = this.coerce(value, ty, expr.span)?;
            this.assign(copy.clone(), value, expr.span);
            Some(copy)
        })?;
        parts.push(Held::Place(given), Role::Passed(parameter), expr.span);
        Some(())
    }

    /// Whether a callee may be given the storage itself: what is never written has none of its own, and
    /// the counter of a loop may be kept elsewhere.
    fn may_be_lent(&self, place: &Place) -> bool {
        let is_constant = match (place.root, place.projections.first()) {
            (Root::Globals, Some(Projection::Field(id))) => {
                let globals = self.decl.program.structure(self.decl.program.globals);
                globals.fields.get(id.index()).is_none_or(|it| it.constant)
            }
            (Root::Instance, Some(Projection::Field(id))) => {
                let state = self.signature.as_ref().and_then(|it| it.state);
                let fields = state.map(|it| &self.decl.program.structure(it).fields);
                fields.and_then(|it| it.get(id.index())).is_none_or(|it| it.constant)
            }
            (Root::Globals | Root::Instance, _) => true,
            (Root::Local(_) | Root::Param(_), _) => false,
        };
        !is_constant && !self.is_counter(place, None)
    }

    /// Whether a place is, or is a part of, what is declared CONSTANT.
    fn is_in_constant(&self, place: &Place) -> bool {
        let Some(mut ty) = self.root_type(place.root) else { return false };
        place.projections.iter().any(|projection| {
            let is_constant = match (projection, ty) {
                (Projection::Field(field), Type::Struct(id)) => {
                    self.decl.program.structure(id).fields.get(field.index()).is_some_and(|it| it.constant)
                }
                _ => false,
            };
            ty = self.decl.program.part(ty, projection).unwrap_or(ty);
            is_constant
        })
    }

    pub(crate) fn report_no_variable(&mut self, formal: &Formal<'s>, owner: &str, span: Span) {
        let name = formal.name.text;
        self.report(
            Diagnostic::new(Code::E0303, span, format!("`{owner}` needs a variable for `{name}`"))
                .label(match formal.section {
                    Section::InOut => "every call must give a VAR_IN_OUT",
                    _ => "every call must give an ARRAY[*]",
                })
                .other(formal.name.span, "declared here")
                .help(match formal.section {
                    Section::Output => format!("write `{name} => variable`"),
                    _ => format!("write `{name} := variable`"),
                }),
        );
    }

    fn report_other_type(&mut self, formal: &Formal<'s>, ty: Type, span: Span) {
        let (wants, has) = (self.type_name(formal.resolved.ty), self.type_name(ty));
        let is_class = matches!(formal.resolved.ty, Type::Struct(it) if self.decl.is_instance(it));
        let message = format!("`{}` is {}, found {has}", formal.name.text, article(&wants));
        self.report(
            Diagnostic::new(Code::E0201, span, message)
                .label(if is_class {
                    "a VAR_IN_OUT takes an instance of its own class, or of one that extends it"
                } else {
                    "a VAR_IN_OUT takes a variable of exactly its own type"
                })
                .other(formal.name.span, "declared here"),
        );
    }

    /// An argument that must be a variable which may be written.
    pub(crate) fn variable_argument(&mut self, expr: &ast::Expr<'s>, name: &str) -> Option<Found<'s>> {
        let found = self.variable_or_view(expr, name)?;
        self.whole(found, expr.span)
    }

    fn variable_or_view(&mut self, expr: &ast::Expr<'s>, name: &str) -> Option<Found<'s>> {
        use ast::ExprKind as Ast;
        let names_storage = matches!(
            expr.kind,
            Ast::Name(_) | Ast::Member(..) | Ast::Index(..) | Ast::Address(_) | Ast::Paren(_) | Ast::Deref(_)
        );
        if !names_storage {
            self.report(
                Diagnostic::new(Code::E0306, expr.span, format!("`{name}` needs a variable"))
                    .label("this is a value, and the call writes to this argument")
                    .help("assign the value to a variable, and give that variable"),
            );
            return None;
        }
        let found = self.place_or_view(expr)?;
        self.may_be_given_away(&found, expr.span).then_some(found)
    }

    /// Makes the statements of a call from its parts.
    pub(crate) fn perform(
        &mut self,
        mut parts: Parts,
        call: &dyn Fn(&Parts) -> Option<StatementKind>,
        span: Span,
    ) -> Option<Parts> {
        self.late_target_of(&mut parts, span)?;
        parts.schedule();
        let mut draft = self.until_outputs(&parts, call, span, Copies::Drafted)?;
        for at in parts.with(|it| matches!(it, Role::Target(..) | Role::Count(..))) {
            let place = parts.written[at].place()?.clone();
            let location = self.at(parts.parts[at].span);
            draft.push(Statement::assign(place.clone(), Expr::load(place, location), location));
        }
        self.note_order(&parts, &draft);
        self.settle(&mut parts.written, &draft);
        let statements = self.until_outputs(&parts, call, span, Copies::Made)?;
        for statement in statements {
            self.count_values_of(&statement);
            self.block.push(statement);
        }
        for at in parts.with(|it| matches!(it, Role::Target(..) | Role::Count(..))) {
            self.connect(&parts, at)?;
        }
        Some(parts)
    }

    /// The statements of a call but for the assignments of its outputs.
    fn until_outputs(
        &mut self,
        parts: &Parts,
        call: &dyn Fn(&Parts) -> Option<StatementKind>,
        span: Span,
        copies: Copies,
    ) -> Option<Block> {
        let mut statements = Block::new();
        let mut back = Block::new();
        for (written, part) in parts.written.iter().zip(&parts.parts) {
            if let (Role::Stored(field, ty), Some(value)) = (&part.role, written.value()) {
                let target = parts.instance()?.clone().field(*field, *ty);
                statements.push(Statement::assign(target, value.clone(), self.at(part.span)));
            }
        }
        for (written, part) in parts.written.iter().zip(&parts.parts) {
            if let (Role::Copied(copy, view), Some(place)) = (&part.role, written.place()) {
                statements.extend(self.copied((place, *view), (copy, None), copies, part.span));
                back.extend(self.copied((copy, None), (place, *view), copies, part.span));
            }
        }
        statements.push(Statement::new(call(parts)?, self.at(span)));
        statements.append(&mut back);
        Some(statements)
    }

    /// The statements that copy a variable, or what shares its bits; one where they are drafted.
    fn copied(
        &mut self,
        from: (&Place, Option<Window>),
        to: (&Place, Option<Window>),
        copies: Copies,
        span: Span,
    ) -> Block {
        let at = self.at(span);
        let is_base = from.0.ty != to.0.ty && matches!((from.0.ty, to.0.ty), (Type::Struct(_), Type::Struct(_)));
        let is_drafted = copies == Copies::Drafted && (from.1.is_some() || to.1.is_some() || is_base);
        if is_drafted {
            return vec![Statement::assign(to.0.clone(), Expr::load(from.0.clone(), at), at)];
        }
        if is_base && from.1.is_none() && to.1.is_none() {
            return self.copied_members(from.0, to.0, at);
        }
        self.nested(|this| {
            let Some(value) = this.read(from.0.clone(), from.1, span) else { return };
            let ty = to.1.map_or(to.0.ty, |it| it.ty);
            let value = match ty {
                Type::String(_) => Expr::convert(Conversion::Value, ty, value, at),
                _ => value,
            };
            this.write(to.0.clone(), to.1, value, span);
        })
    }

    /// The statements that copy what a structure and one that it EXTENDS have in common: their first members.
    pub(crate) fn copied_members(&self, from: &Place, to: &Place, at: Location) -> Block {
        let fields = |it: &Place| match it.ty {
            Type::Struct(id) => self.decl.program.structure(id).fields.as_slice(),
            _ => &[],
        };
        let pairs = fields(from).iter().zip(fields(to)).enumerate();
        pairs
            .map(|(at_field, (field, _))| {
                let member = |it: &Place| it.clone().field(FieldId::next(at_field), field.ty);
                Statement::assign(member(to), Expr::load(member(from), at), at)
            })
            .collect()
    }

    /// An output's value for a variable of type `ty`. It is the variable that is written at `span`, so
    /// that no conversion can be written around it.
    fn output(&mut self, value: Expr, ty: Type, span: Span) -> Option<Expr> {
        let reported = self.decl.log.diagnostics.len();
        let found = self.type_name(value.ty);
        let value = self.coerce(Operand::Typed(value), ty, span);
        if value.is_none() {
            let wanted = self.type_name(ty);
            for error in self.decl.log.diagnostics[reported..].iter_mut().filter(|it| it.fix.is_some()) {
                error.fix = None;
                error.help = Some(format!(
                    "connect it to a variable of type {found}, and convert that to {wanted} after the call"
                ));
            }
        }
        value
    }

    /// `OUT => target`, after the call.
    pub(super) fn connect(&mut self, parts: &Parts, at: usize) -> Option<()> {
        let Part { role, span } = &parts.parts[at];
        let target = parts.written[at].place()?.clone();
        let (source, negated, view) = match role {
            Role::Target(Source::Field(field, ty), negated, view) => {
                (parts.instance()?.clone().field(*field, *ty), *negated, *view)
            }
            Role::Target(Source::Variable(place), negated, view) => (place.clone(), *negated, *view),
            Role::Count(field, ty) => (parts.instance()?.clone().field(*field, *ty), false, None),
            Role::Instance | Role::Stored(..) | Role::Passed(_) | Role::Copied(..) => return None,
        };
        let location = self.at(*span);
        let mut value = Expr::load(source, location).read();
        if negated {
            value = self.not(value, *span)?;
        }
        let ty = view.map_or(target.ty, |it| it.ty);
        let value = self.output(value, ty, *span)?;
        self.write(target, view, value, *span)
    }
}
