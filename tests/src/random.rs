//! Random programs, the same for the same seed: statements over integers of all widths, reals,
//! BOOLs, arrays, calls and loops that end.

use std::fmt::Write;

/// A small generator of numbers (SplitMix64).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut it = self.0;
        it = (it ^ (it >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        it = (it ^ (it >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        it ^ (it >> 31)
    }

    pub fn below(&mut self, count: usize) -> usize {
        let count = u64::try_from(count.max(1)).expect("a usize fits a u64");
        usize::try_from(self.draw() % count).expect("below a usize")
    }

    fn one_of<'t, T>(&mut self, list: &'t [T]) -> &'t T {
        &list[self.below(list.len())]
    }
}

const INTEGERS: [(&str, &str, &str); 8] = [
    ("SINT", "-128", "127"),
    ("INT", "-32768", "32767"),
    ("DINT", "-2147483648", "2147483647"),
    ("LINT", "-9223372036854775808", "9223372036854775807"),
    ("USINT", "0", "255"),
    ("UINT", "0", "65535"),
    ("UDINT", "0", "4294967295"),
    ("ULINT", "0", "18446744073709551615"),
];
const REALS: [&str; 2] = ["REAL", "LREAL"];
/// Elements of each array, which count from -1.
const ELEMENTS: usize = 5;

/// So many programs, from seed 0, are also compiled as generated Rust.
pub const PRINTED: u64 = 24;

/// The name of a program among the generated modules.
pub fn module(seed: u64) -> String {
    format!("random_{seed}")
}

/// A program as Structured Text.
pub fn program(seed: u64) -> String {
    let mut writer =
        Writer { random: Random::new(seed), text: String::new(), loops: 0, function: None, functions: Vec::new() };
    // Two functions a program: with one for each type, most would stay without a call.
    let first = writer.number();
    let second = writer.number();
    for ty in [first, second] {
        if !writer.functions.contains(&ty) {
            writer.function(ty);
            writer.functions.push(ty);
        }
    }
    writer.block();
    writer.main();
    writer.text
}

struct Writer {
    random: Random,
    text: String,
    /// Loops around the place that is being written, and before it.
    loops: usize,
    /// The type of the function that is being written.
    function: Option<&'static str>,
    /// The types for which there is one.
    functions: Vec<&'static str>,
}

