//! What a plant's inputs are said never to do: a file of lines as `Target 1..500`,
//! `not (Start and Stop)`, `Part for at least 3 scans` and `no run`.

use super::choice::{Choice, Covered};
use crate::compare::pair::{Input, Pair};
use crate::compare::program::facts::Numbers;
use crate::machine;
use staunch_host::{Event, Map};
use staunch_ir::{Chars, Repr, Value};
use std::cmp::Ordering;
use std::collections::HashSet;
use std::path::Path;

#[derive(Clone, Debug, Default)]
pub struct Assumptions {
    /// Inputs, by their position, and the values that they take.
    ranges: Vec<(usize, Value, Value)>,
    conditions: Vec<Condition>,
    /// Inputs, and scans for which a value stays at least.
    holds: Vec<(usize, u8)>,
    /// Events that do not happen.
    pub never: Vec<Event>,
    /// The lines, as they are written.
    pub lines: Vec<String>,
}

/// An input as the lines name it, and how its values are written.
struct Named<'a> {
    name: String,
    /// With its NAMESPACE or list, of a global variable.
    full: Option<String>,
    subrange: Option<(i128, i128)>,
    /// It has no order.
    is_text: bool,
    value: Spelling<'a>,
}

/// The value that a text is of an input's type.
type Spelling<'a> = Box<dyn Fn(&str) -> Result<Value, String> + 'a>;

