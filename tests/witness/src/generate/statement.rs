//! Statements, each on a line of its own.

use super::Writer;
use super::types::Ty;

impl Writer {
    pub(super) fn statements(&mut self, count: usize) {
        for _ in 0..count {
            self.fuel = 5;
            self.statement(2);
        }
    }

    fn some(&mut self, depth: usize) {
        self.inside(|this| {
            for _ in 0..1 + this.random.below(2) {
                this.fuel = this.fuel.max(2);
                this.statement(depth);
            }
        });
    }

    fn statement(&mut self, depth: usize) {
        if self.codesys && depth > 0 && self.random.once_in(12) {
            return if self.random.once_in(2) { self.attempted(depth) } else { self.labelled(depth) };
        }
        match self.random.below(if depth == 0 { 11 } else { 18 }) {
            0..=4 => self.assignment(),
            5..=7 => match self.block_call() {
                Some(call) => self.line(&format!("{call};")),
                None => self.assignment(),
            },
            8 if self.random.once_in(3) => match self.own_action() {
                Some(call) => self.line(&format!("{call};")),
                None => self.assignment(),
            },
            8 | 9 => match self.function_call(2, |_| true) {
                Some(call) => self.line(&format!("{call};")),
                None => self.assignment(),
            },
            10 if self.random.once_in(4) => self.assign_property(),
            10 => self.bit_or_set(),
            11 | 12 => self.choice(depth),
            13 => self.case(depth),
            14..=16 => self.counted_loop(depth),
            _ => self.loop_with_condition(depth),
        }
    }

    fn assignment(&mut self) {
        let depth = self.random.below(3);
        if let Some((place, ty)) = self.some_place(true, depth, Self::is_assignable) {
            let value = self.expression(&ty, 3);
            self.line(&format!("{place} := {value};"));
        }
    }

    fn is_assignable(&self, ty: &Ty) -> bool {
        self.types.is_value(ty)
    }

    fn bit_or_set(&mut self) {
        if self.random.once_in(4) {
            return self.assign_character();
        }
        let value = self.expression(&Ty::Bool, 2);
        if self.random.once_in(2)
            && let Some((place, _)) = self.some_place(true, 2, |_, it| matches!(it, Ty::Bits(_)))
        {
            let bit = self.random.below(8);
            let byte = self.random.once_in(3);
            let part = if byte {
                format!("{place}.%B0 := {}", self.expression(&Ty::Bits(0), 2))
            } else {
                format!("{place}.{bit} := {value}")
            };
            return self.line(&format!("{part};"));
        }
        if let Some(place) = self.place_of(&Ty::Bool, true, 2) {
            let operator = *self.random.one_of(&["S=", "R="]);
            self.line(&format!("{place} {operator} {value};"));
        }
    }

    fn choice(&mut self, depth: usize) {
        let condition = self.expression(&Ty::Bool, 2);
        self.line(&format!("IF {condition} THEN"));
        self.some(depth - 1);
        self.jump();
        if self.random.once_in(2) {
            let condition = self.expression(&Ty::Bool, 2);
            self.line(&format!("ELSIF {condition} THEN"));
            self.some(depth - 1);
        }
        if self.random.once_in(2) {
            self.line("ELSE");
            self.some(depth - 1);
        }
        self.line("END_IF;");
    }

    /// The end of a branch that leaves.
    fn jump(&mut self) {
        if self.stays {
            return;
        }
        let jump = match self.random.below(6) {
            0 if self.loops > 0 => "EXIT;".to_owned(),
            1 if self.loops > 0 => "CONTINUE;".to_owned(),
            2 if self.random.once_in(3) => "RETURN;".to_owned(),
            3 if !self.labels.is_empty() => format!("JMP {};", self.random.one_of(&self.labels.clone())),
            _ => return,
        };
        self.inside(|this| this.line(&jump));
    }

    /// Statements whose faults are handled. What leaves them may do so only where nothing comes last.
    fn attempted(&mut self, depth: usize) {
        let finally = self.random.once_in(3);
        let stays = self.stays;
        self.stays |= finally;
        self.line("__TRY");
        self.some(depth - 1);
        // Few statements fault by themselves.
        if self.random.once_in(2)
            && let Some(place) = self.place_of(&Ty::Number(2), true, 1)
        {
            let condition = self.expression(&Ty::Bool, 2);
            // The counter keeps it from being a constant, which is refused.
            let counter = format!("{}w0", self.loop_prefix);
            let divisor = format!("BOOL_TO_INT({condition}) + {counter} - {counter}");
            self.inside(|this| this.line(&format!("{place} := 7 / ({divisor});")));
            self.some(depth - 1);
        }
        self.jump();
        self.line("__CATCH");
        self.some(depth - 1);
        self.jump();
        self.stays = stays;
        if finally {
            self.line("__FINALLY");
            self.some(depth - 1);
        }
        self.line("__ENDTRY");
    }

