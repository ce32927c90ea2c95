//! Requests of Modbus and their answers, as "MODBUS Application Protocol Specification V1.1b3" has them.

use super::registers::{Registers, Table};

/// The codes of functions.
pub(super) mod function {
    pub const READ_COILS: u8 = 1;
    pub const READ_DISCRETE_INPUTS: u8 = 2;
    pub const READ_HOLDING_REGISTERS: u8 = 3;
    pub const READ_INPUT_REGISTERS: u8 = 4;
    pub const WRITE_COIL: u8 = 5;
    pub const WRITE_REGISTER: u8 = 6;
    pub const WRITE_COILS: u8 = 15;
    pub const WRITE_REGISTERS: u8 = 16;
    pub const WRITE_AND_READ_REGISTERS: u8 = 23;
    /// The highest bit of the function of an answer that says what is wrong.
    pub const WRONG: u8 = 0x80;
}

pub(super) const MOST_BITS_READ: usize = 2000;
pub(super) const MOST_BITS_WRITTEN: usize = 1968;
pub(super) const MOST_READ: usize = 125;
pub(super) const MOST_WRITTEN: usize = 123;
const MOST_WRITTEN_AND_READ: usize = 121;

/// What is wrong with a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Exception {
    Function = 1,
    Address = 2,
    Value = 3,
}

/// Appends the answer to a request, both without the header. A refused request has changed nothing.
pub(super) fn answer(request: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) {
    let start = answer.len();
    let (function, rest) = request.split_first().map_or((0, request), |(function, rest)| (*function, rest));
    answer.push(function);
    if let Err(exception) = carry_out(function, rest, registers, answer) {
        answer.truncate(start);
        answer.extend([function | function::WRONG, exception as u8]);
    }
}

fn carry_out(function: u8, rest: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    match function {
        function::READ_COILS => read_bits(Table::Coils, rest, registers, answer),
        function::READ_DISCRETE_INPUTS => read_bits(Table::Discrete, rest, registers, answer),
        function::READ_HOLDING_REGISTERS => read_registers(Table::Holding, rest, registers, answer),
        function::READ_INPUT_REGISTERS => read_registers(Table::Input, rest, registers, answer),
        function::WRITE_COIL => write_coil(rest, registers, answer),
        function::WRITE_REGISTER => write_register(rest, registers, answer),
        function::WRITE_COILS => write_coils(rest, registers, answer),
        function::WRITE_REGISTERS => write_registers(rest, registers, answer),
        function::WRITE_AND_READ_REGISTERS => write_and_read(rest, registers, answer),
        _ => Err(Exception::Function),
    }
}

/// Two numbers of 16 bits, and what follows.
fn pair(bytes: &[u8]) -> Result<(usize, usize, &[u8]), Exception> {
    match bytes {
        [a, b, c, d, rest @ ..] => Ok((number(*a, *b), number(*c, *d), rest)),
        _ => Err(Exception::Value),
    }
}

fn number(high: u8, low: u8) -> usize {
    usize::from(u16::from_be_bytes([high, low]))
}

/// A first number and a count from 1 to `most`, of a request that ends there.
fn range(bytes: &[u8], most: usize) -> Result<(usize, usize), Exception> {
    match pair(bytes)? {
        (first, count, []) if (1..=most).contains(&count) => Ok((first, count)),
        _ => Err(Exception::Value),
    }
}

fn found(registers: &Registers, table: Table, first: usize, count: usize) -> Result<&[u16], Exception> {
    registers.read(table, first, count).ok_or(Exception::Address)
}

fn read_bits(table: Table, rest: &[u8], registers: &Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    let (first, count) = range(rest, MOST_BITS_READ)?;
    let bits = found(registers, table, first, count)?;
    answer.push(count.div_ceil(8) as u8);
    let byte = |bits: &[u16]| bits.iter().rev().fold(0, |byte, bit| byte << 1 | (*bit as u8 & 1));
    answer.extend(bits.chunks(8).map(byte));
    Ok(())
}

fn read_registers(table: Table, rest: &[u8], registers: &Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    let (first, count) = range(rest, MOST_READ)?;
    show(found(registers, table, first, count)?, answer);
    Ok(())
}

fn show(values: &[u16], answer: &mut Vec<u8>) {
    answer.push((2 * values.len()) as u8);
    answer.extend(values.iter().flat_map(|it| it.to_be_bytes()));
}

fn write_coil(rest: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    const ON: usize = 0xFF00;
    let (at, value) = match pair(rest)? {
        (at, value @ (0 | ON), []) => (at, u16::from(value == ON)),
        _ => return Err(Exception::Value),
    };
    found(registers, Table::Coils, at, 1)?;
    registers.write(Table::Coils, at, std::iter::once(value));
    answer.extend(rest);
    Ok(())
}

fn write_register(rest: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    let (at, value) = match pair(rest)? {
        (at, value, []) => (at, value as u16),
        _ => return Err(Exception::Value),
    };
    found(registers, Table::Holding, at, 1)?;
    registers.write(Table::Holding, at, std::iter::once(value));
    answer.extend(rest);
    Ok(())
}

/// A first number, a count, and as many bytes as `size` makes of the count, which must be there exactly.
fn written(bytes: &[u8], most: usize, size: impl Fn(usize) -> usize) -> Result<(usize, usize, &[u8]), Exception> {
    match pair(bytes)? {
        (first, count, [length, values @ ..])
            if (1..=most).contains(&count) && usize::from(*length) == size(count) && values.len() == size(count) =>
        {
            Ok((first, count, values))
        }
        _ => Err(Exception::Value),
    }
}

fn write_coils(rest: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    let (first, count, values) = written(rest, MOST_BITS_WRITTEN, |it| it.div_ceil(8))?;
    found(registers, Table::Coils, first, count)?;
    let bits = (0..count).map(|at| u16::from(values[at / 8] >> (at % 8) & 1));
    registers.write(Table::Coils, first, bits);
    answer.extend(&rest[..4]);
    Ok(())
}

fn write_registers(rest: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    let (first, count, values) = written(rest, MOST_WRITTEN, |it| 2 * it)?;
    found(registers, Table::Holding, first, count)?;
    registers.write(Table::Holding, first, words(values));
    answer.extend(&rest[..4]);
    Ok(())
}

/// The registers that are read are those after the write.
fn write_and_read(rest: &[u8], registers: &mut Registers, answer: &mut Vec<u8>) -> Result<(), Exception> {
    let (from, wanted, rest) = pair(rest)?;
    let (first, count, values) = written(rest, MOST_WRITTEN_AND_READ, |it| 2 * it)?;
    if !(1..=MOST_READ).contains(&wanted) {
        return Err(Exception::Value);
    }
    found(registers, Table::Holding, from, wanted)?;
    found(registers, Table::Holding, first, count)?;
    registers.write(Table::Holding, first, words(values));
    show(found(registers, Table::Holding, from, wanted)?, answer);
    Ok(())
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u16> {
    bytes.chunks_exact(2).map(|it| u16::from_be_bytes([it[0], it[1]]))
}

#[cfg(test)]
mod tests;
