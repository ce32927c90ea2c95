//! What each name in the sources means, for an editor: filled while a program is checked, by what decides there what a
//! name means, and only where it is asked for.

mod asked;
pub(crate) mod definition;
mod outline;
pub(crate) mod recorder;

pub use asked::{Asked, Stop};
pub use definition::{DefId, Definition, DefinitionKind};
pub use recorder::Meaning;

use crate::source::{Sources, Span};
use crate::{Diagnostic, ast};
use recorder::{Named, Offered, Recorder, Settled};
use rustc_hash::FxHashMap;

/// What the names of a program mean, for an editor. Sources with mistakes have an index, too: a name that could not be
/// resolved has no entry.
#[derive(Debug, Default)]
pub struct Index {
    pub definitions: Vec<Definition>,
    /// In the order of their places; none overlap.
    pub uses: Vec<Use>,
    /// What the name could be that is at the place that was asked about, each once.
    pub offers: Vec<Offer>,
    /// In the order of files and lines.
    pub diagnostics: Vec<Diagnostic>,
    /// The definitions by the places of their names.
    places: Vec<DefId>,
    /// Each declaration after what holds it, in the order of these.
    parts: Vec<(DefId, DefId)>,
    /// For each VAR_EXTERNAL, the global variable.
    globals: FxHashMap<DefId, DefId>,
    pub(crate) asked: Asked,
    pub(crate) stop: Stop,
}

/// A name where it is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Use {
    pub span: Span,
    pub meaning: Meaning,
}

/// A name that could be written at a place, and what it means there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    pub name: String,
    pub meaning: Meaning,
    /// It is of what its place asks for, and not just visible there.
    pub is_expected: bool,
}

/// A name without its quotes, as S7 writes them.
fn bare(text: &str) -> &str {
    text.strip_prefix(['"', '#']).unwrap_or(text).trim_end_matches('"')
}

/// Whether a part of a text is a name.
fn is_name(text: &str) -> bool {
    let begins = |it: char| it.is_alphabetic() || it == '_';
    text != bare(text) || text.starts_with(begins) && text.chars().all(|it| begins(it) || it.is_numeric())
}

impl Index {
    pub(crate) fn asked(asked: Asked, stop: Stop) -> Self {
        Self { asked, stop, ..Self::default() }
    }

    /// The place around which names are asked for, where that is in a POU or a type. Elsewhere, as in a CONFIGURATION, the
    /// whole program is checked.
    pub(crate) fn around(&self) -> Option<(u16, u32)> {
        let (file, at) = self.asked.place()?;
        let holds = |it: &&Definition| it.extent.file == file && it.extent.start <= at && at <= it.extent.end;
        self.definitions.iter().filter(holds).any(|it| it.kind.is_whole_for_its_names()).then_some((file, at))
    }

