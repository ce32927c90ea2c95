//! Expressions of a type that is asked for.

use super::Writer;
use super::types::{BITS, DATES, NUMBERS, Ty, pins};

impl Writer {
    /// A value of the type, or of one that widens to it.
    pub(super) fn expression(&mut self, ty: &Ty, depth: usize) -> String {
        if depth == 0 {
            return self.leaf(ty);
        }
        if self.random.once_in(6)
            && let Some(call) = self.function_call(depth, |it| it == ty)
        {
            return call;
        }
        match ty {
            Ty::Bool => self.condition(depth),
            Ty::Number(at) if ty.is_real() => self.real(*at, depth),
            Ty::Number(at) => self.integer(*at, depth),
            Ty::Bits(at) => self.bits(*at, depth),
            Ty::Time => self.time(depth),
            Ty::Date(at) => self.date(*at, depth),
            Ty::Text(_) => self.string(false, depth),
            Ty::Wide(_) => self.string(true, depth),
            Ty::Char(wide) => self.character(*wide, depth),
            Ty::Level(at) => self.level(*at, depth),
            Ty::Color => self.color(depth),
            Ty::Array(_) | Ty::Record(_) | Ty::Union(_) => self.leaf(ty),
            Ty::Pointer(to) => self.reference(to, depth),
            Ty::Interface => self.implementer(depth),
            Ty::Instance(_) | Ty::Standard(_) => unreachable!("an instance is not a value"),
        }
    }

    /// A value with a type of its own, so that literals have something to meet.
    pub(super) fn operand(&mut self, ty: &Ty, depth: usize) -> String {
        if depth == 0 { self.variable(ty, 0) } else { self.expression_of_own_type(ty, depth) }
    }

    fn expression_of_own_type(&mut self, ty: &Ty, depth: usize) -> String {
        match self.random.below(3) {
            0 => self.variable(ty, depth),
            1 => match self.function_call(depth, |it| it == ty) {
                Some(call) => call,
                None => self.variable(ty, depth),
            },
            _ => self.expression(ty, depth),
        }
    }

    fn leaf(&mut self, ty: &Ty) -> String {
        if self.random.once_in(4)
            && !matches!(ty, Ty::Array(_) | Ty::Record(_) | Ty::Union(_) | Ty::Pointer(_) | Ty::Interface)
        {
            return self.literal(ty);
        }
        self.variable(ty, 0)
    }

    /// A variable of the type, now and then of one that widens to it.
    fn variable(&mut self, ty: &Ty, depth: usize) -> String {
        if self.random.once_in(12)
            && let Ty::Number(_) = ty
            && let Some((place, found)) = self.some_place(false, depth, |_, it| widens(it, ty))
        {
            // In a REAL's place a whole number would be computed as one.
            return if ty.is_real() && found.is_integer() {
                format!("TO_{}({place})", self.types.name(ty))
            } else {
                place
            };
        }
        match self.place_of(ty, false, depth) {
            Some(place) => place,
            None => self.typed_literal(ty),
        }
    }

    pub(super) fn literal(&mut self, ty: &Ty) -> String {
        match ty {
            Ty::Bool => (*self.random.one_of(&["TRUE", "FALSE"])).to_owned(),
            Ty::Number(at) => (*self.random.one_of(&NUMBERS[*at].literals)).to_owned(),
            Ty::Bits(_) => (*self.random.one_of(&["16#0F", "16#FF", "16#81", "1", "0"])).to_owned(),
            Ty::Time => (*self.random.one_of(&["T#0s", "T#15ms", "T#20ms", "T#1s500ms", "T#7ms"])).to_owned(),
            Ty::Date(0) => (*self.random.one_of(&["D#1970-01-01", "D#2024-02-29", "D#1969-12-31"])).to_owned(),
            Ty::Date(1) => (*self.random.one_of(&["TOD#00:00:00", "TOD#23:59:59.999", "TOD#12:30:00"])).to_owned(),
            Ty::Date(4) => (*self.random.one_of(&["LD#1970-01-01", "LD#2024-02-29", "LD#1969-12-31"])).to_owned(),
            Ty::Date(5) => (*self.random.one_of(&["LTOD#00:00:00", "LTOD#23:59:59.999999999"])).to_owned(),
            Ty::Date(_) => {
                (*self.random.one_of(&["DT#1970-01-01-00:00:00", "DT#2024-02-29-23:59:59", "DT#1969-12-31-12:00:00"]))
                    .to_owned()
            }
            Ty::Text(_) => self.text_literal(false),
            Ty::Wide(_) => self.text_literal(true),
            Ty::Char(wide) => self.character_literal(*wide),
            Ty::Color => (*self.random.one_of(&["Color#Red", "Color.Green", "Color#Blue"])).to_owned(),
            Ty::Level(at) => {
                let (_, low, high) = self.types.levels[*at];
                self.random.one_of(&[low, low + 1, high]).to_string()
            }
            Ty::Pointer(_) | Ty::Interface => "NULL".to_owned(),
            Ty::Array(_) | Ty::Record(_) | Ty::Union(_) | Ty::Instance(_) | Ty::Standard(_) => {
                unreachable!("no literal of this type")
            }
        }
    }

