//! The standard functions, as a table of signatures, and the names of conversions.

use crate::ast::{self, BinaryOp};
use crate::dialect::{Dialect, bare_block};
use crate::spelling::Key;
use rustc_hash::FxHashMap;
use staunch_ir::{Elementary, Op, TextOp};
use staunch_runtime::{Class, Kind, Signature, signature};
use std::sync::LazyLock;

/// What a standard function means.
#[derive(Clone, Copy)]
pub(crate) enum Meaning {
    /// A row of the runtime's table of operations.
    Operation(Op),
    /// A row of the runtime's table of functions on strings.
    Text(TextOp),
    /// `ADD(a, b)` is `a + b`, with all that an operator does at its types.
    Operator(BinaryOp),
    /// The input that K numbers.
    Mux,
    /// The value itself: a literal stays one.
    Move,
    /// To the integer that its place asks for.
    Round(Rounding),
    /// What the memory has already: the least significant byte first.
    LittleEndian,
    /// What has to hold: else the scan ends with a fault.
    Assert,
    /// The scan's time since the start.
    Clock(Elementary),
    /// A date or a time of day from its parts, or a part of one.
    Date(DateFunction),
    /// One of SIMATIC S7.
    S7(S7Function),
}

/// What a function of SIMATIC S7 does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum S7Function {
    /// The bytes of a bit string in the other order.
    Swap,
    /// The bit of this number alone.
    Decode,
    /// The number of the lowest bit that is set.
    Encode,
    /// What is after the point.
    Fraction,
    /// MUX with a value for each K that numbers no input.
    MuxElse,
    /// The number of so many decimal digits and a sign.
    OfDigits(i64),
    /// So many decimal digits and a sign.
    ToDigits(i64),
}

/// Which whole number a real becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rounding {
    ToZero,
    /// The nearest, of two the even one.
    ToEven,
    Up,
    Down,
}

/// The functions that round, as the names of conversions have them.
const ROUNDINGS: [(&str, Rounding); 4] =
    [("TRUNC", Rounding::ToZero), ("ROUND", Rounding::ToEven), ("CEIL", Rounding::Up), ("FLOOR", Rounding::Down)];

/// What a function makes of dates or their parts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DateFunction {
    /// A day and a time of day.
    Concat,
    /// Year, month and day.
    Day,
    /// Hour, minute, second and millisecond.
    Clock,
    /// All of these.
    Point,
    Weekday,
}

