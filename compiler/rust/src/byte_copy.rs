//! A loop that copies bytes through references, as one call.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::byte_copy::byte_copy;
use staunch_ir::{For, Statement, Taking, Value};

use crate::function::Function;

impl Function<'_> {
    /// `REFERENCES.copy(…)?`, and what the loop leaves in its counter and in the references.
    pub fn copied(&mut self, statement: &Statement, it: &For) -> Option<TokenStream> {
        let copy = byte_copy(it).filter(|_| !matches!(it.taking, Taking::EachOfMany))?;
        let first = self.expr(&it.first).tokens;
        let first = self.assigned(statement, &it.counter, first);
        let last = self.once("last", &it.last);
        let taken = self.for_turns(it, &last.value, &TokenStream::new()).before;
        let (before, last) = (last.before, last.value);
        let (count, end) = match it.last.as_const() {
            Some(Value::I64(last)) => {
                let count = last.max(0);
                let [count, end] = [count, count.wrapping_add(1)].map(Literal::i64_suffixed);
                (quote!(#count), quote!(#end))
            }
            _ => (quote!(#last.max(0)), quote!(#last.max(0).wrapping_add(1))),
        };
        let [to, from] = [copy.to, copy.from].map(|it| self.load(it).tokens);
        let (by, at) = (self.typed(copy.by).tokens, self.emitter.at(copy.at));
        let after = [copy.to, copy.from].map(|it| {
            let pointer = self.load(it).tokens;
            self.given(it, &quote!(ops::advance(#pointer, #count.wrapping_mul(#by))))
        });
        let set = self.given(&it.counter, &end);
        Some(quote! {
            #first #before #taken
            REFERENCES.copy(machine, #to, #from, #last, #by) #at?;
            #(#after)* #set
        })
    }
}
