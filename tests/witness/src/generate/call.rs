//! Calls: arguments by name, by position and mixed, in any order.

use super::Writer;
use super::scope::Variable;
use super::types::{Ty, pins, standard_blocks};

#[derive(Clone, Debug)]
pub struct Routine {
    pub name: String,
    pub result: Option<Ty>,
    pub parameters: Vec<Parameter>,
    /// Of a block.
    pub methods: Vec<Routine>,
    /// The names of a block's actions.
    pub actions: Vec<String>,
    pub properties: Vec<(String, Ty)>,
    /// How many blocks a block has above it.
    pub level: usize,
    /// What instances of a block keep.
    pub state: Vec<Variable>,
    /// Whether a call may lead to an heir of what an in-out is declared with.
    pub tainted: bool,
    /// What a block's FB_init is given, if it has one.
    pub init: Option<Vec<Parameter>>,
    /// Whether a block has a METHOD with `call_after_init`.
    pub is_after_init: bool,
}

impl Routine {
    pub fn new(name: String, result: Option<Ty>, parameters: Vec<Parameter>) -> Self {
        let (methods, actions, properties, state) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self {
            name,
            result,
            parameters,
            methods,
            actions,
            properties,
            level: 0,
            state,
            tainted: false,
            init: None,
            is_after_init: false,
        }
    }
}

#[derive(Clone, Debug)]
pub struct Parameter {
    pub name: String,
    pub ty: Ty,
    pub section: Section,
}

impl Parameter {
    /// The variable of a body that it is; inputs are not assigned.
    pub fn variable(&self) -> Variable {
        let writable = self.section != Section::Input;
        Variable { name: self.name.clone(), ty: self.ty.clone(), writable, lasts: false, located: false }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    Input,
    Output,
    InOut,
}

impl Section {
    pub fn letter(self) -> &'static str {
        match self {
            Self::Input => "i",
            Self::Output => "o",
            Self::InOut => "io",
        }
    }

    pub fn keyword(self) -> &'static str {
        match self {
            Self::Input => "VAR_INPUT",
            Self::Output => "VAR_OUTPUT",
            Self::InOut => "VAR_IN_OUT",
        }
    }
}

impl Writer {
    pub(super) fn standard_type(&mut self) -> Ty {
        Ty::Standard(*self.random.one_of(&standard_blocks()))
    }

    /// A call of a function whose result fits.
    pub(super) fn function_call(&mut self, depth: usize, fits: impl Fn(&Ty) -> bool) -> Option<String> {
        if self.fuel == 0 {
            return None;
        }
        let is_heir = self.is_heir;
        let fitting = |list: &[Routine]| -> Vec<Routine> {
            let callable = |it: &&Routine| !(is_heir && it.tainted);
            list.iter().filter(callable).filter(|it| it.result.as_ref().is_some_and(&fits)).cloned().collect()
        };
        let (functions, own) = (fitting(&self.functions), fitting(&self.own.methods));
        let of_interface: Vec<_> =
            self.interface_method.clone().into_iter().filter(|it| it.result.as_ref().is_some_and(&fits)).collect();
        if !of_interface.is_empty()
            && self.random.once_in(2)
            && let Some((place, _)) = self.some_place(false, depth.saturating_sub(1), |_, it| *it == Ty::Interface)
        {
            return self.routine_call(&format!("{place}."), &of_interface, depth);
        }
        let above = fitting(&self.above);
        if !above.is_empty() && self.random.once_in(2) {
            return self.routine_call("SUPER^.", &above, depth);
        }
        let of_others = self.blocks.iter().any(|it| !fitting(&it.methods).is_empty());
        if of_others
            && self.random.once_in(3)
            && let Some((place, Ty::Instance(at))) = self.some_place(true, depth.saturating_sub(1), |this, it| {
                matches!(it, Ty::Instance(at) if this.may_call(*at) && this.blocks.get(*at).is_some_and(|it| !fitting(&it.methods).is_empty()))
            })
        {
            let methods = fitting(&self.blocks[at].methods);
            self.tainted |= self.blocks[at].tainted;
            return self.routine_call(&format!("{place}."), &methods, depth);
        }
        if !own.is_empty() && (functions.is_empty() || self.random.once_in(2)) {
            let this = *self.random.one_of(&["", "", "THIS^."]);
            return self.routine_call(this, &own, depth);
        }
        self.routine_call("", &functions, depth)
    }

