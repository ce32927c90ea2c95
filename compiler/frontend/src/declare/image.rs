//! Which direct addresses share bits, and which variable keeps them: the array among them, else the widest.
//! Addresses are multiples of their own widths, so that of two which overlap one holds the other.

use super::address::bit_string;
use crate::types::address::{Start, Storage, Use, field_name};
use crate::types::declarations::Declarations;
use crate::types::image::Shared;
use crate::types::table::{GLOBALS, Resolved};
use crate::{Code, Diagnostic, Span};
use rustc_hash::FxHashSet;
use staunch_ir::{Address, Const, Elementary, Field, FieldId, Place, Retain, Root, Section, Type, View};
use std::cmp::Reverse;

/// One of the uses of an address.
#[derive(Clone, Copy)]
struct Member {
    first: Use,
    /// All bits, also those of an array's other elements.
    bits: u64,
    ty: Type,
    /// The field that its declaration has got.
    field: usize,
}

impl Member {
    fn end(&self) -> u64 {
        self.first.address.bit + self.bits
    }

    fn holds(&self, other: &Self) -> bool {
        self.first.address.bit <= other.first.address.bit && other.end() <= self.end()
    }
}

impl<'s> Declarations<'s> {
    /// Finds the addresses that share bits, when all declarations are known.
    pub(super) fn find_image(&mut self, mut uses: Vec<Use>) {
        let key = |this: &Self, it: &Use| (it.address.area, it.address.module, this.register_size(it));
        uses.sort_by_key(|it| {
            (key(self, it), it.address.bit, Reverse(it.bits), it.address.width, it.span.file, it.span.start)
        });
        let mut group: Vec<Use> = Vec::new();
        let mut end = 0;
        for it in uses {
            let goes_on = group.first().is_some_and(|first| key(self, first) == key(self, &it)) && it.address.bit < end;
            if !goes_on {
                self.share(&group);
                group.clear();
                end = 0;
            }
            end = end.max(it.address.bit + it.bits);
            group.push(it);
        }
        self.share(&group);
    }

    /// OpenPLC keeps each size in registers of its own, so that %IX0.0 and %IW0 are two.
    fn register_size(&self, it: &Use) -> u8 {
        if self.dialect(it.span).has_registers() { it.address.width } else { 0 }
    }

    fn share(&mut self, group: &[Use]) {
        let mut seen = FxHashSet::default();
        let mut is_first = |it: &&Use| seen.insert((it.address, self.addresses.storage_of(it.address, it.ty)));
        let firsts: Vec<Use> = group.iter().filter(|it| is_first(it)).copied().collect();
        let [widest, others @ ..] = firsts.as_slice() else { return };
        if others.is_empty() {
            return;
        }
        // A body that names an address says itself which bits it means.
        for (before, it) in others.iter().enumerate().filter(|(_, it)| it.scope.is_some()) {
            let mut named = firsts[..=before].iter();
            if named.any(|first| first.address == it.address && first.scope == it.scope) {
                // Two names of one address are reported as such.
                continue;
            }
            self.report(
                Diagnostic::new(Code::W0410, it.span, "the addresses of two variables overlap")
                    .label("this address shares bits with another one: assigning to one variable changes both")
                    .other(widest.span, "the other address"),
            );
        }
        let members: Option<Vec<Member>> = firsts.iter().map(|it| self.member(*it, group)).collect();
        let Some(members) = members else { return };
        let storage = self.keeper(&members);
        let Some((storage, keeper)) = storage else { return };
        for it in members.iter().filter(|it| it.field != keeper.field) {
            let bit = it.first.address.bit - keeper.first.address.bit;
            let view = View { ty: it.ty, bit, address: it.first.address };
            let shared = Shared { storage, ty: keeper.ty, view };
            self.image.shared.insert(it.field, shared);
        }
    }

    /// `None` where its declaration was refused.
    fn member(&mut self, first: Use, group: &[Use]) -> Option<Member> {
        let same = group.iter().filter(|it| it.address == first.address && it.ty.is_none_or(|ty| Some(ty) == first.ty));
        let bits = same.map(|it| it.bits).max().unwrap_or(first.bits);
        let own = self.addresses.own_fields().len();
        let (ty, field) = match self.addresses.storage_of(first.address, first.ty)? {
            Storage::Global(at) => (self.global(at)?.resolved.ty, self.addresses.field_of_global(at)?),
            Storage::Hidden(at) => (self.synthetic.field_type(at), own + at),
        };
        Some(Member { first, bits, ty, field })
    }

