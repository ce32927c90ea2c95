//! The tables that a firmware reads: what runs when, and the variables at direct addresses.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use staunch_ir::{Address, Area, FieldId, Projection, Repr, Type, Variable, View};

use crate::emitter::Emitter;
use crate::io_parts::Part;

/// A variable at a direct address, and how its bits are carried.
pub struct Io {
    variable: String,
    address: Address,
    /// Number of bits.
    width: u8,
    /// The integers that keep it, the lowest first.
    units: Vec<Unit>,
    /// The first of its bits, where it shares the integer with others.
    shared: Option<u64>,
}

/// Where bits go when they are shifted.
#[derive(Clone, Copy)]
enum Way {
    Up,
    Down,
}

/// Storage of a repr.
#[derive(Clone)]
pub struct Unit {
    place: TokenStream,
    repr: Repr,
    /// The type of a variable of its own.
    ty: Option<Type>,
    /// It is one bit at its address.
    is_bit: bool,
    /// What a subrange may be.
    range: Option<(i128, i128)>,
    /// It is in a cell.
    pub is_cell: bool,
}

impl Emitter<'_> {
    /// `TASKS`, and `IO` where the program has addresses.
    pub fn tables(&self) -> TokenStream {
        let (tasks, io) = (self.tasks(), self.io());
        if io.is_empty() {
            return tasks;
        }
        let rows = io.iter().map(|it| {
            let (address, variable) = (it.address.to_string(), &it.variable);
            let (bit, width) = (Literal::u64_unsuffixed(it.address.bit), Literal::u8_unsuffixed(it.width));
            let area = match it.address.area {
                Area::Input => quote!(Input),
                Area::Output => quote!(Output),
                Area::Memory => quote!(Memory),
            };
            let module = it.address.module.levels().iter().map(|it| Literal::u32_unsuffixed(*it));
            quote! {
                firmware::Io {
                    address: #address, variable: #variable, area: firmware::Area::#area, module: &[#(#module),*],
                    bit: #bit, width: #width
                }
            }
        });
        let fields = io.iter().enumerate().map(|(number, it)| {
            let place = it.units.iter().map(|unit| unit.place.to_string()).collect::<Vec<_>>().join(", ");
            let place = place.replace("self", "Globals").replace(' ', "");
            let row = format!(" | {number} | `{}` | {} | `{place}` |", it.address, area_name(it.address.area));
            quote!(#[doc = #row])
        });
        quote! {
            #tasks
            /// The variables at direct addresses: inputs, outputs, then memory.
            ///
            /// | number | address | area | field |
            /// |---|---|---|---|
            #(#fields)*
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
            /// The program instances that run.
            pub const TASKS: &[firmware::Task] = &[#(#rows),*];
        }
    }

    fn io(&self) -> Vec<Io> {
        let globals = self.program.globals;
        let fields = self.program.structure(globals).fields.iter().enumerate();
        let own = fields.flat_map(|(at, field)| {
            let name = self.names.field(globals, FieldId::next(at));
            field.address.map_or_else(Vec::new, |it| self.io_of(&field.name, field.ty, Some(quote!(self.#name)), it))
        });
        let mut io: Vec<_> = own.map(|it| self.own(it)).collect();
        io.extend(self.program.aliases.iter().flat_map(|it| self.views(it)));
        io.sort_by_key(|it| match it.address.area {
            Area::Input => 0,
            Area::Output => 1,
            Area::Memory => 2,
        });
        io
    }

    /// In memory at an address, `%M`, a variable that is not a number is reached only through its field.
    fn has_rows(&self, ty: Type, address: Address) -> bool {
        address.area != Area::Memory || self.program.repr(ty).is_some()
    }

    fn io_of(&self, name: &str, ty: Type, place: Option<TokenStream>, address: Address) -> Vec<Part> {
        if self.has_rows(ty, address) { self.parts_at(name, ty, place, address) } else { Vec::new() }
    }

    /// The numbers in a variable; a single one has its address as it is written.
    fn parts_at(&self, name: &str, ty: Type, place: Option<TokenStream>, address: Address) -> Vec<Part> {
        let mut parts = self.parts(name, ty, place, address);
        if let (true, [one]) = (self.program.repr(ty).is_some(), parts.as_mut_slice()) {
            one.address = address;
        }
        parts
    }

    fn own(&self, part: Part) -> Io {
        let place = part.place.unwrap_or_default();
        let unit = self.own_unit(place, part.ty, part.repr, part.address.width == 1);
        Io {
            variable: part.name,
            address: part.address,
            width: width(part.address, part.repr),
            units: vec![unit],
            shared: None,
        }
    }

    /// A variable, or an element of one.
    pub fn own_unit(&self, place: TokenStream, ty: Type, repr: Repr, is_bit: bool) -> Unit {
        Unit { ty: Some(ty), is_bit, range: self.program.range(ty), ..self.unit(place, repr) }
    }

    fn unit(&self, place: TokenStream, repr: Repr) -> Unit {
        Unit { place, repr, ty: None, is_bit: false, range: None, is_cell: self.shared }
    }

    /// The numbers in a variable that shares its bits with others.
    fn views(&self, variable: &Variable) -> Vec<Io> {
        let has_rows = variable.view.is_some_and(|it| self.has_rows(it.ty, it.address));
        if has_rows { self.parts_of_view(variable) } else { Vec::new() }
    }

    /// [`views`](Self::views), also of arrays and structures in memory.
    pub fn parts_of_view(&self, variable: &Variable) -> Vec<Io> {
        let Some(View { ty, bit, address }) = variable.view else { return Vec::new() };
        let parts = self.parts_at(&variable.name, ty, None, address);
        parts.into_iter().filter_map(|it| self.view(variable, it, bit, address)).collect()
    }

    /// A part of a variable that begins at a bit of the one that keeps it.
    fn view(&self, variable: &Variable, part: Part, bit: u64, whole: Address) -> Option<Io> {
        let bit = bit + part.address.bit - whole.bit;
        let width = width(part.address, part.repr);
        let Some(Projection::Field(field)) = variable.place.projections.first() else { return None };
        let name = self.names.field(self.program.globals, *field);
        let Part { name: variable_name, address, .. } = part;
        let Type::Array(id) = variable.place.ty else {
            let unit = self.unit(quote!(self.#name), self.program.repr(variable.place.ty)?);
            return Some(Io { variable: variable_name, address, width, units: vec![unit], shared: Some(bit) });
        };
        let repr = self.program.repr(self.program.array(id).element)?;
        let size = u64::from(repr.size()) * 8;
        let unit = |number: u64| {
            let position = Literal::u64_unsuffixed(bit / size + number);
            self.unit(quote!(self.#name[#position]), repr)
        };
        let count = u64::from(width).div_ceil(size);
        let shared = (u64::from(width) < size).then_some(bit % size);
        Some(Io { variable: variable_name, address, width, units: (0..count).map(unit).collect(), shared })
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
            /// Sets each input to the bits that `read` returns for it: call it before a scan.
            pub fn read_inputs(&mut self, mut read: impl FnMut(&firmware::Io) -> u64) {
                for (number, io) in IO.iter().enumerate() {
                    if io.area == firmware::Area::Input {
                        self.set_io(number, read(io));
                    }
                }
            }

            /// Passes the bits of each output to `write`: call it after a scan.
            pub fn write_outputs(&self, mut write: impl FnMut(&firmware::Io, u64)) {
                for (number, io) in IO.iter().enumerate() {
                    if io.area == firmware::Area::Output {
                        write(io, self.io(number));
                    }
                }
            }

            /// The bits of the variable with this number in `IO`, lowest bit first; 0 if the number is out of range.
            pub fn io(&self, number: usize) -> u64 {
                match number { #(#reading => #reads,)* _ => 0 }
            }

            /// Sets the bits of the variable with this number in `IO`; bits above its width are ignored.
            pub fn set_io(&mut self, number: usize, bits: u64) {
                match number { #(#writing => #writes,)* _ => {} }
            }
        }
    }
}

/// As documentation has it.
pub fn area_name(area: Area) -> &'static str {
    match area {
        Area::Input => "input",
        Area::Output => "output",
        Area::Memory => "memory",
    }
}

impl Io {
    fn mask(&self) -> Literal {
        Literal::u64_unsuffixed(u64::MAX >> (64 - u32::from(self.width)))
    }

    pub fn read(&self) -> TokenStream {
        if let (Some(shift), [unit]) = (self.shared, self.units.as_slice()) {
            let (whole, mask) = (shifted(unit.read(), Way::Down, shift), self.mask());
            return quote!(#whole & #mask);
        }
        let parts =
            self.units.iter().zip(0..).map(|(unit, number)| shifted(unit.read(), Way::Up, unit.bits() * number));
        quote!(#(#parts)|*)
    }

    pub fn write(&self) -> TokenStream {
        if let (Some(shift), [unit]) = (self.shared, self.units.as_slice()) {
            let (whole, mask, write) = (unit.read(), self.mask(), unit.write());
            let kept = Literal::u64_unsuffixed((u64::MAX >> (64 - u32::from(self.width))) << shift);
            let bits = shifted(quote!((bits & #mask)), Way::Up, shift);
            return quote!({ let bits = #whole & !#kept | #bits; #write });
        }
        let writes = self.units.iter().zip(0..).map(|(unit, number)| {
            let (write, bits) = (unit.write(), shifted(quote!(bits), Way::Down, unit.bits() * number));
            if number == 0 { quote!(#write;) } else { quote!({ let bits = #bits; #write }) }
        });
        match self.units.as_slice() {
            [unit] => unit.write(),
            _ => quote!({ #(#writes)* }),
        }
    }
}

/// A BOOL at an address of its own is one bit there.
fn width(address: Address, repr: Repr) -> u8 {
    if address.width == 1 { 1 } else { u8::try_from(repr.size() * 8).unwrap_or(u8::MAX) }
}

/// `bits`, shifted unless that is by 0.
fn shifted(bits: TokenStream, way: Way, by: u64) -> TokenStream {
    let count = Literal::u64_unsuffixed(by);
    match way {
        _ if by == 0 => bits,
        Way::Up => quote!(#bits << #count),
        Way::Down => quote!(#bits >> #count),
    }
}

impl Unit {
    fn bits(&self) -> u64 {
        u64::from(self.repr.size()) * 8
    }

    /// What `it` refers to, to be written.
    pub fn referred(&self) -> Self {
        let place = if self.is_cell || self.is_enumeration() { quote!(it) } else { quote!(*it) };
        Self { place, ..self.clone() }
    }

    /// The value or cell `it`, to be read.
    pub fn iterated(&self) -> Self {
        Self { place: quote!(it), ..self.clone() }
    }

    fn is_enumeration(&self) -> bool {
        matches!(self.ty, Some(Type::Enum(_)))
    }

    fn number(&self, place: TokenStream) -> TokenStream {
        if self.is_enumeration() { quote!(#place.0) } else { place }
    }

    pub fn read(&self) -> TokenStream {
        let place = &self.place;
        let place = self.number(if self.is_cell { quote!(#place.get()) } else { quote!(#place) });
        match self.repr {
            Repr::Bool | Repr::U8 | Repr::U16 | Repr::U32 => quote!(u64::from(#place)),
            Repr::U64 => quote!(#place),
            Repr::I64 => quote!(#place as u64),
            Repr::F32 => quote!(u64::from(#place.to_bits())),
            Repr::F64 => quote!(#place.to_bits()),
            Repr::I8 | Repr::I16 | Repr::I32 => {
                let unsigned = format_ident!("u{}", self.repr.size() * 8);
                quote!(u64::from(#place as #unsigned))
            }
        }
    }

    pub fn write(&self) -> TokenStream {
        let place = &self.place;
        let place = match (self.is_cell, self.is_enumeration()) {
            (true, false) => quote!(*#place.get_mut()),
            (true, true) => self.number(quote!(#place.get_mut())),
            (false, _) => self.number(quote!(#place)),
        };
        let value = self.nearest(match self.repr {
            Repr::Bool if self.is_bit => quote!(bits & 1 == 1),
            Repr::Bool => quote!(bits & 255 != 0),
            Repr::U64 => quote!(bits),
            Repr::F32 => quote!(f32::from_bits(bits as u32)),
            Repr::F64 => quote!(f64::from_bits(bits)),
            Repr::I8 | Repr::I16 | Repr::I32 | Repr::I64 | Repr::U8 | Repr::U16 | Repr::U32 => {
                let repr = format_ident!("{}", self.repr.rust_name());
                quote!(bits as #repr)
            }
        });
        quote!(#place = #value)
    }

    /// The value of the variable's type that any bits become.
    fn nearest(&self, value: TokenStream) -> TokenStream {
        match self.ty {
            Some(Type::Elementary(it)) if it.is_day() => quote!(staunch_runtime::ops::start_of_day(#value)),
            Some(Type::Elementary(it)) if it.is_time_of_day() => quote!(staunch_runtime::ops::time_of_day(#value)),
            _ => match self.range {
                Some((low, high)) => {
                    let (low, high) = (Literal::i128_unsuffixed(low), Literal::i128_unsuffixed(high));
                    quote!((#value).clamp(#low, #high))
                }
                None => value,
            },
        }
    }
}
