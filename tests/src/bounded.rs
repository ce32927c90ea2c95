//! Random programs whose loops all have bounds, so that there is a most of what their scans run.

use staunch_witness::random::Random;
use std::fmt::Write;

/// Statements within statements.
const DEEPEST: usize = 3;
const FUNCTIONS: usize = 3;

const HEAD: &str = "VAR_INPUT
    b0, b1, b2, b3 : BOOL; n0, n1, n2 : DINT; r0 : REAL;
END_VAR
VAR
    x0, x1, x2, x3 : DINT; y0, y1 : REAL; p : BOOL; a : ARRAY[0..9] OF DINT; m : ARRAY[0..3, 0..4] OF INT;
    s, t : STRING[40]; clock : TON; pulse : TP; parts : CTU; both : CTUD; edge : R_TRIG; block0, block1 : Block;
    i0, i1, i2, i3, w0, w1, w2, w3 : DINT;
END_VAR
";

/// The program of a seed.
pub fn program(seed: u64) -> String {
    let mut writer =
        Writer { random: Random::new(seed), text: String::new(), loops: 0, functions: 0, has_blocks: false };
    for at in 0..FUNCTIONS {
        writer.function(at);
    }
    writer.block();
    writer.has_blocks = true;
    writer.text += "PROGRAM Main\n";
    writer.text += HEAD;
    writer.statements(12, 0);
    writer.text += "END_PROGRAM\n";
    writer.text
}

struct Writer {
    random: Random,
    text: String,
    /// The loops around.
    loops: usize,
    /// Those that may be called.
    functions: usize,
    has_blocks: bool,
}

impl Writer {
    fn line(&mut self, line: &str) {
        writeln!(self.text, "{line}").expect("writing to a String does not fail");
    }

    fn function(&mut self, at: usize) {
        let head = "VAR_INPUT n0, n1, n2 : DINT; END_VAR\nVAR x0, x1, x2, x3 : DINT; p, b0, b1, b2, b3 : BOOL;
    a : ARRAY[0..9] OF DINT; i0, i1, i2, i3, w0, w1, w2, w3 : DINT; END_VAR";
        self.line(&format!("FUNCTION F{at} : DINT\n{head}"));
        self.statements(3, 1);
        self.line(&format!("F{at} := x0 + x1;\nEND_FUNCTION"));
        self.functions = at + 1;
    }

    fn block(&mut self) {
        self.line("FUNCTION_BLOCK Block\nVAR_INPUT n0, n1, n2 : DINT; END_VAR\nVAR_OUTPUT x0, x1 : DINT; END_VAR");
        self.line("VAR x2, x3 : DINT; p, b0, b1, b2, b3 : BOOL; a : ARRAY[0..9] OF DINT;");
        self.line("    i0, i1, i2, i3, w0, w1, w2, w3 : DINT; END_VAR");
        self.statements(4, 1);
        self.line("END_FUNCTION_BLOCK");
    }

    fn statements(&mut self, most: usize, depth: usize) {
        for _ in 0..1 + self.random.below(most) {
            self.statement(depth);
        }
    }

    fn statement(&mut self, depth: usize) {
        let kinds = if depth < DEEPEST { 12 } else { 6 };
        match self.random.below(kinds) {
            0..=2 => self.assignment(),
            3 if self.has_blocks => self.call_of_block(),
            4 if self.has_blocks => self.text_or_real(),
            5 if self.loops > 0 => self.leave(),
            3..=5 => self.assignment(),
            6 | 7 => self.branch(depth),
            8 => self.case(depth),
            9 | 10 => self.counted(depth),
            _ => self.conditional(depth),
        }
    }

    fn assignment(&mut self) {
        let value = self.number(2);
        let target = match self.random.below(6) {
            0 => format!("a[{}]", self.index()),
            1 => return self.line("p := b0 AND x1 > 3 OR NOT p;"),
            _ => self.variable(),
        };
        self.line(&format!("{target} := {value};"));
    }

    fn call_of_block(&mut self) {
        let (condition, number) = (self.condition(), self.number(1));
        let line = match self.random.below(7) {
            0 => format!("clock(IN := {condition}, PT := T#30ms);"),
            1 => format!("pulse(IN := {condition}, PT := T#50ms);"),
            2 => format!("parts(CU := {condition}, R := b3, PV := 5);"),
            3 => format!("both(CU := {condition}, CD := b1, R := b2, LD := b3, PV := 7);"),
            4 => format!("edge(CLK := {condition});"),
            5 => format!("block0(n0 := {number}, n1 := n2);"),
            _ => format!("block1(n0 := {number}); x1 := block1.x0;"),
        };
        self.line(&line);
    }

