//! What the world may do before a scan: the values of each input that are worth trying, and the
//! combinations of them.

use super::assume::{Assumptions, Mentioned};
use super::choice::{Choice, Covered};
use crate::pair::{Input, Matched, Pair};
use crate::program::facts::{Facts, Numbers};
use crate::program::scalar::{Role, Scalar, Way};
use crate::program::walked::Name;
use staunch_host::format_time;
use staunch_ir::{Chars, Elementary, Program, Repr, Type, Value};
use staunch_runtime::StringType;
use std::collections::HashSet;

/// Combinations of inputs that are tried in every scan of an exhaustive search, if it is not over by then.
const FEW_VECTORS: usize = 512;
/// And in every scan of another one, where that has seen every state that these lead to.
const MAX_VECTORS: usize = 16_384;
/// Values of one input, besides those that its comparisons ask for.
const MAX_VALUES: usize = 64;
/// A type or subrange of at most this many values is tried whole.
const MAX_WHOLE: i128 = 300;
/// Characters of a long text.
const LONGEST: u16 = 300;

#[derive(Clone, Debug)]
pub struct Alphabet {
    pub choices: Vec<Choice>,
    /// Combinations, those that change little first.
    pub vectors: Vec<Vec<Value>>,
    /// How many of them come first in a search.
    pub few: usize,
    /// Whether all combinations are among them.
    pub complete: bool,
}

impl Alphabet {
    pub fn of(pair: &Pair, facts: [&Facts; 2], assumptions: &Assumptions) -> Self {
        let choice = |(at, input): (usize, &Input)| {
            let mut choice = choice(pair, facts, input, assumptions.near(at));
            assumptions.narrow(at, &mut choice, repr(pair, input));
            // What is next to the end of a range may be no time of a system that counts milliseconds.
            choice.values.retain(|it| it.as_integer().is_none_or(|it| it % choice.step == 0));
            choice
        };
        let choices: Vec<Choice> = pair.inputs.iter().enumerate().map(choice).collect();
        let (vectors, complete) = vectors(&choices, assumptions);
        let few = vectors.len().min(FEW_VECTORS);
        Self { choices, vectors, few, complete }
    }

    /// Whether nothing that the inputs can do is left out.
    pub fn is_exact(&self) -> bool {
        self.complete && self.choices.iter().all(|it| it.covered.is_some())
    }
}

fn repr(pair: &Pair, input: &Input) -> Repr {
    let program = &pair.sides[0].program;
    program.repr(pair.scalar(0, input.scalars[0]).ty).unwrap_or(Repr::Bool)
}

/// The inputs, and what keeps its first value because nothing writes it.
#[derive(Debug, Default)]
pub struct Sources {
    pub inputs: Vec<Input>,
    pub kept: Vec<Input>,
}

/// The inputs by their declaration, and what the world outside must be writing: what no statement writes and some
/// read, where it starts at zero, is retained, or an assumption speaks of it. Without an input by its declaration, all that no
/// statement writes and some read.
pub fn sources(pair: &Pair, facts: [&Facts; 2], assumed: &Mentioned) -> Sources {
    let declared = typed(pair, facts, pair.matched(|it| it.role == Role::Input));
    let mut found = Sources { inputs: declared, ..Sources::default() };
    let is_alone = found.inputs.is_empty();
    let filled = filled(pair);
    for scalars in pair.matched(|it| it.role == Role::Variable) {
        let scalar = pair.scalar(0, scalars[0]);
        let writes = [0, 1].map(|side| is_written(pair.scalar(side, scalars[side]), facts[side]));
        let reads = |side: usize| name(pair.scalar(side, scalars[side])).is_some_and(|it| facts[side].is_read(it));
        let full = scalar.full_name(&pair.sides[0].program);
        let is_named = assumed.has(&scalar.path) || full.is_some_and(|it| assumed.has(&it));
        if writes == [true, true] && !is_named || !(reads(0) || reads(1)) {
            continue;
        }
        let Some(input) = typed(pair, facts, vec![scalars]).pop() else { continue };
        let is_set = input.starts_at_zero() || scalar.at.is_retained;
        // What an instance is never given is its own business.
        let is_input = writes == [false, false]
            && !is_table(pair, facts, scalars, &filled, is_alone)
            && (is_alone || is_set && !scalar.at.is_inner);
        if is_named || is_input {
            found.inputs.push(input);
        } else {
            found.kept.push(input);
        }
    }
    found
}

