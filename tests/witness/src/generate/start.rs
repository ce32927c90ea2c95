//! How instances start in CODESYS: FB_init with inputs, which declarations give or leave to their defaults, initial values
//! of inputs, and a METHOD with `call_after_init`.

use super::Writer;
use super::call::{Parameter, Section};
use super::types::Ty;

impl Writer {
    /// The FB_init of the block that is being written, and what an heir's declaration gives to it.
    pub(super) fn initializer(&mut self, number: usize) {
        let mut parameters = Vec::new();
        for at in 0..1 + self.random.below(2) {
            let ty = match self.random.below(6) {
                0 => Ty::Bool,
                1 => Ty::Text(5),
                2 => Ty::Time,
                _ => Ty::Number(*self.random.one_of(&[0, 1, 1, 2])),
            };
            parameters.push(Parameter { name: format!("n{number}{at}"), ty, section: Section::Input });
        }
        let outer = self.scope.clone();
        self.line("METHOD FB_init : BOOL");
        self.line("VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR");
        self.line("VAR_INPUT");
        for it in &parameters {
            let (value, shown) = (self.literal(&it.ty), self.types.name(&it.ty));
            self.inside(|this| this.line(&format!("{} : {shown} := {value};", it.name)));
            self.scope.add(it.variable());
        }
        self.line("END_VAR");
        self.loop_variables();
        self.statements(1);
        // What it was given is seen in what the instance keeps.
        for it in &parameters {
            if let Some(place) = self.place_of(&it.ty, true, 0) {
                self.line(&format!("{place} := {};", it.name));
            }
        }
        self.line("END_METHOD");
        self.scope = outer;
        self.restart_loops();
        self.own.init = Some(parameters);
    }

    /// Runs when the values of the declaration are there.
    pub(super) fn after_init(&mut self) {
        let outer = self.scope.clone();
        self.line("{attribute 'call_after_init'}");
        self.line("METHOD Ready");
        self.loop_variables();
        self.statements(2);
        self.line("END_METHOD");
        self.scope = outer;
        self.restart_loops();
        self.own.is_after_init = true;
    }

    /// `(n0 := 5)` after the type of an instance.
    pub(super) fn construction(&mut self, ty: &Ty) -> String {
        let Ty::Instance(at) = ty else { return String::new() };
        let Some(parameters) = self.blocks.get(*at).and_then(|it| it.init.clone()) else { return String::new() };
        let by_position = self.random.once_in(2);
        let mut given = Vec::new();
        for it in &parameters {
            if !by_position && self.random.once_in(3) {
                continue;
            }
            let value = self.given_at_start(&it.ty);
            given.push(if by_position { value } else { format!("{} := {value}", it.name) });
        }
        if !by_position && self.random.once_in(2) {
            given.reverse();
        }
        if given.is_empty() { String::new() } else { format!("({})", given.join(", ")) }
    }

    /// A number, or a global variable, which another FB_init may have written.
    fn given_at_start(&mut self, ty: &Ty) -> String {
        let globals: Vec<_> =
            self.globals.iter().filter(|it| it.ty == *ty && !it.located).map(|it| it.name.clone()).collect();
        if globals.is_empty() || self.random.once_in(2) {
            self.literal(ty)
        } else {
            self.random.one_of(&globals).clone()
        }
    }

    /// ` := (i0 := 5)`
    pub(super) fn initial_inputs(&mut self, block: usize) -> String {
        let inputs = self.types.blocks[block].clone();
        let inputs = inputs.into_iter().filter(|it| it.2 && matches!(it.1, Ty::Number(_) | Ty::Text(_) | Ty::Time));
        let values: Vec<_> = inputs.map(|(name, ty, _)| format!("{name} := {}", self.literal(&ty))).collect();
        if values.is_empty() { String::new() } else { format!(" := ({})", values.join(", ")) }
    }
}
