//! FOR loops whose counter nobody looks at while they run: `for _ in 0..8`, and the counter's last value after that.
//!
//! A loop that counts from 0 by ones is what LLVM's passes over loops start from, and the counter is not a variable that is alive
//! through it. So it finds that a loop over the bits of a number computes a CRC, and takes a table.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::effects::{Rules, statement_faults};
use staunch_ir::faults::code_faults;
use staunch_ir::{For, Root, Statement, StatementKind, Step, Value, visit};

use crate::function::Function;
use crate::literal::{literal, plain};
use crate::loops::uses;

const RULES: Rules = Rules { operation_faults: code_faults, ..Rules::PLAIN };

/// A loop of so many turns, after which its counter is this.
pub struct Counted {
    turns: i128,
    end: Value,
}

impl Function<'_> {
    /// The loop as one that only counts: where its turns are known, all of them are taken, and nothing in them reads the counter.
    pub fn counted(&self, it: &For) -> Option<Counted> {
        let Step::Constant(step) = it.step else { return None };
        let is_local = matches!(it.counter.root, Root::Local(_)) && it.counter.projections.is_empty();
        if !is_local || !it.is_private || it.may_leave_range() || !self.runs_to_its_end(it) {
            return None;
        }
        let [first, last] = [&it.first, &it.last].map(|it| it.as_const().and_then(Value::as_integer));
        let turns = (last? - first?).checked_div(step)? + 1;
        // One turn or none is hardly meant, and as a range it says less than the comparison does.
        if turns < 2 || (last? < first?) != (step < 0) {
            return None;
        }
        let end = self.repr(it.counter.ty).integer(first? + turns * step)?;
        Some(Counted { turns, end })
    }

    /// `for _ in 0..turns { … } counter = end;`
    pub fn counted_loop(&mut self, it: &For, counted: &Counted) -> TokenStream {
        let labels = self.labels(&it.body, false);
        let body = self.turn(&labels, &it.body, |_| TokenStream::new());
        let turns = match i32::try_from(counted.turns) {
            Ok(turns) => Literal::i32_unsuffixed(turns),
            Err(_) => Literal::i128_suffixed(counted.turns),
        };
        let end = literal(plain(self.repr(it.counter.ty)), counted.end, false).tokens;
        let set = self.given(&it.counter, &end);
        quote!(for _ in 0..#turns { #body } #set)
    }

    fn runs_to_its_end(&self, it: &For) -> bool {
        let mut does = true;
        visit::statements(&it.body, &mut |inner| {
            does &= is_plain(&inner.kind);
            visit::accesses(inner, &mut |place, _| does &= !place.is_same_variable(&it.counter));
        });
        let leaves = uses(&it.body, &|it| matches!(it, StatementKind::Exit));
        does && !leaves && !it.body.iter().any(|it| self.may_fault(it))
    }

    fn may_fault(&self, statement: &Statement) -> bool {
        let checked = vec![false; self.routine.locals.len()];
        statement_faults(self.emitter.program, &RULES, &[], self.routine, (Vec::new(), checked), statement)
    }
}

/// Whether a statement runs nothing that is elsewhere, and leaves no more than a loop.
fn is_plain(kind: &StatementKind) -> bool {
    match kind {
        StatementKind::Assign { .. }
        | StatementKind::If { .. }
        | StatementKind::Case { .. }
        | StatementKind::Loop { .. }
        | StatementKind::For(_)
        | StatementKind::Exit
        | StatementKind::Continue
        | StatementKind::CallBlock { .. } => true,
        StatementKind::Turn
        | StatementKind::Try { .. }
        | StatementKind::Finally { .. }
        | StatementKind::Return
        | StatementKind::Call { .. }
        | StatementKind::External(_)
        | StatementKind::PrescanBlock { .. }
        | StatementKind::Stop(_)
        | StatementKind::Fault(_) => false,
    }
}
