//! Items: structures, enumerations, implementations, and the names of the source files.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use staunch_ir::{Area, ClassKind, EnumId, Field, FieldId, Retain, RoutineId, RoutineKind, Section, StructId, Type};

use crate::alias::Origin;
use crate::emitter::Emitter;
use crate::function::Role;
use crate::literal::literal;
use crate::text::readable;

/// So many fields rustc compares by what it derives, which is one nested expression; it has no stack for thousands.
const DERIVED_FIELDS: usize = 1000;

impl Emitter<'_> {
    /// The program, in the order of the file, each made when it is asked for.
    pub fn items(&self) -> impl Iterator<Item = TokenStream> {
        let enums = (0..self.program.enums.len()).map(|at| self.enumeration(EnumId::next(at)));
        let structs = (0..self.program.structs.len()).map(|at| self.structure(StructId::next(at)));
        let functions = (0..self.program.routines.len())
            .map(RoutineId::next)
            .filter(|id| self.program.routine(*id).kind == RoutineKind::Function)
            .map(|id| self.routine(id));
        let before = [Self::files, Self::tables].into_iter().map(|it| it(self));
        let retained = std::iter::once_with(|| self.retained());
        let machine = self.shared.then(|| self.machine());
        before.chain(enums).chain(structs).chain(retained).chain(functions).chain(machine)
    }

    fn files(&self) -> TokenStream {
        let paths = self.program.files.iter().map(|it| &it.path);
        let consts = self.program.files.iter().zip(0_u16..).map(|(_, number)| {
            let (name, number) = (self.names.file(number), Literal::u16_unsuffixed(number));
            quote!(const #name: u16 = #number;)
        });
        quote! {
            /// The source files: the `file` of a fault's location is an index into them.
            pub const FILES: &[&str] = &[#(#paths),*];
            #(#consts)*
        }
    }

    fn enumeration(&self, id: EnumId) -> TokenStream {
        let enumeration = self.program.enumeration(id);
        let name = self.names.enumeration(id);
        let base = self.ty(Type::Elementary(enumeration.base));
        let docs = self.docs(
            enumeration.doc.as_deref(),
            &format!("TYPE {} ({})", enumeration.name, self.source(enumeration.location)),
        );
        let shared = self.shared.then(|| quote!(reference::shared_enumeration!(#name);));
        let consts = enumeration.values.iter().enumerate().map(|(at, enumerator)| {
            let own = format!("`{}`.", enumerator.name);
            let (name, doc) = (self.names.enumerator(id, at), doc(enumerator.doc.as_deref().or(Some(&own))));
            let value = literal(enumeration.base, enumerator.value, false).tokens;
            quote!(#doc pub const #name: Self = Self(#value);)
        });
        quote! {
            #docs
            #[repr(transparent)]
            #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
            pub struct #name(pub #base);
            impl #name { #(#consts)* }
            #shared
        }
    }

    fn structure(&self, id: StructId) -> TokenStream {
        let structure = self.program.structure(id);
        let name = self.names.structure(id);
        let docs = self.structure_docs(id);
        let parts = || {
            let all = structure.fields.iter().enumerate();
            all.filter(|(at, _)| !self.constants.contains(&(id, FieldId::next(*at))))
        };
        let fields = parts().map(|(at, field)| {
            let (name, ty) = (self.names.field(id, FieldId::next(at)), self.stored(field.ty));
            let docs = self.field_docs(id, field);
            quote!(#docs pub #name: #ty)
        });
        let values = parts().map(|(at, field)| {
            let name = self.names.field(id, FieldId::next(at));
            let value = self.stored_constant(field.ty, &field.initial);
            quote!(#name: #value)
        });
        let (methods, constants) = (self.methods(id), self.constant_items(id));
        let is_large = parts().count() > DERIVED_FIELDS;
        let compared = is_large.then(|| {
            let fields = parts().map(|(at, _)| self.names.field(id, FieldId::next(at)));
            quote! {
                impl PartialEq for #name {
                    fn eq(&self, other: &Self) -> bool {
                        #(if self.#fields != other.#fields { return false; })*
                        true
                    }
                }
            }
        });
        let derives = match (self.shared, is_large) {
            (true, false) => quote!(#[derive(Clone, Debug, PartialEq)]),
            (true, true) => quote!(#[derive(Clone, Debug)]),
            (false, false) => quote!(#[derive(Clone, Copy, Debug, PartialEq)]),
            (false, true) => quote!(#[derive(Clone, Copy, Debug)]),
        };
        let names = (0..structure.fields.len()).map(|at| self.names.field(id, FieldId::next(at)));
        let shared = self.shared.then(|| quote!(reference::shared!(#name { #(#names),* });));
        let io = (id == self.program.globals).then(|| [self.io_methods(), self.image_methods()]);
        let io = io.into_iter().flatten();
        let align = (structure.align > 1).then(|| Literal::u64_unsuffixed(structure.align));
        let layout = align.map_or_else(|| quote!(#[repr(C)]), |it| quote!(#[repr(C, align(#it))]));
        quote! {
            #docs
            #layout
            #derives
            pub struct #name { #(#fields),* }
            #shared
            impl #name {
                #constants
                /// With initial values.
                pub const fn new() -> Self { Self { #(#values),* } }
                #methods
                #(#io)*
            }
            impl Default for #name { fn default() -> Self { Self::new() } }
            #compared
        }
    }

    /// What a field is to who holds the structure, and what its author wrote about it, which is enough for a
    /// plain variable.
    pub fn field_docs(&self, id: StructId, field: &Field) -> TokenStream {
        let is_state = self.program.class_of_state(id).is_some();
        let (what, is_plain) = match field.section {
            Section::Global if field.address.is_some_and(|it| it.area == Area::Input) => ("Global input", false),
            Section::Global if field.address.is_some_and(|it| it.area == Area::Output) => ("Global output", false),
            Section::Input => ("Input", false),
            Section::Output => ("Output", false),
            Section::InOut => ("In-out", false),
            Section::Internal if is_state => ("Variable", true),
            Section::Internal => ("Member", true),
            Section::Global => ("Global", true),
            Section::Temp | Section::External => ("Variable", true),
        };
        let mut marks = String::new();
        if field.constant {
            marks.push_str(", constant");
        }
        if field.retain == Retain::Kept {
            marks.push_str(", retained");
        }
        if let Some(address) = field.address {
            marks.push_str(&format!(", at `{address}`"));
        }
        match &field.doc {
            Some(written) if is_plain && marks.is_empty() => doc(Some(written)),
            written => self.docs(written.as_deref(), &format!("{what} `{}`{marks}.", field.name)),
        }
    }

    /// The routines that work on the structure, as an instance's state.
    fn methods(&self, id: StructId) -> TokenStream {
        let ids = (0..self.program.routines.len()).map(RoutineId::next);
        let methods = ids.filter(|it| self.program.routine(*it).state == Some(id)).map(|it| self.routine(it));
        quote!(#(#methods)*)
    }

    fn structure_docs(&self, id: StructId) -> TokenStream {
        let structure = self.program.structure(id);
        if id == self.program.globals {
            return self.docs(structure.doc.as_deref(), "The global variables.");
        }
        let (keyword, doc) = match self.program.class_of_state(id) {
            Some(class) => (keyword(class.kind), class.doc.as_ref().or(structure.doc.as_ref())),
            None => ("TYPE", structure.doc.as_ref()),
        };
        let title = format!("{keyword} {} ({})", structure.name, self.source(structure.location));
        self.docs(doc.map(String::as_str), &title)
    }

    /// What a function says of itself.
    pub fn scan_docs(&self, id: RoutineId, role: Role) -> TokenStream {
        let routine = self.program.routine(id);
        let origin = self.origins[id.index()];
        match (role, origin) {
            (Role::Scan, Origin::Declared) => doc_line("One scan."),
            (Role::Scan, Origin::Apart) => {
                doc_line("One scan, for instances that are global: the globals that it uses are passed to it.")
            }
            (Role::Scan, Origin::Copy) => doc_line("One scan, for calls whose arguments share storage."),
            (Role::Prescan, _) => doc_line("Prepares counters and other instances for the first scan."),
            (Role::Free | Role::Method, Origin::Declared) => {
                let word = if role == Role::Free { "FUNCTION" } else { "METHOD" };
                let title = format!("{word} {} ({})", routine.name, self.source(routine.location));
                self.docs(routine.doc.as_deref(), &title)
            }
            (Role::Free | Role::Method, Origin::Apart) => {
                let title = format!("{}, to which the globals that it uses are passed.", self.source(routine.location));
                self.docs(routine.doc.as_deref(), &title)
            }
            (Role::Free | Role::Method, Origin::Copy) => {
                let source = self.source(routine.location);
                self.docs(
                    routine.doc.as_deref(),
                    &format!("A copy of {source}, for calls whose arguments share storage."),
                )
            }
        }
    }

    /// What the declaration is, and what its author wrote about it.
    pub fn docs(&self, written: Option<&str>, title: &str) -> TokenStream {
        let title = doc_line(title);
        match written {
            Some(_) => {
                let (gap, written) = (quote!(#[doc = ""]), doc(written));
                quote!(#title #gap #written)
            }
            None => title,
        }
    }
}

fn keyword(kind: ClassKind) -> &'static str {
    match kind {
        ClassKind::Program => "PROGRAM",
        ClassKind::FunctionBlock => "FUNCTION_BLOCK",
    }
}

fn doc(written: Option<&str>) -> TokenStream {
    written.into_iter().flat_map(str::lines).map(doc_line).collect()
}

/// A comment's line as documentation: nothing in it may become a code example.
fn doc_line(line: &str) -> TokenStream {
    let text = readable(line.trim()).replace("```", "'''").replace("~~~", "---").replace('\t', " ");
    let text = if text.is_empty() { text } else { format!(" {text}") };
    quote!(#[doc = #text])
}
