//! The variables of a program at a server whose memory is laid out as that of OpenPLC's runtime.

use super::plan::values;
use crate::attachments::points::{Area, Points};
use crate::attachments::registers::place;
use crate::map::Map;
use crate::remote::Remote;
use std::collections::HashSet;

/// The inputs and outputs that have a place there, each by its address with that place: `%QX1.1`, `coil 9`. Variables that a server's own
/// entries name are left out.
pub fn openplc_layout(map: &Map, remotes: &[Remote]) -> Vec<(String, String)> {
    let points = Points::of(map);
    let named = remotes.iter().flat_map(|it| &it.variables).filter_map(|(name, _)| values(map, &points, name).ok());
    let mut used: HashSet<_> = named.flatten().map(|it| (it.offset(), it.bit())).collect();
    let mut all = Vec::new();
    let (globals, _) = map.globals();
    for address in globals.iter().filter_map(|it| it.address.as_ref()) {
        let Ok(found) = values(map, &points, address) else { continue };
        // An input that shares the bits of another one is read with that.
        let is_read_with_other = found.iter().any(|it| it.view && it.area == Area::Input);
        let Some((table, number)) = found.first().and_then(place).filter(|_| !is_read_with_other) else { continue };
        if found.iter().all(|it| used.insert((it.offset(), it.bit()))) {
            all.push((address.clone(), format!("{} {number}", table.name())));
        }
    }
    all
}
