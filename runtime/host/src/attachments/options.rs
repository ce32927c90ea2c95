//! What the command line says of connections.

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

    /// What a user writes: `shm:NAME` or `modbus:ADDRESS:PORT`.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            Some(("shm", name)) => Self::shared_memory(name),
            Some(("modbus", address)) => Self::modbus(address),
            _ => Err(format!("`{text}` is not a connection: write shm:NAME or modbus:ADDRESS:PORT")),
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
            .ok_or_else(|| format!("`{text}` is nothing that outputs do at the end: there are zero and hold"))
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
        assert_eq!(AtEnd::parse("hold"), Ok(AtEnd::Hold));
        assert!(AtEnd::parse("keep").is_err());
    }
}
