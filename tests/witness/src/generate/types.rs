//! The types of a random program, and what can be reached inside of them.

use crate::places::pin_type;
use crate::types::Elementary;
use staunch_runtime::{BLOCKS, BlockInfo, Direction};

#[derive(Clone, Debug, PartialEq)]
pub enum Ty {
    Bool,
    /// A row of [`NUMBERS`].
    Number(usize),
    /// BYTE to LWORD.
    Bits(usize),
    Time,
    /// A row of [`DATES`].
    Date(usize),
    /// A STRING of this capacity.
    Text(usize),
    /// A WSTRING.
    Wide(usize),
    /// CHAR, or WCHAR.
    Char(bool),
    Color,
    Level(usize),
    Array(usize),
    Record(usize),
    Union(usize),
    /// An instance of the program's own block of this number.
    Instance(usize),
    /// An instance of a standard block: a row of the runtime's table.
    Standard(usize),
    /// What leads to a variable of a type.
    Pointer(Box<Self>),
    /// A variable of the program's interface.
    Interface,
}

pub struct Number {
    pub name: &'static str,
    pub elementary: Elementary,
    pub literals: [&'static str; 7],
}

pub const NUMBERS: [Number; 10] = [
    Number { name: "SINT", elementary: Elementary::Sint, literals: ["-128", "127", "0", "1", "2", "7", "100"] },
    Number { name: "INT", elementary: Elementary::Int, literals: ["-32768", "32767", "0", "1", "2", "-7", "100"] },
    Number {
        name: "DINT",
        elementary: Elementary::Dint,
        literals: ["-2147483648", "2147483647", "0", "1", "2", "-7", "100"],
    },
    Number {
        name: "LINT",
        elementary: Elementary::Lint,
        literals: ["-9223372036854775808", "9223372036854775807", "0", "1", "2", "-7", "100"],
    },
    Number { name: "USINT", elementary: Elementary::Usint, literals: ["255", "254", "0", "1", "2", "7", "100"] },
    Number { name: "UINT", elementary: Elementary::Uint, literals: ["65535", "65534", "0", "1", "2", "7", "100"] },
    Number { name: "UDINT", elementary: Elementary::Udint, literals: ["4294967295", "1", "0", "1", "2", "7", "100"] },
    Number {
        name: "ULINT",
        elementary: Elementary::Ulint,
        literals: ["18446744073709551615", "1", "0", "1", "2", "7", "100"],
    },
    Number {
        name: "REAL",
        elementary: Elementary::Real,
        literals: ["0.0", "1.0", "-1.5", "3.25", "1.0e9", "16777216.0", "0.1"],
    },
    Number {
        name: "LREAL",
        elementary: Elementary::Lreal,
        literals: ["0.0", "1.0", "-1.5", "3.25", "1.0e30", "16777217.0", "0.1"],
    },
];

/// A day, a time of day, and points in time.
pub const DATES: [(&str, Elementary); 6] = [
    ("DATE", Elementary::Date),
    ("TOD", Elementary::Tod),
    ("DT", Elementary::Dt),
    ("LDT", Elementary::Ldt),
    ("LDATE", Elementary::Ldate),
    ("LTOD", Elementary::Ltod),
];

pub const BITS: [&str; 4] = ["BYTE", "WORD", "DWORD", "LWORD"];
const BIT_TYPES: [Elementary; 4] = [Elementary::Byte, Elementary::Word, Elementary::Dword, Elementary::Lword];

impl Ty {
    pub fn elementary(&self) -> Option<Elementary> {
        match self {
            Self::Bool => Some(Elementary::Bool),
            Self::Number(at) => Some(NUMBERS[*at].elementary),
            Self::Bits(at) => Some(BIT_TYPES[*at]),
            Self::Time => Some(Elementary::Time),
            Self::Date(at) => Some(DATES[*at].1),
            Self::Char(wide) => Some(if *wide { Elementary::Wchar } else { Elementary::Char }),
            Self::Text(_)
            | Self::Wide(_)
            | Self::Color
            | Self::Level(_)
            | Self::Array(_)
            | Self::Record(_)
            | Self::Union(_)
            | Self::Instance(_)
            | Self::Standard(_)
            | Self::Pointer(_)
            | Self::Interface => None,
        }
    }

    fn of(elementary: Elementary) -> Option<Self> {
        let number = NUMBERS.iter().position(|it| it.elementary == elementary).map(Self::Number);
        let bits = || BIT_TYPES.iter().position(|it| *it == elementary).map(Self::Bits);
        match elementary {
            Elementary::Bool => Some(Self::Bool),
            Elementary::Time => Some(Self::Time),
            _ => number.or_else(bits),
        }
    }

