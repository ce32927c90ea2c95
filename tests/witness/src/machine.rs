//! A program that runs: its memory and its scans.

use crate::bindings::Binding;
use crate::declarations::Declarations;
use crate::pools::Berth;
use crate::runs::Run;
use crate::starts::Assigns;
use crate::storage::{Cell, Place};
use crate::types::Type;
use staunch_frontend::ast::{File, VarKind};
use staunch_frontend::{Sources, Span};
use staunch_runtime::{Context, Family, Fault, FaultKind};
use std::collections::HashMap;

/// Why a scan ended early.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// What the program did wrong, and where.
    Fault(Fault),
    /// More statements than a test program may take.
    Endless,
    /// The witness does not know a construct.
    Unknown(String),
}

pub(crate) type Outcome<T> = Result<T, Stop>;

pub(crate) fn unknown<T>(what: &str) -> Outcome<T> {
    Err(Stop::Unknown(what.to_owned()))
}

/// Statements and turns of loops that a scan may take.
const STEPS: u32 = 20_000;

#[derive(Debug)]
pub struct Machine<'a> {
    pub(crate) declared: Declarations<'a>,
    sources: &'a Sources,
    pub(crate) memory: Vec<Cell<'a>>,
    pub(crate) globals: HashMap<String, Place<'a>>,
    /// The bytes of each area of the process image.
    pub(crate) images: HashMap<String, usize>,
    /// VAR_STAT, by POU and name.
    pub(crate) statics: HashMap<(usize, String), Place<'a>>,
    pub(crate) runs: Vec<Run<'a>>,
    pub(crate) bindings: Vec<Binding<'a>>,
    pub(crate) pool: Vec<Berth<'a>>,
    /// What initial values assign now.
    pub(crate) assigns: Assigns,
    /// Whether instances have started.
    pub(crate) has_started: bool,
    /// Whether this is a start after the first: what is RETAIN has been kept.
    pub(crate) is_again: bool,
    pub(crate) context: Context,
    steps: u32,
    /// The exception that was raised last.
    pub(crate) raised: u32,
    /// How many calls of METHODs and ACTIONs have not ended.
    pub(crate) nested: u32,
    /// Where the ENO of the call leads whose arguments are evaluated.
    pub(crate) eno: Option<Place<'a>>,
}

/// The variables that a body can name, without the globals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame<'a> {
    pub names: HashMap<String, Place<'a>>,
    /// The instance whose routine this is, with the number of its own class.
    pub this: Option<(usize, Place<'a>)>,
    /// The class whose text runs: the instance's, or one above it.
    pub class: Option<usize>,
}

impl<'a> Machine<'a> {
    /// A program in its initial state. Files that name no dialect are of this family. Of PROGRAMs that no CONFIGURATION lists
    /// those that are `running` do so by themselves, and others are called.
    ///
    /// # Errors
    /// What the witness does not know.
    pub fn new(sources: &'a Sources, files: &'a [File<'a>], family: Family, running: &[&str]) -> Result<Self, Stop> {
        let mut this = Self {
            declared: Declarations::new(files, family)?,
            sources,
            memory: Vec::new(),
            globals: HashMap::new(),
            images: HashMap::new(),
            statics: HashMap::new(),
            runs: Vec::new(),
            bindings: Vec::new(),
            assigns: Assigns::VALUES,
            pool: Vec::new(),
            has_started: false,
            is_again: false,
            context: Context::default(),
            steps: 0,
            raised: 0,
            nested: 0,
            eno: None,
        };
        this.start_images();
        this.start_globals()?;
        this.start_addresses()?;
        this.start_pools()?;
        this.start_runs(files, running)?;
        this.start_bindings(files)?;
        this.assigns = Assigns::ALL;
        Ok(this)
    }

    fn start_globals(&mut self) -> Outcome<()> {
        let declared = self.declared.globals.iter().map(|it| (it.key.clone(), it.slot.clone(), it.address.clone()));
        for (name, slot, address) in declared.collect::<Vec<_>>() {
            let place = match address {
                Some(address) => self.at_address(&address, &slot.ty)?,
                None => self.allocate(&slot.ty),
            };
            self.start(&Frame::default(), &place, slot.initial)?;
            self.globals.insert(name, place);
        }
        for number in 0..self.declared.pous.len() {
            let variables = self.declared.pous[number].variables.iter().filter(|it| it.kind == VarKind::Stat);
            let variables: Vec<_> = variables.map(|it| (it.name.to_ascii_uppercase(), it.slot.clone())).collect();
            for (name, slot) in variables {
                let place = self.allocate(&slot.ty);
                self.start(&Frame::default(), &place, slot.initial)?;
                self.statics.insert((number, name), place);
            }
        }
        Ok(())
    }

    /// One scan of an instance of a PROGRAM. After an early end the variables stay as they were then.
    ///
    /// # Errors
    /// Why it ended early.
    pub fn scan(&mut self, instance: &str, context: &Context) -> Result<(), Stop> {
        self.context = context.clone();
        self.steps = 0;
        let size = self.memory.len();
        let end = self.start_and_run(instance);
        self.memory.truncate(size);
        end
    }

    fn start_and_run(&mut self, instance: &str) -> Outcome<()> {
        if !self.has_started {
            self.start_instances()?;
            self.has_started = true;
        }
        self.run(instance)
    }

    /// A start after the first.
    pub fn starts_again(&mut self) {
        self.is_again = true;
    }

    /// Counts a statement, or a turn of a loop.
    pub(crate) fn step(&mut self) -> Outcome<()> {
        self.steps += 1;
        if self.steps > STEPS { Err(Stop::Endless) } else { Ok(()) }
    }

    pub(crate) fn fault(&self, kind: FaultKind, at: Span) -> Stop {
        Stop::Fault(Fault { kind, at: self.sources.location(at) })
    }

    /// The names of an instance's own variables.
    pub(crate) fn instance_frame(&self, instance: &Place<'a>) -> Frame<'a> {
        match &instance.ty {
            Type::Record(record) => record.pou.map_or_else(Frame::default, |it| self.frame_of(instance, it)),
            _ => Frame::default(),
        }
    }

    /// The names that the text of a class has in an instance of it or of an heir, whose own come after them.
    pub(crate) fn frame_of(&self, instance: &Place<'a>, class: usize) -> Frame<'a> {
        let mut frame = Frame::default();
        let Type::Record(record) = &instance.ty else { return frame };
        frame.this = record.pou.map(|it| (it, instance.clone()));
        frame.class = Some(class);
        let mut offset = 0;
        for (name, slot) in record.fields.iter().take(self.declared.pous[class].fields) {
            frame.names.insert(name.to_ascii_uppercase(), instance.part(offset, &slot.ty));
            offset += slot.ty.size();
        }
        frame
    }
}
