//! The golden cases: what the loop of scans did to the interpreter is done to the witness, stimulus and restarts too.

use crate::case::{Case, Pin, discover};
use crate::compare::{Scan, Verdict, difference};
use crate::leaf::Read;
use crate::recorded::{Event, recorded};
use crate::scan::Table;
use staunch_frontend::{Dialect, Sources, ast, parse_file};
use staunch_runtime::{Family, FaultKind};
use staunch_witness::{Input, Machine, Stop};
use std::collections::BTreeMap;
use std::path::Path;

/// Turns of loops that a scan may take.
const TURNS: u64 = 200_000;

#[test]
fn golden_cases() {
    let (cases, _) = discover(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases"));
    let chosen = std::env::var("STAUNCH_CASE").ok();
    let is_chosen =
        |it: &Case| it.pins.contains(&Pin::Scan) && chosen.as_ref().is_none_or(|name| it.name.contains(name));
    let mut unknown: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let (mut compared, mut wrong) = (0, 0);
    for case in cases.iter().filter(|it| is_chosen(it)) {
        match compare(case, &case.sources()).unwrap_or_else(Verdict::Differs) {
            Verdict::Same { .. } => compared += 1,
            Verdict::Endless => unknown.entry("how it ends".to_owned()).or_default().push(case.name.clone()),
            Verdict::Rejected(reason) => unknown.entry(reason).or_default().push(case.name.clone()),
            Verdict::Differs(how) => {
                println!("{}: {how}", case.name);
                wrong += 1;
            }
        }
    }
    let mut reasons: Vec<_> = unknown.iter().collect();
    reasons.sort_by_key(|it| std::cmp::Reverse(it.1.len()));
    for (reason, names) in reasons {
        println!("{} not compared, {reason}: {}", names.len(), names.join(", "));
    }
    println!("{compared} cases compared");
    assert_eq!(wrong, 0, "of {compared} cases");
}

/// Compares the witness and the interpreter on sources, with the settings and the stimulus of a case; an error is that the
/// stimulus is none for the sources.
pub fn compare(case: &Case, sources: &Sources) -> Result<Verdict, String> {
    let mut settings = case.settings();
    // A program that hangs still ends.
    settings.loop_budget.get_or_insert(TURNS);
    let Some(program) = staunch_frontend::compile(sources, &settings.options).program else {
        return Ok(Verdict::Rejected("it is refused".to_owned()));
    };
    let table = Table::parse(&case.pinned(Pin::Scan))?;
    if settings.options.ctu_stop_at_pv || settings.options.openplc4_cd_rises || settings.options.s7_ld_edge {
        return Ok(Verdict::Rejected("a counter that stops at PV".to_owned()));
    }
    if settings.options.codesys_lreal_literals {
        return Ok(Verdict::Rejected("a number that is an LREAL next to a REAL".to_owned()));
    }
    let has = |what: &str| sources.files().iter().any(|it| it.text.contains(what));
    let own = ["**", "_TO_STRING", "STRING_TO_ULINT", "MID(", "DELETE(", "INSERT(", "LIMIT("];
    if settings.options.dialect == Dialect::Siemens && own.iter().any(|it| has(it)) {
        return Ok(Verdict::Rejected("a function, a power, or the text of a number, in SCL".to_owned()));
    }
    let is_computed =
        || ["_TO_", "REAL", "TIME", "TON", "TOF", "TP", "F_TRIG", "F_EDGE", "STRING"].iter().any(|it| has(it));
    let starts_otherwise = || settings.options.dialect == Dialect::Openplc4 && (has(":= [") || has("NOT 16#"));
    if matches!(settings.options.dialect, Dialect::Openplc | Dialect::Openplc4) && (is_computed() || starts_otherwise())
    {
        return Ok(Verdict::Rejected("values of OpenPLC's C and C++".to_owned()));
    }
    let family = settings.options.dialect.family();
    // The witness has no prescan of Logix: programs with its counters start without one.
    let is_logix = family == Family::Logix || sources.files().iter().any(|it| it.text.contains("LOGIX."));
    let events = recorded(&program, &table, &settings, !is_logix, &case.module())?;
    let mut files: Vec<ast::File<'_>> = (0..).zip(sources.files()).map(|(at, _)| parse_file(sources, at)).collect();
    if let Some(count) = settings.options.default_pool {
        give_pools(&mut files, count);
    }
    let running: Vec<&str> = program.instances.iter().map(|it| it.name.as_str()).collect();
    let start = || Machine::new(sources, &files, family, &running);
    Ok(replayed(&start, events).unwrap_or_else(|stop| match stop {
        Stop::Endless => Verdict::Endless,
        Stop::Unknown(what) => Verdict::Rejected(what),
        Stop::Fault(fault) => Verdict::Differs(format!("the witness faults at the start: {fault}")),
    }))
}

/// `[pool] default`: every type without a pool has one. Of those that `__NEW` does not name nothing is seen.
fn give_pools(files: &mut [ast::File<'_>], count: u32) {
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        match item {
            ast::Item::Pou(pou) if pou.kind.is_block() && pou.modifiers.is_abstract.is_none() => {
                pou.pool.get_or_insert(ast::Pool { count: Some(count), span: pou.name.span });
            }
            ast::Item::Types(declared) => {
                for it in declared.iter_mut().filter(|it| matches!(it.ty.kind, ast::TypeKind::Struct(_))) {
                    it.pool.get_or_insert(ast::Pool { count: Some(count), span: it.name.span });
                }
            }
            _ => {}
        }
    }
}

fn replayed<'a>(start: &dyn Fn() -> Result<Machine<'a>, Stop>, events: Vec<Event>) -> Result<Verdict, Stop> {
    let mut machine = start()?;
    let mut number = 0;
    for event in events {
        match event {
            Event::Init => {
                machine = start()?;
                if number > 0 {
                    machine.starts_again();
                }
            }
            Event::Put(path, Read::Scalar(value)) => machine.put(&path, Input::Scalar(value))?,
            Event::Put(path, Read::Text(text)) => machine.put(&path, Input::Text(units(&text)))?,
            Event::Scan(instance, context, theirs) => {
                number += 1;
                if theirs.end.is_some_and(|it| it.kind == FaultKind::LoopBudget) {
                    // A changed loop may have no end; how many turns it has is not the witness's matter.
                    return Err(Stop::Endless);
                }
                let end = match machine.scan(&instance, &context) {
                    Ok(()) => None,
                    Err(Stop::Fault(fault)) => Some(fault),
                    Err(stop) => return Err(stop),
                };
                let mut ours = Scan { end, variables: machine.variables() };
                add_addresses(&machine, &theirs, &mut ours);
                if !have_any_in_common(&theirs, &ours) {
                    return Err(Stop::Unknown("any of the variables".to_owned()));
                }
                if let Some(how) = difference(number, "interpreter", &theirs, "witness", &ours) {
                    return Ok(Verdict::Differs(how));
                }
            }
        }
    }
    Ok(Verdict::Same { faulted: false })
}

fn have_any_in_common(a: &Scan, b: &Scan) -> bool {
    a.variables.iter().any(|it| b.variables.iter().any(|other| it.0.eq_ignore_ascii_case(&other.0)))
}

/// Variables at addresses have the executors' own names.
fn add_addresses(machine: &Machine<'_>, theirs: &Scan, ours: &mut Scan) {
    let sizes = [("Bool", 0), ("U8", 1), ("U16", 2), ("U32", 4), ("U64", 8)];
    for (path, value) in &theirs.variables {
        let kind = value.split('(').next();
        let size = sizes.iter().find(|it| kind == Some(it.0)).map(|it| it.1);
        // What has several types there may have another one of them.
        let is_same = |it: &(String, String)| it.0.eq_ignore_ascii_case(path) && it.1.split('(').next() == kind;
        let is_known = ours.variables.iter().any(is_same);
        if let Some(size) = size.filter(|_| path.starts_with("Globals.") && !is_known) {
            ours.variables.extend(machine.addressed(path, size).map(|it| (path.clone(), it)));
        }
    }
}

fn units(text: &ast::Chars) -> Vec<u16> {
    (0..text.len()).filter_map(|it| text.unit(it)).collect()
}
