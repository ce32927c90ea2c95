//! Runs of a program: stimulus, time, restarts and traces.

use super::*;
use crate::allocations::allocated;
use crate::attachments::{Connection, Io};
use crate::fixture::{BUTTON, Garage, map, map_with_button, offset_of};
use crate::remote::{OnLoss, Remote, Server};
use staunch_runtime::{Fault, Value};
use std::path::Path;
use std::path::PathBuf;

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("staunch-run-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn traced(folder: &Path, stimulus: &str, options: Options) -> (Result<Summary, Error>, String, Garage) {
    let mut machine = Garage::new();
    let (result, text) = traced_on(&mut machine, folder, stimulus, options);
    (result, text, machine)
}

fn traced_on(
    machine: &mut Garage,
    folder: &Path,
    stimulus: &str,
    options: Options,
) -> (Result<Summary, Error>, String) {
    let (input, output) = (folder.join("in.csv"), folder.join("out.csv"));
    std::fs::write(&input, stimulus).unwrap();
    let options = Options { stimulus: Some(input), trace: Some(output.clone()), quiet: true, ..options };
    let result = run(machine, &map(), &options);
    (result, std::fs::read_to_string(output).unwrap_or_default())
}

fn vars(vars: &str) -> Options {
    Options { vars: Some(vars.to_owned()), ..Options::default() }
}

#[test]
fn inputs_hold_and_time_moves_by_the_cycle() {
    let stimulus = "scan,up\n1,TRUE\n3,FALSE\n4,TRUE\n";
    let (result, trace, _) = traced(&folder("hold"), stimulus, vars("up,c.CV"));
    assert_eq!(trace, "scan,time_ms,up,c.CV\n1,0,TRUE,1\n2,10,TRUE,1\n3,20,FALSE,1\n4,30,TRUE,2\n");
    let summary = result.unwrap();
    assert_eq!((summary.scans, summary.time), (4, 40_000_000));
}

#[test]
fn scans_can_be_placed_in_time() {
    let options = Options { scans: Some(4), cycle: Some(5_000_000), ..vars("speed") };
    let (_, trace, _) = traced(&folder("placed"), "scan,time,up\n2,T#1s,TRUE\n", options);
    assert_eq!(trace, "scan,time_ms,speed\n1,0,0.0\n2,1000,1.0\n3,1005,1.005\n4,1010,1.01\n");
    let (result, _, _) = traced(&folder("back"), "scan,time,up\n3,T#1ms,TRUE\n", Options::default());
    assert!(
        result
            .unwrap_err()
            .to_string()
            .ends_with("in.csv:2:3: scan 3 cannot run at T#1ms: the scan before it runs at T#10ms")
    );
}

#[test]
fn a_restart_keeps_retained_variables_and_inputs() {
    let stimulus = "scan,up,@event\n1,TRUE,\n2,,restart\n3,,\n";
    let (_, trace, machine) = traced(&folder("restart"), stimulus, vars("up,c.CV,total,mixer.count"));
    assert_eq!(trace, "scan,time_ms,up,c.CV,total,mixer.count\n1,0,TRUE,1,1,1\n2,10,TRUE,1,2,2\n3,20,TRUE,1,2,2\n");
    assert_eq!(machine.first_scans, [0, 10_000_000]);
    assert_eq!(machine.read("limit"), Value::I16(7));
}

#[test]
fn scan_zero_shows_the_initial_values() {
    let options = Options { scans: Some(0), ..vars("limit") };
    let (result, trace, _) = traced(&folder("zero"), "scan,up\n1,TRUE\n", options);
    assert_eq!(trace, "scan,time_ms,limit\n0,0,7\n");
    let summary = result.unwrap();
    assert_eq!((summary.scans, summary.time), (0, 0));
}

#[test]
fn a_fault_leaves_the_rows_before_it() {
    let mut machine = Garage::new();
    machine.fault_at = 2;
    let stimulus = "scan,up\n1,1\n2,0\n3,1\n9,0\n";
    let (result, trace) = traced_on(&mut machine, &folder("fault"), stimulus, vars("c.CV"));
    assert_eq!(trace, "scan,time_ms,c.CV\n1,0,1\n2,10,1\n");
    let error = result.unwrap_err();
    assert_eq!(error.exit_code(), 3);
    assert_eq!(error.to_string(), "garage.st:12:5: fault: division by zero (scan 3, program main)");
}

#[test]
fn retained_variables_live_in_a_file() {
    let folder = folder("file");
    let options = || Options { retain: Some(folder.join("garage.ret")), ..vars("total") };
    let stimulus = "scan,up\n1,1\n";
    assert_eq!(traced(&folder, stimulus, options()).1, "scan,time_ms,total\n1,0,1\n");
    assert_eq!(traced(&folder, stimulus, options()).1, "scan,time_ms,total\n1,0,2\n");
}

