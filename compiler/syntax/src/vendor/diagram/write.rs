//! The statements of a diagram. What takes a value is written in the order of execution; before it, what its value comes from and
//! was not executed yet. Results of functions are kept in variables, as they are where a wire comes back to what was executed
//! before: it carries what the last scan left.

mod call;

use super::super::assembly::text;
use super::super::assembly::{Chunk, Trouble};
use super::super::unit::length_of_text;
use super::context::{Context, Names, Rules};
use super::declared::is_standard_block;
use super::expression::{Expression, LONGEST};
use super::functions::is_function;
use super::node::{Diagram, Edge, Kind, Modifier, Name, Node, Storage, Wire};
use super::order::in_order;
use super::types::Types;
use core::ops::Range;
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// No diagram has as many elements in a row.
const DEEPEST: usize = 500;

/// Why a diagram is refused, and where.
#[derive(Debug)]
pub struct Refusal {
    pub place: Range<usize>,
    pub trouble: Trouble,
    pub message: String,
}

type Of<T> = Result<T, Refusal>;

/// Variables that a diagram needs, with their types.
pub type Variables = Vec<(String, String)>;

/// What a diagram becomes.
#[derive(Debug, Default)]
pub struct Written {
    pub statements: Vec<Chunk>,
    pub variables: Variables,
    /// The elements in the order of execution, with the statements of each.
    pub groups: Vec<(usize, Range<usize>)>,
}

/// What a wire carries, after these statements.
type Value = (Rc<Expression>, Vec<Chunk>);

/// How a value is asked for.
#[derive(Clone, Copy, Default)]
struct Asked {
    /// What has a place in the order of execution is not executed before it.
    ordered: bool,
    /// By a VAR_IN_OUT, which takes a variable.
    in_out: bool,
}

/// The outputs that wires come from, in order, and whether these were executed for that.
type Sources = (Vec<(usize, usize)>, bool);

pub struct Writer<'w> {
    file: &'w str,
    diagram: &'w Diagram,
    types: &'w Types<'w>,
    context: Context<'w>,
    names: &'w mut Names,
    written: Written,
    executed: FxHashSet<usize>,
    connectors: FxHashMap<String, Rc<Expression>>,
    /// What wires carry, up to the next call.
    carried: FxHashMap<Sources, Rc<Expression>>,
    /// The outputs that wires come from.
    wired: FxHashSet<(usize, usize)>,
    /// What is being found.
    open: FxHashSet<usize>,
    depth: usize,
}

impl<'w> Writer<'w> {
    pub fn new(
        file: &'w str,
        diagram: &'w Diagram,
        types: &'w Types<'w>,
        context: Context<'w>,
        names: &'w mut Names,
    ) -> Self {
        let wires = diagram.nodes.iter().flat_map(|it| it.inputs.iter().flat_map(|it| &it.wires));
        let wired = wires.filter_map(|it| {
            let at = types.node(&it.from)?;
            Some((at, diagram.nodes[at].output(it)?))
        });
        Self {
            wired: wired.collect(),
            file,
            diagram,
            types,
            context,
            names,
            written: Written::default(),
            executed: FxHashSet::default(),
            connectors: FxHashMap::default(),
            carried: FxHashMap::default(),
            open: FxHashSet::default(),
            depth: 0,
        }
    }

    pub fn run(mut self) -> Of<Written> {
        let refused = self.diagram.nodes.iter().find_map(|it| match it.kind {
            Kind::Refused(what) => Some((it, what)),
            Kind::LeftRail
            | Kind::RightRail
            | Kind::Source(_)
            | Kind::Sink(_)
            | Kind::Both(_)
            | Kind::Contact(_)
            | Kind::Coil(_)
            | Kind::Block { .. }
            | Kind::Connector(_)
            | Kind::Continuation(_) => None,
        });
        if let Some((node, what)) = refused {
            return Err(refuse(node, Trouble::NotSupported, format!("{what} in a diagram is not supported")));
        }
        self.check_elements()?;
        for at in in_order(self.diagram, self.context.rules) {
            self.carried.clear();
            let start = self.written.statements.len();
            self.element(at)?;
            self.written.groups.push((at, start..self.written.statements.len()));
        }
        Ok(self.written)
    }

