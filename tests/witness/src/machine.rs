//! A program that runs: its memory, its scans, and its variables for comparison.

use crate::declarations::Declarations;
use crate::shared::Window;
use crate::storage::{Cell, Place};
use crate::types::Type;
use staunch_frontend::ast::{File, PouKind, VarKind};
use staunch_frontend::{Sources, Span};
use staunch_runtime::{Context, Fault, FaultKind, Value as Scalar};
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
/// Bytes of each area of the process image.
const IMAGE: usize = 1024;

#[derive(Debug)]
pub struct Machine<'a> {
    pub(crate) declared: Declarations<'a>,
    sources: &'a Sources,
    pub(crate) memory: Vec<Cell<'a>>,
    pub(crate) globals: HashMap<String, Place<'a>>,
    /// The bytes of each area of the process image: %I, %Q and %M.
    pub(crate) images: HashMap<char, usize>,
    /// VAR_STAT, by POU and name.
    pub(crate) statics: HashMap<(usize, String), Place<'a>>,
    /// The PROGRAM, and where its instance lies.
    main: usize,
    instance: Place<'a>,
    /// The PROGRAMs beside it, which it calls.
    programs: Vec<(usize, Place<'a>)>,
    pub(crate) context: Context,
    steps: u32,
    /// Where the ENO of the call leads whose arguments are evaluated.
    pub(crate) eno: Option<Place<'a>>,
}

/// The variables that a body can name, apart from the globals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame<'a> {
    pub names: HashMap<String, Place<'a>>,
    /// The instance whose routine this is, with the number of its own class.
    pub this: Option<(usize, Place<'a>)>,
    /// The class whose text runs: the instance's, or one above it.
    pub class: Option<usize>,
}