impl<'a> Named<'a> {
    fn of(pair: &Pair, map: &'a Map, input: &Input) -> Self {
        let name = pair.path(input.scalars).to_owned();
        let (path, repr) = (name.clone(), input.initial.repr());
        let running: Vec<usize> = (0..map.instances.len()).collect();
        let texts: Vec<String> = input.texts.iter().take(input.named).map(Chars::to_string).collect();
        let is_text = !texts.is_empty();
        let value = move |text: &str| {
            if is_text {
                return position(&texts, text);
            }
            let place = staunch_host::place_of(map, &running, &path)?;
            Ok(Value::read(repr, &staunch_host::bytes_of(map, place, text)?))
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
        format!("it is not tried with {literal}, but with what the programs compare it with: {}", shown.join(", "))
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

#[derive(Clone, Debug)]
enum Condition {
    Is(usize),
    Compare(usize, Relation, Value),
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

/// The names of variables that the lines speak of.
#[derive(Debug, Default)]
pub struct Mentioned(HashSet<String>);

impl Mentioned {
    pub fn read(path: &Path) -> Result<Self, String> {
        let tokens = text(path)?.lines().filter_map(|it| tokens(uncommented(it)).ok()).flatten().collect::<Vec<_>>();
        Ok(Self(tokens.into_iter().map(|it| it.to_lowercase()).collect()))
    }

    pub fn has(&self, path: &str) -> bool {
        self.0.contains(&path.to_lowercase())
    }
}

fn text(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|it| format!("cannot read {}: {it}", path.display()))
}

/// A line without its remark: `T#5s` is a value.
fn uncommented(line: &str) -> &str {
    let is_remark = |at: &usize| !line[..*at].ends_with(|it: char| it.is_alphanumeric());
    let remark = line.match_indices('#').map(|it| it.0).find(is_remark);
    line[..remark.unwrap_or(line.len())].trim()
}

impl Assumptions {
    pub fn read(path: &Path, pair: &Pair) -> Result<Self, String> {
        let text = text(path)?;
        let map = machine::map(&pair.sides[0].program)?;
        let inputs: Vec<_> = pair.inputs.iter().map(|it| Named::of(pair, &map, it)).collect();
        let found = Self::parse(&text, &inputs);
        found.map_err(|(line, text)| format!("{}:{line}: {text}", path.display()))
    }

    /// With the number of the line that is wrong.
    fn parse(text: &str, inputs: &[Named<'_>]) -> Result<Self, (usize, String)> {
        let mut found = Self::default();
        for (number, line) in text.lines().enumerate() {
            let line = uncommented(line);
            if !line.is_empty() {
                found.line(line, inputs).map_err(|it| (number + 1, it))?;
                found.lines.push(line.to_owned());
            }
        }
        Ok(found)
    }

    fn line(&mut self, line: &str, inputs: &[Named<'_>]) -> Result<(), String> {
        let tokens = tokens(line)?;
        let mut parser = Parser { tokens: &tokens, inputs };
        let words: Vec<&str> = tokens.iter().map(String::as_str).collect();
        match words.as_slice() {
            [no, event] if no.eq_ignore_ascii_case("no") => {
                let found = Event::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(event));
                self.never.push(found.ok_or_else(|| format!("`{event}` is no event; they are restart, run, reset"))?);
            }
            // That it is named makes it an input.
            [input, name] if input.eq_ignore_ascii_case("input") => {
                parser.input(name)?;
            }
            [name, low, "..", high] => {
                let at = parser.input(name)?;
                if inputs[at].is_text {
                    return Err(format!("`{name}` is a string, which has no range"));
                }
                let [first, last] = [low, high].map(|it| parser.limit(at, it));
                let (first, last) = (first?, last?);
                if order(first, last).is_none_or(Ordering::is_gt) {
                    return Err(format!("no value lies in {low}..{high}"));
                }
                self.ranges.push((at, first, last));
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
                        "`{rest}` is not expected here; a line is `Level 1..500`, `Level for at least 3 scans`, \
                         `input Level`, `no run` or a condition with AND, OR, NOT and comparisons"
                    ));
                }
                self.conditions.push(condition);
            }
        }
        Ok(())
    }

    /// The numbers that the lines compare an input with: values on every side of each are tried.
    pub fn near(&self, input: usize) -> Numbers {
        let mut found = Numbers::default();
        let ends = self.ranges.iter().filter(|it| it.0 == input).flat_map(|it| [it.1, it.2]);
        ends.for_each(|it| found.add(it));
        self.conditions.iter().for_each(|it| it.near(input, &mut found));
        found
    }

    /// Takes values outside of an input's range away, and tries its ends.
    pub fn narrow(&self, input: usize, choice: &mut Choice, repr: Repr) {
        for (_, low, high) in self.ranges.iter().filter(|it| it.0 == input) {
            let (more, whole) = within(*low, *high, repr);
            // Of what has few values, as an enumeration, all are there.
            let more = if choice.covered == Some(Covered::All) { Vec::new() } else { more };
            for value in more {
                if !choice.values.contains(&value) {
                    choice.values.push(value);
                }
            }
            choice.values.retain(|it| is_within(*it, *low, *high));
            choice.range = low.as_integer().zip(high.as_integer()).or(choice.range);
            if whole {
                choice.covered = Some(Covered::All);
            }
        }
    }

    /// Whether the inputs may have these values at once.
    pub fn allow(&self, inputs: &[Value]) -> bool {
        self.ranges.iter().all(|(at, low, high)| is_within(inputs[*at], *low, *high))
            && self.conditions.iter().all(|it| it.holds(inputs))
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
                let ordering = order(inputs[*at], *limit);
                match relation {
                    Relation::Lt => ordering.is_some_and(Ordering::is_lt),
                    Relation::Le => ordering.is_some_and(Ordering::is_le),
                    Relation::Gt => ordering.is_some_and(Ordering::is_gt),
                    Relation::Ge => ordering.is_some_and(Ordering::is_ge),
                    Relation::Eq => ordering.is_some_and(Ordering::is_eq),
                    Relation::Ne => ordering.is_none_or(Ordering::is_ne),
                }
            }
            Self::Not(inner) => !inner.holds(inputs),
            Self::And(a, b) => a.holds(inputs) && b.holds(inputs),
            Self::Or(a, b) => a.holds(inputs) || b.holds(inputs),
        }
    }

    fn near(&self, input: usize, found: &mut Numbers) {
        match self {
            Self::Compare(at, _, limit) if *at == input => found.add(*limit),
            Self::Is(_) | Self::Compare(..) => {}
            Self::Not(inner) => inner.near(input, found),
            Self::And(a, b) | Self::Or(a, b) => [a, b].into_iter().for_each(|it| it.near(input, found)),
        }
    }
}

/// Two values of one type; a NaN is in no order.
fn order(a: Value, b: Value) -> Option<Ordering> {
    match (a, b) {
        (Value::F32(a), Value::F32(b)) => a.partial_cmp(&b),
        (Value::F64(a), Value::F64(b)) => a.partial_cmp(&b),
        (Value::Bool(a), Value::Bool(b)) => Some(a.cmp(&b)),
        _ => Some(a.as_integer()?.cmp(&b.as_integer()?)),
    }
}

