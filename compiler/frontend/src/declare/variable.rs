//! What the keyword and the marks of a block of variables say of each of them.

use crate::ast;
use crate::types::declarations::Declarations;
use crate::types::scope::{Scope, Variable};
use crate::types::table::Resolved;
use staunch_ir::{DeclarationId, Field, Place, Section};
use std::cell::Cell;
use std::rc::Rc;

pub(crate) fn section(kind: ast::VarKind) -> Section {
    match kind {
        ast::VarKind::Var | ast::VarKind::Stat | ast::VarKind::Inst => Section::Internal,
        ast::VarKind::Input => Section::Input,
        ast::VarKind::Output => Section::Output,
        ast::VarKind::InOut => Section::InOut,
        ast::VarKind::Temp => Section::Temp,
        ast::VarKind::Global => Section::Global,
        ast::VarKind::External => Section::External,
    }
}

/// RETAIN, or its synonym PERSISTENT.
pub fn is_declared_retain(block: &ast::VarBlock<'_>) -> bool {
    block.retain.is_some() || block.persistent.is_some()
}

/// What the words of a block say of a restart.
fn retention(block: &ast::VarBlock<'_>) -> staunch_ir::Retain {
    match (is_declared_retain(block), block.non_retain) {
        (true, _) => staunch_ir::Retain::Kept,
        (false, Some(_)) => staunch_ir::Retain::Anew,
        (false, None) => staunch_ir::Retain::Inherited,
    }
}

impl<'s> Declarations<'s> {
    pub(super) fn variable(
        &self,
        name: ast::Name<'s>,
        block: &ast::VarBlock<'s>,
        declared: Option<&'s ast::VarDecl<'s>>,
        resolved: Rc<Resolved>,
        place: Place,
    ) -> Variable<'s> {
        Variable {
            name,
            declared,
            place,
            section: section(block.kind),
            constant: block.constant.is_some(),
            retain: is_declared_retain(block) || self.keeps_everything(name.span),
            resolved,
            used: Rc::new(Cell::new(false)),
        }
    }

    /// Whether a power cycle leaves what is declared at `span`, whatever its declaration says.
    fn keeps_everything(&self, span: crate::Span) -> bool {
        self.dialect(span).family().over_power_cycle() == staunch_runtime::Keeps::Everything
    }

    /// The counter in a variable, by its path, that RETAIN does not keep: Cscape has R_CTU and R_CTD.
    fn lost_counter(&self, path: String, ty: staunch_ir::Type) -> Option<String> {
        match ty {
            staunch_ir::Type::Block(id) => {
                let info = id.info();
                let is_lost = info.retention == staunch_runtime::Retention::Inputs && info.facts.kept.is_none();
                is_lost.then_some(path)
            }
            staunch_ir::Type::Array(id) => self.lost_counter(path, self.program.array(id).element),
            staunch_ir::Type::Struct(id) => {
                let mut fields = self.program.structure(id).fields.iter();
                fields.find_map(|it| self.lost_counter(format!("{path}.{}", it.name), it.ty))
            }
            staunch_ir::Type::Elementary(_)
            | staunch_ir::Type::Reference(_)
            | staunch_ir::Type::Subrange(..)
            | staunch_ir::Type::String(_)
            | staunch_ir::Type::Enum(_) => None,
        }
    }

    /// Reports a block that is both RETAIN and NON_RETAIN, or CONSTANT and one of them.
    pub(super) fn check_retain_once(&mut self, block: &ast::VarBlock<'s>) {
        // TwinCAT has `VAR_INPUT CONSTANT PERSISTENT`: the program writes none of it, so a start has nothing to restore.
        let persistent = block.persistent.filter(|it| !self.dialect(*it).has_persistent_constants());
        if let (Some(constant), Some(retain)) = (block.constant, block.retain.or(persistent).or(block.non_retain)) {
            let word = self.log.sources.text(retain);
            let message = format!("a variable is CONSTANT or {word}, not both");
            self.report(
                crate::Diagnostic::new(crate::Code::E0403, retain, message)
                    .label("a CONSTANT has its value at each start")
                    .other(constant, "CONSTANT here")
                    .help(format!("delete {word}"))
                    .fix(retain, ""),
            );
        }
        if let (Some(kept), Some(not)) = (block.retain.or(block.persistent), block.non_retain) {
            self.report(
                crate::Diagnostic::new(crate::Code::E0403, not, "a variable is RETAIN or NON_RETAIN, not both")
                    .label("this contradicts the other word")
                    .other(kept, "this keeps the values through a restart")
                    .help("delete one of the two"),
            );
        }
    }

    /// Reports RETAIN where it keeps nothing.
    pub(super) fn check_retain(&mut self, block: &ast::VarBlock<'s>, ty: staunch_ir::Type, name: ast::Name<'s>) {
        if !is_declared_retain(block) {
            return;
        }
        if let Some(path) = self.lost_counter(name.text.to_owned(), ty) {
            self.report(
                crate::Diagnostic::new(
                    crate::Code::W0302,
                    name.span,
                    format!("RETAIN does not keep the count of `{path}`, a Cscape counter"),
                )
                .label("it starts again from 0 after a restart")
                .help("use R_CTU or R_CTD, with a RETAIN variable for RCV"),
            );
        }
    }

    pub(super) fn field(
        &mut self,
        name: ast::Name<'s>,
        resolved: &Resolved,
        block: &ast::VarBlock<'s>,
        decl: &'s ast::VarDecl<'s>,
    ) -> Field {
        let declared = DeclarationId::next(self.declared.len());
        self.declared.push((name, decl));
        let address = decl.address.and_then(|it| crate::types::address::parse(it.text));
        Field {
            name: crate::types::address::field_name(name.text),
            ty: resolved.ty,
            initial: resolved.initial.clone(),
            section: section(block.kind),
            retain: retention(block),
            constant: block.has_values(),
            address,
            doc: decl.doc.clone(),
            location: self.location(name.span),
            declared: Some(declared),
        }
    }

    /// Reports a second variable of the same name in one scope.
    pub(super) fn enter_variable(&mut self, scope: &mut Scope<'s>, variable: Variable<'s>) {
        let name = variable.name;
        if variable.section != Section::External {
            self.check_spelling(name);
        }
        if let Err(first) = scope.insert(variable) {
            self.report(
                crate::Diagnostic::new(crate::Code::E0103, name.span, format!("`{}` is declared twice", name.text))
                    .label("declared again here")
                    .other(first.span, "first declared here"),
            );
        }
    }
}
