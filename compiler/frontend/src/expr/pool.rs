//! `__NEW` and `__DELETE`. A program has no heap: an object is made in a free place of its type's pool, which the source
//! declares with `{pool 16}`, and deleted by making that free again.

use super::checker::Checker;
use super::method::is_this;
use super::operand::Operand;
use super::place::{Access, Found};
use crate::diagnostic::Missing;
use crate::names::{Found as Meant, Sense};
use crate::types::pools::Pool;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span, ast};
use ast::{ArgumentKind, ExprKind as Ast};
use staunch_ir::{
    Conversion, Elementary, Expr, ExprKind, FaultKind, For, Op, Place, RefKind, Statement, StatementKind, Type, Value,
};
use staunch_runtime::reference::CLASS;

fn is_named(callee: &ast::Expr<'_>, wanted: &str) -> bool {
    matches!(&callee.kind, Ast::Name(name) if name.text.eq_ignore_ascii_case(wanted))
}

impl<'s> Checker<'_, 's> {
    /// `__NEW(type)`, where `callee` names it; the inner `None` says that it was reported.
    pub(crate) fn new_object(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<Option<Operand>> {
        if is_named(callee, "__DELETE") {
            self.report(
                Diagnostic::new(Code::E0311, span, "a call of `__DELETE` has no value")
                    .label("this cannot be part of an expression")
                    .help("write it as a statement of its own"),
            );
            return Some(None);
        }
        if !is_named(callee, "__NEW") {
            return None;
        }
        if self.signature.is_none() {
            self.decl.not_supported(span, "`__NEW` as an initial value");
            return Some(None);
        }
        Some(self.made(arguments, span).map(Operand::Typed))
    }

    fn made(&mut self, arguments: &[ast::Argument<'s>], span: Span) -> Option<Expr> {
        if let [
            ast::Argument { kind: ArgumentKind::Positional(named), .. },
            ast::Argument { kind: ArgumentKind::Positional(count), .. },
        ] = arguments
        {
            return self.made_array(named, count, span);
        }
        let [ast::Argument { kind: ArgumentKind::Positional(written), .. }] = arguments else {
            self.report_arguments_of_new(span);
            return None;
        };
        let (named, given) = match &written.kind {
            Ast::Call(named, given) => (&**named, given.as_slice()),
            _ => (written, &[][..]),
        };
        let pool = self.pool_named(named)?;
        let takes_arguments = match pool.object {
            Type::Struct(state) => self.decl.slot_of_instance(state).map(|it| self.decl.initial_methods(it)),
            _ => None,
        };
        if let (Some(first), true) = (given.first(), takes_arguments.is_none_or(|it| it.is_empty())) {
            let name = self.type_name(pool.object);
            self.report(
                Diagnostic::new(Code::E0304, first.span, format!("a new object of type `{name}` takes no arguments"))
                    .label("only a METHOD FB_init takes such arguments, in `codesys`"),
            );
            return None;
        }
        let covered = std::mem::replace(&mut self.is_covered, false);
        let made = self.make(&pool, given, span);
        self.is_covered = covered;
        Some(made)
    }

    fn report_arguments_of_new(&mut self, span: Span) {
        self.report(
            Diagnostic::new(Code::E0302, span, "`__NEW` takes the type of the object")
                .label("expected `__NEW(Type)`, `__NEW(Type(input := value))` for the inputs of its FB_init, or `__NEW(Type, count)`"),
        );
    }

    /// `__NEW(INT, n)`: an array in the pool of those that are long enough, the shortest first.
    fn made_array(&mut self, named: &ast::Expr<'s>, count: &ast::Expr<'s>, span: Span) -> Option<Expr> {
        let element = self.type_named(named)?;
        let wanted = self.value(count, Type::LINT);
        let pools = self.pools_of_arrays(element);
        if pools.is_empty() {
            if self.decl.pools_missing.insert(element) {
                self.report_no_array_pool(element, named.span);
            }
            return None;
        }
        let at = self.at(span);
        let covered = std::mem::replace(&mut self.is_covered, false);
        let n = self.temporary("count", Type::LINT);
        self.assign(n.clone(), wanted?, span);
        let ty = self.decl.reference_type(RefKind::PointerTo, element);
        let made = self.temporary("made", ty);
        let null = self.null(Some(ty), span);
        self.assign(made.clone(), null, span);
        let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
        let test = |op, a: &Place, b| Expr::apply(op, Type::BOOL, vec![Expr::load(a.clone(), at), b], at);
        for (length, low, pool) in pools {
            // What is longer than the arrays of this pool looks in the next; so does what finds no place.
            let open = self.compared_with_null(Op::Eq, &made, span);
            let fits = [test(Op::Ge, &n, lint(1)), test(Op::Le, &n, lint(length)), open];
            let condition = fits.into_iter().reduce(|a, b| Expr::apply(Op::And, Type::BOOL, vec![a, b], at))?;
            let then = self.nested(|this| {
                let array = this.make(&pool, &[], span);
                let taken = this.temporary("taken", array.ty);
                this.assign(taken.clone(), array, span);
                let condition = this.compared_with_null(Op::Ne, &taken, span);
                let then = this.nested(|this| {
                    let first = taken.clone().deref(pool.object, at).index(lint(low), element, at);
                    let first = Expr::new(ty, ExprKind::AddressOf(Box::new(first)), at);
                    this.assign(made.clone(), first, span);
                });
                this.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
            });
            self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        }
        self.is_covered = covered;
        Some(Expr::load(made, at))
    }

    fn compared_with_null(&mut self, op: Op, reference: &Place, span: Span) -> Expr {
        let (at, lword) = (self.at(span), Type::Elementary(Elementary::Lword));
        let bits = self.convert(Conversion::Same, lword, Expr::load(reference.clone(), at));
        Expr::apply(op, Type::BOOL, vec![bits, Expr::constant(Elementary::Lword, Value::U64(0), at)], at)
    }

    /// The pools of arrays of a type, the shorter ones first: their lengths, and first indices.
    fn pools_of_arrays(&self, element: Type) -> Vec<(i64, i64, Pool)> {
        let arrays = self.decl.pools.iter().filter_map(|(ty, pool)| {
            let Type::Array(id) = ty else { return None };
            let array = self.decl.program.array(*id);
            let length = i64::try_from(array.len()).ok()?;
            (array.element == element).then_some((length, array.low, pool.clone()?))
        });
        let mut arrays: Vec<_> = arrays.collect();
        arrays.sort_by_key(|it| (it.0, it.1));
        arrays
    }

    fn report_no_array_pool(&mut self, element: Type, span: Span) {
        let name = self.type_name(element);
        let help = match self.decl.held_instance(element) {
            Some(_) => format!(
                "only arrays of values can be made this way: declare `{{pool 4}}` before `{name}`, with the largest number of objects, \
                 and make each with `__NEW({name})`"
            ),
            None => format!(
                "declare one: `{{pool 4}} TYPE Some : ARRAY[0..99] OF {name}; END_TYPE`, with the largest number of arrays at a time, \
                 and the largest number of elements"
            ),
        };
        self.report(
            Diagnostic::new(Code::E0413, span, format!("no pool of arrays of {name} is declared"))
                .label("a program has no heap")
                .help(help),
        );
    }

    /// The pool of the type that an expression names.
    fn pool_named(&mut self, named: &ast::Expr<'s>) -> Option<Pool> {
        let ty = self.type_named(named)?;
        if let Some(pool) = self.decl.pools.get(&ty) {
            return pool.clone();
        }
        let name = self.type_name(ty);
        if let Some(span) = self.is_abstract(ty) {
            self.report(
                Diagnostic::new(Code::E0413, named.span, format!("`{name}` is ABSTRACT: it has no objects"))
                    .label("a FUNCTION_BLOCK that extends it is expected here")
                    .other(span, "declared as such here"),
            );
            return None;
        }
        // Said once of each type.
        self.decl.pools.insert(ty, None);
        let message = format!("`{name}` has no pool for `__NEW` to take an object from");
        let error = Diagnostic::new(Code::E0413, named.span, message).label("a program has no heap");
        self.report(self.with_pragma(error, ty));
        None
    }

    fn type_named(&mut self, named: &ast::Expr<'s>) -> Option<Type> {
        if let Some(word) = ["STRING", "WSTRING"].into_iter().find(|it| is_named(named, it)) {
            self.report(
                Diagnostic::new(Code::E0413, named.span, format!("a {word} has no pool for `__NEW` to take it from"))
                    .label("a program has no heap")
                    .help(format!(
                        "make it a member: `{{pool 16}} TYPE Text : STRUCT value : {word}(80); END_STRUCT END_TYPE`"
                    )),
            );
            return None;
        }
        let ty = self.type_of_path(named);
        // A missing expression has been reported.
        if ty.is_none() && !matches!(named.kind, ast::ExprKind::Error(_)) && !self.reports_unknown_type(named) {
            self.report(
                Diagnostic::new(Code::E0413, named.span, "`__NEW` makes objects of a type")
                    .label("expected the name of a FUNCTION_BLOCK or a type"),
            );
        }
        ty
    }

    /// Reports a type that is not there; what is another thing by its name is not reported here.
    fn reports_unknown_type(&mut self, named: &ast::Expr<'s>) -> bool {
        let Some(path) = named.path() else { return false };
        let [first, ..] = path.as_slice() else { return false };
        let Some((name, around)) = path.split_last() else { return false };
        if self.means_anything(&path, Sense::Value) {
            return false;
        }
        let is_declared = self.decl.lookup(&path, Sense::Type) != Meant::Nothing;
        if is_declared || self.scope.is_refused(first.text) {
            // What is wrong with it has been reported.
            return true;
        }
        let error = self.decl.not_in_library(Code::E0102, around, *name);
        let error = error.or_else(|| self.decl.not_there(first.text, first.span)).unwrap_or_else(|| {
            let full = path.iter().map(|it| it.text).collect::<Vec<_>>().join(".");
            Diagnostic::missing(Missing::Type, &full, named.span).label("unknown type")
        });
        self.report(error);
        true
    }

    fn is_abstract(&self, ty: Type) -> Option<Span> {
        let Type::Struct(state) = ty else { return None };
        self.decl.pous[self.decl.slot_of_instance(state)?].ast.modifiers.is_abstract
    }

    fn type_of_path(&mut self, named: &ast::Expr<'s>) -> Option<Type> {
        let path = named.path()?;
        match path.as_slice() {
            [name] => match self.decl.dialect(name.span).rules().named(name.text) {
                Some(ty) => Some(Type::Elementary(ty)),
                None => self.noted_type(path.as_slice()),
            },
            path => self.noted_type(path),
        }
    }

    fn noted_type(&mut self, path: &[ast::Name<'s>]) -> Option<Type> {
        self.decl.note_path(path, &self.decl.lookup(path, Sense::Type));
        self.decl.type_of_path(path)
    }

    /// How a type gets a pool.
    fn with_pragma(&self, error: Diagnostic, ty: Type) -> Diagnostic {
        let word = match ty {
            Type::Struct(id) if self.decl.is_instance(id) => "FUNCTION_BLOCK",
            Type::Struct(_) => "TYPE",
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Block(_)
            | Type::Reference(_) => {
                let name = self.type_name(ty);
                return error.help(format!(
                    "declare one: `{{pool 16}} TYPE Some : {name}; END_TYPE`, with the largest number of objects at a time"
                ));
            }
        };
        let name = self.type_name(ty);
        error.help(format!(
            "write `{{pool 16}}` before `{word} {name}`, with the largest number of objects at a time in place of 16"
        ))
    }

    /// A reference to an object that is made in a free place; null where there is none.
    fn make(&mut self, pool: &Pool, given: &[ast::Argument<'s>], span: Span) -> Expr {
        let at = self.at(span);
        let ty = self.decl.reference_type(RefKind::PointerTo, pool.object);
        let (made, free) = (self.temporary("made", ty), self.temporary("free", Type::LINT));
        let number = self.temporary("place", Type::LINT);
        let null = self.null(Some(ty), span);
        let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
        self.assign(made.clone(), null, span);
        self.assign(free.clone(), lint(0), span);
        let (is_used, _) = pool.at(Expr::load(number.clone(), at), at);
        let condition = Expr::apply(Op::Not, Type::BOOL, vec![Expr::load(is_used, at)], at);
        let found = vec![
            Statement::assign(free.clone(), Expr::load(number.clone(), at), at),
            Statement::new(StatementKind::Exit, at),
        ];
        let look = StatementKind::If { condition, then: found, otherwise: Vec::new() };
        self.block.push(For::over(number, lint(1), lint(pool.count), vec![Statement::new(look, at)], at));
        let then = self.nested(|this| {
            let (is_used, object) = pool.at(Expr::load(free.clone(), at), at);
            let initial = this.decl.start_of(object.ty);
            let value = this.initial_value(&Resolved { ty: object.ty, initial }, span);
            this.assign(object.clone(), value, span);
            this.assign(is_used, Expr::bool(true, at), span);
            let reference = Expr::new(ty, ExprKind::AddressOf(Box::new(object.clone())), at);
            this.decl.note_referred(object.ty);
            let reference = this.told_apart(reference, &object, span);
            this.assign(made.clone(), reference, span);
            this.start_made(object, given, span);
        });
        let condition = Expr::apply(Op::Gt, Type::BOOL, vec![Expr::load(free, at), lint(0)], at);
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        Expr::load(made, at)
    }

    /// `__DELETE(pointer)`, where `callee` names it, and `__NEW` as a statement, which is of no use.
    pub(crate) fn pool_statement(
        &mut self,
        callee: &ast::Expr<'s>,
        arguments: &[ast::Argument<'s>],
        span: Span,
    ) -> Option<()> {
        if is_named(callee, "__NEW") {
            self.report(
                Diagnostic::new(Code::E0508, span, "the result of `__NEW` is not used")
                    .label("nothing would refer to the object")
                    .help("assign it: `pointer := __NEW(…);`"),
            );
            return Some(());
        }
        if !is_named(callee, "__DELETE") {
            return None;
        }
        let [ast::Argument { kind: ArgumentKind::Positional(pointer), .. }] = arguments else {
            self.report(
                Diagnostic::new(Code::E0302, span, "`__DELETE` takes 1 argument")
                    .label("the variable that refers to the object"),
            );
            return Some(());
        };
        let covered = std::mem::replace(&mut self.is_covered, false);
        self.delete(pointer, span);
        self.is_covered = covered;
        Some(())
    }

    fn delete(&mut self, pointer: &ast::Expr<'s>, span: Span) -> Option<()> {
        let found = self.deleted_place(pointer)?;
        let place = found.place.clone();
        let pools = self.pools_behind(place.ty, pointer.span)?;
        if !self.writable(&found, pointer.span) {
            return None;
        }
        let (at, lword) = (self.at(span), Type::Elementary(Elementary::Lword));
        let bits = self.temporary("deleted", lword);
        let value = self.convert(Conversion::Same, lword, Expr::load(place.clone(), at));
        let value = object_of(value);
        self.assign(bits.clone(), value, span);
        let is_found = self.temporary("found", Type::BOOL);
        let then = self.nested(|this| {
            this.assign(is_found.clone(), Expr::bool(false, at), span);
            pools.iter().for_each(|pool| this.delete_from(pool, &bits, &is_found, span));
            let condition = Expr::apply(Op::Not, Type::BOOL, vec![Expr::load(is_found.clone(), at)], at);
            let then = vec![Statement::new(StatementKind::Fault(FaultKind::NotOfPool), at)];
            this.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
            let null = this.null(Some(place.ty), span);
            this.assign(place, null, span);
        });
        let zero = Expr::constant(Elementary::Lword, Value::U64(0), at);
        let condition = Expr::apply(Op::Ne, Type::BOOL, vec![Expr::load(bits, at), zero], at);
        self.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
        Some(())
    }

    /// The variable whose object is deleted. A REFERENCE TO a pointer stands for that; THIS is a pointer of its own.
    fn deleted_place(&mut self, pointer: &ast::Expr<'s>) -> Option<Found<'s>> {
        let found = self.place_of_reference(pointer)?;
        if is_this(pointer) && matches!(found.place.ty, Type::Struct(_)) {
            let ty = self.decl.reference_type(RefKind::PointerTo, found.place.ty);
            let this = self.value(pointer, ty)?;
            let own = self.temporary("this", ty);
            self.assign(own.clone(), this, pointer.span);
            return Some(Found { place: own, view: None, access: Access::Write });
        }
        self.referred(found, pointer.span)
    }

    /// Frees the place of a pool whose object a reference names.
    fn delete_from(&mut self, pool: &Pool, bits: &Place, is_found: &Place, span: Span) {
        let (at, lword) = (self.at(span), Type::Elementary(Elementary::Lword));
        let ty = self.decl.reference_type(RefKind::PointerTo, pool.object);
        let number = self.temporary("place", Type::LINT);
        let (is_used, object) = pool.at(Expr::load(number.clone(), at), at);
        let reference = Expr::new(ty, ExprKind::AddressOf(Box::new(object.clone())), at);
        let own = object_of(self.convert(Conversion::Same, lword, reference));
        let same = Expr::apply(Op::Eq, Type::BOOL, vec![own, Expr::load(bits.clone(), at)], at);
        let freed = self.nested(|this| {
            let condition = Expr::apply(Op::Not, Type::BOOL, vec![Expr::load(is_used.clone(), at)], at);
            let then = vec![Statement::new(StatementKind::Fault(FaultKind::Deleted), at)];
            this.push(StatementKind::If { condition, then, otherwise: Vec::new() }, span);
            let class = if let Type::Struct(id) = object.ty { this.decl.slot_of_instance(id) } else { None };
            if let Some(class) = class {
                this.exit(class, &object, span);
            }
            this.assign(is_used, Expr::bool(false, at), span);
            this.assign(is_found.clone(), Expr::bool(true, at), span);
            this.push(StatementKind::Exit, span);
        });
        let look = StatementKind::If { condition: same, then: freed, otherwise: Vec::new() };
        let lint = |value| Expr::constant(Elementary::Lint, Value::I64(value), at);
        self.block.push(For::over(number, lint(1), lint(pool.count), vec![Statement::new(look, at)], at));
    }

    /// The pools that what a variable refers to may be in.
    fn pools_behind(&mut self, ty: Type, span: Span) -> Option<Vec<Pool>> {
        let target = match ty {
            // That what it refers to is not known has been reported.
            Type::Reference(id) if self.decl.table.unknown_references.contains(&id) => return None,
            Type::Reference(id) => {
                let target = self.decl.program.references[id.index()];
                (target.kind != RefKind::ReferenceTo).then_some(target.target)
            }
            _ => None,
        };
        let Some(target) = target else {
            let found = self.type_name(ty);
            self.report(
                Diagnostic::new(
                    Code::E0211,
                    span,
                    format!("`__DELETE` takes a POINTER TO an object, but this is {found}"),
                )
                .label("expected the variable that `__NEW` was assigned to"),
            );
            return None;
        };
        let classes = match (self.decl.interface_of(ty), target) {
            (Some(interface), _) => self.decl.implementers(interface).to_vec(),
            (None, Type::Struct(state)) => match self.decl.slot_of_instance(state) {
                Some(class) => self.decl.kin(class),
                None => return self.pools_of(&[target], target, span),
            },
            (None, _) => return self.pools_of(&[target], target, span),
        };
        let states = classes.into_iter().filter_map(|it| self.decl.signature(it)?.state.map(Type::Struct));
        let states: Vec<_> = states.collect();
        let title = if self.decl.interface_of(ty).is_some() { ty } else { target };
        self.pools_of(&states, title, span)
    }

    fn pools_of(&mut self, types: &[Type], title: Type, span: Span) -> Option<Vec<Pool>> {
        let known: Vec<_> = types.iter().filter_map(|it| self.decl.pools.get(it).cloned()).collect();
        let was_refused =
            known.iter().any(Option::is_none) || types.iter().any(|it| self.decl.pools_missing.contains(it));
        let arrays = types.iter().flat_map(|it| self.pools_of_arrays(*it)).map(|it| it.2);
        let pools: Vec<_> = known.into_iter().flatten().chain(arrays).collect();
        if pools.is_empty() && was_refused {
            return None;
        }
        if pools.is_empty() {
            let name = self.type_name(title);
            types.iter().for_each(|it| drop(self.decl.pools.insert(*it, None)));
            let message = format!("`{name}` has no pool");
            let error = Diagnostic::new(Code::E0413, span, message).label("`__DELETE` returns an object to its pool");
            self.report(match title {
                Type::Reference(_) => error.help("write `{pool 16}` before the FUNCTION_BLOCKs that `__NEW` makes"),
                _ => self.with_pragma(error, title),
            });
            return None;
        }
        Some(pools)
    }
}

/// A reference's bits without the number of a class.
fn object_of(bits: Expr) -> Expr {
    let (lword, at) = (bits.ty, bits.at);
    let mask = Expr::constant(Elementary::Lword, Value::U64((1 << CLASS) - 1), at);
    Expr::apply(Op::And, lword, vec![bits, mask], at)
}
