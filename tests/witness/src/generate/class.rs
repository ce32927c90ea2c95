//! Blocks as classes: heirs that override methods, properties, and an interface.
//!
//! A method that an heir overrides calls only what is written before it, as the overridden one did: otherwise
//! programs would be recursive, and refused.

use super::Writer;
use super::call::{Routine, Section};
use super::scope::Variable;
use super::types::Ty;

/// The method that the interface has.
const INTERFACE_METHOD: usize = 0;

impl Writer {
    pub(super) fn block_type(&mut self) {
        let number = self.blocks.len();
        let name = format!("Blk{number}");
        self.blank();
        self.tainted = false;
        let base = (number > 0 && self.random.once_in(2)).then(|| self.random.below(number));
        self.is_heir = base.is_some();
        let has_interface = number == 0 && self.refers && self.random.once_in(2);
        // It may call what comes after it.
        let copier = (self.codesys && self.random.once_in(2)).then(|| format!("Copy{number}"));
        self.functions.extend(copier.iter().map(|it| Routine::new(it.clone(), Some(Ty::Number(1)), Vec::new())));
        let head = match base {
            Some(base) => format!(" EXTENDS Blk{base}"),
            None if has_interface => " IMPLEMENTS IDo".to_owned(),
            None => String::new(),
        };
        let above = base.map(|it| self.blocks[it].clone());
        let is_after_init = above.as_ref().map_or(self.codesys && self.random.once_in(4), |it| it.is_after_init);
        if is_after_init {
            self.line("{attribute 'call_after_init'}");
        }
        self.line(&format!("FUNCTION_BLOCK {name}{head}"));
        let level = above.as_ref().map_or(0, |it| it.level + 1);
        let prefix = "h".repeat(level);
        let mut parameters = above.as_ref().map(|it| it.parameters.clone()).unwrap_or_default();
        let inherited = above.as_ref().map(|it| it.state.clone()).unwrap_or_default();
        let before = self.scope.len();
        inherited.into_iter().for_each(|it| self.scope.add(it));
        self.scope.add_in_outs(&parameters);
        let mut added = self.new_parameters(&prefix, false);
        // A call through the base does not know in-outs of an heir.
        added.retain(|it| it.section != Section::InOut || level == 0);
        self.edges = true;
        self.declare_sections(&added, true);
        self.edges = false;
        parameters.extend(added);
        self.locals("VAR", &format!("{prefix}l"), 2);
        self.line("VAR");
        for at in 0..self.random.below(3) {
            let ty = if number > 0 && self.random.once_in(2) { Ty::Instance(0) } else { self.standard_type() };
            let variable = self.declare(&format!("{prefix}b{at}"), ty);
            self.scope.add(variable);
        }
        self.line("END_VAR");
        let state = self.scope.without(|it| parameters.iter().any(|p| p.section == Section::InOut && p.name == it));
        let kept = state.from(before);
        if self.random.once_in(3) {
            self.locals("VAR_TEMP", &format!("{prefix}t"), 1);
        }
        self.loop_prefix = prefix;
        self.loop_variables();
        let loop_prefix = std::mem::take(&mut self.loop_prefix);
        let whole = std::mem::replace(&mut self.scope, state);
        self.properties(above.as_ref());
        let above_methods = above.as_ref().map(|it| it.methods.clone()).unwrap_or_default();
        for (at, method) in above_methods.iter().enumerate() {
            self.above = above_methods[..=at].to_vec();
            if self.random.once_in(2) { self.method(method.clone()) } else { self.own.methods.push(method.clone()) }
        }
        let least = usize::from(has_interface);
        for _ in 0..self.random.below(3).max(least) {
            let routine = self.new_method();
            self.method(routine);
        }
        self.above = Vec::new();
        self.own.init = above.as_ref().and_then(|it| it.init.clone());
        if self.codesys && self.random.once_in(2) {
            self.initializer(number);
        }
        if is_after_init {
            self.after_init();
        }
        self.loop_prefix = loop_prefix;
        self.own.actions = above.as_ref().map(|it| it.actions.clone()).unwrap_or_default();
        if self.own.actions.is_empty() && self.random.once_in(3) {
            self.action();
        }
        self.scope = whole;
        self.own_properties();
        if above.is_some() && self.random.once_in(2) {
            self.line("SUPER^();");
        }
        self.statements(4);
        self.line("END_FUNCTION_BLOCK");
        self.loop_prefix.clear();
        let pins = parameters.iter().filter(|it| it.section != Section::InOut);
        let pins = pins.map(|it| (it.name.clone(), it.ty.clone(), it.section == Section::Input));
        self.types.blocks.push(pins.collect());
        self.types.properties.push(self.own.properties.clone());
        self.types.bases.push(base);
        let own = std::mem::replace(&mut self.own, Routine::new(String::new(), None, Vec::new()));
        let tainted = self.tainted || parameters.iter().any(|it| matches!(it.ty, Ty::Instance(_)));
        let block = Routine { name, parameters, level, state: kept, tainted, ..own };
        if has_interface {
            self.interface(&block.methods[INTERFACE_METHOD]);
        }
        let is_plain = block.parameters.iter().all(|it| it.section != Section::InOut)
            && block.state.iter().all(|it| self.is_copied(&it.ty));
        self.blocks.push(block);
        self.copied.push(is_plain);
        self.is_heir = false;
        if let Some(copier) = copier {
            self.copier(&copier, number);
        }
    }

    /// Whether an assignment copies what is of this type: all but a standard block.
    fn is_copied(&self, ty: &Ty) -> bool {
        match ty {
            Ty::Standard(_) => false,
            Ty::Instance(at) => self.copied[*at],
            _ => true,
        }
    }

