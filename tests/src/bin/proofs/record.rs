//! What a program's run on the interpreter needs from outside, scan by scan, and what its state is after each.

use staunch_host::Machine;
use staunch_ir::{Chars, Program, Value};
use staunch_runtime::{Context, Fault};
use staunch_tests::leaf::{Leaf, Leaves, Read};

include!("../../../proofs/hash.rs");

/// Scans of a program that are recorded: the first ones.
const MOST: usize = 2000;

pub struct Recorder<'m> {
    machine: &'m mut dyn Machine,
    leaves: Leaves<'m>,
    parts: Vec<Part>,
    /// The state after the scan before, or the initial one.
    before: Vec<u8>,
    scans: Vec<u8>,
    count: usize,
    turns: u64,
}

impl<'m> Recorder<'m> {
    /// The machine in its initial state.
    pub fn new(machine: &'m mut dyn Machine, program: &'m Program, turns: u64) -> Self {
        let (leaves, before) = (Leaves::new(program), machine.state().to_vec());
        let parts = parts(&leaves.values(&before));
        Self { machine, leaves, parts, before, scans: Vec::new(), count: 0, turns }
    }

    pub fn scans(&self) -> usize {
        self.count
    }

    pub fn parts(&self) -> usize {
        self.parts.len()
    }

    pub fn bytes(&self) -> Vec<u8> {
        let parts = self.parts.iter().flat_map(|it| [number(it.at), it.kind].map(u32::to_le_bytes));
        let count = number(self.parts.len()).to_le_bytes();
        count.into_iter().chain(parts.flatten()).chain(self.scans.iter().copied()).collect()
    }

    /// What has been written since the scan before: whole values.
    fn patches(&self) -> Vec<(usize, Vec<u8>)> {
        let state = self.machine.state();
        if state == self.before {
            return Vec::new();
        }
        let (old, new) = (self.leaves.values(&self.before), self.leaves.values(state));
        let bytes = old.iter().zip(&new).map(|(old, new)| (bytes(old), bytes(new), new.offset));
        bytes.filter(|(old, new, _)| old != new).map(|(_, new, offset)| (offset, new)).collect()
    }

    fn add(&mut self, patches: &[(usize, Vec<u8>)], instance: usize, cx: &Context, ended: &Result<(), Fault>) {
        let state = self.machine.state();
        let hash = self.parts.iter().fold(START, |hash, it| stir_part(hash, state, *it));
        let mut put = |bytes: &[u8]| self.scans.extend_from_slice(bytes);
        put(&number(patches.len()).to_le_bytes());
        for (offset, bytes) in patches {
            put(&number(*offset).to_le_bytes());
            put(&number(bytes.len()).to_le_bytes());
            put(bytes);
        }
        put(&number(instance).to_le_bytes());
        put(&u32::from(cx.first_scan).to_le_bytes());
        put(&cx.now().to_le_bytes());
        put(&self.turns.to_le_bytes());
        put(&cx.cycle.to_le_bytes());
        put(&ended.map_or_else(|it| it.code(), |()| 0).to_le_bytes());
        put(&hash.to_le_bytes());
        self.count += 1;
    }
}

impl Machine for Recorder<'_> {
    fn state(&self) -> &[u8] {
        self.machine.state()
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) {
        self.machine.write(offset, bytes);
    }

    fn init(&mut self) {
        self.machine.init();
    }

    fn scan(&mut self, instance: usize, cx: &Context) -> Result<(), Fault> {
        let patches = self.patches();
        let before = cx.clone();
        let ended = self.machine.scan(instance, cx);
        if self.count < MOST {
            self.add(&patches, instance, &before, &ended);
        }
        self.before.clear();
        self.before.extend_from_slice(self.machine.state());
        ended
    }
}

fn number(it: usize) -> u32 {
    u32::try_from(it).expect("a state is small")
}

fn bytes(leaf: &Leaf) -> Vec<u8> {
    match &leaf.value {
        Read::Scalar(it) => scalar(*it),
        Read::Text(Chars::Narrow(it)) => length(it.len()).into_iter().chain(it.iter().copied()).collect(),
        Read::Text(Chars::Wide(it)) => {
            length(it.len()).into_iter().chain(it.iter().flat_map(|it| it.to_le_bytes())).collect()
        }
    }
}

fn length(it: usize) -> [u8; 2] {
    u16::try_from(it).expect("a string is short").to_le_bytes()
}

fn scalar(value: Value) -> Vec<u8> {
    match value {
        Value::Bool(it) => vec![it.into()],
        Value::I8(it) => it.to_le_bytes().into(),
        Value::I16(it) => it.to_le_bytes().into(),
        Value::I32(it) => it.to_le_bytes().into(),
        Value::I64(it) => it.to_le_bytes().into(),
        Value::U8(it) => it.to_le_bytes().into(),
        Value::U16(it) => it.to_le_bytes().into(),
        Value::U32(it) => it.to_le_bytes().into(),
        Value::U64(it) => it.to_le_bytes().into(),
        Value::F32(it) => it.to_le_bytes().into(),
        Value::F64(it) => it.to_le_bytes().into(),
    }
}

/// What is compared, values side by side as one part.
fn parts(leaves: &[Leaf]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for leaf in leaves {
        let kind = match &leaf.value {
            Read::Scalar(Value::F32(_)) => REAL,
            Read::Scalar(Value::F64(_)) => LREAL,
            Read::Text(Chars::Narrow(_)) => STRING,
            Read::Text(Chars::Wide(_)) => WSTRING,
            Read::Scalar(it) => number(scalar(*it).len()),
        };
        let is_plain = |kind: u32| kind < REAL;
        match parts.last_mut().filter(|it| is_plain(kind) && is_plain(it.kind)) {
            Some(last) if last.at + last.kind as usize == leaf.offset => last.kind += kind,
            Some(_) | None => parts.push(Part { at: leaf.offset, kind }),
        }
    }
    parts
}
