//! Routines with the same code share one function.
//!
//! ```text
//! Motor.Start, Pump.Start, Fan.Start:          Motor.Start:
//!     load [instance+8]                            load [instance+8]
//!     …, three times                               …
//! call Fan.Start(fan)                          call Motor.Start(fan)
//! ```
//!
//! A METHOD that heirs have from their base is a routine of each: they keep the base's variables first, at the same places, so that most
//! of them have the same code. It applies to routines that are declared at the same place, and whose code is equal before the code
//! generator optimises it, with the functions that it calls: callees come before their callers, and are already one. What takes the
//! place of a call is a routine's own code: another's would say of an heir's variables that they are of another class. It may not be
//! applied where a debugger is to find each routine, nor to what the host calls.

use crate::count::Marks;
use crate::target::Aim;
use cranelift_codegen::ir::function::FunctionStencil;
use cranelift_codegen::ir::{AliasRegionData, Function, UserExternalName};
use cranelift_module::FuncId;
use rustc_hash::{FxHashMap, FxHasher};
use staunch_ir::{ClassKind, Location, Program, RoutineId};
use std::borrow::Cow;
use std::hash::{Hash, Hasher};

/// The code of routines that others may equal.
#[derive(Default)]
pub(crate) struct Folded {
    /// The routines that are declared where another one is.
    candidates: Vec<bool>,
    known: FxHashMap<(Location, u64), Vec<(Shape, FuncId)>>,
}

/// All that a routine's machine code depends on.
#[derive(PartialEq)]
pub(crate) struct Shape {
    code: FunctionStencil,
    /// What the numbers of functions and data mean in it.
    names: Vec<UserExternalName>,
    marks: Marks,
}

impl Shape {
    /// Which variables a class has does not matter to a function by itself: only which accesses are of one class.
    fn of(code: &Function, names: Vec<UserExternalName>, marks: &Marks) -> Self {
        let mut code = code.stencil.clone();
        let classes = code.dfg.alias_regions.iter().count();
        code.dfg.alias_regions.clear();
        for number in (0..).take(classes) {
            code.dfg.alias_regions.push(AliasRegionData { user_id: number, description: Cow::Borrowed("") });
        }
        Self { code, names, marks: marks.clone() }
    }

    fn hash(&self) -> u64 {
        let mut hasher = FxHasher::default();
        self.code.hash(&mut hasher);
        hasher.finish()
    }
}

impl Folded {
    pub fn of(program: &Program, aim: Aim) -> Self {
        if aim == Aim::Debugging {
            return Self::default();
        }
        let mut places: FxHashMap<Location, usize> = FxHashMap::default();
        for it in &program.routines {
            *places.entry(it.location).or_default() += 1;
        }
        let mut candidates: Vec<_> = program.routines.iter().map(|it| places[&it.location] > 1).collect();
        let programs = program.classes.iter().filter(|it| it.kind == ClassKind::Program);
        for it in programs.flat_map(|it| [Some(it.body), it.prescan]).flatten() {
            candidates[it.index()] = false;
        }
        Self { candidates, known: FxHashMap::default() }
    }

    /// Whether a routine may have another's function.
    pub fn is_candidate(&self, routine: RoutineId) -> bool {
        self.candidates.get(routine.index()).is_some_and(|it| *it)
    }

    /// The function of a routine with this code; `make` makes it for the first one.
    pub fn function<E>(
        &mut self,
        at: Location,
        (code, names, marks): (&Function, Vec<UserExternalName>, &Marks),
        make: impl FnOnce() -> Result<FuncId, E>,
    ) -> Result<Shared, E> {
        let shape = Shape::of(code, names, marks);
        let known = self.known.entry((at, shape.hash())).or_default();
        if let Some((_, id)) = known.iter().find(|it| it.0 == shape) {
            return Ok(Shared::Known(*id));
        }
        let id = make()?;
        known.push((shape, id));
        Ok(Shared::New(id))
    }
}

/// A routine's function.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shared {
    /// Another routine's.
    Known(FuncId),
    /// Its own.
    New(FuncId),
}
