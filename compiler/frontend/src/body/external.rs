//! `{external}`: a FUNCTION or FUNCTION_BLOCK that is implemented outside of Structured Text. Its routine hands its
//! parameters over, each as a copy where two of them might share storage, so that Rust may have them at once.

use crate::ast::{self, PouKind, VarKind};
use crate::diagnostic::wording::article;
use crate::expr::checker::Checker;
use crate::types::declarations::Declarations;
use crate::types::signature::Signature;
use crate::{Code, Diagnostic, Span};
use staunch_ir::{
    Argument, Block, Expr, External, ExternalCall, ExternalParam, FaultKind, Mode, ParamId, Place, Root, StatementKind,
    Type,
};

impl<'s> Checker<'_, 's> {
    /// The body of what is implemented outside.
    pub(super) fn external_body(&mut self, slot: usize, signature: &Signature<'s>, statements: &[ast::Statement<'s>]) {
        let pou = self.decl.pous[slot].ast;
        let span = pou.name.span;
        self.check_no_statements(pou, statements);
        let Some(external) = self.decl.outside(slot, signature) else { return };
        if self.decl.log.options.is_run {
            self.push(StatementKind::Fault(FaultKind::NotImplemented), span);
            return;
        }
        let at = self.at(span);
        let instance = signature.state.map(|it| Place::root(Root::Instance, Type::Struct(it)));
        let references = external.params.iter().filter(|it| it.by_reference).count() + usize::from(instance.is_some());
        let (mut arguments, mut back) = (Vec::new(), Vec::new());
        for (number, param) in signature.params.iter().enumerate() {
            let own = Place::root(Root::Param(ParamId::next(number)), param.ty);
            arguments.push(match param.mode {
                Mode::Value(local) => Argument::Value(Expr::load(Place::local(local, param.ty), at)),
                Mode::Reference if references == 1 => Argument::Reference(own),
                Mode::Reference => {
                    let copy = self.temporary(&param.name, param.ty);
                    self.assign(copy.clone(), Expr::load(own.clone(), at), span);
                    back.push((own, copy.clone()));
                    Argument::Reference(copy)
                }
            });
        }
        let result = signature.result.as_ref().map(|(local, resolved)| Place::local(*local, resolved.ty));
        let call = ExternalCall { external, instance, arguments, result };
        self.push(StatementKind::External(Box::new(call)), span);
        for (own, copy) in back {
            self.assign(own, Expr::load(copy, at), span);
        }
    }

    /// In place of what is missing.
    pub(super) fn not_there(&mut self, span: Span) -> Block {
        self.nested(|this| this.push(StatementKind::Fault(FaultKind::NotImplemented), span))
    }

    /// What a mock puts before the body is at the name.
    fn check_no_statements(&mut self, pou: &ast::Pou<'s>, statements: &[ast::Statement<'s>]) {
        let is_written =
            |it: &&ast::Statement<'_>| !matches!(it.kind, ast::StatementKind::Empty) && it.span != pou.name.span;
        if let Some(first) = statements.iter().find(is_written) {
            let message = format!("`{}` is `{{external}}` but has a body", pou.name.text);
            self.report(
                Diagnostic::new(Code::E0319, first.span, message)
                    .label("it is implemented outside the program")
                    .help("delete the body, or `{external}`"),
            );
        }
        let mocks: Vec<_> = statements.iter().filter(|it| it.span == pou.name.span).cloned().collect();
        let mut block = self.block_of(&mocks);
        self.block.append(&mut block);
    }
}

impl<'s> Declarations<'s> {
    /// What is handed over, if all of it can be.
    fn outside(&mut self, slot: usize, signature: &Signature<'s>) -> Option<External> {
        let pou = self.pous[slot].ast;
        let declared = pou.external?;
        let reported = self.log.diagnostics.len();
        self.check_external_unit(slot);
        for formal in &signature.formals {
            let is_written = pou.kind.is_block() || formal.section != staunch_ir::Section::Input;
            self.check_passed(formal.resolved.ty, is_written, formal.name.span, pou);
        }
        for variable in &signature.scope.variables {
            let is_formal = signature.formals.iter().any(|it| it.name.span == variable.name.span);
            if pou.kind.is_block() && !is_formal {
                self.check_passed(variable.place.ty, true, variable.name.span, pou);
            }
        }
        if let Some((_, resolved)) = &signature.result {
            self.check_passed(resolved.ty, true, pou.name.span, pou);
        }
        let symbol = declared.symbol.map_or_else(|| self.emitted_name(slot).replace('.', "_"), str::to_owned);
        self.check_symbol(slot, &symbol);
        let params = signature.params.iter().map(|it| ExternalParam {
            name: it.name.clone(),
            ty: it.ty,
            by_reference: it.mode == Mode::Reference,
        });
        let params = params.collect();
        (self.log.diagnostics.len() == reported).then(|| External {
            name: self.emitted_name(slot),
            symbol,
            doc: pou.doc.clone(),
            location: self.location(pou.name.span),
            state: signature.state,
            params,
            result: signature.result.as_ref().map(|(_, resolved)| resolved.ty),
        })
    }

    fn refuse_external(&mut self, span: Span, message: String, label: &str, help: &str) {
        self.report(Diagnostic::new(Code::E0319, span, message).label(label.to_owned()).help(help.to_owned()));
    }

