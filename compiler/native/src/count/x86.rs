//! How long each instruction of x86-64 is, and where control goes after it: as far as the code generator makes them. An
//! instruction that is not known here is not guessed.

use super::flow::{Flow, Instruction};

/// What follows the first bytes of an instruction.
struct Shape {
    has_operand: bool,
    immediate: usize,
}

const fn plain(immediate: usize) -> Option<Shape> {
    Some(Shape { has_operand: false, immediate })
}

const fn operand(immediate: usize) -> Option<Shape> {
    Some(Shape { has_operand: true, immediate })
}

/// What comes before the operation.
#[derive(Default)]
struct Prefixes {
    /// 66: operands of 16 bits.
    narrow: bool,
    /// REX with its bit W: operands of 64 bits.
    wide: bool,
}

/// The instruction at `at`; `None` if it is not known.
pub(crate) fn instruction(code: &[u8], at: usize) -> Option<Instruction> {
    let mut next = at;
    let mut prefixes = Prefixes::default();
    loop {
        match code.get(next)? {
            0x66 => prefixes.narrow = true,
            // Of reals; segments, as in long instructions that do nothing; LOCK.
            0xF2 | 0xF3 | 0x2E | 0x3E | 0x64 | 0x65 | 0xF0 => {}
            _ => break,
        }
        next += 1;
    }
    let rex = code.get(next)?;
    if rex & 0xF0 == 0x40 {
        prefixes.wide = rex & 8 != 0;
        next += 1;
    }
    let first = *code.get(next)?;
    let (shape, operation, next) = match first {
        0x0F => two_bytes(code, next + 1)?,
        _ => (one_byte(first, *code.get(next + 1).unwrap_or(&0), &prefixes)?, u16::from(first), next + 1),
    };
    let operand = if shape.has_operand { operand_length(code, next)? } else { 0 };
    let selector = code.get(next).map_or(0, |it| it >> 3 & 7);
    let end = next + operand + shape.immediate;
    let immediate = code.get(end - shape.immediate..end)?;
    Some(Instruction { at, end, flow: flow(operation, selector, immediate, end)? })
}

/// Operations of one byte. `then` is the next byte, which for some says which of several they are.
fn one_byte(operation: u8, then: u8, prefixes: &Prefixes) -> Option<Shape> {
    let number = if prefixes.narrow { 2 } else { 4 };
    let is_test = then >> 3 & 7 < 2;
    match operation {
        0x00..=0x3F => match operation & 7 {
            0..=3 => operand(0),
            4 => plain(1),
            5 => plain(number),
            _ => None,
        },
        0x50..=0x5F | 0x90..=0x99 | 0xC3 | 0xC9 | 0xCC => plain(0),
        0x63 => operand(0),
        0x68 | 0xA9 => plain(number),
        0x69 | 0x81 | 0xC7 => operand(number),
        0x6A | 0xA8 | 0xB0..=0xB7 | 0xEB => plain(1),
        0x6B | 0x80 | 0x83 | 0xC0 | 0xC1 | 0xC6 => operand(1),
        0x70..=0x7F => plain(1),
        0x84..=0x8B | 0x8D | 0x8F | 0xD0..=0xD3 | 0xFE | 0xFF => operand(0),
        0xB8..=0xBF => plain(if prefixes.wide { 8 } else { number }),
        0xE8 | 0xE9 => plain(4),
        0xF6 => operand(usize::from(is_test)),
        0xF7 => operand(if is_test { number } else { 0 }),
        // Among others the moves of whole strings, which a prefix repeats.
        _ => None,
    }
}

/// Operations after 0F, from the byte that says which; with the place of the operand.
fn two_bytes(code: &[u8], at: usize) -> Option<(Shape, u16, usize)> {
    let second = *code.get(at)?;
    let shape = match second {
        // Of three bytes.
        0x38 => return Some((operand(0)?, 0x0F38, at + 2)),
        0x3A => return Some((operand(1)?, 0x0F3A, at + 2)),
        0x0B | 0x77 | 0xA2 | 0xC8..=0xCF => plain(0),
        0x80..=0x8F => plain(4),
        0x70..=0x73 | 0xA4 | 0xAC | 0xBA | 0xC2 | 0xC4..=0xC6 => operand(1),
        0x10..=0x1F | 0x28..=0x2F | 0x40..=0x6F | 0x74..=0x76 | 0x7E | 0x7F | 0x90..=0x9F => operand(0),
        0xA3 | 0xA5 | 0xAB | 0xAD..=0xB1 | 0xB3 | 0xB6..=0xB8 | 0xBB..=0xC1 | 0xD0..=0xFE => operand(0),
        _ => None,
    }?;
    Some((shape, 0x0F00 | u16::from(second), at + 1))
}

