//! Statements of a routine: Structured Text but for its operands. An alias is written as what it names, a module's tag as
//! its variable, `JSR(Fill)` as `Fill()`, and a call of an Add-On Instruction, `Valve(valve_1, open, closed)`, as one of
//! its tag: `valve_1(EnableIn := TRUE, Open := open, Closed => closed)`.

use super::super::assembly::{Assembly, Chunk, Mark, Says, Trouble};
use super::names::{Names, Operand, Scope, is_of_statements, key, legal, plain};
use super::service::controller_service;
use core::ops::Range;
use rustc_hash::FxHashMap;

/// The parameters of a routine in ladder.
#[derive(Clone, Debug)]
pub enum Subroutine {
    Known {
        /// The operands of its `SBR`.
        inputs: Vec<Vec<Chunk>>,
        /// Of each `RET` that has operands, in the order of the rungs.
        returns: Vec<Vec<Vec<Chunk>>>,
    },
    /// It cannot be read.
    Unknown,
}

/// What the operands of a program or an instruction are.
pub struct Logic<'a> {
    pub file: &'a str,
    pub names: &'a Names,
    pub scope: &'a Scope,
    /// Routines, and the actions that they are.
    pub actions: FxHashMap<String, String>,
    /// What routines in ladder take and give.
    pub subroutines: FxHashMap<String, Subroutine>,
    /// The variable that is `S:FS`.
    pub first_scan: Option<String>,
    /// The main routine of a program.
    pub main: &'a str,
}

impl Logic<'_> {
    /// The type of an operand, where it is known.
    pub fn type_of(&self, operand: &str) -> Option<String> {
        let own = self.names.type_of(operand, self.scope);
        own.or_else(|| self.names.type_of(operand, &self.names.controller))
    }
}

impl Logic<'_> {
    /// Whether an operand is a tag that is not an array.
    pub fn is_single(&self, operand: &str) -> bool {
        let name = key(operand);
        let is = |it: &Scope| it.types.contains_key(&name) && !it.arrays.contains(&name);
        if self.scope.tags.contains(&name) { is(self.scope) } else { is(&self.names.controller) }
    }
}

/// Writes the chunks of a routine.
pub fn write(logic: &Logic<'_>, chunks: &[Chunk], out: &mut Assembly) {
    let mut writer = Writer { logic, out, comment: None, depth: 0, calls: Vec::new(), after_dot: false };
    for chunk in chunks {
        match chunk.says {
            Says::Itself => writer.line(chunk.place.clone()),
            Says::Symbol(_) | Says::Words(_) | Says::Wrong(..) => {
                writer.out.copy(logic.file, core::slice::from_ref(chunk))
            }
        }
    }
}

struct Writer<'a, 'o> {
    logic: &'a Logic<'a>,
    out: &'o mut Assembly,
    /// How the comment ends that is open.
    comment: Option<&'static str>,
    /// How many parentheses and brackets are open.
    depth: usize,
    calls: Vec<Call<'a>>,
    after_dot: bool,
}

/// A call of an Add-On Instruction that is open.
struct Call<'a> {
    name: &'a str,
    /// Its name in the file.
    place: Range<usize>,
    /// What was written before it.
    mark: Option<Mark>,
    /// What it takes after its tag.
    operands: &'a [Operand],
    /// How many are given, with its tag.
    given: usize,
    /// Where the first begins that is one too many.
    surplus: Option<usize>,
    depth: usize,
}

/// A piece of a line, and what is written for it.
enum Piece {
    Itself,
    Words(String),
    /// Why it is refused; it is left out.
    Refused(String),
    /// It ends a call that has other operands than its instruction takes: why the call is refused, and where.
    Miscounted(Mark, String, Range<usize>),
    /// Why it is refused, and what is read in its place.
    Instead(String, &'static str),
}

impl<'a> Writer<'a, '_> {
    fn line(&mut self, place: Range<usize>) {
        let text = &self.logic.file[place.clone()];
        // What is not yet copied.
        let mut from = 0;
        let mut at = 0;
        while at < text.len() {
            let (length, piece) = self.token(text, at, place.start + at);
            let token = at..at + length.max(1);
            at = token.end;
            if matches!(piece, Piece::Itself) {
                continue;
            }
            self.copy(&place, from..token.start);
            self.piece(piece, &(place.start + token.start..place.start + token.end));
            from = at;
        }
        self.copy(&place, from..text.len());
    }

    fn piece(&mut self, piece: Piece, token: &Range<usize>) {
        let (message, words) = match piece {
            Piece::Itself => return,
            Piece::Miscounted(mark, message, place) => {
                self.out.rewind(mark);
                return self.out.problem(Trouble::Odd, message, &place);
            }
            Piece::Words(words) => (None, words),
            Piece::Refused(message) => (Some(message), String::new()),
            Piece::Instead(message, words) => (Some(message), words.to_owned()),
        };
        if let Some(call) = self.calls.last_mut() {
            call.mark.get_or_insert_with(|| self.out.mark());
        }
        if let Some(message) = message {
            self.out.problem(Trouble::NotSupported, message, token);
        }
        if !words.is_empty() {
            self.out.write(&words, token);
        }
    }

