//! Writing while power may fail: the last complete state is found, or the one before.

use super::super::format::{Layout, recover};
use super::super::kept::Kept;
use super::super::storage::Which;
use super::super::tests::faulty::{Faults, Faulty};
use super::*;
use crate::allocations::allocations;
use std::sync::mpsc::{Receiver, Sender, channel};

const SIZE: usize = 64;
const STATE: usize = 80;
const REGIONS: [std::ops::Range<usize>; 2] = [0..40, 56..80];

fn keeper<S: Storage>(storage: S) -> Keeper<S> {
    Keeper::new(storage, Layout::new("Main", [("main.x", "ARRAY", SIZE)].into_iter()), None)
}

/// What is kept of a state in which all bytes are equal.
const fn all(number: u8) -> [u8; SIZE] {
    [number; SIZE]
}

fn soon() -> Pace {
    Pace::within(Duration::ZERO)
}

fn on_disk(disk: &Faulty) -> Option<u8> {
    let content = recover(&disk.after_power_cut()?).unwrap();
    Some(content.found.unwrap().values[0])
}

fn until(mut is_so: impl FnMut() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < Duration::from_secs(60), "it does not come");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_write_starts_half_the_time_after_the_one_before() {
    let ms = Duration::from_millis;
    let pace = Pace::within(ms(1000));
    assert_eq!(pace.wait(None), None);
    assert_eq!(pace.wait(Some((ms(100), false))), Some(ms(400)));
    assert_eq!(pace.wait(Some((ms(500), false))), None);
    assert_eq!(soon().wait(Some((ms(0), false))), None);
    // After an error the disk has a while to recover.
    assert_eq!(pace.wait(Some((ms(600), true))), Some(ms(400)));
    assert_eq!(soon().wait(Some((ms(600), true))), Some(ms(400)));
    assert_eq!(Pace::within(ms(60_000)).wait(Some((ms(2000), true))), Some(ms(28_000)));
    assert!(pace.is_late(ms(501)) && !pace.is_late(ms(500)));
    assert!(!soon().is_late(ms(5000)));
}

#[test]
fn a_change_is_saved_and_no_change_is_not() {
    let disk = Faulty::new(1, Faults::default(), None);
    let kept = Kept::whole(&REGIONS);
    let mut whole = vec![0; SIZE];
    let mut writer = Writer::start(keeper(disk.clone()), soon(), (&whole, ""), |_| {}).unwrap();
    let mut offer = |clock, state: &[u8]| {
        if kept.copy_changed(state, &mut whole) {
            writer.offer(clock, &whole);
        }
    };
    let mut state = [0; STATE];
    offer(1, &state);
    // A variable that is not retained is not a change.
    state[50] = 1;
    offer(2, &state);
    state[0] = 1;
    offer(3, &state);
    until(|| on_disk(&disk) == Some(1));
    let writes = disk.writes();
    for clock in 4..100 {
        offer(clock, &state);
    }
    thread::sleep(Duration::from_millis(20));
    assert_eq!(disk.writes(), writes);
    state[79] = 9;
    writer.finish(100, &kept.of(&state), "p.st:1:1: fault").unwrap();
    let content = recover(&disk.cached().unwrap()).unwrap();
    assert_eq!(content.clock, 100);
    let found = content.found.unwrap();
    assert_eq!(found.values, [&state[..40], &state[56..]].concat());
    assert_eq!(found.fault, "p.st:1:1: fault");
}

#[test]
fn the_newest_of_many_changes_is_saved() {
    let disk = Faulty::new(1, Faults::default(), None);
    let hour = Pace::within(Duration::from_secs(3600));
    let mut writer = Writer::start(keeper(disk.clone()), hour, (&[0; SIZE], ""), |_| {}).unwrap();
    for number in 1..=200 {
        writer.offer(1, &all(number));
    }
    // The first at once, the rest not before the half hour is over; the end waits for none of that.
    until(|| on_disk(&disk).is_some());
    assert!(disk.writes() <= 2);
    writer.finish(1, &all(201), "").unwrap();
    assert_eq!(on_disk(&disk), Some(201));
}

/// A disk whose syncs take as long as the test wants.
struct Stuck(Faulty, Receiver<()>);

impl Storage for Stuck {
    fn create(&mut self) -> io::Result<()> {
        self.0.create()
    }

    fn write(&mut self, which: Which, offset: usize, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(which, offset, bytes)
    }

    fn sync(&mut self, which: Which) -> io::Result<()> {
        let _ = self.1.recv();
        self.0.sync(which)
    }

    fn publish(&mut self) -> io::Result<()> {
        self.0.publish()
    }

    fn sync_name(&mut self) -> io::Result<()> {
        self.0.sync_name()
    }

    fn discard(&mut self) {
        self.0.discard();
    }
}

#[test]
fn the_scan_does_not_wait_for_the_disk() {
    let disk = Faulty::new(1, Faults::default(), None);
    let (go_on, wait): (Sender<()>, _) = channel();
    let mut writer = Writer::start(keeper(Stuck(disk.clone(), wait)), soon(), (&[0; SIZE], ""), |_| {}).unwrap();
    // The disk hangs in its first sync; a scan that waited for it would never end.
    for number in 1..=100 {
        writer.offer(1, &all(number));
    }
    assert_eq!(on_disk(&disk), None);
    drop(go_on);
    until(|| on_disk(&disk) == Some(100));
    writer.finish(1, &all(100), "").unwrap();
}

#[test]
fn a_disk_that_fails_is_tried_again_and_told_once() {
    let disk = Faulty::new(1, Faults { errors: 100, ..Faults::default() }, None);
    let (tell, told) = channel();
    let tell = move |text: &str| drop(tell.send(text.to_owned()));
    let mut writer = Writer::start(keeper(disk.clone()), soon(), (&[0; SIZE], ""), tell).unwrap();
    writer.offer(1, &all(1));
    let first = told.recv().unwrap();
    assert!(first.starts_with("retained variables cannot be saved: a bad sector;"), "{first}");
    disk.set(Faults::default());
    // Without another change.
    assert_eq!(told.recv().unwrap(), "retained variables are saved again");
    assert_eq!(on_disk(&disk), Some(1));
    disk.set(Faults { errors: 100, ..Faults::default() });
    assert!(writer.finish(1, &all(2), "").is_err());
    assert_eq!(on_disk(&disk), Some(1));
}

#[test]
fn the_scan_does_not_allocate() {
    let disk = Faulty::new(1, Faults::default(), None);
    let kept = Kept::whole(&REGIONS);
    let mut whole = vec![0; SIZE];
    let mut writer = Writer::start(keeper(disk.clone()), soon(), (&whole, ""), |_| {}).unwrap();
    let offers = || {
        (1..=200).for_each(|number| {
            assert!(kept.copy_changed(&[number; STATE], &mut whole));
            writer.offer(1, &whole);
        });
    };
    assert_eq!(allocations(offers), 0);
    assert_eq!(allocations(|| drop(vec![0; SIZE])), 1);
    writer.finish(1, &all(1), "").unwrap();
}