    fn routine_call(&mut self, before: &str, routines: &[Routine], depth: usize) -> Option<String> {
        if routines.is_empty() || self.fuel == 0 {
            return None;
        }
        self.fuel -= 1;
        let routine = self.random.one_of(routines).clone();
        self.tainted |= routine.tainted;
        let arguments = self.arguments(&routine.parameters, depth, true)?;
        // What a path leads to is not looked for where EN is FALSE.
        if !before.is_empty() && arguments.contains("EN := ") {
            return None;
        }
        Some(format!("{before}{}({arguments})", routine.name))
    }

    /// A call of an action of the block that is being written.
    pub(super) fn own_action(&mut self) -> Option<String> {
        let actions = self.own.actions.clone();
        (!actions.is_empty()).then(|| format!("{}()", self.random.one_of(&actions)))
    }

    /// A call of an instance, as a statement.
    pub(super) fn block_call(&mut self) -> Option<String> {
        let (place, ty) = self.some_place(true, 2, |this, it| match it {
            Ty::Instance(at) => this.may_call(*at),
            _ => matches!(it, Ty::Standard(_)),
        })?;
        if let Ty::Instance(at) = ty {
            self.tainted |= self.blocks[at].tainted;
        }
        let parameters = match &ty {
            // A block that is being written cannot hold or be given itself.
            Ty::Instance(at) => self.blocks.get(*at)?.parameters.clone(),
            Ty::Standard(at) if pins(*at).is_empty() => return Some(self.instruction(&place)),
            Ty::Standard(at) => pins(*at)
                .into_iter()
                .map(|(name, ty, is_input)| Parameter {
                    name,
                    ty,
                    section: if is_input { Section::Input } else { Section::Output },
                })
                .collect(),
            _ => return None,
        };
        let actions = match ty {
            Ty::Instance(at) => self.blocks[at].actions.clone(),
            _ => Vec::new(),
        };
        if !actions.is_empty() && self.random.once_in(3) {
            // By name: an heir's action has more inputs than that of the declared block.
            let arguments = self.named_arguments(&parameters)?;
            return Some(format!("{place}.{}({arguments})", self.random.one_of(&actions)));
        }
        let arguments = self.arguments(&parameters, 2, false)?;
        Some(format!("{place}({arguments})"))
    }

    /// An instruction of Logix on a tag.
    pub(super) fn instruction(&mut self, tag: &str) -> String {
        let name = *self.random.one_of(&["CTU", "CTU", "CTD", "RES"]);
        format!("LOGIX.{name}(Counter := {tag}, RungIn := {})", self.expression(&Ty::Bool, 1))
    }

    fn named_arguments(&mut self, parameters: &[Parameter]) -> Option<String> {
        self.arguments_after(0, parameters, 2, false)
    }

    /// `None` where there is nothing to give to an in-out.
    fn arguments(&mut self, parameters: &[Parameter], depth: usize, of_function: bool) -> Option<String> {
        let positional = if self.random.once_in(2) { self.random.below(parameters.len() + 1) } else { 0 };
        self.arguments_after(positional, parameters, depth, of_function)
    }

