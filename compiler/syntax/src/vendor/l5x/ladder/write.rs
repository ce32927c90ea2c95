//! Rungs as statements.

use super::super::super::assembly::{Chunk, Says, Trouble};
use super::super::logic::Logic;
use super::super::names::key;
use super::super::service::controller_service;
use super::condition::{Condition, Expression};
use super::jump::{self, Form, Parts};
use super::parse::{self, Branch, Element, Instruction, Path};
use super::rows::{Does, row_of};
use super::subroutine::each;
use super::text::Text;
use core::ops::Range;

/// A routine in Structured Text.
#[derive(Debug, Default)]
pub struct Ladder {
    pub chunks: Vec<Chunk>,
    /// What its statements need.
    pub variables: Vec<Variable>,
}

#[derive(Debug)]
pub struct Variable {
    pub name: String,
    pub ty: &'static str,
    /// Other routines use it, too.
    pub is_shared: bool,
}

/// The rungs of a routine as statements.
pub fn statements(routine: &str, rungs: &[Text], logic: &Logic<'_>) -> Ladder {
    let paths: Vec<_> = rungs.iter().map(|it| parse::rung(&it.text)).collect();
    let parts = Parts::of(rungs, &paths);
    let mut ladder = Ladder::default();
    let Some(first) = rungs.first() else { return ladder };
    let mut writer = Writer {
        routine,
        logic,
        text: first,
        parts: &parts,
        part: 0,
        zone: None,
        returns: 0,
        used: 0,
        out: &mut ladder,
        leaves: false,
    };
    if parts.form != Form::Straight && uses(rungs, &paths, "MCR") {
        writer.open_zones();
    }
    writer.between_parts(|parts, part, _, _| parts.first(part));
    for (text, path) in rungs.iter().zip(&paths) {
        (writer.text, writer.used) = (text, 0);
        match path {
            Ok(path) => writer.rung(path),
            Err(it) => writer.wrong(Trouble::Odd, it.message.clone(), &it.place),
        }
    }
    writer.between_parts(|parts, part, _, leaves| parts.last(part, leaves));
    ladder
}

/// Whether an instruction is somewhere in the rungs.
fn uses(rungs: &[Text], paths: &[Result<Path, parse::Mistake>], name: &str) -> bool {
    let mut found = false;
    for (text, path) in rungs.iter().zip(paths) {
        let Ok(path) = path else { continue };
        each(path, &mut |it| found |= text.text[it.name.clone()].eq_ignore_ascii_case(name));
    }
    found
}

pub struct Writer<'a> {
    pub routine: &'a str,
    pub logic: &'a Logic<'a>,
    pub text: &'a Text,
    pub parts: &'a Parts,
    /// The part that the rung is in.
    part: usize,
    /// What rungs begin with, once an `MCR` may have been executed.
    pub zone: Option<String>,
    /// `RET`s with operands so far.
    pub returns: usize,
    /// Variables of conditions that the rung has so far.
    used: usize,
    out: &'a mut Ladder,
    /// The last rung went elsewhere, whatever its condition.
    leaves: bool,
}

