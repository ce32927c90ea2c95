//! The variables that a POU declares, one declaration at a time.

use super::pou::Builder;
use super::specs::Within;
use crate::ast::{self, PouKind, VarKind};
use crate::diagnostic::wording::article;
use crate::types::declarations::Declarations;
use crate::types::signature::Signature;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{BlockId, Part, Type};
use std::rc::Rc;

impl<'s> Declarations<'s> {
    pub(super) fn declare_variables(
        &mut self,
        pou: &'s ast::Pou<'s>,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        owner_signature: Option<&Signature<'s>>,
        builder: &mut Builder<'s>,
    ) {
        if block.kind == VarKind::Global && self.has_globals(pou) {
            return;
        }
        self.check_address_here(Some(pou.kind), block, decl);
        match block.kind {
            VarKind::Inst => self.declare_instance_variables(pou, block, decl, owner_signature, builder),
            VarKind::External => self.declare_early_externals(block, decl, builder),
            VarKind::Var
            | VarKind::Input
            | VarKind::Output
            | VarKind::InOut
            | VarKind::Temp
            | VarKind::Stat
            | VarKind::Global => self.declare_own(pou, block, decl, builder),
        }
    }

    fn declare_early_externals(
        &mut self,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        builder: &mut Builder<'s>,
    ) {
        self.check_is_own_instance(block, decl);
        if self.is_early_external(decl) {
            self.declare_externals(block, decl, builder.own_scope());
        }
    }

    fn declare_own(
        &mut self,
        pou: &'s ast::Pou<'s>,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        builder: &mut Builder<'s>,
    ) {
        self.check_one_name(decl);
        self.check_in_out_has_no_initial(block, decl);
        let Some(resolved) = self.type_of_declaration(pou, block, decl, builder) else {
            decl.names.iter().for_each(|name| builder.refuse(*name));
            return;
        };
        let reference = decl.names.iter().find_map(|it| self.polymorphic_type(builder.slot, block, *it, resolved.ty));
        builder.polymorphic = reference.is_some();
        let resolved = Rc::new(reference.map_or(resolved, Resolved::plain));
        self.check_has_value(pou, block, decl, resolved.ty);
        if let Some(first) = decl.names.first() {
            self.check_retain(block, resolved.ty, *first);
        }
        if pou.kind.is_function() && block.kind == VarKind::Output {
            self.note_part(Part::FunctionOutput, decl.span);
        }
        if pou.kind.is_function() && block.kind == VarKind::Input && decl.initial.is_some() {
            self.note_part(Part::FunctionDefault, decl.span);
        }
        let starts_anew = block.kind == VarKind::Temp || (pou.kind.is_function() && block.kind == VarKind::Var);
        if starts_anew && let Some(id) = self.remembers(resolved.ty) {
            self.forgets(pou, decl, id);
        }
        for name in &decl.names {
            self.declare_name(pou, block, decl, *name, &resolved, builder);
        }
    }

    fn check_in_out_has_no_initial(&mut self, block: &ast::VarBlock<'s>, decl: &ast::VarDecl<'s>) {
        let (VarKind::InOut, Some(initial)) = (block.kind, &decl.initial) else { return };
        if self.dialect(initial.span).has_values_of_in_outs() {
            return;
        }
        let whole = Span { start: decl.ty.span.end, ..initial.span };
        self.report(
            Diagnostic::new(Code::E0403, initial.span, "a VAR_IN_OUT has no initial value")
                .label("it stands for a variable of the caller")
                .help("delete it")
                .fix(whole, ""),
        );
    }

    /// The type and the initial value of what is declared, as it is written; `None` where it was refused.
    fn type_of_declaration(
        &mut self,
        pou: &'s ast::Pou<'s>,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        builder: &Builder<'s>,
    ) -> Option<Resolved> {
        let scope = &builder.scope;
        let owner = owner_of(pou, decl);
        let reported = self.log.diagnostics.len();
        let is_given = pou.kind == PouKind::Program && block.kind == VarKind::Input;
        let within = if is_given { Within::Input } else { Within::of(pou) };
        let resolved = match open_bounds(pou, block, decl) {
            Some((bounds, element)) => {
                self.check_no_initial(decl);
                self.open_array(bounds, element, scope, owner)
            }
            None => match self.abstract_in_out(builder.slot, block, decl) {
                Some(ty) => Some(Resolved::plain(ty)),
                None if pou.kind.is_block() && self.is_bit(&decl.ty) => self.initial_bit(decl, scope),
                None => self.declared_type(decl, scope, owner, within),
            },
        };
        if !self.log.has_errors_since(reported) {
            self.check_is_own_instance(block, decl);
        }
        // What needs the value of a CONSTANT knows none where that was refused.
        resolved.filter(|_| !block.has_values() || !self.log.has_errors_since(reported))
    }

    /// Reports a CONSTANT that is not given a value.
    fn check_has_value(&mut self, pou: &ast::Pou<'s>, block: &ast::VarBlock<'s>, decl: &ast::VarDecl<'s>, ty: Type) {
        let is_plain = matches!(ty, Type::Elementary(_) | Type::Reference(_) | Type::String(_));
        if block.constant.is_some() && decl.initial.is_none() && block.kind == VarKind::Var && is_plain {
            let owner = owner_of(pou, decl);
            self.report(
                Diagnostic::new(Code::W0404, decl.span, format!("the CONSTANT `{owner}` has no value"))
                    .label("it has its type's initial value")
                    .help("give it one: `name : TYPE := value;`"),
            );
        }
    }

