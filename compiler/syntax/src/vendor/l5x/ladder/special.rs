//! Instructions that are more than one statement.

use super::super::super::assembly::{Chunk, Trouble};
use super::super::names::bits_of;
use super::condition::{Condition, Expression};
use super::parse::Instruction;
use super::rows::{FUNCTIONS, Special};
use super::write::{Writer, fill};
use core::ops::Range;

impl Writer<'_> {
    pub fn special(
        &mut self,
        special: Special,
        it: &Instruction,
        operands: &[Vec<Chunk>],
        condition: Condition,
        own: &mut Option<String>,
    ) -> Condition {
        let place = self.text.place(&it.place);
        match special {
            Special::AlwaysFalse => Condition::Expression(Expression::new(vec![Chunk::words("FALSE", &place)])),
            Special::Limit => {
                let test = self.limits(it, operands, &place);
                self.compared(it, condition, own, test)
            }
            Special::Compare => {
                let [open, close] = ["(", ")"].map(|it| vec![Chunk::words(it, &place)]);
                let test = Expression::new([open, self.expression(&it.operands[0]), close].concat());
                self.compared(it, condition, own, test)
            }
            Special::Compute => {
                let statement =
                    [operands[0].clone(), vec![Chunk::words(" := ", &place)], self.expression(&it.operands[1])];
                self.where_true(&condition, statement.concat(), &place);
                condition
            }
            Special::Distribute => {
                if let Some(bits) = self.distributed(it, &place) {
                    self.where_true(&condition, bits, &place);
                }
                condition
            }
            Special::Fill => {
                let fill = self.filled(it, operands, &place);
                self.where_true(&condition, fill, &place);
                condition
            }
            Special::Call => {
                self.call_routine(it, operands, &condition, &place);
                condition
            }
            Special::Return => {
                self.returned(it, &condition, &place);
                condition
            }
            Special::Jump => {
                let label = self.operand_text(&it.operands[0]).to_owned();
                match self.parts.number(&label) {
                    Some(part) => {
                        let jump = self.parts.jump(&self.part_variable(), part);
                        self.leave(&condition, vec![Chunk::words(jump, &place)], &place);
                    }
                    None => {
                        let message = format!("the routine has no label `{label}` at the beginning of a rung");
                        self.wrong(Trouble::Odd, message, &it.operands[0]);
                    }
                }
                condition
            }
            Special::Inputs => condition,
            Special::Label => {
                if !self.text.text[..it.place.start].trim().is_empty() {
                    self.wrong(Trouble::Odd, "a label must be at the beginning of its rung".to_owned(), &it.place);
                }
                condition
            }
            Special::Zone => {
                self.zone(&condition, &place);
                condition
            }
        }
    }

    /// With the limits the other way round it is true outside of them.
    fn limits(&self, it: &Instruction, operands: &[Vec<Chunk>], place: &Range<usize>) -> Expression {
        const INSIDE: &str = "{0} <= {1} AND {1} <= {2}";
        const OUTSIDE: &str = "({1} >= {0} OR {1} <= {2})";
        const EITHER: &str = "({0} <= {2} AND {0} <= {1} AND {1} <= {2} OR {0} > {2} AND ({1} >= {0} OR {1} <= {2}))";
        let number = |at: usize| self.operand_text(&it.operands[at]).parse::<f64>().ok();
        let text = match number(0).zip(number(2)) {
            Some((low, high)) if low <= high => INSIDE,
            Some(_) => OUTSIDE,
            None => EITHER,
        };
        Expression::new(fill(text, operands, &[], place))
    }

    /// An expression of `CMP` or `CPT`: some functions have other names.
    fn expression(&self, part: &Range<usize>) -> Vec<Chunk> {
        let text = self.operand_text(part);
        let (mut words, mut from, mut at) = (Vec::new(), 0, 0);
        while at < text.len() {
            let rest = &text[at..];
            let length = rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(rest.len());
            let other = FUNCTIONS.iter().find(|it| it.0.eq_ignore_ascii_case(&rest[..length]));
            if let Some((_, other)) = other.filter(|_| rest[length..].trim_start().starts_with('(')) {
                words.extend(self.text.part(&(part.start + from..part.start + at)));
                words.push(Chunk::words(*other, &self.text.place(&(part.start + at..part.start + at + length))));
                from = at + length;
            }
            at += if length > 0 { length } else { rest.chars().next().map_or(1, char::len_utf8) };
        }
        words.extend(self.text.part(&(part.start + from..part.end)));
        words
    }

    /// `BTD(a,0,b,8,2)` bit by bit: `b.8 := a.0; b.9 := a.1`.
    fn distributed(&mut self, it: &Instruction, place: &Range<usize>) -> Option<Vec<Chunk>> {
        let number = |at: usize| self.operand_text(&it.operands[at]).parse::<usize>().ok();
        let (Some(from), Some(to), Some(length)) = (number(1), number(3), number(4)) else {
            let message = "`BTD` is supported for bits and lengths that are numbers".to_owned();
            self.wrong(Trouble::NotSupported, message, &it.place);
            return None;
        };
        let (source, destination) = (&it.operands[0], &it.operands[2]);
        let bits = self.logic.type_of(self.operand_text(destination)).and_then(|it| bits_of(&it)).unwrap_or(32);
        let length = length.min(bits.saturating_sub(to));
        let immediate = self.operand_text(source).parse::<i64>().ok();
        let overlaps = to > from && self.operand_text(source).eq_ignore_ascii_case(self.operand_text(destination));
        let mut words = Vec::new();
        for at in 0..length {
            // What is read later is not written before.
            let at = if overlaps { length - 1 - at } else { at };
            if !words.is_empty() {
                words.push(Chunk::words("; ", place));
            }
            words.extend(self.text.part(destination));
            words.push(Chunk::words(format!(".{} := ", to + at), place));
            match immediate {
                Some(value) => {
                    let bit = value >> (from + at).min(63) & 1 == 1;
                    words.push(Chunk::words(if bit { "TRUE" } else { "FALSE" }, place));
                }
                None => {
                    words.extend(self.text.part(source));
                    words.push(Chunk::words(format!(".{}", from + at), place));
                }
            }
        }
        Some(words)
    }

    /// `FLL(0,a[2],5)` as a loop over the elements from `a[2]` on, up to the last one that there is.
    fn filled(&mut self, it: &Instruction, operands: &[Vec<Chunk>], place: &Range<usize>) -> Vec<Chunk> {
        let (part, text) = (&it.operands[1], self.operand_text(&it.operands[1]));
        if self.logic.is_single(text) {
            return [operands[1].clone(), vec![Chunk::words(" := ", place)], operands[0].clone()].concat();
        }
        let first = text.strip_suffix(']').and_then(|it| it.rfind('[')).filter(|it| !text[*it..].contains(','));
        let (array, index) = match first {
            Some(at) => (part.start..part.start + at, Some(part.start + at + 1..part.end - 1)),
            None => (part.clone(), None),
        };
        let (array, index) = (self.text.part(&array), index.filter(|it| self.operand_text(it).trim() != "0"));
        let index = index.map(|it| self.text.part(&it));
        let number = self.declared(format!("{}_element", self.routine), "DINT");
        let mut words = vec![Chunk::words(format!("FOR {number} := "), place)];
        words.extend(index.clone().unwrap_or_else(|| vec![Chunk::words("0", place)]));
        words.push(Chunk::words(" TO MIN(", place));
        if let Some(index) = index {
            words.extend(index);
            words.push(Chunk::words(" + ", place));
        }
        words.extend_from_slice(&operands[2]);
        words.push(Chunk::words(" - 1, UPPER_BOUND(", place));
        words.extend_from_slice(&array);
        words.push(Chunk::words(", 1)) DO ", place));
        words.extend(array);
        words.push(Chunk::words(format!("[{number}] := "), place));
        words.extend_from_slice(&operands[0]);
        words.push(Chunk::words("; END_FOR", place));
        words
    }

    /// `MCR` ends a zone whose rungs are false; elsewhere it begins one unless its rung is true (1756-RM003, "Master Control Reset").
    fn zone(&mut self, condition: &Condition, place: &Range<usize>) {
        let is_first = self.zone.is_none();
        let zone = self.zone_variable();
        let value = match condition {
            Condition::True => vec![Chunk::words("TRUE", place)],
            // Nothing else is on its rung.
            Condition::Variable(it) if *it == zone => vec![Chunk::words("TRUE", place)],
            _ if is_first => condition.words(place),
            _ => [vec![Chunk::words(format!("NOT {zone} OR "), place)], condition.words(place)].concat(),
        };
        self.statement([vec![Chunk::words(format!("{zone} := "), place)], value].concat(), place);
        self.zone = Some(zone);
    }

    /// Where a jump may lead past the first `MCR`.
    pub fn open_zones(&mut self) {
        let (zone, place) = (self.zone_variable(), self.text.place(&(0..self.text.text.len())));
        self.statement(vec![Chunk::words(format!("{zone} := TRUE"), &place)], &place);
        self.zone = Some(zone);
    }

    fn zone_variable(&mut self) -> String {
        self.declared(format!("{}_zone", self.routine), "BOOL")
    }
}