/// The array or structure that a variable is a part of, where it may be a table.
fn whole(scalar: &Scalar) -> Option<Way> {
    let members = scalar.way.members[..scalar.at.table?].to_vec();
    Some(Way { from: scalar.way.from, members })
}

/// Arrays and structures in which something does not start at zero.
fn filled(pair: &Pair) -> HashSet<Way> {
    let side = &pair.sides[0];
    let is_set = |it: &&Scalar| side.state()[it.offset..it.offset + it.size].iter().any(|it| *it != 0);
    side.scalars.all.iter().filter(|it| it.at.table.is_some()).filter(is_set).filter_map(whole).collect()
}

/// Whether it is a part of an array or structure that neither program writes: its values are the program's own. One
/// without values that others see, as a panel's in the globals, or in a program that declares no input, is written from
/// outside.
fn is_table(pair: &Pair, facts: [&Facts; 2], scalars: Matched, filled: &HashSet<Way>, is_alone: bool) -> bool {
    let is_read = |side: usize| {
        let scalar = pair.scalar(side, scalars[side]);
        let Some(depth) = scalar.at.table else { return false };
        name(scalar).is_some_and(|it| !facts[side].is_written_around(it, &scalar.way, depth))
    };
    let Some(whole) = whole(pair.scalar(0, scalars[0])) else { return false };
    let is_seen = is_alone || whole.from == pair.sides[0].program.globals;
    is_read(0) && is_read(1) && (!is_seen || filled.contains(&whole))
}

/// Whether the world outside writes into a table.
pub fn has_tables(pair: &Pair, facts: [&Facts; 2], inputs: &[Input]) -> bool {
    let is_of = |side: usize, it: &Input| {
        name(pair.scalar(side, it.scalars[side])).is_some_and(|it| facts[side].is_of_table(it))
    };
    inputs.iter().any(|it| is_of(0, it) || is_of(1, it))
}

/// Whether a program writes a variable.
fn is_written(scalar: &Scalar, facts: &Facts) -> bool {
    name(scalar).is_none_or(|it| facts.is_written(it, &scalar.way))
}

/// Those that both programs hold in one type, strings of any length; the world outside has no addresses to give.
fn typed(pair: &Pair, facts: [&Facts; 2], found: Vec<Matched>) -> Vec<Input> {
    let input = |scalars: Matched| {
        let [a, b] = [pair.scalar(0, scalars[0]), pair.scalar(1, scalars[1])];
        let bytes = &pair.sides[0].state()[a.offset..a.offset + a.size];
        match [a.ty, b.ty] {
            [Type::Reference(_), _] | [_, Type::Reference(_)] => return None,
            [Type::String(x), Type::String(y)] if x.wide == y.wide => {
                let capacity = x.capacity.min(y.capacity);
                let near = [0, 1].map(|side: usize| texts_of(pair, facts, side, scalars));
                let initial = match a.is_shared {
                    // What shares its bits starts with zeros.
                    true => Chars::empty(x),
                    false => Chars::read(StringType { capacity, ..x }, bytes),
                };
                let (texts, named) = texts(initial, near.concat(), StringType { capacity, ..x });
                return Some(Input { scalars, initial: Value::U16(0), range: None, texts, named });
            }
            _ => {}
        }
        let repr = pair.sides[0].program.repr(a.ty)?;
        // Two programs number their types for themselves.
        (pair.sides[1].program.repr(b.ty)? == repr || are_long_times(a.ty, b.ty)).then(|| Input {
            scalars,
            initial: Value::read(repr, bytes),
            range: None,
            texts: Vec::new(),
            named: 0,
        })
    };
    found.into_iter().filter_map(input).collect()
}

