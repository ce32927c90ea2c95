//! What may come to differ because a variable or block does: all that its value decides, through assignments,
//! conditions, calls and references. Variables are distinguished by their declarations.

use super::walked::{Name, Walked};
use staunch_ir::visit::{self, Access};
use staunch_ir::{
    Argument, FieldId, Mode, ParamId, Place, Program, Root, Routine, RoutineId, Statement, StatementKind, StructId,
    Type, reference,
};
use std::collections::{HashMap, HashSet};

/// A variable by its declaration.
pub type Declared = (StructId, FieldId);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Node {
    /// A variable, given a value as a whole.
    Whole(Name),
    /// That a part of it was.
    Part(Name),
    /// Whether, and how often, a routine's statements run.
    Run(RoutineId),
    /// What a routine hands back.
    Result(RoutineId),
    /// What references lead to.
    Referenced,
}

type Edges = HashMap<Node, HashSet<Node>>;

/// What each decides directly.
#[derive(Debug, Default)]
pub struct Dependencies {
    decides: Edges,
}

impl Dependencies {
    pub fn of(program: &Program) -> Self {
        let mut found = Self::default();
        for (at, structure) in program.structs.iter().enumerate() {
            for (number, field) in structure.fields.iter().enumerate() {
                let whole = Name::Field(StructId::next(at), FieldId::next(number));
                found.members(program, whole, field.ty);
            }
        }
        for (owner, field) in reference::reached(program) {
            let name = Name::Field(owner, field);
            found.add(Node::Whole(name), Node::Referenced);
            found.add(Node::Part(name), Node::Referenced);
            found.add(Node::Referenced, Node::Whole(name));
        }
        for (at, routine) in program.routines.iter().enumerate() {
            let id = RoutineId::next(at);
            for (number, param) in routine.params.iter().enumerate() {
                if let Mode::Value(local) = param.mode {
                    // The routine reads its own copy.
                    let name = Name::Param(id, ParamId::next(number));
                    found.add(Node::Whole(name), Node::Whole(Name::Local(id, local)));
                }
            }
            let mut walk = Walk { program, routine, id, found: &mut found };
            walk.block(&routine.body, &[]);
        }
        found
    }

    /// The fields whose values may follow from that of one.
    pub fn follow(&self, start: (StructId, FieldId)) -> HashSet<(StructId, FieldId)> {
        self.follow_past(start, &HashSet::new())
    }

    /// Those that follow without going through any of `others`.
    pub fn follow_past(
        &self,
        (owner, field): (StructId, FieldId),
        others: &HashSet<(StructId, FieldId)>,
    ) -> HashSet<(StructId, FieldId)> {
        let start = Name::Field(owner, field);
        let is_other = |node: &Node| match node {
            Node::Whole(Name::Field(owner, field)) | Node::Part(Name::Field(owner, field)) => {
                others.contains(&(*owner, *field))
            }
            Node::Whole(_) | Node::Part(_) | Node::Run(_) | Node::Result(_) | Node::Referenced => false,
        };
        let seen = reached(&self.decides, vec![Node::Whole(start), Node::Part(start)], |it| !is_other(it));
        let fields = seen.into_iter().filter_map(|it| match it {
            Node::Whole(Name::Field(owner, field)) => Some((owner, field)),
            Node::Whole(_) | Node::Part(_) | Node::Run(_) | Node::Result(_) | Node::Referenced => None,
        });
        fields.collect()
    }

    /// The fields that may decide the value of one of these, themselves among them.
    pub fn deciding(&self, of: &[Declared]) -> HashSet<Declared> {
        let mut decided_by = Edges::default();
        for (from, all) in &self.decides {
            all.iter().for_each(|to| _ = decided_by.entry(*to).or_default().insert(*from));
        }
        let names = of.iter().map(|it| Name::Field(it.0, it.1));
        let seen = reached(&decided_by, names.flat_map(|it| [Node::Whole(it), Node::Part(it)]).collect(), |_| true);
        let fields = seen.into_iter().filter_map(|it| match it {
            Node::Whole(Name::Field(owner, field)) | Node::Part(Name::Field(owner, field)) => Some((owner, field)),
            Node::Whole(_) | Node::Part(_) | Node::Run(_) | Node::Result(_) | Node::Referenced => None,
        });
        fields.collect()
    }

    fn add(&mut self, from: Node, to: Node) {
        self.decides.entry(from).or_default().insert(to);
    }

    /// Who gives a structure a value gives it to its members.
    fn members(&mut self, program: &Program, whole: Name, ty: Type) {
        match ty {
            Type::Array(id) => self.members(program, whole, program.array(id).element),
            Type::Struct(id) => {
                for number in 0..program.structure(id).fields.len() {
                    self.add(Node::Whole(whole), Node::Whole(Name::Field(id, FieldId::next(number))));
                }
            }
            _ => {}
        }
    }
}

