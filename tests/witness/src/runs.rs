//! The PROGRAMs that run: their instances, what their runs are connected with, and when a TASK lets them run.

use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::storage::Place;
use crate::types::{Elementary, Type};
use staunch_frontend::ast::{Argument, Configuration, Expr, File, Item, PouKind, Resource};

/// An instance of a PROGRAM.
#[derive(Clone, Debug)]
pub(crate) struct Run<'a> {
    pub name: &'a str,
    pou: usize,
    pub place: Place<'a>,
    /// What a CONFIGURATION connects it with.
    connections: &'a [Argument<'a>],
    task: Task<'a>,
    /// Whether it has run since the start.
    has_run: bool,
    /// Whether it runs by itself, and not only where others call it.
    pub runs: bool,
}

/// What decides whether a run that is due happens: SINGLE, and the INTERVAL with it.
#[derive(Clone, Copy, Debug, Default)]
struct Task<'a> {
    single: Option<&'a Expr<'a>>,
    interval: Option<&'a Expr<'a>>,
    was_single: bool,
    /// When it falls due next.
    next: i128,
}

/// A run that a CONFIGURATION lists.
struct Listed<'a> {
    name: &'a str,
    pou: usize,
    connections: &'a [Argument<'a>],
    task: Task<'a>,
    runs: bool,
}

impl<'a> Machine<'a> {
    /// The instances of the CONFIGURATION, and each PROGRAM that it does not list under its own name.
    pub(crate) fn start_runs(&mut self, files: &'a [File<'a>], running: &[&str]) -> Outcome<()> {
        let mut listed = Vec::new();
        for resource in configurations(files).flat_map(|it| &it.resources) {
            listed.append(&mut self.listed(resource)?);
        }
        for pou in 0..self.declared.pous.len() {
            if self.declared.pous[pou].kind == PouKind::Program && !listed.iter().any(|it| it.pou == pou) {
                let (name, connections) = (self.declared.pous[pou].name, &[] as &[_]);
                let runs = running.iter().any(|it| it.eq_ignore_ascii_case(name));
                if !runs && !listed.is_empty() {
                    return unknown("whether anything calls a PROGRAM that is not listed");
                }
                let place = self.start_run(Listed { name, pou, connections, task: Task::default(), runs })?;
                self.globals.insert(self.declared.pous[pou].key.clone(), place);
            }
        }
        listed.into_iter().try_for_each(|it| self.start_run(it).map(drop))
    }

    fn listed(&self, resource: &'a Resource<'a>) -> Outcome<Vec<Listed<'a>>> {
        let listed = resource.programs.iter().map(|it| {
            let path: Vec<_> = it.namespace.iter().chain([&it.program]).copied().collect();
            let Some(pou) = self.declared.pou_named(&path) else { return unknown("the PROGRAM of a run") };
            let task =
                it.task.and_then(|name| resource.tasks.iter().find(|it| it.name.text.eq_ignore_ascii_case(name.text)));
            let property = |name: &str| {
                let mut properties = task.map_or(&[][..], |it| &it.properties).iter();
                properties.find(|it| it.0.text.eq_ignore_ascii_case(name)).map(|it| &it.1)
            };
            let task = Task { single: property("SINGLE"), interval: property("INTERVAL"), was_single: false, next: 0 };
            Ok(Listed { name: it.name.text, pou, connections: &it.connections, task, runs: true })
        });
        listed.collect()
    }

    fn start_run(&mut self, Listed { name, pou, connections, task, runs }: Listed<'a>) -> Outcome<Place<'a>> {
        let ty = self.declared.instance_of(pou)?;
        let place = self.allocate(&ty);
        self.start(&Frame::default(), &place, None)?;
        self.runs.push(Run { name, pou, place: place.clone(), connections, task, has_run: false, runs });
        Ok(place)
    }

    /// One run of an instance. Its connections are given as arguments of a call are.
    pub(crate) fn run(&mut self, name: &str) -> Outcome<()> {
        let Some(at) = self.runs.iter().position(|it| it.name.eq_ignore_ascii_case(name)) else {
            return unknown("this run");
        };
        if !self.is_due(at)? {
            return Ok(());
        }
        // `{attribute 'startup'}`: once after each start.
        let has_run = std::mem::replace(&mut self.runs[at].has_run, true);
        if has_run && self.declared.pous[self.runs[at].pou].starts_up {
            return Ok(());
        }
        let Run { pou, place, connections, .. } = self.runs[at].clone();
        let passed = self.arguments_of(pou, connections)?;
        self.run_instance(pou, &place, passed)
    }

    /// With SINGLE it runs where that rises, and while it is FALSE at each multiple of the INTERVAL; what falls due while it
    /// is TRUE is left out.
    fn is_due(&mut self, run: usize) -> Outcome<bool> {
        let Task { single, interval, was_single, next } = self.runs[run].task;
        let Some(single) = single else { return Ok(true) };
        let now = i128::from(self.context.now());
        let single = self.value_as(&Frame::default(), single, &Type::BOOL)?.as_bool()?;
        self.runs[run].task.was_single = single;
        let fell_due = match interval {
            Some(interval) if now >= next => {
                let time = Type::Elementary(Elementary::Time);
                let interval = self.value_as(&Frame::default(), interval, &time)?.as_integer()?;
                self.runs[run].task.next = now - now % interval + interval;
                true
            }
            Some(_) | None => false,
        };
        Ok(if single { !was_single } else { fell_due })
    }
}

/// The CONFIGURATIONs of the files.
pub(crate) fn configurations<'a>(files: &'a [File<'a>]) -> impl Iterator<Item = &'a Configuration<'a>> {
    files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        Item::Configuration(it) => Some(it),
        Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Test(_) => None,
    })
}
