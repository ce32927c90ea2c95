//! Both systems under a stimulus: the host drives each, and what it leaves after each scan is kept.
//! And a sequence of inputs as a stimulus.

use super::Verdict;
use crate::pair::{Input, Pair, Row, Side};
use crate::request::Request;
use crate::search::trace::Trace;
use crate::search::world::World;
use staunch_host::{Error, Event, Machine, Options};
use staunch_ir::Value;
use staunch_machine::Native;
use staunch_runtime::{Context, Fault};
use std::fmt::Write;

/// A machine that keeps its state after each scan.
struct Recorder<'s> {
    machine: &'s mut Native,
    scans: Vec<Recorded>,
    event: Option<Event>,
}

struct Recorded {
    now: i64,
    event: Option<Event>,
    /// As the scan begins.
    given: Vec<u8>,
    state: Vec<u8>,
    fault: Option<Fault>,
}

impl Machine for Recorder<'_> {
    fn state(&self) -> &[u8] {
        self.machine.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.machine.write(offset, bytes);
    }

    fn init(&mut self) {
        self.machine.init();
    }

    fn starts_again(&mut self, event: Event) {
        self.event = Some(event);
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        let before = self.machine.state().to_vec();
        let result = self.machine.scan(instance, cx);
        // Programs that run at one time make one scan.
        let same = self.scans.pop_if(|it| it.now == cx.now());
        let event = self.event.take().or(same.as_ref().and_then(|it| it.event));
        let given = same.map_or(before, |it| it.given);
        let state = self.machine.state().to_vec();
        self.scans.push(Recorded { now: cx.now(), event, given, state, fault: result.err() });
        result
    }
}

/// The rows up to the first difference.
pub fn follow(pair: &mut Pair, request: &Request) -> Result<Verdict, String> {
    let [a, b] = pair.sides.each_mut().map(|side| record(side, request));
    let (a, b) = (a?, b?);
    name_columns(pair, request);
    let mut rows = Vec::new();
    let count = a.len().max(b.len());
    for (a, b) in a.into_iter().zip(b) {
        let inputs = pair.inputs.iter().map(|it| pair.sides[0].show(it.scalars[0], &a.given)).collect();
        rows.push(Row { event: a.event, inputs, states: [a.state, b.state], faults: [a.fault, b.fault] });
        if rows.last().is_some_and(|row| !pair.differences(row).is_empty() || pair.faults_differ(row.faults)) {
            return Ok(Verdict::Differs { rows, trace: None, shortest: false });
        }
    }
    let tried = vec![format!("{count} scans of the stimulus: they leave the same values on both")];
    Ok(Verdict::NotFound { tried, left: vec!["any other inputs".to_owned()] })
}

fn record(side: &mut Side, request: &Request) -> Result<Vec<Recorded>, String> {
    let map = staunch_machine::map(&side.program)?;
    let options = Options {
        scans: request.scans,
        cycle: request.cycle,
        stimulus: request.stimulus.clone(),
        quiet: true,
        ..Options::default()
    };
    let mut recorder = Recorder { machine: side.machine(), scans: Vec::new(), event: None };
    match staunch_host::run(&mut recorder, &map, &options) {
        // A fault ends the run; the other side may have one too.
        Ok(_) | Err(Error::Fault { .. }) => Ok(recorder.scans),
        Err(error) => Err(format!("under --dialect {}: {error}", side.dialect.name())),
    }
}

/// Shows the stimulus's columns as the inputs.
fn name_columns(pair: &mut Pair, request: &Request) {
    let text = request.stimulus.as_ref().and_then(|it| std::fs::read_to_string(it).ok()).unwrap_or_default();
    let header = text.lines().next().unwrap_or_default();
    let names = header.split([',', ';']).map(|it| it.trim().trim_matches('"').to_ascii_lowercase());
    let place = |side: &Side, name: &str| {
        side.scalars.all.iter().position(|it| it.path.eq_ignore_ascii_case(name) || it.key == name)
    };
    let column = |name: String| {
        let scalars = [place(&pair.sides[0], &name)?, place(&pair.sides[1], &name)?];
        Some(Input { scalars, initial: Value::Bool(false), range: None, texts: Vec::new(), named: 0 })
    };
    let found: Vec<Input> = names.filter_map(column).collect();
    if !found.is_empty() {
        pair.inputs = found;
    }
}

/// A stimulus for `run` and `compare`: a row where something changes, and the last.
pub fn text(pair: &Pair, world: &World, trace: &Trace) -> String {
    let steps: Vec<_> = trace.steps().collect();
    let events = steps.iter().any(|it| it.event.is_some());
    let mut text = "scan".to_owned();
    for input in &pair.inputs {
        let path = pair.path(input.scalars);
        let quote = if path.contains(',') { "\"" } else { "" };
        let _ = write!(text, ",{quote}{path}{quote}");
    }
    text.push_str(if events { ",@event\n" } else { "\n" });
    let mut before: Option<&[Value]> = None;
    for (number, step) in (1..).zip(&steps) {
        let same = before == Some(step.inputs.as_slice()) && step.event.is_none() && !world.inputs_written;
        if !same || number == steps.len() {
            let _ = write!(text, "{number}");
            for (input, value) in pair.inputs.iter().zip(&step.inputs) {
                let _ = write!(text, ",{}", cell(pair, input, *value));
            }
            if events {
                let _ = write!(text, ",{}", step.event.map_or("", Event::name));
            }
            text.push('\n');
        }
        before = Some(&step.inputs);
    }
    text
}

fn cell(pair: &Pair, input: &Input, value: Value) -> String {
    let cell = input.spelled(&pair.sides[0].program, pair.scalar(0, input.scalars[0]).ty, value);
    // In quotes an empty text is one.
    if input.texts.is_empty() && !cell.contains(['"', ',']) {
        cell
    } else {
        format!("\"{}\"", cell.replace('"', "\"\""))
    }
}
