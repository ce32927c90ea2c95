//! `staunch compare`: what a move of a program from one system to another changes.
//!
//! The folders are layers, and each imports from those before it: the program's text for the other system, what each
//! program's text says, both side by side, what their inputs may be, how they may come to differ, the search for inputs
//! that make them, what it has found, what that comes to, and the report.

mod other;
mod program;

mod pair;

mod inputs;

mod difference;

mod search;

mod findings;

mod verdict;

mod variants;

mod report;

use crate::args::{Common, Compare, Files, MessageFormat};
use crate::output;
use crate::session::Session;
use crate::{REJECTED, input, run};
use difference::accept::Accepted;
use difference::pitfall;
use findings::finding::Findings;
use other::{fixed, logix, migrated, missing, renamed};
use pair::{Pair, Side};
use report::{Report, picture, rejection};
use search::tolerance::Tolerance;
use search::world::World;
use staunch_frontend::Dialect;
use staunch_ir::Program;
use variants::Variant;
use verdict::{Judged, Other, Verdict, WithoutRun, judge, scope};

pub fn compare(common: &Common, args: &Compare) -> Result<u8, String> {
    let args = &args.settled()?;
    let common = Common { dialect: Some(args.from.dialect), ..common.clone() };
    let from = Session::start_to_move(&common, &args.files)?;
    crate::apart::compare(&from, args)?;
    fixed::check(
        &from.sources,
        args.from.dialect,
        "--from",
        args.against.is_none() && args.from.dialect != args.to.dialect,
    )?;
    let Some(program) = from.program_to_run(args.program.as_deref())? else {
        if from.common.format() == MessageFormat::Human {
            output::tell(format_args!("the program can be compared when `--from {}` accepts it", args.from.name));
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
            args.write.iter().for_each(|it| output::tell(format_args!("no file is written to {}", it.display())));
            return report.rejection(&rejection::find(&to, args.from.dialect, args.to.dialect));
        }
    };
    if let Some(path) = &args.write {
        let sources = rewritten.as_ref().map_or(&from.sources, |it| &it.sources);
        let changes: Vec<_> = to.renamed.iter().chain(&to.readdressed).cloned().collect();
        migrated::write(&from, path, sources, &changes, args.to.dialect)?;
    }
    let sources = rewritten.as_ref().map_or(&from.sources, |it| &it.sources);
    let own = side_by_side(&report, [program, moved], &renamed)?;
    each_variant(&report, own, &renamed, |variant| {
        variant.programs(&from, (sources, args.to.dialect), args.program.as_deref())
    })
}

/// Both systems' programs side by side, and what that came to.
struct Compared {
    pair: Pair,
    world: World,
    findings: Findings,
    accepted: Accepted,
    verdict: Verdict,
    /// Beyond what is accepted.
    rest: Option<Verdict>,
    /// Where nobody switches it to STOP, if the difference needs that.
    without_run: Option<WithoutRun>,
}

impl Compared {
    fn weight(&self) -> verdict::Weight {
        verdict::weight(&self.verdict, self.rest.as_ref())
    }
}

/// Shows the variant that the project file decides, or else the one that asks for the most; and what the others came to.
fn each_variant(
    report: &Report,
    own: Compared,
    renamed: &[Option<String>],
    programs: impl Fn(&Variant) -> Result<Option<[Program; 2]>, String>,
) -> Result<u8, String> {
    let variant = Variant::own(report.session, &own.pair)?;
    let mut others = Vec::new();
    let (mut shown, mut of) = (own, variant.clone());
    for variant in variant.others() {
        let Some(programs) = programs(&variant)? else {
            others.push(Other::rejected(variant));
            continue;
        };
        let next = side_by_side(report, programs, renamed)?;
        let is_open = !variant.is_decided(&report.session.project);
        let (next, variant) = match is_open && next.weight() > shown.weight() {
            true => (std::mem::replace(&mut shown, next), std::mem::replace(&mut of, variant)),
            false => (next, variant),
        };
        others.push(Other::of(variant, &next.verdict, next.rest.as_ref(), next.without_run.as_ref()));
    }
    let Compared { pair, world, findings, accepted, verdict, rest, without_run } = &mut shown;
    if let (Some(path), Verdict::Differs { rows, trace, .. }) = (report.args.picture(), &*verdict) {
        picture::draw(pair, world, report.args, path, (rows, trace.as_ref()))?;
    }
    let judged =
        Judged { verdict, rest: rest.as_ref(), variant: &of, others: &others, without_run: without_run.as_ref() };
    report.print(pair, world, &judged, findings, accepted)
}

