//! The tables that a firmware reads: what runs when, and the variables at direct addresses.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use staunch_ir::{Address, Area, Field, FieldId, Lane, Type};

use crate::emitter::Emitter;

/// A variable at a direct address, and how its bits are carried.
struct Io<'p> {
    field: &'p Field,
    address: Address,
    name: &'p Ident,
    lane: Lane,
    is_enumeration: bool,
}

impl Emitter<'_> {
    /// `TASKS`, and `IO` where the program has addresses.
    pub fn tables(&self) -> TokenStream {
        let (tasks, io) = (self.tasks(), self.io());
        if io.is_empty() {
            return tasks;
        }
        let rows = io.iter().map(|it| {
            let (address, variable) = (it.address.to_string(), &it.field.name);
            let (bit, width) = (Literal::u64_unsuffixed(it.address.bit), Literal::u8_unsuffixed(it.address.width));
            let area = match it.address.area {
                Area::Input => quote!(Input),
                Area::Output => quote!(Output),
                Area::Memory => quote!(Memory),
            };
            quote! {
                firmware::Io { address: #address, variable: #variable, area: firmware::Area::#area, bit: #bit, width: #width }
            }
        });
        quote! {
            #tasks
            /// The variables at direct addresses; their numbers here are what `Globals::io` takes.
            pub const IO: &[firmware::Io] = &[#(#rows),*];
        }
    }

    fn tasks(&self) -> TokenStream {
        let rows = self.program.instances.iter().map(|it| {
            let (instance, program) = (&it.name, &self.program.class(it.program).name);
            let priority = Literal::u32_unsuffixed(it.priority);
            let interval = match it.interval {
                Some(interval) => {
                    let interval = Literal::i64_unsuffixed(interval);
                    quote!(Some(#interval))
                }
                None => quote!(None),
            };
            quote! {
                firmware::Task { instance: #instance, program: #program, interval: #interval, priority: #priority }
            }
        });
        quote! {
            /// The programs that run.
            pub const TASKS: &[firmware::Task] = &[#(#rows),*];
        }
    }

    fn io(&self) -> Vec<Io<'_>> {
        let globals = self.program.globals;
        let fields = self.program.structure(globals).fields.iter().enumerate();
        let io = fields.filter_map(|(at, field)| {
            Some(Io {
                field,
                address: field.address?,
                name: self.names.field(globals, FieldId::next(at)),
                lane: self.program.lane(field.ty)?,
                is_enumeration: matches!(field.ty, Type::Enum(_)),
            })
        });
        io.collect()
    }

    /// How the globals show and take the bits at an address.
    pub fn io_methods(&self) -> TokenStream {
        let io = self.io();
        if io.is_empty() {
            return TokenStream::new();
        }
        let numbers = || (0..io.len()).map(Literal::usize_unsuffixed);
        let (reads, writes) = (io.iter().map(Io::read), io.iter().map(Io::write));
        let (reading, writing) = (numbers(), numbers());
        quote! {
            /// The bits of the variable with this number in `IO`, the lowest first; 0 where there is none.
            pub fn io(&self, number: usize) -> u64 {
                match number { #(#reading => #reads,)* _ => 0 }
            }

            /// Sets the variable with this number in `IO` from its bits; those above its width are left out.
            pub fn set_io(&mut self, number: usize, bits: u64) {
                match number { #(#writing => #writes,)* _ => {} }
            }
        }
    }
}

impl Io<'_> {
    fn place(&self) -> TokenStream {
        let name = self.name;
        if self.is_enumeration { quote!(self.#name.0) } else { quote!(self.#name) }
    }

    fn read(&self) -> TokenStream {
        let place = self.place();
        match self.lane {
            Lane::Bool | Lane::U8 | Lane::U16 | Lane::U32 => quote!(u64::from(#place)),
            Lane::U64 => place,
            Lane::I64 => quote!(#place as u64),
            Lane::F32 => quote!(u64::from(#place.to_bits())),
            Lane::F64 => quote!(#place.to_bits()),
            Lane::I8 | Lane::I16 | Lane::I32 => {
                let unsigned = format_ident!("u{}", self.lane.size() * 8);
                quote!(u64::from(#place as #unsigned))
            }
        }
    }

    fn write(&self) -> TokenStream {
        let place = self.place();
        let value = match self.lane {
            Lane::Bool => quote!(bits & 1 == 1),
            Lane::U64 => quote!(bits),
            Lane::F32 => quote!(f32::from_bits(bits as u32)),
            Lane::F64 => quote!(f64::from_bits(bits)),
            Lane::I8 | Lane::I16 | Lane::I32 | Lane::I64 | Lane::U8 | Lane::U16 | Lane::U32 => {
                let lane = format_ident!("{}", self.lane.rust_name());
                quote!(bits as #lane)
            }
        };
        quote!(#place = #value)
    }
}
