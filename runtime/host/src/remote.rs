//! A server that a run reads from and writes to, as `staunch.toml` describes it and the map carries it.

use std::time::Duration;

/// A Modbus TCP server (a slave), and which of its coils and registers are which variables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remote {
    /// In messages; that may be the server's address.
    pub name: String,
    /// `192.168.0.20:502`
    pub server: String,
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
        match self.name == self.server {
            true => format!("modbus {}", self.server),
            false => format!("modbus {} ({})", self.name, self.server),
        }
    }

    /// As the map carries it.
    pub fn lines(&self) -> Vec<String> {
        let order = self.word_order.map_or("-", |it| word(&WordOrder::ALL, it));
        let (period, timeout) = (self.period.as_nanos(), self.timeout.as_nanos());
        let loss = word(&OnLoss::ALL, self.on_loss);
        let head =
            format!("remote\t{}\t{}\t{}\t{period}\t{timeout}\t{loss}\t{order}", self.name, self.server, self.unit);
        let variables = self.variables.iter().map(|(name, place)| format!("register\t{name}\t{place}"));
        std::iter::once(head).chain(variables).collect()
    }

    /// The first line of [`lines`](Self::lines), after its first word.
    pub(crate) fn parse<'t>(mut cells: impl Iterator<Item = &'t str>) -> Option<Self> {
        let (name, server) = (cells.next()?.to_owned(), cells.next()?.to_owned());
        let unit = cells.next()?.parse().ok()?;
        let mut time = || Some(Duration::from_nanos(cells.next()?.parse().ok()?));
        let (period, timeout) = (time()?, time()?);
        let on_loss = named(&OnLoss::ALL, cells.next()?)?;
        let word_order = named(&WordOrder::ALL, cells.next()?);
        Some(Self { name, server, unit, period, timeout, on_loss, word_order, variables: Vec::new() })
    }
}
