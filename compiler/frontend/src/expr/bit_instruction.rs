//! Instructions of Logix on single bits: `ONS`, `OSR`, `OSF`, `OTL` and `OTU`, by Rockwell 1756-RM003, *Bit
//! Instructions*. A storage bit holds the rung of the last execution; the prescan gives it the value that lets the
//! first scan see no edge.

use super::argument::as_written;
use super::binding::{Given, Parameter};
use super::checker::Checker;
use super::order::{Held, Written};
use super::part::Bits;
use super::uses::Preparation;
use crate::names::BitInstruction;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Expr, Op, Place, Section, StatementKind, Type};

/// A BOOL, or one bit of an integer.
#[derive(Clone)]
struct Bit {
    bits: Option<Bits>,
    span: Span,
}

impl<'s> Checker<'_, 's> {
    pub(super) fn bit_instruction(
        &mut self,
        instruction: BitInstruction,
        name: ast::Name<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Expr> {
        let operands = instruction.operands();
        let mut parameters: Vec<_> = operands.iter().map(|name| Parameter::of_library(name, Section::InOut)).collect();
        parameters.push(Parameter::of_library("RungIn", Section::Input));
        let given = self.instruction_operands(name, &parameters, arguments)?;
        let mut bits = vec![None; operands.len()];
        let mut written: Vec<Written> = Vec::new();
        let mut order = Vec::new();
        let mut complete = true;
        for at in as_written(&given) {
            let Given::Value(expr) = given[at] else { continue };
            let held = self.after_parts(&mut written, |this| match bits.get_mut(at) {
                Some(bit) => {
                    let (place, found) = this.bit(name, operands[at], expr)?;
                    *bit = Some(found);
                    Some(Held::Place(place))
                }
                None => this.value(expr, Type::BOOL).map(Held::Value),
            });
            match held {
                Some(held) => {
                    written.push(Written::new(held));
                    order.push(at);
                }
                None => complete = false,
            }
        }
        if !complete {
            return None;
        }
        if let Some(at) = (0..operands.len()).find(|at| !matches!(given[*at], Given::Value(_))) {
            let named: Vec<_> = operands.iter().map(|it| format!("{it} := tag")).collect();
            let message = format!("`{}` needs a BOOL for `{}`", name.text, operands[at]);
            self.report(Diagnostic::new(Code::E0303, name.span, message).help(format!(
                "write `{}({}, RungIn := condition)`",
                name.text,
                named.join(", ")
            )));
            return None;
        }
        if !self.has_rung(name, given.last()?) {
            return None;
        }
        let place_of =
            |written: &[Written], at: usize| written[order.iter().position(|it| *it == at)?].place().cloned();
        // A prescan finds an element by the index as the text has it, not as it was in a scan.
        let named: Vec<_> = (0..operands.len()).map(|at| place_of(&written, at)).collect::<Option<_>>()?;
        for part in &mut written {
            match &mut part.held {
                Held::Place(place) => self.fix(place),
                Held::Value(rung) if rung.as_const().is_none() => self.save("rung", rung),
                Held::Value(_) => {}
            }
        }
        let rung = written.iter().find_map(Written::value)?.clone();
        let places: Vec<_> = (0..operands.len()).map(|at| place_of(&written, at)).collect::<Option<_>>()?;
        let bits: Vec<_> = bits.into_iter().collect::<Option<_>>()?;
        for ((place, bit), value) in named.iter().zip(&bits).zip(instruction.prescan()) {
            self.note_assigned(place, bit.span);
            if let Some(value) = value {
                self.prepared(place, Preparation::Bit { shift: bit.bits.map(|it| it.shift), value: *value });
            }
        }
        let parts: Vec<_> = places.into_iter().zip(bits).collect();
        self.execute(instruction, &parts, rung, span)
    }

    fn execute(&mut self, instruction: BitInstruction, parts: &[(Place, Bit)], rung: Expr, span: Span) -> Option<Expr> {
        let at = self.at(span);
        let and = |a, b| Expr::apply(Op::And, Type::BOOL, vec![a, b], at);
        match instruction {
            BitInstruction::Latch | BitInstruction::Unlatch => {
                let value = Expr::bool(instruction == BitInstruction::Latch, at);
                let then = self.nested(|this| {
                    this.write_bit(&parts[0], value, span);
                });
                self.push(StatementKind::If { condition: rung.clone(), then, otherwise: Vec::new() }, span);
                Some(rung)
            }
            BitInstruction::OneShot | BitInstruction::OneShotRising => {
                let before = self.read_bit(&parts[0], span)?;
                let before = self.not(before, span)?;
                let mut edge = and(rung.clone(), before);
                self.save("edge", &mut edge);
                self.write_bit(&parts[0], rung.clone(), span)?;
                match parts.get(1) {
                    None => Some(edge),
                    Some(output) => self.write_bit(output, edge, span).map(|()| rung),
                }
            }
            BitInstruction::OneShotFalling => {
                let before = self.read_bit(&parts[0], span)?;
                let falls = self.not(rung.clone(), span)?;
                let mut edge = and(falls, before);
                self.save("edge", &mut edge);
                self.write_bit(&parts[0], rung.clone(), span)?;
                self.write_bit(&parts[1], edge, span)?;
                Some(rung)
            }
        }
    }

    /// `a [:=] b`: the prescan sets it to 0.
    pub(crate) fn reset_at_start(&mut self, target: &ast::Expr<'s>) -> Option<()> {
        let (base, part) = match &target.kind {
            ast::ExprKind::Part(base, part) => (&**base, Some(*part)),
            _ => (target, None),
        };
        let place = self.place(base)?.place;
        let preparation = match part {
            Some(part) => Preparation::Bit { shift: Some(self.find_part(place.ty, part)?.bits().shift), value: false },
            None if self.is_set_to_zero(place.ty) => Preparation::Zero,
            None => {
                let ty = self.type_name(place.ty);
                let error = Diagnostic::new(
                    Code::E0321,
                    target.span,
                    format!("`[:=]` assigns a number, a BOOL or a STRING, but this is {ty}"),
                );
                self.report(error.label("the prescan sets one value to 0").help("write `:=`"));
                return None;
            }
        };
        self.prepared(&place, preparation);
        Some(())
    }

    /// Whether `[:=]` assigns this: a number, a BOOL or a STRING.
    fn is_set_to_zero(&self, ty: Type) -> bool {
        self.decl.program.repr(ty).is_some() || ty.string_type().is_some()
    }

    /// What is given for a bit.
    fn bit(&mut self, name: ast::Name<'s>, operand: &str, expr: &ast::Expr<'s>) -> Option<(Place, Bit)> {
        let (base, part) = match &expr.kind {
            ast::ExprKind::Part(base, part) => (&**base, Some(*part)),
            _ => (expr, None),
        };
        let found = self.variable_argument(base, operand)?;
        if !self.is_no_input_address(&found, expr.span) {
            return None;
        }
        let bit = match part {
            Some(part) => Some(self.find_part(found.place.ty, part)?),
            None => None,
        };
        let ty = bit.map_or(found.place.ty, |it| Type::Elementary(it.ty));
        if ty != Type::BOOL {
            let has = self.type_name(ty);
            let message = format!("`{}` works on a BOOL, or on a bit of an integer, found {has}", name.text);
            let error = Diagnostic::new(Code::E0313, expr.span, message).label("expected a BOOL");
            if matches!(ty, Type::Block(_)) {
                let error = error.help(format!("declare `{operand} : BOOL;`, and give it"));
                let error = self.help_on_other_tag(error, ty, name, expr.span);
                self.report(error);
                return None;
            }
            self.report(error.help(match matches!(ty, Type::Elementary(it) if it.repr().is_integer()) {
                true => format!("write one of its bits: `{}.0`", self.decl.log.sources.text(expr.span)),
                false => format!("declare `{operand} : BOOL;`, and give it"),
            }));
            return None;
        }
        Some((found.place, Bit { bits: bit.map(|it| it.bits()), span: expr.span }))
    }

    fn read_bit(&mut self, (place, bit): &(Place, Bit), span: Span) -> Option<Expr> {
        let value = self.read(place.clone(), None, span)?;
        match bit.bits {
            Some(bits) => self.bits(value, bits, Type::BOOL, span),
            None => Some(value),
        }
    }

    fn write_bit(&mut self, (place, bit): &(Place, Bit), value: Expr, span: Span) -> Option<()> {
        match bit.bits {
            Some(bits) => self.merge(place.clone(), bits, value, span),
            None => self.write(place.clone(), None, value, span),
        }
    }
}
