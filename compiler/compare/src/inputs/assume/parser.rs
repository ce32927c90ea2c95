//! A line's names, values and conditions.

use super::condition::{Condition, Relation};
use crate::pair::{Input, Pair};
use staunch_host::Map;
use staunch_ir::{Chars, Value};

/// An input as the lines name it, and how its values are written.
pub struct Named<'a> {
    pub name: String,
    /// With its NAMESPACE or list, of a global variable.
    pub full: Option<String>,
    pub subrange: Option<(i128, i128)>,
    /// It has no order.
    pub is_text: bool,
    pub value: Spelling<'a>,
}

/// The value that a text is of an input's type.
pub type Spelling<'a> = Box<dyn Fn(&str) -> Result<Value, String> + 'a>;

impl<'a> Named<'a> {
    pub fn of(pair: &Pair, maps: &'a [Map; 2], input: &Input) -> Self {
        let name = pair.path(input.scalars).to_owned();
        let repr = input.initial.repr();
        let sides = [0, 1].map(|side| {
            let path = pair.scalar(side, input.scalars[side]).path.clone();
            (pair.sides[side].dialect.name(), &maps[side], path)
        });
        let texts: Vec<String> = input.texts.iter().take(input.named).map(Chars::to_string).collect();
        let is_text = !texts.is_empty();
        let value = move |text: &str| {
            if is_text {
                return position(&texts, text);
            }
            // Either system has the value.
            let [a, b] = sides.each_ref().map(|(dialect, map, path)| {
                let running: Vec<usize> = (0..map.instances.len()).collect();
                let bytes = staunch_host::place_of(map, &running, path)
                    .and_then(|place| staunch_host::bytes_of(map, place, text));
                bytes.map_err(|it| format!("under --dialect {dialect}: {it}"))
            });
            b?;
            Ok(Value::read(repr, &a?))
        };
        let full = pair.scalar(0, input.scalars[0]).full_name(&pair.sides[0].program);
        Self { full, name, is_text, subrange: subrange(pair, input.scalars), value: Box::new(value) }
    }
}

impl Named<'_> {
    fn is_in_full(&self, name: &str) -> bool {
        self.full.as_ref().is_some_and(|it| it.eq_ignore_ascii_case(name))
    }
}

/// Which of the texts that a string is tried with a literal is.
fn position(texts: &[String], literal: &str) -> Result<Value, String> {
    let found = texts.iter().position(|it| it == literal).and_then(|it| u16::try_from(it).ok());
    found.map(Value::U16).ok_or_else(|| {
        let shown: Vec<_> = texts.iter().filter(|it| it.len() < SHOWN).map(String::as_str).collect();
        format!(
            "the search does not try {literal}, but only the values that the programs compare it with: {}",
            shown.join(", ")
        )
    })
}

/// Characters of a text that a message shows.
const SHOWN: usize = 40;

/// The limits of an input's subrange; where the two systems' differ, what is in both.
fn subrange(pair: &Pair, scalars: [usize; 2]) -> Option<(i128, i128)> {
    let both = [0, 1].map(|side| pair.sides[side].program.range(pair.scalar(side, scalars[side]).ty));
    let limits = both.into_iter().flatten();
    limits.reduce(|all, it| (all.0.max(it.0), all.1.min(it.1)))
}

pub struct Parser<'t> {
    pub tokens: &'t [String],
    pub inputs: &'t [Named<'t>],
}

impl Parser<'_> {
    pub fn input(&self, name: &str) -> Result<usize, String> {
        let is_it = |it: &Named<'_>| it.name.eq_ignore_ascii_case(name) || it.is_in_full(name);
        let found = self.inputs.iter().position(is_it);
        found.ok_or_else(|| match self.inputs {
            [] => format!("`{name}` is not an input: the program has none"),
            inputs => {
                let names: Vec<_> = inputs.iter().map(|it| it.name.as_str()).collect();
                format!("`{name}` is not an input; the inputs are {}", names.join(", "))
            }
        })
    }

    /// A value of an input.
    pub fn limit(&self, input: usize, text: &str) -> Result<Value, String> {
        let Named { name, subrange, value, .. } = &self.inputs[input];
        let inside = |limit: &Value| {
            let number = limit.as_integer();
            number.is_none_or(|it| subrange.is_none_or(|(low, high)| (low..=high).contains(&it)))
        };
        let limit = value(text).map_err(|it| format!("{name}: {it}"))?;
        match subrange {
            Some((low, high)) if !inside(&limit) => {
                Err(format!("`{name}` is declared as {low}..{high}, but {text} is not in that range"))
            }
            Some(_) | None => Ok(limit),
        }
    }

    fn word(&mut self, word: &str) -> bool {
        let is = self.tokens.first().is_some_and(|it| it.eq_ignore_ascii_case(word));
        if is {
            self.tokens = &self.tokens[1..];
        }
        is
    }

    pub fn either(&mut self) -> Result<Condition, String> {
        let mut left = self.both()?;
        while self.word("or") {
            left = Condition::Or(Box::new(left), Box::new(self.both()?));
        }
        Ok(left)
    }

    fn both(&mut self) -> Result<Condition, String> {
        let mut left = self.one()?;
        while self.word("and") {
            left = Condition::And(Box::new(left), Box::new(self.one()?));
        }
        Ok(left)
    }

    fn one(&mut self) -> Result<Condition, String> {
        if self.word("not") {
            return Ok(Condition::Not(Box::new(self.one()?)));
        }
        if self.word("(") {
            let inner = self.either()?;
            return if self.word(")") { Ok(inner) } else { Err("a `)` is missing".to_owned()) };
        }
        let Some((name, rest)) = self.tokens.split_first() else {
            return Err("an input is missing at the end".to_owned());
        };
        let at = self.input(name)?;
        self.tokens = rest;
        let relations = [
            ("<", Relation::Lt),
            ("<=", Relation::Le),
            (">", Relation::Gt),
            (">=", Relation::Ge),
            ("=", Relation::Eq),
            ("<>", Relation::Ne),
        ];
        let is_text = self.inputs[at].is_text;
        let Some((_, relation)) = relations.iter().find(|it| self.word(it.0)) else { return Ok(Condition::Is(at)) };
        let Some((value, rest)) = self.tokens.split_first() else {
            return Err("a value is missing at the end".to_owned());
        };
        if is_text && !matches!(relation, Relation::Eq | Relation::Ne) {
            return Err(format!("`{name}` is a string: compare it with `=` or `<>`"));
        }
        let limit = self.limit(at, value).map_err(|error| match self.input(value) {
            Ok(_) => format!("`{value}` is also an input, but `{name}` must be compared with a value"),
            Err(_) => error,
        })?;
        self.tokens = rest;
        Ok(Condition::Compare(at, *relation, limit))
    }
}
