//! What a plant's inputs are said never to do: a file of lines as `Target 1..500`,
//! `not (Start and Stop)`, `Part for at least 3 scans` and `no run`.

use super::alphabet::{Choice, Covered};
use super::pair::Pair;
use staunch_host::Event;
use staunch_ir::{Repr, Value};
use std::path::Path;

#[derive(Clone, Debug, Default)]
pub struct Assumptions {
    /// Inputs, by their position, and the values that they take.
    ranges: Vec<(usize, i128, i128)>,
    conditions: Vec<Condition>,
    /// Inputs, and scans for which a value stays at least.
    holds: Vec<(usize, u8)>,
    /// Events that do not happen.
    pub never: Vec<Event>,
    /// The lines, as they are written.
    pub lines: Vec<String>,
}

/// The limits of an input's subrange; where the two systems' differ, what is in both.
fn subrange(pair: &Pair, scalars: [usize; 2]) -> Option<(i128, i128)> {
    let both = [0, 1].map(|side| pair.sides[side].program.range(pair.scalar(side, scalars[side]).ty));
    let limits = both.into_iter().flatten();
    limits.reduce(|all, it| (all.0.max(it.0), all.1.min(it.1)))
}

#[derive(Clone, Debug)]
enum Condition {
    Is(usize),
    Compare(usize, Relation, f64),
    Not(Box<Condition>),
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
}

#[derive(Clone, Copy, Debug)]
enum Relation {
    Lt,
    Le,
    Gt,
    Ge,
    Eq,
    Ne,
}

impl Assumptions {
    pub fn read(path: &Path, pair: &Pair) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|it| format!("cannot read {}: {it}", path.display()))?;
        let names: Vec<String> = pair.inputs.iter().map(|it| pair.path(it.scalars).to_owned()).collect();
        let subranges: Vec<_> = pair.inputs.iter().map(|it| subrange(pair, it.scalars)).collect();
        let found = Self::parse(&text, &names, &subranges);
        found.map_err(|(line, text)| format!("{}:{line}: {text}", path.display()))
    }

    /// With the number of the line that is wrong.
    fn parse(text: &str, names: &[String], subranges: &[Option<(i128, i128)>]) -> Result<Self, (usize, String)> {
        let mut found = Self::default();
        for (number, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if !line.is_empty() {
                found.line(line, names).map_err(|it| (number + 1, it))?;
                found.fits(names, subranges).map_err(|it| (number + 1, it))?;
                found.lines.push(line.to_owned());
            }
        }
        Ok(found)
    }

    fn line(&mut self, line: &str, names: &[String]) -> Result<(), String> {
        let tokens = tokens(line)?;
        let mut parser = Parser { tokens: &tokens, names };
        let words: Vec<&str> = tokens.iter().map(String::as_str).collect();
        match words.as_slice() {
            [no, event] if no.eq_ignore_ascii_case("no") => {
                let found = Event::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(event));
                self.never.push(found.ok_or_else(|| format!("`{event}` is no event; they are restart, run, reset"))?);
            }
            [name, low, "..", high] => {
                let bound = |it: &str| it.parse::<i128>().map_err(|_| format!("`{it}` is no whole number"));
                let (low, high) = (bound(low)?, bound(high)?);
                if low > high {
                    return Err(format!("no value lies in {low}..{high}"));
                }
                self.ranges.push((parser.input(name)?, low, high));
            }
            [name, f, at, least, count, scans]
                if [f, at, least]
                    .iter()
                    .zip(["for", "at", "least"])
                    .all(|(it, word)| it.eq_ignore_ascii_case(word))
                    && ["scan", "scans"].iter().any(|it| it.eq_ignore_ascii_case(scans)) =>
            {
                let count = count.parse::<u8>().ok().filter(|it| *it > 0);
                let count = count.ok_or_else(|| format!("`{}` is no number of scans from 1 to 255", words[4]))?;
                self.holds.push((parser.input(name)?, count));
            }
            _ => {
                let condition = parser.either()?;
                if let Some(rest) = parser.tokens.first() {
                    return Err(format!(
                        "`{rest}` is not expected here; a line is `Input 1..500`, `Input for at least 3 scans`, \
                         `no run` or a condition with AND, OR, NOT and comparisons"
                    ));
                }
                self.conditions.push(condition);
            }
        }
        Ok(())
    }

    /// The last range lies within the values that the input's type has.
    fn fits(&self, names: &[String], subranges: &[Option<(i128, i128)>]) -> Result<(), String> {
        let Some((input, low, high)) = self.ranges.last() else { return Ok(()) };
        match subranges.get(*input).copied().flatten() {
            Some((least, most)) if *low < least || *high > most => {
                Err(format!("`{}` is declared as {least}..{most}, and {low}..{high} is not within that", names[*input]))
            }
            Some(_) | None => Ok(()),
        }
    }

    /// Takes values outside of an input's range away, and tries its ends.
    pub fn narrow(&self, input: usize, choice: &mut Choice, repr: Repr) {
        for (_, low, high) in self.ranges.iter().filter(|it| it.0 == input) {
            let whole = high - low < 300;
            let inside = |it: i128| (*low..=*high).contains(&it);
            let more = if whole { (*low..=*high).collect() } else { vec![*low, low + 1, high - 1, *high] };
            for value in more.into_iter().filter_map(|it| repr.integer(it)) {
                if !choice.values.contains(&value) {
                    choice.values.push(value);
                }
            }
            choice.values.retain(|it| it.as_integer().is_none_or(inside));
            if whole && repr.is_integer() {
                choice.covered = Some(Covered::All);
            }
        }
    }

    /// Whether the inputs may have these values at once.
    pub fn allow(&self, inputs: &[Value]) -> bool {
        let inside = |(at, low, high): &(usize, i128, i128)| {
            inputs[*at].as_integer().is_none_or(|it| (*low..=*high).contains(&it))
        };
        self.ranges.iter().all(inside) && self.conditions.iter().all(|it| it.holds(inputs))
    }

    /// Ages of the inputs that have to stay: at the start, each has been as it is for long.
    pub fn ages(&self) -> Vec<u8> {
        self.holds.iter().map(|it| it.1).collect()
    }

    /// The ages after one more scan; `None` where an input changes too soon.
    pub fn age(&self, ages: &[u8], before: &[Value], now: &[Value]) -> Option<Vec<u8>> {
        let age = |((input, least), age): (&(usize, u8), &u8)| match before[*input] == now[*input] {
            true => Some(age.saturating_add(1).min(*least)),
            false => (age >= least).then_some(1),
        };
        self.holds.iter().zip(ages).map(age).collect()
    }
}

