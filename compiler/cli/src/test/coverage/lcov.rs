//! Coverage as lcov's tools and most CI systems read it.

use super::{Branch, Condition, File, Way};
use crate::session::Session;
use std::collections::{BTreeMap, BTreeSet};

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

/// A decision is a block with its branches, on the line where it begins; `-` says that it was never reached.
fn branches(file: &File, text: &mut String) {
    let mut blocks: BTreeMap<(u32, u16), Vec<&Branch>> = BTreeMap::new();
    for branch in &file.branches {
        let at = match branch.way {
            Way::If(_) | Way::Otherwise => branch.at,
            Way::Label(case) => case,
        };
        blocks.entry((at.line, at.column)).or_default().push(branch);
    }
    for (block, ((line, _), branches)) in blocks.iter().enumerate() {
        let is_reached = branches.iter().any(|it| it.taken > 0);
        for (number, branch) in branches.iter().enumerate() {
            let taken = if is_reached { branch.taken.to_string() } else { "-".to_owned() };
            *text += &format!("BRDA:{line},{block},{number},{taken}\n");
        }
    }
    let hit = file.branches.iter().filter(|it| it.taken > 0).count();
    *text += &format!("BRF:{}\nBRH:{hit}\n", file.branches.len());
}

/// For each condition, whether it decided when it was TRUE, and when it was FALSE. A decision is where its first condition
/// is. lcov knows the decisions of a line by how many conditions they have: where two have as many, those of the line are
/// one.
fn conditions(session: &Session, file: &File, text: &mut String) {
    let mut lines: BTreeMap<u32, Vec<&[Condition]>> = BTreeMap::new();
    for decision in file.conditions.chunk_by(|a, b| a.decision == b.decision) {
        lines.entry(decision[0].at.line).or_default().push(decision);
    }
    for (line, decisions) in lines {
        let sizes: BTreeSet<usize> = decisions.iter().map(|it| it.len()).collect();
        let is_clear = sizes.len() == decisions.len();
        let all: usize = decisions.iter().map(|it| it.len()).sum();
        for (number, condition) in decisions.iter().copied().flatten().enumerate() {
            let (of, number) = if is_clear { (condition.of, condition.number) } else { (all, number) };
            let written = condition.text(session).replace(',', " ");
            for (sense, taken) in ["t", "f"].into_iter().zip(condition.decides()) {
                *text += &format!("MCDC:{line},{of},{sense},{taken},{number},{written}\n");
            }
        }
    }
    if !file.conditions.is_empty() {
        let hit: usize = file.conditions.iter().map(|it| it.decides().iter().filter(|it| **it > 0).count()).sum();
        *text += &format!("MCF:{}\nMCH:{hit}\n", file.conditions.len() * 2);
    }
}
