//! What the pragmas of a file say.

use crate::dialect::Dialect;
use crate::log::Log;
use crate::spelling::nearest;
use crate::{Code, Diagnostic, Span, ast};

/// Pragmas that change what a program means: to pass over them would compile another program.
const DECIDING_PRAGMAS: [&str; 6] = ["if", "elsif", "else", "end_if", "define", "undefine"];
/// What conditions of CODESYS's may ask for besides.
const CONDITIONS: [&str; 6] =
    ["hasattribute", "hasconstanttype", "hasconstantvalue", "hasvalue", "hastype", "project_defined"];
/// Pragmas for editors and other tools.
const HARMLESS_PRAGMAS: [&str; 17] = [
    "analysis",
    "axcode",
    "bp",
    "end_region",
    "endregion",
    "flag",
    "flow",
    "info",
    "nobp",
    "noflow",
    "region",
    // Of Siemens AX: who may read and write a variable from outside of the PLC.
    "s7.extern",
    // Of B&R: whether a function may run on redundant controllers.
    "redund_context",
    "redund_error",
    "redund_ok",
    "redund_unreplicable",
    "text",
];

/// The attributes that Staunch acts on, and those of CODESYS's and TwinCAT's editors, monitoring and downloads, which
/// change nothing here.
const ATTRIBUTES: &[&str] = &[
    "analysis",
    "blobinit",
    "blobinitconst",
    "c++_compatible",
    "call_after_init",
    "call_after_online_change_slot",
    "call_on_type_change",
    "conditionalshow",
    "conditionalshow_all_locals",
    "const_non_replaced",
    "const_replaced",
    "dataflow",
    "displaymode",
    "enable_dynamic_creation",
    "estimated-stack-usage",
    "ExpandFully",
    "flow",
    "hide",
    "hide_all_locals",
    "init_on_onlchange",
    "initialize_on_call",
    "instance-path",
    "io_function_block",
    "io_function_block_mapping",
    "linkalways",
    "memory_check",
    "minimal_input_size",
    "monitoring",
    "monitoring_display",
    "monitoring_encoding",
    "monitoring_instead",
    "naming",
    "no-analysis",
    "no-exit",
    "no-init",
    "no_assign",
    "no_assign_warning",
    "no_check",
    "no_copy",
    "no_explicit_call",
    "no_init",
    "no_instance_in_retain",
    "no_virtual_actions",
    "noflow",
    "noinit",
    "obsolete",
    "opc.ua.da",
    "OPC.UA.DA.Access",
    "pack_mode",
    "parameterstringof",
    "pin_presentation_order_inputs",
    "pin_presentation_order_outputs",
    "pingroup",
    "ProcessValue",
    "pytmc",
    "qualified_only",
    "reflection",
    "signature_flag",
    "startup",
    "strict",
    "subsequent",
    "suppress_warning",
    "symbol",
    "Tc2GvlVarNames",
    "tc_no_symbol",
    "TcCallAfterOutputUpdate",
    "TcContextId",
    "TcContextName",
    "TcDisplayScale",
    "TcEncoding",
    "TcGenerated",
    "TcGlobalDataType",
    "TcHideSubItems",
    "TcIgnorePersistent",
    "TcInitSymbol",
    "TcLinkTo",
    "TcLinkToOSO",
    "TcNcAxis",
    "TcNoSymbol",
    "TcRpcEnable",
    "TcSwapDWord",
    "TcSwapWord",
    "TcTypeSystem",
    "to_string",
];

/// Attributes that act in CODESYS or TwinCAT and do not here, with what does the same.
const WITHOUT_EFFECT: [(&str, &str); 8] = [
    ("TcRetain", "declare the variable in VAR RETAIN"),
    ("TcPersistent", "declare the variable in VAR PERSISTENT"),
    ("TcInitOnReset", "declare the variable without RETAIN and PERSISTENT"),
    ("is_connected", "give the input an initial value that no caller gives, and compare with it"),
    ("global_init_slot", "initialise what others need at the start of the first PROGRAM"),
    ("init_namespace", "give the STRING its initial value: `:= 'Library'`"),
    ("call_after_global_init_slot", "call it at the start of the first PROGRAM"),
    ("call_before_global_exit_slot", "call it at the end of the program"),
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
                let names: Vec<_> = Dialect::names().map(|it| it.0).collect();
                let mut error = Diagnostic::new(Code::E0105, pragma.span, format!("there is no dialect `{name}`"))
                    .label("unknown dialect");
                let near = nearest(name, names.iter().copied());
                error = error.help(match near {
                    Some(near) => format!("did you mean `{{dialect '{near}'}}`?"),
                    None => format!("the dialects are {}", crate::diagnostic::wording::all_of(&names)),
                });
                self.report(error);
                continue;
            };
            if let Some((_, first)) = found {
                self.report(
                    Diagnostic::new(Code::E0106, pragma.span, "a file can have only one dialect")
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
            pragma.text.trim().chars().take_while(|it| it.is_ascii_alphanumeric() || matches!(it, '_' | '.')).collect();
        let word = word.to_ascii_lowercase();
        if super::list::is_list_pragma(pragma.text) {
            return;
        }
        if word == "attribute" {
            self.check_attribute(pragma);
        } else if word == "error" || word == "warning" {
            self.tell(pragma, &word);
        } else if word == "external" {
            self.check_external_pragma(file, pragma.span);
        } else if word == "pool" {
            self.check_pool_pragma(file, pragma.span);
        } else if word == "if" || word == "elsif" {
            self.report_condition(pragma, &word);
        } else if DECIDING_PRAGMAS.contains(&word.as_str()) {
            self.not_supported(pragma.span, &format!("the pragma `{word}`"));
        } else if !HARMLESS_PRAGMAS.contains(&word.as_str())
            && !crate::allow::is_allowance(pragma.text)
            && !crate::testing::fixture::is_pragma(pragma.text)
        {
            let error = Diagnostic::new(Code::W0102, pragma.span, format!("the pragma `{word}` is not known"))
                .label("it has no effect");
            self.report(match known_form(pragma.text, &word) {
                Some(form) => error.help(format!("write `{{{form}}}`")),
                None => error,
            });
        }
    }
}

