//! Asks the golden cases and other tests of the suite about every mutant, each mutant in a process of its own. That
//! process is forked when everything has been compiled, read and run once, so that it takes milliseconds; it is asked only
//! what reaches the mutant, the quickest first, and ends at the first answer that is another.
//!
//! `.ci/mutants` puts this file into the suite of the copy with the mutants.

use super::{constants, fixes, golden as suite, rows};
use staunch_runtime::mutant;
use staunch_tests::case::{self, Pin};
use staunch_tests::execute::Executor;
use staunch_tests::{cases, golden};
use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

unsafe extern "C" {
    fn fork() -> i32;
    fn waitpid(pid: i32, status: *mut i32, options: i32) -> i32;
    fn _exit(code: i32) -> !;
    fn setitimer(which: i32, timer: *const [i64; 4], before: *mut [i64; 4]) -> i32;
    fn setrlimit(resource: i32, limit: *const [u64; 2]) -> i32;
}

/// `ITIMER_PROF`: the time that a process computes, however busy the machine is.
const COMPUTED: i32 = 2;
/// `RLIMIT_AS` of Linux, and how much a process may have.
const ADDRESS_SPACE: i32 = 9;
static MEMORY: [u64; 2] = [4 << 30; 2];

/// Something that holds without a mutant: `false` and a panic say that it does not.
struct Question {
    name: String,
    holds: Box<dyn Fn() -> bool>,
    takes: Duration,
}

impl Question {
    fn new(name: String, holds: impl Fn() -> bool + 'static) -> Self {
        Self { name, holds: Box::new(holds), takes: Duration::ZERO }
    }

    /// A test, which panics where it fails.
    fn test(name: &str, test: fn()) -> Self {
        Self::new(name.to_owned(), move || {
            test();
            true
        })
    }

    fn answer(&self) -> bool {
        catch_unwind(AssertUnwindSafe(|| (self.holds)())).unwrap_or(false)
    }
}

/// `MUTANTS_OF=frontend` asks cases of the interpreter alone: the generated Rust was made before there was a mutant, and
/// to differ from it is nothing that a test of a changed front end would see.
fn questions() -> Vec<Question> {
    let is_frontend = std::env::var("MUTANTS_OF").is_ok_and(|it| it == "frontend");
    let executors: &[Executor] = if is_frontend { &[Executor::Interpreter] } else { &Executor::ALL };
    let root = std::env::var_os("MUTANTS_CASES").map_or_else(cases, Into::into);
    let mut questions = Vec::new();
    for case in case::discover(&root).0 {
        let (fixed, checked) = (case.clone(), case.clone());
        let name = case.name.clone();
        if case.pins.contains(&Pin::Diagnostics) {
            questions.push(Question::new(format!("fixes of {name}"), move || fixes::problems_of(&fixed).is_empty()));
        }
        questions.push(Question::new(format!("check of {name}"), move || suite::is_said_by_check(&checked)));
        questions.push(Question::new(name, move || golden::check_on(&case, executors).is_ok()));
    }
    questions.push(Question::test("rows", rows::a_row_takes_the_types_of_its_class_and_no_others));
    questions.push(Question::test("rows of the witness", rows::the_witness_agrees_on_the_calls_that_it_knows));
    questions.push(Question::test("constants", constants::constants_are_computed_as_at_run_time));
    questions.push(Question::test("documents", super::documents::the_structured_text_in_documents_compiles));
    questions.push(Question::test("pages", super::pages::pages_show_what_they_say));
    if !is_frontend {
        questions.push(Question::test("executors' rows", rows::the_executors_agree_on_every_row));
        questions.push(Question::test("vectors", super::vectors::every_counter_vector_holds_on_every_executor));
        questions.push(Question::test("operations", super::operations::the_interpreter_computes_as_the_runtime_does));
        questions.push(Question::test("printed", super::operations::printed_rust_computes_as_the_runtime_does));
        questions.push(Question::test("effects", super::effects::cases_touch_what_their_effects_say));
        questions.push(Question::test("turns", super::turns::loops_end_alike_at_every_budget));
    }
    questions
}

#[test]
fn every_mutant() {
    std::panic::set_hook(Box::new(|_| ()));
    let mut questions = questions();
    questions.retain(|it| it.answer() || {
        println!("left out: {}", it.name);
        false
    });
    let at_start: BTreeSet<u32> = mutant::reached().into_iter().collect();
    let mut reach: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (at, question) in questions.iter_mut().enumerate() {
        let start = Instant::now();
        assert!(question.answer(), "{} holds no longer", question.name);
        question.takes = start.elapsed();
        for number in mutant::reached() {
            reach.entry(number).or_default().push(at);
        }
    }
    // What is computed once for all is not computed again in a fork.
    at_start.iter().filter(|it| !reach.contains_key(it)).for_each(|it| println!("once: {it}"));
    let wanted = std::env::var("MUTANTS").ok();
    let wanted: Option<BTreeSet<u32>> = wanted.map(|it| it.split(',').filter_map(|it| it.parse().ok()).collect());
    reach.retain(|it, _| wanted.as_ref().is_none_or(|wanted| wanted.contains(it)));

    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let mut running = BTreeMap::new();
    for (number, mut asked) in reach {
        asked.sort_by_key(|it| questions[*it].takes);
        if running.len() == processors {
            wait_for_one(&mut running);
        }
        let shown = format!("{number} {} {}", asked.len(), questions[asked[0]].name);
        // SAFETY: no other thread has a lock that what is asked needs: the harness waits for this one.
        let child = unsafe { fork() };
        if child == 0 {
            // SAFETY: the limit can be read. A program that never ends may also ask for memory without end.
            unsafe { setrlimit(ADDRESS_SPACE, &raw const MEMORY) };
            mutant::turn_on(number);
            let is_seen = asked.iter().any(|it| !answers_in_time(&questions[*it]));
            // SAFETY: it ends this process, which has nothing to write.
            unsafe { _exit(i32::from(is_seen)) }
        }
        running.insert(child, shown);
    }
    while !running.is_empty() {
        wait_for_one(&mut running);
    }
}

fn answers_in_time(question: &Question) -> bool {
    let seconds = i64::try_from(question.takes.as_secs() * 20).unwrap_or(60) + 10;
    let timer = [0, 0, seconds, 0];
    // SAFETY: the time can be read. A program that never ends is ended by the signal.
    unsafe { setitimer(COMPUTED, &raw const timer, std::ptr::null_mut()) };
    question.answer()
}

fn wait_for_one(running: &mut BTreeMap<i32, String>) {
    let mut status = 0;
    // SAFETY: `status` can be written.
    let child = unsafe { waitpid(-1, &raw mut status, 0) };
    let Some(shown) = running.remove(&child) else { return };
    println!("{}: {shown}", if status == 0 { "survives" } else { "dies" });
}
