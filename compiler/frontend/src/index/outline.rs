//! What files declare, in their order.

use super::definition::{DefId, Definition, DefinitionKind};
use crate::ast::{
    self, Configuration, File, Item, Name, Pou, PouKind, StatementKind, TypeDecl, TypeKind, TypeSpec, VarBlock,
    VarDecl, VarKind,
};
use crate::source::Span;

pub(super) fn definitions(files: &[File<'_>]) -> Vec<Definition> {
    let mut outline = Outline::default();
    files.iter().for_each(|it| outline.file(it));
    outline.found
}

#[derive(Default)]
struct Outline {
    found: Vec<Definition>,
}

impl Outline {
    fn add(&mut self, name: Name<'_>, kind: DefinitionKind, owner: Option<DefId>, extent: Span) -> DefId {
        let id = DefId(self.found.len());
        self.found.push(Definition { name: name.span, kind, owner, extent, bases: Vec::new(), ty: None, doc: None });
        id
    }

    fn set_doc(&mut self, id: DefId, doc: Option<&String>) {
        self.found[id.0].doc = doc.cloned();
    }

    fn file(&mut self, file: &File<'_>) {
        for item in &file.items {
            match item {
                Item::Pou(pou) => self.pou(pou, None),
                Item::Types(types) => types.iter().for_each(|it| self.type_decl(it)),
                Item::Globals(block) => self.block(block, None),
                Item::Configuration(it) => self.configuration(it),
                Item::Test(it) => self.pou(&it.pou, None),
            }
        }
    }

    fn pou(&mut self, pou: &Pou<'_>, owner: Option<DefId>) {
        let is_accessor = matches!(pou.kind, PouKind::Getter | PouKind::Setter);
        // A PROPERTY is declared once, whatever it has of GET and SET.
        let same = || self.found.iter().rposition(|it| it.name == pou.name.span && it.owner == owner).map(DefId);
        let known = if is_accessor { same() } else { None };
        let id = known.unwrap_or_else(|| self.add(pou.name, kind_of(pou.kind), owner, pou.extent));
        self.set_doc(id, pou.doc.as_ref());
        self.found[id.0].bases = pou.bases.iter().filter_map(|it| Some(it.last()?.span)).collect();
        if let Some(result) = &pou.result {
            self.found[id.0].ty = Some(result.span);
            self.spec(result, id);
        }
        // What is assigned to a PROPERTY is an input of its SET, by the PROPERTY's name.
        let is_own = |it: &&VarDecl<'_>| it.names.first().is_none_or(|it| it.span != pou.name.span);
        for block in &pou.blocks {
            block.vars.iter().filter(is_own).for_each(|it| self.variable(it, kind_in(block), Some(id)));
        }
        pou.routines.iter().for_each(|it| self.pou(it, Some(id)));
        ast::each_statement(&pou.body, &mut |it| {
            if let StatementKind::Label(name) = &it.kind {
                self.add(*name, DefinitionKind::Label, Some(id), it.span);
            }
        });
        for step in pou.chart.iter().flat_map(|it| &it.steps) {
            self.add(step.name, DefinitionKind::Step, Some(id), step.name.span);
        }
    }

    fn block(&mut self, block: &VarBlock<'_>, owner: Option<DefId>) {
        block.vars.iter().for_each(|it| self.variable(it, kind_in(block), owner));
    }

    fn variable(&mut self, declared: &VarDecl<'_>, kind: DefinitionKind, owner: Option<DefId>) {
        let mut first = None;
        for name in &declared.names {
            let id = self.add(*name, kind, owner, declared.span);
            self.found[id.0].ty = Some(declared.ty.span);
            self.set_doc(id, declared.doc.as_ref());
            first = first.or(Some(id));
        }
        if let Some(first) = first {
            self.spec(&declared.ty, first);
        }
    }

    fn type_decl(&mut self, declared: &TypeDecl<'_>) {
        let kind = match declared.ty.kind {
            TypeKind::Struct(_) => DefinitionKind::Structure,
            TypeKind::Union(_) => DefinitionKind::Union,
            TypeKind::Enum { .. } => DefinitionKind::Enumeration,
            _ => DefinitionKind::Type,
        };
        let id = self.add(declared.name, kind, None, declared.name.span.to(declared.ty.span));
        self.found[id.0].ty = Some(declared.ty.span);
        self.set_doc(id, declared.doc.as_ref());
        self.found[id.0].bases = declared.base.iter().filter_map(|it| Some(it.last()?.span)).collect();
        self.spec(&declared.ty, id);
    }

    /// What a type that is written where it is used declares.
    fn spec(&mut self, spec: &TypeSpec<'_>, owner: DefId) {
        match &spec.kind {
            TypeKind::Struct(members) | TypeKind::Union(members) => {
                members.iter().for_each(|it| self.variable(it, DefinitionKind::Member, Some(owner)));
            }
            TypeKind::Enum { values, .. } => {
                for value in values {
                    let id = self.add(value.name, DefinitionKind::Enumerator, Some(owner), value.name.span);
                    self.set_doc(id, value.doc.as_ref());
                }
            }
            TypeKind::Array { element, .. } => self.spec(element, owner),
            TypeKind::Reference { target, .. } => self.spec(target, owner),
            TypeKind::Named(_) | TypeKind::String { .. } | TypeKind::Subrange { .. } | TypeKind::Error => {}
        }
    }

    fn configuration(&mut self, it: &Configuration<'_>) {
        let id = self.add(it.name, DefinitionKind::Configuration, None, it.span);
        it.globals.iter().for_each(|it| self.block(it, Some(id)));
        for resource in &it.resources {
            let named = resource.name.map(|it| self.add(it, DefinitionKind::Resource, Some(id), it.span));
            let owner = named.unwrap_or(id);
            resource.globals.iter().for_each(|it| self.block(it, Some(owner)));
            for task in &resource.tasks {
                self.add(task.name, DefinitionKind::Task, Some(owner), task.name.span);
            }
            for instance in &resource.programs {
                self.add(instance.name, DefinitionKind::Instance, Some(owner), instance.name.span);
            }
        }
    }
}

/// What the variables of a block are.
const fn kind_in(block: &VarBlock<'_>) -> DefinitionKind {
    let is_constant = block.constant.is_some() && !matches!(block.kind, VarKind::Input | VarKind::InOut);
    if is_constant { DefinitionKind::Constant } else { DefinitionKind::Variable(block.kind) }
}

const fn kind_of(kind: PouKind) -> DefinitionKind {
    match kind {
        PouKind::Program => DefinitionKind::Program,
        PouKind::FunctionBlock => DefinitionKind::FunctionBlock,
        PouKind::Class => DefinitionKind::Class,
        PouKind::Interface => DefinitionKind::Interface,
        PouKind::Function => DefinitionKind::Function,
        PouKind::Test => DefinitionKind::Test,
        PouKind::Action => DefinitionKind::Action,
        PouKind::Method => DefinitionKind::Method,
        PouKind::Getter | PouKind::Setter => DefinitionKind::Property,
    }
}
