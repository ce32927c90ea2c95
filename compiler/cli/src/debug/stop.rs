//! A stop as text, for people or as an object.

use super::variables::{Shown, Variables};
use staunch_frontend::{Sources, Style, excerpt};
use staunch_host::{format_time, json_text};
use staunch_ir::Location;
use staunch_runtime::{Fault, Time};
use std::fmt::Write;

/// What there is to see at a stop.
#[derive(Debug)]
pub(super) struct Report<'a> {
    pub number: u64,
    pub scan: u64,
    pub time: Time,
    pub at: Location,
    /// What `--when` faulted with.
    pub faulted: Option<Fault>,
    pub path: Vec<String>,
    pub variables: Variables,
    pub sources: &'a Sources,
}

impl Report<'_> {
    pub fn text(&self, style: Style) -> String {
        let title = format!("in scan {}, at {}", self.scan, format_time(self.time));
        let mut out = excerpt(&title, self.sources.file(self.at.file).statement_at(self.at), self.sources, style);
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{}", self.path.join(" > "));
        if let Some(fault) = self.faulted {
            let _ = writeln!(out, "  --when cannot be evaluated here: {}", fault.kind);
        }
        let all = [&self.variables.locals, &self.variables.members];
        let width = all.iter().flat_map(|it| it.iter()).map(|it| it.name.chars().count()).max().unwrap_or(0);
        for it in all.into_iter().flatten() {
            let _ = writeln!(out, "  {:width$} : {} = {}", it.name, it.ty, it.value);
        }
        out
    }

    pub fn json(&self) -> String {
        let source = self.sources.file(self.at.file);
        let line = source.text.get(source.line_range(self.at.line)).unwrap_or_default();
        let path: Vec<_> = self.path.iter().map(|it| json_text(it)).collect();
        let fault = self.faulted.map_or_else(|| "null".to_owned(), |it| json_text(&it.kind.to_string()));
        format!(
            "{{\"reason\":\"stop\",\"stop\":{},\"scan\":{},\"time_ns\":{},\"file\":{},\"line\":{},\"column\":{},\"source\":{},\
             \"path\":[{}],\"when_fault\":{fault},\"locals\":[{}],\"members\":[{}]}}",
            self.number,
            self.scan,
            self.time,
            json_text(&source.path),
            self.at.line,
            self.at.column,
            json_text(line),
            path.join(","),
            objects(&self.variables.locals),
            objects(&self.variables.members),
        )
    }
}

fn objects(all: &[Shown]) -> String {
    all.iter().map(|it| format!("{{{}}}", it.json())).collect::<Vec<_>>().join(",")
}

impl Shown {
    /// Without the braces.
    pub fn json(&self) -> String {
        let [name, ty, value] = [&self.name, &self.ty, &self.value].map(|it| json_text(it));
        format!("\"name\":{name},\"type\":{ty},\"value\":{value}")
    }
}
