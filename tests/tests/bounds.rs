//! Scans never run more instructions than `staunch report` says, as callgrind counts them: those of all examples, of the
//! programs that are measured for speed, and of random programs.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use staunch_frontend::{Options, Source, Sources};
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;
use staunch_native::{Target, measures, object};
use staunch_tests::bounded;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{folder, have, project, staunch, succeed};

const TARGET: &str = "x86_64-unknown-linux-gnu";
/// So many random programs are run, unless STAUNCH_BOUNDS says how many.
const RANDOM_PROGRAMS: usize = 40;
/// Programs that one process runs.
const TOGETHER: usize = 40;

/// A program as a library that a driver loads.
struct Subject {
    name: String,
    library: PathBuf,
    state: usize,
    inputs: Vec<Input>,
    /// The instructions of a scan of each instance; `None` where it has no bound.
    bounds: Vec<Option<u64>>,
}

/// A number that the driver sets before each scan.
struct Input {
    ty: String,
    offset: usize,
}

/// How a subject did.
struct Held {
    name: String,
    most: u64,
    bound: u64,
}

#[test]
fn examples_run_no_more_instructions_than_is_reported() {
    if !have("the instructions of examples", &["cc", "valgrind"], TARGET) {
        return;
    }
    let subjects: Vec<_> =
        examples().into_iter().map(|(name, source, dialect)| built(&name, &source, dialect)).collect();
    let bounded = subjects.iter().filter(|it| it.bounds.iter().all(Option::is_some)).count();
    assert!(bounded * 4 > subjects.len() * 3, "only {bounded} of {} have a bound", subjects.len());
    let median = check(&held(&subjects, 60, "examples"));
    assert!(median <= 2.0, "{median}");
}

#[test]
fn random_programs_run_no_more_instructions_than_is_reported() {
    if !have("the instructions of random programs", &["cc", "valgrind"], TARGET) {
        return;
    }
    let wanted = std::env::var("STAUNCH_BOUNDS").map_or(RANDOM_PROGRAMS, |it| it.parse().unwrap());
    // A WHILE may have no bound: more are made than are run.
    let tried = u64::try_from(wanted + wanted / 8 + 4).unwrap();
    let runtime = runtime();
    let half = |first: u64| {
        let runtime = &runtime;
        move || (first..tried).step_by(2).map(|it| compiled(it, runtime)).collect::<Vec<_>>()
    };
    let mut subjects = std::thread::scope(|scope| {
        let halves = [0, 1].map(|it| scope.spawn(half(it)));
        halves.into_iter().flat_map(|it| it.join().expect("each program is compiled")).collect::<Vec<_>>()
    });
    subjects.retain(|it| it.bounds[0].is_some());
    assert!(subjects.len() >= wanted, "only {} have a bound", subjects.len());
    subjects.truncate(wanted);
    // Few of their scans take the longest way: how close the bound is shows in the examples.
    check(&held(&subjects, 12, "random"));
}

/// No bound is exceeded. Gives how many times as much as was run it is, in the median.
fn check(all: &[Held]) -> f64 {
    let exceeded = |it: &&Held| it.most > it.bound;
    let text = |it: &Held| format!("{}: {} of {}\n", it.name, it.most, it.bound);
    let wrong: String = all.iter().filter(exceeded).map(text).collect();
    assert!(wrong.is_empty(), "more than is reported:\n{wrong}");
    let mut ratios: Vec<f64> = all.iter().map(|it| it.bound as f64 / it.most.max(1) as f64).collect();
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    println!("{} held, {median:.2} in the median, {:.2} at most", all.len(), ratios.last().unwrap());
    median
}

/// The examples, and the programs that are measured, with their dialects.
fn examples() -> Vec<(String, PathBuf, Option<String>)> {
    let files = |folder: &str| {
        let mut found: Vec<_> = fs::read_dir(project().join(folder)).unwrap().map(|it| it.unwrap().path()).collect();
        found.sort();
        found
    };
    let name = |it: &Path| it.file_stem().unwrap().to_str().unwrap().to_owned();
    let has_source = |it: &PathBuf| {
        let is_source = |it: fs::DirEntry| it.path().extension().is_some_and(|it| it == "st" || it == "json");
        it.is_dir() && fs::read_dir(it).unwrap().any(|it| is_source(it.unwrap()))
    };
    // Two programs in a folder.
    let one = |it: PathBuf| if it.ends_with("openplc_garage") { it.join("garage.st") } else { it };
    let of_folder = files("st_examples").into_iter().filter(has_source).map(|it| (name(&it), one(it), None));
    let measured = files("tests/perf/programs").into_iter().map(|it| {
        let text = fs::read_to_string(&it).unwrap();
        let dialect = text.lines().find_map(|line| line.strip_prefix("// dialect: "));
        (format!("perf_{}", name(&it)), it, dialect.and_then(|it| it.split(' ').next()).map(str::to_owned))
    });
    of_folder.chain(measured).collect()
}

