//! A declaration, as an editor shows it.

use crate::ast::VarKind;
use crate::source::Span;

/// One declaration of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct DefId(pub(super) usize);

#[derive(Clone, Debug)]
pub struct Definition {
    /// Where its name is.
    pub name: Span,
    pub kind: DefinitionKind,
    /// What it is a part of: the POU of a variable, the structure of a member.
    pub owner: Option<DefId>,
    /// From its first word to its last.
    pub extent: Span,
    /// What a class EXTENDS and IMPLEMENTS: the last name of each.
    pub bases: Vec<Span>,
    /// Where its type is written: of a variable, a member, or the result of a FUNCTION.
    pub ty: Option<Span>,
    /// The comment at its declaration.
    pub doc: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DefinitionKind {
    Program,
    FunctionBlock,
    Class,
    Interface,
    Function,
    Method,
    Property,
    Action,
    Test,
    /// A TYPE that is neither a structure nor an enumeration.
    Type,
    Structure,
    Union,
    Enumeration,
    Enumerator,
    Member,
    Variable(VarKind),
    Constant,
    Label,
    Step,
    Configuration,
    Resource,
    Task,
    /// A PROGRAM as a CONFIGURATION runs it.
    Instance,
}

impl DefinitionKind {
    /// Whether its declaration and its body say what the names in it mean.
    pub(super) fn is_whole_for_its_names(self) -> bool {
        match self {
            Self::Program
            | Self::FunctionBlock
            | Self::Class
            | Self::Interface
            | Self::Function
            | Self::Method
            | Self::Property
            | Self::Action
            | Self::Test
            | Self::Type
            | Self::Structure
            | Self::Union
            | Self::Enumeration => true,
            Self::Variable(_)
            | Self::Constant
            | Self::Member
            | Self::Enumerator
            | Self::Label
            | Self::Step
            | Self::Configuration
            | Self::Resource
            | Self::Task
            | Self::Instance => false,
        }
    }

    /// What it is called in Structured Text.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Program => "PROGRAM",
            Self::FunctionBlock => "FUNCTION_BLOCK",
            Self::Class => "CLASS",
            Self::Interface => "INTERFACE",
            Self::Function => "FUNCTION",
            Self::Method => "METHOD",
            Self::Property => "PROPERTY",
            Self::Action => "ACTION",
            Self::Test => "TEST",
            Self::Type => "TYPE",
            Self::Structure => "STRUCT",
            Self::Union => "UNION",
            Self::Enumeration => "enumeration",
            Self::Enumerator => "enumerator",
            Self::Member => "member",
            Self::Variable(VarKind::Var) => "VAR",
            Self::Variable(VarKind::Input) => "VAR_INPUT",
            Self::Variable(VarKind::Output) => "VAR_OUTPUT",
            Self::Variable(VarKind::InOut) => "VAR_IN_OUT",
            Self::Variable(VarKind::Temp) => "VAR_TEMP",
            Self::Variable(VarKind::Stat) => "VAR_STAT",
            Self::Variable(VarKind::Inst) => "VAR_INST",
            Self::Variable(VarKind::Global) => "VAR_GLOBAL",
            Self::Variable(VarKind::External) => "VAR_EXTERNAL",
            Self::Constant => "CONSTANT",
            Self::Label => "label",
            Self::Step => "STEP",
            Self::Configuration => "CONFIGURATION",
            Self::Resource => "RESOURCE",
            Self::Task => "TASK",
            Self::Instance => "PROGRAM of a CONFIGURATION",
        }
    }
}
