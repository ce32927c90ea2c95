//! A process image: the position of the value at each direct address among the bytes of its area. Emitted Rust uses the same image as an
//! executable does in shared memory.

use super::Area;

/// The number of values of each width in an area, as in OpenPLC's runtime; there are eight times as many bits.
const NUMBERS: usize = 1024;

/// The width of the value at a direct address: X, B, W, D or L.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Width {
    /// One bit, which takes a whole byte in an image.
    Bit,
    /// 8 bits.
    Byte,
    /// 16 bits.
    Word,
    /// 32 bits.
    Double,
    /// 64 bits.
    Long,
}

impl Width {
    /// The size of a value in an image, in bytes.
    pub const fn size(self) -> usize {
        match self {
            Self::Bit | Self::Byte => 1,
            Self::Word => 2,
            Self::Double => 4,
            Self::Long => 8,
        }
    }

    /// How many values of this width an area has.
    pub const fn count(self) -> usize {
        match self {
            Self::Bit => 8 * NUMBERS,
            Self::Byte | Self::Word | Self::Double | Self::Long => NUMBERS,
        }
    }

    /// The offset of its table in an area.
    const fn table(self) -> usize {
        match self {
            Self::Bit => 0,
            Self::Byte => 8 * NUMBERS,
            Self::Word => 9 * NUMBERS,
            Self::Double => 11 * NUMBERS,
            Self::Long => 15 * NUMBERS,
        }
    }
}

/// The place of the value at a direct address in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    /// `%I`, `%Q` or `%M`.
    pub area: Area,
    /// The width of the value.
    pub width: Width,
    /// 3 in `%IW3`. For a bit, eight times its byte plus its position there: 11 in `%QX1.3`.
    pub number: usize,
}

impl Place {
    /// The size of an area, in bytes.
    pub const AREA_SIZE: usize = 23 * NUMBERS;

    /// The place with this number, which must be below [`Width::count`].
    pub const fn new(area: Area, width: Width, number: usize) -> Self {
        Self { area, width, number }
    }

    /// The place of an address: for `%QX1.3` the outputs, a bit, and the number 11. `None` for the address of a module, `%IW1.2.3`, and for
    /// a number that is too high.
    pub fn parse(address: &str) -> Option<Self> {
        let mut letters = address.strip_prefix('%')?.chars();
        let area = match letters.next()? {
            'I' => Area::Input,
            'Q' => Area::Output,
            'M' => Area::Memory,
            _ => return None,
        };
        let width = match letters.next()? {
            'X' => Width::Bit,
            'B' => Width::Byte,
            'W' => Width::Word,
            'D' => Width::Double,
            'L' => Width::Long,
            _ => return None,
        };
        let number = match (width, letters.as_str().split_once('.')) {
            (Width::Bit, Some((byte, bit))) => bit_number(byte.parse().ok()?, bit.parse().ok()?)?,
            (Width::Bit, None) => return None,
            (Width::Byte | Width::Word | Width::Double | Width::Long, _) => letters.as_str().parse().ok()?,
        };
        (number < width.count()).then_some(Self { area, width, number })
    }

    /// Whether a value of this type fits the place: a BOOL needs a bit, and other values a place with their number of bytes.
    pub const fn holds(self, is_bool: bool, size: usize) -> bool {
        match self.width {
            Width::Bit => is_bool,
            Width::Byte | Width::Word | Width::Double | Width::Long => !is_bool && size == self.width.size(),
        }
    }

    /// The maximum number of array elements that have places from here on.
    pub const fn room(self) -> usize {
        self.width.count().saturating_sub(self.number)
    }

    /// The offset of its first byte in its area.
    pub const fn at(self) -> usize {
        self.width.table().saturating_add(self.number.saturating_mul(self.width.size()))
    }
}

fn bit_number(byte: usize, bit: usize) -> Option<usize> {
    if bit < 8 { byte.checked_mul(8)?.checked_add(bit) } else { None }
}

/// Access to the bytes at the places of an image, lowest byte first: a driver's memory, its pins, or the data that it has received.
///
/// `read_image` and `write_image` of a program's globals load and store each place that belongs to a variable.
pub trait ProcessImage {
    /// Copies the value at a place into `bytes`, which has the size of the place. A bit is FALSE if its byte is 0, otherwise TRUE.
    fn load(&self, place: Place, bytes: &mut [u8]);

