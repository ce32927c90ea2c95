//! The valid values of each byte of a state. Bytes from outside (a stimulus, a retain file, a user's own
//! host) pass through here, so that compiled code finds only valid values of its variables' types.

use crate::map::{Array, Map, Type, Variable};
use staunch_runtime::time::MILLISECOND;
use staunch_runtime::{Elementary, Repr, StringType, Time, Value, ops};
use std::collections::HashMap;
use std::ops::Range;

/// The values that a program's state may hold, by its map.
///
/// Written bytes become the nearest value of their variable's type: a BOOL that is not 0 is TRUE, a
/// string's length is at most its capacity and the bytes after its end are 0, a number of a subrange
/// becomes its nearer bound, a TIME is cut to the milliseconds of the dialect, a date is moved to its midnight and a time of day
/// into its day, and bytes that belong to no variable are 0. The number of an enumeration stays, even if it has no name, and so
/// does a REAL, even if it is NaN.
#[derive(Clone, Debug)]
pub struct Domain {
    size: usize,
    /// A part comes before what it is a part of; the last is the whole state.
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
enum Node {
    /// All bytes are valid.
    Any,
    Bool,
    /// A day, which is its midnight.
    Day,
    /// A time of day, which is less than a day.
    Clock,
    /// A string of at most this many bytes.
    Text(StringType),
    /// A TIME that is a number of milliseconds between these.
    Milliseconds(i64, i64),
    Subrange {
        repr: Repr,
        low: i128,
        high: i128,
    },
    Array {
        element: usize,
        stride: usize,
        count: usize,
    },
    /// In the order of their offsets.
    Structure(Vec<Part>),
}

#[derive(Clone, Copy, Debug)]
struct Part {
    offset: usize,
    size: usize,
    node: usize,
}

impl Part {
    fn end(&self) -> usize {
        self.offset + self.size
    }
}

impl Domain {
    pub fn of(map: &Map) -> Self {
        let mut builder = Builder { map, nodes: Vec::new(), known: HashMap::new() };
        let globals = map.globals.map(|(ty, offset)| builder.part(ty, None, offset));
        let instances = map.instances.iter().map(|it| (it.ty, it.offset));
        let instances: Vec<Part> = instances.map(|(ty, offset)| builder.part(ty, None, offset)).collect();
        builder.structure(globals.into_iter().chain(instances).collect());
        Self { size: map.size, nodes: builder.nodes }
    }

    /// Writes bytes into a state, and makes values of what they are a part of.
    ///
    /// # Panics
    /// If the state is not of the map's size, or the bytes do not fit into it.
    pub fn write(&self, state: &mut [u8], offset: usize, bytes: &[u8]) {
        assert_eq!(state.len(), self.size, "the state of another program");
        let window = offset..offset + bytes.len();
        state[window.clone()].copy_from_slice(bytes);
        let whole = Part { offset: 0, size: self.size, node: self.nodes.len() - 1 };
        self.settle(state, whole, &window);
    }

    /// Whether bytes before this position and bytes from it on become values without each other.
    pub(crate) fn is_boundary(&self, position: usize) -> bool {
        let (mut at, mut node) = (position, self.nodes.len() - 1);
        loop {
            match &self.nodes[node] {
                Node::Array { element, stride, .. } if *stride > 0 => (at, node) = (at % stride, *element),
                Node::Structure(parts) => {
                    let Some(part) = parts.iter().find(|it| it.offset < at && at < it.end()) else { return true };
                    (at, node) = (at - part.offset, part.node);
                }
                Node::Any => return true,
                Node::Bool
                | Node::Day
                | Node::Clock
                | Node::Milliseconds(..)
                | Node::Text(_)
                | Node::Subrange { .. }
                | Node::Array { .. } => {
                    return at == 0;
                }
            }
        }
    }

    /// The bytes of variables in a window of the state, in their order.
    pub(crate) fn values(&self, window: &Range<usize>, see: &mut dyn FnMut(Range<usize>)) {
        let whole = Part { offset: 0, size: self.size, node: self.nodes.len() - 1 };
        self.values_of(whole, window, see);
    }