/// The bytes that say where an operand is, from the first of them.
fn operand_length(code: &[u8], at: usize) -> Option<usize> {
    let form = *code.get(at)?;
    let (mode, base) = (form >> 6, form & 7);
    if mode == 3 {
        return Some(1);
    }
    let scaled = if base == 4 { Some(*code.get(at + 1)?) } else { None };
    let has_no_base = scaled.map_or(base, |it| it & 7) == 5;
    let distance = match mode {
        0 if has_no_base => 4,
        0 => 0,
        1 => 1,
        _ => 4,
    };
    Some(1 + usize::from(scaled.is_some()) + distance)
}

fn flow(operation: u16, selector: u8, immediate: &[u8], end: usize) -> Option<Flow> {
    Some(match operation {
        0x70..=0x7F | 0x0F80..=0x0F8F => Flow::Branch(target(immediate, end)?),
        0xE9 | 0xEB => Flow::Jump(target(immediate, end)?),
        0xE8 => Flow::Call,
        0xFF if selector == 2 => Flow::Call,
        0xFF if selector == 4 => Flow::Table,
        0xC3 | 0xCC | 0x0F0B => Flow::Ends,
        _ => Flow::Next,
    })
}

/// Where a jump by a distance from its end leads to.
fn target(distance: &[u8], end: usize) -> Option<usize> {
    let distance = match distance {
        [it] => isize::from(it.cast_signed()),
        other => isize::try_from(i32::from_le_bytes(other.try_into().ok()?)).ok()?,
    };
    end.checked_add_signed(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As GNU's assembler writes them.
    #[test]
    fn instructions_have_their_lengths() {
        let known: [&[u8]; 24] = [
            &[0x55],
            &[0x48, 0x89, 0xE5],
            &[0x48, 0x83, 0xEC, 0x10],
            &[0x66, 0xC7, 0x46, 0x08, 0x05, 0x00],
            &[0xC7, 0x84, 0x24, 0x80, 0, 0, 0, 1, 0, 0, 0],
            &[0x49, 0xB8, 1, 2, 3, 4, 5, 6, 7, 8],
            &[0xB8, 1, 0, 0, 0],
            &[0x0F, 0xB6, 0x07],
            &[0x4C, 0x8B, 0x1D, 0, 0, 0, 0],
            &[0x42, 0x8B, 0x04, 0x8D, 0, 0, 0, 0],
            &[0x8B, 0x44, 0x8F, 0x04],
            &[0xF2, 0x0F, 0x58, 0xC1],
            &[0xF3, 0x0F, 0x10, 0x05, 0, 0, 0, 0],
            &[0x66, 0x0F, 0x3A, 0x0B, 0xC0, 0x03],
            &[0x66, 0x0F, 0x38, 0x17, 0xC0],
            &[0x48, 0x0F, 0xAF, 0xC2],
            &[0x6B, 0xC0, 0x64],
            &[0x69, 0xC0, 0xE8, 0x03, 0, 0],
            &[0xF6, 0xC1, 0x01],
            &[0x48, 0xF7, 0xF9],
            &[0xF7, 0xC1, 1, 0, 0, 0],
            &[0x48, 0xC1, 0xE0, 0x05],
            &[0x0F, 0x94, 0xC0],
            &[0x66, 0x0F, 0x1F, 0x44, 0, 0],
        ];
        for bytes in known {
            let mut code = bytes.to_vec();
            code.extend([0x90; 16]);
            let found = instruction(&code, 0);
            let expected = Instruction { at: 0, end: bytes.len(), flow: Flow::Next };
            assert_eq!(found, Some(expected), "{bytes:02X?}");
        }
    }

    #[test]
    fn control_goes_where_it_is_led() {
        let flow = |bytes: &[u8]| instruction(bytes, 0).map(|it| it.flow);
        assert_eq!(flow(&[0x74, 0x10]), Some(Flow::Branch(18)));
        assert_eq!(flow(&[0xEB, 0xFE]), Some(Flow::Jump(0)));
        assert_eq!(flow(&[0xE9, 5, 0, 0, 0]), Some(Flow::Jump(10)));
        assert_eq!(flow(&[0x0F, 0x85, 0xFA, 0xFF, 0xFF, 0xFF]), Some(Flow::Branch(0)));
        assert_eq!(flow(&[0xE8, 0, 0, 0, 0]), Some(Flow::Call));
        assert_eq!(flow(&[0xFF, 0xD0]), Some(Flow::Call));
        assert_eq!(flow(&[0x41, 0xFF, 0xE3]), Some(Flow::Table));
        assert_eq!(flow(&[0xC3]), Some(Flow::Ends));
        assert_eq!(flow(&[0x0F, 0x0B]), Some(Flow::Ends));
        // A repeated move, a jump back before the start, and an instruction that is cut off.
        assert_eq!(flow(&[0xF3, 0xA4]), None);
        assert_eq!(flow(&[0xEB, 0x80]), None);
        assert_eq!(flow(&[0x48, 0xB8, 1, 2]), None);
    }
}
