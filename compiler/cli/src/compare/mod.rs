//! `staunch compare`: what a move of a program from one system to another changes.

mod leaf;
mod pair;

mod logix;

mod duration;
mod hold;
mod search;
mod shrink;
mod stimulus;

mod trap;

mod obstacle;
mod report;

use crate::args::{Common, Compare, Files, MessageFormat};
use crate::session::Session;
use crate::{REJECTED, input, run};
use pair::{Pair, Row, Side};
use staunch_frontend::{Code, Dialect, Sources};

/// Time between scans where neither the command nor the project file says one.
const CYCLE: i64 = 10_000_000;

/// What the comparison came to.
enum Verdict {
    /// The rows up to the first difference.
    Differs(Vec<Row>),
    /// How far it was looked, in a sentence.
    Same(String),
}

pub fn compare(common: &Common, args: &Compare) -> Result<u8, String> {
    let common = Common { dialect: Some(args.from), ..common.clone() };
    let from = Session::start(&common, &args.files)?;
    let Some(program) = from.program_to_run(args.program.as_deref())? else {
        if from.common.format() == MessageFormat::Human {
            eprintln!("the program is compared once `--from {}` accepts it", args.from.name());
        }
        return Ok(REJECTED);
    };
    let rewritten = rewrite(&from, args)?;
    let notes = rewritten.as_ref().map_or_else(Vec::new, |it| it.notes.clone());
    let to = from.moved(args.to, rewritten.map(|it| it.sources))?;
    let renamed = to.diagnostics.iter().filter(|it| it.code == Code::W0609).count();
    let report = report::Report { session: &from, from: args.from, to: args.to, notes, renamed };
    let moved = match to.program_to_run(args.program.as_deref())? {
        Some(moved) => moved,
        None => return report.obstacle(&obstacle::find(&to, args.from, args.to)),
    };
    let cycle = run::cycle(&from, args.cycle.as_deref())?.unwrap_or(CYCLE);
    let only: Vec<String> = args.vars.iter().flat_map(|it| it.split(',')).map(|it| it.trim().to_owned()).collect();
    let sides = [Side::new(args.from, program)?, Side::new(args.to, moved)?];
    let mut pair = Pair::new(sides, cycle, &only);
    if pair.compared.is_empty() && !only.is_empty() {
        return Err("--vars names no variable that both systems' programs have".to_owned());
    }
    match verdict(&mut pair, args)? {
        Verdict::Same(how) => report.same(&how),
        Verdict::Differs(rows) => report.difference(&pair, &rows, &self_feeding(&[&from, &to])),
    }
}

/// The other system's program where it is another text: the user's, or, for Logix, one with its
/// instructions in place of blocks.
fn rewrite(from: &Session, args: &Compare) -> Result<Option<logix::Rewritten>, String> {
    if let Some(path) = &args.against {
        let files = Files { files: vec![path.clone()] };
        let sources = input::read(&files.files)?;
        return Ok(Some(logix::Rewritten { sources, notes: Vec::new() }));
    }
    if args.to == Dialect::Logix && args.from != Dialect::Logix {
        return Ok(logix::rewrite(&from.sources, args.from));
    }
    Ok(None)
}

fn verdict(pair: &mut Pair, args: &Compare) -> Result<Verdict, String> {
    if args.stimulus.is_some() {
        return stimulus::follow(pair, args);
    }
    let outcome = search::search(pair, search::Limits { depth: args.depth, budget: args.budget });
    if let Some(rows) = outcome.steps.as_ref().and_then(|it| pair.replay(it)) {
        return Ok(Verdict::Differs(rows));
    }
    Ok(Verdict::Same(match (outcome.complete, outcome.depth) {
        (true, _) => {
            format!("every state that the inputs tried can reach is the same on both ({} scans)", outcome.scans)
        }
        (false, depth) => format!(
            "every sequence of inputs over {depth} scans, then inputs that are held, long pulses and random inputs, {} scans in all",
            outcome.scans
        ),
    }))
}

/// The counters that their own output resets.
fn self_feeding(sessions: &[&Session]) -> Vec<String> {
    let of = |session: &&Session| {
        let lints = session.diagnostics.iter().filter(|it| it.code == Code::W0612);
        let names = lints.filter_map(|it| Some(session.sources.text(it.others.first()?.span).to_owned()));
        names.collect::<Vec<_>>()
    };
    sessions.iter().flat_map(of).collect()
}

/// The text of a file by its number, for messages.
fn line_of(sources: &Sources, file: u16, line: u32) -> String {
    let text = &sources.get(file).text;
    let at = usize::try_from(line.saturating_sub(1)).unwrap_or(0);
    text.lines().nth(at).unwrap_or_default().trim().to_owned()
}