    fn typed_literal(&mut self, ty: &Ty) -> String {
        let literal = self.literal(ty);
        match ty {
            Ty::Number(at) => format!("{}#{literal}", NUMBERS[*at].name),
            Ty::Bits(at) => format!("{}#{literal}", BITS[*at]),
            Ty::Level(at) => format!("{}#{literal}", NUMBERS[self.types.levels[*at].0].name),
            Ty::Char(wide) => format!("{}#{literal}", if *wide { "WCHAR" } else { "CHAR" }),
            Ty::Bool | Ty::Time | Ty::Date(_) | Ty::Text(_) | Ty::Wide(_) | Ty::Color => literal,
            Ty::Pointer(_) | Ty::Interface => literal,
            Ty::Array(_) | Ty::Record(_) | Ty::Union(_) | Ty::Instance(_) | Ty::Standard(_) => {
                unreachable!("no literal of this type")
            }
        }
    }

    /// Mostly one that leads somewhere.
    fn reference(&mut self, to: &Ty, depth: usize) -> String {
        let whole = Ty::Pointer(Box::new(to.clone()));
        match self.random.below(8) {
            0 if self.random.once_in(8) => "NULL".to_owned(),
            0..=2 => self.variable(&whole, depth),
            _ => self.address_of(to, depth).unwrap_or_else(|| self.variable(&whole, depth)),
        }
    }

    /// Whether two references, or one and nothing, are the same.
    fn same(&mut self, depth: usize) -> Option<String> {
        let (a, ty) = self.some_place(false, depth, |_, it| matches!(it, Ty::Pointer(_)))?;
        let b = if self.random.once_in(2) { "NULL".to_owned() } else { self.expression(&ty, depth - 1) };
        Some(format!("({a} {} {b})", self.random.one_of(&["=", "<>"])))
    }

    fn number_type(&mut self) -> Ty {
        Ty::Number(*self.random.one_of(&[0, 1, 1, 2, 2, 4, 5, 8]))
    }

    /// An operand of fewer than 32 bits, of whatever type: CODESYS computes all of them at 32.
    fn narrow(&mut self, depth: usize) -> String {
        let ty = match self.random.below(6) {
            at @ (0 | 1 | 4 | 5) => Ty::Number(at),
            at => Ty::Bits(at - 2),
        };
        let operand = self.operand(&ty, depth);
        match self.random.below(4) {
            0 => format!("({operand} + 1)"),
            1 => format!("({operand} * {operand})"),
            _ => operand,
        }
    }

    fn mixed(&mut self, depth: usize) -> String {
        let (a, b) = (self.narrow(depth - 1), self.narrow(depth - 1));
        match self.random.below(8) {
            0 => format!("MAX({a}, {b})"),
            1 => format!("SEL({}, {a}, {b})", self.expression(&Ty::Bool, depth - 1)),
            2 => format!("-({a})"),
            3 => format!("({a} / MAX({b}, 1))"),
            _ => format!("({a} {} {b})", self.random.one_of(&["+", "-", "*"])),
        }
    }

