//! Two programs, side by side, and what that came to.

use crate::difference::accept::Accepted;
use crate::difference::pitfall;
use crate::findings::finding::Findings;
use crate::pair::{Pair, Side};
use crate::request::Request;
use crate::search::tolerance::Tolerance;
use crate::search::world::World;
use crate::verdict::{self, Verdict, WithoutRun, judge, scope};
use staunch_ir::Program;

/// Both systems' programs side by side, and what that came to.
#[derive(Debug)]
pub struct Compared {
    pub pair: Pair,
    pub world: World,
    pub findings: Findings,
    pub accepted: Accepted,
    pub verdict: Verdict,
    /// Beyond what is accepted.
    pub rest: Option<Verdict>,
    /// Where nobody switches it to STOP, if the difference needs that.
    pub without_run: Option<WithoutRun>,
}

impl Compared {
    pub fn weight(&self) -> verdict::Weight {
        verdict::weight(&self.verdict, self.rest.as_ref())
    }
}

/// Runs both systems' programs. `renamed` has what the program calls each pin that the move renames; where it `is_ported`, lines of
/// it were rewritten.
pub fn side_by_side(
    request: &Request,
    [program, moved]: [Program; 2],
    renamed: &[Option<String>],
    is_ported: bool,
    accepted: Accepted,
) -> Result<Compared, String> {
    let side = |dialect, program| Side::new(dialect, program, request.cycle);
    let mut pair = Pair::new([side(request.from, program)?, side(request.to, moved)?], &[]);
    pair.is_ported = is_ported;
    let mut world = World::of(&mut pair, request)?;
    let same_program = pair.runs_the_same();
    pair.compare_only(&request.vars);
    check_compared(&pair, request)?;
    pair.find_idle();
    pair.settle_counts();
    let uses = pitfall::uses(&pair);
    let mut findings = Findings::new(&pair, &world, &uses, renamed);
    let verdict = if same_program && request.stimulus.is_none() && !world.unfollowed.is_empty() {
        let tried = vec!["both systems run the same program, by the rules that Staunch follows".to_owned()];
        Verdict::NotFound { tried, left: world.unfollowed.clone() }
    } else if same_program && request.stimulus.is_none() {
        findings.all_impossible("both systems run the same program");
        Verdict::Equal(scope::same_program(&pair, &world))
    } else {
        judge::judge(&mut pair, &world, request, &mut findings)?
    };
    let rest = match &verdict {
        Verdict::Differs { .. }
            if request.stimulus.is_none() && accepted.accepts_any() && !findings.fail(&accepted) =>
        {
            let is_named = !request.vars.is_empty();
            world.tolerance = Some(Tolerance::of(&pair, &world.computed, &uses, &accepted, is_named));
            Some(judge::beyond_accepted(&mut pair, &world, request, &mut findings))
        }
        Verdict::Differs { .. } | Verdict::Equal(_) | Verdict::NotFound { .. } => None,
    };
    // What is not accepted is shown in place of what is.
    let (verdict, rest) = match rest {
        Some(it @ Verdict::Differs { .. }) => (it, None),
        rest => (verdict, rest),
    };
    let without_run = judge::without_run(&mut pair, &world, request, &verdict, &mut findings);
    Ok(Compared { pair, world, findings, accepted, verdict, rest, without_run })
}

/// Everything to compare must exist on both sides: otherwise it would be silently ignored.
fn check_compared(pair: &Pair, request: &Request) -> Result<(), String> {
    let only = &request.vars;
    let programs = if request.against.is_some() { "programs" } else { "systems' programs" };
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
    let Some(against) = request.against.as_deref().filter(|_| only.is_empty()) else { return Ok(()) };
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
