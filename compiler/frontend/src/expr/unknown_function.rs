//! A call of what is not there: what was probably meant, and what to write for what other systems and languages have.

use super::checker::Checker;
use super::unresolved::block_of_another_dialect;
use super::{logix_operands, test_words};
use crate::diagnostic::{Missing, Subject};
use crate::dialect::{Dialect, missing};
use crate::log::Log;
use crate::names::{functions, is_instruction};
use crate::prelude;
use crate::spelling::nearest;
use crate::{Code, Diagnostic, ast};
use staunch_ir::Type;
use staunch_runtime::Family;

/// Functions of C and other languages, and what to write for them.
const OF_C: [(&str, &str); 23] = [
    ("STR", "write `TO_STRING(x)`"),
    ("POW", "write `EXPT(base, exponent)`, or `base ** exponent`"),
    ("FABS", "write `ABS(x)`"),
    ("FMOD", "write `x - y * TRUNC(x / y)`"),
    ("ATAN2", "write `ATAN(y / x)`, and choose the quadrant by the signs of `x` and `y`"),
    ("STRLEN", "write `LEN(s)`"),
    ("STRCMP", "compare with `=`, `<` or `>`: `s = 'text'`"),
    ("STRCPY", "write `target := source;`"),
    ("STRCAT", "write `CONCAT(a, b)`"),
    ("STRSTR", "write `FIND(text, part)`: 0 where it is not in it"),
    ("SUBSTR", "write `MID(text, length, position)`"),
    ("SUBSTRING", "write `MID(text, length, position)`"),
    ("ATOI", "write `STRING_TO_INT(s)`"),
    ("ATOF", "write `STRING_TO_REAL(s)`"),
    ("ITOA", "write `INT_TO_STRING(n)`"),
    ("SPRINTF", "write `CONCAT('n = ', INT_TO_STRING(n))`"),
    ("PRINTF", "a PLC program has no console: assign to a variable, and show it with `staunch run --vars`"),
    ("PRINT", "a PLC program has no console: assign to a variable, and show it with `staunch run --vars`"),
    ("MEMCPY", "assign whole variables: `target := source;` copies an array or a structure"),
    ("MALLOC", "a PLC program has no heap: declare a variable, or an array of the most that is needed"),
    ("SLEEP", "a scan does not wait: start a TON, and continue when its Q is TRUE"),
    ("DELAY", "a scan does not wait: start a TON, and continue when its Q is TRUE"),
    ("MILLIS", "measure with a TON, whose ET is the time since its IN became TRUE"),
];

/// Conversions of times that some compilers have beyond the standard's.
const UNITS_OF_TIME: [(&str, &str); 4] = [
    ("TIME_TO_S", "write `TIME_TO_LINT(x) / 1000`"),
    ("TIME_TO_MS", "write `TIME_TO_LINT(x)`"),
    ("TIME_TO_US", "write `LTIME_TO_LINT(TIME_TO_LTIME(x)) / 1000`"),
    ("TIME_TO_NS", "write `LTIME_TO_LINT(TIME_TO_LTIME(x))`"),
];

/// What S7 has in place of a counter of S5.
fn s5_counter(name: &str) -> Option<&'static str> {
    let counters = [("S_CU", "CTU"), ("S_CD", "CTD"), ("S_CUD", "CTUD")];
    counters.into_iter().find(|it| it.0.eq_ignore_ascii_case(name)).map(|it| it.1)
}

