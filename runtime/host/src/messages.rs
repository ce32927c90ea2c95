//! Messages that a program logs, for example with `ADSLOGSTR`: the compiler keeps the last ones in variables, which are read
//! after each scan.

use crate::error::tell;
use crate::json::quote;
use crate::map::Map;
use crate::run::options::Options;
use crate::value::value_at;
use crate::{Error, path};
use std::ops::Range;

const COUNT: &str = "Globals.__AdsLogCount";
const MASKS: &str = "Globals.__AdsLogMasks";
const TEXTS: &str = "Globals.__AdsLogTexts";
/// How many messages are kept.
const KEPT: u32 = 16;
/// Bits of a mask, and what they say of a message.
const KINDS: [(u32, &str); 3] = [(4, "error"), (2, "warning"), (1, "hint")];

/// A message, or that some are not kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    kind: &'static str,
    text: String,
}

impl Message {
    pub fn json(&self, scan: u64) -> String {
        let Self { kind, text } = self;
        format!("{{\"reason\":\"log\",\"scan\":{scan},\"kind\":{},\"message\":{}}}", quote(kind), quote(text))
    }

    pub fn line(&self, scan: u64) -> String {
        format!("log, scan {scan}: {}: {}", self.kind, self.text)
    }

    /// On standard error, or as JSON.
    pub fn tell(&self, scan: u64, options: &Options) -> Result<(), Error> {
        if options.json {
            return options.print_json(&self.json(scan));
        }
        if !options.quiet {
            tell(self.line(scan));
        }
        Ok(())
    }
}

/// The messages of a program, and how many of them have been reported.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    pub is_there: bool,
    told: u32,
}

impl Messages {
    pub fn of(map: &Map) -> Self {
        let is_there = path::resolve(map, &[], COUNT).is_ok();
        Self { is_there, told: 0 }
    }

    /// Where the state has them, first how many there were; nothing in a program that logs nothing.
    pub fn places(map: &Map) -> Vec<Range<usize>> {
        let places = [COUNT, MASKS, TEXTS].map(|it| path::resolve(map, &[], it));
        let place = |it: path::Place| it.offset..it.offset + map.size_of(it.ty);
        places.into_iter().filter_map(Result::ok).map(place).collect()
    }

    /// Those since the last call, in their order.
    pub fn take(&mut self, map: &Map, state: &[u8]) -> Vec<Message> {
        if !self.is_there {
            return Vec::new();
        }
        let value = |path: &str| value_at(map, &[], state, path).unwrap_or_default();
        let count: u32 = value(COUNT).parse().unwrap_or(0);
        // A restart has counted anew where there are fewer.
        let fresh = count.checked_sub(self.told).unwrap_or(count);
        self.told = count;
        let mut messages = Vec::new();
        if let Some(lost @ 1..) = fresh.checked_sub(KEPT) {
            messages.push(Message { kind: "note", text: format!("{lost} earlier messages were not kept") });
        }
        for number in count - fresh.min(KEPT)..count {
            let place = number % KEPT;
            let mask: u32 = value(&format!("{MASKS}[{place}]")).parse().unwrap_or(0);
            let kind = KINDS.iter().find(|it| mask & it.0 != 0).map_or("message", |it| it.1);
            messages.push(Message { kind, text: value(&format!("{TEXTS}[{place}]")) });
        }
        messages
    }
}
