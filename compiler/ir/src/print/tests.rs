//! The text of the sample program.

use super::print;
use crate::fixture::*;
use crate::{
    Arm, Conversion, Elementary, Expr, ExprKind, FaultKind, Op, RoutineId, Statement, StatementKind, TextOp, Type,
    Value,
};

fn body_text(body: Vec<Statement>) -> String {
    let text = print(&sample(body));
    let start = text.find("\nprogram Main\n").unwrap();
    let body = text[start..].find("\nbody\n").unwrap() + start + "\nbody\n".len();
    text[body..text.find("\n\ninstance").unwrap()].to_owned()
}

#[test]
fn declarations() {
    let text = print(&sample(vec![stmt(StatementKind::Return)]));
    let expected = "file main.st

enum Color: INT (Red = 0, Green = 5)

struct Adder
  var sum: INT := 10

struct Main
  var count: INT
  var wide: DINT
  var values: ARRAY[1..3] OF INT := [2(1), 9]
  var adder: Adder := (10)
  var name: STRING[8] := 'abc'
  var counter: CTU
  var color: Color := 5
  var limit: INT := 3 constant
  var flag: BOOL

struct globals
  var total: DINT

function Double: INT
  param x%0: INT
  param remainder&1: INT
  local x%0: INT
  local Double%1: INT
body
  Double%1 := MUL(x%0, INT#2) @7:3
  remainder&1 := x%0 @7:3

function_block Adder
  param amount&0: INT
body
  amount&0 := ADD(amount&0, INT#1) @7:3
  self.sum := ADD(self.sum, amount&0) @7:3

prescan Adder
body
  self.sum := INT#100 @7:3

program Main
  local temp%0: INT := 4
body
  return @7:3

instance main: Main priority 0
";
    assert_eq!(text, expected);
}

#[test]
fn statements() {
    let condition = Expr::apply(Op::Lt, Type::BOOL, vec![load(count()), int(3)], AT);
    let arms = vec![Arm { labels: vec![(1, 1), (3, 5)], body: vec![stmt(StatementKind::Exit)] }];
    let body = vec![
        stmt(StatementKind::If {
            condition,
            then: vec![call_adder(count())],
            otherwise: vec![call_double(int(1), value(lint(2), 1), Some(temp()))],
        }),
        stmt(StatementKind::Loop {
            body: vec![stmt(StatementKind::Case {
                selector: load(count()),
                arms,
                otherwise: vec![stmt(StatementKind::Continue)],
            })],
            count: None,
            continuing: vec![call_counter(Expr::bool(true, AT), 5)],
        }),
        prescan_adder(RoutineId(2), adder()),
        stmt(StatementKind::Fault(FaultKind::ZeroStep)),
    ];
    let expected = "  if LT(self.count, INT#3) @7:3
    call Adder self.adder(ref self.count) @7:3
  else
    temp%0 := call Double(INT#1, ref self.values[LINT#2]) @7:3
  loop @7:3
    case self.count @7:3
    1, 3..5:
      exit @7:3
    else
      continue @7:3
  continuing
    CTU self.counter(TRUE, FALSE, INT#5) @7:3
  call Adder.prescan self.adder() @7:3
  fault ZeroStep @7:3";
    assert_eq!(body_text(body), expected);
}

#[test]
fn expressions() {
    let real = Expr::constant(Elementary::Lreal, Value::F64(-0.0), AT);
    let text = Expr::new(Type::string(4), ExprKind::Text(crate::Chars::Narrow(b"a'\n\xff".to_vec())), AT);
    let length = Expr::new(Type::INT, ExprKind::ApplyText(TextOp::Len, vec![text]), AT);
    let body = vec![
        assign(count(), Expr::convert(Conversion::Truncate, Type::INT, real, AT)),
        assign(count(), length),
        assign(color_place(), Expr::new(COLOR, ExprKind::Const(Value::I16(5)), AT)),
        assign(total(), Expr::convert(Conversion::Value, Type::DINT, load(limit()), AT)),
        assign(count(), Expr::convert(Conversion::Same, Type::INT, load(color_place()), AT)),
    ];
    let expected = r"  self.count := TRUNC INT(LREAL#-0.0) @7:3
  self.count := LEN('a\'\n\xff') @7:3
  self.color := Color#5 @7:3
  global.total := TO DINT(self.limit) @7:3
  self.count := AS INT(self.color) @7:3";
    assert_eq!(body_text(body), expected);
}