    /// Reads what the files declare.
    pub(crate) fn declare(&mut self, files: &[ast::File<'_>]) {
        self.definitions = outline::definitions(files);
        self.places = (0..self.definitions.len()).map(DefId).collect();
        self.places.sort_by_key(|it| (self.definitions[it.0].name.file, self.definitions[it.0].name.start));
        self.parts = self.ids().filter_map(|(id, it)| Some((it.owner?, id))).collect();
        self.parts.sort_unstable();
    }

    /// Adds what checking has found out.
    pub(crate) fn add(&mut self, recorder: Recorder, sources: &Sources) {
        let known: FxHashMap<Span, DefId> = self.ids().map(|(id, it)| (it.name, id)).collect();
        let mut uses: FxHashMap<Span, Meaning> = self.uses.drain(..).map(|it| (it.span, it.meaning)).collect();
        let Settled { uses: found, offered, externals } = recorder.settled();
        self.globals.extend(
            externals.iter().filter_map(|(own, global)| known.get(own).copied().zip(known.get(global).copied())),
        );
        uses.reserve(found.len());
        for (span, target) in found {
            // What the compiler writes out has the place of what it stands for. The library's names may be other ones.
            let text = sources.text(span);
            let is_written = match &target {
                _ if text.is_empty() => false,
                Named::Definition(it) => {
                    sources.get(it.file).is_bundled() || bare(text).eq_ignore_ascii_case(bare(sources.text(*it)))
                }
                _ => is_name(text),
            };
            if !known.contains_key(&span)
                && is_written
                && let Some(meaning) = target.meaning(|declared| known.get(&declared).copied())
            {
                uses.insert(span, meaning);
            }
        }
        let offered_before = self.offers.iter().enumerate().map(|(at, it)| (it.name.to_ascii_uppercase(), at));
        let mut places: FxHashMap<String, usize> = offered_before.collect();
        for Offered { name, means, is_expected } in offered {
            let Some(meaning) = means.meaning(|declared| known.get(&declared).copied()) else { continue };
            let place = *places.entry(name.to_ascii_uppercase()).or_insert(self.offers.len());
            match self.offers.get_mut(place) {
                Some(it) => it.is_expected |= is_expected,
                None => self.offers.push(Offer { name, meaning, is_expected }),
            }
        }
        self.offers.sort_by_key(|it| !it.is_expected);
        self.uses = uses.into_iter().map(|(span, meaning)| Use { span, meaning }).collect();
        self.uses.sort_unstable_by_key(|it| (it.span.file, it.span.start, it.span.end));
    }

    pub fn get(&self, id: DefId) -> &Definition {
        &self.definitions[id.0]
    }

    pub fn ids(&self) -> impl Iterator<Item = (DefId, &Definition)> {
        self.definitions.iter().enumerate().map(|(at, it)| (DefId(at), it))
    }

    /// What the name at a place means, and the name's extent: a declaration's own name means that.
    pub fn at(&self, file: u16, offset: u32) -> Option<(Span, Meaning)> {
        let holds = |it: Span| it.file == file && it.start <= offset && offset <= it.end;
        let after = self.uses.partition_point(|it| (it.span.file, it.span.start) <= (file, offset));
        let used = self.uses[..after].last().filter(|it| holds(it.span)).map(|it| (it.span, it.meaning.clone()));
        let start = |it: &DefId| (self.get(*it).name.file, self.get(*it).name.start);
        let after = self.places.partition_point(|it| start(it) <= (file, offset));
        // A name that is empty may be where another one begins.
        let declared = self.places[..after].iter().rev().take(2).find(|it| holds(self.get(**it).name));
        used.or_else(|| declared.map(|it| (self.get(*it).name, Meaning::Definition(*it))))
    }

    /// The declarations of one variable: a global one, and then each VAR_EXTERNAL of it.
    pub fn declarations_of(&self, id: DefId) -> Vec<DefId> {
        let global = self.globals.get(&id).copied().unwrap_or(id);
        let mut all: Vec<_> = self.globals.iter().filter(|it| *it.1 == global).map(|it| *it.0).collect();
        all.sort_unstable();
        all.insert(0, global);
        all
    }

    /// The names that are used in a part of a text, in their order.
    pub fn uses_in(&self, span: Span) -> &[Use] {
        let before = |offset: u32| self.uses.partition_point(|it| (it.span.file, it.span.start) < (span.file, offset));
        &self.uses[before(span.start)..before(span.end)]
    }

    /// Where a declaration's name is used.
    pub fn uses_of(&self, id: DefId) -> impl Iterator<Item = Span> {
        self.uses.iter().filter(move |it| it.meaning == Meaning::Definition(id)).map(|it| it.span)
    }

    /// What a declaration holds: the variables of a POU, the members of a structure.
    pub fn parts_of(&self, id: DefId) -> impl Iterator<Item = (DefId, &Definition)> {
        let from = self.parts.partition_point(|it| it.0 < id);
        let own = self.parts[from..].iter().take_while(move |it| it.0 == id);
        own.map(|it| (it.1, self.get(it.1)))
    }
}