fn built(name: &str, source: &Path, dialect: Option<String>) -> Subject {
    let folder = folder(&format!("bounds-{name}"));
    let run = |arguments: &[&str]| {
        let mut command = staunch();
        command.args(arguments).arg("-q").args(dialect.iter().flat_map(|it| ["--dialect", it])).arg(source);
        succeed(command.args(["-A", "warnings"]))
    };
    let archive = folder.join("program.a");
    run(&["build", "--emit", "lib", "-o", archive.to_str().unwrap()]);
    let report = run(&["report", "--message-format", "json"]);
    let report = report.lines().find(|it| it.contains("\"reason\":\"report\"")).unwrap();
    let report: serde_json::Value = serde_json::from_str(report).unwrap();
    let map = run(&["build", "--emit", "map", "-o", "-"]);
    let bound = |instance: &str| {
        let is_run = |it: &&serde_json::Value| it["programs"].as_array().unwrap().iter().any(|it| it == instance);
        report["tasks"].as_array().unwrap().iter().find(is_run).unwrap()["instructions"].as_u64()
    };
    let bounds = instances(&map).map(bound).collect();
    subject(name, &map, bounds, &folder, &archive)
}

/// The runtime's library, with a program that is not linked.
fn runtime() -> PathBuf {
    let folder = folder("bounds-runtime");
    let (source, archive) = (folder.join("main.st"), folder.join("runtime.a"));
    fs::write(&source, "PROGRAM Main END_PROGRAM").unwrap();
    let mut command = staunch();
    succeed(command.args(["build", "-q", "--emit", "lib", "-o"]).arg(&archive).arg(&source));
    archive
}

fn compiled(seed: u64, runtime: &Path) -> Subject {
    let name = format!("random_{seed}");
    let folder = folder(&format!("bounds-{name}"));
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", bounded::program(seed)));
    fs::write(folder.join("program.st"), bounded::program(seed)).unwrap();
    let compiled = staunch_frontend::compile(&sources, &Options::default());
    let program = compiled.program.unwrap_or_else(|| panic!("seed {seed}: {:?}", compiled.diagnostics.first()));
    let target = Target::parse(TARGET).unwrap();
    let made = folder.join("program.o");
    fs::write(&made, object(&program, &target).unwrap()).unwrap();
    let longest = measures(&program, &target).unwrap().longest_scan(&|_, _| true);
    let bound = longest.unknown.is_empty().then_some(longest.instructions);
    let archive = folder.join("program.a");
    let _ = fs::remove_file(&archive);
    succeed(Command::new("ar").arg("rcs").arg(&archive).arg(&made));
    let map = map_text(&program, &Layout::new(&program));
    let subject = subject(&name, &map, vec![bound], &folder, &archive);
    link(&subject, &[&archive, runtime]);
    subject
}

fn instances(map: &str) -> impl Iterator<Item = &str> {
    map.lines().filter_map(|line| line.strip_prefix("instance\t")?.split('\t').nth(1))
}

fn subject(name: &str, map: &str, bounds: Vec<Option<u64>>, folder: &Path, archive: &Path) -> Subject {
    let records = |kind: &'static str| {
        let cells = map.lines().map(|line| line.split('\t').collect::<Vec<_>>());
        cells.filter(move |it| it[0] == kind)
    };
    let state = records("machine").next().unwrap()[1].parse().unwrap();
    let inputs = records("variable").filter(|it| it[3] == "input");
    let input = |it: Vec<&str>| Input { ty: it[4].to_owned(), offset: it[5].parse().unwrap() };
    let inputs = inputs.map(input).filter(|it| !c_type(&it.ty).is_empty()).collect();
    let subject = Subject { name: name.to_owned(), library: folder.join("program.so"), state, inputs, bounds };
    if !name.starts_with("random") {
        link(&subject, &[archive]);
    }
    subject
}

fn link(subject: &Subject, archives: &[&Path]) {
    let mut command = Command::new("cc");
    command.args(["-shared", "-Wl,-u,staunch_scan", "-Wl,-u,staunch_init", "-Wl,-Bsymbolic", "-o"]);
    // What is implemented outside is never called.
    succeed(command.arg(&subject.library).args(archives).arg("-lm"));
}

