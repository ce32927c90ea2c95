//! A Cortex-M4 without an operating system: the stimulus that the host's run reads drives the
//! same program here, and its rows go out by semihosting. Nothing allocates.
#![no_std]
#![no_main]

mod stimulus;

mod plc {
    staunch_runtime::include_st!("counter");
}

use core::panic::PanicInfo;
use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, heprintln, hprintln};
use plc::{Counter, Globals};
use staunch_runtime::firmware::{Place, ProcessImage, Stamp, Width};
use staunch_runtime::{Context, Fault};
use stimulus::Stimulus;

const CYCLE: i64 = 10_000_000;
const STIMULUS: &str = include_str!("../stimulus.csv");

/// Scans whose instructions are counted.
const MEASURED: u32 = 1000;
/// The machine runs at 25 MHz, and QEMU's `-icount shift=0` runs an instruction in a nanosecond.
const INSTRUCTIONS_PER_TICK: u32 = 40;

#[entry]
fn main() -> ! {
    let ended = follow_stimulus().and_then(|()| measure());
    match ended {
        Ok(()) => debug::exit(debug::EXIT_SUCCESS),
        Err(fault) => {
            heprintln!("{}", fault.of(plc::FILES));
            debug::exit(debug::EXIT_FAILURE);
        }
    }
    loop {
        cortex_m::asm::wfi();
    }
}

/// The board's pins, as a process image. Here a line of the stimulus sets the inputs, and a row shows the outputs; a board has its ports in
/// their place.
#[derive(Default)]
struct Pins {
    /// %IX0.0 to %IX0.2
    inputs: u64,
    /// %QX0.0 and %QX0.1
    outputs: u64,
    /// %QW1
    per_minute: i16,
}

impl ProcessImage for Pins {
    fn load(&self, place: Place, bytes: &mut [u8]) {
        let is_high = self.inputs.checked_shr(place.number as u32).unwrap_or(0) & 1 == 1;
        bytes.fill(is_high.into());
    }

    fn store(&mut self, place: Place, bytes: &[u8]) {
        match (place.width, bytes) {
            (Width::Bit, [0]) => self.outputs &= !(1 << place.number),
            (Width::Bit, _) => self.outputs |= 1 << place.number,
            (Width::Word, [low, high]) => self.per_minute = i16::from_le_bytes([*low, *high]),
            _ => {}
        }
    }
}

impl Pins {
    fn is_set(&self, output: u32) -> bool {
        self.outputs >> output & 1 == 1
    }
}

/// One scan between the pins: the program's inputs, then the program, then its outputs.
fn scan(counter: &mut Counter, globals: &mut Globals, pins: &mut Pins, cx: &Context) -> Result<(), Fault> {
    globals.read_image(pins);
    counter.scan(cx, globals)?;
    globals.write_image(pins);
    Ok(())
}

/// Prints what `staunch run --trace -` prints for the same stimulus.
fn follow_stimulus() -> Result<(), Fault> {
    let (mut counter, mut globals, mut pins) = (Counter::new(), Globals::new(), Pins::default());
    hprintln!("scan,time_ms,Arrives,Leaves,NewShift,OnBelt.CV,Shift.CV,Full,Idle,PerMinute");
    let mut now = 0;
    for (number, inputs) in (1_u32..).zip(Stimulus::new(STIMULUS)) {
        pins.inputs = inputs;
        scan(&mut counter, &mut globals, &mut pins, &Context::new(now, now == 0))?;
        row(number, now, &counter, &pins);
        now += CYCLE;
    }
    restart(&mut counter, now);
    Ok(())
}

/// What stays over a power cut. A board writes the record to flash or FRAM; here it is in memory.
fn restart(counter: &mut Counter, now: i64) {
    let mut record = [0xFF; plc::RETAINED_SIZE];
    plc::save_retained(&mut record, Stamp { sequence: 1, now }, counter);
    let mut restarted = Counter::new();
    for task in plc::TASKS {
        match plc::load_retained(&record, &mut restarted) {
            Ok(stamp) => {
                heprintln!("{} kept {} parts at {} ms", task.instance, restarted.shift.cv, stamp.now / 1_000_000)
            }
            Err(reason) => heprintln!("{} starts anew: {reason}", task.instance),
        }
    }
}

/// %IX0.0 to %IX0.2, and %QX0.0, %QX0.1 and %QW1, as they are at the pins.
fn row(scan: u32, now: i64, counter: &Counter, pins: &Pins) {
    let [arrives, leaves, new_shift] = [0, 1, 2].map(|pin| word(pins.inputs >> pin & 1 == 1));
    let [full, idle] = [0, 1].map(|output| word(pins.is_set(output)));
    let (on_belt, shift, per_minute) = (counter.on_belt.cv, counter.shift.cv, pins.per_minute);
    let time = now / 1_000_000;
    hprintln!("{scan},{time},{arrives},{leaves},{new_shift},{on_belt},{shift},{full},{idle},{per_minute}");
}

fn word(value: bool) -> &'static str {
    if value { "TRUE" } else { "FALSE" }
}

/// Counts the instructions of a scan, with parts that come and go.
fn measure() -> Result<(), Fault> {
    // SAFETY: nothing else in this program touches the peripherals.
    let mut timer = unsafe { Peripherals::steal() }.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(0x00FF_FFFF);
    timer.clear_current();
    timer.enable_counter();
    let (mut counter, mut globals) = (Counter::new(), Globals::new());
    let start = SYST::get_current();
    for scan in 0..MEASURED {
        globals.arrives = scan & 1 == 0;
        globals.leaves = scan & 2 == 0;
        counter.scan(&Context::at(i64::from(scan) * CYCLE), &mut globals)?;
    }
    let ticks = start.wrapping_sub(SYST::get_current()) & 0x00FF_FFFF;
    let instructions = ticks * INSTRUCTIONS_PER_TICK / MEASURED;
    heprintln!("{instructions} instructions a scan; {} bytes of state", size_of::<Counter>() + size_of::<Globals>());
    Ok(())
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    debug::exit(debug::EXIT_FAILURE);
    loop {
        cortex_m::asm::bkpt();
    }
}