    fn integer(&mut self, at: usize, depth: usize) -> String {
        if self.codesys && matches!(at, 2 | 3) && self.random.once_in(3) {
            return self.mixed(depth);
        }
        let ty = &Ty::Number(at);
        let a = self.operand(ty, depth - 1);
        match self.random.below(20) {
            0..=4 => {
                let sign = *self.random.one_of(&["+", "-", "*"]);
                format!("({a} {sign} {})", self.expression(ty, depth - 1))
            }
            // What is written first may be a number too.
            5 => format!("({} + {a})", self.literal(ty)),
            6 => {
                let sign = *self.random.one_of(&["/", "MOD"]);
                match self.random.below(8) {
                    0 => format!("({a} {sign} {})", self.variable(ty, depth - 1)),
                    _ => format!("({a} {sign} MAX({}, 1))", self.operand(ty, depth - 1)),
                }
            }
            7 => format!("({a} MOD 7)"),
            8 => self.function_of_three("LIMIT", ["MN", "IN", "MX"], ty, depth),
            9 => {
                let name = *self.random.one_of(&["MAX", "MIN"]);
                format!("{name}({a}, {})", self.expression(ty, depth - 1))
            }
            10 => self.sel(ty, depth),
            11 => self.mux(ty, depth),
            12 if ty.is_signed() => format!("-({a})"),
            13 => format!("ABS({a})"),
            14..=16 => {
                let from = self.number_type();
                let value = self.operand(&from, depth - 1);
                format!("{}_TO_{}({value})", self.types.name(&from), self.types.name(ty))
            }
            17 => match self.random.below(8) {
                0 | 4 => {
                    let wide = self.random.once_in(2);
                    format!("INT_TO_{}(LEN({}))", NUMBERS[at].name, self.string(wide, depth - 1))
                }
                5 => {
                    let wide = self.random.once_in(2);
                    let (a, b) = (self.string(wide, depth - 1), self.string(wide, depth - 1));
                    format!("INT_TO_{}(FIND({a}, {b}))", NUMBERS[at].name)
                }
                6 if !self.codesys => {
                    let of = Ty::Char(self.random.once_in(2));
                    format!("TO_{}({})", NUMBERS[at].name, self.operand(&of, depth - 1))
                }
                7 => {
                    let day = Ty::Date(*self.random.one_of(&[0, 2]));
                    let day = if self.random.once_in(2) { Ty::Date(0) } else { day };
                    let of = match day {
                        Ty::Date(0) => self.operand(&day, depth - 1),
                        _ => format!("DT_TO_DATE({})", self.operand(&day, depth - 1)),
                    };
                    format!("INT_TO_{}(DAY_OF_WEEK({of}))", NUMBERS[at].name)
                }
                1 => format!("TO_{}({})", NUMBERS[at].name, self.operand(&Ty::Color, depth - 1)),
                2 => format!("TIME_TO_{}({})", NUMBERS[at].name, self.operand(&Ty::Time, depth - 1)),
                _ => format!("REAL_TRUNC_{}({})", NUMBERS[at].name, self.operand(&Ty::Number(8), depth - 1)),
            },
            _ => a,
        }
    }

    fn real(&mut self, at: usize, depth: usize) -> String {
        let ty = &Ty::Number(at);
        let a = self.operand(ty, depth - 1);
        let b = self.expression(ty, depth - 1);
        match self.random.below(12) {
            0..=2 => format!("({a} {} {b})", self.random.one_of(&["+", "-", "*"])),
            3 => format!("({a} / {})", self.operand(ty, depth - 1)),
            4 => format!("SQRT(ABS({a}))"),
            5 => format!("MIN({a}, {b})"),
            6 => self.sel(ty, depth),
            7 | 8 => {
                let from = self.number_type();
                let value = self.operand(&from, depth - 1);
                format!("{}_TO_{}({value})", self.types.name(&from), self.types.name(ty))
            }
            9 => format!("({} + 1.0 + {a})", self.literal(ty)),
            _ => a,
        }
    }

    fn condition(&mut self, depth: usize) -> String {
        match self.random.below(16) {
            15 => match self.same(depth) {
                Some(it) => it,
                None => self.variable(&Ty::Bool, depth),
            },
            14 => match self.some_place(true, depth, |_, it| matches!(it, Ty::Standard(at) if pins(*at).is_empty())) {
                Some((tag, _)) => self.instruction(&tag),
                None => self.variable(&Ty::Bool, depth),
            },
            0 => self.junction("AND", depth),
            1 => self.junction("OR", depth),
            2 => self.junction("XOR", depth),
            3 => self.junction("AND_THEN", depth),
            4 => self.junction("OR_ELSE", depth),
            5 => format!("NOT {}", self.operand(&Ty::Bool, depth - 1)),
            6 => {
                let (a, b) = (self.operand(&Ty::Color, depth - 1), self.expression(&Ty::Color, depth - 1));
                format!("({a} {} {b})", self.random.one_of(&["=", "<>"]))
            }
            7 => {
                let wide = self.random.once_in(2);
                let (a, b) = match self.random.below(3) {
                    0 if !self.codesys => {
                        let of = Ty::Char(wide);
                        (self.operand(&of, depth - 1), self.expression(&of, depth - 1))
                    }
                    _ => (self.string(wide, depth - 1), self.string(wide, depth - 1)),
                };
                format!("({a} {} {b})", self.random.one_of(&["=", "<", ">="]))
            }
            8 => format!("(tick MOD {} = {})", self.random.below(3) + 2, self.random.below(2))
                .replace("tick", &self.tick()),
            9 => self.sel(&Ty::Bool, depth),
            10 => {
                let (ty, name) = (self.number_type(), *self.random.one_of(&["GT", "LE", "EQ"]));
                let (a, b) = (self.operand(&ty, depth - 1), self.operand(&ty, depth - 1));
                format!("{name}({a}, {b})")
            }
            11 => match self.some_place(false, depth, |_, it| matches!(it, Ty::Bits(_))) {
                Some((place, _)) => format!("{place}.{}", self.random.below(8)),
                None => self.variable(&Ty::Bool, depth),
            },
            12 if self.codesys => {
                let (a, b) = (self.mixed(depth), self.narrow(depth - 1));
                format!("({a} {} {b})", self.random.one_of(&["<", "<=", ">", ">=", "=", "<>"]))
            }
            _ => {
                let ty = self.number_type();
                let (a, b) = (self.operand(&ty, depth - 1), self.expression(&ty, depth - 1));
                format!("({a} {} {b})", self.random.one_of(&["<", "<=", ">", ">=", "=", "<>"]))
            }
        }
    }

