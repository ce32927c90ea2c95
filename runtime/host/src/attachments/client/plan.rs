//! Which requests read and write the variables of a connection: as few as possible, each of numbers that follow one another.

use crate::attachments::pdu;
use crate::attachments::points::{Area, Point, Points, Width};
use crate::attachments::registers::{REGISTER_BITS, Table};
use crate::map::{Map, Type};
use crate::path;
use crate::remote::{Remote, WordOrder};
use staunch_runtime::Elementary;
use std::collections::HashSet;

/// What is wrong with a connection, or with one of its variables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    pub variable: Option<String>,
    pub text: String,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// What is read and written, each once.
    pub points: Vec<Point>,
    /// Which of them are read.
    pub inputs: Vec<usize>,
    /// Of these, the variable, and the place in the state.
    pub named_inputs: Vec<(String, usize, Option<u8>)>,
    pub reads: Vec<Request>,
    pub writes: Vec<Request>,
}

/// Coils or registers that follow one another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub table: Table,
    pub first: u16,
    pub count: u16,
    pub parts: Vec<Part>,
}

/// Bits of a coil or register that are bits of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// In the request, from 0.
    pub at: usize,
    pub point: usize,
    /// Of the point.
    pub shift: u32,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Coil,
    Register,
    /// One bit of a register.
    Bit(u8),
}

/// A value's place at the server.
#[derive(Clone, Copy, Debug)]
struct Placed {
    table: Table,
    first: usize,
    count: usize,
    bit: Option<u8>,
    point: usize,
}

impl Placed {
    fn meets(&self, other: &Self) -> bool {
        self.table == other.table && self.first < other.first + other.count && other.first < self.first + self.count
    }
}

/// The first place of a variable, as it is written: `holding-register 10`, `input-register 3.7`.
struct Start {
    table: Table,
    number: usize,
    bit: Option<u8>,
}

const TABLES: [Table; 4] = [Table::Coils, Table::Discrete, Table::Input, Table::Holding];

/// Numbers of a table.
const NUMBERS: usize = 1 << 16;

/// What is wrong with the servers of one program: the number of one, from 0, and its mistake.
pub fn check_remotes(all: &[Remote], map: &Map) -> Result<(), (usize, Mistake)> {
    let points = Points::of(map);
    let mut inputs = HashSet::new();
    for (number, remote) in all.iter().enumerate() {
        let plan = Plan::of(remote, map, &points).map_err(|it| (number, it))?;
        let twice = plan.named_inputs.iter().find(|(_, offset, bit)| !inputs.insert((*offset, *bit)));
        if let Some((name, _, _)) = twice {
            let text = "another connection writes the same input".to_owned();
            return Err((number, Mistake { variable: Some(name.clone()), text }));
        }
    }
    Ok(())
}

/// Where a server's inputs are in the state, if there is nothing wrong with it.
pub(crate) fn input_places(remote: &Remote, map: &Map, points: &Points) -> Vec<(usize, Option<u8>)> {
    let plan = Plan::of(remote, map, points).unwrap_or_default();
    plan.named_inputs.into_iter().map(|(_, offset, bit)| (offset, bit)).collect()
}

impl Plan {
    pub fn of(remote: &Remote, map: &Map, points: &Points) -> Result<Self, Mistake> {
        let mut plan = Self::default();
        let (mut reads, mut writes) = (Vec::new(), Vec::new());
        for (name, place) in &remote.variables {
            let fail = |text: String| Mistake { variable: Some(name.clone()), text };
            let start = start(place).map_err(fail)?;
            let found = values(map, points, name).map_err(fail)?;
            let mut number = start.number;
            for point in found {
                let placed = placed(&start, number, &point, plan.points.len(), remote.word_order).map_err(fail)?;
                number = placed.first + placed.count;
                if point.area == Area::Input {
                    plan.inputs.push(plan.points.len());
                    plan.named_inputs.push((name.clone(), point.offset(), point.bit()));
                    reads.push(placed);
                } else {
                    if writes.iter().any(|it: &Placed| it.meets(&placed)) {
                        return Err(fail(format!("another variable is written to {place}, too")));
                    }
                    writes.push(placed);
                }
                plan.points.push(point);
            }
        }
        let order = remote.word_order.unwrap_or(WordOrder::HighFirst);
        plan.reads = requests(reads, order, |it| most(it, pdu::MOST_BITS_READ, pdu::MOST_READ));
        plan.writes = requests(writes, order, |it| most(it, pdu::MOST_BITS_WRITTEN, pdu::MOST_WRITTEN));
        Ok(plan)
    }
}

fn most(table: Table, bits: usize, registers: usize) -> usize {
    if table.is_bits() { bits } else { registers }
}

fn start(place: &str) -> Result<Start, String> {
    let wrong = || {
        format!(
            "`{place}` is not a place at a server: write, for example, \"input-register 3\"; the tables are coil, discrete-input, \
             input-register and holding-register, each with the numbers from 0 to 65535"
        )
    };
    let is_line = !place.chars().any(char::is_control);
    let (word, number) = place.trim().split_once(' ').filter(|_| is_line).ok_or_else(wrong)?;
    let table = TABLES.into_iter().find(|it| it.name() == word).ok_or_else(wrong)?;
    let (number, bit) = match number.trim().split_once('.') {
        Some((number, bit)) if !table.is_bits() => {
            let bit: u8 = bit.parse().ok().filter(|it| usize::from(*it) < REGISTER_BITS).ok_or_else(wrong)?;
            (number, Some(bit))
        }
        Some(_) => return Err(wrong()),
        None => (number.trim(), None),
    };
    let number = number.parse().ok().filter(|it| *it < NUMBERS).ok_or_else(wrong)?;
    Ok(Start { table, number, bit })
}

