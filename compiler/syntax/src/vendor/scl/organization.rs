//! What starts an organization block. A source does not name it; TIA Portal writes a title and inputs that only blocks of one kind have.

use super::{Event, Scl};

/// The names that TIA Portal and STEP 7 give, the titles, and an input that no other kind has.
const KINDS: [(Event, &[&str], &str, &str); 2] = [
    (Event::Cycle, &["main", "ob1"], "main program sweep", "remanence"),
    (Event::StartUp, &["startup", "ob100"], "complete restart", "lostretentive"),
];

impl Scl<'_> {
    /// What starts the organization block at the next token.
    pub fn event(&self, name: &str) -> Event {
        let is_body = |at: &usize| self.is(*at, "BEGIN") || self.is(*at, "END_ORGANIZATION_BLOCK");
        let head: Vec<usize> = (self.at..self.tokens.len()).take_while(|at| !is_body(at)).collect();
        let title = head.iter().find(|at| self.is(**at, "TITLE")).map_or("", |at| {
            let start = self.place(*at).start;
            self.file[start..].lines().next().unwrap_or_default()
        });
        let declares = |input: &str| head.iter().any(|at| self.is(*at, input) && self.declares(*at));
        let (name, title) = (name.to_ascii_lowercase(), title.to_ascii_lowercase());
        let is_it = |(_, names, known, input): &&(Event, &[&str], &str, &str)| {
            names.contains(&name.as_str()) || title.contains(known) || declares(input)
        };
        KINDS.iter().find(is_it).map_or(Event::Unknown, |it| it.0)
    }
}
