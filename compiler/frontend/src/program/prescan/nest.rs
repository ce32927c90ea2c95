//! A prescan reaches the instances inside: each POU's runs those of the instances it contains.

use super::build::{Builder, routine_of};
use super::reach::joined;
use crate::expr::uses::{KeptCount, Uses};
use crate::types::declarations::Declarations;
use staunch_ir::startup::{Event, Fate, Startup};
use staunch_ir::{Elementary, Expr, FieldId, Location, Op, Place, Program, Root, RoutineId, StructId, Type, Value};

/// The slots of the POUs that have instances, with their structures: parts before what they are
/// parts of, as structures are in that order.
fn owners(program: &Program) -> Vec<(StructId, usize)> {
    let classes = program.classes.iter();
    let mut owners: Vec<_> = classes.map(|it| (it.state, it.body.index())).collect();
    owners.sort_unstable();
    owners
}

/// Adds the prescans of contained instances.
pub(super) fn nest(declarations: &mut Declarations<'_>, open: &OpenCounts) {
    for (state, at) in owners(&declarations.program) {
        extend(declarations, open, at, Root::Instance, state);
    }
    let first = declarations.program.instances.first().map(|it| declarations.program.class(it.program).body);
    if let Some(at) = first.map(RoutineId::index) {
        extend(declarations, open, at, Root::Globals, declarations.program.globals);
    }
}

fn extend(declarations: &mut Declarations<'_>, open: &OpenCounts, at: usize, root: Root, state: StructId) {
    let instances = instances(declarations, root, state);
    if instances.is_empty() {
        return;
    }
    let mut builder = Builder::new(declarations, at);
    for Inside { slot, place, fate } in instances {
        let prescan = routine_of(declarations, slot);
        if !declarations.program.routine(prescan).body.is_empty() {
            builder.instance(prescan, &place);
        }
        // The block itself cannot know that its instance is RETAIN as a whole.
        if fate.is_kept() {
            for count in &open[slot] {
                builder.restore(&joined(&place, &count.counter), &joined(&place, &count.kept));
            }
        }
    }
    builder.finish().add_to(declarations);
}

/// An instance of a user's FUNCTION_BLOCK.
struct Inside {
    slot: usize,
    place: Place,
    fate: Fate,
}

/// The instances in a POU's state, or in the globals.
fn instances(declarations: &Declarations<'_>, root: Root, state: StructId) -> Vec<Inside> {
    let mut found = Vec::new();
    let startup = Startup::new(&declarations.program);
    let walk = Walk { declarations, startup };
    walk.members(&Place::root(root, Type::Struct(state)), state, Fate::Inherited, &mut found);
    found
}

struct Walk<'d, 's> {
    declarations: &'d Declarations<'s>,
    startup: Startup<'d>,
}

impl Walk<'_, '_> {
    fn members(&self, place: &Place, id: StructId, fate: Fate, found: &mut Vec<Inside>) {
        for (at, field) in self.declarations.program.structure(id).fields.iter().enumerate() {
            let (at, ty) = (FieldId::next(at), field.ty);
            let fate = self.startup.field(id, at, Event::PowerCycle).within(fate);
            self.inside(place.clone().field(at, ty), fate, found);
        }
    }

    /// The instances at `place`: itself, or its elements or members.
    fn inside(&self, place: Place, fate: Fate, found: &mut Vec<Inside>) {
        match place.ty {
            Type::Struct(id) => match self.declarations.slot_of_instance(id) {
                Some(slot) => found.push(Inside { slot, place, fate }),
                None => self.members(&place, id, fate, found),
            },
            Type::Array(id) => {
                let element = self.declarations.program.array(id).element;
                self.inside(place.index(every(), element, Location::default()), fate, found);
            }
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Block(_) => {}
        }
    }
}

/// An index that is not constant: the builder puts every element in its place.
fn every() -> Expr {
    let at = Location::default();
    let zero = Expr::constant(Elementary::Lint, Value::I64(0), at);
    Expr::apply(Op::Neg, Type::LINT, vec![zero], at)
}

/// For each POU, the counts that its instances keep in themselves but not RETAIN there.
pub(super) type OpenCounts = Vec<Vec<KeptCount>>;

pub(super) fn open_counts(declarations: &Declarations<'_>, uses: &[Uses]) -> OpenCounts {
    let program = &declarations.program;
    let startup = Startup::new(program);
    let mut open = vec![Vec::new(); uses.len()];
    for (state, at) in owners(program) {
        let is_inside = |it: &&KeptCount| it.counter.root == Root::Instance && it.kept.root == Root::Instance;
        let own = uses[at].counts.iter().filter(is_inside);
        let mut counts: Vec<_> = own.filter(|it| fate(&startup, program, at, it) == Fate::Inherited).cloned().collect();
        for Inside { slot, place, fate } in instances(declarations, Root::Instance, state) {
            if fate == Fate::Inherited {
                counts.extend(open[slot].iter().map(|it: &KeptCount| KeptCount {
                    counter: joined(&place, &it.counter),
                    kept: joined(&place, &it.kept),
                    ..it.clone()
                }));
            }
        }
        open[at] = counts;
    }
    open
}

/// What a power cycle does to the variable that keeps a count.
pub(super) fn fate(startup: &Startup<'_>, program: &Program, pou: usize, count: &KeptCount) -> Fate {
    startup.place(&program.routines[pou], &count.kept, Event::PowerCycle)
}

/// The counts that are kept because an instance around them is RETAIN as a whole.
pub(super) fn kept_from_outside<'o>(
    declarations: &Declarations<'_>,
    open: &'o OpenCounts,
) -> impl Iterator<Item = &'o KeptCount> {
    let program = &declarations.program;
    let states = owners(program).into_iter().map(|(state, _)| (Root::Instance, state));
    let all = states.chain([(Root::Globals, program.globals)]);
    let all: Vec<_> = all.flat_map(|(root, state)| instances(declarations, root, state)).collect();
    all.into_iter().filter(|it| it.fate.is_kept()).flat_map(|it| &open[it.slot])
}
