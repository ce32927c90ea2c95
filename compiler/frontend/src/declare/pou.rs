//! Signatures: what callers of a POU see, and where its variables live.

use super::specs::Within;
use crate::ast::{self, PouKind, VarKind};
use crate::diagnostic::wording::article;
use crate::dialect::Dialect;
use crate::dialect::rules::{Part, Use};
use crate::types::declarations::Declarations;
use crate::types::scope::Scope;
use crate::types::signature::{EdgeInput, Formal, Signature, Target, pin_place};
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span, dialect};
use rustc_hash::{FxHashMap, FxHashSet};
use staunch_ir::{
    Const, Field, FieldId, Local, LocalId, Mode, Param, ParamId, Place, Program, Root, Section, Struct, Type,
};
use std::rc::Rc;

/// A signature while its variables are read.
pub(super) struct Builder<'s> {
    pub slot: usize,
    pub scope: Rc<Scope<'s>>,
    pub fields: Vec<Field>,
    formals: Vec<Formal<'s>>,
    params: Vec<Param>,
    locals: Vec<Local>,
    edges: Vec<EdgeInput>,
    /// False when the result's type was refused.
    complete: bool,
    /// Whether what is being declared is a VAR_IN_OUT that is passed as a reference.
    pub polymorphic: bool,
}

