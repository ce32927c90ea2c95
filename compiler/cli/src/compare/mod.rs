//! `staunch compare`: what a move of a program from one system to another changes.
//!
//! The folders are layers, and each imports from those before it: the program's text for the other system, what each
//! program's text says, both side by side, what their inputs may be, how they may come to differ, the search for inputs
//! that make them, what it has found, and the report.

mod other;
mod program;

mod pair;

mod inputs;

mod difference;

mod search;

mod findings;

mod report;

use crate::args::{Common, Compare, Files, MessageFormat};
use crate::session::Session;
use crate::{REJECTED, input, run};
use difference::accept::Accepted;
use difference::pitfall;
use findings::finding::Findings;
use findings::reason;
use inputs::alphabet;
use other::{fixed, logix, migrated, missing, renamed};
use pair::{Pair, Side, Step};
use program::scalar::{Role, Scalar};
use report::verdict::{Judged, Verdict};
use report::{Report, picture, rejection, scope, stimulus};
use search::tolerance::Tolerance;
use search::trace::Trace;
use search::world::World;
use search::{look, strategy};
use staunch_frontend::Dialect;

pub fn compare(common: &Common, args: &Compare) -> Result<u8, String> {
    let args = &args.settled()?;
    let common = Common { dialect: Some(args.from.dialect), ..common.clone() };
    let from = Session::start(&common, &args.files)?;
    fixed::check(
        &from.sources,
        args.from.dialect,
        "--from",
        args.against.is_none() && args.from.dialect != args.to.dialect,
    )?;
    let Some(program) = from.program_to_run(args.program.as_deref())? else {
        if from.common.format() == MessageFormat::Human {
            eprintln!("the program is compared once `--from {}` accepts it", args.from.name);
        }
        return Ok(REJECTED);
    };
    let rewritten = rewrite(&from, args)?;
    let notes = rewritten.as_ref().map_or_else(Vec::new, |it| it.notes.clone());
    let to = match &rewritten {
        Some(it) if args.against.is_none() => from.rewritten(args.to.dialect, &it.sources, |span| it.origin(span))?,
        Some(it) => from.moved(args.to.dialect, Some(it.sources.clone()))?,
        None => from.moved(args.to.dialect, None)?,
    };
    let renamed = renamed::owners(&to.sources, to.renamed.iter().map(|it| it.span));
    let missing =
        if args.against.is_some() { Vec::new() } else { missing::find(&from.sources, &program, args.to.dialect) };
    let unknown = if args.against.is_some() { Vec::new() } else { missing::unknown(&program, args.to.dialect) };
    let report = Report { session: &from, args, notes, renamed: renamed.len(), missing, unknown };
    let moved = match to.program_to_run(args.program.as_deref())? {
        Some(moved) => moved,
        None => {
            args.write.iter().for_each(|it| eprintln!("no file is written to {}", it.display()));
            return report.rejection(&rejection::find(&to, args.from.dialect, args.to.dialect));
        }
    };
    if let Some(path) = &args.write {
        let sources = rewritten.as_ref().map_or(&from.sources, |it| &it.sources);
        migrated::write(&from, path, sources, &to.renamed, args.to.dialect)?;
    }
    let cycle = run::cycle(&from, args.cycle.as_deref())?;
    let same_program = is_same(&program, &moved);
    let sides = [Side::new(args.from.dialect, program, cycle)?, Side::new(args.to.dialect, moved, cycle)?];
    let mut pair = Pair::new(sides, &[]);
    let mut world = World::of(&mut pair, args)?;
    let only: Vec<String> = args.vars.iter().flat_map(|it| it.split(',')).map(|it| it.trim().to_owned()).collect();
    pair.compare_only(&only);
    check_compared(&pair, args, &only)?;
    let uses = pitfall::uses(&pair);
    let mut findings = Findings::new(&pair, &world, &uses, &renamed);
    let accepted = args.accept.as_deref().map(Accepted::read).transpose()?.unwrap_or_default();
    let verdict = if same_program && args.stimulus.is_none() {
        findings.all_impossible("both systems run the same program");
        Verdict::Equal("both systems run the same program: no statement, type, block or retention differs".to_owned())
    } else {
        verdict(&mut pair, &world, args, &mut findings)?
    };
    let rest = match &verdict {
        Verdict::Differs { .. } if args.stimulus.is_none() && accepted.accepts_any() && !findings.fail(&accepted) => {
            world.tolerance = Some(Tolerance::of(&pair, &world.computed, &uses, &accepted));
            Some(beyond_accepted(&mut pair, &world, args, &mut findings))
        }
        Verdict::Differs { .. } | Verdict::Equal(_) | Verdict::NotFound { .. } => None,
    };
    // What is not accepted is shown in place of what is.
    let (verdict, rest) = match rest {
        Some(it @ Verdict::Differs { .. }) => (it, None),
        rest => (verdict, rest),
    };
    if let (Some(path), Verdict::Differs { rows, trace, .. }) = (args.picture(), &verdict) {
        picture::draw(&mut pair, &world, args, path, (rows, trace.as_ref()))?;
    }
    report.print(&pair, &world, &Judged { verdict: &verdict, rest: rest.as_ref() }, &findings, &accepted)
}

