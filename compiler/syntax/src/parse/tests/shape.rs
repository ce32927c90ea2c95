//! Trees as short text, so that a test is a line.

use crate::{ast::*, diagnostic::Diagnostic, parse::parse};

pub fn parsed(text: &str) -> (File<'_>, Vec<Diagnostic>) {
    let mut diagnostics = Vec::new();
    let file = parse(0, text, &mut diagnostics);
    (file, diagnostics)
}

/// The file, which must parse.
pub fn correct(text: &str) -> File<'_> {
    let (file, diagnostics) = parsed(text);
    let messages: Vec<_> = diagnostics.iter().map(|it| (it.span, &it.message)).collect();
    assert!(messages.is_empty(), "{text}\n{messages:?}");
    file
}

/// The statements of a program with this body.
pub fn body(statements: &str) -> String {
    let text = format!("PROGRAM p {statements} END_PROGRAM");
    let file = correct(&text);
    let Item::Pou(pou) = &file.items[0] else { panic!("no program") };
    block(&pou.body)
}

pub fn initial_of(declaration: &str) -> String {
    let text = format!("VAR_GLOBAL {declaration} END_VAR");
    let file = correct(&text);
    let Item::Globals(block) = &file.items[0] else { panic!("no globals") };
    block.vars.iter().map(var).collect::<Vec<_>>().join(" ")
}

