//! Loops that take several turns at once, by the runtime's macro `strips!`.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use staunch_ir::turns;
use staunch_ir::{RoutineId, Statement, StatementKind};

use crate::function::Function;

/// Operations that the turns taken at once should come to: as much as LLVM unrolls whole.
const ENOUGH: usize = 600;
const MOST: usize = 32;
const LEAST: usize = 4;
/// Operations in one routine, so that its code grows by no more.
const MOST_IN_A_ROUTINE: usize = 8192;

impl Function<'_> {
    /// What makes a strip of the loop around it, with the loop's turn, and the rest of the body. The macro knows a turn that
    /// is the first statement. Where `few` is true, the loop takes no turns.
    pub fn strip<'s>(
        &mut self,
        (whole, continuing): (&[Statement], &[Statement]),
        body: &'s [Statement],
        few: Option<&Ident>,
    ) -> (Option<TokenStream>, &'s [Statement]) {
        let Some((turn, rest)) = body.split_first().filter(|it| matches!(it.0.kind, StatementKind::Turn)) else {
            return (None, body);
        };
        let Some(rounds) = self.rounds(whole, continuing) else { return (None, body) };
        let (rounds, turn) = (Literal::usize_unsuffixed(rounds), self.statements(std::slice::from_ref(turn)));
        let few = few.map(|it| quote!(, #it));
        (Some(quote!(st_strips!(#rounds #few); #turn)), rest)
    }

    /// How many rounds a strip has: a power of two, as few different loops are easier to read.
    fn rounds(&mut self, whole: &[Statement], continuing: &[Statement]) -> Option<usize> {
        // A strip takes its turns when it ends, and a fault would leave them.
        if self.emitter.handles_faults {
            return None;
        }
        let size = turns::size_of_single(whole, continuing, &|it| self.callee_takes_turns(it))?;
        let rounds = 1 << (ENOUGH / size.max(1)).clamp(1, MOST).ilog2();
        let copied = self.loops.copied + rounds * size;
        if rounds < LEAST || copied > MOST_IN_A_ROUTINE {
            return None;
        }
        self.loops.copied = copied;
        Some(rounds)
    }

    fn callee_takes_turns(&self, callee: RoutineId) -> bool {
        self.emitter.effects[callee.index()].turns
    }
}
