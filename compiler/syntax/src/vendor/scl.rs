//! Sources of Siemens' SCL for S7-1200 and S7-1500: blocks whose names are in quotes and whose local names have a `#`
//! before them, with what TIA Portal notes between their heads and their declarations. Data blocks become variables.

mod counter;
mod counter_use;
mod data_block;
mod organization;
pub(super) mod token;
mod words;

use super::assembly::{Assembly, Chunk, Trouble};
use crate::spelling::abbreviates;
use core::ops::Range;
use counter::Counters;
use rustc_hash::FxHashMap;
use staunch_ir::Elementary;
use token::{Kind, Token};

/// Heads of blocks, as the language has them, and how they end in Structured Text.
const BLOCKS: [(&str, &str, &str); 6] = [
    ("FUNCTION_BLOCK", "FUNCTION_BLOCK", "END_FUNCTION_BLOCK"),
    ("FUNCTION", "FUNCTION", "END_FUNCTION"),
    ("ORGANIZATION_BLOCK", "PROGRAM", "END_PROGRAM"),
    ("DATA_BLOCK", "", ""),
    ("TYPE", "TYPE", "END_TYPE"),
    // Not in the language; tools that also read Structured Text have it.
    ("PROGRAM", "PROGRAM", "END_PROGRAM"),
];

/// What is noted in a head, before a value.
const NOTES: [&str; 5] = ["VERSION", "TITLE", "AUTHOR", "FAMILY", "NAME"];

/// Whether a text begins as such a source does: with a block whose name is in quotes, or one that no other system has;
/// or it begins with another block of the language, and uses local names. One `#` may be a slip.
pub fn is_source(text: &str) -> bool {
    // A file that is not SCL should not be read as a whole to find that out.
    let mut tokens = token::Tokens::new(text).filter(|it| it.kind != Kind::Pragma);
    let Some(head) = tokens.next().filter(|it| it.kind == Kind::Word) else { return false };
    let word = &text[head.place];
    let is = |it: &str| word.eq_ignore_ascii_case(it);
    if is("PROGRAM") || !BLOCKS.iter().any(|it| is(it.0)) {
        return false;
    }
    let is_quoted = tokens.next().is_some_and(|it| it.kind == Kind::Quoted);
    is_quoted || is("ORGANIZATION_BLOCK") || is("DATA_BLOCK") || {
        may_have_locals(text) && tokens.filter(|it| it.kind == Kind::Local && it.place.len() > 1).nth(1).is_some()
    }
}

/// Whether there is a `#` before a name, and nothing before that which makes it a literal's.
fn may_have_locals(text: &str) -> bool {
    let is_of_name = |it: &u8| it.is_ascii_alphanumeric() || *it == b'_' || !it.is_ascii();
    let bytes = text.as_bytes();
    memchr::memchr_iter(b'#', bytes).any(|at| {
        let [before, after] = [at.checked_sub(1), at.checked_add(1)].map(|it| it.and_then(|it| bytes.get(it)));
        before.is_some_and(|it| !is_of_name(it)) && after.is_some_and(|it| *it == b'"' || is_of_name(it))
    })
}

pub fn read(file: &str) -> Assembly {
    let mut out = Assembly::default();
    out.write("{dialect 'siemens'}\n", &(0..0));
    let tokens = token::Tokens::new(file).collect();
    let mut reader = Scl {
        file,
        tokens,
        at: 0,
        copied: 0,
        out,
        is_body: false,
        locals: FxHashMap::default(),
        has_enable: false,
        is_combined: false,
        regions: Vec::new(),
        counters: Counters::default(),
    };
    reader.counters = reader.called_counters();
    while reader.at < reader.tokens.len() {
        reader.block();
    }
    reader.copy_to(file.len());
    reader.out
}

/// What starts an organization block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    /// It runs in each cycle, as OB 1.
    Cycle,
    /// It runs before the first cycle, as OB 100.
    StartUp,
    Unknown,
}

struct Scl<'t> {
    file: &'t str,
    tokens: Vec<Token>,
    /// The next token.
    at: usize,
    /// How far the file has been taken.
    copied: usize,
    out: Assembly,
    /// Whether the declarations are over.
    is_body: bool,
    /// What the block declares, and its type, both in lower case.
    locals: FxHashMap<String, String>,
    /// Whether the block is called with EN and ENO.
    has_enable: bool,
    /// Whether the value of a combined assignment is being read.
    is_combined: bool,
    /// The REGIONs that are open.
    regions: Vec<Range<usize>>,
    counters: Counters,
}

impl<'t> Scl<'t> {
    fn token(&self, at: usize) -> Option<&Token> {
        self.tokens.get(at)
    }

