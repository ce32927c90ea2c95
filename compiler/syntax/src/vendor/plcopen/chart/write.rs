//! A chart as text: each initial step, with its ACTIONs and transitions after it, and after these the steps that they enter.

use super::super::super::assembly::{Trouble, text};
use super::super::super::diagram::{Context, Diagram, Names, Refusal, Types, Wire, Writer, is_one_expression};
use super::super::super::unit::after_comment;
use super::element::{Action, Chart, Condition, Does, Kind};
use super::network::{Networks, StepAt, refuse};
use super::{Chunk, Parts, Transition, Written};
use core::ops::Range;
use rustc_hash::{FxHashMap, FxHashSet};

/// The ACTION that runs the blocks that conditions are wired of.
const BLOCKS: &str = "COMPUTE_FUNCTION_BLOCKS";

type Of<T> = Result<T, Refusal>;

pub fn write(
    file: &str,
    chart: &Chart,
    networks: &Networks,
    context: Context<'_>,
    names: &mut Names,
    parts: Parts<'_>,
) -> Of<Written> {
    let mut conditions = Conditions {
        file,
        context,
        statements: FxHashMap::default(),
        variables: Vec::new(),
        values: FxHashMap::default(),
    };
    conditions.find(chart, &networks.found, parts.transitions, names)?;
    let Conditions { mut statements, variables, values, .. } = conditions;
    let blocks = networks.found.iter().filter_map(|it| statements.remove(it)).flatten().collect();
    let mut text = Text {
        file,
        chart,
        networks,
        conditions: values,
        actions: parts.actions.into_iter().map(|(name, body)| (name.to_ascii_uppercase(), body)).collect(),
        blocks,
        numbers: numbers(chart),
        seen: FxHashSet::default(),
        written: Vec::new(),
    };
    for step in &networks.initial {
        text.network(*step)?;
    }
    text.rest();
    Ok(Written { text: text.written, variables })
}

/// What the transitions wait for.
struct Conditions<'w> {
    file: &'w str,
    context: Context<'w>,
    /// The calls of blocks that each is wired of.
    statements: FxHashMap<usize, Vec<Chunk>>,
    variables: Vec<(String, String)>,
    /// After the steps of each transition.
    values: FxHashMap<usize, Vec<Chunk>>,
}

impl Conditions<'_> {
    fn find(
        &mut self,
        chart: &Chart,
        order: &[usize],
        named: &FxHashMap<String, Transition>,
        names: &mut Names,
    ) -> Of<()> {
        let mut wired = Vec::new();
        for at in order.iter().copied() {
            let element = &chart.elements[at];
            let Kind::Transition { condition, .. } = &element.kind else { continue };
            let value = match condition {
                Condition::Missing => {
                    return Err(refuse(element, Trouble::Odd, "this transition has no condition".to_owned()));
                }
                Condition::Other(language) => {
                    let message = format!("the condition is {language}, not Structured Text");
                    return Err(refuse(element, Trouble::OtherLanguage, message));
                }
                Condition::Text(it) => self.assigned(it.clone(), &element.place),
                Condition::Wired(wires) if wires.is_empty() => {
                    return Err(refuse(
                        element,
                        Trouble::Odd,
                        "nothing is wired to the condition of this transition".to_owned(),
                    ));
                }
                Condition::Wired(wires) => {
                    wired.push((at, wires.as_slice(), element.place.clone()));
                    continue;
                }
                Condition::Named(name) => match named.get(&name.text.to_ascii_uppercase()) {
                    // It is a variable.
                    None => self.assigned(vec![name.chunk.clone()], &element.place),
                    Some(Transition::Text(it)) => {
                        let is_assignment = text(self.file, it).starts_with(":=");
                        if is_assignment {
                            closed(self.file, it.clone(), &element.place)
                        } else {
                            self.assigned(it.clone(), &element.place)
                        }
                    }
                    Some(Transition::Other(language)) => {
                        let message = format!("the transition `{}` is {language}, not Structured Text", name.text);
                        return Err(refuse(element, Trouble::OtherLanguage, message));
                    }
                    Some(Transition::Diagram(diagram)) => {
                        let Some(wires) = diagram.wires_to(self.file, &name.text) else {
                            let message = format!(
                                "the diagram of the transition `{}` has no variable or coil with this name",
                                name.text
                            );
                            return Err(refuse(element, Trouble::Odd, message));
                        };
                        self.wired(diagram, &[(at, wires, element.place.clone())], names)?;
                        continue;
                    }
                },
            };
            self.check_condition(&value, &element.place)?;
            self.values.insert(at, value);
        }
        self.wired(&chart.diagram, &wired, names)
    }

    /// A condition is one expression: it is written among others.
    fn check_condition(&self, value: &[Chunk], place: &Range<usize>) -> Of<()> {
        let written = without_comments(&text(self.file, value));
        let condition = written.trim().trim_start_matches(":=").trim_end().trim_end_matches(';').trim();
        let why = match condition {
            "" => "the condition of this transition is empty".to_owned(),
            _ if !is_one_expression(condition) => format!("`{condition}` is not a condition"),
            _ => return Ok(()),
        };
        Err(Refusal { place: place.clone(), trouble: Trouble::Odd, message: why })
    }

    /// `:= condition;`
    fn assigned(&self, condition: Vec<Chunk>, place: &Range<usize>) -> Vec<Chunk> {
        let mut value = vec![Chunk::words(" := ", place)];
        value.extend(condition);
        closed(self.file, value, place)
    }

    /// Finds what wires to some transitions carry.
    fn wired(&mut self, diagram: &Diagram, wired: &[(usize, &[Wire], Range<usize>)], names: &mut Names) -> Of<()> {
        if wired.is_empty() {
            return Ok(());
        }
        let types = Types::of(self.file, diagram, self.context.declared, self.context.pou);
        let wires: Vec<_> = wired.iter().map(|it| it.1).collect();
        let (values, variables) = Writer::new(self.file, diagram, &types, self.context, names).values(&wires)?;
        self.variables.extend(variables);
        for ((value, statements), (at, _, place)) in values.into_iter().zip(wired) {
            let mut chunks = Vec::new();
            value.write(place, &mut chunks);
            self.values.insert(*at, self.assigned(chunks, place));
            self.statements.insert(*at, statements);
        }
        Ok(())
    }
}