impl<'a> Machine<'a> {
    /// A program in its initial state.
    ///
    /// # Errors
    /// What the witness does not know.
    pub fn new(sources: &'a Sources, files: &'a [File<'a>]) -> Result<Self, Stop> {
        let mut declared = Declarations::new(files)?;
        let programs: Vec<_> =
            (0..declared.pous.len()).filter(|it| declared.pous[*it].kind == PouKind::Program).collect();
        let is_main = |it: &&usize| programs.len() == 1 || declared.pous[**it].name.eq_ignore_ascii_case("Main");
        let Some(&main) = programs.iter().find(is_main) else { return unknown("which PROGRAM runs") };
        let ty = declared.instance_of(main)?;
        let mut this = Self {
            declared,
            sources,
            memory: Vec::new(),
            globals: HashMap::new(),
            images: HashMap::new(),
            statics: HashMap::new(),
            main,
            instance: Place { at: 0, ty: ty.clone(), nowhere: None, declared: None, window: None },
            programs: Vec::new(),
            context: Context::default(),
            steps: 0,
            eno: None,
        };
        this.start_globals()?;
        this.start_programs(programs)?;
        this.instance = this.allocate(&ty);
        this.start(&Frame::default(), &this.instance.clone(), None)?;
        Ok(this)
    }

    /// The PROGRAMs that others call and read by their names.
    fn start_programs(&mut self, programs: Vec<usize>) -> Outcome<()> {
        for number in programs {
            if number != self.main {
                let ty = self.declared.instance_of(number)?;
                let place = self.allocate(&ty);
                self.start(&Frame::default(), &place, None)?;
                self.globals.insert(self.declared.pous[number].name.to_ascii_uppercase(), place.clone());
                self.programs.push((number, place));
            }
        }
        Ok(())
    }

    fn start_globals(&mut self) -> Outcome<()> {
        for area in ['I', 'Q', 'M'] {
            self.images.insert(area, self.memory.len());
            self.memory.push(Cell::Bytes(vec![0; IMAGE]));
        }
        let declared =
            self.declared.globals.iter().map(|it| (it.name.to_ascii_uppercase(), it.slot.clone(), it.address));
        for (name, slot, address) in declared.collect::<Vec<_>>() {
            let place = match address {
                Some((area, window)) => self.at_address(area, window, &slot.ty)?,
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

    /// What lies at a direct address.
    pub(crate) fn at_address(&self, area: char, window: Window, ty: &Type<'a>) -> Outcome<Place<'a>> {
        match (self.images.get(&area), ty.bytes()) {
            (Some(at), Some(bytes)) if window.bit / 8 + bytes <= IMAGE => {
                Ok(Place { at: *at, ty: ty.clone(), nowhere: None, declared: None, window: Some(window) })
            }
            _ => unknown("this address"),
        }
    }

    /// One scan. After an early end the variables stay as they were then.
    ///
    /// # Errors
    /// Why it ended early.
    pub fn scan(&mut self, context: &Context) -> Result<(), Stop> {
        self.context = context.clone();
        self.steps = 0;
        let size = self.memory.len();
        let end = self.run_instance(self.main, &self.instance.clone(), Vec::new());
        self.memory.truncate(size);
        end
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

    /// Path and value of each variable, as the executors' traces name them.
    pub fn variables(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        for it in &self.declared.globals {
            self.leaves(&format!("Globals.{}", it.name), &self.globals[&it.name.to_ascii_uppercase()], &mut found);
        }
        for (number, pou) in self.declared.pous.iter().enumerate() {
            for it in pou.variables.iter().filter(|it| it.kind == VarKind::Stat) {
                let place = &self.statics[&(number, it.name.to_ascii_uppercase())];
                let owner = pou.owner.map_or(String::new(), |it| format!("{}_", self.declared.pous[it].name));
                let name = format!("{owner}{}_{}", pou.name, it.name);
                // A global of this name makes the executors take another.
                if !self.globals.contains_key(&name.to_ascii_uppercase()) {
                    self.leaves(&format!("Globals.{name}"), place, &mut found);
                }
            }
        }
        for (number, place) in &self.programs {
            self.leaves(self.declared.pous[*number].name, place, &mut found);
        }
        self.leaves(self.declared.pous[self.main].name, &self.instance, &mut found);
        found
    }

    fn leaves(&self, path: &str, place: &Place<'a>, found: &mut Vec<(String, String)>) {
        match &place.ty {
            Type::Elementary(_) | Type::Subrange(..) | Type::Enum(_) | Type::Text(_) => {
                found.push((path.to_owned(), shown(&self.read(place).cells[0])));
            }
            Type::Array(array) => {
                for (number, at) in (array.low..=array.high).zip(0..) {
                    if let Some(element) = place.nth(at) {
                        self.leaves(&format!("{path}[{number}]"), &element, found);
                    }
                }
            }
            // The executors keep an array of the smallest of its parts.
            Type::Union(_) => {
                let (Some(unit), Some(bytes)) = (place.ty.smallest_part(), place.ty.bytes()) else { return };
                let start = Window { bit: 0, single: false };
                let size = usize::try_from(unit.repr().size()).unwrap_or(1);
                for number in 0..bytes.div_ceil(size) {
                    let part = place.further(start, number * size, &Type::Elementary(unit));
                    self.leaves(&format!("{path}.bytes[{number}]"), &part, found);
                }
            }
            Type::Record(record) => {
                for (number, (name, _)) in record.fields.iter().enumerate() {
                    if let Some(field) = place.field(number) {
                        self.leaves(&format!("{path}.{name}"), &field, found);
                    }
                }
            }
            // The executors' own numbers are not compared.
            Type::Reference(_) => {}
            Type::Block(info) => {
                for (number, pin) in info.pins.iter().enumerate() {
                    found.push((format!("{path}.{}", pin.name), shown(&self.memory[place.at + number])));
                }
            }
        }
    }
}

/// A value as its bits, but for a NaN: which one it is, processors decide.
fn shown(cell: &Cell<'_>) -> String {
    match cell {
        Cell::Scalar(Scalar::F32(it)) if it.is_nan() => "NaN".to_owned(),
        Cell::Scalar(Scalar::F64(it)) if it.is_nan() => "NaN".to_owned(),
        Cell::Scalar(it) => format!("{it:?}"),
        Cell::Reference(_) => "a reference".to_owned(),
        Cell::Bytes(it) => format!("{it:?}"),
        Cell::Text(bytes) => format!("{:?}", String::from_utf8_lossy(bytes)),
    }
}