    fn text_or_real(&mut self) {
        let lines = [
            "s := CONCAT(t, 'some more of it');",
            "t := LEFT(s, 12);",
            "s := DINT_TO_STRING(x0);",
            "t := CONCAT(s, MID(s, 3, 2));",
            "y0 := SIN(y0 + r0) * 2.5;",
            "y1 := SQRT(ABS(y0)) + r0;",
            "y0 := LIMIT(-10.0, y1 * 1.5, 10.0);",
            "x2 := REAL_TO_DINT(y1);",
            "m[x1 MOD 4, 2] := m[1, 3] + 1;",
            "a[3] := a[ABS(n1) MOD 10];",
        ];
        let line = *self.random.one_of(&lines);
        self.line(line);
    }

    fn leave(&mut self) {
        let condition = self.condition();
        // After CONTINUE a WHILE would not step.
        let word = *self.random.one_of(&["EXIT", "EXIT", "RETURN"]);
        self.line(&format!("IF {condition} THEN {word}; END_IF"));
    }

    fn branch(&mut self, depth: usize) {
        let condition = self.condition();
        self.line(&format!("IF {condition} THEN"));
        self.statements(3, depth + 1);
        if self.random.once_in(2) {
            let condition = self.condition();
            self.line(&format!("ELSIF {condition} THEN"));
            self.statements(2, depth + 1);
        }
        if self.random.once_in(2) {
            self.line("ELSE");
            self.statements(3, depth + 1);
        }
        self.line("END_IF");
    }

    fn case(&mut self, depth: usize) {
        let number = self.number(1);
        self.line(&format!("CASE {number} OF"));
        let labels = *self.random.one_of(&[2, 3, 9]);
        for label in 0..labels {
            self.line(&format!("{}:", label * 2));
            self.statements(2, depth + 1);
        }
        self.line("ELSE");
        self.statements(2, depth + 1);
        self.line("END_CASE");
    }

    fn counted(&mut self, depth: usize) {
        let (first, turns, step) = (self.random.below(5), self.random.below(40), 1 + self.random.below(3));
        let last = first + turns;
        let counter = self.loops;
        let limits = match self.random.once_in(4) {
            true => format!("{last} TO {first} BY -{step}"),
            false => format!("{first} TO {last} BY {step}"),
        };
        self.line(&format!("FOR i{counter} := {limits} DO"));
        self.body(depth);
        self.line("END_FOR");
    }

    fn conditional(&mut self, depth: usize) {
        let (counter, turns) = (self.loops, 1 + self.random.below(20));
        self.line(&format!("w{counter} := 0;"));
        // A call there would be statements of its own.
        let other = self.random.below(4);
        let condition = if self.random.once_in(2) { format!(" AND NOT b{other}") } else { String::new() };
        self.line(&format!("WHILE w{counter} < {turns}{condition} DO\nw{counter} := w{counter} + 1;"));
        self.body(depth);
        self.line("END_WHILE");
    }

    fn body(&mut self, depth: usize) {
        self.loops += 1;
        self.statements(3, depth + 1);
        self.loops -= 1;
    }

    fn variable(&mut self) -> String {
        format!("x{}", self.random.below(4))
    }

    fn index(&mut self) -> String {
        match self.loops.checked_sub(1) {
            Some(inner) if self.random.once_in(2) => format!("i{inner} MOD 10"),
            _ => self.random.below(10).to_string(),
        }
    }

    fn number(&mut self, depth: usize) -> String {
        match self.random.below(if depth == 0 { 4 } else { 10 }) {
            0 => self.random.below(100).to_string(),
            1 => format!("n{}", self.random.below(3)),
            2 | 3 => self.variable(),
            4 => format!("a[{}]", self.index()),
            5 if self.functions > 0 => {
                let (callee, number) = (self.random.below(self.functions), self.number(0));
                format!("F{callee}({number}, n1, x2)")
            }
            6 => format!("MAX({}, {})", self.number(0), self.number(0)),
            7 => format!("{} / (x3 * x3 + 1)", self.number(0)),
            _ => {
                let operation = *self.random.one_of(&["+", "-", "*"]);
                format!("({} {operation} {})", self.number(depth - 1), self.number(depth - 1))
            }
        }
    }

    fn condition(&mut self) -> String {
        match self.random.below(5) {
            0 => format!("b{}", self.random.below(4)),
            1 => format!("p AND b{}", self.random.below(4)),
            _ => {
                let comparison = *self.random.one_of(&["<", ">", "=", "<>", ">="]);
                format!("{} {comparison} {}", self.number(1), self.number(0))
            }
        }
    }
}
