//! Routines that choose by the class of an instance. A call by a variable of an INTERFACE, or through a reference to a
//! class with heirs, is a CASE over the classes; where these are many, one routine has it for all such calls. Nobody
//! writes it: it has a slot after the POUs, as instances of generic FUNCTIONs have.

use super::declarations::{Declarations, PouSlot, Slot};
use super::signature::Signature;
use staunch_ir::{
    Block, Const, Expr, Local, LocalId, Location, Mode, Param, ParamId, Place, Root, Routine, RoutineKind, Type,
};

/// What the CASE of such a routine works with.
pub(crate) struct Handed {
    /// The reference to the instance.
    pub pointer: Place,
    pub arguments: Vec<staunch_ir::Argument>,
    pub result: Option<Place>,
}

/// A routine while it is made.
struct Draft {
    params: Vec<Param>,
    locals: Vec<Local>,
    arguments: Vec<staunch_ir::Argument>,
}

impl<'s> Declarations<'s> {
    /// The slot of the routine that calls what is in `slot` on an instance of class `class`, or of what extends that or
    /// has that INTERFACE, to which a value of type `pointer` refers; `body` makes its statements.
    pub fn dispatch_routine(
        &mut self,
        (pointer, class, slot): (Type, Type, usize),
        body: impl FnOnce(Handed) -> Block,
    ) -> Option<usize> {
        let key = (pointer, class, slot);
        if let Some(known) = self.dispatches.get(&key) {
            return Some(*known);
        }
        let signature = self.signature(slot)?;
        let name = self.own_name(self.dispatch_name(slot));
        let location = self.location(self.pous[slot].ast.name.span);
        let called = self.title(slot);
        let mut draft = Draft { params: Vec::new(), locals: Vec::new(), arguments: Vec::new() };
        let instance = draft.value(self, "instance", pointer);
        draft.pass_on(self, &signature);
        let result = signature.result.as_ref().map(|(_, resolved)| draft.local(self, "result", resolved.ty));
        let place = |id: LocalId| Place::local(id, draft.locals[id.index()].ty);
        let handed = Handed { pointer: place(instance), arguments: draft.arguments, result: result.map(place) };
        let routine = Routine {
            kind: RoutineKind::Function,
            name,
            doc: Some(format!("Calls `{called}` of the instance's class. A null reference faults at the call.")),
            location,
            state: None,
            params: draft.params,
            locals: draft.locals.clone(),
            result,
            body: body(handed),
        };
        let made = self.pous.len();
        let ast = self.pous[slot].ast;
        // Calls of it are not checked by a signature.
        self.pous.push(PouSlot { dispatch: Some(Box::new(routine)), slot: Slot::Failed, ..PouSlot::open(ast) });
        self.dispatches.insert(key, made);
        Some(made)
    }

    /// `IValve_Open`
    fn dispatch_name(&self, slot: usize) -> String {
        match self.pous[slot].owner {
            Some(owner) => format!("{}_{}", self.emitted_name(owner), self.emitted_name(slot)),
            None => format!("call_{}", self.emitted_name(slot)),
        }
    }
}

impl Draft {
    fn local(&mut self, decl: &Declarations<'_>, name: &str, ty: Type) -> LocalId {
        let id = LocalId::next(self.locals.len());
        let initial = if decl.program.is_open(ty) { Const::Zero } else { decl.least(ty) };
        self.locals.push(Local { name: name.to_owned(), ty, initial, doc: None });
        id
    }

    fn value(&mut self, decl: &Declarations<'_>, name: &str, ty: Type) -> LocalId {
        let id = self.local(decl, name, ty);
        self.params.push(Param { name: name.to_owned(), ty, doc: None, mode: Mode::Value(id), bounds: Vec::new() });
        id
    }

    /// The parameters of what is called, which it is given as they are.
    fn pass_on(&mut self, decl: &Declarations<'_>, signature: &Signature<'_>) {
        for param in &signature.params {
            match param.mode {
                Mode::Value(_) => {
                    let id = self.value(decl, &param.name, param.ty);
                    let value = Expr::load(Place::local(id, param.ty), Location::CALLER);
                    self.arguments.push(staunch_ir::Argument::Value(value));
                }
                Mode::Reference => {
                    let place = Place::root(Root::Param(ParamId::next(self.params.len())), param.ty);
                    self.params.push(Param { bounds: Vec::new(), ..param.clone() });
                    self.arguments.push(staunch_ir::Argument::Reference(place));
                }
            }
            let mut bound = |name: &str| self.local(decl, name, Type::DINT);
            let bounds = param.bounds.iter().map(|_| (bound("low"), bound("high"))).collect();
            if let Some(own) = self.params.last_mut() {
                own.bounds = bounds;
            }
        }
    }
}
