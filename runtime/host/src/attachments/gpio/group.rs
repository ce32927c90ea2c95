//! Which lines are requested together, and what is wrong with others.

use crate::attachments::client::{input_places, values};
use crate::attachments::options::AtEnd;
use crate::attachments::points::{Area, Point, Points, Width};
use crate::attachments::safe::points_of;
use crate::map::Map;
use crate::pin::{Bias, Pin, PinLine};
use crate::remote::Remote;
use std::collections::HashSet;
use std::time::Duration;

/// As many lines may be requested together.
const MOST: usize = 64;

/// Lines of a chip with the same settings.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub chip: String,
    pub is_output: bool,
    pub active_low: bool,
    pub bias: Bias,
    pub debounce: Option<Duration>,
    pub lines: Vec<Place>,
}

#[derive(Clone, Debug)]
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "only Linux has lines"))]
pub(super) struct Place {
    pub line: PinLine,
    /// Its number among the points.
    pub point: usize,
    /// Of an output, what it is before the first scan.
    pub initial: bool,
}

impl Group {
    /// The bits that outputs take if a scan does not end, and of which lines they are.
    pub fn at_emergency(&self, safe: &[Option<bool>], at_end: AtEnd) -> (u64, u64) {
        let all = self.lines.iter().enumerate().filter(|_| self.is_output);
        all.fold((0, 0), |(bits, mask), (at, it)| match (safe[it.point], at_end) {
            (Some(safe), _) => (bits | u64::from(safe) << at, mask | 1 << at),
            (None, AtEnd::Zero) => (bits, mask | 1 << at),
            (None, AtEnd::Hold) => (bits, mask),
        })
    }
}

#[derive(Debug)]
pub(super) struct Planned {
    pub points: Vec<Point>,
    pub safe: Vec<Option<bool>>,
    pub groups: Vec<Group>,
}

/// What is wrong with the lines of a program: the number of one, from 0, and why.
pub fn check_pins(pins: &[Pin], remotes: &[Remote], map: &Map) -> Result<(), (usize, String)> {
    let points = points_of(map);
    let planned = plan(pins, map, &points)?;
    let others: HashSet<_> = remotes.iter().flat_map(|it| input_places(it, map, &points)).collect();
    let is_other = |it: &Point| it.area == Area::Input && others.contains(&(it.offset(), it.bit()));
    match planned.points.iter().position(is_other) {
        Some(at) => Err((at, "a Modbus server writes the same input".to_owned())),
        None => Ok(()),
    }
}

/// The point with a number is that of the pin with the number.
pub(super) fn plan(pins: &[Pin], map: &Map, points: &Points) -> Result<Planned, (usize, String)> {
    let mut planned = Planned { points: Vec::new(), safe: Vec::new(), groups: Vec::new() };
    for (number, pin) in pins.iter().enumerate() {
        let point = checked(pin, &pins[..number], map, points, &planned.points).map_err(|text| (number, text))?;
        let safe = pin.safe.or(point.safe.map(|it| it != 0));
        let place = Place { line: pin.line.clone(), point: number, initial: safe.unwrap_or(false) };
        let is_output = point.area == Area::Output;
        let group = planned.groups.iter_mut().find(|it| {
            it.chip == pin.chip
                && (it.is_output, it.active_low, it.bias, it.debounce)
                    == (is_output, pin.active_low, pin.bias, pin.debounce)
                && it.lines.len() < MOST
        });
        match group {
            Some(group) => group.lines.push(place),
            None => planned.groups.push(Group {
                chip: pin.chip.clone(),
                is_output,
                active_low: pin.active_low,
                bias: pin.bias,
                debounce: pin.debounce,
                lines: vec![place],
            }),
        }
        planned.points.push(point);
        planned.safe.push(safe);
    }
    Ok(planned)
}

/// The one bit that a line is.
fn checked(pin: &Pin, before: &[Pin], map: &Map, points: &Points, others: &[Point]) -> Result<Point, String> {
    let found = values(map, points, &pin.variable)?;
    let point = match found.as_slice() {
        [one] if one.width == Width::Bit => *one,
        [_] => return Err("a line is one bit: use a BOOL, at %IX or %QX".to_owned()),
        all => return Err(format!("it has {} values, and a line is one: name one of them", all.len())),
    };
    if before.iter().any(|it| it.chip == pin.chip && it.line == pin.line) {
        return Err(format!("line {} of {} has another variable, too", pin.line, pin.chip));
    }
    if others.iter().any(|it| (it.offset(), it.bit()) == (point.offset(), point.bit())) {
        return Err("it has another line, too".to_owned());
    }
    match point.area {
        Area::Input if pin.safe.is_some() => {
            Err("it is an input, and `safe` is for outputs: declare it at %QX, or remove `safe`".to_owned())
        }
        Area::Output if pin.safe.is_some() && point.safe.is_some() => {
            Err("it has a value in `[safe]`, too: remove one of both".to_owned())
        }
        Area::Output if pin.debounce.is_some() => {
            Err("it is an output, and `debounce` is for inputs: declare it at %IX, or remove `debounce`".to_owned())
        }
        Area::Input | Area::Output | Area::Memory => Ok(point),
    }
}
