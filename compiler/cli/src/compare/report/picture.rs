//! The trace as a picture: the same scans under each system, one above the other, drawn by the host.

use crate::{output, scratch};
use staunch_compare::pair::{Matched, Pair, Row};
use staunch_compare::request::Request;
use staunch_compare::search::trace::Trace;
use staunch_compare::search::world::World;
use staunch_compare::verdict::stimulus;
use staunch_host::{Error, Options};
use std::fmt::Write;
use std::path::Path;

/// Of what differs, so many variables have lanes.
const SHOWN: usize = 12;
/// The line with the system's name above its picture.
const HEADING: f64 = 28.0;

/// Draws the scans up to the difference.
pub fn draw(
    pair: &mut Pair,
    world: &World,
    request: &Request,
    path: &Path,
    (rows, trace): (&[Row], Option<&Trace>),
) -> Result<(), String> {
    let scratch = scratch::folder()?;
    let stimulus = match (&request.stimulus, trace) {
        (Some(given), _) => Some(given.clone()),
        (None, Some(trace)) => {
            let saved = scratch.path().join("trace.csv");
            output::write(&saved, stimulus::text(pair, world, trace).as_bytes())?;
            Some(saved)
        }
        (None, None) => None,
    };
    let differences = rows.last().map_or_else(Vec::new, |it| pair.differences(it));
    let mut pictures = Vec::new();
    for side in 0..2 {
        let svg = scratch.path().join(format!("{side}.svg"));
        let options = Options {
            scans: u64::try_from(rows.len()).ok(),
            cycle: request.cycle,
            stimulus: stimulus.clone(),
            trace: Some(svg.clone()),
            vars: Some(variables(pair, side, &differences)),
            quiet: true,
            ..Options::default()
        };
        let map = staunch_machine::map(&pair.sides[side].program)?;
        match staunch_host::run(pair.sides[side].machine(), &map, &options) {
            // A fault ends the run, and the picture.
            Ok(_) | Err(Error::Fault { .. }) => {}
            Err(error) => return Err(error.to_string()),
        }
        let text = std::fs::read_to_string(&svg).map_err(|it| format!("cannot read {}: {it}", svg.display()))?;
        pictures.push((pair.sides[side].dialect.name(), text));
    }
    output::write(path, stacked(&pictures).as_bytes())
}

/// The inputs and what differs, as this side calls them.
fn variables(pair: &Pair, side: usize, differences: &[Matched]) -> String {
    let inputs = pair.inputs.iter().map(|it| it.scalars);
    let shown = inputs.chain(differences.iter().copied().take(SHOWN));
    shown.map(|it| pair.scalar(side, it[side]).path.clone()).collect::<Vec<_>>().join(",")
}

/// Pictures below one another, each with its name.
fn stacked(pictures: &[(&str, String)]) -> String {
    let width = pictures.iter().map(|it| size(&it.1, "width")).fold(0.0, f64::max);
    let height: f64 = pictures.iter().map(|it| HEADING + size(&it.1, "height")).sum();
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {width:.0} {height:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    let mut y = 0.0;
    for (name, picture) in pictures {
        let _ = writeln!(
            svg,
            "<text x=\"16\" y=\"{:.0}\" font-family=\"monospace\" font-size=\"16\" font-weight=\"700\">{name}</text>",
            y + 20.0
        );
        y += HEADING;
        svg.push_str(&picture.replacen("<svg ", &format!("<svg y=\"{y:.0}\" "), 1));
        y += size(picture, "height");
    }
    svg + "</svg>\n"
}

/// A length of the outermost element.
fn size(svg: &str, name: &str) -> f64 {
    let value = svg.split(&format!(" {name}=\"")).nth(1).and_then(|it| it.split('"').next());
    value.and_then(|it| it.parse().ok()).unwrap_or(0.0)
}
