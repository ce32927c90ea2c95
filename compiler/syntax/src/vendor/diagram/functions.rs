//! The standard functions as a diagram shows them: the types of their inputs, and of what they return.

/// The types of the inputs, of which the last repeats, and of OUT. Those that begin with ANY and are the same are one type.
pub struct Signature {
    inputs: &'static [&'static str],
    output: &'static str,
}

const ANY: &[&str] = &["ANY"];
const NUMBERS: &[&str] = &["ANY_NUM"];
const REALS: &[&str] = &["ANY_REAL"];
const BITS: &[&str] = &["ANY_BIT"];
const SHIFTED: &[&str] = &["ANY_BIT", "ANY_INT"];
const TEXTS: &[&str] = &["STRING"];
const PART: &[&str] = &["STRING", "ANY_INT"];

const FUNCTIONS: [(&str, &[&str], &str); 56] = [
    ("ABS", NUMBERS, "ANY_NUM"),
    ("SQRT", REALS, "ANY_REAL"),
    ("LN", REALS, "ANY_REAL"),
    ("LOG", REALS, "ANY_REAL"),
    ("EXP", REALS, "ANY_REAL"),
    ("SIN", REALS, "ANY_REAL"),
    ("COS", REALS, "ANY_REAL"),
    ("TAN", REALS, "ANY_REAL"),
    ("ASIN", REALS, "ANY_REAL"),
    ("ACOS", REALS, "ANY_REAL"),
    ("ATAN", REALS, "ANY_REAL"),
    ("ADD", NUMBERS, "ANY_NUM"),
    ("SUB", NUMBERS, "ANY_NUM"),
    ("MUL", NUMBERS, "ANY_NUM"),
    ("DIV", NUMBERS, "ANY_NUM"),
    ("MOD", &["ANY_INT"], "ANY_INT"),
    ("EXPT", &["ANY_REAL", "ANY_NUM"], "ANY_REAL"),
    ("MOVE", ANY, "ANY"),
    ("SHL", SHIFTED, "ANY_BIT"),
    ("SHR", SHIFTED, "ANY_BIT"),
    ("ROL", SHIFTED, "ANY_BIT"),
    ("ROR", SHIFTED, "ANY_BIT"),
    ("AND", BITS, "ANY_BIT"),
    ("OR", BITS, "ANY_BIT"),
    ("XOR", BITS, "ANY_BIT"),
    ("NOT", BITS, "ANY_BIT"),
    ("SEL", &["BOOL", "ANY"], "ANY"),
    ("MUX", &["ANY_INT", "ANY"], "ANY"),
    ("MAX", ANY, "ANY"),
    ("MIN", ANY, "ANY"),
    ("LIMIT", ANY, "ANY"),
    ("GT", ANY, "BOOL"),
    ("GE", ANY, "BOOL"),
    ("EQ", ANY, "BOOL"),
    ("LT", ANY, "BOOL"),
    ("LE", ANY, "BOOL"),
    ("NE", ANY, "BOOL"),
    ("LEN", TEXTS, "INT"),
    ("FIND", TEXTS, "INT"),
    ("CONCAT", TEXTS, "STRING"),
    ("LEFT", PART, "STRING"),
    ("RIGHT", PART, "STRING"),
    ("MID", PART, "STRING"),
    ("DELETE", PART, "STRING"),
    ("INSERT", &["STRING", "STRING", "ANY_INT"], "STRING"),
    ("REPLACE", &["STRING", "STRING", "ANY_INT"], "STRING"),
    ("TRUNC", REALS, "ANY_INT"),
    ("ADD_TIME", &["TIME"], "TIME"),
    ("SUB_TIME", &["TIME"], "TIME"),
    ("MULTIME", &["TIME", "ANY_NUM"], "TIME"),
    ("DIVTIME", &["TIME", "ANY_NUM"], "TIME"),
    ("ADD_TOD_TIME", &["TOD", "TIME"], "TOD"),
    ("ADD_DT_TIME", &["DT", "TIME"], "DT"),
    ("SUB_TOD_TIME", &["TOD", "TIME"], "TOD"),
    ("SUB_DT_TIME", &["DT", "TIME"], "DT"),
    ("CONCAT_DATE_TOD", &["DATE", "TOD"], "DT"),
];

