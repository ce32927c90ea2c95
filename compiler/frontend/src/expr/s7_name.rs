//! Names of S7 that are not declared: tags and blocks in quotes, and addresses without their `%`.

use super::checker::Checker;
use crate::dialect::Dialect;
use crate::{Diagnostic, ast};

impl<'s> Checker<'_, 's> {
    /// What to do about a name of SCL that means nothing here.
    pub(super) fn help_on_s7_name(&self, name: ast::Name<'s>, error: &Diagnostic) -> Option<Diagnostic> {
        if self.decl.dialect(name.span) != Dialect::Siemens {
            return None;
        }
        if let Some(address) = address(name.text) {
            let error = error.clone().help(format!("an address is written with `%`: `{address}`"));
            return Some(error.fix(name.span, address));
        }
        let sources = &self.decl.log.sources;
        let place = sources.get(name.span.file).in_file(name.span);
        let start = usize::try_from(place.start).ok()?;
        let inner = sources.file(name.span.file).text.get(start..)?.strip_prefix('"')?;
        let (text, after) = inner.split_once('"')?;
        let error = error.clone().label("a name in quotes is a PLC tag, a data block or a block of the project");
        Some(match after.trim_start().starts_with(['.', '(']) {
            true => error.help(format!("add the source of the block: `DATA_BLOCK \"{text}\" … END_DATA_BLOCK`")),
            false => error.help(format!(
                "for a PLC tag, add a file `tags.st` that declares it: `VAR_GLOBAL {} AT %I0.0 : BOOL; END_VAR`",
                name.text
            )),
        })
    }
}

/// `%MW10` of `MW10`; of German letters, `EW4`, with ours.
fn address(name: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    let area = match upper.as_bytes().first()? {
        b'I' | b'E' => 'I',
        b'Q' | b'A' => 'Q',
        b'M' => 'M',
        _ => return None,
    };
    let rest = &upper[1..];
    let digits = rest.strip_prefix(['B', 'W', 'D', 'X']).unwrap_or(rest);
    let is_address = !digits.is_empty() && digits.len() < rest.len() && digits.bytes().all(|it| it.is_ascii_digit());
    is_address.then(|| format!("%{area}{rest}"))
}
