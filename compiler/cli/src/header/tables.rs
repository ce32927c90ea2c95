//! Tables that a host makes of a program: its tasks, what is at addresses, and what a power cycle keeps.

use super::names::Names;
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;
use staunch_ir::{Address, FieldId, Program, Projection};
use std::fmt::Write;

/// Each is a macro with the rows of an array, and one with their number, so that nothing is in the program that is not used.
pub fn tables(program: &Program, layout: &Layout, names: &mut Names) -> String {
    let mut text = String::from(
        "\n/* Tables, for `static const staunch_task tasks[] = STAUNCH_TASKS;` and so on: the instances that run, the variables at\n   \
         addresses, and the bytes that are kept over a power cycle. A table without rows is left out. */\n",
    );
    let tasks = program.instances.iter().enumerate().map(|(number, it)| {
        format!("{{{}, {number}u, INT64_C({}), {}u}}", quoted(&it.name), it.interval.unwrap_or(0), it.priority)
    });
    table(&mut text, &names.own("TASKS"), tasks.collect());
    table(&mut text, &names.own("LOCATED"), located(program, layout));
    table(&mut text, &names.own("RETAINED"), retained(program, layout));
    text
}

fn table(text: &mut String, name: &str, rows: Vec<String>) {
    if rows.is_empty() {
        return;
    }
    let _ = writeln!(text, "#define {name}_COUNT {}u", rows.len());
    let _ = writeln!(text, "#define {name} {{ \\\n    {} }}", rows.join(", \\\n    "));
}

/// All storage at addresses is among the globals.
fn located(program: &Program, layout: &Layout) -> Vec<String> {
    let row = |address: &Address, offset: u64, size: u64, bit: Option<u64>| {
        let bit = bit.map_or("-1".to_owned(), |it| it.to_string());
        format!("{{{}, {offset}u, {size}u, {bit}}}", quoted(address.to_string()))
    };
    let base = layout.machine.globals;
    let fields = program.structure(program.globals).fields.iter().enumerate().filter_map(|(at, field)| {
        let offset = base + layout.field(program.globals, FieldId::next(at));
        Some(row(field.address.as_ref()?, offset, layout.size(field.ty), None))
    });
    let views = program.aliases.iter().filter_map(|alias| {
        let (Some(view), Some(Projection::Field(field))) = (alias.view, alias.place.projections.first()) else {
            return None;
        };
        let offset = base + layout.field(program.globals, *field) + view.bit / 8;
        let bit = (view.address.width == 1).then_some(view.bit % 8);
        Some(row(&view.address, offset, layout.size(view.ty), bit))
    });
    fields.chain(views).collect()
}

fn retained(program: &Program, layout: &Layout) -> Vec<String> {
    let Ok(map) = staunch_host::Map::parse(&map_text(program, layout)) else { return Vec::new() };
    let ranges = staunch_host::retained(&map);
    ranges.iter().map(|it| format!("{{{}u, {}u}}", it.start, it.len())).collect()
}

/// A text in C.
pub fn quoted(text: impl AsRef<[u8]>) -> String {
    let mut quoted = String::from("\"");
    for &byte in text.as_ref() {
        match byte {
            b'"' | b'\\' => quoted.extend(['\\', char::from(byte)]),
            // After `??` is a trigraph.
            b' '..=b'~' if byte != b'?' => quoted.push(char::from(byte)),
            _ => _ = write!(quoted, "\\{byte:03o}"),
        }
    }
    quoted.push('"');
    quoted
}
