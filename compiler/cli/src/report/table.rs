//! The figures as a table, for people.

use super::budget::path;
use super::figures::{Figures, OfTask};
use super::memory::Memory;

const COLUMNS: usize = 7;
const HEADINGS: [&str; COLUMNS] = ["task", "state", "retained", "constant", "text", "stack", "instructions"];

pub fn text(figures: &Figures) -> String {
    let mut rows = vec![HEADINGS.map(str::to_owned)];
    rows.extend(figures.tasks.iter().map(row));
    rows.push(cells("whole program", &figures.whole, [String::new(), String::new()]));
    let mut text = format!("Bytes, and the most instructions of a scan, for {}\n\n", figures.target);
    lines(&mut text, &rows);
    text.push('\n');
    figures.tasks.iter().for_each(|it| text += &details(it));
    text
}

fn row(it: &OfTask) -> [String; COLUMNS] {
    let stack = if it.stack.unknown.is_empty() { it.stack.bytes.to_string() } else { "unknown".to_owned() };
    let instructions = it.time.instructions.map_or_else(|| "no bound".to_owned(), |it| it.to_string());
    cells(&it.task.name, &it.memory, [stack, instructions])
}

fn cells(name: &str, memory: &Memory, [stack, instructions]: [String; 2]) -> [String; COLUMNS] {
    let Memory { state, retained, constant, text } = memory;
    let [state, retained, constant, text] = [state, retained, constant, text].map(u64::to_string);
    [name.to_owned(), state, retained, constant, text, stack, instructions]
}

/// The first column begins at the left, the others end at the right.
fn lines(text: &mut String, rows: &[[String; COLUMNS]]) {
    let width = |at: usize| rows.iter().map(|it| it[at].chars().count()).max().unwrap_or(0);
    let widths: [usize; COLUMNS] = std::array::from_fn(width);
    let line = |text: &mut String, cells: &[String; COLUMNS]| {
        let mut line = format!("{:<1$}", cells[0], widths[0]);
        cells.iter().zip(widths).skip(1).for_each(|(it, width)| line += &format!("  {it:>width$}"));
        *text += line.trim_end();
        text.push('\n');
    };
    for (at, row) in rows.iter().enumerate() {
        line(text, row);
        if at == 0 {
            line(text, &widths.map(|it| "─".repeat(it)));
        }
    }
}

/// The deepest and the longest path, and what is not known.
fn details(it: &OfTask) -> String {
    let name = &it.task.name;
    let mut text = format!("Stack of {name}: {}\n", path(&it.stack.path));
    if !it.stack.unknown.is_empty() {
        text += &format!("  External code may need any amount of stack: {}\n", it.stack.unknown_names());
    }
    if it.time.instructions.is_some() {
        text += &format!("Instructions of {name}: {}\n", path(&it.time.path));
        return text;
    }
    text += &format!("Instructions of {name}: there is no bound\n");
    it.time.unbounded.iter().for_each(|it| text += &format!("  {}\n", it.line()));
    text
}
