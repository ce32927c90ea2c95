//! The grammar of a rung in neutral text: instructions in a row, and branches in brackets.
//!
//! ```text
//! rung        = path ";"
//! path        = { instruction | branch }
//! branch      = "[" path { "," path } "]"
//! instruction = name "(" [ operand { "," operand } ] ")"
//! ```

use core::ops::Range;

/// Branches that are nested deeper are refused.
const DEEPEST: usize = 64;

pub type Path = Vec<Element>;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Element {
    Instruction(Instruction),
    Branch(Branch),
}

/// The parts of an instruction, by their places in the rung's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instruction {
    pub name: Range<usize>,
    /// Without space around them.
    pub operands: Vec<Range<usize>>,
    pub place: Range<usize>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    pub paths: Vec<Path>,
    pub place: Range<usize>,
}

/// Why a text is not a rung, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    pub message: String,
    pub place: Range<usize>,
}

pub fn rung(text: &str) -> Result<Path, Mistake> {
    let mut parser = Parser { text, at: 0 };
    let path = parser.path(0)?;
    match parser.next() {
        Some(b';') => parser.at += 1,
        None => return Err(parser.mistake("`;` is missing at the end of the rung")),
        Some(_) => return Err(parser.unexpected()),
    }
    if parser.next().is_some() {
        return Err(parser.mistake("something follows the `;` that ends the rung"));
    }
    Ok(path)
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
}

impl Parser<'_> {
    /// The next byte that is not a space.
    fn next(&mut self) -> Option<u8> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text.as_bytes().get(self.at).copied()
    }

    fn path(&mut self, depth: usize) -> Result<Path, Mistake> {
        let mut path = Vec::new();
        loop {
            match self.next() {
                Some(b'[') => path.push(Element::Branch(self.branch(depth + 1)?)),
                Some(it) if it.is_ascii_alphabetic() || it == b'_' => {
                    path.push(Element::Instruction(self.instruction()?))
                }
                _ => return Ok(path),
            }
        }
    }

    fn branch(&mut self, depth: usize) -> Result<Branch, Mistake> {
        let start = self.at;
        if depth > DEEPEST {
            return Err(self.mistake("branches are nested too deep"));
        }
        self.at += 1;
        let mut paths = Vec::new();
        loop {
            paths.push(self.path(depth)?);
            match self.next() {
                Some(b',') => self.at += 1,
                Some(b']') => {
                    self.at += 1;
                    return Ok(Branch { paths, place: start..self.at });
                }
                None | Some(b';') => {
                    return Err(Mistake {
                        message: "this branch is not closed: `]` is missing".to_owned(),
                        place: start..start + 1,
                    });
                }
                Some(_) => return Err(self.unexpected()),
            }
        }
    }

    fn instruction(&mut self) -> Result<Instruction, Mistake> {
        let start = self.at;
        let rest = &self.text[start..];
        let length = rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(rest.len());
        let name = start..start + length;
        self.at = name.end;
        if self.next() != Some(b'(') {
            let message = format!(
                "`{}` is not an instruction: its operands in parentheses are missing",
                &self.text[name.clone()]
            );
            return Err(Mistake { message, place: name });
        }
        self.at += 1;
        let operands = self.operands(&name)?;
        Ok(Instruction { name, operands, place: start..self.at })
    }

    /// What is in the parentheses of an instruction, to their end.
    fn operands(&mut self, name: &Range<usize>) -> Result<Vec<Range<usize>>, Mistake> {
        let (mut operands, mut depth, mut from) = (Vec::new(), 0_usize, self.at);
        loop {
            let Some(byte) = self.text.as_bytes().get(self.at).copied() else { return Err(self.open(name)) };
            match byte {
                b'(' | b'[' => depth += 1,
                b']' => depth = depth.saturating_sub(1),
                b')' if depth > 0 => depth -= 1,
                b')' | b',' if depth == 0 => {
                    operands.push(self.trimmed(from..self.at));
                    from = self.at + 1;
                }
                b';' => return Err(self.open(name)),
                b'\'' => self.at = self.string_end(),
                _ => {}
            }
            self.at += 1;
            if byte == b')' && from == self.at {
                break;
            }
        }
        // `NOP()` has none.
        if let [one] = operands.as_slice()
            && one.is_empty()
        {
            operands.clear();
        }
        Ok(operands)
    }

    /// The last byte of a text in quotes; of one that is not closed, the last of the rung.
    fn string_end(&self) -> usize {
        let bytes = self.text.as_bytes();
        let mut at = self.at + 1;
        while let Some(byte) = bytes.get(at) {
            match byte {
                b'$' => at += 2,
                b'\'' => return at,
                _ => at += 1,
            }
        }
        bytes.len() - 1
    }

    fn trimmed(&self, part: Range<usize>) -> Range<usize> {
        let text = &self.text[part.clone()];
        let start = part.start + text.len() - text.trim_start().len();
        start..start + text.trim().len()
    }

    fn open(&self, name: &Range<usize>) -> Mistake {
        let message = format!("`)` is missing after the operands of `{}`", &self.text[name.clone()]);
        Mistake { message, place: name.clone() }
    }

    fn unexpected(&self) -> Mistake {
        let found = self.text[self.at..].chars().next().unwrap_or(' ');
        Mistake {
            message: format!("an instruction or a branch was expected, found `{found}`"),
            place: self.at..self.at + found.len_utf8(),
        }
    }

    fn mistake(&self, message: &str) -> Mistake {
        // The last that there is, where the text ends too early.
        let at = if self.at < self.text.len() { self.at } else { self.text.trim_end().len().saturating_sub(1) };
        let at = (0..=at).rev().find(|it| self.text.is_char_boundary(*it)).unwrap_or(0);
        let length = self.text[at..].chars().next().map_or(0, char::len_utf8);
        Mistake { message: message.to_owned(), place: at..at + length }
    }
}
