//! What a project of OpenPLC Editor says of its device: the board, and the pins and points that its addresses are. They
//! change nothing of what the program does.

/// Programs for this board are compiled by the runtime, by MATIEC.
const RUNTIME_3: &str = "OpenPLC Runtime v3";

/// What is known from some or all files of a project.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Device {
    /// Whether an editor from v4.2 on has written it, which compiles by STruC++.
    pub is_strucpp: bool,
    pub board: Option<String>,
    pub pins: Vec<Pin>,
}

/// An address, and what it is outside.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pin {
    /// Of which board it is, where the file keeps those of several.
    pub board: Option<String>,
    /// As it is on the board; nothing for a point of another device.
    pub pin: Option<String>,
    pub alias: Option<String>,
    pub address: String,
}

impl Device {
    /// Adds what another file of the project says.
    pub fn merge(&mut self, other: Self) {
        self.is_strucpp |= other.is_strucpp;
        self.board = self.board.take().or(other.board);
        self.pins.extend(other.pins);
    }

    /// The dialect of OpenPLC that compiles the project.
    pub fn dialect(&self) -> &'static str {
        let is_newer = self.is_strucpp && self.board.as_deref() != Some(RUNTIME_3);
        if is_newer { "openplc4" } else { "openplc" }
    }

    /// The address that an alias stands for.
    pub fn address(&self, alias: &str) -> Option<&str> {
        let is_it = |it: &&Pin| it.alias.as_deref().is_some_and(|it| it.eq_ignore_ascii_case(alias));
        self.own_pins().find(is_it).map(|it| it.address.as_str())
    }

    /// What is known of an address: `pin 7 (Start)`.
    pub fn label(&self, address: &str) -> Option<String> {
        let wanted = normal(address);
        let pin = self.own_pins().find(|it| normal(&it.address) == wanted)?;
        match (&pin.pin, &pin.alias) {
            (Some(number), Some(alias)) => Some(format!("pin {number} ({alias})")),
            (Some(number), None) => Some(format!("pin {number}")),
            (None, alias) => alias.clone(),
        }
    }

    /// Those of the board that the project is for.
    fn own_pins(&self) -> impl Iterator<Item = &Pin> {
        self.pins.iter().filter(|it| it.board.is_none() || it.board == self.board)
    }
}

/// `%I0.0` is `%IX0.0`.
pub fn normal(address: &str) -> String {
    let address = address.to_ascii_uppercase();
    match address.get(..2).zip(address.get(2..)) {
        Some((area, rest)) if rest.starts_with(|it: char| it.is_ascii_digit()) => format!("{area}X{rest}"),
        Some(_) | None => address,
    }
}