/// What a program compares a string with.
fn texts_of(pair: &Pair, facts: [&Facts; 2], side: usize, scalars: Matched) -> Vec<Chars> {
    let scalar = pair.scalar(side, scalars[side]);
    // Which text goes where among shared bits is not followed.
    if scalar.is_shared {
        return facts[side].all_texts.clone();
    }
    name(scalar).map_or_else(Vec::new, |it| facts[side].texts(it))
}

/// What to try of a string: the initial one, those that it is compared with, none, another one, and a long one; and how many
/// of them are before the other two.
fn texts(initial: Chars, near: Vec<Chars>, ty: StringType) -> (Vec<Chars>, usize) {
    let mut found = vec![initial];
    let of = |letter: u8, length: usize| match ty.wide {
        true => Chars::Wide(vec![letter.into(); length]),
        false => Chars::Narrow(vec![letter; length]),
    };
    let full = of(b'x', ty.capacity.min(LONGEST).into());
    let other = (b'a'..=b'z').map(|it| of(it, 1)).find(|it| !near.contains(it));
    let mut add = |text: Chars| {
        if text.fits(ty) && !found.contains(&text) {
            found.push(text);
        }
        found.len()
    };
    let named = near.into_iter().take(MAX_VALUES).chain([Chars::empty(ty)]).map(&mut add).last().unwrap_or(1);
    let _ = other.into_iter().chain([full]).map(&mut add).last();
    (found, named)
}

/// Inputs of both sides that are not tried: references, and those that the two hold in different types.
pub fn untried(pair: &Pair) -> Vec<&str> {
    let tried: HashSet<Matched> = pair.inputs.iter().map(|it| it.scalars).collect();
    let both = pair.matched(|it| it.role == Role::Input);
    let inputs = both.into_iter().filter(|it| !tried.contains(it));
    inputs.map(|it| pair.path(it)).collect()
}

/// For each input whose system has values that the other one has not, what is tried.
pub fn in_common(pair: &Pair) -> Vec<String> {
    let sentence = |input: &Input| {
        let types = [0, 1].map(|side: usize| pair.scalar(side, input.scalars[side]).ty);
        let limits = |side: usize| pair.sides[side].dialect.rules().limits(types[side].elementary()?);
        let Range { low, high, .. } = times_of_both(pair, types).filter(|_| limits(0) != limits(1))?;
        let [low, high] = [low, high].map(|it| i64::try_from(it).map_or_else(|_| it.to_string(), format_time));
        let path = pair.path(input.scalars);
        Some(format!("Of `{path}`, only what both systems have is tried: {low} to {high}."))
    };
    pair.inputs.iter().filter_map(sentence).collect()
}

/// Outputs of standard blocks that are inputs: they are compared, and only what a call leaves in them is tried.
pub fn outputs_given(pair: &Pair) -> Vec<&str> {
    let given = pair.matched(|it| it.at.is_given && matches!(it.role, Role::Output(_)));
    given.into_iter().map(|it| pair.path(it)).collect()
}

/// Whether a program assigns an input of its own.
pub fn are_written(pair: &Pair, facts: [&Facts; 2]) -> bool {
    let written = |side: usize, input: &Input| {
        let scalar = pair.scalar(side, input.scalars[side]);
        name(scalar).is_some_and(|it| facts[side].is_written(it, &scalar.way))
    };
    pair.inputs.iter().any(|it| written(0, it) || written(1, it))
}

fn name(scalar: &Scalar) -> Option<Name> {
    scalar.field.map(|(structure, field)| Name::Field(structure, field))
}

