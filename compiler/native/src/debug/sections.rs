//! The sections of an object that debug information is in, with the addresses and offsets that a linker completes.

use crate::Error;
use cranelift_object::object::write::{Object, Relocation, SectionId, SymbolId};
use cranelift_object::object::{RelocationEncoding, RelocationFlags, RelocationKind, SectionKind};
use gimli::write::{EndianVec, RelocateWriter, RelocationTarget, Sections, Writer};
use gimli::{LittleEndian, SectionId as Name};
use rustc_hash::FxHashMap;

/// A section that is being written.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    bytes: EndianVec<LittleEndian>,
    relocations: Vec<gimli::write::Relocation>,
}

impl Section {
    pub(crate) fn new() -> Self {
        Self { bytes: EndianVec::new(LittleEndian), relocations: Vec::new() }
    }
}

impl RelocateWriter for Section {
    type Writer = EndianVec<LittleEndian>;

    fn writer(&self) -> &Self::Writer {
        &self.bytes
    }

    fn writer_mut(&mut self) -> &mut Self::Writer {
        &mut self.bytes
    }

    fn relocate(&mut self, relocation: gimli::write::Relocation) {
        self.relocations.push(relocation);
    }
}

/// Puts all sections into an object, in which a number of a symbol is a position in `symbols`.
pub(crate) fn put(object: &mut Object<'_>, sections: &Sections<Section>, symbols: &[SymbolId]) -> Result<(), Error> {
    let mut ids: FxHashMap<Name, SectionId> = FxHashMap::default();
    sections.for_each(|name, section| -> Result<(), Error> {
        if section.bytes.len() > 0 {
            let id = object.add_section(Vec::new(), name.name().as_bytes().to_vec(), SectionKind::Debug);
            object.append_section_data(id, section.bytes.slice(), 1);
            ids.insert(name, id);
        }
        Ok(())
    })?;
    sections.for_each(|name, section| {
        let Some(id) = ids.get(&name) else { return Ok(()) };
        section.relocations.iter().try_for_each(|it| relocate(object, *id, it, &ids, symbols))
    })
}

fn relocate(
    object: &mut Object<'_>,
    section: SectionId,
    it: &gimli::write::Relocation,
    ids: &FxHashMap<Name, SectionId>,
    symbols: &[SymbolId],
) -> Result<(), Error> {
    let symbol = match it.target {
        RelocationTarget::Symbol(at) => symbols[at],
        RelocationTarget::Section(name) => object.section_symbol(ids[&name]),
    };
    let flags = RelocationFlags::Generic {
        kind: RelocationKind::Absolute,
        encoding: RelocationEncoding::Generic,
        size: it.size * 8,
    };
    let offset = u64::try_from(it.offset).expect("a usize fits a u64");
    let relocation = Relocation { offset, symbol, addend: it.addend, flags };
    object.add_relocation(section, relocation).map_err(|error| Error::Output(error.to_string()))
}
