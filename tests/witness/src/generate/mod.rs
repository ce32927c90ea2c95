//! Random programs, the same for the same seed, that `check` accepts.
//!
//! They are made to meet what is hard: calls in every position, in-outs that overlap, counters that
//! callees write, indices that depend on what a call changes, and faults in the midst of it all.

mod call;
mod class;
mod expression;
mod scope;
mod start;
mod statement;
mod text;
mod types;

use crate::random::Random;
use call::{Parameter, Routine, Section};
use scope::{Scope, Variable};
use std::fmt::Write;
use types::{Catalogue, DATES, NUMBERS, Ty};

/// A program as Structured Text.
pub fn program(seed: u64) -> String {
    let mut writer = Writer::new(seed);
    writer.codesys = seed % 3 == 2;
    writer.types.codesys = writer.codesys;
    writer.refers = (seed / 3).is_multiple_of(2);
    if writer.codesys {
        writer.line("{dialect 'codesys'}");
    }
    writer.whole();
    writer.text
}

struct Writer {
    random: Random,
    /// Whether the program follows CODESYS's rules, else the standard's.
    codesys: bool,
    /// Whether the program has references. Without, nobody else can write what is a block's own.
    refers: bool,
    text: String,
    depth: usize,
    types: Catalogue,
    /// Functions and blocks that have been written: what comes later may call them.
    functions: Vec<Routine>,
    blocks: Vec<Routine>,
    /// Which of them can be copied.
    copied: Vec<bool>,
    /// Instances that functions copy, which Main calls.
    copies: Vec<Variable>,
    globals: Vec<Variable>,
    /// The methods and actions of the block that is being written.
    own: Routine,
    scope: Scope,
    /// Statements and calls that may still be written in this body.
    fuel: usize,
    /// Variables of the loops around: they are not assigned inside.
    counters: Vec<String>,
    /// The counters themselves, and whether they can be below 0.
    counting: Vec<(String, bool)>,
    loops: usize,
    whiles: usize,
    /// Labels that come after the statement, in its list or one around it.
    labels: Vec<String>,
    /// Nothing may leave the `__TRY` around.
    stays: bool,
    /// How the names of the block's own counters of WHILE begin.
    loop_prefix: String,
    /// Whether the block that is being written has a base.
    is_heir: bool,
    /// Whether inputs that are being declared may be edges.
    edges: bool,
    /// Whether what is being written calls what may lead to an heir.
    tainted: bool,
    /// What `SUPER^` has for the method that is being written.
    above: Vec<Routine>,
    interface_method: Option<Routine>,
}

impl Writer {
    fn new(seed: u64) -> Self {
        Self {
            random: Random::new(seed),
            codesys: false,
            refers: true,
            text: String::new(),
            depth: 0,
            types: Catalogue::default(),
            functions: Vec::new(),
            blocks: Vec::new(),
            copied: Vec::new(),
            copies: Vec::new(),
            globals: Vec::new(),
            own: Routine::new(String::new(), None, Vec::new()),
            scope: Scope::default(),
            fuel: 0,
            counters: Vec::new(),
            counting: Vec::new(),
            loops: 0,
            whiles: 0,
            labels: Vec::new(),
            stays: false,
            loop_prefix: String::new(),
            is_heir: false,
            edges: false,
            tainted: false,
            above: Vec::new(),
            interface_method: None,
        }
    }

