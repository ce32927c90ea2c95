//! A disk for tests: it writes short, fills up, fails to sync, and forgets or tears what was not synced
//! when its power is cut. Sectors reach it in any order.

use super::super::storage::{Storage, Which};
use std::io;
use std::sync::{Arc, Mutex};

/// The least that a disk writes at once; here it can still be torn.
const SECTOR: usize = 512;

/// Numbers that are random enough.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Random(pub u64);

impl Random {
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % bound.max(1)
    }

    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }
}

#[derive(Clone, Debug, Default)]
struct Sector {
    cached: Vec<u8>,
    durable: Vec<u8>,
    /// What it may hold as well: contents that were written and not synced.
    possible: Vec<Vec<u8>>,
    /// Written since the last sync, which may have failed: a sync tries no sector a second time.
    dirty: bool,
}

impl Sector {
    fn after_power_cut(&self, random: &mut Random) -> Vec<u8> {
        let mut any = || match random.below(self.possible.len() + 1) {
            0 => self.durable.clone(),
            at => self.possible[at - 1].clone(),
        };
        let (first, second) = (any(), any());
        let torn = random.below(SECTOR + 1).min(first.len());
        let rest = second.get(torn..).unwrap_or_default();
        [&first[..torn], rest].concat()
    }
}

#[derive(Clone, Debug, Default)]
struct Model {
    sectors: Vec<Sector>,
}

impl Model {
    fn write(&mut self, offset: usize, bytes: &[u8]) {
        for (at, byte) in (offset..).zip(bytes) {
            let number = at / SECTOR;
            if self.sectors.len() <= number {
                self.sectors.resize(number + 1, Sector::default());
            }
            let cached = &mut self.sectors[number].cached;
            if cached.len() <= at % SECTOR {
                cached.resize(at % SECTOR + 1, 0);
            }
            cached[at % SECTOR] = *byte;
        }
        let touched = offset / SECTOR..(offset + bytes.len()).div_ceil(SECTOR);
        for sector in &mut self.sectors[touched] {
            sector.possible.push(sector.cached.clone());
            sector.dirty = true;
        }
    }

    fn sync(&mut self, fails: bool) {
        for sector in self.sectors.iter_mut().filter(|it| it.dirty) {
            sector.dirty = false;
            if !fails {
                sector.durable.clone_from(&sector.cached);
                sector.possible.clear();
            }
        }
    }

    fn size(&self) -> usize {
        self.sectors.iter().map(|it| it.cached.len()).sum()
    }

    fn of(bytes: &[u8]) -> Self {
        let sector = |it: &[u8]| Sector { cached: it.to_vec(), durable: it.to_vec(), ..Sector::default() };
        Self { sectors: bytes.chunks(SECTOR).map(sector).collect() }
    }
}

/// How often things fail, in percent, and when the power goes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Faults {
    pub errors: usize,
    pub short_writes: usize,
    pub failing_syncs: usize,
    /// Bytes that new files may have; none without.
    pub room: Option<usize>,
    /// Operations until the power is cut; the last one happens in part.
    pub power: Option<usize>,
}

#[derive(Clone, Debug)]
struct State {
    random: Random,
    faults: Faults,
    kept: Option<Model>,
    new: Option<Model>,
    /// What the name may stand for as well, until the folder is synced.
    renamed_from: Option<Option<Model>>,
    writes: usize,
}

/// The disk; its copies are the same disk.
#[derive(Clone, Debug)]
pub(crate) struct Faulty(Arc<Mutex<State>>);

impl Faulty {
    pub fn new(seed: u64, faults: Faults, file: Option<&[u8]>) -> Self {
        let random = Random(seed);
        let kept = file.map(Model::of);
        Self(Arc::new(Mutex::new(State { random, faults, kept, new: None, renamed_from: None, writes: 0 })))
    }

    pub fn set(&self, faults: Faults) {
        self.0.lock().unwrap().faults = faults;
    }

