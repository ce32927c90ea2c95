//! A line of a GPIO chip and its variable, as `staunch.toml` describes it and the map carries it.

use std::time::Duration;

/// A line of a GPIO chip, and the variable that is read from it or written to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pin {
    /// A variable or an address.
    pub variable: String,
    /// `gpiochip0`, or the path of its device.
    pub chip: String,
    pub line: PinLine,
    /// TRUE is the low level.
    pub active_low: bool,
    pub bias: Bias,
    /// How long an input has to keep its level.
    pub debounce: Option<Duration>,
    /// What an output is before the first scan and at the end, whatever the command line says.
    pub safe: Option<bool>,
}

/// How a line is named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PinLine {
    Number(u32),
    /// The name that the board's description gives it: `GPIO17`.
    Name(String),
}

/// The resistor at a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bias {
    /// As it is.
    AsIs,
    PullUp,
    PullDown,
    Disabled,
}

impl Bias {
    pub const ALL: [(&'static str, Self); 4] =
        [("as-is", Self::AsIs), ("pull-up", Self::PullUp), ("pull-down", Self::PullDown), ("disabled", Self::Disabled)];
}

impl std::fmt::Display for PinLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "\"{name}\""),
        }
    }
}

impl Pin {
    /// As the map carries it.
    pub fn record(&self) -> String {
        let line = match &self.line {
            PinLine::Number(number) => format!("number\t{number}"),
            PinLine::Name(name) => format!("name\t{name}"),
        };
        let level = if self.active_low { "low" } else { "high" };
        let bias = Bias::ALL.iter().find(|it| it.1 == self.bias).map_or("-", |it| it.0);
        let debounce = self.debounce.map_or(0, |it| it.as_micros());
        let safe = self.safe.map_or("-", |it| if it { "TRUE" } else { "FALSE" });
        format!("gpio\t{}\t{}\t{line}\t{level}\t{bias}\t{debounce}\t{safe}", self.variable, self.chip)
    }

    /// [`record`](Self::record), after its first word.
    pub(crate) fn parse<'t>(mut cells: impl Iterator<Item = &'t str>) -> Option<Self> {
        let (variable, chip) = (cells.next()?.to_owned(), cells.next()?.to_owned());
        let line = match (cells.next()?, cells.next()?) {
            ("number", number) => PinLine::Number(number.parse().ok()?),
            ("name", name) => PinLine::Name(name.to_owned()),
            _ => return None,
        };
        let active_low = cells.next()? == "low";
        let bias = cells.next()?;
        let bias = Bias::ALL.iter().find(|it| it.0 == bias)?.1;
        let debounce = Some(cells.next()?.parse().ok()?).filter(|it| *it > 0).map(Duration::from_micros);
        let safe = match cells.next()? {
            "TRUE" => Some(true),
            "FALSE" => Some(false),
            _ => None,
        };
        Some(Self { variable, chip, line, active_low, bias, debounce, safe })
    }
}