/// What a pragma that is not known is nearly.
fn known_form(text: &str, word: &str) -> Option<String> {
    const KNOWN: [&str; 6] = ["attribute", "dialect", "external", "gvl", "pool", "allow"];
    let meant = nearest(word, KNOWN.into_iter())?;
    let rest = text.trim().get(word.len()..)?.trim().trim_matches(['\'', '"', '=', ':', ' ']);
    match meant {
        "dialect" => {
            let dialect = Dialect::names().map(|it| it.0).find(|it| it.eq_ignore_ascii_case(rest));
            Some(format!("dialect '{}'", dialect.unwrap_or("codesys")))
        }
        "attribute" | "gvl" if !rest.is_empty() => Some(format!("{meant} '{rest}'")),
        _ => Some(format!("{meant} {rest}").trim().to_owned()),
    }
}

impl Log<'_> {
    /// A condition of `{IF}` that asks for more than what is defined.
    fn report_condition(&mut self, pragma: ast::Name<'_>, word: &str) {
        let text = pragma.text.to_ascii_lowercase();
        if let Some((operator, form)) = crate::lex::miswritten(pragma.text.trim().get(word.len()..).unwrap_or_default())
        {
            self.report(
                Diagnostic::new(Code::E0001, pragma.span, format!("wrong form of `{operator}` in the pragma `{word}`"))
                    .label(format!("expected `{form}`"))
                    .help(format!("write `{form}`")),
            );
            return;
        }
        let asked = CONDITIONS.iter().find(|it| text.contains(*it));
        let of_declared = ["variable", "type", "pou", "task", "resource"].iter().find(|kind| {
            let after =
                text.split("defined").skip(1).filter_map(|it| it.trim_start().strip_prefix('(')?.split_once(':'));
            after.clone().any(|it| it.0.trim() == **kind)
        });
        let what = match (of_declared, asked) {
            (Some(kind), _) => format!("`defined({kind}: …)`"),
            (None, Some(asked)) => format!("`{asked}`"),
            (None, None) => "this condition".to_owned(),
        };
        let help = match of_declared {
            Some(&"type") => "for a FUNCTION_BLOCK or PROGRAM, write `defined(pou: …)`",
            Some(_) | None => {
                "where the condition holds, define a name with `{define NAME}` or in the project, and test that"
            }
        };
        let message = format!("{what} in the pragma `{word}` is not supported yet");
        self.report(
            Diagnostic::new(Code::E0902, pragma.span, message).label("whether it is true is not known here").help(help),
        );
    }

    /// `{error 'text'}` and `{warning 'text'}` in what is compiled say so. `{warning disable C0195}` is of the editor.
    fn tell(&mut self, pragma: ast::Name<'_>, word: &str) {
        let text = pragma.text.trim().get(word.len()..).unwrap_or_default().trim();
        let text = text.strip_prefix('\'').and_then(|it| it.strip_suffix('\''));
        let (code, label) = match word {
            "error" => (Code::E0110, "an `{error}` pragma of the program"),
            _ => (Code::W0103, "a `{warning}` pragma of the program"),
        };
        if text.is_some() || word == "error" {
            let text = text.filter(|it| !it.trim().is_empty()).unwrap_or("`{error}`");
            self.report(Diagnostic::new(code, pragma.span, text).label(label));
        }
    }

    /// An attribute that is not known, and was probably meant for one that is; those with values are for other tools.
    fn check_attribute(&mut self, pragma: ast::Name<'_>) {
        let rest = pragma.text.trim().get("attribute".len()..).unwrap_or_default();
        let mut parts = rest.split('\'');
        let (Some(_), Some(name), Some(after)) = (parts.next(), parts.next(), parts.next()) else { return };
        if let Some((name, help)) = WITHOUT_EFFECT.iter().find(|it| it.0.eq_ignore_ascii_case(name)) {
            let message = format!("the attribute '{name}' is not supported");
            let error = Diagnostic::new(Code::W0102, pragma.span, message).label("it has no effect");
            return self.report(error.help(*help));
        }
        let of_a_tool = name.contains([':', '.', ' ']) || !after.trim().is_empty();
        let known = ATTRIBUTES.iter().chain(&self.asked_attributes);
        if known.into_iter().any(|it| it.eq_ignore_ascii_case(name)) {
            return;
        }
        let near = nearest(name, ATTRIBUTES.iter().copied());
        if of_a_tool && near.is_none() {
            return;
        }
        let error = Diagnostic::new(Code::W0102, pragma.span, format!("the attribute '{name}' is not known"))
            .label("it has no effect");
        self.report(match near {
            Some(near) => error.help(format!("did you mean `{{attribute '{near}'}}`?")),
            None => error,
        });
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
                Diagnostic::new(Code::E0319, span, "`{external}` is not attached to anything")
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
                Diagnostic::new(Code::E0413, span, "this pool is not attached to a type")
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
