//! The calls of blocks and functions.

use super::super::super::assembly::{Chunk, Trouble};
use super::super::expression::Expression;
use super::super::functions::has_pins_in_order;
use super::super::node::{Kind, Name, Node, Output};
use super::{Asked, Of, Writer, refuse};
use std::rc::Rc;

/// What a pin of a function is given to.
#[derive(Default)]
struct Given {
    /// Outputs by their names: `OUT2 => x`.
    parts: Vec<Vec<Chunk>>,
    /// What the result is assigned to.
    target: Option<Vec<Chunk>>,
    /// The result is in a variable, and not only where it is assigned to.
    is_kept: bool,
}

impl<'w> Writer<'w> {
    /// Writes the call of a block, once.
    pub(super) fn execute(&mut self, at: usize, asked: Asked) -> Of<()> {
        let node = &self.diagram.nodes[at];
        let Kind::Block { ty, instance } = &node.kind else { return Ok(()) };
        if asked.ordered || !self.executed.insert(at) {
            return Ok(());
        }
        // What comes back to it reads what the last scan left.
        let outer = std::mem::take(&mut self.open);
        let mut arguments = Vec::new();
        let mut enable = None;
        for input in &node.inputs {
            let in_out = node.is_in_out(&input.formal);
            let value = self.value(&input.wires, Asked { ordered: node.order > 0, in_out })?;
            let Some(value) = value else {
                if in_out {
                    return Err(refuse(node, Trouble::Odd, format!("nothing is wired to `{}`", input.formal)));
                }
                continue;
            };
            let value = self.modified(node, input.modifier, value);
            match self.context.is_codesys() && input.formal.eq_ignore_ascii_case("EN") {
                true => enable = Some(value),
                false => arguments.push((input.formal.as_str(), value)),
            }
        }
        self.open = outer;
        if let Some(enable) = enable {
            let name = self.kept_in(ty, instance.as_ref(), node, "ENO");
            self.written.variables.push((name.clone(), "BOOL".to_owned()));
            self.assign(node, &[Chunk::words(name.as_str(), &node.place)], &enable);
            self.words(&format!("IF {name} THEN\n    "), node);
            self.call(at, arguments)?;
            self.words("END_IF;\n", node);
        } else {
            self.call(at, arguments)?;
        }
        if instance.is_some() {
            self.carried.clear();
        }
        Ok(())
    }

    fn call(&mut self, at: usize, arguments: Vec<(&str, Rc<Expression>)>) -> Of<()> {
        let node = &self.diagram.nodes[at];
        let Kind::Block { ty, instance } = &node.kind else { return Ok(()) };
        let mut parts = self.inputs(node, ty, instance.is_some(), arguments)?;
        let mut given =
            if instance.is_none() { self.results(at, ty)? } else { Given { is_kept: true, ..Given::default() } };
        parts.append(&mut given.parts);
        if instance.is_some() && node.has_enable() && !self.context.is_codesys() {
            // An instance that was never called has TRUE there.
            let name = self.kept_in(ty, instance.as_ref(), node, "ENO");
            parts.push(vec![Chunk::words(format!("ENO => {name}"), &node.place)]);
            self.written.variables.push((name, "BOOL := TRUE".to_owned()));
        }
        if let Some(target) = given.target {
            self.written.statements.extend(target);
            self.words(" := ", node);
        }
        let name = instance.as_ref().unwrap_or(ty);
        self.written.statements.push(name.chunk.clone());
        self.words("(", node);
        for (at, part) in parts.into_iter().enumerate() {
            if at > 0 {
                self.words(", ", node);
            }
            self.written.statements.extend(part);
        }
        self.words(");\n", node);
        let assigned = |it: &&Output| !it.target.is_empty() && (given.is_kept || !it.is_result(&ty.text));
        for pin in node.outputs.iter().filter(assigned) {
            let value = match instance {
                Some(instance) => format!("{}.{}", instance.text, pin.formal),
                None => self.kept_in(ty, None, node, &pin.formal),
            };
            let value = Expression::name(&value, &node.place);
            let value = self.modified(node, pin.modifier, value);
            self.assign(node, &pin.target, &value);
        }
        Ok(())
    }

    /// What the inputs are given, by their names where their order does not say it.
    fn inputs(
        &self,
        node: &Node,
        ty: &Name,
        is_instance: bool,
        arguments: Vec<(&str, Rc<Expression>)>,
    ) -> Of<Vec<Vec<Chunk>>> {
        let own = |it: &str| !it.eq_ignore_ascii_case("EN");
        if !is_instance && !arguments.iter().any(|it| own(it.0)) && node.inputs.iter().any(|it| own(&it.formal)) {
            return Err(refuse(node, Trouble::Odd, format!("nothing is wired to an input of `{}`", ty.text)));
        }
        let connected = node.inputs.iter().all(|it| !it.wires.is_empty());
        // CODESYS numbers the inputs of its operators.
        let formals: Vec<&str> = node.inputs.iter().map(|it| it.formal.as_str()).filter(|it| own(it)).collect();
        let by_name = !self.context.is_codesys()
            && (node.outputs.len() > 1 || !connected || !has_pins_in_order(&ty.text, &formals));
        let is_named = is_instance || by_name || self.context.has_function(&ty.text);
        let argument = |(formal, value): (&str, Rc<Expression>)| {
            let mut part = Vec::new();
            if is_named && !formal.is_empty() {
                part.push(Chunk::words(format!("{formal} := "), &node.place));
            }
            value.write(&node.place, &mut part);
            part
        };
        Ok(arguments.into_iter().map(argument).collect())
    }

    /// The variables that keep the outputs of a function.
    fn results(&mut self, at: usize, ty: &Name) -> Of<Given> {
        let node = &self.diagram.nodes[at];
        let mut given = Given { is_kept: true, ..Given::default() };
        for (output, pin) in node.outputs.iter().enumerate() {
            let is_enable = pin.formal.eq_ignore_ascii_case("ENO");
            if node.is_in_out(&pin.formal) || self.context.is_codesys() && is_enable {
                continue;
            }
            if pin.is_result(&ty.text) && !pin.target.is_empty() && !self.wired.contains(&(at, output)) {
                given.target = Some(pin.target.clone());
                given.is_kept = false;
                continue;
            }
            let name = self.kept_in(ty, None, node, &pin.formal);
            let of_type = self.type_of(at, output)?;
            self.written.variables.push((name.clone(), of_type));
            match node.outputs.len() > 1 && !pin.is_result(&ty.text) {
                true => given.parts.push(vec![Chunk::words(format!("{} => {name}", pin.formal), &node.place)]),
                false => given.target = Some(vec![Chunk::words(name, &node.place)]),
            }
        }
        Ok(given)
    }
}
