//! What an assignment gives its targets, as a statement and as an expression.

use super::checker::{Checker, Context};
use super::operand::Operand;
use super::place::Found;
use super::unresolved::not_constant;
use crate::diagnostic::wording::article;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Expr, ExprKind, Place, StatementKind, Type};

impl<'s> Checker<'_, 's> {
    /// `(a := b)`, of CODESYS: what `a` is given, where it is written.
    pub(crate) fn assigned_value(
        &mut self,
        sides: &[ast::Expr<'s>; 2],
        sign: Span,
        expected: Option<Type>,
        span: Span,
    ) -> Option<Expr> {
        let [target, value] = sides;
        if !self.decl.dialect(span).assigns_in_expressions() {
            match expected {
                Some(Type::BOOL) => self.report_assignment(sides, sign),
                _ => self.report(
                    Diagnostic::new(Code::E0512, span, "an assignment has no value")
                        .label("an assignment in an expression is an extension of CODESYS")
                        .help("write it as a statement of its own, and the variable here"),
                ),
            }
            self.operand(target, None);
            self.operand(value, None);
            return None;
        }
        if self.signature.is_none() || self.context != Context::Body {
            self.report(not_constant(span));
            return None;
        }
        self.assigned(std::slice::from_ref(target), value, span, true).map(Expr::read)
    }

    /// `:=` where a comparison was meant.
    pub(crate) fn report_assignment(&mut self, [left, _]: &[ast::Expr<'s>; 2], sign: Span) {
        let shown = self.decl.log.sources.text(left.span);
        let shown = if shown.len() <= 40 { shown } else { "a" };
        let help = format!("write `{shown} = …`");
        self.report(
            Diagnostic::new(Code::E0009, sign, "`:=` assigns, and a condition cannot; a comparison is written `=`")
                .label("expected `=`")
                .help(help)
                .fix(sign, "="),
        );
    }

    /// An assignment that is a whole condition, where the dialect has that.
    pub(crate) fn doubt_assignment(&mut self, [left, _]: &[ast::Expr<'s>; 2], sign: Span) {
        let shown = self.decl.log.sources.text(left.span).to_owned();
        self.report(
            Diagnostic::new(Code::W0530, sign, "this condition is an assignment")
                .label(format!("`{shown}` is assigned, and the condition is its new value"))
                .help("write `=` to compare, or assign in a statement before this one")
                .fix(sign, "="),
        );
    }

    /// Whether a METHOD or ACTION of the POU is named where something is assigned, which is refused.
    fn refuse_routine(&mut self, target: &ast::Expr<'s>) -> bool {
        let ast::ExprKind::Name(name) = target.kind else { return false };
        let is_variable = self.scope.get(name.text).is_some() || self.result_variable(name).is_some();
        let Some(slot) = self.own_routine(name).filter(|_| !is_variable) else { return false };
        let word = self.decl.pous[slot].ast.kind.word();
        self.report(
            Diagnostic::new(Code::E0101, name.span, format!("`{}` is {}", name.text, article(word)))
                .label("it cannot be assigned to")
                .help(format!("assign to a variable; a result is assigned inside the {word}")),
        );
        true
    }

    /// What the first of the targets is given, where that `is_read`. Targets are found from left to right, then the value is
    /// computed, and assigned from right to left. It is computed once where a target to the left reads it.
    pub(crate) fn assigned(
        &mut self,
        targets: &[ast::Expr<'s>],
        value: &ast::Expr<'s>,
        span: Span,
        is_read: bool,
    ) -> Option<Expr> {
        let [target, rest @ ..] = targets else { return None };
        if targets.len() == 1
            && !is_read
            && let Some(made) = self.assign_property(target, value, span)
        {
            return made.map(|()| Expr::bool(true, self.at(span)));
        }
        if (is_read || targets.len() > 1) && self.refuse_part(target) {
            self.operand(value, None);
            return None;
        }
        let found = if self.refuse_routine(target) { None } else { self.place_or_view(target) };
        let Some(found) = found else {
            // What is left may hold mistakes of its own.
            rest.iter().for_each(|it| drop(self.place(it)));
            self.operand(value, None);
            return None;
        };
        if let Some(()) = self.refuse_instance(&found.place, target.span) {
            return None;
        }
        let writable = self.writable(&found, target.span);
        let (ty, view) = (self.type_of(&found), found.view);
        let mut place = found.place;
        let (mark, written) = (self.block.len(), self.kept_order(&place));
        let mut given = self.after_place(&mut place, |this| {
            if rest.is_empty() {
                return this.value_or_heir(value, ty);
            }
            let right = this.assigned(rest, value, span, true)?;
            this.coerce(Operand::Typed(right.read()), ty, value.span)
        })?;
        self.note_siblings(mark, Some(&given));
        self.note_reordered(mark, written.as_ref(), span);
        if is_read && given.as_const().is_none() {
            self.save("assigned", &mut given);
        } else {
            self.before_target(&place, &mut given);
        }
        if writable && given.ty != ty && self.decl.extends(given.ty, ty) {
            self.note_assigned(&place, target.span);
            self.assign_part(&place, given);
            return Some(Expr::bool(true, self.at(span)));
        }
        if writable {
            self.note_assigned(&place, target.span);
            let read = if is_read { given.clone() } else { Expr::bool(true, self.at(span)) };
            self.write(place, view, given, span)?;
            return Some(read);
        }
        Some(given)
    }

    /// `x S= c` sets, `x R= c` resets, while `c` is TRUE, which is asked once.
    pub(crate) fn set_reset(
        &mut self,
        targets: &[(&ast::Expr<'s>, bool)],
        value: &ast::Expr<'s>,
        span: Span,
    ) -> Option<()> {
        let mut latched = Vec::new();
        let condition = self.latched(targets, value, &mut latched)?;
        let then = self.nested(|this| {
            let at = this.at(span);
            for (found, set) in latched.into_iter().rev() {
                this.write(found.place, found.view, Expr::bool(set, at), span);
            }
        });
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        Some(())
    }

    /// The condition under which the targets are written. They are found first, from left to right, as in an assignment,
    /// whether they are then written or not, and kept with the last one first.
    fn latched(
        &mut self,
        targets: &[(&ast::Expr<'s>, bool)],
        value: &ast::Expr<'s>,
        latched: &mut Vec<(Found<'s>, bool)>,
    ) -> Option<Expr> {
        let [(target, set), rest @ ..] = targets else {
            let condition = self.condition(value)?;
            self.count_condition(value, Some(&condition));
            return Some(condition);
        };
        let found = self.place_or_view(target);
        let Some(mut found) = found.filter(|it| self.writable(it, target.span)) else {
            rest.iter().for_each(|it| drop(self.place(it.0)));
            self.operand(value, None);
            return None;
        };
        let ty = self.type_of(&found);
        if ty != Type::BOOL {
            let ty = self.type_name(ty);
            let op = if *set { "S=" } else { "R=" };
            self.error(Code::E0201, target.span, format!("`{op}` needs a BOOL, but this is {ty}"));
            return None;
        }
        self.note_assigned(&found.place, target.span);
        self.freeze(&mut found.place, &[], true);
        if latched.len() + rest.len() > 0 {
            // What is written before it may be what its index asks.
            self.fix(&mut found.place);
        }
        let mut place = found.place.clone();
        let condition = self.after_place(&mut place, |this| this.latched(rest, value, latched))?;
        latched.push((Found { place, ..found }, *set));
        Some(condition)
    }

    /// A value for a variable of type `ty`; in `siemens` also an instance of a class that EXTENDS the variable's, as it is.
    fn value_or_heir(&mut self, value: &ast::Expr<'s>, ty: Type) -> Option<Expr> {
        let slices = self.decl.dialect(value.span).copies_bases_of_instances();
        if !slices || !matches!(ty, Type::Struct(it) if self.decl.is_instance(it)) {
            return self.value(value, ty);
        }
        match self.operand(value, Some(ty))? {
            Operand::Typed(heir) if heir.ty != ty && self.decl.extends(heir.ty, ty) => {
                match self.decl.held_not_copied(heir.ty, value.span) {
                    Some(message) => self.instance_is_no_value(&heir, message, value.span),
                    None => Some(heir),
                }
            }
            operand => self.coerce(operand, ty, value.span),
        }
    }

    /// What an instance has of its base goes to an instance of that.
    pub(super) fn assign_part(&mut self, place: &Place, mut given: Expr) {
        if !matches!(given.kind, ExprKind::Load(_)) {
            self.save("assigned", &mut given);
        }
        if let ExprKind::Load(from) = &given.kind {
            let members = self.copied_members(from, place, given.at);
            self.block.extend(members);
        }
    }

    /// What a statement of its own assigns, when it is more than a variable.
    fn refuse_part(&mut self, target: &ast::Expr<'s>) -> bool {
        let what = match &target.bare().kind {
            _ if self.character_of(target).is_some() => "a character of a string",
            _ if self.property(target).is_some() => "a PROPERTY",
            _ => return false,
        };
        self.report(
            Diagnostic::new(Code::E0306, target.span, format!("{what} can only be assigned by a separate statement"))
                .label("this assignment is part of another one or of an expression")
                .help("assign the value to a variable here, and this one in a statement after it"),
        );
        true
    }

    /// A block's state is not copied over another's.
    fn refuse_instance(&mut self, place: &Place, span: Span) -> Option<()> {
        let (way, instance) = self.decl.instance_not_copied(place.ty, span)?;
        let (ty, instance) = (self.type_name(place.ty), self.type_name(instance));
        let error = match way.as_str() {
            "" => Diagnostic::new(Code::E0210, span, format!("an instance of {instance} cannot be assigned to"))
                .label("this is the block itself"),
            way => Diagnostic::new(Code::E0210, span, format!("{ty} cannot be assigned as a whole"))
                .label(format!("it holds an instance of {instance}, at `{way}`, which is never copied")),
        };
        self.report(error.help(match self.decl.is_copied_elsewhere(place.ty) {
            true => "assign to its inputs, or call it; in the dialects `codesys` and `siemens` an assignment copies it",
            false => "assign to its inputs, or call it",
        }));
        Some(())
    }
}
