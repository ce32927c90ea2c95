//! A trace as a value change dump (IEEE 1364), for waveform viewers.

use super::{Row, Sink, Subject};
use crate::column::Column;
use crate::map::Type;
use crate::value;
use staunch_runtime::{Repr, Value};
use std::io::{self, Write};

pub(super) struct Waves {
    out: Box<dyn Write>,
    /// What each column showed last.
    before: Vec<String>,
    /// The last time that was written.
    time: Option<i64>,
    /// When the last row was.
    end: Option<i64>,
}

/// How a viewer keeps a value.
enum Kind {
    Bits(Repr),
    Real,
    /// An extension that all common viewers read.
    Text,
}

fn kind(ty: Type) -> Kind {
    match ty {
        Type::Elementary(it) if it.repr().is_float() => Kind::Real,
        Type::Elementary(it) => Kind::Bits(it.repr()),
        Type::Bit(_) | Type::Reference => Kind::Text,
        Type::String(_) | Type::Characters(_) | Type::Enum(_) | Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
            Kind::Text
        }
    }
}

impl Waves {
    pub fn new(mut out: Box<dyn Write>, subject: &Subject<'_>) -> io::Result<Self> {
        writeln!(out, "$version Staunch $end\n$timescale 1 ns $end")?;
        let mut open: Vec<String> = vec![word(&subject.title)];
        writeln!(out, "$scope module {} $end", open[0])?;
        for (number, column) in subject.columns.iter().enumerate() {
            let (mut scopes, name) = path(&column.heading);
            scopes.insert(0, open[0].clone());
            let common = open.iter().zip(&scopes).take_while(|(a, b)| a == b).count();
            for _ in common..open.len() {
                writeln!(out, "$upscope $end")?;
            }
            for scope in &scopes[common..] {
                writeln!(out, "$scope module {scope} $end")?;
            }
            open = scopes;
            declare(&mut out, column, &name, number)?;
        }
        for _ in &open {
            writeln!(out, "$upscope $end")?;
        }
        writeln!(out, "$enddefinitions $end")?;
        Ok(Self { out, before: vec![String::new(); subject.columns.len()], time: None, end: None })
    }
}

fn declare(out: &mut dyn Write, column: &Column, name: &str, number: usize) -> io::Result<()> {
    let code = code(number);
    match kind(column.place.ty) {
        Kind::Bits(Repr::Bool) => writeln!(out, "$var wire 1 {code} {name} $end"),
        Kind::Bits(repr) => writeln!(out, "$var integer {} {code} {name} $end", repr.size() * 8),
        Kind::Real => writeln!(out, "$var real 64 {code} {name} $end"),
        Kind::Text => writeln!(out, "$var string 1 {code} {name} $end"),
    }
}

/// The scopes and the name of a heading.
fn path(heading: &str) -> (Vec<String>, String) {
    if heading.starts_with('%') {
        return (Vec::new(), word(heading));
    }
    let mut parts: Vec<String> = heading.split('.').map(word).collect();
    let name = parts.pop().unwrap_or_default();
    (parts, name)
}

/// Space would end a name.
fn word(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join("_")
}

/// A string without what would end it. Viewers read the escapes of C.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '\\' => out.push_str("\\\\"),
            it if it.is_control() || it.is_whitespace() => {
                let octal = |byte: &u8| format!("\\{byte:03o}");
                out.extend(it.encode_utf8(&mut [0; 4]).as_bytes().iter().map(octal));
            }
            it => out.push(it),
        }
    }
    out
}

/// The short name of a column: printable characters from `!` to `~`.
fn code(mut number: usize) -> String {
    let mut code = String::new();
    loop {
        code.push(char::from(b'!' + (number % 94) as u8));
        number /= 94;
        if number == 0 {
            return code;
        }
        number -= 1;
    }
}

impl Sink for Waves {
    fn row(&mut self, subject: &Subject<'_>, row: Row<'_>) -> io::Result<()> {
        let first = self.time.is_none();
        self.end = Some(row.time);
        for (number, column) in subject.columns.iter().enumerate() {
            let text = change(subject, column, row.state);
            if text == self.before[number] {
                continue;
            }
            if self.time != Some(row.time) {
                writeln!(self.out, "#{}", row.time)?;
                self.time = Some(row.time);
                if first {
                    writeln!(self.out, "$dumpvars")?;
                }
            }
            writeln!(self.out, "{text}{}", code(number))?;
            self.before[number] = text;
        }
        if first && self.time.is_some() {
            writeln!(self.out, "$end")?;
        }
        Ok(())
    }

    /// The last row may have changed nothing, and still the run lasted until then.
    fn finish(&mut self, _subject: &Subject<'_>) -> io::Result<()> {
        match self.end {
            end if end != self.time => end.map_or(Ok(()), |end| writeln!(self.out, "#{end}")),
            _ => Ok(()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// A value change, without the column's code.
fn change(subject: &Subject<'_>, column: &Column, state: &[u8]) -> String {
    let bytes = &state[column.place.offset..];
    match kind(column.place.ty) {
        Kind::Bits(repr) => match Value::read(repr, bytes) {
            Value::Bool(it) => u8::from(it).to_string(),
            it => {
                let width = repr.size() as usize * 8;
                let bits = it.as_integer().unwrap_or(0) as u128 & (u128::MAX >> (128 - width));
                format!("b{bits:b} ")
            }
        },
        Kind::Real => {
            let number = value::number(subject.map, column.place.ty, bytes).unwrap_or(0.0);
            format!("r{number} ")
        }
        Kind::Text => {
            let mut text = String::new();
            subject.cell(column, state, &mut text);
            format!("s{} ", escaped(&text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::columns;
    use crate::fixture::map;
    use crate::trace::tests::{texts_written, written};

    #[test]
    fn only_changes_are_written() {
        let map = map();
        let columns = columns(&map, &[0], Some("up,c.CV,name,speed,m[1,2]")).unwrap();
        let subject =
            Subject { map: &map, columns, overlays: Vec::new(), title: "Garage".to_owned(), cycle: 10_000_000 };
        let text = written(&subject, |out| Box::new(Waves::new(out, &subject).unwrap()));
        assert_eq!(
            text,
            "$version Staunch $end
$timescale 1 ns $end
$scope module Garage $end
$var wire 1 ! up $end
$scope module c $end
$var integer 16 \" CV $end
$upscope $end
$var string 1 # name $end
$var real 64 $ speed $end
$var integer 16 % m[1,2] $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0!
b0 \"
s #
r0 $
b0 %
$end
#10000000
1!
b1 \"
sa,b #
b1111111111111111 %
#10250000
r0.5 $
"
        );
    }

    #[test]
    fn different_texts_stay_different() {
        let map = map();
        let columns = columns(&map, &[0], Some("name")).unwrap();
        let subject =
            Subject { map: &map, columns, overlays: Vec::new(), title: "Garage".to_owned(), cycle: 10_000_000 };
        let texts = ["a b", "a\nb", "a_b", "\0", "\\000", "ä", "\u{a0}"];
        let vcd = texts_written(&subject, &texts, |out| Box::new(Waves::new(out, &subject).unwrap()));
        let changes: Vec<_> = vcd.lines().filter_map(|it| it.strip_prefix('s')).collect();
        let expected = ["a\\040b !", "a\\012b !", "a_b !", "\\000 !", "\\\\000 !", "ä !", "\\302\\240 !"];
        assert_eq!(changes, expected);
    }

    #[test]
    fn codes_do_not_repeat() {
        let codes: std::collections::HashSet<String> = (0..20_000).map(code).collect();
        assert_eq!(codes.len(), 20_000);
    }
}
