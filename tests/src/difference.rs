//! What changed between two texts, line by line.

use std::fmt::Write;

/// The lines that differ, with `-` before the old and `+` before the new ones.
pub fn lines(old: &str, new: &str) -> String {
    let (old, new): (Vec<_>, Vec<_>) = (old.lines().collect(), new.lines().collect());
    let start = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let tail = |text: &[&str]| text[start..].iter().rev().map(|it| (*it).to_owned()).collect::<Vec<_>>();
    let end = tail(&old).iter().zip(&tail(&new)).take_while(|(a, b)| a == b).count();
    let mut text = String::new();
    for step in steps(&old[start..old.len() - end], &new[start..new.len() - end]) {
        let _ = match step {
            Step::Both => continue,
            Step::Old(line) => writeln!(text, "-{line}"),
            Step::New(line) => writeln!(text, "+{line}"),
        };
    }
    text
}

enum Step<'t> {
    Both,
    Old(&'t str),
    New(&'t str),
}

/// By the longest common subsequence.
fn steps<'t>(old: &[&'t str], new: &[&'t str]) -> Vec<Step<'t>> {
    let mut common = vec![vec![0_usize; new.len() + 1]; old.len() + 1];
    for (i, a) in old.iter().enumerate().rev() {
        for (j, b) in new.iter().enumerate().rev() {
            common[i][j] = if a == b { common[i + 1][j + 1] + 1 } else { common[i + 1][j].max(common[i][j + 1]) };
        }
    }
    let (mut i, mut j, mut steps) = (0, 0, Vec::new());
    while i < old.len() || j < new.len() {
        let step = match (old.get(i), new.get(j)) {
            (Some(a), Some(b)) if a == b => Step::Both,
            (Some(a), Some(_)) if common[i + 1][j] >= common[i][j + 1] => Step::Old(a),
            (_, Some(b)) => Step::New(b),
            (Some(a), None) => Step::Old(a),
            (None, None) => break,
        };
        i += usize::from(!matches!(step, Step::New(_)));
        j += usize::from(!matches!(step, Step::Old(_)));
        steps.push(step);
    }
    steps
}