fn without_comments(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("(*") {
        kept.push_str(&rest[..at]);
        rest = after_comment(&rest[at + 2..]);
    }
    kept + rest
}

/// With a `;` at its end.
fn closed(file: &str, mut value: Vec<Chunk>, place: &Range<usize>) -> Vec<Chunk> {
    if !text(file, &value).ends_with(';') {
        value.push(Chunk::words(";", place));
    }
    value.push(Chunk::words(" ", place));
    value
}

/// An ACTION: its name, its text, and where it is used.
type NamedText = (String, Vec<Chunk>, Range<usize>);

/// The numbers of the actions that are written in action blocks, in the order of the file.
fn numbers(chart: &Chart) -> FxHashMap<(usize, usize), usize> {
    let mut numbers = FxHashMap::default();
    for (block, element) in chart.elements.iter().enumerate() {
        let Kind::Actions(actions) = &element.kind else { continue };
        for (at, _) in actions.iter().enumerate().filter(|it| matches!(it.1.does, Does::Text(_))) {
            numbers.insert((block, at), numbers.len() + 1);
        }
    }
    numbers
}

struct Text<'w> {
    file: &'w str,
    chart: &'w Chart,
    networks: &'w Networks,
    conditions: FxHashMap<usize, Vec<Chunk>>,
    /// Those that are not written yet, by their names in capitals.
    actions: Vec<(String, Vec<Chunk>)>,
    blocks: Vec<Chunk>,
    /// Of the actions that are written in an action block: by the block, and the place in it.
    numbers: FxHashMap<(usize, usize), usize>,
    seen: FxHashSet<usize>,
    written: Vec<Chunk>,
}

impl<'w> Text<'w> {
    fn words(&mut self, words: impl Into<String>, place: &Range<usize>) {
        self.written.push(Chunk::words(words, place));
    }

    /// What is entered by a transition comes before the next transition.
    fn network(&mut self, initial: StepAt) -> Of<()> {
        let mut waiting = vec![initial];
        while let Some(at) = waiting.pop() {
            if !self.seen.insert(at) {
                continue;
            }
            let is_step = matches!(self.chart.elements[at].kind, Kind::Step { .. });
            let after = if is_step { &self.networks.transitions } else { &self.networks.to };
            match is_step {
                true => self.step(at)?,
                false => self.transition(at)?,
            }
            waiting.extend(after.get(&at).into_iter().flatten().rev());
        }
        Ok(())
    }

    fn step(&mut self, at: StepAt) -> Of<()> {
        let element = &self.chart.elements[at];
        let Kind::Step { name, is_initial } = &element.kind else { return Ok(()) };
        self.words(if *is_initial { "\nINITIAL_STEP " } else { "\nSTEP " }, &element.place);
        self.written.push(name.chunk.clone());
        self.words(":\n", &element.place);
        let mut after = Vec::new();
        for block in self.networks.actions.get(&at).into_iter().flatten() {
            let Kind::Actions(actions) = &self.chart.elements[*block].kind else { continue };
            for (number, action) in actions.iter().enumerate() {
                let number = self.numbers.get(&(*block, number)).copied().unwrap_or_default();
                self.association(action, &format!("{}_INLINE{number}", name.text.to_ascii_uppercase()), &mut after)?;
            }
        }
        if self.networks.initial.first() == Some(&at) && !self.blocks.is_empty() {
            self.words(format!("    {BLOCKS}(S);\n"), &element.place);
            after.push((BLOCKS.to_owned(), std::mem::take(&mut self.blocks), element.place.clone()));
        }
        self.words("END_STEP\n", &element.place);
        for (name, body, place) in after {
            self.action(&name, body, &place);
        }
        Ok(())
    }