/// Those whose result is a time.
const DIFFERENCES: [&str; 3] = ["SUB_DATE_DATE", "SUB_TOD_TOD", "SUB_DT_DT"];

/// Functions that dates and times have under the same name, so that the types of their inputs decide.
pub fn is_of_times_too(name: &str) -> bool {
    ["ADD", "SUB", "MUL", "DIV"].iter().any(|it| name.eq_ignore_ascii_case(it))
}

pub fn signature(name: &str) -> Option<Signature> {
    let row = FUNCTIONS.iter().find(|it| name.eq_ignore_ascii_case(it.0));
    row.map(|(_, inputs, output)| Signature { inputs, output })
}

/// The pins of functions that have others than IN, or IN1, IN2 and so on.
const PINS: [(&[&str], &[&str]); 8] = [
    (&["SEL"], &["G", "IN0", "IN1"]),
    (&["LIMIT"], &["MN", "IN", "MX"]),
    (&["SHL", "SHR", "ROL", "ROR"], &["IN", "N"]),
    (&["LEFT", "RIGHT"], &["IN", "L"]),
    (&["MID", "DELETE"], &["IN", "L", "P"]),
    (&["INSERT"], &["IN1", "IN2", "P"]),
    (&["REPLACE"], &["IN1", "IN2", "L", "P"]),
    (&["MUX"], &["K"]),
];

/// Whether the pins of a standard function are its own, in its order, so that their values need no names.
pub fn has_pins_in_order(name: &str, formals: &[&str]) -> bool {
    let of = |names: &[&str]| names.iter().any(|it| name.eq_ignore_ascii_case(it));
    let is = |formal: &str, expected: &str| formal.eq_ignore_ascii_case(expected);
    let numbered = |formals: &[&str], first: usize| {
        formals.iter().enumerate().all(|(at, it)| is(it, &format!("IN{}", at + first)))
    };
    match PINS.iter().find(|it| of(it.0)) {
        Some((["MUX"], _)) => formals
            .split_first()
            .is_some_and(|(first, rest)| is(first, "K") && (numbered(rest, 0) || numbered(rest, 1))),
        Some((_, pins)) => formals.len() == pins.len() && formals.iter().zip(*pins).all(|(a, b)| is(a, b)),
        None => {
            matches!(formals, [one] if one.is_empty() || is(one, "IN")) || formals.len() > 1 && numbered(formals, 1)
        }
    }
}

pub fn is_function(name: &str) -> bool {
    signature(name).is_some() || converted(name).is_some()
}

impl Signature {
    /// The type of an input, from 0.
    pub fn input(&self, at: usize) -> Option<&'static str> {
        self.inputs.get(at).or(self.inputs.last()).copied()
    }

    pub fn output(&self) -> &'static str {
        self.output
    }
}

/// The type that a function returns which says it by its name, as `INT_TO_REAL` does.
pub fn converted(name: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    if DIFFERENCES.contains(&upper.as_str()) {
        return Some("TIME".to_owned());
    }
    let (_, to) = upper.rsplit_once("_TO_")?;
    let to = match to {
        "DATE_AND_TIME" => "DT",
        "TIME_OF_DAY" => "TOD",
        // Of any width.
        "BCD" => return None,
        to => to,
    };
    Some(to.to_owned())
}

/// The type that ADD, SUB, MUL and DIV return for a first input that is a time or a date, with a second of this type.
pub fn of_times(name: &str, first: &str, second: Option<&str>) -> Option<&'static str> {
    let short = |ty: &str| match ty.to_ascii_uppercase().as_str() {
        "TIME" => Some("TIME"),
        "TOD" | "TIME_OF_DAY" => Some("TOD"),
        "DT" | "DATE_AND_TIME" => Some("DT"),
        "DATE" => Some("DATE"),
        _ => None,
    };
    let ty = short(first)?;
    let is_difference = name.eq_ignore_ascii_case("SUB") && ty != "TIME" && second.and_then(short) == Some(ty);
    Some(if is_difference { "TIME" } else { ty })
}
