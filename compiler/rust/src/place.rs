//! Places: a root and the way from it. A subscript is checked where it is.

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use staunch_ir::{Expr, FieldId, Location, Place, Projection, Root, Type, Value};

use crate::function::Function;
use crate::literal::{number, signed};
use crate::precedence::{Code, Level};
use staunch_ir::faults;

impl Function<'_> {
    /// The place, as what an assignment, a borrow or a method call takes. A parameter's own name
    /// stands for the reference that it is.
    pub fn place(&self, place: &Place) -> TokenStream {
        if let Some((_, copy)) = self.counters.iter().rev().find(|(counter, _)| counter.is_same_variable(place)) {
            return quote!(#copy);
        }
        self.written_place(place)
    }

    /// The place itself, also where a loop has a copy of its value.
    pub fn written_place(&self, place: &Place) -> TokenStream {
        self.place_with(place, &mut |index, ty, at| self.position(index, ty, at))
    }

    /// The place with its subscripts evaluated before, by the statements in `before`.
    pub fn fixed_place(&self, place: &Place, before: &mut Vec<TokenStream>) -> TokenStream {
        let before = core::cell::RefCell::new(before);
        self.place_with(place, &mut |index, ty, at| {
            let position = self.position(index, ty, at);
            if index.as_const().is_some() {
                return position;
            }
            let mut before = before.borrow_mut();
            let name = self.made_up("index", before.len());
            before.push(quote!(let #name = #position;));
            quote!(#name)
        })
    }

    fn place_with(&self, place: &Place, position: &mut dyn FnMut(&Expr, Type, Location) -> TokenStream) -> TokenStream {
        if place.is_followed() {
            return self.found(place);
        }
        let mut tokens = self.root(place.root);
        let types = self.emitter.types_along(self.routine, place);
        for (projection, ty) in place.projections.iter().zip(types) {
            tokens = match projection {
                Projection::Field(field) => {
                    if let Some(constant) = self.constant(ty, *field) {
                        tokens = constant;
                        continue;
                    }
                    let name = self.emitter.field_name(ty, *field);
                    // A block is in its cell as a whole.
                    let read = (self.emitter.shared && matches!(ty, Type::Block(_))).then(|| quote!(.get()));
                    quote!(#tokens #read.#name)
                }
                Projection::Deref { .. } => unreachable!("a place that leads through no reference"),
                Projection::Index { index, at } => {
                    let index = position(index, ty, *at);
                    quote!(#tokens[#index])
                }
            };
        }
        tokens
    }

    /// A constant that is not part of the state: `Main::LIMIT`.
    fn constant(&self, ty: Type, field: FieldId) -> Option<TokenStream> {
        let Type::Struct(id) = ty else { return None };
        let (name, constant) = (self.emitter.names.structure(id), self.emitter.constant_name(id, field)?);
        Some(quote!(#name::#constant))
    }

    /// The 0-based position of an element.
    pub fn position(&self, index: &Expr, ty: Type, at: Location) -> TokenStream {
        let Type::Array(id) = ty else { unreachable!("verified IR: only arrays have elements") };
        if let Some(subscript) = self.subscript(index, id) {
            let name = &subscript.name;
            return quote!(#name);
        }
        let array = self.emitter.program.array(id);
        if let Some(Value::I64(value)) = index.as_const()
            && (array.low..=array.high).contains(&value)
        {
            let position = number(value.abs_diff(array.low));
            return quote!(#position);
        }
        let (low, high) = (signed(array.low.into(), "").tokens, signed(array.high.into(), "").tokens);
        let (index, at) = (self.expr(index).tokens, self.emitter.at(at));
        quote!(ops::index(#index, #low, #high) #at?)
    }

    /// Whether finding `place` can fault here, where loops have found some subscripts already.
    pub fn place_faults(&self, place: &Place) -> bool {
        let types = self.emitter.types_along(self.routine, place);
        let mut found = place.projections.iter().zip(types).filter(|(projection, ty)| match (projection, ty) {
            (Projection::Index { index, .. }, Type::Array(id)) => self.subscript(index, *id).is_none(),
            _ => true,
        });
        found.any(|(projection, _)| faults::projection_faults(self.emitter.program, projection))
    }

    fn root(&self, root: Root) -> TokenStream {
        let name: &Ident = match root {
            Root::Instance => return quote!(self),
            Root::Globals => return crate::shared::globals(self.emitter.shared),
            Root::Local(id) => &self.names.locals[id.index()],
            Root::Param(id) => &self.names.params[id.index()],
        };
        quote!(#name)
    }

    /// Whether the place's text is a reference: a parameter, the instance or the globals.
    pub fn is_whole_param(&self, place: &Place) -> bool {
        let is_value = matches!(place.root, Root::Local(_)) || self.emitter.shared && place.root == Root::Globals;
        place.projections.is_empty() && !is_value
    }

    pub fn load(&self, place: &Place) -> Code {
        if self.emitter.shared {
            return self.load_shared(place);
        }
        let tokens = self.place(place);
        let types = self.emitter.types_along(self.routine, place);
        let last = place.projections.last().zip(types.last());
        let is_reference = last.is_some_and(|(last, ty)| self.emitter.is_constant_reference(*ty, last));
        if is_reference || self.is_whole_param(place) {
            Code::new(quote!(*#tokens), Level::Unary)
        } else {
            Code::postfix(tokens)
        }
    }

    /// The place as the target of an assignment.
    pub fn target(&self, place: &Place, tokens: TokenStream) -> TokenStream {
        if self.is_whole_param(place) { quote!(*#tokens) } else { tokens }
    }

    /// The place handed over as `&mut`, or as `&` where storage is shared.
    pub fn borrowed(&self, place: &Place) -> TokenStream {
        if self.emitter.shared {
            let tokens = self.written_place(place);
            return if self.is_reference(place) || place.is_followed() { tokens } else { quote!(&#tokens) };
        }
        let tokens = self.place(place);
        if self.is_whole_param(place) { tokens } else { quote!(&mut #tokens) }
    }

    fn load_shared(&self, place: &Place) -> Code {
        let is_copy = self.counters.iter().any(|(counter, _)| counter.is_same_variable(place));
        if is_copy || self.is_pin(place) {
            return Code::postfix(self.place(place));
        }
        if let Some(value) = self.load_followed(place) {
            return value;
        }
        let tokens = self.place(place);
        Code::postfix(if self.is_cell(place) {
            quote!(#tokens.get())
        } else if self.emitter.is_in_cell(place.ty) {
            tokens
        } else {
            quote!(#tokens.clone())
        })
    }
}