fn is_within(value: Value, low: Value, high: Value) -> bool {
    order(low, value).is_some_and(Ordering::is_le) && order(value, high).is_some_and(Ordering::is_le)
}

/// Values to try of a range, and whether they are all of it.
fn within(low: Value, high: Value, repr: Repr) -> (Vec<Value>, bool) {
    let (Some(first), Some(last)) = (low.as_integer(), high.as_integer()) else { return (vec![low, high], false) };
    let whole = last - first < 300;
    let numbers = if whole { (first..=last).collect() } else { vec![first, first + 1, last - 1, last] };
    (numbers.into_iter().filter_map(|it| repr.integer(it)).collect(), whole)
}

struct Parser<'t> {
    tokens: &'t [String],
    inputs: &'t [Named<'t>],
}

impl Parser<'_> {
    fn input(&self, name: &str) -> Result<usize, String> {
        let is_it = |it: &Named<'_>| it.name.eq_ignore_ascii_case(name) || it.is_in_full(name);
        let found = self.inputs.iter().position(is_it);
        found.ok_or_else(|| match self.inputs {
            [] => format!("`{name}` is no input: the program has none"),
            inputs => {
                let names: Vec<_> = inputs.iter().map(|it| it.name.as_str()).collect();
                format!("`{name}` is no input; they are {}", names.join(", "))
            }
        })
    }

    /// A value of an input.
    fn limit(&self, input: usize, text: &str) -> Result<Value, String> {
        let Named { name, subrange, value, .. } = &self.inputs[input];
        let inside = |limit: &Value| {
            let number = limit.as_integer();
            number.is_none_or(|it| subrange.is_none_or(|(low, high)| (low..=high).contains(&it)))
        };
        let limit = value(text).map_err(|it| format!("{name}: {it}"))?;
        match subrange {
            Some((low, high)) if !inside(&limit) => {
                Err(format!("`{name}` is declared as {low}..{high}, and {text} is not within that"))
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
        let is_text = self.inputs[at].is_text;
        let Some((_, relation)) = relations.iter().find(|it| self.word(it.0)) else { return Ok(Condition::Is(at)) };
        let Some((value, rest)) = self.tokens.split_first() else {
            return Err("a value is missing at the end".to_owned());
        };
        if is_text && !matches!(relation, Relation::Eq | Relation::Ne) {
            return Err(format!("`{name}` is a string: it is compared by `=` and `<>`"));
        }
        let limit = self.limit(at, value)?;
        self.tokens = rest;
        Ok(Condition::Compare(at, *relation, limit))
    }
}

/// Names as `s[3].part`, values as `-5`, `0.5`, `T#1m30s` and `Mode#Auto` are one token each, and so are `..` and each
/// operator.
fn tokens(line: &str) -> Result<Vec<String>, String> {
    let mut found: Vec<String> = Vec::new();
    let mut rest = line.trim_start();
    while let Some(first) = rest.chars().next() {
        let operator = ["..", "<=", ">=", "<>", "<", ">", "=", "(", ")"].iter().find(|it| rest.starts_with(**it));
        let length = if let Some(it) = operator {
            it.len()
        } else if matches!(first, '\'' | '"') {
            rest[1..]
                .find(first)
                .map(|it| it + 2)
                .ok_or_else(|| format!("a {first} that closes the text is missing"))?
        } else if first.is_alphanumeric() || matches!(first, '_' | '%' | '-') {
            word(rest)
        } else {
            return Err(format!("`{first}` is not expected"));
        };
        found.push(rest[..length].to_owned());
        rest = rest[length..].trim_start();
    }
    Ok(found)
}

/// The bytes of the name or value that a text begins with: it ends before `..`.
fn word(text: &str) -> usize {
    let is_number = text.starts_with(|it: char| it.is_ascii_digit() || it == '-');
    let mut is_typed = false;
    let mut before = ' ';
    for (at, it) in text.char_indices() {
        is_typed |= it == '#';
        let belongs = it.is_alphanumeric()
            || matches!(it, '_' | '%' | '#')
            || it == '.' && !text[at..].starts_with("..")
            || matches!(it, '[' | ']' | ',') && !is_number
            // `-5`, `1e-3`, `T#-5s`, `DT#2024-01-31-12:30:00`
            || it == '-' && (at == 0 || is_typed || is_number && matches!(before, 'e' | 'E'))
            || it == ':' && is_typed;
        if !belongs {
            return at;
        }
        before = it;
    }
    text.len()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn parsed(text: &str) -> Result<Assumptions, (usize, String)> {
        fn wrong(it: &str) -> String {
            format!("`{it}` is no value")
        }
        let truth = |it: &str| it.parse().map(Value::Bool).map_err(|_| wrong(it));
        let count = |it: &str| it.parse().map(Value::I16).map_err(|_| wrong(it));
        let level = |it: &str| it.parse().map(Value::F32).map_err(|_| wrong(it));
        let named = |name: &str, subrange, value: Spelling<'static>| Named {
            name: name.to_owned(),
            full: None,
            subrange,
            is_text: false,
            value,
        };
        let inputs = [
            named("Start", None, Box::new(truth)),
            named("Stop", None, Box::new(truth)),
            named("Target", Some((-10, 900)), Box::new(count)),
            named("Level", None, Box::new(level)),
        ];
        Assumptions::parse(text, &inputs)
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
        let mut choice = Choice { values: [0, 7, 501].map(Value::I16).to_vec(), covered: None, range: None };
        found.narrow(2, &mut choice, Repr::I16);
        assert_eq!(choice.values, [7, 1, 2, 499, 500].map(Value::I16));
        assert_eq!(choice.covered, None);
    }

    #[test]
    fn what_the_lines_compare_with_is_tried() {
        let found = parsed("Target > 40 and not (Target = 43)\nLevel 0.5..2.5").unwrap();
        assert_eq!(found.near(2).integers.into_iter().collect::<Vec<_>>(), [40, 43]);
        assert_eq!(found.near(3).reals, [0.5, 2.5]);
        let mut choice = Choice { values: [0.0, 1.0, 3.0].map(Value::F32).to_vec(), covered: None, range: None };
        found.narrow(3, &mut choice, Repr::F32);
        assert_eq!(choice.values, [1.0, 0.5, 2.5].map(Value::F32));
        let inputs = |level: f32| [Value::Bool(false), Value::Bool(false), Value::I16(50), Value::F32(level)];
        assert!(found.allow(&inputs(2.5)) && !found.allow(&inputs(2.6)) && !found.allow(&inputs(f32::NAN)));
    }

    #[test]
    fn a_remark_is_no_value() {
        assert_eq!(uncommented(" Wait T#1s..T#5s  # the panel's"), "Wait T#1s..T#5s");
        assert_eq!(uncommented("# all"), "");
        assert_eq!(uncommented("Start # T#5s"), "Start");
    }

    #[test]
    fn values_are_one_token() {
        let line = "a T#-1m30s..T#2.5s DT#2024-01-31-12:30:00 Mode#Auto 16#FF -5..1e-3 s[1,2].x";
        let found =
            ["a", "T#-1m30s", "..", "T#2.5s", "DT#2024-01-31-12:30:00", "Mode#Auto", "16#FF", "-5", "..", "1e-3"];
        let expected: Vec<_> = found.into_iter().chain(["s[1,2].x"]).collect();
        assert_eq!(tokens(line).unwrap(), expected);
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
        assert!(parsed("Target -10..900").is_ok());
        let (line, text) = parsed("no run\nTarget 5..901").unwrap_err();
        assert_eq!((line, text.as_str()), (2, "`Target` is declared as -10..900, and 901 is not within that"));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let wrong = |text: &str| parsed(text).unwrap_err();
        assert_eq!(
            wrong("Start\nMotor 1..3"),
            (2, "`Motor` is no input; they are Start, Stop, Target, Level".to_owned())
        );
        assert_eq!(wrong("Target 5..1").1, "no value lies in 5..1");
        assert_eq!(wrong("Start for at least 0 scans").1, "`0` is no number of scans from 1 to 255");
        assert!(wrong("Start Stop").1.starts_with("`Stop` is not expected here; a line is "));
        assert_eq!(wrong("not (Start").1, "a `)` is missing");
        assert_eq!(wrong("Target > x").1, "Target: `x` is no value");
        assert_eq!(wrong("Target 0.5..2").1, "Target: `0.5` is no value");
        assert_eq!(wrong("Start ! Stop").1, "`!` is not expected");
    }
}