    fn whole(&mut self) {
        self.declare_types();
        self.declare_globals();
        // Functions and blocks in turn: each calls those before it.
        for _ in 0..2 + self.random.below(2) {
            self.function();
        }
        for _ in 0..1 + self.random.below(3) {
            self.block_type();
            self.function();
        }
        self.declare_composites_of_blocks();
        let blocks = self.blocks.len();
        if self.codesys && self.random.once_in(2) {
            self.sub_program();
        }
        self.main(blocks);
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.text, "{:1$}{text}", "", self.depth * 4);
    }

    fn inside(&mut self, write: impl FnOnce(&mut Self)) {
        self.depth += 1;
        write(self);
        self.depth -= 1;
    }

    fn declare_types(&mut self) {
        self.line("TYPE");
        self.depth += 1;
        self.line("Color : (Red := 3, Green, Blue := 10);");
        for number in 0..2 {
            let base = *self.random.one_of(&[1, 1, 2, 4]);
            let low = *self.random.one_of(&[0, 0, 1, 2]);
            let high = low + 2 + i64::try_from(self.random.below(4)).unwrap_or(0);
            self.line(&format!("Level{number} : {}({low}..{high});", NUMBERS[base].name));
            self.types.levels.push((base, low, high));
        }
        for _ in 0..2 {
            self.declare_array(None);
        }
        for _ in 0..2 {
            self.declare_record(None);
        }
        self.declare_array(Some(Ty::Record(0)));
        if self.random.once_in(2) {
            self.declare_union();
        }
        self.depth -= 1;
        self.line("END_TYPE");
    }

    fn declare_array(&mut self, element: Option<Ty>) {
        let element = element.unwrap_or_else(|| self.plain_type());
        let count = if self.random.once_in(4) { 2 } else { 1 };
        let mut bounds = Vec::new();
        for _ in 0..count {
            let low = *self.random.one_of(&[0, 0, 1, -1]);
            bounds.push((low, low + 1 + i64::try_from(self.random.below(3)).unwrap_or(0)));
        }
        let shown: Vec<_> = bounds.iter().map(|(low, high)| format!("{low}..{high}")).collect();
        let name = self.types.name(&element);
        let number = self.types.arrays.len();
        self.line(&format!("List{number} : ARRAY[{}] OF {name};", shown.join(", ")));
        self.types.arrays.push((bounds, element));
    }

    fn declare_record(&mut self, extra: Option<Ty>) {
        let number = self.types.records.len();
        let mut fields: Vec<(String, Ty)> = extra.into_iter().map(|it| ("m".to_owned(), it)).collect();
        for at in 0..2 + self.random.below(3) {
            let ty = if self.random.once_in(5) { Ty::Array(0) } else { self.plain_type() };
            fields.push((format!("f{at}"), ty));
        }
        self.line(&format!("Rec{number} : STRUCT"));
        for (name, ty) in &fields {
            let initial = self.initial(ty);
            let ty = self.types.name(ty);
            self.line(&format!("    {name} : {ty}{initial};"));
        }
        self.line("END_STRUCT;");
        self.types.records.push(fields);
    }

    fn declare_union(&mut self) {
        let mut members = Vec::new();
        for at in 0..2 + self.random.below(3) {
            let ty = match self.random.below(6) {
                0 => Ty::Array(self.random.below(self.types.arrays.len())),
                1 => Ty::Record(self.random.below(self.types.records.len())),
                2 => Ty::Bits(self.random.below(4)),
                _ => self.plain_type(),
            };
            let ty = if self.types.is_shareable(&ty) { ty } else { Ty::Number(self.random.below(NUMBERS.len())) };
            members.push((format!("u{at}"), ty));
        }
        self.line("Uni0 : UNION");
        for (name, ty) in &members {
            self.line(&format!("    {name} : {};", self.types.name(ty)));
        }
        self.line("END_UNION;");
        self.types.unions.push(members);
    }

    /// Variables whose direct addresses overlap.
    fn declare_located(&mut self) {
        let area = *self.random.one_of(&["M", "Q"]);
        let mut taken: Vec<String> = Vec::new();
        for number in 0..3 + self.random.below(4) {
            let (size, ty) = match self.random.below(8) {
                0 | 1 => (0, Ty::Bool),
                2 => (1, Ty::Bits(0)),
                3 => (1, Ty::Number(*self.random.one_of(&[0, 4]))),
                4 => (2, Ty::Number(*self.random.one_of(&[1, 5]))),
                5 => (2, Ty::Bits(1)),
                6 => (4, Ty::Number(*self.random.one_of(&[2, 6]))),
                _ => (8, Ty::Bits(3)),
            };
            let at = match size {
                0 => format!("X{}.{}", self.random.below(8), self.random.below(8)),
                1 => format!("B{}", self.random.below(8)),
                2 => format!("W{}", self.random.below(4)),
                4 => format!("D{}", self.random.below(2)),
                _ => "L0".to_owned(),
            };
            // The same bits have the same type.
            if taken.contains(&at) {
                continue;
            }
            taken.push(at.clone());
            let name = format!("q{number}");
            let shown = self.types.name(&ty);
            self.line(&format!("    {name} AT %{area}{at} : {shown};"));
            self.globals.push(Variable { name, ty, writable: true, lasts: false, located: true });
        }
    }

    /// Arrays and structures that hold blocks: they are declared when the blocks are known.
    fn declare_composites_of_blocks(&mut self) {
        self.line("TYPE");
        self.depth += 1;
        let block = Ty::Instance(self.random.below(self.blocks.len()));
        self.declare_array(Some(block.clone()));
        self.declare_record(Some(block));
        let standard = self.standard_type();
        let holder = Ty::Record(self.types.records.len() - 1);
        let element = if self.random.once_in(2) { standard } else { holder };
        self.declare_array(Some(element));
        self.depth -= 1;
        self.line("END_TYPE");
    }

    fn declare_globals(&mut self) {
        self.line("VAR_GLOBAL");
        for number in 0..7 {
            let ty = match number {
                0 | 1 => Ty::Number(*self.random.one_of(&[0, 1, 2, 4])),
                2 => Ty::Array(self.random.below(self.types.arrays.len())),
                3 => Ty::Record(self.random.below(self.types.records.len())),
                _ => self.any_type(),
            };
            let variable = self.declare(&format!("g{number}"), ty);
            self.globals.push(Variable { lasts: true, ..variable });
        }
        for number in 0..2 * usize::from(self.refers) {
            let ty = self.pointer_type();
            let variable = self.declare(&format!("gp{number}"), ty);
            self.globals.push(variable);
        }
        if self.random.once_in(2) {
            self.declare_located();
        }
        self.line("END_VAR");
        self.line("VAR_GLOBAL CONSTANT");
        for (number, ty, value) in [(0, 2, "7"), (1, 1, "3"), (2, 8, "16777216.0"), (3, 0, "100")] {
            let name = format!("k{number}");
            self.line(&format!("    {name} : {} := {value};", NUMBERS[ty].name));
            self.globals.push(Variable { name, ty: Ty::Number(ty), writable: false, lasts: true, located: false });
        }
        self.line("END_VAR");
    }

    /// Writes a declaration with, perhaps, an initial value.
    fn declare(&mut self, name: &str, ty: Ty) -> Variable {
        let initial = self.initial(&ty);
        self.inside(|this| {
            let shown = this.types.name(&ty) + &this.construction(&ty);
            this.line(&format!("{name} : {shown}{initial};"));
        });
        Variable { name: name.to_owned(), ty, writable: true, lasts: false, located: false }
    }

    fn initial(&mut self, ty: &Ty) -> String {
        let scalar = matches!(
            ty,
            Ty::Bool
                | Ty::Number(_)
                | Ty::Bits(_)
                | Ty::Time
                | Ty::Date(_)
                | Ty::Text(_)
                | Ty::Wide(_)
                | Ty::Char(_)
                | Ty::Color
                | Ty::Level(_)
        );
        match ty {
            _ if self.random.once_in(2) => String::new(),
            _ if scalar => format!(" := {}", self.literal(ty)),
            Ty::Instance(at) if *at < self.types.blocks.len() => self.initial_inputs(*at),
            Ty::Array(at) => {
                let (bounds, element) = self.types.arrays[*at].clone();
                let scalar = matches!(element, Ty::Number(_) | Ty::Bits(_) | Ty::Text(_) | Ty::Wide(_) | Ty::Color);
                if bounds.len() > 1 || !scalar {
                    return String::new();
                }
                format!(" := [{}, {}]", self.literal(&element), self.literal(&element))
            }
            _ => String::new(),
        }
    }

    fn function(&mut self) {
        let number = self.functions.len();
        let name = format!("Fun{number}");
        let result = self.result_type();
        self.blank();
        self.tainted = false;
        let shown = self.types.name(&result);
        self.line(&format!("FUNCTION {name} : {shown}"));
        let parameters = self.parameters("", true);
        self.locals("VAR", "l", 2);
        if self.random.once_in(4) {
            self.locals("VAR_STAT", "s", 2);
        }
        // A function's result is a variable in its body.
        self.scope.add(Variable {
            name: name.clone(),
            ty: result.clone(),
            writable: true,
            lasts: false,
            located: false,
        });
        self.body(3);
        let value = self.expression(&result, 2);
        self.line(&format!("{name} := {value};"));
        self.line("END_FUNCTION");
        let tainted = self.tainted || parameters.iter().any(|it| matches!(it.ty, Ty::Instance(_)));
        self.functions.push(Routine { tainted, ..Routine::new(name, Some(result), parameters) });
    }

    /// An action, with the counters of its block.
    fn action(&mut self) {
        self.line("ACTION Act");
        self.statements(2);
        self.line("END_ACTION");
        self.restart_loops();
        self.own.actions.push("Act".to_owned());
    }

    /// A PROGRAM that Main calls by its name: for its body it is an existing instance.
    fn sub_program(&mut self) {
        self.blank();
        self.line("PROGRAM Sub");
        let mut parameters = self.new_parameters("", false);
        parameters.retain(|it| it.section != Section::InOut);
        self.declare_sections(&parameters, true);
        self.locals("VAR", "l", 3);
        self.loop_variables();
        self.statements(4);
        self.line("END_PROGRAM");
        let pins = parameters.iter().map(|it| (it.name.clone(), it.ty.clone(), it.section == Section::Input));
        self.types.blocks.push(pins.collect());
        self.types.properties.push(Vec::new());
        self.types.bases.push(None);
        self.blocks.push(Routine::new("Sub".to_owned(), None, parameters));
    }

    fn main(&mut self, blocks: usize) {
        self.blank();
        self.line("PROGRAM Main");
        self.line("VAR");
        self.inside(|this| {
            this.line("tick : DINT;");
        });
        self.scope.add(Variable {
            name: "tick".to_owned(),
            ty: Ty::Number(2),
            writable: false,
            lasts: true,
            located: false,
        });
        let (arrays, records) = (self.types.arrays.len(), self.types.records.len());
        for at in 0..12 {
            let ty = match at {
                0 => Ty::Instance(self.random.below(blocks)),
                1 => Ty::Array(arrays - 1),
                2 => Ty::Array(arrays - 2),
                3 => Ty::Record(records - 1),
                4 => Ty::Array(self.random.below(arrays)),
                5 => self.standard_type(),
                6 | 7 => Ty::Number(*self.random.one_of(&[0, 1, 2, 4])),
                _ => self.any_type(),
            };
            let variable = self.declare(&format!("v{at}"), ty);
            self.scope.add(Variable { lasts: true, ..variable });
        }
        for it in self.copies.clone() {
            self.scope.add(it);
        }
        if blocks < self.blocks.len() {
            let ty = Ty::Instance(blocks);
            self.scope.add(Variable { name: "Sub".to_owned(), ty, writable: true, lasts: false, located: false });
        }
        for at in 0..2 * usize::from(self.refers) {
            let to = self.scope.types(&self.types, |it| it.lasts && it.writable);
            let ty = Ty::Pointer(Box::new(self.random.one_of(&to).clone()));
            let variable = self.declare(&format!("p{at}"), ty);
            self.scope.add(variable);
        }
        if self.interface_method.is_some() {
            for name in ["it0", "it1"] {
                let variable = self.declare(name, Ty::Interface);
                self.scope.add(variable);
            }
        }
        self.line("END_VAR");
        if self.random.once_in(4) {
            self.locals("VAR_TEMP", "t", 1);
        }
        self.loop_variables();
        self.line("tick := tick + 1;");
        self.point_somewhere();
        self.statements(9);
        for it in self.copies.clone() {
            self.line(&format!("{}();", it.name));
        }
        if blocks < self.blocks.len() {
            self.line("Sub();");
        }
        self.line("END_PROGRAM");
    }

    /// A reference to what globals have.
    fn pointer_type(&mut self) -> Ty {
        let scope = Scope::new(&self.globals);
        let to = scope.types(&self.types, |it| it.lasts && it.writable);
        Ty::Pointer(Box::new(self.random.one_of(&to).clone()))
    }

    /// Gives most references something to lead to in the first scan.
    fn point_somewhere(&mut self) {
        self.line("IF tick = 1 THEN");
        for (name, to) in self.scope.pointers() {
            let address = self.address_of(&to, 1).filter(|_| !self.random.once_in(30));
            if let Some(address) = address {
                self.line(&format!("    {name} := {address};"));
            }
        }
        if self.interface_method.is_some() {
            for name in ["it0", "it1"] {
                let value = self.implementer(1);
                self.line(&format!("    {name} := {value};"));
            }
        }
        self.line("END_IF");
    }

    fn blank(&mut self) {
        self.text.push('\n');
        self.scope = Scope::new(&self.globals);
        self.restart_loops();
    }

    fn restart_loops(&mut self) {
        self.counters.clear();
        self.counting.clear();
        self.loops = 0;
        self.whiles = 0;
    }

    /// Writes new parameters, whose names begin with `prefix`. Those of a call exist until it ends.
    fn parameters(&mut self, prefix: &str, of_call: bool) -> Vec<Parameter> {
        let parameters = self.new_parameters(prefix, of_call);
        self.declare_sections(&parameters, true);
        parameters
    }

    fn new_parameters(&mut self, prefix: &str, of_call: bool) -> Vec<Parameter> {
        let mut parameters = Vec::new();
        for (section, most) in [(Section::Input, 3), (Section::Output, 2), (Section::InOut, 2)] {
            for at in 0..self.random.below(most + 1) {
                let name = format!("{prefix}{}{at}", section.letter());
                let ty = match section {
                    Section::Input if !of_call && self.random.once_in(4) => Ty::Bool,
                    Section::Input if of_call && self.refers && self.random.once_in(6) => self.pointer_type(),
                    Section::Input | Section::Output => self.any_type(),
                    Section::InOut => self.in_out_type(),
                };
                parameters.push(Parameter { name, ty, section });
            }
        }
        parameters
    }

    /// Parameters of a routine that may be overridden: without initial values, which are not inherited.
    fn declare_parameters(&mut self, parameters: &[Parameter]) {
        self.declare_sections(parameters, false);
    }

    fn declare_sections(&mut self, parameters: &[Parameter], with_initial: bool) {
        for section in [Section::Input, Section::Output, Section::InOut] {
            let own: Vec<_> = parameters.iter().filter(|it| it.section == section).collect();
            if own.is_empty() {
                continue;
            }
            self.line(section.keyword());
            for Parameter { name, ty, .. } in own {
                if self.edges && section == Section::Input && *ty == Ty::Bool && self.random.once_in(2) {
                    let edge = *self.random.one_of(&["R_EDGE", "F_EDGE"]);
                    self.inside(|this| this.line(&format!("{name} : BOOL {edge};")));
                } else if section == Section::InOut || !with_initial {
                    let shown = self.types.name(ty);
                    self.inside(|this| this.line(&format!("{name} : {shown};")));
                } else {
                    self.declare(name, ty.clone());
                }
                let writable = section != Section::Input;
                self.scope.add(Variable { name: name.clone(), ty: ty.clone(), writable, lasts: false, located: false });
            }
            self.line("END_VAR");
        }
    }

    fn locals(&mut self, keyword: &str, letter: &str, count: usize) {
        self.line(keyword);
        for at in 0..count {
            let ty = if at == 0 { Ty::Number(*self.random.one_of(&[0, 1, 2, 4])) } else { self.any_type() };
            let variable = self.declare(&format!("{letter}{at}"), ty);
            self.scope.add(variable);
        }
        self.line("END_VAR");
    }

    /// Counters of WHILE and REPEAT, which nothing else assigns.
    fn loop_variables(&mut self) {
        self.line("VAR");
        let of = |number: usize| format!("{}w{number}", self.loop_prefix);
        self.line(&format!("    {}, {}, {}, {} : INT;", of(0), of(1), of(2), of(3)));
        self.line("END_VAR");
    }

    fn body(&mut self, statements: usize) {
        self.loop_variables();
        self.statements(statements);
    }

    /// Elementary types and their like.
    fn plain_type(&mut self) -> Ty {
        match self.random.below(22) {
            18 | 19 => Ty::Wide(*self.random.one_of(&[3, 5, 8])),
            20 if !self.codesys => Ty::Char(false),
            21 if !self.codesys => Ty::Char(true),
            16 | 17 | 20 | 21 => Ty::Date(self.random.below(DATES.len())),
            0..=6 => Ty::Number(self.random.below(NUMBERS.len())),
            7 | 8 => Ty::Number(*self.random.one_of(&[1, 2])),
            9 | 10 => Ty::Bool,
            11 => Ty::Bits(self.random.below(4)),
            12 => Ty::Time,
            13 => Ty::Text(*self.random.one_of(&[3, 5, 8])),
            14 => Ty::Color,
            _ => Ty::Level(self.random.below(self.types.levels.len())),
        }
    }

    /// What can be copied.
    fn any_type(&mut self) -> Ty {
        match self.random.below(8) {
            0 if !self.types.arrays.is_empty() => Ty::Array(self.random.below(3)),
            1 if !self.types.records.is_empty() => Ty::Record(self.random.below(2)),
            2 if !self.types.unions.is_empty() => Ty::Union(0),
            _ => self.plain_type(),
        }
    }

    /// Of what globals and locals have, so that there is something to give.
    fn in_out_type(&mut self) -> Ty {
        match self.random.below(6) {
            0 if !self.blocks.is_empty() => Ty::Instance(self.random.below(self.blocks.len())),
            0 | 1 => Ty::Array(self.random.below(3)),
            2 => Ty::Record(self.random.below(2)),
            _ => {
                let at = self.random.below(self.globals.len());
                let at = if self.globals[at].writable { at } else { 0 };
                let types = self.types.shapes(&self.globals[at].ty);
                let types: Vec<_> = types.into_iter().map(|it| it.ty).collect();
                self.random.one_of(&types).clone()
            }
        }
    }

    fn result_type(&mut self) -> Ty {
        match self.random.below(10) {
            0..=4 => Ty::Number(*self.random.one_of(&[0, 1, 1, 2, 2, 4, 8])),
            5 | 6 => Ty::Bool,
            7 => self.any_type(),
            _ => self.plain_type(),
        }
    }
}