fn block(statements: &[Statement<'_>]) -> String {
    statements.iter().map(statement).collect::<Vec<_>>().join(" ")
}

fn statement(it: &Statement<'_>) -> String {
    match &it.kind {
        StatementKind::Empty => ";".into(),
        StatementKind::Assign { target, value } => format!("{}:={}", expr(target), expr(value)),
        StatementKind::AssignAll { targets, value } => {
            let targets: Vec<_> = targets.iter().map(expr).collect();
            format!("{}:={}", targets.join(":="), expr(value))
        }
        StatementKind::SetReset { target, value, set } => {
            format!("{}{}{}", expr(target), if *set { " S=" } else { " R=" }, expr(value))
        }
        StatementKind::SetResetAll { targets, value } => {
            let sign = |set: bool| if set { " S=" } else { " R=" };
            let targets: String = targets.iter().map(|(it, set)| format!("{}{}", expr(it), sign(*set))).collect();
            format!("{targets}{}", expr(value))
        }
        StatementKind::Attempt { target, value } => format!("{} ?= {}", expr(target), expr(value)),
        StatementKind::Bind { target, value } => format!("{} REF={}", expr(target), expr(value)),
        StatementKind::Expr(it) => expr(it),
        StatementKind::If { branches, otherwise } => {
            let branches: Vec<_> =
                branches.iter().map(|(test, body)| format!("{}?{{{}}}", expr(test), block(body))).collect();
            let otherwise = otherwise.as_ref().map_or(String::new(), |it| format!("else{{{}}}", block(it)));
            format!("if {}{otherwise}", branches.join(""))
        }
        StatementKind::Case { selector, arms, otherwise } => {
            let arms: Vec<_> = arms
                .iter()
                .map(|arm| {
                    let labels: Vec<_> = arm
                        .labels
                        .iter()
                        .map(|it| match &it.high {
                            Some(high) => format!("{}..{}", expr(&it.low), expr(high)),
                            None => expr(&it.low),
                        })
                        .collect();
                    format!(" {}:{{{}}}", labels.join(","), block(&arm.body))
                })
                .collect();
            let otherwise = otherwise.as_ref().map_or(String::new(), |it| format!(" else{{{}}}", block(it)));
            format!("case {}{}{otherwise}", expr(selector), arms.join(""))
        }
        StatementKind::For { counter, from, to, by, body } => {
            let by = by.as_ref().map_or(String::new(), |it| format!(" by {}", expr(it)));
            format!("for {}:={} to {}{by}{{{}}}", expr(counter), expr(from), expr(to), block(body))
        }
        StatementKind::While { condition, body } => format!("while {}{{{}}}", expr(condition), block(body)),
        StatementKind::Repeat { body, until } => format!("repeat{{{}}}until {}", block(body), expr(until)),
        StatementKind::Try(it) => {
            let finally = it.finally.as_ref().map_or(String::new(), |it| format!("finally{{{}}}", block(&it.body)));
            let exception = it.exception.as_ref().map_or(String::new(), expr);
            format!("try{{{}}}catch({exception}){{{}}}{finally}", block(&it.body), block(&it.handler))
        }
        StatementKind::Label(name) => format!("{}:", name.text),
        StatementKind::Jump(name) => format!("jmp {}", name.text),
        StatementKind::Exit => "exit".into(),
        StatementKind::Continue => "continue".into(),
        StatementKind::Return => "return".into(),
        StatementKind::ReturnIf(condition) => format!("return if {}", expr(condition)),
        StatementKind::Error => "error".into(),
    }
}

pub fn expr(it: &Expr<'_>) -> String {
    match &it.kind {
        ExprKind::Literal(it) => literal(it),
        ExprKind::Name(name) | ExprKind::Address(name) => name.text.into(),
        ExprKind::Member(of, name) | ExprKind::Part(of, name) => format!("{}.{}", expr(of), name.text),
        ExprKind::Index(of, indices) => {
            format!("{}[{}]", expr(of), indices.iter().map(expr).collect::<Vec<_>>().join(","))
        }
        ExprKind::Error(parts) => format!("error({})", parts.iter().map(expr).collect::<Vec<_>>().join(",")),
        ExprKind::Deref(of) => format!("{}^", expr(of)),
        ExprKind::Call(of, arguments) => {
            format!("{}({})", expr(of), arguments.iter().map(argument).collect::<Vec<_>>().join(","))
        }
        ExprKind::Unary(op, of) => format!("{op:?}({})", expr(of)),
        ExprKind::Binary(sides, op, _) => format!("({} {} {})", expr(&sides[0]), op.text(), expr(&sides[1])),
        ExprKind::Paren(inner) => format!("<{}>", expr(inner)),
        ExprKind::Assign(sides, _) => format!("({} := {})", expr(&sides[0]), expr(&sides[1])),
    }
}

fn argument(it: &Argument<'_>) -> String {
    match &it.kind {
        ArgumentKind::Positional(it) => expr(it),
        ArgumentKind::Input(name, it) => format!("{}:={}", name.text, expr(it)),
        ArgumentKind::Output { name, negated, target } => {
            let not = if *negated { "not " } else { "" };
            format!("{not}{}=>{}", name.text, target.as_ref().map_or(String::new(), expr))
        }
    }
}

fn literal(it: &Literal<'_>) -> String {
    let prefix = it.prefix.as_ref().map_or(String::new(), |it| format!("{}#", it.text));
    let value = match &it.value {
        LiteralValue::Bool(it) => it.to_string(),
        LiteralValue::Integer { value, .. } => value.to_string(),
        LiteralValue::Real(digits) => digits.to_string(),
        LiteralValue::Time { ty, nanoseconds } => format!("{nanoseconds}ns:{}", ty.name()),
        LiteralValue::String(chars) => format!("{:?}", chars.text()),
        LiteralValue::Enumerator(name) => name.text.into(),
        LiteralValue::Error => "error".into(),
    };
    prefix + &value
}

fn var(it: &VarDecl<'_>) -> String {
    let names = it.names.iter().map(|it| it.text).collect::<Vec<_>>().join(",");
    let address = it.address.map_or(String::new(), |it| format!(" at {}", it.text));
    let edge = it.edge.map_or(String::new(), |(it, _)| format!(" {it:?}"));
    let start = it.initial.as_ref().map_or(String::new(), |it| format!(" := {}", initial(it)));
    format!("{names}{address}: {}{edge}{start};", ty(&it.ty))
}

pub fn ty(it: &TypeSpec<'_>) -> String {
    match &it.kind {
        TypeKind::Named(path) => path.iter().map(|it| it.text).collect::<Vec<_>>().join("."),
        TypeKind::String { wide, capacity } => {
            let capacity = capacity.as_ref().map_or(String::new(), |it| format!("[{}]", expr(it)));
            format!("{}{capacity}", if *wide { "wstring" } else { "string" })
        }
        TypeKind::Subrange { base, low, high } => format!("{}({}..{})", base.text, expr(low), expr(high)),
        TypeKind::Array { bounds, element } => {
            let bounds: Vec<_> = bounds
                .iter()
                .map(|it| match it {
                    Bound::Range(low, high) => format!("{}..{}", expr(low), expr(high)),
                    Bound::Open(_) => "*".into(),
                })
                .collect();
            format!("array[{}] {}", bounds.join(","), ty(element))
        }
        TypeKind::Reference { kind, target } => format!("{} {}", kind.word(), ty(target)),
        TypeKind::Struct(fields) => format!("{{{}}}", fields.iter().map(var).collect::<Vec<_>>().join(" ")),
        TypeKind::Enum { base, values } => {
            let values: Vec<_> = values
                .iter()
                .map(|it| match &it.value {
                    Some(value) => format!("{}={}", it.name.text, expr(value)),
                    None => it.name.text.into(),
                })
                .collect();
            format!("enum({}){}", values.join(","), base.map_or("", |it| it.text))
        }
        TypeKind::Union(fields) => format!("<{}>", fields.iter().map(var).collect::<Vec<_>>().join(" ")),
        TypeKind::Error => "error".into(),
    }
}

fn initial(it: &Initial<'_>) -> String {
    match &it.kind {
        InitialKind::Value(it) => expr(it),
        InitialKind::Bind(it) => format!("REF= {}", expr(it)),
        InitialKind::Elements(elements) => {
            let elements: Vec<_> = elements
                .iter()
                .map(|it| {
                    let values = it.values.iter().map(initial).collect::<Vec<_>>().join(",");
                    it.count.as_ref().map_or(values.clone(), |count| format!("{}x({values})", expr(count)))
                })
                .collect();
            format!("[{}]", elements.join(","))
        }
        InitialKind::Fields(fields) => {
            let fields: Vec<_> = fields.iter().map(|(name, it)| format!("{}={}", name.text, initial(it))).collect();
            format!("({})", fields.join(","))
        }
        InitialKind::Indexed(elements) => {
            let index = |it: &[Expr<'_>]| it.iter().map(expr).collect::<Vec<_>>().join(",");
            let elements: Vec<_> = elements.iter().map(|(at, it)| format!("[{}]={}", index(at), initial(it))).collect();
            format!("[{}]", elements.join(","))
        }
        InitialKind::Members(values) => format!("({})", values.iter().map(initial).collect::<Vec<_>>().join(",")),
    }
}
