//! `{attribute 'pack_mode' := '1'}`: members are aligned to no more than so many bytes. As those of a UNION they are
//! some bits of numbers, since a variable of its own is aligned to its size on every executor.

use super::structure::storage;
use crate::types::declarations::Declarations;
use crate::types::table::Resolved;
use crate::{Code, Diagnostic};
use staunch_ir::layout::Shape;
use staunch_ir::{Const, Field, FieldId, Overlay, Struct, StructId, Type};

/// Where members lie, and what they take together.
struct Packing {
    offsets: Vec<u64>,
    whole: Shape,
}

impl Declarations<'_> {
    /// The structure with its members packed, but for the first `kept` fields, which are those of its base. `None`
    /// where that changes nothing, or where a member is none of what can be some bits of a number.
    pub(super) fn packed(&mut self, plain: &Struct, kept: usize, most: u64) -> Option<Struct> {
        let own = &plain.fields[kept..];
        if own.is_empty() || self.unpackable(own).is_some() {
            return None;
        }
        let packing = self.packing(plain, kept, most);
        let unpacked = self.packing(plain, plain.fields.len(), most);
        let is_same = packing.offsets == unpacked.offsets && packing.whole.size == unpacked.whole.size;
        if is_same && !self.has_text(own) {
            return None;
        }
        let Packing { offsets, whole: Shape { size, align } } = packing;
        // A base's fields stay as they are: what takes the base takes its heirs.
        let start = kept.checked_sub(1).map_or(0, |last| offsets[last] + self.stored_size(plain.fields[last].ty));
        let offsets: Vec<_> = offsets[kept..].iter().map(|it| it - start).collect();
        let parts = own.iter().filter_map(|it| self.smallest_part(it.ty).ok());
        let alignments = offsets.iter().map(|it| 1_u64 << it.trailing_zeros().min(3));
        let most = if kept == 0 { align.min(8) } else { 1 };
        let unit = parts.chain(alignments).fold(most, u64::min);
        let ty = self.units_of(size - start, unit)?;
        let initial = self.packed_initial(ty, own, &offsets);
        let doc = Some("The bytes of the members, which are packed.".to_owned());
        let name = if kept == 0 { "bytes".to_owned() } else { format!("bytes_{}", kept + 1) };
        let mut fields = plain.fields[..kept].to_vec();
        fields.push(storage(&name, ty, initial, doc, plain.location));
        let overlays = packed_overlays(plain, kept, &offsets);
        Some(Struct { fields, overlays, align, ..plain.clone() })
    }

    /// The first `kept` fields are where they are without packing.
    fn packing(&self, plain: &Struct, kept: usize, most: u64) -> Packing {
        let mut whole = Shape { size: 0, align: if kept == 0 { 1 } else { plain.align } };
        let mut offsets = Vec::with_capacity(plain.fields.len());
        for (at, field) in plain.fields.iter().enumerate() {
            let (size, align) = match at < kept {
                true => (self.stored_size(field.ty), self.align_of(field.ty)),
                false => (self.sizeof(field.ty), self.align_in_bytes(field.ty).min(most)),
            };
            let offset = whole.size.next_multiple_of(align);
            offsets.push(offset);
            whole = Shape { size: offset.saturating_add(size), align: whole.align.max(align) };
        }
        whole.size = whole.size.next_multiple_of(whole.align);
        Packing { offsets, whole }
    }

    /// The alignment of what an address shows of a variable: of a STRING that are its characters.
    fn align_in_bytes(&self, ty: Type) -> u64 {
        match ty {
            Type::String(it) => it.unit_size().into(),
            Type::Elementary(_)
            | Type::Subrange(..)
            | Type::Reference(_)
            | Type::Enum(_)
            | Type::Array(_)
            | Type::Struct(_)
            | Type::Block(_) => self.align_of(ty),
        }
    }

    /// What a variable takes, and not what its address shows.
    fn stored_size(&self, ty: Type) -> u64 {
        if let Type::String(_) = ty { self.size_of(ty) } else { self.sizeof(ty) }
    }

    /// A STRING's variable takes more bytes than an address shows of it.
    fn has_text(&self, fields: &[Field]) -> bool {
        fields.iter().any(|it| matches!(it.ty, Type::String(_)))
    }

    fn packed_initial(&self, ty: Type, fields: &[Field], offsets: &[u64]) -> Const {
        if fields.iter().all(|it| it.initial == Const::Zero) {
            return Const::Zero;
        }
        let size = |ty| usize::try_from(self.sizeof(ty)).unwrap_or_default();
        let mut bytes = vec![0; size(ty)];
        for (field, offset) in fields.iter().zip(offsets) {
            let start = usize::try_from(*offset).unwrap_or_default();
            self.put(field.ty, &field.initial, &mut bytes[start..start + size(field.ty)]);
        }
        self.taken(ty, &bytes)
    }

    /// What keeps a structure from being packed.
    fn unpackable(&self, fields: &[Field]) -> Option<String> {
        fields.iter().find_map(|it| match self.smallest_part(it.ty) {
            Err((ty, why)) => Some(format!("`{}` holds {}: {why}", it.name, self.program.type_name(ty))),
            Ok(_) => it.address.map(|_| format!("`{}` has a location of its own", it.name)),
        })
    }

    /// Structures that are not packed, though their attribute asks for it, where that makes a difference.
    pub(super) fn warn_of_packing(&mut self) {
        for at in 0..self.types.len() {
            let decl = self.types[at].decl;
            let Some((most, span)) = decl.pack else { continue };
            let Some(Resolved { ty: Type::Struct(id), .. }) = self.named_type(at) else { continue };
            let Some(why) = self.unpackable(&self.program.structure(id).fields) else { continue };
            let (is, asked) = self.sizes_of(id, most);
            if is == asked {
                continue;
            }
            self.report(
                Diagnostic::new(
                    Code::W0514,
                    span,
                    format!("`{}` is not packed: it takes {is} bytes instead of {asked}", decl.name.text),
                )
                .label(why)
                .other(decl.name.span, "declared here")
                .help("order the members by size, or copy them one by one to an ARRAY OF BYTE"),
            );
        }
    }

    fn sizes_of(&self, id: StructId, most: u64) -> (u64, u64) {
        let packed = self.packing(self.program.structure(id), 0, most).whole.size;
        (self.sizeof(Type::Struct(id)), packed)
    }
}

/// The members as bits of the one field that a packed structure has after those of its base.
fn packed_overlays(plain: &Struct, kept: usize, offsets: &[u64]) -> Vec<Overlay> {
    let bytes = FieldId::next(kept);
    let is_kept = |it: &&Overlay| it.field.index() < kept;
    let mut overlays: Vec<_> = plain.overlays.iter().filter(is_kept).cloned().collect();
    for (at, (field, offset)) in plain.fields[kept..].iter().zip(offsets).enumerate() {
        let (id, first) = (FieldId::next(kept + at), offset * 8);
        let shared: Vec<_> = plain.overlays.iter().filter(|it| it.field == id).cloned().collect();
        if shared.is_empty() {
            let Field { name, ty, doc, location, .. } = field.clone();
            let (is_bit, is_packed) = (false, true);
            overlays.push(Overlay { name, ty, field: bytes, bit: first, is_bit, is_packed, doc, location });
        }
        overlays.extend(shared.into_iter().map(|it| Overlay { field: bytes, bit: first + it.bit, ..it }));
    }
    overlays
}
