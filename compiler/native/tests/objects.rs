//! Objects for every target: what they define, what they need, and what they must not have.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use cranelift_object::object::{File, Object, ObjectSection, ObjectSymbol};
use staunch_ir::*;
use staunch_native::{Target, object};
use staunch_runtime::{BLOCKS, Kind};
use std::collections::BTreeSet;
use support::*;

/// One PROGRAM with every operation, conversion and block.
fn everything() -> Program {
    let reprs: Vec<_> = Repr::ALL.to_vec();
    let mut fields: Vec<_> = reprs.iter().map(|repr| zero("value", elementary(*repr))).collect();
    fields.push(field("text", Type::string(80), Const::Text(Chars::Narrow(b"start".to_vec()))));
    fields.push(zero("wide", Type::String(StringType::wide(80))));
    fields.push(zero("values", Type::Array(ArrayId(0))));
    let first_block = fields.len();
    fields.extend((0..BLOCKS.len()).map(|at| zero("block", Type::Block(BlockId::next(at)))));
    let value = |repr: Repr| {
        let at = reprs.iter().position(|it| *it == repr).unwrap();
        member(StructId(0), at, elementary(repr))
    };
    let text = || member(StructId(0), reprs.len(), Type::string(80));
    let wide = || member(StructId(0), reprs.len() + 1, Type::String(StringType::wide(80)));
    let mut body = Vec::new();
    for op in Op::ALL {
        for repr in reprs.iter().copied().filter(|repr| op.allows(*repr)) {
            let operands = op.operands().iter().map(|fixed| load(value(fixed.unwrap_or(repr)))).collect();
            let result = op.result().unwrap_or(repr);
            body.push(assign(value(result), operation(*op, elementary(result), operands)));
        }
    }
    for (from, to) in reprs.iter().flat_map(|from| reprs.iter().map(move |to| (*from, *to))) {
        let convert = |how| assign(value(to), Expr::convert(how, elementary(to), load(value(from)), AT));
        body.push(convert(Conversion::Value));
        if from.is_float() && to.is_integer() {
            body.push(convert(Conversion::Truncate));
        }
    }
    for (op, is_wide) in TextOp::ALL.iter().flat_map(|op| [(op, false), (op, true)]) {
        let place = |kind: Kind| match kind {
            Kind::String => text(),
            Kind::Wstring => wide(),
            Kind::AnyString if is_wide => wide(),
            Kind::AnyString => text(),
            Kind::T | Kind::Any(_) | Kind::Is(_) => value(kind.repr().unwrap()),
        };
        let signature = op.signature();
        let operands = signature.parameters.iter().map(|it| load(place(it.kind))).collect();
        let target = place(signature.result);
        body.push(assign(target.clone(), Expr::new(target.ty, ExprKind::ApplyText(*op, operands), AT)));
    }
    let values = || member(StructId(0), reprs.len() + 2, Type::Array(ArrayId(0)));
    body.push(assign(values(), load(values())));
    body.push(assign(values(), Expr::new(values().ty, ExprKind::Aggregate(Const::Zero), AT)));
    for number in 0..BLOCKS.len() {
        let id = BlockId::next(number);
        let block = || member(StructId(0), first_block + number, Type::Block(id));
        for (instruction, info) in id.info().instructions.iter().enumerate() {
            let inputs = match info.takes_rung {
                true => vec![load(value(Repr::Bool))],
                false => id.info().inputs().map(|pin| load(value(pin.repr()))).collect(),
            };
            body.push(stmt(StatementKind::CallBlock { block: block(), instruction, inputs }));
            if info.prescan.is_some() {
                body.push(stmt(StatementKind::PrescanBlock { block: block(), instruction }));
            }
        }
    }
    let main = Routine { body, ..routine(RoutineKind::Body, "Main", Some(StructId(0))) };
    program(vec![Array { low: 0, high: 99, element: Type::LREAL }], vec![structure("Main", fields)], vec![main])
}

fn names<'a>(symbols: impl Iterator<Item = &'a str>) -> BTreeSet<String> {
    symbols.map(str::to_owned).collect()
}

#[test]
fn objects_have_the_entry_points_and_need_the_runtime_alone() {
    let program = everything();
    verify::verify(&program).unwrap();
    let mut runtime = names(["memcpy", "memmove", "memset"].into_iter());
    staunch_runtime_abi::for_each_symbol(&mut |name, _| {
        runtime.insert(name.to_owned());
    });
    for target in Target::SUPPORTED {
        let bytes = object(&program, &Target::parse(target).unwrap()).unwrap();
        let file = File::parse(bytes.as_slice()).unwrap();
        let defined = file.symbols().filter(|it| it.is_global() && it.is_definition());
        let exported = names(defined.map(|it| it.name().unwrap()));
        let entry_points = ["staunch_init", "staunch_map", "staunch_map_len", "staunch_scan"];
        assert_eq!(exported, names(entry_points.into_iter()), "{target}");
        let undefined = file.symbols().filter(|it| it.is_undefined());
        let needed = names(undefined.map(|it| it.name().unwrap()).filter(|name| !name.is_empty()));
        assert!(needed.is_subset(&runtime), "{target}: {:?}", needed.difference(&runtime));
        assert!(file.section_by_name(".eh_frame").is_none(), "{target}");
        assert_eq!(file.section_by_name(".note.GNU-stack").is_some(), target.contains("linux"), "{target}");
        assert_eq!(bytes, object(&program, &Target::parse(target).unwrap()).unwrap(), "always the same");
    }
}

#[test]
fn the_map_and_its_length_are_data() {
    let program = everything();
    let map = symbols::map_text(&program, &layout::Layout::new(&program));
    let bytes = object(&program, &Target::parse("riscv64").unwrap()).unwrap();
    let file = File::parse(bytes.as_slice()).unwrap();
    let data = |name: &str| {
        let symbol = file.symbols().find(|it| it.name() == Ok(name)).unwrap();
        let section = file.section_by_index(symbol.section_index().unwrap()).unwrap();
        let start = usize::try_from(symbol.address() - section.address()).unwrap();
        section.data().unwrap()[start..][..usize::try_from(symbol.size()).unwrap()].to_vec()
    };
    assert_eq!(String::from_utf8(data("staunch_map")).unwrap(), map);
    assert_eq!(data("staunch_map_len"), u64::try_from(map.len()).unwrap().to_le_bytes());
}
