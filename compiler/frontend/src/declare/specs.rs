//! Type specifications to types.

use super::run::configurations;
use crate::ast::{self, Bound, TypeKind};
use crate::diagnostic::wording::all_of;
use crate::diagnostic::{Missing, Subject};
use crate::dialect::rules::InitialValues;
use crate::dialect::{self, Dialect, missing};
use crate::expr::unresolved::{block_of_another_dialect, no_such_block};
use crate::index::recorder::Named;
use crate::names::{Entry, Found, Meaning, Sense};
use crate::prelude;
use crate::spelling::{Key, nearest};
use crate::types::declarations::Declarations;
use crate::types::generic::class_named;
use crate::types::scope::{Scope, Variable};
use crate::types::table::{PendingReference, Resolved, instance_of, scalar_initial};
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashMap;
use staunch_ir::{
    Array, ArrayId, BoundsId, Const, Elementary, Enum, EnumId, Enumerator, Part, RefKind, RefType, ReferenceId,
    StringType, Type, Use, Value,
};
use staunch_runtime::Family;
use std::rc::Rc;

/// A variable larger than this many bytes is refused.
pub(crate) const MAX_SIZE: u64 = 1 << 30;
/// The initial values of all variables hold at most so many constants.
const MAX_CONSTANTS: usize = 1 << 20;
/// An array of arrays is refused beyond so many dimensions: rustc takes no type that is much deeper.
const MAX_DIMENSIONS: usize = 64;
/// Longest string.
const MAX_CAPACITY: i128 = 32767;

/// The most where a system has no such limit: a length has 16 bits.
const LONG_CAPACITY: i128 = 65534;

/// Types of SIMATIC S7 that are not the standard's, and what to write for them.
const OF_SIMATIC: [(&str, &str); 3] = [
    ("S5TIME", "write `TIME`, with literals `T#2s`: the standard's timers take it, and it counts exactly"),
    ("VARIANT", "write a FUNCTION with the same name for each type, or parameters of `ANY` or `ANY_NUM`"),
    ("IEC_COUNTER", "write the counter's type: `S7.CTU`, `S7.CTD` or `S7.CTUD`"),
];

/// What other languages call elementary types.
const FOREIGN: [(&str, &str); 42] = [
    ("INTEGER", "INT"),
    ("SHORT", "INT"),
    ("LONG", "DINT"),
    ("BOOLEAN", "BOOL"),
    ("BIT", "BOOL"),
    ("FLOAT", "REAL"),
    ("FLOAT32", "REAL"),
    ("SINGLE", "REAL"),
    ("DOUBLE", "LREAL"),
    ("FLOAT64", "LREAL"),
    ("INT8", "SINT"),
    ("INT16", "INT"),
    ("INT32", "DINT"),
    ("INT64", "LINT"),
    ("UINT8", "USINT"),
    ("UINT16", "UINT"),
    ("UINT32", "UDINT"),
    ("UINT64", "ULINT"),
    ("UNSIGNED", "UINT"),
    ("I8", "SINT"),
    ("I16", "INT"),
    ("I32", "DINT"),
    ("I64", "LINT"),
    ("U8", "USINT"),
    ("U16", "UINT"),
    ("U32", "UDINT"),
    ("U64", "ULINT"),
    ("F32", "REAL"),
    ("F64", "LREAL"),
    ("INT8_T", "SINT"),
    ("INT16_T", "INT"),
    ("INT32_T", "DINT"),
    ("INT64_T", "LINT"),
    ("UINT8_T", "USINT"),
    ("UINT16_T", "UINT"),
    ("UINT32_T", "UDINT"),
    ("UINT64_T", "ULINT"),
    ("STR", "STRING"),
    ("TEXT", "STRING"),
    ("TIMER", "TON"),
    ("COUNT", "CTU"),
    ("DURATION", "TIME"),
];

/// Where something is declared, as far as that decides whether it starts with its initial value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Within {
    /// A FUNCTION_BLOCK, a FUNCTION or what is in one.
    Pou,
    Structure,
    /// A PROGRAM, or global variables.
    Program,
    /// The inputs of a PROGRAM, which the world outside gives.
    Input,
}

impl Within {
    pub(super) fn of(pou: &ast::Pou<'_>) -> Self {
        if pou.kind == ast::PouKind::Program { Self::Program } else { Self::Pou }
    }
}

