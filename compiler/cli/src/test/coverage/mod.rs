//! What tests execute: statements, branches, and the conditions that were shown to decide (MC/DC).

mod annotated;
mod lcov;
mod table;
mod text;

use crate::output;
use crate::session::Session;
use staunch_frontend::{CoverageKind, CoveragePoint, Decision, Span};
use staunch_ir::layout::{Layout, usize_of};
use staunch_ir::{Location, Program, Type};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use text::Extent;

/// The counts of a program's points, summed over its runs.
#[derive(Debug)]
pub struct Counts {
    /// Where the globals begin in the state of the program as it was compiled.
    globals: u64,
    /// For each point its offset among the globals, and its counts.
    points: Vec<(u64, Vec<u64>)>,
}

impl Counts {
    pub fn of(program: &Program, points: &[CoveragePoint]) -> Self {
        let layout = Layout::new(program);
        let fields = &program.structure(program.globals).fields;
        let count = |it: &CoveragePoint| {
            let rows = match fields[it.field.index()].ty {
                Type::Array(id) => usize::try_from(program.array(id).high + 1).unwrap_or(0),
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Struct(_)
                | Type::Block(_) => 1,
            };
            (layout.field(program.globals, it.field), vec![0; rows])
        };
        Self { globals: layout.machine.globals, points: points.iter().map(count).collect() }
    }

    /// Adds what a run has left in the state.
    pub fn add(&mut self, state: &[u8]) {
        self.add_at(self.globals, state);
    }

    /// As [`add`](Self::add), where the globals begin elsewhere: in a program with fewer instances.
    pub fn add_at(&mut self, globals: u64, state: &[u8]) {
        for (offset, counts) in &mut self.points {
            let from = usize_of(globals + *offset);
            let (words, _) = state.get(from..).unwrap_or_default().as_chunks::<4>();
            counts.iter_mut().zip(words).for_each(|(count, word)| *count += u64::from(u32::from_ne_bytes(*word)));
        }
    }
}

/// What is known of the sources.
#[derive(Debug, Default)]
pub struct Coverage {
    points: BTreeMap<Key, (CoveragePoint, Vec<u64>)>,
}

/// A point in the order of the sources; programs with and without the tests have the same.
type Key = (u16, u32, u16, u8, Vec<(u32, u16)>);

fn key(point: &CoveragePoint) -> Key {
    let Location { file, line, column } = point.at;
    let (sort, conditions) = match &point.kind {
        CoverageKind::Statement => (0, Vec::new()),
        CoverageKind::Arm(_) => (1, Vec::new()),
        CoverageKind::Otherwise => (4, Vec::new()),
        CoverageKind::Decision(it) => {
            (if it.branches { 2 } else { 3 }, it.conditions.iter().map(|it| (it.at.line, it.at.column)).collect())
        }
    };
    (file, line, column, sort, conditions)
}

/// One source, as the reports have it.
#[derive(Debug)]
struct File {
    number: u16,
    path: String,
    statements: Vec<(Location, u64)>,
    branches: Vec<Branch>,
    conditions: Vec<Condition>,
}

/// One way on from a place.
#[derive(Clone, Debug)]
struct Branch {
    at: Location,
    /// The condition of an IF or a loop.
    span: Option<Span>,
    way: Way,
    taken: u64,
    /// How often the place was reached, whichever way it then went.
    reached: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// The condition has this value.
    If(bool),
    /// A label of the CASE that begins there holds the value.
    Label(Location),
    /// No label does.
    Otherwise,
}

/// A condition of a decision, by masking MC/DC: it is shown to decide by two evaluations in which it differs,
/// the decision differs, and in each of which the decision would be other if the condition alone were.
#[derive(Clone, Debug)]
struct Condition {
    at: Location,
    /// The number of its decision among those of the file, and its own there, of so many.
    decision: usize,
    number: usize,
    of: usize,
    /// How often it was FALSE, and TRUE, and decided.
    decided: [u64; 2],
    is_shown: bool,
    /// It is alone, and what is said of it as a branch says it all.
    is_branch: bool,
    span: Option<Span>,
}

impl Condition {
    fn text(&self, session: &Session) -> String {
        text_of(session, self.span, self.at, Extent::Condition)
    }

    /// How often it decided when it was TRUE, and when it was FALSE. lcov takes a condition that did both for shown: where the decision
    /// was the same both times, as that of `a XOR b` may be, the second one counts for nothing.
    fn decides(&self) -> [u64; 2] {
        let [no, yes] = self.decided;
        [yes, if self.is_shown || yes == 0 { no } else { 0 }]
    }
}

