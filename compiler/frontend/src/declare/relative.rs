//! Relative locations of a structure's members, `AT %B4`, `AT %X0.3`: bytes and bits from its start.
//!
//! They give the structure's layout in the memory of the system that the source is from, which no program can see:
//! they are checked, and a structure that has them cannot be in the process image. In a UNION they say which bytes are shared.

use crate::dialect::Dialect;
use crate::types::declarations::Declarations;
use crate::{Code, Diagnostic, Span, ast};
use staunch_ir::{Elementary, Field, Type};

/// `%B4` or `%X0.3`, in bits; `None` for a direct address.
fn parse(text: &str) -> Option<Offset> {
    let text = text.strip_prefix('%')?;
    let (size, place) = text.split_at_checked(1)?;
    match (size, place.split_once('.')) {
        ("B" | "b", None) => Some(Offset { bit: 8 * u64::from(place.parse::<u32>().ok()?), is_bit: false }),
        ("X" | "x", Some((byte, bit))) => {
            let bit = bit.parse::<u64>().ok().filter(|it| *it < 8)?;
            Some(Offset { bit: 8 * u64::from(byte.parse::<u32>().ok()?) + bit, is_bit: true })
        }
        _ => None,
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Offset {
    pub bit: u64,
    pub is_bit: bool,
}

/// A member's place.
struct Extent {
    start: u64,
    end: u64,
    span: Span,
}

impl<'s> Declarations<'s> {
    /// Checks the locations of a structure's members; gives how many bits they take, or `None` where they have none.
    pub(super) fn relative_extent(&mut self, members: &[ast::VarDecl<'s>], fields: &[Field]) -> Option<u64> {
        let mut extents = Vec::new();
        let mut fields = fields.iter();
        for decl in members {
            let types: Vec<_> = fields.by_ref().take(decl.names.len()).map(|it| it.ty).collect();
            let Some(address) = self.location_of(decl) else { continue };
            self.check_one_name(decl);
            if let (Some(offset), [ty, ..]) = (self.offset(address), types.as_slice()) {
                let bits = self.bits_at(address, offset, *ty).unwrap_or_default();
                extents.push(Extent { start: offset.bit, end: offset.bit.saturating_add(bits), span: address.span });
            }
        }
        let first = extents.first()?.span;
        for decl in members.iter().filter(|it| self.location_of(it).is_none()).collect::<Vec<_>>() {
            self.report(
                Diagnostic::new(Code::E0409, decl.span, "this member has no location")
                    .label("if one member has a location, every member must have one")
                    .other(first, "the location of another member"),
            );
        }
        extents.sort_by_key(|it| (it.start, it.end, it.span.start));
        self.report_overlaps(&extents);
        extents.iter().map(|it| it.end).max()
    }

    /// Reports members that begin before the one before them ends.
    fn report_overlaps(&mut self, extents: &[Extent]) {
        let mut last: Option<&Extent> = None;
        for extent in extents {
            if let Some(last) = last.filter(|it| extent.start < it.end) {
                let (byte, bit) = (last.end / 8, last.end % 8);
                let end = if bit == 0 { format!("byte {byte}") } else { format!("bit {byte}.{bit}") };
                self.report(
                    Diagnostic::new(Code::E0409, extent.span, "two members have the same place")
                        .label("this one begins before the other ends")
                        .other(last.span, format!("the next member can begin at {end}")),
                );
            }
            if last.is_none_or(|it| it.end < extent.end) {
                last = Some(extent);
            }
        }
    }

    /// Where a member says that it lies. `AT %I*` says that the system's tree of devices may connect it: it is a member like
    /// any other.
    pub(super) fn location_of(&self, member: &ast::VarDecl<'s>) -> Option<ast::Name<'s>> {
        let is_open =
            |it: &ast::Name<'s>| it.text.ends_with('*') && self.log.has_form(it.span, Dialect::leaves_addresses_open);
        member.address.filter(|it| !is_open(it))
    }

    /// Where a member of a UNION begins, if that is said; `None` where it is wrong.
    pub(super) fn offset_in_union(&mut self, member: &ast::VarDecl<'s>, ty: Type) -> Option<Option<Offset>> {
        let Some(address) = self.location_of(member) else { return Some(None) };
        let offset = self.offset(address)?;
        self.bits_at(address, offset, ty);
        Some(Some(offset))
    }

    fn offset(&mut self, address: ast::Name<'s>) -> Option<Offset> {
        let offset = parse(address.text);
        if offset.is_none() && is_direct(address.text) {
            self.not_supported(address.span, "the address of a structure's member");
        } else if offset.is_none() {
            self.report(
                Diagnostic::new(
                    Code::E0409,
                    address.span,
                    format!("`{}` is not a location in a structure", address.text),
                )
                .help("write a byte, `%B4`, or a byte and a bit from 0 to 7, `%X4.0`"),
            );
        }
        offset
    }

    /// Reports an address of what lies otherwise in the memory of the system that the source is from.
    pub(super) fn check_not_relative(&mut self, ty: Type, span: Span) {
        if self.holds_relative(ty) {
            let found = self.program.type_name(ty);
            let what = format!("a variable of {found} at an address, whose members have locations of their own,");
            self.not_supported(span, &what);
        }
    }

    fn holds_relative(&self, ty: Type) -> bool {
        self.program.holds(ty, |it| matches!(it, Type::Struct(id) if self.table.relative.contains_key(&id)))
    }

    /// How many bits a member takes; `None` where other systems decide that.
    fn bits_at(&mut self, address: ast::Name<'s>, offset: Offset, ty: Type) -> Option<u64> {
        let is_bool = ty == Type::Elementary(Elementary::Bool);
        if offset.is_bit && !is_bool {
            let found = self.program.type_name(ty);
            self.report(
                Diagnostic::new(Code::E0409, address.span, format!("`{}` is a bit, but this is {found}", address.text))
                    .help(format!("write the byte where it begins: `%B{}`", offset.bit / 8)),
            );
        }
        if is_bool && offset.is_bit { Some(1) } else { self.bits_of(ty) }
    }

    /// How many bits a type takes in every system; `None` where that differs.
    fn bits_of(&self, ty: Type) -> Option<u64> {
        match ty {
            // A BOOL of an array may be a byte or a bit.
            Type::Elementary(Elementary::Bool) | Type::String(_) | Type::Reference(_) | Type::Block(_) => None,
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) => Some(8 * self.size_of(ty)),
            Type::Struct(id) => self.table.relative.get(&id).copied(),
            Type::Array(id) => {
                let array = self.program.array(id);
                self.bits_of(array.element).map(|it| it.saturating_mul(array.len()))
            }
        }
    }
}

fn is_direct(text: &str) -> bool {
    matches!(text.as_bytes().get(1), Some(b'I' | b'i' | b'Q' | b'q' | b'M' | b'm'))
}
