//! What declarations say of the start of instances: the METHODs that it calls, the values, and the arguments of FB_init.

use crate::ast::{PouKind, TypeKind, TypeSpec, VarBlock, VarDecl, VarKind};
use crate::dialect::Dialect;
use crate::spelling::Key;
use crate::start::{AFTER, GLOBALS, INIT, INITIAL, OF_INSTANCE, START, is_after};
use crate::types::declarations::Declarations;
use crate::types::starts::OF_THE_SYSTEM;
use crate::{Code, Diagnostic};
use staunch_ir::Type;

impl<'s> Declarations<'s> {
    /// Whether instances have a start.
    pub(super) fn note_starts(&mut self) {
        self.starts.is_any = self.pous.iter().any(|it| it.ast.name.text == GLOBALS);
    }

    /// Reports arguments for an instance that is declared, and started, elsewhere.
    pub(super) fn check_is_own_instance(&mut self, block: &VarBlock<'s>, decl: &VarDecl<'s>) {
        let (word, label) = match block.kind {
            VarKind::InOut => ("VAR_IN_OUT", "it stands for an instance of the caller, which has already been started"),
            VarKind::External => ("VAR_EXTERNAL", "the instance starts where VAR_GLOBAL declares it"),
            VarKind::Var
            | VarKind::Input
            | VarKind::Output
            | VarKind::Temp
            | VarKind::Stat
            | VarKind::Inst
            | VarKind::Global => return,
        };
        if let Some(construction) = decl.construction.as_ref().filter(|_| !self.says_nothing(decl)) {
            let message = format!("a variable of {word} takes no arguments");
            let error = Diagnostic::new(Code::E0304, construction.span, message).label(label);
            self.report(error.help("delete them").fix(construction.span, ""));
        }
    }

    /// Reports arguments for instances that take none.
    pub(super) fn check_construction(&mut self, decl: &VarDecl<'s>, mut ty: Type) {
        let Some(construction) = &decl.construction else { return };
        if let TypeKind::Reference { kind, .. } = &decl.ty.kind {
            let message = format!("a {} takes no arguments", kind.word());
            let error = Diagnostic::new(Code::E0304, construction.span, message)
                .label("they are for FB_init, which runs where an instance is declared")
                .help("delete them")
                .fix(construction.span, "");
            return self.report(error);
        }
        let is_array = matches!(ty, Type::Array(_));
        while let Type::Array(id) = ty {
            ty = self.program.array(id).element;
        }
        let class = if let Type::Struct(id) = ty { self.slot_of_instance(id) } else { None };
        let name = self.program.type_name(ty);
        if class.is_some_and(|it| self.has_unknown_base(it)) {
            return;
        }
        if class.is_none_or(|it| self.initial_methods(it).is_empty()) {
            if (class.is_some() || matches!(ty, Type::Block(_))) && self.says_nothing(decl) {
                return;
            }
            let label = match class {
                Some(_) => "only a METHOD FB_init takes such arguments, in `codesys`",
                None => "only an instance of a FUNCTION_BLOCK with a METHOD FB_init takes arguments",
            };
            self.report(
                Diagnostic::new(
                    Code::E0304,
                    construction.span,
                    format!("a variable of type `{name}` takes no arguments"),
                )
                .label(label)
                .help("initial values are written after `:=`: `: Type := (member := value)`"),
            );
        } else if !is_array && construction.is_of_elements {
            let error = Diagnostic::new(Code::E0304, construction.span, "FB_init runs for each instance");
            self.report(error.label("write one list: `(…)`"));
        }
    }

    /// Whether empty parentheses are after the type, in a dialect that has FB_init.
    fn says_nothing(&self, decl: &VarDecl<'s>) -> bool {
        let is_empty = decl.construction.as_ref().is_some_and(|it| it.lists.iter().all(Vec::is_empty));
        is_empty && self.dialect(decl.span) == Dialect::Codesys
    }

    /// Reports FB_init of a PROGRAM, which nothing calls.
    pub(super) fn check_program_has_no_start(&mut self, program: usize) {
        let init = self.pous[program].routines.get(&Key(INIT)).and_then(|it| it.called);
        let Some((_, span)) = init.filter(|it| self.dialect(it.1) == Dialect::Codesys) else { return };
        self.report(
            Diagnostic::new(Code::E0403, span, "a PROGRAM has no FB_init")
                .in_this_dialect()
                .label("the system calls it only for instances of FUNCTION_BLOCKs")
                .help("give the variables initial values, or move these statements into a FUNCTION_BLOCK and declare an instance of it"),
        );
    }

