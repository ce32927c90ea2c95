//! The PROGRAMs that run: their instances, and what their runs are connected with.

use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::storage::Place;
use staunch_frontend::ast::{Argument, Configuration, File, Item, PouKind};

/// An instance of a PROGRAM.
#[derive(Clone, Debug)]
pub(crate) struct Run<'a> {
    pub name: &'a str,
    pou: usize,
    pub place: Place<'a>,
    /// What a CONFIGURATION connects it with.
    connections: &'a [Argument<'a>],
    /// Whether it has run by itself, and not only where others call it.
    pub runs: bool,
}

impl<'a> Machine<'a> {
    /// The instances of the CONFIGURATION, and each PROGRAM that it does not list under its own name.
    pub(crate) fn start_runs(&mut self, files: &'a [File<'a>]) -> Outcome<()> {
        let none: &'a [Argument<'a>] = &[];
        let listed: Vec<_> = configurations(files)
            .flat_map(|it| &it.resources)
            .flat_map(|it| &it.programs)
            .map(|it| (it.name.text, it.program.text, it.connections.as_slice()))
            .collect();
        let is_listed = |name: &str| listed.iter().any(|it| it.1.eq_ignore_ascii_case(name));
        let programs = self.declared.pous.iter().filter(|it| it.kind == PouKind::Program);
        let alone: Vec<_> = programs.map(|it| it.name).filter(|it| !is_listed(it)).collect();
        for name in alone {
            self.start_run(name, name, none, true)?;
        }
        for (name, program, connections) in listed {
            self.start_run(name, program, connections, false)?;
        }
        Ok(())
    }

    fn start_run(
        &mut self,
        name: &'a str,
        program: &str,
        connections: &'a [Argument<'a>],
        by_name: bool,
    ) -> Outcome<()> {
        let Some(pou) = self.declared.pou_named(program) else { return unknown("the PROGRAM of a run") };
        let ty = self.declared.instance_of(pou)?;
        let place = self.allocate(&ty);
        self.start(&Frame::default(), &place, None)?;
        if by_name {
            self.globals.insert(name.to_ascii_uppercase(), place.clone());
        }
        self.runs.push(Run { name, pou, place, connections, runs: false });
        Ok(())
    }

    /// One run of an instance. Its connections are given as arguments of a call are.
    pub(crate) fn run(&mut self, name: &str) -> Outcome<()> {
        let run = self.runs.iter_mut().find(|it| it.name.eq_ignore_ascii_case(name));
        let Some(run) = run else { return unknown("this run") };
        run.runs = true;
        let Run { pou, place, connections, .. } = run.clone();
        let passed = self.arguments_of(pou, connections)?;
        self.run_instance(pou, &place, passed)
    }
}

/// The CONFIGURATIONs of the files.
pub(crate) fn configurations<'a>(files: &'a [File<'a>]) -> impl Iterator<Item = &'a Configuration<'a>> {
    files.iter().flat_map(|it| &it.items).filter_map(|it| match it {
        Item::Configuration(it) => Some(it),
        Item::Pou(_) | Item::Types(_) | Item::Globals(_) | Item::Test(_) => None,
    })
}