/// The values of a variable, of an array one after the other.
pub(crate) fn values(map: &Map, points: &Points, name: &str) -> Result<Vec<Point>, String> {
    let all: Vec<usize> = (0..map.instances.len()).collect();
    let place = path::resolve(map, &all, name)?;
    let end = place.offset + map.size_of(place.ty).max(1);
    let mut leaf = place.ty;
    while let Some(array) = map.array(leaf) {
        leaf = array.element;
    }
    // Other variables may share the bytes.
    let is_alike = |it: &Point| match leaf {
        Type::Bit(bit) => it.bit() == Some(bit),
        Type::Elementary(Elementary::Bool) => it.width == Width::Bit && it.bit().is_none(),
        _ => it.width != Width::Bit && it.width.size() == map.size_of(leaf),
    };
    let of_it = |it: &&Point| (place.offset..end).contains(&it.offset()) && is_alike(it);
    let mut found: Vec<Point> = points.all.iter().filter(of_it).copied().collect();
    found.dedup_by_key(|it| (it.offset(), it.bit()));
    match found.first() {
        None => Err("only variables at addresses are connected: declare it as `AT %IW0` or `AT %QW0`".to_owned()),
        Some(it) if it.area == Area::Memory => {
            Err("%M is neither read nor written: use %I for what is read, and %Q for what is written".to_owned())
        }
        Some(_) => Ok(found),
    }
}

/// Where a value is, if it fits there.
fn placed(
    start: &Start,
    first: usize,
    point: &Point,
    number: usize,
    order: Option<WordOrder>,
) -> Result<Placed, String> {
    let Start { table, bit, .. } = *start;
    let is_output = point.area == Area::Output;
    let count = match (point.width, table.is_bits(), bit) {
        (Width::Bit, true, None) => 1,
        (Width::Bit, false, Some(_)) if is_output => {
            return Err("one bit of a register cannot be written alone: write all of it, from a %QW".to_owned());
        }
        (Width::Bit, false, Some(_)) => 1,
        (Width::Bit, false, None) if is_output => {
            return Err("it is a bit, and a register has 16: write it to a coil, or all 16 from a %QW".to_owned());
        }
        (Width::Bit, false, None) => {
            return Err("it is a bit, and a register has 16: name one, as in \"input-register 3.0\"".to_owned());
        }
        (Width::Word | Width::Double | Width::Long, false, None) => point.width.size() * 8 / REGISTER_BITS,
        (Width::Word | Width::Double | Width::Long, _, _) => return Err("it has more bits than one".to_owned()),
        (Width::Bit, true, Some(_)) | (Width::Byte, _, _) => {
            return Err("a byte has no place in registers of 16 bits: use an address with W".to_owned());
        }
    };
    if is_output && matches!(table, Table::Discrete | Table::Input) {
        return Err("a server lets nobody write this: outputs are a coil or a holding-register".to_owned());
    }
    if count > 1 && order.is_none() {
        return Err("it takes several registers: say which comes first, word-order = \"high-first\" or \"low-first\""
            .to_owned());
    }
    if first + count > NUMBERS {
        return Err("it ends after number 65535".to_owned());
    }
    let bit = bit.map(|it| it.wrapping_add((first - start.number) as u8));
    Ok(Placed { table, first, count, bit, point: number })
}

/// Values that follow one another share a request; no value is in two.
fn requests(mut all: Vec<Placed>, order: WordOrder, most: impl Fn(Table) -> usize) -> Vec<Request> {
    all.sort_by_key(|it| (it.table as usize, it.first, it.count));
    let mut requests: Vec<Request> = Vec::new();
    for it in all {
        let end = it.first + it.count;
        let joined = requests.last_mut().filter(|last| {
            let (first, count) = (usize::from(last.first), usize::from(last.count));
            last.table == it.table && it.first <= first + count && end - first <= most(it.table)
        });
        let request = match joined {
            Some(request) => request,
            None => {
                let first = it.first as u16;
                requests.push(Request { table: it.table, first, count: 0, parts: Vec::new() });
                requests.last_mut().expect("one was added")
            }
        };
        let start = it.first - usize::from(request.first);
        request.count = request.count.max((end - usize::from(request.first)) as u16);
        for register in 0..it.count {
            let place = match order {
                WordOrder::HighFirst => it.count - 1 - register,
                WordOrder::LowFirst => register,
            };
            let kind = match it.bit {
                Some(bit) => Kind::Bit(bit),
                None if it.table.is_bits() => Kind::Coil,
                None => Kind::Register,
            };
            let shift = (place * REGISTER_BITS) as u32;
            request.parts.push(Part { at: start + register, point: it.point, shift, kind });
        }
    }
    requests
}

#[cfg(test)]
mod tests;
