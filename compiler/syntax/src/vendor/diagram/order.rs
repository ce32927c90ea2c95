//! The order of execution.

use super::context::Rules;
use super::node::{Diagram, Kind, Node};
use core::cmp::Ordering;

/// What takes a value or is called, in order: first what has a number, then the others, connectors last.
///
/// Of Beremiz from April 2023 on, and of OpenPLC Editor in Python 3: coils and variables, then blocks, each as the file has them.
/// Of OpenPLC Editor 4, whose `xml2st` was corrected in October 2025: all of them, connectors too, from top to bottom and from left to
/// right. CODESYS has blocks among the others, in the order of its file.
pub fn in_order(diagram: &Diagram, rules: Rules) -> Vec<usize> {
    let (mut order, others) = numbered(diagram);
    let connectors = others.clone().filter(|it| matches!(diagram.nodes[*it].kind, Kind::Connector(_)));
    let targets = others.clone().filter(|it| is_target(diagram, *it));
    let blocks = others.clone().filter(|it| is_block(diagram, *it));
    match rules {
        Rules::Beremiz => order.extend(targets.chain(blocks).chain(connectors)),
        Rules::Editor4 => order.extend(sorted(diagram, targets.chain(blocks).chain(connectors))),
        Rules::Codesys => {
            order.extend(
                others.clone().filter(|it| is_target(diagram, *it) || is_block(diagram, *it)).chain(connectors),
            );
        }
    }
    order
}

/// The same without connectors, as the editors before had it: coils and variables from top to bottom and from left to right, and so
/// blocks.
pub fn by_place(diagram: &Diagram) -> Vec<usize> {
    let (mut order, others) = numbered(diagram);
    order.extend(sorted(diagram, others.clone().filter(|it| is_target(diagram, *it))));
    order.extend(sorted(diagram, others.filter(|it| is_block(diagram, *it))));
    order
}

/// What has a number, in that order, and the others.
fn numbered(diagram: &Diagram) -> (Vec<usize>, impl Iterator<Item = usize> + Clone) {
    let has_number = |at: &usize| {
        let node = &diagram.nodes[*at];
        node.order > 0 && matches!(node.kind, Kind::Sink(_) | Kind::Both(_) | Kind::Block { .. })
    };
    let mut order: Vec<usize> = (0..diagram.nodes.len()).filter(has_number).collect();
    order.sort_by_key(|it| diagram.nodes[*it].order);
    (order, (0..diagram.nodes.len()).filter(move |it| !has_number(it)))
}

fn is_target(diagram: &Diagram, at: usize) -> bool {
    matches!(diagram.nodes[at].kind, Kind::Sink(_) | Kind::Both(_) | Kind::Coil(_))
}

fn is_block(diagram: &Diagram, at: usize) -> bool {
    matches!(diagram.nodes[at].kind, Kind::Block { .. })
}

/// Elements within ten pixels are in one row, so that this does not order all pairs: elements go in one by one, each to where halving
/// leads.
fn sorted(diagram: &Diagram, all: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut sorted: Vec<usize> = Vec::new();
    for at in all {
        let (mut low, mut high) = (0, sorted.len());
        while low < high {
            let middle = low.midpoint(high);
            match compared(&diagram.nodes[at], &diagram.nodes[sorted[middle]]) {
                Ordering::Less => high = middle,
                Ordering::Equal | Ordering::Greater => low = middle + 1,
            }
        }
        sorted.insert(low, at);
    }
    sorted
}

fn compared(a: &Node, b: &Node) -> Ordering {
    let (a, b) = (a.position, b.position);
    match a.y.abs_diff(b.y) < 10 {
        true => a.x.cmp(&b.x),
        false => a.y.cmp(&b.y),
    }
}