    fn text(&self, at: usize) -> &'t str {
        self.token(at).and_then(|it| self.file.get(it.place.clone())).unwrap_or_default()
    }

    fn is(&self, at: usize, word: &str) -> bool {
        self.token(at).is_some_and(|it| it.kind == Kind::Word) && self.text(at).eq_ignore_ascii_case(word)
    }

    fn place(&self, at: usize) -> Range<usize> {
        let end = self.file.len();
        self.token(at).map_or(end..end, |it| it.place.clone())
    }

    /// Takes the file up to a place as it is.
    fn copy_to(&mut self, end: usize) {
        if end > self.copied {
            self.out.copy(self.file, &[Chunk::verbatim(self.copied..end)]);
            self.copied = end;
        }
    }

    /// Writes words for what is at a place.
    fn replace(&mut self, place: Range<usize>, words: &str) {
        self.copy_to(place.start);
        if !words.is_empty() {
            self.out.write(words, &place);
        }
        self.copied = place.end;
    }

    fn refuse(&mut self, place: Range<usize>, message: String) {
        self.problem(Trouble::NotSupported, place, message);
    }

    fn problem(&mut self, trouble: Trouble, place: Range<usize>, message: String) {
        self.copy_to(place.start);
        self.out.problem(trouble, message, &place);
        self.copied = place.end;
    }

    /// A name as Structured Text has it.
    fn name(&self, at: usize) -> String {
        words::legal(token::name(self.text(at)))
    }

    /// That of a block, a type or a data block: a variable may be called as a type of the language, these may not.
    fn global_name(&self, at: usize) -> String {
        let name = self.name(at);
        let is_quoted = self.token(at).is_some_and(|it| it.kind == Kind::Quoted);
        if is_quoted && Elementary::named(&name).is_some() { name + "_" } else { name }
    }

    fn block(&mut self) {
        let Some(block) = BLOCKS.iter().find(|it| self.is(self.at, it.0)) else { return self.simple() };
        self.locals.clear();
        self.is_body = false;
        self.has_enable = block.0.starts_with("FUNCTION");
        if block.0 == "DATA_BLOCK" {
            return self.data_block();
        }
        let head = self.place(self.at);
        let (name, place) = (self.global_name(self.at + 1), self.place(self.at + 1));
        let event = (block.0 == "ORGANIZATION_BLOCK").then(|| self.event(&name));
        if event == Some(Event::StartUp) {
            self.copy_to(head.start);
            self.out.write("{attribute 'startup'}\n", &head);
        }
        self.replace(head, block.1);
        if event == Some(Event::Unknown) {
            let message = format!("the source does not say which event starts `{name}`");
            self.refuse(place.start..place.start, message);
            self.out.help(
                "write code that runs at intervals as a PROGRAM that a TASK of a CONFIGURATION runs; code for an event as a FUNCTION_BLOCK that \
                 `Main` calls when the event occurs",
            );
        }
        self.replace(place.clone(), &name);
        self.at += 2;
        self.result();
        if block.0 == "TYPE" {
            self.out.write(" : ", &place);
        }
        self.notes();
        while self.at < self.tokens.len() {
            if !self.is_body && self.is(self.at, "CONST") {
                self.constants();
                continue;
            }
            let end = self.text(self.at);
            let word = end.split_at_checked(4).filter(|it| it.0.eq_ignore_ascii_case("END_"));
            if word.is_some_and(|it| it.1.eq_ignore_ascii_case(block.0)) {
                let place = self.place(self.at);
                self.open_regions(place.start);
                self.replace(place, block.2);
                self.at += 1;
                return;
            }
            if word.is_some_and(|it| self.is_abbreviated_end(it.1, block.0)) {
                let place = self.place(self.at);
                self.open_regions(place.start);
                self.copy_to(place.start);
                self.out.problem(Trouble::Odd, format!("`{end}` is written `END_{}`", block.0), &place);
                self.out.help(format!("write `END_{}`", block.0));
                self.replace(place, block.2);
                self.at += 1;
                return;
            }
            self.simple();
        }
        self.open_regions(self.file.len());
    }

    /// Whether `ORG_BLOCK`, after `END_`, stands for the end of a block: no other end has this word.
    fn is_abbreviated_end(&self, word: &str, block: &str) -> bool {
        const INNER: [&str; 10] =
            ["IF", "CASE", "FOR", "WHILE", "REPEAT", "VAR", "STRUCT", "CONST", "REGION", "DATA_BLOCK"];
        let is_inner = INNER.iter().any(|it| word.eq_ignore_ascii_case(it));
        let is_used = matches!(self.text(self.at + 1), ":" | "." | "(" | "[");
        let plain = |it: &str| it.replace('_', "").to_ascii_uppercase();
        !is_inner && !is_used && word.len() > 1 && self.is_body && abbreviates(&plain(word), &plain(block))
    }

    /// Reports the regions that are open where their block ends.
    fn open_regions(&mut self, end: usize) {
        for region in core::mem::take(&mut self.regions) {
            self.copy_to(end);
            self.out.problem(Trouble::Open, "the REGION that starts here is not closed".to_owned(), &region);
            self.out.help("write `END_REGION` where it ends");
        }
    }

    /// `CONST most := 5; END_CONST`, of STEP 7: constants whose values say what types they have.
    fn constants(&mut self) {
        let place = self.place(self.at);
        self.replace(place, "VAR CONSTANT");
        self.at += 1;
        while self.at < self.tokens.len() && !self.is(self.at, "BEGIN") {
            if self.is(self.at, "END_CONST") {
                let place = self.place(self.at);
                self.replace(place, "END_VAR");
                self.at += 1;
                return;
            }
            let (name, place) = (self.at, self.place(self.at));
            self.simple();
            let Some(end) = (name..self.tokens.len()).find(|it| self.text(*it) == ";") else { return };
            if self.text(name + 1) == ":" && self.text(name + 2) == "=" {
                let value = self.file[self.place(name + 3).start..self.place(end).start].trim();
                self.replace(place.end..place.end, &format!(" : {}", type_of(value)));
            }
            while self.at <= end {
                self.simple();
            }
        }
    }

    /// The type of a function's result; `Void` is none.
    fn result(&mut self) {
        if self.text(self.at) != ":" {
            return;
        }
        if self.is(self.at + 1, "VOID") {
            let place = self.place(self.at).start..self.place(self.at + 1).end;
            self.replace(place, "");
            self.at += 2;
        } else {
            self.at += 1;
            self.simple();
        }
    }

    /// Passes over what is noted between a head and what it declares.
    fn notes(&mut self) {
        loop {
            let start = self.place(self.at);
            if self.is(self.at, "TITLE") {
                // Its text needs no quotes, and ends with its line.
                let end = self.file[start.start..].find('\n').map_or(self.file.len(), |it| start.start + it);
                while self.token(self.at).is_some_and(|it| it.place.start < end) {
                    self.at += 1;
                }
                self.replace(start.start..end.max(self.copied), "");
            } else if NOTES.iter().any(|it| self.is(self.at, it)) && self.text(self.at + 1) == ":" {
                let end = self.place(self.at + 2).end;
                self.replace(start.start..end, "");
                self.at += 3;
            } else if self.is(self.at, "KNOW_HOW_PROTECT")
                || self.token(self.at).is_some_and(|it| it.kind == Kind::Pragma)
            {
                self.replace(start, "");
                self.at += 1;
            } else {
                return;
            }
        }
    }

    /// A token of declarations or statements.
    fn simple(&mut self) {
        let Some(Token { kind, place }) = self.token(self.at).cloned() else { return };
        let at = self.at;
        self.at += 1;
        let after_dot = at > 0 && self.text(at - 1) == ".";
        if self.is_address_of_a_block(at) {
            self.at = at + 3;
            return self.address(at + 2, place.start..self.place(at + 2).end);
        }
        match kind {
            Kind::Pragma => self.replace(place, ""),
            Kind::Local => {
                let name = self.name(at);
                self.replace(place, &name);
            }
            Kind::Quoted => {
                let is_declared = !self.is_body && self.declares(at);
                let is_member = after_dot || is_declared || self.is_given(at);
                let name = if is_member { self.name(at) } else { self.global_name(at) };
                if is_declared {
                    self.locals.insert(name.to_ascii_lowercase(), String::new());
                }
                let is_hidden = !after_dot && self.locals.contains_key(&name.to_ascii_lowercase());
                let name = if is_hidden && self.is_body { format!("Globals.{name}") } else { name };
                self.replace(place, &name);
            }
            Kind::Address if !after_dot => self.address(at, place),
            Kind::Literal => self.literal(place),
            Kind::Word => {
                if after_dot {
                    self.timer(at, place.clone());
                } else {
                    self.word(at, place.clone());
                }
                let is_member = after_dot || if self.is_body { self.is_given(at) } else { self.declares(at) };
                let name = if is_member { self.name(at) } else { token::name(self.text(at)) };
                if name != self.text(at) && self.copied < place.end {
                    self.replace(place, &name);
                }
            }
            Kind::Other => self.sign(at, place),
            Kind::Address => {}
        }
    }

    /// `"Plant".%DBX0.0`
    fn is_address_of_a_block(&self, at: usize) -> bool {
        let is_name = self.token(at).is_some_and(|it| matches!(it.kind, Kind::Word | Kind::Local | Kind::Quoted));
        let address = self.text(at + 2).get(..3).filter(|_| is_name && self.text(at + 1) == ".");
        address.is_some_and(|it| it.eq_ignore_ascii_case("%DB"))
    }

    /// Refuses an address, which with the block before it takes a place of the file.
    fn address(&mut self, at: usize, place: Range<usize>) {
        let address = self.text(at).to_ascii_uppercase();
        let start = self.place(at).start;
        self.copy_to(place.start);
        let message = format!("`{address}` is an address: blocks share memory only by name");
        self.out.problem(Trouble::NotSupported, message, &(start..start));
        // What reads on finds an operand of the same size.
        let of_a_block = address.split_once(".DB").map(|it| it.1);
        if let Some(size) = of_a_block.or_else(|| address.strip_prefix("%DB")) {
            self.out.help("write the member of the data block at this address");
            let size = size.get(..1).unwrap_or("X");
            self.replace(place, &if size == "X" { "%MX0.0".to_owned() } else { format!("%M{size}0") });
        }
    }

    /// `#total += #a * 2;` is `total := total + (a * 2);`.
    fn sign(&mut self, at: usize, place: Range<usize>) {
        let sign = self.text(at);
        if sign == ";" && core::mem::take(&mut self.is_combined) {
            self.replace(place.start..place.start, ")");
        }
        let is_combined = matches!(sign, "+" | "-" | "*" | "/") && self.text(at + 1) == "=";
        if !is_combined || !self.is_body || self.place(at + 1).start != place.end {
            return;
        }
        let Some(target) = self.target_before(at) else { return };
        let whole = place.start..self.place(at + 1).end;
        self.replace(place.clone(), ":= ");
        self.copied = self.place(target).start;
        self.at = target;
        while self.at < at {
            self.simple();
        }
        self.copy_to(self.place(at - 1).end);
        self.copied = whole.start;
        self.replace(whole, &format!(" {sign} ("));
        self.at = at + 2;
        self.is_combined = true;
    }

    /// Where the variable begins that ends before a token. It is named twice, so that none is found whose index
    /// calls something.
    fn target_before(&self, end: usize) -> Option<usize> {
        let mut at = end;
        loop {
            at = at.checked_sub(1)?;
            let mut depth = 0;
            while depth > 0 || self.text(at) == "]" {
                match self.text(at) {
                    "]" => depth += 1,
                    "[" => depth -= 1,
                    "(" => return None,
                    _ => {}
                }
                at = at.checked_sub(1)?;
            }
            let is_name = matches!(self.token(at)?.kind, Kind::Word | Kind::Local | Kind::Quoted);
            let before = at.checked_sub(1)?;
            match (is_name, self.text(before)) {
                (false, _) => return None,
                (true, ".") => at = before,
                (true, _) => return Some(at),
            }
        }
    }

    fn word(&mut self, at: usize, place: Range<usize>) {
        let word = self.text(at).to_ascii_uppercase();
        match word.as_str() {
            "REGION" => {
                let end = self.file[place.start..].find('\n').map_or(self.file.len(), |it| place.start + it);
                while self.token(self.at).is_some_and(|it| it.place.start < end) {
                    self.at += 1;
                }
                self.regions.push(place.clone());
                self.replace(place.start..end, "");
            }
            "END_REGION" => {
                if self.regions.pop().is_none() {
                    self.copy_to(place.start);
                    self.out.problem(Trouble::SecondEnd, "no REGION is open here".to_owned(), &place);
                    self.out.help("delete it, or write `REGION` where the region begins");
                }
                let end = self.end_of_region(at);
                self.at = end + 1;
                self.replace(place.start..self.place(end).end, "");
            }
            "BEGIN" => {
                self.is_body = true;
                let has_own = self.has_enable && self.names_enable(at);
                self.replace(place, if has_own { "VAR_OUTPUT ENO : BOOL; END_VAR\n" } else { "" });
            }
            "DB_SPECIFIC" => self.replace(place, ""),
            "GOTO" => self.replace(place, "JMP"),
            _ if !self.is_body && self.declares(at) => {
                let ty = self.text(self.after(at) + 1).to_ascii_lowercase();
                self.locals.insert(self.name(at).to_ascii_lowercase(), ty);
            }
            _ if self.text(at.wrapping_sub(1)) == ":" && counter::is_one(&word) => {
                let name = self.name(self.declared_before(at));
                let block = self.counter(&word, &name);
                if block != word {
                    self.replace(place, &block);
                }
            }
            _ => {}
        }
    }

    /// The last token of an END_REGION: its line may name the region again. A statement after it is one.
    fn end_of_region(&self, at: usize) -> usize {
        let place = self.place(at);
        let line = self.file[place.end..].find('\n').map_or(self.file.len(), |it| place.end + it);
        let is_on_line = |it: &usize| self.token(*it).is_some_and(|it| it.place.start < line);
        let last = (at + 1..).take_while(is_on_line).last().unwrap_or(at);
        let is_statement = self.text(at + 1) != ";" && (at + 1..=last).any(|it| self.text(it) == ";");
        if self.text(at + 1) == ";" {
            at + 1
        } else if is_statement {
            at
        } else {
            last
        }
    }

    /// Whether a body, up to its end, sets its block's ENO or asks for it: each block has one, which is not declared.
    fn names_enable(&self, from: usize) -> bool {
        let is_end = |at: &usize| self.is(*at, "END_FUNCTION") || self.is(*at, "END_FUNCTION_BLOCK");
        let is_own = |at: usize| {
            self.is(at, "ENO") && self.text(at - 1) != "." && (self.text(at + 1), self.text(at + 2)) != ("=", ">")
        };
        let mut body = (from + 1..self.tokens.len()).take_while(|at| !is_end(at));
        !self.locals.contains_key("eno") && body.any(is_own)
    }

    /// Whether a name is before its type.
    fn declares(&self, at: usize) -> bool {
        let colon = self.after(at);
        self.text(colon) == ":" && self.text(colon + 1) != "="
    }

    /// Whether a name is before the value that it is given: `"type" := 3`, `to => #n`.
    fn is_given(&self, at: usize) -> bool {
        matches!((self.text(at + 1), self.text(at + 2)), (":", "=") | ("=", ">"))
    }

    /// The token after a name and what is noted of it.
    fn after(&self, at: usize) -> usize {
        (at + 1..).find(|it| self.token(*it).is_none_or(|it| it.kind != Kind::Pragma)).unwrap_or(at)
    }

    /// `#delay.TON(…)` of a TON_TIME is a call of it, and so is `"C".CTU(…)` of a counter.
    fn timer(&mut self, at: usize, place: Range<usize>) {
        let is_call = self.text(at + 1) == "(" && at > 2;
        if is_call && self.is_counter_called_as(&self.name(at - 2), self.text(at)) {
            let dot = self.place(at - 1).start;
            return self.replace(dot..place.end, "");
        }
        let ty = self.locals.get(&self.name(at.saturating_sub(2)).to_ascii_lowercase());
        let called = format!("{}_time", self.text(at).to_ascii_lowercase());
        if is_call && self.text(at.saturating_sub(3)) != "." && ty.is_some_and(|it| *it == called) {
            let dot = self.place(at - 1).start;
            self.replace(dot..place.end, "");
        }
    }

    /// `W#16#FF`
    fn literal(&mut self, place: Range<usize>) {
        let Some((prefix, _)) = self.file[place.clone()].split_once('#') else { return };
        let long = match prefix.to_ascii_uppercase().as_str() {
            "B" => "BYTE",
            "W" => "WORD",
            "DW" => "DWORD",
            "LW" => "LWORD",
            "L" => "DINT",
            _ => return,
        };
        self.replace(place.start..place.start + prefix.len(), long);
    }
}

/// The type that a constant has by its value.
fn type_of(value: &str) -> String {
    let is_number = |it: &str| it.chars().all(|it| it.is_ascii_digit());
    if value.starts_with('\'') {
        return "STRING".to_owned();
    }
    if ["TRUE", "FALSE"].iter().any(|it| value.eq_ignore_ascii_case(it)) {
        return "BOOL".to_owned();
    }
    match value.split_once('#') {
        Some((prefix, _)) if !is_number(prefix) => match prefix.to_ascii_uppercase().as_str() {
            "T" => "TIME".to_owned(),
            "D" => "DATE".to_owned(),
            "B" => "BYTE".to_owned(),
            "W" => "WORD".to_owned(),
            "DW" => "DWORD".to_owned(),
            "L" => "DINT".to_owned(),
            prefix => prefix.to_owned(),
        },
        _ if value.contains('.') => "REAL".to_owned(),
        _ if value.trim_start_matches('-').parse::<i64>().is_ok_and(|it| it > 32767) => "DINT".to_owned(),
        _ => "INT".to_owned(),
    }
}
