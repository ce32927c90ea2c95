//! The map of small programs.

use super::map_text;
use crate::fixture::{block, sample};
use crate::layout::Layout;
use crate::{Address, Area, Elementary, Program, Section, Type};
use staunch_runtime::Family;

fn map(program: &Program) -> String {
    crate::verify::verify(program).unwrap();
    map_text(program, &Layout::new(program))
}

#[test]
fn every_record_of_a_program() {
    let mut program = sample(Vec::new());
    program.instances[0].interval = Some(10_000_000);
    let fields = &mut program.structs[1].fields;
    fields[0].address = Some(Address { area: Area::Input, module: crate::Module::default(), bit: 64, width: 16 });
    fields[0].retain = crate::Retain::Kept;
    fields[0].ty = Type::Subrange(Elementary::Int, crate::BoundsId(0));
    program.classes[1].variables[0].place.ty = Type::Subrange(Elementary::Int, crate::BoundsId(0));
    program.structs[2].fields[0].section = Section::Global;
    let block = crate::fixture::ctu().0;
    let expected = format!(
        "map\t1
compiler\t{}
machine\t48\t4
file\t0\tmain.st
enum\t0\tColor\ti16\tRed=0\tGreen=5
array\t0\t1\t3\tINT\t2
struct\t0\tAdder\t2\tfunction_block
field\tsum\tINT\t0\tvar\t-\t-\t-
struct\t1\tMain\t44\tprogram
field\tcount\tINT\t0\tvar\tretain\t%IW4\t-3..7
field\twide\tDINT\t4\tvar\t-\t-\t-
field\tvalues\tarray:0\t8\tvar\t-\t-\t-
field\tadder\tstruct:0\t14\tvar\t-\t-\t-
field\tname\tSTRING[8]\t16\tvar\t-\t-\t-
field\tcounter\tblock:{block}\t26\tvar\t-\t-\t-
field\tcolor\tenum:0\t36\tvar\t-\t-\t-
field\tlimit\tINT\t38\tvar\tconstant\t-\t-
field\tflag\tBOOL\t40\tvar\t-\t-\t-
struct\t2\tglobals\t4\tglobals
field\ttotal\tDINT\t0\tglobal\t-\t-\t-
block\t{block}\tCTU\t10
field\tCU\tBOOL\t0\tinput\t-\t-\t-
field\tR\tBOOL\t1\tinput\t-\t-\t-
field\tPV\tINT\t2\tinput\t-\t-\t-
field\tQ\tBOOL\t4\toutput\t-\t-\t-
field\tCV\tINT\t6\toutput\t-\t-\t-
",
        env!("CARGO_PKG_VERSION")
    );
    let text = map(&program);
    assert!(text.starts_with(&expected), "{text}");
    let tail = format!(
        "globals\tstruct:2\t0
instance\t0\tmain\tMain\tstruct:1\t4\t10000000\t0
variable\t0\tcount\tvar\tINT\t4\tretain\t%IW4\t-3..7
variable\t0\ttotal\texternal\tDINT\t0\t-\t-\t-
variable\t0\tcounter\tvar\tblock:{block}\t30\t-\t-\t-
"
    );
    assert!(text.ends_with(&tail), "{text}");
}

#[test]
fn a_retentive_block_marks_its_variable() {
    let mut program = sample(Vec::new());
    let counter = block("COUNTER", Family::Logix);
    program.structs[1].fields[5].ty = Type::Block(counter);
    program.arrays[0].element = Type::Block(counter);
    program.structs[1].fields[2].initial = crate::Const::Zero;
    program.classes[1].variables.clear();
    let text = map(&program);
    for name in ["values", "counter"] {
        let line = text.lines().find(|line| line.starts_with(&format!("field\t{name}\t")));
        assert!(line.unwrap().contains("\tretain,whole\t"), "{line:?}");
    }
}

#[test]
fn the_file_that_declares_a_variable_decides_what_is_kept() {
    let flags = |system: Family| {
        let mut program = sample(Vec::new());
        program.files[0].system = system;
        let text = map(&program);
        let line = text.lines().find(|line| line.starts_with("field\tcounter\t")).unwrap_or_default().to_owned();
        line.split('\t').nth(5).unwrap_or_default().to_owned()
    };
    let found = [Family::Iec, Family::Cscape, Family::Openplc, Family::Codesys, Family::Logix].map(flags);
    assert_eq!(found, ["-", "-", "-", "stays", "retain,whole"]);
}

#[test]
fn an_address_reads_as_it_is_written() {
    let text = |area, bit, width| Address { area, module: crate::Module::default(), bit, width }.to_string();
    assert_eq!(text(Area::Output, 11, 1), "%QX1.3");
    assert_eq!(text(Area::Memory, 24, 8), "%MB3");
    assert_eq!(text(Area::Input, 64, 32), "%ID2");
    assert_eq!(text(Area::Input, 64, 64), "%IL1");
}

#[test]
fn a_large_array_is_one_record() {
    let mut program = sample(Vec::new());
    program.arrays[0] = crate::Array { low: 1, high: 1 << 20, element: Type::Elementary(Elementary::Byte) };
    program.structs[1].fields[2].initial = crate::Const::Zero;
    assert!(map(&program).len() < 4096);
}
