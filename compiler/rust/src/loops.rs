//! Loops: WHILE where the shape allows, labels only where CONTINUE needs them, and counters kept
//! where the optimiser sees them.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};
use staunch_ir::loops::exit_condition;
use staunch_ir::visit::{self, Access};
use staunch_ir::{Block, Count, Expr, For, Location, Place, Root, Statement, StatementKind, Step, Type, Value};

use crate::function::Function;
use crate::loop_state::Labels;
use crate::names::ident;
use crate::precedence::{Code, Level};
use crate::turns::Taken;

/// A value, and the statement that finds it.
pub struct Once {
    pub value: TokenStream,
    pub before: Option<TokenStream>,
}

impl Function<'_> {
    pub fn repeat(&mut self, whole: &Block, continuing: &Block, count: Option<&Count>) -> TokenStream {
        let Taken { before, few } = count.map(|it| self.count_turns(it)).unwrap_or_default();
        let (condition, body) = self.while_condition(whole);
        // The macro knows no loop of few turns without a condition at its start.
        let strips = condition.is_some() || few.is_none();
        let (strip, body) = if strips { self.strip((whole, continuing), body, few.as_ref()) } else { (None, body) };
        let labels = self.labels(body, !continuing.is_empty());
        self.loops.few = few;
        let body = self.turn(&labels, body, |this| this.block(continuing));
        self.loops.few = None;
        let label = &labels.label;
        match (condition, strip) {
            (Some(condition), Some(strip)) => quote!(#before #label while (#condition) { #strip #body }),
            (None, Some(strip)) => quote!(#before #label loop { #strip #body }),
            (Some(condition), None) => quote!(#before #label while #condition { #body }),
            (None, None) => quote!(#before #label loop { #body }),
        }
    }

    pub fn for_loop(&mut self, statement: &Statement, it: &For) -> TokenStream {
        if let Some(copied) = self.copied(statement, it) {
            return copied;
        }
        let first = self.expr(&it.first).tokens;
        let first = self.assigned(statement, &it.counter, first);
        if let Some(counted) = self.counted(it) {
            let last = self.expr(&it.last).tokens;
            let before = self.for_turns(it, &last, &TokenStream::new()).before;
            let counted = self.counted_loop(it, &counted);
            return quote!(#first #before #counted);
        }
        let last = self.once("last", &it.last);
        let step = match &it.step {
            Step::Constant(_) => Once { value: TokenStream::new(), before: None },
            Step::Variable(step) => self.once("step", step),
        };
        let zero = matches!(it.step, Step::Variable(_)).then(|| {
            let (step, at) = (&step.value, self.emitter.at(it.step_at));
            quote!(if #step == 0 { return Err(FaultKind::ZeroStep)#at; })
        });
        let Taken { before: taken, few } = self.for_turns(it, &last.value, &step.value);
        let condition = self.further_turn(it, &last.value, &step.value);
        let (strip, body) =
            if few.is_some() { self.strip((&it.body, &[]), &it.body, few.as_ref()) } else { (None, &*it.body) };
        let labels = self.labels(body, true);
        let reads = it.is_private && !matches!(it.counter.root, Root::Local(_)) && mentions(&it.body, &it.counter);
        let copy = reads.then(|| self.copy_counter(&it.counter));
        let outer = self.hoisted_indices.len();
        let subscripts = if it.is_private { self.find_subscripts(it) } else { TokenStream::new() };
        self.loops.few = few;
        let body = self.turn(&labels, body, |this| {
            this.hoisted_indices.truncate(outer);
            if reads {
                this.counters.pop();
            }
            this.step(it, &last.value, &step.value, statement.at)
        });
        self.loops.few = None;
        let (label, before, step_before) = (&labels.label, last.before, step.before);
        let head = quote!(#first #before #step_before #zero #taken #label);
        match strip {
            Some(strip) => quote!(#head while (#condition) { #strip #copy #subscripts #body }),
            None => quote!(#head while #condition { #copy #subscripts #body }),
        }
    }

    /// What a loop's body and its end need of labels. A block around the body is what CONTINUE
    /// leaves when something follows the body.
    pub fn labels(&mut self, body: &[Statement], has_end: bool) -> Labels {
        let labelled = has_end && uses(body, &|it| matches!(it, StatementKind::Continue));
        if !labelled {
            return Labels { leave: quote!(break;), next: quote!(continue;), label: None, body: None };
        }
        self.loops.made += 1;
        let number = self.loops.made;
        let (loop_label, body_label) = (lifetime(&format!("loop_{number}")), lifetime(&format!("next_{number}")));
        let exits = uses(body, &|it| matches!(it, StatementKind::Exit));
        Labels {
            leave: quote!(break #loop_label;),
            next: quote!(break #body_label;),
            label: exits.then(|| quote!(#loop_label:)),
            body: Some(body_label),
        }
    }

    /// The body, and what follows it at the end of each turn.
    pub fn turn(
        &mut self,
        labels: &Labels,
        body: &[Statement],
        end: impl FnOnce(&mut Self) -> TokenStream,
    ) -> TokenStream {
        self.loops.around.push(labels.clone());
        let body = self.statements(body);
        self.loops.around.pop();
        self.loops.around.push(Labels { leave: quote!(break;), next: quote!(continue;), label: None, body: None });
        let end = end(self);
        self.loops.around.pop();
        match &labels.body {
            Some(label) => quote!(#label: { #body } #end),
            None => quote!(#body #end),
        }
    }

    /// A value that the turns of a loop read, found before it.
    pub fn once(&self, name: &str, value: &Expr) -> Once {
        let printed = self.expr(value).tokens;
        if value.as_const().is_some() {
            return Once { value: printed, before: None };
        }
        let (name, ty) = (self.made_up(name, self.loops.around.len()), self.emitter.ty(value.ty));
        Once { value: quote!(#name), before: Some(quote!(let #name: #ty = #printed;)) }
    }

    fn further_turn(&self, it: &For, last: &TokenStream, step: &TokenStream) -> TokenStream {
        let counter = self.count(&it.counter).above(Level::Compare);
        match &it.step {
            Step::Constant(step) if *step > 0 => quote!(#counter <= #last),
            Step::Constant(_) => quote!(#counter >= #last),
            Step::Variable(_) if !self.repr(it.counter.ty).is_signed() => quote!(#counter <= #last),
            Step::Variable(_) => quote!(if #step > 0 { #counter <= #last } else { #counter >= #last }),
        }
    }

    /// Steps the counter at the end of a turn, or leaves the loop.
    fn step(&self, it: &For, last: &TokenStream, step: &TokenStream, at: Location) -> TokenStream {
        let repr = self.repr(it.counter.ty);
        let counter = self.count(&it.counter);
        let counter = counter.at_least(Level::Postfix);
        if repr.range() != Some(it.range) && it.may_leave_range() {
            let step = match &it.step {
                Step::Constant(step) => Literal::i128_unsuffixed(*step).into_token_stream(),
                Step::Variable(_) => quote!(i128::from(#step)),
            };
            let (least, most) = (Literal::i128_unsuffixed(it.range.0), Literal::i128_unsuffixed(it.range.1));
            let (next, at) = (self.made_up("next", self.loops.around.len()), self.emitter.at(at));
            let counter = self.count(&it.counter).tokens;
            let set = self.given(&it.counter, &quote!(#next));
            return quote! {
                let Some(#next) = ops::step(#counter, #step, #last, (#least, #most)) #at? else { break };
                #set
            };
        }
        let (verb, step) = match &it.step {
            Step::Constant(step) => {
                let size = Literal::u128_unsuffixed(step.unsigned_abs());
                (if *step > 0 { "add" } else { "sub" }, quote!(#size))
            }
            Step::Variable(_) => ("add", step.clone()),
        };
        if it.may_leave_range() {
            let (next, checked) = (self.made_up("next", self.loops.around.len()), ident(&format!("checked_{verb}")));
            let set = self.given(&it.counter, &quote!(#next));
            return quote!(let Some(#next) = #counter.#checked(#step) else { break }; #set);
        }
        let wrapping = ident(&format!("wrapping_{verb}"));
        self.given(&it.counter, &quote!(#counter.#wrapping(#step)))
    }

    /// The counter's value, as a number.
    pub fn count(&self, counter: &Place) -> Code {
        let value = self.load(counter);
        let Type::Enum(_) = counter.ty else { return value };
        let value = value.at_least(Level::Postfix);
        Code::postfix(quote!(#value.0))
    }

    /// `counter = number;`
    pub fn given(&self, place: &Place, number: &TokenStream) -> TokenStream {
        let value = match place.ty {
            Type::Enum(id) => {
                let name = self.emitter.names.enumeration(id);
                quote!(#name(#number))
            }
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::String(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => number.clone(),
        };
        if self.emitter.shared {
            return self.set(place, &value);
        }
        let target = self.target(place, self.written_place(place));
        quote!(#target = #value;)
    }

    /// `let i = self.i;`: a copy that the optimiser sees unchanged through the body, so that a
    /// subscript's check also serves as the check of Rust's own.
    fn copy_counter(&mut self, place: &Place) -> TokenStream {
        let (value, copied) = (self.place(place), self.load(place).tokens);
        let name = value.clone().into_iter().last().map(|it| it.to_string()).unwrap_or_default();
        let name = match self.counter_names.get(&value.to_string()) {
            Some(known) => known.clone(),
            None => self.names.scope.claim(name.trim_start_matches("r#")),
        };
        self.counter_names.insert(value.to_string(), name.clone());
        self.counters.push((place.clone(), name.clone()));
        quote!(let #name = #copied;)
    }

    /// `while` where the loop starts by leaving on a condition.
    fn while_condition<'s>(&mut self, body: &'s [Statement]) -> (Option<TokenStream>, &'s [Statement]) {
        if let Some(it) = self.fold(body)
            && exit_condition(it.reader).is_some()
        {
            return (Some(it.stay().tokens), it.after);
        }
        let Some((test, rest)) = body.split_first() else { return (None, body) };
        let condition = exit_condition(test).filter(|it| it.as_const() != Some(Value::Bool(true)));
        let Some(condition) = condition else { return (None, body) };
        if condition.as_const() == Some(Value::Bool(false)) {
            return (None, rest);
        }
        (Some(self.not(condition).tokens), rest)
    }

    pub fn leave(&self) -> TokenStream {
        let labels = self.loops.around.last().expect("verified IR: EXIT is in a loop");
        labels.leave.clone()
    }

    pub fn next(&self) -> TokenStream {
        let labels = self.loops.around.last().expect("verified IR: CONTINUE is in a loop");
        labels.next.clone()
    }
}

/// Whether a statement of the loop itself, not of one inside it, is what `is` asks for.
pub fn uses(block: &[Statement], is: &dyn Fn(&StatementKind) -> bool) -> bool {
    block.iter().any(|statement| {
        let inner = !matches!(statement.kind, StatementKind::Loop { .. } | StatementKind::For(_));
        is(&statement.kind) || inner && statement.kind.blocks().into_iter().any(|it| uses(it, is))
    })
}

/// Whether the statements read the counter, whole.
fn mentions(body: &[Statement], counter: &Place) -> bool {
    let mut found = false;
    visit::statements(body, &mut |statement| {
        visit::accesses(statement, &mut |place, access| {
            found |= access == Access::Read && place.is_same_variable(counter);
        });
    });
    found
}

fn lifetime(name: &str) -> TokenStream {
    let lifetime = syn::Lifetime::new(&format!("'{name}"), proc_macro2::Span::call_site());
    quote!(#lifetime)
}