#[test]
fn a_run_ends_by_itself() {
    let options = Options { quiet: true, ..Options::default() };
    let summary = run(&mut Garage::new(), &map(), &options).unwrap();
    assert_eq!(summary.scans, DEFAULT_SCANS);
    let (result, _, _) = traced(&folder("by-time"), "time,up\nT#0s,1\nT#25ms,0\n", vars("up"));
    assert_eq!(result.unwrap().scans, 4);
}

#[test]
fn real_time_is_waited_for() {
    let options = Options { realtime: true, quiet: true, scans: Some(3), cycle: Some(4_000_000), ..Options::default() };
    let summary = run(&mut Garage::new(), &map(), &options).unwrap();
    assert!(summary.elapsed >= Duration::from_millis(8), "{summary:?}");
    let figures = summary.real.unwrap();
    assert!(figures.shortest() <= figures.longest());
    assert_eq!((figures.programs[0].scan.count(), figures.programs[0].jitter.count()), (3, 2));
}

#[test]
fn the_program_to_run_is_picked_by_name() {
    let mut map = map();
    assert_eq!(running(&map, Some("garage")).unwrap(), [0]);
    assert_eq!(running(&map, Some("main")).unwrap(), [0]);
    assert_eq!(
        running(&map, Some("Garagee")).unwrap_err().to_string(),
        "there is no PROGRAM `Garagee`; did you mean `Garage`?"
    );
    map.instances[0].name = "Garage".to_owned();
    map.instances.push(map.instances[0].clone());
    map.instances[1].name = "Mixer".to_owned();
    map.instances[1].program = "Mixer".to_owned();
    assert_eq!(
        running(&map, None).unwrap_err().to_string(),
        "no CONFIGURATION says which PROGRAM runs: pick one with --program: `Garage`, `Mixer`"
    );
    map.instances[1].priority = 1;
    assert_eq!(running(&map, None).unwrap(), [0, 1]);
}

#[test]
fn wrong_wishes_are_told() {
    let error = |options| run(&mut Garage::new(), &map(), &options).unwrap_err();
    assert_eq!(error(vars("upp")).to_string(), "--vars: there is no variable `upp`; did you mean `up`?");
    assert_eq!(error(Options { cycle: Some(0), ..Options::default() }).exit_code(), 2);
    let missing = error(Options { stimulus: Some("no/such.csv".into()), ..Options::default() });
    assert!(missing.to_string().starts_with("cannot read no/such.csv: "), "{missing}");
}

/// A program that changes all of its state in each scan.
struct Changing([u8; 128]);

impl Machine for Changing {
    fn state(&self) -> &[u8] {
        &self.0
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.0[offset..offset + bytes.len()].copy_from_slice(bytes);
    }

    fn init(&mut self) {
        self.0.fill(0);
    }

    fn scan(&mut self, _: usize, _: &Context) -> Result<(), Fault> {
        self.0.iter_mut().for_each(|it| *it = it.wrapping_add(1));
        Ok(())
    }
}

/// The page faults of this thread until now; `None` where the system does not say.
fn page_faults() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/thread-self/stat").ok()?;
    // After the name in brackets come state, five numbers, flags, and the minor and major faults with those of children.
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    Some(fields[7].parse::<u64>().ok()? + fields[9].parse::<u64>().ok()?)
}

/// Counts what its thread allocates, and waits for pages, from one of its scans to another.
struct Watched {
    machine: Changing,
    scan: u64,
    range: [u64; 2],
    /// Allocations and page faults at the two scans.
    seen: [(usize, Option<u64>); 2],
}

impl Machine for Watched {
    fn state(&self) -> &[u8] {
        self.machine.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.machine.write(offset, bytes);
    }

    fn init(&mut self) {
        self.machine.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        self.scan += 1;
        // To look allocates and touches memory, which is not counted.
        if self.scan == self.range[0] {
            page_faults();
            let faults = page_faults();
            self.seen[0] = (allocated(), faults);
        } else if self.scan == self.range[1] {
            self.seen[1] = (allocated(), None);
            self.seen[1].1 = page_faults();
        }
        self.machine.scan(instance, cx)
    }
}

/// An address where nobody listens.
fn free_address() -> String {
    std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string()
}

/// The run's own server, as one whose coil is read.
fn asked(server: &str) -> Remote {
    Remote {
        name: "itself".to_owned(),
        server: Server::Tcp(server.to_owned()),
        unit: 1,
        period: Duration::from_millis(1),
        timeout: Duration::from_millis(500),
        on_loss: OnLoss::Hold,
        word_order: None,
        variables: vec![("button".to_owned(), "coil 1".to_owned()), ("lamp".to_owned(), "coil 9".to_owned())],
    }
}