    /// What changes from scan to scan.
    fn tick(&mut self) -> String {
        self.variable(&Ty::Number(2), 0)
    }

    fn junction(&mut self, operator: &str, depth: usize) -> String {
        let a = self.operand(&Ty::Bool, depth - 1);
        let b = self.expression(&Ty::Bool, depth - 1);
        format!("({a} {operator} {b})")
    }

    fn bits(&mut self, at: usize, depth: usize) -> String {
        let ty = &Ty::Bits(at);
        let a = self.operand(ty, depth - 1);
        match self.random.below(6) {
            0 | 1 => {
                let operator = *self.random.one_of(&["AND", "OR", "XOR"]);
                format!("({a} {operator} {})", self.operand(ty, depth - 1))
            }
            2 => {
                let name = *self.random.one_of(&["SHL", "SHR", "ROL", "ROR"]);
                format!("{name}({a}, {})", self.operand(&Ty::Number(1), depth - 1))
            }
            3 => format!("NOT {a}"),
            5 if self.codesys && at < 2 => self.character_of_text(at == 1, depth - 1).unwrap_or(a),
            4 => {
                let from = self.number_type();
                let value = self.operand(&from, depth - 1);
                format!("{}_TO_{}({value})", self.types.name(&from), BITS[at])
            }
            _ => a,
        }
    }

    fn time(&mut self, depth: usize) -> String {
        let a = self.operand(&Ty::Time, depth - 1);
        match self.random.below(7) {
            6 => {
                let of = Ty::Date(self.random.below(3));
                if self.random.once_in(3) {
                    let name = DATES[match of {
                        Ty::Date(it) => it,
                        _ => 0,
                    }]
                    .0;
                    let (a, b) = (self.operand(&of, depth - 1), self.operand(&of, depth - 1));
                    return format!("SUB_{name}_{name}({a}, {b})");
                }
                format!("({} - {})", self.operand(&of, depth - 1), self.operand(&of, depth - 1))
            }
            0 => format!("({a} {} {})", self.random.one_of(&["+", "-"]), self.operand(&Ty::Time, depth - 1)),
            1 => format!("({a} * {})", self.operand(&Ty::Number(1), depth - 1)),
            2 => format!("({a} / MAX({}, 1))", self.operand(&Ty::Number(1), depth - 1)),
            3 => format!("DINT_TO_TIME({})", self.operand(&Ty::Number(2), depth - 1)),
            _ => a,
        }
    }

    fn date(&mut self, at: usize, depth: usize) -> String {
        let own = Ty::Date(at);
        match self.random.below(6) {
            // A day and a time have no sum, but in CODESYS.
            0 if !matches!(at, 0 | 4) => {
                let sign = *self.random.one_of(&["+", "-"]);
                format!("({} {sign} {})", self.operand(&own, depth - 1), self.operand(&Ty::Time, depth - 1))
            }
            1 => {
                let other = (at + 1 + self.random.below(DATES.len() - 1)) % DATES.len();
                let value = self.operand(&Ty::Date(other), depth - 1);
                format!("{}_TO_{}({value})", DATES[other].0, DATES[at].0)
            }
            2 => format!("DINT_TO_{}({})", DATES[at].0, self.operand(&Ty::Number(2), depth - 1)),
            3 => self.made_date(at, depth).unwrap_or_else(|| self.operand(&own, depth - 1)),
            _ => self.operand(&own, depth - 1),
        }
    }

