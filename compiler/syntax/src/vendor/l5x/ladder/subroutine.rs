//! What a routine takes and gives: the operands of its `SBR` and of its `RET`s.

use super::super::logic::Subroutine;
use super::parse::{self, Element, Instruction};
use super::text::Text;

/// The parameters of the routine that consists of these rungs.
pub fn subroutine(rungs: &[Text]) -> Subroutine {
    let (mut inputs, mut returns) = (Vec::new(), Vec::new());
    for rung in rungs {
        let Ok(path) = parse::rung(&rung.text) else { continue };
        each(&path, &mut |it| {
            let operands = || it.operands.iter().map(|part| rung.part(part)).collect::<Vec<_>>();
            let name = &rung.text[it.name.clone()];
            if name.eq_ignore_ascii_case("SBR") {
                inputs = operands();
            } else if returns_values(name, it) {
                returns.push(operands());
            }
        });
    }
    Subroutine::Known { inputs, returns }
}

/// Whether it is a `RET` with operands.
pub fn returns_values(name: &str, it: &Instruction) -> bool {
    name.eq_ignore_ascii_case("RET") && !it.operands.is_empty()
}

/// Calls `see` for each instruction, in the order in which they are executed.
pub fn each(path: &[Element], see: &mut dyn FnMut(&Instruction)) {
    for element in path {
        match element {
            Element::Instruction(it) => see(it),
            Element::Branch(it) => it.paths.iter().for_each(|path| each(path, see)),
        }
    }
}