    /// Only a FUNCTION, or a FUNCTION_BLOCK without routines and bases, has a form outside.
    fn check_external_unit(&mut self, slot: usize) {
        let pou = self.pous[slot].ast;
        let kind = pou.kind.word();
        if !matches!(pou.kind, PouKind::Function | PouKind::FunctionBlock) {
            let message = format!("{} cannot be `{{external}}`", article(kind));
            return self.refuse_external(
                pou.name.span,
                message,
                "declared as external here",
                "call a FUNCTION or FUNCTION_BLOCK that is",
            );
        }
        let own = pou.routines.iter().find(|it| it.name.text != crate::start::START);
        if let Some(routine) = own {
            let message = format!("`{}` is `{{external}}` but has {}", pou.name.text, article(routine.kind.word()));
            let help = "pass an input that selects what to do, or declare an external FUNCTION for each METHOD";
            self.refuse_external(routine.name.span, message, "only a call of the instance itself is external", help);
        }
        if let Some(base) = pou.extends.or(pou.implements.first().copied()) {
            let message = format!("`{}` is `{{external}}` but has a base", pou.name.text);
            self.refuse_external(base.span, message, "METHODs cannot be external", "delete it");
        }
        if self.is_generic(slot) || self.pous[slot].instance.is_some() {
            let message = format!("`{}` is `{{external}}` but generic", pou.name.text);
            self.refuse_external(
                pou.name.span,
                message,
                "an external parameter has one type",
                "declare one for each type",
            );
        }
        let edges = pou.blocks.iter().flat_map(|it| &it.vars).filter_map(|it| it.edge);
        for (_, span) in edges {
            let message = format!("`{}` is `{{external}}` but has an edge input", pou.name.text);
            self.refuse_external(
                span,
                message,
                "edges are detected in a body, and it has none here",
                "delete it, and detect the edge in the implementation",
            );
        }
        let is_unused = |it: &&ast::VarBlock<'_>| match it.kind {
            VarKind::Temp | VarKind::External | VarKind::Stat | VarKind::Inst => true,
            VarKind::Var => pou.kind.is_function(),
            VarKind::Input | VarKind::Output | VarKind::InOut | VarKind::Global => false,
        };
        if let Some(block) = pou.blocks.iter().find(is_unused) {
            let word = self.log.sources.text(block.span).to_ascii_uppercase();
            let message = format!("`{}` is `{{external}}` but has {word}", pou.name.text);
            self.refuse_external(block.span, message, "no body here can use these variables", "delete it");
        }
    }

    /// Only plain values can be looked at from outside, and a subrange cannot be held there.
    fn check_passed(&mut self, ty: Type, is_written: bool, span: Span, pou: &ast::Pou<'s>) {
        let Some(reason) = self.not_passed(ty, is_written) else { return };
        let message =
            format!("`{}` is `{{external}}`, but {} cannot be passed", pou.name.text, self.program.type_name(ty));
        self.report(Diagnostic::new(Code::E0319, span, message).label(reason));
    }

    fn not_passed(&self, ty: Type, is_written: bool) -> Option<&'static str> {
        match ty {
            Type::Elementary(_) | Type::String(_) | Type::Enum(_) => None,
            Type::Subrange(..) => {
                is_written.then_some("the implementation might ignore the limits: declare the type without them")
            }
            Type::Reference(_) => Some("references are checked only in Structured Text: pass the variable itself"),
            Type::Block(_) => Some("blocks are called only in Structured Text: pass its outputs"),
            Type::Array(id) if self.program.array(id).is_open() => {
                Some("it has no size of its own: declare the bounds")
            }
            Type::Array(id) => self.not_passed(self.program.array(id).element, is_written),
            Type::Struct(id) if self.slot_of_instance(id).is_some() => {
                Some("blocks are called only in Structured Text: pass its outputs")
            }
            Type::Struct(id) => {
                self.program.structure(id).fields.iter().find_map(|it| self.not_passed(it.ty, is_written))
            }
        }
    }

    /// A symbol is a name of C, and has one meaning.
    fn check_symbol(&mut self, slot: usize, symbol: &str) {
        let pou = self.pous[slot].ast;
        let is_letter = |it: char| it.is_ascii_alphanumeric() || it == '_';
        let is_name = symbol.chars().all(is_letter) && !symbol.starts_with(|it: char| it.is_ascii_digit());
        if symbol.is_empty() || !is_name || symbol.starts_with("staunch_") {
            let message = format!("`{symbol}` cannot be a symbol of C");
            let help = "write another: `{external 'name'}`";
            return self.refuse_external(
                pou.name.span,
                message,
                "expected letters, digits and `_`; `staunch_` is reserved",
                help,
            );
        }
        let before = self.externals.entry(symbol.to_owned()).or_insert(pou.name.span);
        let before = *before;
        if before != pou.name.span {
            self.report(
                Diagnostic::new(
                    Code::E0319,
                    pou.name.span,
                    format!("two `{{external}}` POUs have the symbol `{symbol}`"),
                )
                .other(before, "the other one")
                .help("give one of them another symbol: `{external 'name'}`"),
            );
        }
    }
}
