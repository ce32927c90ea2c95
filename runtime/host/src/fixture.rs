//! A map and a machine written by hand, for the tests of this crate.

use crate::domain::Domain;
use crate::map::Map;
use crate::{Machine, path};
use staunch_runtime::{Context, Fault, FaultKind, Location, Value};

/// `Garage`: an input, a counter, and a variable of every kind.
pub const MAP: &str = "map\t1
compiler\t1.2.3
machine\t128\t8
file\t0\tgarage.st
enum\t0\tColor\ti16\tRed=0\tGreen=5
array\t0\t-1\t2\tINT\t2
array\t1\t1\t2\tarray:0\t8
struct\t0\tPoint\t8\tstructure
field\tx\tINT\t0\tvar\t-\t-\t-
field\ty\tREAL\t4\tvar\t-\t-\t-
struct\t1\tMixer\t4\tfunction_block
field\trun\tBOOL\t0\tinput\t-\t-\t-
field\tcount\tINT\t2\tvar\tretain\t-\t-
struct\t2\tGarage\t104\tprogram
struct\t3\tglobals\t8\tglobals
field\ttotal\tDINT\t0\tglobal\tretain\t-\t-
field\tlamp\tBOOL\t4\tglobal\t-\t%QX0.1\t-
block\t7\tCTU\t10
field\tCU\tBOOL\t0\tinput\t-\t-\t-
field\tR\tBOOL\t1\tinput\t-\t-\t-
field\tPV\tINT\t2\tinput\t-\t-\t-
field\tQ\tBOOL\t4\toutput\t-\t-\t-
field\tCV\tINT\t6\toutput\t-\t-\t-
field\tm\tBOOL\t8\tmemory\t-\t-\t-
globals\tstruct:3\t0
instance\t0\tmain\tGarage\tstruct:2\t8\t-\t65535
variable\t0\tup\tinput\tBOOL\t8\t-\t%IX0.0\t-
variable\t0\tc\tvar\tblock:7\t10\t-\t-\t-
variable\t0\tm\tvar\tarray:1\t20\t-\t-\t-
variable\t0\tspeed\tvar\tREAL\t36\t-\t-\t-
variable\t0\tcolour\tvar\tenum:0\t40\t-\t-\t-
variable\t0\tname\tvar\tSTRING[4]\t42\t-\t-\t-
variable\t0\tpause\tvar\tTIME\t48\t-\t-\t-
variable\t0\tlevel\tvar\tINT\t56\t-\t-\t0..10
variable\t0\tlimit\tvar\tINT\t58\tconstant\t-\t-
variable\t0\tmixer\tvar\tstruct:1\t60\t-\t-\t-
variable\t0\tcorner\tvar\tstruct:0\t64\t-\t-\t-
variable\t0\ttotal\texternal\tDINT\t0\tretain\t-\t-
";

/// A map with these fields at addresses, each a type, an offset, flags and an address.
pub fn map_with(fields: &[(&str, usize, &str, &str)]) -> Map {
    let mut text =
        "map\t1\nmachine\t64\t8\nenum\t0\tE\ti16\ta=0\narray\t0\t1\t4\tINT\t2\narray\t1\t0\t1\tBOOL\t1\n".to_owned();
    text += "struct\t1\tGlobals\t64\tglobals\n";
    for (at, (ty, offset, flags, address)) in fields.iter().enumerate() {
        text += &format!("field\tv{at}\t{ty}\t{offset}\tglobal\t{flags}\t{address}\t-\n");
    }
    Map::parse(&(text + "globals\tstruct:1\t0\n")).unwrap()
}

/// The fields of `Garage`'s state, which hold what its variables say.
pub fn map() -> Map {
    Map::parse(&map_text()).unwrap()
}

/// The same with `button`, an input among the global variables.
pub fn map_with_button() -> Map {
    let button = "field\tbutton\tBOOL\t5\tglobal\t-\t%IX0.1\t-\n";
    Map::parse(&map_text().replace("field\tlamp\t", &format!("{button}field\tlamp\t"))).unwrap()
}

pub const BUTTON: usize = 5;

fn map_text() -> String {
    let mut fields = String::new();
    for line in MAP.lines().filter(|it| it.starts_with("variable") && !it.contains("external")) {
        let cells: Vec<&str> = line.split('\t').collect();
        let offset: usize = cells[5].parse().unwrap();
        let cells = [cells[2], cells[4], &(offset - 8).to_string(), cells[3], cells[6], cells[7], cells[8]];
        fields += &format!("field\t{}\n", cells.join("\t"));
    }
    MAP.replace("struct\t3\tglobals", &(fields + "struct\t3\tglobals"))
}

pub fn offset_of(path: &str) -> usize {
    path::resolve(&map(), &[0], path).unwrap().offset
}

/// Counts rising edges of `up` in `c.CV`, `mixer.count` and the retained `total`; `speed` is the
/// clock in seconds. It faults when the count reaches `fault_at`.
#[derive(Debug)]
pub struct Garage {
    state: Vec<u8>,
    pub fault_at: i16,
    pub first_scans: Vec<i64>,
}

impl Garage {
    pub fn new() -> Self {
        Self { state: vec![0; 128], fault_at: i16::MAX, first_scans: Vec::new() }
    }

    pub fn read(&self, path: &str) -> Value {
        let place = path::resolve(&map(), &[0], path).unwrap();
        let crate::Type::Elementary(it) = place.ty else { panic!("{path}") };
        Value::read(it.repr(), &self.state[place.offset..])
    }

    fn add(&mut self, path: &str) -> i128 {
        let number = self.read(path).as_integer().unwrap() + 1;
        let value = self.read(path).repr().integer(number).unwrap();
        value.write(&mut self.state[offset_of(path)..]);
        number
    }
}

impl Machine for Garage {
    fn state(&self) -> &[u8] {
        &self.state
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        Domain::of(&map_with_button()).write(&mut self.state, offset, bytes);
    }

    fn init(&mut self) {
        self.state.fill(0);
        Value::I16(7).write(&mut self.state[offset_of("limit")..]);
    }

    fn scan(&mut self, _instance: usize, cx: &Context) -> Result<(), Fault> {
        if cx.first_scan {
            self.first_scans.push(cx.now());
        }
        Value::F32(cx.now() as f32 / 1e9).write(&mut self.state[offset_of("speed")..]);
        let up = self.read("up");
        if up == Value::Bool(true) && self.read("c.m") == Value::Bool(false) {
            let count = self.add("c.CV");
            self.add("mixer.count");
            self.add("total");
            if count == i128::from(self.fault_at) {
                let at = Location { file: 0, line: 12, column: 5 };
                return Err(Fault { kind: FaultKind::DivideByZero, at });
            }
        }
        up.write(&mut self.state[offset_of("c.m")..]);
        Ok(())
    }
}

/// A state alone, of the size of `map`.
#[derive(Debug)]
pub struct Bytes {
    pub state: Vec<u8>,
    domain: Domain,
}

impl Bytes {
    pub fn new(map: &Map) -> Self {
        Self { state: vec![0; map.size], domain: Domain::of(map) }
    }
}

impl Machine for Bytes {
    fn state(&self) -> &[u8] {
        &self.state
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.domain.write(&mut self.state, offset, bytes);
    }

    fn init(&mut self) {
        self.state.fill(0);
    }

    fn scan(&mut self, _instance: usize, _cx: &Context) -> Result<(), Fault> {
        Ok(())
    }
}
