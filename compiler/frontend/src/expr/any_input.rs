//! What is given for an input of ANY as CODESYS has it: the argument's class of type, its address and its size.

use super::checker::Checker;
use crate::types::signature::Formal;
use crate::{Code, Diagnostic, ast};
use staunch_ir::{Elementary, Expr, ExprKind, FieldId, RefKind, Type, Value};

/// The number of a type's class and its name, of CODESYS' TypeClass. CHAR and WCHAR, which CODESYS does not have, are of none.
pub(crate) fn class_of(ty: Type) -> (u32, &'static str) {
    match ty {
        Type::Elementary(it) => match it {
            Elementary::Bool => (0, "BOOL"),
            Elementary::Byte => (2, "BYTE"),
            Elementary::Word => (3, "WORD"),
            Elementary::Dword => (4, "DWORD"),
            Elementary::Lword => (5, "LWORD"),
            Elementary::Sint => (6, "SINT"),
            Elementary::Int => (7, "INT"),
            Elementary::Dint => (8, "DINT"),
            Elementary::Lint => (9, "LINT"),
            Elementary::Usint => (10, "USINT"),
            Elementary::Uint => (11, "UINT"),
            Elementary::Udint => (12, "UDINT"),
            Elementary::Ulint => (13, "ULINT"),
            Elementary::Real => (14, "REAL"),
            Elementary::Lreal => (15, "LREAL"),
            Elementary::Time => (18, "TIME"),
            Elementary::Date => (19, "DATE"),
            Elementary::Dt => (20, "DATEANDTIME"),
            Elementary::Tod => (21, "TIMEOFDAY"),
            Elementary::Char | Elementary::Wchar => (29, "NONE"),
            Elementary::Ltime | Elementary::Ultime => (37, "LTIME"),
            Elementary::Ldate => (46, "LDATE"),
            Elementary::Ldt => (47, "LDATEANDTIME"),
            Elementary::Ltod => (48, "LTIMEOFDAY"),
        },
        Type::String(it) if it.wide => (17, "WSTRING"),
        Type::String(_) => (16, "STRING"),
        Type::Reference(_) => (22, "POINTER"),
        Type::Subrange(..) => (24, "SUBRANGE"),
        Type::Enum(_) => (25, "ENUM"),
        Type::Array(_) => (26, "ARRAY"),
        Type::Struct(_) | Type::Block(_) => (28, "USERDEF"),
    }
}

impl<'s> Checker<'_, 's> {
    /// Whether a type is the structure that inputs of ANY get.
    fn is_any(&self, ty: Type) -> bool {
        let structure = self.decl.table.any.structure.map(|it| &self.decl.types[it].slot);
        matches!((structure, ty), (Some(crate::types::declarations::Slot::Done(it)), Type::Struct(_)) if it.ty == ty)
    }

    /// What is handed on of an argument for such an input; the inner `None` says that it was reported. An input of
    /// this kind is handed on as it is.
    pub(crate) fn any_value(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<Option<Expr>> {
        if !self.is_any(ty) || self.static_type(expr) == Some(ty) {
            return None;
        }
        Some(self.handed_on(expr, ty))
    }

    fn handed_on(&mut self, expr: &ast::Expr<'s>, ty: Type) -> Option<Expr> {
        let (Type::Struct(id), at) = (ty, self.at(expr.span)) else { return None };
        let pointer = match self.pointer_to_counter(expr) {
            Some(pointer) => pointer?,
            None => self.reference_to(expr, RefKind::PointerTo)?,
        };
        let Type::Reference(reference) = pointer.ty else { return None };
        let target = self.decl.program.target(reference);
        let class = ExprKind::Const(Value::U32(class_of(target).0));
        let size = i32::try_from(self.decl.sizeof(target)).unwrap_or(i32::MAX);
        let any = self.temporary("any", ty);
        let members: Vec<_> = self.decl.program.structure(id).fields.iter().map(|it| it.ty).collect();
        for (field, ty) in members.into_iter().enumerate() {
            let value = match field {
                0 => Expr::new(ty, class.clone(), at),
                1 => self.convert(staunch_ir::Conversion::Same, ty, pointer.clone()),
                _ => Expr::constant(Elementary::Dint, Value::I32(size), at),
            };
            self.assign(any.clone().field(FieldId::next(field), ty), value, expr.span);
        }
        Some(Expr::load(any, at))
    }

    /// Reports an argument that is not of the class that such an input is declared with: `ANY_NUM`.
    pub(crate) fn is_of_class(&mut self, formal: &Formal<'s>, expr: &ast::Expr<'s>) -> Option<()> {
        let Some(class) = self.decl.table.any.classes.get(&formal.name.span).copied() else { return Some(()) };
        let Some(ty) = self.static_type(expr) else { return Some(()) };
        if self.is_any(ty) || self.admits(class, ty.read(), expr.span) {
            return Some(());
        }
        let (wanted, found) = (class.name(), self.type_name(ty));
        self.report(
            Diagnostic::new(
                Code::E0204,
                expr.span,
                format!("`{}` takes {wanted}, but this is {found}", formal.name.text),
            )
            .label(format!("this is {found}")),
        );
        None
    }
}
