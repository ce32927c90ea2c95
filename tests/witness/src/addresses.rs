//! Direct addresses: an address is one variable, whoever declares it.

use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::shared::Window;
use crate::storage::{Cell, Place};
use crate::types::{Elementary, Slot, Type};
use staunch_runtime::Family;

/// Bytes of each area of the process image.
const IMAGE: usize = 1024;

/// Where it is, and its type if no declaration says more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    /// `I`, `Q` or `M`; in OpenPLC each size has registers of its own.
    image: String,
    window: Window,
    ty: Elementary,
}

impl Address {
    pub fn is_input(&self) -> bool {
        self.image.starts_with('I')
    }

    /// `%MW1` is bytes 2 and 3.
    pub fn read(text: &str, family: Family) -> Outcome<Self> {
        let text = text.trim_start_matches('%').to_ascii_uppercase();
        let letters = text.trim_end_matches(|it: char| !it.is_ascii_alphabetic());
        let (area, size) = letters.split_at(letters.len().min(1));
        let (bytes, ty) = match size {
            "" | "X" => (0, Elementary::Bool),
            "B" => (1, Elementary::Byte),
            "W" => (2, Elementary::Word),
            "D" => (4, Elementary::Dword),
            "L" => (8, Elementary::Lword),
            _ => return unknown("this address"),
        };
        let numbers: Result<Vec<usize>, _> = text[letters.len()..].split('.').map(str::parse).collect();
        let bit = match (bytes, numbers.as_deref()) {
            (0, Ok([byte, bit])) if *bit < 8 => 8 * byte + bit,
            (1.., Ok([number])) => 8 * bytes * number,
            _ => return unknown("this address"),
        };
        let image = if matches!(family, Family::Openplc | Family::Openplc4) { letters } else { area };
        Ok(Self { image: image.to_owned(), window: Window { bit, single: bytes == 0 }, ty })
    }
}

impl<'a> Machine<'a> {
    pub(crate) fn start_images(&mut self) {
        for area in ["I", "Q", "M"] {
            for size in ["", "X", "B", "W", "D", "L"] {
                self.images.insert(format!("{area}{size}"), self.memory.len());
                self.memory.push(Cell::Bytes(vec![0; IMAGE]));
            }
        }
    }

    /// What the variables at addresses start with: bytes that no declaration says otherwise of are zeros.
    pub(crate) fn start_addresses(&mut self) -> Outcome<()> {
        let located = self.declared.pous.iter().flat_map(|it| &it.variables);
        let located = located.filter_map(|it| Some((it.address.clone()?, it.slot.clone())));
        for (address, slot) in located.collect::<Vec<(Address, Slot<'a>)>>() {
            let place = self.at_address(&address, &slot.ty)?;
            self.start(&Frame::default(), &place, slot.initial)?;
        }
        Ok(())
    }

    /// What a body means by `%MW3`: what is declared there, or else a bit string.
    pub(crate) fn at_name(&self, text: &str) -> Outcome<Place<'a>> {
        let address = Address::read(text, self.declared.family)?;
        let bits = Type::Elementary(address.ty);
        let of_pous = self.declared.pous.iter().flat_map(|it| &it.variables);
        let mut all = self.declared.globals.iter().chain(of_pous);
        let declared = all.find(|it| it.address.as_ref() == Some(&address) && it.slot.ty.bytes() == bits.bytes());
        self.at_address(&address, declared.map_or(&bits, |it| &it.slot.ty))
    }

    pub(crate) fn at_address(&self, address: &Address, ty: &Type<'a>) -> Outcome<Place<'a>> {
        match ty.bytes() {
            Some(bytes) if address.window.bit / 8 + bytes <= IMAGE => {}
            _ => return unknown("this address"),
        }
        let Some(at) = self.images.get(&address.image) else { return unknown("this area") };
        Ok(Place {
            at: *at,
            ty: ty.clone(),
            nowhere: None,
            declared: None,
            window: Some(address.window),
            character: None,
        })
    }

    /// Adds the variables of a POU that have addresses to the names of its body.
    pub(crate) fn name_addresses(&self, frame: &mut Frame<'a>, pou: usize) -> Outcome<()> {
        for it in &self.declared.pous[pou].variables {
            if let Some(address) = &it.address {
                frame.names.insert(it.name.to_ascii_uppercase(), self.at_address(address, &it.slot.ty)?);
            }
        }
        Ok(())
    }
}
