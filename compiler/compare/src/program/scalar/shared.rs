//! Bits that several variables share, and the members of a UNION: what keeps them has a name that nobody has declared. They are
//! told by the variables that they are, the largest ones, which share nothing with each other.

use super::{MAX_ELEMENTS, Role, Walk, Whole};
use staunch_ir::layout::usize_of;
use staunch_ir::{Area, FieldId, Place, Projection, Root, Section, StructId, Type, Variable};
use std::collections::HashSet;
use std::ops::Range;

/// A variable that is some of the bits.
pub struct View {
    path: String,
    ty: Type,
    /// In what keeps it.
    bit: u64,
    is_bit: bool,
    pub area: Option<Area>,
}

/// A scalar of a view.
struct Leaf {
    path: String,
    ty: Type,
    /// In what keeps it.
    bytes: Range<usize>,
    /// It has values, which are those of its bytes.
    is_number: bool,
}

impl Leaf {
    fn meets(&self, bytes: &Range<usize>) -> bool {
        self.bytes.start < bytes.end && bytes.start < self.bytes.end
    }

    /// Not every value of its bytes is one of its own.
    fn is_narrow(&self) -> bool {
        matches!(self.ty, Type::BOOL | Type::Enum(_) | Type::Subrange(..))
    }
}

impl Walk<'_> {
    /// The variables of the PROGRAMs that run, and of the globals, that are bits of a field of the globals.
    pub fn views_of_global(&self, id: StructId, field: FieldId) -> Vec<View> {
        let program = self.program;
        if id != program.globals || program.structure(id).fields[field.index()].section != Section::Internal {
            return Vec::new();
        }
        let is_in = |place: &Place| {
            place.root == Root::Globals && matches!(place.projections[..], [Projection::Field(it)] if it == field)
        };
        let view = |prefix: &str, it: &Variable| {
            let view = it.view.filter(|_| is_in(&it.place))?;
            let (path, is_bit) = (format!("{prefix}{}", it.name), view.ty == Type::BOOL);
            Some(View { path, ty: view.ty, bit: view.bit, is_bit, area: Some(view.address.area) })
        };
        let mut found = Vec::new();
        let is_global = |own: &Variable| {
            let is = |name: &str| name.eq_ignore_ascii_case(&own.name);
            let is_other = |it: &Variable| it.view != own.view || !is_in(&it.place);
            let fields = &program.structure(id).fields;
            fields.iter().any(|it| is(&it.name)) || program.aliases.iter().any(|it| is(&it.name) && is_other(it))
        };
        for instance in &program.instances {
            // A global one may have the same name.
            let full = format!("{}.", instance.name);
            let prefix = |it: &Variable| match program.instances.len() > 1 || is_global(it) {
                true => full.as_str(),
                false => "",
            };
            found.extend(program.class(instance.program).variables.iter().filter_map(|it| view(prefix(it), it)));
        }
        found.extend(program.aliases.iter().filter_map(|it| view("", it)));
        found
    }

    /// The members of a structure that are bits of a field of it.
    pub fn views_of_member(&self, path: &str, id: StructId, field: FieldId) -> Vec<View> {
        let overlays = self.program.structure(id).overlays.iter().filter(|it| it.field == field);
        let view = overlays.map(|it| {
            let path = format!("{path}.{}", it.name);
            View { path, ty: it.ty, bit: it.bit, is_bit: it.is_bit, area: None }
        });
        view.collect()
    }

    /// A variable, or what keeps the bits of views, by these.
    pub fn kept(&mut self, path: &str, ty: Type, views: &[View], whole: Whole) {
        if views.is_empty() {
            return self.part(path, ty, whole);
        }
        let mut leaves = Vec::new();
        for view in views {
            let start = usize_of(view.bit / 8);
            if view.is_bit {
                let (path, ty, bytes) = (view.path.clone(), view.ty, start..start + 1);
                leaves.push(Leaf { path, ty, bytes, is_number: false });
            } else {
                self.leaves(&view.path, view.ty, start, &mut leaves);
            }
        }
        let units = self.units(path, ty);
        let is_touched = |bytes: &Range<usize>| leaves.iter().any(|it| it.meets(bytes));
        // Bytes between the members of a structure belong to no variable.
        let gaps: Vec<_> = units.iter().filter(|it| !is_touched(&it.1)).map(|it| it.1.start).collect();
        let (texts, others): (Vec<Leaf>, Vec<Leaf>) =
            leaves.into_iter().partition(|it| matches!(it.ty, Type::String(_)));
        let of_others: Vec<_> = others.iter().map(|it| it.bytes.clone()).collect();
        let shown = apart(others);
        let covered =
            |bytes: &Range<usize>| bytes.clone().filter(|at| shown.iter().any(|it| it.bytes.contains(at))).count();
        let end = units.last().map_or(0, |it| it.1.end);
        let is_torn = units.iter().any(|it| !matches!(covered(&it.1), 0) && covered(&it.1) != it.1.len());
        if shown.is_empty() && texts.is_empty() || is_torn || shown.iter().chain(&texts).any(|it| it.bytes.end > end) {
            return self.part(path, ty, whole);
        }
        let element = self.unit(ty);
        let rest = units.into_iter().filter(|it| covered(&it.1) == 0).map(|it| (it.1.start, it.0, element));
        let mut all: Vec<_> = rest.collect();
        all.extend(shown.iter().map(|it| (it.bytes.start, it.path.clone(), it.ty)));
        all.sort_by_key(|it| it.0);
        // A text is shown whole, in place of bytes that no number has.
        let is_others = |at: usize| of_others.iter().any(|it| it.contains(&at));
        let of_text = |at: usize| texts.iter().position(|it| it.bytes.contains(&at) && !is_others(at));
        let mut told = HashSet::new();
        for (at, path, ty) in all {
            if let Some(number) = of_text(at) {
                let text: &Leaf = &texts[number];
                if told.insert(number) {
                    let part = Whole { offset: whole.offset + text.bytes.start, is_shared: true, ..whole.clone() };
                    self.part(&text.path, text.ty, part);
                }
                self.part(&path, ty, Whole { offset: whole.offset + at, role: Role::Hidden, ..whole.clone() });
                continue;
            }
            let role = if gaps.contains(&at) { Role::Hidden } else { whole.role };
            self.part(&path, ty, Whole { offset: whole.offset + at, role, ..whole.clone() });
        }
    }

    /// What keeps bits is made of these.
    fn unit(&self, ty: Type) -> Type {
        if let Type::Array(id) = ty { self.program.array(id).element } else { ty }
    }

    fn units(&self, path: &str, ty: Type) -> Vec<(String, Range<usize>)> {
        let size = usize_of(self.layout.size(self.unit(ty)));
        let Type::Array(id) = ty else { return vec![(path.to_owned(), 0..size)] };
        let array = self.program.array(id);
        if array.len() > MAX_ELEMENTS || matches!(array.element, Type::Array(_) | Type::Struct(_) | Type::Block(_)) {
            return Vec::new();
        }
        let unit = |(at, index): (usize, i64)| (format!("{path}[{index}]"), at * size..(at + 1) * size);
        (array.low..=array.high).enumerate().map(unit).collect()
    }

    fn leaves(&self, path: &str, ty: Type, start: usize, out: &mut Vec<Leaf>) {
        let is_number = matches!(ty, Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_));
        match ty {
            Type::Array(id) => {
                let array = self.program.array(id);
                let stride = usize_of(self.layout.stride(id));
                for (at, index) in (array.low..=array.high).enumerate().take(usize_of(MAX_ELEMENTS * 8)) {
                    self.leaves(&format!("{path}[{index}]"), array.element, start + at * stride, out);
                }
            }
            Type::Struct(id) if self.program.structure(id).overlays.is_empty() => {
                for (at, field) in self.program.structure(id).fields.iter().enumerate() {
                    let offset = start + usize_of(self.layout.field(id, FieldId::next(at)));
                    self.leaves(&format!("{path}.{}", field.name), field.ty, offset, out);
                }
            }
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Enum(_)
            | Type::String(_)
            | Type::Reference(_)
            | Type::Block(_)
            | Type::Struct(_) => {
                let bytes = start..start + size(ty).unwrap_or_else(|| usize_of(self.layout.size(ty)));
                out.push(Leaf { path: path.to_owned(), ty, bytes, is_number });
            }
        }
    }
}

/// Bytes of a text among bits that others share: it has a zero at its end in place of a length.
pub fn size(ty: Type) -> Option<usize> {
    ty.string_type().map(|it| (usize::from(it.capacity) + 1) * usize_of(it.unit_size().into()))
}

/// The largest of them that share nothing. One of few values is only shown for bytes that have no others.
fn apart(mut leaves: Vec<Leaf>) -> Vec<Leaf> {
    leaves.sort_by_key(|it| core::cmp::Reverse(it.bytes.len()));
    let is_whole = |leaf: &Leaf| {
        let other = |it: &Leaf| it.meets(&leaf.bytes) && (it.ty != leaf.ty || it.bytes != leaf.bytes || !it.is_number);
        leaf.is_number && !(leaf.is_narrow() && leaves.iter().any(other))
    };
    let whole: Vec<bool> = leaves.iter().map(is_whole).collect();
    let mut found: Vec<Leaf> = Vec::new();
    for (leaf, is_whole) in leaves.into_iter().zip(whole) {
        if is_whole && !found.iter().any(|it| it.meets(&leaf.bytes)) {
            found.push(leaf);
        }
    }
    found
}
