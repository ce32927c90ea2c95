//! The relation of places, against where they lie.

use super::*;
use crate::fixture::{AT, assign, field, int, lint, load, local, param, program, routine, structure};
use crate::{
    Argument, Array, ArrayId, Const, ExprKind, Field, FieldId, LocalId, Mode, ParamId, RefKind, RefType, ReferenceId,
    Routine, RoutineKind,
};

const PART: Type = Type::Struct(StructId(0));
const STATE: Type = Type::Struct(StructId(1));
const GLOBALS: Type = Type::Struct(StructId(2));
const PAIR: Type = Type::Array(ArrayId(0));
const PARTS: Type = Type::Array(ArrayId(1));

/// ```text
/// Part     a: INT, b: ARRAY[0..1] OF INT
/// Block    given: INT (an input), own: INT, parts: ARRAY[0..1] OF Part
/// globals  k: INT, parts: ARRAY[0..1] OF Part, instance: Block
/// ```
/// The body is Block's, with the VAR_IN_OUTs `number: INT` and `part: Part`.
fn small() -> Program {
    let input = Field { section: Section::Input, ..field("given", Type::INT, Const::Zero) };
    let part = structure("Part", vec![field("a", Type::INT, Const::Zero), field("b", PAIR, Const::Zero)]);
    let state =
        structure("Block", vec![input, field("own", Type::INT, Const::Zero), field("parts", PARTS, Const::Zero)]);
    let globals = structure(
        "globals",
        vec![
            field("k", Type::INT, Const::Zero),
            field("parts", PARTS, Const::Zero),
            field("instance", STATE, Const::Zero),
        ],
    );
    let body = Routine {
        params: vec![param("number", Type::INT, Mode::Reference), param("part", PART, Mode::Reference)],
        locals: vec![local("i", Type::LINT, Const::Zero), local("number", Type::INT, Const::Zero)],
        ..routine(RoutineKind::Body, "Block", Some(StructId(1)))
    };
    let arrays = vec![Array { low: 0, high: 1, element: Type::INT }, Array { low: 0, high: 1, element: PART }];
    program(arrays, vec![part, state, globals], vec![body])
}

/// Every place below `place`, each element by a known and by an unknown index.
fn below(program: &Program, place: Place, found: &mut Vec<Place>) {
    match place.ty {
        Type::Struct(id) => {
            for (at, part) in program.structure(id).fields.iter().enumerate() {
                below(program, place.clone().field(FieldId::next(at), part.ty), found);
            }
        }
        Type::Array(id) => {
            let element = program.array(id).element;
            for index in [lint(0), lint(1), load(Place::local(LocalId(0), Type::LINT))] {
                below(program, place.clone().index(index, element, AT), found);
            }
        }
        _ => {}
    }
    found.push(place);
}

fn every_place(program: &Program) -> Vec<Place> {
    let roots = [
        (Root::Instance, STATE),
        (Root::Globals, GLOBALS),
        (Root::Local(LocalId(1)), Type::INT),
        (Root::Param(ParamId(0)), Type::INT),
        (Root::Param(ParamId(1)), PART),
    ];
    let mut found = Vec::new();
    roots.into_iter().for_each(|(root, ty)| below(program, Place::root(root, ty), &mut found));
    found
}

/// How many numbers a type holds.
fn size(program: &Program, ty: Type) -> usize {
    match ty {
        Type::Struct(id) => program.structure(id).fields.iter().map(|it| size(program, it.ty)).sum(),
        Type::Array(id) => 2 * size(program, program.array(id).element),
        _ => 1,
    }
}

/// The numbers that a place means: where its root lies, and what its unknown indices are, a bit each.
fn numbers(program: &Program, place: &Place, root: (usize, Type), unknown: usize) -> std::ops::Range<usize> {
    let (mut at, mut ty) = root;
    let mut unknown = unknown;
    for projection in &place.projections {
        match (projection, ty) {
            (Projection::Field(id), Type::Struct(of)) => {
                let fields = &program.structure(of).fields;
                at += fields[..id.index()].iter().map(|it| size(program, it.ty)).sum::<usize>();
                ty = fields[id.index()].ty;
            }
            (Projection::Index { index, .. }, Type::Array(of)) => {
                let known = index.as_const().and_then(|it| it.as_integer());
                ty = program.array(of).element;
                at += size(program, ty) * known.map_or(unknown & 1, |it| usize::try_from(it).unwrap());
                unknown >>= usize::from(known.is_none());
            }
            _ => unreachable!("a place of the small program"),
        }
    }
    at..at + size(program, ty)
}

