//! The entries of debug information as they are made.

use gimli::constants::{DW_AT_name, DW_AT_type, DwAt, DwTag};
use gimli::write::{Address, AttributeValue, DwarfUnit, Range, UnitEntryId};
use gimli::{Encoding, Format};
use rustc_hash::FxHashMap;
use staunch_ir::layout::Layout;
use staunch_ir::{Program, Type};

/// What debuggers of the last ten years read.
const ENCODING: Encoding = Encoding { format: Format::Dwarf32, version: 4, address_size: 8 };

pub(crate) struct Entries<'a> {
    pub(crate) program: &'a Program,
    pub(crate) layout: &'a Layout,
    pub(crate) dwarf: DwarfUnit,
    /// The entries of types.
    pub(crate) types: FxHashMap<Type, UnitEntryId>,
    /// Those of pointers, by what they lead to.
    pub(crate) pointers: FxHashMap<Type, UnitEntryId>,
    /// What variables of INTERFACEs are shown as.
    pub(crate) leads: FxHashMap<Type, UnitEntryId>,
    /// The word that leads to the state.
    pub(crate) state: Address,
    /// The code that is described.
    pub(crate) ranges: Vec<Range>,
}

impl<'a> Entries<'a> {
    pub(crate) fn new(program: &'a Program, layout: &'a Layout, state: Address) -> Self {
        Self {
            program,
            layout,
            dwarf: DwarfUnit::new(ENCODING),
            types: FxHashMap::default(),
            pointers: FxHashMap::default(),
            leads: FxHashMap::default(),
            state,
            ranges: Vec::new(),
        }
    }

    pub(crate) fn encoding() -> Encoding {
        ENCODING
    }

    pub(crate) fn root(&self) -> UnitEntryId {
        self.dwarf.unit.root()
    }

    pub(crate) fn add(&mut self, parent: UnitEntryId, tag: DwTag) -> UnitEntryId {
        self.dwarf.unit.add(parent, tag)
    }

    pub(crate) fn add_named(&mut self, parent: UnitEntryId, tag: DwTag, name: &str) -> UnitEntryId {
        let id = self.add(parent, tag);
        self.name(id, name);
        id
    }

    pub(crate) fn name(&mut self, id: UnitEntryId, name: &str) {
        let name = self.dwarf.strings.add(name.replace('\0', "?"));
        self.set(id, DW_AT_name, AttributeValue::StringRef(name));
    }

    pub(crate) fn set(&mut self, id: UnitEntryId, attribute: DwAt, value: AttributeValue) {
        self.dwarf.unit.get_mut(id).set(attribute, value);
    }

    pub(crate) fn set_type(&mut self, id: UnitEntryId, ty: UnitEntryId) {
        self.set(id, DW_AT_type, AttributeValue::UnitRef(ty));
    }
}

/// Whether a name is the user's: those that the compiler makes up cannot be declared.
pub(crate) fn is_declared(name: &str) -> bool {
    !name.starts_with("__") && !name.is_empty() && name.chars().all(|it| it.is_alphanumeric() || it == '_')
}