    fn copy(&mut self, place: &Range<usize>, part: Range<usize>) {
        if !part.is_empty() {
            let part = place.start + part.start..place.start + part.end;
            self.out.copy(self.logic.file, &[Chunk::verbatim(part)]);
        }
    }

    /// The length of what begins at a byte of a line, which is at `place` of the file, and what is written for it.
    fn token(&mut self, text: &'a str, at: usize, place: usize) -> (usize, Piece) {
        let rest = &text[at..];
        if let Some(close) = self.comment {
            let end = rest.find(close).map(|it| it + close.len());
            self.comment = if end.is_some() { None } else { Some(close) };
            return (end.unwrap_or(rest.len()), Piece::Itself);
        }
        let after_dot = core::mem::take(&mut self.after_dot);
        let first = rest.bytes().next().unwrap_or_default();
        match first {
            b'/' if rest.starts_with("//") => (rest.find('\n').unwrap_or(rest.len()), Piece::Itself),
            b'#' if rest.starts_with("#region") || rest.starts_with("#endregion") => {
                (rest.find('\n').unwrap_or(rest.len()), Piece::Words(String::new()))
            }
            b'(' | b'/' if rest.starts_with("(*") || rest.starts_with("/*") => {
                self.comment = Some(if first == b'(' { "*)" } else { "*/" });
                (2, Piece::Itself)
            }
            b'\'' => (string(rest), Piece::Itself),
            b'[' if rest.starts_with("[:=]") => (4, Piece::Itself),
            b'\\' => {
                let name = &rest[..1 + word(&rest[1..], "_.")];
                let message = format!("`{name}` is a tag of another program, which cannot be reached here");
                (name.len(), Piece::Instead(message, "0"))
            }
            b'(' | b'[' => {
                self.depth += 1;
                (1, Piece::Itself)
            }
            b')' | b']' => (1, self.close(place)),
            b',' => (1, self.comma(rest, place)),
            b'.' => {
                self.after_dot = true;
                (1, Piece::Itself)
            }
            b'0'..=b'9' => (word(rest, "_#"), Piece::Itself),
            b'A'..=b'Z' | b'a'..=b'z' | b'_' if after_dot => {
                let length = word(rest, "_");
                (length, legal(&rest[..length]).map_or(Piece::Itself, Piece::Words))
            }
            b'A'..=b'Z' | b'a'..=b'z' | b'_' => self.name(rest, place),
            b' ' | b'\t' => {
                self.after_dot = after_dot;
                (1, Piece::Itself)
            }
            _ => (rest.chars().next().map_or(1, char::len_utf8), Piece::Itself),
        }
    }

    fn name(&mut self, rest: &'a str, place: usize) -> (usize, Piece) {
        let name = &rest[..word(rest, "_")];
        let after = rest[name.len()..].trim_start();
        let scope = self.logic.scope;
        if let Some(flag) = status_flag(rest) {
            if let Some(first_scan) = self.logic.first_scan.as_ref().filter(|_| flag.eq_ignore_ascii_case(FIRST_SCAN)) {
                return (flag.len(), Piece::Words(first_scan.clone()));
            }
            let message = format!("`{flag}`, a status flag of the controller, is not supported");
            return (flag.len(), Piece::Instead(message, "FALSE"));
        }
        if let Some((length, variable)) = self.module(rest) {
            return (length, Piece::Words(variable));
        }
        // Tags and instructions have names of their own: a tag is never called.
        let is_called = after.starts_with('(') && !after.starts_with("(*");
        if is_called {
            let open = rest.len() - after.len() + 1;
            if let Some(operands) = self.logic.names.instructions.get(&key(name)) {
                self.depth += 1;
                self.calls.push(Call {
                    name,
                    place: place..place + name.len(),
                    mark: None,
                    operands,
                    given: usize::from(!rest[open..].trim_start().starts_with(')')),
                    surplus: None,
                    depth: self.depth,
                });
                return (open, Piece::Words(String::new()));
            }
            if let Some(close) = closing(&rest[open..]) {
                // Its operands are not values: some are left out, some are names of the controller.
                if let Some(service) = controller_service(name) {
                    let message = format!("`{}` is not supported: {service}", name.to_ascii_uppercase());
                    return (open + close + 1, Piece::Refused(message));
                }
                let inside = &rest[open..open + close];
                let piece = match name.to_ascii_uppercase().as_str() {
                    "JSR" => self.subroutine(inside),
                    "RET" if inside.trim().is_empty() => Piece::Words("RETURN".to_owned()),
                    "SBR" | "NOP" if inside.trim().is_empty() => Piece::Words(String::new()),
                    "RET" | "SBR" => Piece::Refused("a subroutine's parameters are not supported".to_owned()),
                    _ => return (name.len(), Piece::Itself),
                };
                return (open + close + 1, piece);
            }
        }
        if is_called {
            return (name.len(), Piece::Itself);
        }
        let is_tag = |it: &Scope| it.tags.contains(&key(name));
        // Where it may be an operator, it is one.
        let own = || {
            legal(name)
                .filter(|_| !is_of_statements(name))
                .filter(|_| is_tag(scope) || is_tag(&self.logic.names.controller))
        };
        let piece = self.logic.names.meaning(name, scope).or_else(own).map_or(Piece::Itself, Piece::Words);
        (name.len(), piece)
    }

