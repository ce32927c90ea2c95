//! What is noted while a program is checked.

use super::asked::{Asked, Stop};
use super::definition::DefId;
use crate::source::Span;
use rustc_hash::FxHashMap;
use staunch_ir::{BlockId, Elementary, EnumId};
use std::cell::{Cell, RefCell};

/// What a name means; `D` stands for what a source declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meaning<D = DefId> {
    /// What a source declares.
    Definition(D),
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

/// A meaning while declarations have no ids: a declaration is known by where its name is.
pub(crate) type Named = Meaning<Span>;

impl Named {
    /// With the id of the declaration, if there is one.
    pub(super) fn meaning(self, known: impl Fn(Span) -> Option<DefId>) -> Option<Meaning> {
        Some(match self {
            Self::Definition(name) => Meaning::Definition(known(name)?),
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

/// All that was noted.
pub(super) struct Settled {
    /// The names with what they mean.
    pub uses: FxHashMap<Span, Named>,
    pub offered: Vec<Offered>,
    /// The names of VAR_EXTERNALs, and where their global variables are declared.
    pub externals: Vec<(Span, Span)>,
}

/// Notes what names mean. The last note of a name counts: a call's arguments are tried for each of
/// several FUNCTIONs before one is chosen.
#[derive(Debug, Default)]
pub(crate) struct Recorder {
    pub asked: Asked,
    /// The place around which alone bodies are checked.
    pub around: Option<(u16, u32)>,
    pub stop: Stop,
    offered: RefCell<Vec<Offered>>,
    uses: RefCell<FxHashMap<Span, Named>>,
    /// The names of VAR_EXTERNALs, and where their global variables are declared.
    externals: RefCell<Vec<(Span, Span)>>,
    /// Where enumerators are declared, by their names in capitals.
    enumerators: RefCell<FxHashMap<(EnumId, String), Span>>,
    /// What is checked is a copy: an inherited routine.
    is_muted: Cell<bool>,
}

impl Recorder {
    pub fn new(asked: Asked, stop: Stop) -> Self {
        Self { asked, stop, ..Self::default() }
    }

    /// Whether completion is asked for at this name.
    pub fn is_asked(&self, name: Span) -> bool {
        match self.asked {
            Asked::All | Asked::Around(..) => false,
            Asked::Names(file, at, length) => file == name.file && (at..at + length).contains(&name.start),
        }
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

    pub fn note_external(&self, name: Span, global: Span) {
        self.externals.borrow_mut().push((name, global));
    }

    pub fn declare_enumerator(&self, owner: EnumId, name: &str, span: Span) {
        self.enumerators.borrow_mut().insert((owner, name.to_ascii_uppercase()), span);
    }

    /// Where an enumerator is declared.
    pub fn enumerator(&self, owner: EnumId, name: &str) -> Option<Span> {
        self.enumerators.borrow().get(&(owner, name.to_ascii_uppercase())).copied()
    }

    pub(super) fn settled(self) -> Settled {
        Settled {
            uses: self.uses.into_inner(),
            offered: self.offered.into_inner(),
            externals: self.externals.into_inner(),
        }
    }
}
