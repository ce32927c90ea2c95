//! Texts and characters: STRING and WSTRING of several capacities, and what changes one into another.

use super::Writer;
use super::types::Ty;

/// Texts of both kinds, shorter and longer than what holds them; some are characters of several units.
const NARROW: [&str; 6] = ["''", "'a'", "'bc'", "'xyz12'", "'hello world'", "'né'"];
const WIDE: [&str; 6] = ["\"\"", "\"a\"", "\"bü\"", "\"xyz12\"", "\"hello €\"", "\"n😀\""];

impl Writer {
    pub(super) fn text_literal(&mut self, wide: bool) -> String {
        (*self.random.one_of(if wide { &WIDE } else { &NARROW })).to_owned()
    }

    pub(super) fn character_literal(&mut self, wide: bool) -> String {
        let literals = if wide { ["\"a\"", "\"€\"", "\"z\""] } else { ["'a'", "'$$'", "'z'"] };
        (*self.random.one_of(&literals)).to_owned()
    }

    pub(super) fn string(&mut self, wide: bool, depth: usize) -> String {
        if depth == 0 {
            let place = self.some_place(false, 0, |_, it| it.is_text(wide));
            return place.map_or_else(|| self.text_literal(wide), |it| it.0);
        }
        let count = |this: &mut Self| this.expression(&Ty::Number(1), depth - 1);
        let a = self.string(wide, depth - 1);
        match self.random.below(14) {
            0 | 1 => format!("CONCAT({a}, {})", self.string(wide, depth - 1)),
            2 => format!("LEFT({a}, {})", count(self)),
            3 => format!("MID({a}, 2, {})", count(self)),
            4 => format!("INSERT({a}, {}, {})", self.string(wide, depth - 1), count(self)),
            5 => self.function_call(depth, |it| it.is_text(wide)).unwrap_or(a),
            6 => self.text_literal(wide),
            7 => format!("MAX({a}, {})", self.string(wide, depth - 1)),
            8 => format!("RIGHT({a}, {})", count(self)),
            9 => format!("DELETE({a}, {}, {})", count(self), count(self)),
            10 => format!("REPLACE({a}, {}, 1, {})", self.string(wide, depth - 1), count(self)),
            11 if wide => format!("STRING_TO_WSTRING({})", self.string(false, depth - 1)),
            11 => format!("WSTRING_TO_STRING({})", self.string(true, depth - 1)),
            12 if !wide => format!("INT_TO_STRING({})", self.operand(&Ty::Number(1), depth - 1)),
            13 if !self.codesys => format!("CONCAT({a}, {})", self.operand(&Ty::Char(wide), depth - 1)),
            _ => a,
        }
    }

    pub(super) fn character(&mut self, wide: bool, depth: usize) -> String {
        let own = Ty::Char(wide);
        match self.random.below(7) {
            0 | 1 => self.character_of_text(wide, depth).unwrap_or_else(|| self.operand(&own, depth - 1)),
            2 if wide => format!("CHAR_TO_WCHAR({})", self.operand(&Ty::Char(false), depth - 1)),
            2 => format!("WCHAR_TO_CHAR({})", self.operand(&Ty::Char(true), depth - 1)),
            3 if wide => format!("WSTRING_TO_WCHAR({})", self.string(true, depth - 1)),
            3 => format!("STRING_TO_CHAR({})", self.string(false, depth - 1)),
            4 => format!("MAX({}, {})", self.operand(&own, depth - 1), self.operand(&own, depth - 1)),
            5 if !wide => format!("BYTE_TO_CHAR({})", self.operand(&Ty::Bits(0), depth - 1)),
            _ => self.operand(&own, depth - 1),
        }
    }

    /// `s[i]`: a CHAR of the standard, a BYTE or a WORD of CODESYS.
    pub(super) fn character_of_text(&mut self, wide: bool, depth: usize) -> Option<String> {
        // What is in a UNION has no characters of its own.
        let (place, ty) = self.direct_place(0, |_, it| it.is_text(wide))?;
        Some(self.indexed_text(&place, &ty, depth))
    }

    fn indexed_text(&mut self, place: &str, ty: &Ty, depth: usize) -> String {
        let capacity = match ty {
            Ty::Text(it) | Ty::Wide(it) => i64::try_from(*it).unwrap_or(1),
            _ => 1,
        };
        let first = i64::from(!self.codesys);
        let index = self.index((first, capacity - 1 + first), depth);
        format!("{place}[{index}]")
    }

    /// `s[i] := c;`
    pub(super) fn assign_character(&mut self) {
        let wide = self.random.once_in(2);
        let Some((place, ty)) = self.direct_place(0, |_, it| it.is_text(wide)) else { return };
        let target = self.indexed_text(&place, &ty, 1);
        let unit = if self.codesys { Ty::Bits(usize::from(wide)) } else { Ty::Char(wide) };
        let value = self.expression(&unit, 2);
        self.line(&format!("{target} := {value};"));
    }
}