/// What the unknown indices of a place may be.
fn ways(place: &Place) -> std::ops::Range<usize> {
    0..1 << place.indices().filter(|it| it.as_const().is_none()).count()
}

/// Where the instance and the parameters may lie: in storage of a caller, and wherever in the globals
/// and the instance's inputs their types are.
fn layouts(program: &Program) -> Vec<[usize; 5]> {
    let [globals, own, local, callers_number, callers_part] = [0, 100, 200, 300, 400];
    let in_globals = size(program, Type::INT) + size(program, PARTS);
    let mut found = Vec::new();
    for instance in [own, in_globals] {
        let numbers = (0..size(program, Type::INT) + size(program, PARTS) + 1).chain([callers_number, instance]);
        for number in numbers {
            for part in [1, 4, callers_part] {
                found.push([instance, globals, local, number, part]);
            }
        }
        // Both parameters may be given variables of one caller.
        for number in callers_part..callers_part + 3 {
            found.push([instance, globals, local, number, callers_part]);
        }
    }
    found
}

fn root_at(layout: &[usize; 5], root: Root) -> (usize, Type) {
    match root {
        Root::Instance => (layout[0], STATE),
        Root::Globals => (layout[1], GLOBALS),
        Root::Local(_) => (layout[2], Type::INT),
        Root::Param(ParamId(0)) => (layout[3], Type::INT),
        Root::Param(_) => (layout[4], PART),
    }
}

/// `No` and `Must` hold wherever the roots lie and whatever the indices are. Below one root `May` says
/// that both happen; between two, types alone decide, and it may be said too often.
#[test]
fn agrees_with_storage() {
    let program = small();
    let frame = Frame::of(&program, &program.routines[0]);
    let places = every_place(&program);
    let layouts = layouts(&program);
    for a in &places {
        for b in &places {
            let mut outcomes = [false; 2];
            for (layout, i, j) in
                layouts.iter().flat_map(|it| ways(a).flat_map(move |i| ways(b).map(move |j| (it, i, j))))
            {
                let a = numbers(&program, a, root_at(layout, a.root), i);
                let b = numbers(&program, b, root_at(layout, b.root), j);
                outcomes[usize::from(a.start < b.end && b.start < a.end)] = true;
                if outcomes == [true, true] {
                    break;
                }
            }
            let expected = match outcomes {
                [true, false] => Alias::No,
                [false, true] => Alias::Must,
                _ => Alias::May,
            };
            let found = alias(&frame, a, b);
            let coarser = found == Alias::May && a.root != b.root;
            assert!(found == expected || coarser, "{found:?}, not {expected:?}:\n{a:?}\n{b:?}");
        }
    }
}

#[test]
fn types_and_names_keep_roots_apart() {
    let program = small();
    let frame = Frame::of(&program, &program.routines[0]);
    let own = Place::root(Root::Instance, STATE).field(FieldId(1), Type::INT);
    let given = Place::root(Root::Instance, STATE).field(FieldId(0), Type::INT);
    let k = Place::root(Root::Globals, GLOBALS).field(FieldId(0), Type::INT);
    let number = Place::root(Root::Param(ParamId(0)), Type::INT);
    let part = Place::root(Root::Param(ParamId(1)), PART);
    assert_eq!(alias(&frame, &own, &number), Alias::No);
    assert_eq!(alias(&frame, &given, &number), Alias::May);
    assert_eq!(alias(&frame, &given, &k), Alias::No);
    assert_eq!(alias(&frame, &number, &k), Alias::May);
    assert_eq!(alias(&frame, &number, &part.clone().field(FieldId(0), Type::INT)), Alias::May);
    assert_eq!(alias(&frame, &part, &k), Alias::No);
}

#[test]
fn a_call_changes_what_it_is_passed_and_what_is_global() {
    let program = small();
    let frame = Frame::of(&program, &program.routines[0]);
    let own = || Place::root(Root::Instance, STATE).field(FieldId(1), Type::INT);
    let given = || Place::root(Root::Instance, STATE).field(FieldId(0), Type::INT);
    let k = || Place::root(Root::Globals, GLOBALS).field(FieldId(0), Type::INT);
    let number = || Place::root(Root::Param(ParamId(0)), Type::INT);
    let temp = || Place::local(LocalId(1), Type::INT);
    let call = |passed: Place| {
        let arguments = vec![Argument::Reference(passed)];
        let callee = crate::RoutineId(0);
        [Statement::new(StatementKind::Call { callee, instance: None, arguments, result: None }, AT)]
    };
    let changed =
        |block: &[Statement]| [own(), given(), k(), number(), temp()].map(|it| changes(&frame, block, &load(it)));
    assert_eq!(changed(&call(temp())), [false, true, true, true, true]);
    assert_eq!(changed(&call(own())), [true, true, true, true, false]);
    assert_eq!(changed(&[assign(k(), int(1))]), [false, false, true, true, false]);
    assert_eq!(changed(&[assign(temp(), int(1))]), [false, false, false, false, true]);
}

