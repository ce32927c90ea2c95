//! Compiles every case that runs, every counter vector and every operation to Rust, as modules
//! that the crate includes: what is tested is what the Rust back end prints.
//!
//! Also lists the cases, so that each is a test with a name of its own.

#[path = "src/case.rs"]
#[allow(dead_code, reason = "the crate uses more of it")]
mod case;
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

fn main() {
    for path in [
        "build.rs",
        "src/case.rs",
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
    let mut generated = Generated { folder: out.join("generated"), modules: String::new(), entries: String::new() };
    let _ = fs::remove_dir_all(&generated.folder);
    cases.iter().for_each(|it| generated.case(it));
    generated.vectors();
    random::seeds().for_each(|seed| generated.text(&random::module(seed), random::program(seed), &Options::default()));
    let codesys = Options { dialect: Dialect::Codesys, ..Options::default() };
    (0..pointers::PRINTED).for_each(|seed| generated.text(&pointers::module(seed), pointers::program(seed), &codesys));
    generated.text("rows", rows::program(), &Options::default());
    generated.add("operations", &operation::program(&operation::Task::all()));
    generated.write(&out.join("generated.rs"));
    fs::write(out.join("golden_tests.rs"), golden_tests(&cases)).expect("the list of cases is written");
}

struct Generated {
    folder: PathBuf,
    modules: String,
    entries: String,
}

impl Generated {
    fn case(&mut self, case: &Case) {
        if !case.pins.contains(&Pin::Scan) {
            return;
        }
        // A case that does not compile, or breaks the back end, is missing here: its test says so.
        let program = std::panic::catch_unwind(|| case.compile().1.program);
        if let Ok(Some(program)) = program {
            self.add(&case.module(), &program);
        }
    }

    fn vectors(&mut self) {
        let text = fs::read_to_string("vectors/counters.json").expect("the vectors are there");
        for vector in vector::read(&text) {
            self.text(&vector.module(), vector.source.clone(), &vector.options);
        }
    }

    fn text(&mut self, module: &str, text: String, options: &Options) {
        let mut sources = Sources::default();
        sources.add(Source::new("program.st", text));
        if let Some(program) = staunch_frontend::compile(&sources, options).program {
            self.add(module, &program);
        }
    }

    fn add(&mut self, module: &str, program: &Program) {
        let Ok((code, glue)) = std::panic::catch_unwind(|| print(program)) else { return };
        let folder = self.folder.join(module);
        fs::create_dir_all(&folder).expect("the folder of a module is made");
        for (file, text) in [("code.rs", code), ("glue.rs", glue)] {
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

fn print(program: &Program) -> (String, String) {
    let options = staunch_rust::Options::default();
    let map = staunch_ir::symbols::map_text(program, &Layout::new(program));
    let glue = staunch_rust::emit_glue(program, "super::code", &map, &options);
    // Many programs are in one crate: their entry points are told apart by their modules.
    (staunch_rust::emit(program, &options), glue.replace("#[unsafe(no_mangle)]\n", ""))
}

fn golden_tests(cases: &[Case]) -> String {
    let test = |case: &Case| format!("#[test]\nfn {}() {{\n    check({:?});\n}}\n", case.module(), case.name);
    cases.iter().map(test).collect()
}
