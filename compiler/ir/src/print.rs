//! The IR as text, one statement a line, for people and golden tests. It is written, never read.
//!
//! `self.x` is the instance's, `global.x` a global, `x%2` local 2, `x&0` by-reference parameter 0.

mod statement;

use crate::{
    ClassKind, Const, Conversion, Expr, ExprKind, Field, Mode, Overlay, Place, Program, Projection, Retain, Root,
    Routine, RoutineKind, Section, Struct, Type, Value,
};
use core::fmt::{self, Display, Write};

impl Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&print(self))
    }
}

/// The whole program.
pub fn print(program: &Program) -> String {
    printed(program, true)
}

/// The same without files and places in them: what programs have in common whose text is in other files.
pub fn print_without_places(program: &Program) -> String {
    printed(program, false)
}

fn printed(program: &Program, has_places: bool) -> String {
    let mut printer = Printer { program, text: String::new(), depth: 0, has_places };
    printer.program().expect("writing to a String does not fail");
    printer.text
}

struct Printer<'p> {
    program: &'p Program,
    text: String,
    depth: usize,
    has_places: bool,
}

impl Printer<'_> {
    fn line(&mut self, line: fmt::Arguments<'_>) -> fmt::Result {
        for _ in 0..self.depth {
            self.text.push_str("  ");
        }
        writeln!(self.text, "{line}")
    }

    fn program(&mut self) -> fmt::Result {
        let program = self.program;
        let files = if self.has_places { program.files.as_slice() } else { &[] };
        for file in files {
            self.line(format_args!("file {}", file.path))?;
        }
        for enumeration in &program.enums {
            self.enumeration(enumeration)?;
        }
        for structure in &program.structs {
            self.line(format_args!("\nstruct {}", structure.name))?;
            structure.overlays.iter().try_for_each(|it| self.overlay(structure, it))?;
            structure.fields.iter().try_for_each(|field| self.field(field))?;
        }
        for routine in &program.routines {
            self.routine(routine)?;
        }
        self.instances()
    }

    fn enumeration(&mut self, enumeration: &crate::Enum) -> fmt::Result {
        let values: Vec<String> =
            enumeration.values.iter().map(|value| format!("{} = {}", value.name, value_text(value.value))).collect();
        let base = enumeration.base.name();
        self.line(format_args!("\nenum {}: {base} ({})", enumeration.name, values.join(", ")))
    }

    fn overlay(&mut self, structure: &Struct, overlay: &Overlay) -> fmt::Result {
        let (storage, bit) = (&structure.fields[overlay.field.index()].name, overlay.bit);
        self.line(format_args!(
            "  overlay {}: {} = {storage} from bit {bit}",
            overlay.name,
            self.program.type_name(overlay.ty)
        ))
    }

    fn field(&mut self, field: &Field) -> fmt::Result {
        let mut line = format!("  {} {}: ", section_word(field.section), field.name);
        line.push_str(&self.program.type_name(field.ty));
        self.initial(&mut line, &field.initial)?;
        for (holds, word) in [
            (field.retain == Retain::Kept, " retain"),
            (field.retain == Retain::Anew, " non_retain"),
            (field.constant, " constant"),
        ] {
            line.push_str(if holds { word } else { "" });
        }
        if let Some(address) = field.address {
            write!(line, " at {address}")?;
        }
        self.line(format_args!("{line}"))
    }

    /// Nothing for all-zero.
    fn initial(&self, line: &mut String, value: &Const) -> fmt::Result {
        match value {
            Const::Zero => Ok(()),
            Const::Scalar(_) | Const::Text(_) | Const::Array(_) | Const::Struct(_) => {
                write!(line, " := {}", constant_text(value))
            }
        }
    }

    fn routine(&mut self, routine: &Routine) -> fmt::Result {
        let class = routine.state.and_then(|it| self.program.class_of_state(it)).map(|it| it.kind);
        let kind = match (routine.kind, class) {
            (RoutineKind::Prescan, _) => "prescan",
            (RoutineKind::Body, Some(ClassKind::Program)) => "program",
            (RoutineKind::Body, Some(ClassKind::FunctionBlock) | None) => "function_block",
            (RoutineKind::Function, _) => "function",
            (RoutineKind::Method, _) => "method",
        };
        let result = routine.result.map(|id| &routine.locals[id.index()]);
        let result = result.map(|local| format!(": {}", self.program.type_name(local.ty))).unwrap_or_default();
        let name = match routine.kind {
            RoutineKind::Method => self.program.title(routine),
            RoutineKind::Function | RoutineKind::Body | RoutineKind::Prescan => routine.name.clone(),
        };
        self.line(format_args!("\n{kind} {name}{result}"))?;
        for (id, param) in routine.params.iter().enumerate() {
            let ty = self.program.type_name(param.ty);
            match param.mode {
                Mode::Value(local) => self.line(format_args!("  param {}%{}: {ty}", param.name, local.0))?,
                Mode::Reference => self.line(format_args!("  param {}&{id}: {ty}", param.name))?,
            }
        }
        for (id, local) in routine.locals.iter().enumerate() {
            let mut line = format!("  local {}%{id}: {}", local.name, self.program.type_name(local.ty));
            self.initial(&mut line, &local.initial)?;
            self.line(format_args!("{line}"))?;
        }
        if routine.body.is_empty() {
            return Ok(());
        }
        self.line(format_args!("body"))?;
        self.block(routine, &routine.body)
    }

    fn instances(&mut self) -> fmt::Result {
        for instance in &self.program.instances {
            let mut line = format!("\ninstance {}: ", instance.name);
            line.push_str(&self.program.class(instance.program).name);
            if let Some(interval) = instance.interval {
                write!(line, " every {interval}ns")?;
            }
            self.line(format_args!("{line} priority {}", instance.priority))?;
        }
        Ok(())
    }

    fn place(&self, routine: &Routine, place: &Place) -> String {
        let mut ty = self.program.root_type(routine, place.root);
        let mut text = match place.root {
            Root::Instance => "self".to_owned(),
            Root::Globals => "global".to_owned(),
            Root::Local(id) => format!("{}%{}", routine.locals[id.index()].name, id.0),
            Root::Param(id) => format!("{}&{}", routine.params[id.index()].name, id.0),
        };
        for projection in &place.projections {
            match projection {
                Projection::Field(field) => {
                    text.push('.');
                    text.push_str(&self.member_name(ty, *field));
                    ty = ty.and_then(|ty| self.program.member(ty, *field));
                }
                Projection::Index { index, .. } => {
                    text.push_str(&format!("[{}]", self.expr(routine, index)));
                    ty = self.element(ty);
                }
                Projection::Deref { target, .. } => {
                    text.push('^');
                    ty = Some(*target);
                }
            }
        }
        text
    }

    fn member_name(&self, ty: Option<Type>, field: crate::FieldId) -> String {
        match ty {
            Some(Type::Struct(id)) => self.program.structure(id).fields[field.index()].name.clone(),
            Some(Type::Block(id)) => id.info().pins[field.index()].name.to_owned(),
            Some(
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Array(_),
            )
            | None => {
                format!("?{}", field.0)
            }
        }
    }

    fn element(&self, ty: Option<Type>) -> Option<Type> {
        match ty {
            Some(Type::Array(id)) => Some(self.program.array(id).element),
            Some(
                Type::Elementary(_)
                | Type::Reference(_)
                | Type::Subrange(..)
                | Type::String(_)
                | Type::Enum(_)
                | Type::Struct(_)
                | Type::Block(_),
            )
            | None => None,
        }
    }

    fn expr(&self, routine: &Routine, expr: &Expr) -> String {
        let ty = || self.program.type_name(expr.ty);
        match &expr.kind {
            ExprKind::Const(Value::Bool(value)) if expr.ty == Type::BOOL => value_text(Value::Bool(*value)),
            ExprKind::Const(value) => format!("{}#{}", ty(), value_text(*value)),
            ExprKind::Text(text) => text.to_string(),
            ExprKind::Aggregate(value) => format!("{}{}", ty(), constant_text(value)),
            ExprKind::Load(place) => self.place(routine, place),
            ExprKind::AddressOf(place) => format!("ADR({})", self.place(routine, place)),
            ExprKind::Apply(op, operands) => self.call(routine, op.source_name(), operands),
            ExprKind::ApplyText(op, operands) => self.call(routine, op.source_name(), operands),
            ExprKind::Convert(how, operand) => {
                let word = match how {
                    Conversion::Value => "TO",
                    Conversion::Truncate => "TRUNC",
                    Conversion::Same => "AS",
                    Conversion::Bits => "BITS",
                };
                format!("{word} {}({})", ty(), self.expr(routine, operand))
            }
        }
    }

    fn call(&self, routine: &Routine, name: &str, operands: &[Expr]) -> String {
        format!("{name}({})", self.exprs(routine, operands))
    }

    fn exprs(&self, routine: &Routine, exprs: &[Expr]) -> String {
        let texts: Vec<String> = exprs.iter().map(|expr| self.expr(routine, expr)).collect();
        texts.join(", ")
    }
}

