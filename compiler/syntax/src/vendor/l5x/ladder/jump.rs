//! Jumps. A routine with labels has parts, each from a label to the next one, and a number of the part that continues.
//!
//! ```text
//! XIC(a)JMP(done);            R_part := 0;
//! ADD(n,1,n);                 REPEAT
//! LBL(done)OTE(x);                IF a THEN R_part := 1; EXIT; END_IF;
//!                                 n := n + 1;
//!                             UNTIL TRUE END_REPEAT;
//!                             IF R_part <= 1 THEN
//!                                 x [:=] TRUE;
//!                             END_IF;
//! ```
//!
//! Where one leads back, the routine is a loop over its parts:
//!
//! ```text
//! LBL(again)ADD(n,1,n);       R_part := 0;
//! LES(n,5)JMP(again);         WHILE R_part < 2 DO
//!                                 CASE R_part OF
//!                                 0:  R_part := 1;
//!                                 1:  n := n + 1;
//!                                     IF n < 5 THEN R_part := 1; CONTINUE; END_IF;
//!                                     R_part := 2;
//!                                 END_CASE;
//!                             END_WHILE;
//! ```

use super::parse::{Element, Mistake, Path};
use super::subroutine::each;
use super::text::Text;
use rustc_hash::FxHashMap;

/// The parts of a routine, by the labels that they begin with.
#[derive(Debug)]
pub struct Parts {
    numbers: FxHashMap<String, usize>,
    pub count: usize,
    pub form: Form,
}

/// How the parts follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Nothing jumps.
    Straight,
    /// All jumps lead on.
    On,
    /// Some lead back.
    Loop,
}

impl Parts {
    pub fn of(rungs: &[Text], paths: &[Result<Path, Mistake>]) -> Self {
        let mut parts = Self { numbers: FxHashMap::default(), count: 1, form: Form::Straight };
        let mut jumps = Vec::new();
        for (text, path) in rungs.iter().zip(paths) {
            let Ok(path) = path else { continue };
            if let Some(label) = label(text, path) {
                parts.numbers.entry(label).or_insert(parts.count);
                parts.count += 1;
            }
            each(path, &mut |it| {
                let is_jump = text.text[it.name.clone()].eq_ignore_ascii_case("JMP");
                let to = it.operands.first().filter(|_| is_jump);
                jumps.extend(to.map(|it| (parts.count - 1, text.text[it.clone()].to_owned())));
            });
        }
        for (from, to) in jumps {
            let leads_on = parts.number(&to).is_none_or(|to| to > from);
            match (parts.form, leads_on) {
                (_, false) => parts.form = Form::Loop,
                (Form::Straight, true) => parts.form = Form::On,
                (Form::On | Form::Loop, true) => {}
            }
        }
        parts
    }

    pub fn number(&self, label: &str) -> Option<usize> {
        self.numbers.get(&label.to_ascii_lowercase()).copied()
    }

    /// What begins the first part.
    pub fn first(&self, part: &str) -> String {
        match self.form {
            Form::Straight => String::new(),
            Form::On => format!("{part} := 0;\nREPEAT\n"),
            Form::Loop => format!("{part} := 0;\nWHILE {part} < {} DO\nCASE {part} OF\n0:\n", self.count),
        }
    }

    /// What ends a part and begins the next one.
    pub fn next(&self, part: &str, number: usize, leaves: bool) -> String {
        match self.form {
            Form::Straight => String::new(),
            Form::On => format!("{}IF {part} <= {number} THEN\nREPEAT\n", end_of_part(number)),
            Form::Loop if leaves => format!("{number}:\n"),
            Form::Loop => format!("{part} := {number};\n{number}:\n"),
        }
    }

    /// What ends the last part.
    pub fn last(&self, part: &str, leaves: bool) -> String {
        match self.form {
            Form::Straight => String::new(),
            Form::On => end_of_part(self.count).to_owned(),
            Form::Loop if leaves => "END_CASE;\nEND_WHILE;\n".to_owned(),
            Form::Loop => format!("{part} := {};\nEND_CASE;\nEND_WHILE;\n", self.count),
        }
    }

    /// What continues in another part.
    pub fn jump(&self, part: &str, to: usize) -> String {
        let leave = if self.form == Form::Loop { "CONTINUE" } else { "EXIT" };
        format!("{part} := {to}; {leave}")
    }
}

/// What ends a part before the one with this number: the first one is not in an IF.
fn end_of_part(number: usize) -> &'static str {
    if number == 1 { "UNTIL TRUE END_REPEAT;\n" } else { "UNTIL TRUE END_REPEAT;\nEND_IF;\n" }
}

/// The label that a rung begins with.
pub fn label(text: &Text, path: &Path) -> Option<String> {
    let Some(Element::Instruction(first)) = path.first() else { return None };
    let [operand] = first.operands.as_slice() else { return None };
    let is_label = text.text[first.name.clone()].eq_ignore_ascii_case("LBL");
    is_label.then(|| text.text[operand.clone()].to_ascii_lowercase())
}
