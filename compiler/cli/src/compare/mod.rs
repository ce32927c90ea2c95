//! `staunch compare`: what a move of a program from one system to another changes. The search is the crate's; this reads what it is
//! about, and shows what it has found.

mod migrated;
mod report;

use crate::args::{Common, Compare, Files, MessageFormat};
use crate::output;
use crate::session::Session;
use crate::{REJECTED, input, run};
use report::{Report, picture, rejection};
use staunch_compare::compared::{Compared, side_by_side};
use staunch_compare::difference::accept::Accepted;
use staunch_compare::other::{fixed, logix, missing, renamed};
use staunch_compare::request::Request;
use staunch_compare::variants::Variant;
use staunch_compare::verdict::{Judged, Other, Verdict};
use staunch_frontend::{Dialect, Sources};
use staunch_ir::Program;
use std::path::PathBuf;

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
    let request = request(&from, args)?;
    let accepted = accepted(args)?;
    let report = Report { session: &from, args, request: &request, notes, renamed: renamed.len(), missing, unknown };
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
    let compared = |programs| side_by_side(&request, programs, &renamed, !report.notes.is_empty(), accepted.clone());
    let own = compared([program, moved])?;
    each_variant(&report, own, compared, |variant| {
        programs(variant, &from, (sources, args.to.dialect), args.program.as_deref())
    })
}

fn request(from: &Session, args: &Compare) -> Result<Request, String> {
    let vars = args.vars.iter().flat_map(|it| it.split(',')).map(|it| it.trim().to_owned());
    // Read once: it may be a pipe.
    let assumed = args.assume.as_ref().map(|it| Ok::<_, String>((it.clone(), input::text(it)?))).transpose()?;
    Ok(Request {
        from: args.from.dialect,
        to: args.to.dialect,
        against: args.against.clone(),
        vars: vars.collect(),
        stimulus: args.stimulus.clone(),
        scans: args.scans,
        cycle: run::cycle(from, args.cycle.as_deref())?,
        depth: args.depth,
        budget: args.budget,
        assumed,
    })
}

fn accepted(args: &Compare) -> Result<Accepted, String> {
    let read = |path: &PathBuf| Accepted::of(path, &input::text(path)?);
    Ok(args.accept.as_ref().map(read).transpose()?.unwrap_or_default())
}

/// Both sides' programs with a variant's answers, where both systems accept them.
fn programs(
    variant: &Variant,
    from: &Session,
    to: (&Sources, Dialect),
    asked: Option<&str>,
) -> Result<Option<[Program; 2]>, String> {
    let ours = from.with_options(&from.sources, None, |it| variant.applied(it))?;
    let theirs = from.with_options(to.0, Some(to.1), |it| variant.applied(it))?;
    let (Some(ours), Some(theirs)) = (ours, theirs) else { return Ok(None) };
    Ok(Some([from.choose(&ours, asked)?, from.choose(&theirs, asked)?]))
}

/// Shows the variant that the project file decides, or else the one that asks for the most; and what the others came to.
fn each_variant(
    report: &Report,
    own: Compared,
    compared: impl Fn([Program; 2]) -> Result<Compared, String>,
    programs: impl Fn(&Variant) -> Result<Option<[Program; 2]>, String>,
) -> Result<u8, String> {
    let variant = Variant::own(&own.pair, |it| report.session.answer(it))?;
    let mut others = Vec::new();
    let (mut shown, mut of) = (own, variant.clone());
    for variant in variant.others() {
        let Some(programs) = programs(&variant)? else {
            others.push(Other::rejected(variant));
            continue;
        };
        let next = compared(programs)?;
        let is_open = !variant.is_decided(|it| report.session.project.has(it));
        let (next, variant) = match is_open && next.weight() > shown.weight() {
            true => (std::mem::replace(&mut shown, next), std::mem::replace(&mut of, variant)),
            false => (next, variant),
        };
        others.push(Other::of(variant, &next.verdict, next.rest.as_ref(), next.without_run.as_ref()));
    }
    let Compared { pair, world, findings, accepted, verdict, rest, without_run } = &mut shown;
    if let (Some(path), Verdict::Differs { rows, trace, .. }) = (report.args.picture(), &*verdict) {
        picture::draw(pair, world, report.request, path, (rows, trace.as_ref()))?;
    }
    let judged =
        Judged { verdict, rest: rest.as_ref(), variant: &of, others: &others, without_run: without_run.as_ref() };
    report.print(pair, world, &judged, findings, accepted)
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
