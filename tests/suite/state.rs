//! Whatever bytes a host writes into a state, the executors find the same values in it, and then do
//! the same.

use staunch_host::{Domain, Machine, Map};
use staunch_ir::Program;
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::symbols::map_text;
use staunch_runtime::{Context, Fault};
use staunch_tests::case::{self, Pin};
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;
use staunch_tests::{cases, random};

/// Forged states of each program.
const STATES: u64 = 4;
const SCANS: u64 = 3;
/// Forged bounds make loops of up to 2^63 turns.
const TURNS: u64 = 2_000;
/// Larger states hold the same types more often.
const LARGE: usize = 1 << 16;

#[test]
fn cases_agree_on_any_bytes() {
    let (cases, _) = case::discover(&cases());
    let mut scans = 0;
    for case in cases.iter().filter(|it| it.pins.contains(&Pin::Scan)) {
        if let Some(program) = case.compile().1.program {
            scans += forge(&program, &case.module(), &case.name);
        }
    }
    assert!(scans > 1000, "only {scans} scans were compared");
}

#[test]
fn random_programs_agree_on_any_bytes() {
    for seed in random::seeds() {
        let mut sources = staunch_frontend::Sources::default();
        sources.add(staunch_frontend::Source::new("program.st", random::program(seed)));
        // `check` refuses a few.
        if let Some(program) = staunch_frontend::compile(&sources, &staunch_frontend::Options::default()).program {
            forge(&program, &random::module(seed), &format!("seed {seed}"));
        }
    }
}

/// Runs a program from states of any bytes, and gives the number of scans that were compared.
fn forge(program: &Program, module: &str, name: &str) -> u64 {
    let map = Map::parse(&map_text(program, Leaves::new(program).layout())).unwrap();
    if map.size > LARGE || map.instances.is_empty() {
        return 0;
    }
    let reference = Interpreter::new(program);
    let machines = [Executor::Rust, Executor::Native];
    let machines = machines.map(|it| it.machine(program, module).unwrap_or_else(|error| panic!("{name}: {error}")));
    let (domain, mut all_set) = (Domain::of(&map), vec![0; map.size]);
    domain.write(&mut all_set, 0, &vec![0xFF; map.size]);
    let is_padding = all_set.iter().map(|byte| *byte == 0).collect();
    let mut forger = Forger { program, name, domain, is_padding, reference, machines };
    (0..STATES).map(|seed| forger.scans(seed, map.size, map.instances.len())).sum()
}

struct Forger<'p> {
    program: &'p Program,
    name: &'p str,
    domain: Domain,
    /// What Rust leaves there when it copies a structure is undefined.
    is_padding: Vec<bool>,
    reference: Interpreter<'p>,
    machines: [Box<dyn Machine + 'p>; 2],
}

impl Forger<'_> {
    fn scans(&mut self, seed: u64, size: usize, instances: usize) -> u64 {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        let bytes = random.bytes(size);
        self.domain.write(self.reference.state_mut(), 0, &bytes);
        self.machines.iter_mut().for_each(|it| it.write(0, &bytes));
        self.same(0);
        let scans = (0..SCANS).flat_map(|scan| (0..instances).map(move |instance| (scan, instance)));
        for (scan, instance) in scans {
            // The clock is anywhere, too: a forged file may say so.
            let now = if seed == 0 { i64::try_from(scan).unwrap() } else { random.next().cast_signed() };
            let cx = || Context::new(now, scan == 0 && seed.is_multiple_of(2)).with_turns(TURNS);
            let end = match self.reference.scan(instance, &cx()) {
                Ok(()) => Ok(()),
                Err(Stop::Fault(fault)) => Err(fault),
                Err(Stop::OutOfSteps) => unreachable!("the number of steps is not limited"),
            };
            self.scan(instance, cx, end);
            self.same(scan + 1);
        }
        SCANS
    }

    fn scan(&mut self, instance: usize, cx: impl Fn() -> Context, end: Result<(), Fault>) {
        for machine in &mut self.machines {
            assert_eq!(machine.scan(instance, &cx()), end, "{}", self.name);
        }
    }

    /// The variables are equal, and their bytes are values of their types.
    fn same(&self, scan: u64) {
        let leaves = Leaves::new(self.program);
        let expected = leaves.of(self.reference.state());
        for machine in &self.machines {
            let found = leaves.of(machine.state());
            let different = expected.iter().zip(&found).find(|(a, b)| a != b);
            assert!(different.is_none(), "{}, scan {scan}: {different:?}", self.name);
        }
        let states = self.machines.iter().map(|it| it.state()).chain([self.reference.state()]);
        for (who, state) in ["Rust", "native", "interpreter"].iter().zip(states) {
            let mut settled = state.to_vec();
            self.domain.write(&mut settled, 0, state);
            let different = (0..state.len()).find(|at| state[*at] != settled[*at] && !self.is_padding[*at]);
            assert!(
                different.is_none(),
                "{}, {who}, scan {scan}: byte {different:?} is not part of a value",
                self.name
            );
        }
    }
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Any bytes, more of them those at which types end.
    fn bytes(&mut self, count: usize) -> Vec<u8> {
        const EDGES: [u8; 8] = [0, 1, 2, 0x7F, 0x80, 0xFE, 0xFF, 3];
        let mut byte = || {
            let number = self.next();
            if number & 1 == 0 { (number >> 8) as u8 } else { EDGES[(number >> 8) as usize % EDGES.len()] }
        };
        (0..count).map(|_| byte()).collect()
    }
}