/// What is to be compared is there on both sides: what is not would be passed over in silence.
fn check_compared(pair: &Pair, args: &Compare, only: &[String]) -> Result<(), String> {
    let programs = if args.against.is_some() { "programs" } else { "systems' programs" };
    match pair.unknown_name(only) {
        Some((name, 0)) => return Err(format!("--vars: there is no variable `{name}`")),
        Some((name, 1)) => return Err(format!("--vars: only one of the two {programs} has a variable `{name}`")),
        Some((name, _)) => {
            return Err(format!(
                "--vars: `{name}` is a CONSTANT, or an input of a block: what it is given is not compared"
            ));
        }
        None => {}
    }
    if pair.compared.is_empty() && !only.is_empty() {
        return Err(format!("--vars names nothing but inputs, which are the same for both {programs}"));
    }
    let Some(against) = args.against.as_deref().filter(|_| only.is_empty()) else { return Ok(()) };
    if let Some((side, name)) = pair.only_one_has(|it| it.at.is_output && it.field.is_some()).first() {
        let of = if *side == 0 { "the first program".to_owned() } else { against.display().to_string() };
        let help = "declare it in both, or name what is to be compared with --vars";
        return Err(format!("`{name}` is an output of {of} alone: {help}"));
    }
    if pair.compared.is_empty() {
        return Err(format!("{} and the program have no variable in common that could be compared", against.display()));
    }
    Ok(())
}

/// The search goes on past what is accepted.
fn beyond_accepted(pair: &mut Pair, world: &World, args: &Compare, findings: &mut Findings) -> Verdict {
    let outcome = strategy::search(pair, world, args.budget, 0);
    findings.note(pair, world, &outcome, false);
    if let Some(trace) = &outcome.found {
        let steps: Vec<Step> = trace.steps().cloned().collect();
        pair.init();
        for step in &steps {
            let faults = pair.scan(step);
            look::look(pair, world, step.event, faults);
        }
        pair.compared = world.tolerance.iter().flat_map(|it| pair.remaining_compared(&it.passing)).collect();
        return differs(pair, world, trace, false, findings);
    }
    let is_told_apart = world.tolerance.as_ref().is_none_or(|it| it.beside.is_empty());
    if outcome.complete && covers_all(pair, world, args) && is_told_apart {
        return Verdict::Equal(scope::every_state(pair, world, &outcome));
    }
    scope::not_found(pair, world, &outcome)
}

/// Whether the search leaves nothing out that the inputs could do, and no output that one of the two alone has: where
/// addresses share bits on one system, what is written by another name is an output of its own on the other.
fn covers_all(pair: &Pair, world: &World, args: &Compare) -> bool {
    let is_output = |it: &Scalar| it.at.is_output && it.field.is_some();
    let has_all = args.vars.is_some() || pair.only_one_has(is_output).is_empty();
    has_all
        && world.alphabet.is_exact()
        && pair.whole
        && alphabet::untried(pair).is_empty()
        && alphabet::outputs_given(pair).is_empty()
        && pair.only_one_has(|it| it.role == Role::Input).is_empty()
}

fn differs(pair: &mut Pair, world: &World, trace: &Trace, shortest: bool, findings: &mut Findings) -> Verdict {
    let steps: Vec<Step> = trace.steps().cloned().collect();
    let rows = pair.replay(&steps);
    let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
    let cause = pitfall::cause(pair, &rows, &differences, &world.habits);
    findings.explain(&cause, trace);
    if cause.pitfall.is_none() && reason::find(pair, &rows, &differences, findings).is_none() {
        findings.unexplained(pair, &differences, trace);
    }
    Verdict::Differs { rows, trace: Some(trace.clone()), shortest }
}

/// The other system's program where it is another text: the user's, or, for Logix, one with its
/// instructions in place of blocks.
fn rewrite(from: &Session, args: &Compare) -> Result<Option<logix::Rewritten>, String> {
    if let Some(path) = &args.against {
        let files = Files { files: vec![path.clone()] };
        let sources = input::read(&files.files, &[])?;
        fixed::check(&sources, args.to.dialect, "--to", false)?;
        return Ok(Some(logix::Rewritten::by_user(sources)));
    }
    if args.to.dialect == Dialect::Logix && args.from.dialect != Dialect::Logix {
        return Ok(logix::rewrite(&from.sources, args.from.dialect));
    }
    Ok(None)
}

/// Whether both systems run one program: the statements and types with their blocks, and where each
/// variable lies and whether it is retained, are the same.
fn is_same(a: &staunch_ir::Program, b: &staunch_ir::Program) -> bool {
    use staunch_ir::{layout::Layout, print, symbols::map_text};
    print(a) == print(b) && map_text(a, &Layout::new(a)) == map_text(b, &Layout::new(b))
}

fn verdict(pair: &mut Pair, world: &World, args: &Compare, findings: &mut Findings) -> Result<Verdict, String> {
    if args.stimulus.is_some() {
        return stimulus::follow(pair, args);
    }
    let outcome = strategy::search(pair, world, args.budget, findings.open());
    let exact = covers_all(pair, world, args);
    findings.note(pair, world, &outcome, exact);
    if let Some(trace) = outcome.found.clone() {
        let is_tried = outcome.more_values == 0 && world.alphabet.complete;
        let shortest = is_tried && outcome.depth + 1 >= trace.scans();
        return Ok(differs(pair, world, &trace, shortest, findings));
    }
    if outcome.complete && exact {
        return Ok(Verdict::Equal(scope::every_state(pair, world, &outcome)));
    }
    Ok(scope::not_found(pair, world, &outcome))
}
