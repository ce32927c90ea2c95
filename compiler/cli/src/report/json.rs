//! The figures as one object on one line.

use super::figures::{Figures, OfTask};
use super::memory::Memory;
use super::stack::Need;
use super::time::{Time, Unbounded};
use staunch_host::json_text;

pub fn text(figures: &Figures) -> String {
    format!(
        "{{\"reason\":\"report\",\"target\":{},\"tasks\":{},\"total\":{{{}}}}}\n",
        json_text(&figures.target),
        list(figures.tasks.iter().map(task)),
        memory(&figures.whole)
    )
}

fn task(it: &OfTask) -> String {
    format!(
        "{{\"name\":{},\"programs\":{},\"interval_ns\":{},{},{},{}}}",
        json_text(&it.task.name),
        list(it.task.instances.iter().map(|it| json_text(&it.name))),
        it.task.interval.map_or_else(null, |it| it.to_string()),
        memory(&it.memory),
        stack(&it.stack),
        time(&it.time)
    )
}

fn memory(it: &Memory) -> String {
    format!(
        "\"state_bytes\":{},\"retained_bytes\":{},\"constant_bytes\":{},\"text_bytes\":{}",
        it.state, it.retained, it.constant, it.text
    )
}

fn stack(it: &Need) -> String {
    let bytes = if it.unknown.is_empty() { it.bytes.to_string() } else { null() };
    format!(
        "\"stack_bytes\":{bytes},\"stack_path\":{},\"stack_unknown\":{}",
        path(&it.path, "bytes"),
        list(it.unknown.iter().map(|it| json_text(it)))
    )
}

fn time(it: &Time) -> String {
    format!(
        "\"instructions\":{},\"instructions_path\":{},\"unbounded\":{}",
        it.instructions.map_or_else(null, |it| it.to_string()),
        path(&it.path, "instructions"),
        list(it.unbounded.iter().map(unbounded))
    )
}

fn unbounded(it: &Unbounded) -> String {
    let message = json_text(&it.text);
    match &it.place {
        Some((file, at)) => {
            let (line, column) = (at.line, at.column);
            format!("{{\"file\":{},\"line\":{line},\"column\":{column},\"message\":{message}}}", json_text(file))
        }
        None => format!("{{\"message\":{message}}}"),
    }
}

fn path(functions: &[(String, u64)], unit: &str) -> String {
    list(functions.iter().map(|(name, number)| format!("{{\"name\":{},\"{unit}\":{number}}}", json_text(name))))
}

fn list(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(","))
}

fn null() -> String {
    "null".to_owned()
}
