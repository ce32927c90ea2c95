//! All cases in crates of some, each of which a link must succeed of.

use crate::module::{Printed, entries, program, put};
use staunch_tests::{case, cases, folder as tests};
use std::fs;
use std::path::Path;

/// What rustc optimises at once, in a time and a memory that small machines have.
const BATCH: usize = 60;

const CAREFUL: &str = "//! Nothing more.\n\npub fn called(_: usize, _: *const usize) -> i32 {\n    0\n}\n";
const CARELESS: &str =
    "//! It may panic.\n\npub fn called(at: usize, _: *const usize) -> i32 {\n    [3, 5, 7][at]\n}\n";
const ALLOCATING: &str =
    "//! It allocates.\n\nextern crate alloc;\n\npub fn called(at: usize, _: *const usize) -> i32 {
    alloc::boxed::Box::leak(alloc::boxed::Box::new([at, at + 1])).as_ptr() as usize as i32\n}\n";
const UNSAFE: &str =
    "//! It is unsafe.\n#![forbid(unsafe_code)]\n\npub fn called(at: usize, from: *const usize) -> i32 {
    unsafe { *from.add(at) as i32 }\n}\n";

pub fn write(folder: &Path) -> Result<String, String> {
    let (all, _) = case::discover(&cases());
    let mut modules = Vec::new();
    for case in &all {
        let Some(program) = program(case) else { continue };
        let printed = Printed::new(case.module(), &program);
        if !printed.is_safe() {
            return Err(format!("{}: its Rust does not forbid unsafe code", case.name));
        }
        printed.write(folder)?;
        modules.push(printed.module);
    }
    let batches = modules.chunks(BATCH).enumerate();
    batches.clone().try_for_each(|(at, it)| batch(folder, &format!("batch_{at}"), it, CAREFUL))?;
    // A probe that cannot fail would prove nothing.
    let some = &modules[..1];
    batch(folder, "refused_panic", some, CARELESS)?;
    batch(folder, "refused_allocation", some, ALLOCATING)?;
    batch(folder, "refused_unsafe", some, UNSAFE)?;
    Ok(format!("{} programs in {} crates", modules.len(), batches.len()))
}

fn batch(folder: &Path, name: &str, modules: &[String], more: &str) -> Result<(), String> {
    let batch = folder.join(name);
    fs::create_dir_all(&batch).map_err(|it| it.to_string())?;
    let main = fs::read_to_string(tests().join("proofs/linked.rs")).map_err(|it| it.to_string())?;
    put(&batch.join("main.rs"), main)?;
    put(&batch.join("entries.rs"), entries(modules.iter().map(String::as_str), folder, "super")?)?;
    put(&batch.join("more.rs"), more)
}
