//! The instructions of ladder: what each does, in Structured Text. `{0}`, `{1}` … stand for its operands, and `{rung}` for the
//! condition of the rung before it. What the prescan does to one follows from its statement: `[:=]` sets to zero, and the
//! instructions that Structured Text has here bring their own. By Rockwell 1756-RM003, "Bit", "Timer and Counter", "Compare",
//! "Compute/Math", "Move/Logical", "File/Misc.", "ASCII String", "ASCII Conversion" and "Program Control Instructions".

use super::super::names::key;

/// What an instruction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Does {
    /// The rung continues where this is true.
    Tests(&'static str),
    /// As before, but not looked at where the rung is false already: an index out of range is not a fault then (1756-PM004, p. 52).
    Compares(&'static str),
    /// Executed in each scan, whatever the rung is.
    Always(&'static str),
    /// Executed where the rung is true.
    WhereTrue(&'static str),
    /// As before, in REALs where the destination, the last operand, is one; an immediate value with a fraction is rounded for an
    /// integer.
    Computes(&'static str),
    /// The rung continues with the value of this.
    Gives(&'static str),
    /// It does nothing.
    Nothing,
    /// More than a statement says.
    Special(Special),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Special {
    /// `AFI`
    AlwaysFalse,
    /// `LIM`
    Limit,
    /// `CMP`
    Compare,
    /// `CPT`
    Compute,
    /// `FLL`
    Fill,
    /// `BTD`
    Distribute,
    /// `JSR`
    Call,
    /// `SBR`
    Inputs,
    /// `RET`
    Return,
    /// `JMP`
    Jump,
    /// `LBL`
    Label,
    /// `MCR`
    Zone,
}

impl Special {
    fn words(self) -> &'static str {
        match self {
            Self::AlwaysFalse => "the rung does not continue",
            Self::Limit => {
                "the rung continues where Test is between the limits, or is one of them; where Low Limit is above High \
                 Limit, where it is outside of them, or is one"
            }
            Self::Compare => "the rung continues where the expression is true",
            Self::Compute => "`Destination := Expression`, where the rung is true",
            Self::Fill => "Source is assigned to Length elements from Destination on, where the rung is true",
            Self::Distribute => "Length bits are copied, from the two bits on; these and the length are numbers",
            Self::Call => {
                "calls a routine, where the rung is true: `JSR(Name, 2, a, b, c)` gives its `SBR` the inputs `a` and \
                 `b`, and `c` the value of the `RET` by which it returned"
            }
            Self::Inputs => "where the inputs of its routine go",
            Self::Return => "leaves the routine, where the rung is true, and returns its operands",
            Self::Jump => "continues at the rung with that label, where the rung is true",
            Self::Label => "a label, at the beginning of a rung",
            Self::Zone => "begins a zone whose rungs are false unless this one is true; the next `MCR` ends it",
        }
    }
}

pub struct Row {
    /// The name, and others that mean the same.
    pub names: &'static [&'static str],
    /// What its operands are called; of those that may be left out none is here.
    pub operands: &'static [&'static str],
    pub does: Does,
}

impl Row {
    /// Whether it has so many operands. The preset and the accumulated value are shown; the tag holds them.
    pub fn takes(&self, count: usize) -> bool {
        let may_be_one = self.operands.ends_with(&["Preset", "Accum"]);
        self.operands == ANY || self.operands.len() == count || may_be_one && count == 1
    }
}

/// What takes any number of operands counts them itself.
pub const ANY: &[&str] = &["…"];

const fn row(names: &'static [&'static str], operands: &'static [&'static str], does: Does) -> Row {
    Row { names, operands, does }
}

use Does::{Always, Compares, Computes, Gives, Nothing, Special as More, Tests, WhereTrue};

const BIT: &[&str] = &["Data Bit"];
const TWO: &[&str] = &["Source A", "Source B"];
const THREE: &[&str] = &["Source A", "Source B", "Destination"];
const MOVE: &[&str] = &["Source", "Destination"];
const ONE_SHOT: &[&str] = &["Storage Bit", "Output Bit"];
const TIMER: &[&str] = &["Timer", "Preset", "Accum"];
const COUNTER: &[&str] = &["Counter", "Preset", "Accum"];

pub const ROWS: &[Row] = &[
    row(&["XIC"], BIT, Tests("{0}")),
    row(&["XIO"], BIT, Tests("NOT {0}")),
    row(&["OTE"], BIT, Always("{0} [:=] {rung}")),
    row(&["OTL"], BIT, Always("OTL(DataBit := {0}, RungIn := {rung})")),
    row(&["OTU"], BIT, Always("OTU(DataBit := {0}, RungIn := {rung})")),
    row(&["ONS"], &["Storage Bit"], Gives("ONS(StorageBit := {0}, RungIn := {rung})")),
    row(&["OSR"], ONE_SHOT, Always("OSR(StorageBit := {0}, OutputBit := {1}, RungIn := {rung})")),
    row(&["OSF"], ONE_SHOT, Always("OSF(StorageBit := {0}, OutputBit := {1}, RungIn := {rung})")),
    row(&["TON"], TIMER, Always("TON(Timer := {0}, RungIn := {rung})")),
    row(&["TOF"], TIMER, Always("TOF(Timer := {0}, RungIn := {rung})")),
    row(&["RTO"], TIMER, Always("RTO(Timer := {0}, RungIn := {rung})")),
    row(&["CTU"], COUNTER, Always("CTU(Counter := {0}, RungIn := {rung})")),
    row(&["CTD"], COUNTER, Always("CTD(Counter := {0}, RungIn := {rung})")),
    row(&["RES"], &["Structure"], Always("RES({0}, {rung})")),
    row(&["EQU", "EQ"], TWO, Compares("{0} = {1}")),
    row(&["NEQ", "NE"], TWO, Compares("{0} <> {1}")),
    row(&["GRT", "GT"], TWO, Compares("{0} > {1}")),
    row(&["GEQ", "GE"], TWO, Compares("{0} >= {1}")),
    row(&["LES", "LT"], TWO, Compares("{0} < {1}")),
    row(&["LEQ", "LE"], TWO, Compares("{0} <= {1}")),
    row(&["LIM", "LIMIT"], &["Low Limit", "Test", "High Limit"], More(Special::Limit)),
    row(&["MEQ"], &["Source", "Mask", "Compare"], Compares("({0} AND {1}) = ({2} AND {1})")),
    row(&["CMP"], &["Expression"], More(Special::Compare)),
    row(&["MOV", "MOVE"], MOVE, Computes("{1} := {0}")),
    row(&["MVM"], &["Source", "Mask", "Destination"], WhereTrue("{2} := ({0} AND {1}) OR ({2} AND NOT {1})")),
    row(&["BTD"], &["Source", "Source Bit", "Destination", "Destination Bit", "Length"], More(Special::Distribute)),
    row(&["CLR"], &["Destination"], WhereTrue("{0} := 0")),
    row(&["ADD"], THREE, Computes("{2} := {0} + {1}")),
    row(&["SUB"], THREE, Computes("{2} := {0} - {1}")),
    row(&["MUL"], THREE, Computes("{2} := {0} * {1}")),
    row(&["DIV"], THREE, Computes("{2} := {0} / {1}")),
    row(&["MOD"], THREE, Computes("{2} := {0} MOD {1}")),
    row(&["XPY", "EXPT"], &["Source X", "Source Y", "Destination"], Computes("{2} := {0} ** {1}")),
    row(&["NEG"], MOVE, WhereTrue("{1} := -{0}")),
    row(&["ABS"], MOVE, WhereTrue("{1} := ABS({0})")),
    row(&["SQR", "SQRT"], MOVE, WhereTrue("{1} := SQRT({0})")),
    row(&["SIN"], MOVE, WhereTrue("{1} := SIN({0})")),
    row(&["COS"], MOVE, WhereTrue("{1} := COS({0})")),
    row(&["TAN"], MOVE, WhereTrue("{1} := TAN({0})")),
    row(&["ASN", "ASIN"], MOVE, WhereTrue("{1} := ASIN({0})")),
    row(&["ACS", "ACOS"], MOVE, WhereTrue("{1} := ACOS({0})")),
    row(&["ATN", "ATAN"], MOVE, WhereTrue("{1} := ATAN({0})")),
    row(&["DEG"], MOVE, WhereTrue("{1} := {0} * 57.29578")),
    row(&["RAD"], MOVE, WhereTrue("{1} := {0} * 0.01745329")),
    row(&["LN"], MOVE, WhereTrue("{1} := LN({0})")),
    row(&["LOG"], MOVE, WhereTrue("{1} := LOG({0})")),
    row(&["TRN", "TRUNC"], MOVE, WhereTrue("{1} := TRUNC({0})")),
    row(&["AND"], THREE, WhereTrue("{2} := {0} AND {1}")),
    row(&["OR"], THREE, WhereTrue("{2} := {0} OR {1}")),
    row(&["XOR"], THREE, WhereTrue("{2} := {0} XOR {1}")),
    row(&["NOT"], MOVE, WhereTrue("{1} := NOT {0}")),
    row(&["CPT"], &["Destination", "Expression"], More(Special::Compute)),
    row(&["COP"], &["Source", "Destination", "Length"], WhereTrue("COP({0}, {1}, {2})")),
    row(&["CPS"], &["Source", "Destination", "Length"], WhereTrue("CPS({0}, {1}, {2})")),
    row(&["FLL"], &["Source", "Destination", "Length"], More(Special::Fill)),
    row(&["SIZE"], &["Source", "Dimension To Vary", "Size"], WhereTrue("SIZE({0}, {1}, {2})")),
    row(&["CONCAT"], THREE, WhereTrue("{2} := CONCAT({0}, {1})")),
    row(&["MID"], &["Source", "Quantity", "Start", "Destination"], WhereTrue("{3} := MID({0}, {1}, {2})")),
    row(&["DELETE"], &["Source", "Quantity", "Start", "Destination"], WhereTrue("{3} := DELETE({0}, {1}, {2})")),
    row(&["INSERT"], &["Source A", "Source B", "Start", "Destination"], WhereTrue("{3} := INSERT({0}, {1}, {2} - 1)")),
    row(&["FIND"], &["Source", "Search", "Start", "Result"], WhereTrue("FIND({0}, {1}, {2}, {3})")),
    row(&["UPPER"], MOVE, WhereTrue("UPPER({0}, {1})")),
    row(&["LOWER"], MOVE, WhereTrue("LOWER({0}, {1})")),
    row(&["DTOS"], MOVE, WhereTrue("DTOS({0}, {1})")),
    row(&["STOD"], MOVE, WhereTrue("STOD({0}, {1})")),
    row(&["SWPB"], &["Source", "Order Mode", "Destination"], WhereTrue("SWPB({0}, {1}, {2})")),
    row(&["AFI"], &[], More(Special::AlwaysFalse)),
    row(&["NOP"], &[], Nothing),
    // No other task interrupts a scan here.
    row(&["UID"], &[], Nothing),
    row(&["UIE"], &[], Nothing),
    row(&["TND"], &[], WhereTrue("RETURN")),
    row(&["JSR"], ANY, More(Special::Call)),
    row(&["SBR"], ANY, More(Special::Inputs)),
    row(&["RET"], ANY, More(Special::Return)),
    row(&["JMP"], &["Label"], More(Special::Jump)),
    row(&["LBL"], &["Label"], More(Special::Label)),
    row(&["MCR"], &[], More(Special::Zone)),
];

/// A row for the documentation: the names, the operands, and what is written for the instruction.
pub fn described() -> impl Iterator<Item = (String, String, String)> {
    ROWS.iter().map(|row| {
        let names: Vec<_> = row.names.iter().map(|it| format!("`{it}`")).collect();
        let operands = row.operands.join(", ");
        let numbered = |text: &str| {
            let with = |text: String, (at, operand): (usize, &&str)| text.replace(&format!("{{{at}}}"), operand);
            row.operands.iter().enumerate().fold(text.replace("{rung}", "rung"), with)
        };
        let does = match row.does {
            Tests(text) | Compares(text) => format!("the rung continues where `{}`", numbered(text)),
            Always(text) => format!("`{}`", numbered(text)),
            WhereTrue(text) | Computes(text) => format!("`{}`, where the rung is true", numbered(text)),
            Gives(text) => format!("the rung continues with `{}`", numbered(text)),
            Nothing => "nothing".to_owned(),
            More(it) => it.words().to_owned(),
        };
        (names.join(", "), operands, does)
    })
}

pub fn row_of(name: &str) -> Option<&'static Row> {
    let name = key(name);
    ROWS.iter().find(|it| it.names.iter().any(|own| key(own) == name))
}

/// Functions in expressions that Structured Text calls otherwise.
pub const FUNCTIONS: &[(&str, &str)] =
    &[("SQR", "SQRT"), ("TRN", "TRUNC"), ("ASN", "ASIN"), ("ACS", "ACOS"), ("ATN", "ATAN")];
