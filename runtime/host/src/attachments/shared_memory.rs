//! A process image in shared memory, around a scan. Other processes read and write it at any time; `image` has the layout and how each
//! side gets whole values.
//!
//! Inputs are what is outside: each scan has all of them. Outputs are the program's. Memory (`%M`) belongs to both: a value there that is
//! not the one last published was written outside, and the program takes it over.

use super::attachment::{Attachment, Ended};
use super::emergency;
use super::image::{Image, State};
use super::options::AtEnd;
use super::points::{Area, Point, Points};
use crate::{Error, Machine};

#[derive(Debug)]
pub(super) struct SharedMemory {
    image: Image,
    at_end: AtEnd,
    /// Outputs whose safe values are stated.
    safe: &'static [Point],
    inputs: Vec<Value>,
    outputs: Vec<Point>,
    memory: Vec<Value>,
}

#[derive(Clone, Copy, Debug)]
struct Value {
    point: Point,
    /// The input that the program has; of memory, what was last published.
    held: u64,
    /// What was read, if the world outside is not just writing.
    read: u64,
}

impl SharedMemory {
    /// The program before its first scan.
    pub fn start(name: &str, points: &Points, at_end: AtEnd, state: &[u8]) -> Result<Self, Error> {
        let image = Image::open(name)
            .map_err(|error| Error::Usage(format!("cannot open /dev/shm/{name} (--io shm): {error}")))?;
        let of = |area| points.all.iter().filter(move |it| it.area == area);
        // Where inputs share bits, the variable that has all of them is read.
        let inputs = of(Area::Input).filter(|it| !it.view);
        let value = |it: &Point| Value { point: *it, held: it.read(state), read: 0 };
        let (inputs, memory) = (inputs.map(value).collect(), of(Area::Memory).map(value).collect());
        let safe: Vec<Point> = of(Area::Output).filter(|it| it.safe.is_some()).copied().collect();
        // A thread that ends the process has no time to ask whose they are.
        let safe: &'static [Point] = safe.leak();
        let new = Self { image, at_end, safe, inputs, outputs: of(Area::Output).copied().collect(), memory };
        image.end_outputs(at_end, safe);
        image.publish(|| new.memory.iter().for_each(|it| image.store(&it.point, it.held)));
        emergency::add(image, at_end, safe);
        Ok(new)
    }
}

impl Attachment for SharedMemory {
    fn before(&mut self, machine: &mut dyn Machine) {
        let Self { image, inputs, memory, .. } = self;
        let is_whole = image.read_inputs(|| {
            inputs.iter_mut().chain(memory.iter_mut()).for_each(|it| it.read = image.load(&it.point));
        });
        if is_whole {
            inputs.iter_mut().for_each(|it| it.held = it.read);
            for it in memory.iter_mut().filter(|it| it.read != it.held) {
                it.point.write(machine, it.read, u64::MAX);
                it.held = it.read;
            }
        }
        // Also those of before: a program that has started again has initial values.
        inputs.iter().for_each(|it| it.point.write(machine, it.held, u64::MAX));
    }

    fn after(&mut self, state: &[u8]) {
        let Self { image, outputs, memory, .. } = self;
        image.publish(|| {
            outputs.iter().for_each(|it| image.store(it, it.read(state)));
            for it in memory {
                let new = it.point.read(state);
                // What was written outside during the scan is left for the next one.
                if new != it.held && image.replace(&it.point, it.held, new) {
                    it.held = new;
                }
            }
            image.count_scan();
        });
        image.tell(State::Runs);
    }

    fn end(&mut self, ended: Ended) {
        self.image.end_outputs(self.at_end, self.safe);
        self.image.tell(if ended == Ended::Fault { State::Faulted } else { State::Ended });
    }
}
