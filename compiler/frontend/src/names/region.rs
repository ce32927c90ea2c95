//! Regions: which namespace a place in a file is in, and what is used there.

use crate::source::Span;

/// A declared namespace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SpaceId(pub(super) usize);

impl SpaceId {
    pub const ROOT: Self = Self(0);
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RegionId(usize);

/// A stretch of a file: the file, a NAMESPACE, a list of global variables, or a POU that has a USING.
#[derive(Debug)]
pub(super) struct Region {
    pub space: SpaceId,
    pub outer: Option<RegionId>,
    /// What its USING directives name.
    pub uses: Vec<SpaceId>,
}

/// The regions of all files.
#[derive(Debug, Default)]
pub(super) struct Regions {
    all: Vec<Region>,
    /// For each file, where the innermost region changes, in order.
    files: Vec<Vec<(u32, RegionId)>>,
}

impl Regions {
    /// Adds those of the next file: each with its stretch and its namespace, outer ones and earlier ones
    /// first; the first is the file itself.
    pub fn add_file(&mut self, stretches: impl IntoIterator<Item = (Span, SpaceId)>) -> Vec<RegionId> {
        let mut changes: Vec<(u32, RegionId)> = Vec::new();
        let mut open: Vec<(u32, RegionId)> = Vec::new();
        let mut ids = Vec::new();
        for (span, space) in stretches {
            while open.len() > 1 && open.last().is_some_and(|it| it.0 <= span.start) {
                end_innermost(&mut open, &mut changes);
            }
            let id = RegionId(self.all.len());
            self.all.push(Region { space, outer: open.last().map(|it| it.1), uses: Vec::new() });
            changes.push((span.start, id));
            open.push((span.end, id));
            ids.push(id);
        }
        while open.len() > 1 {
            end_innermost(&mut open, &mut changes);
        }
        self.files.push(changes);
        ids
    }

    pub fn count_files(&self) -> usize {
        self.files.len()
    }

    /// All of a file is read as if it were at a place of another one.
    pub fn read_as_at(&mut self, file: u16, place: Span) {
        if let (Some(region), Some(changes)) = (self.at(place), self.files.get_mut(usize::from(file))) {
            *changes = vec![(0, region)];
        }
    }

    pub fn use_in(&mut self, region: RegionId, space: SpaceId) {
        let uses = &mut self.all[region.0].uses;
        if !uses.contains(&space) {
            uses.push(space);
        }
    }

    /// The innermost region at a place.
    pub fn at(&self, place: Span) -> Option<RegionId> {
        let changes = self.files.get(usize::from(place.file))?;
        let after = changes.partition_point(|it| it.0 <= place.start);
        Some(changes.get(after.saturating_sub(1))?.1)
    }

    /// The regions around a place, the innermost first.
    pub fn around(&self, place: Span) -> impl Iterator<Item = &Region> {
        let first = self.at(place).map(|it| &self.all[it.0]);
        std::iter::successors(first, |it| it.outer.map(|it| &self.all[it.0]))
    }
}

fn end_innermost(open: &mut Vec<(u32, RegionId)>, changes: &mut Vec<(u32, RegionId)>) {
    let Some((end, _)) = open.pop() else { return };
    changes.extend(open.last().map(|(_, outer)| (end, *outer)));
}
