//! Calls: `JSR`, `RET`, and Add-On Instructions.

use super::super::super::assembly::{Chunk, Trouble};
use super::super::logic::Subroutine;
use super::super::names::key;
use super::condition::{Condition, Expression};
use super::parse::Instruction;
use super::write::{Writer, counted};
use core::ops::Range;

impl Writer<'_> {
    /// `JSR(Routine,2,a,b,c)`: two inputs, and where what is returned goes.
    pub fn call_routine(
        &mut self,
        it: &Instruction,
        operands: &[Vec<Chunk>],
        condition: &Condition,
        place: &Range<usize>,
    ) {
        let Some(name) = it.operands.first().map(|it| self.operand_text(it).to_owned()) else {
            return self.miscounted("JSR", &["Routine Name"], it);
        };
        if name.eq_ignore_ascii_case(self.logic.main) {
            let message = format!("`{name}` is the main routine, which would call itself");
            return self.wrong(Trouble::Odd, message, &it.place);
        }
        let Some(action) = self.logic.actions.get(&key(&name)).cloned() else {
            return self.wrong(Trouble::Odd, format!("the program has no routine `{name}`"), &it.operands[0]);
        };
        let inputs = it.operands.get(1).map_or(Some(0), |it| self.operand_text(it).parse().ok());
        let Some(inputs) = inputs.filter(|it: &usize| *it <= operands.len().saturating_sub(2)) else {
            let message = "the second operand is the number of inputs, which follow it".to_owned();
            return self.wrong(Trouble::Odd, message, &it.operands[1]);
        };
        let given = operands.get(2..).unwrap_or_default();
        let (given, wanted) = given.split_at(inputs);
        let (routine_inputs, returns) = match self.logic.subroutines.get(&key(&name)) {
            // What is wrong with it is said where it is.
            Some(Subroutine::Unknown) => return,
            Some(Subroutine::Known { inputs, returns }) => (inputs.clone(), returns.clone()),
            None => (Vec::new(), Vec::new()),
        };
        let (takes, gives) = (routine_inputs.len(), returns.iter().map(Vec::len).min().unwrap_or(0));
        if given.len() != takes || wanted.len() > gives {
            let [inputs, values] = [(takes, "input"), (gives, "value")].map(|(it, what)| counted(it, what));
            let (given, wanted) = (given.len(), wanted.len());
            let message =
                format!("`{name}` takes {inputs} and returns {values}, by its SBR and RET, not {given} and {wanted}");
            return self.wrong(Trouble::Odd, message, &it.place);
        }
        let mut words = Vec::new();
        for (to, from) in routine_inputs.iter().zip(given) {
            words.extend(
                [to.clone(), vec![Chunk::words(" := ", place)], from.clone(), vec![Chunk::words("; ", place)]].concat(),
            );
        }
        if wanted.is_empty() {
            words.push(Chunk::words(format!("{action}()"), place));
        } else {
            let number = self.return_of(&name);
            words.push(Chunk::words(format!("{number} := 0; {action}();"), place));
            for (at, values) in returns.iter().enumerate() {
                let head = if at == 0 { " IF" } else { " ELSIF" };
                words.push(Chunk::words(format!("{head} {number} = {} THEN", at + 1), place));
                for (to, from) in wanted.iter().zip(values) {
                    let blank = vec![Chunk::words(" ", place)];
                    words.extend(
                        [
                            blank,
                            to.clone(),
                            vec![Chunk::words(" := ", place)],
                            from.clone(),
                            vec![Chunk::words(";", place)],
                        ]
                        .concat(),
                    );
                }
            }
            words.push(Chunk::words(" END_IF", place));
        }
        self.where_true(condition, words, place);
    }

    pub fn returned(&mut self, it: &Instruction, condition: &Condition, place: &Range<usize>) {
        let mut words = Vec::new();
        if !it.operands.is_empty() {
            self.returns += 1;
            let number = self.return_of(self.routine);
            words.push(Chunk::words(format!("{number} := {}; ", self.returns), place));
        }
        words.push(Chunk::words("RETURN", place));
        self.leave(condition, words, place);
    }

    /// A call of an Add-On Instruction, `Valve(valve_1,level,closed)`.
    pub fn call_instruction(&mut self, it: &Instruction, condition: Condition, wanted: bool) -> Condition {
        let (name, place) = (self.name(it).to_owned(), self.text.place(&it.place));
        let parameters = self.logic.names.instructions.get(&key(&name)).cloned().unwrap_or_default();
        if it.operands.len() != parameters.len() + 1 {
            let names: Vec<&str> =
                std::iter::once("its tag").chain(parameters.iter().map(|it| it.name.as_str())).collect();
            self.miscounted(&name, &names, it);
            return condition;
        }
        let tag = self.text.part(&it.operands[0]);
        let is_always = self.logic.names.runs_when_false.contains(&key(&name));
        let mut words = tag.clone();
        words.push(Chunk::words("(EnableIn := ", &place));
        words.extend(if is_always { condition.words(&place) } else { vec![Chunk::words("TRUE", &place)] });
        for (parameter, part) in parameters.iter().zip(&it.operands[1..]) {
            let sign = if parameter.is_output { "=>" } else { ":=" };
            words.push(Chunk::words(format!(", {} {sign} ", parameter.name), &place));
            words.extend(self.text.part(part));
        }
        words.push(Chunk::words(")", &place));
        if is_always {
            self.statement(words, &place);
        } else {
            self.where_true(&condition, words, &place);
        }
        if !wanted {
            return condition;
        }
        let out = [tag, vec![Chunk::words(".EnableOut", &place)]].concat();
        condition.and(Expression::new(out), &place)
    }
}
