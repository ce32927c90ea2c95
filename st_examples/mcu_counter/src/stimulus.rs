//! The inputs of each scan, from the CSV that the host reads: a row holds until the next.

use core::str::Lines;

#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs {
    pub arrives: bool,
    pub leaves: bool,
    pub new_shift: bool,
}

/// One item a scan, up to the last row's.
#[derive(Clone, Debug)]
pub struct Stimulus<'t> {
    rows: Lines<'t>,
    row: Option<&'t str>,
    scan: u32,
    inputs: Inputs,
}

impl<'t> Stimulus<'t> {
    pub fn new(text: &'t str) -> Self {
        let mut rows = text.lines();
        rows.next();
        let row = rows.next();
        Self { rows, row, scan: 0, inputs: Inputs::default() }
    }
}

impl Iterator for Stimulus<'_> {
    type Item = Inputs;

    fn next(&mut self) -> Option<Inputs> {
        let row = self.row?;
        self.scan += 1;
        let mut cells = row.split(',');
        let due: u32 = cells.next()?.parse().ok()?;
        if due == self.scan {
            let Inputs { arrives, leaves, new_shift } = &mut self.inputs;
            for (input, cell) in [arrives, leaves, new_shift].into_iter().zip(cells) {
                match cell {
                    "TRUE" => *input = true,
                    "FALSE" => *input = false,
                    _ => {}
                }
            }
            self.row = self.rows.next();
        }
        Some(self.inputs)
    }
}
