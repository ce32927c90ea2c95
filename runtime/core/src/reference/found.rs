//! The target of a reference, looked for where it is expected: emitted Rust compares with the few places where a
//! variable of the type is, and asks the table of objects for all else.

use super::{CLASS, ORIGIN, Reference, Shared, Table, View, Wanted, offset};
use crate::{FaultKind, Repr, Scalar};
use core::any::Any;
use core::cell::Cell;

/// The bits of a reference that say where it points: without its class.
const PLACE: u64 = (1 << CLASS) - 1;

/// How far the place at `distance` bytes from where a reference points is after the byte of the state at `offset`, in this
/// object: far beyond any array where it is before that, or in another object.
#[inline]
pub const fn behind(reference: u64, distance: u64, object: u32, offset: u32) -> u64 {
    let first = Reference { object, address: ORIGIN + offset };
    if distance == 0 {
        return (reference & PLACE).wrapping_sub(first.bits());
    }
    // The object is compared by itself: an address and a distance may be more than 32 bits.
    let at = Reference::from_bits(reference);
    if at.object == object {
        (at.address as u64).wrapping_add(distance).wrapping_sub(first.address as u64)
    } else {
        u64::MAX
    }
}

/// The variable, if that is where it is looked for.
#[inline]
pub fn whole<T>(it: &T, at: u64) -> Option<&T> {
    if at == 0 { Some(it) } else { None }
}

/// The element that begins at a byte of an array.
#[inline]
pub fn element<T>(array: &[T], at: u64) -> Option<&T> {
    let size = size_of::<T>() as u64;
    let twos = size.trailing_zeros();
    // By the odd part's inverse and a rotation a multiple of the size becomes its position, and all else a number beyond
    // each array.
    let position = at.wrapping_mul(const { inverse(size_of::<T>() as u64) }).rotate_right(twos);
    array.get(usize::try_from(position).ok()?)
}

/// What the odd part of a number is multiplied with to give 1, in 64 bits.
pub const fn inverse(number: u64) -> u64 {
    let odd = match number {
        0 => 1,
        number => number >> number.trailing_zeros(),
    };
    // Newton's iteration: each turn doubles the bits that are right, of which there are three at the start.
    let (mut inverse, mut turns) = (odd, 0);
    while turns < 5 {
        inverse = inverse.wrapping_mul(2_u64.wrapping_sub(odd.wrapping_mul(inverse)));
        turns += 1;
    }
    inverse
}

/// The element that holds a byte of an array, and the byte's position in it.
#[inline]
pub fn part<T>(array: &[T], at: u64) -> Option<(&T, u64)> {
    let size = size_of::<T>() as u64;
    let position = usize::try_from(at.checked_div(size)?).ok()?;
    array.get(position).map(|it| (it, at % size))
}

/// The reference to a part of the state that is in this object.
#[inline]
pub fn to<P: ?Sized>(object: u32, whole: &impl Shared, part: &P) -> u64 {
    Reference { object, address: ORIGIN + offset(whole, part) as u32 }.bits()
}

/// The place at a distance from where a reference points, with the variable there if it is one of those that are
/// expected. Where the table decides, it gets a copy of the table: this is in registers as long as nobody has its address.
#[derive(Debug)]
pub struct Found<'m, T, M> {
    variable: Option<&'m T>,
    table: Table<'m>,
    machine: &'m M,
    reference: u64,
    distance: u64,
}

impl<'t> Table<'t> {
    #[inline]
    pub const fn found<T, M>(
        self,
        variable: Option<&'t T>,
        machine: &'t M,
        reference: u64,
        distance: u64,
    ) -> Found<'t, T, M> {
        Found { variable, table: self, machine, reference, distance }
    }
}

impl<'m, T, M: Shared> Found<'m, T, M> {
    /// The number or BOOL that `of` reads out of the variable, `further` bytes into it.
    #[inline]
    pub fn get<V: Scalar>(self, further: u64, of: impl FnOnce(&'m T) -> V) -> Result<V, FaultKind> {
        self.get_as(view::<V>(), further, of)
    }

    /// What is seen as nothing but what it is.
    #[inline]
    pub fn get_as<V: Scalar>(self, view: View, further: u64, of: impl FnOnce(&'m T) -> V) -> Result<V, FaultKind> {
        match self.variable {
            Some(it) => Ok(of(it)),
            None => {
                let Self { table, .. } = self;
                table.load(self.machine, self.reference, self.distance + further, view)
            }
        }
    }

    /// Writes a number or BOOL to where `of` leads in the variable, `further` bytes into it.
    #[inline]
    pub fn set<V: Scalar>(
        self,
        further: u64,
        of: impl FnOnce(&'m T) -> &'m Cell<V>,
        value: V,
    ) -> Result<(), FaultKind> {
        self.set_as(view::<V>(), further, |it, value| of(it).set(value), value)
    }

    /// The same for what is seen as nothing but what it is: `store` writes it.
    #[inline]
    pub fn set_as<V: Scalar>(
        self,
        view: View,
        further: u64,
        store: impl FnOnce(&'m T, V),
        value: V,
    ) -> Result<(), FaultKind> {
        match self.variable {
            Some(it) => {
                store(it, value);
                Ok(())
            }
            None => {
                let Self { table, .. } = self;
                table.store(self.machine, self.reference, self.distance + further, view, value)
            }
        }
    }

    /// The part of the variable to which `of` leads, `further` bytes into it: of exactly its type.
    #[inline]
    pub fn borrow<V: Any>(
        self,
        wanted: Wanted,
        further: u64,
        of: impl FnOnce(&'m T) -> &'m V,
    ) -> Result<&'m V, FaultKind> {
        match self.variable {
            Some(it) => Ok(of(it)),
            None => {
                let Self { table, .. } = self;
                table.variable(self.machine, self.reference, self.distance + further, wanted)
            }
        }
    }
}

/// How a number or BOOL is seen.
const fn view<V: Scalar>() -> View {
    match V::LANE {
        Repr::Bool => View::Truth,
        repr => View::Number(repr.size()),
    }
}
