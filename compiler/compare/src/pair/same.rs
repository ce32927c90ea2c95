//! Whether the two systems' programs do the same, by their text.

use super::Pair;
use crate::program::flow::Ranges;
use staunch_ir::layout::Layout;
use staunch_ir::symbols::map_text;
use staunch_ir::{Program, print};

/// What a map says of retention; which bytes are kept is compared by events.
const RETENTION: [&str; 4] = ["retain", "whole", "stays", "restarts"];

impl Pair {
    /// Whether both run a program that does the same: the statements in their plain form, the types with their blocks, where each
    /// variable lies, and what each event keeps are the same. What the systems do after a fault is not known to be.
    pub fn runs_the_same(&self) -> bool {
        let [a, b] = &self.sides;
        let events = self.events();
        let plain = |side: usize| {
            let plain = Ranges::of(&self.sides[side].program, &self.starts(side)).plain()?;
            Some(text(&plain))
        };
        events.into_iter().all(|it| a.drive.keeps_as(it, &b.drive)) && plain(0).is_some_and(|it| plain(1) == Some(it))
    }
}

/// The program, where its variables are, and when it runs.
fn text(program: &Program) -> String {
    let (mut text, map) = (print(program), map_text(program, &Layout::new(program)));
    // The map has no variables of a call. A block of another vendor may have the same name, and has another number.
    for routine in &program.routines {
        let types = routine.locals.iter().map(|it| it.ty).chain(routine.params.iter().map(|it| it.ty));
        types.for_each(|it| text += &format!("{it:?}\n"));
    }
    // The times that a system has matter where a variable is one.
    let has_times = text.contains("TIME") || map.contains("TIME");
    let lines = map.lines().filter(|it| has_times || !it.starts_with("times\t"));
    lines.for_each(|it| text += &without_retention(it));
    text
}

fn without_retention(line: &str) -> String {
    let cells = line.split('\t').map(|cell| {
        let flags: Vec<&str> = cell.split(',').filter(|it| !RETENTION.contains(it)).collect();
        if flags.is_empty() { "-".to_owned() } else { flags.join(",") }
    });
    let kept: Vec<String> = cells.collect();
    kept.join("\t") + "\n"
}
