//! What the program calls and the crate around it implements: a trait, and the calls of its functions.

use proc_macro2::TokenStream;
use quote::quote;
use staunch_ir::{External, ExternalCall, Statement, Type};

use crate::emitter::Emitter;
use crate::function::Function;
use crate::names::Scope;

impl Emitter<'_> {
    /// The trait that the crate implements for its `Externals`; nothing where the program calls nothing outside.
    pub fn externals(&self) -> Option<TokenStream> {
        let externals = self.program.externals();
        if externals.is_empty() {
            return None;
        }
        let functions = externals.into_iter().map(|it| self.external(it));
        Some(quote! {
            /// The routines that the program calls but does not contain: the module that includes this one implements them for its type `Externals`.
            pub trait External { #(#functions)* }
        })
    }

    fn external(&self, external: &External) -> TokenStream {
        let kind = if external.state.is_some() { "FUNCTION_BLOCK" } else { "FUNCTION" };
        let source = self.source(external.location);
        let docs = self.docs(external.doc.as_deref(), &format!("{kind} {} ({source})", external.name));
        let mut scope = Scope::with(&["block", "cx"]);
        let block = external.state.map(|it| {
            let ty = self.ty(Type::Struct(it));
            if self.shared { quote!(block: &#ty) } else { quote!(block: &mut #ty) }
        });
        let context = block.is_some().then(|| quote!(cx: &Context));
        let params = external.params.iter().map(|it| {
            let name = scope.claim_variable(&it.name);
            let (ty, stored) = (self.ty(it.ty), self.stored(it.ty));
            match (it.by_reference, self.shared) {
                (false, _) => quote!(#name: #ty),
                (true, false) => quote!(#name: &mut #ty),
                (true, true) => quote!(#name: &#stored),
            }
        });
        let all = block.into_iter().chain(context).chain(params);
        let result = external.result.map(|it| self.ty(it)).map(|ty| quote!(-> #ty));
        let name = self.names.external(external);
        quote!(#docs fn #name(#(#all),*) #result;)
    }
}

impl Function<'_> {
    pub fn external(&self, statement: &Statement, call: &ExternalCall) -> TokenStream {
        let name = self.emitter.names.external(&call.external);
        let instance = call.instance.as_ref().map(|it| self.borrowed(it));
        let context = instance.is_some().then(|| quote!(cx));
        let arguments = call.arguments.iter().map(|it| self.argument(it));
        let all = instance.into_iter().chain(context).chain(arguments);
        let call_text = quote!(<Externals as External>::#name(#(#all),*));
        match &call.result {
            Some(target) => self.assigned(statement, target, call_text),
            None => quote!(#call_text;),
        }
    }
}
