//! A process image as bytes: what the globals read from one before a scan, and write to it after that. Which variables have a place, and
//! where, is as for an executable.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use staunch_ir::{Address, FieldId, Repr, Type, Variable};
use staunch_runtime::firmware::{Area, Place, Width};

use crate::emitter::Emitter;
use crate::firmware::{Io, Unit};

/// What has places, and the names of what has none.
#[derive(Default)]
struct Image {
    own: Vec<Placed>,
    /// Bits that are those of another variable, too.
    views: Vec<(Place, Io)>,
    lacking: Vec<String>,
}

/// A variable, or the numbers of an array, one after the other.
struct Placed {
    first: Place,
    count: u64,
    field: TokenStream,
    /// How many arrays are within one another.
    depth: usize,
    unit: Unit,
}

/// The numbers of a variable.
struct Numbers {
    ty: Type,
    count: u64,
    depth: usize,
}

impl Emitter<'_> {
    /// How the globals are read from and written to a process image; nothing where no variable has a place there.
    pub fn image_methods(&self) -> TokenStream {
        let image = self.image();
        if image.own.is_empty() && image.views.is_empty() {
            return TokenStream::new();
        }
        let lacking = (!image.lacking.is_empty()).then(|| {
            let text = format!(" These variables have no place in the image: {}.", image.lacking.join(", "));
            quote!(#[doc = ""] #[doc = #text])
        });
        let (reads, writes) = (with_names(image.reads()), with_names(image.writes()));
        quote! {
            /// Copies inputs and memory from a process image: call it before a scan.
            #lacking
            pub fn read_image(&mut self, image: &impl firmware::ProcessImage) {
                #reads
            }

            /// Copies outputs and memory to a process image: call it after a scan, and once before the first one.
            pub fn write_image(&self, image: &mut impl firmware::ProcessImage) {
                #writes
            }
        }
    }

    fn image(&self) -> Image {
        let mut image = Image::default();
        let globals = self.program.globals;
        for (at, field) in self.program.structure(globals).fields.iter().enumerate() {
            let Some(address) = field.address else { continue };
            let name = self.names.field(globals, FieldId::next(at));
            match self.placed(field.ty, address, quote!(self.#name)) {
                Some(placed) => image.own.push(placed),
                None => image.lacking.push(format!("`{}` (`{address}`)", field.name)),
            }
        }
        for alias in &self.program.aliases {
            let Some(view) = alias.view else { continue };
            match self.place(view.ty, view.address) {
                Some((place, ..)) => image.views.extend(self.placed_view(alias, place)),
                None => image.lacking.push(format!("`{}` (`{}`)", alias.name, view.address)),
            }
        }
        image
    }

    fn placed(&self, ty: Type, address: Address, field: TokenStream) -> Option<Placed> {
        let (first, Numbers { ty, count, depth }, repr) = self.place(ty, address)?;
        let unit = self.own_unit(field.clone(), ty, repr, first.width == Width::Bit);
        Some(Placed { first, count, field, depth, unit })
    }

    /// The first place of a variable, if each of its numbers has one.
    fn place(&self, ty: Type, address: Address) -> Option<(Place, Numbers, Repr)> {
        let numbers = self.numbers(ty);
        let repr = match numbers.ty {
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) => self.program.repr(numbers.ty)?,
            Type::String(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) | Type::Reference(_) => return None,
        };
        let size = usize::try_from(repr.size()).ok()?;
        let place = Place::parse(&address.to_string())?;
        let has_room = usize::try_from(numbers.count).is_ok_and(|it| it <= place.room());
        (place.holds(repr == Repr::Bool, size) && has_room).then_some((place, numbers, repr))
    }

    fn numbers(&self, ty: Type) -> Numbers {
        let mut numbers = Numbers { ty, count: 1, depth: 0 };
        while let Type::Array(id) = numbers.ty {
            let array = self.program.array(id);
            numbers.ty = array.element;
            numbers.count = numbers.count.saturating_mul(array.len());
            numbers.depth += 1;
        }
        numbers
    }

    fn placed_view(&self, alias: &Variable, first: Place) -> Vec<(Place, Io)> {
        let numbers = first.number..first.width.count();
        self.parts_of_view(alias).into_iter().zip(numbers).map(|(io, it)| (Place { number: it, ..first }, io)).collect()
    }
}

