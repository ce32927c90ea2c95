//! The lines of GPIO chips in a project file.

use super::named;
use staunch_build::{Gpio, GpioLine, Project};
use staunch_host::{Bias, Map, Pin, PinLine, Remote, check_pins, parse_duration};
use std::time::Duration;

/// The lines, held against the program's variables. An error is a mistake in the project file, with its place.
pub fn pins(project: &Project, remotes: &[Remote], map: &Map) -> Result<Vec<Pin>, String> {
    let place = |number, key: &str, text: String| format!("{}: {text}", project.place_in_table("gpio", number, key));
    let read = |(number, it)| pin(it).map_err(|(key, text)| place(number, key, text));
    let pins: Vec<Pin> = project.gpio.iter().enumerate().map(read).collect::<Result<_, _>>()?;
    check_pins(&pins, remotes, map).map_err(|(number, text)| {
        let name = &pins[number].variable;
        place(number, "variable", format!("`{name}`: {text}"))
    })?;
    Ok(pins)
}

/// An error is the setting that is wrong, and why.
fn pin(gpio: &Gpio) -> Result<Pin, (&'static str, String)> {
    let is_line = |text: &str| !text.is_empty() && !text.contains(char::is_control);
    if !is_line(&gpio.chip) {
        let text = "`chip` is the name of a device in /dev, or its path: chip = \"gpiochip0\"";
        return Err(("chip", text.to_owned()));
    }
    let line = match &gpio.line {
        GpioLine::Number(number) => u32::try_from(*number).ok().map(PinLine::Number),
        GpioLine::Name(name) => is_line(name).then(|| PinLine::Name(name.clone())),
    };
    let line = line.ok_or_else(|| ("line", "`line` is the number of a line, as 17, or its name".to_owned()))?;
    Ok(Pin {
        variable: gpio.variable.clone(),
        chip: gpio.chip.clone(),
        line,
        active_low: gpio.active_low,
        bias: named(&Bias::ALL, gpio.bias.as_deref()).unwrap_or(Bias::AsIs),
        debounce: gpio.debounce.as_deref().map(debounce).transpose()?,
        safe: gpio.safe,
    })
}

/// The kernel counts microseconds in 32 bits.
fn debounce(written: &str) -> Result<Duration, (&'static str, String)> {
    let fail = |text: String| ("debounce", format!("`debounce`: {text}"));
    let nanoseconds = parse_duration(written).map_err(|it| fail(it.to_string()))?;
    let microseconds = u32::try_from(nanoseconds / 1000).ok().filter(|it| *it > 0);
    let microseconds = microseconds.ok_or_else(|| fail(format!("`{written}` is not between 1us and 4294s")))?;
    Ok(Duration::from_micros(microseconds.into()))
}
