//! Sizes and offsets, against those of Rust.

use super::*;
use crate::Value;
use crate::fixture::{self, AT, COLOR, field, routine, structure};
use crate::{Elementary, RoutineKind, Struct};
use core::mem::{align_of, offset_of, size_of};

/// A program with two instances of one PROGRAM, whose state is the last of `structs`.
fn program(arrays: Vec<Array>, mut structs: Vec<Struct>) -> Program {
    let state = StructId::next(structs.len() - 1);
    let global = field("g", Type::BOOL, Const::Scalar(Value::Bool(true)));
    structs.push(structure("globals", vec![global]));
    let main = routine(RoutineKind::Body, "Main", Some(state));
    let mut program = fixture::program(arrays, structs, vec![main]);
    program.instances.push(program.instances[0].clone());
    program
}

#[repr(C)]
struct Text5 {
    len: u16,
    bytes: [u8; 5],
}

#[repr(C)]
struct Outer {
    first: u8,
    inner: [[Inner; 2]; 3],
    color: i16,
    text: Text5,
    last: u32,
    end: bool,
}

#[repr(C)]
struct Inner {
    flag: bool,
    wide: f64,
    text: Text5,
    small: u8,
}

fn elementary(it: Elementary) -> Type {
    Type::Elementary(it)
}

fn nested() -> Program {
    let inner = structure(
        "Inner",
        vec![
            field("flag", Type::BOOL, Const::Scalar(Value::Bool(true))),
            field("wide", Type::LREAL, Const::Zero),
            field("text", Type::string(5), Const::Text(crate::Chars::Narrow(b"abc".to_vec()))),
            field("small", elementary(Elementary::Usint), Const::Scalar(Value::U8(9))),
        ],
    );
    let row = Const::Array(vec![(
        2,
        Const::Struct(vec![
            Const::Scalar(Value::Bool(true)),
            Const::Scalar(Value::F64(1.5)),
            Const::Text(crate::Chars::Narrow(b"xy".to_vec())),
            Const::Zero,
        ]),
    )]);
    let outer = structure(
        "Outer",
        vec![
            field("first", elementary(Elementary::Byte), Const::Scalar(Value::U8(1))),
            field("inner", Type::Array(ArrayId(1)), Const::Array(vec![(1, Const::Zero), (2, row)])),
            field("color", COLOR, Const::Scalar(Value::I16(-2))),
            field("text", Type::string(5), Const::Zero),
            field("last", elementary(Elementary::Udint), Const::Scalar(Value::U32(77))),
            field("end", Type::BOOL, Const::Zero),
        ],
    );
    let arrays = vec![
        Array { low: 0, high: 1, element: Type::Struct(StructId(0)) },
        Array { low: -1, high: 1, element: Type::Array(ArrayId(0)) },
    ];
    program(arrays, vec![inner, outer])
}

#[test]
fn offsets_are_those_of_repr_c() {
    let program = nested();
    let layout = Layout::new(&program);
    let inner = [offset_of!(Inner, flag), offset_of!(Inner, wide), offset_of!(Inner, text), offset_of!(Inner, small)];
    let outer = [
        offset_of!(Outer, first),
        offset_of!(Outer, inner),
        offset_of!(Outer, color),
        offset_of!(Outer, text),
        offset_of!(Outer, last),
        offset_of!(Outer, end),
    ];
    let offsets = |id: u32, count: usize| -> Vec<usize> {
        (0..count).map(|at| usize_of(layout.field(StructId(id), FieldId::next(at)))).collect()
    };
    assert_eq!(offsets(0, 4), inner);
    assert_eq!(offsets(1, 6), outer);
    for (id, size, align) in
        [(0, size_of::<Inner>(), align_of::<Inner>()), (1, size_of::<Outer>(), align_of::<Outer>())]
    {
        let expected = Shape { size: u64_of(size), align: u64_of(align) };
        assert_eq!(layout.shape(Type::Struct(StructId(id))), expected);
    }
    assert_eq!(usize_of(layout.stride(ArrayId(0))), size_of::<Inner>());
    assert_eq!(usize_of(layout.stride(ArrayId(1))), 2 * size_of::<Inner>());
}

#[test]
fn machine_holds_globals_then_instances() {
    let program = nested();
    let machine = Layout::new(&program).machine;
    let outer = u64_of(size_of::<Outer>());
    assert_eq!(machine, Machine { size: 8 + 2 * outer, align: 8, globals: 0, instances: vec![8, 8 + outer] });
}

#[test]
fn image_holds_initial_values() {
    let program = nested();
    let layout = Layout::new(&program);
    let image = layout.image(&program);
    assert_eq!(image[0], 1, "the global");
    let second = &image[usize_of(layout.machine.instances[1])..];
    assert_eq!(second[0], 1);
    let inner = &second[offset_of!(Outer, inner)..];
    assert!(inner[..2 * size_of::<Inner>()].iter().all(|byte| *byte == 0), "Zero is all zero");
    for element in 2..6 {
        let bytes = &inner[element * size_of::<Inner>()..];
        assert_eq!(Value::read(Repr::F64, &bytes[offset_of!(Inner, wide)..]), Value::F64(1.5));
        assert_eq!(Value::read(Repr::U16, &bytes[offset_of!(Inner, text)..]), Value::U16(2));
        assert_eq!(&bytes[offset_of!(Inner, text) + 2..][..3], b"xy\0");
    }
    assert_eq!(Value::read(Repr::I16, &second[offset_of!(Outer, color)..]), Value::I16(-2));
    assert_eq!(Value::read(Repr::U32, &second[offset_of!(Outer, last)..]), Value::U32(77));
}

#[test]
fn too_large_is_an_error_with_its_place() {
    let huge = Array { low: i64::MIN, high: i64::MAX, element: Type::LREAL };
    let at = Some(AT);
    let one = |array: Array| {
        let fields = vec![field("big", Type::Array(ArrayId(0)), Const::Zero)];
        Layout::try_new(&program(vec![array], vec![structure("S", fields)])).map(|layout| layout.machine.size)
    };
    assert_eq!(one(huge), Err(TooLarge { ty: Some(Type::Array(ArrayId(0))), at }));
    let half = Array { low: 1, high: 1 << 29, element: elementary(Elementary::Byte) };
    assert_eq!(one(half), Err(TooLarge { ty: None, at: None }), "two instances and the globals");
    assert_eq!(one(Array { high: 1 << 20, ..half }), Ok(1 + (2 << 20)));
}

#[test]
fn too_many_fields_are_too_large() {
    let array = Array { low: 1, high: 1 << 29, element: elementary(Elementary::Byte) };
    let fields = (0..3).map(|at| field(&format!("f{at}"), Type::Array(ArrayId(0)), Const::Zero)).collect();
    let result = Layout::try_new(&program(vec![array], vec![structure("S", fields)]));
    assert!(matches!(result, Err(TooLarge { ty: None, at: Some(_) })));
}

#[test]
fn blocks_have_the_size_of_their_rust_type() {
    for (position, info) in staunch_runtime::BLOCKS.iter().enumerate() {
        let id = BlockId::next(position);
        let shape = block_shape(id);
        assert_eq!((usize_of(shape.size), usize_of(shape.align)), (info.size, info.align), "{info:?}");
        for pin in info.pins {
            assert!(pin.offset + usize_of(u64::from(pin.repr().size())) <= info.size, "{info:?}.{}", pin.name);
        }
    }
}