    /// Copies `bytes`, which has the size of the place, to the place. A bit is 0 or 1.
    fn store(&mut self, place: Place, bytes: &[u8]);

    /// The value at a place as bits.
    fn bits(&self, place: Place) -> u64 {
        let mut bytes = [0; 8];
        if let Some(value) = bytes.get_mut(..place.width.size()) {
            self.load(place, value);
        }
        match (place.width, u64::from_le_bytes(bytes)) {
            (Width::Bit, bits) => u64::from(bits != 0),
            (_, bits) => bits,
        }
    }

    /// The value at a place as bits, if it differs from `present`.
    fn changed(&self, place: Place, present: u64) -> Option<u64> {
        Some(self.bits(place)).filter(|bits| *bits != present)
    }

    /// Sets the value at a place from bits; bits above its width are ignored.
    fn set_bits(&mut self, place: Place, bits: u64) {
        if let Some(value) = bits.to_le_bytes().get(..place.width.size()) {
            self.store(place, value);
        }
    }
}

/// An image in memory, in which each place is at its [`at`](Place::at). An area may be shorter: places past its end are read as 0 and are
/// not written.
#[derive(Debug)]
pub struct Areas<'a> {
    /// `%I`
    pub inputs: &'a [u8],
    /// `%Q`
    pub outputs: &'a mut [u8],
    /// `%M`
    pub memory: &'a mut [u8],
}

impl ProcessImage for Areas<'_> {
    fn load(&self, place: Place, bytes: &mut [u8]) {
        let area = match place.area {
            Area::Input => self.inputs,
            Area::Output => self.outputs,
            Area::Memory => self.memory,
        };
        let found = area.get(place.at()..).and_then(|it| it.get(..bytes.len()));
        match found {
            Some(found) => bytes.iter_mut().zip(found).for_each(|(byte, it)| *byte = *it),
            None => bytes.fill(0),
        }
    }

    fn store(&mut self, place: Place, bytes: &[u8]) {
        let area = match place.area {
            Area::Input => return,
            Area::Output => &mut *self.outputs,
            Area::Memory => &mut *self.memory,
        };
        if let Some(found) = area.get_mut(place.at()..).and_then(|it| it.get_mut(..bytes.len())) {
            found.iter_mut().zip(bytes).for_each(|(it, byte)| *it = *byte);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_places() {
        let at = |address| Place::parse(address).map(|it| (it.area, it.at()));
        assert_eq!(at("%IX0.0"), Some((Area::Input, 0)));
        assert_eq!(at("%QX1023.7"), Some((Area::Output, 8191)));
        assert_eq!(at("%MB0"), Some((Area::Memory, 8192)));
        assert_eq!(at("%IW1"), Some((Area::Input, 9218)));
        assert_eq!(at("%ID0"), Some((Area::Input, 11_264)));
        assert_eq!(at("%QL1023"), Some((Area::Output, Place::AREA_SIZE - 8)));
        for wrong in ["%IX0", "%IX0.8", "%IX1024.0", "%IW1024", "%IW1.2.3", "%IW", "%ZW1", "IW1", "%IX0.1.2", "%I1", ""]
        {
            assert_eq!(at(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn an_area_may_end_early() {
        let (mut outputs, mut memory) = ([0; 3], [7; 8194]);
        let mut areas = Areas { inputs: &[9], outputs: &mut outputs, memory: &mut memory };
        assert_eq!(areas.bits(Place::new(Area::Input, Width::Bit, 0)), 1);
        assert_eq!(areas.bits(Place::new(Area::Input, Width::Long, 1023)), 0);
        areas.set_bits(Place::new(Area::Output, Width::Bit, 2), 1);
        areas.set_bits(Place::new(Area::Output, Width::Bit, 3), 1);
        areas.set_bits(Place::new(Area::Memory, Width::Byte, 1), 0x1FE);
        areas.set_bits(Place::new(Area::Memory, Width::Word, 0), 1);
        assert_eq!(areas.bits(Place::new(Area::Memory, Width::Byte, 1)), 0xFE);
        assert_eq!(areas.bits(Place::new(Area::Memory, Width::Word, usize::MAX)), 0);
        assert_eq!(outputs, [0, 0, 1]);
    }
}
