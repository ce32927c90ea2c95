//! Where a program computes with a type that its system holds otherwise than it is held here: the rules that are known
//! and not followed.

use staunch_frontend::Dialect;
use staunch_frontend::rules::{NOT_FOLLOWED, Use};
use staunch_ir::{Elementary, Expr, ExprKind, Op, Program, Section, visit};

/// A sentence for each type that the program computes with, or is given from outside.
pub fn find(program: &Program, dialect: Dialect) -> Vec<String> {
    let rows = NOT_FOLLOWED.iter().filter(|it| it.dialect == dialect);
    let found = rows.filter_map(|row| {
        let Use::Type(ty) = row.uses;
        let line = used(program, ty)?;
        let system = dialect.name().to_ascii_uppercase();
        Some(format!(
            "{} of {system}, which is not followed here and is used in line {line}: {} ({})",
            row.uses.name(),
            row.what,
            row.evidence
        ))
    });
    found.collect()
}

/// The first line that computes with a type, or declares an input of it. What is only assigned or compared cannot leave
/// the type's range.
fn used(program: &Program, ty: Elementary) -> Option<u32> {
    let is_it = |it: &staunch_ir::Field| it.section == Section::Input && it.ty.elementary() == Some(ty);
    let programs = program.instances.iter().map(|it| program.class(it.program).state).chain([program.globals]);
    let inputs =
        programs.flat_map(|it| &program.structure(it).fields).filter(|it| is_it(it)).map(|it| it.location.line);
    let mut lines: Vec<u32> = inputs.collect();
    for routine in &program.routines {
        visit::statements(&routine.body, &mut |statement| {
            visit::values(statement, &mut |value| {
                if computes(value, ty) {
                    lines.push(statement.at.line);
                }
            });
        });
    }
    lines.into_iter().min()
}

fn computes(expr: &Expr, ty: Elementary) -> bool {
    let is_it = |it: &Expr| it.ty.elementary() == Some(ty);
    let chooses = |op: Op| matches!(op, Op::Lt | Op::Le | Op::Gt | Op::Ge | Op::Eq | Op::Ne | Op::Min | Op::Max);
    match &expr.kind {
        ExprKind::Apply(op, operands) => {
            let own = !chooses(*op) && (is_it(expr) || operands.iter().any(is_it));
            own || operands.iter().any(|it| computes(it, ty))
        }
        ExprKind::ApplyText(_, operands) => operands.iter().any(|it| is_it(it) || computes(it, ty)),
        ExprKind::Convert(_, inner) => is_it(expr) != is_it(inner) || computes(inner, ty),
        ExprKind::Const(_)
        | ExprKind::Text(_)
        | ExprKind::Aggregate(_)
        | ExprKind::AddressOf(_)
        | ExprKind::Load(_) => false,
    }
}
