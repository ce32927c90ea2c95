//! Statements whose faults are handled: a closure, whose `?` ends it. What leaves it otherwise is handed on by its result.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use staunch_ir::{Block, Place, Root, Statement, StatementKind, visit};

use crate::function::Function;
use crate::loop_state::Labels;
use crate::loops::uses;

impl Function<'_> {
    pub fn attempt(&mut self, statement: &Statement, body: &Block, kind: &Place, handler: &Block) -> TokenStream {
        let ends = Ends::of(body);
        let around = std::mem::take(&mut self.loops.around);
        let few = self.loops.few.take();
        self.loops.around.push(Labels {
            leave: ended_early("Exit"),
            next: ended_early("Continue"),
            label: None,
            body: None,
        });
        self.attempts += 1;
        let inside = self.statements(body);
        self.attempts -= 1;
        (self.loops.around, self.loops.few) = (around, few);
        let fault = self.made_up("fault", self.attempts);
        let number = self.kind(statement, kind, &fault);
        let handler = self.statements(handler);
        if !ends.early() {
            return quote!(if let Err(#fault) = exception::attempt(|| { #inside Ok(()) }) { #number #handler });
        }
        let exit = ends.exit.then(|| (format_ident!("Exit"), self.leave()));
        let next = ends.next.then(|| (format_ident!("Continue"), self.next()));
        let back = ends.back.then(|| (format_ident!("Return"), self.return_from_body()));
        let arms = [exit, next, back].into_iter().flatten();
        let arms = arms.map(|(name, leave)| quote!(Ok(exception::Ended::#name) => { #leave }));
        quote! {
            match exception::attempt(|| { #inside Ok(exception::Ended::Here) }) {
                #(#arms)*
                Ok(_) => {}
                Err(#fault) => { #number #handler }
            }
        }
    }

    /// Statements after which `last` comes in any case: a closure, whose `?` ends it.
    pub fn finally(&mut self, body: &Block, last: &Block) -> TokenStream {
        let around = std::mem::take(&mut self.loops.around);
        self.endings += 1;
        let inside = self.statements(body);
        self.endings -= 1;
        self.loops.around = around;
        let ended = self.made_up("ended", self.endings);
        let last = self.statements(last);
        quote!(let #ended = exception::attempt(|| { #inside Ok(()) }); #last #ended?;)
    }

    /// The number of what is caught, where the handler asks for it.
    fn kind(&self, statement: &Statement, kind: &Place, fault: &Ident) -> TokenStream {
        let number = quote!(#fault.caught()?);
        let Root::Local(id) = kind.root else { unreachable!("verified IR: the kind of a fault goes to a local") };
        if self.plan.locals[id.index()].mentions == 1 {
            return quote!(#number;);
        }
        self.assigned(statement, kind, number)
    }

    /// RETURN.
    pub fn return_from_body(&self) -> TokenStream {
        if self.attempts > 0 {
            return ended_early("Return");
        }
        let value = self.returned();
        quote!(return #value;)
    }
}

fn ended_early(how: &str) -> TokenStream {
    let how = format_ident!("{how}");
    quote!(return Ok(exception::Ended::#how);)
}

/// How statements may leave what is around them.
struct Ends {
    exit: bool,
    next: bool,
    back: bool,
}

impl Ends {
    fn of(body: &[Statement]) -> Self {
        let mut back = false;
        visit::statements(body, &mut |it| back |= matches!(it.kind, StatementKind::Return));
        let exit = uses(body, &|it| matches!(it, StatementKind::Exit));
        Self { exit, next: uses(body, &|it| matches!(it, StatementKind::Continue)), back }
    }

    fn early(&self) -> bool {
        self.exit || self.next || self.back
    }
}