fn value_text(value: Value) -> String {
    match value {
        Value::Bool(true) => "TRUE".to_owned(),
        Value::Bool(false) => "FALSE".to_owned(),
        Value::I8(it) => it.to_string(),
        Value::I16(it) => it.to_string(),
        Value::I32(it) => it.to_string(),
        Value::I64(it) => it.to_string(),
        Value::U8(it) => it.to_string(),
        Value::U16(it) => it.to_string(),
        Value::U32(it) => it.to_string(),
        Value::U64(it) => it.to_string(),
        // Debug has the fewest digits that read back as the same value, and always a point.
        Value::F32(it) => format!("{it:?}"),
        Value::F64(it) => format!("{it:?}"),
    }
}

fn constant_text(value: &Const) -> String {
    match value {
        Const::Zero => "0".to_owned(),
        Const::Scalar(value) => value_text(*value),
        Const::Text(text) => text.to_string(),
        Const::Array(runs) => {
            let runs: Vec<String> = runs.iter().map(|(count, value)| run_text(*count, value)).collect();
            format!("[{}]", runs.join(", "))
        }
        Const::Struct(values) => {
            let values: Vec<String> = values.iter().map(constant_text).collect();
            format!("({})", values.join(", "))
        }
    }
}

fn run_text(count: u64, value: &Const) -> String {
    match count {
        1 => constant_text(value),
        _ => format!("{count}({})", constant_text(value)),
    }
}

fn section_word(section: Section) -> &'static str {
    match section {
        Section::Input => "input",
        Section::Output => "output",
        Section::InOut => "inout",
        Section::Internal => "var",
        Section::Temp => "temp",
        Section::Global => "global",
        Section::External => "external",
    }
}

#[cfg(test)]
mod tests;