    fn declare_name(
        &mut self,
        pou: &'s ast::Pou<'s>,
        block: &'s ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
        name: ast::Name<'s>,
        resolved: &Rc<Resolved>,
        builder: &mut Builder<'s>,
    ) {
        if self.is_named_as_result(pou, name) {
            return builder.refuse(name);
        }
        let Some(place) = self.place_variable(pou, block, decl, name, resolved, builder) else {
            return builder.refuse(name);
        };
        let mut variable = self.variable(name, block, Some(decl), Rc::clone(resolved), place);
        if let Some(early) = builder.scope.constants.as_ref().and_then(|it| it.get(name.text)) {
            variable.used = Rc::clone(&early.used);
        }
        if let Some(used) = self.used_in_generic(builder.slot, name.text) {
            variable.used = used;
        }
        self.hide_private(&variable, builder);
        self.enter_variable(builder.own_scope(), variable);
    }

    /// Reports a variable that has its FUNCTION's or METHOD's name, which is that of the result there.
    pub(super) fn is_named_as_result(&mut self, pou: &ast::Pou<'s>, name: ast::Name<'s>) -> bool {
        let without = pou.result.is_none() && self.dialect(pou.name.span).shows_inner_variables();
        // What has no body uses neither name.
        let is_declared = pou.is_stub && self.log.sources.is_of_automation_studio();
        let has_result = pou.kind.is_function() && pou.kind != PouKind::Setter && !without && !is_declared;
        let is_result = has_result && name.text.eq_ignore_ascii_case(pou.name.text);
        if is_result {
            self.report(
                Diagnostic::new(Code::E0103, name.span, format!("`{}` is declared twice", name.text))
                    .label(format!("in the body of the {} its name means its result", pou.kind.word()))
                    .other(pou.name.span, "first declared here"),
            );
        }
        is_result
    }

    /// The class of a VAR_IN_OUT that stands for instances of what extends an ABSTRACT one.
    fn abstract_in_out(&mut self, slot: usize, block: &ast::VarBlock<'s>, decl: &ast::VarDecl<'s>) -> Option<Type> {
        let ast::TypeKind::Named(path) = &decl.ty.kind else { return None };
        let ty = self.class_at(path).filter(|_| self.may_be_polymorphic(slot, block))?;
        let Type::Struct(state) = ty else { return None };
        let class = self.slot_of_instance(state)?;
        self.pous[class].ast.modifiers.is_abstract.is_some().then_some(ty)
    }

    /// The standard block in a type: it works with what it remembers of earlier calls.
    fn remembers(&self, ty: Type) -> Option<BlockId> {
        self.program.find_in(ty, &|it| match it {
            Type::Block(id) => Some(id),
            _ => None,
        })
    }

    /// Reports a block whose state does not outlive the call.
    fn forgets(&mut self, pou: &ast::Pou<'s>, decl: &ast::VarDecl<'s>, id: BlockId) {
        let info = id.info();
        let what = if info.pin("PT").is_some() {
            "its time never passes"
        } else if info.is_counter() {
            "its count is lost"
        } else if info.pin("CLK").is_some() {
            "it takes every TRUE for an edge"
        } else {
            "its state is lost"
        };
        let (place, help) = match pou.kind {
            PouKind::Function => ("a FUNCTION", "make this a FUNCTION_BLOCK, or take the block as a VAR_IN_OUT"),
            PouKind::Method | PouKind::Getter | PouKind::Setter => {
                ("a METHOD", "declare it in the FUNCTION_BLOCK, or take the block as a VAR_IN_OUT")
            }
            PouKind::Program
            | PouKind::FunctionBlock
            | PouKind::Class
            | PouKind::Interface
            | PouKind::Test
            | PouKind::Action => ("VAR_TEMP", "declare it in VAR"),
        };
        let block = article(info.name);
        self.report(
            Diagnostic::new(Code::W0303, decl.span, format!("{block} in {place} starts again at each call"))
                .label(format!("so {what}"))
                .help(help),
        );
    }

    /// An array of any bounds is its caller's.
    fn check_no_initial(&mut self, decl: &ast::VarDecl<'s>) {
        let Some(initial) = &decl.initial else { return };
        self.report(
            Diagnostic::new(Code::E0403, initial.span, "an array of any bounds has no initial value")
                .label("its number of elements is known only in a call"),
        );
    }
}

/// What messages call a declaration: its first variable.
fn owner_of<'s>(pou: &ast::Pou<'s>, decl: &ast::VarDecl<'s>) -> &'s str {
    decl.names.first().map_or(pou.name.text, |it| it.text)
}

/// What `ARRAY[*]` is made of, where a parameter may be one: the standard has it for inputs, outputs and
/// in-outs of FUNCTIONs and METHODs, and for in-outs of FUNCTION_BLOCKs.
fn open_bounds<'s>(
    pou: &ast::Pou<'s>,
    block: &ast::VarBlock<'s>,
    decl: &'s ast::VarDecl<'s>,
) -> Option<(&'s [ast::Bound<'s>], &'s ast::TypeSpec<'s>)> {
    let may = if pou.kind.is_function() {
        matches!(block.kind, VarKind::Input | VarKind::Output | VarKind::InOut)
    } else {
        pou.kind.is_block() && block.kind == VarKind::InOut
    };
    match &decl.ty.kind {
        ast::TypeKind::Array { bounds, element } if may => {
            bounds.iter().any(|it| matches!(it, ast::Bound::Open(_))).then_some((bounds, element))
        }
        _ => None,
    }
}
