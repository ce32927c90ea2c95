//! Functions: signatures, locals, and how they end.

use std::collections::HashMap;

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use staunch_ir::effects::Effects;
use staunch_ir::{Block, Class, ClassKind, LocalId, Mode, Place, Routine, RoutineId, RoutineKind, StatementKind};

use crate::declare::{Declaration, Plan, plan};
use crate::emitter::Emitter;
use crate::loop_state::{HoistedIndex, Loops};
use crate::names::{LocalNames, ident};

/// One function being printed.
pub struct Function<'a> {
    pub emitter: &'a Emitter<'a>,
    pub routine: &'a Routine,
    pub names: LocalNames,
    pub plan: Plan,
    /// For each local, whether a call gets a reference to it.
    pub borrowed: Vec<bool>,
    /// It returns a `Result`.
    pub faults: bool,
    pub loops: Loops,
    /// How many closures of statements whose faults are handled are around.
    pub attempts: usize,
    /// How many closures of statements after which others come in any case are around.
    pub endings: usize,
    /// Variables that the loops around have copied, innermost last.
    pub counters: Vec<(Place, Ident)>,
    /// The names of those copies, by what they copy.
    pub counter_names: HashMap<String, Ident>,
    /// Subscripts that the loops around have found, innermost last.
    pub hoisted_indices: Vec<HoistedIndex>,
    /// The line last marked.
    pub marked: Option<(u16, u32)>,
}

/// What a function of a POU is to the Rust reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A PROGRAM's or FUNCTION_BLOCK's method; its signature does not depend on its body.
    Scan,
    Prescan,
    /// A METHOD or ACTION.
    Method,
    Free,
}

