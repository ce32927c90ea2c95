//! What a program declares, as far as `{IF …}` asks for it.

use crate::source::Span;
use staunch_runtime::literal;

/// What is known of what a program declares.
#[derive(Clone, Copy, Debug)]
pub enum Known<'k, 's> {
    /// Not yet: parts that it decides are left out, and where it would is noted.
    Later,
    /// It is not asked for: each part is kept that it may decide.
    Never,
    All(&'k Declared<'s>),
    /// For the condition here; for the others not yet.
    One(&'k Declared<'s>, Span),
}

impl<'k, 's> Known<'k, 's> {
    /// What a condition may ask for.
    pub fn at(self, condition: Span) -> Option<&'k Declared<'s>> {
        match self {
            Self::All(declared) => Some(declared),
            Self::One(declared, at) => Some(declared).filter(|_| at == condition),
            Self::Later | Self::Never => None,
        }
    }
}

/// What is asked of the declarations of a program.
#[derive(Clone, Copy, Debug)]
pub enum Question<'s> {
    /// `defined(variable: x)`, `defined(type: T)` and their like.
    Is(Subject, &'s str),
    /// `hasattribute(pou: P, 'a')`
    HasAttribute(Subject, &'s str, &'s str),
    /// `hastype(variable: x, LREAL)`
    HasType(&'s str, &'s str),
    /// `hasconstantvalue(SIZE, 4, >=)`
    HasConstantValue(&'s str, &'s str, &'s str),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    Variable,
    Type,
    Pou,
    Task,
}

/// The declarations of all files.
#[derive(Debug, Default)]
pub struct Declared<'s> {
    pub types: Vec<Declaration<'s>>,
    /// Those of a FUNCTION_BLOCK, `Valve.Open`, with its name.
    pub pous: Vec<Declaration<'s>>,
    pub tasks: Vec<&'s str>,
    pub globals: Vec<Declaration<'s>>,
    pub scopes: Vec<Scope<'s>>,
    /// Whether the library has a type, or a POU, of a name; nothing where that is not known.
    pub library: Option<fn(Subject, &str) -> Option<bool>>,
}

/// A variable, a type or a POU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declaration<'s> {
    pub name: String,
    pub attributes: Vec<&'s str>,
    /// The first word of a type: `STRING` of `STRING(80)`.
    pub ty: &'s str,
    /// Of a CONSTANT, what is written after `:=`.
    pub value: Option<&'s str>,
}

/// A POU with its variables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scope<'s> {
    pub span: Span,
    pub name: &'s str,
    pub base: Option<&'s str>,
    pub variables: Vec<Declaration<'s>>,
}

/// Names are followed no farther: those that lead back to themselves are reported later.
const FARTHEST: usize = 50;

impl<'s> Declared<'s> {
    /// Nothing, where that is not known.
    pub fn answer(&self, question: &Question<'s>, at: Span) -> Option<bool> {
        match *question {
            Question::Is(Subject::Variable, name) => Some(self.variable(simple(name)?, at).is_some()),
            Question::Is(Subject::Task, name) => Some(self.tasks.iter().any(|it| it.eq_ignore_ascii_case(name))),
            Question::Is(Subject::Type, name) => self.is_type(simple(name)?),
            Question::Is(Subject::Pou, name) => self.is_pou(name),
            Question::HasAttribute(Subject::Variable, name, attribute) => {
                Some(self.variable(simple(name)?, at).is_some_and(|it| it.has(attribute)))
            }
            Question::HasAttribute(_, name, attribute) => {
                Some(find(&self.pous, name).is_some_and(|it| it.has(attribute)))
            }
            Question::HasType(name, ty) => {
                Some(self.variable(simple(name)?, at).is_some_and(|it| self.has_type(it, ty)))
            }
            Question::HasConstantValue(name, value, operator) => {
                let (constant, value) = (self.number(simple(name)?, at, 0)?, self.number(value, at, 0)?);
                Some(compare(constant, value, operator))
            }
        }
    }

    fn is_type(&self, name: &str) -> Option<bool> {
        if find(&self.types, name).is_some() {
            return Some(true);
        }
        // Nobody says whether a FUNCTION_BLOCK counts as one.
        if find(&self.pous, name).is_some() { None } else { self.has_library(Subject::Type, name) }
    }

    fn is_pou(&self, name: &str) -> Option<bool> {
        if find(&self.pous, name).is_some() {
            return Some(true);
        }
        let Some((owner, routine)) = name.split_once('.') else { return self.has_library(Subject::Pou, name) };
        // What is not known may be a namespace.
        let scope = self.scope(owner)?;
        let inherited = scope.base.map(|base| format!("{base}.{routine}"));
        inherited.map_or(Some(false), |it| find(&self.pous, &it).map(|_| true).or_else(|| self.is_pou_of_base(&it, 0)))
    }