    /// So many come first and without names; the others follow in any order.
    fn arguments_after(
        &mut self,
        positional: usize,
        parameters: &[Parameter],
        depth: usize,
        of_function: bool,
    ) -> Option<String> {
        let depth = depth.saturating_sub(1);
        let mut order: Vec<&Parameter> = parameters.iter().collect();
        if self.codesys {
            order.sort_by_key(|it| it.section == Section::Output);
        }
        let mut named: Vec<&Parameter> = order.split_off(positional);
        self.shuffle(&mut named);
        let mut arguments = Vec::new();
        for parameter in order {
            arguments.push(self.argument(parameter, depth)?.1);
        }
        for parameter in named {
            // A call without names gives all inputs.
            let has_names = positional == 0 || arguments.len() > positional;
            let left_out = match parameter.section {
                // A FUNCTION of CODESYS is given all inputs.
                Section::Input if matches!(parameter.ty, Ty::Pointer(_)) => false,
                Section::Input if of_function && self.codesys => false,
                Section::Input => has_names && self.random.once_in(if of_function { 6 } else { 3 }),
                Section::Output => self.random.once_in(3),
                Section::InOut => false,
            };
            if left_out {
                continue;
            }
            let (negated, value) = self.argument(parameter, depth)?;
            let name = &parameter.name;
            arguments.push(match parameter.section {
                Section::Output if negated => format!("NOT {name} => {value}"),
                Section::Output => format!("{name} => {value}"),
                Section::Input | Section::InOut => format!("{name} := {value}"),
            });
        }
        if self.random.once_in(12) {
            let en = format!("EN := {}", self.expression(&Ty::Bool, depth));
            arguments.insert(positional + self.random.below(arguments.len() - positional + 1), en);
        }
        if self.random.once_in(12)
            && let Some(place) = self.place_of(&Ty::Bool, true, depth)
        {
            arguments
                .insert(positional + self.random.below(arguments.len() - positional + 1), format!("ENO => {place}"));
        }
        Some(arguments.join(", "))
    }

    /// Whether an output is negated, and the argument.
    fn argument(&mut self, parameter: &Parameter, depth: usize) -> Option<(bool, String)> {
        let ty = &parameter.ty;
        match parameter.section {
            Section::Input => match ty {
                Ty::Array(_) | Ty::Record(_) | Ty::Union(_) => Some((false, self.place_of(ty, false, depth)?)),
                _ => Some((false, self.expression(ty, depth))),
            },
            Section::InOut => {
                let place = match ty {
                    Ty::Text(_) | Ty::Wide(_) if self.random.once_in(3) => {
                        let wide = ty.is_text(true);
                        self.in_out_place(depth, |_, it| it.is_text(wide))
                    }
                    Ty::Instance(base) => {
                        let fits =
                            |this: &Self, it: &Ty| matches!(it, Ty::Instance(at) if this.types.is_heir(*at, *base));
                        // A reference to nothing would end most programs early.
                        if self.random.once_in(8) {
                            self.in_out_place(depth, fits)
                        } else {
                            self.direct_place(depth, fits).map(|it| it.0)
                        }
                    }
                    _ => self.in_out_place(depth, |_, it| it == ty),
                };
                Some((false, place?))
            }
            Section::Output => {
                let negated = *ty == Ty::Bool && self.random.once_in(4);
                let from = ty.elementary();
                let place = self.some_place(true, depth, |this, it| {
                    it == ty
                        || (this.widens(from, it) && !negated)
                        || [false, true].into_iter().any(|wide| ty.is_text(wide) && it.is_text(wide))
                });
                Some((negated, place?.0))
            }
        }
    }

    fn widens(&self, from: Option<crate::types::Elementary>, to: &Ty) -> bool {
        let to = match to {
            Ty::Level(at) => Ty::Number(self.types.levels[*at].0).elementary(),
            other => other.elementary(),
        };
        matches!((from, to), (Some(from), Some(to)) if from.widens_to(to))
    }

    fn shuffle<T>(&mut self, list: &mut [T]) {
        for at in (1..list.len()).rev() {
            list.swap(at, self.random.below(at + 1));
        }
    }
}