    /// The file as a process sees it that starts while the power is on.
    pub fn cached(&self) -> Option<Vec<u8>> {
        let state = self.0.lock().unwrap();
        state.kept.as_ref().map(|it| it.sectors.iter().flat_map(|it| it.cached.clone()).collect())
    }

    /// The file as it is when the power comes back.
    pub fn after_power_cut(&self) -> Option<Vec<u8>> {
        let mut state = self.0.lock().unwrap();
        let state = &mut *state;
        let random = &mut state.random;
        let old = state.renamed_from.as_ref().filter(|_| random.chance(50));
        let file = old.map_or(state.kept.as_ref(), Option::as_ref)?;
        Some(file.sectors.iter().flat_map(|it| it.after_power_cut(random)).collect())
    }

    pub fn has_power(&self) -> bool {
        self.0.lock().unwrap().faults.power != Some(0)
    }

    pub fn writes(&self) -> usize {
        self.0.lock().unwrap().writes
    }
}

impl State {
    /// FALSE if the power goes during this operation.
    fn powered(&mut self) -> io::Result<bool> {
        match &mut self.faults.power {
            None => Ok(true),
            Some(0) => Err(io::Error::other("no power")),
            Some(left) => {
                *left -= 1;
                Ok(*left > 0)
            }
        }
    }

    fn fail(&mut self, percent: usize) -> io::Result<()> {
        match self.random.chance(percent) {
            true => Err(io::Error::other("a bad sector")),
            false => Ok(()),
        }
    }

    fn file(&mut self, which: Which) -> io::Result<&mut Model> {
        let file = match which {
            Which::Kept => &mut self.kept,
            Which::New => &mut self.new,
        };
        file.as_mut().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

impl Storage for Faulty {
    fn create(&mut self) -> io::Result<()> {
        let mut state = self.0.lock().unwrap();
        state.powered()?;
        let errors = state.faults.errors;
        state.fail(errors)?;
        state.new = Some(Model::default());
        Ok(())
    }

    fn write(&mut self, which: Which, offset: usize, bytes: &[u8]) -> io::Result<usize> {
        let mut state = self.0.lock().unwrap();
        let (powered, faults) = (state.powered()?, state.faults);
        state.fail(faults.errors)?;
        let size = state.file(which)?.size();
        let mut count = bytes.len();
        if !powered || state.random.chance(faults.short_writes) {
            count = state.random.below(count) + 1;
        }
        if let Some(room) = faults.room.filter(|it| offset + count > size.max(*it)) {
            count = room.saturating_sub(offset);
        }
        if count == 0 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        state.file(which)?.write(offset, &bytes[..count]);
        state.writes += 1;
        Ok(count)
    }

    fn sync(&mut self, which: Which) -> io::Result<()> {
        let mut state = self.0.lock().unwrap();
        let powered = state.powered()?;
        let failing = state.faults.failing_syncs;
        let fails = !powered || state.random.chance(failing);
        state.file(which)?.sync(fails);
        if fails { Err(io::Error::other("it cannot be synced")) } else { Ok(()) }
    }

    fn publish(&mut self) -> io::Result<()> {
        let mut state = self.0.lock().unwrap();
        let powered = state.powered()?;
        let faults = state.faults;
        state.fail(faults.errors)?;
        let old = state.kept.take();
        // The name may still stand for an older file, if the folder was not synced then.
        state.renamed_from.get_or_insert(old);
        state.kept = state.new.take();
        if powered { Ok(()) } else { Err(io::Error::other("no power")) }
    }

    fn sync_name(&mut self) -> io::Result<()> {
        let mut state = self.0.lock().unwrap();
        let powered = state.powered()?;
        let failing = state.faults.failing_syncs;
        if !powered || state.random.chance(failing) {
            return Err(io::Error::other("the folder cannot be synced"));
        }
        state.renamed_from = None;
        Ok(())
    }

    fn discard(&mut self) {
        self.0.lock().unwrap().new = None;
    }
}