/// What is written, or as much as its place says of it.
fn text_of(session: &Session, span: Option<Span>, at: Location, extent: Extent) -> String {
    span.map_or_else(|| text::condition(session, at, extent), |it| text::written(session, it))
}

impl Branch {
    /// Not taken; one that was never reached is reported as a statement.
    fn is_open(&self) -> bool {
        self.taken == 0 && (self.reached > 0 || !matches!(self.way, Way::If(_)))
    }
}

impl Coverage {
    pub fn add(&mut self, points: &[CoveragePoint], counts: &Mutex<Counts>) {
        let Ok(counts) = counts.lock() else { return };
        for (point, (_, counted)) in points.iter().zip(&counts.points) {
            let empty = || (point.clone(), vec![0; counted.len()]);
            let (_, sum) = self.points.entry(key(point)).or_insert_with(empty);
            sum.iter_mut().zip(counted).for_each(|(sum, count)| *sum += count);
        }
    }

    fn files(&self, session: &Session) -> Vec<File> {
        let mut files: Vec<File> = Vec::new();
        for (point, counts) in self.points.values() {
            if files.last().is_none_or(|it| it.number != point.at.file) {
                let path = session.sources.get(point.at.file).path.clone();
                let (number, statements) = (point.at.file, Vec::new());
                files.push(File { number, path, statements, branches: Vec::new(), conditions: Vec::new() });
            }
            if let Some(file) = files.last_mut() {
                file.add(point, counts);
            }
        }
        files
    }

    /// Writes what is asked for; what is to be printed.
    pub fn write(&self, session: &Session, wanted: &[PathBuf]) -> Result<String, String> {
        let files = self.files(session);
        let mut text = String::new();
        for path in wanted {
            let written = match form(path)? {
                Form::Table => {
                    text += &table::text(session, &files);
                    continue;
                }
                Form::Lcov => lcov::text(session, &files),
                Form::Page => annotated::page(session, &files),
                Form::Text => annotated::text(session, &files),
            };
            output::write(path, written.as_bytes())?;
        }
        Ok(text)
    }
}

/// How coverage is shown.
enum Form {
    Table,
    Lcov,
    Page,
    Text,
}

fn form(path: &Path) -> Result<Form, String> {
    let ending = path.extension().map(|it| it.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        _ if path == Path::new("table") => Ok(Form::Table),
        "info" => Ok(Form::Lcov),
        "html" => Ok(Form::Page),
        "txt" => Ok(Form::Text),
        _ => Err(format!("--coverage {}: expected `table`, or a file .info, .html or .txt", path.display())),
    }
}

/// Says before the tests run which of these cannot be written after them.
pub fn check(wanted: &[PathBuf]) -> Result<(), String> {
    wanted.iter().try_for_each(|path| match form(path)? {
        Form::Table => Ok(()),
        Form::Lcov | Form::Page | Form::Text => output::check(path),
    })
}

impl File {
    fn add(&mut self, point: &CoveragePoint, counts: &[u64]) {
        let at = point.at;
        let count: u64 = counts.iter().sum();
        match &point.kind {
            CoverageKind::Statement => self.statements.push((at, count)),
            CoverageKind::Arm(case) => {
                self.branches.push(Branch { at, span: None, way: Way::Label(*case), taken: count, reached: count });
            }
            CoverageKind::Otherwise => {
                self.branches.push(Branch { at, span: None, way: Way::Otherwise, taken: count, reached: count });
            }
            CoverageKind::Decision(decision) => self.decision(at, decision, counts),
        }
    }

    fn decision(&mut self, at: Location, decision: &Decision, counts: &[u64]) {
        let rows: Vec<(usize, u64)> = counts.iter().copied().enumerate().filter(|it| it.1 > 0).collect();
        let reached = counts.iter().sum();
        if decision.branches {
            for value in [true, false] {
                let taken = rows.iter().filter(|it| decision.formula.value(it.0) == value).map(|it| it.1).sum();
                self.branches.push(Branch { at, span: decision.span, way: Way::If(value), taken, reached });
            }
        }
        let number_of_decision = self.conditions.last().map_or(0, |it| it.decision + 1);
        for (number, condition) in decision.conditions.iter().enumerate() {
            let value = |row: usize| decision.formula.value(row);
            // The rows in which the condition decides.
            let deciding = |it: &&(usize, u64)| value(it.0) != value(it.0 ^ 1 << number);
            let mut decided = [0, 0];
            let mut outcomes = [[false; 2]; 2];
            for (row, count) in rows.iter().filter(deciding) {
                let own = row >> number & 1;
                decided[own] += count;
                outcomes[own][usize::from(value(*row))] = true;
            }
            let is_shown = outcomes[0][0] && outcomes[1][1] || outcomes[0][1] && outcomes[1][0];
            let of = decision.conditions.len();
            self.conditions.push(Condition {
                at: condition.at,
                decision: number_of_decision,
                number,
                of,
                decided,
                is_shown,
                is_branch: of == 1 && decision.branches,
                span: condition.span,
            });
        }
    }

