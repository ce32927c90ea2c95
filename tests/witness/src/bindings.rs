//! VAR_CONFIG: variables of single instances that get the value at an address before each run of their PROGRAM, and give
//! it back after it, and such that start with a value of their own.

use crate::addresses::Address;
use crate::machine::{Frame, Machine, Outcome, unknown};
use crate::runs::configurations;
use crate::storage::Place;
use staunch_frontend::ast::{self, Expr, ExprKind, File};

/// A variable, and the address that it is bound to.
#[derive(Clone, Debug)]
pub(crate) struct Binding<'a> {
    place: Place<'a>,
    image: Place<'a>,
    is_input: bool,
}

impl<'a> Machine<'a> {
    pub(crate) fn start_bindings(&mut self, files: &'a [File<'a>]) -> Outcome<()> {
        let inside = configurations(files).flat_map(|it| &it.bindings);
        let of_resources = configurations(files).flat_map(|it| &it.resources).flat_map(|it| &it.bindings);
        for binding in inside.chain(of_resources).chain(files.iter().flat_map(|it| &it.bindings)) {
            self.start_binding(binding)?;
        }
        Ok(())
    }

    fn start_binding(&mut self, binding: &'a ast::Binding<'a>) -> Outcome<()> {
        let place = self.bound(&binding.target)?;
        let initial = binding.located.initial.as_ref();
        let Some(name) = binding.located.address else { return self.start(&Frame::default(), &place, initial) };
        let address = Address::read(name.text, self.declared.family)?;
        let image = self.at_address(&address, &place.ty)?;
        match initial {
            Some(_) => self.start(&Frame::default(), &image, initial)?,
            // The address starts as the variable does.
            None => self.write(&image, &self.read(&place)),
        }
        self.bindings.push(Binding { place, image, is_input: address.is_input() });
        Ok(())
    }

    /// `run.valves[2].open`, perhaps after the name of its RESOURCE; where nothing lists PROGRAMs, by its PROGRAM.
    fn bound(&mut self, target: &'a Expr<'a>) -> Outcome<Place<'a>> {
        let run =
            |name: &str| self.runs.iter().find(|it| it.name.eq_ignore_ascii_case(name)).map(|it| it.place.clone());
        match &target.kind {
            ExprKind::Name(name) => run(name.text).map_or_else(|| unknown("the run of a VAR_CONFIG"), Ok),
            ExprKind::Member(base, name) => {
                if let ExprKind::Name(resource) = &base.kind
                    && run(resource.text).is_none()
                {
                    return run(name.text).map_or_else(|| unknown("the run of a VAR_CONFIG"), Ok);
                }
                let base = self.bound(base)?;
                self.member(&base, name.text).map_or_else(|| unknown("this variable of a VAR_CONFIG"), Ok)
            }
            ExprKind::Index(base, indices) => {
                let mut place = self.bound(base)?;
                for index in indices {
                    place = self.element(&Frame::default(), &place, index)?;
                }
                Ok(place)
            }
            _ => unknown("this variable of a VAR_CONFIG"),
        }
    }

    pub(crate) fn take_bound(&mut self, instance: &Place<'a>) {
        for binding in self.bindings_of(instance) {
            self.write(&binding.place, &self.read(&binding.image));
        }
    }

    pub(crate) fn give_bound(&mut self, instance: &Place<'a>) {
        for binding in self.bindings_of(instance).into_iter().filter(|it| !it.is_input) {
            self.write(&binding.image, &self.read(&binding.place));
        }
    }

    fn bindings_of(&self, instance: &Place<'a>) -> Vec<Binding<'a>> {
        let range = instance.at..instance.at + instance.ty.size();
        self.bindings.iter().filter(|it| range.contains(&it.place.at)).cloned().collect()
    }
}
