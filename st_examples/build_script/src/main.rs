//! A garage's counting is Structured Text; the world around it is Rust.

mod plc {
    staunch_runtime::include_st!("parking_garage");
}

use plc::ParkingGarage;
use staunch_runtime::{Context, Fault};

fn main() -> Result<(), Fault> {
    let mut garage = ParkingGarage::new();
    let mut now = 0;
    for car in 1..=201 {
        for at_the_sensor in [true, false] {
            garage.entry_sensor = at_the_sensor && !garage.garage_full;
            let cx = if now == 0 { Context::first(now) } else { Context::at(now) };
            garage.scan(&cx)?;
            now += 10_000_000;
        }
        if car % 50 == 0 || car > 199 {
            println!("car {car}: {} free{}", garage.free_spaces, if garage.garage_full { ", full" } else { "" });
        }
    }
    Ok(())
}