    #[cfg(test)]
    pub(crate) fn is_value(&self, at: usize) -> bool {
        let mut found = false;
        self.values(&(at..at + 1), &mut |_| found = true);
        found
    }

    fn values_of(&self, part: Part, window: &Range<usize>, see: &mut dyn FnMut(Range<usize>)) {
        if part.end() <= window.start || window.end <= part.offset {
            return;
        }
        let mut all = |end: usize| {
            let found = part.offset.max(window.start)..end.min(window.end);
            if !found.is_empty() {
                see(found);
            }
        };
        match &self.nodes[part.node] {
            Node::Any | Node::Bool | Node::Day | Node::Clock | Node::Milliseconds(..) | Node::Subrange { .. } => {
                all(part.end())
            }
            Node::Text(ty) => {
                let text = usize::from(ty.capacity) * ty.unit_size() as usize;
                all(part.offset + size_of::<u16>() + text);
            }
            Node::Array { element, stride, count } => {
                let from = window.start.saturating_sub(part.offset) / stride.max(&1);
                let to = (window.end - part.offset).div_ceil(*stride.max(&1)).min(*count);
                for position in from..to {
                    let offset = part.offset + position * stride;
                    self.values_of(Part { offset, size: *stride, node: *element }, window, see);
                }
            }
            Node::Structure(parts) => {
                for member in parts {
                    self.values_of(Part { offset: part.offset + member.offset, ..*member }, window, see);
                }
            }
        }
    }

    /// Makes values of what the window touches of a part, which is given by its place in the state.
    fn settle(&self, state: &mut [u8], part: Part, window: &Range<usize>) {
        if part.end() <= window.start || window.end <= part.offset {
            return;
        }
        let bytes = &mut state[part.offset..part.end()];
        match &self.nodes[part.node] {
            Node::Any => {}
            Node::Bool => bytes[0] = u8::from(bytes[0] != 0),
            Node::Day => settle_time(bytes, ops::start_of_day),
            Node::Clock => settle_time(bytes, ops::time_of_day),
            Node::Milliseconds(least, greatest) => {
                settle_time(bytes, |it| (it / MILLISECOND).clamp(*least, *greatest) * MILLISECOND);
            }
            Node::Text(ty) => settle_text(bytes, *ty),
            Node::Subrange { repr, low, high } => settle_number(bytes, *repr, *low, *high),
            Node::Array { element, stride, count } => {
                let elements = Part { size: *stride, node: *element, ..part };
                self.settle_elements(state, elements, *count, window);
            }
            Node::Structure(parts) => self.settle_members(state, part, parts, window),
        }
    }

    fn settle_elements(&self, state: &mut [u8], first: Part, count: usize, window: &Range<usize>) {
        if first.size == 0 || matches!(self.nodes[first.node], Node::Any) {
            return;
        }
        let from = window.start.saturating_sub(first.offset) / first.size;
        let to = (window.end - first.offset).div_ceil(first.size).min(count);
        for position in from..to {
            let offset = first.offset + position * first.size;
            self.settle(state, Part { offset, ..first }, window);
        }
    }

    fn settle_members(&self, state: &mut [u8], whole: Part, parts: &[Part], window: &Range<usize>) {
        let start = window.start.saturating_sub(whole.offset);
        let first = parts.partition_point(|it| it.end() <= start);
        let mut end = first.checked_sub(1).map_or(whole.offset, |before| whole.offset + parts[before].end());
        for part in &parts[first..] {
            let offset = whole.offset + part.offset;
            clear(state, end..offset, window);
            if offset >= window.end {
                return;
            }
            self.settle(state, Part { offset, ..*part }, window);
            end = offset + part.size;
        }
        clear(state, end..whole.end(), window);
    }
}

/// Bytes between variables, as far as they were written.
fn clear(state: &mut [u8], gap: Range<usize>, window: &Range<usize>) {
    let (from, to) = (gap.start.max(window.start), gap.end.min(window.end));
    if from < to {
        state[from..to].fill(0);
    }
}

fn settle_text(bytes: &mut [u8], ty: StringType) {
    let (header, rest) = bytes.split_at_mut(size_of::<u16>());
    let length = u16::from_ne_bytes([header[0], header[1]]).min(ty.capacity);
    header.copy_from_slice(&length.to_ne_bytes());
    rest[usize::from(length) * ty.unit_size() as usize..].fill(0);
}

fn settle_time(bytes: &mut [u8], settled: impl Fn(Time) -> Time) {
    if let Value::I64(time) = Value::read(Repr::I64, bytes) {
        Value::I64(settled(time)).write(bytes);
    }
}

fn settle_number(bytes: &mut [u8], repr: Repr, low: i128, high: i128) {
    let number = Value::read(repr, bytes).as_integer().map(|it| it.max(low).min(high));
    if let Some(value) = number.and_then(|it| repr.integer(it)) {
        value.write(bytes);
    }
}

type Bounds = Option<(i128, i128)>;

struct Builder<'m> {
    map: &'m Map,
    nodes: Vec<Node>,
    known: HashMap<(Type, Bounds), usize>,
}

