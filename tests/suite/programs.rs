//! Random programs do the same on the interpreter and as generated Rust. That they do so on the
//! interpreter, as native code and on the witness is tested in `staunch-witness`, on many more.

use staunch_frontend::{Options, Source, Sources};
use staunch_host::Machine;
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;
use staunch_tests::random;

#[test]
fn random_programs_agree_as_generated_rust() {
    let compared = random::seeds().filter(|seed| agree(*seed)).count();
    assert!(compared > 10, "{compared} were compared");
}

/// Whether the program was compared: `check` refuses a few.
fn agree(seed: u64) -> bool {
    let text = random::program(seed);
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", text.clone()));
    let compilation = staunch_frontend::compile(&sources, &Options::default());
    let Some(program) = &compilation.program else { return false };
    let leaves = Leaves::new(program);
    let executors = [Executor::Interpreter, Executor::Rust];
    let mut machines = executors.map(|it| it.machine(program, &random::module(seed)).unwrap());
    for scan in 0..random::SCANS {
        let ends = machines.each_mut().map(|it: &mut Box<dyn Machine + '_>| it.scan(0, &random::context(scan)));
        let [a, b] = machines.each_ref().map(|it| leaves.of(it.state()));
        let different = a.iter().zip(&b).find(|(a, b)| a != b);
        assert!(different.is_none(), "seed {seed}, scan {scan}: {different:?}\n{text}");
        assert_eq!(ends[0], ends[1], "seed {seed}, scan {scan}\n{text}");
    }
    true
}
