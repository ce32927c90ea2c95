//! `staunch doctor`: which targets this machine can build for, and what to type where something is missing.

use crate::args::{Doctor, Opt};
use crate::{USAGE, linker, output, rustc};
use staunch_native::Target;
use std::fmt::Write as _;

/// The targets that are asked for where none is named: those that the tests build for.
const TARGETS: [&str; 4] = [
    "aarch64-unknown-linux-gnu",
    "riscv64gc-unknown-linux-gnu",
    "armv7-unknown-linux-gnueabihf",
    "thumbv7em-none-eabihf",
];

/// Something to make for a target, and what it lacks.
struct Need {
    what: &'static str,
    missing: Option<String>,
}

/// Prints the list. A target that is asked for by name must be complete, and so must this machine.
pub fn doctor(args: &Doctor) -> Result<u8, String> {
    let host = linker::host();
    let asked: Vec<String> = args.target.iter().map(|it| crate::build::full_name(it)).collect();
    let named: Vec<&str> = if asked.is_empty() { vec![host] } else { asked.iter().map(String::as_str).collect() };
    let others: &[&str] = if asked.is_empty() { &TARGETS } else { &[] };
    let mut text = String::new();
    let mut is_complete = true;
    for target in &named {
        is_complete &= show(&mut text, target);
    }
    for target in others.iter().filter(|it| **it != host) {
        show(&mut text, target);
    }
    output::print(text.as_bytes())?;
    Ok(if is_complete { 0 } else { USAGE })
}

/// Whether everything for the target is available.
fn show(text: &mut String, target: &str) -> bool {
    let is_host = linker::is_host(target);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{target}{}", if is_host { ", this machine" } else { "" });
    let needs = needs(target, is_host);
    for Need { what, missing } in &needs {
        let _ = match missing {
            None => writeln!(text, "       ok  {what}"),
            Some(missing) => writeln!(text, "  missing  {what}: {missing}"),
        };
    }
    needs.iter().all(|it| it.missing.is_none())
}

fn needs(target: &str, is_host: bool) -> Vec<Need> {
    let foreign = Some(target).filter(|_| !is_host);
    let compiler = rustc::find(foreign, Opt::Speed).err();
    let linker = linker::find(foreign).err();
    let has_system = !target.contains("-none");
    let mut needs = Vec::new();
    if is_host || Target::parse(target).is_ok() {
        // For this machine the command carries the runtime as a library.
        let runtime = compiler.clone().filter(|_| !is_host);
        needs.push(Need { what: "an object of native code", missing: None });
        needs.push(Need { what: "an executable of native code", missing: linker.clone().or(runtime) });
    }
    let rust = if has_system { compiler.or(linker) } else { compiler };
    let what = if has_system { "an executable through Rust" } else { "a library through Rust" };
    needs.push(Need { what, missing: rust });
    needs
}