#[test]
fn an_index_is_read() {
    let program = small();
    let frame = Frame::of(&program, &program.routines[0]);
    let index = || Place::local(LocalId(0), Type::LINT);
    let parts = Place::root(Root::Globals, GLOBALS).field(FieldId(1), PARTS);
    let a = parts.index(load(index()), PART, AT).field(FieldId(0), Type::INT);
    assert!(reads(&frame, &load(a.clone()), &index()));
    assert!(changes(&frame, &[assign(index(), lint(1))], &load(a)));
}

#[test]
fn what_a_reference_leads_to_is_any_variable_but_one_that_lives_for_a_call() {
    let mut program = small();
    program.references = vec![RefType { kind: RefKind::PointerTo, target: Type::INT }];
    program.reach.references = true;
    let pointer = Type::Reference(ReferenceId(0));
    let through = |root| Place::root(root, pointer).deref(Type::INT, AT);
    let k = Place::root(Root::Globals, GLOBALS).field(FieldId(0), Type::INT);
    let own = Place::root(Root::Instance, STATE).field(FieldId(1), Type::INT);
    let temp = Place::local(LocalId(1), Type::INT);
    let meet = |program: &Program, [of_k, of_own]: [Alias; 2]| {
        let frame = Frame::of(program, &program.routines[0]);
        for pointer in [through(Root::Local(LocalId(0))), through(Root::Param(ParamId(0)))] {
            for (place, meets) in [(&k, of_k), (&own, of_own), (&pointer, Alias::May), (&temp, Alias::No)] {
                assert_eq!((alias(&frame, &pointer, place), alias(&frame, place, &pointer)), (meets, meets));
            }
        }
    };
    meet(&program, [Alias::May; 2]);
    // Once it is known whose addresses are taken, it is one of those.
    let taken = |of: &Place| {
        Statement::assign(temp.clone(), Expr::new(pointer, ExprKind::AddressOf(Box::new(of.clone())), AT), AT)
    };
    program.routines[0].body = vec![taken(&own)];
    program.reached = Some(crate::reference::reach(&program));
    meet(&program, [Alias::No, Alias::May]);
    program.routines[0].body = vec![taken(&k)];
    program.reached = Some(crate::reference::reach(&program));
    meet(&program, [Alias::May, Alias::No]);
}

#[test]
fn a_pin_may_be_what_a_parameter_stands_for() {
    let counter = crate::fixture::counter();
    let mut program = small();
    program.structs[2].fields.push(field("counter", counter.ty, Const::Zero));
    program.routines[0].params.push(param("text", Type::string(9), Mode::Reference));
    let frame = Frame::of(&program, &program.routines[0]);
    let block = Place::root(Root::Globals, GLOBALS).field(FieldId(3), counter.ty);
    // CV and PV are INTs; no pin is a text.
    assert_eq!(alias(&frame, &Place::root(Root::Param(ParamId(0)), Type::INT), &block), Alias::May);
    assert_eq!(alias(&frame, &Place::root(Root::Param(ParamId(2)), Type::string(9)), &block), Alias::No);
}

#[test]
fn ways_have_fields_in_common_until_they_part() {
    let way = |numbers: &[u32]| numbers.iter().map(|it| Projection::Field(FieldId(*it))).collect::<Vec<_>>();
    assert_eq!(common_fields(&way(&[]), &way(&[1])), 0);
    assert_eq!(common_fields(&way(&[2]), &way(&[1])), 0);
    assert_eq!(common_fields(&way(&[1, 2]), &way(&[1, 2, 3])), 2);
    assert_eq!(common_fields(&way(&[1, 2, 4]), &way(&[1, 3, 4])), 1);
}

#[test]
fn an_array_of_any_length_may_be_one_of_two_elements() {
    let mut program = small();
    program.arrays.push(Array::open(Type::INT));
    let open = Type::Array(ArrayId(2));
    program.routines[0].params.push(param("any", open, Mode::Reference));
    let frame = Frame::of(&program, &program.routines[0]);
    let any = Place::root(Root::Param(ParamId(2)), open);
    let pair = Place::root(Root::Param(ParamId(1)), PART).field(FieldId(1), PAIR);
    let number = Place::root(Root::Param(ParamId(0)), Type::INT);
    for (a, b) in [(&any, &pair), (&pair, &any), (&any, &number)] {
        assert_eq!(alias(&frame, a, b), Alias::May);
    }
}
