//! A server that a run reads from and writes to, as `staunch.toml` describes it and the map carries it.

use std::time::Duration;

/// A Modbus server (a slave), and which of its coils and registers are which variables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remote {
    /// In messages; that may be the server's address or port.
    pub name: String,
    pub server: Server,
    pub unit: u8,
    /// From one turn of requests to the next.
    pub period: Duration,
    /// How long an answer may take.
    pub timeout: Duration,
    pub on_loss: OnLoss,
    pub word_order: Option<WordOrder>,
    /// A variable or an address, and its place on the server: `input-register 3`.
    pub variables: Vec<(String, String)>,
}

/// How a server is reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Server {
    /// Modbus TCP, at `192.168.0.20:502`.
    Tcp(String),
    /// Modbus RTU. Several units may share the line.
    Serial(Line),
}

/// A serial line, of 8 data bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// `/dev/ttyUSB0`
    pub port: String,
    /// Bits a second.
    pub baud_rate: u32,
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    None,
    Even,
    Odd,
}

/// What becomes of inputs whose server does not answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnLoss {
    /// They stay as they are.
    Hold,
    /// They are 0 and FALSE.
    Safe,
    /// The run ends.
    Fault,
}

/// Which register of a value of several comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordOrder {
    HighFirst,
    LowFirst,
}

impl OnLoss {
    pub const ALL: [(&'static str, Self); 3] = [("hold", Self::Hold), ("safe", Self::Safe), ("fault", Self::Fault)];
}

impl Parity {
    pub const ALL: [(&'static str, Self); 3] = [("none", Self::None), ("even", Self::Even), ("odd", Self::Odd)];
}

impl Server {
    /// The address or port.
    fn place(&self) -> &str {
        match self {
            Self::Tcp(address) => address,
            Self::Serial(line) => &line.port,
        }
    }
}

impl Line {
    pub const BAUD_RATES: std::ops::RangeInclusive<u32> = 300..=4_000_000;
    /// Units that answer: 0 stands for all of them, and from 248 on numbers are reserved.
    pub const UNITS: std::ops::RangeInclusive<u8> = 1..=247;

    /// With the settings that are usual for Modbus RTU: "MODBUS over Serial Line V1.02", 2.5.1.
    pub fn at(port: &str) -> Self {
        Self { port: port.to_owned(), baud_rate: 19200, parity: Parity::Even, stop_bits: 1 }
    }

    /// Whether a text is a path, on one line.
    pub fn is_port(text: &str) -> bool {
        text.starts_with('/') && !text.contains(char::is_control)
    }

    /// What a message shows of it: `19200 baud, parity even, 1 stop bit`.
    pub fn settings(&self) -> String {
        let (parity, plural) = (word(&Parity::ALL, self.parity), if self.stop_bits == 1 { "" } else { "s" });
        format!("{} baud, parity {parity}, {} stop bit{plural}", self.baud_rate, self.stop_bits)
    }
}

impl WordOrder {
    pub const ALL: [(&'static str, Self); 2] = [("high-first", Self::HighFirst), ("low-first", Self::LowFirst)];
}

fn word<T: Copy + PartialEq>(all: &[(&'static str, T)], value: T) -> &'static str {
    all.iter().find(|it| it.1 == value).map_or("-", |it| it.0)
}

fn named<T: Copy>(all: &[(&'static str, T)], word: &str) -> Option<T> {
    all.iter().find(|it| it.0 == word).map(|it| it.1)
}

impl Remote {
    /// As messages name it.
    pub(crate) fn label(&self) -> String {
        let place = match &self.server {
            Server::Tcp(address) => address.clone(),
            Server::Serial(line) => format!("{} unit {}", line.port, self.unit),
        };
        match self.name == self.server.place() {
            true => format!("modbus {place}"),
            false => format!("modbus {} ({place})", self.name),
        }
    }

    /// As the map carries it.
    pub fn lines(&self) -> Vec<String> {
        let order = self.word_order.map_or("-", |it| word(&WordOrder::ALL, it));
        let (period, timeout) = (self.period.as_nanos(), self.timeout.as_nanos());
        let (place, loss) = (self.server.place(), word(&OnLoss::ALL, self.on_loss));
        let mut head = format!("remote\t{}\t{place}\t{}\t{period}\t{timeout}\t{loss}\t{order}", self.name, self.unit);
        if let Server::Serial(line) = &self.server {
            let parity = word(&Parity::ALL, line.parity);
            head += &format!("\t{}\t{parity}\t{}", line.baud_rate, line.stop_bits);
        }
        let variables = self.variables.iter().map(|(name, place)| format!("register\t{name}\t{place}"));
        std::iter::once(head).chain(variables).collect()
    }

    /// The first line of [`lines`](Self::lines), after its first word.
    pub(crate) fn parse<'t>(mut cells: impl Iterator<Item = &'t str>) -> Option<Self> {
        let (name, place) = (cells.next()?.to_owned(), cells.next()?.to_owned());
        let unit = cells.next()?.parse().ok()?;
        let mut time = || Some(Duration::from_nanos(cells.next()?.parse().ok()?));
        let (period, timeout) = (time()?, time()?);
        let on_loss = named(&OnLoss::ALL, cells.next()?)?;
        let word_order = named(&WordOrder::ALL, cells.next()?);
        let server = match cells.next() {
            Some(baud_rate) => Server::Serial(Line {
                port: place,
                baud_rate: baud_rate.parse().ok()?,
                parity: named(&Parity::ALL, cells.next()?)?,
                stop_bits: cells.next()?.parse().ok()?,
            }),
            None => Server::Tcp(place),
        };
        Some(Self { name, server, unit, period, timeout, on_loss, word_order, variables: Vec::new() })
    }
}
