//! The blocks of a function with what each costs, and the longest way through them.

use std::collections::BTreeSet;

/// A block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Node<C> {
    pub(crate) instructions: u64,
    pub(crate) calls: Vec<C>,
    pub(crate) next: Vec<usize>,
}

/// What the longest way asks of the graph's owner.
pub(crate) trait Costs<C> {
    /// The instructions of a call; `None` where the block that makes it is not run.
    fn call(&mut self, call: &C) -> Option<u64>;
    /// How often control goes back to `head` from the blocks in `from`, each time that the loop is entered.
    fn repeats(&mut self, head: usize, from: &[usize]) -> u64;
    /// A loop with more than one start.
    fn tangled(&mut self);
}

/// The most instructions on a way from the first block to any end.
pub(crate) fn longest<C>(nodes: &[Node<C>], costs: &mut dyn Costs<C>) -> u64 {
    let mut weights = Vec::with_capacity(nodes.len());
    for node in nodes {
        let calls: Option<Vec<u64>> = node.calls.iter().map(|it| costs.call(it)).collect();
        weights.push(calls.map(|it| it.into_iter().fold(node.instructions, u64::saturating_add)));
    }
    let run: BTreeSet<usize> = (0..nodes.len()).filter(|it| weights[*it].is_some()).collect();
    let weights: Vec<u64> = weights.into_iter().map(Option::unwrap_or_default).collect();
    if !run.contains(&0) {
        return 0;
    }
    let mut longest = Longest { nodes, weights, heads: BTreeSet::new(), costs };
    longest.from(0, &run)
}

struct Longest<'a, C> {
    nodes: &'a [Node<C>],
    weights: Vec<u64>,
    /// The starts of the loops that are open: what leads back to them is counted.
    heads: BTreeSet<usize>,
    costs: &'a mut dyn Costs<C>,
}

impl<C> Longest<'_, C> {
    /// The longest way among `within` that begins at `start`.
    fn from(&mut self, start: usize, within: &BTreeSet<usize>) -> u64 {
        let mut most = 0;
        let mut before = vec![0_u64; self.nodes.len()];
        // In an order in which what leads to a part comes before it.
        let parts = self.parts(start, within);
        let within: &BTreeSet<usize> = &parts.iter().flatten().copied().collect();
        for part in parts {
            let weight = self.part(start, &part, within);
            let reached = part.iter().map(|it| before[*it]).max().unwrap_or(0);
            let end = reached.saturating_add(weight);
            most = most.max(end);
            for at in &part {
                for next in self.next(*at, within).collect::<Vec<_>>() {
                    before[next] = before[next].max(end);
                }
            }
        }
        most
    }

    /// One block, or a loop.
    fn part(&mut self, start: usize, part: &BTreeSet<usize>, within: &BTreeSet<usize>) -> u64 {
        let first = *part.first().expect("a part has blocks");
        let is_loop = part.len() > 1 || self.next(first, within).any(|it| it == first);
        if !is_loop {
            return self.weights[first];
        }
        let mut heads: BTreeSet<usize> = part.iter().copied().filter(|it| *it == start).collect();
        for at in within.difference(part) {
            heads.extend(self.next(*at, within).filter(|it| part.contains(it)));
        }
        let head = *heads.first().expect("control comes into a loop that it reaches");
        if heads.len() > 1 {
            self.costs.tangled();
        }
        let from: Vec<usize> = part.iter().copied().filter(|at| self.next(*at, part).any(|it| it == head)).collect();
        let repeats = self.costs.repeats(head, &from);
        self.heads.extend(&heads);
        let once = self.from(head, part);
        heads.iter().for_each(|it| _ = self.heads.remove(it));
        once.saturating_mul(repeats.saturating_add(1))
    }

    fn next<'s>(&'s self, at: usize, within: &'s BTreeSet<usize>) -> impl Iterator<Item = usize> + 's {
        self.nodes[at].next.iter().copied().filter(|it| within.contains(it) && !self.heads.contains(it))
    }

    /// The strongly connected parts that control reaches from `start`, each after those that lead to it. It takes no stack, so
    /// that a function may be as large as it likes.
    fn parts(&self, start: usize, within: &BTreeSet<usize>) -> Vec<BTreeSet<usize>> {
        let order = self.ended(start, within);
        let mut before = vec![Vec::new(); self.nodes.len()];
        for at in &order {
            self.next(*at, within).for_each(|it| before[it].push(*at));
        }
        let (mut taken, mut parts) = (vec![false; self.nodes.len()], Vec::new());
        for root in order.iter().rev() {
            let (mut part, mut open) = (BTreeSet::new(), vec![*root]);
            while let Some(at) = open.pop() {
                if !std::mem::replace(&mut taken[at], true) {
                    part.insert(at);
                    open.extend(&before[at]);
                }
            }
            if !part.is_empty() {
                parts.push(part);
            }
        }
        parts
    }

    /// All that control reaches, each after what it reaches from there.
    fn ended(&self, start: usize, within: &BTreeSet<usize>) -> Vec<usize> {
        let (mut seen, mut order) = (vec![false; self.nodes.len()], Vec::new());
        seen[start] = true;
        let mut open = vec![(start, self.next(start, within).collect::<Vec<_>>())];
        while let Some((at, rest)) = open.last_mut() {
            match rest.pop() {
                Some(next) if seen[next] => {}
                Some(next) => {
                    seen[next] = true;
                    open.push((next, self.next(next, within).collect()));
                }
                None => {
                    order.push(*at);
                    open.pop();
                }
            }
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Given(u64, usize);

    impl Costs<u64> for Given {
        fn call(&mut self, call: &u64) -> Option<u64> {
            (*call != 0).then_some(*call)
        }

        fn repeats(&mut self, _: usize, _: &[usize]) -> u64 {
            self.0
        }

        fn tangled(&mut self) {
            self.1 += 1;
        }
    }

    fn node(instructions: u64, next: &[usize]) -> Node<u64> {
        Node { instructions, calls: Vec::new(), next: next.to_vec() }
    }

    #[test]
    fn the_longer_branch_counts() {
        let nodes = [node(1, &[1, 2]), node(10, &[3]), node(20, &[3]), node(5, &[])];
        assert_eq!(longest(&nodes, &mut Given(0, 0)), 26);
        let called =
            [Node { calls: vec![30], ..node(1, &[1, 2]) }, node(10, &[]), Node { calls: vec![0], ..node(99, &[]) }];
        assert_eq!(longest(&called, &mut Given(0, 0)), 41);
    }

    #[test]
    fn loops_are_repeated() {
        // 1 and 2 are in a loop, and 2 is one of its own.
        let nodes = [node(1, &[1]), node(2, &[2]), node(3, &[2, 1, 3]), node(7, &[])];
        let inner = 3 * 5;
        assert_eq!(longest(&nodes, &mut Given(4, 0)), 1 + (2 + inner) * 5 + 7);
    }

    #[test]
    fn two_starts_are_seen() {
        let nodes = [node(1, &[1, 2]), node(1, &[2]), node(1, &[1])];
        let mut given = Given(1, 0);
        longest(&nodes, &mut given);
        assert_eq!(given.1, 1);
    }
}
