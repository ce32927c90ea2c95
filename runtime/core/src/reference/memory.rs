//! A program's state as what references reach into.

use core::any::{Any, TypeId};
use core::cell::Cell;

use crate::Text;
use crate::text::Unit;

/// The bytes of a state. Offsets lie within it, by the checks of a [`Table`](super::Table); what would not
/// is left out.
pub trait Memory {
    fn read(&self, at: usize, out: &mut [u8]);
    fn write(&self, at: usize, bytes: &[u8]);
}

/// A state as plain bytes.
impl Memory for [Cell<u8>] {
    fn read(&self, at: usize, out: &mut [u8]) {
        for (to, from) in out.iter_mut().zip(self.get(at..).unwrap_or_default()) {
            *to = from.get();
        }
    }

    fn write(&self, at: usize, bytes: &[u8]) {
        for (to, from) in self.get(at..).unwrap_or_default().iter().zip(bytes) {
            to.set(*from);
        }
    }
}

/// A variable of emitted Rust that several paths may reach, so that its numbers, strings and blocks lie
/// in cells.
pub trait Shared: Any {
    /// Takes over the value of another.
    fn assign(&self, from: &Self);
    /// Reads bytes of it, from position `at`.
    fn read(&self, at: usize, out: &mut [u8]);
    fn write(&self, at: usize, bytes: &[u8]);
    /// The variable of this type that begins at position `at` in it.
    fn find(&self, at: usize, wanted: TypeId) -> Option<&dyn Any>;
}

/// A variable that is found by its type.
pub fn find<T: Any>(whole: &impl Shared, at: usize) -> Option<&T> {
    whole.find(at, TypeId::of::<T>())?.downcast_ref()
}

/// The offset of a part of a program's state.
pub fn offset<P: ?Sized>(whole: &impl Shared, part: &P) -> usize {
    let address = |it: *const u8| it.addr();
    address(core::ptr::from_ref(part).cast()).wrapping_sub(address(core::ptr::from_ref(whole).cast()))
}

/// The state of emitted Rust.
impl<T: Shared> Memory for T {
    fn read(&self, at: usize, out: &mut [u8]) {
        Shared::read(self, at, out);
    }

    fn write(&self, at: usize, bytes: &[u8]) {
        Shared::write(self, at, bytes);
    }
}

/// Whether the object itself is the one that is looked for.
pub fn this<T: Any>(it: &T, at: usize, wanted: TypeId) -> Option<&dyn Any> {
    (at == 0 && TypeId::of::<T>() == wanted).then_some(it as &dyn Any)
}

/// A value as its bytes in memory. A standard block has none that anyone sees.
pub trait Raw: Copy + 'static {
    fn read(self, _at: usize, _out: &mut [u8]) {}

    #[must_use]
    fn written(self, _at: usize, _bytes: &[u8]) -> Self {
        self
    }
}

impl<T: Raw> Shared for Cell<T> {
    fn assign(&self, from: &Self) {
        self.set(from.get());
    }

    fn read(&self, at: usize, out: &mut [u8]) {
        self.get().read(at, out);
    }

    fn write(&self, at: usize, bytes: &[u8]) {
        self.set(self.get().written(at, bytes));
    }

    fn find(&self, at: usize, wanted: TypeId) -> Option<&dyn Any> {
        this(self, at, wanted)
    }
}

impl<T: Shared, const N: usize> Shared for [T; N] {
    fn assign(&self, from: &Self) {
        self.iter().zip(from).for_each(|(to, from)| to.assign(from));
    }

    fn read(&self, at: usize, out: &mut [u8]) {
        let (mut at, mut out) = (at, out);
        while let Some(element) = self.get(at.checked_div(size_of::<T>()).unwrap_or(N)).filter(|_| !out.is_empty()) {
            let inside = at % size_of::<T>();
            let count = out.len().min(size_of::<T>() - inside);
            let (now, later) = out.split_at_mut(count);
            element.read(inside, now);
            (at, out) = (at + count, later);
        }
    }

    fn write(&self, at: usize, bytes: &[u8]) {
        let (mut at, mut bytes) = (at, bytes);
        while let Some(element) = self.get(at.checked_div(size_of::<T>()).unwrap_or(N)).filter(|_| !bytes.is_empty()) {
            let inside = at % size_of::<T>();
            let (now, later) = bytes.split_at(bytes.len().min(size_of::<T>() - inside));
            element.write(inside, now);
            (at, bytes) = (at + now.len(), later);
        }
    }

