//! What the pragmas of a file say.

use crate::dialect::Dialect;
use crate::log::Log;
use crate::spelling::nearest;
use crate::{Code, Diagnostic, Span, ast};

/// Pragmas that change what a program means: to pass over them would compile another program.
const DECIDING_PRAGMAS: [&str; 6] = ["if", "elsif", "else", "end_if", "define", "undefine"];
/// Pragmas for editors and other tools.
const HARMLESS_PRAGMAS: [&str; 12] = [
    "attribute",
    "region",
    "endregion",
    "end_region",
    "warning",
    "info",
    "text",
    "error",
    "flag",
    "analysis",
    "nobp",
    "bp",
];

impl Log<'_> {
    /// Notes the dialect of the next file.
    pub(crate) fn read_pragmas(&mut self, file: &ast::File<'_>) {
        let mut found: Option<(Dialect, Span)> = None;
        for pragma in &file.pragmas {
            let Some(name) = dialect_pragma(pragma.text) else {
                self.check_pragma(file, *pragma);
                continue;
            };
            let Some(dialect) = Dialect::named(name) else {
                let names: Vec<_> = Dialect::ALL.iter().map(|it| it.name()).collect();
                let mut error = Diagnostic::new(Code::E0105, pragma.span, format!("there is no dialect `{name}`"))
                    .label("unknown dialect");
                let near = nearest(name, names.iter().copied());
                error = error.help(match near {
                    Some(near) => format!("did you mean `{{dialect '{near}'}}`?"),
                    None => format!("the dialects are {}", crate::diagnostic::wording::list(&names)),
                });
                self.report(error);
                continue;
            };
            if let Some((_, first)) = found {
                self.report(
                    Diagnostic::new(Code::E0106, pragma.span, "a file has one dialect")
                        .label("a second dialect pragma")
                        .other(first, "the first one")
                        .help("keep one of them; a block of another system is named in full, `CODESYS.CTU`"),
                );
                continue;
            }
            found = Some((dialect, pragma.span));
        }
        let own = found.map(|(dialect, _)| dialect).filter(|it| self.options.moved_from != Some(*it));
        self.dialects.push(own.unwrap_or(self.options.dialect));
    }

    /// What a pragma that does not name a dialect is good for.
    fn check_pragma(&mut self, file: &ast::File<'_>, pragma: ast::Name<'_>) {
        let word: String =
            pragma.text.trim().chars().take_while(|it| it.is_ascii_alphanumeric() || *it == '_').collect();
        let word = word.to_ascii_lowercase();
        if super::list::is_list_pragma(pragma.text) {
            return;
        }
        if word == "external" {
            self.check_external_pragma(file, pragma.span);
        } else if word == "pool" {
            self.check_pool_pragma(file, pragma.span);
        } else if DECIDING_PRAGMAS.contains(&word.as_str()) {
            self.not_supported(pragma.span, &format!("the pragma `{word}`"));
        } else if !HARMLESS_PRAGMAS.contains(&word.as_str())
            && !crate::allow::is_allowance(pragma.text)
            && !crate::testing::fixture::is_pragma(pragma.text)
        {
            self.report(
                Diagnostic::new(Code::W0102, pragma.span, format!("the pragma `{word}` is not known"))
                    .label("it has no effect"),
            );
        }
    }
}

impl Log<'_> {
    /// It says something of the unit that follows it.
    fn check_external_pragma(&mut self, file: &ast::File<'_>, span: Span) {
        let is_of = |it: &ast::Item<'_>| match it {
            ast::Item::Pou(pou) => pou.external.is_some_and(|it| it.span == span),
            ast::Item::Types(_) | ast::Item::Globals(_) | ast::Item::Configuration(_) | ast::Item::Test(_) => false,
        };
        if !file.items.iter().any(is_of) {
            self.report(
                Diagnostic::new(Code::E0319, span, "`{external}` belongs to nothing")
                    .label("expected before a FUNCTION or FUNCTION_BLOCK, alone or with a symbol")
                    .help("write `{external}` or `{external 'symbol'}` directly before the unit"),
            );
        }
    }
}

impl Log<'_> {
    /// It says something of the type that follows it.
    fn check_pool_pragma(&mut self, file: &ast::File<'_>, span: Span) {
        let is_it = |it: &Option<ast::Pool>| it.is_some_and(|it| it.span == span);
        let is_of = |it: &ast::Item<'_>| match it {
            ast::Item::Pou(pou) => is_it(&pou.pool),
            ast::Item::Types(types) => types.iter().any(|it| is_it(&it.pool)),
            ast::Item::Globals(_) | ast::Item::Configuration(_) | ast::Item::Test(_) => false,
        };
        if !file.items.iter().any(is_of) {
            self.report(
                Diagnostic::new(Code::E0413, span, "this pool belongs to nothing")
                    .label("expected before a FUNCTION_BLOCK, or a TYPE that is a STRUCT")
                    .help("write it directly before the type of the objects that `__NEW` makes"),
            );
        }
    }
}

/// The quoted name in `dialect 'codesys'`.
fn dialect_pragma(text: &str) -> Option<&str> {
    let text = text.trim();
    let (word, rest) = text.split_at_checked("dialect".len())?;
    let rest = rest.trim_start().trim_start_matches(":=").trim();
    let quoted = rest.strip_prefix('\'')?.strip_suffix('\'');
    word.eq_ignore_ascii_case("dialect").then_some(quoted).flatten()
}