impl Condition {
    fn holds(&self, inputs: &[Value]) -> bool {
        match self {
            Self::Is(at) => inputs[*at] == Value::Bool(true),
            Self::Compare(at, relation, limit) => {
                let value = match inputs[*at] {
                    Value::F32(it) => f64::from(it),
                    Value::F64(it) => it,
                    other => other.as_integer().and_then(|it| it.to_string().parse().ok()).unwrap_or(0.0),
                };
                match relation {
                    Relation::Lt => value < *limit,
                    Relation::Le => value <= *limit,
                    Relation::Gt => value > *limit,
                    Relation::Ge => value >= *limit,
                    Relation::Eq => value == *limit,
                    Relation::Ne => value != *limit,
                }
            }
            Self::Not(inner) => !inner.holds(inputs),
            Self::And(a, b) => a.holds(inputs) && b.holds(inputs),
            Self::Or(a, b) => a.holds(inputs) || b.holds(inputs),
        }
    }
}

struct Parser<'t> {
    tokens: &'t [String],
    names: &'t [String],
}

impl Parser<'_> {
    fn input(&self, name: &str) -> Result<usize, String> {
        let found = self.names.iter().position(|it| it.eq_ignore_ascii_case(name));
        found.ok_or_else(|| match self.names {
            [] => format!("`{name}` is no input: the program has none"),
            names => format!("`{name}` is no input; they are {}", names.join(", ")),
        })
    }

    fn word(&mut self, word: &str) -> bool {
        let is = self.tokens.first().is_some_and(|it| it.eq_ignore_ascii_case(word));
        if is {
            self.tokens = &self.tokens[1..];
        }
        is
    }

    fn either(&mut self) -> Result<Condition, String> {
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
        let Some((_, relation)) = relations.iter().find(|it| self.word(it.0)) else { return Ok(Condition::Is(at)) };
        let Some((number, rest)) = self.tokens.split_first() else {
            return Err("a number is missing at the end".to_owned());
        };
        let limit = number.parse().map_err(|_| format!("`{number}` is no number"))?;
        self.tokens = rest;
        Ok(Condition::Compare(at, *relation, limit))
    }
}

