//! Both systems under a stimulus: the host drives each, and what it leaves after each scan is kept.

use super::Verdict;
use super::pair::{Input, Pair, Row, Side};
use crate::args::Compare;
use crate::{machine::Native, run};
use staunch_host::{Error, Machine, Options};
use staunch_runtime::{Context, Fault};

/// A machine that keeps its state after each scan.
struct Recorder<'s> {
    machine: &'s mut Native,
    scans: Vec<Recorded>,
    restarted: bool,
    /// What a restart sets anew although the declaration retains it.
    forgotten: Vec<(usize, Vec<u8>)>,
}

struct Recorded {
    now: i64,
    restart: bool,
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
        self.restarted = !self.scans.is_empty();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        for (offset, bytes) in self.forgotten.iter().filter(|_| self.restarted) {
            self.machine.write(*offset, bytes);
        }
        let result = self.machine.scan(instance, cx);
        // Programs that run at one time make one scan.
        let same = self.scans.pop_if(|it| it.now == cx.now);
        let restart = std::mem::take(&mut self.restarted) || same.is_some_and(|it| it.restart);
        let state = self.machine.state().to_vec();
        self.scans.push(Recorded { now: cx.now, restart, state, fault: result.err() });
        result
    }
}

/// The rows up to the first difference.
pub fn follow(pair: &mut Pair, args: &Compare) -> Result<Verdict, String> {
    let [a, b] = pair.sides.each_mut().map(|side| record(side, args));
    let (a, b) = (a?, b?);
    name_columns(pair, args);
    let mut rows = Vec::new();
    let count = a.len().max(b.len());
    for (a, b) in a.into_iter().zip(b) {
        let row = Row { restart: a.restart, states: [a.state, b.state], faults: [a.fault, b.fault] };
        pair.restore(&row.states);
        let differs = pair.differs(row.faults);
        rows.push(row);
        if differs {
            return Ok(Verdict::Differs(rows));
        }
    }
    Ok(Verdict::Same(format!("{count} scans of the stimulus leave the same values on both")))
}

fn record(side: &mut Side, args: &Compare) -> Result<Vec<Recorded>, String> {
    let map = run::map(&side.program)?;
    let cycle = args.cycle.as_deref().map(staunch_host::parse_duration).transpose()?;
    let options =
        Options { scans: args.scans, cycle, stimulus: args.stimulus.clone(), quiet: true, ..Options::default() };
    let forgotten = side.forgotten();
    let mut recorder = Recorder { machine: side.machine(), scans: Vec::new(), restarted: false, forgotten };
    match staunch_host::run(&mut recorder, &map, &options) {
        // A fault ends the run; the other side may have one too.
        Ok(_) | Err(Error::Fault { .. }) => Ok(recorder.scans),
        Err(error) => Err(format!("under --dialect {}: {error}", side.dialect.name())),
    }
}

/// Shows the stimulus's columns as the inputs.
fn name_columns(pair: &mut Pair, args: &Compare) {
    let text = args.stimulus.as_ref().and_then(|it| std::fs::read_to_string(it).ok()).unwrap_or_default();
    let header = text.lines().next().unwrap_or_default();
    let names = header.split(',').map(|it| it.trim().trim_matches('"').to_ascii_lowercase());
    let place = |side: &Side, name: &str| {
        side.leaves.all.iter().position(|it| it.path.eq_ignore_ascii_case(name) || it.key == name)
    };
    let column = |name: String| {
        let leaves = [place(&pair.sides[0], &name)?, place(&pair.sides[1], &name)?];
        Some(Input { leaves, values: Vec::new() })
    };
    let found: Vec<Input> = names.filter_map(column).collect();
    if !found.is_empty() {
        pair.inputs = found;
    }
}
