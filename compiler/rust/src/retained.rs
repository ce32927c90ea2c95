//! What a firmware calls to keep retained variables: they go to bytes and come back by one function, which
//! walks the state as a host's file does (`runtime/host/src/start.rs`).

use std::fmt::Write as _;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use staunch_ir::startup::{self, Event, Fate, Startup};
use staunch_ir::{ArrayId, BlockId, Elementary, EnumId, FieldId, StructId, Type};
use staunch_runtime::firmware::RECORD_OVERHEAD;

use crate::emitter::Emitter;
use crate::literal::signed;
use crate::names::ident;

/// A variable's place, or a reference to it.
#[derive(Clone, Debug)]
struct Target {
    tokens: TokenStream,
    is_reference: bool,
}

impl Target {
    fn field(&self, name: &Ident) -> Self {
        let whole = &self.tokens;
        Self { tokens: quote!(#whole.#name), is_reference: false }
    }

    /// The contents of the cell.
    fn opened(&self) -> Self {
        let tokens = &self.tokens;
        Self { tokens: quote!(#tokens.get_mut()), is_reference: true }
    }

    fn borrowed(&self) -> TokenStream {
        let tokens = &self.tokens;
        if self.is_reference { quote!(#tokens) } else { quote!(&mut #tokens) }
    }
}

/// The walk over what a power cycle keeps.
struct Walk<'e> {
    emitter: &'e Emitter<'e>,
    startup: Startup<'e>,
    /// Bytes of the values.
    size: u64,
    /// Each value with all that its bytes mean: the fingerprint's text.
    meaning: String,
}

impl Emitter<'_> {
    /// `save_retained`, `load_retained` and what belongs to them; nothing where no variable is retained.
    pub fn retained(&self) -> TokenStream {
        let program = self.program;
        let mut walk = Walk { emitter: self, startup: Startup::new(program), size: 0, meaning: String::new() };
        let (mut params, mut names, mut body) = (Vec::new(), Vec::new(), Vec::new());
        let globals = (ident("globals"), program.globals);
        let instances = program.instances.iter().enumerate();
        let instances = instances.map(|(at, it)| (self.names.instance(at).clone(), program.class(it.program).state));
        for (name, state) in instances.chain([globals]) {
            let carried = {
                let target = Target { tokens: quote!(#name), is_reference: true };
                walk.fields(state, &target, &name.to_string(), Fate::Inherited)
            };
            if !carried.is_empty() {
                let ty = self.names.structure(state);
                params.push(quote!(#name: &mut #ty));
                body.push(carried);
                names.push(name);
            }
        }
        match names.is_empty() {
            true => TokenStream::new(),
            false => functions(&walk, &params, &names, &body),
        }
    }
}

fn functions(walk: &Walk<'_>, params: &[TokenStream], names: &[Ident], body: &[TokenStream]) -> TokenStream {
    let overhead = u64::try_from(RECORD_OVERHEAD).expect("a few bytes");
    let size = Literal::u64_unsuffixed(overhead + walk.size);
    let program: TokenStream =
        format!("{:#010x}", staunch_runtime::crc32(walk.meaning.as_bytes())).parse().expect("a number");
    quote! {
        /// Bytes of a record of the retained variables.
        pub const RETAINED_SIZE: usize = #size;

        /// Tells the retained variables, their types and their order from those of other programs.
        pub const RETAINED_PROGRAM: u32 = #program;

        /// Writes a record of the retained variables, which it leaves as they are. After a scan that returned an error
        /// they are those of half a scan: the record before it is the one to keep.
        pub fn save_retained(bytes: &mut [u8; RETAINED_SIZE], stamp: firmware::Stamp, #(#params),*) {
            firmware::save(bytes, RETAINED_PROGRAM, stamp, |carrier| carry_retained(carrier, #(#names),*));
        }

        /// When the record at the start of `bytes` was written, if it is one of this program.
        pub fn retained_stamp(bytes: &[u8]) -> Result<firmware::Stamp, firmware::NotRetained> {
            firmware::stamp(bytes, RETAINED_SIZE, RETAINED_PROGRAM)
        }

        /// Reads the retained variables from the record at the start of `bytes`. After an error they are as
        /// before; whatever a record holds, each gets a value of its type.
        pub fn load_retained(bytes: &[u8], #(#params),*) -> Result<firmware::Stamp, firmware::NotRetained> {
            firmware::load(bytes, RETAINED_SIZE, RETAINED_PROGRAM, |carrier| carry_retained(carrier, #(#names),*))
        }

        fn carry_retained(carrier: &mut firmware::Carrier<'_>, #(#params),*) {
            #(#body)*
        }
    }
}

impl Walk<'_> {
    /// Carries what is kept of a structure's fields.
    fn fields(&mut self, id: StructId, place: &Target, path: &str, outside: Fate) -> TokenStream {
        let fields = self.emitter.program.structure(id).fields.iter().enumerate();
        fields
            .filter(|(_, field)| !field.constant)
            .map(|(at, field)| {
                let field_id = FieldId::next(at);
                let name = self.emitter.names.field(id, field_id);
                let fate = self.startup.field(id, field_id, Event::PowerCycle).within(outside);
                self.part(field.ty, &place.field(name), &format!("{path}.{}", field.name), fate)
            })
            .collect()
    }

    fn part(&mut self, ty: Type, place: &Target, path: &str, fate: Fate) -> TokenStream {
        let opened = place.opened();
        self.opened_part(ty, if self.emitter.is_in_cell(ty) { &opened } else { place }, path, fate)
    }

    fn opened_part(&mut self, ty: Type, place: &Target, path: &str, fate: Fate) -> TokenStream {
        match ty {
            // They are null at every restart.
            Type::Reference(_) => TokenStream::new(),
            Type::Struct(id) => self.fields(id, place, path, fate),
            Type::Array(id) => self.array(id, place, path, fate),
            Type::Block(id) => self.block(id, place, path, fate),
            Type::Elementary(_) | Type::Subrange(..) | Type::String(_) | Type::Enum(_) if !fate.is_kept() => {
                TokenStream::new()
            }
            Type::Elementary(it) => self.value(place, path, &self.elementary(it), it.repr().size()),
            Type::Subrange(it, bounds) => {
                let (low, high) = self.emitter.program.bounds(bounds);
                self.value(place, path, &format!("{}({low}..{high})", it.name()), it.repr().size());
                let (place, low, high) = (place.borrowed(), signed(low, "").tokens, signed(high, "").tokens);
                quote!(carrier.within(#place, #low, #high);)
            }
            Type::String(it) => {
                let size = 2 + u64::from(it.capacity) * u64::from(it.unit_size());
                self.value(place, path, &it.to_string(), size)
            }
            Type::Enum(id) => {
                let (ty, size) = (self.enumeration(id), self.emitter.program.enumeration(id).base.repr().size());
                let number = &place.tokens;
                let number = Target { tokens: quote!(#number.0), is_reference: false };
                self.value(&number, path, &ty, size)
            }
        }
    }

    /// What the bytes of the type mean: a TIME is another, where other ones are.
    fn elementary(&self, ty: Elementary) -> String {
        match self.emitter.program.milliseconds {
            Some((least, greatest)) if ty == Elementary::Time => format!("{}({least}..{greatest})", ty.name()),
            Some(_) | None => ty.own_name().to_owned(),
        }
    }

    fn array(&mut self, id: ArrayId, place: &Target, path: &str, fate: Fate) -> TokenStream {
        let array = self.emitter.program.array(id);
        let before = self.size;
        let path = format!("{path}[{}..{}]", array.low, array.high);
        let element = Target { tokens: quote!(element), is_reference: true };
        let carried = self.part(array.element, &element, &path, fate);
        self.size = before + (self.size - before) * array.len();
        let place = place.borrowed();
        if carried.is_empty() {
            carried
        } else if self.is_plain(array.element) {
            quote!(carrier.value(#place);)
        } else {
            quote!(for element in #place { #carried })
        }
    }

    /// Whether the runtime carries arrays of the type as a whole.
    fn is_plain(&self, ty: Type) -> bool {
        match ty {
            Type::Elementary(_) | Type::String(_) => !self.emitter.shared,
            Type::Array(id) => self.is_plain(self.emitter.program.array(id).element),
            Type::Subrange(..) | Type::Enum(_) | Type::Struct(_) | Type::Block(_) | Type::Reference(_) => false,
        }
    }

    fn block(&mut self, id: BlockId, place: &Target, path: &str, outside: Fate) -> TokenStream {
        let info = id.info();
        let pins = info.pins.iter().enumerate();
        pins.filter(|(_, pin)| startup::pin(info, pin).within(outside).is_kept())
            .map(|(at, pin)| {
                let ty = id.pin_type(FieldId::next(at)).expect("position of a pin");
                let name = ident(pin.field);
                self.opened_part(ty, &place.field(&name), &format!("{path}:{}.{}", info.name, pin.name), outside)
            })
            .collect()
    }

    fn value(&mut self, place: &Target, path: &str, ty: &str, size: impl Into<u64>) -> TokenStream {
        self.size += size.into();
        let _ = writeln!(self.meaning, "{}\t{}", path.to_uppercase(), ty.to_uppercase());
        let place = place.borrowed();
        quote!(carrier.value(#place);)
    }

    fn enumeration(&self, id: EnumId) -> String {
        let enumeration = self.emitter.program.enumeration(id);
        let value = |it: &staunch_ir::Enumerator| format!("{}={:?}", it.name, it.value);
        let values: Vec<String> = enumeration.values.iter().map(value).collect();
        format!("{}({})", enumeration.name, values.join(","))
    }
}
