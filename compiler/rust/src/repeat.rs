//! Loops: WHILE where the shape allows, labels only where CONTINUE needs them, and counters kept
//! where the optimiser sees them.

use proc_macro2::TokenStream;
use quote::quote;
use staunch_ir::counted::exit_condition;
use staunch_ir::{Block, Place, Projection, Root, Statement, StatementKind, Value};

use crate::alias::overlap;
use crate::function::Function;
use crate::walk::{self, Access};

/// The labels of the loops around a statement, innermost last.
#[derive(Debug, Default)]
pub struct Loops {
    around: Vec<Labels>,
    made: usize,
}

#[derive(Clone, Debug)]
struct Labels {
    /// `Exit` inside the labelled block of the body.
    leave: TokenStream,
    /// `Continue`.
    next: TokenStream,
}

impl Function<'_> {
    pub fn repeat(&mut self, statements: &[Statement], at: usize, body: &Block, continuing: &Block) -> TokenStream {
        // A block around the body is what CONTINUE leaves when something follows the body.
        let labelled = !continuing.is_empty() && uses(body, &|it| matches!(it, StatementKind::Continue));
        let exits = uses(body, &|it| matches!(it, StatementKind::Exit));
        let (condition, body) = self.while_condition(body);
        let counter = self.counter(body, continuing);
        let exits = exits && labelled && uses(body, &|it| matches!(it, StatementKind::Exit));
        self.loops.made += usize::from(labelled);
        let loop_label = lifetime(&format!("loop_{}", self.loops.made));
        let next_label = lifetime(&format!("next_{}", self.loops.made));
        let plain = Labels { leave: quote!(break;), next: quote!(continue;) };
        let labels = if labelled {
            Labels { leave: quote!(break #loop_label;), next: quote!(break #next_label;) }
        } else {
            plain.clone()
        };
        self.loops.around.push(labels);
        let copy = counter.map(|place| self.copy_counter(place));
        let outer = self.subscripts.len();
        let subscripts = self.find_subscripts(statements, at);
        let body = self.statements(body);
        self.subscripts.truncate(outer);
        self.loops.around.pop();
        self.loops.around.push(plain);
        let continuing = self.block(continuing);
        self.loops.around.pop();
        if copy.is_some() {
            self.counters.pop();
        }
        let label = exits.then(|| quote!(#loop_label:));
        let body = if labelled { quote!(#next_label: { #body }) } else { body };
        match condition {
            Some(condition) => quote!(#label while #condition { #copy #subscripts #body #continuing }),
            None => quote!(#label loop { #copy #subscripts #body #continuing }),
        }
    }

    /// The variable that counts a loop's turns, if the body reads it and nothing changes it but
    /// the end of a turn.
    fn counter<'s>(&self, body: &[Statement], continuing: &'s Block) -> Option<&'s Place> {
        let [before @ .., Statement { kind: StatementKind::Assign { target: counter, .. }, .. }] =
            continuing.as_slice()
        else {
            return None;
        };
        let fields = counter.projections.iter().all(|it| matches!(it, Projection::Field(_)));
        if !fields || matches!(counter.root, Root::Local(_) | Root::Param(_)) {
            return None;
        }
        let (mut read, mut changed) = (false, false);
        let mut see = |statement: &Statement| {
            changed |= counter.root == Root::Globals && self.touches_globals(statement);
            walk::accesses(statement, &mut |place, access| {
                let same = overlap(place, counter);
                read |= same && access == Access::Read;
                changed |= same && access != Access::Read;
            });
        };
        walk::statements(body, &mut see);
        walk::statements(before, &mut see);
        (read && !changed).then_some(counter)
    }

    fn touches_globals(&self, statement: &Statement) -> bool {
        match statement.kind {
            StatementKind::Call { callee, .. } => self.emitter.needs[callee.index()].body.globals,
            StatementKind::PrescanInstance { callee, .. } => self.emitter.needs[callee.index()].prescan.globals,
            _ => false,
        }
    }

    /// `let i = self.i;`: a copy that the optimiser sees unchanged through the body, so that a
    /// subscript's check also serves as the check of Rust's own.
    fn copy_counter(&mut self, place: &Place) -> TokenStream {
        let value = self.place(place);
        let name = value.clone().into_iter().last().map(|it| it.to_string()).unwrap_or_default();
        let name = match self.counter_names.get(&value.to_string()) {
            Some(known) => known.clone(),
            None => self.names.scope.claim(name.trim_start_matches("r#")),
        };
        self.counter_names.insert(value.to_string(), name.clone());
        self.counters.push((place.clone(), name.clone()));
        quote!(let #name = #value;)
    }

    /// `while` where the loop starts by leaving on a condition.
    fn while_condition<'s>(&mut self, body: &'s [Statement]) -> (Option<TokenStream>, &'s [Statement]) {
        let Some((test, rest)) = body.split_first() else { return (None, body) };
        let condition = exit_condition(test).filter(|it| it.as_const() != Some(Value::Bool(true)));
        let Some(condition) = condition else { return (None, body) };
        if condition.as_const() == Some(Value::Bool(false)) {
            return (None, rest);
        }
        (Some(self.not(condition).tokens), rest)
    }

    pub fn leave(&self) -> TokenStream {
        let labels = self.loops.around.last().expect("verified IR: EXIT stands in a loop");
        labels.leave.clone()
    }

    pub fn next(&self) -> TokenStream {
        let labels = self.loops.around.last().expect("verified IR: CONTINUE stands in a loop");
        labels.next.clone()
    }
}

/// Whether a statement of the loop itself, not of one inside it, is what `is` asks for.
fn uses(block: &[Statement], is: &dyn Fn(&StatementKind) -> bool) -> bool {
    block.iter().any(|statement| {
        let inner = !matches!(statement.kind, StatementKind::Loop { .. });
        is(&statement.kind) || inner && statement.kind.blocks().into_iter().any(|it| uses(it, is))
    })
}

fn lifetime(name: &str) -> TokenStream {
    let lifetime = syn::Lifetime::new(&format!("'{name}"), proc_macro2::Span::call_site());
    quote!(#lifetime)
}