impl<'s> Declarations<'s> {
    pub(super) fn resolve_type_slot(&mut self, at: usize) -> Option<Resolved> {
        let decl = self.types[at].decl;
        let scope = Rc::new(Scope::default());
        let doc = decl.doc.clone();
        let name = self.name_in_full(decl.name);
        if let Some(span) = decl.is_abstract.filter(|it| !self.dialect(*it).has_abstract_types()) {
            self.report(
                Diagnostic::new(Code::E0403, span, format!("the TYPE `{}` cannot be ABSTRACT", decl.name.text))
                    .label("TwinCAT has that, for structures that others extend")
                    .help("delete the word: a structure without it can be extended as well"),
            );
        }
        let mut resolved = match (&decl.base, &decl.ty.kind) {
            (Some(base), TypeKind::Struct(members)) => {
                let base = self.base_structure(base)?;
                let most = decl.pack.map(|it| it.0);
                self.structure(members, (Some(base), most), &scope, &name, doc, decl.ty.span)?
            }
            (None, TypeKind::Struct(members)) => {
                let most = decl.pack.map(|it| it.0);
                self.structure(members, (None, most), &scope, &name, doc, decl.ty.span)?
            }
            (Some(base), _) => {
                self.report_no_structure(base);
                return None;
            }
            (None, _) => self.resolve_type_named(&decl.ty, &scope, &name, doc)?,
        };
        if let (Type::Enum(id), TypeKind::Enum { .. }) = (resolved.ty, &decl.ty.kind) {
            let has = |wanted: &str| decl.attributes.iter().any(|it| it.eq_ignore_ascii_case(wanted));
            self.table.strict.extend(has("strict").then_some(id));
            if has("qualified_only") {
                self.table.qualified.insert(id);
                self.names.anonymous_enumerators.retain(|_, it| it.0 != resolved.ty);
            }
            self.table.spelled.extend(has("to_string").then_some(id));
            let names_values = matches!(decl.ty.kind, TypeKind::Enum { base: Some(_), .. });
            self.table.named_values.extend((names_values && !has("strict")).then_some(id));
        }
        self.note_type(decl, resolved.ty);
        if let Some(initial) = &decl.initial {
            if self.has_flat_rows(&decl.ty, initial) {
                return None;
            }
            resolved.initial = self.initial(initial, &resolved, &scope)?;
        }
        if let (Type::Enum(_), Const::Scalar(first)) = (resolved.ty, &resolved.initial)
            && first.as_integer() != Some(0)
        {
            self.note_part(Part::EnumStart, decl.name.span);
        }
        Some(resolved)
    }

    /// Notes what other compilers make something else of.
    fn note_type(&mut self, decl: &ast::TypeDecl<'s>, ty: Type) {
        let is_named = matches!(decl.ty.kind, TypeKind::Named(_));
        match ty {
            Type::Subrange(..) => self.note_part(Part::NamedNumber, decl.name.span),
            Type::Elementary(it) if is_named && (it.is_integer() || it.is_bits() && it != Elementary::Bool) => {
                self.note_part(Part::NamedNumber, decl.name.span);
            }
            Type::String(_) if matches!(decl.ty.kind, TypeKind::String { .. }) => {
                self.note_part(Part::NamedText, decl.name.span);
            }
            _ => {}
        }
    }

