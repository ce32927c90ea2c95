//! What a call takes.

use super::describe::{PARAMETERS, parameter, signatures};
use crate::calls::{around, calls};
use crate::place::{Place, count};
use crate::project::Analysis;
use gen_lsp_types::{
    ActiveParameter, ParameterInformation, ParameterInformationLabel, SignatureHelp, SignatureInformation,
};
use staunch_frontend::{DefId, DefinitionKind, Meaning};
use staunch_runtime::Direction;

/// A signature: what is called, and its parameters, each with its name.
#[derive(Clone, Debug)]
pub struct Called {
    pub name: String,
    pub parameters: Vec<(String, String)>,
    pub result: Option<String>,
}

/// What a name before parentheses stands for, once for each of several signatures.
pub fn called(analysis: &Analysis, name: &str, meaning: &Meaning) -> Vec<Called> {
    match meaning {
        Meaning::Definition(id) => of_definition(analysis, *id),
        Meaning::Block(block) => {
            let info = block.info();
            let pins = info.pins.iter().filter(|it| it.direction != Direction::Memory);
            let parameters = pins.map(|it| (it.name.to_owned(), format!("{} : {}", it.name, it.ty.name()))).collect();
            vec![Called { name: info.name.to_owned(), parameters, result: None }]
        }
        Meaning::Function => {
            let all = signatures(name, analysis.dialect()).into_iter();
            let of = |it: &staunch_runtime::Signature| {
                it.parameters.iter().map(|at| (at.name.to_owned(), parameter(it, at))).collect()
            };
            all.map(|it| Called { name: it.name.to_owned(), parameters: of(it), result: None }).collect()
        }
        _ => Vec::new(),
    }
}

fn of_definition(analysis: &Analysis, id: DefId) -> Vec<Called> {
    let definition = analysis.index.get(id);
    match definition.kind {
        DefinitionKind::Variable(_) | DefinitionKind::Member | DefinitionKind::Instance => {
            match analysis.type_of(id) {
                // An instance is called as its block is.
                Some(Meaning::Definition(ty)) if analysis.index.get(ty).kind != DefinitionKind::Structure => {
                    let name = analysis.name(id);
                    of_pou(analysis, ty).map(|it| Called { name: name.to_owned(), ..it }).into_iter().collect()
                }
                Some(it @ Meaning::Block(_)) => called(analysis, analysis.name(id), &it),
                _ => Vec::new(),
            }
        }
        _ => of_pou(analysis, id).into_iter().collect(),
    }
}

fn of_pou(analysis: &Analysis, id: DefId) -> Option<Called> {
    let definition = analysis.index.get(id);
    let members = analysis.members(id);
    let of_kind = |kind| members.iter().filter(move |it| it.1.kind == DefinitionKind::Variable(kind));
    let all = PARAMETERS.iter().flat_map(|it| of_kind(it.0));
    let parameters = all.map(|(id, it)| {
        let name = analysis.name(*id).to_owned();
        let shown = it.ty.map_or_else(|| name.clone(), |ty| format!("{name} : {}", analysis.text(ty)));
        (name, shown)
    });
    let is_called = !matches!(
        definition.kind,
        DefinitionKind::Structure | DefinitionKind::Enumeration | DefinitionKind::Type | DefinitionKind::Union
    );
    let result = definition.ty.map(|it| analysis.text(it).to_owned());
    is_called.then(|| Called { name: analysis.name(id).to_owned(), parameters: parameters.collect(), result })
}

pub fn help(analysis: &Analysis, place: Place) -> Option<SignatureHelp> {
    help_by(analysis, analysis, place)
}

/// The file with the call around a place without its arguments, as a statement: a call that is being typed is not yet an expression.
pub fn closed(analysis: &Analysis, place: Place) -> Option<String> {
    let source = analysis.source(place.file);
    let calls = calls(place.file, &source.text);
    let (call, _) = around(&calls, place.offset)?;
    let index = |it: u32| usize::try_from(it).ok();
    let rest = source.text.get(index(place.offset)?..)?;
    let rest = rest.find('\n').map_or("", |it| &rest[it..]);
    Some(format!("{});{rest}", source.text.get(..=index(call.open)?)?))
}

/// The same, where another analysis knows what the call's name means.
pub fn help_by(analysis: &Analysis, knows: &Analysis, place: Place) -> Option<SignatureHelp> {
    let calls = calls(place.file, &analysis.source(place.file).text);
    let (call, at) = around(&calls, place.offset)?;
    let (_, meaning) = knows.index.at(call.name.file, call.name.start)?;
    let all = called(knows, analysis.text(call.name), &meaning);
    let given = call.arguments.get(at).and_then(|it| it.name).map(|it| analysis.text(it));
    let active = |it: &Called| {
        let named = given.and_then(|name| it.parameters.iter().position(|it| it.0.eq_ignore_ascii_case(name)));
        ActiveParameter::Int(count(named.unwrap_or(at)))
    };
    let signatures: Vec<_> = all
        .iter()
        .map(|it| {
            let names: Vec<_> = it.parameters.iter().map(|it| it.1.as_str()).collect();
            let result = it.result.as_ref().map_or_else(String::new, |it| format!(" : {it}"));
            let parameters = it.parameters.iter().map(|it| ParameterInformation {
                label: ParameterInformationLabel::String(it.1.clone()),
                documentation: None,
            });
            SignatureInformation {
                label: format!("{}({}){result}", it.name, names.join(", ")),
                documentation: None,
                parameters: Some(parameters.collect()),
                active_parameter: Some(active(it)),
            }
        })
        .collect();
    let is_known = !signatures.is_empty();
    is_known.then_some(SignatureHelp { signatures, active_signature: Some(0), active_parameter: None })
}