impl<'s> Checker<'_, 's> {
    /// The counters of S5, which S7-300 and S7-400 have besides: functions that work on a counter by its number.
    fn report_s5_counter(&mut self, name: ast::Name<'s>, counter: &str) {
        let pins = match counter {
            "CTU" => "CU := …, R := …, PV := …",
            "CTD" => "CD := …, LD := …, PV := …",
            _ => "CU := …, CD := …, R := …, LD := …, PV := …",
        };
        let text = name.text.to_ascii_uppercase();
        self.report(
            Diagnostic::new(Code::E0904, name.span, format!("`{text}` is a counter of S5, which is not supported"))
                .label("it counts from 0 to 999 in BCD, in a numbered counter")
                .help(format!(
                    "declare `c : {counter};`, and call `c({pins})`: it counts in INT, also past 999 and below 0"
                )),
        );
    }

    pub(crate) fn report_unknown_function(&mut self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) {
        if self.decl.bare_block(name).is_some() {
            self.report_type_called(name, ast::PouKind::FunctionBlock);
        } else if Family::ALL.into_iter().any(|it| is_instruction(it, name.text)) {
            self.report_instruction(name);
        } else if let Some(error) = of_another_dialect(name, &self.decl.log) {
            self.report(error);
        } else if let Some(counter) = s5_counter(name.text).filter(|_| self.decl.dialect(name.span) == Dialect::Siemens)
        {
            self.report_s5_counter(name, counter);
        } else if let Some((why, instead)) = missing::function_of_s7(self.decl.dialect(name.span), name.text) {
            let message = format!("the function `{}` of S7 is not supported", name.text);
            self.report(Diagnostic::new(Code::E0904, name.span, message).label(why).help(instead));
        } else if not_yet(name.text, self.decl.dialect(name.span)) {
            let what = format!("the function {}", name.text.to_ascii_uppercase());
            self.report(Diagnostic::unavailable(name.text, name.span, &what));
        } else if !self.is_of_unknown_base() {
            let error = self.no_such_function(name, arguments);
            self.report(error);
        }
    }

    /// An instruction of Logix, in another dialect.
    fn report_instruction(&mut self, name: ast::Name<'s>) {
        let is_moved = self.decl.log.options.moved_from.is_some();
        let error = block_of_another_dialect(self.decl.dialect(name.span), is_moved, name);
        self.report(error.unwrap_or_else(|| {
            Diagnostic::new(Code::E0309, name.span, format!("`{}` is an instruction of LOGIX", name.text))
                .help(format!("write `LOGIX.{}(…)`, or compile with `--dialect logix`", name.text))
        }));
    }

    fn no_such_function(&self, name: ast::Name<'s>, arguments: &[ast::Argument<'s>]) -> Diagnostic {
        let error = Diagnostic::missing(Missing::Callable, name.text, name.span).label("unknown name");
        let is_logix = self.decl.dialect(name.span).family() == Family::Logix;
        if let Some(meant) = logix_operands::of_ladder(name.text).filter(|_| is_logix) {
            error.note("it is an instruction of ladder").help(meant)
        } else if staunch_ir::Elementary::named(name.text).is_some() {
            error.help(format!("a value is converted with `TO_{}(…)`", name.text.to_ascii_uppercase()))
        } else if let Some((_, meant)) = UNITS_OF_TIME.iter().find(|it| name.text.eq_ignore_ascii_case(it.0)) {
            error.note("TIME_TO_LINT counts milliseconds, LTIME_TO_LINT nanoseconds").help(*meant)
        } else if let Some(function) = typed_function(name.text) {
            error
                .help(format!("write `{function}(…)`, which takes the type of what it is given"))
                .fix(name.span, function)
        } else if let Some(function) = conversion(name.text) {
            error.help(format!("write `{function}(…)`")).fix(name.span, function)
        } else if let Some((_, meant)) = OF_C.iter().find(|it| name.text.eq_ignore_ascii_case(it.0)) {
            error.help(*meant)
        } else if let Some(hint) = self.decl.hint_of_namespace(name) {
            error.help(hint)
        } else if let Some(hint) = test_words::hint(name.text).filter(|_| self.is_test()) {
            error.help(hint)
        } else if let Some(near) = self.like_function(name) {
            error.help(format!("did you mean `{near}`?")).fix(name.span, near)
        } else if let Some(helped) = self.help_on_instance(name, arguments, &error) {
            helped
        } else {
            error
        }
    }

    /// What can be called here by nearly this name: FUNCTIONs, instances, and the METHODs and ACTIONs of the POU around.
    fn like_function(&self, name: ast::Name<'s>) -> Option<String> {
        let own = self.decl.pous.iter().filter(|it| it.ast.kind == ast::PouKind::Function).map(|it| it.ast.name.text);
        let instances =
            self.scope.variables.iter().filter(|it| matches!(it.place.ty, Type::Block(_) | Type::Struct(_)));
        let around = self.slot.map_or(&[][..], |it| &self.decl.pous[self.decl.home(it)].ast.routines).iter();
        let around = around.filter(|it| matches!(it.kind, ast::PouKind::Method | ast::PouKind::Action));
        // Nobody means `NOT()`.
        let standard =
            functions::names().filter(|it| !["NOT", "AND", "OR", "XOR"].contains(it)).map(|it| -> &str { it });
        let named = own.chain(around.map(|it| it.name.text)).chain(instances.map(|it| it.name.text));
        nearest(name.text, named.chain(standard)).map(str::to_owned)
    }
}