    /// Notes a PROGRAM without a TASK where another has one.
    pub(super) fn note_tasks(&mut self, files: &[ast::File<'s>]) {
        for resource in configurations(files).flat_map(|it| &it.resources) {
            let without = resource.programs.iter().find(|it| it.task.is_none());
            if let Some(run) = without.filter(|_| resource.programs.iter().any(|it| it.task.is_some())) {
                self.note_part(Part::NoTask, run.name.span);
            }
        }
    }

    pub(super) fn note_part(&mut self, part: Part, span: Span) {
        let at = self.location(span);
        self.program.uses.note(Use::Part(part), at);
    }

    /// The type of a declared variable, with the variable's own initial value.
    pub(super) fn declared_type(
        &mut self,
        decl: &'s ast::VarDecl<'s>,
        scope: &Rc<Scope<'s>>,
        name: &str,
        within: Within,
    ) -> Option<Resolved> {
        let mut resolved = self.resolve_type_named(&decl.ty, scope, name, None)?;
        self.check_construction(decl, resolved.ty);
        let starts_by_itself = decl.initial.is_none() && within != Within::Input;
        if starts_by_itself
            && let (Type::Subrange(..), Some((least, greatest))) = (resolved.ty, self.program.range(resolved.ty))
            && !(least..=greatest).contains(&0)
        {
            self.note_part(Part::SubrangeStart, decl.span);
        }
        if let Some(initial) = &decl.initial {
            // A refused value has been reported; the type is known anyway.
            let is_flat = self.has_flat_rows(&decl.ty, initial);
            let value = if is_flat { None } else { self.initial(initial, &resolved, scope) };
            let is_written = !decl.names.first().is_some_and(|it| crate::added::is_added(it.text));
            let is_left_out = is_written && self.leaves_out(initial, resolved.ty, within);
            if is_left_out && (value.is_some() || is_flat) {
                self.report_left_out(decl, initial);
            } else if !is_left_out {
                resolved.initial = value.unwrap_or(resolved.initial);
            }
        }
        self.count_constants(&mut resolved, decl);
        Some(resolved)
    }

    /// Whether the system does not apply an initial value.
    fn leaves_out(&self, initial: &ast::Initial<'s>, ty: Type, within: Within) -> bool {
        let is_computed = matches!(&initial.kind, ast::InitialKind::Value(it) if !is_plain(it));
        let is_left_out = match within {
            Within::Pou => false,
            Within::Structure => matches!(ty, Type::Array(_)),
            Within::Program | Within::Input => {
                matches!(ty, Type::Array(_)) || is_computed && matches!(ty, Type::Elementary(_))
            }
        };
        is_left_out && self.dialect(initial.span).rules().initial_values.choice == InitialValues::OfStrucpp
    }

    fn report_left_out(&mut self, decl: &ast::VarDecl<'s>, initial: &ast::Initial<'s>) {
        if let Some(name) = decl.names.first() {
            self.report(
                Diagnostic::new(
                    Code::W0415,
                    initial.span,
                    format!("`{}` does not start with this value in OpenPLC", name.text),
                )
                .label("here STruC++ 0.6.1 ignores arrays and expressions, and applies only a number or a name")
                .help("assign it in the first scan, or declare it in a FUNCTION_BLOCK"),
            );
        }
    }

    /// Refuses an initial value with which all of them would hold too many constants: a structure
    /// of structures of structures holds very many soon.
    fn count_constants(&mut self, resolved: &mut Resolved, decl: &ast::VarDecl<'s>) {
        let own = constants(&resolved.initial).saturating_mul(decl.names.len());
        if self.table.constants.saturating_add(own) <= MAX_CONSTANTS {
            self.table.constants += own;
            return;
        }
        resolved.initial = Const::Zero;
        let message = format!("the initial values hold more than {MAX_CONSTANTS} constants");
        self.report(
            Diagnostic::new(Code::E0901, decl.span, message).label(format!("this declaration has {own} of them")),
        );
    }

    /// `name` is what an anonymous structure or enumeration is called after.
    pub(super) fn resolve_type_named(
        &mut self,
        spec: &'s ast::TypeSpec<'s>,
        scope: &Rc<Scope<'s>>,
        name: &str,
        doc: Option<String>,
    ) -> Option<Resolved> {
        match &spec.kind {
            TypeKind::Named(path) => self.resolve_path(path, spec.span),
            TypeKind::String { wide, capacity } => self.string(*wide, capacity.as_deref(), scope, spec.span),
            TypeKind::Subrange { base, low, high } => self.subrange(*base, low, high, scope),
            TypeKind::Array { bounds, element } => self.array_type(bounds, element, scope, name, spec.span),
            TypeKind::Struct(members) => self.structure(members, (None, None), scope, name, doc, spec.span),
            TypeKind::Union(members) => self.union(members, scope, name, doc, spec.span),
            TypeKind::Enum { base, values } => self.enumeration(*base, values, scope, name, doc, spec.span),
            TypeKind::Reference { kind, target } => self.reference(*kind, target, scope, name),
            // The parser has said so.
            TypeKind::Error => None,
        }
    }

    /// What a reference points to is looked up when all is declared, where it has a name of its own.
    fn reference(
        &mut self,
        kind: RefKind,
        target: &'s ast::TypeSpec<'s>,
        scope: &Rc<Scope<'s>>,
        name: &str,
    ) -> Option<Resolved> {
        let named = match &target.kind {
            TypeKind::Named(path) => Some(path.as_slice()),
            _ => None,
        };
        if let Some(path) = named
            && !matches!(path, [name] if Elementary::named(name.text).is_some() || self.class_word(*name).is_some())
        {
            return Some(Resolved::plain(Type::Reference(self.reference_to_named(kind, path, target.span))));
        }
        let target = self.resolve_type_named(target, scope, name, None)?.ty;
        Some(Resolved::plain(self.reference_type(kind, target)))
    }

    fn reference_to_named(&mut self, kind: RefKind, path: &'s [ast::Name<'s>], span: Span) -> ReferenceId {
        self.note_path(path, &self.lookup(path, Sense::Type));
        let named = (kind, path.iter().map(|it| Key(it.text)).collect::<Vec<_>>());
        let alike = self.table.references_to.get(&named).into_iter().flatten();
        let mut alike = alike.map(|at| self.table.pending_references[*at]);
        // A name may mean another type in another namespace.
        if let Some(known) = alike.find(|it| self.lookup(it.path, Sense::Type) == self.lookup(path, Sense::Type)) {
            return known.id;
        }
        let id = ReferenceId::next(self.program.references.len());
        self.table.references_to.entry(named).or_default().push(self.table.pending_references.len());
        // It is put right by `settle_references`.
        self.program.references.push(RefType { kind, target: Type::BOOL });
        self.table.pending_references.push(PendingReference { id, path, span });
        id
    }