impl Writer<'_> {
    fn rung(&mut self, path: &Path) {
        let whole = 0..self.text.text.len();
        if let Some(remark) = &self.text.remark {
            let words = Chunk::words(format!("// {remark}\n"), &self.text.place(&whole));
            self.out.chunks.push(words);
        }
        if let Some(edit) = &self.text.edit {
            let message = format!("this is an unfinished edit (type {edit}): finish it, and export the file again");
            self.wrong(Trouble::NotSupported, message, &whole);
        }
        if let Some(label) = jump::label(self.text, path) {
            if self.parts.number(&label) != Some(self.part + 1) {
                self.wrong(Trouble::Odd, format!("the label `{label}` already exists"), &whole);
            }
            self.part += 1;
            self.between_parts(Parts::next);
        }
        self.leaves = false;
        let start = self.zone.clone().map_or(Condition::True, Condition::Variable);
        self.path(path, start, false);
    }

    /// Instructions in a row. The condition after them is of use only where it is `wanted`.
    fn path(&mut self, path: &[Element], start: Condition, wanted: bool) -> Condition {
        let (mut condition, mut own) = (start, None);
        for (at, element) in path.iter().enumerate() {
            let wanted = wanted || at + 1 < path.len();
            condition = match element {
                Element::Instruction(it) => self.instruction(it, condition, &mut own, wanted),
                Element::Branch(it) => self.branch(it, condition, &mut own, wanted),
            };
        }
        condition
    }

    fn branch(&mut self, it: &Branch, condition: Condition, own: &mut Option<String>, wanted: bool) -> Condition {
        let place = self.text.place(&it.place);
        if let Some(tests) = self.tests(it, &place) {
            return tests.map_or(condition.clone(), |it| condition.and(it, &place));
        }
        let start = self.in_variable(condition, own, &place);
        let after = wanted.then(|| self.variable());
        for (at, path) in it.paths.iter().enumerate() {
            let end = self.path(path, start.clone(), wanted);
            let Some(after) = &after else { continue };
            let head = if at == 0 { format!("{after} := ") } else { format!("{after} := {after} OR ") };
            let mut words = vec![Chunk::words(head, &place)];
            words.extend(end.words(&place));
            self.statement(words, &place);
        }
        after.map_or(start, Condition::Variable)
    }

    /// A branch of tests alone, as an expression; none where a path of it is empty.
    fn tests(&mut self, it: &Branch, place: &Range<usize>) -> Option<Option<Expression>> {
        let mut only = true;
        let mut all = Vec::new();
        for path in &it.paths {
            each(path, &mut |it| {
                only &= row_of(&self.text.text[it.name.clone()])
                    .is_some_and(|row| is_test(row.does) && row.takes(it.operands.len()))
                    && !self.may_fault(it);
            });
        }
        if !only {
            return None;
        }
        for path in &it.paths {
            match self.path(path, Condition::True, true) {
                Condition::Expression(it) => all.push(it),
                Condition::True | Condition::Variable(_) => return Some(None),
            }
        }
        Some(Some(Expression::any(all, place)))
    }

    fn instruction(
        &mut self,
        it: &Instruction,
        condition: Condition,
        own: &mut Option<String>,
        wanted: bool,
    ) -> Condition {
        let (name, place) = (self.name(it).to_owned(), self.text.place(&it.place));
        if self.logic.names.instructions.contains_key(&key(&name)) {
            let condition = if wanted { self.in_variable(condition, own, &place) } else { condition };
            return self.call_instruction(it, condition, wanted);
        }
        let Some(row) = row_of(&name) else {
            let message = match controller_service(&name) {
                Some(service) => format!("`{}` is not supported: {service}", name.to_ascii_uppercase()),
                None => format!("the instruction `{name}` is not supported"),
            };
            self.wrong(Trouble::NotSupported, message, &it.place);
            return condition;
        };
        if !row.takes(it.operands.len()) {
            self.miscounted(&name, row.operands, it);
            return condition;
        }
        if let Some((message, part)) = self.wrong_operand(row, it) {
            self.wrong(Trouble::Odd, message, &part);
            return condition;
        }
        let operands: Vec<_> = it.operands.iter().map(|part| self.operand(part)).collect();
        match row.does {
            Does::Nothing => condition,
            Does::Tests(test) => condition.and(Expression::new(fill(test, &operands, &[], &place)), &place),
            Does::Compares(test) => {
                let test = Expression::new(fill(test, &operands, &[], &place));
                self.compared(it, condition, own, test)
            }
            Does::Gives(value) => {
                let value = fill(value, &operands, &condition.words(&place), &place);
                self.set_own(own, value, &place)
            }
            Does::Always(statement) => {
                let condition = if wanted { self.in_variable(condition, own, &place) } else { condition };
                let statement = fill(statement, &operands, &condition.words(&place), &place);
                self.statement(statement, &place);
                condition
            }
            Does::WhereTrue(statement) => {
                let condition = if wanted { self.in_variable(condition, own, &place) } else { condition };
                self.where_true(&condition, fill(statement, &operands, &[], &place), &place);
                condition
            }
            Does::Computes(statement) => {
                let condition = if wanted { self.in_variable(condition, own, &place) } else { condition };
                let operands = self.computed(it, operands, &place);
                self.where_true(&condition, fill(statement, &operands, &[], &place), &place);
                condition
            }
            Does::Special(special) => {
                let is_test = is_test(row.does);
                let condition = if wanted && !is_test { self.in_variable(condition, own, &place) } else { condition };
                self.special(special, it, &operands, condition, own)
            }
        }
    }

    /// The condition where a comparison holds, which a false rung does not look at.
    pub fn compared(
        &mut self,
        it: &Instruction,
        condition: Condition,
        own: &mut Option<String>,
        test: Expression,
    ) -> Condition {
        let place = self.text.place(&it.place);
        if matches!(condition, Condition::True) || !self.may_fault(it) {
            return condition.and(test, &place);
        }
        let before = condition.words(&place);
        let after = self.set_own(own, before, &place);
        let value = [after.words(&place), vec![Chunk::words(" := ", &place)], test.words].concat();
        self.where_true(&after, value, &place);
        after
    }

    pub fn name(&self, it: &Instruction) -> &str {
        &self.text.text[it.name.clone()]
    }

    pub fn operand_text(&self, part: &Range<usize>) -> &str {
        &self.text.text[part.clone()]
    }

    /// The condition, in a variable if it is an expression.
    fn in_variable(&mut self, condition: Condition, own: &mut Option<String>, place: &Range<usize>) -> Condition {
        match condition {
            Condition::True | Condition::Variable(_) => condition,
            Condition::Expression(it) => self.set_own(own, it.words, place),
        }
    }

    /// A path has one variable, which others do not read any more when it gets another value.
    fn set_own(&mut self, own: &mut Option<String>, value: Vec<Chunk>, place: &Range<usize>) -> Condition {
        let name = own.take().unwrap_or_else(|| self.variable());
        let mut words = vec![Chunk::words(format!("{name} := "), place)];
        words.extend(value);
        self.statement(words, place);
        *own = Some(name.clone());
        Condition::Variable(name)
    }

    /// A further variable for a condition.
    fn variable(&mut self) -> String {
        self.used += 1;
        let name = match self.used {
            1 => format!("{}_rung", self.routine),
            more => format!("{}_rung_{more}", self.routine),
        };
        self.declared(name, "BOOL")
    }

    /// A variable of the routine, by a name that no tag has.
    pub fn declared(&mut self, name: String, ty: &'static str) -> String {
        self.declare(name, ty, false)
    }

    /// The number of the RET with operands that a routine returned by.
    pub fn return_of(&mut self, routine: &str) -> String {
        self.declare(format!("{routine}_return"), "DINT", true)
    }

    fn declare(&mut self, mut name: String, ty: &'static str, is_shared: bool) -> String {
        let logic = self.logic;
        while [&logic.scope.tags, &logic.names.controller.tags].iter().any(|it| it.contains(&key(&name)))
            || logic.actions.contains_key(&key(&name))
        {
            name.push('_');
        }
        if !self.out.variables.iter().any(|it| it.name == name) {
            self.out.variables.push(Variable { name: name.clone(), ty, is_shared });
        }
        name
    }

    /// These statements leave what is around them, where the condition is true.
    pub fn leave(&mut self, condition: &Condition, statements: Vec<Chunk>, place: &Range<usize>) {
        self.leaves |= matches!(condition, Condition::True);
        self.where_true(condition, statements, place);
    }

    pub fn where_true(&mut self, condition: &Condition, statements: Vec<Chunk>, place: &Range<usize>) {
        if matches!(condition, Condition::True) {
            return self.statement(statements, place);
        }
        let mut words = vec![Chunk::words("IF ", place)];
        words.extend(condition.words(place));
        words.push(Chunk::words(" THEN ", place));
        words.extend(statements);
        words.push(Chunk::words("; END_IF", place));
        self.statement(words, place);
    }

    pub fn statement(&mut self, words: Vec<Chunk>, place: &Range<usize>) {
        self.out.chunks.extend(words);
        self.out.chunks.push(Chunk::words(";\n", place));
    }

    /// Notes what is wrong with a part of the rung.
    pub fn wrong(&mut self, trouble: Trouble, message: String, part: &Range<usize>) {
        let message = format!("rung {} of `{}`: {message}", self.text.number, self.routine);
        self.out.chunks.push(Chunk { place: self.text.place(part), says: Says::Wrong(trouble, message) });
    }

    pub fn miscounted(&mut self, name: &str, takes: &[&str], it: &Instruction) {
        let named = if takes.is_empty() { String::new() } else { format!(" ({})", takes.join(", ")) };
        let message = format!("`{name}` takes {}{named}, not {}", counted(takes.len(), "operand"), it.operands.len());
        self.wrong(Trouble::Odd, message, &it.place);
    }

    pub fn part_variable(&mut self) -> String {
        self.declared(format!("{}_part", self.routine), "DINT")
    }

    /// Writes what begins or ends parts, of which one has a number.
    fn between_parts(&mut self, words: impl Fn(&Parts, &str, usize, bool) -> String) {
        if self.parts.form == Form::Straight {
            return;
        }
        let (part, place) = (self.part_variable(), self.text.place(&(0..self.text.text.len())));
        let words = words(self.parts, &part, self.part, self.leaves);
        self.out.chunks.push(Chunk::words(words, &place));
    }
}

/// Whether it is no more than a condition.
fn is_test(does: Does) -> bool {
    use super::rows::Special::{AlwaysFalse, Compare, Limit};
    matches!(does, Does::Tests(_) | Does::Compares(_) | Does::Nothing | Does::Special(AlwaysFalse | Compare | Limit))
}

/// `1 operand`, `2 operands`
pub fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// A row's text with operands in their places.
pub fn fill(text: &str, operands: &[Vec<Chunk>], rung: &[Chunk], place: &Range<usize>) -> Vec<Chunk> {
    let mut words = Vec::new();
    for piece in text.split_inclusive('}') {
        let (before, name) = piece.split_once('{').unwrap_or((piece, ""));
        if !before.is_empty() {
            words.push(Chunk::words(before, place));
        }
        match name.trim_end_matches('}') {
            "" => {}
            "rung" => words.extend_from_slice(rung),
            number => {
                words.extend(number.parse().ok().and_then(|it: usize| operands.get(it)).into_iter().flatten().cloned())
            }
        }
    }
    words
}
