//! The coils and registers that a Modbus client sees: those of OpenPLC's runtime (`webserver/core/modbus.cpp` of OpenPLC_v3).

use super::exchange::Exchange;
use super::points::{Area, BITS, NUMBERS, Point, Width};

const MEMORY_WORDS: usize = NUMBERS;
const MEMORY_DOUBLES: usize = 2 * NUMBERS;
const MEMORY_LONGS: usize = 4 * NUMBERS;
const HOLDING: usize = 8 * NUMBERS;
pub(super) const REGISTER_BITS: usize = 16;

/// One of the four tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Table {
    Coils,
    Discrete,
    Input,
    Holding,
}

impl Table {
    /// Its numbers are single bits.
    pub fn is_bits(self) -> bool {
        matches!(self, Self::Coils | Self::Discrete)
    }

    /// One of its numbers, as people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coils => "coil",
            Self::Discrete => "discrete-input",
            Self::Input => "input-register",
            Self::Holding => "holding-register",
        }
    }

    pub fn size(self) -> usize {
        match self {
            Self::Coils | Self::Discrete => BITS,
            Self::Input => NUMBERS,
            Self::Holding => HOLDING,
        }
    }
}

/// The table of a point, and its first number there. `None` for what clients do not see.
pub(super) fn place(point: &Point) -> Option<(Table, usize)> {
    let at = point.number;
    match (point.area, point.width) {
        (Area::Input, Width::Bit) => Some((Table::Discrete, at)),
        (Area::Output, Width::Bit) => Some((Table::Coils, at)),
        (Area::Input, Width::Word) => Some((Table::Input, at)),
        (Area::Output, Width::Word) => Some((Table::Holding, at)),
        (Area::Memory, Width::Word) => Some((Table::Holding, MEMORY_WORDS + at)),
        (Area::Memory, Width::Double) => Some((Table::Holding, MEMORY_DOUBLES + 2 * at)),
        (Area::Memory, Width::Long) => Some((Table::Holding, MEMORY_LONGS + 4 * at)),
        (Area::Memory, Width::Bit)
        | (Area::Input | Area::Output | Area::Memory, Width::Byte)
        | (Area::Input | Area::Output, Width::Double | Width::Long) => None,
    }
}

/// Numbers of a point in its table.
fn numbers(point: &Point) -> usize {
    if point.width == Width::Bit { 1 } else { point.width.size() * 8 / REGISTER_BITS }
}

/// The clients' side of an [`Exchange`]: what they see, scan by scan, with what they have written since. One request at a time uses it.
#[derive(Debug)]
pub(super) struct Registers {
    /// By [`Table`]: a coil is 0 or 1. What no variable has keeps what is written to it.
    tables: [Vec<u16>; 4],
    /// By [`Table`], for each number the point there, and how far that is to be shifted.
    links: [Vec<Option<(u32, u8)>>; 4],
    points: Vec<(Table, usize, usize)>,
    /// For each point, the last request that has written to it.
    written: Vec<u64>,
    /// The scan that is seen.
    scan: u64,
    /// What the present request writes.
    writes: Vec<(usize, u64, u64)>,
}

impl Registers {
    /// Of points that have a [`place`].
    pub fn new(points: &[Point]) -> Self {
        let mut tables = [Table::Coils, Table::Discrete, Table::Input, Table::Holding].map(|it| vec![0; it.size()]);
        let mut links = tables.each_ref().map(|it| vec![None; it.len()]);
        let mut places = Vec::new();
        for (at, point) in points.iter().enumerate() {
            let (table, first) = place(point).unwrap_or((Table::Discrete, 0));
            let count = numbers(point);
            for number in 0..count {
                // The high word comes first.
                let shift = REGISTER_BITS * (count - 1 - number);
                links[table as usize][first + number] = Some((at as u32, shift as u8));
                // Before the first scan.
                tables[table as usize][first + number] = (point.safe.unwrap_or(0) >> shift) as u16;
            }
            places.push((table, first, count));
        }
        let written = vec![0; points.len()];
        Self { tables, links, points: places, written, scan: 0, writes: Vec::new() }
    }

    /// Sees the last scan. A value that was written and that no scan has used yet stays as it was written.
    pub fn update(&mut self, exchange: &Exchange) {
        let Self { tables, points, written, scan, .. } = self;
        exchange.see_newer(*scan, |shown| {
            *scan = shown.scan;
            for (at, (table, first, count)) in points.iter().enumerate() {
                if written[at] > shown.request {
                    continue;
                }
                for number in 0..*count {
                    let shift = REGISTER_BITS * (count - 1 - number);
                    tables[*table as usize][first + number] = (shown.values[at] >> shift) as u16;
                }
            }
        });
    }

    /// The values from `first` on, `None` if the table ends before.
    pub fn read(&self, table: Table, first: usize, count: usize) -> Option<&[u16]> {
        self.tables[table as usize].get(first..first + count)
    }

    /// Writes coils or registers, which [`read`](Self::read) has found.
    pub fn write(&mut self, table: Table, first: usize, values: impl Iterator<Item = u16>) {
        for (number, value) in (first..table.size()).zip(values) {
            self.tables[table as usize][number] = value;
            if let Some((point, shift)) = self.links[table as usize][number] {
                self.writes.push((point as usize, u64::from(value) << shift, 0xFFFF << shift));
            }
        }
    }

    /// The request is over: what it has written is for the next scan.
    pub fn hand_over(&mut self, exchange: &Exchange) {
        if self.writes.is_empty() {
            return;
        }
        let request = exchange.write(&self.writes);
        for (point, _, _) in self.writes.drain(..) {
            self.written[point] = request;
        }
    }
}