impl Builder<'_> {
    fn part(&mut self, ty: Type, range: Bounds, offset: usize) -> Part {
        Part { offset, size: self.map.size_of(ty), node: self.node(ty, range) }
    }

    fn node(&mut self, ty: Type, range: Bounds) -> usize {
        if let Some(known) = self.known.get(&(ty, range)) {
            return *known;
        }
        let node = match ty {
            Type::Elementary(it) if it.repr() == Repr::Bool => self.push(Node::Bool),
            Type::Elementary(it) if it.is_day() => self.push(Node::Day),
            Type::Elementary(it) if it.is_time_of_day() => self.push(Node::Clock),
            Type::Elementary(Elementary::Time) => self.time(),
            Type::Elementary(it) => self.number(it.repr(), range),
            // Each use of a reference is checked.
            Type::Enum(_) | Type::Bit(_) | Type::Reference | Type::Characters(_) => self.push(Node::Any),
            Type::String(it) => self.push(Node::Text(it)),
            Type::Array(_) => match self.map.array(ty) {
                Some(array) => self.array(array, range),
                None => self.push(Node::Any),
            },
            Type::Struct(_) | Type::Block(_) => self.members(ty),
        };
        self.known.insert((ty, range), node);
        node
    }

    fn push(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    fn time(&mut self) -> usize {
        self.push(self.map.milliseconds.map_or(Node::Any, |(least, greatest)| Node::Milliseconds(least, greatest)))
    }

    fn number(&mut self, repr: Repr, range: Bounds) -> usize {
        self.push(match range {
            Some((low, high)) => Node::Subrange { repr, low, high },
            None => Node::Any,
        })
    }

    /// A subrange of an array's declaration holds for its elements.
    fn array(&mut self, array: Array, range: Bounds) -> usize {
        let element = self.node(array.element, range);
        match self.nodes[element] {
            Node::Any => element,
            _ => self.push(Node::Array { element, stride: array.stride, count: array.len() }),
        }
    }

    fn members(&mut self, ty: Type) -> usize {
        let members = self.map.structure(ty).map_or(&[][..], |it| &it.members);
        let part = |it: &Variable| self.part(it.ty, it.range, it.offset);
        let parts = members.iter().filter(|it| !it.view).map(part).collect();
        self.structure(parts)
    }

    fn structure(&mut self, mut parts: Vec<Part>) -> usize {
        parts.sort_by_key(|it| it.offset);
        self.push(Node::Structure(parts))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{map, offset_of};

    /// The state of the fixture after `bytes` are written to a variable.
    fn written(path: &str, bytes: &[u8]) -> Vec<u8> {
        let mut state = vec![0; 128];
        Domain::of(&map()).write(&mut state, offset_of(path), bytes);
        state.split_off(offset_of(path))
    }

    #[test]
    fn written_bytes_become_values_of_their_type() {
        assert_eq!(written("up", &[0xFE])[..1], [1]);
        assert_eq!(written("c.Q", &[2])[..1], [1]);
        assert_eq!(written("lamp", &[0x80])[..1], [1]);
        assert_eq!(written("level", &11_i16.to_ne_bytes())[..2], 10_i16.to_ne_bytes());
        assert_eq!(written("level", &(-1_i16).to_ne_bytes())[..2], [0, 0]);
        assert_eq!(written("level", &7_i16.to_ne_bytes())[..2], 7_i16.to_ne_bytes());
        // No name has this number, and no REAL these bits.
        assert_eq!(written("colour", &[0xFF; 2])[..2], [0xFF; 2]);
        assert_eq!(written("speed", &[0xFF; 4])[..4], [0xFF; 4]);
    }

    #[test]
    fn a_time_is_moved_to_the_milliseconds_of_the_dialect() {
        let domain = Domain::of(&Map { milliseconds: Some((0, 5000)), ..map() });
        let at = offset_of("pause");
        for (written, held) in [(-1, 0), (i64::MIN, 0), (1_999_999, 1_000_000), (i64::MAX, 5_000_000_000)] {
            let mut state = vec![0; 128];
            domain.write(&mut state, at, &i64::to_ne_bytes(written));
            assert_eq!(state[at..at + 8], i64::to_ne_bytes(held), "{written}");
        }
    }

    #[test]
    fn a_string_ends_within_its_capacity_and_zeros_follow() {
        assert_eq!(written("name", &[0xFF, 0xFF, 1, 2, 3, 4])[..6], [4, 0, 1, 2, 3, 4]);
        assert_eq!(written("name", &[1, 0, 1, 2, 3, 4])[..6], [1, 0, 1, 0, 0, 0]);
        // The length alone, over characters that were there before.
        let (domain, at) = (Domain::of(&map()), offset_of("name"));
        let mut state = vec![0; 128];
        domain.write(&mut state, at, &[4, 0, 1, 2, 3, 4]);
        domain.write(&mut state, at + 1, &[1]);
        assert_eq!(state[at..at + 6], [4, 0, 1, 2, 3, 4]);
        domain.write(&mut state, at, &[2]);
        assert_eq!(state[at..at + 6], [2, 0, 1, 2, 0, 0]);
    }

    #[test]
    fn bytes_of_no_variable_become_zero_where_they_are_written() {
        let domain = Domain::of(&map());
        let mut state = vec![0xAA; 128];
        // The byte after `c.Q` is padding, and so is the end of the state.
        let padding = offset_of("c.Q") + 1;
        domain.write(&mut state, padding, &[9]);
        assert_eq!((state[padding - 1], state[padding], state[padding + 1]), (0xAA, 0, 0xAA));
        domain.write(&mut state, 120, &[9; 8]);
        assert_eq!(state[119..], [0xAA, 0, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn a_second_writing_changes_nothing() {
        let domain = Domain::of(&map());
        let mut random = 1_u32;
        for _ in 0..if cfg!(miri) { 1 } else { 100 } {
            let mut next = || {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (random >> 24) as u8
            };
            let bytes: Vec<u8> = (0..128).map(|_| next()).collect();
            let mut once = vec![0; 128];
            domain.write(&mut once, 0, &bytes);
            let mut twice = vec![0; 128];
            domain.write(&mut twice, 0, &once);
            assert_eq!(once, twice);
            // Values are written over values, byte by byte.
            let mut slowly = once.clone();
            (0..128).for_each(|at| domain.write(&mut slowly, at, &once[at..=at]));
            assert_eq!(once, slowly);
        }
    }

    #[test]
    fn values_have_boundaries() {
        let domain = Domain::of(&map());
        let name = offset_of("name");
        assert!(domain.is_boundary(0) && domain.is_boundary(128));
        assert!(domain.is_boundary(name) && !domain.is_boundary(name + 1) && domain.is_boundary(name + 6));
        assert!(domain.is_boundary(offset_of("m[2,0]")) && domain.is_boundary(offset_of("c.CV")));
        // Any bytes make a number.
        assert!(domain.is_boundary(offset_of("c.CV") + 1) && !domain.is_boundary(offset_of("level") + 1));
    }

    #[test]
    #[should_panic(expected = "the state of another program")]
    fn a_state_of_another_size_is_refused() {
        Domain::of(&map()).write(&mut [0; 64], 0, &[0]);
    }
}
