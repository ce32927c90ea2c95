//! WHILE and REPEAT that do not take their turns one by one: all of them before the first one, where a variable is stepped
//! toward a bound, else several at once, by the runtime's macro `strips!`.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::alias::Frame;
use staunch_ir::loops::Known;
use staunch_ir::turns::{self, Linear};
use staunch_ir::{Block, RoutineId, Statement, StatementKind, visit};

use crate::function::Function;
use crate::loops::uses;
use crate::precedence::Level;

/// Operations that the turns taken at once should come to: as much as LLVM unrolls whole.
const ENOUGH: usize = 600;
const MOST: usize = 32;
const LEAST: usize = 4;
/// Operations in one routine, so that its code grows by no more.
const MOST_IN_A_ROUTINE: usize = 8192;

impl Function<'_> {
    /// What makes a strip of the loop around it, with the loop's turn, and the rest of the body. The macro knows a turn that
    /// is the first statement.
    pub fn strip<'s>(
        &mut self,
        whole: &Block,
        body: &'s [Statement],
        continuing: &Block,
    ) -> (Option<TokenStream>, &'s [Statement]) {
        let Some((turn, rest)) = body.split_first().filter(|it| matches!(it.0.kind, StatementKind::Turn)) else {
            return (None, body);
        };
        let Some(rounds) = self.rounds(whole, continuing) else { return (None, body) };
        let (rounds, turn) = (Literal::usize_unsuffixed(rounds), self.statements(std::slice::from_ref(turn)));
        (Some(quote!(st_strips!(#rounds); #turn)), rest)
    }

    /// How many rounds a strip has: a power of two, as few different loops are easier to read.
    fn rounds(&mut self, whole: &Block, continuing: &Block) -> Option<usize> {
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

    /// `WHILE i < n DO … i := i + 1; END_WHILE` that nothing else leaves.
    pub fn linear_loop(&mut self, whole: &Block, continuing: &Block) -> Option<TokenStream> {
        if !continuing.is_empty() {
            return None;
        }
        let program = self.emitter.program;
        let known = Known { program, loops: &[], checked: &|_| false };
        let frame = Frame::of(program, self.routine);
        let it = turns::linear(&known, &frame, whole, &|it| self.callee_takes_turns(it))?;
        let mut returns = false;
        visit::statements(it.body, &mut |it| returns |= matches!(it.kind, StatementKind::Return));
        let ends_early = returns || uses(it.body, &|it| matches!(it, StatementKind::Exit));
        (it.others.is_empty() && !ends_early).then(|| self.prepaid_while(&it))
    }

    fn prepaid_while(&mut self, it: &Linear<'_>) -> TokenStream {
        let (is_up, is_inclusive) = (it.step > 0, it.offset == 0);
        let bound = self.once(if is_inclusive { "last" } else { "bound" }, it.bound);
        let (name, at) = (self.made_up("turns", self.loops.around.len()), self.emitter.at(it.at));
        let (counter, step) = (self.count(it.counter), Literal::i128_unsuffixed(it.step));
        let (first, limit) = (counter.tokens.clone(), bound.value);
        let compared = counter.above(Level::Compare);
        let (take, condition, end) = match (is_inclusive, is_up) {
            (true, true) => (quote!(take_turns), quote!(#compared <= #name.limit), quote!(cx, #first)),
            (true, false) => (quote!(take_turns), quote!(#compared >= #name.limit), quote!(cx, #first)),
            (false, true) => (quote!(take_turns_before), quote!(#compared < #name.limit), quote!()),
            (false, false) => (quote!(take_turns_before), quote!(#compared > #name.limit), quote!()),
        };
        let labels = self.labels(it.body, false);
        let body = self.turn(&labels, it.body, |_| TokenStream::new());
        let before = bound.before;
        quote! {
            #before
            let #name = cx.#take(#first, #limit, #step)#at?;
            while #condition { #body }
            #name.end(#end)#at?;
        }
    }
}
