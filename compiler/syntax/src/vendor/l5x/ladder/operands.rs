//! The operands of instructions: what is wrong with them, and how they are written.

use super::super::super::assembly::Chunk;
use super::super::names::bits_of;
use super::parse::Instruction;
use super::rows::Row;
use super::write::Writer;
use core::ops::Range;

impl Writer<'_> {
    /// What is wrong with an operand, whatever the tags are.
    pub fn wrong_operand(&self, row: &Row, it: &Instruction) -> Option<(String, Range<usize>)> {
        let name = self.name(it);
        for (at, part) in it.operands.iter().enumerate() {
            let operand = row.operands.get(at).copied().unwrap_or("operand");
            let text = self.operand_text(part);
            let is_shown = ["Preset", "Accum"].contains(&operand);
            if text.is_empty() {
                return Some((format!("the {operand} of `{name}` is missing"), it.place.clone()));
            }
            if text == "?" && !is_shown {
                return Some((format!("the {operand} of `{name}` was not entered"), part.clone()));
            }
            let is_written = ["Destination", "Output Bit", "Storage Bit", "Size"].contains(&operand);
            if is_written && !text.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_' || it == '\\') {
                return Some((format!("the {operand} of `{name}` is a tag, not `{text}`"), part.clone()));
            }
        }
        None
    }

    /// Whether a comparison may end in a fault: by an index, or by a division.
    pub fn may_fault(&self, it: &Instruction) -> bool {
        let is_contact = ["XIC", "XIO"].iter().any(|own| own.eq_ignore_ascii_case(self.name(it)));
        !is_contact && it.operands.iter().any(|part| may_fault(self.operand_text(part)))
    }

    /// An operand with others next to it.
    pub fn operand(&self, part: &Range<usize>) -> Vec<Chunk> {
        let words = self.text.part(part);
        if !self.operand_text(part).starts_with('-') {
            return words;
        }
        let place = self.text.place(part);
        let mut all = vec![Chunk::words("(", &place)];
        all.extend(words);
        all.push(Chunk::words(")", &place));
        all
    }

    /// The operands of arithmetic: what is stored in a REAL is computed in REALs, by 1756-RM006K, p. 541: operands of one
    /// instruction are converted to the highest of their types.
    pub fn computed(&self, it: &Instruction, operands: Vec<Vec<Chunk>>, place: &Range<usize>) -> Vec<Vec<Chunk>> {
        let ty = |part: &Range<usize>| self.logic.type_of(self.operand_text(part));
        let last = operands.len() - 1;
        let Some(destination) = it.operands.last().and_then(ty) else { return operands };
        if last == 1 {
            return self.moved(it, operands, &destination, place);
        }
        let Some(real) = Some(destination).filter(|it| is_real(it)) else { return operands };
        let convert = |(at, words): (usize, Vec<Chunk>)| {
            let text = self.operand_text(&it.operands[at]);
            if at == last {
                return words;
            }
            if text.bytes().all(|it| it.is_ascii_digit()) {
                return [words, vec![Chunk::words(".0", place)]].concat();
            }
            match self.logic.type_of(text).filter(|it| !is_real(it)) {
                Some(ty) => {
                    let head = Chunk::words(format!("{ty}_TO_{real}("), place);
                    [vec![head], words, vec![Chunk::words(")", place)]].concat()
                }
                None => words,
            }
        };
        operands.into_iter().enumerate().map(convert).collect()
    }

    /// The operands of `MOV`.
    fn moved(&self, it: &Instruction, operands: Vec<Vec<Chunk>>, ty: &str, place: &Range<usize>) -> Vec<Vec<Chunk>> {
        let text = self.operand_text(&it.operands[0]);
        let is_fraction = text.parse::<f64>().is_ok_and(|it| it.fract() != 0.0);
        if !is_fraction || bits_of(ty).is_none() {
            return operands;
        }
        let [head, tail] = [format!("REAL_TO_{ty}("), ")".to_owned()].map(|it| vec![Chunk::words(it, place)]);
        vec![[head, operands[0].clone(), tail].concat(), operands[1].clone()]
    }
}

/// Whether an operand has an index that is not a number, or divides.
fn may_fault(operand: &str) -> bool {
    let mut indices = operand.split('[').skip(1).map(|it| it.split(']').next().unwrap_or_default());
    let is_number = |it: &str| it.bytes().all(|it| it.is_ascii_digit() || it == b',' || it == b' ');
    let divides = operand.contains('/') || operand.to_ascii_uppercase().contains("MOD");
    divides || indices.any(|it| !is_number(it))
}

fn is_real(ty: &str) -> bool {
    ty.eq_ignore_ascii_case("REAL") || ty.eq_ignore_ascii_case("LREAL")
}
