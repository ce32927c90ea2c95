//! `AssertEquals` of structures and arrays. TcUnit compares their bytes; here their members are compared, one by one, so that what
//! lies between members does not count.

use super::assertion::Claim;
use crate::expr::checker::Checker;
use crate::expr::operand::Operand;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{
    Chars, Conversion, Elementary, Expr, ExprKind, FieldId, For, Op, Place, StatementKind, Step, StringType, Taking,
    Type, Value,
};

/// What is noted of the first member that differs: its path.
const PATH: Type = Type::string(255);

/// What two values have so far: whether they differ, and the path of the first member that does.
struct Difference {
    found: Place,
    path: Place,
    span: Span,
}

impl<'s> Checker<'_, 's> {
    /// Whether a value is made of others.
    pub(super) fn is_made_of_others(value: &Operand) -> bool {
        matches!(value.ty(), Some(Type::Struct(_) | Type::Array(_) | Type::Block(_)))
    }

    /// Claims that two structures or arrays are equal.
    pub(super) fn equal_wholes(
        &mut self,
        values: [Operand; 2],
        both: [&ast::Expr<'s>; 2],
        span: Span,
    ) -> Option<Claim> {
        let [expected, actual] = both;
        let [a, b] = values;
        let Some(ty) = a.ty().filter(|it| b.ty() == Some(*it) && self.is_comparable(*it)) else {
            return self.refuse_wholes([a.ty(), b.ty()], actual.span);
        };
        let a = self.place_of_whole(a, expected.span)?;
        let b = self.place_of_whole(b, actual.span)?;
        let at = self.at(span);
        let difference =
            Difference { found: self.temporary("differ", Type::BOOL), path: self.temporary("path", PATH), span };
        self.assign(difference.found.clone(), Expr::bool(false, at), span);
        self.find_difference(&difference, [a, b], ty, "")?;
        let (_, path) = self.keep("expected", Expr::load(difference.path, at), span)?;
        let differs = Expr::load(difference.found, at);
        let holds = Expr::apply(Op::Not, Type::BOOL, vec![differs], at);
        Some(Claim { expected: Some(path), ..Claim::new(holds, "to be the same, {} differs") })
    }

    fn refuse_wholes<T>(&mut self, types: [Option<Type>; 2], span: Span) -> Option<T> {
        let [expected, actual] = types.map(|it| it.map_or_else(|| "a number".to_owned(), |it| self.type_name(it)));
        let error = if expected == actual {
            Diagnostic::new(Code::E0204, span, format!("`AssertEquals` does not compare {actual}"))
                .label("this holds an instance of a block, a pointer or a reference")
                .help("compare its outputs or members, each by itself")
        } else {
            Diagnostic::new(Code::E0204, span, format!("`AssertEquals` does not compare {expected} and {actual}"))
                .label(format!("expected {expected}, but this is {actual}"))
                .help("structures and arrays are compared with others of their type")
        };
        self.report(error);
        None
    }

    /// Whether it is made of values that can be compared.
    fn is_comparable(&self, ty: Type) -> bool {
        match ty {
            Type::Elementary(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) => true,
            Type::Reference(_) | Type::Block(_) => false,
            Type::Array(id) => {
                let array = self.decl.program.array(id);
                !array.is_open() && self.is_comparable(array.element)
            }
            Type::Struct(id) if self.decl.is_instance(id) => false,
            Type::Struct(id) => self.decl.program.structure(id).fields.iter().all(|it| self.is_comparable(it.ty)),
        }
    }

    /// Where the value is, whatever is evaluated after it.
    fn place_of_whole(&mut self, value: Operand, span: Span) -> Option<Place> {
        let mut value = self.materialise(value, None, span)?;
        if !matches!(value.kind, ExprKind::Load(_)) {
            self.save("compared", &mut value);
        }
        let ExprKind::Load(mut place) = value.kind else { return None };
        self.fix(&mut place);
        Some(place)
    }

    /// Compares two places of a type, whose path this is.
    fn find_difference(&mut self, to: &Difference, [a, b]: [Place; 2], ty: Type, path: &str) -> Option<()> {
        match ty {
            Type::Struct(id) => {
                let fields = &self.decl.program.structure(id).fields;
                let members: Vec<_> = fields.iter().map(|it| (it.name.clone(), it.ty)).collect();
                for (at, (name, member)) in members.into_iter().enumerate() {
                    let both = [a.clone(), b.clone()].map(|it| it.field(FieldId::next(at), member));
                    let path = if path.is_empty() { name } else { format!("{path}.{name}") };
                    self.find_difference(to, both, member, &path)?;
                }
                Some(())
            }
            Type::Array(id) => {
                let array = self.decl.program.array(id);
                let (low, high, element) = (array.low, array.high, array.element);
                let at = self.at(to.span);
                let counter = self.temporary("index", Type::LINT);
                let index = Expr::load(counter.clone(), at);
                let both = [a, b].map(|it| it.index(index.clone(), element, at));
                let mut is_whole = None;
                let body =
                    self.nested(|this| is_whole = this.find_difference(to, both, element, &format!("{path}[…]")));
                is_whole?;
                let [first, last] = [low, high].map(|it| Expr::constant(Elementary::Lint, Value::I64(it), at));
                let (step, range) = (Step::Constant(1), Elementary::Lint.repr().range()?);
                let (is_private, taking, step_at) = (true, Taking::Each, at);
                let head = For { counter, first, last, step, range, is_private, body, taking, step_at };
                let made = head.statement(at);
                self.push(made.kind, to.span);
                Some(())
            }
            Type::String(_) => {
                let [a, b] = [a, b].map(|it| Expr::load(it, staunch_ir::Location::default()));
                let differs = self.compare_texts(Op::Ne, a, b, to.span)?;
                self.note_difference(to, differs, path)
            }
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) => {
                let at = self.at(to.span);
                let values = [a, b].map(|it| Expr::load(it, at).read());
                let differs = self.apply(Op::Ne, ty.read(), values.into(), Type::BOOL, to.span)?;
                self.note_difference(to, differs, path)
            }
            Type::Reference(_) | Type::Block(_) => None,
        }
    }

    fn note_difference(&mut self, to: &Difference, differs: Expr, path: &str) -> Option<()> {
        let at = self.at(to.span);
        let text = path.as_bytes().to_vec();
        let capacity = u16::try_from(text.len()).unwrap_or(u16::MAX);
        let text =
            Expr::new(Type::String(StringType { wide: false, capacity }), ExprKind::Text(Chars::Narrow(text)), at);
        let text = self.convert(Conversion::Value, PATH, text);
        let is_first = Expr::apply(Op::Not, Type::BOOL, vec![Expr::load(to.found.clone(), at)], at);
        let condition = Expr::apply(Op::And, Type::BOOL, vec![is_first, differs], at);
        let then = self.nested(|this| {
            this.assign(to.found.clone(), Expr::bool(true, at), to.span);
            this.assign(to.path.clone(), text, to.span);
        });
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, to.span);
        Some(())
    }
}
