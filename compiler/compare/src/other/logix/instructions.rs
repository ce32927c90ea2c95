//! The instructions for one call of a counter block.

/// Counting, then resetting: reset wins.
pub fn up(owner: &str, counts: Option<&str>, resets: Option<&str>) -> Vec<String> {
    let count = counts.map(|it| format!("CTU({owner}, {it})"));
    // A reset that reads the counter is decided before the instruction that counts changes it.
    if let (Some(reset), Some(count)) = (resets.filter(|it| reads(owner, it)), &count) {
        return vec![format!("IF {reset} THEN {count}; RES({owner}, TRUE); ELSE {count}; END_IF")];
    }
    let reset = resets.map(|it| format!("RES({owner}, {it})"));
    count.into_iter().chain(reset).collect()
}

/// Counting, then loading: load wins.
pub fn down(owner: &str, counts: Option<&str>, loads: Option<&str>) -> Vec<String> {
    let count = counts.map(|it| format!("CTD({owner}, {it})"));
    let load = format!("{owner}.ACC := {owner}.PRE");
    if let (Some(condition), Some(count)) = (loads.filter(|it| reads(owner, it)), &count) {
        return vec![format!("IF {condition} THEN {count}; {load}; ELSE {count}; END_IF")];
    }
    let load = loads.map(|it| format!("IF {it} THEN {load}; END_IF"));
    count.into_iter().chain(load).collect()
}

/// Counting both ways, then loading: load wins over counting, and reset over load.
pub fn both(owner: &str, loads: Option<&str>) -> Vec<String> {
    let count = format!("CTUD({owner})");
    let load = format!("{owner}.ACC := {owner}.PRE");
    let Some(condition) = loads else { return vec![count] };
    if reads(owner, condition) {
        let load = format!("IF NOT {owner}.Reset THEN {load}; END_IF");
        return vec![format!("IF {condition} THEN {count}; {load}; ELSE {count}; END_IF")];
    }
    let is_one = condition.chars().all(|it| it.is_ascii_alphanumeric() || it == '_');
    let condition = if is_one { condition.to_owned() } else { format!("({condition})") };
    vec![count, format!("IF {condition} AND NOT {owner}.Reset THEN {load}; END_IF")]
}

/// Whether a condition reads the counter itself.
fn reads(owner: &str, condition: &str) -> bool {
    condition.to_ascii_uppercase().contains(&format!("{}.", owner.to_ascii_uppercase()))
}
