//! The map: the place of each variable, as text that a host, a trace or a debugger reads.
//!
//! One record a line, fields separated by tabs, `-` for an absent one. Types are structural (an
//! array names its element's type), so the map grows with declarations, not with elements.

use crate::layout::Layout;
use crate::loops::constant_position;
use crate::startup::{self, Event, Fate, Startup};
use crate::usage::used_globals;
use crate::{
    Address, BlockId, Bound, Class, ClassKind, FieldId, Place, Program, Projection, Root, Section, StructId, Type,
    Variable, View, reference,
};
use core::fmt::{self, Write};
use staunch_runtime::{Direction, Pin};
use std::collections::BTreeSet;

/// The map's version, in its first line.
pub const VERSION: u32 = 1;

/// The map of a verified program. Its records, in order:
///
/// ```text
/// map        1
/// compiler   version
/// machine    size  align
/// file       number  path
/// times      least  greatest          TIMEs in milliseconds, where they are whole ones
/// enum       id  name  repr's Rust name  NAME=value …
/// array      id  low  high  element type  stride
/// struct     id  name  size            then its fields
/// block      id  name  size            then its pins, as fields; only blocks in use
/// field      name  type  offset  section  flags  address  low..high
/// path       field of the globals  its name in full, of one in a NAMESPACE or a list
/// bound      type  offset in the machine  address of the input that it is copied from before each scan
/// remote     name  address and port  unit  period in ns  timeout in ns  on-loss  word-order, or -; for a serial port, which is
///            in the place of the address, then baud rate  parity  stop bits; then its registers
/// register   variable  place at the server, `input-register 3`
/// gpio       variable  chip  number or name  that of the line  low or high: the level of TRUE  bias  debounce in us, or 0  TRUE, FALSE or -: safe
/// safe       variable  its value before the first scan and at the end of a run
/// object     offset in the machine  size
/// globals    struct:id  offset
/// instance   number  name  program  struct:id  offset  interval in ns  priority
/// variable   instance  name  section  type  offset in the machine  flags  address  low..high
/// ```
///
/// The flags are `retain`, `whole`, `stays`, `restarts`, `constant`, and `used`, of a global that some instance uses.
/// A text in what is a `view` has no length: it is its characters up to a zero.
/// An object is what references may name, by its number, from 1. A type is an IEC name, `STRING[n]`,
/// `REFERENCE`, or `enum:id`, `array:id`, `struct:id`, `block:id`. A
/// variable that lives for one call has no record.
pub fn map_text(program: &Program, layout: &Layout) -> String {
    write_map(program, layout, Blocks::OfState)
}

/// The same, with the standard blocks that live for one call: what a debugger reads.
pub fn map_text_with_locals(program: &Program, layout: &Layout) -> String {
    write_map(program, layout, Blocks::All)
}

fn write_map(program: &Program, layout: &Layout, blocks: Blocks) -> String {
    let (used, startup) = (used_globals(program), Startup::new(program));
    let mut map = Map { program, layout, used, startup, blocks, text: String::new() };
    map.write().expect("writing to a String does not fail");
    map.text
}

struct Map<'a> {
    program: &'a Program,
    layout: &'a Layout,
    used: BTreeSet<FieldId>,
    startup: Startup<'a>,
    blocks: Blocks,
    text: String,
}

/// Which standard blocks the map describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Blocks {
    OfState,
    /// Also those of local variables.
    All,
}

/// What a `field` or `variable` line says after its place.
struct Attributes {
    retain: bool,
    /// Kept with all that is inside.
    whole: bool,
    /// Kept so over IDLE -> RUN.
    stays: bool,
    /// Starts anew, although what it is a part of is retained.
    restarts: bool,
    constant: bool,
    /// Of a global: some instance uses it.
    used: bool,
    /// Some bits of another variable.
    view: bool,
    address: Option<Address>,
    range: Option<(i128, i128)>,
}