    /// A date of its parts, or by a function's name; now and then of parts that make none.
    fn made_date(&mut self, at: usize, depth: usize) -> Option<String> {
        let part = |this: &mut Self, low: i64, high: i64| {
            let value = this.operand(&Ty::Number(1), depth - 1);
            let high = if this.random.once_in(24) { high + 1 } else { high };
            format!("LIMIT({low}, {value}, {high})")
        };
        let made = match at {
            0 => format!("CONCAT_DATE({}, {}, {})", part(self, 1970, 2100), part(self, 1, 12), part(self, 1, 28)),
            1 if self.random.once_in(2) => {
                let (time, name) = (self.operand(&Ty::Time, depth - 1), *self.random.one_of(&["ADD", "SUB"]));
                format!("{name}_TOD_TIME({}, {time})", self.operand(&Ty::Date(1), depth - 1))
            }
            1 => {
                let (hour, minute) = (part(self, 0, 23), part(self, 0, 59));
                format!("CONCAT_TOD({hour}, {minute}, {}, {})", part(self, 0, 59), part(self, 0, 999))
            }
            2 if self.random.once_in(2) => {
                let day = self.operand(&Ty::Date(0), depth - 1);
                format!("CONCAT_DATE_TOD({day}, {})", self.operand(&Ty::Date(1), depth - 1))
            }
            2 => {
                let (time, name) = (self.operand(&Ty::Time, depth - 1), *self.random.one_of(&["ADD", "SUB"]));
                format!("{name}_DT_TIME({}, {time})", self.operand(&Ty::Date(2), depth - 1))
            }
            _ => return None,
        };
        Some(made)
    }

    fn color(&mut self, depth: usize) -> String {
        match self.random.below(4) {
            0 => self.sel(&Ty::Color, depth),
            1 => self.literal(&Ty::Color),
            2 => (*self.random.one_of(&["Red", "Green", "Blue"])).to_owned(),
            _ => self.variable(&Ty::Color, depth),
        }
    }

    /// A value for a subrange: outside of it now and then.
    fn level(&mut self, at: usize, depth: usize) -> String {
        let (base, low, high) = self.types.levels[at];
        let ty = Ty::Number(base);
        let value = self.operand(&ty, depth - 1);
        match self.random.below(8) {
            0 => self.variable(&Ty::Level(at), depth),
            // A constant that lies outside is refused.
            1 if self.random.once_in(3) && !is_constant(&value) => value,
            _ => format!("LIMIT({low}, {value}, {high})"),
        }
    }

    fn sel(&mut self, ty: &Ty, depth: usize) -> String {
        let g = self.expression(&Ty::Bool, depth - 1);
        let (a, b) = (self.operand(ty, depth - 1), self.expression(ty, depth - 1));
        match self.random.below(4) {
            0 => format!("SEL(IN1 := {a}, G := {g}, IN0 := {b})"),
            _ => format!("SEL({g}, {a}, {b})"),
        }
    }

    fn mux(&mut self, ty: &Ty, depth: usize) -> String {
        let k = self.operand(&Ty::Number(1), depth - 1);
        let k = if self.random.once_in(8) { k } else { format!("LIMIT(0, {k}, 2)") };
        let values = [self.operand(ty, depth - 1), self.operand(ty, depth - 1), self.operand(ty, depth - 1)];
        format!("MUX({k}, {})", values.join(", "))
    }

    fn function_of_three(&mut self, name: &str, names: [&str; 3], ty: &Ty, depth: usize) -> String {
        let values = [self.operand(ty, depth - 1), self.operand(ty, depth - 1), self.operand(ty, depth - 1)];
        let [a, b, c] = &values;
        match self.random.below(3) {
            0 => format!("{name}({0} := {c}, {1} := {a}, {2} := {b})", names[2], names[0], names[1]),
            _ => format!("{name}({a}, {b}, {c})"),
        }
    }
}

/// Whether this is a literal, or the name of a constant.
fn is_constant(value: &str) -> bool {
    let bare = value.rsplit('#').next().unwrap_or(value);
    bare.strip_prefix(['k', '-']).unwrap_or(bare).chars().all(|it| it.is_ascii_digit())
}

fn widens(from: &Ty, to: &Ty) -> bool {
    match (from.elementary(), to.elementary()) {
        (Some(from), Some(to)) => from != to && from.widens_to(to),
        _ => false,
    }
}
