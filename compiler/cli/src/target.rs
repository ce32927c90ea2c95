//! The machine that native code is made for.

use crate::args::Opt;
use staunch_native::{Aim, Target};

/// By its name, or this one.
pub fn of(name: Option<&str>, opt: Opt) -> Result<Target, String> {
    let target = match name {
        Some(name) => Target::parse(name),
        None => Target::host(),
    };
    Ok(target.map_err(|it| it.to_string())?.aiming_at(match opt {
        Opt::Speed => Aim::Speed,
        Opt::Size => Aim::Size,
    }))
}
