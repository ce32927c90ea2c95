//! Compiles every case that runs, every counter vector and every operation to Rust, as modules
//! that the crate includes: what is tested is what the Rust back end prints.
//!
//! Also lists the cases, so that each is a test with a name of its own.

#[path = "src/case.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod case;
#[path = "src/long_line.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod long_line;
#[path = "src/operation.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod operation;
#[path = "src/pointers.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod pointers;
#[path = "src/random.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod random;
#[path = "src/rows.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod rows;
#[path = "src/vector.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod vector;

use case::{Case, Pin};
use staunch_frontend::{Dialect, Options, Source, Sources};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

fn main() {
    for path in [
        "build.rs",
        "src/case.rs",
        "src/long_line.rs",
        "src/operation.rs",
        "src/pointers.rs",
        "src/random.rs",
        "src/rows.rs",
        "src/vector.rs",
        "cases",
        "vectors",
    ] {
        println!("cargo::rerun-if-changed={path}");
    }
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let (cases, _) = case::discover(Path::new("cases"));
    let mut subjects: Vec<Subject> = cases.iter().filter_map(Subject::case).collect();
    let vectors = fs::read_to_string("vectors/counters.json").expect("the vectors are there");
    subjects.extend(vector::read(&vectors).into_iter().map(|it| Subject::text(&it.module(), it.source, it.options)));
    let seeds = random::seeds();
    subjects.extend(seeds.map(|seed| Subject::text(&random::module(seed), random::program(seed), Options::default())));
    let codesys = || Options { dialect: Dialect::Codesys, ..Options::default() };
    let pointers = 0..pointers::PRINTED;
    subjects.extend(pointers.map(|it| Subject::text(&pointers::module(it), pointers::program(it), codesys())));
    subjects.push(Subject::text("rows", rows::program(), Options::default()));
    subjects.push(Subject::text(long_line::MODULE, long_line::program(), Options::default()));
    let operations = || Some(operation::program(&operation::Task::all()));
    subjects.push(Subject { module: "operations".to_owned(), compile: Box::new(operations) });

    let mut generated = Generated { folder: out.join("generated"), modules: String::new(), entries: String::new() };
    let _ = fs::remove_dir_all(&generated.folder);
    for (subject, printed) in subjects.iter().zip(print_all(&subjects)) {
        if let Some(printed) = printed {
            generated.add(&subject.module, &printed);
        }
    }
    generated.write(&out.join("generated.rs"));
    fs::write(out.join("golden_tests.rs"), golden_tests(&cases)).expect("the list of cases is written");
}

/// A program to print, and the module that it becomes.
struct Subject<'a> {
    module: String,
    compile: Box<dyn Fn() -> Option<Program> + Send + Sync + 'a>,
}

impl<'a> Subject<'a> {
    fn case(case: &'a Case) -> Option<Self> {
        let runs = case.pins.contains(&Pin::Scan);
        runs.then(|| Self { module: case.module(), compile: Box::new(|| case.compile().1.program) })
    }

    fn text(module: &str, text: String, options: Options) -> Self {
        let compile = move || {
            let mut sources = Sources::default();
            sources.add(Source::new("program.st", text.clone()));
            staunch_frontend::compile(&sources, &options).program
        };
        Self { module: module.to_owned(), compile: Box::new(compile) }
    }

    /// What does not compile, or breaks the back end, is missing in the crate: its test says so.
    fn print(&self) -> Option<Printed> {
        let printed = || (self.compile)().map(|program| Printed::new(&program));
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(printed)).ok().flatten()
    }
}

struct Printed {
    code: String,
    glue: String,
}

impl Printed {
    fn new(program: &Program) -> Self {
        let options = staunch_rust::Options::default();
        let map = staunch_ir::symbols::map_text(program, &Layout::new(program));
        let glue = staunch_rust::emit_glue(program, "super::code", &map, &options);
        // Many programs are in one crate: their entry points are distinguished by their modules.
        Self { code: staunch_rust::emit(program, &options), glue: glue.replace("#[unsafe(no_mangle)]\n", "") }
    }
}

/// Prints them on all processors; each result is at the place of its subject.
fn print_all(subjects: &[Subject<'_>]) -> Vec<Option<Printed>> {
    let slots: Vec<OnceLock<Option<Printed>>> = subjects.iter().map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some((subject, slot)) = {
            let at = next.fetch_add(1, Ordering::Relaxed);
            subjects.get(at).zip(slots.get(at))
        } {
            let _ = slot.set(subject.print());
        }
    };
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..workers).for_each(|_| drop(scope.spawn(work))));
    slots.into_iter().map(|it| it.into_inner().flatten()).collect()
}

struct Generated {
    folder: PathBuf,
    modules: String,
    entries: String,
}

impl Generated {
    fn add(&mut self, module: &str, printed: &Printed) {
        let folder = self.folder.join(module);
        fs::create_dir_all(&folder).expect("the folder of a module is made");
        for (file, text) in [("code.rs", &printed.code), ("glue.rs", &printed.glue)] {
            let path = folder.join(file);
            fs::write(&path, text).expect("a module is written");
        }
        let path = |file: &str| folder.join(file).display().to_string();
        let _ = writeln!(
            self.modules,
            "mod {module} {{\n    #[path = {:?}]\n    pub mod code;\n    #[path = {:?}]\n    pub mod glue;\n}}",
            path("code.rs"),
            path("glue.rs")
        );
        let _ = writeln!(
            self.entries,
            "    Entry {{\n        name: {module:?},\n        \
             map: &{module}::glue::staunch_map,\n        map_len: {module}::glue::staunch_map_len,\n        \
             init: {module}::glue::staunch_init,\n        scan: {module}::glue::staunch_scan,\n    }},"
        );
    }

    fn write(&self, path: &Path) {
        let Self { modules, entries, .. } = self;
        let text = format!("{modules}\npub(super) const ENTRIES: &[Entry] = &[\n{entries}];\n");
        fs::write(path, text).expect("the list of modules is written");
    }
}

fn golden_tests(cases: &[Case]) -> String {
    let test = |case: &Case| format!("#[test]\nfn {}() {{\n    check({:?});\n}}\n", case.module(), case.name);
    cases.iter().map(test).collect()
}
