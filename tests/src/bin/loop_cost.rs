//! Runs each PROGRAM of a file in native code, without turns and as it is, for callgrind to count the second scan of each:
//! `.ci/loop-cost`.

use staunch_frontend::{Dialect, Options, Source, Sources};
use staunch_host::Machine;
use staunch_ir::{Block, StatementKind, Taking};
use staunch_runtime::Context;
use staunch_tests::execute::Executor;

fn main() -> Result<(), String> {
    let path = std::env::args().nth(1).ok_or("the file is missing")?;
    let mut sources = Sources::default();
    sources.add(Source::decode("loops.st", &std::fs::read(path).map_err(|it| it.to_string())?));
    let options = Options { dialect: Dialect::Codesys, ..Options::default() };
    let taken = staunch_frontend::compile(&sources, &options).program.ok_or("the file has errors")?;
    let mut plain = taken.clone();
    plain.routines.iter_mut().for_each(|it| without_turns(&mut it.body));
    let mut machines = [Executor::Native.machine(&plain, "")?, Executor::Native.machine(&taken, "")?];
    for instance in 0..taken.instances.len() {
        for machine in &mut machines {
            machine.scan(instance, &Context::first(0)).map_err(|it| format!("{it:?}"))?;
            measured(machine.as_mut(), instance);
        }
    }
    Ok(())
}

#[inline(never)]
fn measured(machine: &mut dyn Machine, instance: usize) {
    let end = machine.scan(instance, &Context::at(0));
    assert!(end.is_ok(), "{end:?}");
}

fn without_turns(block: &mut Block) {
    block.retain(|it| !matches!(it.kind, StatementKind::Turn));
    for statement in block {
        match &mut statement.kind {
            StatementKind::For(it) => it.taking = Taking::Each,
            StatementKind::Loop { count, .. } => *count = None,
            _ => {}
        }
        statement.kind.blocks_mut().into_iter().for_each(without_turns);
    }
}