    /// What is executed, and what there is: statements, branches, conditions.
    fn figures(&self) -> [(usize, usize); 3] {
        [
            (self.statements.iter().filter(|it| it.1 > 0).count(), self.statements.len()),
            (self.branches.iter().filter(|it| it.taken > 0).count(), self.branches.len()),
            (self.conditions.iter().filter(|it| it.is_shown).count(), self.conditions.len()),
        ]
    }

    /// What the tests leave open, in the order of the source, each with its place.
    fn open(&self, session: &Session) -> Vec<(Location, String)> {
        let whole = |it: &Branch| text_of(session, it.span, it.at, Extent::Decision);
        let mut open: Vec<(Location, String)> = Vec::new();
        open.extend(self.statements.iter().filter(|it| it.1 == 0).map(|it| (it.0, "not executed".to_owned())));
        for branch in self.branches.iter().filter(|it| it.is_open()) {
            let what = match branch.way {
                Way::If(true) => format!("never TRUE: {}", whole(branch)),
                Way::If(false) => format!("never FALSE: {}", whole(branch)),
                Way::Label(_) => format!("never chosen: {}", whole(branch)),
                Way::Otherwise => "never without a label that fits".to_owned(),
            };
            open.push((branch.at, what));
        }
        for condition in self.conditions.iter().filter(|it| !it.is_shown && !it.is_branch) {
            open.push((condition.at, format!("not shown to decide: {}", condition.text(session))));
        }
        open.sort_by_key(|it| (it.0.line, it.0.column));
        open
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use staunch_frontend::Formula;

    fn shown(formula: &Formula, conditions: usize, rows: &[usize]) -> Vec<bool> {
        let mut counts = vec![0; 1 << conditions];
        rows.iter().for_each(|it| counts[*it] += 1);
        let condition = staunch_frontend::Condition { at: Location::default(), span: None };
        let conditions = vec![condition; conditions];
        let decision = Decision { branches: true, span: None, conditions, formula: formula.clone() };
        let mut file = File {
            number: 0,
            path: String::new(),
            statements: Vec::new(),
            branches: Vec::new(),
            conditions: Vec::new(),
        };
        file.decision(Location::default(), &decision, &counts);
        file.conditions.iter().map(|it| it.is_shown).collect()
    }

    /// `a AND (b OR c)`, with a as bit 0: worked out by hand.
    #[test]
    fn masking_mc_dc() {
        let [a, b, c] = [0, 1, 2].map(Formula::Condition);
        let formula = Formula::And(vec![a, Formula::Or(vec![b, c])]);
        // TTF and FTF show a; TTF and TFF show b; TFT and TFF show c.
        assert_eq!(shown(&formula, 3, &[0b011, 0b010]), [true, false, false]);
        assert_eq!(shown(&formula, 3, &[0b011, 0b010, 0b001]), [true, true, false]);
        assert_eq!(shown(&formula, 3, &[0b011, 0b010, 0b001, 0b101]), [true, true, true]);
        // In TTT neither b nor c decides.
        assert_eq!(shown(&formula, 3, &[0b111, 0b001]), [false, false, false]);
        // By masking: a decides in TTF and in FFT, where other conditions differ too.
        assert_eq!(shown(&formula, 3, &[0b011, 0b100]), [true, false, false]);
        assert_eq!(shown(&formula, 3, &[0b011, 0b000]), [false, false, false]);
    }

    /// In `a XOR b` each condition decides in every row.
    #[test]
    fn exclusive_or() {
        let formula = Formula::Xor(vec![Formula::Condition(0), Formula::Condition(1)]);
        assert_eq!(shown(&formula, 2, &[0b00, 0b01]), [true, false]);
        assert_eq!(shown(&formula, 2, &[0b00, 0b11]), [false, false]);
        assert_eq!(shown(&formula, 2, &[0b00, 0b01, 0b11]), [true, true]);
    }
}
