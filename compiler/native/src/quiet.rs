//! Calls of the runtime that keep all registers.
//!
//! ```text
//!                                       quiet(state, reference, distance, space, …):
//!     load [p]                              save all registers
//!     …                                     fault := staunch_reference_load(table, state, reference, …, space)
//! slow:                                     store fault, space+8
//!     call staunch_reference_load           restore them
//! ```
//!
//! The code for a reference that leads where it is expected is a few instructions; away from it is a call of the runtime. A usual call keeps
//! few registers, so that all values that are needed after it would be in the frame, or in registers that the function has to save, on
//! the common path as well. It applies to accesses through references. There is one such function for each of the runtime's;
//! none in code for a debugger, which finds variables in the frame anyway. It may not assume that
//! nothing in memory changes.

use crate::Error;
use crate::address::Address;
use crate::function::Function;
use crate::module::{ModuleEmitter, Workspace};
use crate::runtime_call::by_pointer;
use crate::signature::{POINTER, c_value};
use crate::target::Aim;
use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, UserFuncName, Value, types};
use cranelift_frontend::FunctionBuilder;
use staunch_ir::Location;
use staunch_runtime::Repr;

/// Where the fault is, after what is loaded or stored.
const FAULT_AT: u64 = 8;
/// The bytes of both.
pub(crate) const SPACE: u64 = 16;

impl Function<'_, '_> {
    /// An access by reference, away from the common path: by a function of the runtime that is given the table, the state, the
    /// reference, the distance, some numbers, and a pointer to the space.
    pub(crate) fn access_away(
        &mut self,
        (symbol, numbers): (&'static str, Vec<u32>),
        [reference, distance]: [Value; 2],
        space: Address,
        at: Location,
    ) {
        let [words, state] = self.world();
        let pointer = self.pointer(space);
        if self.module.aim == Aim::Debugging {
            let number = |value| (AbiParam::new(types::I64), value);
            let mut arguments = vec![words, state, number(reference), number(distance)];
            for it in numbers {
                let value = self.integer(types::I32, it.into());
                arguments.push(self.by_repr(Repr::U32, value));
            }
            arguments.push(by_pointer(pointer));
            return self.checked(symbol, &arguments, at);
        }
        let id = self.module.quiet(symbol, numbers.len());
        let function = self.function_ref(id);
        let mut arguments = vec![state.1, reference, distance, pointer];
        for it in numbers {
            arguments.push(self.integer(types::I32, it.into()));
        }
        self.ins().call(function, &arguments);
        let kind = self.load_as(types::I8, space.plus(FAULT_AT));
        self.fault_of_kind(kind, at);
    }
}

/// The functions that routines call so.
pub(crate) fn emit(module: &mut ModuleEmitter<'_>, workspace: &mut Workspace) -> Result<(), Error> {
    for (symbol, (id, numbers)) in core::mem::take(&mut module.quiet) {
        let number = c_value(module.output.isa().triple(), Repr::U32);
        let runtime = of_runtime(module.output.make_signature(), number, numbers);
        let runtime = module.import(symbol, &runtime);
        let table = module.reference_table();
        let context = &mut workspace.context;
        context.func.signature = module.output.declarations().get_function_decl(id).signature.clone();
        context.func.name = UserFuncName::user(0, id.as_u32());
        let mut builder = FunctionBuilder::new(&mut context.func, &mut workspace.builder);
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        builder.seal_block(entry);
        let [state, reference, distance, space, numbers @ ..] = builder.block_params(entry) else {
            unreachable!("the parameters of a quiet function")
        };
        let (space, mut arguments) = (*space, vec![*state, *reference, *distance]);
        arguments.extend(numbers);
        let table = module.output.declare_data_in_func(table, builder.func);
        arguments.insert(0, builder.ins().symbol_value(POINTER, table));
        arguments.push(space);
        let runtime = module.output.declare_func_in_func(runtime, builder.func);
        let call = builder.ins().call(runtime, &arguments);
        let kind = builder.inst_results(call)[0];
        let at = i32::try_from(FAULT_AT).expect("it is near");
        builder.ins().store(MemFlagsData::trusted(), kind, space, at);
        builder.ins().return_(&[]);
        builder.finalize(module.output.target_config());
        module.define_entry(context, id, &format!("{symbol}, which keeps registers"))?;
    }
    Ok(())
}

/// The signature of the runtime's function, which returns a fault.
fn of_runtime(mut signature: Signature, number: AbiParam, numbers: usize) -> Signature {
    signature.params.extend([POINTER, POINTER, types::I64, types::I64].map(AbiParam::new));
    signature.params.extend(core::iter::repeat_n(number, numbers));
    signature.params.push(AbiParam::new(POINTER));
    signature.returns.push(AbiParam::new(types::I8).uext());
    signature
}
