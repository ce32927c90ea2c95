//! IR to Rust: one readable, safe, `no_std` module a program. It compiles
//! without warnings, cannot panic, and is the same text in every run.
#![forbid(unsafe_code)]

mod names;

mod alias;

mod precedence;

mod literal;
mod look_up;
mod text;

mod declare;
mod emitter;
mod expected;
mod loop_state;

mod attempt;
mod byte_copy;
mod constant;
mod counted;
mod expression;
mod external;
mod firmware;
mod flash;
mod function;
mod index_hoist;
mod io_parts;
mod item;
mod loops;
mod name_table;
mod place;
mod process_image;
mod retained;
mod shared;
mod short_circuit;
mod statement;
mod string;
mod strips;
mod turns;

mod format;
mod glue;
mod imports;
mod layout_asserts;

use proc_macro2::TokenStream;
use quote::quote;
use staunch_ir::Program;
use staunch_ir::promote::{Gain, promoted};

use emitter::Emitter;
use imports::Imports;

pub use glue::emit_glue;

/// How the emitted text fits into its crate.
#[derive(Clone, Debug)]
pub struct Options {
    /// Path of the runtime crate.
    pub runtime: String,
    pub shape: Shape,
    pub state: State,
    /// A table of the variables' names, types and values at run time.
    pub names: bool,
}

/// What is in the structures of the emitted text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// All variables, each where the program's map says: for hosts that find them by that.
    Mapped,
    /// What changes: constants are `const` items.
    Lean,
}

/// Where the emitted text goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A file of its own, with inner attributes at its top.
    File,
    /// The target of an `include!`, which takes no inner attributes: the text is in a module of
    /// this name, and everything in it is also exported next to it.
    Include { module: String },
}

impl Default for Options {
    fn default() -> Self {
        Self { runtime: "staunch_runtime".to_owned(), shape: Shape::File, state: State::Mapped, names: false }
    }
}

/// Lints that speak of how a program is phrased, which is its Structured Text's affair, or that
/// call a mistake what is legal there and has been reported by the compiler.
const ALLOWED: &[(&str, &[&str])] = &[
    ("not every crate uses every part of a program", &["dead_code"]),
    (
        "variables and control flow are as in the source",
        &[
            "unreachable_code",
            "unused_assignments",
            "unused_comparisons",
            "unused_variables",
            "clippy::absurd_extreme_comparisons",
            "clippy::almost_swapped",
            "clippy::bad_bit_mask",
            "clippy::eq_op",
            "clippy::erasing_op",
            "clippy::ifs_same_cond",
            "clippy::impossible_comparisons",
            "clippy::never_loop",
            "clippy::overly_complex_bool_expr",
            "clippy::redundant_comparisons",
            "clippy::self_assignment",
            "clippy::while_immutable_condition",
        ],
    ),
    (
        "constants and phrasing are as in the source",
        &["unused_parens", "clippy::approx_constant", "clippy::complexity", "clippy::style"],
    ),
];

/// Prints a verified program.
pub fn emit(program: &Program, options: &Options) -> String {
    let separated = alias::separate(&promoted(program, Gain::WHOLE));
    let mut emitter = Emitter::new(&separated.program, &separated.origins);
    // References find what they lead to by the whole layout.
    if options.state == State::Lean && !emitter.shared {
        emitter.constants = flash::constants(&emitter);
    }
    let externals = emitter.externals();
    let calls_out = externals.is_some();
    let names = options.names.then(|| emitter.name_table());
    let mut used = Imports::default();
    let mut printed = String::new();
    for item in externals.into_iter().chain(emitter.items()).chain(names) {
        let text = format::print(item);
        used.note(&text);
        printed.push_str(&text);
    }
    printed.insert_str(0, &format::print(imports(&used, &options.runtime, emitter.shared, calls_out)));
    let body = format!("{}{}", format::finish(&printed), layout_asserts::layout(&emitter));
    let header = header(program);
    match &options.shape {
        Shape::File => {
            let attributes = attributes("#!");
            format!("{header}{attributes}\n{body}")
        }
        Shape::Include { module } => {
            let (module, attributes) = (names::ident(&names::snake(module)), attributes("#"));
            format!(
                "{header}{attributes}mod {module} {{\n{body}}}\n#[allow(unused_imports, reason = \"a crate takes what it needs\")]\npub use {module}::*;\n"
            )
        }
    }
}

fn imports(used: &Imports, runtime: &str, shared: bool, calls_out: bool) -> TokenStream {
    let cell = shared.then(|| {
        quote!(
            use core::cell::Cell;
        )
    });
    let externals = calls_out.then(|| {
        quote!(
            use super::Externals;
        )
    });
    let used = used.items(runtime);
    quote!(#cell #externals #used)
}

fn header(program: &Program) -> String {
    let mut header = format!("// Generated by Staunch {} from", env!("CARGO_PKG_VERSION"));
    for (at, file) in program.files.iter().enumerate() {
        header.push_str(if at == 0 { " " } else { ", " });
        header.push_str(&text::readable(&file.path.replace(['\n', '\r'], " ")));
    }
    header.push_str(".\n// Staunch claims no rights in this text: it is yours as your source is.\n");
    header
}

fn attributes(sign: &str) -> String {
    let mut text = format!("{sign}[forbid(unsafe_code)]\n");
    for (reason, lints) in ALLOWED {
        if let [lint] = lints {
            text.push_str(&format!("{sign}[allow({lint}, reason = \"{reason}\")]\n"));
            continue;
        }
        text.push_str(&format!("{sign}[allow(\n"));
        for lint in *lints {
            text.push_str(&format!("    {lint},\n"));
        }
        text.push_str(&format!("    reason = \"{reason}\"\n)]\n"));
    }
    text
}