    fn find(&self, at: usize, wanted: TypeId) -> Option<&dyn Any> {
        this(self, at, wanted).or_else(|| {
            // Of elements without bytes one is as good as the other.
            let position = at.checked_div(size_of::<T>()).unwrap_or(0);
            self.get(position)?.find(at.checked_rem(size_of::<T>()).unwrap_or(0), wanted)
        })
    }
}

macro_rules! raw {
    ($($rust:ident)*) => { $(
        impl Raw for $rust {
            #[inline]
            fn read(self, at: usize, out: &mut [u8]) {
                copy(&self.to_ne_bytes(), at, out);
            }

            #[inline]
            fn written(self, at: usize, bytes: &[u8]) -> Self {
                let mut whole = self.to_ne_bytes();
                overlay(&mut whole, at, bytes);
                Self::from_ne_bytes(whole)
            }
        }
    )* };
}

raw!(i8 i16 i32 i64 u8 u16 u32 u64 f32 f64);

impl Raw for bool {
    fn read(self, at: usize, out: &mut [u8]) {
        copy(&[u8::from(self)], at, out);
    }

    fn written(self, at: usize, bytes: &[u8]) -> Self {
        let mut whole = [u8::from(self)];
        overlay(&mut whole, at, bytes);
        whole[0] != 0
    }
}

impl<const N: usize, U: Unit> Raw for Text<N, U> {
    fn read(self, at: usize, out: &mut [u8]) {
        for (position, to) in (at..).zip(out) {
            *to = self.raw_byte(position);
        }
    }

    fn written(mut self, at: usize, bytes: &[u8]) -> Self {
        for (position, byte) in (at..).zip(bytes) {
            self.set_raw_byte(position, *byte);
        }
        self
    }
}

fn copy(whole: &[u8], at: usize, out: &mut [u8]) {
    for (to, from) in out.iter_mut().zip(whole.get(at..).unwrap_or_default()) {
        *to = *from;
    }
}

fn overlay(whole: &mut [u8], at: usize, bytes: &[u8]) {
    for (to, from) in whole.get_mut(at..).unwrap_or_default().iter_mut().zip(bytes) {
        *to = *from;
    }
}

/// Makes a structure of emitted Rust [`Shared`], by its fields.
#[macro_export]
macro_rules! shared {
    ($name:ident { $($field:ident),* $(,)? }) => {
        impl $crate::reference::Shared for $name {
            fn assign(&self, from: &Self) {
                $($crate::reference::Shared::assign(&self.$field, &from.$field);)*
                let _ = from;
            }

            fn read(&self, at: usize, out: &mut [u8]) {
                $(if let Some(at) = $crate::reference::inside(at, ::core::mem::offset_of!($name, $field), size_of_val(&self.$field)) {
                    return $crate::reference::Shared::read(&self.$field, at, out);
                })*
                let _ = (at, out);
            }

            fn write(&self, at: usize, bytes: &[u8]) {
                $(if let Some(at) = $crate::reference::inside(at, ::core::mem::offset_of!($name, $field), size_of_val(&self.$field)) {
                    return $crate::reference::Shared::write(&self.$field, at, bytes);
                })*
                let _ = (at, bytes);
            }

            // An instance without variables has no bytes, and lies where it begins.
            fn find(&self, at: usize, wanted: ::core::any::TypeId) -> Option<&dyn ::core::any::Any> {
                $(if let Some(at) = $crate::reference::inside(at, ::core::mem::offset_of!($name, $field), size_of_val(&self.$field).max(1)) {
                    if let Some(found) = $crate::reference::Shared::find(&self.$field, at, wanted) {
                        return Some(found);
                    }
                })*
                $crate::reference::this(self, at, wanted)
            }
        }
    };
}

/// The position in a field of the byte at `at` in the whole, if it is in the field.
#[inline]
pub fn inside(at: usize, offset: usize, size: usize) -> Option<usize> {
    at.checked_sub(offset).filter(|inside| *inside < size)
}

/// Makes an enumeration of emitted Rust a value with bytes.
#[macro_export]
macro_rules! shared_enumeration {
    ($name:ident) => {
        impl $crate::reference::Raw for $name {
            fn read(self, at: usize, out: &mut [u8]) {
                $crate::reference::Raw::read(self.0, at, out);
            }

            fn written(self, at: usize, bytes: &[u8]) -> Self {
                Self($crate::reference::Raw::written(self.0, at, bytes))
            }
        }
    };
}
