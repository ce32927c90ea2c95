//! The sources, with how often each line was executed, and what is left open below the line.

use super::File;
use crate::session::Session;
use std::collections::BTreeMap;

/// A line of a source.
struct Line<'s> {
    number: u32,
    text: &'s str,
    /// Of the statement that was executed most; `None` where none begins.
    count: Option<u64>,
    open: Vec<String>,
}

fn lines<'s>(session: &'s Session, file: &File) -> Vec<Line<'s>> {
    let source = session.sources.file(file.number);
    let mut counts: BTreeMap<u32, u64> = BTreeMap::new();
    for (at, count) in &file.statements {
        let line = counts.entry(at.line).or_default();
        *line = (*line).max(*count);
    }
    let mut open: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    file.open(session).into_iter().for_each(|(at, what)| open.entry(at.line).or_default().push(what));
    let line = |(number, text): (u32, &'s str)| Line {
        number,
        text,
        count: counts.get(&number).copied(),
        open: open.remove(&number).unwrap_or_default(),
    };
    (1..).zip(source.text.lines()).map(line).collect()
}

pub fn text(session: &Session, files: &[File]) -> String {
    let mut text = String::new();
    for file in files {
        text += &format!("{}\n", file.path);
        for line in lines(session, file) {
            let count = line.count.map(|it| it.to_string()).unwrap_or_default();
            text += format!("{count:>8} | {:>5} | {}", line.number, line.text).trim_end();
            text.push('\n');
            line.open.iter().for_each(|it| text += &format!("{:>8} | {:>5} | ^ {it}\n", "", ""));
        }
        text.push('\n');
    }
    text
}

/// One file, which needs no network.
pub fn page(session: &Session, files: &[File]) -> String {
    let mut text = String::from(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Coverage</title>\n<style>\n\
         body { font: 14px system-ui, sans-serif; margin: 2em }\n\
         table { border-collapse: collapse; font: 13px ui-monospace, monospace }\n\
         td { padding: 0 .7em; white-space: pre; vertical-align: top }\n\
         td.number { text-align: right; color: #777 }\n\
         tr.yes td.code { background: #e6f4e6 } tr.no td.code { background: #fbdcdc } tr.part td.code { background: #fdf3cf }\n\
         .open { color: #a02020 }\n</style></head><body>\n",
    );
    for file in files {
        let [statements, branches, conditions] = file.figures().map(|(part, whole)| format!("{part} of {whole}"));
        text += &format!("<h2>{}</h2>\n<p>{statements} statements, {branches} branches, ", escaped(&file.path));
        text += &format!("{conditions} conditions</p>\n<table>\n");
        lines(session, file).iter().for_each(|it| text += &row(it));
        text += "</table>\n";
    }
    text + "</body></html>\n"
}

fn row(line: &Line<'_>) -> String {
    let class = match (line.count, line.open.is_empty()) {
        (Some(0), _) => "no",
        (_, false) => "part",
        (Some(_), true) => "yes",
        (None, true) => "",
    };
    let count = line.count.map(|it| it.to_string()).unwrap_or_default();
    let open: String = line.open.iter().map(|it| format!("\n<span class=\"open\">^ {}</span>", escaped(it))).collect();
    format!(
        "<tr class=\"{class}\"><td class=\"number\">{count}</td><td class=\"number\">{}</td><td class=\"code\">{}{open}</td></tr>\n",
        line.number,
        escaped(line.text)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