    /// Two instances that are global, and a function that copies one to the other: also while its body runs.
    fn copier(&mut self, name: &str, number: usize) {
        let value = self.random.below(9);
        if !self.copied[number] {
            self.line(&format!("FUNCTION {name} : INT {name} := {value}; END_FUNCTION"));
            return;
        }
        let [to, from] = ["c", "d"].map(|it| format!("{it}{number}"));
        self.line(&format!("VAR_GLOBAL {to}, {from} : Blk{number}; END_VAR"));
        self.line(&format!("FUNCTION {name} : INT {to} := {from}; {name} := {value}; END_FUNCTION"));
        let ty = Ty::Instance(number);
        let variables = [&to, &from].map(|it| Variable {
            name: it.clone(),
            ty: ty.clone(),
            writable: true,
            lasts: true,
            located: false,
        });
        self.copies.extend(variables);
    }

    fn new_method(&mut self) -> Routine {
        let name = format!("Do{}", self.own.methods.len());
        let result = self.result_type();
        let parameters = self.new_parameters("m", true);
        Routine::new(name, Some(result), parameters)
    }

    /// A method of the block that is being written. It sees what instances keep.
    fn method(&mut self, routine: Routine) {
        let Some(result) = routine.result.clone() else { return };
        let name = &routine.name;
        let shown = self.types.name(&result);
        self.line(&format!("METHOD {name} : {shown}"));
        let outer = self.scope.clone();
        self.own_properties();
        self.declare_parameters(&routine.parameters);
        self.locals("VAR", "ml", 1);
        if self.random.once_in(4) {
            self.locals("VAR_STAT", "ms", 1);
        }
        self.scope.add(Variable {
            name: name.clone(),
            ty: result.clone(),
            writable: true,
            lasts: false,
            located: false,
        });
        self.body(2);
        let value = self.expression(&result, 2);
        self.line(&format!("{name} := {value};"));
        self.line("END_METHOD");
        self.scope = outer;
        self.restart_loops();
        self.own.methods.push(routine);
    }

    /// PROPERTYs: those above may be overridden.
    fn properties(&mut self, above: Option<&Routine>) {
        let above = above.map(|it| it.properties.clone()).unwrap_or_default();
        let found = above.len();
        for (name, ty) in above {
            if self.random.once_in(2) {
                self.property(name, ty);
            } else {
                self.own.properties.push((name, ty));
            }
        }
        for at in found..found + self.random.below(2) {
            let ty = match self.random.below(4) {
                0 => Ty::Bool,
                1 => Ty::Text(5),
                _ => Ty::Number(*self.random.one_of(&[0, 1, 2, 4])),
            };
            self.property(format!("Prop{at}"), ty);
        }
    }

    fn property(&mut self, name: String, ty: Ty) {
        let outer = self.scope.clone();
        let shown = self.types.name(&ty);
        self.line(&format!("PROPERTY {name} : {shown}"));
        self.line("GET");
        self.body(1);
        let value = self.expression(&ty, 2);
        self.line(&format!("{name} := {value};"));
        self.line("END_GET");
        self.restart_loops();
        self.line("SET");
        self.scope.add(Variable { name: name.clone(), ty: ty.clone(), writable: false, lasts: false, located: false });
        self.body(2);
        self.line("END_SET");
        self.line("END_PROPERTY");
        self.restart_loops();
        self.scope = outer;
        self.own.properties.push((name, ty));
    }

    /// The block's own PROPERTYs may be read by their names.
    fn own_properties(&mut self) {
        for (name, ty) in self.own.properties.clone() {
            self.scope.add(Variable { name, ty, writable: false, lasts: false, located: false });
        }
    }

    fn interface(&mut self, method: &Routine) {
        let Some(result) = &method.result else { return };
        let shown = self.types.name(result);
        self.line("INTERFACE IDo");
        self.line(&format!("METHOD {} : {shown}", method.name));
        self.declare_parameters(&method.parameters);
        self.line("END_METHOD");
        self.line("END_INTERFACE");
        self.interface_method = Some(method.clone());
    }

    /// `fb.Prop := x;`
    pub(super) fn assign_property(&mut self) {
        if self.random.once_in(3)
            && let Some((name, ty)) = self.own.properties.first().cloned()
        {
            let value = self.expression(&ty, 2);
            let this = *self.random.one_of(&["", "THIS^."]);
            return self.line(&format!("{this}{name} := {value};"));
        }
        let has = |this: &Self, ty: &Ty| match ty {
            Ty::Instance(at) => this.types.properties.get(*at).is_some_and(|it| !it.is_empty()) && this.may_call(*at),
            _ => false,
        };
        let Some((place, Ty::Instance(at))) = self.some_place(true, 2, has) else { return };
        let (name, ty) = self.random.one_of(&self.types.properties[at].clone()).clone();
        let value = self.expression(&ty, 2);
        self.line(&format!("{place}.{name} := {value};"));
    }

    /// Whether calls of this block lead to no heir that is being written.
    pub(super) fn may_call(&self, block: usize) -> bool {
        !self.is_heir || self.blocks.get(block).is_some_and(|it| !it.tainted)
    }

    /// An instance, or a variable of the interface.
    pub(super) fn implementer(&mut self, depth: usize) -> String {
        let place = match self.random.below(8) {
            0 => self.some_place(false, depth, |_, it| *it == Ty::Interface),
            _ => self.some_place(true, depth, |this, it| matches!(it, Ty::Instance(at) if this.types.is_heir(*at, 0))),
        };
        place.map_or_else(|| "NULL".to_owned(), |it| it.0)
    }
}