/// Retained variables and the trace are written by threads of their own, figures are counted in place, the bytes of inputs and outputs
/// are copied, and a stimulus writes bytes that it has: from the first scans on nothing allocates, and no memory is touched that was not before.
#[test]
#[cfg_attr(miri, ignore = "it runs in real time")]
fn scans_in_real_time_neither_allocate_nor_wait_for_memory() {
    const SCANS: u64 = 1_000_000;
    // Every thread of the run has been met, and the ring of the trace has gone round.
    const FIRST: u64 = 20_000;
    let folder = folder("no-allocation");
    let shared = format!("staunch-allocations-{}", std::process::id());
    let (mut map, server) = (map_with_button(), free_address());
    map.remotes.push(asked(&server));
    let mut connections = vec![Connection::Modbus(server)];
    if cfg!(target_os = "linux") {
        connections.push(Connection::SharedMemory(shared.clone()));
    }
    let stimulus = folder.join("stimulus.csv");
    let rows: String = (1..1000).map(|it| format!("{},{}\n", it * 1000, it % 11)).collect();
    std::fs::write(&stimulus, format!("scan,level\n{rows}")).unwrap();
    let options = Options {
        realtime: true,
        quiet: true,
        scans: Some(FIRST + SCANS),
        cycle: Some(1000),
        retain: Some(folder.join("retained")),
        stimulus: Some(stimulus),
        forces: vec!["pause=T#1s".to_owned()],
        trace: Some("/dev/null".into()),
        vars: Some("up,level,c.CV,total,name".to_owned()),
        io: Io { connections, ..Io::default() },
        ..Options::default()
    };
    let machine = Changing([0; 128]);
    let mut watched = Watched { machine, scan: 0, range: [FIRST, FIRST + SCANS], seen: [(0, None); 2] };
    let ran = run(&mut watched, &map, &options).unwrap();
    assert_eq!(ran.scans, FIRST + SCANS);
    let [first, last] = watched.seen;
    assert_eq!(last.0 - first.0, 0, "allocations");
    if let (Some(first), Some(last)) = (first.1, last.1) {
        assert_eq!(last - first, 0, "page faults");
    }
    let _ = std::fs::remove_file(format!("/dev/shm/{shared}"));
}

/// The calls that a machine gets, in their order.
#[derive(Debug)]
struct Told {
    garage: Garage,
    all: Vec<String>,
}

impl Machine for Told {
    fn state(&self) -> &[u8] {
        self.garage.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        let known =
            [("button", BUTTON), ("up", offset_of("up")), ("level", offset_of("level")), ("total", offset_of("total"))];
        let name = known.into_iter().find(|it| it.1 == offset).map(|it| it.0);
        self.all.push(format!("{} := {}", name.unwrap_or("?"), bytes[0]));
        self.garage.write(offset, bytes);
    }

    fn init(&mut self) {
        self.garage.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        self.all.push("scan".to_owned());
        self.garage.scan(instance, cx)
    }
}

/// The stimulus has the word over the world outside, and what is forced over both and over the program, for all who look at the state later.
#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(miri, ignore = "it runs in real time")]
fn what_is_around_a_scan_is_in_order() {
    assert_eq!(AROUND.iter().position(|it| *it == Step::Programs), Some(2));
    let folder = folder("order");
    let shared = format!("staunch-order-{}", std::process::id());
    let image = PathBuf::from(format!("/dev/shm/{shared}"));
    let stimulus = folder.join("stimulus.csv");
    std::fs::write(&stimulus, "scan,level,button,up\n1,3,,\n2,,TRUE,TRUE\n3,5,,\n").unwrap();
    let trace = folder.join("trace.csv");
    let options = || Options {
        realtime: true,
        quiet: true,
        scans: Some(3),
        stimulus: Some(stimulus.clone()),
        forces: vec!["total=7".to_owned()],
        retain: Some(folder.join("retained")),
        trace: Some(trace.clone()),
        vars: Some("level,button,total".to_owned()),
        io: Io { connections: vec![Connection::SharedMemory(shared.clone())], ..Io::default() },
        ..Options::default()
    };
    let mut told = Told { garage: Garage::new(), all: Vec::new() };
    run(&mut told, &map_with_button(), &options()).unwrap();
    let texts: Vec<&str> = told.all.iter().map(String::as_str).collect();
    let scans: Vec<&[&str]> = texts.split(|it| *it == "scan").collect();
    // The input is the world's at first, then the stimulus's: it is written again after what is read, which is FALSE.
    assert_eq!(scans[0], ["level := 3", "total := 7"]);
    assert_eq!(
        scans[1],
        ["total := 7", "button := 1", "up := 1", "button := 0", "button := 1", "up := 1", "total := 7"]
    );
    assert_eq!(scans[2], ["total := 7", "level := 5", "button := 0", "button := 1", "up := 1", "total := 7"]);
    assert_eq!(scans[3], ["total := 7"]);
    let rows = std::fs::read_to_string(&trace).unwrap();
    let ends: Vec<&str> = rows.lines().skip(1).map(|it| it.splitn(3, ',').nth(2).unwrap()).collect();
    assert_eq!(ends, ["3,FALSE,7", "3,TRUE,7", "5,TRUE,7"]);
    // The program has counted an edge in `total`, and what is kept is the forced value.
    let mut next = Garage::new();
    let once = Options { scans: Some(0), retain: Some(folder.join("retained")), quiet: true, ..Options::default() };
    run(&mut next, &map_with_button(), &once).unwrap();
    assert_eq!(next.read("total"), Value::I32(7));
    let _ = std::fs::remove_file(image);
}