    /// What wires carry that a condition is made of, each with the statements that find it: nothing else of the diagram is executed. With
    /// the variables that these need.
    pub fn values(mut self, wired: &[&'w [Wire]]) -> Of<(Vec<Value>, Variables)> {
        self.check_elements()?;
        let mut values = Vec::with_capacity(wired.len());
        for wires in wired {
            let value = self.value(wires, Asked::default())?.unwrap_or_else(Expression::always);
            values.push((value, std::mem::take(&mut self.written.statements)));
        }
        Ok((values, self.written.variables))
    }

    /// What no editor draws: two elements with one number, a text that is not one expression, an instance in a block of another type.
    fn check_elements(&self) -> Of<()> {
        let mut seen = FxHashSet::default();
        for node in &self.diagram.nodes {
            if !seen.insert(node.id.as_str()) {
                return Err(refuse(node, Trouble::Odd, format!("another element has the localId `{}`, too", node.id)));
            }
            let written = node.expression().map(|it| text(self.file, it));
            match written.as_deref() {
                Some("") if !self.context.is_codesys() => {
                    return Err(refuse(node, Trouble::Odd, "this element does not name a variable".to_owned()));
                }
                Some(written) if !is_one_expression(written) => {
                    return Err(refuse(node, Trouble::Odd, format!("`{written}` is not an expression")));
                }
                Some(_) | None => {}
            }
            if let Kind::Block { ty, instance: None } = &node.kind
                && is_standard_block(&ty.text)
                && !self.context.has_function(&ty.text)
            {
                return Err(refuse(node, Trouble::Odd, format!("this `{}` has no instance name", ty.text)));
            }
            if let Kind::Block { ty, instance: Some(instance) } = &node.kind
                && let Some(declared) = self.context.declared.variable(self.context.pou, &instance.text)
                && !declared.eq_ignore_ascii_case(&ty.text)
            {
                let message =
                    format!("this block is a `{}`, but `{}` is declared as `{declared}`", ty.text, instance.text);
                return Err(refuse(node, Trouble::Odd, message));
            }
        }
        Ok(())
    }

    fn element(&mut self, at: usize) -> Of<()> {
        let node = &self.diagram.nodes[at];
        match &node.kind {
            Kind::Sink(target) | Kind::Both(target) => self.assignment(node, target),
            Kind::Coil(target) => self.coil(node, target),
            Kind::Block { .. } => self.execute(at, Asked::default()),
            Kind::Connector(name) => self.connector(name, node, Asked::default()).map(|_| ()),
            Kind::LeftRail
            | Kind::RightRail
            | Kind::Source(_)
            | Kind::Contact(_)
            | Kind::Continuation(_)
            | Kind::Refused(_) => Ok(()),
        }
    }

    fn wires_of(node: &Node) -> &[Wire] {
        node.inputs.first().map_or(&[], |it| it.wires.as_slice())
    }

    fn assignment(&mut self, node: &'w Node, target: &[Chunk]) -> Of<()> {
        let wires = Self::wires_of(node);
        let Some(value) = self.value(wires, Asked::default())? else { return Ok(()) };
        let value = if node.modifier.negated { Expression::not(value) } else { value };
        let enabled = self.enabled(wires);
        let statement = |writer: &mut Self| writer.assign(node, target, &value);
        match enabled {
            Some(enabled) => {
                self.words(&format!("IF {enabled} THEN\n    "), node);
                statement(self);
                self.words("END_IF;\n", node);
            }
            None => statement(self),
        }
        Ok(())
    }

    /// ENO of the block that the only wire comes from, if EN decides whether it is executed.
    fn enabled(&self, wires: &[Wire]) -> Option<String> {
        let [wire] = wires else { return None };
        let at = self.types.node(&wire.from)?;
        let node = &self.diagram.nodes[at];
        match &node.kind {
            Kind::Block { ty, instance } if node.has_enable() => Some(self.kept_in(ty, instance.as_ref(), node, "ENO")),
            _ => None,
        }
    }

    fn coil(&mut self, node: &'w Node, target: &[Chunk]) -> Of<()> {
        let Some(value) = self.value(Self::wires_of(node), Asked::default())? else { return Ok(()) };
        match node.modifier {
            Modifier { negated: false, storage: Some(storage), .. } => {
                self.words("IF ", node);
                value.write(&node.place, &mut self.written.statements);
                self.words(" THEN\n    ", node);
                let to = match storage {
                    Storage::Set => "TRUE",
                    Storage::Reset => "FALSE",
                };
                self.assign(node, target, &Expression::name(to, &node.place));
                self.words("END_IF;\n", node);
            }
            modifier => {
                let value = self.modified(node, modifier, value);
                self.assign(node, target, &value);
            }
        }
        Ok(())
    }

    fn assign(&mut self, node: &Node, target: &[Chunk], value: &Expression) {
        self.written.statements.extend(target.iter().cloned());
        self.words(" := ", node);
        value.write(&node.place, &mut self.written.statements);
        self.words(";\n", node);
    }

    fn words(&mut self, words: &str, node: &Node) {
        self.written.statements.push(Chunk::words(words, &node.place));
    }

    /// A value after the sign at a pin, a contact or a coil.
    fn modified(&mut self, node: &Node, modifier: Modifier, value: Rc<Expression>) -> Rc<Expression> {
        match modifier {
            Modifier { negated: true, .. } => Expression::not(value),
            Modifier { edge: Some(edge), .. } => {
                let ty = match edge {
                    Edge::Rising => "R_TRIG",
                    Edge::Falling => "F_TRIG",
                };
                let name = self.names.free(ty, self.context);
                self.written.variables.push((name.clone(), ty.to_owned()));
                self.words(&format!("{name}(CLK := "), node);
                value.write(&node.place, &mut self.written.statements);
                self.words(");\n", node);
                Expression::name(&format!("{name}.Q"), &node.place)
            }
            Modifier { negated: false, edge: None, .. } => value,
        }
    }

    /// What wires to one pin carry, if there are any.
    fn value(&mut self, wires: &'w [Wire], asked: Asked) -> Of<Option<Rc<Expression>>> {
        if wires.is_empty() {
            return Ok(None);
        }
        let mut from = Vec::with_capacity(wires.len());
        for wire in wires {
            from.push(self.source(wire)?);
        }
        let mut pins = from.clone();
        pins.sort_unstable();
        let key = (pins, asked.ordered);
        if let Some(known) = self.carried.get(&key).filter(|_| !asked.in_out) {
            return Ok(Some(known.clone()));
        }
        let Some(first) = wires.first() else { return Ok(None) };
        self.depth += 1;
        if self.depth > DEEPEST {
            let message = format!("more than {DEEPEST} elements are wired in a row");
            return Err(Refusal { place: first.place.clone(), trouble: Trouble::NotSupported, message });
        }
        let value = self.parallel(wires, &from, asked);
        self.depth -= 1;
        let value = value?;
        if value.length > LONGEST {
            let message = format!("what this wire carries takes more than {LONGEST} characters as an expression");
            return Err(Refusal { place: first.place.clone(), trouble: Trouble::NotSupported, message });
        }
        self.carried.insert(key, value.clone());
        Ok(Some(value))
    }

    /// The element and the output that a wire comes from.
    fn source(&self, wire: &Wire) -> Of<(usize, usize)> {
        let refuse = |message: String| Refusal { place: wire.place.clone(), trouble: Trouble::Odd, message };
        let at = self.types.node(&wire.from);
        let at =
            at.ok_or_else(|| refuse(format!("this wire comes from element {}, which does not exist", wire.from)))?;
        let node = &self.diagram.nodes[at];
        match (&node.kind, node.output(wire)) {
            (Kind::Block { ty, .. }, None) => Err(refuse(match wire.formal.as_deref() {
                Some(output) => {
                    format!("this wire comes from an output `{output}` that `{}` does not have", ty.text)
                }
                None => format!("this wire does not say from which output of `{}` it comes", ty.text),
            })),
            (_, output) => Ok((at, output.unwrap_or(0))),
        }
    }

    /// One of several wires is TRUE. Contacts in parallel that are fed by the same share that.
    fn parallel(&mut self, wires: &'w [Wire], from: &[(usize, usize)], asked: Asked) -> Of<Rc<Expression>> {
        let mut paths: Vec<(Vec<Rc<Expression>>, Rc<Expression>)> = Vec::new();
        for (wire, (at, output)) in wires.iter().zip(from) {
            let (own, fed_by) = self.path(*at, *output, wire, asked)?;
            match paths.iter_mut().find(|it| Rc::ptr_eq(&it.1, &fed_by)) {
                Some(path) => path.0.push(own),
                None => paths.push((vec![own], fed_by)),
            }
        }
        let joined = paths.into_iter().map(|(own, fed_by)| Expression::all(vec![fed_by, Expression::any(own)]));
        Ok(Expression::any(joined.collect()))
    }

    /// What an element gives a wire, and what it is fed by, if it only lets that through.
    fn path(&mut self, at: usize, output: usize, wire: &Wire, asked: Asked) -> Of<(Rc<Expression>, Rc<Expression>)> {
        let node = &self.diagram.nodes[at];
        let alone = |value| (value, Expression::always());
        Ok(match &node.kind {
            Kind::LeftRail => alone(Expression::always()),
            Kind::Source(written) | Kind::Both(written) => {
                let value = Expression::written(self.file, written.clone());
                alone(if node.modifier.negated { Expression::not(value) } else { value })
            }
            Kind::Contact(written) => {
                let own = Expression::written(self.file, written.clone());
                let own = self.modified(node, node.modifier, own);
                (own, self.fed(at, asked)?)
            }
            Kind::Coil(_) if self.context.rules != Rules::Beremiz => alone(self.fed(at, asked)?),
            // The editors join the wires to a coil by AND where something is wired to its right.
            Kind::Coil(_) => {
                let mut parts = Vec::new();
                for wire in Self::wires_of(node) {
                    parts.push(self.fed_by(at, std::slice::from_ref(wire), asked)?);
                }
                match parts.is_empty() {
                    true => alone(self.fed(at, asked)?),
                    false => alone(Expression::all(parts)),
                }
            }
            Kind::Block { .. } => alone(self.output(at, output, asked)?),
            Kind::Continuation(name) => {
                let is_its = |it: &&Node| matches!(&it.kind, Kind::Connector(other) if other == name);
                let mut found = self.diagram.nodes.iter().filter(is_its);
                let connector = found.next().filter(|_| found.next().is_none());
                let message = || format!("the continuation `{name}` needs exactly one connector `{name}`");
                let connector = connector.ok_or_else(|| refuse(node, Trouble::Odd, message()))?;
                self.enter(at)?;
                let value = self.connector(name, connector, asked)?;
                self.open.remove(&at);
                alone(value.ok_or_else(|| {
                    refuse(connector, Trouble::Odd, format!("nothing is wired to the connector `{name}`"))
                })?)
            }
            Kind::Sink(_) | Kind::RightRail | Kind::Connector(_) | Kind::Refused(_) => {
                let message = "this wire comes from an element without an output".to_owned();
                return Err(Refusal { place: wire.place.clone(), trouble: Trouble::Odd, message });
            }
        })
    }

    /// What feeds a contact or a coil.
    fn fed(&mut self, at: usize, asked: Asked) -> Of<Rc<Expression>> {
        self.fed_by(at, Self::wires_of(&self.diagram.nodes[at]), asked)
    }

    fn fed_by(&mut self, at: usize, wires: &'w [Wire], asked: Asked) -> Of<Rc<Expression>> {
        let node = &self.diagram.nodes[at];
        self.enter(at)?;
        let value = self.value(wires, Asked { in_out: false, ..asked })?;
        self.open.remove(&at);
        let name = node.expression().map(|it| text(self.file, it)).unwrap_or_default();
        value.ok_or_else(|| refuse(node, Trouble::Odd, format!("nothing is wired to `{name}` from the left")))
    }

    fn enter(&mut self, at: usize) -> Of<()> {
        let node = &self.diagram.nodes[at];
        match self.open.insert(at) {
            true => Ok(()),
            false => Err(refuse(node, Trouble::Odd, "this element is wired back to itself in a loop".to_owned())),
        }
    }

    fn connector(&mut self, name: &str, node: &'w Node, asked: Asked) -> Of<Option<Rc<Expression>>> {
        if let Some(known) = self.connectors.get(name) {
            return Ok(Some(known.clone()));
        }
        let value = self.value(Self::wires_of(node), Asked { in_out: false, ..asked })?;
        if let Some(value) = &value {
            self.connectors.insert(name.to_owned(), value.clone());
        }
        Ok(value)
    }

    /// An output of a block, which is executed before if it was not yet.
    fn output(&mut self, at: usize, output: usize, asked: Asked) -> Of<Rc<Expression>> {
        self.execute(at, asked)?;
        let node = &self.diagram.nodes[at];
        let Kind::Block { ty, instance } = &node.kind else { return Ok(Expression::always()) };
        let Some(pin) = node.outputs.get(output) else { return Ok(Expression::always()) };
        let asked_of_input = Asked { ordered: node.order > 0, in_out: true };
        let value = match instance {
            // What it takes is what it gives back.
            _ if node.is_in_out(&pin.formal) => {
                let wires = node.input(&pin.formal).map_or(&[][..], |it| it.wires.as_slice());
                let value = self.value(wires, asked_of_input)?;
                return value
                    .ok_or_else(|| refuse(node, Trouble::Odd, format!("nothing is wired to `{}`", pin.formal)));
            }
            Some(_) if pin.formal.eq_ignore_ascii_case("ENO") => match node.has_enable() {
                true => Expression::name(&self.kept_in(ty, instance.as_ref(), node, "ENO"), &node.place),
                false => Expression::always(),
            },
            Some(instance) => Expression::name(&format!("{}.{}", instance.text, pin.formal), &node.place),
            None => Expression::name(&self.kept_in(ty, None, node, &pin.formal), &node.place),
        };
        let value = self.modified(node, pin.modifier, value);
        match instance {
            Some(instance) if asked.in_out => {
                self.kept(at, output, &format!("{}_{}", instance.text, pin.formal), value)
            }
            Some(_) | None => Ok(value),
        }
    }

    /// A variable that has an output, for a VAR_IN_OUT to take.
    fn kept(&mut self, at: usize, output: usize, name: &str, value: Rc<Expression>) -> Of<Rc<Expression>> {
        let node = &self.diagram.nodes[at];
        if !self.written.variables.iter().any(|it| it.0 == name) {
            let ty = self.type_of(at, output)?;
            self.written.variables.push((name.to_owned(), ty));
            self.assign(node, &[Chunk::words(name, &node.place)], &value);
        }
        Ok(Expression::name(name, &node.place))
    }

    fn type_of(&self, at: usize, output: usize) -> Of<String> {
        let node = &self.diagram.nodes[at];
        let known = self.types.output(at, output).filter(|it| !it.starts_with("ANY"));
        known.map(ToOwned::to_owned).ok_or_else(|| {
            let pin = &node.outputs[output].formal;
            let message = match &node.kind {
                Kind::Block { ty, instance: None }
                    if !is_function(&ty.text) && !self.context.has_function(&ty.text) =>
                {
                    format!("`{}` is not a standard function, and the project does not declare it", ty.text)
                }
                _ => format!("nothing that is wired to {} says what type `{pin}` is of", node.shown(self.file)),
            };
            refuse(node, Trouble::Odd, message)
        })
    }

    /// The variable that keeps an output of a function, or ENO of an instance. The numbers of an action's elements are its own.
    fn kept_in(&self, ty: &Name, instance: Option<&Name>, node: &Node, formal: &str) -> String {
        let (ty, number) = (&ty.text, &node.number);
        let action = match self.context.action {
            "" => String::new(),
            action => format!("{action}_"),
        };
        match (instance, formal) {
            (Some(instance), _) => format!("_TMP_{}_{formal}", instance.text),
            (None, "") => format!("{action}{ty}{number}"),
            (None, _) => format!("_TMP_{action}{ty}{number}_{formal}"),
        }
    }
}

/// Whether a text can be no more than one expression: it would be pasted among others.
pub fn is_one_expression(written: &str) -> bool {
    let mut depth = 0_usize;
    let mut rest = written;
    while let Some(first) = rest.chars().next() {
        if let '\'' | '"' = first {
            let length = 1 + length_of_text(&rest.as_bytes()[1..], rest.as_bytes()[0]);
            rest = rest.get(length..).unwrap_or_default();
            continue;
        }
        let is_more = first == ';' || ["(*", "*)", "//", "/*", ":="].iter().any(|it| rest.starts_with(it));
        match first {
            _ if is_more => return false,
            '(' => depth += 1,
            ')' if depth == 0 => return false,
            ')' => depth -= 1,
            _ => {}
        }
        rest = &rest[first.len_utf8()..];
    }
    depth == 0
}

fn refuse(node: &Node, trouble: Trouble, message: String) -> Refusal {
    Refusal { place: node.place.clone(), trouble, message }
}