/// Functions that are not rows of the runtime's tables, and other vendors' names of parameters.
const OTHERS: &[(Option<Dialect>, Signature, Meaning)] = &[
    (None, signature!("MUX" (K: ANY_INT, IN0: T, IN1: T) -> T [ANY] extensible), Meaning::Mux),
    (None, signature!("MOVE" (IN: T) -> T [ANY]), Meaning::Move),
    (None, signature!("TRUNC" (IN: ANY_REAL) -> ANY_INT), Meaning::Round(Rounding::ToZero)),
    (None, signature!("ADD_TIME" (IN1: TIME, IN2: TIME) -> TIME), Meaning::Operator(BinaryOp::Add)),
    (None, signature!("SUB_TIME" (IN1: TIME, IN2: TIME) -> TIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("MUL_TIME" (IN1: TIME, IN2: ANY_NUM) -> TIME), Meaning::Operator(BinaryOp::Mul)),
    (None, signature!("DIV_TIME" (IN1: TIME, IN2: ANY_NUM) -> TIME), Meaning::Operator(BinaryOp::Div)),
    (None, signature!("MULTIME" (IN1: TIME, IN2: ANY_NUM) -> TIME), Meaning::Operator(BinaryOp::Mul)),
    (None, signature!("DIVTIME" (IN1: TIME, IN2: ANY_NUM) -> TIME), Meaning::Operator(BinaryOp::Div)),
    (None, signature!("ADD_LTIME" (IN1: LTIME, IN2: LTIME) -> LTIME), Meaning::Operator(BinaryOp::Add)),
    (None, signature!("SUB_LTIME" (IN1: LTIME, IN2: LTIME) -> LTIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("MUL_LTIME" (IN1: LTIME, IN2: ANY_NUM) -> LTIME), Meaning::Operator(BinaryOp::Mul)),
    (None, signature!("DIV_LTIME" (IN1: LTIME, IN2: ANY_NUM) -> LTIME), Meaning::Operator(BinaryOp::Div)),
    (None, signature!("ADD_TOD_TIME" (IN1: TOD, IN2: TIME) -> TOD), Meaning::Operator(BinaryOp::Add)),
    (None, signature!("ADD_DT_TIME" (IN1: DT, IN2: TIME) -> DT), Meaning::Operator(BinaryOp::Add)),
    (None, signature!("SUB_DATE_DATE" (IN1: DATE, IN2: DATE) -> TIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_TOD_TIME" (IN1: TOD, IN2: TIME) -> TOD), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_TOD_TOD" (IN1: TOD, IN2: TOD) -> TIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_DT_TIME" (IN1: DT, IN2: TIME) -> DT), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_DT_DT" (IN1: DT, IN2: DT) -> TIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("ADD_LTOD_LTIME" (IN1: LTOD, IN2: LTIME) -> LTOD), Meaning::Operator(BinaryOp::Add)),
    (None, signature!("ADD_LDT_LTIME" (IN1: LDT, IN2: LTIME) -> LDT), Meaning::Operator(BinaryOp::Add)),
    (None, signature!("SUB_LDATE_LDATE" (IN1: LDATE, IN2: LDATE) -> LTIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_LTOD_LTIME" (IN1: LTOD, IN2: LTIME) -> LTOD), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_LTOD_LTOD" (IN1: LTOD, IN2: LTOD) -> LTIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_LDT_LTIME" (IN1: LDT, IN2: LTIME) -> LDT), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("SUB_LDT_LDT" (IN1: LDT, IN2: LDT) -> LTIME), Meaning::Operator(BinaryOp::Sub)),
    (None, signature!("CONCAT_DATE_TOD" (IN1: DATE, IN2: TOD) -> DT), Meaning::Date(DateFunction::Concat)),
    (None, signature!("CONCAT_DATE_LTOD" (IN1: DATE, IN2: LTOD) -> LDT), Meaning::Date(DateFunction::Concat)),
    (
        None,
        signature!("CONCAT_DATE" (YEAR: ANY_INT, MONTH: ANY_INT, DAY: ANY_INT) -> DATE),
        Meaning::Date(DateFunction::Day),
    ),
    (
        None,
        signature!("CONCAT_TOD" (HOUR: ANY_INT, MINUTE: ANY_INT, SECOND: ANY_INT, MILLISECOND: ANY_INT) -> TOD),
        Meaning::Date(DateFunction::Clock),
    ),
    (
        None,
        signature!("CONCAT_LTOD" (HOUR: ANY_INT, MINUTE: ANY_INT, SECOND: ANY_INT, MILLISECOND: ANY_INT) -> LTOD),
        Meaning::Date(DateFunction::Clock),
    ),
    (
        None,
        signature!("CONCAT_DT" (YEAR: ANY_INT, MONTH: ANY_INT, DAY: ANY_INT, HOUR: ANY_INT, MINUTE: ANY_INT, SECOND: ANY_INT, MILLISECOND: ANY_INT) -> DT),
        Meaning::Date(DateFunction::Point),
    ),
    (
        None,
        signature!("CONCAT_LDT" (YEAR: ANY_INT, MONTH: ANY_INT, DAY: ANY_INT, HOUR: ANY_INT, MINUTE: ANY_INT, SECOND: ANY_INT, MILLISECOND: ANY_INT) -> LDT),
        Meaning::Date(DateFunction::Point),
    ),
    (None, signature!("DAY_OF_WEEK" (IN: LDATE) -> ANY_INT), Meaning::Date(DateFunction::Weekday)),
    // Edition 3, table 37, by its names and by those that systems have instead.
    (None, signature!("TO_BIG_ENDIAN" (IN: T) -> T [ANY]), Meaning::Operation(Op::SwapBytes)),
    (None, signature!("FROM_BIG_ENDIAN" (IN: T) -> T [ANY]), Meaning::Operation(Op::SwapBytes)),
    (None, signature!("BIG_ENDIAN_TO" (IN: T) -> T [ANY]), Meaning::Operation(Op::SwapBytes)),
    (None, signature!("TO_LITTLE_ENDIAN" (IN: T) -> T [ANY]), Meaning::LittleEndian),
    (None, signature!("FROM_LITTLE_ENDIAN" (IN: T) -> T [ANY]), Meaning::LittleEndian),
    (None, signature!("LITTLE_ENDIAN_TO" (IN: T) -> T [ANY]), Meaning::LittleEndian),
    // Edition 4.
    (None, signature!("ASSERT" (IN: BOOL) -> BOOL), Meaning::Assert),
    // TwinCAT's Tc2_Math.
    (CODESYS, signature!("CEIL" (LR_IN: T) -> T [ANY_REAL]), Meaning::Operation(Op::Ceil)),
    (CODESYS, signature!("FLOOR" (LR_IN: T) -> T [ANY_REAL]), Meaning::Operation(Op::Floor)),
    (CODESYS, signature!("LTRUNC" (LR_IN: T) -> T [ANY_REAL]), Meaning::Operation(Op::Whole)),
    (CODESYS, signature!("TIME" () -> TIME), Meaning::Clock(Elementary::Time)),
    (CODESYS, signature!("LTIME" () -> LTIME), Meaning::Clock(Elementary::Ltime)),
    // S7.
    (SIEMENS, signature!("ROUND" (IN: ANY_REAL) -> ANY_INT), Meaning::Round(Rounding::ToEven)),
    (SIEMENS, signature!("CEIL" (IN: ANY_REAL) -> ANY_INT), Meaning::Round(Rounding::Up)),
    (SIEMENS, signature!("FLOOR" (IN: ANY_REAL) -> ANY_INT), Meaning::Round(Rounding::Down)),
    (
        SIEMENS,
        signature!("CONCAT" (string1: ANY_STRING, string2: ANY_STRING) -> ANY_STRING extensible),
        Meaning::Text(TextOp::Concat),
    ),
    (SIEMENS, signature!("SWAP" (IN: T) -> T [ANY_BIT]), Meaning::S7(S7Function::Swap)),
    // S7-1200 manual V4.2, 09/2016, p. 328: IN modulo the bits of OUT.
    (SIEMENS, signature!("DECO" (IN: ANY_INT) -> ANY_BIT), Meaning::S7(S7Function::Decode)),
    (SIEMENS, signature!("ENCO" (IN: T) -> INT [ANY_BIT]), Meaning::S7(S7Function::Encode)),
    (SIEMENS, signature!("FRAC" (IN: T) -> T [ANY_REAL]), Meaning::S7(S7Function::Fraction)),
    (
        SIEMENS,
        signature!("MUX" (K: ANY_INT, INELSE: T, IN0: T, IN1: T) -> T [ANY] extensible),
        Meaning::S7(S7Function::MuxElse),
    ),
    // BCD16 is from -999 to 999, BCD32 from -9999999 to 9999999 (S7-400 Instruction List, A5E00267845-01, p. 82).
    (SIEMENS, signature!("BCD16_TO_INT" (IN: WORD) -> INT), Meaning::S7(S7Function::OfDigits(3))),
    (SIEMENS, signature!("INT_TO_BCD16" (IN: INT) -> WORD), Meaning::S7(S7Function::ToDigits(3))),
    (SIEMENS, signature!("BCD32_TO_DINT" (IN: DWORD) -> DINT), Meaning::S7(S7Function::OfDigits(7))),
    (SIEMENS, signature!("DINT_TO_BCD32" (IN: DINT) -> DWORD), Meaning::S7(S7Function::ToDigits(7))),
    // S7-1200 manual, 11/2011, p. 234; V4.2, p. 337.
    (SIEMENS, signature!("T_ADD" (IN1: ANY_ELEMENTARY, IN2: ANY_DURATION) -> ANY), Meaning::Operator(BinaryOp::Add)),
    (SIEMENS, signature!("T_SUB" (IN1: ANY_ELEMENTARY, IN2: ANY_DURATION) -> ANY), Meaning::Operator(BinaryOp::Sub)),
    (SIEMENS, signature!("T_DIFF" (IN1: ANY_DATE, IN2: ANY_DATE) -> ANY), Meaning::Operator(BinaryOp::Sub)),
    // CODESYS's library names the parameters of the functions on strings in its own way.
    (CODESYS, signature!("LEN" (STR: ANY_STRING) -> INT), Meaning::Text(TextOp::Len)),
    (CODESYS, signature!("LEFT" (STR: ANY_STRING, SIZE: ANY_INT) -> ANY_STRING), Meaning::Text(TextOp::Left)),
    (CODESYS, signature!("RIGHT" (STR: ANY_STRING, SIZE: ANY_INT) -> ANY_STRING), Meaning::Text(TextOp::Right)),
    (
        CODESYS,
        signature!("MID" (STR: ANY_STRING, LEN: ANY_INT, POS: ANY_INT) -> ANY_STRING),
        Meaning::Text(TextOp::Mid),
    ),
    (
        CODESYS,
        signature!("CONCAT" (STR1: ANY_STRING, STR2: ANY_STRING) -> ANY_STRING extensible),
        Meaning::Text(TextOp::Concat),
    ),
    (
        CODESYS,
        signature!("INSERT" (STR1: ANY_STRING, STR2: ANY_STRING, POS: ANY_INT) -> ANY_STRING),
        Meaning::Text(TextOp::Insert),
    ),
    (
        CODESYS,
        signature!("DELETE" (STR: ANY_STRING, LEN: ANY_INT, POS: ANY_INT) -> ANY_STRING),
        Meaning::Text(TextOp::Delete),
    ),
    (
        CODESYS,
        signature!("REPLACE" (STR1: ANY_STRING, STR2: ANY_STRING, L: ANY_INT, P: ANY_INT) -> ANY_STRING),
        Meaning::Text(TextOp::Replace),
    ),
    (CODESYS, signature!("FIND" (STR1: ANY_STRING, STR2: ANY_STRING) -> INT), Meaning::Text(TextOp::Find)),
    // Of its library Standard64.
    (CODESYS, signature!("WLEN" (STR: WSTRING) -> INT), Meaning::Text(TextOp::Len)),
    (CODESYS, signature!("WLEFT" (STR: WSTRING, SIZE: ANY_INT) -> WSTRING), Meaning::Text(TextOp::Left)),
    (CODESYS, signature!("WRIGHT" (STR: WSTRING, SIZE: ANY_INT) -> WSTRING), Meaning::Text(TextOp::Right)),
    (CODESYS, signature!("WMID" (STR: WSTRING, LEN: ANY_INT, POS: ANY_INT) -> WSTRING), Meaning::Text(TextOp::Mid)),
    (CODESYS, signature!("WCONCAT" (STR1: WSTRING, STR2: WSTRING) -> WSTRING), Meaning::Text(TextOp::Concat)),
    (
        CODESYS,
        signature!("WINSERT" (STR1: WSTRING, STR2: WSTRING, POS: ANY_INT) -> WSTRING),
        Meaning::Text(TextOp::Insert),
    ),
    (
        CODESYS,
        signature!("WDELETE" (STR: WSTRING, LEN: ANY_INT, POS: ANY_INT) -> WSTRING),
        Meaning::Text(TextOp::Delete),
    ),
    (
        CODESYS,
        signature!("WREPLACE" (STR1: WSTRING, STR2: WSTRING, L: ANY_INT, P: ANY_INT) -> WSTRING),
        Meaning::Text(TextOp::Replace),
    ),
    (CODESYS, signature!("WFIND" (STR1: WSTRING, STR2: WSTRING) -> INT), Meaning::Text(TextOp::Find)),
];

const CODESYS: Option<Dialect> = Some(Dialect::Codesys);
const SIEMENS: Option<Dialect> = Some(Dialect::Siemens);

/// A signature, whose it is if it is a vendor's, and what it means.
type Function = (Option<Dialect>, &'static Signature, Meaning);

/// Every standard function, a vendor's forms after the standard's.
static FUNCTIONS: LazyLock<FxHashMap<Key<'static>, Vec<Function>>> = LazyLock::new(|| {
    let operations = Op::ALL.iter().map(|op| (None, op.signature(), meaning(*op)));
    let texts = TextOp::ALL.iter().map(|op| (None, op.signature(), Meaning::Text(*op)));
    let others = OTHERS.iter().map(|(dialect, signature, meaning)| (*dialect, signature, *meaning));
    let mut functions: FxHashMap<_, Vec<_>> = FxHashMap::default();
    for function in operations.chain(texts).chain(others).filter(|it| !it.1.name.starts_with('_')) {
        functions.entry(Key(function.1.name)).or_default().push(function);
    }
    functions
});

/// The standard functions that a dialect has, as their signatures.
pub fn standard_functions(dialect: Dialect) -> impl Iterator<Item = &'static Signature> {
    FUNCTIONS.values().flatten().filter(move |it| it.0.is_none_or(|it| it == dialect)).map(|it| it.1)
}

/// The standard functions of a name.
pub(crate) fn named(name: &str) -> &[Function] {
    FUNCTIONS.get(&Key(name)).map_or(&[], Vec::as_slice)
}

/// Whether a function bears this name in any dialect.
pub(crate) fn exists(name: &str) -> bool {
    !named(name).is_empty() || conversion(name).is_some()
}

/// Whether a standard function bears this name in the dialect.
pub(crate) fn exists_in(name: &str, dialect: Dialect) -> bool {
    let has = |owner: Option<Dialect>| owner.is_none_or(|it| it == dialect);
    named(name).iter().any(|it| has(it.0))
        || conversion(name).is_some_and(|it| has(it.owner()))
        || dialect.has_typed_functions() && typed(name).is_some()
}

/// Whether a declaration without a body is of what is here without it: an operator, a standard function, or a standard block that has
/// these parameters.
pub(crate) fn is_in_the_library(pou: &ast::Pou<'_>, dialect: Dialect) -> bool {
    const OPERATORS: [&str; 7] = ["AND", "OR", "XOR", "NOT", "MOD", "ADR", "SIZEOF"];
    let name = pou.name.text;
    if pou.kind == ast::PouKind::Function {
        let is_edge = |it: &(&str, &str)| it.0.eq_ignore_ascii_case(name);
        return OPERATORS.iter().any(|it| it.eq_ignore_ascii_case(name))
            || crate::automation_studio::EDGES.iter().any(is_edge)
            || exists_in(name, dialect);
    }
    let Some(block) = bare_block(dialect, name) else { return false };
    let has_pin = |wanted: &str| block.info().pins.iter().any(|it| it.name.eq_ignore_ascii_case(wanted));
    let shown = pou.blocks.iter().filter(|it| it.kind != ast::VarKind::Var);
    shown.flat_map(|it| &it.vars).flat_map(|it| &it.names).all(|it| has_pin(it.text))
}

/// What `ADD_INT` names: ADD, with one type of all that it may take (edition 3, table 21).
pub(crate) fn typed(name: &str) -> Option<(&'static Signature, Meaning, Elementary)> {
    let (function, ty) = name.rsplit_once('_')?;
    let ty = Elementary::named(ty)?;
    let mut forms = named(function).iter().filter(|it| it.0.is_none());
    let takes = |it: &Signature| it.class.contains(ty.class()) && it.parameters.iter().any(|it| it.kind == Kind::T);
    let (_, signature, meaning) = forms.find(|it| takes(it.1))?;
    Some((signature, *meaning, ty))
}

/// A dialect that has a function with this name, if not all dialects have it.
pub(crate) fn owner(name: &str) -> Option<Dialect> {
    named(name).iter().find_map(|it| it.0).or_else(|| conversion(name)?.owner())
}

/// Whether a call of the function does something, besides its result.
pub(crate) fn is_statement(name: &str) -> bool {
    named(name).iter().any(|it| matches!(it.2, Meaning::Assert))
}

/// The names of the standard functions that give a value, for suggestions.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.keys().map(|it| it.0).filter(|it| !is_statement(it))
}

/// What an operation's function means: for those with an operator, the operator.
fn meaning(op: Op) -> Meaning {
    let operator = match op {
        Op::Add => BinaryOp::Add,
        Op::Sub => BinaryOp::Sub,
        Op::Mul => BinaryOp::Mul,
        Op::Div => BinaryOp::Div,
        Op::Mod => BinaryOp::Mod,
        Op::Expt => BinaryOp::Power,
        Op::And => BinaryOp::And,
        Op::Or => BinaryOp::Or,
        Op::Xor => BinaryOp::Xor,
        Op::Eq => BinaryOp::Eq,
        Op::Ne => BinaryOp::Ne,
        Op::Lt => BinaryOp::Lt,
        Op::Le => BinaryOp::Le,
        Op::Gt => BinaryOp::Gt,
        Op::Ge => BinaryOp::Ge,
        _ => return Meaning::Operation(op),
    };
    Meaning::Operator(operator)
}

/// What a conversion function's name says.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conversion {
    pub from: Option<Converted>,
    pub to: Converted,
    pub how: How,
    /// `ANY_TO_INT`, which is TO_INT.
    of_any: bool,
}

impl Conversion {
    /// Whose it is, if it is a vendor's.
    fn owner(self) -> Option<Dialect> {
        if self.of_any {
            return CODESYS;
        }
        match self.how {
            How::Rounds(Rounding::ToEven | Rounding::Up | Rounding::Down) => SIEMENS,
            How::Rounds(Rounding::ToZero) | How::Value | How::FromBcd | How::ToBcd => None,
        }
    }
}

/// How a conversion makes its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum How {
    /// The value, rounded.
    Value,
    /// A real as a whole number.
    Rounds(Rounding),
    /// The number of decimal digits in four bits each.
    FromBcd,
    /// The digits of a number.
    ToBcd,
}