    /// Reports METHODs that the start calls, and cannot.
    pub(super) fn check_started(&mut self, class: usize) {
        for slot in self.initial_methods(class) {
            let pou = self.pous[slot].ast;
            if pou.home.is_some() {
                continue;
            }
            let inputs = pou.blocks.iter().filter(|it| it.kind == VarKind::Input).flat_map(|it| &it.vars);
            let names: Vec<_> = inputs.flat_map(|it| &it.names).map(|it| Key(it.text)).collect();
            let missing = OF_THE_SYSTEM.iter().find(|it| !names.contains(&Key(it)));
            if let Some(missing) = missing {
                self.report(
                    Diagnostic::new(Code::E0403, pou.name.span, format!("this FB_init has no input `{missing}`"))
                        .label("the system passes the kind of start in these inputs")
                        .in_this_dialect()
                        .help("declare `VAR_INPUT bInitRetains : BOOL; bInCopyCode : BOOL; END_VAR` in it"),
                );
            }
        }
        self.check_overridden_after(class);
        for slot in self.methods_after(class) {
            let (pou, owner) = (self.pous[slot].ast, self.pous[class].ast);
            let is_given = |it: &&VarBlock<'_>| matches!(it.kind, VarKind::Input | VarKind::InOut);
            if let Some(block) = pou.blocks.iter().filter(is_given).find(|it| !it.vars.is_empty()) {
                self.report(
                    Diagnostic::new(Code::E0403, block.span, "a METHOD that runs after the start has no inputs")
                        .in_this_dialect()
                        .label("the system calls it without arguments")
                        .other(pou.name.span, format!("`{AFTER}` is before this METHOD")),
                );
            }
            if INITIAL.iter().any(|it| Key(it) == Key(pou.name.text)) {
                let message = format!("`{}` is already called by the system", pou.name.text);
                self.report(Diagnostic::new(Code::E0403, pou.name.span, message).label(format!("without `{AFTER}`")));
            } else if !owner.attributes.iter().any(|it| it.eq_ignore_ascii_case(AFTER)) {
                let message = format!("`{}` lacks the attribute of its METHOD `{}`", owner.name.text, pou.name.text);
                self.report(
                    Diagnostic::new(Code::E0403, owner.name.span, message)
                        .label("so CODESYS and TwinCAT do not call the METHOD")
                        .other(pou.name.span, "this METHOD has the attribute")
                        .help(format!("write `{{attribute '{AFTER}'}}` before the {}, too", owner.kind.word())),
                );
            }
        }
    }

    /// Reports METHODs without the attribute that override one with it: no document says whether they are called.
    fn check_overridden_after(&mut self, class: usize) {
        let Some(base) = self.base_of(class) else { return };
        let is_own = |it: &usize| self.pous[*it].owner == Some(class);
        let own = (class + 1..self.pous.len()).take_while(is_own);
        let is_new = |it: &usize| self.pous[*it].ast.home.is_none() && !is_after(self.pous[*it].ast);
        for new in own.filter(is_new).collect::<Vec<_>>() {
            let old = self.routine_for(base, new).filter(|it| is_after(self.pous[*it].ast));
            let Some(old) = old.map(|it| self.pous[it].ast.name).filter(|it| self.dialect(it.span) == Dialect::Codesys)
            else {
                continue;
            };
            let name = self.pous[new].ast.name;
            self.report(
                Diagnostic::new(Code::E0403, name.span, format!("`{}` overrides a METHOD with `{AFTER}`", name.text))
                    .label("this METHOD lacks the attribute")
                    .other(old.span, "this one has it")
                    .help(format!("write `{{attribute '{AFTER}'}}` before this METHOD, too")),
            );
        }
    }

    /// What is said of a routine in emitted code. A PROGRAM that others name starts as an instance among the globals does.
    pub(crate) fn doc_of(&self, slot: usize) -> Option<String> {
        let pou = self.pous[slot].ast;
        let of_named = self.pous[slot].owner.is_some_and(|it| self.is_named_program(it));
        match pou.name.text == START && of_named {
            true => Some(OF_INSTANCE.to_owned()),
            false => pou.doc.clone(),
        }
    }

    /// The METHOD that starts what is in the PROGRAM in a slot.
    pub(crate) fn start_of_program(&self, slot: usize) -> Option<usize> {
        let pou = &self.pous[slot];
        let start = pou.routines.get(&Key(START)).and_then(|it| it.called)?;
        (pou.ast.kind == PouKind::Program).then_some(start.0)
    }

    /// Whether a routine is one that starts what is in a class, and there is nothing.
    pub(crate) fn starts_nothing(&self, slot: usize) -> bool {
        let pou = self.pous[slot].ast;
        let owner = self.pous[slot].owner.filter(|it| self.pous[*it].ast.kind != PouKind::Program);
        pou.name.text == START && owner.is_some() && self.program.routines[slot].body.is_empty()
    }
}

/// The declarations of a structure's members.
pub(crate) fn members<'s>(ty: &'s TypeSpec<'s>, found: &mut Vec<&'s VarDecl<'s>>) {
    match &ty.kind {
        TypeKind::Struct(members) | TypeKind::Union(members) => {
            for member in members {
                found.push(member);
                self::members(&member.ty, found);
            }
        }
        TypeKind::Array { element, .. } => members(element, found),
        TypeKind::Named(_)
        | TypeKind::String { .. }
        | TypeKind::Subrange { .. }
        | TypeKind::Enum { .. }
        | TypeKind::Reference { .. }
        | TypeKind::Error => {}
    }
}