/// The nodes that edges lead to from these, themselves among them, through those that `may` be entered.
fn reached(edges: &Edges, mut open: Vec<Node>, may: impl Fn(&Node) -> bool) -> HashSet<Node> {
    let mut seen: HashSet<Node> = open.iter().copied().collect();
    while let Some(node) = open.pop() {
        let next = edges.get(&node).into_iter().flatten();
        open.extend(next.filter(|it| may(it) && seen.insert(**it)));
    }
    seen
}

struct Walk<'p, 'f> {
    program: &'p Program,
    routine: &'p Routine,
    id: RoutineId,
    found: &'f mut Dependencies,
}

impl Walk<'_, '_> {
    /// `around`: what decides whether these statements run.
    fn block(&mut self, block: &[Statement], around: &[Node]) {
        block.iter().for_each(|it| self.statement(it, around));
    }

    fn statement(&mut self, statement: &Statement, around: &[Node]) {
        let mut sources = around.to_vec();
        let mut targets = Vec::new();
        visit::accesses(statement, &mut |place, access| match access {
            Access::Read => sources.extend(self.read(place)),
            Access::Write => targets.push(place.clone()),
            Access::Borrow => {
                sources.extend(self.read(place));
                targets.push(place.clone());
            }
        });
        match &statement.kind {
            StatementKind::Call { callee, instance, arguments, result } => {
                self.each(around, Node::Run(*callee));
                arguments.iter().enumerate().for_each(|(at, it)| self.argument(*callee, at, it, around));
                instance.iter().for_each(|it| self.write(it, &[Node::Run(*callee)]));
                let handed_back: Vec<Node> = around.iter().copied().chain([Node::Result(*callee)]).collect();
                result.iter().for_each(|it| self.write(it, &handed_back));
            }
            StatementKind::Exit | StatementKind::Continue | StatementKind::Return | StatementKind::Fault(_) => {
                self.each(around, Node::Run(self.id));
            }
            // What faults decides what else runs.
            StatementKind::Try { body, kind, .. } => {
                visit::statements(body, &mut |inner| {
                    visit::accesses(inner, &mut |place, _| {
                        let read = self.read(place);
                        self.each(&read, Node::Run(self.id));
                    });
                    if let StatementKind::Call { callee, .. } = &inner.kind {
                        self.found.add(Node::Run(*callee), Node::Run(self.id));
                    }
                });
                self.write(kind, &[Node::Run(self.id)]);
            }
            StatementKind::Finally { .. }
            | StatementKind::Assign { .. }
            | StatementKind::If { .. }
            | StatementKind::Case { .. }
            | StatementKind::Loop { .. }
            | StatementKind::For(_)
            | StatementKind::Turn
            | StatementKind::External(_)
            | StatementKind::CallBlock { .. }
            | StatementKind::PrescanBlock { .. }
            | StatementKind::Stop(_) => targets.iter().for_each(|it| self.write(it, &sources)),
        }
        statement.kind.blocks().into_iter().for_each(|it| self.block(it, &sources));
    }

    fn argument(&mut self, callee: RoutineId, at: usize, argument: &Argument, around: &[Node]) {
        let parameter = Name::Param(callee, ParamId::next(at));
        let mut sources = around.to_vec();
        match argument {
            Argument::Value(value) => visit::reads(value, &mut |it| sources.extend(self.read(it))),
            Argument::Reference(place) => {
                sources.extend(self.read(place));
                self.write(place, &[Node::Whole(parameter), Node::Part(parameter)]);
            }
        }
        self.each(&sources, Node::Whole(parameter));
    }

    fn each(&mut self, sources: &[Node], to: Node) {
        sources.iter().for_each(|it| self.found.add(*it, to));
    }

    fn read(&self, place: &Place) -> Vec<Node> {
        let (names, is_followed) = self.names(place);
        let mut found: Vec<Node> =
            names.last().into_iter().flat_map(|it| [Node::Whole(*it), Node::Part(*it)]).collect();
        if is_followed {
            found.push(Node::Referenced);
        }
        found
    }

    fn write(&mut self, place: &Place, sources: &[Node]) {
        let (names, is_followed) = self.names(place);
        let last = if is_followed { Some(Node::Referenced) } else { names.last().copied().map(Node::Whole) };
        let parts = names.iter().copied().map(Node::Part);
        let local = matches!(place.root, Root::Local(_)).then_some(Node::Result(self.id));
        for target in parts.chain(last).chain(local) {
            self.each(sources, target);
            self.found.add(Node::Run(self.id), target);
        }
    }

    /// The variables that a place is a part of, the innermost last; whether it leads through a reference.
    fn names(&self, place: &Place) -> (Vec<Name>, bool) {
        let walked = Walked::of(self.program, (self.routine, self.id), place);
        (walked.names, walked.is_followed)
    }
}