    pub fn is_integer(&self) -> bool {
        matches!(self, Self::Number(at) if *at < 8)
    }

    /// Whether it is a WSTRING, or a STRING.
    pub fn is_text(&self, wide: bool) -> bool {
        if wide { matches!(self, Self::Wide(_)) } else { matches!(self, Self::Text(_)) }
    }

    pub fn is_signed(&self) -> bool {
        matches!(self, Self::Number(0..=3 | 8 | 9))
    }

    pub fn is_real(&self) -> bool {
        matches!(self, Self::Number(8 | 9))
    }
}

/// A step on the way to a part of a variable.
#[derive(Clone, Debug)]
pub enum Piece {
    Member(String),
    /// `^`
    Deref,
    /// An index for each pair of bounds.
    Index(Vec<(i64, i64)>),
}

/// What can be reached from a variable.
#[derive(Clone, Debug)]
pub struct Shape {
    pub pieces: Vec<Piece>,
    pub ty: Ty,
    pub writable: bool,
    /// Whether it is reached by a reference, so that its address is another's.
    pub through: bool,
    /// Whether it is a standard block's, and has no address.
    pub is_pin: bool,
    /// Whether it shares its bytes, and has no address of its own.
    pub is_shared: bool,
}

#[derive(Default)]
pub struct Catalogue {
    /// Whether references are written as CODESYS does.
    pub codesys: bool,
    /// Base, and bounds.
    pub levels: Vec<(usize, i64, i64)>,
    pub arrays: Vec<(Vec<(i64, i64)>, Ty)>,
    pub records: Vec<Vec<(String, Ty)>>,
    pub unions: Vec<Vec<(String, Ty)>>,
    /// The inputs and outputs of the program's own blocks: name, type, and whether it is an input.
    pub blocks: Vec<Vec<(String, Ty, bool)>>,
    /// The properties of each block, its base's too.
    pub properties: Vec<Vec<(String, Ty)>>,
    /// The block that each extends.
    pub bases: Vec<Option<usize>>,
}

impl Catalogue {
    pub fn name(&self, ty: &Ty) -> String {
        match ty {
            Ty::Bool => "BOOL".to_owned(),
            Ty::Number(at) => NUMBERS[*at].name.to_owned(),
            Ty::Bits(at) => BITS[*at].to_owned(),
            Ty::Time => "TIME".to_owned(),
            Ty::Date(at) => DATES[*at].0.to_owned(),
            Ty::Text(capacity) => format!("STRING[{capacity}]"),
            Ty::Wide(capacity) => format!("WSTRING[{capacity}]"),
            Ty::Char(wide) => if *wide { "WCHAR" } else { "CHAR" }.to_owned(),
            Ty::Color => "Color".to_owned(),
            Ty::Level(at) => format!("Level{at}"),
            Ty::Array(at) => format!("List{at}"),
            Ty::Record(at) => format!("Rec{at}"),
            Ty::Union(at) => format!("Uni{at}"),
            Ty::Instance(at) => format!("Blk{at}"),
            Ty::Standard(at) => standard_name(&BLOCKS[*at]),
            Ty::Interface => "IDo".to_owned(),
            Ty::Pointer(to) => format!("{} {}", if self.codesys { "POINTER TO" } else { "REF_TO" }, self.name(to)),
        }
    }

    /// Whether a block is another, or extends it.
    pub fn is_heir(&self, block: usize, of: usize) -> bool {
        block == of || self.bases.get(block).copied().flatten().is_some_and(|it| self.is_heir(it, of))
    }

    /// Whether a value of the type can be copied.
    pub fn is_value(&self, ty: &Ty) -> bool {
        match ty {
            Ty::Instance(_) | Ty::Standard(_) => false,
            Ty::Array(at) => self.is_value(&self.arrays[*at].1),
            Ty::Record(at) => self.records[*at].iter().all(|(_, ty)| self.is_value(ty)),
            Ty::Bool | Ty::Number(_) | Ty::Bits(_) | Ty::Time | Ty::Text(_) | Ty::Color | Ty::Level(_) => true,
            Ty::Date(_) | Ty::Wide(_) | Ty::Char(_) | Ty::Union(_) | Ty::Pointer(_) | Ty::Interface => true,
        }
    }

