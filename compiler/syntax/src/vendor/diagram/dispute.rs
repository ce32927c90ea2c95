//! Where the editors' two orders of execution give different results.

use super::super::assembly::Chunk;
use super::super::assembly::text;
use super::node::{Diagram, Kind};
use super::order::by_place;
use core::ops::Range;
use rustc_hash::FxHashSet;

/// More elements are not compared, each with each.
const MOST: usize = 2_000;

/// What an element reads and writes with all that is executed for it.
struct Used {
    reads: FxHashSet<String>,
    writes: FxHashSet<String>,
}

/// Two elements that are executed in this order, as the file has them, and in the other one by their places, where that matters: one
/// writes what the other reads or writes.
pub fn dispute(
    file: &str,
    diagram: &Diagram,
    statements: &[Chunk],
    groups: &[(usize, Range<usize>)],
) -> Option<(usize, usize)> {
    if groups.len() > MOST {
        return None;
    }
    let mut rank = vec![0; diagram.nodes.len()];
    for (at, node) in by_place(diagram).into_iter().enumerate() {
        rank[node] = at;
    }
    let used: Vec<Used> = groups.iter().map(|it| used(file, &statements[it.1.clone()])).collect();
    let is_connector = |at: usize| matches!(diagram.nodes[groups[at].0].kind, Kind::Connector(_));
    for late in 0..groups.len() {
        for early in 0..late {
            let (a, b) = (groups[early].0, groups[late].0);
            let is_turned = rank[a] > rank[b] && !is_connector(early) && !is_connector(late);
            if is_turned && depend(&used[early], &used[late]) {
                return Some((a, b));
            }
        }
    }
    None
}

fn depend(a: &Used, b: &Used) -> bool {
    !a.writes.is_disjoint(&b.reads) || !b.writes.is_disjoint(&a.reads) || !a.writes.is_disjoint(&b.writes)
}

fn used(file: &str, statements: &[Chunk]) -> Used {
    let written = text(file, statements).to_ascii_uppercase();
    let names = written.split(|it: char| !it.is_alphanumeric() && it != '_').filter(|it| !it.is_empty());
    let reads = names.map(ToOwned::to_owned).collect();
    // `x := …` and `instance(…)`, also after THEN.
    let targets = written.split(';').filter_map(|it| {
        let statement = it.rsplit_once(" THEN\n").map_or(it, |it| it.1).trim();
        let end = statement.find(|it: char| !it.is_alphanumeric() && it != '_')?;
        Some(statement[..end].to_owned())
    });
    Used { reads, writes: targets.collect() }
}
