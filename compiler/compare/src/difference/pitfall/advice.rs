//! What to do about a pitfall, by the direction of the move: what keeps a count on one system loses it on another.
//! Each text is proved in each of its directions, by the cases of `tests/compare/advice.txt`.

mod form;
mod own;
mod texts;

pub use form::{Counting, Form, Rules};

use super::list::{Pitfall, said_of};
use form::Advice;
use staunch_frontend::Dialect::{self, Codesys, Cscape, Iec, Logix, Openplc, Openplc4, Siemens};
use texts::{BLOCKS, FALLING, RISES, TO_LOGIX};

/// Where no text is proved.
const OWN: &str = "No rewrite has been proved for this direction and this kind of counter: rewrite it yourself, and compare that \
     with `--against`.";

fn all() -> impl Iterator<Item = &'static Advice> {
    BLOCKS.iter().chain(FALLING).chain(RISES).chain(TO_LOGIX)
}

impl Pitfall {
    /// What to do on the system that the program moves to.
    pub fn advice(self, from: Dialect, to: Dialect, counting: Counting) -> String {
        let is_of_counting = !Self::OF_MORE.contains(&self);
        let mut texts: Vec<&str> = said(self.number(), from, to, counting).map(|it| it.text).collect();
        texts.dedup();
        if texts.is_empty() || is_of_counting && counting.is_partial {
            let own = own::text(counting).filter(|_| is_of_counting);
            return own.unwrap_or_else(|| OWN.to_owned());
        }
        let text = said_of([from, to], &texts.join(" "));
        match to {
            Cscape | Codesys => text.replace("R := ", "RESET := ").replace("LD := ", "LOAD := "),
            Iec | Openplc | Openplc4 | Logix | Siemens => text,
        }
    }
}

fn said(pitfall: usize, from: Dialect, to: Dialect, counting: Counting) -> impl Iterator<Item = &'static Advice> {
    let found = all().filter(move |it| it.pitfalls.contains(&pitfall) && it.is_for(counting));
    found.filter(move |it| it.from.contains(&from) && it.to.contains(&to))
}

#[cfg(test)]
mod tests {
    use super::{Advice, Dialect, Form, all};

    const CASES: &str = include_str!("../../../../cli/tests/compare/advice.txt");

    /// Whether a case has the advice for a pitfall, a direction and a kind of counter.
    fn is_proved(it: &Advice, pitfall: usize, from: Dialect, to: Dialect, form: Option<Form>) -> bool {
        CASES.split("\n\n").any(|case| {
            let Some(head) = case.lines().find_map(|it| it.strip_prefix("trap ")) else { return false };
            let (number, rest) = head.split_once(": ").expect("a trap");
            let mut parts = rest.split("; ");
            let (directions, name) = (parts.next().expect("directions"), parts.last());
            let (a, b) = directions.split_once(" -> ").expect("two sides");
            let has = |list: &str, dialect: Dialect| list.split(", ").any(|it| it == dialect.name());
            let instruction = form.map_or("", |it| match it {
                Form::Up => "CTU",
                Form::Down => "CTD",
                Form::UpDown => "CTUD",
            });
            let mut words = case.split(|it: char| !it.is_ascii_alphanumeric());
            let sets = |value: &str| case.contains(&format!("setting openplc4-cd-edge = \"{value}\""));
            let is_set = it.rises.is_none_or(|rises| rises == sets("rising"));
            let counts = instruction.is_empty() || words.any(|it| it == instruction);
            number == pitfall.to_string() && name == Some(it.name) && has(a, from) && has(b, to) && counts && is_set
        })
    }

    #[test]
    fn each_text_has_a_case_in_each_direction() {
        let mut missing = Vec::new();
        for it in all() {
            for pitfall in it.pitfalls.iter().copied() {
                let directions = it.from.iter().flat_map(|from| it.to.iter().map(move |to| (*from, *to)));
                for (from, to) in directions.filter(|(from, to)| from != to) {
                    let forms: Vec<Option<Form>> = match it.forms {
                        [] => vec![None],
                        forms => forms.iter().copied().map(Some).collect(),
                    };
                    for form in forms.into_iter().filter(|form| !is_proved(it, pitfall, from, to, *form)) {
                        missing.push(format!("trap {pitfall}: {} -> {}; {} {form:?}", from.name(), to.name(), it.name));
                    }
                }
            }
        }
        assert!(missing.is_empty(), "not proved:\n{}", missing.join("\n"));
    }
}