    /// `Local:1:I`. One that the file does not describe is an unknown name; `Filling:` before a statement is a label.
    fn module(&self, rest: &str) -> Option<(usize, String)> {
        let name = rest[..word(rest, "_:")].trim_end_matches(':');
        if !name.contains(':') {
            return None;
        }
        let known = self.logic.names.modules.get(&key(name)).cloned();
        let last = name.rsplit(':').next().unwrap_or_default();
        let is_connection = last.starts_with(['I', 'O', 'C', 'S']) && last[1..].bytes().all(|it| it.is_ascii_digit());
        let is_one = is_connection && name.matches(':').count() == 2;
        let variable = known.or_else(|| is_one.then(|| plain(name)))?;
        Some((name.len(), variable))
    }

    /// `Fill` or `Fill, 0`: what is in the parentheses of a JSR.
    fn subroutine(&self, inside: &str) -> Piece {
        let mut operands = inside.split(',').map(str::trim);
        let name = operands.next().unwrap_or_default();
        if !operands.all(|it| it == "0") {
            return Piece::Refused(format!("`{name}` is called with parameters, which subroutines cannot have here"));
        }
        if name.eq_ignore_ascii_case(self.logic.main) {
            return Piece::Refused(format!("`{name}` is the main routine, which would call itself"));
        }
        match self.logic.actions.get(&key(name)) {
            Some(action) => Piece::Words(format!("{action}()")),
            None => Piece::Refused(format!("the program has no routine `{name}`")),
        }
    }

    fn close(&mut self, place: usize) -> Piece {
        let call = self.calls.pop_if(|it| it.depth == self.depth);
        self.depth = self.depth.saturating_sub(1);
        match call {
            Some(call) if call.given != call.operands.len() + 1 => call.miscounted(self.logic.file, place),
            Some(Call { given: 1, .. }) => Piece::Words("(EnableIn := TRUE)".to_owned()),
            Some(_) | None => Piece::Itself,
        }
    }

    fn comma(&mut self, rest: &str, place: usize) -> Piece {
        let depth = self.depth;
        let Some(call) = self.calls.last_mut().filter(|it| it.depth == depth) else { return Piece::Itself };
        let before = if call.given > 1 { ", " } else { "(EnableIn := TRUE, " };
        let operand = call.operands.get(call.given.saturating_sub(1));
        call.given += 1;
        match operand {
            Some(it) => Piece::Words(format!("{before}{} {} ", it.name, if it.is_output { "=>" } else { ":=" })),
            None => {
                let after = rest[1..].trim_start();
                call.surplus.get_or_insert(place + rest.len() - after.len());
                Piece::Itself
            }
        }
    }
}

impl Call<'_> {
    /// What is said of it where it ends.
    fn miscounted(&self, file: &str, end: usize) -> Piece {
        let names: String = self.operands.iter().map(|it| format!(", `{}`", it.name)).collect();
        let (name, given, takes) = (self.name, self.given, self.operands.len() + 1);
        let order = if names.is_empty() { "" } else { ", in this order" };
        let many = if given == 1 { "operand" } else { "operands" };
        let message =
            format!("`{name}` takes a tag of the type `{name}`{names}{order}: {given} {many} instead of {takes}");
        let place = match self.surplus {
            Some(surplus) if !file[surplus..end].contains(['\n', '\r']) => surplus..end,
            _ if !file[self.place.start..end].contains(['\n', '\r']) => self.place.start..end + 1,
            _ => self.place.clone(),
        };
        match self.mark {
            Some(mark) => Piece::Miscounted(mark, message, place),
            None => Piece::Itself,
        }
    }
}

pub const FIRST_SCAN: &str = "S:FS";

/// `S:FS`, the flag of the first scan, and the flags of the last operation.
fn status_flag(rest: &str) -> Option<&str> {
    let name = &rest[..word(rest, "_:")];
    let flags = ["S:FS", "S:N", "S:Z", "S:V", "S:C", "S:MINOR"];
    flags.iter().any(|it| it.eq_ignore_ascii_case(name)).then_some(name)
}

/// The length of a word that a line begins with.
fn word(rest: &str, more: &str) -> usize {
    rest.find(|it: char| !it.is_ascii_alphanumeric() && !more.contains(it)).unwrap_or(rest.len())
}

/// The length of the string that a line begins with; one that does not end is left to be reported.
fn string(rest: &str) -> usize {
    let mut is_escaped = false;
    for (at, it) in rest.char_indices().skip(1) {
        match it {
            _ if is_escaped => is_escaped = false,
            '$' => is_escaped = true,
            '\'' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Where the parenthesis ends that is open before a text.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 1_usize;
    for (at, it) in text.bytes().enumerate() {
        match it {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}
