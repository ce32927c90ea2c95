//! The places for the objects that `__NEW` makes: what `{pool 16}` asks for.

use crate::ast::{self, TypeKind};
use crate::types::declarations::Declarations;
use crate::types::pools::{MOST, Pool};
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{Const, Field, Retain, Section, Struct, Type};

impl<'s> Declarations<'s> {
    pub(super) fn declare_pools(&mut self) {
        for slot in 0..self.written_pous().len() {
            let pou = self.pous[slot].ast;
            let Some(pool) = pou.pool.filter(|it| self.may_have_pool(pou, it.span)) else { continue };
            if let Some(state) = self.signature(slot).and_then(|it| it.state) {
                let name = self.emitted_name(slot);
                let pool = self.declare_pool(&name, pou.name, Type::Struct(state), pool);
                self.pools.insert(Type::Struct(state), pool);
            }
        }
        for at in 0..self.types.len() {
            let decl = self.types[at].decl;
            let Some(pool) = decl.pool else { continue };
            let may_be_made = self.may_be_made(decl, pool.span);
            let Some(Resolved { ty, .. }) = self.named_type(at) else { continue };
            if self.is_first_pool(decl.name, ty, pool.span) {
                let name = self.name_in_full(decl.name);
                let pool = if may_be_made { self.declare_pool(&name, decl.name, ty, pool) } else { None };
                if let (None, Type::Array(id)) = (&pool, ty) {
                    self.pools_missing.insert(self.program.array(id).element);
                }
                self.pools.insert(ty, pool);
            }
        }
    }

    fn may_have_pool(&mut self, pou: &ast::Pou<'s>, pool: Span) -> bool {
        if let Some(span) = pou.modifiers.is_abstract {
            self.report(
                Diagnostic::new(Code::E0413, pool, format!("`{}` is ABSTRACT: it has no objects", pou.name.text))
                    .label("declare the pool for a FUNCTION_BLOCK that extends it")
                    .other(span, "declared as such here"),
            );
            return false;
        }
        if !pou.kind.is_block() {
            self.refuse_pool(pool, pou.name);
        }
        pou.kind.is_block()
    }

    /// Whether objects of a type can be made one by one: structures, and values of a type that `__NEW` names; or as an
    /// array, of which `__NEW` is given the number of elements.
    fn may_be_made(&mut self, decl: &ast::TypeDecl<'s>, pool: Span) -> bool {
        let is_it = match &decl.ty.kind {
            TypeKind::Struct(_) | TypeKind::Named(_) => true,
            TypeKind::Array { bounds, .. } => matches!(bounds.as_slice(), [ast::Bound::Range(..)]),
            TypeKind::Error
            | TypeKind::String { .. }
            | TypeKind::Subrange { .. }
            | TypeKind::Union(_)
            | TypeKind::Enum { .. }
            | TypeKind::Reference { .. } => false,
        };
        if !is_it && !matches!(decl.ty.kind, TypeKind::Error) {
            self.refuse_pool(pool, decl.name);
        }
        if let Some(initial) = decl.initial.as_ref().filter(|_| is_it && !matches!(decl.ty.kind, TypeKind::Struct(_))) {
            let message = format!("the objects in the pool of `{}` cannot have an initial value", decl.name.text);
            self.report(
                Diagnostic::new(Code::E0413, initial.span, message)
                    .label("the pool serves every name of their type")
                    .help("delete it, and assign the value after `__NEW`"),
            );
            return false;
        }
        is_it
    }

    fn is_first_pool(&mut self, name: ast::Name<'s>, ty: Type, pool: Span) -> bool {
        if self.pools.contains_key(&ty) {
            let ty = self.program.type_name(ty);
            self.report(
                Diagnostic::new(
                    Code::E0413,
                    pool,
                    format!("`{}` is another name for {ty}, which has a pool", name.text),
                )
                .label("a type has one pool")
                .help("delete this pragma, and add the number of these objects there"),
            );
            return false;
        }
        if let Some(message) = self.array_of_instances(ty) {
            self.report(Diagnostic::new(Code::E0413, pool, message).label("a pool is for an array of values"));
            return false;
        }
        true
    }

    fn array_of_instances(&self, ty: Type) -> Option<String> {
        matches!(ty, Type::Array(_)).then(|| self.held_instance(ty)).flatten()
    }

    fn refuse_pool(&mut self, pool: Span, name: ast::Name<'s>) {
        self.report(
            Diagnostic::new(Code::E0413, pool, format!("`{}` cannot have a pool", name.text))
                .label("a pool is for a FUNCTION_BLOCK, or a TYPE that is a STRUCT, an ARRAY or another name of a type")
                .other(name.span, "this is none of these"),
        );
    }

    fn declare_pool(&mut self, title: &str, name: ast::Name<'s>, object: Type, pool: ast::Pool) -> Option<Pool> {
        let Some(count) = pool.count.filter(|it| (1..=MOST).contains(it)) else {
            self.report(
                Diagnostic::new(Code::E0413, pool.span, format!("a pool can have 1 to {MOST} objects"))
                    .label(format!("expected a whole number from 1 to {MOST}"))
                    .help("write the largest number of objects at a time: `{pool 16}`"),
            );
            return None;
        };
        let location = self.location(name.span);
        let field = |name: &str, ty, doc: &str| Field {
            name: name.to_owned(),
            ty,
            // `__NEW` gives an object its initial values.
            initial: Const::Zero,
            section: Section::Internal,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: Some(doc.to_owned()),
            location,
            declared: None,
        };
        let title = title.replace('.', "_");
        let fields = vec![
            field("used", Type::BOOL, "Whether the place holds an object."),
            field("object", object, "The object that `__NEW` has created."),
        ];
        let doc = format!("A place for one `{}`.", name.text);
        let place = self.push_struct(Struct::new(format!("PlaceOf{title}"), Some(doc), location, fields));
        self.program.places.insert(place);
        let count = i64::from(count);
        let array = self.intern_array(1, count, Resolved { ty: Type::Struct(place), initial: Const::Zero });
        let doc = format!("The pool of `{}`: the objects that `__NEW` creates.", name.text);
        let objects = Field { section: Section::Global, ..field(&format!("pool_of_{title}"), array, &doc) };
        let at = self.add_synthetic(objects, None);
        let places = self.synthetic_place(at);
        Some(Pool { places, place, count, object })
    }
}
