//! The text of the functions that look for a variable where it is expected.

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use staunch_ir::Type;
use staunch_ir::reference::{Step, Target, wanted};

use crate::emitter::Emitter;
use crate::literal::number;
use crate::look_up::LookUp;

impl Emitter<'_> {
    pub fn look_up_of(&self, ty: Type) -> Option<&Ident> {
        let ty = wanted(self.program, ty);
        self.look_ups.iter().find(|it| wanted(self.program, it.ty) == ty).map(|it| &it.name)
    }

    pub fn look_up(&self, it: &LookUp) -> TokenStream {
        let (name, ty) = (&it.name, self.stored(it.ty));
        let doc = format!(
            " The {} that a reference refers to, if it is in one of the expected places.",
            self.program.type_name(it.ty)
        );
        let mut places = it.targets.iter().map(|it| self.place_of(it));
        let first = places.next();
        quote! {
            #[doc = #doc]
            #[inline]
            fn #name(&self, reference: u64, distance: u64) -> reference::Found<'_, #ty, Self> {
                let behind = |object, offset| reference::behind(reference, distance, object, offset);
                let variable = #first #(.or_else(|| #places))*;
                REFERENCES.found(variable, self, reference, distance)
            }
        }
    }

    fn place_of(&self, target: &Target) -> TokenStream {
        let (object, offset) = (number(target.object.into()), number(target.offset));
        let (root, state) = match target.instance {
            None => (quote!(self.globals), self.program.globals),
            Some(at) => {
                let name = self.names.instance(at);
                (quote!(self.#name), self.program.class(self.program.instances[at].program).state)
            }
        };
        self.within(root, Type::Struct(state), &target.way, &quote!(behind(#object, #offset)))
    }

    /// What the way leads to from a variable, where the position in it is `at`.
    fn within(&self, root: TokenStream, ty: Type, way: &[Step], at: &TokenStream) -> TokenStream {
        let (mut path, mut ty) = (root, ty);
        for (done, step) in way.iter().enumerate() {
            match (step, ty) {
                (Step::Field(field), _) => {
                    let name = self.field_name(ty, *field);
                    path = quote!(#path.#name);
                    ty = self.program.member(ty, *field).expect("a way through the type");
                }
                (Step::Element(position), Type::Array(id)) => {
                    let position = number(*position);
                    path = quote!(#path[#position]);
                    ty = self.program.array(id).element;
                }
                (Step::Each { .. }, Type::Array(id)) => {
                    let rest = &way[done + 1..];
                    let path = if done == 0 { path } else { quote!(&#path) };
                    if rest.is_empty() {
                        return quote!(reference::element(#path, #at));
                    }
                    let inner = self.within(quote!(it), self.program.array(id).element, rest, &quote!(at));
                    return quote!(reference::part(#path, #at).and_then(|(it, at)| #inner));
                }
                (Step::Element(_) | Step::Each { .. }, _) => unreachable!("a way through the type"),
            }
        }
        quote!(reference::whole(&#path, #at))
    }
}
