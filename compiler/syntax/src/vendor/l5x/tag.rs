//! Types and tags: the members of structures, the variables of controllers, programs and instructions.

use super::super::assembly::{Assembly, Chunk};
use super::super::xml::{Broken, Element, Part, Reader};
use super::data::{self, Value, array_of, name_of, ty_text};
use super::names::{Names, Scope, Shown, is_operand, key};
use staunch_runtime::{BLOCKS, Family};

type Chunks = Result<Vec<Chunk>, Broken>;

/// `TYPE name : STRUCT … END_STRUCT; END_TYPE`. A bit is a BOOL: the hidden member that holds it can be reached by
/// no name. A structure of the family of strings is a string.
pub fn data_type<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, names: &mut Names) -> Chunks {
    let place = &element.place;
    // Modules describe theirs again.
    let of = element.attribute(file, "Name").unwrap_or_default();
    names.module_types.insert(key(of));
    let is_text = element.attribute(file, "Family") == Some("StringFamily");
    let mut chunks = vec![Chunk::words("TYPE ", place)];
    chunks.extend(name_of(file, element));
    chunks.push(Chunk::words(if is_text { " : STRING[" } else { " :\nSTRUCT\n" }, place));
    let mut open = 1_usize;
    while open > 0 {
        match reader.part()? {
            Some(Part::Open(member)) if member.name == "Member" => {
                let attribute = |it: &str| member.attribute(file, it).unwrap_or_default();
                let dimension = attribute("Dimension");
                if is_text && attribute("Name") == "DATA" {
                    chunks.extend(member.attribute_text(file, "Dimension"));
                } else if !is_text && attribute("Hidden") != "true" {
                    let member_type = type_name(file, &member);
                    names.members.insert((key(of), key(attribute("Name"))), member_type);
                    chunks.extend(declared(file, &member, dimension));
                    chunks.push(Chunk::words(";\n", &member.place));
                }
                reader.skip()?;
            }
            Some(Part::Open(member)) if member.name == "Members" => open += 1,
            Some(Part::Open(_)) => reader.skip()?,
            Some(Part::Close) => open -= 1,
            Some(Part::Text(_)) => {}
            None => break,
        }
    }
    chunks.push(Chunk::words(if is_text { "];\nEND_TYPE\n" } else { "END_STRUCT;\nEND_TYPE\n" }, &reader.last()));
    Ok(chunks)
}

/// `name : ARRAY[0..9] OF type`
fn declared<'t>(file: &'t str, element: &Element<'t>, dimensions: &str) -> Vec<Chunk> {
    let place = &element.place;
    let mut chunks: Vec<Chunk> = name_of(file, element).into_iter().collect();
    match array_of(dimensions) {
        // An in-out of one element is how Logix has one of any size.
        Some(_) if dimensions == "1" && element.attribute(file, "Usage") == Some("InOut") => {
            chunks.push(Chunk::words(" : ARRAY[*] OF ", place));
        }
        Some(array) => chunks.push(Chunk::words(format!(" : {array}"), place)),
        None => {
            let at = ["Dimensions", "Dimension"].iter().find_map(|it| element.attribute_place(file, it));
            let message = format!("`{dimensions}` are not dimensions of an array");
            chunks.extend([Chunk::odd(message, &at.unwrap_or_else(|| place.clone())), Chunk::words(" : ", place)]);
        }
    }
    chunks.extend(ty(file, element));
    chunks
}

fn ty<'t>(file: &'t str, element: &Element<'t>) -> Option<Chunk> {
    let place = element.attribute_place(file, "DataType")?;
    Some(match ty_text(&file[place.clone()]) {
        Some(text) => Chunk::words(text, &place),
        None => Chunk::verbatim(place),
    })
}

/// The type that an element says.
pub fn type_name(file: &str, element: &Element<'_>) -> String {
    element.attribute(file, "DataType").unwrap_or_default().to_owned()
}

/// The tags in an element that was opened, to its end; aliases are noted, to be written as what they name.
pub fn tags<'t>(file: &'t str, reader: &mut Reader<'t>, head: &str, names: &Names, scope: &mut Scope) -> Chunks {
    let mut all = Vec::new();
    each_tag(file, reader, head, names, scope, &mut |chunks| all.extend(chunks))?;
    Ok(all)
}

fn each_tag<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    head: &str,
    names: &Names,
    scope: &mut Scope,
    write: &mut dyn FnMut(Vec<Chunk>),
) -> Result<(), Broken> {
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if matches!(element.name, "Tag" | "LocalTag") => {
                let name = key(element.attribute(file, "Name").unwrap_or_default());
                match element.attribute(file, "AliasFor") {
                    Some(target) => {
                        write(alias(file, &element, name, target, names, scope).into_iter().collect());
                        reader.skip()?;
                    }
                    None => {
                        scope.types.insert(name.clone(), type_name(file, &element));
                        if element.attribute(file, "Dimensions").is_some() {
                            scope.arrays.insert(name.clone());
                        }
                        scope.tags.insert(name);
                        let is_constant = element.attribute(file, "Constant") == Some("true");
                        let head = if is_constant { format!("{head} CONSTANT ") } else { format!("{head} ") };
                        write(tag(file, reader, &element, head, names)?);
                    }
                }
            }
            Part::Open(_) => reader.skip()?,
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(())
}

