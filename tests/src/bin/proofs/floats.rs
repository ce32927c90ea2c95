//! The cases that compute with floats: as Rust, as objects of three machines, and with what they do here.

use crate::module::{Printed, entries, program, put};
use crate::objects;
use crate::record::Recorder;
use staunch_host::{Error, Map, Options, run};
use staunch_ir::Program;
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;
use staunch_native::{Target, object_named};
use staunch_runtime::Context;
use staunch_tests::case::{self, Case, Pin};
use staunch_tests::execute::Executor;
use staunch_tests::scan::Table;
use staunch_tests::{cases, folder as tests};
use std::fs;
use std::path::Path;

pub fn write(folder: &Path) -> Result<String, String> {
    let (all, _) = case::discover(&cases());
    fs::create_dir_all(folder).map_err(|it| it.to_string())?;
    let (mut modules, mut record, mut size, mut parts, mut scans) = (Vec::new(), Vec::new(), 0, 0, 0);
    for case in all.iter().filter(|it| it.pins.contains(&Pin::Scan)) {
        let Some(program) = program(case) else { continue };
        let printed = Printed::new(case.module(), &program);
        if !printed.has_floats() {
            continue;
        }
        printed.write(folder)?;
        let prefix = format!("case{}", modules.len());
        for target in objects::TARGETS {
            let target_of = Target::parse(target).map_err(|it| it.to_string())?;
            let object = object_named(&program, &target_of, &prefix).map_err(|it| format!("{}: {it}", case.name))?;
            fs::create_dir_all(folder.join(target)).map_err(|it| it.to_string())?;
            put(&folder.join(target).join(format!("{prefix}.o")), object)?;
        }
        let drive = drive(case, &program, &folder.join("drive"))?;
        for bytes in [case.name.as_bytes(), &drive.bytes] {
            record.extend_from_slice(&u32::try_from(bytes.len()).map_err(|it| it.to_string())?.to_le_bytes());
            record.extend_from_slice(bytes);
        }
        size = size.max(usize::try_from(Layout::new(&program).machine.size).map_err(|it| it.to_string())?);
        (parts, scans) = (parts.max(drive.parts), scans + drive.scans);
        modules.push(printed.module);
    }
    let names = || modules.iter().map(String::as_str);
    for (kind, text) in [("rust", entries(names(), folder, "super::drive")?), ("native", symbols(modules.len()))] {
        let kind = folder.join(kind);
        fs::create_dir_all(&kind).map_err(|it| it.to_string())?;
        put(&kind.join("entries.rs"), text)?;
        put(&kind.join("record"), &record)?;
        put(&kind.join("size"), size.to_string())?;
        put(&kind.join("parts"), parts.to_string())?;
        for file in ["hash.rs", "drive.rs", "hosted.rs", "bare.rs"] {
            fs::copy(tests().join("proofs").join(file), kind.join(file)).map_err(|it| it.to_string())?;
        }
    }
    Ok(format!("{} programs, {scans} scans", modules.len()))
}

/// The entry points of objects.
fn symbols(count: usize) -> String {
    let declared = |at| {
        format!(
            "    fn case{at}_init(state: *mut u8);\n    \
             fn case{at}_scan(state: *mut u8, cx: *const Context, instance: u32) -> u64;\n"
        )
    };
    let entry = |at| format!("    Entry {{ init: case{at}_init, scan: case{at}_scan }},\n");
    let (declared, entries): (String, String) = ((0..count).map(declared).collect(), (0..count).map(entry).collect());
    format!(
        "//! Programs.\n\nextern crate staunch_runtime_abi as _;\nuse super::drive::Entry;\nuse staunch_runtime::Context;\n\n\
         unsafe extern \"C\" {{\n{declared}}}\n\npub const ENTRIES: &[Entry] = &[\n{entries}];\n"
    )
}

struct Drive {
    bytes: Vec<u8>,
    parts: usize,
    scans: usize,
}

/// The case's run on the interpreter, as its `.scan` says it.
fn drive(case: &Case, program: &Program, folder: &Path) -> Result<Drive, String> {
    let wrong = |it: &dyn std::fmt::Display| format!("{}: {it}", case.name);
    let table = Table::parse(&case.pinned(Pin::Scan)).map_err(|it| wrong(&it))?;
    let settings = case.settings();
    let mut machine = Executor::Interpreter.machine(program, "").map_err(|it| wrong(&it))?;
    let map = Map::parse(&map_text(program, &Layout::new(program))).map_err(|it| wrong(&it))?;
    fs::create_dir_all(folder).map_err(|it| it.to_string())?;
    let stimulus = folder.join(format!("{}.csv", case.module()));
    put(&stimulus, table.stimulus())?;
    let options = Options {
        scans: table.scans().last().copied(),
        cycle: settings.cycle.as_deref().map(staunch_host::parse_duration).transpose()?,
        loop_budget: settings.loop_budget,
        stimulus: Some(stimulus),
        quiet: true,
        ..Options::default()
    };
    let turns = settings.loop_budget.unwrap_or(Context::TURNS);
    let mut recorder = Recorder::new(machine.as_mut(), program, turns);
    match run(&mut recorder, &map, &options) {
        Ok(_) | Err(Error::Fault { .. }) => {}
        Err(error) => return Err(wrong(&error)),
    }
    Ok(Drive { bytes: recorder.bytes(), parts: recorder.parts(), scans: recorder.scans() })
}
