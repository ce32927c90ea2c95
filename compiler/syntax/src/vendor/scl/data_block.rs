//! A data block: a variable of its structure, or of the type or block that it names.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::{Kind, Scl};
use core::ops::Range;
use rustc_hash::FxHashMap;

/// The values of a data block's members, by their names.
#[derive(Default)]
struct Values {
    members: Vec<(String, Range<usize>, Value)>,
    /// Where a member is whose members have values, by its name in lower case. One that has a
    /// value as a whole as well is in it twice, which is an error like any other.
    wholes: FxHashMap<String, usize>,
}

enum Value {
    /// What the file says.
    Written(Range<usize>),
    Members(Values),
}

impl Scl<'_> {
    /// `DATA_BLOCK "Plant" … BEGIN … END_DATA_BLOCK`
    pub fn data_block(&mut self) {
        let head = self.place(self.at);
        let (name, place) = (self.global_name(self.at + 1), self.place(self.at + 1));
        self.replace(head.start..place.end, "");
        self.at += 2;
        let mut is_retained = self.attributes();
        let ty = if self.is(self.at, "VAR") || self.is(self.at, "STRUCT") {
            // A structure is retained as a whole, an instance by its sections.
            let (open, close) = match self.is_retained_in_part() && !is_retained {
                true => ("FUNCTION_BLOCK {}\n", "END_FUNCTION_BLOCK\n"),
                false => ("TYPE {} : STRUCT\n", "END_STRUCT; END_TYPE\n"),
            };
            let is_structure = close.starts_with("END_STRUCT");
            let ty = format!("{name}_data");
            self.out.write(&open.replace("{}", &ty), &place);
            is_retained |= self.structure(is_structure) && is_structure;
            self.out.write(close, &place);
            ty
        } else {
            let ty = self.global_name(self.at);
            let is_word = self.token(self.at).is_some_and(|it| it.kind == Kind::Word);
            let place = self.place(self.at);
            self.replace(place, "");
            self.at += 1;
            if is_word && super::counter::is_one(&ty.to_ascii_uppercase()) { self.counter(&ty, &name) } else { ty }
        };
        let values = self.values();
        let retain = if is_retained { "RETAIN " } else { "" };
        self.out.write(&format!("VAR_GLOBAL {retain}"), &place);
        self.out.write(&name, &place);
        self.out.write(" : ", &place);
        self.out.write(&ty, &place);
        if !values.members.is_empty() {
            self.out.write(" := ", &place);
            values.write(self.file, &mut self.out);
        }
        self.out.write("; END_VAR\n", &place);
    }

    /// Passes over what is noted in the head; whether all of the block is retained.
    fn attributes(&mut self) -> bool {
        let mut is_retained = false;
        loop {
            self.notes();
            if !["NON_RETAIN", "RETAIN", "READ_ONLY", "UNLINKED"].iter().any(|it| self.is(self.at, it)) {
                return is_retained;
            }
            is_retained |= self.is(self.at, "RETAIN");
            let place = self.place(self.at);
            self.replace(place, "");
            self.at += 1;
        }
    }

    /// Whether some of the sections are retained, and others are not.
    fn is_retained_in_part(&self) -> bool {
        let is_end = |it: &usize| self.is(*it, "BEGIN") || self.is(*it, "END_DATA_BLOCK");
        let tokens = (self.at..self.tokens.len()).take_while(|it| !is_end(it));
        let sections: Vec<_> = tokens.filter(|it| self.is(*it, "VAR")).map(|it| self.is(it + 1, "RETAIN")).collect();
        sections.contains(&true) && sections.contains(&false)
    }

    /// The members, in one structure or in sections, which are left out if they become one; whether they are retained.
    fn structure(&mut self, is_one: bool) -> bool {
        let mut retained = false;
        while !self.is(self.at, "BEGIN") && !self.is(self.at, "END_DATA_BLOCK") && self.at < self.tokens.len() {
            let start = self.place(self.at);
            let is_section = self.is(self.at, "VAR");
            let end = if is_section { "END_VAR" } else { "END_STRUCT" };
            self.at += 1;
            let retains = is_section && self.is(self.at, "RETAIN");
            let has_word = retains || self.is(self.at, "NON_RETAIN");
            let opened = if has_word { self.place(self.at).end } else { start.end };
            self.at += usize::from(has_word);
            let section = if retains { "VAR_INPUT RETAIN\n" } else { "VAR_INPUT\n" };
            self.replace(start.start..opened, if is_one { "" } else { section });
            retained |= retains;
            let mut depth = 0_usize;
            while self.at < self.tokens.len() && !(depth == 0 && self.is(self.at, end)) {
                depth += usize::from(self.is(self.at, "STRUCT"));
                depth = depth.saturating_sub(usize::from(self.is(self.at, "END_STRUCT")));
                self.simple();
            }
            let close = self.place(self.at);
            self.at += 1;
            let has_sign = self.text(self.at) == ";";
            let end = if has_sign { self.place(self.at).end } else { close.end };
            self.at += usize::from(has_sign);
            self.replace(close.start..end, if is_one { "" } else { "END_VAR\n" });
            self.notes();
        }
        retained
    }

    /// `a := 1; b.c := 2;` between BEGIN and the end.
    fn values(&mut self) -> Values {
        let mut values = Values::default();
        let from = self.place(self.at).start;
        self.at += usize::from(self.is(self.at, "BEGIN"));
        while self.at < self.tokens.len() && !self.is(self.at, "END_DATA_BLOCK") {
            let start = self.at;
            let mut sign = None;
            while self.at < self.tokens.len() && self.text(self.at) != ";" && !self.is(self.at, "END_DATA_BLOCK") {
                if sign.is_none() && self.text(self.at) == ":" && self.text(self.at + 1) == "=" {
                    sign = Some(self.at);
                }
                self.at += 1;
            }
            let end = self.at;
            self.at += usize::from(self.text(self.at) == ";");
            match sign {
                Some(sign) if start < sign && sign + 2 < end => {
                    self.value(&mut values, start..sign, sign + 2..end);
                }
                _ if start < end => self.no_value(start..end),
                _ => {}
            }
        }
        let end = self.place(self.at).end;
        self.at += 1;
        self.replace(from..end, "");
        values
    }

    /// What lacks its member, its value or the sign between them.
    fn no_value(&mut self, tokens: Range<usize>) {
        let place = self.place(tokens.start).start..self.place(tokens.end - 1).end;
        let message = "an initial value of a data block is `member := value;`".to_owned();
        self.copied = place.start;
        self.problem(Trouble::Odd, place, message);
    }

    /// A value for a path of members and elements.
    fn value(&mut self, values: &mut Values, path: Range<usize>, value: Range<usize>) {
        let place = self.place(path.start).start..self.place(path.end - 1).end;
        let names = self.path(path);
        let is_plain = value
            .clone()
            .all(|at| matches!(self.token(at).map(|it| it.kind), Some(Kind::Other | Kind::Word | Kind::Literal)));
        let Some(names) = names.filter(|_| is_plain) else {
            let text = &self.file[place.clone()];
            // What is before it is written with the variable.
            self.copied = place.start;
            return self
                .refuse(place, format!("the initial value of `{text}` is not read: declare it with its variable"));
        };
        let written = self.place(value.start).start..self.place(value.end - 1).end;
        values.set(names.into_iter(), written);
    }

    /// `Lines[2].Name`, as `Lines[2]` and `Name`; `None` for what is not a path.
    fn path(&self, tokens: Range<usize>) -> Option<Vec<(String, Range<usize>)>> {
        let mut names = Vec::new();
        let mut at = tokens.start;
        while at < tokens.end {
            let start = self.place(at);
            let is_name = matches!(self.token(at)?.kind, Kind::Word | Kind::Quoted | Kind::Local);
            let mut name = is_name.then(|| self.name(at))?;
            let mut end = start.end;
            at += 1;
            while at < tokens.end && self.text(at) == "[" {
                let close = (at..tokens.end).find(|it| self.text(*it) == "]")?;
                for token in at..=close {
                    let is_named = matches!(self.token(token)?.kind, Kind::Quoted | Kind::Local);
                    name.push_str(&if is_named { self.name(token) } else { self.text(token).to_owned() });
                }
                end = self.place(close).end;
                at = close + 1;
            }
            names.push((name, start.start..end));
            let is_last = at == tokens.end;
            if !is_last && (self.text(at) != "." || at + 1 == tokens.end) {
                return None;
            }
            at += 1;
        }
        Some(names)
    }
}

impl Values {
    fn set(&mut self, mut path: impl Iterator<Item = (String, Range<usize>)>, written: Range<usize>) {
        let Some((name, place)) = path.next() else { return };
        let mut rest = path.peekable();
        if rest.peek().is_none() {
            self.members.push((name, place, Value::Written(written)));
            return;
        }
        let at = *self.wholes.entry(name.to_ascii_lowercase()).or_insert_with(|| {
            self.members.push((name, place, Value::Members(Self::default())));
            self.members.len() - 1
        });
        if let Value::Members(inner) = &mut self.members[at].2 {
            inner.set(&mut rest as &mut dyn Iterator<Item = _>, written);
        }
    }

    fn write(&self, file: &str, out: &mut Assembly) {
        for (at, (name, place, value)) in self.members.iter().enumerate() {
            out.write(if at == 0 { "(" } else { ", " }, place);
            out.write(name, place);
            out.write(" := ", place);
            match value {
                Value::Written(written) => out.copy(file, &[Chunk::verbatim(written.clone())]),
                Value::Members(inner) => inner.write(file, out),
            }
            if at + 1 == self.members.len() {
                out.write(")", place);
            }
        }
    }
}