    fn is_pou_of_base(&self, name: &str, depth: usize) -> Option<bool> {
        let (owner, routine) = name.split_once('.')?;
        let Some(base) = self.scope(owner)?.base else { return Some(false) };
        let name = format!("{base}.{routine}");
        if depth > FARTHEST || find(&self.pous, &name).is_some() {
            return Some(depth <= FARTHEST);
        }
        self.is_pou_of_base(&name, depth + 1)
    }

    fn has_library(&self, subject: Subject, name: &str) -> Option<bool> {
        self.library.map_or(Some(false), |has| has(subject, name))
    }

    fn scope(&self, name: &str) -> Option<&Scope<'s>> {
        self.scopes.iter().find(|it| it.name.eq_ignore_ascii_case(name))
    }

    /// A variable that is seen at a place: of a METHOD, of its class and what that EXTENDS, a global one.
    fn variable(&self, name: &str, at: Span) -> Option<&Declaration<'s>> {
        let is_around = |it: &&Scope<'_>| it.span.file == at.file && it.span.start <= at.start && at.end <= it.span.end;
        // What is inside of another one comes after it.
        let around: Vec<_> = self.scopes.iter().filter(is_around).collect();
        around.iter().rev().find_map(|it| self.variable_of(it, name, 0)).or_else(|| find(&self.globals, name))
    }

    fn variable_of<'d>(&'d self, scope: &'d Scope<'s>, name: &str, depth: usize) -> Option<&'d Declaration<'s>> {
        let own = find(&scope.variables, name);
        let base = scope.base.filter(|_| depth < FARTHEST);
        own.or_else(|| self.variable_of(self.scope(base?)?, name, depth + 1))
    }

    fn has_type(&self, variable: &Declaration<'s>, ty: &str) -> bool {
        let mut is = variable.ty;
        for _ in 0..FARTHEST {
            if is.eq_ignore_ascii_case(ty) {
                return true;
            }
            let Some(other) = find(&self.types, is) else { return false };
            is = other.ty;
        }
        false
    }

    /// The value of a literal, or of a CONSTANT whose value is one.
    fn number(&self, text: &str, at: Span, depth: usize) -> Option<Number> {
        let text = text.trim();
        if let Some(number) = number(text) {
            return Some(number);
        }
        let is_name = text.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_') && depth < FARTHEST;
        let constant = self.variable(text, at).filter(|_| is_name)?;
        self.number(constant.value?, at, depth + 1)
    }
}

impl Declaration<'_> {
    fn has(&self, attribute: &str) -> bool {
        self.attributes.iter().any(|it| it.eq_ignore_ascii_case(attribute))
    }
}

fn find<'d, 's>(all: &'d [Declaration<'s>], name: &str) -> Option<&'d Declaration<'s>> {
    all.iter().find(|it| it.name.eq_ignore_ascii_case(name))
}

/// A name without dots: what another one is a part of is not looked at.
fn simple(name: &str) -> Option<&str> {
    (!name.contains('.')).then_some(name)
}

#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Number {
    Whole(i128),
    Real(f64),
}

fn number(text: &str) -> Option<Number> {
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |it| (-1, it.trim_start()));
    if digits.eq_ignore_ascii_case("TRUE") || digits.eq_ignore_ascii_case("FALSE") {
        return Some(Number::Whole(i128::from(digits.eq_ignore_ascii_case("TRUE"))));
    }
    // `INT#5`
    let is_type = |it: &str| it.starts_with(|it: char| it.is_ascii_alphabetic());
    let digits = digits.split_once('#').filter(|it| is_type(it.0)).map_or(digits, |it| it.1);
    if let Ok(whole) = literal::integer(digits) {
        return Some(Number::Whole(sign * i128::from(whole)));
    }
    literal::check_real(digits).ok().filter(|()| !is_type(digits))?;
    let real: f64 = digits.replace('_', "").parse().ok()?;
    Some(Number::Real(if sign < 0 { -real } else { real }))
}

fn compare(a: Number, b: Number, operator: &str) -> bool {
    let order = match (a, b) {
        (Number::Whole(a), Number::Whole(b)) => Some(a.cmp(&b)),
        (a, b) => a.as_real().partial_cmp(&b.as_real()),
    };
    let Some(order) = order else { return false };
    match operator {
        "<" => order.is_lt(),
        "<=" => order.is_le(),
        "=" => order.is_eq(),
        "<>" => order.is_ne(),
        ">=" => order.is_ge(),
        _ => order.is_gt(),
    }
}

impl Number {
    fn as_real(self) -> f64 {
        match self {
            // A constant of a program is far within what a real holds.
            Self::Whole(it) => it.to_string().parse().unwrap_or(f64::NAN),
            Self::Real(it) => it,
        }
    }
}
