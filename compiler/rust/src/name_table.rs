//! Variables by name at run time, where that is asked for: a table of paths and types, and a function that reads
//! what a row names. A display or a console of a firmware needs no more; who asks for none carries nothing.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use staunch_ir::{BlockId, FieldId, StructId, Type};
use staunch_runtime::Direction;

use crate::emitter::Emitter;
use crate::literal::number;
use crate::names::ident;

/// A row of the table.
struct Row {
    path: String,
    ty: String,
    elements: u64,
    value: TokenStream,
}

/// Where the walk is.
#[derive(Clone)]
struct At {
    /// In Structured Text.
    path: String,
    /// In Rust.
    steps: Vec<Step>,
}

#[derive(Clone)]
enum Step {
    /// `.field`, and the variable at the start.
    Plain(TokenStream),
    /// An element of so many.
    Element(u64),
}

impl Emitter<'_> {
    /// `NAMES` and `named`.
    pub fn name_table(&self) -> TokenStream {
        let program = self.program;
        let instances = program.instances.iter().enumerate();
        let instances = instances
            .map(|(at, it)| (self.names.instance(at).clone(), program.class(it.program).state, it.name.clone()));
        let roots = instances.chain([(ident("globals"), program.globals, String::new())]);
        let (mut rows, mut params) = (Vec::new(), Vec::new());
        for (name, state, path) in roots {
            let before = rows.len();
            self.named_fields(state, &At { path, steps: vec![Step::Plain(quote!(#name))] }, &mut rows);
            if rows.len() > before {
                let ty = self.names.structure(state);
                params.push(quote!(#name: &#ty));
            }
        }
        table(&rows, &params)
    }

    fn named_fields(&self, id: StructId, at: &At, rows: &mut Vec<Row>) {
        let fields = self.program.structure(id).fields.iter().enumerate();
        for (position, field) in fields.filter(|(_, field)| !field.constant) {
            let at = at.member(&field.name, self.names.field(id, FieldId::next(position)));
            self.named(field.ty, at, rows);
        }
    }

    fn named(&self, ty: Type, at: At, rows: &mut Vec<Row>) {
        let at = if self.is_in_cell(ty) { at.opened() } else { at };
        let place = at.place();
        match ty {
            // What it leads to has a name of its own.
            Type::Reference(_) => {}
            Type::Struct(id) => self.named_fields(id, &at, rows),
            Type::Array(id) => {
                let array = self.program.array(id);
                self.named(array.element, at.element(array.low, array.high, array.len()), rows);
            }
            Type::Block(id) => named_pins(id, &at, rows),
            Type::Elementary(it) | Type::Subrange(it, _) => rows.push(at.row(it.own_name(), quote!(#place.into()))),
            Type::String(it) => rows.push(at.row(&it.to_string(), quote!((&#place).into()))),
            Type::Enum(id) => rows.push(at.row(&self.program.enumeration(id).name, quote!(#place.0.into()))),
        }
    }
}

fn named_pins(id: BlockId, at: &At, rows: &mut Vec<Row>) {
    for (position, pin) in id.info().pins.iter().enumerate() {
        let ty = match (pin.direction, id.pin_type(FieldId::next(position))) {
            (Direction::Input | Direction::Output | Direction::Member, Some(Type::Elementary(ty))) => ty,
            (Direction::Input | Direction::Output | Direction::Member | Direction::Memory, _) => continue,
        };
        let at = at.member(pin.name, &ident(pin.field));
        let place = at.place();
        rows.push(at.row(ty.own_name(), quote!(#place.into())));
    }
}

impl At {
    fn member(&self, name: &str, field: &Ident) -> Self {
        let dot = if self.path.is_empty() { "" } else { "." };
        self.then(format!("{dot}{name}"), Step::Plain(quote!(.#field)))
    }

    fn element(&self, low: i64, high: i64, count: u64) -> Self {
        self.then(format!("[{low}..{high}]"), Step::Element(count))
    }

    /// The contents of the cell.
    fn opened(&self) -> Self {
        self.then(String::new(), Step::Plain(quote!(.get())))
    }

    fn then(&self, path: String, step: Step) -> Self {
        let mut steps = self.steps.clone();
        steps.push(step);
        Self { path: self.path.clone() + &path, steps }
    }

    /// Of all arrays on the way.
    fn elements(&self) -> u64 {
        self.steps.iter().map(Step::count).product()
    }

    /// The variable, with the position in each array made of that among all elements.
    fn place(&self) -> TokenStream {
        let mut apart = self.elements();
        let parts = self.steps.iter().map(|step| {
            apart /= step.count().max(1);
            match step {
                Step::Plain(tokens) => tokens.clone(),
                Step::Element(count) => {
                    let (apart, count) = (number(apart), number(*count));
                    quote!([element / #apart % #count])
                }
            }
        });
        parts.collect()
    }

    fn row(&self, ty: &str, value: TokenStream) -> Row {
        Row { path: self.path.clone(), ty: ty.to_owned(), elements: self.elements(), value }
    }
}

impl Step {
    fn count(&self) -> u64 {
        match self {
            Self::Plain(_) => 1,
            Self::Element(count) => *count,
        }
    }
}

fn table(rows: &[Row], params: &[TokenStream]) -> TokenStream {
    let names = rows.iter().map(|Row { path, ty, elements, .. }| {
        let elements = number(*elements);
        quote!(firmware::Name { path: #path, ty: #ty, elements: #elements })
    });
    let arms = rows.iter().enumerate().map(|(at, Row { value, .. })| {
        let at = Literal::usize_unsuffixed(at);
        quote!(#at => see(#value),)
    });
    quote! {
        /// The variables by name. A path with bounds in it is that of the elements of arrays.
        pub const NAMES: &[firmware::Name] = &[#(#names),*];

        /// Shows the value of the variable with this number in `NAMES`; of several elements the one at the position
        /// `element`, from 0, the last index the fastest. Shows nothing where there is none.
        pub fn named(number: usize, element: usize, #(#params,)* see: &mut dyn FnMut(firmware::Value<'_>)) {
            if NAMES.get(number).is_none_or(|it| element >= it.elements) {
                return;
            }
            match number { #(#arms)* _ => {} }
        }
    }
}
