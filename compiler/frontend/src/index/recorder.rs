//! What is noted while a program is checked.

use super::definition::DefId;
use crate::source::Span;
use rustc_hash::FxHashMap;
use staunch_ir::{BlockId, Elementary, EnumId};
use std::cell::{Cell, RefCell};

/// What a name means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// What a source declares.
    Definition(DefId),
    /// A NAMESPACE, or a list of global variables, by its full name.
    Namespace(String),
    Elementary(Elementary),
    /// A standard block.
    Block(BlockId),
    /// The pin of a standard block at this position.
    Pin(BlockId, usize),
    /// A standard function.
    Function,
    /// An input or output of a standard function.
    Parameter,
    /// An instruction of Logix.
    Instruction,
    /// A word that stands for something where it is: `THIS`, `NULL`, a library's name.
    Word,
}

/// The same while declarations have no ids: by where their names are.
#[derive(Clone, Debug)]
pub(crate) enum Named {
    Declared(Span),
    Namespace(String),
    Elementary(Elementary),
    Block(BlockId),
    Pin(BlockId, usize),
    Function,
    Parameter,
    Instruction,
    Word,
}

impl Named {
    pub(super) fn meaning(self, known: impl Fn(Span) -> Option<DefId>) -> Option<Meaning> {
        Some(match self {
            Self::Declared(name) => Meaning::Definition(known(name)?),
            Self::Namespace(name) => Meaning::Namespace(name),
            Self::Elementary(it) => Meaning::Elementary(it),
            Self::Block(it) => Meaning::Block(it),
            Self::Pin(block, at) => Meaning::Pin(block, at),
            Self::Function => Meaning::Function,
            Self::Parameter => Meaning::Parameter,
            Self::Instruction => Meaning::Instruction,
            Self::Word => Meaning::Word,
        })
    }
}

/// A name that could be where it is asked.
#[derive(Clone, Debug)]
pub(crate) struct Offered {
    pub name: String,
    pub means: Named,
    /// It is of what its place asks for, and not just visible there.
    pub is_expected: bool,
}

/// Notes what names mean. What is looked at more than once has the last meaning: a call's arguments are tried for each of
/// several FUNCTIONs before one is chosen.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    /// Where a name is of which all is asked that it could be.
    asked: Option<(u16, u32)>,
    offered: RefCell<Vec<Offered>>,
    uses: RefCell<FxHashMap<Span, Named>>,
    /// Where enumerators are declared, by their names in capitals.
    enumerators: RefCell<FxHashMap<(EnumId, String), Span>>,
    /// What is checked is a copy: an inherited routine.
    is_muted: Cell<bool>,
}

impl Recorder {
    /// One that notes what a name at a place could be, too.
    pub fn asked(at: Option<(u16, u32)>) -> Self {
        Self { asked: at, ..Self::default() }
    }

    /// Whether it is asked what a name could be that is here.
    pub fn is_asked(&self, name: Span) -> bool {
        self.asked == Some((name.file, name.start))
    }

    pub fn offer(&self, it: Offered) {
        self.offered.borrow_mut().push(it);
    }

    pub fn mute(&self, is_muted: bool) {
        self.is_muted.set(is_muted);
    }

    pub fn note(&self, name: Span, target: Named) {
        if !self.is_muted.get() {
            self.uses.borrow_mut().insert(name, target);
        }
    }

    pub fn declare_enumerator(&self, owner: EnumId, name: &str, span: Span) {
        self.enumerators.borrow_mut().insert((owner, name.to_ascii_uppercase()), span);
    }

    /// Where an enumerator is declared.
    pub fn enumerator(&self, owner: EnumId, name: &str) -> Option<Span> {
        self.enumerators.borrow().get(&(owner, name.to_ascii_uppercase())).copied()
    }

    /// The names with what they mean, and what is offered.
    pub(super) fn settled(self) -> (FxHashMap<Span, Named>, Vec<Offered>) {
        (self.uses.into_inner(), self.offered.into_inner())
    }
}
