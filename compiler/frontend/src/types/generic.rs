//! Generic FUNCTIONs of a user, whose parameters are of ANY, ANY_NUM and the like. Each of these words is one type
//! in a call; for each set of types that calls give them there is one instance, which is checked and becomes a
//! routine like any other FUNCTION.

use crate::diagnostic::Sentence;
use crate::{Code, Span, ast};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::Type;
use staunch_runtime::Class;

/// Which types a generic FUNCTION is checked with.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    /// The slot of the FUNCTION as it is written.
    pub of: usize,
    /// For each of its words, in their order.
    pub types: Vec<Type>,
    /// The name that it has for back ends.
    pub name: String,
    /// The first call that asks for it.
    pub call: Span,
    /// The instance whose body has that call.
    pub within: Option<usize>,
}

/// The instances that calls have asked for.
#[derive(Default)]
pub(crate) struct Generics {
    pub slots: FxHashMap<(usize, Vec<Type>), usize>,
    pub counts: FxHashMap<usize, usize>,
    pub names: FxHashSet<String>,
    /// What the words mean in the signature that is being made.
    pub words: Vec<(Class, Type)>,
    /// What was reported of one instance of a FUNCTION.
    pub reported: FxHashSet<(Code, Span, Sentence)>,
}

/// The class that a word names.
pub(crate) fn class_named(word: &str) -> Option<Class> {
    let is_any = word.get(..3).is_some_and(|it| it.eq_ignore_ascii_case("ANY"));
    let mut named = Class::ALL.iter().filter(|_| is_any);
    named.find(|it| it.name().eq_ignore_ascii_case(word)).copied()
}

/// The words in a type, in the order of the text.
pub(crate) fn names_in<'a, 's>(spec: &'a ast::TypeSpec<'s>, found: &mut Vec<&'a ast::Name<'s>>) {
    match &spec.kind {
        ast::TypeKind::Named(path) => found.extend(path.iter().take(usize::from(path.len() == 1))),
        ast::TypeKind::Array { element, .. } => names_in(element, found),
        ast::TypeKind::Struct(members) | ast::TypeKind::Union(members) => {
            members.iter().for_each(|it| names_in(&it.ty, found))
        }
        ast::TypeKind::Reference { target, .. } => names_in(target, found),
        ast::TypeKind::Subrange { base, .. } => found.push(base),
        ast::TypeKind::Enum { .. } | ast::TypeKind::String { .. } | ast::TypeKind::Error => {}
    }
}
