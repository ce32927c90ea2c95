//! Programs with references: storage that several paths may reach is in cells, each routine gets the
//! whole machine, and accesses through references are checked by the table of objects.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use staunch_ir::reference::{Followed, followed, table, view, wanted};
use staunch_ir::{ClassId, Place, Projection, Root, Type};
use staunch_runtime::reference::{View, Wanted};

use crate::emitter::Emitter;
use crate::function::Function;
use crate::literal::number;
use crate::names::ident;
use crate::precedence::{Code, Level};
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
        let look_ups = self.look_ups.iter().map(|it| self.look_up(it));
        quote! {
            /// The objects that references can refer to, and their types.
            const REFERENCES: reference::Table<'static> = reference::Table::new(&[#(#words),*]);
            /// The program's whole state, into which references can point.
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
                #(#look_ups)*
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

    /// Whether a value of the type is seen as nothing but what it is.
    fn is_exact(&self, ty: Type) -> bool {
        matches!(view(self.program, ty), View::Exact(_))
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
    pub fn block_of_pin(&self, place: &Place) -> Option<(Place, Ident)> {
        let types = self.emitter.types_along(self.routine, place);
        let (Some(Type::Block(id)), Some(Projection::Field(pin))) = (types.last(), place.projections.last()) else {
            return None;
        };
        let block = place.before(place.projections.len() - 1, Type::Block(*id));
        Some((block, ident(id.info().pins[pin.index()].field)))
    }

    /// How a reference is followed.
    fn way(&self, it: &Followed<'_>) -> Way {
        let mut way = Way { reference: self.load(&it.pointer).tokens, ..Way::default() };
        let is_found_by_steps = |it: &Projection| !matches!(it, Projection::Field(_));
        if it.pointer.projections.iter().any(is_found_by_steps) {
            way.reference = way.bind(self.made_up("reference", 0), &way.reference.clone());
        }
        let (to_variable, inside) = it.way.split_at(it.subscripts());
        let (mut near, mut further) = (Distance::default(), Distance::default());
        let ty = self.steps(&mut way, it.target, to_variable, &mut near);
        way.inside = TokenStream::new();
        let _ = self.steps(&mut way, ty, inside, &mut further);
        let (reference, distance) = (&way.reference, near.tokens());
        way.place = self.emitter.look_up_of(ty).map(|name| quote!(machine.#name(#reference, #distance)));
        way.further = further.tokens();
        way.distance = near.and(further).tokens();
        way
    }

    /// Steps from a variable to a part of it, whose type is returned.
    fn steps(&self, way: &mut Way, ty: Type, steps: &[Projection], distance: &mut Distance) -> Type {
        let mut ty = ty;
        for projection in steps {
            match (projection, ty) {
                (Projection::Field(field), _) => {
                    distance.fixed += self.emitter.layout.offset(ty, *field);
                    let name = self.emitter.field_name(ty, *field);
                    way.inside.extend(quote!(.#name));
                }
                (Projection::Index { index, at }, Type::Array(id)) => {
                    let stride = number(self.emitter.layout.stride(id));
                    let mut position = self.position(index, ty, *at);
                    if index.as_const().is_none() {
                        position = way.bind(self.made_up("position", way.before.len()), &position);
                    }
                    distance.steps.push(quote!(#position as u64 * #stride));
                    way.inside.extend(quote!([#position]));
                }
                (Projection::Index { .. } | Projection::Deref { .. }, _) => {
                    unreachable!("verified IR: the way from a reference")
                }
            }
            ty = crate::alias::element(self.emitter.program, ty, projection);
        }
        ty
    }

    /// How a scalar or string is read through a reference; `None` for what is looked at whole.
    pub fn load_followed(&self, place: &Place) -> Option<Code> {
        let program = self.emitter.program;
        let it = followed(program, place).filter(|it| it.pin.is_none())?;
        let at = self.emitter.at(it.at);
        let way = self.way(&it);
        let (reference, distance) = (&way.reference, &way.distance);
        if let Type::String(ty) = place.ty {
            let (string, capacity) =
                (ident(if ty.wide { "wide_string" } else { "string" }), number(ty.capacity.into()));
            return Some(way.after(quote!(REFERENCES.#string::<#capacity>(machine, #reference, #distance) #at?)));
        }
        let repr = ident(program.repr(place.ty)?.rust_name());
        let (view, is_exact) = (self.emitter.seen_as(place.ty), self.emitter.is_exact(place.ty));
        let field = matches!(place.ty, Type::Enum(_)).then(|| quote!(.0));
        let (further, inside) = (&way.further, &way.inside);
        let value = match &way.place {
            Some(found) if is_exact => quote!(#found.get_as(#view, #further, |it| it #inside.get() #field) #at?),
            Some(found) if inside.is_empty() => quote!(#found.get(#further, Cell::get) #at?),
            Some(found) => quote!(#found.get(#further, |it| it #inside.get()) #at?),
            None => quote!(REFERENCES.load::<#repr>(machine, #reference, #distance, #view) #at?),
        };
        let value = way.after(value);
        Some(match place.ty {
            Type::Enum(id) => {
                let (name, value) = (self.emitter.names.enumeration(id), value.tokens);
                Code::postfix(quote!(#name(#value)))
            }
            _ => value,
        })
    }

    /// `place := value;` through a reference; `None` for what is looked at whole.
    pub fn store_followed(&self, place: &Place, value: &TokenStream) -> Option<TokenStream> {
        let program = self.emitter.program;
        let it = followed(program, place).filter(|it| it.pin.is_none())?;
        let at = self.emitter.at(it.at);
        let way = self.way(&it);
        let (reference, distance) = (&way.reference, &way.distance);
        if matches!(place.ty, Type::String(_)) {
            let name = self.made_up("value", 0);
            let (ty, as_units) = (self.emitter.ty(place.ty), text::as_units(place.ty));
            let store = quote!(REFERENCES.store_text(machine, #reference, #distance, #name.#as_units()) #at?;);
            return Some(way.statements(quote!({ let #name: #ty = #value; #store })));
        }
        let repr = ident(program.repr(place.ty)?.rust_name());
        let (view, is_exact) = (self.emitter.seen_as(place.ty), self.emitter.is_exact(place.ty));
        let (further, inside) = (&way.further, &way.inside);
        let (value, new) = match place.ty {
            Type::Enum(id) => {
                let name = self.emitter.names.enumeration(id);
                (quote!((#value).0), quote!(#name(value)))
            }
            _ => (value.clone(), quote!(value)),
        };
        Some(way.statements(match &way.place {
            Some(found) if is_exact => {
                quote!(#found.set_as(#view, #further, |it, value| it #inside.set(#new), #value) #at?;)
            }
            Some(found) if inside.is_empty() => quote!(#found.set(#further, |it| it, #value) #at?;),
            Some(found) => quote!(#found.set(#further, |it| &it #inside, #value) #at?;),
            None => quote!(REFERENCES.store::<#repr>(machine, #reference, #distance, #view, #value) #at?;),
        }))
    }

    /// The target of a reference, as `&T`.
    pub fn found(&self, place: &Place) -> TokenStream {
        let it = followed(self.emitter.program, place).expect("a place that leads through a reference");
        let way = self.way(&it);
        let (reference, distance) = (&way.reference, &way.distance);
        let (ty, wanted, at) = (self.emitter.stored(it.ty), self.emitter.wanted(it.ty), self.emitter.at(it.at));
        let (further, inside) = (&way.further, &way.inside);
        let found = match &way.place {
            Some(found) if inside.is_empty() => quote!(#found.borrow(#wanted, #further, |it| it) #at?),
            Some(found) => quote!(#found.borrow(#wanted, #further, |it| &it #inside) #at?),
            None => quote!(REFERENCES.variable::<#ty>(machine, #reference, #distance, #wanted) #at?),
        };
        let found = way.after(found).at_least(Level::Postfix);
        match it.pin {
            Some((block, pin)) => {
                let pin = ident(block.info().pins[pin.index()].field);
                quote!(#found.get().#pin)
            }
            None => found,
        }
    }

    /// `ADR(place)`
    pub fn reference_to(&self, place: &Place) -> Code {
        if let Some(it) = followed(self.emitter.program, place) {
            let way = self.way(&it);
            let (reference, distance) = (&way.reference, &way.distance);
            return way.after(quote!(ops::advance(#reference, (#distance) as i64)));
        }
        let variable = self.borrowed(place);
        Code::postfix(match self.emitter.targets.object_of(self.routine, place) {
            Some(object) => {
                let object = number(object.into());
                quote!(reference::to(#object, machine, #variable))
            }
            None => {
                let size = number(self.emitter.layout.size(place.ty));
                quote!(REFERENCES.address(reference::offset(machine, #variable), #size))
            }
        })
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

/// How a reference is followed to its target.
#[derive(Default)]
struct Way {
    /// Statements that come before: what is found by a search or a check, found once.
    before: Vec<TokenStream>,
    reference: TokenStream,
    /// From where the reference points, in bytes.
    distance: TokenStream,
    /// The call that looks for a variable where one is expected, and the way on from that, also in bytes.
    place: Option<TokenStream>,
    inside: TokenStream,
    further: TokenStream,
}

impl Way {
    fn bind(&mut self, name: Ident, value: &TokenStream) -> TokenStream {
        self.before.push(quote!(let #name = #value;));
        quote!(#name)
    }

    fn after(&self, value: TokenStream) -> Code {
        let before = &self.before;
        if before.is_empty() { Code::postfix(value) } else { Code::new(quote!({ #(#before)* #value }), Level::Block) }
    }

    fn statements(&self, last: TokenStream) -> TokenStream {
        let before = &self.before;
        if before.is_empty() { last } else { quote!({ #(#before)* #last }) }
    }
}

/// Bytes from one place to another: what is known, and what is computed.
#[derive(Default)]
struct Distance {
    fixed: u64,
    steps: Vec<TokenStream>,
}

impl Distance {
    fn and(mut self, other: Self) -> Self {
        self.fixed += other.fixed;
        self.steps.extend(other.steps);
        self
    }

    fn tokens(&self) -> TokenStream {
        let fixed = (self.fixed > 0 || self.steps.is_empty()).then(|| number(self.fixed));
        let all = fixed.iter().map(|it| quote!(#it)).chain(self.steps.iter().cloned());
        quote!(#(#all)+*)
    }
}

/// Where fields of the globals are found.
pub fn globals(shared: bool) -> TokenStream {
    if shared { quote!(machine.globals) } else { quote!(globals) }
}
