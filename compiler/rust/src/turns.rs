//! What a loop whose number of turns is known does before the first one.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use staunch_ir::{Count, For, Location, Step, Taking};

use crate::function::Function;

#[derive(Default)]
pub struct Taken {
    /// Takes the turns, or finds whether they are few.
    pub before: TokenStream,
    /// The variable that says that they are few, and that the loop need not take them.
    pub few: Option<Ident>,
}

/// The values of the counter, and whether the last one is past the loop's end.
struct Way {
    first: TokenStream,
    last: TokenStream,
    step: TokenStream,
    is_before: bool,
}

impl Function<'_> {
    pub fn for_turns(&self, it: &For, last: &TokenStream, step: &TokenStream) -> Taken {
        let step = match &it.step {
            Step::Constant(step) => Literal::i128_unsuffixed(*step).into_token_stream(),
            Step::Variable(_) => quote!(i128::from(#step)),
        };
        let first = self.count(&it.counter).tokens;
        self.taken(it.taking, &Way { first, last: last.clone(), step, is_before: false })
    }

    pub fn count_turns(&self, it: &Count) -> Taken {
        let (first, last) = (self.count(&it.counter).tokens, self.expr(&it.bound).tokens);
        let step = Literal::i128_unsuffixed(it.step).into_token_stream();
        self.taken(it.taking, &Way { first, last, step, is_before: it.offset != 0 })
    }

    fn taken(&self, taking: Taking, way: &Way) -> Taken {
        match taking {
            Taking::Each => Taken::default(),
            Taking::EachOfMany => {
                let few = self.made_up("few", self.loops.around.len());
                let found = way.of("has_few_turns");
                Taken { before: quote!(let #few = Context::#found;), few: Some(few) }
            }
            Taking::Ahead(at) => self.ahead(&way.of("take_turns"), at),
            Taking::AheadOfMany(at) => self.ahead(&way.of("take_many_turns"), at),
        }
    }

    fn ahead(&self, take: &TokenStream, at: Location) -> Taken {
        let at = self.emitter.at(at);
        Taken { before: quote!(cx.#take #at?;), few: None }
    }
}

impl Way {
    fn of(&self, name: &str) -> TokenStream {
        let name = if self.is_before { format_ident!("{name}_before") } else { format_ident!("{name}") };
        let (first, last, step) = (&self.first, &self.last, &self.step);
        quote!(#name(#first, #last, #step))
    }
}
