//! Programs with references: storage that several paths may reach lies in cells, each routine is handed the
//! whole machine, and accesses through references are checked by the table of objects.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use staunch_ir::reference::{Followed, followed, table, view, wanted};
use staunch_ir::{ClassId, Place, Projection, Root, Type};
use staunch_runtime::reference::{View, Wanted};

use crate::emitter::Emitter;
use crate::function::Function;
use crate::literal::number;
use crate::names::ident;
use crate::precedence::Code;
use crate::text;

impl Emitter<'_> {
    /// The whole state, and the table of the objects in it.
    pub fn machine(&self) -> TokenStream {
        let program = self.program;
        let globals = self.names.structure(program.globals);
        let state = |id: ClassId| self.names.structure(program.class(id).state);
        let names: Vec<_> = (0..program.instances.len()).map(|at| self.names.instance(at)).collect();
        let types = program.instances.iter().map(|it| state(it.program));
        let docs = program.instances.iter().map(|it| format!(" PROGRAM `{}`.", it.name));
        let starts = program.instances.iter().map(|it| state(it.program));
        let words = table(program, &self.layout).into_iter().map(Literal::u32_unsuffixed);
        quote! {
            /// The objects that references may name, and the types in them.
            const REFERENCES: reference::Table<'static> = reference::Table::new(&[#(#words),*]);
            /// The program's whole state: what references may lead to.
            #[repr(C)]
            #[derive(Clone, Debug, PartialEq)]
            pub struct Machine {
                /// The global variables.
                pub globals: #globals,
                #(#[doc = #docs] pub #names: #types),*
            }
            reference::shared!(Machine { globals, #(#names),* });
            impl Machine {
                /// With initial values.
                pub const fn new() -> Self { Self { globals: #globals::new(), #(#names: #starts::new()),* } }
            }
            impl Default for Machine { fn default() -> Self { Self::new() } }
        }
    }

    fn seen_as(&self, ty: Type) -> TokenStream {
        match view(self.program, ty) {
            View::Truth => quote!(reference::View::Truth),
            View::Text { wide } => quote!(reference::View::Text { wide: #wide }),
            View::Number(size) => {
                let size = number(size.into());
                quote!(reference::View::Number(#size))
            }
            View::Exact(id) => {
                let id = number(id.into());
                quote!(reference::View::Exact(#id))
            }
        }
    }

    fn wanted(&self, ty: Type) -> TokenStream {
        match wanted(self.program, ty) {
            Wanted::Repr(repr) => {
                let repr = format_ident!("{repr:?}");
                quote!(reference::Wanted::Repr(reference::Repr::#repr))
            }
            Wanted::Text(it) => {
                let (kind, capacity) = (ident(if it.wide { "wide" } else { "narrow" }), number(it.capacity.into()));
                quote!(reference::Wanted::Text(text::StringType::#kind(#capacity)))
            }
            Wanted::Exact(id) => {
                let id = number(id.into());
                quote!(reference::Wanted::Exact(#id))
            }
        }
    }
}

impl Function<'_> {
    /// Whether the place's text is a cell: all scalars, strings and blocks are, but for locals that nobody
    /// else is handed, and copies of counters.
    pub fn is_cell(&self, place: &Place) -> bool {
        self.emitter.is_in_cell(place.ty) && !self.is_plain_local(place) && !self.is_pin(place)
    }

    fn is_plain_local(&self, place: &Place) -> bool {
        match place.root {
            Root::Local(id) if place.projections.is_empty() => !self.borrowed[id.index()],
            Root::Local(_) | Root::Instance | Root::Globals | Root::Param(_) => false,
        }
    }

    /// Whether the place is a pin of a standard block.
    pub fn is_pin(&self, place: &Place) -> bool {
        let types = self.emitter.types_along(self.routine, place);
        matches!((types.last(), place.projections.last()), (Some(Type::Block(_)), Some(Projection::Field(_))))
    }

    /// The block that a pin is of, and the pin's name.
    pub fn block_of_pin(&self, place: &Place) -> Option<(Place, proc_macro2::Ident)> {
        let types = self.emitter.types_along(self.routine, place);
        let (Some(Type::Block(id)), Some(Projection::Field(pin))) = (types.last(), place.projections.last()) else {
            return None;
        };
        let block = place.before(place.projections.len() - 1, Type::Block(*id));
        Some((block, ident(id.info().pins[pin.index()].field)))
    }

    /// The reference and the distance from where it points, as arguments.
    fn way(&self, it: &Followed<'_>) -> (TokenStream, TokenStream) {
        let reference = self.load(&it.pointer).tokens;
        let (mut fixed, mut ty, mut steps) = (0, it.target, Vec::new());
        for projection in it.way {
            match (projection, ty) {
                (Projection::Field(field), _) => fixed += self.emitter.layout.offset(ty, *field),
                (Projection::Index { index, at }, Type::Array(id)) => {
                    let stride = number(self.emitter.layout.stride(id));
                    let position = self.position(index, ty, *at);
                    steps.push(quote!((#position) as u64 * #stride));
                }
                (Projection::Index { .. } | Projection::Deref { .. }, _) => {
                    unreachable!("verified IR: the way from a reference")
                }
            }
            ty = crate::alias::element(self.emitter.program, ty, projection);
        }
        let fixed = (fixed > 0 || steps.is_empty()).then(|| number(fixed));
        let fixed = fixed.map(|it| quote!(#it));
        let all = fixed.into_iter().chain(steps);
        (reference, quote!(#(#all)+*))
    }

    /// How a scalar or string behind a reference is read; `None` for what is looked at whole.
    pub fn load_followed(&self, place: &Place) -> Option<Code> {
        let program = self.emitter.program;
        let it = followed(program, place).filter(|it| it.pin.is_none())?;
        let at = self.emitter.at(it.at);
        if let Type::String(ty) = place.ty {
            let (reference, distance) = self.way(&it);
            let (string, capacity) =
                (ident(if ty.wide { "wide_string" } else { "string" }), number(ty.capacity.into()));
            return Some(Code::postfix(quote!(REFERENCES.#string::<#capacity>(machine, #reference, #distance) #at?)));
        }
        let repr = ident(program.repr(place.ty)?.rust_name());
        let ((reference, distance), view) = (self.way(&it), self.emitter.seen_as(place.ty));
        let value = quote!(REFERENCES.load::<#repr>(machine, #reference, #distance, #view) #at?);
        Some(Code::postfix(match place.ty {
            Type::Enum(id) => {
                let name = self.emitter.names.enumeration(id);
                quote!(#name(#value))
            }
            _ => value,
        }))
    }

    /// `place := value;` through a reference; `None` for what is looked at whole.
    pub fn store_followed(&self, place: &Place, value: &TokenStream) -> Option<TokenStream> {
        let program = self.emitter.program;
        let it = followed(program, place).filter(|it| it.pin.is_none())?;
        let at = self.emitter.at(it.at);
        if matches!(place.ty, Type::String(_)) {
            let (reference, distance) = self.way(&it);
            let (ty, as_units) = (self.emitter.ty(place.ty), text::as_units(place.ty));
            return Some(quote! {
                {
                    let (reference, distance) = (#reference, #distance);
                    let value: #ty = #value;
                    REFERENCES.store_text(machine, reference, distance, value.#as_units()) #at?;
                }
            });
        }
        let repr = ident(program.repr(place.ty)?.rust_name());
        let ((reference, distance), view) = (self.way(&it), self.emitter.seen_as(place.ty));
        let value = if matches!(place.ty, Type::Enum(_)) { quote!((#value).0) } else { value.clone() };
        Some(quote!(REFERENCES.store::<#repr>(machine, #reference, #distance, #view, #value) #at?;))
    }

    /// The variable behind a reference, as `&T`.
    pub fn found(&self, place: &Place) -> TokenStream {
        let it = followed(self.emitter.program, place).expect("a place that leads through a reference");
        let (reference, distance) = self.way(&it);
        let (ty, wanted, at) = (self.emitter.stored(it.ty), self.emitter.wanted(it.ty), self.emitter.at(it.at));
        let found = quote!(REFERENCES.variable::<#ty>(machine, #reference, #distance, #wanted) #at?);
        match it.pin {
            Some((block, pin)) => {
                let pin = ident(block.info().pins[pin.index()].field);
                quote!(#found.get().#pin)
            }
            None => found,
        }
    }

    /// `ADR(place)`
    pub fn reference_to(&self, place: &Place) -> TokenStream {
        if let Some(it) = followed(self.emitter.program, place) {
            let (reference, distance) = self.way(&it);
            return quote!(ops::advance(#reference, (#distance) as i64));
        }
        let size = number(self.emitter.layout.size(place.ty));
        let variable = self.borrowed(place);
        quote!(REFERENCES.address(reference::offset(machine, #variable), #size))
    }

    /// `place := value;` where storage is shared.
    pub fn set(&self, place: &Place, value: &TokenStream) -> TokenStream {
        if let Some((block, pin)) = self.block_of_pin(place) {
            let block = self.written_place(&block);
            return quote!({ let cell = &#block; let mut block = cell.get(); block.#pin = #value; cell.set(block); });
        }
        if let Some(stored) = self.store_followed(place, value) {
            return stored;
        }
        let target = self.written_place(place);
        if self.is_plain_local(place) && self.emitter.is_in_cell(place.ty) {
            return quote!(#target = #value;);
        }
        if self.is_cell(place) {
            return quote!(#target.set(#value););
        }
        let target = if self.is_reference(place) { target } else { quote!(&#target) };
        quote!(reference::Shared::assign(#target, &#value);)
    }

    /// Whether the place's text is a reference: what is found through one is, a member of it too.
    pub fn is_reference(&self, place: &Place) -> bool {
        self.is_whole_param(place) || followed(self.emitter.program, place).is_some_and(|it| it.pin.is_none())
    }
}

/// Where fields of the globals are found.
pub fn globals(shared: bool) -> TokenStream {
    if shared { quote!(machine.globals) } else { quote!(globals) }
}
