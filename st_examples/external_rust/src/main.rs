//! What the program calls is Rust: a converter, and an average.

mod plc {
    staunch_runtime::include_st!("scale");
    use super::Externals;
}

use plc::{Average, External, Scale};
use staunch_runtime::{Context, Fault};
use std::sync::atomic::{AtomicI16, Ordering};

/// What the program declares `{external}` is implemented for this.
#[derive(Debug)]
pub struct Externals;

impl External for Externals {
    /// A real one would ask its driver. This one answers on channel 2, with a load that grows.
    fn read_channel(channel: i16, ok: &mut bool) -> i16 {
        static LOAD: AtomicI16 = AtomicI16::new(400);
        *ok = channel == 2;
        LOAD.fetch_add(20, Ordering::Relaxed)
    }

    fn average(block: &mut Average, _: &Context) {
        block.last.rotate_right(1);
        block.last[0] = block.value;
        block.count = (block.count + 1).min(4);
        let sum: i16 = block.last.iter().sum();
        block.mean = f32::from(sum) / f32::from(block.count);
    }
}

fn main() -> Result<(), Fault> {
    let mut scale = Scale::new();
    for scan in 0..3 {
        scale.scan(&Context::at(scan * 10_000_000))?;
        println!("{:.1} kg{}", scale.weight, if scale.fault { ", no answer" } else { "" });
    }
    Ok(())
}
