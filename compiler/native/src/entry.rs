//! The program's entry points, which a host calls by their C symbols: `staunch_init` and
//! `staunch_scan`, and for objects the data `staunch_map` and `staunch_map_len`.

use crate::Error;
use crate::module::{ModuleEmitter, Workspace, define_data};
use crate::scan::Scan;
use crate::signature::{CODE, POINTER, SCAN, of_scan};
use cranelift_codegen::ir::{self as clif, AbiParam, BlockArg, InstBuilder, Signature, UserFuncName, types};
use cranelift_frontend::{FunctionBuilder, Switch};
use cranelift_module::{FuncId, Linkage, Module};

/// Runs of zeros in the initial image that are at least this long are not kept as data.
const GAP: usize = 256;

/// The functions that a program consists of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EntryPoints {
    pub(crate) init: FuncId,
    pub(crate) scan: FuncId,
}

pub(crate) fn emit(module: &mut ModuleEmitter<'_>, workspace: &mut Workspace) -> Result<EntryPoints, Error> {
    let init = define(module, workspace, "init", of_init, init)?;
    let scan = match module.scan() {
        Some(of_a_routine) => of_a_routine,
        None => define(module, workspace, SCAN, of_scan, scan)?,
    };
    Ok(EntryPoints { init, scan })
}

fn define(
    module: &mut ModuleEmitter<'_>,
    workspace: &mut Workspace,
    name: &str,
    of: fn(&mut Signature),
    emit: fn(&mut ModuleEmitter<'_>, &mut FunctionBuilder<'_>, &[clif::Value]),
) -> Result<FuncId, Error> {
    let mut signature = module.output.make_signature();
    of(&mut signature);
    let symbol = module.symbol(name);
    let id = module.output.declare_function(&symbol, Linkage::Export, &signature)?;
    let context = &mut workspace.context;
    context.func.signature = signature;
    context.func.name = UserFuncName::user(0, id.as_u32());
    let mut builder = FunctionBuilder::new(&mut context.func, &mut workspace.builder);
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let values = builder.block_params(entry).to_vec();
    emit(module, &mut builder, &values);
    builder.seal_all_blocks();
    builder.finalize(module.output.target_config());
    module.define_entry(context, id, &symbol)?;
    Ok(id)
}

fn of_init(signature: &mut Signature) {
    signature.params.push(AbiParam::new(POINTER));
}

/// `staunch_init(state)`: zeros, and over them the parts of the initial image that are not.
fn init(module: &mut ModuleEmitter<'_>, builder: &mut FunctionBuilder<'_>, values: &[clif::Value]) {
    let (state, config) = (values[0], module.output.target_config());
    module.note_state(builder, state);
    let image = module.layout.image(module.program);
    let size = i64::try_from(image.len()).expect("verified IR: sizes are within 1 GiB");
    let size = builder.ins().iconst(POINTER, size);
    let zero = builder.ins().iconst(types::I8, 0);
    builder.call_memset(config, state, zero, size);
    for (start, end) in parts(&image) {
        let id = module.constant(image[start..end].to_vec());
        let data = module.output.declare_data_in_func(id, builder.func);
        let from = builder.ins().symbol_value(POINTER, data);
        let to = builder.ins().iadd_imm_s(state, immediate(start));
        let size = builder.ins().iconst(POINTER, immediate(end - start));
        builder.call_memcpy(config, to, from, size);
    }
    builder.ins().return_(&[]);
}

/// Where an image is not zero: from byte, to byte.
fn parts(image: &[u8]) -> Vec<(usize, usize)> {
    let mut parts: Vec<(usize, usize)> = Vec::new();
    for (at, _) in image.iter().enumerate().filter(|(_, byte)| **byte != 0) {
        match parts.last_mut() {
            Some((_, end)) if at - *end < GAP => *end = at + 1,
            Some(_) | None => parts.push((at, at + 1)),
        }
    }
    parts
}

/// `staunch_scan(state, context, instance)`: the code of a fault, or 0. A number that is no
/// instance's does nothing.
fn scan(module: &mut ModuleEmitter<'_>, builder: &mut FunctionBuilder<'_>, values: &[clif::Value]) {
    let &[state, context, instance] = values else { unreachable!("as many as declared above") };
    module.note_state(builder, state);
    let done = builder.create_block();
    builder.append_block_param(done, CODE);
    Scan { module, builder, state, context, done }.starts();
    let otherwise = builder.create_block();
    let blocks: Vec<_> = module.program.instances.iter().map(|_| builder.create_block()).collect();
    let mut switch = Switch::new();
    for (number, block) in blocks.iter().enumerate() {
        switch.set_entry(u128::try_from(number).expect("a usize fits"), *block);
    }
    switch.emit(builder, instance, otherwise);
    for (number, block) in blocks.into_iter().enumerate() {
        builder.switch_to_block(block);
        let mut scan = Scan { module, builder, state, context, done };
        scan.instance(number);
    }
    builder.switch_to_block(otherwise);
    let none = builder.ins().iconst(CODE, 0);
    builder.ins().jump(done, &[BlockArg::Value(none)]);
    builder.switch_to_block(done);
    let code = builder.block_params(done)[0];
    builder.ins().return_(&[code]);
}

fn immediate(size: usize) -> i64 {
    i64::try_from(size).expect("verified IR: sizes are within 1 GiB")
}

/// `staunch_map`, the map's text, and `staunch_map_len`, its length.
pub(crate) fn map(module: &mut dyn Module, prefix: &str, text: &str) -> Result<(), Error> {
    let length = u64::try_from(text.len()).expect("a usize fits a u64").to_le_bytes();
    for (name, bytes) in [("map", text.as_bytes()), ("map_len", length.as_slice())] {
        let id = module.declare_data(&format!("{prefix}_{name}"), Linkage::Export, false, false)?;
        define_data(module, id, bytes.to_vec())?;
    }
    Ok(())
}
