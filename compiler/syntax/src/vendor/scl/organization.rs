//! What starts an organization block. A source does not name it; TIA Portal writes a title and inputs that only blocks of one kind have.

use super::Scl;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// It runs in each cycle, as OB 1.
    Cycle,
    /// It runs before the first cycle, as OB 100.
    StartUp,
    Unknown,
}

/// The names that TIA Portal and STEP 7 give, the titles, and an input that no other kind has.
const KINDS: [(Event, &[&str], &str, &str); 2] = [
    (Event::Cycle, &["main", "ob1"], "main program sweep", "remanence"),
    (Event::StartUp, &["startup", "ob100"], "complete restart", "lostretentive"),
];

/// That of the block at the next token.
pub fn event(scl: &Scl<'_>, name: &str) -> Event {
    let is_body = |at: &usize| scl.is(*at, "BEGIN") || scl.is(*at, "END_ORGANIZATION_BLOCK");
    let head: Vec<usize> = (scl.at..scl.tokens.len()).take_while(|at| !is_body(at)).collect();
    let title = head.iter().find(|at| scl.is(**at, "TITLE")).map_or("", |at| {
        let start = scl.place(*at).start;
        scl.file[start..].lines().next().unwrap_or_default()
    });
    let declares = |input: &str| head.iter().any(|at| scl.is(*at, input) && scl.declares(*at));
    let (name, title) = (name.to_ascii_lowercase(), title.to_ascii_lowercase());
    let is_it = |(_, names, known, input): &&(Event, &[&str], &str, &str)| {
        names.contains(&name.as_str()) || title.contains(known) || declares(input)
    };
    KINDS.iter().find(is_it).map_or(Event::Unknown, |it| it.0)
}