impl<'s> Declarations<'s> {
    pub(super) fn signature_of(&mut self, slot: usize) -> Option<Signature<'s>> {
        let pou = self.pous[slot].ast;
        let owner = match self.pous[slot].owner {
            Some(owner) => Some(self.signature(owner)?),
            None => None,
        };
        if let (PouKind::Action, Some(owner)) = (pou.kind, &owner) {
            let signature = signature_of_action(owner, self.scope_around(slot, owner));
            return Some(self.with_temporaries(slot, owner, signature));
        }
        let outer = owner.as_ref().map(|it| self.scope_around(slot, it));
        let scope = || outer.as_ref().map_or_else(Scope::default, |it| Scope::within(Rc::clone(it)));
        let mut builder = Builder {
            slot,
            scope: Rc::new(scope()),
            fields: Vec::new(),
            formals: Vec::new(),
            params: Vec::new(),
            locals: Vec::new(),
            edges: Vec::new(),
            complete: true,
            polymorphic: false,
        };
        let known = self.constants.get(&slot).cloned();
        let constants = known.unwrap_or_else(|| Rc::new(self.early_constants(pou, scope())));
        Rc::get_mut(&mut builder.scope).expect("the scope is new").constants = Some(constants);
        let result = self.result(pou, &mut builder);
        for block in &pou.blocks {
            self.check_block_qualifiers(pou, block);
            for decl in &block.vars {
                self.declare_variables(pou, block, decl, owner.as_deref(), &mut builder);
            }
        }
        let mut instance_variables = FxHashMap::default();
        if pou.kind.has_routines() {
            self.instance_variables(pou, &mut builder, &mut instance_variables);
        }
        if pou.kind.is_block() && builder.fields.is_empty() && self.is_told_apart(slot) {
            builder.fields.push(self.presence(pou));
        }
        let state = owner.map(|it| it.state).unwrap_or_else(|| {
            (!pou.kind.is_function() && pou.kind != PouKind::Interface).then(|| {
                let location = self.location(pou.name.span);
                let mut fields = std::mem::take(&mut builder.fields);
                fields.shrink_to_fit();
                let name = match self.pous[slot].run {
                    Some(instance) => format!("{}_{}", pou.name.text, self.log.sources.text(instance)),
                    None => self.emitted_name(slot),
                };
                let id = self.push_struct(Struct::new(name, pou.doc.clone(), location, fields));
                self.table.instances.insert(id, slot);
                // What starts an instance does not come back to it.
                if pou.routines.iter().any(|it| it.name.text != crate::start::START) {
                    self.program.reentered.insert(id);
                }
                id
            })
        });
        let Builder { scope, mut formals, params, locals, edges, complete, .. } = builder;
        formals.shrink_to_fit();
        complete.then_some(Signature { scope, state, formals, params, locals, result, edges, instance_variables })
    }

    /// A base's body, which SUPER calls as an ACTION, has the VAR_TEMP that are the body's own.
    fn with_temporaries(&mut self, slot: usize, owner: &Signature<'s>, signature: Signature<'s>) -> Signature<'s> {
        let pou = self.pous[slot].ast;
        let mut builder = Builder {
            slot,
            scope: signature.scope,
            fields: Vec::new(),
            formals: signature.formals,
            params: signature.params,
            locals: signature.locals,
            edges: signature.edges,
            complete: true,
            polymorphic: false,
        };
        for block in &pou.blocks {
            for decl in &block.vars {
                self.declare_variables(pou, block, decl, Some(owner), &mut builder);
            }
        }
        let Builder { scope, formals, params, locals, edges, .. } = builder;
        Signature { scope, formals, params, locals, edges, ..signature }
    }

    /// What a class without variables has, so that its instances are at places of their own, to be referred to.
    fn presence(&mut self, pou: &ast::Pou<'s>) -> Field {
        Field {
            name: "instance".to_owned(),
            ty: Type::Elementary(staunch_ir::Elementary::Byte),
            initial: Const::Zero,
            section: Section::Internal,
            retain: staunch_ir::Retain::Inherited,
            constant: false,
            address: None,
            doc: Some("Has no variables, but needs an address".to_owned()),
            location: self.location(pou.name.span),
            declared: None,
        }
    }

    /// What a routine sees of its POU: one that is inherited does not see what the heirs declare.
    pub(super) fn scope_around(&self, slot: usize, owner: &Signature<'s>) -> Rc<Scope<'s>> {
        let home = self.pous[self.home(slot)].ast;
        let Some(class) = self.pous[slot].owner.map(|it| self.pous[it].ast) else { return Rc::clone(&owner.scope) };
        let later: FxHashSet<_> = class.blocks.iter().skip(home.blocks.len()).map(|it| it.span).collect();
        if later.is_empty() {
            return Rc::clone(&owner.scope);
        }
        let declared = class.blocks.iter().filter(|it| later.contains(&it.span)).flat_map(|it| &it.vars);
        let unseen: FxHashSet<_> = declared.flat_map(|it| &it.names).map(|it| it.span).collect();
        Rc::new(owner.scope.without(&unseen))
    }

    /// VAR_INST: what a METHOD keeps in the instance, by where it is declared.
    fn instance_variables(
        &mut self,
        pou: &'s ast::Pou<'s>,
        builder: &mut Builder<'s>,
        found: &mut FxHashMap<Span, (Place, Rc<Resolved>)>,
    ) {
        for routine in &pou.routines {
            for block in routine.blocks.iter().filter(|it| it.kind == VarKind::Inst) {
                for decl in &block.vars {
                    let scope = Rc::clone(&builder.scope);
                    let owner = decl.names.first().map_or(pou.name.text, |it| it.text);
                    let Some(resolved) = self.declared_type(decl, &scope, owner, Within::Pou).map(Rc::new) else {
                        continue;
                    };
                    for name in &decl.names {
                        let place = self.push_field(block, decl, *name, &resolved, builder);
                        if let Some(field) = builder.fields.last_mut() {
                            field.name = format!("{}_{}", routine.name.text, name.text);
                        }
                        found.insert(name.span, (place, Rc::clone(&resolved)));
                    }
                }
            }
        }
    }

    /// The CONSTANTs of a POU by their values: a declaration before them may use them. A mistake in
    /// one of them is reported when its own turn comes, but what it needs is resolved for good.
    pub(super) fn early_constants(&mut self, pou: &'s ast::Pou<'s>, scope: Scope<'s>) -> Scope<'s> {
        let mut scope = Rc::new(scope);
        let counted = self.table.constants;
        let named =
            |it: &&'s ast::VarDecl<'s>| matches!(it.ty.kind, ast::TypeKind::Named(_) | ast::TypeKind::String { .. });
        let mut waiting: Vec<_> =
            pou.constants().flat_map(|block| block.vars.iter().filter(named).map(move |decl| (block, decl))).collect();
        // One constant may use another that is declared after it, so rounds continue while they help.
        loop {
            let before = waiting.len();
            waiting.retain(|(block, decl)| {
                let reported = self.log.diagnostics.len();
                let resolved = self.declared_type(decl, &scope, pou.name.text, Within::of(pou));
                let known = resolved.filter(|_| self.log.diagnostics.len() == reported);
                let others =
                    self.log.diagnostics.split_off(reported).into_iter().filter(|it| !within(it.span, decl.span));
                self.log.diagnostics.extend(others);
                let Some(resolved) = known.map(Rc::new) else { return true };
                for name in &decl.names {
                    let place = Place::root(Root::Instance, resolved.ty);
                    let variable = self.variable(*name, block, Some(decl), Rc::clone(&resolved), place);
                    let scope = Rc::get_mut(&mut scope).expect("no one else holds the scope between declarations");
                    let _ = scope.insert(variable);
                }
                false
            });
            if waiting.len() == before || waiting.is_empty() {
                break;
            }
        }
        for name in waiting.iter().flat_map(|(_, decl)| &decl.names) {
            Rc::get_mut(&mut scope).expect("no one else holds the scope between declarations").refuse(*name);
        }
        self.table.constants = counted;
        Rc::into_inner(scope).unwrap_or_default()
    }

    /// A FUNCTION's result is the local that bears its name.
    fn result(&mut self, pou: &'s ast::Pou<'s>, builder: &mut Builder<'s>) -> Option<(LocalId, Resolved)> {
        let spec = pou.result.as_ref()?;
        let scope = Rc::clone(&builder.scope);
        let Some(resolved) = self.resolve_spec(spec, &scope, pou.name.text) else {
            builder.complete = false;
            return None;
        };
        if self.refuse_copy(resolved.ty, pou.name, "pass the instance in VAR_IN_OUT").is_none() {
            builder.complete = false;
        }
        let id = builder.local(pou.name.text, &resolved, None);
        Some((id, resolved))
    }

    pub(super) fn resolve_spec(
        &mut self,
        spec: &'s ast::TypeSpec<'s>,
        scope: &Rc<Scope<'s>>,
        name: &str,
    ) -> Option<Resolved> {
        self.resolve_type_named(spec, scope, name, None)
    }

    fn check_block_qualifiers(&mut self, pou: &ast::Pou<'s>, block: &ast::VarBlock<'s>) {
        let retain = block.retain.or(block.persistent);
        if block.kind == VarKind::Temp && !pou.kind.is_function() {
            let at = self.location(block.span);
            self.program.uses.note(Use::Part(Part::Temp), at);
        }
        let lives_one_call = block.kind == VarKind::Temp
            || (pou.kind.is_function() && !matches!(block.kind, VarKind::Stat | VarKind::Inst));
        if let Some(span) = retain
            && (lives_one_call || matches!(block.kind, VarKind::InOut | VarKind::External))
        {
            let what = match block.kind {
                VarKind::Temp => "VAR_TEMP".to_owned(),
                VarKind::InOut => "VAR_IN_OUT".to_owned(),
                VarKind::External => "VAR_EXTERNAL".to_owned(),
                VarKind::Var | VarKind::Input | VarKind::Output | VarKind::Stat | VarKind::Inst | VarKind::Global => {
                    format!("a {}'s variable", pou.kind.word())
                }
            };
            self.report(
                Diagnostic::new(Code::E0403, span, format!("{what} cannot be RETAIN"))
                    .label("it has no value of its own to keep through a restart")
                    .help("declare the variable in VAR RETAIN"),
            );
        }
        self.check_retain_once(block);
        if let Some(span) = block.constant {
            self.check_constant_section(block.kind, span);
        }
        if block.kind == VarKind::Global && !self.has_globals(pou) {
            let kind = pou.kind.word();
            self.report(
                Diagnostic::new(Code::E0403, block.span, format!("a {kind} has no VAR_GLOBAL"))
                    .label(format!("expected VAR: its variables belong to the {kind} `{}`", pou.name.text))
                    .help(format!("write `VAR`, or move the block above the {kind}, to where the file's units are")),
            );
        }
    }

    fn check_constant_section(&mut self, kind: VarKind, span: Span) {
        let (message, help) = match kind {
            VarKind::Output if self.dialect(span) == Dialect::Codesys => return,
            VarKind::Output => ("a VAR_OUTPUT cannot be CONSTANT", "declare it in VAR CONSTANT"),
            VarKind::InOut if self.dialect(span).has_constant_in_outs() => return,
            VarKind::InOut => ("a VAR_IN_OUT cannot be CONSTANT", "declare what is only read in VAR_INPUT"),
            VarKind::Temp => ("a VAR_TEMP cannot be CONSTANT", "declare it in VAR CONSTANT"),
            VarKind::Var | VarKind::Input | VarKind::Stat | VarKind::Inst | VarKind::Global | VarKind::External => {
                return;
            }
        };
        self.report(Diagnostic::new(Code::E0403, span, message).help(help));
    }

    /// VAR_INST of a METHOD: its owner has the storage.
    pub(super) fn declare_instance_variables(
        &mut self,
        pou: &ast::Pou<'s>,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        owner: Option<&Signature<'s>>,
        builder: &mut Builder<'s>,
    ) {
        let Some(owner) = owner else {
            let word = pou.kind.word();
            self.report(
                Diagnostic::new(Code::E0403, block.span, format!("{} has no VAR_INST", article(word)))
                    .label("VAR_INST is for variables of a METHOD that are kept in the instance")
                    .help("write `VAR`"),
            );
            decl.names.iter().for_each(|name| builder.refuse(*name));
            return;
        };
        for name in &decl.names {
            let stored = owner.instance_variables.get(&name.span).cloned();
            let stored = stored.filter(|_| !self.is_named_as_result(pou, *name));
            let Some((place, resolved)) = stored else {
                builder.refuse(*name);
                continue;
            };
            let variable = self.variable(*name, block, Some(decl), resolved, place);
            let scope = builder.own_scope();
            self.enter_variable(scope, variable);
        }
    }

    /// Gives a variable its storage: a field of the instance, a local, or a parameter.
    pub(super) fn place_variable(
        &mut self,
        pou: &'s ast::Pou<'s>,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        name: ast::Name<'s>,
        resolved: &Rc<Resolved>,
        builder: &mut Builder<'s>,
    ) -> Option<Place> {
        let section = super::variable::section(block.kind);
        let constant = block.kind == VarKind::InOut && block.constant.is_some();
        let word = self.word(&decl.ty);
        let formal = |target| Formal { name, section, constant, resolved: Rc::clone(resolved), word, target };
        let place = match (pou.kind.is_function(), block.kind) {
            // A program has one set of variables, so they last anyway.
            (_, VarKind::Stat) if pou.kind.is_function() || pou.kind.is_block() => {
                return Some(self.static_variable(builder.slot, block, decl, name, resolved));
            }
            // The instance keeps it for its ACTIONs.
            (false, VarKind::InOut) if builder.polymorphic => {
                let place = self.push_field(block, decl, name, resolved, builder);
                builder.formals.push(formal(Target::Field(FieldId::next(builder.fields.len() - 1))));
                place
            }
            (true, VarKind::InOut) if builder.polymorphic => {
                let local = builder.local(name.text, resolved, decl.doc.clone());
                let at = builder.param(name.text, resolved, decl, Mode::Value(local));
                builder.formals.push(formal(Target::Param(at)));
                Place::local(local, resolved.ty)
            }
            (_, VarKind::InOut) => {
                let at = builder.param(name.text, resolved, decl, Mode::Reference);
                builder.formals.push(formal(Target::Param(at)));
                Place::root(Root::Param(ParamId::next(at)), resolved.ty)
            }
            (true, VarKind::Input) if self.program.is_open(resolved.ty) => {
                self.refuse_copy(resolved.ty, name, "declare it in VAR_IN_OUT")?;
                let at = builder.param(name.text, resolved, decl, Mode::Reference);
                builder.formals.push(formal(Target::Param(at)));
                Place::root(Root::Param(ParamId::next(at)), resolved.ty)
            }
            (true, VarKind::Input) => {
                self.refuse_copy(resolved.ty, name, "declare it in VAR_IN_OUT")?;
                let local = builder.local(name.text, resolved, decl.doc.clone());
                let at = builder.param(name.text, resolved, decl, Mode::Value(local));
                builder.formals.push(formal(Target::Param(at)));
                Place::local(local, resolved.ty)
            }
            (true, VarKind::Output) => {
                let at = builder.param(name.text, resolved, decl, Mode::Reference);
                builder.formals.push(formal(Target::Param(at)));
                Place::root(Root::Param(ParamId::next(at)), resolved.ty)
            }
            (true, _) | (_, VarKind::Temp) => {
                Place::local(builder.local(name.text, resolved, decl.doc.clone()), resolved.ty)
            }
            (false, _) => {
                let has_place = pou.kind == PouKind::Program || matches!(block.kind, VarKind::Var | VarKind::Stat);
                let located = has_place.then(|| self.located(Some(pou.name), block, decl, name, resolved));
                let place = match located.flatten() {
                    Some(place) => place?,
                    None => {
                        let place = self.push_field(block, decl, name, resolved, builder);
                        if matches!(block.kind, VarKind::Input | VarKind::Output) {
                            builder.formals.push(formal(Target::Field(FieldId::next(builder.fields.len() - 1))));
                        }
                        place
                    }
                };
                match decl.edge {
                    Some((edge, span)) => self.edge_input(edge, span, name, place, builder)?,
                    None => place,
                }
            }
        };
        if let (Root::Param(id), true) = (place.root, self.program.is_open(resolved.ty)) {
            builder.params[id.index()].bounds = builder.bounds(name.text, &self.program, resolved.ty);
        }
        if let (Some((_, span)), true) = (decl.edge, block.kind != VarKind::Input || pou.kind.is_function()) {
            self.error(Code::E0403, span, "R_EDGE and F_EDGE are only for inputs of a FUNCTION_BLOCK or PROGRAM");
        }
        Some(place)
    }

    fn push_field(
        &mut self,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        name: ast::Name<'s>,
        resolved: &Resolved,
        builder: &mut Builder<'s>,
    ) -> Place {
        let id = FieldId::next(builder.fields.len());
        let place = Place::root(Root::Instance, resolved.ty).field(id, resolved.ty);
        let field = self.field(name, resolved, block, decl);
        builder.fields.push(field);
        place
    }

    /// VAR_STAT: one variable for all calls and all instances.
    fn static_variable(
        &mut self,
        slot: usize,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        name: ast::Name<'s>,
        resolved: &Resolved,
    ) -> Place {
        // What a class inherits is declared once, and so is its variable.
        let is_instance = self.pous[slot].instance.is_some();
        if let Some(at) = self.synthetic.statics.get(&name.span).copied().filter(|_| !is_instance) {
            return self.synthetic_place(at);
        }
        let around = self.pous[slot].owner.into_iter().chain([slot]).map(|it| self.emitted_name(it));
        let around = around.collect::<Vec<_>>().join("_").replace('.', "_");
        let spelling = format!("{around}_{}", name.text);
        let field = Field { name: spelling, section: Section::Global, ..self.field(name, resolved, block, decl) };
        let at = self.add_synthetic(field, Some(name));
        self.synthetic.statics.insert(name.span, at);
        self.synthetic_place(at)
    }

    /// Adds the hidden trigger of an edge input; the body reads the trigger's `Q`.
    fn edge_input(
        &mut self,
        edge: ast::Edge,
        span: Span,
        name: ast::Name<'s>,
        input: Place,
        builder: &mut Builder<'s>,
    ) -> Option<Place> {
        if input.ty != Type::BOOL {
            self.error(Code::E0403, span, "R_EDGE and F_EDGE are for inputs of type BOOL");
            return None;
        }
        let name_of_block = match edge {
            ast::Edge::Rising => "R_TRIG",
            ast::Edge::Falling => "F_TRIG",
        };
        let block = dialect::bare_block(self.dialect(span), name_of_block)?;
        let block = dialect::as_options_have_it(block, |it| self.log.options.is_on(it));
        let id = FieldId::next(builder.fields.len());
        builder.fields.push(Field {
            name: format!("{}_edge", name.text),
            ty: Type::Block(block),
            initial: Const::Zero,
            section: Section::Internal,
            retain: staunch_ir::Retain::Inherited,
            constant: false,
            address: None,
            doc: Some(format!("Edge memory of `{}`", name.text)),
            location: self.location(name.span),
            declared: None,
        });
        let trigger = Place::root(Root::Instance, Type::Block(block)).field(id, Type::Block(block));
        builder.edges.push(EdgeInput { input, trigger: trigger.clone() });
        Some(pin_place(trigger, block, "Q"))
    }
}

/// An ACTION is called as its POU is, and works with what that has.
fn signature_of_action<'s>(owner: &Signature<'s>, scope: Rc<Scope<'s>>) -> Signature<'s> {
    // What stands for bounds is a local, of which it has its own.
    let (mut params, mut locals) = (owner.params.clone(), Vec::new());
    for local in params.iter_mut().flat_map(|it| &mut it.bounds).flat_map(|(low, high)| [low, high]) {
        locals.push(owner.locals[local.index()].clone());
        *local = LocalId::next(locals.len() - 1);
    }
    Signature { scope: Rc::new(Scope::within(scope)), params, locals, result: None, edges: Vec::new(), ..owner.clone() }
}

fn within(inner: Span, outer: Span) -> bool {
    inner.file == outer.file && outer.start <= inner.start && inner.end <= outer.end
}

impl<'s> Builder<'s> {
    /// The scope, to add to.
    pub fn own_scope(&mut self) -> &mut Scope<'s> {
        Rc::get_mut(&mut self.scope).expect("no one else holds the scope between declarations")
    }

    pub fn refuse(&mut self, name: ast::Name<'s>) {
        Rc::get_mut(&mut self.scope).expect("no one else holds the scope between declarations").refuse(name);
    }

    fn local(&mut self, name: &str, resolved: &Resolved, doc: Option<String>) -> LocalId {
        let id = LocalId::next(self.locals.len());
        self.locals.push(Local { name: name.to_owned(), ty: resolved.ty, initial: resolved.initial.clone(), doc });
        id
    }

    fn param(&mut self, name: &str, resolved: &Resolved, decl: &ast::VarDecl<'_>, mode: Mode) -> usize {
        let (name, doc) = (name.to_owned(), decl.doc.clone());
        self.params.push(Param { name, ty: resolved.ty, doc, mode, bounds: Vec::new() });
        self.params.len() - 1
    }

    /// The locals for the bounds of an `ARRAY[*]`.
    fn bounds(&mut self, name: &str, program: &Program, mut ty: Type) -> Vec<(LocalId, LocalId)> {
        let mut bounds = Vec::new();
        while let Type::Array(id) = ty
            && program.array(id).is_open()
        {
            let mut local = |end| self.local(&format!("{name}_{end}"), &Resolved::plain(Type::DINT), None);
            bounds.push((local("low"), local("high")));
            ty = program.array(id).element;
        }
        bounds
    }
}
