//! Requests and answers of a client, which a link carries in its frames.

use super::link::Link;
use super::plan::{Kind, Request};
use super::trouble::Trouble;
use crate::attachments::pdu::function;
use crate::attachments::registers::Table;
use crate::remote::Remote;

/// The longest request or answer: "MODBUS Application Protocol Specification V1.1b3", 4.1.
const MOST: usize = 253;

/// A connection.
#[derive(Debug)]
pub(super) struct Wire {
    link: Link,
    request: Vec<u8>,
    answer: Vec<u8>,
}

impl Wire {
    pub fn connect(remote: &Remote) -> Result<Self, Trouble> {
        let link = Link::connect(&remote.server, remote.timeout)?;
        Ok(Self { link, request: Vec::with_capacity(MOST), answer: Vec::with_capacity(MOST) })
    }

    /// Adds what the server has to the values that are written: each a point, bits, and which these are.
    pub fn read(
        &mut self,
        remote: &Remote,
        request: &Request,
        all: &mut Vec<(usize, u64, u64)>,
    ) -> Result<(), Trouble> {
        let code = match request.table {
            Table::Coils => function::READ_COILS,
            Table::Discrete => function::READ_DISCRETE_INPUTS,
            Table::Input => function::READ_INPUT_REGISTERS,
            Table::Holding => function::READ_HOLDING_REGISTERS,
        };
        self.begin(code, request.first);
        self.request.extend(request.count.to_be_bytes());
        let count = usize::from(request.count);
        let bytes = if request.table.is_bits() { count.div_ceil(8) } else { 2 * count };
        let values = match self.exchange(remote, request)? {
            [length, values @ ..] if usize::from(*length) == bytes && values.len() == bytes => values,
            _ => return Err(Trouble::Failed("the answer has another length than was asked for".to_owned())),
        };
        let register = |at: usize| u64::from(u16::from_be_bytes([values[2 * at], values[2 * at + 1]]));
        all.extend(request.parts.iter().map(|it| match it.kind {
            Kind::Coil => (it.point, u64::from(values[it.at / 8] >> (it.at % 8) & 1), u64::MAX),
            Kind::Bit(bit) => (it.point, register(it.at) >> bit & 1, u64::MAX),
            Kind::Register => (it.point, register(it.at) << it.shift, 0xFFFF << it.shift),
        }));
        Ok(())
    }

    /// Writes the values of points. One coil or register is written by the function that every server has.
    pub fn write(&mut self, remote: &Remote, request: &Request, values: &[u64]) -> Result<(), Trouble> {
        let mut registers = vec![0u16; usize::from(request.count)];
        for it in &request.parts {
            registers[it.at] = (values[it.point] >> it.shift) as u16;
        }
        match (request.table.is_bits(), registers.as_slice()) {
            (true, [one]) => {
                self.begin(function::WRITE_COIL, request.first);
                self.request.extend(if *one == 0 { [0, 0] } else { [0xFF, 0] });
            }
            (false, [one]) => {
                self.begin(function::WRITE_REGISTER, request.first);
                self.request.extend(one.to_be_bytes());
            }
            (true, coils) => {
                self.begin(function::WRITE_COILS, request.first);
                self.request.extend(request.count.to_be_bytes());
                self.request.push(coils.len().div_ceil(8) as u8);
                let byte = |it: &[u16]| it.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit != 0));
                self.request.extend(coils.chunks(8).map(byte));
            }
            (false, registers) => {
                self.begin(function::WRITE_REGISTERS, request.first);
                self.request.extend(request.count.to_be_bytes());
                self.request.push((2 * registers.len()) as u8);
                self.request.extend(registers.iter().flat_map(|it| it.to_be_bytes()));
            }
        }
        self.exchange(remote, request).map(drop)
    }

    fn begin(&mut self, code: u8, first: u16) {
        self.request.clear();
        self.request.push(code);
        self.request.extend(first.to_be_bytes());
    }

    /// Sends the request, and returns what follows the function in its answer.
    fn exchange(&mut self, remote: &Remote, request: &Request) -> Result<&[u8], Trouble> {
        self.answer.clear();
        self.link.exchange(remote.unit, remote.timeout, &self.request, &mut self.answer)?;
        let code = self.request[0];
        match self.answer.as_slice() {
            [it, rest @ ..] if *it == code => Ok(rest),
            [it, reason, ..] if *it == code | function::WRONG => Err(Trouble::Refused(refusal(request, *reason))),
            _ => Err(Trouble::Failed("the answer does not fit the request".to_owned())),
        }
    }
}

/// What a server says, in the words of "MODBUS Application Protocol Specification V1.1b3", 7.
fn refusal(request: &Request, code: u8) -> String {
    let meaning = match code {
        1 => "illegal function",
        2 => "illegal data address",
        3 => "illegal data value",
        4 => "server device failure",
        5 => "acknowledge",
        6 => "server device busy",
        10 => "gateway path unavailable",
        11 => "gateway target device failed to respond",
        _ => "an unknown code",
    };
    let last = request.first.saturating_add(request.count - 1);
    format!("the server refuses {} {} to {last}: {meaning} ({code})", request.table.name(), request.first)
}
