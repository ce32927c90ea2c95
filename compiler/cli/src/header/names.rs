//! Names in C.

use std::collections::HashSet;

/// The prefix of symbols without another one.
pub const PREFIX: &str = "staunch";

/// Words that cannot be names in C or C++, or that compilers and their usual headers define, but can be names in Structured Text.
const WORDS: &[&str] = &[
    "BUFSIZ",
    "CHAR_BIT",
    "CHAR_MAX",
    "CHAR_MIN",
    "CLOCKS_PER_SEC",
    "DBL_EPSILON",
    "DBL_MAX",
    "DBL_MIN",
    "EDOM",
    "EILSEQ",
    "EINTR",
    "EOF",
    "ERANGE",
    "EXIT_FAILURE",
    "EXIT_SUCCESS",
    "FILENAME_MAX",
    "FLT_EPSILON",
    "FLT_MAX",
    "FLT_MIN",
    "FOPEN_MAX",
    "HUGE_VAL",
    "INFINITY",
    "LLONG_MAX",
    "LLONG_MIN",
    "LONG_MAX",
    "LONG_MIN",
    "L_tmpnam",
    "MB_CUR_MAX",
    "MB_LEN_MAX",
    "M_E",
    "M_PI",
    "NAN",
    "NDEBUG",
    "PATH_MAX",
    "RAND_MAX",
    "SCHAR_MAX",
    "SCHAR_MIN",
    "SEEK_CUR",
    "SEEK_END",
    "SEEK_SET",
    "SHRT_MAX",
    "SHRT_MIN",
    "SIGINT",
    "SIGTERM",
    "TMP_MAX",
    "UCHAR_MAX",
    "ULLONG_MAX",
    "ULONG_MAX",
    "USHRT_MAX",
    "alignas",
    "alignof",
    "and_eq",
    "asm",
    "assert",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "decltype",
    "default",
    "delete",
    "double",
    "dynamic_cast",
    "enum",
    "errno",
    "explicit",
    "export",
    "extern",
    "float",
    "friend",
    "goto",
    "inline",
    "int",
    "linux",
    "long",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not_eq",
    "nullptr",
    "offsetof",
    "operator",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "stderr",
    "stdin",
    "stdout",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "union",
    "unix",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "xor_eq",
];

/// Macros that every header has, without the prefix.
const OWN: [&str; 12] = [
    "STATE_SIZE",
    "STATE_ALIGN",
    "SHARED",
    "ASSERT",
    "ALIGNED",
    "TURNS",
    "TASKS",
    "TASKS_COUNT",
    "LOCATED",
    "LOCATED_COUNT",
    "RETAINED",
    "RETAINED_COUNT",
];

/// What every header names with the prefix, and no structure of the program's may be.
const OWN_TAGS: [&str; 5] = ["state", "context", "task", "located", "retained"];

/// The names of one header.
pub struct Names {
    prefix: String,
    /// Macros and constants without their prefix, each defined once.
    taken: HashSet<String>,
}

impl Names {
    pub fn new(prefix: &str, file: &str) -> Self {
        let own = OWN.into_iter().chain([file]);
        Self { prefix: prefix.to_owned(), taken: own.map(str::to_owned).collect() }
    }

    /// Nothing of the program's gets these names.
    pub fn take(&mut self, names: Vec<String>) {
        self.taken.extend(names);
    }

    /// What is linked: `staunch_init`.
    pub fn symbol(&self, name: &str) -> String {
        format!("{}_{name}", self.prefix)
    }

    /// A structure of the program's: with the prefix, if it is not the usual one.
    pub fn tag(&self, name: &str) -> String {
        let tag = if self.prefix == PREFIX { plain(name) } else { self.symbol(&plain(name)) };
        match OWN_TAGS.iter().any(|own| self.symbol(own) == tag) {
            true => tag + "_",
            false => tag,
        }
    }

    /// A macro that every header has.
    pub fn own(&self, name: &str) -> String {
        format!("{}_{name}", upper(&[&self.prefix]))
    }

    /// A macro for a name of the program's: `STAUNCH_MAIN_X`, or `STAUNCH_MAIN_X_2` and so on where that is taken.
    pub fn claim(&mut self, parts: &[&str]) -> String {
        let wanted = upper(parts);
        let mut name = wanted.clone();
        let mut number = 2;
        while !self.taken.insert(name.clone()) {
            name = format!("{wanted}_{number}");
            number += 1;
        }
        self.own(&name)
    }
}

/// Whether symbols may begin so in C.
pub fn is_prefix(text: &str) -> bool {
    let starts = text.starts_with(|it: char| it.is_ascii_alphabetic());
    starts && text.chars().all(|it| it.is_ascii_alphanumeric() || it == '_')
}

/// A name in letters of C.
pub fn plain(name: &str) -> String {
    name.chars().map(|it| if it.is_ascii_alphanumeric() { it } else { '_' }).collect()
}

/// The name of a variable.
pub fn variable(name: &str) -> String {
    let mut name = plain(name);
    let is_reserved =
        name.strip_prefix('_').is_some_and(|it| it.starts_with(|it: char| it == '_' || it.is_ascii_uppercase()));
    if is_reserved || is_macro(&name) || WORDS.contains(&name.as_str()) {
        name.push('_');
    }
    name
}

/// Whether a header that is included may define it: `INT16_MAX`.
fn is_macro(name: &str) -> bool {
    let limits = ["INT", "UINT", "SIZE", "PTRDIFF", "SIG_ATOMIC", "WCHAR", "WINT"];
    let endings = ["_MAX", "_MIN", "_C", "_WIDTH"];
    name == "NULL" || limits.iter().any(|it| name.starts_with(it)) && endings.iter().any(|it| name.ends_with(it))
}

pub fn upper(parts: &[&str]) -> String {
    plain(&parts.join("_")).to_ascii_uppercase()
}
