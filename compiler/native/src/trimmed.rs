//! The machine code of x86-64 without the frame that it does not need.
//!
//! ```text
//! push rbp                        …
//! mov rbp, rsp                    ret
//! …
//! mov rsp, rbp                    push rbp
//! pop rbp                         mov rbp, rsp
//! ret                             sub rsp, 16
//!                                 …
//!                                 leave
//!                                 ret
//! ```
//!
//! The code generator makes a frame for each function, and gives it back by three instructions. A function that calls none, keeps nothing on
//! the stack and is given all in registers has no use for it. The others give it back by `leave`, which does what the three do. The bytes
//! that remain after each end are never run. It applies to code of which [`count`](crate::count) knows each instruction, and to ends that
//! nothing jumps into. It may not move constants: the machine wants some of them at multiples of 16, so that a function with operations that may
//! have such has an instruction in place of its start that does nothing.

use crate::count::{Run, runs_of};
use cranelift_codegen::CompiledCode;
use cranelift_codegen::binemit::CodeOffset;
use cranelift_codegen::ir::{Function, Inst, Opcode};

const START: &[u8] = &[0x55, 0x48, 0x89, 0xE5];
const NOTHING: &[u8] = &[0x0F, 0x1F, 0x40, 0x00];
/// `mov rsp, rbp`, `pop rbp` and `ret`.
const END: &[u8] = &[0x48, 0x89, 0xEC, 0x5D, 0xC3];
const LEAVE_AND_RETURN: &[u8] = &[0xC9, 0xC3];
const RETURN: &[u8] = &[0xC3];
/// A trap, which nothing runs.
const FILLING: u8 = 0xCC;
/// `add rsp` with a number of a byte, and of four; and how long they are.
const GIVING_BACK: [(&[u8], usize); 2] = [(&[0x48, 0x83, 0xC4], 4), (&[0x48, 0x81, 0xC4], 7)];
/// So many numbers, and so many results, are in registers by all conventions that functions have.
const IN_REGISTERS: [usize; 2] = [4, 2];

/// A function's code, and how many bytes of the code generator's are missing before it.
#[derive(Clone, Debug)]
pub(crate) struct Trimmed {
    pub(crate) bytes: Vec<u8>,
    pub(crate) cut: usize,
}

impl Trimmed {
    /// Code as it is.
    pub(crate) fn none(code: &CompiledCode) -> Self {
        Self { bytes: code.code_buffer().to_vec(), cut: 0 }
    }

    /// Where it has what the code generator's has there.
    pub(crate) fn place(&self, offset: CodeOffset) -> CodeOffset {
        let cut = CodeOffset::try_from(self.cut).expect("a few bytes");
        offset.saturating_sub(cut)
    }

    pub(crate) fn of(code: &CompiledCode, function: &Function) -> Self {
        let mut it = Self::none(code);
        let Some(runs) = runs_of(code) else { return it };
        let needs_frame = needs_frame(code, function, &runs) || !it.bytes.starts_with(START);
        for run in &runs {
            it.end(run, if needs_frame { LEAVE_AND_RETURN } else { RETURN });
        }
        if !needs_frame {
            it.start(function);
        }
        it
    }

    /// Replaces the end of a run, if the function ends there.
    fn end(&mut self, run: &Run, by: &[u8]) {
        let code = &mut self.bytes[run.start..run.end];
        if !code.ends_with(END) || run.instructions < 3 {
            return;
        }
        let mut from = code.len() - END.len();
        for (operation, length) in GIVING_BACK {
            let starts = from.checked_sub(length).filter(|it| code[*it..].starts_with(operation));
            // The bytes are those of an instruction: it is the one before.
            if let Some(earlier) = starts.filter(|it| run.begins.contains(&(run.start + it))) {
                from = earlier;
                break;
            }
        }
        if run.begins.contains(&(run.start + from)) {
            let end = &mut code[from..];
            end.fill(FILLING);
            end[..by.len()].copy_from_slice(by);
        }
    }

    fn start(&mut self, function: &Function) {
        if may_have_aligned_constants(function) {
            self.bytes[..START.len()].copy_from_slice(NOTHING);
        } else {
            self.bytes.drain(..START.len());
            self.cut = START.len();
        }
    }
}

fn needs_frame(code: &CompiledCode, function: &Function, runs: &[Run]) -> bool {
    let is_on_stack = code.buffer.frame_layout().is_none_or(|it| it.frame_to_fp_offset > 0);
    let calls = runs.iter().any(|it| !it.calls.is_empty());
    let counts = [&function.signature.params, &function.signature.returns].map(Vec::len);
    let is_given_in_memory = counts.iter().zip(IN_REGISTERS).any(|(it, most)| *it > most);
    is_on_stack || calls || is_given_in_memory
}

/// Whether an operation is none of those whose constants may be anywhere.
fn may_have_aligned_constants(function: &Function) -> bool {
    let is_real = |inst: Inst| {
        let values = function.dfg.inst_args(inst).iter().chain(function.dfg.inst_results(inst));
        let mut types = values.map(|it| function.dfg.value_type(*it));
        types.any(|it| it.is_float() || it.is_vector())
    };
    let is_plain = |inst: Inst| {
        matches!(
            function.dfg.insts[inst].opcode(),
            Opcode::Fadd
                | Opcode::Fsub
                | Opcode::Fmul
                | Opcode::Fdiv
                | Opcode::Sqrt
                | Opcode::Fcmp
                | Opcode::Fpromote
                | Opcode::Fdemote
                | Opcode::FcvtFromSint
                | Opcode::F32const
                | Opcode::F64const
                | Opcode::Load
                | Opcode::Store
        )
    };
    let mut instructions = function.layout.blocks().flat_map(|it| function.layout.block_insts(it));
    instructions.any(|it| is_real(it) && !is_plain(it))
}