/// Runs both systems' programs.
fn side_by_side(
    report: &Report,
    [program, moved]: [Program; 2],
    renamed: &[Option<String>],
) -> Result<Compared, String> {
    let args = report.args;
    let cycle = run::cycle(report.session, args.cycle.as_deref())?;
    let sides = [Side::new(args.from.dialect, program, cycle)?, Side::new(args.to.dialect, moved, cycle)?];
    let mut pair = Pair::new(sides, &[]);
    pair.is_ported = !report.notes.is_empty();
    let mut world = World::of(&mut pair, args)?;
    let same_program = pair.runs_the_same();
    let only: Vec<String> = args.vars.iter().flat_map(|it| it.split(',')).map(|it| it.trim().to_owned()).collect();
    pair.compare_only(&only);
    check_compared(&pair, args, &only)?;
    pair.find_idle();
    pair.settle_counts();
    let uses = pitfall::uses(&pair);
    let mut findings = Findings::new(&pair, &world, &uses, renamed);
    let accepted = args.accept.as_deref().map(Accepted::read).transpose()?.unwrap_or_default();
    let verdict = if same_program && args.stimulus.is_none() && !world.unfollowed.is_empty() {
        let tried = vec!["both systems run the same program, by the rules that Staunch follows".to_owned()];
        Verdict::NotFound { tried, left: world.unfollowed.clone() }
    } else if same_program && args.stimulus.is_none() {
        findings.all_impossible("both systems run the same program");
        Verdict::Equal(scope::same_program(&pair, &world))
    } else {
        judge::judge(&mut pair, &world, args, &mut findings)?
    };
    let rest = match &verdict {
        Verdict::Differs { .. } if args.stimulus.is_none() && accepted.accepts_any() && !findings.fail(&accepted) => {
            let is_named = !only.is_empty();
            world.tolerance = Some(Tolerance::of(&pair, &world.computed, &uses, &accepted, is_named));
            Some(judge::beyond_accepted(&mut pair, &world, args, &mut findings))
        }
        Verdict::Differs { .. } | Verdict::Equal(_) | Verdict::NotFound { .. } => None,
    };
    // What is not accepted is shown in place of what is.
    let (verdict, rest) = match rest {
        Some(it @ Verdict::Differs { .. }) => (it, None),
        rest => (verdict, rest),
    };
    let without_run = judge::without_run(&mut pair, &world, args, &verdict, &mut findings);
    Ok(Compared { pair, world, findings, accepted, verdict, rest, without_run })
}

/// Everything to compare must exist on both sides: otherwise it would be silently ignored.
fn check_compared(pair: &Pair, args: &Compare, only: &[String]) -> Result<(), String> {
    let programs = if args.against.is_some() { "programs" } else { "systems' programs" };
    match pair.unknown_name(only) {
        Some((name, 0)) => return Err(format!("--vars: there is no variable `{name}`")),
        Some((name, 1)) => return Err(format!("--vars: only one of the two {programs} has a variable `{name}`")),
        Some((name, _)) => {
            return Err(format!("--vars: `{name}` is a CONSTANT or an input of a block, which is not compared"));
        }
        None => {}
    }
    if pair.compared.is_empty() && !only.is_empty() {
        return Err(format!("--vars names only inputs, which are the same for both {programs}"));
    }
    let Some(against) = args.against.as_deref().filter(|_| only.is_empty()) else { return Ok(()) };
    if let Some((side, name)) = pair.only_one_has(|it| it.at.is_output && it.field.is_some()).first() {
        let of = if *side == 0 { "the first program".to_owned() } else { against.display().to_string() };
        let help = "declare it in both, or name the variables to compare with --vars";
        return Err(format!("only {of} has the output `{name}`: {help}"));
    }
    if pair.compared.is_empty() {
        return Err(format!("{} and the program have no common variable to compare", against.display()));
    }
    Ok(())
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
        return logix::rewrite(&from.sources, args.from.dialect);
    }
    Ok(None)
}