/// The texts of a string input: one on every side where the programs ask for those alone whether it is equal to them. Of two
/// types, the longer one holds more.
fn choice_of_texts(pair: &Pair, facts: [&Facts; 2], input: &Input) -> Choice {
    let scalars = [0, 1].map(|side: usize| pair.scalar(side, input.scalars[side]));
    let both =
        |holds: fn(&Facts, Name) -> bool| (0..2).all(|it| name(scalars[it]).is_some_and(|name| holds(facts[it], name)));
    let least = scalars.iter().filter_map(|it| it.ty.string_type()).map(|it| usize::from(it.capacity)).min();
    let near = [0, 1].map(|side: usize| texts_of(pair, facts, side, input.scalars)).concat();
    let stays = || both(|facts, name| !facts.is_handed_on(name)) && near.iter().all(|it| Some(it.len()) < least);
    let is_short = scalars[0].ty == scalars[1].ty || stays();
    let covered = if both(|facts, name| !facts.is_read(name)) {
        Some(Covered::Unread)
    } else {
        let is_own = scalars.iter().all(|it| !it.is_shared);
        (is_own && both(Facts::only_compared) && is_short && near.len() <= MAX_VALUES).then_some(Covered::Compared)
    };
    let count = u16::try_from(input.texts.len()).unwrap_or(u16::MAX);
    Choice { values: (0..count).map(Value::U16).collect(), covered, range: None, step: 1 }
}

/// The values of an input: on every side of what the programs compare it with, and of what is assumed of it.
fn choice(pair: &Pair, facts: [&Facts; 2], input: &Input, assumed: Numbers) -> Choice {
    if !input.texts.is_empty() {
        return choice_of_texts(pair, facts, input);
    }
    let program = &pair.sides[0].program;
    let scalars = [pair.scalar(0, input.scalars[0]), pair.scalar(1, input.scalars[1])];
    let names = scalars.map(name);
    let both = |holds: fn(&Facts, Name) -> bool| (0..2).all(|it| names[it].is_some_and(|name| holds(facts[it], name)));
    let mut near = assumed;
    for (facts, name) in facts.iter().zip(names) {
        near.add_all(name.map(|it| facts.worth_trying(it)).unwrap_or_default());
    }
    let times = times_of_both(pair, scalars.map(|it| it.ty));
    let (values, all) = values(program, scalars[0].ty, &near, times);
    let range = |side: usize| pair.sides[side].program.range(scalars[side].ty);
    let covered = if all && range(0) == range(1) {
        Some(Covered::All)
    } else if both(|facts, name| !facts.is_read(name)) {
        Some(Covered::Unread)
    } else if both(Facts::only_compared) && !input.initial.repr().is_float() {
        Some(Covered::Compared)
    } else {
        None
    };
    let mut kept = vec![input.initial];
    for value in values {
        if !kept.contains(&value) {
            kept.push(value);
        }
    }
    let type_range = pair.sides[0].program.repr(scalars[0].ty).filter(|it| it.is_integer()).and_then(Repr::range);
    let range = times.map(|it| (it.low, it.high)).or(range(0)).or(type_range);
    Choice { values: kept, covered, range, step: times.map_or(1, |it| it.step) }
}

/// The least and the greatest number to try, and what lies between two of them.
#[derive(Clone, Copy)]
struct Range {
    low: i128,
    high: i128,
    step: i128,
}

/// LTIMEs, of which one has no sign.
fn are_long_times(a: Type, b: Type) -> bool {
    let is_long = |ty: Type| matches!(ty, Type::Elementary(Elementary::Ltime | Elementary::Ultime));
    is_long(a) && is_long(b)
}

/// Of a TIME or an LTIME, in nanoseconds: those that both systems have.
fn times_of_both(pair: &Pair, types: [Type; 2]) -> Option<Range> {
    let limits = |side: usize| {
        let ty = types[side].elementary().filter(|it| it.is_duration())?;
        pair.sides[side].dialect.rules().limits(ty)
    };
    let (a, b) = (limits(0)?, limits(1)?);
    let counts = pair.sides.iter().filter_map(|it| it.dialect.rules().time_count()).map(|it| it.unit);
    let step = counts.max().filter(|_| types[0] == Type::TIME).map_or(1, i128::from);
    let (low, high) = (a.0.max(b.0), a.1.min(b.1));
    Some(Range { low: low / step * step, high: high / step * step, step })
}