    /// Looks up what references point to, when all types are declared.
    pub(super) fn settle_references(&mut self) {
        for at in 0..self.table.pending_references.len() {
            let PendingReference { id, path, span, .. } = self.table.pending_references[at];
            if let Some(ty) = self.class_at(path).or_else(|| Some(self.resolve_path(path, span)?.ty)) {
                self.program.references[id.index()].target = ty;
            } else {
                self.table.unknown_references.insert(id);
            }
        }
        self.table.index.references.clear();
        for (at, reference) in self.program.references.iter().enumerate() {
            if self.table.unknown_references.contains(&ReferenceId::next(at)) {
                continue;
            }
            self.table.index.references.entry(*reference).or_insert(ReferenceId::next(at));
        }
    }

    /// The instances of a class that a path names; of an ABSTRACT one there are those of its heirs.
    pub(super) fn class_at(&mut self, path: &[ast::Name<'s>]) -> Option<Type> {
        let found = self.lookup(path, Sense::Type);
        let Found::One(Meaning::Declared(Entry::Pou(at))) = found else { return None };
        if !self.pous[at].ast.kind.is_block() {
            return None;
        }
        self.note_path(path, &found);
        self.signature(at)?.state.map(Type::Struct)
    }

    pub(super) fn resolve_path(&mut self, path: &[ast::Name<'s>], span: Span) -> Option<Resolved> {
        if let [name] = path {
            return self.resolve_name(*name);
        }
        let (name, around) = path.split_last()?;
        self.offer_in(around, *name, Sense::Type);
        let found = self.lookup(path, Sense::Type);
        self.note_path(path, &found);
        match found {
            Found::One(Meaning::Declared(Entry::Type(at))) => self.named_type(at),
            Found::One(Meaning::Declared(Entry::Pou(at))) => self.instance_type(at, *name),
            Found::One(Meaning::Block(block)) => Some(block_type(block)),
            Found::Several(meanings) => {
                self.report_ambiguous(*name, &meanings);
                None
            }
            Found::One(_) | Found::Nothing => {
                self.report_unknown_qualified(around, *name, span);
                None
            }
        }
    }

    fn report_unknown_qualified(&mut self, around: &[ast::Name<'s>], name: ast::Name<'s>, span: Span) {
        if self.names.space_at(self.site(name.span), around).is_some() {
            let error = self.not_in_namespace(Code::E0102, around, name);
            self.report(error);
            return;
        }
        if let Some(error) = self.not_in_library(Code::E0102, around, name) {
            self.report(error);
            return;
        }
        // The first part that is not there.
        let known =
            (1..around.len()).rev().find(|it| self.names.space_at(self.site(name.span), &around[..*it]).is_some());
        let full = around.iter().take(known.unwrap_or(0) + 1).map(|it| it.text).collect::<Vec<_>>().join(".");
        let error = match Family::named(&full) {
            Some(family) => no_such_block(family, name),
            None => {
                let families = Family::ALL.map(Family::name);
                let libraries: Vec<_> = self.names.libraries().collect();
                let help = match libraries.as_slice() {
                    [] => format!("the families of blocks are {}", all_of(&families)),
                    libraries => {
                        format!("the project's libraries are {}, by their files or folders", all_of(libraries))
                    }
                };
                let place = around.first().map_or(span, |it| it.span);
                let known = || self.library_not_there(&full, place);
                self.not_there(&full, place)
                    .or_else(known)
                    .unwrap_or_else(|| Diagnostic::missing(Missing::Namespace, &full, place).help(help))
            }
        };
        self.report(error);
    }

    fn resolve_name(&mut self, name: ast::Name<'s>) -> Option<Resolved> {
        self.offer_types(name);
        let rules = self.dialect(name.span).rules();
        if let Some(elementary) = rules.named(name.text) {
            self.log.note(name.span, || Named::Elementary(elementary));
            let initial = scalar_initial(rules.first_value(elementary));
            return Some(Resolved { ty: Type::Elementary(elementary), initial });
        }
        let found = self.lookup(&[name], Sense::Type);
        self.note_path(&[name], &found);
        match found {
            Found::One(Meaning::Declared(Entry::Type(at))) => self.named_type(at),
            Found::One(Meaning::Declared(Entry::Pou(at))) => self.instance_type(at, name),
            Found::One(Meaning::Block(block)) => Some(block_type(block)),
            Found::Several(meanings) => {
                self.report_ambiguous(name, &meanings);
                None
            }
            Found::One(_) | Found::Nothing => {
                if let Some(class) = class_named(name.text) {
                    self.log.note(name.span, || Named::Word);
                    return self.generic_type(class, name);
                }
                self.report_unknown_type(name);
                None
            }
        }
    }

    /// The state of a FUNCTION_BLOCK: the type of its instances.
    fn instance_type(&mut self, at: usize, name: ast::Name<'s>) -> Option<Resolved> {
        let pou = self.pous[at].ast;
        if let Some(ty) = self.interface_type(at) {
            return Some(Resolved::plain(ty));
        }
        let is_run = pou.kind == ast::PouKind::Program && (self.log.options.tests || self.is_run(name.span));
        if !pou.kind.is_block() && !is_run {
            let kind = if pou.kind == ast::PouKind::Program { "PROGRAM" } else { "FUNCTION" };
            self.report(
                Diagnostic::new(Code::E0102, name.span, format!("`{}` is a {kind}, not a type", name.text))
                    .label("a FUNCTION_BLOCK or a type is expected here")
                    .other(pou.name.span, "declared here"),
            );
            return None;
        }
        if let Some(span) = pou.modifiers.is_abstract {
            self.report(
                Diagnostic::new(Code::E0102, name.span, format!("`{}` is ABSTRACT: it has no instances", name.text))
                    .label("a FUNCTION_BLOCK that extends it is expected here")
                    .other(span, "declared as such here"),
            );
            return None;
        }
        let signature = self.signature(at)?;
        Some(instance_of(&self.program, signature.state?))
    }

    fn report_unknown_type(&mut self, name: ast::Name<'s>) {
        let dialect = self.dialect(name.span);
        if let Some(library) = missing::library_of_type(dialect, name.text) {
            return self.report(Diagnostic::unavailable(
                name.text,
                name.span,
                &format!("`{}` of {library}", name.text),
            ));
        }
        if let Some(dialect) = prelude::owner(name.text) {
            let system = dialect.name().to_ascii_uppercase();
            self.report(
                Diagnostic::new(Code::E0102, name.span, format!("`{}` is in {system}'s library", name.text))
                    .about(Subject::Elsewhere { name: name.text.to_owned() })
                    .label("this file's dialect does not have this type")
                    .help(self.log.how_to_have(dialect)),
            );
            return;
        }
        if let Some(error) =
            block_of_another_dialect(self.dialect(name.span), self.log.options.moved_from.is_some(), name)
        {
            self.report(error);
            return;
        }
        let blocks = staunch_runtime::BLOCKS.iter().map(|it| it.name);
        let blocks = blocks.filter(|it| dialect::bare_block(dialect, it).is_some());
        let elementary = Elementary::ALL.iter().map(|it| it.name());
        let candidates = self.names.type_names().chain(blocks).chain(elementary).chain(["STRING", "WSTRING"]);
        let near = nearest(name.text, candidates).map(str::to_owned);
        let foreign =
            FOREIGN.iter().find(|(it, _)| it.eq_ignore_ascii_case(name.text)).map(|(_, ours)| (*ours).to_owned());
        let near = foreign.or(near);
        let mut error = Diagnostic::missing(Missing::Type, name.text, name.span).label("unknown type");
        if name.text.eq_ignore_ascii_case("VOID") {
            error = error.help("a FUNCTION without a result has no `:` and no type after its name");
        } else if let Some((_, ours)) = OF_SIMATIC.iter().find(|(it, _)| it.eq_ignore_ascii_case(name.text)) {
            error = error.note("it is a type of SIMATIC S7").help(*ours);
        } else if let Some(hint) = self.hint_of_namespace(name) {
            error = error.help(hint);
        } else if let Some(near) = near {
            error = error.help(format!("did you mean `{near}`?")).fix(name.span, near);
        } else if let Some(libraries) = missing::libraries_with(dialect, name.text) {
            error = error
                .label(format!("it is in {libraries}, which is not bundled with Staunch"))
                .help("name its source, or a declaration of it, in `libraries` of staunch.toml");
        }
        self.report(error);
    }

    fn string(
        &mut self,
        wide: bool,
        capacity: Option<&'s ast::Expr<'s>>,
        scope: &Rc<Scope<'s>>,
        span: Span,
    ) -> Option<Resolved> {
        let string = |capacity| Resolved::plain(Type::String(StringType { wide, capacity }));
        let Some(expr) = capacity else {
            return Some(string(self.dialect(span).rules().default_string.choice.capacity()));
        };
        let length = self.constant_integer(expr, scope)?;
        let limits = if self.dialect(span).has_long_strings() { 0..=LONG_CAPACITY } else { 1..=MAX_CAPACITY };
        if !limits.contains(&length) {
            let ty = StringType { wide, capacity: 0 };
            let message = format!("a {} holds {} to {} {}", ty.word(), limits.start(), limits.end(), ty.units());
            self.report(Diagnostic::new(Code::E0206, expr.span, message).label(format!("this is {length}")));
            return None;
        }
        Some(string(u16::try_from(length).unwrap_or(u16::MAX)))
    }

    fn subrange(
        &mut self,
        base: ast::Name<'s>,
        low: &'s ast::Expr<'s>,
        high: &'s ast::Expr<'s>,
        scope: &Rc<Scope<'s>>,
    ) -> Option<Resolved> {
        let resolved = self.resolve_name(base)?;
        // CODESYS counts bit strings among the integers.
        let takes_bits = self.dialect(base.span) == Dialect::Codesys;
        let is_bits = |it: &Elementary| takes_bits && it.is_bits() && *it != Elementary::Bool;
        let made_of = match resolved.ty.elementary().filter(|it| it.is_integer() || is_bits(it)) {
            Some(it) => it,
            None => {
                self.report(
                    Diagnostic::new(Code::E0407, base.span, "a subrange is made of an integer type")
                        .label(format!("this is {}", self.program.type_name(resolved.ty))),
                );
                return None;
            }
        };
        let bounds = (self.constant_integer(low, scope)?, self.constant_integer(high, scope)?);
        let whole = self.program.range(resolved.ty).or(made_of.repr().range())?;
        if bounds.0 > bounds.1 || bounds.0 < whole.0 || bounds.1 > whole.1 {
            self.report(
                Diagnostic::new(
                    Code::E0407,
                    low.span.to(high.span),
                    format!(
                        "the bounds of a subrange of `{}` must be between {} and {}, the lower one first",
                        base.text, whole.0, whole.1
                    ),
                )
                .label(format!("these are {} and {}", bounds.0, bounds.1)),
            );
            return None;
        }
        let ty = Type::Subrange(made_of, self.intern_bounds(bounds));
        let initial = self.least(ty);
        Some(Resolved { ty, initial })
    }

    /// The limits of a subrange, each pair once.
    pub(crate) fn intern_bounds(&mut self, bounds: (i128, i128)) -> BoundsId {
        *self.table.index.bounds.entry(bounds).or_insert_with(|| {
            self.program.bounds.push(bounds);
            BoundsId::next(self.program.bounds.len() - 1)
        })
    }

    fn array_type(
        &mut self,
        bounds: &'s [Bound<'s>],
        element: &'s ast::TypeSpec<'s>,
        scope: &Rc<Scope<'s>>,
        name: &str,
        span: Span,
    ) -> Option<Resolved> {
        let mut resolved = self.resolve_type_named(element, scope, name, None);
        let mut dimensions = Vec::new();
        for bound in bounds {
            match bound {
                Bound::Open(span) => {
                    self.report(open_is_for_parameters(*span));
                    resolved = None;
                }
                Bound::Range(low, high) => dimensions.push((low, high)),
            }
        }
        for (low, high) in dimensions.into_iter().rev() {
            let (first, last) = (self.constant_integer(low, scope), self.constant_integer(high, scope));
            let (Some(first), Some(last), Some(inner)) = (first, last, resolved.take()) else { continue };
            resolved = self.dimension(first, last, inner, low.span.to(high.span));
        }
        let resolved = resolved?;
        if self.size_of(resolved.ty) > MAX_SIZE {
            self.error(Code::E0901, span, "this array is larger than 1 GiB");
            return None;
        }
        Some(resolved)
    }

    /// The type of a parameter that takes arrays of any bounds.
    pub(super) fn open_array(
        &mut self,
        bounds: &'s [Bound<'s>],
        element: &'s ast::TypeSpec<'s>,
        scope: &Rc<Scope<'s>>,
        name: &str,
    ) -> Option<Resolved> {
        let mut resolved = self.resolve_type_named(element, scope, name, None)?;
        let fixed = bounds.iter().find_map(|it| match it {
            Bound::Range(low, high) => Some(low.span.to(high.span)),
            Bound::Open(_) => None,
        });
        if let Some(span) = fixed {
            self.error(Code::E0406, span, "in an array, either all bounds are `*` or none");
            return None;
        }
        if let Some(held) = self.program.prescanned_in(resolved.ty) {
            self.not_supported(element.span, &format!("ARRAY[*] OF {held}"));
            return None;
        }
        for _ in bounds {
            resolved = Resolved::plain(self.intern_array_type(Array::open(resolved.ty), resolved));
        }
        Some(resolved)
    }

    fn dimension(&mut self, low: i128, high: i128, element: Resolved, span: Span) -> Option<Resolved> {
        if low > high {
            let error = Diagnostic::new(Code::E0406, span, "the bounds of an array are in the wrong order")
                .label(format!("{low} is above {high}"));
            let is_of_names = self.log.sources.text(span).contains(|it: char| it.is_alphabetic());
            self.report(match is_of_names {
                true => error.help("the lower bound comes first: check the values of the constants"),
                false => error.help(format!("write `{high}..{low}`")).fix(span, format!("{high}..{low}")),
            });
            return None;
        }
        let (Ok(low), Ok(high)) = (i64::try_from(low), i64::try_from(high)) else {
            self.error(Code::E0406, span, "the bounds of an array are LINT values");
            return None;
        };
        if self.dimensions(element.ty) >= MAX_DIMENSIONS {
            self.error(Code::E0901, span, format!("an array has at most {MAX_DIMENSIONS} dimensions"));
            return None;
        }
        let count = high.abs_diff(low).saturating_add(1);
        if count.saturating_mul(self.size_of(element.ty).max(1)) > MAX_SIZE {
            self.error(Code::E0901, span, "this array is larger than 1 GiB");
            return None;
        }
        let initial = match &element.initial {
            Const::Zero => Const::Zero,
            other => Const::Array(vec![(count, other.clone())]),
        };
        Some(Resolved { ty: self.intern_array(low, high, element), initial })
    }

    fn dimensions(&self, mut ty: Type) -> usize {
        let mut count = 0;
        while let Type::Array(id) = ty {
            ty = self.program.array(id).element;
            count += 1;
        }
        count
    }

    pub(super) fn intern_array(&mut self, low: i64, high: i64, element: Resolved) -> Type {
        self.intern_array_type(Array { low, high, element: element.ty }, element)
    }

    fn intern_array_type(&mut self, array: Array, element: Resolved) -> Type {
        let known = self.table.index.arrays.entry(array).or_default();
        if let Some(id) = known.iter().find(|it| self.table.elements[it.index()] == element) {
            return Type::Array(*id);
        }
        let id = ArrayId::next(self.program.arrays.len());
        known.push(id);
        self.program.arrays.push(array);
        self.table.elements.push(element);
        Type::Array(id)
    }

    /// Refuses what a call would have to copy.
    pub(super) fn refuse_copy(&mut self, ty: Type, name: ast::Name<'s>, help: &str) -> Option<()> {
        let Some(message) = self.held_not_copied(ty, name.span) else { return Some(()) };
        self.report(
            Diagnostic::new(Code::E0210, name.span, message).label("a call would copy it").help(help.to_owned()),
        );
        None
    }

    /// What the value of an enumerator may name: also those before it.
    fn scope_of_values(
        &self,
        around: &Rc<Scope<'s>>,
        base: Elementary,
        values: &[ast::EnumValue<'s>],
        known: &[Enumerator],
    ) -> Rc<Scope<'s>> {
        let mut scope = Scope::within(Rc::clone(around));
        let block = ast::VarBlock::new(ast::VarKind::Var, Span::default());
        for (value, known) in values.iter().zip(known) {
            let ty = Type::Elementary(base);
            let resolved = Rc::new(Resolved { ty, initial: scalar_initial(known.value) });
            let place = staunch_ir::Place::root(staunch_ir::Root::Instance, ty);
            let variable = self.variable(value.name, &block, None, resolved, place);
            // A duplicate is reported where the values are declared.
            let _ = scope.insert(Variable { constant: true, ..variable });
        }
        Rc::new(scope)
    }

    fn enumeration(
        &mut self,
        base: Option<ast::Name<'s>>,
        values: &'s [ast::EnumValue<'s>],
        scope: &Rc<Scope<'s>>,
        name: &str,
        doc: Option<String>,
        span: Span,
    ) -> Option<Resolved> {
        let base = match base {
            None => Elementary::Int,
            Some(name) => match Elementary::named(name.text).filter(|it| it.repr().is_integer() && it.is_integral()) {
                Some(base) => {
                    self.log.note(name.span, || Named::Elementary(base));
                    base
                }
                None => {
                    self.error(Code::E0407, name.span, "the base of an enumeration is an integer or bit-string type");
                    return None;
                }
            },
        };
        let mut enumerators: Vec<Enumerator> = Vec::new();
        let mut seen = FxHashMap::default();
        let mut next = 0i128;
        for value in values {
            if let Some(expr) = &value.value {
                let scope = self.scope_of_values(scope, base, &values[..enumerators.len()], &enumerators);
                next = self.constant_of(expr, base, &scope)?;
            }
            let Some(number) = base.repr().integer(next) else {
                self.report(
                    Diagnostic::new(Code::E0202, value.name.span, format!("{next} does not fit {}", base.name()))
                        .about(Subject::Beyond(base))
                        .label(format!("the enumeration's values are of type {}", base.name())),
                );
                return None;
            };
            let first = *seen.entry(Key(value.name.text)).or_insert(value.name.span);
            if first != value.name.span {
                self.report(
                    Diagnostic::new(Code::E0103, value.name.span, format!("`{}` is declared twice", value.name.text))
                        .other(first, "first declared here"),
                );
            }
            enumerators.push(Enumerator { name: value.name.text.to_owned(), doc: value.doc.clone(), value: number });
            next += 1;
        }
        let Some(first) = enumerators.first().map(|it| it.value) else {
            self.error(Code::E0408, span, "an enumeration has at least one value");
            return None;
        };
        let id = EnumId::next(self.program.enums.len());
        for (value, declared) in values.iter().zip(&enumerators) {
            self.names.anonymous_enumerators.entry(Key(value.name.text)).or_insert((Type::Enum(id), declared.value));
        }
        let location = self.location(span);
        self.table.index.values.add(id, values.iter().map(|it| it.name.text));
        if let Some(index) = &self.log.index {
            values.iter().for_each(|it| index.declare_enumerator(id, it.name.text, it.name.span));
        }
        self.program.enums.push(Enum { name: name.to_owned(), doc, location, base, values: enumerators });
        Some(Resolved { ty: Type::Enum(id), initial: scalar_initial(first) })
    }
}