    /// `Fill(L, T#5s);`, and the ACTION where it is the first that names it.
    fn association(&mut self, action: &Action, inline: &str, after: &mut Vec<NamedText>) -> Of<()> {
        let place = &action.place;
        let is_word = |it: &str| it.bytes().all(|it| it.is_ascii_alphanumeric());
        let pasted = action.duration.iter().chain(&action.indicator).map(|it| it.said(self.file));
        let wrong = (!is_word(&action.qualifier)).then(|| action.qualifier.clone());
        let wrong = wrong.or_else(|| pasted.map(String::from).find(|it| !is_one_expression(it)));
        if let Some(wrong) = wrong {
            let message = format!("`{wrong}` is not a part of an action");
            return Err(Refusal { place: place.clone(), trouble: Trouble::Odd, message });
        }
        self.words("    ", place);
        match &action.does {
            Does::Missing => {
                let message = "this action names nothing and has no text".to_owned();
                return Err(Refusal { place: place.clone(), trouble: Trouble::Odd, message });
            }
            Does::Other(language) => {
                let message = format!("this action is {language}, not Structured Text");
                return Err(Refusal { place: place.clone(), trouble: Trouble::OtherLanguage, message });
            }
            Does::Named(name) => {
                self.written.push(name.chunk.clone());
                if let Some(known) = self.actions.iter().position(|it| it.0.eq_ignore_ascii_case(&name.text)) {
                    let (_, body) = self.actions.remove(known);
                    after.push((name.text.clone(), body, place.clone()));
                }
            }
            Does::Text(body) => {
                self.words(inline, place);
                after.push((inline.to_owned(), body.clone(), place.clone()));
            }
        }
        self.words(format!("({}", action.qualifier), place);
        for part in action.duration.iter().chain(&action.indicator).filter(|it| !it.said(self.file).trim().is_empty()) {
            self.words(", ", place);
            self.written.push(part.clone());
        }
        self.words(");\n", place);
        Ok(())
    }

    fn action(&mut self, name: &str, body: Vec<Chunk>, place: &Range<usize>) {
        self.words(format!("ACTION {name}:\n"), place);
        self.written.extend(body);
        self.words("\nEND_ACTION\n", place);
    }

    fn transition(&mut self, at: usize) -> Of<()> {
        let element = &self.chart.elements[at];
        let Kind::Transition { priority, .. } = &element.kind else { return Ok(()) };
        let from = self.networks.from.get(&at).map_or(&[][..], Vec::as_slice);
        let to = self.networks.to.get(&at).map_or(&[][..], Vec::as_slice);
        if to.is_empty() {
            return Err(refuse(element, Trouble::Odd, "no step is after this transition".to_owned()));
        }
        self.words("TRANSITION ", &element.place);
        if let Some(priority) = priority.as_ref().filter(|it| !it.bytes().all(|it| it.is_ascii_digit())) {
            return Err(refuse(element, Trouble::Odd, format!("the priority `{priority}` is not a whole number")));
        }
        if let Some(priority) = priority {
            self.words(format!("(PRIORITY := {priority}) "), &element.place);
        }
        self.words("FROM ", &element.place);
        self.steps(from, &element.place);
        self.words(" TO ", &element.place);
        self.steps(to, &element.place);
        let condition = self.conditions.remove(&at).unwrap_or_default();
        self.written.extend(condition);
        self.words("END_TRANSITION\n", &element.place);
        Ok(())
    }

    fn steps(&mut self, steps: &[StepAt], place: &Range<usize>) {
        let open = if steps.len() > 1 { ["(", ")"] } else { ["", ""] };
        self.words(open[0], place);
        for (at, step) in steps.iter().enumerate() {
            if at > 0 {
                self.words(", ", place);
            }
            if let Kind::Step { name, .. } = &self.chart.elements[*step].kind {
                self.words(name.text.clone(), place);
            }
        }
        self.words(open[1], place);
    }

    /// The ACTIONs that no step names.
    fn rest(&mut self) {
        let end = self.chart.elements.last().map_or(0..0, |it| it.place.clone());
        for (name, body) in std::mem::take(&mut self.actions) {
            self.action(&name, body, &end);
        }
    }
}