/// Notes an alias; what is wrong with it.
fn alias<'t>(
    file: &'t str,
    element: &Element<'t>,
    name: String,
    target: &str,
    names: &Names,
    scope: &mut Scope,
) -> Option<Chunk> {
    let place = element.attribute_place(file, "AliasFor")?;
    if !is_operand(target) {
        return Some(Chunk::odd(format!("an alias is for a tag or a part of one, not for `{target}`"), &place));
    }
    scope.aliases.insert(name.clone(), target.to_owned());
    let leads_to_itself = names.leads_to_itself(&name, scope);
    leads_to_itself.then(|| Chunk::odd(format!("this alias refers to itself through `{target}`"), &place))
}

/// Those of a controller, which may be many: each is written when it has been read.
pub fn controller_tags<'t>(
    file: &'t str,
    reader: &mut Reader<'t>,
    names: &mut Names,
    out: &mut Assembly,
) -> Result<(), Broken> {
    let mut scope = core::mem::take(&mut names.controller);
    let read = each_tag(file, reader, "VAR_GLOBAL", names, &mut scope, &mut |chunks| out.copy(file, &chunks));
    names.controller = scope;
    read
}

/// A tag or a parameter that was opened, to its end: a section of its own.
pub fn tag<'t>(file: &'t str, reader: &mut Reader<'t>, element: &Element<'t>, head: String, names: &Names) -> Chunks {
    let place = &element.place;
    let dimensions = element.attribute(file, "Dimensions").unwrap_or_default();
    let mut chunks = vec![Chunk::words(head, place)];
    chunks.extend(declared(file, element, dimensions));
    let ty = element.attribute(file, "DataType").unwrap_or_default();
    let value = initial(file, reader, ty)?;
    if value.is_none() {
        chunks.extend(shown(file, element, ty, dimensions, names));
    }
    // An instruction's parameters start at their defaults, unless its tag says otherwise.
    let says_all = |it: &Value| names.instructions.contains_key(&key(it.ty)) || has_defaults(it.ty);
    let value = value.filter(|it| !it.is_zero() || says_all(it));
    if let Some(value) = value {
        chunks.push(Chunk::words(" := ", place));
        let is_hidden = |ty: &str, member: &str| names.alias_parameters.contains(&(key(ty), key(member)));
        value.write(says_all(&value), &is_hidden, &mut chunks);
    }
    chunks.push(Chunk::words("; END_VAR\n", place));
    Ok(chunks)
}

/// The values that rungs show of a timer or counter without data, or of the elements of an array of them.
fn shown(file: &str, element: &Element<'_>, ty: &str, dimensions: &str, names: &Names) -> Option<Chunk> {
    let is_one = ["TIMER", "COUNTER"].iter().any(|it| it.eq_ignore_ascii_case(ty));
    let name = element.attribute(file, "Name").filter(|_| is_one)?;
    let values = |name: &str| match names.shown.get(&key(name)).map(|it| it.0) {
        Some(Shown::Values { preset, accum }) => Ok(Some(format!("(PRE := {preset}, ACC := {accum})"))),
        Some(Shown::Several) => {
            Err(format!("rungs show different values of `{name}`, and the tag has no data that shows which is right"))
        }
        None => Ok(None),
    };
    let found = match dimensions.parse::<usize>() {
        _ if dimensions.is_empty() => values(name),
        Ok(count) => (0..count)
            .map(|it| values(&format!("{name}[{it}]")))
            .collect::<Result<Vec<_>, _>>()
            .map(|it| it.iter().any(Option::is_some).then(|| list(&it))),
        // Of several dimensions.
        Err(_) => Ok(None),
    };
    match found {
        Ok(values) => values.map(|it| Chunk::words(format!(" := {it}"), &element.place)),
        Err(message) => Some(Chunk::odd(message, &element.place)),
    }
}

/// Values of elements, some of which have none.
fn list(values: &[Option<String>]) -> String {
    let each = values.iter().map(|it| it.as_deref().unwrap_or("(PRE := 0)"));
    format!("[{}]", each.collect::<Vec<_>>().join(", "))
}

/// Whether a structure of Logix's own has members that start TRUE, as `EnableIn` does.
fn has_defaults(ty: &str) -> bool {
    let own = BLOCKS.iter().filter(|it| it.family == Family::Logix && it.is_named(ty));
    own.flat_map(|it| it.pins).any(|it| it.starts_true)
}

/// The value in a tag that was opened, to the tag's end: decorated data before the older form.
fn initial<'t>(file: &'t str, reader: &mut Reader<'t>, ty: &'t str) -> Result<Option<Value<'t>>, Broken> {
    let (mut decorated, mut older) = (None, None);
    while let Some(part) = reader.part()? {
        match part {
            Part::Open(element) if matches!(element.name, "Data" | "DefaultData") => {
                match element.attribute(file, "Format") {
                    Some("Decorated") => decorated = data::within(file, reader)?,
                    Some("String") => decorated = data::text(file, reader, &element.place)?,
                    Some("L5K") => older = data::plain_numbers(file, reader, ty, &element.place)?,
                    _ => reader.skip()?,
                }
            }
            Part::Open(_) => reader.skip()?,
            Part::Text(_) => {}
            Part::Close => break,
        }
    }
    Ok(decorated.or(older))
}
