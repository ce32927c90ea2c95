//! Declarations of counters, and what they start with.

use super::Writer;
use crate::other::logix::counter::Counter;
use crate::other::logix::edit::bounds;
use crate::other::logix::shape::Shape;
use staunch_frontend::Span;
use staunch_frontend::ast::{Initial, InitialKind, Name, TypeKind, TypeSpec, VarBlock, VarDecl};

impl<'f> Writer<'_, 'f> {
    pub(super) fn block(&mut self, block: &'f VarBlock<'f>) {
        block.vars.iter().for_each(|it| self.declaration(it));
    }

    fn declaration(&mut self, decl: &'f VarDecl<'f>) {
        self.ty(&decl.ty);
        let Some(initial) = &decl.initial else { return };
        match (self.shapes.of_type(&decl.ty), &initial.kind) {
            (Some(Shape::Counter(counter)), InitialKind::Fields(fields)) => {
                let kept = self.fields(counter, fields);
                let text = if kept.is_empty() { String::new() } else { format!(" := ({})", kept.join(", ")) };
                self.edit(Span { start: decl.ty.span.end, ..initial.span }, text);
            }
            (Some(shape), _) => self.initial(shape, initial),
            (None, _) => {}
        }
    }

    /// The counters in a type that is written out.
    pub(super) fn ty(&mut self, ty: &'f TypeSpec<'f>) {
        match &ty.kind {
            TypeKind::Named(_) => {
                if let (Some(Shape::Counter(counter)), true) = (self.shapes.of_type(ty), self.is_block(ty)) {
                    self.edit(ty.span, counter.tag.name.to_owned());
                }
            }
            TypeKind::Array { element, .. } => self.ty(element),
            TypeKind::Reference { target, .. } => self.ty(target),
            TypeKind::Struct(members) | TypeKind::Union(members) => {
                members.iter().for_each(|it| self.declaration(it));
            }
            TypeKind::String { .. } | TypeKind::Subrange { .. } | TypeKind::Enum { .. } | TypeKind::Error => {}
        }
    }

    /// Whether a type names the block itself, and not a type that is one.
    fn is_block(&self, ty: &TypeSpec<'_>) -> bool {
        match &ty.kind {
            TypeKind::Named(names) => {
                names.len() == 1 && Counter::named(names[0].text, self.shapes.dialect()).is_some()
            }
            TypeKind::String { .. }
            | TypeKind::Subrange { .. }
            | TypeKind::Array { .. }
            | TypeKind::Struct(_)
            | TypeKind::Enum { .. }
            | TypeKind::Reference { .. }
            | TypeKind::Union(_)
            | TypeKind::Error => false,
        }
    }

    /// The initial values of counters in arrays and structures.
    pub(super) fn initial(&mut self, shape: Shape<'f>, initial: &Initial<'_>) {
        match (&initial.kind, shape) {
            (InitialKind::Fields(fields), Shape::Counter(counter)) => {
                let kept = self.fields(counter, fields);
                let text = if kept.is_empty() { "PRE := 0".to_owned() } else { kept.join(", ") };
                self.edit(initial.span, format!("({text})"));
            }
            (InitialKind::Fields(fields), _) => {
                for (name, value) in fields {
                    if let Some(shape) = self.shapes.member(shape, *name) {
                        self.initial(shape, value);
                    }
                }
            }
            (InitialKind::Elements(elements), _) => {
                let Some(shape) = self.shapes.element(shape) else { return };
                elements.iter().flat_map(|it| &it.values).for_each(|it| self.initial(shape, it));
            }
            (InitialKind::Value(_) | InitialKind::Bind(_) | InitialKind::Indexed(_) | InitialKind::Members(_), _) => {}
        }
    }

    fn fields(&self, counter: Counter, fields: &[(Name<'_>, Initial<'_>)]) -> Vec<String> {
        fields.iter().filter_map(|it| self.field(counter, it)).collect()
    }

    /// An initial value by its tag's name; none where the tag needs none.
    fn field(&self, counter: Counter, (name, value): &(Name<'_>, Initial<'_>)) -> Option<String> {
        let (start, end) = bounds(value.span);
        let value = &self.text[start..end];
        match counter.member(name.text).filter(|_| !counter.is_empty(name.text)) {
            Some(tag) => Some(format!("{tag} := {value}")),
            // An input that is FALSE does nothing, and an output is computed anew by each call.
            None if value.eq_ignore_ascii_case("FALSE") || counter.is_empty(name.text) => None,
            // Nothing stands for it; the compiler says so at this place.
            None => Some(format!("{} := {value}", name.text)),
        }
    }
}
