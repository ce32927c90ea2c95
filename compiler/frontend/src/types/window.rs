//! What is some bits of a variable: at a direct address that others share, a BIT, a member of a UNION, what `.3` selects.

use staunch_ir::{Address, Overlay, Type, View};

/// Some bits of a place that holds an integer, a bit string, or an array of them; or, where it is an element of
/// such an array, of what begins there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    pub ty: Type,
    /// The first bit, from the start of the place.
    pub bit: u64,
    /// A single bit, of type BOOL.
    pub is_bit: bool,
    pub address: Option<Address>,
    /// It is selected from a variable: `.3`, `.%B1`.
    pub is_selected: bool,
    /// It is a member of a packed structure, or a part of one.
    pub is_packed: bool,
}

impl From<View> for Window {
    fn from(view: View) -> Self {
        let is_bit = view.ty == Type::BOOL;
        Self { ty: view.ty, bit: view.bit, is_bit, address: Some(view.address), is_selected: false, is_packed: false }
    }
}

impl From<&Overlay> for Window {
    fn from(it: &Overlay) -> Self {
        Self { ty: it.ty, bit: it.bit, is_bit: it.is_bit, address: None, is_selected: false, is_packed: it.is_packed }
    }
}
