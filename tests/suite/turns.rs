//! Compiled code takes the turns of loops in its own ways, many at once where it can. The result does not differ from
//! taking them as the interpreter does: for every budget a scan ends in the same way.

use staunch_host::Machine;
use staunch_ir::interpret::{Interpreter, Stop};
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{FieldId, Program};
use staunch_runtime::Context;
use staunch_tests::case;
use staunch_tests::cases;
use staunch_tests::execute::Executor;
use staunch_tests::leaf::Leaves;

const CASE: &str = "loops/of_every_kind";
const KINDS: i16 = 24;
/// The two other inputs.
const INPUTS: [[i16; 2]; 7] = [[0, 0], [3, 1], [7, 2], [12, 5], [-4, 3], [30, 40], [-9, -2]];
/// Each budget up to here, and then one that suffices for all loops that end soon.
const BUDGETS: u64 = 48;
const LARGE: u64 = 5_000;
/// Around what a loop may have without taking any.
const MANY: [[i16; 2]; 6] = [[1023, 3], [1024, 3], [1025, 12], [3, 1030], [1030, -1], [-1030, -2055]];

#[test]
fn loops_end_alike_at_every_budget() {
    let (cases, _) = case::discover(&cases());
    let case = cases.iter().find(|it| it.name == CASE).unwrap();
    let program = case.compile().1.program.unwrap();
    let machines = [Executor::Rust, Executor::Native].map(|it| it.machine(&program, &case.module()).unwrap());
    let mut sweep = Sweep { program: &program, machines, faulted: 0, ended: 0 };
    for kind in 0..KINDS {
        for [n, m] in INPUTS {
            (0..BUDGETS).chain([LARGE]).for_each(|budget| sweep.scan([kind, n, m], budget));
        }
        for [n, m] in MANY {
            let around = Context::FREE_TURNS - 3..Context::FREE_TURNS + 9;
            [0, 1, LARGE].into_iter().chain(around).for_each(|budget| sweep.scan([kind, n, m], budget));
        }
    }
    assert!(sweep.faulted > 1000 && sweep.ended > 1000, "{} faults, {} ends", sweep.faulted, sweep.ended);
}

struct Sweep<'p> {
    program: &'p Program,
    machines: [Box<dyn Machine + 'p>; 2],
    faulted: usize,
    ended: usize,
}

impl Sweep<'_> {
    fn scan(&mut self, inputs: [i16; 3], budget: u64) {
        let cx = || Context::new(0, false).with_turns(budget);
        let mut reference = Interpreter::new(self.program);
        let start = self.offset();
        for (at, value) in inputs.iter().enumerate() {
            reference.state_mut()[start + 2 * at..][..2].copy_from_slice(&value.to_le_bytes());
        }
        let before = reference.state().to_vec();
        let contexts: [Context; 3] = std::array::from_fn(|_| cx());
        self.machines.iter_mut().for_each(|it| it.write(0, &before));
        let leaves = Leaves::new(self.program);
        // The second scan has the turns that the first one left.
        for scan in 0..2 {
            let end = reference.scan(0, &contexts[0]).map_err(|it| match it {
                Stop::Fault(fault) => fault,
                Stop::OutOfSteps => unreachable!("the number of steps is not limited"),
            });
            let expected = leaves.of(reference.state());
            for ((machine, cx), who) in self.machines.iter_mut().zip(&contexts[1..]).zip(["Rust", "native"]) {
                let what = format!("{who}, kind, n, m: {inputs:?}, budget {budget}, scan {scan}");
                assert_eq!(machine.scan(0, cx), end, "{what}");
                let found = leaves.of(machine.state());
                let different = expected.iter().zip(&found).find(|(a, b)| a != b);
                assert!(different.is_none(), "{what}: {different:?}");
            }
            if end.is_err() {
                self.faulted += 1;
                break;
            }
            self.ended += 1;
        }
    }

    /// Where the first three variables of the PROGRAM are.
    fn offset(&self) -> usize {
        let layout = Layout::new(self.program);
        let class = self.program.class(self.program.instances[0].program);
        let names = ["kind", "n", "m"];
        let fields = &self.program.structure(class.state).fields[..names.len()];
        assert!(fields.iter().map(|it| &it.name).eq(names));
        usize_of(layout.machine.instances[0] + layout.field(class.state, FieldId(0)))
    }
}