/// A function, or one of a library, that another dialect has.
fn of_another_dialect(name: ast::Name<'_>, log: &Log<'_>) -> Option<Diagnostic> {
    let (dialect, is_library) = match functions::owner(name.text) {
        Some(dialect) => (dialect, false),
        None => (prelude::owner(name.text)?, true),
    };
    let system = dialect.name().to_ascii_uppercase();
    let message = match is_library {
        true => format!("`{}` is in {system}'s library", name.text),
        false => format!("`{}` is a function of {system}", name.text),
    };
    let error =
        Diagnostic::new(Code::E0307, name.span, message).label("this file's dialect does not have this function");
    let error = if is_library { error.about(Subject::Elsewhere { name: name.text.to_owned() }) } else { error };
    let rounds = !is_library && name.text.eq_ignore_ascii_case("ROUND");
    Some(match rounds {
        true => error.help("`REAL_TO_DINT(x)` rounds to the nearest, halves to the even one"),
        false => error.help(log.how_to_have(dialect)),
    })
}

/// Types as other languages abbreviate them in the name of a conversion.
const ABBREVIATED: [(&str, &str); 6] = [
    ("STR", "STRING"),
    ("INTEGER", "INT"),
    ("BOOLEAN", "BOOL"),
    ("FLOAT", "REAL"),
    ("DOUBLE", "LREAL"),
    ("WSTR", "WSTRING"),
];

/// `INT_TO_STR`, `STR2INT`: the conversion that is meant.
fn conversion(name: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    let (from, to) = upper.split_once("_TO_").or_else(|| upper.split_once('2'))?;
    let full = |word: &str| {
        let whole = ABBREVIATED.iter().find(|it| it.0 == word).map(|it| it.1);
        let is_type = staunch_ir::Elementary::named(word).is_some() || ["STRING", "WSTRING"].contains(&word);
        whole.map(str::to_owned).or_else(|| is_type.then(|| word.to_owned()))
    };
    let meant = format!("{}_TO_{}", full(from)?, full(to)?);
    (meant != upper).then_some(meant)
}

/// The function of all types that `ADD_INT` names with one.
fn typed_function(name: &str) -> Option<String> {
    functions::typed(name).map(|(signature, ..)| signature.name.to_owned())
}

/// Functions of the standard's tables, and of CODESYS, that are known to be missing.
fn not_yet(name: &str, dialect: Dialect) -> bool {
    if missing::is_operator(dialect, name) {
        return true;
    }
    let name = name.to_ascii_uppercase();
    let (from, to) = name.split_once("_TO_").unwrap_or_default();
    from == "BCD" || to == "BCD" || name == "NAME_OF"
}
