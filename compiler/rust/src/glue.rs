//! The C entry points over emitted Rust: what an executable, a library or a test links against.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::iter;

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::layout::usize_of;
use staunch_ir::{ClassId, Program, Type};

use crate::alias;
use crate::emitter::Emitter;
use crate::names::{Names, ident};
use crate::{Options, format};

/// The text of a module that exports `staunch_map`, `staunch_init` and `staunch_scan` for the
/// program that [`emit`](crate::emit) printed. `code` is the path of that text's module, `map`
/// the program's map.
pub fn emit_glue(program: &Program, code: &str, map: &str, options: &Options) -> String {
    let separated = alias::separate(program);
    let emitter = Emitter::new(&separated.program, &separated.origins);
    let (program, names) = (&separated.program, &emitter.names);
    let globals = names.structure(program.globals);
    let code: syn::Path = syn::parse_str(code).expect("the code's path is a Rust path");
    let runtime: syn::Path = syn::parse_str(&options.runtime).expect("the runtime's path is a Rust path");
    let members = program.instances.iter().enumerate().map(|(at, instance)| {
        let (name, ty) = (names.instance(at), state(program, names, instance.program));
        quote!(pub #name: #code::#ty)
    });
    let scans = program.instances.iter().enumerate().map(|(at, instance)| {
        let (name, number) = (names.instance(at), Literal::usize_unsuffixed(at));
        let uses_globals = emitter.effects[program.class(instance.program).body.index()].uses_globals();
        let globals = match (emitter.shared, uses_globals) {
            (true, _) => Some(quote!(, self)),
            (false, true) => Some(quote!(, &mut self.globals)),
            (false, false) => None,
        };
        quote!(#number => self.#name.scan(cx #globals))
    });
    let starts = before_the_first_scan(&emitter);
    let (bytes, length) = (Literal::byte_string(map.as_bytes()), Literal::usize_unsuffixed(map.len()));
    let size = Literal::u64_unsuffixed(emitter.layout.machine.size);
    let offsets = program.instances.iter().enumerate().map(|(at, _)| {
        let (name, offset) = (names.instance(at), Literal::u64_unsuffixed(emitter.layout.machine.instances[at]));
        quote!(assert!(core::mem::offset_of!(Machine, #name) == #offset);)
    });
    let (statics, copies) = statics(&emitter, &code);
    let start = (!copies.is_empty()).then(|| {
        quote! {
            /// A start value, which is copied and never changed.
            struct Start<T>(T);

            /// # Safety
            /// Nobody writes to one.
            unsafe impl<T> Sync for Start<T> {}
        }
    });
    let machine = (!copies.is_empty()).then(|| quote!(let machine = state.cast::<Machine>();));
    let whole = if emitter.shared {
        quote!(use #code::Machine; #start)
    } else {
        quote! {
            /// The program's whole state.
            #[repr(C)]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Machine { pub globals: #code::#globals, #(#members),* }
        }
    };
    let items = quote! {
        use #runtime::{Context, Fault};

        #whole

        impl Machine {
            /// One scan of an instance.
            pub fn scan(&mut self, cx: &Context, instance: u32) -> Result<(), Fault> {
                #starts
                match instance { #(#scans,)* _ => Ok(()) }
            }
        }

        const _: () = {
            assert!(size_of::<Machine>() == #size);
            #(#offsets)*
        };

        #[doc = " The map of the state."]
        #[unsafe(no_mangle)]
        pub static staunch_map: [u8; #length] = *#bytes;

        #[unsafe(no_mangle)]
        pub static staunch_map_len: usize = #length;

        #(#statics)*

        /// Writes the initial state, in place: it may be larger than the stack.
        ///
        /// # Safety
        /// `state` points to writable memory of the machine's size and alignment.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn staunch_init(state: *mut u8) {
            st_mark!("SAFETY: as the caller promises; a static is no part of the state.");
            unsafe {
                state.write_bytes(0, size_of::<Machine>());
                #machine
                #(#copies)*
            }
        }

        /// One scan; 0, or the code of a fault.
        ///
        /// # Safety
        /// `state` has been initialised by `staunch_init` and nobody else uses it meanwhile; what was
        /// written to it since are values of the variables' types (a BOOL is 0 or 1). `cx` points to
        /// a context.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn staunch_scan(state: *mut u8, cx: *const Context, instance: u32) -> u64 {
            st_mark!("SAFETY: as the caller promises.");
            let (machine, cx) = unsafe { (&mut *state.cast::<Machine>(), &*cx) };
            machine.scan(cx, instance).err().map_or(0, Fault::code)
        }
    };
    let mut text = String::from("// Generated by Staunch: the C entry points of the program.\n");
    text.push_str("#![allow(non_upper_case_globals, reason = \"the symbols are C's\")]\n\n");
    write!(text, "{}", format::format(items)).expect("writing to a String does not fail");
    text
}

/// What starts the instances of all PROGRAMs, where several run.
fn before_the_first_scan(emitter: &Emitter<'_>) -> Option<TokenStream> {
    let starts = emitter.program.starts();
    let calls = starts.iter().map(|(at, start)| {
        let (name, method) = (emitter.names.instance(*at), emitter.names.routine(*start));
        let needs = &emitter.effects[start.index()];
        let context = needs.context.then(|| quote!(cx));
        let world = match (emitter.shared, needs.uses_globals()) {
            (true, _) => Some(quote!(self)),
            (false, true) => Some(quote!(&mut self.globals)),
            (false, false) => None,
        };
        let (arguments, propagate) = (context.into_iter().chain(world), needs.faults.then(|| quote!(?)));
        quote!(self.#name.#method(#(#arguments),*) #propagate;)
    });
    (!starts.is_empty()).then(|| quote!(if cx.first_scan { #(#calls)* }))
}

/// For each structure that does not start with zeros alone, a static with its initial values; and
/// the copies of them into the state.
fn statics(emitter: &Emitter<'_>, code: &syn::Path) -> (Vec<TokenStream>, Vec<TokenStream>) {
    let (program, names, layout) = (emitter.program, &emitter.names, &emitter.layout);
    let image = layout.image(program);
    let instances = program.instances.iter().enumerate().map(|(at, instance)| {
        let state = program.class(instance.program).state;
        (names.instance(at).clone(), state, layout.machine.instances[at])
    });
    let globals = (ident("globals"), program.globals, layout.machine.globals);
    let (mut statics, mut copies) = (BTreeMap::new(), Vec::new());
    for (member, id, offset) in iter::once(globals).chain(instances) {
        let start = usize_of(offset);
        let bytes = &image[start..start + usize_of(layout.size(Type::Struct(id)))];
        if bytes.iter().any(|byte| *byte != 0) {
            let (ty, name) = (names.structure(id), ident(&format!("START_{}", id.0)));
            if emitter.shared {
                copies.push(quote!((&raw mut (*machine).#member).copy_from_nonoverlapping(&raw const #name.0, 1);));
                statics.insert(id, quote!(static #name: Start<#code::#ty> = Start(#code::#ty::new());));
                continue;
            }
            copies.push(quote!((&raw mut (*machine).#member).copy_from_nonoverlapping(&raw const #name, 1);));
            statics.insert(id, quote!(static #name: #code::#ty = #code::#ty::new();));
        }
    }
    (statics.into_values().collect(), copies)
}

fn state<'n>(program: &Program, names: &'n Names, id: ClassId) -> &'n proc_macro2::Ident {
    names.structure(program.class(id).state)
}
