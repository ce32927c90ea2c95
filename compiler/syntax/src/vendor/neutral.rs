//! Rungs of Logix as neutral text, `XIC(limit_switch_1)CTU(counter_1,10,0);`, among the declarations and statements of a file in
//! Structured Text. Rungs that follow one another are made statements as those of a routine are.

use super::assembly::{Assembly, Chunk, Says, Trouble};
use super::l5x::{Ladder, Logic, Names, Scope, Shown, Text, is_rung, shown, starts_as_rung, statements};
use super::unit::{after_comment, length_of_text};
use core::ops::Range;
use rustc_hash::FxHashMap;

/// The text with statements for its rungs; `None` where it has none.
pub fn read(text: &str) -> Option<Assembly> {
    // Every file is searched.
    memchr::memmem::find(text.as_bytes(), b"XI")?;
    if !["XIC(", "XIO("].iter().any(|it| text.contains(it)) {
        return None;
    }
    let mut scanner = Scanner::new(text);
    scanner.run();
    // One instruction alone may as well be a call.
    if !scanner.rungs.iter().any(|it| it.is_certain) || scanner.rungs.iter().any(|it| it.unit.is_none()) {
        return None;
    }
    Some(assembled(text, &scanner))
}

/// A rung, and where it is.
struct Found {
    place: Range<usize>,
    /// It can be nothing else.
    is_certain: bool,
    /// Rungs between which nothing is have one number.
    group: usize,
    /// The unit that it is in.
    unit: Option<usize>,
}

/// What holds declarations and statements, and how it begins.
enum Holds {
    /// A PROGRAM or a FUNCTION_BLOCK.
    Pou,
    /// It has the variables of its POU.
    Action,
    /// A FUNCTION or a METHOD.
    Routine,
    Test,
}

impl Holds {
    fn begun_by(word: &str) -> Option<Self> {
        let is = |it: &str| word.eq_ignore_ascii_case(it);
        match () {
            () if is("PROGRAM") || is("FUNCTION_BLOCK") => Some(Self::Pou),
            () if is("ACTION") => Some(Self::Action),
            () if is("FUNCTION") || is("METHOD") => Some(Self::Routine),
            () if is("TEST") => Some(Self::Test),
            () => None,
        }
    }
}

struct Unit<'t> {
    name: &'t str,
    kind: Holds,
    /// Where more variables may be declared.
    variables: usize,
}

struct Scanner<'t> {
    text: &'t str,
    at: usize,
    units: Vec<Unit<'t>>,
    /// Those that have not ended, the innermost last.
    open: Vec<usize>,
    rungs: Vec<Found>,
    group: usize,
    /// Whether the last that was read was a rung.
    in_group: bool,
}

impl<'t> Scanner<'t> {
    fn new(text: &'t str) -> Self {
        Self { text, at: 0, units: Vec::new(), open: Vec::new(), rungs: Vec::new(), group: 0, in_group: false }
    }

    fn run(&mut self) {
        // A rung is a statement: it begins where one may.
        let mut begins = true;
        while self.at < self.text.len() {
            let rest = &self.text[self.at..];
            if let Some(length) = blank(rest) {
                self.at += length;
                continue;
            }
            if begins && starts_as_rung(rest) && self.rung() {
                continue;
            }
            self.in_group = false;
            let word = word(rest);
            if word.is_empty() {
                begins = rest.starts_with(';');
                self.at += rest.chars().next().map_or(1, char::len_utf8);
                continue;
            }
            self.at += word.len();
            begins = self.keyword(word);
        }
    }

    /// Whether a statement begins after a word; notes units.
    fn keyword(&mut self, word: &'t str) -> bool {
        if let Some(kind) = Holds::begun_by(word) {
            self.unit(word, kind);
            return true;
        }
        let upper = word.to_ascii_uppercase();
        match upper.strip_prefix("END_") {
            Some("VAR") => {
                if let Some(unit) = self.open.last() {
                    self.units[*unit].variables = self.at;
                }
                true
            }
            Some(ended) if Holds::begun_by(ended).is_some() => {
                self.open.pop();
                true
            }
            Some(_) => false,
            None => ["THEN", "ELSE", "DO", "REPEAT"].contains(&upper.as_str()),
        }
    }

    /// Takes the heading of a unit, whose keyword was taken.
    fn unit(&mut self, keyword: &'t str, kind: Holds) {
        let name = match kind {
            Holds::Test => {
                // The title.
                self.pass_blank();
                keyword
            }
            Holds::Pou | Holds::Action | Holds::Routine => self.name(),
        };
        self.at += heading(&self.text[self.at..]);
        let variables = match kind {
            Holds::Action => self.pou().map(|it| it.variables),
            Holds::Pou | Holds::Routine | Holds::Test => None,
        };
        self.open.push(self.units.len());
        self.units.push(Unit { name, kind, variables: variables.unwrap_or(self.at) });
    }

