//! What the command line says of connections.

use crate::remote::{Line, Parity};

/// What a run in real time is connected with.
#[derive(Clone, Debug, Default)]
pub struct Io {
    /// In the order in which they work around a scan: where two write one input, the later one counts.
    pub connections: Vec<Connection>,
    pub at_end: AtEnd,
}

/// One connection, as `--io` names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Connection {
    /// A process image in `/dev/shm`, by its name there.
    SharedMemory(String),
    /// A Modbus TCP server at this address and port.
    Modbus(String),
    /// A Modbus RTU server on a serial line.
    ModbusRtu(SerialUnit),
}

/// A unit on a serial line, as `--io modbus-rtu` names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SerialUnit {
    pub line: Line,
    pub unit: u8,
}

/// What becomes of the outputs when the run ends, also by a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtEnd {
    /// They are 0 and FALSE.
    #[default]
    Zero,
    /// They stay as the last whole scan left them.
    Hold,
}

impl Connection {
    /// As many as one run may have.
    pub const MOST: usize = 8;

    /// What a user writes: `shm:NAME`, `modbus:ADDRESS:PORT` or `modbus-rtu:PORT`.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            Some(("shm", name)) => Self::shared_memory(name),
            Some(("modbus", address)) => Self::modbus(address),
            Some(("modbus-rtu", port)) => SerialUnit::parse(port).map(Self::ModbusRtu),
            _ => Err(format!("`{text}` is not a connection: write shm:NAME, modbus:ADDRESS:PORT or modbus-rtu:PORT")),
        }
    }

    fn shared_memory(name: &str) -> Result<Self, String> {
        let is_name = !name.is_empty() && !name.contains(['/', '\0']) && name != "." && name != "..";
        match is_name {
            true => Ok(Self::SharedMemory(name.to_owned())),
            false => Err(format!("`{name}` is not a name in /dev/shm: write one without `/`, as in shm:plant")),
        }
    }

    fn modbus(address: &str) -> Result<Self, String> {
        match is_address_and_port(address) {
            true => Ok(Self::Modbus(address.to_owned())),
            false => Err(format!("`{address}` is not an address and port: write, for example, modbus:127.0.0.1:502")),
        }
    }
}

impl SerialUnit {
    /// `/dev/ttyUSB0,unit=3,baud-rate=9600,parity=none,stop-bits=2`. The settings may be left out.
    fn parse(text: &str) -> Result<Self, String> {
        let mut parts = text.split(',');
        let port = parts.next().unwrap_or_default();
        if !Line::is_port(port) {
            return Err(format!(
                "`{port}` is not the path of a serial port: write, for example, modbus-rtu:/dev/ttyUSB0"
            ));
        }
        let mut all = Self { line: Line::at(port), unit: 1 };
        parts.try_for_each(|it| all.set(it)).map(|()| all)
    }

    fn set(&mut self, setting: &str) -> Result<(), String> {
        let (key, value) = setting.split_once('=').unwrap_or((setting, ""));
        let wrong = |expected: &str| format!("`{value}` is not {expected}, in `{setting}` of modbus-rtu");
        let number = || value.parse::<u32>().ok();
        match key {
            "unit" => {
                let unit = number().and_then(|it| u8::try_from(it).ok()).filter(|it| Line::UNITS.contains(it));
                self.unit = unit.ok_or_else(|| wrong("a unit from 1 to 247"))?;
            }
            "baud-rate" => {
                let rate = number().filter(|it| Line::BAUD_RATES.contains(it));
                self.line.baud_rate = rate.ok_or_else(|| wrong("a number of bits a second from 300 to 4000000"))?;
            }
            "parity" => {
                let parity = Parity::ALL.iter().find(|it| it.0 == value).map(|it| it.1);
                self.line.parity = parity.ok_or_else(|| wrong("none, even or odd"))?;
            }
            "stop-bits" => {
                let bits = number().and_then(|it| u8::try_from(it).ok()).filter(|it| (1..=2).contains(it));
                self.line.stop_bits = bits.ok_or_else(|| wrong("1 or 2"))?;
            }
            _ => {
                return Err(format!(
                    "modbus-rtu has no setting `{key}`; its settings are unit, baud-rate, parity and stop-bits"
                ));
            }
        }
        Ok(())
    }
}

/// Whether a text is of the form `HOST:PORT`, on one line. What the host's name means is known only when it is connected to.
pub fn is_address_and_port(text: &str) -> bool {
    let parts = text.rsplit_once(':');
    parts.is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
        && !text.contains(char::is_control)
}

/// As on the command line.
impl std::fmt::Display for Connection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::SharedMemory(name) => write!(f, "shm:{name}"),
            Self::Modbus(address) => write!(f, "modbus:{address}"),
            Self::ModbusRtu(it) => write!(f, "modbus-rtu:{},unit={}", it.line.port, it.unit),
        }
    }
}

impl AtEnd {
    pub const ALL: [(&'static str, Self); 2] = [("zero", Self::Zero), ("hold", Self::Hold)];

    /// What a user writes.
    pub fn parse(text: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().find(|it| it.0 == text);
        found
            .map(|it| it.1)
            .ok_or_else(|| format!("`{text}` is not a policy for outputs at the end: write zero or hold"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn connections_are_read_as_they_are_written() {
        for text in ["shm:plant", "modbus:127.0.0.1:502", "modbus:[::1]:0", "modbus:localhost:1502"] {
            assert_eq!(Connection::parse(text).unwrap().to_string(), text);
        }
        for text in ["shm:", "shm:a/b", "shm:..", "modbus:502", "modbus::502", "modbus:host:70000", "opcua:x", "plant"]
        {
            assert!(Connection::parse(text).is_err(), "{text}");
        }
        let port = "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0";
        let line = Line { port: port.to_owned(), baud_rate: 9600, parity: Parity::None, stop_bits: 2 };
        let text = format!("modbus-rtu:{port},stop-bits=2,parity=none,unit=247,baud-rate=9600");
        assert_eq!(Connection::parse(&text), Ok(Connection::ModbusRtu(SerialUnit { line, unit: 247 })));
        for (text, expected) in [
            ("modbus-rtu:ttyS0", "`ttyS0` is not the path of a serial port"),
            ("modbus-rtu:/dev/ttyS0,unit=0", "`0` is not a unit from 1 to 247"),
            ("modbus-rtu:/dev/ttyS0,unit=248", "`248` is not a unit"),
            ("modbus-rtu:/dev/ttyS0,baud-rate=96", "`96` is not a number of bits a second from 300 to 4000000"),
            ("modbus-rtu:/dev/ttyS0,parity=mark", "`mark` is not none, even or odd"),
            ("modbus-rtu:/dev/ttyS0,stop-bits=3", "`3` is not 1 or 2"),
            (
                "modbus-rtu:/dev/ttyS0,baud=9600",
                "no setting `baud`; its settings are unit, baud-rate, parity and stop-bits",
            ),
        ] {
            let refused = Connection::parse(text).unwrap_err();
            assert!(refused.contains(expected), "{refused}");
        }
        assert_eq!(AtEnd::parse("hold"), Ok(AtEnd::Hold));
        assert!(AtEnd::parse("keep").is_err());
    }
}