impl Image {
    /// A view of memory is read where it is another value than the variable's before: what was written outside through one address is not
    /// undone by another.
    fn reads(&self) -> TokenStream {
        let own = self.own.iter().filter(|it| it.first.area != Area::Output).map(Placed::read);
        let views = || self.views.iter().filter(|it| it.0.area == Area::Memory).enumerate();
        let changed = views().map(|(number, (place, io))| {
            let (changed, place, present) = (format_ident!("changed_{number}"), name_of(*place), io.read());
            quote!(let bits = #present; let #changed = image.changed(#place, bits);)
        });
        let taken = views().map(|(number, (_, io))| {
            let (changed, write) = (format_ident!("changed_{number}"), io.write());
            quote!(if let Some(bits) = #changed { #write; })
        });
        quote!(#(#changed)* #(#own)* #(#taken)*)
    }

    fn writes(&self) -> TokenStream {
        let own = self.own.iter().filter(|it| it.first.area != Area::Input).map(Placed::write);
        let views = self.views.iter().filter(|it| it.0.area != Area::Input).map(|(place, io)| {
            let (place, bits) = (name_of(*place), io.read());
            quote!(let bits = #bits; image.set_bits(#place, bits);)
        });
        quote!(#(#own)* #(#views)*)
    }
}

impl Placed {
    fn read(&self) -> TokenStream {
        let (place, field) = (self.place(), &self.field);
        let all = match self.depth {
            0 => {
                let write = self.unit.write();
                return quote!(let bits = image.bits(#place); #write;);
            }
            1 => quote!(&mut #field),
            depth => {
                let flat = vec![quote!(.as_flattened_mut()); depth - 1];
                quote!(#field #(#flat)*)
            }
        };
        let (numbers, write) = (self.range(), self.unit.referred().write());
        quote!(for (number, it) in (#numbers).zip(#all) { let bits = image.bits(#place); #write; })
    }

    fn write(&self) -> TokenStream {
        let (place, field) = (self.place(), &self.field);
        if self.depth == 0 {
            let bits = self.unit.read();
            return quote!(let bits = #bits; image.set_bits(#place, bits););
        }
        let flat = vec![quote!(.as_flattened()); self.depth - 1];
        let (numbers, bits) = (self.range(), self.unit.iterated().read());
        let all =
            if self.unit.is_cell { quote!(#field #(#flat)*.iter()) } else { quote!(#field #(#flat)*.iter().copied()) };
        quote!(for (number, it) in (#numbers).zip(#all) { let bits = #bits; image.set_bits(#place, bits); })
    }

    fn range(&self) -> TokenStream {
        let (first, count) = (self.first.number as u64, self.count);
        let (first, end) = (Literal::u64_unsuffixed(first), Literal::u64_unsuffixed(first + count));
        quote!(#first..#end)
    }

    /// The one of its place, or of the number in a loop.
    fn place(&self) -> TokenStream {
        if self.depth == 0 { name_of(self.first) } else { written(self.first, quote!(number)) }
    }
}

/// A body in which places are written by their names, if it has any.
fn with_names(body: TokenStream) -> TokenStream {
    if body.is_empty() { body } else { quote!(use firmware::{Area, Place, Width}; #body) }
}

fn name_of(place: Place) -> TokenStream {
    let number = Literal::usize_unsuffixed(place.number);
    written(place, quote!(#number))
}

fn written(place: Place, number: TokenStream) -> TokenStream {
    let area = match place.area {
        Area::Input => quote!(Input),
        Area::Output => quote!(Output),
        Area::Memory => quote!(Memory),
    };
    let width = match place.width {
        Width::Bit => quote!(Bit),
        Width::Byte => quote!(Byte),
        Width::Word => quote!(Word),
        Width::Double => quote!(Double),
        Width::Long => quote!(Long),
    };
    quote!(Place::new(Area::#area, Width::#width, #number))
}