    /// Who keeps the bits of all.
    fn keeper(&mut self, members: &[Member]) -> Option<(usize, Member)> {
        for it in members {
            if let Err((ty, why)) = self.smallest_part(it.ty) {
                let other = members.iter().find(|other| other.field != it.field).unwrap_or(it);
                self.refuse_sharing(it.first, other.first, ty, why);
                return None;
            }
        }
        let is_number = |it: &&Member| matches!(it.ty, Type::Elementary(_) | Type::Enum(_));
        let mut wholes = members.iter().filter(|it| !is_number(it));
        let is_of_one = |array: &Member| members.iter().all(|it| array.holds(it));
        let keeper = match (wholes.next(), wholes.next()) {
            (Some(array), None) if is_of_one(array) && self.keeps_bits(array) => *array,
            (Some(_), _) => self.bytes_of(members)?,
            (None, _) => self.widest_number(members)?,
        };
        Some((keeper.field, keeper))
    }

    /// Whether it is made of integers, and lies where one of them does.
    fn keeps_bits(&self, it: &Member) -> bool {
        self.unit(it.ty).is_some_and(|bits| it.first.address.bit.is_multiple_of(bits))
    }

    /// An array of bytes for all, where no array of integers holds the bits of every other, and for texts and structures.
    fn bytes_of(&mut self, members: &[Member]) -> Option<Member> {
        let first = members.iter().min_by_key(|it| it.first.address.bit)?;
        let start = first.first.address.bit / 8 * 8;
        let bits = members.iter().map(Member::end).max()?.next_multiple_of(8) - start;
        let high = i64::try_from(bits / 8).ok()? - 1;
        let ty = self.intern_array(0, high, Resolved::plain(Type::Elementary(Elementary::Byte)));
        let address = Address { bit: start, width: 8, ..first.first.address };
        Some(self.add_keeper(&Member { first: Use { address, ..first.first }, bits, ty, ..*first }))
    }

    /// A field that keeps the bits of all, and that nobody has declared.
    fn add_keeper(&mut self, it: &Member) -> Member {
        let address = it.first.address;
        let field = Field {
            name: format!("bits_of_{}", field_name(&address.to_string())),
            ty: it.ty,
            initial: Const::Zero,
            section: Section::Internal,
            retain: Retain::Inherited,
            constant: false,
            address: None,
            doc: Some(format!("The bits from `{address}` on, which several variables share.")),
            location: self.location(it.first.span),
            declared: None,
        };
        let at = self.add_synthetic(field, None);
        Member { field: self.addresses.own_fields().len() + at, ..*it }
    }

    /// The widest one, if that is a number of which all bits are values; else a bit string that holds its bits.
    fn widest_number(&mut self, members: &[Member]) -> Option<Member> {
        let most = members.iter().map(|it| it.bits).max()?;
        let mut widest = members.iter().filter(|it| it.bits == most);
        let first = *widest.clone().next()?;
        if let Some(it) = widest.find(|it| is_of_bits(it.ty)) {
            return Some(*it);
        }
        Some(self.add_keeper(&Member { ty: bit_string(first.first.address), ..first }))
    }

    /// The bits of the integers that the type is made of.
    fn unit(&self, ty: Type) -> Option<u64> {
        match ty {
            Type::Elementary(it) if is_of_bits(ty) => Some(u64::from(it.repr().size()) * 8),
            Type::Array(id) => match self.program.array(id).element {
                Type::Elementary(Elementary::Bool) | Type::Array(_) => None,
                element => self.unit(element),
            },
            _ => None,
        }
    }

    fn refuse_sharing(&mut self, it: Use, other: Use, ty: Type, why: &str) {
        let name = self.program.type_name(ty);
        let mut error = Diagnostic::new(Code::E0410, it.span, format!("{name} cannot share its bits with others"))
            .label("this address shares bits with another one")
            .help(why);
        if other.span != it.span {
            error = error.other(other.span, "the other address");
        }
        self.report(error);
    }

