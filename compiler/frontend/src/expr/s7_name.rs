//! Names of S7 that are not declared: tags and blocks in quotes, and addresses without their `%`.

use super::checker::Checker;
use crate::diagnostic::Missing;
use crate::dialect::Dialect;
use crate::spelling::Key;
use crate::{Diagnostic, ast};

impl<'s> Checker<'_, 's> {
    /// What to do about a name of SCL that means nothing here.
    pub(super) fn help_on_s7_name(&self, name: ast::Name<'s>, error: &Diagnostic) -> Option<Diagnostic> {
        if self.decl.dialect(name.span) != Dialect::Siemens {
            return None;
        }
        let (quoted, after) = self.name_as_written(name)?;
        if let Some(address) = address(name.text, after) {
            return Some(self.help_on_address(name, &address, error));
        }
        if is_data_block(name.text) && after.trim_start().get(..3).is_some_and(|it| it.eq_ignore_ascii_case(".DB")) {
            let error = error.clone().label("this is an address in a data block");
            return Some(error.help("write the member at this address by its name: `\"Data\".member`"));
        }
        let text = quoted?;
        // A name that a local variable has too is one of a list.
        let error = match Key(text) == Key(name.text) {
            true => error.clone(),
            false => Diagnostic::missing(Missing::Variable, text, name.span),
        };
        let error = error.label("a name in quotes is a PLC tag, a data block or a block of the project");
        Some(match after.trim_start().starts_with(['.', '(']) {
            true => error.help(format!("add the source of the block: `DATA_BLOCK \"{text}\" … END_DATA_BLOCK`")),
            false => error.help(format!(
                "for a PLC tag, add a file `tags.st` that declares it: `VAR_GLOBAL {text} AT %I0.0 : BOOL; END_VAR`"
            )),
        })
    }

    /// What a name is in quotes in its file, where it is in some.
    pub(super) fn name_in_quotes(&self, name: ast::Name<'s>) -> Option<&str> {
        self.name_as_written(name)?.0
    }

    /// What is between the quotes of a name, if it has some, and the text after it.
    fn name_as_written(&self, name: ast::Name<'s>) -> Option<(Option<&str>, &str)> {
        let sources = &self.decl.log.sources;
        let place = sources.get(name.span.file).in_file(name.span);
        let text = sources.file(name.span.file).text.get(usize::try_from(place.start).ok()?..)?;
        Some(match text.strip_prefix('"').and_then(|it| it.split_once('"')) {
            Some((inner, after)) => (Some(inner), after),
            None => (None, text.get(name.text.len()..)?),
        })
    }

    /// A source of SCL has no addresses here; Structured Text has, with a `%`.
    fn help_on_address(&self, name: ast::Name<'s>, address: &str, error: &Diagnostic) -> Diagnostic {
        let sources = &self.decl.log.sources;
        let is_scl = sources.get(name.span.file).text.starts_with("{dialect 'siemens'}");
        let error = error.clone().label("this is an absolute address");
        if !is_scl {
            let meant = address.split_once('.').map_or(address, |it| it.0);
            return error.help(format!("an absolute address is written with `%`: `{address}`")).fix(name.span, meant);
        }
        let ty = match address.as_bytes().get(2) {
            Some(b'B') => "BYTE",
            Some(b'W') => "WORD",
            Some(b'D') => "DWORD",
            _ => "BOOL",
        };
        error.help(format!(
            "declare a PLC tag in a file `tags.st`, `VAR_GLOBAL Tag_1 AT {address} : {ty}; END_VAR`, and write `\"Tag_1\"`"
        ))
    }
}

/// `DB1`
fn is_data_block(name: &str) -> bool {
    let number = name.get(..2).filter(|it| it.eq_ignore_ascii_case("DB")).and_then(|_| name.get(2..));
    number.is_some_and(|it| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit()))
}

/// `%MW10` of `MW10`, `%I0.3` of `I0` before `.3`; of German letters, `EW4`, with ours.
fn address(name: &str, after: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    let area = match upper.as_bytes().first()? {
        b'I' | b'E' => 'I',
        b'Q' | b'A' => 'Q',
        b'M' => 'M',
        _ => return None,
    };
    let rest = &upper[1..];
    let digits = rest.strip_prefix(['B', 'W', 'D', 'X']).unwrap_or(rest);
    if digits.is_empty() || !digits.bytes().all(|it| it.is_ascii_digit()) {
        return None;
    }
    let is_wide = digits.len() < rest.len() && !rest.starts_with('X');
    let bit = after.strip_prefix('.').and_then(|it| it.get(..1)).filter(|it| it.as_bytes()[0].is_ascii_digit());
    match (is_wide, bit) {
        (true, _) => Some(format!("%{area}{rest}")),
        (false, bit) => bit.map(|bit| format!("%{area}{rest}.{bit}")),
    }
}