    /// The POU that an ACTION here belongs to: the one around it, or the one before.
    fn pou(&self) -> Option<&Unit<'t>> {
        let open = self.open.iter().rev().map(|it| &self.units[*it]);
        open.chain(self.units.iter().rev()).find(|it| matches!(it.kind, Holds::Pou))
    }

    /// Takes a unit's name, after `FINAL` and the like.
    fn name(&mut self) -> &'t str {
        loop {
            self.pass_blank();
            let word = word(&self.text[self.at..]);
            self.at += word.len();
            if !MODIFIERS.iter().any(|it| word.eq_ignore_ascii_case(it)) {
                return word;
            }
        }
    }

    fn pass_blank(&mut self) {
        while let Some(length) = blank(&self.text[self.at..]) {
            self.at += length;
        }
    }

    /// Takes a rung, if one is here.
    fn rung(&mut self) -> bool {
        let rest = &self.text[self.at..];
        let length = rest.find(';').map_or(rest.len(), |it| it + 1);
        let Some(is_certain) = is_rung(&rest[..length]) else { return false };
        self.group += usize::from(!self.in_group);
        let unit = self.open.last().copied();
        self.rungs.push(Found { place: self.at..self.at + length, is_certain, group: self.group, unit });
        self.at += length;
        self.in_group = true;
        true
    }
}

const MODIFIERS: [&str; 8] =
    ["PUBLIC", "PRIVATE", "PROTECTED", "INTERNAL", "FINAL", "ABSTRACT", "OVERRIDE", "OVERLOAD"];

/// The length of what may follow a unit's name: `: INT`, `EXTENDS Base IMPLEMENTS Reader, Writer`.
fn heading(text: &str) -> usize {
    let mut at = 0;
    let mut end = 0;
    // A word belongs to the heading after one of these.
    let mut expects = false;
    while at < text.len() {
        let rest = &text[at..];
        let word = word(rest);
        if let Some(length) = blank(rest) {
            at += length;
        } else if let Some(':' | ',' | '.') = rest.chars().next() {
            at += 1;
            expects = true;
        } else if rest.starts_with(['[', '(']) {
            at += rest.find([']', ')']).map_or(rest.len(), |it| it + 1);
            end = at;
        } else if !word.is_empty() && (expects || continues_heading(word)) {
            at += word.len();
            end = at;
            expects = continues_heading(word);
        } else {
            break;
        }
    }
    end
}

/// Whether a word of a heading has another after it.
fn continues_heading(word: &str) -> bool {
    ["EXTENDS", "IMPLEMENTS", "ARRAY", "OF", "POINTER", "REFERENCE", "TO", "REF_TO"]
        .iter()
        .any(|it| word.eq_ignore_ascii_case(it))
}

/// The length of space, a comment, a pragma or a string.
fn blank(rest: &str) -> Option<usize> {
    let until = |end: &str, from: usize| rest[from..].find(end).map_or(rest.len(), |it| from + it + end.len());
    match rest.as_bytes() {
        [b' ' | b'\t' | b'\r' | b'\n', ..] => Some(1),
        [b'/', b'/', ..] => Some(until("\n", 2)),
        [b'/', b'*', ..] => Some(until("*/", 2)),
        [b'(', b'*', ..] => Some(rest.len() - after_comment(&rest[2..]).len()),
        [b'{', ..] => Some(until("}", 1)),
        [quote @ (b'\'' | b'"'), inner @ ..] => Some(1 + length_of_text(inner, *quote)),
        _ => None,
    }
}

fn word(rest: &str) -> &str {
    &rest[..rest.find(|it: char| !it.is_ascii_alphanumeric() && it != '_').unwrap_or(rest.len())]
}

/// What takes the place of a part of the text.
struct Edit {
    place: Range<usize>,
    chunks: Vec<Chunk>,
}