    /// Takes the fields away that others keep, with what they say of the start.
    pub(super) fn settle_image(&mut self, fields: &mut Vec<Field>) {
        self.image.settle(fields.len());
        let mut shared: Vec<_> = self.image.shared.values().copied().collect();
        shared.sort_by_key(|it| (it.storage, it.view.bit, it.view.address.width));
        for views in shared.chunk_by(|a, b| a.storage == b.storage) {
            let Some(keeper) = fields.get_mut(views[0].storage) else { continue };
            self.start_together(keeper, views);
        }
        let mut field = 0;
        fields.retain(|_| {
            field += 1;
            !self.image.shared.contains_key(&(field - 1))
        });
    }

    /// Each declaration may say how its bits start.
    fn start_together(&mut self, keeper: &mut Field, views: &[Shared]) {
        let start = |address: Address, ty: Type| self.addresses.starts.get(&(address, ty));
        let is_given = |at: Option<&Start>| at.is_some_and(|it| it.initial.is_some());
        if views.iter().any(|it| start(it.view.address, it.view.ty).is_some_and(|it| it.kept)) {
            keeper.retain = Retain::Kept;
        }
        let given = views.iter().filter(|it| is_given(start(it.view.address, it.view.ty)));
        let given: Vec<Shared> = given.copied().collect();
        if given.is_empty() {
            return;
        }
        let size = usize::try_from(self.sizeof(keeper.ty)).unwrap_or_default();
        let mut bytes = vec![0; size];
        self.put(keeper.ty, &keeper.initial, &mut bytes);
        let said = if is_given(keeper.address.and_then(|it| start(it, keeper.ty))) { 0xFF } else { 0 };
        let mut together = Together { bytes, said: vec![said; size] };
        for it in given {
            if let Some(span) = self.start_view(it.view, &mut together) {
                self.report_two_starts(span, keeper);
            }
        }
        keeper.initial = self.taken(keeper.ty, &together.bytes);
    }

    /// Sets the bits of a view; where another one says that they start otherwise, gives the place of its initial value.
    fn start_view(&self, view: View, together: &mut Together) -> Option<Span> {
        let (value, span) = self.addresses.starts.get(&(view.address, view.ty))?.initial.as_ref()?;
        let first = usize::try_from(view.bit / 8).ok()?;
        let size = usize::try_from(self.sizeof(view.ty)).ok()?;
        let mut bytes = vec![0; size];
        self.put(view.ty, value, &mut bytes);
        let shift = view.bit % 8;
        let mask = if view.ty == Type::BOOL { 1 << shift } else { 0xFF };
        let range = first..first + size;
        let (now, said) = (together.bytes.get_mut(range.clone())?, together.said.get_mut(range)?);
        bytes.iter_mut().for_each(|it| *it = *it << shift & mask);
        let differs = |at: usize| (now[at] ^ bytes[at]) & mask & said[at] != 0;
        if (0..size).any(differs) {
            return Some(*span);
        }
        for at in 0..size {
            now[at] = now[at] & !mask | bytes[at];
            said[at] |= mask;
        }
        None
    }

    fn report_two_starts(&mut self, span: Span, keeper: &Field) {
        let mut error = Diagnostic::new(Code::E0409, span, "two initial values for the same bits")
            .label("another declaration gives them another value")
            .help("give the value in one of the declarations");
        // What nobody has declared has no place of its own.
        if keeper.section != Section::Internal {
            error = error.other(self.log.name_at(keeper.location), "they are kept here");
        }
        self.report(error);
    }

    /// The views as other names of what keeps their bits. `names` are those of all declared fields.
    pub(super) fn views(&self, names: &[String]) -> Vec<staunch_ir::Variable> {
        let is_shown = |it: &usize| !self.addresses.second_names.contains(it);
        let mut views: Vec<_> = self.image.shared.keys().copied().filter(is_shown).collect();
        views.sort_unstable();
        let variable = |field: usize| {
            let ty = self.image.shared.get(&field)?.view.ty;
            let declared = Place::root(Root::Globals, Type::Struct(GLOBALS)).field(FieldId::next(field), ty);
            let (place, view) = self.image.stored(&declared);
            Some(staunch_ir::Variable { name: names.get(field)?.clone(), section: Section::Global, place, view })
        };
        views.into_iter().filter_map(variable).collect()
    }
}

/// BOOL, integers and bit strings: all bits are values of them, and no type of time.
fn is_of_bits(ty: Type) -> bool {
    matches!(ty, Type::Elementary(it) if it == Elementary::Bool || it.repr().is_integer() && !it.is_time())
}

/// What the declarations of some bits say together of their start.
struct Together {
    bytes: Vec<u8>,
    /// The bits that one of them has said.
    said: Vec<u8>,
}
