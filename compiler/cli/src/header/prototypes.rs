//! What a program calls and C implements.

use super::names::variable;
use super::types::Types;
use staunch_ir::{External, Type};
use std::fmt::Write;

/// Nothing for a program that calls nothing outside.
pub fn prototypes(types: &mut Types<'_>) -> String {
    let externals = types.program.externals();
    if externals.is_empty() {
        return String::new();
    }
    let all = |it: &External| {
        let params = it.params.iter().map(|it| it.ty).collect::<Vec<_>>();
        it.state.map(Type::Struct).into_iter().chain(params).chain(it.result).collect::<Vec<_>>()
    };
    externals.iter().flat_map(|it| all(it)).for_each(|it| types.define(it));
    let mut text = "
/* The POUs that the program calls but does not implement: define these functions, and link them with the program. A
   FUNCTION_BLOCK gets its instance and the context of the scan. Parameters that are not numbers are passed by pointers,
   which never overlap. Write only valid values of the variables' types. */
"
    .to_owned();
    for it in &externals {
        let _ = write!(text, "{}", prototype(types, it));
    }
    text
}

fn prototype(types: &Types<'_>, it: &External) -> String {
    let mut params = Vec::new();
    if let Some(state) = it.state {
        params.push(format!("{} *block", types.element(Type::Struct(state))));
        params.push("const staunch_context *cx".to_owned());
    }
    for param in &it.params {
        let (ty, name) = (types.element(param.ty), parameter(&param.name));
        params.push(match (param.by_reference, types.program.repr(param.ty)) {
            (true, _) => format!("{ty} *{name}"),
            (false, Some(_)) => format!("{ty} {name}"),
            (false, None) => format!("const {ty} *{name}"),
        });
    }
    let result = it.result.map(|ty| (types.program.repr(ty), types.element(ty)));
    let returned = match result {
        Some((Some(_), ty)) => ty,
        Some((None, ty)) => {
            params.push(format!("{ty} *result"));
            "void".to_owned()
        }
        None => "void".to_owned(),
    };
    let params = if params.is_empty() { "void".to_owned() } else { params.join(", ") };
    let kind = if it.state.is_some() { "FUNCTION_BLOCK" } else { "FUNCTION" };
    format!("/* {kind} {} */\n{returned} {}({params});\n", it.name, it.symbol)
}

/// The instance, the context and the result have names of their own.
fn parameter(name: &str) -> String {
    let name = variable(name);
    if ["block", "cx", "result"].contains(&name.as_str()) { format!("{name}_") } else { name }
}
