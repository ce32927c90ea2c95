//! What a scan does around the bodies of PROGRAMs. Where one PROGRAM runs, its body is `staunch_scan` itself, which saves the
//! call.

use crate::address::Address;
use crate::module::ModuleEmitter;
use crate::signature::CODE;
use cranelift_codegen::ir::{self as clif, BlockArg, InstBuilder, MemFlagsData, types};
use cranelift_frontend::FunctionBuilder;
use staunch_ir::effects::Effects;
use staunch_ir::{Program, RoutineId};
use staunch_runtime::Context;

/// What a body that is `staunch_scan` works on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begun {
    pub(crate) context: clif::Value,
    pub(crate) globals: clif::Value,
    pub(crate) instance: clif::Value,
}

/// The body that is `staunch_scan` itself: that of the one PROGRAM that runs, which nobody else calls.
pub(crate) fn scanned(program: &Program, effects: &[Effects]) -> Option<RoutineId> {
    let [only] = program.instances.as_slice() else { return None };
    let body = program.class(only.program).body;
    let is_called = effects.iter().any(|it| it.calls.contains(&body));
    let is_plain = program.routine(body).params.is_empty();
    (is_plain && !is_called).then_some(body)
}

/// How a body begins that is `staunch_scan`: with what comes before any, in the block that is open.
pub(crate) fn start_of_scan(module: &mut ModuleEmitter<'_>, builder: &mut FunctionBuilder<'_>) -> Begun {
    let entry = builder.current_block().expect("the function's first block");
    let &[state, context, instance] = builder.block_params(entry) else { unreachable!("as many as declared") };
    module.note_state(builder, state);
    let [none, first, done] = [(); 3].map(|()| builder.create_block());
    builder.set_cold_block(none);
    builder.append_block_param(done, CODE);
    builder.ins().brif(instance, none, &[], first, &[]);
    builder.switch_to_block(none);
    let no_fault = builder.ins().iconst(CODE, 0);
    builder.ins().jump(done, &[BlockArg::Value(no_fault)]);
    builder.switch_to_block(done);
    let code = builder.block_params(done)[0];
    builder.ins().return_(&[code]);
    builder.switch_to_block(first);
    let at = Address::at(state).plus(module.layout.machine.instances[0]);
    let globals = Address::at(state).plus(module.layout.machine.globals);
    let class = module.program.class(module.program.instances[0].program);
    let mut scan = Scan { module, builder, state, context, done };
    if let Some(prescan) = class.prescan {
        scan.prescan(prescan, at);
    }
    let [instance, globals] = [at, globals].map(|it| scan.pointer(it));
    builder.seal_all_blocks();
    Begun { context, globals, instance }
}

pub(crate) struct Scan<'s, 'p, 'b> {
    pub(crate) module: &'s mut ModuleEmitter<'p>,
    pub(crate) builder: &'s mut FunctionBuilder<'b>,
    pub(crate) state: clif::Value,
    pub(crate) context: clif::Value,
    pub(crate) done: clif::Block,
}

impl Scan<'_, '_, '_> {
    /// Before the first scan of any PROGRAM, what starts the instances of all.
    pub(crate) fn starts(&mut self) {
        for (number, start) in self.module.program.starts() {
            let at = Address::at(self.state).plus(self.module.layout.machine.instances[number]);
            self.prescan(start, at);
        }
    }

    pub(crate) fn instance(&mut self, number: usize) {
        let class = self.module.program.class(self.module.program.instances[number].program);
        let at = Address::at(self.state).plus(self.module.layout.machine.instances[number]);
        if let Some(prescan) = class.prescan {
            self.prescan(prescan, at);
        }
        let code = self.call(class.body, at);
        self.builder.ins().jump(self.done, &[BlockArg::Value(code)]);
    }

    /// In the first scan, and only on if it does not fault.
    fn prescan(&mut self, routine: RoutineId, at: Address) {
        let offset = core::mem::offset_of!(Context, first_scan);
        let offset = i32::try_from(offset).expect("a context is small");
        let flags = MemFlagsData::trusted();
        let first_scan = self.builder.ins().load(types::I8, flags, self.context, offset);
        let [prescan, body] = [(); 2].map(|()| self.builder.create_block());
        self.builder.ins().brif(first_scan, prescan, &[], body, &[]);
        self.builder.switch_to_block(prescan);
        let code = self.call(routine, at);
        self.builder.ins().brif(code, self.done, &[BlockArg::Value(code)], body, &[]);
        self.builder.switch_to_block(body);
    }

    /// Calls a routine of a PROGRAM; gives the code that it returned, or 0.
    fn call(&mut self, routine: RoutineId, instance: Address) -> clif::Value {
        let effects = self.module.effects(routine).clone();
        let function = self.module.routine_ref(routine, self.builder.func);
        let mut values = Vec::new();
        if effects.context {
            values.push(self.context);
        }
        if effects.uses_globals() {
            values.push(self.pointer(Address::at(self.state).plus(self.module.layout.machine.globals)));
        }
        values.push(self.pointer(instance));
        let call = self.builder.ins().call(function, &values);
        match self.builder.inst_results(call).first() {
            Some(code) => *code,
            None => self.builder.ins().iconst(CODE, 0),
        }
    }

    fn pointer(&mut self, address: Address) -> clif::Value {
        match address.displacement() {
            0 => address.base,
            offset => self.builder.ins().iadd_imm_s(address.base, i64::from(offset)),
        }
    }
}
