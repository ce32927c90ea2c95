//! Calls of routines and of standard blocks.

use crate::address::{Address, Class};
use crate::function::Function;
use crate::inline_block::{self, block_info};
use crate::members::offset;
use crate::place::PlaceValue;
use crate::runtime_call::by_pointer;
use crate::signature::result_type;
use cranelift_codegen::ir::{self as clif, InstBuilder};
use staunch_ir::effects::Effects;
use staunch_ir::{Argument, Expr, Location, Place, Repr, RoutineId, Type};
use staunch_runtime::{BlockInfo, Instruction};

impl Function<'_, '_> {
    pub(crate) fn call(
        &mut self,
        callee: RoutineId,
        instance: Option<&Place>,
        arguments: &[Argument],
        result: Option<&Place>,
        at: Location,
    ) {
        let instance = instance.map(|place| self.reference(place));
        let mut values = self.start_of_call(callee, instance);
        for argument in arguments {
            let value = match argument {
                Argument::Value(value) => self.argument(value),
                Argument::Reference(place) => self.reference(place),
            };
            values.push(value);
        }
        let out = self.result_pointer(callee, result);
        values.extend(out);
        let returned = self.call_routine(callee, &values, at);
        if let (Some(returned), Some(target)) = (returned, result) {
            match self.place_value(target) {
                PlaceValue::Variable(variable) => self.builder.def_var(variable, returned),
                PlaceValue::Memory(address) => self.store(returned, address),
            }
        }
    }

    /// What every function takes first.
    fn start_of_call(&self, callee: RoutineId, instance: Option<clif::Value>) -> Vec<clif::Value> {
        let effects = self.module.effects(callee);
        let context = self.start.context.filter(|_| effects.context);
        let globals = self.start.globals.filter(|_| effects.uses_globals());
        [context, globals, instance].into_iter().flatten().collect()
    }

    /// Calls a function, passes its fault on, and gives an elementary result.
    fn call_routine(&mut self, callee: RoutineId, values: &[clif::Value], at: Location) -> Option<clif::Value> {
        let function = self.routine_ref(callee);
        let Effects { faults, turns: takes_turns, faults_at_call, .. } = *self.module.effects(callee);
        if takes_turns {
            self.spill_turns();
        }
        let call = self.ins().call(function, values);
        // Its code may take the call's place.
        self.known_in = None;
        let results = self.builder.inst_results(call).to_vec();
        if !faults {
            return results.first().copied();
        }
        match faults_at_call {
            true => self.pass_fault_of_call(results[0], at),
            false => self.pass_fault(results[0]),
        }
        if takes_turns {
            self.reload_turns();
        }
        results.get(1).copied()
    }

    pub(crate) fn reference(&mut self, place: &Place) -> clif::Value {
        let address = self.address(place);
        self.pointer(address)
    }

    /// An argument that the callee copies, if it is not elementary.
    pub(crate) fn argument(&mut self, value: &Expr) -> clif::Value {
        match value.ty {
            Type::Elementary(_) | Type::Reference(_) | Type::Subrange(..) | Type::Enum(_) => self.scalar(value),
            Type::String(_) => self.text_pointer(value),
            Type::Array(_) | Type::Struct(_) | Type::Block(_) => {
                let address = self.aggregate(value);
                self.pointer(address)
            }
        }
    }

    /// Where a callee puts a result that is not elementary, whether it is wanted or not.
    fn result_pointer(&mut self, callee: RoutineId, result: Option<&Place>) -> Option<clif::Value> {
        let program = self.module.program;
        let ty = result_type(program.routine(callee)).filter(|ty| program.repr(*ty).is_none())?;
        let address = match result {
            Some(place) => self.address(place),
            None => {
                let shape = self.module.layout.shape(ty);
                self.temporary(shape)
            }
        };
        Some(self.pointer(address))
    }

    pub(crate) fn call_block(&mut self, block: &Place, instruction: usize, inputs: &[Expr]) {
        let info = block_info(block);
        let address = self.address(block);
        let values: Vec<_> = inputs.iter().map(|input| self.scalar(input)).collect();
        if let Some(emit) = inline_block::find(block, instruction, self.module.aim) {
            return emit(self, info, address, &values);
        }
        let instruction = &info.instructions[instruction];
        let rung = if instruction.takes_rung {
            values[0]
        } else {
            self.store_pins(info, address, &values);
            self.integer(clif::types::I8, 1)
        };
        self.run_instruction(instruction, address, rung);
    }

    pub(crate) fn store_pins(&mut self, info: &BlockInfo, address: Address, values: &[clif::Value]) {
        for (at, (pin, value)) in info.inputs().zip(values).enumerate() {
            self.store(*value, address.plus(offset(pin.offset)).of(Class::of_pin(info, at)));
        }
    }

    fn run_instruction(&mut self, instruction: &Instruction, block: Address, rung: clif::Value) {
        let context = self.start.context.expect("a function that calls blocks gets the context");
        let block = self.pointer(block);
        let rung = self.by_repr(Repr::Bool, rung);
        let arguments = [by_pointer(block), by_pointer(context), rung];
        self.call_runtime(instruction.symbol, &arguments, None);
    }

    pub(crate) fn prescan_block(&mut self, block: &Place, instruction: usize) {
        let prescan = block_info(block).instructions[instruction].prescan;
        let symbol = prescan.expect("verified IR: an instruction with a prescan").symbol;
        let block = self.reference(block);
        self.call_runtime(symbol, &[by_pointer(block)], None);
    }
}