fn c_type(ty: &str) -> &'static str {
    match ty {
        "BOOL" => "bool",
        "SINT" | "USINT" | "BYTE" => "int8_t",
        "INT" | "UINT" | "WORD" => "int16_t",
        "DINT" | "UDINT" | "DWORD" => "int32_t",
        "LINT" | "ULINT" | "LWORD" => "int64_t",
        "REAL" => "float",
        "LREAL" => "double",
        _ => "",
    }
}

/// Runs the scans of all that have a bound, and counts each.
fn held(subjects: &[Subject], scans: usize, name: &str) -> Vec<Held> {
    let bounded: Vec<&Subject> = subjects.iter().filter(|it| it.bounds.iter().all(Option::is_some)).collect();
    let mut all = Vec::new();
    for (number, group) in bounded.chunks(TOGETHER).enumerate() {
        let counts = counts(group, scans, &format!("bounds-{name}-{number}"));
        let mut rest = counts.as_slice();
        for subject in group {
            let (own, others) = rest.split_at(scans * subject.bounds.len());
            rest = others;
            for (at, bound) in subject.bounds.iter().enumerate() {
                let most = own.iter().skip(at).step_by(subject.bounds.len()).max().copied().unwrap();
                all.push(Held { name: subject.name.clone(), most, bound: bound.unwrap() });
            }
        }
        assert!(rest.is_empty(), "{} counts too many", rest.len());
    }
    all
}

/// The instructions of each call of `staunch_scan`, in their order.
fn counts(group: &[&Subject], scans: usize, name: &str) -> Vec<u64> {
    let folder = folder(name);
    for old in fs::read_dir(&folder).unwrap() {
        fs::remove_file(old.unwrap().path()).unwrap();
    }
    fs::write(folder.join("driver.c"), driver(group, scans)).unwrap();
    let program = folder.join("driver");
    let mut cc = Command::new("cc");
    succeed(cc.current_dir(&folder).args(["-O1", "driver.c", "-ldl", "-o"]).arg(&program));
    let out = folder.join("count");
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--toggle-collect=staunch_scan", "--dump-after=staunch_scan"]);
    succeed(valgrind.arg(format!("--callgrind-out-file={}", out.display())).arg(&program));
    let total = |number: usize| {
        let text = fs::read_to_string(out.with_extension(number.to_string())).ok()?;
        let total = text.lines().find_map(|it| it.strip_prefix("totals: "))?;
        Some(total.split(' ').next()?.parse().unwrap())
    };
    (1..).map_while(total).collect()
}

/// C that loads each program, and sets its inputs to all kinds of values before each scan.
fn driver(group: &[&Subject], scans: usize) -> String {
    let mut text = "#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
typedef struct { int64_t now; bool first_scan; uint64_t turns; int64_t cycle; } staunch_context;
static uint64_t seed = 88172645463325252u;
static int64_t draw(void) {
    seed ^= seed << 13; seed ^= seed >> 7; seed ^= seed << 17;
    return seed & 64 ? (int64_t)(seed >> 8) % 12 : (int64_t)seed;
}
static void run(const char *library, size_t size, uint32_t instances, void (*set)(uint8_t *)) {
    void *loaded = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    if (!loaded) { fputs(dlerror(), stderr); exit(1); }
    void (*init)(uint8_t *) = dlsym(loaded, \"staunch_init\");
    uint64_t (*scan)(uint8_t *, staunch_context *, uint32_t) = dlsym(loaded, \"staunch_scan\");
    uint8_t *state = aligned_alloc(64, size / 64 * 64 + 64);
    init(state);
"
    .to_owned();
    text += &format!("    for (int s = 0; s < {scans}; s++) {{\n        set(state);\n");
    text += "        for (uint32_t it = 0; it < instances; it++) {
            staunch_context cx = { s * 10000000ll, s == 0, 10000000, 10000000 };
            scan(state, &cx, it);
        }
    }
}
";
    let mut calls = String::new();
    for (number, subject) in group.iter().enumerate() {
        text += &format!("static void set_{number}(uint8_t *state) {{\n");
        for Input { ty, offset } in &subject.inputs {
            let value = match ty.as_str() {
                "BOOL" => "draw() & 1",
                "REAL" | "LREAL" => "draw() % 2000 / 7.0",
                _ => "draw()",
            };
            text += &format!("    *({} *)(state + {offset}) = {value};\n", c_type(ty));
        }
        text += "}\n";
        let (library, size, instances) = (subject.library.display(), subject.state, subject.bounds.len());
        calls += &format!("    run(\"{library}\", {size}, {instances}, set_{number});\n");
    }
    format!("{text}int main(void) {{\n{calls}    return 0;\n}}\n")
}