impl<'a> Emitter<'a> {
    /// The method or function of a routine.
    pub fn routine(&self, id: RoutineId) -> TokenStream {
        let routine = self.program.routine(id);
        let needs = &self.effects[id.index()];
        let role = match routine.kind {
            RoutineKind::Function => Role::Free,
            RoutineKind::Body => Role::Scan,
            RoutineKind::Prescan => Role::Prescan,
            RoutineKind::Method => Role::Method,
        };
        let mut function = self.function(routine, needs, role == Role::Scan || needs.faults);
        let before = self.first_scan(id);
        let body = function.body(&routine.body);
        let signature = function.signature(self.names.routine(id), needs, role);
        let docs = self.scan_docs(id, role);
        quote!(#docs #signature { #before #body })
    }

    /// The start of a PROGRAM's scan, where it has a prescan.
    fn first_scan(&self, id: RoutineId) -> Option<TokenStream> {
        let is_it = |it: &&Class| it.body == id && it.kind == ClassKind::Program;
        let prescan = self.program.classes.iter().find(is_it)?.prescan?;
        let (needs, name) = (&self.effects[prescan.index()], self.names.routine(prescan));
        let arguments = self.extra_arguments(needs);
        let propagate = needs.faults.then(|| quote!(?));
        Some(quote!(if cx.first_scan { self.#name(#(#arguments),*) #propagate; }))
    }

    /// The context and the globals, where a callee wants them.
    fn extra_arguments(&self, needs: &Effects) -> Vec<TokenStream> {
        let context = needs.context.then(|| quote!(cx));
        context.into_iter().chain(self.world_argument(needs)).collect()
    }

    /// The globals, where a callee wants them, or the whole machine.
    pub fn world_argument(&self, needs: &Effects) -> Option<TokenStream> {
        if self.shared {
            return Some(quote!(machine));
        }
        needs.uses_globals().then(|| quote!(globals))
    }

    fn function<'b>(&'b self, routine: &'b Routine, needs: &Effects, faults: bool) -> Function<'b> {
        let (names, plan) = (self.names.locals(routine), plan(routine, &routine.body));
        Function {
            emitter: self,
            routine,
            names,
            plan,
            borrowed: needs.borrowed.clone(),
            faults,
            loops: Loops::default(),
            attempts: 0,
            endings: 0,
            counters: Vec::new(),
            counter_names: HashMap::new(),
            hoisted_indices: Vec::new(),
            marked: None,
        }
    }
}

impl Function<'_> {
    /// The context comes first and the globals last, so that arguments may read globals.
    fn signature(&self, name: &Ident, needs: &Effects, role: Role) -> TokenStream {
        let shared = self.emitter.shared;
        let receiver = (self.routine.kind != RoutineKind::Function)
            .then(|| if shared { quote!(&self) } else { quote!(&mut self) });
        let context = match (needs.context, role) {
            (true, _) => Some(quote!(cx: &Context)),
            (false, Role::Scan) => Some(quote!(_cx: &Context)),
            (false, Role::Prescan | Role::Method | Role::Free) => None,
        };
        let params = self.params();
        let globals_type = self.emitter.ty(staunch_ir::Type::Struct(self.emitter.program.globals));
        let globals = if shared {
            Some(quote!(machine: &Machine))
        } else {
            needs.uses_globals().then(|| quote!(globals: &mut #globals_type))
        };
        let all = receiver.into_iter().chain(context).chain(params).chain(globals);
        let result = self.result_type();
        quote!(pub fn #name(#(#all),*) #result)
    }

    fn params(&self) -> Vec<TokenStream> {
        let params = self.routine.params.iter().zip(&self.names.params);
        params
            .map(|(param, name)| {
                let ty = self.emitter.ty(param.ty);
                match param.mode {
                    Mode::Reference if self.emitter.shared => {
                        let stored = self.emitter.stored(param.ty);
                        quote!(#name: &#stored)
                    }
                    Mode::Reference => quote!(#name: &mut #ty),
                    Mode::Value(local) if self.is_mutable(local) => quote!(mut #name: #ty),
                    Mode::Value(_) => quote!(#name: #ty),
                }
            })
            .collect()
    }

    fn result_type(&self) -> Option<TokenStream> {
        let value = self.routine.result.map(|it| self.emitter.ty(self.routine.locals[it.index()].ty));
        match (value, self.faults) {
            (Some(ty), true) => Some(quote!(-> Result<#ty, Fault>)),
            (None, true) => Some(quote!(-> Result<(), Fault>)),
            (Some(ty), false) => Some(quote!(-> #ty)),
            (None, false) => None,
        }
    }

    fn body(&mut self, block: &Block) -> TokenStream {
        let mut block = block.as_slice();
        // What follows the body returns anyway.
        while let [before @ .., last] = block
            && matches!(last.kind, StatementKind::Return)
        {
            block = before;
        }
        let (block, tail) = self.tail(block);
        let locals = self.top_locals();
        let statements = self.statements(block);
        let end = match tail {
            Some(value) => Some(if self.faults { quote!(Ok(#value)) } else { value }),
            None => self.returned(),
        };
        let cells = self.cells();
        quote!(#cells #(#locals)* #statements #end)
    }

    /// A last assignment to the result needs no variable, where nothing else mentions it.
    fn tail<'s>(&self, block: &'s [staunch_ir::Statement]) -> (&'s [staunch_ir::Statement], Option<TokenStream>) {
        if let (Some(result), [before @ .., last]) = (self.routine.result, block)
            && let StatementKind::Assign { target, value } = &last.kind
            && self.plan.locals[result.index()].mentions == 1
            && self.plan.declares(last, target) == Some(result)
        {
            return (before, Some(self.expr(value).tokens));
        }
        (block, None)
    }

    fn top_locals(&self) -> Vec<TokenStream> {
        let locals = (0..self.routine.locals.len()).map(LocalId::next);
        let top = locals.filter(|it| self.plan.locals[it.index()].how == Declaration::Top);
        top.map(|it| {
            let local = &self.routine.locals[it.index()];
            let value = self.emitter.constant(local.ty, &local.initial).tokens;
            let value = if self.borrowed_scalar(it) { quote!(Cell::new(#value)) } else { value };
            let left = self.let_local(it);
            quote!(#left = #value;)
        })
        .collect()
    }

    /// `let mut name: type`.
    pub fn let_local(&self, id: LocalId) -> TokenStream {
        let (name, ty) = (&self.names.locals[id.index()], self.emitter.ty(self.routine.locals[id.index()].ty));
        let ty = if self.borrowed_scalar(id) { quote!(Cell<#ty>) } else { ty };
        let mutable = self.is_mutable(id).then(|| quote!(mut));
        quote!(let #mutable #name: #ty)
    }

    /// Whether the local's text has to be `mut`: what is in cells, or has them inside, does not.
    fn is_mutable(&self, id: LocalId) -> bool {
        let ty = self.routine.locals[id.index()].ty;
        let is_in_cells = self.emitter.shared && (!self.emitter.is_in_cell(ty) || self.borrowed[id.index()]);
        self.plan.locals[id.index()].mutable && !is_in_cells
    }

    /// Whether a scalar or string is in a cell, since a call gets a reference to it.
    pub fn borrowed_scalar(&self, id: LocalId) -> bool {
        self.emitter.is_in_cell(self.routine.locals[id.index()].ty) && self.borrowed[id.index()]
    }

    /// Arguments that are in cells.
    fn cells(&self) -> TokenStream {
        let params = self.routine.params.iter().zip(&self.names.params);
        let cells = params.filter_map(|(param, name)| match param.mode {
            Mode::Value(local) if self.borrowed_scalar(local) => Some(quote!(let #name = Cell::new(#name);)),
            Mode::Value(_) | Mode::Reference => None,
        });
        cells.collect()
    }

    /// What a `return` hands back.
    pub fn returned(&self) -> Option<TokenStream> {
        let value = self.routine.result.map(|it| {
            let name = &self.names.locals[it.index()];
            if self.borrowed_scalar(it) { quote!(#name.get()) } else { quote!(#name) }
        });
        match (value, self.faults) {
            (Some(value), true) => Some(quote!(Ok(#value))),
            (None, true) => Some(quote!(Ok(()))),
            (Some(value), false) => Some(quote!(#value)),
            (None, false) => None,
        }
    }

    /// A name for a variable that the printer needs, different from all of the user's.
    pub fn made_up(&self, wanted: &str, number: usize) -> Ident {
        let prefix = self.names.scope.unused_prefix(wanted);
        if number == 0 { ident(&prefix) } else { ident(&format!("{prefix}_{}", number + 1)) }
    }
}
