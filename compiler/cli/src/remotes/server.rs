//! How the settings say a server is reached: at an address of the network, or by a serial line.

use super::named;
use staunch_build::Modbus;
use staunch_host::{Line, Parity, Remote, Server, is_address_and_port};

/// An error is the setting that is wrong, and why.
pub fn of(modbus: &Modbus) -> Result<Server, (String, String)> {
    match (&modbus.server, &modbus.port) {
        (Some(_), Some(_)) => {
            let text = "a server has an address or a serial port, and not both: remove `server` or `port`";
            Err(("port".to_owned(), text.to_owned()))
        }
        (_, Some(port)) => line(modbus, port).map(Server::Serial),
        (Some(server), None) => at_address(modbus, server),
        (None, None) => unreachable!("the project file was checked for one of both"),
    }
}

fn at_address(modbus: &Modbus, server: &str) -> Result<Server, (String, String)> {
    if !is_address_and_port(server) {
        let text = format!(
            "`{server}` is not an address and port: write, for example, server = \"192.168.0.20:502\", or port = \
             \"/dev/ttyUSB0\" for a serial line"
        );
        return Err(("server".to_owned(), text));
    }
    let of_line = [
        ("baud-rate", modbus.baud_rate.is_some()),
        ("parity", modbus.parity.is_some()),
        ("data-bits", modbus.data_bits.is_some()),
        ("stop-bits", modbus.stop_bits.is_some()),
    ];
    match of_line.iter().find(|it| it.1) {
        Some((key, _)) => {
            let text = format!("`{key}` is a setting of a serial line: write port = \"/dev/ttyUSB0\" and not `server`");
            Err(((*key).to_owned(), text))
        }
        None => Ok(Server::Tcp(server.to_owned())),
    }
}

fn line(modbus: &Modbus, port: &str) -> Result<Line, (String, String)> {
    let fail = |key: &str, text: String| (key.to_owned(), text);
    if !Line::is_port(port) {
        let text = format!("`{port}` is not the path of a serial port: write, for example, port = \"/dev/ttyUSB0\"");
        return Err(fail("port", text));
    }
    let usual = Line::at(port);
    let baud_rate = modbus.baud_rate.unwrap_or(usual.baud_rate.into());
    let baud_rate = u32::try_from(baud_rate).ok().filter(|it| Line::BAUD_RATES.contains(it)).ok_or_else(|| {
        let (least, most) = (Line::BAUD_RATES.start(), Line::BAUD_RATES.end());
        fail(
            "baud-rate",
            format!("`baud-rate` must be a number from {least} to {most}, such as 9600 or 19200, not {baud_rate}"),
        )
    })?;
    if let Some(bits) = modbus.data_bits.filter(|it| *it != 8) {
        return Err(fail("data-bits", format!("Modbus RTU has 8 data bits, not {bits}: `data-bits` can be left out")));
    }
    let stop_bits = match modbus.stop_bits {
        None => usual.stop_bits,
        Some(1) => 1,
        Some(2) => 2,
        Some(other) => return Err(fail("stop-bits", format!("`stop-bits` must be 1 or 2, not {other}"))),
    };
    let parity = named(&Parity::ALL, modbus.parity.as_deref()).unwrap_or(usual.parity);
    Ok(Line { baud_rate, parity, stop_bits, ..usual })
}

/// The unit: on a serial line, 0 stands for all units, none of which answers, and from 248 on numbers are reserved.
pub fn unit(modbus: &Modbus, server: &Server) -> Result<u8, (String, String)> {
    let (least, most) = match server {
        Server::Tcp(_) => (0, 255),
        Server::Serial(_) => (*Line::UNITS.start(), *Line::UNITS.end()),
    };
    let unit = modbus.unit.unwrap_or(1);
    u8::try_from(unit).ok().filter(|it| (least..=most).contains(it)).ok_or_else(|| {
        let place = if least == 0 { "" } else { " on a serial line" };
        ("unit".to_owned(), format!("`unit` is a number from {least} to {most}{place}, not {unit}"))
    })
}

/// A port has one speed for all units. An error is the number of the second table, and what is wrong.
pub fn check_lines(remotes: &[Remote]) -> Result<(), (usize, String)> {
    let lines = || {
        let line = |(number, it): (usize, &Remote)| match &it.server {
            Server::Serial(line) => Some((number, line.clone())),
            Server::Tcp(_) => None,
        };
        remotes.iter().enumerate().filter_map(line)
    };
    for (number, line) in lines() {
        if let Some((_, first)) = lines().find(|it| it.1.port == line.port).filter(|it| it.1 != line) {
            let (port, one, other) = (&line.port, line.settings(), first.settings());
            return Err((
                number,
                format!("`{port}` has {one} here, and {other} above: all units of a line share them"),
            ));
        }
    }
    Ok(())
}