/// What is converted, or made.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Converted {
    Elementary(Elementary),
    /// A STRING or WSTRING of any length.
    Text {
        wide: bool,
    },
}

impl Converted {
    /// By its name in capitals.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "STRING" => Some(Self::Text { wide: false }),
            "WSTRING" => Some(Self::Text { wide: true }),
            "__XWORD" => Some(Self::Elementary(Elementary::Lword)),
            "__XINT" => Some(Self::Elementary(Elementary::Lint)),
            "__UXINT" => Some(Self::Elementary(Elementary::Ulint)),
            _ => Elementary::named(name).map(Self::Elementary),
        }
    }

    fn is(self, class: fn(Elementary) -> bool) -> bool {
        matches!(self, Self::Elementary(it) if class(it))
    }
}

/// What the name of a conversion function says.
pub(crate) fn conversion(name: &str) -> Option<Conversion> {
    // Most names have no underscore, and this is asked of each that is called.
    if !name.contains('_') {
        return None;
    }
    let name = name.to_ascii_uppercase();
    for (word, rounding) in ROUNDINGS {
        if let Some(to) = name.strip_prefix(word).and_then(|it| it.strip_prefix('_')) {
            return made(How::Rounds(rounding), "", to);
        }
    }
    if let Some((from, to)) = name.split_once("_TRUNC_") {
        return made(How::Rounds(Rounding::ToZero), from, to);
    }
    if let Some(to) = name.strip_prefix("ANY_TO_") {
        return Some(Conversion { of_any: true, ..made(How::Value, "", to)? });
    }
    let (from, to) = name.split_once("_TO_").or_else(|| Some(("", name.strip_prefix("TO_")?)))?;
    match (from.strip_suffix("BCD"), to.strip_prefix("BCD_")) {
        (Some(from), None) => made(How::FromBcd, from.strip_suffix('_').unwrap_or(from), to),
        (None, Some(to)) => made(How::ToBcd, from, to),
        (None, None) => made(How::Value, from, to),
        (Some(_), Some(_)) => None,
    }
}

/// The conversion between what these words name; the first says nothing where the operand does. A name with types that
/// the standard does not convert so is none.
fn made(how: How, from: &str, to: &str) -> Option<Conversion> {
    let (takes, gives): (Set, Set) = match how {
        How::Value => (|_| true, |_| true),
        How::Rounds(Rounding::ToZero) => (Elementary::is_real, Elementary::is_integer),
        How::Rounds(_) => (Elementary::is_real, |it| it.is_integer() || it.is_real()),
        How::FromBcd => (is_bit_string, is_unsigned),
        How::ToBcd => (is_unsigned, is_bit_string),
    };
    let named = |word: &str, class| Converted::named(word).filter(|it| how == How::Value || it.is(class));
    let from = match from {
        "" => None,
        from => Some(named(from, takes)?),
    };
    Some(Conversion { from, to: named(to, gives)?, how, of_any: false })
}

/// Some of the elementary types.
type Set = fn(Elementary) -> bool;

fn is_bit_string(ty: Elementary) -> bool {
    ty.is_bits() && ty != Elementary::Bool
}

fn is_unsigned(ty: Elementary) -> bool {
    ty.is(Class::Unsigned)
}