impl Map<'_> {
    fn write(&mut self) -> fmt::Result {
        let machine = &self.layout.machine;
        writeln!(self.text, "map\t{VERSION}")?;
        writeln!(self.text, "compiler\t{}", env!("CARGO_PKG_VERSION"))?;
        writeln!(self.text, "machine\t{}\t{}", machine.size, machine.align)?;
        for (number, file) in self.program.files.iter().enumerate() {
            writeln!(self.text, "file\t{number}\t{}", one_line(&file.path))?;
        }
        if let Some((least, greatest)) = self.program.milliseconds {
            writeln!(self.text, "times\t{least}\t{greatest}")?;
        }
        self.enums()?;
        self.arrays()?;
        self.structs()?;
        self.blocks()?;
        for it in reference::objects(self.program, self.layout) {
            writeln!(self.text, "object\t{}\t{}", it.offset, it.size)?;
        }
        writeln!(self.text, "globals\tstruct:{}\t{}", self.program.globals.0, machine.globals)?;
        self.bound()?;
        self.instances()?;
        self.program.remotes.iter().try_for_each(|it| writeln!(self.text, "{it}"))
    }

    /// What a VAR_CONFIG binds to inputs.
    fn bound(&mut self) -> fmt::Result {
        // Several calls of a PROGRAM copy the same.
        let mut lines = BTreeSet::new();
        for Bound { state, variable, address } in &self.program.bound {
            let bases: Vec<u64> = match state {
                Some(state) => {
                    let all = self.program.instances.iter().zip(&self.layout.machine.instances);
                    all.filter(|it| self.program.class(it.0.program).state == *state).map(|it| *it.1).collect()
                }
                None => vec![0],
            };
            let offsets = bases.into_iter().filter_map(|it| Some(self.storage(*state, variable, None, it)?.0));
            lines.extend(offsets.map(|it| (it, format!("bound\t{}\t{it}\t{address}", TypeName(variable.ty)))));
        }
        lines.into_iter().try_for_each(|it| writeln!(self.text, "{}", it.1))
    }

    fn enums(&mut self) -> fmt::Result {
        for (id, enumeration) in self.program.enums.iter().enumerate() {
            let repr = enumeration.base.repr().rust_name();
            write!(self.text, "enum\t{id}\t{}\t{repr}", enumeration.name)?;
            for value in &enumeration.values {
                let number = value.value.as_integer().expect("verified IR: integer enumerators");
                write!(self.text, "\t{}={number}", value.name)?;
            }
            self.text.push('\n');
        }
        Ok(())
    }

    fn arrays(&mut self) -> fmt::Result {
        for (id, array) in self.program.arrays.iter().enumerate() {
            let (low, high, stride) = (array.low, array.high, self.layout.size(array.element));
            writeln!(self.text, "array\t{id}\t{low}\t{high}\t{}\t{stride}", TypeName(array.element))?;
        }
        Ok(())
    }

    fn structs(&mut self) -> fmt::Result {
        for (id, structure) in self.program.structs.iter().enumerate() {
            let ty = Type::Struct(StructId::next(id));
            let (name, size, kind) = (&structure.name, self.layout.size(ty), self.kind(StructId::next(id)));
            writeln!(self.text, "struct\t{id}\t{name}\t{size}\t{kind}")?;
            for position in 0..structure.fields.len() {
                let offset = self.layout.offset(ty, FieldId::next(position));
                let used = id == self.program.globals.index() && self.used.contains(&FieldId::next(position));
                self.field(StructId::next(id), FieldId::next(position), offset, used)?;
                self.overlays(StructId::next(id), FieldId::next(position))?;
            }
            if id == self.program.globals.index() {
                self.aliases()?;
            }
        }
        Ok(())
    }

    /// The members that are bits of fields. Texts in them have no length: they are their characters and a zero.
    fn overlays(&mut self, id: StructId, field: FieldId) -> fmt::Result {
        for overlay in self.program.structure(id).overlays.iter().filter(|it| it.field == field) {
            let offset = self.layout.field(id, overlay.field) + overlay.bit / 8;
            let ty = match overlay.is_bit {
                true => format!("bit:{}", overlay.bit % 8),
                false => TypeName(overlay.ty).to_string(),
            };
            write!(self.text, "field\t{}\t{ty}\t{offset}\tvar", overlay.name)?;
            self.write_attributes(&Attributes { view: true, ..Attributes::NONE })?;
        }
        Ok(())
    }

    /// A field of the globals under its other names.
    fn aliases(&mut self) -> fmt::Result {
        for alias in &self.program.aliases {
            let Some((offset, mut attributes)) = self.storage(None, &alias.place, alias.view, 0) else { continue };
            attributes.used = self.is_used(alias);
            let offset = offset - self.layout.machine.globals;
            let (section, ty) = (section_name(alias.section), type_of(alias));
            write!(self.text, "field\t{}\t{ty}\t{offset}\t{section}", alias.name)?;
            self.write_attributes(&attributes)?;
        }
        for (name, path) in &self.program.global_paths {
            writeln!(self.text, "path\t{name}\t{path}")?;
        }
        Ok(())
    }

    fn is_used(&self, alias: &Variable) -> bool {
        matches!(alias.place.projections.first(), Some(Projection::Field(id)) if self.used.contains(id))
    }

    /// A structure's members are all for users; an instance's inputs and outputs are.
    fn kind(&self, id: StructId) -> &'static str {
        match self.program.class_of_state(id).map(|it| it.kind) {
            Some(ClassKind::Program) => "program",
            Some(ClassKind::FunctionBlock) => "function_block",
            None if id == self.program.globals => "globals",
            None => "structure",
        }
    }

    fn field(&mut self, owner: StructId, id: FieldId, offset: u64, used: bool) -> fmt::Result {
        let field = &self.program.structure(owner).fields[id.index()];
        // Of the globals, what nobody has declared keeps the bits of addresses that overlap.
        let is_keeper = owner == self.program.globals && field.section == Section::Internal;
        let is_storage = is_keeper || self.program.structure(owner).is_storage(id);
        let section = if is_storage { "memory" } else { section_name(field.section) };
        write!(self.text, "field\t{}\t{}\t{offset}\t{section}", field.name, TypeName(field.ty))?;
        self.write_attributes(&Attributes { used, ..self.attributes_of(owner, id) })
    }

    /// The standard blocks that the program's types mention.
    fn blocks(&mut self) -> fmt::Result {
        let fields = self.program.structs.iter().flat_map(|structure| &structure.fields).map(|field| field.ty);
        let elements = self.program.arrays.iter().map(|array| array.element);
        let locals = self.program.routines.iter().flat_map(|it| &it.locals).map(|it| it.ty);
        let locals = locals.filter(|_| self.blocks == Blocks::All);
        let used: BTreeSet<BlockId> = fields.chain(elements).chain(locals).filter_map(block_of).collect();
        used.into_iter().try_for_each(|id| self.block(id))
    }

    fn block(&mut self, id: BlockId) -> fmt::Result {
        let info = id.info();
        writeln!(self.text, "block\t{}\t{}\t{}", id.0, info.name, info.size)?;
        for (position, pin) in info.pins.iter().enumerate() {
            let ty = id.pin_type(FieldId::next(position)).expect("position of a pin");
            let Pin { name, offset, .. } = pin;
            write!(self.text, "field\t{name}\t{}\t{offset}\t{}", TypeName(ty), direction_name(pin.direction))?;
            self.write_attributes(&Attributes { restarts: startup::pin(info, pin) == Fate::Anew, ..Attributes::NONE })?;
        }
        Ok(())
    }

    fn instances(&mut self) -> fmt::Result {
        let offsets = self.layout.machine.instances.iter();
        for (number, (instance, offset)) in self.program.instances.iter().zip(offsets).enumerate() {
            let class = self.program.class(instance.program);
            let state = class.state.0;
            write!(self.text, "instance\t{number}\t{}\t{}\tstruct:{state}\t{offset}\t", instance.name, class.name)?;
            match instance.interval {
                Some(nanoseconds) => write!(self.text, "{nanoseconds}")?,
                None => self.text.push('-'),
            }
            writeln!(self.text, "\t{}", instance.priority)?;
            self.variables(number, class, *offset)?;
        }
        Ok(())
    }

    fn variables(&mut self, instance: usize, class: &Class, base: u64) -> fmt::Result {
        for variable in &class.variables {
            let Some((offset, attributes)) = self.storage(Some(class.state), &variable.place, variable.view, base)
            else {
                continue;
            };
            let section = section_name(variable.section);
            let ty = type_of(variable);
            write!(self.text, "variable\t{instance}\t{}\t{section}\t{ty}\t{offset}", variable.name)?;
            self.write_attributes(&attributes)?;
        }
        Ok(())
    }

    /// Where a variable is in the machine, and the attributes of the field it is; `None` for
    /// one that lives for a call.
    fn storage(
        &self,
        state: Option<StructId>,
        place: &Place,
        view: Option<View>,
        base: u64,
    ) -> Option<(u64, Attributes)> {
        let (mut offset, structure) = match place.root {
            Root::Instance => (base, state?),
            Root::Globals => (self.layout.machine.globals, self.program.globals),
            Root::Local(_) | Root::Param(_) => return None,
        };
        let mut ty = Type::Struct(structure);
        let mut attributes = Attributes::NONE;
        for projection in &place.projections {
            match (projection, ty) {
                (Projection::Field(id), _) => {
                    offset += self.layout.offset(ty, *id);
                    (ty, attributes) = self.member(ty, *id)?;
                }
                (Projection::Index { index, .. }, Type::Array(id)) => {
                    let element = self.program.array(id).element;
                    offset += constant_position(self.program, index, id)? * self.layout.size(element);
                    ty = element;
                }
                (Projection::Index { .. }, _) => unreachable!("verified IR: an array is indexed"),
                (Projection::Deref { .. }, _) => {
                    unreachable!("verified IR: a variable is not reached through a reference")
                }
            }
        }
        match view {
            Some(View { bit, address, .. }) => {
                Some((offset + bit / 8, Attributes { view: true, address: Some(address), ..Attributes::NONE }))
            }
            None => Some((offset, attributes)),
        }
    }

    fn member(&self, ty: Type, id: FieldId) -> Option<(Type, Attributes)> {
        match ty {
            Type::Struct(structure) => {
                let field = &self.program.structure(structure).fields[id.index()];
                Some((field.ty, self.attributes_of(structure, id)))
            }
            Type::Block(block) => Some((block.pin_type(id)?, Attributes::NONE)),
            Type::Elementary(_)
            | Type::Reference(_)
            | Type::Subrange(..)
            | Type::String(_)
            | Type::Enum(_)
            | Type::Array(_) => None,
        }
    }

    fn attributes_of(&self, owner: StructId, id: FieldId) -> Attributes {
        let field = &self.program.structure(owner).fields[id.index()];
        let fate = |event| self.startup.field(owner, id, event);
        let (power_cycle, run) = (fate(Event::PowerCycle), fate(Event::Run));
        let mut ty = field.ty;
        while let Type::Array(id) = ty {
            ty = self.program.array(id).element;
        }
        Attributes {
            retain: power_cycle.is_kept(),
            whole: power_cycle == Fate::Whole,
            stays: run == Fate::Whole && power_cycle != Fate::Whole,
            restarts: power_cycle == Fate::Anew,
            constant: field.constant,
            used: false,
            view: false,
            address: field.address,
            // A subrange of elements is at their array.
            range: self.program.range(ty),
        }
    }

    /// `flags`, `address` and `range`, to the end of the line.
    fn write_attributes(&mut self, attributes: &Attributes) -> fmt::Result {
        let flags = [
            ("retain", attributes.retain),
            ("whole", attributes.whole),
            ("stays", attributes.stays),
            ("restarts", attributes.restarts),
            ("constant", attributes.constant),
            ("used", attributes.used),
            ("view", attributes.view),
        ];
        let flags: Vec<_> = flags.into_iter().filter(|(_, is_set)| *is_set).map(|(name, _)| name).collect();
        let flags = if flags.is_empty() { "-".to_owned() } else { flags.join(",") };
        write!(self.text, "\t{flags}\t")?;
        match attributes.address {
            Some(address) => write!(self.text, "{address}")?,
            None => self.text.push('-'),
        }
        match attributes.range {
            Some((low, high)) => writeln!(self.text, "\t{low}..{high}"),
            None => writeln!(self.text, "\t-"),
        }
    }
}

