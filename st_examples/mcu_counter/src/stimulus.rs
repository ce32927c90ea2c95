//! The inputs of each scan, from the CSV that the host reads: a row holds until the next.

use core::str::Lines;

/// The board's pins in each scan, a bit a pin, up to the last row's.
#[derive(Clone, Debug)]
pub struct Stimulus<'t> {
    rows: Lines<'t>,
    row: Option<&'t str>,
    scan: u32,
    pins: u64,
}

impl<'t> Stimulus<'t> {
    pub fn new(text: &'t str) -> Self {
        let mut rows = text.lines();
        rows.next();
        let row = rows.next();
        Self { rows, row, scan: 0, pins: 0 }
    }
}

impl Iterator for Stimulus<'_> {
    type Item = u64;

    fn next(&mut self) -> Option<u64> {
        let row = self.row?;
        self.scan += 1;
        let mut cells = row.split(',');
        let due: u32 = cells.next()?.parse().ok()?;
        if due == self.scan {
            for (pin, cell) in cells.enumerate() {
                match cell {
                    "TRUE" => self.pins |= 1 << pin,
                    "FALSE" => self.pins &= !(1 << pin),
                    _ => {}
                }
            }
            self.row = self.rows.next();
        }
        Some(self.pins)
    }
}