fn assembled(text: &str, scanner: &Scanner<'_>) -> Assembly {
    let (names, scope) = (Names::default(), Scope::default());
    let actions = scanner.units.iter().filter(|it| matches!(it.kind, Holds::Action));
    let actions = actions.map(|it| (it.name.to_ascii_lowercase(), it.name.to_owned())).collect();
    let logic = Logic {
        file: text,
        names: &names,
        scope: &scope,
        actions,
        subroutines: FxHashMap::default(),
        first_scan: None,
        main: "",
    };
    let mut edits = presets(text);
    let last = scanner.rungs.last().map_or(0, |it| it.group);
    let mut declared: Vec<(usize, String)> = Vec::new();
    for group in 1..=last {
        let rungs = || scanner.rungs.iter().filter(|it| it.group == group);
        let Some(unit) = rungs().find_map(|it| it.unit).map(|it| &scanner.units[it]) else { continue };
        let lines = rungs().enumerate();
        let texts: Vec<_> = lines.map(|(number, it)| rung_text(text, number, &it.place)).collect();
        let Ladder { chunks, variables } = statements(unit.name, &texts, &logic);
        for it in variables {
            let section = if matches!(unit.kind, Holds::Action) || it.is_shared { "VAR" } else { "VAR_TEMP" };
            declared.push((unit.variables, format!("{section} {} : {}; END_VAR", it.name, it.ty)));
        }
        let (first, last) = (rungs().next(), rungs().next_back());
        let (Some(first), Some(last)) = (first, last) else { continue };
        edits.push(Edit { place: first.place.start..last.place.end, chunks });
    }
    declared.sort();
    declared.dedup();
    for (at, words) in declared {
        edits.push(Edit { place: at..at, chunks: vec![Chunk::words(format!("\n{words}"), &(at..at))] });
    }
    edits.sort_by_key(|it| it.place.start);
    written(text, &edits)
}

fn rung_text(text: &str, number: usize, place: &Range<usize>) -> Text {
    Text::new(text, number.to_string(), vec![Chunk::verbatim(place.clone())], place.clone())
}

/// The text with its edits.
fn written(text: &str, edits: &[Edit]) -> Assembly {
    let mut out = Assembly::default();
    if !text.contains("{dialect") {
        out.write("{dialect 'logix'}\n", &(0..0));
    }
    let mut from = 0;
    for edit in edits {
        out.copy(text, &[Chunk::verbatim(from..edit.place.start)]);
        out.copy(text, &edit.chunks);
        from = edit.place.end;
    }
    out.copy(text, &[Chunk::verbatim(from..text.len())]);
    for problem in out.problems.iter_mut().filter(|it| it.trouble == Trouble::Odd) {
        problem.help =
            Some("write rungs as Logix's neutral text has them: `XIC(a)[XIO(b) ,XIC(c) ]OTE(d);`".to_owned());
    }
    out
}

/// The values that rungs show become those of a timer or counter that is declared once, by itself and without any: `delay : TIMER;`.
/// One that is declared with values has those; of any other a rung cannot show what it has.
fn presets(text: &str) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (name, (values, place)) in shown(text) {
        let (plain, is_given) = declarations(text, &name);
        let (at, says) = match (values, plain.as_slice()) {
            (Shown::Values { preset: 0, accum: 0 }, _) => continue,
            (_, []) if is_given => continue,
            (Shown::Values { preset, accum }, [end]) if !is_given => {
                (*end, Says::Words(format!(" := (PRE := {preset}, ACC := {accum})")))
            }
            (Shown::Values { preset, .. }, _) => {
                let message = format!(
                    "a rung shows the preset {preset} of `{name}`, which no declaration gives it: declare it once, by \
                     itself, with `:= (PRE := {preset})`, or write `?` in the rung"
                );
                (0, Says::Wrong(Trouble::Odd, message))
            }
            (Shown::Several, _) => {
                let message = format!("rungs show different values of `{name}`, and its declaration has none");
                (0, Says::Wrong(Trouble::Odd, message))
            }
        };
        let place = if at == 0 { place } else { at..at };
        edits.push(Edit { place: at..at, chunks: vec![Chunk { place, says }] });
    }
    edits
}

/// Where the declarations end of a timer or counter by itself that has no values, and whether there are some with values.
fn declarations(text: &str, name: &str) -> (Vec<usize>, bool) {
    let lower = text.to_ascii_lowercase();
    let is_name = |it: char| it.is_ascii_alphanumeric() || it == '_';
    let (mut plain, mut is_given) = (Vec::new(), false);
    for (at, _) in lower.match_indices(name).filter(|(at, _)| !lower[..*at].ends_with(is_name)) {
        let rest = lower[at + name.len()..].trim_start();
        let Some(rest) = rest.strip_prefix(':').map(str::trim_start) else { continue };
        let Some(ty) = ["timer", "counter"].iter().find(|it| rest.starts_with(**it)) else { continue };
        let after = rest[ty.len()..].trim_start();
        is_given |= after.starts_with(":=");
        // The last of several that are declared together is not by itself.
        if after.starts_with(';') && !lower[..at].trim_end().ends_with(',') {
            plain.push(lower.len() - rest.len() + ty.len());
        }
    }
    (plain, is_given)
}
