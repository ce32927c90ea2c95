//! Native objects of all cases for each machine, and which names they may need in addition to the runtime's.

use crate::module::put;
use staunch_native::{Target, object};
use staunch_tests::{case, cases};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Machines that native code is made for.
pub const TARGETS: [&str; 3] = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "riscv64gc-unknown-linux-gnu"];

pub fn write(folder: &Path) -> Result<String, String> {
    let targets = TARGETS.map(|it| (folder.join(it), Target::parse(it)));
    for (folder, _) in &targets {
        fs::create_dir_all(folder).map_err(|it| it.to_string())?;
    }
    let (mut declared, mut count) = (BTreeSet::new(), 0);
    for case in case::discover(&cases()).0 {
        let Some(program) = case.compile().1.program else { continue };
        for (folder, target) in &targets {
            let target = target.as_ref().map_err(ToString::to_string)?;
            let object = object(&program, target).map_err(|it| format!("{}: {it}", case.name))?;
            put(&folder.join(format!("{}.o", case.module())), object)?;
        }
        declared.extend(program.externals().iter().map(|it| it.symbol.clone()));
        count += 1;
    }
    let declared: Vec<_> = declared.iter().map(|it| format!("{it}\n")).collect();
    put(&folder.join("declared"), declared.concat())?;
    Ok(format!("{count} programs for {} machines, {} names declared", TARGETS.len(), declared.len()))
}