impl Attributes {
    const NONE: Self = Self {
        retain: false,
        whole: false,
        stays: false,
        restarts: false,
        constant: false,
        used: false,
        view: false,
        address: None,
        range: None,
    };
}

/// The type of a variable; that of a single bit says which one of its byte it is.
fn type_of(variable: &Variable) -> String {
    match variable.view {
        Some(View { ty: Type::BOOL, bit, .. }) => format!("bit:{}", bit % 8),
        Some(View { ty, .. }) => TypeName(ty).to_string(),
        None => TypeName(variable.place.ty).to_string(),
    }
}

/// A type as the map writes it.
struct TypeName(Type);

impl fmt::Display for TypeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Type::Elementary(it) | Type::Subrange(it, _) => f.write_str(it.own_name()),
            Type::String(it) => write!(f, "{it}"),
            Type::Enum(id) => write!(f, "enum:{}", id.0),
            Type::Array(id) => write!(f, "array:{}", id.0),
            Type::Struct(id) => write!(f, "struct:{}", id.0),
            Type::Block(id) => write!(f, "block:{}", id.0),
            Type::Reference(_) => f.write_str("REFERENCE"),
        }
    }
}

fn block_of(ty: Type) -> Option<BlockId> {
    match ty {
        Type::Block(id) => Some(id),
        Type::Elementary(_)
        | Type::Reference(_)
        | Type::String(_)
        | Type::Enum(_)
        | Type::Subrange(..)
        | Type::Array(_)
        | Type::Struct(_) => None,
    }
}

/// A path with a tab or line end in it would break the record.
fn one_line(path: &str) -> String {
    path.replace(|c: char| c.is_control(), "?")
}

fn section_name(section: Section) -> &'static str {
    match section {
        Section::Input => "input",
        Section::Output => "output",
        Section::InOut => "inout",
        Section::Internal => "var",
        Section::Temp => "temp",
        Section::Global => "global",
        Section::External => "external",
    }
}

fn direction_name(direction: Direction) -> &'static str {
    match direction {
        Direction::Input => "input",
        Direction::Output => "output",
        Direction::Memory => "memory",
        Direction::Member => "member",
    }
}

#[cfg(test)]
mod tests;
