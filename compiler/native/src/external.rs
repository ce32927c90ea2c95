//! Calls of what is implemented outside, in C: a FUNCTION_BLOCK's instance and the context first, then the parameters in
//! order (numbers by value, all else and what may be written as pointers), at last a pointer for a result that is no
//! number.

use crate::function::Function;
use crate::place::PlaceValue;
use crate::runtime_call::by_pointer;
use crate::signature::clif_type;
use cranelift_codegen::ir::AbiParam;
use staunch_ir::{Argument, ExternalCall};

impl Function<'_, '_> {
    pub(crate) fn external(&mut self, call: &ExternalCall) {
        let mut values = Vec::new();
        if let Some(instance) = &call.instance {
            let context =
                self.start.context.expect("a function that calls what is outside on an instance has the context");
            values.push(by_pointer(self.reference(instance)));
            values.push(by_pointer(context));
        }
        for argument in &call.arguments {
            let value = match argument {
                Argument::Value(value) => {
                    let repr = self.module.program.repr(value.ty);
                    let passed = self.argument(value);
                    repr.map_or_else(|| by_pointer(passed), |repr| self.by_repr(repr, passed))
                }
                Argument::Reference(place) => by_pointer(self.reference(place)),
            };
            values.push(value);
        }
        let repr = call.result.as_ref().and_then(|it| self.module.program.repr(it.ty));
        if let (Some(target), None) = (&call.result, repr) {
            values.push(by_pointer(self.reference(target)));
        }
        let returned = repr.map(|it| AbiParam::new(clif_type(it)));
        let returned = self.call_runtime(&call.external.symbol, &values, returned);
        if let (Some(returned), Some(target)) = (returned, &call.result) {
            match self.place_value(target) {
                PlaceValue::Variable(variable) => self.builder.def_var(variable, returned),
                PlaceValue::Memory(address) => self.store(returned, address),
            }
        }
    }
}
