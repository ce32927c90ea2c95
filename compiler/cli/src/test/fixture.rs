//! A fixture of AxUnit: its tests run one after another on one instance of it, each in a scan of its own. After a fault the
//! others run on a fresh one.

use super::outcome::{Case, Outcome};
use staunch_frontend::{Fixture, Test};

/// What a scan does.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The number of the test, from 1.
    number: usize,
    is_first: bool,
    is_last: bool,
}

/// A DINT or a BOOL.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    Number(i32),
    Flag(bool),
}

impl Value {
    /// As the program has it.
    pub fn bytes(self) -> Vec<u8> {
        match self {
            Self::Number(it) => it.to_le_bytes().to_vec(),
            Self::Flag(it) => vec![u8::from(it)],
        }
    }

    /// As a stimulus has it.
    pub fn text(self) -> String {
        match self {
            Self::Number(it) => it.to_string(),
            Self::Flag(it) => it.to_string(),
        }
    }
}

impl Step {
    /// The variables that say it, and that which says what has failed.
    pub fn values(&self, test: &Test) -> Vec<(String, Value)> {
        let number = Value::Number(i32::try_from(self.number).unwrap_or(i32::MAX));
        let steps = [number, Value::Flag(self.is_first), Value::Flag(self.is_last)];
        let named = Fixture::STEPS.iter().zip(steps).map(|(it, value)| (format!("{}.{it}", test.instance), value));
        let none = (!test.failed.is_empty()).then(|| (test.failed.clone(), Value::Number(0)));
        named.chain(none).collect()
    }
}

/// Runs tests; the outcomes of all of them, or up to one that faults.
pub type Runs<'r> = dyn FnMut(&[Step]) -> Result<Vec<Outcome>, String> + 'r;

/// The tests of a fixture, as many as `wants` asks for.
pub fn cases(
    test: &Test,
    fixture: &Fixture,
    wants: &dyn Fn(&str) -> bool,
    run: &mut Runs<'_>,
) -> Result<Vec<Case>, String> {
    let titled = fixture.cases.iter().map(|it| (format!("{}{}", test.title, it.title), it.span));
    let wanted: Vec<_> = titled.zip(1..).filter(|it| wants(&it.0.0)).collect();
    let mut cases = Vec::new();
    while cases.len() < wanted.len() {
        let rest = &wanted[cases.len()..];
        let step = |(at, (_, number)): (usize, &(_, usize))| Step {
            number: *number,
            is_first: at == 0,
            is_last: at + 1 == rest.len(),
        };
        let outcomes = run(&rest.iter().enumerate().map(step).collect::<Vec<_>>())?;
        if outcomes.is_empty() {
            return Err(format!("the tests of {} do not run", test.title));
        }
        let ran = rest.iter().zip(outcomes);
        cases.extend(ran.map(|(((title, span), _), outcome)| Case { title: title.clone(), span: *span, outcome }));
    }
    Ok(cases)
}