fn open_is_for_parameters(span: Span) -> Diagnostic {
    Diagnostic::new(Code::E0406, span, "an array of any bounds is the type of a parameter")
        .label("its number of elements is not known here")
        .help("give its bounds, or declare it in VAR_IN_OUT of a FUNCTION or FUNCTION_BLOCK, or in VAR_INPUT or VAR_OUTPUT of a FUNCTION")
}

/// How many constants an initial value is written with; a repeated one counts once.
fn constants(initial: &Const) -> usize {
    match initial {
        Const::Zero | Const::Scalar(_) | Const::Text(_) => 1,
        Const::Array(runs) => runs.iter().map(|(_, it)| constants(it)).sum(),
        Const::Struct(fields) => fields.iter().map(constants).sum(),
    }
}

fn block_type(block: staunch_ir::BlockId) -> Resolved {
    let pins = block.info().pins;
    let initial = if pins.iter().any(|pin| pin.starts_true) {
        let value = |pin: &staunch_runtime::Pin| {
            if pin.starts_true { Const::Scalar(Value::Bool(true)) } else { Const::Zero }
        };
        Const::Struct(pins.iter().map(value).collect())
    } else {
        Const::Zero
    };
    Resolved { ty: Type::Block(block), initial }
}

/// Whether a value is a literal, with a sign perhaps, or a name.
fn is_plain(value: &ast::Expr<'_>) -> bool {
    match &value.kind {
        ast::ExprKind::Literal(_) | ast::ExprKind::Name(_) => true,
        ast::ExprKind::Unary(ast::UnaryOp::Neg | ast::UnaryOp::Plus, inner) => {
            matches!(inner.kind, ast::ExprKind::Literal(_))
        }
        _ => false,
    }
}