impl Writer {
    fn types() -> impl Iterator<Item = &'static str> {
        INTEGERS.iter().map(|it| it.0).chain(REALS)
    }

    /// A function of two operands, an output and an in-out of one type.
    fn function(&mut self, ty: &'static str) {
        self.function = Some(ty);
        let default = self.literal(ty);
        let _ = writeln!(
            self.text,
            "FUNCTION f_{ty} : {ty}\nVAR_INPUT a : {ty}; b : {ty} := {default}; q : BOOL; END_VAR\nVAR_OUTPUT o : {ty}; END_VAR\n\
             VAR_IN_OUT io : {ty}; END_VAR\nVAR l : {ty}; END_VAR"
        );
        for target in ["l", "o", "io"] {
            let value = self.expression(ty, 2);
            let _ = writeln!(self.text, "{target} := {value};");
        }
        let condition = self.expression("BOOL", 1);
        let value = self.expression(ty, 2);
        let _ =
            writeln!(self.text, "IF {condition} THEN f_{ty} := l; RETURN; END_IF\nf_{ty} := {value};\nEND_FUNCTION");
        self.function = None;
    }

    /// A function block with memory, and an in-out.
    fn block(&mut self) {
        self.text.push_str(
            "FUNCTION_BLOCK Memory\nVAR_INPUT a : DINT := 3; q : BOOL; END_VAR\nVAR_OUTPUT o : DINT; END_VAR\n\
             VAR_IN_OUT io : DINT; END_VAR\nVAR calls : UINT; c : CTU; END_VAR\ncalls := calls + 1;\nc(CU := q, PV := 3);\n\
             io := io + a;\no := io - o;\nIF c.Q THEN o := 0; END_IF\nEND_FUNCTION_BLOCK\n",
        );
    }

    fn main(&mut self) {
        self.text.push_str("PROGRAM Main\nVAR\n");
        for ty in Self::types() {
            let (a, b) = (self.literal(ty), self.literal(ty));
            let _ = writeln!(
                self.text,
                "v_{ty} : {ty} := {a}; w_{ty} : {ty} := {b}; a_{ty} : ARRAY[-1..3] OF {ty} := [{}({a}), {b}];",
                ELEMENTS - 1
            );
        }
        self.text.push_str(
            "v_BOOL, w_BOOL : BOOL; m, n : Memory; t : TON; e : R_TRIG;\ni0, i1, i2, i3, i4, i5 : DINT;\nEND_VAR\n",
        );
        for _ in 0..12 {
            self.statement(2);
        }
        self.text.push_str("END_PROGRAM\n");
    }

    fn statement(&mut self, depth: usize) {
        match self.random.below(if depth == 0 { 5 } else { 10 }) {
            0 | 1 => self.assignment(),
            2 => self.call(),
            3 => self.element(),
            4 => self.block_call(),
            5 | 6 => self.choice(depth),
            7 => self.case(depth),
            _ => self.repetition(depth),
        }
    }

    fn any(&mut self) -> &'static str {
        let types: Vec<_> = Self::types().chain(["BOOL"]).collect();
        types[self.random.below(types.len())]
    }

    fn number(&mut self) -> &'static str {
        let types: Vec<_> = Self::types().collect();
        types[self.random.below(types.len())]
    }

    fn assignment(&mut self) {
        let ty = self.any();
        let (name, value) = (*self.random.one_of(&["v", "w"]), self.expression(ty, 3));
        let _ = writeln!(self.text, "{name}_{ty} := {value};");
    }

    fn element(&mut self) {
        let ty = self.number();
        let (index, value) = (self.index(), self.expression(ty, 2));
        let _ = writeln!(self.text, "a_{ty}[{index}] := {value};");
    }

    /// An index that is in range: a program that always faults tests little.
    fn index(&mut self) -> String {
        match self.random.below(3) {
            0 => (i64::try_from(self.random.below(ELEMENTS)).unwrap_or(0) - 1).to_string(),
            1 => "LIMIT(-1, v_INT, 3)".to_owned(),
            _ => "ABS(w_DINT MOD 4) MOD 4".to_owned(),
        }
    }

    fn call(&mut self) {
        let at = self.random.below(self.functions.len());
        let ty = self.functions[at];
        let (a, q) = (self.expression(ty, 2), self.expression("BOOL", 1));
        let aliased = if self.random.below(2) == 0 { "v" } else { "w" };
        let _ = writeln!(self.text, "w_{ty} := f_{ty}(a := {a}, q := {q}, o => a_{ty}[0], io := {aliased}_{ty}) ;");
    }

    fn block_call(&mut self) {
        let q = self.expression("BOOL", 1);
        let text = match self.random.below(4) {
            0 => {
                let a = self.expression("DINT", 2);
                format!("m(a := {a}, q := {q}, io := v_DINT);")
            }
            1 => format!("n(q := {q}, io := a_DINT[2], o => w_DINT);"),
            2 => format!("t(IN := {q}, PT := T#15ms); v_BOOL := t.Q;"),
            _ => format!("e(CLK := {q}); w_BOOL := e.Q XOR w_BOOL;"),
        };
        let _ = writeln!(self.text, "{text}");
    }

    fn choice(&mut self, depth: usize) {
        let condition = self.expression("BOOL", 2);
        let _ = writeln!(self.text, "IF {condition} THEN");
        self.statement(depth - 1);
        if self.random.below(2) == 0 {
            let condition = self.expression("BOOL", 2);
            let _ = writeln!(self.text, "ELSIF {condition} THEN");
            self.statement(depth - 1);
        }
        self.text.push_str("ELSE\n");
        self.statement(depth - 1);
        self.text.push_str("END_IF\n");
    }

    fn case(&mut self, depth: usize) {
        let (ty, ..) = *self.random.one_of(&INTEGERS);
        let selector = self.expression(ty, 1);
        let _ = writeln!(self.text, "CASE {selector} OF\n0, 1:");
        self.statement(depth - 1);
        self.text.push_str("2..100:\n");
        self.statement(depth - 1);
        self.text.push_str("ELSE\n");
        self.statement(depth - 1);
        self.text.push_str("END_CASE\n");
    }

    fn repetition(&mut self, depth: usize) {
        // Each loop has a counter of its own, so that every loop ends.
        if self.loops >= 6 {
            return self.assignment();
        }
        let counter = format!("i{}", self.loops);
        self.loops += 1;
        let jump = *self.random.one_of(&["EXIT", "CONTINUE"]);
        match self.random.below(3) {
            0 => {
                let step = *self.random.one_of(&["", " BY 2", " BY -3"]);
                let _ = writeln!(self.text, "FOR {counter} := -2 TO 9{step} DO");
                let condition = self.expression("BOOL", 1);
                let _ = writeln!(self.text, "IF {condition} THEN {jump}; END_IF");
                self.statement(depth - 1);
                self.text.push_str("END_FOR\n");
            }
            1 => {
                let _ = writeln!(self.text, "{counter} := 0;\nWHILE {counter} < 5 DO\n{counter} := {counter} + 1;");
                let condition = self.expression("BOOL", 1);
                let _ = writeln!(self.text, "IF {condition} THEN {jump}; END_IF");
                self.statement(depth - 1);
                self.text.push_str("END_WHILE\n");
            }
            _ => {
                let _ = writeln!(self.text, "{counter} := 0;\nREPEAT\n{counter} := {counter} + 1;");
                self.statement(depth - 1);
                let condition = self.expression("BOOL", 1);
                let _ = writeln!(self.text, "UNTIL {counter} > 4 OR {condition}\nEND_REPEAT");
            }
        }
    }

    fn expression(&mut self, ty: &'static str, depth: usize) -> String {
        if depth == 0 {
            return self.leaf(ty);
        }
        match ty {
            "BOOL" => self.condition(depth),
            "REAL" | "LREAL" => self.real(ty, depth),
            _ => self.integer(ty, depth),
        }
    }

    /// No literal, so that what the front end folds is not most of the program.
    fn variable(&mut self, ty: &'static str) -> String {
        match self.function {
            Some(own) if own == ty => (*self.random.one_of(&["a", "b", "l", "io", "o"])).to_owned(),
            Some(_) if ty == "BOOL" => "q".to_owned(),
            Some(own) => format!("{own}_TO_{ty}(a)"),
            None if ty != "BOOL" && self.random.below(3) == 0 => {
                let index = self.index();
                format!("a_{ty}[{index}]")
            }
            None => format!("{}_{ty}", self.random.one_of(&["v", "w"])),
        }
    }

    fn leaf(&mut self, ty: &'static str) -> String {
        if self.random.below(4) == 0 { self.literal(ty) } else { self.variable(ty) }
    }

    /// An operand that keeps its operation from being constant.
    fn operand(&mut self, ty: &'static str, depth: usize) -> String {
        if depth == 0 { self.variable(ty) } else { self.expression(ty, depth) }
    }

    fn literal(&mut self, ty: &str) -> String {
        if ty == "BOOL" {
            return (*self.random.one_of(&["TRUE", "FALSE"])).to_owned();
        }
        if REALS.contains(&ty) {
            return (*self.random.one_of(&["0.0", "1.0", "-1.5", "3.25", "1.0e9", "-1.0e-9", "1.0e30"])).to_owned();
        }
        let (_, low, high) = INTEGERS.into_iter().find(|it| it.0 == ty).expect("an integer type");
        (*self.random.one_of(&[low, high, "0", "1", "2", "7", "100"])).to_owned()
    }

    fn integer(&mut self, ty: &'static str, depth: usize) -> String {
        let a = self.operand(ty, depth - 1);
        let b = self.expression(ty, depth - 1);
        match self.random.below(12) {
            0..=2 => format!("({a} + {b})"),
            3 => format!("({a} - {b})"),
            4 => format!("({a} * {b})"),
            5 if self.random.below(8) == 0 => format!("({a} / {})", self.variable(ty)),
            5 => format!("({a} / MAX({}, 1))", self.operand(ty, depth - 1)),
            6 => format!("({a} MOD 7)"),
            7 => format!("MAX({a}, {b})"),
            8 => format!("LIMIT({}, {a}, {b})", self.literal(ty)),
            9 => {
                let condition = self.expression("BOOL", depth - 1);
                format!("SEL({condition}, {a}, {b})")
            }
            10 => {
                let from = self.number();
                let value = self.operand(from, depth - 1);
                if from == ty { value } else { format!("{from}_TO_{ty}({value})") }
            }
            _ => a,
        }
    }

    fn real(&mut self, ty: &'static str, depth: usize) -> String {
        let a = self.operand(ty, depth - 1);
        let b = self.expression(ty, depth - 1);
        match self.random.below(10) {
            0..=2 => format!("({a} {} {b})", ["+", "-", "*"][self.random.below(3)]),
            3 => format!("({a} / {})", self.variable(ty)),
            4 => format!("SQRT(ABS({a}))"),
            5 => format!("MIN({a}, {b})"),
            6 => format!("SIN({a})"),
            7 => {
                let (from, ..) = *self.random.one_of(&INTEGERS);
                let value = self.operand(from, depth - 1);
                format!("{from}_TO_{ty}({value})")
            }
            _ => format!("ABS({a})"),
        }
    }

    fn condition(&mut self, depth: usize) -> String {
        let a = self.operand("BOOL", depth - 1);
        let b = self.expression("BOOL", depth - 1);
        match self.random.below(7) {
            0 => format!("({a} AND {b})"),
            1 => format!("({a} OR {b})"),
            2 => format!("({a} XOR NOT {b})"),
            3 => format!("({a} AND_THEN {b})"),
            _ => {
                let ty = self.number();
                let (a, b) = (self.operand(ty, depth - 1), self.expression(ty, depth - 1));
                let operator = *self.random.one_of(&["<", "<=", ">", ">=", "=", "<>"]);
                format!("({a} {operator} {b})")
            }
        }
    }
}
