//! Coverage as lcov's tools and most CI systems read it.

use super::{File, Way, text};
use crate::session::Session;
use std::collections::BTreeMap;

pub fn text(session: &Session, files: &[File]) -> String {
    let mut text = String::new();
    for file in files {
        text += &format!("TN:\nSF:{}\n", file.path);
        branches(file, &mut text);
        conditions(session, file, &mut text);
        lines(file, &mut text);
        text += "end_of_record\n";
    }
    text
}

/// A line was executed as often as the statement on it that was executed most.
fn lines(file: &File, text: &mut String) {
    let mut lines: BTreeMap<u32, u64> = BTreeMap::new();
    for (at, count) in &file.statements {
        let line = lines.entry(at.line).or_default();
        *line = (*line).max(*count);
    }
    lines.iter().for_each(|(line, count)| *text += &format!("DA:{line},{count}\n"));
    *text += &format!("LF:{}\nLH:{}\n", lines.len(), lines.values().filter(|it| **it > 0).count());
}

fn branches(file: &File, text: &mut String) {
    for (number, branch) in file.branches.iter().enumerate() {
        let taken = if matches!(branch.way, Way::If(_)) && branch.reached == 0 {
            "-".to_owned()
        } else {
            branch.taken.to_string()
        };
        // The block is the decision; both of its branches are numbered in it.
        let (block, own) = match branch.way {
            Way::If(false) => (number - 1, 1),
            Way::If(true) | Way::Label | Way::Otherwise => (number, 0),
        };
        *text += &format!("BRDA:{},{block},{own},{taken}\n", branch.at.line);
    }
    let hit = file.branches.iter().filter(|it| it.taken > 0).count();
    *text += &format!("BRF:{}\nBRH:{hit}\n", file.branches.len());
}

/// For each condition, whether it decided when it was TRUE, and when it was FALSE.
fn conditions(session: &Session, file: &File, text: &mut String) {
    for condition in &file.conditions {
        let written = text::condition(session, condition.at, false).replace(',', " ");
        for (sense, value) in [("t", 1), ("f", 0)] {
            let taken = condition.decided[value];
            let (line, of, number) = (condition.at.line, condition.of, condition.number);
            *text += &format!("MCDC:{line},{of},{sense},{taken},{number},{written}\n");
        }
    }
    if !file.conditions.is_empty() {
        let hit: usize = file.conditions.iter().map(|it| it.decided.iter().filter(|it| **it > 0).count()).sum();
        *text += &format!("MCF:{}\nMCH:{hit}\n", file.conditions.len() * 2);
    }
}