    /// Statements before a label that they jump to; or after one, with a jump back a few times.
    fn labelled(&mut self, depth: usize) {
        if self.whiles >= 4 {
            return self.assignment();
        }
        let counter = format!("{}w{}", self.loop_prefix, self.whiles);
        let label = format!("l{}", self.whiles);
        self.whiles += 1;
        let condition = self.expression(&Ty::Bool, 2);
        if self.random.once_in(2) {
            self.line(&format!("{counter} := 0;"));
            self.line(&format!("{label}:"));
            self.line(&format!("{counter} := {counter} + 1;"));
            self.some(depth - 1);
            self.line(&format!("IF {counter} < 4 AND {condition} THEN JMP {label}; END_IF;"));
            return;
        }
        self.labels.push(label.clone());
        self.some(depth - 1);
        self.line(&format!("IF {condition} THEN JMP {label}; END_IF;"));
        self.some(depth - 1);
        self.labels.pop();
        self.line(&format!("{label}:"));
    }

    fn case(&mut self, depth: usize) {
        let color = self.random.once_in(4);
        let ty = if color { Ty::Color } else { Ty::Number(*self.random.one_of(&[0, 1, 2, 4])) };
        let selector = self.operand(&ty, 2);
        self.line(&format!("CASE {selector} OF"));
        let labels = if color { ["Red", "Green, Color#Blue", ""] } else { ["0, 1", "2..5", "7, 10..100"] };
        for label in labels.iter().filter(|it| !it.is_empty()) {
            self.line(&format!("{label}:"));
            self.some(depth - 1);
            self.jump();
        }
        if self.random.once_in(2) {
            self.line("ELSE");
            self.some(depth - 1);
        }
        self.line("END_CASE;");
    }

    /// FOR, mostly over few values; its variable may be a global, a part of a structure, or of a
    /// subrange, and a callee may write it.
    fn counted_loop(&mut self, depth: usize) {
        if self.loops >= 2 {
            return self.assignment();
        }
        let found = self.direct_place(0, |_, it| it.is_integer() || matches!(it, Ty::Level(_)));
        let Some((counter, ty)) = found else { return self.assignment() };
        let base = match &ty {
            Ty::Level(at) => Ty::Number(self.types.levels[*at].0),
            other => other.clone(),
        };
        let bound = |this: &mut Self, low: i64, high: i64| {
            if this.random.once_in(2) {
                let span = usize::try_from(high - low + 1).unwrap_or(1);
                return (low + i64::try_from(this.random.below(span)).unwrap_or(0)).to_string();
            }
            let value = this.operand(&base, 1);
            format!("LIMIT({low}, {value}, {high})")
        };
        let (low, high) = match &ty {
            Ty::Level(at) => (self.types.levels[*at].1, self.types.levels[*at].2),
            _ => (0, 4),
        };
        let edge = !matches!(ty, Ty::Level(_)) && self.random.once_in(5);
        let (from, to) = if edge {
            let most = ty.elementary().map_or(0, |it| it.range().1);
            ((most - 3).to_string(), most.to_string())
        } else {
            (bound(self, low, high), bound(self, low, high))
        };
        let step = match self.random.below(10) {
            0 => " BY 2".to_owned(),
            1 => " BY -1".to_owned(),
            2 if !edge => format!(" BY LIMIT(1, {}, 3)", self.operand(&base, 1)),
            3 if !edge && self.random.once_in(3) => format!(" BY {}", self.operand(&base, 1)),
            _ => String::new(),
        };
        let (from, to) = if step == " BY -1" && self.random.once_in(2) { (to, from) } else { (from, to) };
        let root = counter.split(['.', '[']).next().unwrap_or_default().to_owned();
        self.line(&format!("FOR {counter} := {from} TO {to}{step} DO"));
        self.counters.push(root);
        self.counting.push((counter, base.is_signed()));
        self.loops += 1;
        self.some(depth - 1);
        self.loops -= 1;
        self.counters.pop();
        self.counting.pop();
        self.line("END_FOR;");
    }

    fn loop_with_condition(&mut self, depth: usize) {
        if self.loops >= 2 || self.whiles >= 4 {
            return self.assignment();
        }
        let counter = format!("{}w{}", self.loop_prefix, self.whiles);
        self.whiles += 1;
        self.loops += 1;
        self.line(&format!("{counter} := 0;"));
        let condition = self.expression(&Ty::Bool, 2);
        if self.random.once_in(2) {
            self.line(&format!("WHILE {counter} < 4 AND {condition} DO"));
            self.inside(|this| this.line(&format!("{counter} := {counter} + 1;")));
            self.some(depth - 1);
            self.line("END_WHILE;");
        } else {
            self.line("REPEAT");
            self.inside(|this| this.line(&format!("{counter} := {counter} + 1;")));
            self.some(depth - 1);
            self.line(&format!("UNTIL {counter} > 3 OR {condition}"));
            self.line("END_REPEAT;");
        }
        self.loops -= 1;
    }
}