    /// Whether a value of the type can share its bytes with others.
    pub fn is_shareable(&self, ty: &Ty) -> bool {
        match ty {
            Ty::Bool | Ty::Number(_) | Ty::Bits(_) | Ty::Time | Ty::Color | Ty::Union(_) => true,
            Ty::Array(at) => self.is_shareable(&self.arrays[*at].1),
            Ty::Record(at) => self.records[*at].iter().all(|(_, ty)| self.is_shareable(ty)),
            Ty::Date(_) | Ty::Text(_) | Ty::Wide(_) | Ty::Char(_) => true,
            Ty::Level(_) | Ty::Instance(_) | Ty::Standard(_) => false,
            Ty::Pointer(_) | Ty::Interface => false,
        }
    }

    /// The variable itself and all its parts.
    pub fn shapes(&self, ty: &Ty) -> Vec<Shape> {
        let mut shapes = vec![Shape {
            pieces: Vec::new(),
            ty: ty.clone(),
            writable: true,
            through: false,
            is_pin: false,
            is_shared: false,
        }];
        let within = |piece: Piece, ty: &Ty, writable: bool, shapes: &mut Vec<Shape>| {
            for mut shape in self.shapes(ty) {
                shape.pieces.insert(0, piece.clone());
                shape.writable &= writable;
                shapes.push(shape);
            }
        };
        match ty {
            Ty::Array(at) => {
                let (bounds, element) = &self.arrays[*at];
                within(Piece::Index(bounds.clone()), element, true, &mut shapes);
            }
            Ty::Record(at) => {
                for (name, ty) in &self.records[*at] {
                    within(Piece::Member(name.clone()), ty, true, &mut shapes);
                }
            }
            Ty::Union(at) => {
                for (name, ty) in &self.unions[*at] {
                    within(Piece::Member(name.clone()), ty, true, &mut shapes);
                }
                shapes.iter_mut().skip(1).for_each(|it| it.is_shared = true);
            }
            Ty::Instance(at) => {
                for (name, ty, is_input) in &self.blocks[*at] {
                    within(Piece::Member(name.clone()), ty, *is_input, &mut shapes);
                }
                for (name, ty) in &self.properties[*at] {
                    let pieces = vec![Piece::Member(name.clone())];
                    shapes.push(Shape {
                        pieces,
                        ty: ty.clone(),
                        writable: false,
                        through: true,
                        is_pin: false,
                        is_shared: false,
                    });
                }
            }
            Ty::Standard(at) => {
                for (name, ty, is_input) in pins(*at) {
                    within(Piece::Member(name), &ty, is_input, &mut shapes);
                }
                shapes.iter_mut().skip(1).for_each(|it| it.is_pin = true);
            }
            Ty::Pointer(to) => {
                within(Piece::Deref, to, true, &mut shapes);
                shapes.iter_mut().skip(1).for_each(|it| it.through = true);
            }
            Ty::Bool | Ty::Number(_) | Ty::Bits(_) | Ty::Time | Ty::Text(_) | Ty::Color | Ty::Level(_) => {}
            Ty::Date(_) | Ty::Wide(_) | Ty::Char(_) | Ty::Interface => {}
        }
        shapes
    }
}

/// The inputs and outputs of a standard block: name, type, and whether it is an input.
pub fn pins(block: usize) -> Vec<(String, Ty, bool)> {
    let info = &BLOCKS[block];
    let mut found = Vec::new();
    for (at, pin) in info.pins.iter().enumerate() {
        let ty = pin_type(info, at).elementary().and_then(Ty::of);
        if let (Some(ty), Direction::Input | Direction::Output) = (ty, pin.direction) {
            found.push((pin.name.to_owned(), ty, pin.direction == Direction::Input));
        }
    }
    found
}

/// Blocks that stand for themselves: not those of an option, or with a variable outside of them.
pub fn standard_blocks() -> Vec<usize> {
    let fits = |it: &BlockInfo| {
        // The operation that advances time in tests is not part of the language.
        let is_hidden = it.name.starts_with("__");
        !is_hidden
            && it.facts.option.is_none()
            && it.facts.kept.is_none()
            && !it.name.starts_with("LT")
            && !it.name.starts_with("FBD_")
            // The witness does not look at what a TIMER has before it times.
            && it.name != "TIMER"
    };
    (0..BLOCKS.len()).filter(|at| fits(&BLOCKS[*at])).collect()
}

fn standard_name(info: &BlockInfo) -> String {
    format!("{}.{}", info.family.name(), info.name)
}
