//! What a plant's inputs are said never to do: a file of lines as `Target 1..500`,
//! `not (Start and Stop)`, `Part for at least 3 scans` and `no run`.

mod condition;

mod parser;
mod tokens;

use super::choice::{Choice, Covered};
use crate::pair::Pair;
use crate::program::facts::Numbers;
use condition::{Condition, is_within, order};
use parser::{Named, Parser};
use staunch_host::Event;
use staunch_ir::{Repr, Value};
use std::cmp::Ordering;
use std::collections::HashSet;
use std::path::Path;
use tokens::{tokens, uncommented};

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

/// The names of variables that the lines speak of.
#[derive(Debug, Default)]
pub struct Mentioned(HashSet<String>);

impl Mentioned {
    pub fn of(text: &str) -> Self {
        let lines = text.lines().filter_map(|it| tokens(uncommented(it)).ok());
        // In `no run` it is an event, whatever variable has that name.
        let of_variables = lines.filter(|it| event(it).is_none());
        Self(of_variables.flatten().map(|it| it.to_lowercase()).collect())
    }

    pub fn has(&self, path: &str) -> bool {
        self.0.contains(&path.to_lowercase())
    }
}

/// The name of the event that does not happen, by `no run`.
fn event(tokens: &[String]) -> Option<&str> {
    match tokens {
        [no, event] if no.eq_ignore_ascii_case("no") => Some(event),
        _ => None,
    }
}

impl Assumptions {
    /// Of the text of a file.
    pub fn of(path: &Path, text: &str, pair: &Pair) -> Result<Self, String> {
        let maps = [staunch_machine::map(&pair.sides[0].program)?, staunch_machine::map(&pair.sides[1].program)?];
        let inputs: Vec<_> = pair.inputs.iter().map(|it| Named::of(pair, &maps, it)).collect();
        let found = Self::parse(text, &inputs);
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
            [_, event] if self::event(&tokens).is_some() => {
                let found = Event::ALL.into_iter().find(|it| it.name().eq_ignore_ascii_case(event));
                self.never
                    .push(found.ok_or_else(|| format!("`{event}` is not an event; expected restart, run or reset"))?);
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
                    return Err(format!("no value is in {low}..{high}"));
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
                let count = count.ok_or_else(|| format!("`{}` is not a number of scans from 1 to 255", words[4]))?;
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

/// Values to try of a range, and whether they are all of it.
fn within(low: Value, high: Value, repr: Repr) -> (Vec<Value>, bool) {
    let (Some(first), Some(last)) = (low.as_integer(), high.as_integer()) else { return (vec![low, high], false) };
    let whole = last - first < 300;
    let numbers = if whole { (first..=last).collect() } else { vec![first, first + 1, last - 1, last] };
    (numbers.into_iter().filter_map(|it| repr.integer(it)).collect(), whole)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::parser::Spelling;
    use super::*;

    fn parsed(text: &str) -> Result<Assumptions, (usize, String)> {
        fn wrong(it: &str) -> String {
            format!("`{it}` is not a value")
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
        let mut choice = Choice { values: [0, 7, 501].map(Value::I16).to_vec(), covered: None, range: None, step: 1 };
        found.narrow(2, &mut choice, Repr::I16);
        assert_eq!(choice.values, [7, 1, 2, 499, 500].map(Value::I16));
        assert_eq!(choice.covered, None);
    }

    #[test]
    fn what_the_lines_compare_with_is_tried() {
        let found = parsed("Target > 40 and not (Target = 43)\nLevel 0.5..2.5").unwrap();
        assert_eq!(found.near(2).integers.into_iter().collect::<Vec<_>>(), [40, 43]);
        assert_eq!(found.near(3).reals, [0.5, 2.5]);
        let mut choice =
            Choice { values: [0.0, 1.0, 3.0].map(Value::F32).to_vec(), covered: None, range: None, step: 1 };
        found.narrow(3, &mut choice, Repr::F32);
        assert_eq!(choice.values, [1.0, 0.5, 2.5].map(Value::F32));
        let inputs = |level: f32| [Value::Bool(false), Value::Bool(false), Value::I16(50), Value::F32(level)];
        assert!(found.allow(&inputs(2.5)) && !found.allow(&inputs(2.6)) && !found.allow(&inputs(f32::NAN)));
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
        assert_eq!((line, text.as_str()), (2, "`Target` is declared as -10..900, but 901 is not in that range"));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let wrong = |text: &str| parsed(text).unwrap_err();
        assert_eq!(
            wrong("Start\nMotor 1..3"),
            (2, "`Motor` is not an input; the inputs are Start, Stop, Target, Level".to_owned())
        );
        assert_eq!(wrong("Target 5..1").1, "no value is in 5..1");
        assert_eq!(wrong("Start for at least 0 scans").1, "`0` is not a number of scans from 1 to 255");
        assert!(wrong("Start Stop").1.starts_with("`Stop` is not expected here; a line is "));
        assert_eq!(wrong("not (Start").1, "a `)` is missing");
        assert_eq!(wrong("Target > x").1, "Target: `x` is not a value");
        assert_eq!(wrong("Target > level").1, "`level` is also an input, but `Target` must be compared with a value");
        assert_eq!(wrong("Target 0.5..2").1, "Target: `0.5` is not a value");
        assert_eq!(wrong("Start ! Stop").1, "`!` is not expected");
    }
}