/// Names as `s[3].part` and numbers are one token, and so are `..` and each operator.
fn tokens(line: &str) -> Result<Vec<String>, String> {
    let mut found: Vec<String> = Vec::new();
    let mut rest = line.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = if let Some(it) =
            ["..", "<=", ">=", "<>", "<", ">", "=", "(", ")"].iter().find(|it| rest.starts_with(**it))
        {
            it.len()
        } else if first.is_ascii_digit() || first == '-' {
            let digits = rest[1..].find(|it: char| !it.is_ascii_digit()).map_or(rest.len(), |it| it + 1);
            match rest[digits..].strip_prefix('.').filter(|it| it.starts_with(|it: char| it.is_ascii_digit())) {
                Some(part) => digits + 1 + part.find(|it: char| !it.is_ascii_digit()).unwrap_or(part.len()),
                None => digits,
            }
        } else if first.is_alphabetic() || matches!(first, '_' | '%') {
            let belongs = |it: char| it.is_alphanumeric() || matches!(it, '_' | '%' | '.' | '[' | ']' | ',');
            let end = rest.find(|it: char| !belongs(it)).unwrap_or(rest.len());
            rest[..end].find("..").unwrap_or(end)
        } else {
            return Err(format!("`{first}` is not expected"));
        };
        found.push(rest[..length].to_owned());
        rest = rest[length..].trim_start();
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn parsed(text: &str) -> Result<Assumptions, (usize, String)> {
        let names = ["Start".to_owned(), "Stop".to_owned(), "Target".to_owned()];
        Assumptions::parse(text, &names, &[None, None, Some((0, 900))])
    }

    fn inputs(start: bool, stop: bool, target: i16) -> Vec<Value> {
        vec![Value::Bool(start), Value::Bool(stop), Value::I16(target)]
    }

    #[test]
    fn conditions_hold_of_values() {
        let found = parsed("# the plant\nnot (start and STOP)  # never both\nTarget >= -5 or Stop\n").unwrap();
        assert!(found.allow(&inputs(true, false, 3)));
        assert!(!found.allow(&inputs(true, true, 3)));
        assert!(!found.allow(&inputs(true, false, -6)));
        assert!(found.allow(&inputs(false, true, -6)));
        assert_eq!(found.lines.len(), 2);
    }

    #[test]
    fn a_range_takes_values_away_and_tries_its_ends() {
        let found = parsed("Target 1..500").unwrap();
        let mut choice = Choice { values: [0, 7, 501].map(Value::I16).to_vec(), covered: None };
        found.narrow(2, &mut choice, Repr::I16);
        assert_eq!(choice.values, [7, 1, 2, 499, 500].map(Value::I16));
        assert_eq!(choice.covered, None);
    }

    #[test]
    fn an_input_that_has_to_stay_ages() {
        let found = parsed("Start for at least 3 scans").unwrap();
        let (low, high) = (inputs(false, false, 0), inputs(true, false, 0));
        let first = found.age(&found.ages(), &low, &high).unwrap();
        assert_eq!(first, [1]);
        assert_eq!(found.age(&first, &high, &low), None);
        let second = found.age(&first, &high, &high).unwrap();
        let third = found.age(&second, &high, &high).unwrap();
        assert_eq!(found.age(&third, &high, &low), Some(vec![1]));
    }

    #[test]
    fn a_range_lies_within_the_subrange() {
        assert!(parsed("Target 0..900").is_ok());
        let (line, text) = parsed("no run\nTarget 5..901").unwrap_err();
        assert_eq!((line, text.as_str()), (2, "`Target` is declared as 0..900, and 5..901 is not within that"));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let wrong = |text: &str| parsed(text).unwrap_err();
        assert_eq!(wrong("Start\nMotor 1..3"), (2, "`Motor` is no input; they are Start, Stop, Target".to_owned()));
        assert_eq!(wrong("Target 5..1").1, "no value lies in 5..1");
        assert_eq!(wrong("Start for at least 0 scans").1, "`0` is no number of scans from 1 to 255");
        assert!(wrong("Start Stop").1.starts_with("`Stop` is not expected here; a line is "));
        assert_eq!(wrong("not (Start").1, "a `)` is missing");
        assert_eq!(wrong("Target > x").1, "`x` is no number");
        assert_eq!(wrong("Start ! Stop").1, "`!` is not expected");
    }
}
