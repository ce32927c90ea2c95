//! `COP`, `CPS` and `SIZE` of Logix, by Rockwell 1756-RM003, *Array (File)/Misc. Instructions*, and the
//! instructions that ask the controller for a service.
//!
//! `Length` counts elements of the destination. Elements of one type are assigned one after the other, numbers
//! of different types byte by byte. A copy ends at the end of the destination's array, as documented; where the
//! controller would continue in memory that is not the array's, it is a fault.

use super::checker::Checker;
use super::operand::Operand;
use crate::names::Sense;
use crate::vendor::controller_service;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::{
    Array, Block, Conversion, Elementary, Expr, ExprKind, For, Location, Op, Place, Projection, RefKind, Root,
    Statement, Type, Value,
};
use staunch_runtime::Family;

const BYTE: Type = Type::Elementary(Elementary::Byte);
const LWORD: Type = Type::Elementary(Elementary::Lword);

#[derive(Clone, Copy)]
enum Instruction {
    Copy,
    Size,
    /// What the controller does, of which a program alone has nothing.
    Service(&'static str),
}

fn instruction(name: &str) -> Option<(Instruction, [&'static str; 3])> {
    let is = |it: &str| it.eq_ignore_ascii_case(name);
    match () {
        () if is("COP") || is("CPS") => Some((Instruction::Copy, ["Source", "Dest", "Length"])),
        () if is("SIZE") => Some((Instruction::Size, ["Source", "Dim", "Size"])),
        () => controller_service(name).map(|it| (Instruction::Service(it), [""; 3])),
    }
}

/// What is copied from or to: elements of an array from one on, or one variable.
struct Side {
    /// The array, or the variable.
    place: Place,
    element: Type,
    /// The array's bounds, and the index of the first element: a constant or a local.
    row: Option<(Array, Expr)>,
    /// What follows it in memory is of the same tag.
    is_member: bool,
    span: Span,
}

impl Side {
    /// How many elements there are from the first on.
    fn remaining(&self, at: Location) -> Expr {
        match &self.row {
            None => lint(1, at),
            Some((array, start)) => match constant(start) {
                Some(start) => lint(array.high - start + 1, at),
                None => operation(Op::Sub, vec![lint(array.high + 1, at), start.clone()], at),
            },
        }
    }

    /// An element by its distance from the first; of one variable it is that itself.
    fn at(&self, distance: &Expr, at: Location) -> Place {
        match &self.row {
            None => self.place.clone(),
            Some((_, start)) => self.place.clone().index(sum(start, distance, at), self.element, at),
        }
    }
}

impl<'s> Checker<'_, 's> {
    /// Whether a statement calls one of them.
    pub(crate) fn logix_statement(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> bool {
        let Ast::Name(name) = &callee.kind else { return false };
        if self.calls_own_routine(callee) {
            return false;
        }
        if self.signature.is_some() && self.has_destination(*name, arguments, span) {
            return true;
        }
        let Some((instruction, names)) = instruction(name.text) else { return false };
        let is_known = self.means_anything(&[*name], Sense::Callee);
        if is_known || self.decl.dialect(name.span).family() != Family::Logix {
            return false;
        }
        // A constant is wanted: the caller reports that this is not a value.
        if self.signature.is_none() {
            return true;
        }
        if let Instruction::Service(service) = instruction {
            self.report(crate::parse::controller_service(name.span, name.text, service));
            return true;
        }
        match self.in_order(*name, names, arguments, span) {
            None => self.check_arguments(arguments),
            Some([source, target, length]) if matches!(instruction, Instruction::Copy) => {
                self.copy_elements(*name, source, target, length, span);
            }
            Some([source, dimension, target]) => {
                self.size_in_elements(source, dimension, target, span);
            }
        }
        true
    }

    fn copy_elements(
        &mut self,
        name: ast::Name<'s>,
        source: &ast::Expr<'s>,
        target: &ast::Expr<'s>,
        length: &ast::Expr<'s>,
        span: Span,
    ) -> Option<()> {
        let source = self.copied_side(name, source, false);
        let target = self.copied_side(name, target, true);
        let length = self.copied_length(length);
        let (source, target, length) = (source?, target?, length?);
        let at = self.at(span);
        let is_number = |it| matches!(it, Type::Elementary(_));
        let (from, to) = (source.element.read(), target.element.read());
        let is_same = from == to && source.element == target.element;
        if !(is_same || is_number(from) && is_number(to)) {
            return self.report_layout(name, &source, &target);
        }
        let count = match target.is_member {
            true => length,
            false => least(length, target.remaining(at), at),
        };
        let assigned = match constant(&count) {
            Some(1) => target.at(&lint(0, at), at),
            _ => target.place.clone(),
        };
        self.note_assigned(&assigned, target.span);
        let sizes = [&source, &target].map(|it| i64::try_from(self.decl.sizeof(it.element)).unwrap_or(i64::MAX));
        let read = match (is_same, constant(&count)) {
            (true, _) => count.clone(),
            (false, Some(count)) => lint(count.saturating_mul(sizes[1]).saturating_add(sizes[0] - 1) / sizes[0], at),
            (false, None) => {
                let bytes = operation(Op::Mul, vec![count.clone(), lint(sizes[1], at)], at);
                let up = operation(Op::Add, vec![bytes, lint(sizes[0] - 1, at)], at);
                operation(Op::Div, vec![up, lint(sizes[0], at)], at)
            }
        };
        self.has_elements(name, &source, read)?;
        if target.is_member {
            self.has_elements(name, &target, count.clone())?;
        }
        if is_same && constant(&count) == Some(1) {
            let value = Expr::load(source.at(&lint(0, at), at), at);
            self.assign(target.at(&lint(0, at), at), value, span);
            return Some(());
        }
        let body = match is_same {
            true => self.each_element(&source, &target, &count, at),
            false => self.each_byte_of(&source, &target, count, sizes[1], at),
        };
        self.block.push(body);
        Some(())
    }

    /// What an operand names.
    fn copied_side(&mut self, name: ast::Name<'s>, expr: &ast::Expr<'s>, is_target: bool) -> Option<Side> {
        let found = self.place(expr)?;
        if is_target && !self.writable(&found, expr.span) {
            return None;
        }
        let mut place = found.place;
        self.fix(&mut place);
        let (at, span) = (self.at(expr.span), expr.span);
        let whole = |this: &Self, place: &Place| match place.ty {
            Type::Array(id) => Some(this.decl.program.array(id)),
            _ => None,
        };
        let row = match (place.ty, place.projections.pop()) {
            (Type::Array(_), last) => {
                place.projections.extend(last);
                whole(self, &place).map(|it| (it, lint(it.low, at)))
            }
            (_, Some(Projection::Index { index, .. })) => {
                place.ty = self.type_at(&place)?;
                whole(self, &place).map(|it| (it, *index))
            }
            (_, last) => {
                place.projections.extend(last);
                None
            }
        };
        let element = row.as_ref().map_or(place.ty, |it| it.0.element);
        let is_of_many = row.is_some() && matches!(place.projections.last(), Some(Projection::Index { .. }));
        let refused = match element {
            _ if self.decl.program.is_open(place.ty) => Some("an ARRAY[*]"),
            Type::Array(_) => Some("an array of several dimensions"),
            _ if is_of_many => Some("an array of several dimensions"),
            Type::Elementary(Elementary::Bool) => Some("BOOLs"),
            _ => None,
        };
        if let Some(what) = refused {
            self.decl.not_supported(span, &format!("`{}` of {what}", name.text.to_ascii_uppercase()));
            return None;
        }
        if let Some(message) = self.decl.held_not_copied(element, span) {
            self.error(Code::E0210, span, message);
            return None;
        }
        let fields = place.projections.iter().filter(|it| matches!(it, Projection::Field(_))).count();
        let own = usize::from(matches!(place.root, Root::Instance | Root::Globals));
        Some(Side { place, element, row, is_member: fields > own, span })
    }

    /// The type that a place has without what its projections lead to last.
    fn type_at(&self, place: &Place) -> Option<Type> {
        let root = self.root_type(place.root)?;
        place.projections.iter().try_fold(root, |ty, projection| self.decl.program.part(ty, projection))
    }

    /// The number of elements, as a LINT that is a constant or in a local.
    fn copied_length(&mut self, expr: &ast::Expr<'s>) -> Option<Expr> {
        let value = self.integer_index(expr)?;
        let mut value = self.as_lint(value, expr.span)?;
        if value.as_const().is_none() {
            self.save("length", &mut value);
        }
        Some(value)
    }

    /// Refuses a copy that is known to leave a side, and checks one that is not.
    fn has_elements(&mut self, name: ast::Name<'s>, side: &Side, elements: Expr) -> Option<()> {
        let at = self.at(side.span);
        let remaining = side.remaining(at);
        if let (Some(elements), Some(remaining)) = (constant(&elements), constant(&remaining)) {
            if elements > remaining {
                let text = self.decl.log.sources.text(side.span);
                let message = format!("`{}` needs {elements} elements from `{text}` on", name.text);
                let label = match remaining {
                    1 => "only 1 is left".to_owned(),
                    many => format!("only {many} are left"),
                };
                let error = Diagnostic::new(Code::E0208, side.span, message).label(label);
                self.report(error.help("Length counts elements of the destination's type"));
                return None;
            }
            return Some(());
        }
        let checked = Expr::apply(Op::CheckIndex, Type::LINT, vec![lint(i64::MIN, at), elements, remaining], at);
        let place = self.temporary("within", Type::LINT);
        self.assign(place, checked, side.span);
        Some(())
    }

    /// `target[k] := source[k]` from the first element on.
    fn each_element(&mut self, source: &Side, target: &Side, count: &Expr, at: Location) -> Statement {
        let counter = self.temporary("element", Type::LINT);
        let distance = Expr::load(counter.clone(), at);
        let body = vec![Statement::assign(target.at(&distance, at), Expr::load(source.at(&distance, at), at), at)];
        For::over(counter, lint(0, at), sum(count, &lint(-1, at), at), body, at)
    }

    fn each_byte_of(&mut self, source: &Side, target: &Side, count: Expr, size: i64, at: Location) -> Statement {
        let [from, to] = [source, target].map(|it| self.pointer_to(it.at(&lint(0, at), at), at));
        let bytes = match constant(&count) {
            Some(count) => lint(count.saturating_mul(size), at),
            None => operation(Op::Mul, vec![count, lint(size, at)], at),
        };
        let byte = |it: &Place| it.clone().deref(BYTE, at);
        let mut body: Block = vec![Statement::assign(byte(&to), Expr::load(byte(&from), at), at)];
        for pointer in [&from, &to] {
            let bits = Expr::convert(Conversion::Same, LWORD, Expr::load(pointer.clone(), at), at);
            let next = Expr::apply(Op::Advance, LWORD, vec![bits, lint(1, at)], at);
            body.push(Statement::assign(pointer.clone(), Expr::convert(Conversion::Same, pointer.ty, next, at), at));
        }
        For::over(self.temporary("turn", Type::LINT), lint(1, at), bytes, body, at)
    }

    /// A local that refers to the bytes of a number.
    fn pointer_to(&mut self, place: Place, at: Location) -> Place {
        let ty = self.decl.reference_type(RefKind::PointerTo, place.ty);
        let bytes = self.decl.reference_type(RefKind::PointerTo, BYTE);
        let address = Expr::new(ty, ExprKind::AddressOf(Box::new(place)), at);
        let pointer = self.temporary("address", bytes);
        let address = if ty == bytes { address } else { Expr::convert(Conversion::Same, bytes, address, at) };
        self.block.push(Statement::assign(pointer.clone(), address, at));
        pointer
    }

    fn report_layout(&mut self, name: ast::Name<'s>, source: &Side, target: &Side) -> Option<()> {
        let [from, to] = [source, target].map(|it| self.type_name(it.element));
        let what = format!("`{}` from {from} to {to}", name.text.to_ascii_uppercase());
        self.report(
            Diagnostic::new(Code::E0902, target.span, format!("{what} is not supported"))
                .label(format!("expected {from}"))
                .note("it copies bytes, and a controller stores strings and structures differently")
                .help("assign the members one by one"),
        );
        None
    }

    /// `SIZE(array, 0, number)`: the dimensions count from 0.
    fn size_in_elements(
        &mut self,
        source: &ast::Expr<'s>,
        dimension: &ast::Expr<'s>,
        target: &ast::Expr<'s>,
        span: Span,
    ) -> Option<()> {
        let array = match &source.kind {
            Ast::Index(array, _) => array,
            _ => source,
        };
        let found = self.place(array)?;
        let mut sizes = Vec::new();
        let mut ty = found.place.ty;
        while let Type::Array(id) = ty {
            let array = self.decl.program.array(id);
            sizes.push(array.high - array.low + 1);
            ty = array.element;
        }
        if sizes.is_empty() || ty == Type::BOOL {
            let ty = self.type_name(found.place.ty);
            self.report(
                Diagnostic::new(
                    Code::E0201,
                    source.span,
                    format!("`SIZE` counts an array's elements, but this is {ty}"),
                )
                .label("expected an array of numbers, strings or structures"),
            );
            return None;
        }
        let number = self.typed(dimension, Some(Type::DINT))?;
        let position = constant_of(&number).and_then(|it| usize::try_from(it).ok());
        let Some((position, size)) = position.and_then(|it| Some((it, *sizes.get(it)?))) else {
            let message = "the dimension must be a constant, and exist in the array";
            let (count, last) = (sizes.len(), sizes.len() - 1);
            let label = if count == 1 {
                "the only dimension is 0".to_owned()
            } else {
                format!("its dimensions are 0 to {last}")
            };
            self.report(Diagnostic::new(Code::E0208, dimension.span, message).label(label));
            return None;
        };
        let target_place = self.place(target)?;
        if !self.writable(&target_place, target.span) {
            return None;
        }
        self.note_assigned(&target_place.place, target.span);
        let size = match self.open_size(&found.place, position, span) {
            Some(size) => Operand::Typed(size),
            None => Operand::Integer(i128::from(size)),
        };
        let value = self.coerce(size, target_place.place.ty, target.span)?;
        self.assign(target_place.place, value, span);
        Some(())
    }

    /// The elements in a dimension of an `ARRAY[*]`, which each call gives its bounds.
    fn open_size(&mut self, place: &Place, position: usize, span: Span) -> Option<Expr> {
        if !self.decl.program.is_open(place.ty) {
            return None;
        }
        let (low, high) = *self.bounds_of(place.root).get(place.projections.len() + position)?;
        let at = self.at(span);
        let bound = |it| Expr::load(Place::local(it, Type::DINT), at);
        let one = Expr::constant(Elementary::Dint, Value::I32(1), at);
        let distance = Expr::apply(Op::Sub, Type::DINT, vec![bound(high), bound(low)], at);
        Some(Expr::apply(Op::Add, Type::DINT, vec![distance, one], at))
    }

    /// The three operands of one of them, by position or by name.
    pub(super) fn in_order<'a>(
        &mut self,
        name: ast::Name<'s>,
        names: [&'static str; 3],
        arguments: &'a [ast::Argument<'s>],
        span: Span,
    ) -> Option<[&'a ast::Expr<'s>; 3]> {
        let mut given = [None; 3];
        for (at, argument) in arguments.iter().enumerate() {
            let (slot, value) = match &argument.kind {
                ArgumentKind::Positional(value) => (Some(at), value),
                ArgumentKind::Input(formal, value) => {
                    (names.iter().position(|it| it.eq_ignore_ascii_case(formal.text)), value)
                }
                ArgumentKind::Output { .. } => (None, given[0].or(given[1])?),
            };
            match slot.and_then(|it| given.get_mut(it)).filter(|it| it.is_none()) {
                Some(free) => *free = Some(value),
                None => given[0] = None,
            }
        }
        match given {
            [Some(a), Some(b), Some(c)] if arguments.len() == 3 => Some([a, b, c]),
            _ => {
                self.report(
                    Diagnostic::new(Code::E0302, span, format!("`{}` takes 3 arguments", name.text))
                        .label(format!("its parameters are `{}`, `{}` and `{}`", names[0], names[1], names[2])),
                );
                None
            }
        }
    }
}

fn constant(expr: &Expr) -> Option<i64> {
    i64::try_from(constant_of(expr)?).ok()
}

fn constant_of(expr: &Expr) -> Option<i128> {
    expr.as_const().and_then(Value::as_integer)
}

fn lint(value: i64, at: Location) -> Expr {
    Expr::constant(Elementary::Lint, Value::I64(value), at)
}

fn operation(op: Op, operands: Vec<Expr>, at: Location) -> Expr {
    Expr::apply(op, Type::LINT, operands, at)
}

fn sum(a: &Expr, b: &Expr, at: Location) -> Expr {
    match (constant(a), constant(b)) {
        (Some(a), Some(b)) => lint(a.wrapping_add(b), at),
        (Some(0), None) => b.clone(),
        _ => operation(Op::Add, vec![a.clone(), b.clone()], at),
    }
}

fn least(a: Expr, b: Expr, at: Location) -> Expr {
    match (constant(&a), constant(&b)) {
        (Some(a), Some(b)) => lint(a.min(b), at),
        _ => operation(Op::Min, vec![a, b], at),
    }
}