/// What to try of a type, those near a comparison first; and whether that is all of it.
fn values(program: &Program, ty: Type, near: &Numbers, times: Option<Range>) -> (Vec<Value>, bool) {
    let Some(repr) = program.repr(ty) else { return (Vec::new(), false) };
    match ty {
        Type::Enum(id) => (program.enumeration(id).values.iter().map(|it| it.value).collect(), true),
        Type::Elementary(Elementary::Bool) => (vec![Value::Bool(false), Value::Bool(true)], true),
        _ if repr.is_float() => (reals(repr, near), false),
        _ => {
            let (low, high) = program.range(ty).or(repr.range()).unwrap_or((0, 0));
            integers(repr, times.unwrap_or(Range { low, high, step: 1 }), ty, near)
        }
    }
}

fn integers(repr: Repr, Range { low, high, step }: Range, ty: Type, near: &Numbers) -> (Vec<Value>, bool) {
    let inside = |it: &i128| (low..=high).contains(it) && it % step == 0;
    let whole = high - low < MAX_WHOLE;
    let times = ty.elementary().is_some_and(Elementary::is_time);
    let around = near.integers.iter().flat_map(|it| [*it, it.saturating_add(step), it.saturating_sub(step)]);
    // A time of one scan, and of a hundred; and what counts and presets are small in.
    let some: &[i128] = if times { &[0, 10_000_000, 1_000_000_000] } else { &[1, 2, 3, 0, -1] };
    let ends = [high, low];
    let mut found: Vec<i128> = Vec::new();
    for it in around.chain(some.iter().copied()).chain(ends).filter(inside) {
        if !found.contains(&it) {
            found.push(it);
        }
    }
    if whole {
        found.extend((low..=high).filter(|it| !found.contains(it)).collect::<Vec<_>>());
    }
    (found.into_iter().filter_map(|it| repr.integer(it)).collect(), whole)
}

/// Halves, which systems round in different ways, and what an INT and a DINT do not hold.
const ROUNDED: [f64; 4] = [2.5, -1.5, 40_000.0, 3.0e9];

fn reals(repr: Repr, near: &Numbers) -> Vec<Value> {
    let mut found = Vec::new();
    for (at, limit) in near.reals.iter().enumerate() {
        let between = near.reals.get(at + 1).map(|next| f64::midpoint(*limit, *next));
        found.extend([*limit, limit + 1.0, limit - 1.0]);
        found.extend(between);
    }
    found.extend([0.0, 1.0, -1.0]);
    found.extend(ROUNDED);
    found.truncate(MAX_VALUES);
    let value = |it: f64| match repr {
        Repr::F32 => narrowed(it).map(Value::F32),
        _ => Some(Value::F64(it)),
    };
    found.into_iter().filter_map(value).collect()
}

/// The nearest REAL.
pub fn narrowed(number: f64) -> Option<f32> {
    number.to_string().parse().ok()
}

/// Every combination that is allowed, or those that change few inputs; and whether that is all.
fn vectors(choices: &[Choice], assumptions: &Assumptions) -> (Vec<Vec<Value>>, bool) {
    let mut found: Vec<(usize, Vec<Value>)> = vec![(0, Vec::new())];
    let mut complete = true;
    for choice in choices {
        let with = |(changes, vector): &(usize, Vec<Value>)| {
            let each = |(at, value): (usize, &Value)| {
                let mut vector = vector.clone();
                vector.push(*value);
                (changes + usize::from(at > 0), vector)
            };
            choice.values.iter().enumerate().map(each).collect::<Vec<_>>()
        };
        found = found.iter().flat_map(with).collect();
        found.sort_by_key(|it| it.0);
        complete &= found.len() <= MAX_VECTORS * 2;
        found.truncate(MAX_VECTORS * 2);
    }
    found.retain(|it| assumptions.allow(&it.1));
    complete &= found.len() <= MAX_VECTORS;
    found.truncate(MAX_VECTORS);
    (found.into_iter().map(|it| it.1).collect(), complete)
}
