//! Finds variables by the names that people use for them.

use crate::map::{Map, Section, Type, Variable};

/// A variable, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// In the program's state.
    pub offset: usize,
    pub ty: Type,
    /// Bounds of a subrange type.
    pub range: Option<(i128, i128)>,
    pub constant: bool,
    /// The world outside writes it.
    pub input: bool,
    /// In a UNION, where texts lie otherwise.
    pub(crate) is_shared: bool,
}

impl Place {
    /// A variable of a type alone, with the offsets of its parts counted from its own start.
    pub(crate) fn of_type(ty: Type) -> Self {
        Self { offset: 0, ty, range: None, constant: false, input: false, is_shared: false }
    }

    pub(crate) fn of(variable: &Variable, base: usize) -> Self {
        let Variable { offset, ty, range, constant, view, .. } = *variable;
        let ty = if view { shared(ty) } else { ty };
        Self { offset: base + offset, ty, range, constant, input: variable.is_input(), is_shared: view }
    }

    /// A member or element of this variable.
    pub(crate) fn part(self, ty: Type, offset: usize) -> Self {
        let ty = if self.is_shared { shared(ty) } else { ty };
        Self { ty, offset: self.offset + offset, range: None, ..self }
    }

    pub(crate) fn member(self, variable: &Variable) -> Self {
        let is_shared = self.is_shared || variable.view;
        let inner = Self { is_shared, ..self };
        Self { range: variable.range, ..inner.part(variable.ty, variable.offset) }
    }
}

/// The type of a variable whose bytes belong to other variables as well.
fn shared(ty: Type) -> Type {
    match ty {
        Type::String(it) => Type::Characters(it),
        Type::Elementary(_)
        | Type::Bit(_)
        | Type::Characters(_)
        | Type::Enum(_)
        | Type::Array(_)
        | Type::Struct(_)
        | Type::Block(_)
        | Type::Reference => ty,
    }
}

/// Finds the variable that `text` names, seen from the instances `running`.
///
/// The error is a sentence without a full stop, with a name that might have been meant.
pub fn resolve(map: &Map, running: &[usize], text: &str) -> Result<Place, String> {
    let text = text.trim();
    if text.starts_with('%') {
        return by_address(map, running, text);
    }
    let steps = steps(text).ok_or_else(|| format!("`{text}` is not the name of a variable"))?;
    let Some((Step::Name(first), rest)) = steps.split_first() else {
        return Err(format!("`{text}` is not the name of a variable"));
    };
    as_variable(map, running, &steps, first, rest).or_else(|error| {
        // A variable may be called as a PROGRAM is.
        let Some((Step::Name(second), after)) = rest.split_first() else { return Err(error) };
        match in_scope(map, running, first, second) {
            Ok(Some(place)) => follow(map, place, after),
            Ok(None) | Err(_) => Err(error),
        }
    })
}

/// What a path leads to where its first name is a variable's, if any has that name.
fn as_variable(
    map: &Map,
    running: &[usize],
    steps: &[Step<'_>],
    first: &str,
    rest: &[Step<'_>],
) -> Result<Place, String> {
    if let Some(place) = in_programs(map, running, first)? {
        return follow(map, place, rest);
    }
    if let Some((Step::Name(second), after)) = rest.split_first() {
        if let Some(place) = in_scope(map, running, first, second)? {
            return follow(map, place, after);
        }
    }
    if let Some((place, after)) = in_list(map, steps) {
        return follow(map, place, after);
    }
    let (globals, base) = map.globals();
    match (named(globals, first), rest.first()) {
        (Some(it), _) => follow(map, Place::of(it, base), rest),
        (None, Some(Step::Name(name))) if held_by(map, first).next().is_some() => {
            let near = nearest(name, held_by(map, first));
            Err(format!("`{first}` has no variable `{name}`{near}"))
        }
        (None, _) => Err(unknown(map, running, first)),
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step<'t> {
    Name(&'t str),
    Index(i64),
}

/// The steps of `a.b[1,2].c`; `None` if it does not read as a path.
fn steps(text: &str) -> Option<Vec<Step<'_>>> {
    let mut steps = Vec::new();
    let mut rest = text;
    loop {
        let end = rest.find(['.', '[']).unwrap_or(rest.len());
        let name = rest[..end].trim();
        if name.is_empty() || !name.chars().all(|it| it.is_alphanumeric() || it == '_') {
            return None;
        }
        steps.push(Step::Name(name));
        rest = &rest[end..];
        while let Some(inside) = rest.strip_prefix('[') {
            let (indices, after) = inside.split_once(']')?;
            for index in indices.split(',') {
                steps.push(Step::Index(index.trim().parse().ok()?));
            }
            rest = after.trim_start();
        }
        match rest.strip_prefix('.') {
            Some(after) => rest = after,
            None if rest.is_empty() => return Some(steps),
            None => return None,
        }
    }
}

/// The wanted part of the state: where it is, how large it is, and perhaps its type.
#[derive(Clone, Copy)]
struct Wanted {
    offset: usize,
    size: usize,
    ty: Option<Type>,
}

/// The name of the variable at an offset of the state that has this size.
pub(crate) fn path_at(map: &Map, offset: usize, size: usize) -> Option<String> {
    path_to(map, Wanted { offset, size, ty: None })
}

/// The name of the variable of type `ty` at an offset of the state: `Main.motors[2]`, or of a PROGRAM's instance.
pub fn instance_at(map: &Map, offset: usize, ty: Type) -> Option<String> {
    let program = map.instances.iter().find(|it| (it.offset, it.ty) == (offset, ty));
    let wanted = Wanted { offset, size: map.size_of(ty), ty: Some(ty) };
    program.map(|it| it.name.clone()).or_else(|| path_to(map, wanted))
}

fn path_to(map: &Map, wanted: Wanted) -> Option<String> {
    let (globals, base) = map.globals();
    let found = member_at(map, globals, base, wanted);
    found.or_else(|| {
        map.instances.iter().find_map(|it| {
            let members = map.structure(it.ty).map_or(&[][..], |it| &it.members);
            let path = member_at(map, members, it.offset, wanted)?;
            Some(format!("{}.{path}", it.name))
        })
    })
}

/// The variable that an offset of the state is in, and where it starts, if it is in what only keeps the bits of several: one
/// that starts there before others, and a short one before long ones.
pub(crate) fn view_at(map: &Map, (start, size): (usize, usize), offset: usize) -> Option<(String, usize)> {
    let (globals, base) = map.globals();
    let is_storage = |it: &&Variable| it.section == Section::Memory && base + it.offset == start;
    globals.iter().find(is_storage).filter(|it| map.size_of(it.ty) == size)?;
    let is_in = |it: &&Variable| {
        let (from, length) = (base + it.offset, map.size_of(Place::of(it, base).ty));
        it.view && !matches!(it.ty, Type::Bit(_)) && (from..from + length).contains(&offset)
    };
    let rank = |it: &&Variable| (base + it.offset != offset, map.size_of(it.ty));
    let found = globals.iter().filter(is_in).min_by_key(rank)?;
    Some((found.name.clone(), base + found.offset))
}

fn member_at(map: &Map, members: &[Variable], base: usize, wanted: Wanted) -> Option<String> {
    members.iter().find_map(|it| {
        let way = way_to(map, it.ty, base + it.offset, wanted)?;
        Some(format!("{}{way}", it.name))
    })
}

/// The way from a variable at `start` to its part that is wanted.
fn way_to(map: &Map, ty: Type, start: usize, wanted: Wanted) -> Option<String> {
    let (length, offset) = (map.size_of(ty), wanted.offset);
    if (start, length) == (offset, wanted.size) && wanted.ty.is_none_or(|it| it == ty) {
        return Some(String::new());
    }
    if offset < start || start + length <= offset {
        return None;
    }
    if let Some(array) = map.array(ty) {
        let position = (offset - start).checked_div(array.stride)?;
        let way = way_to(map, array.element, start + position * array.stride, wanted)?;
        let index = array.low.checked_add_unsigned(u64::try_from(position).ok()?)?;
        return Some(format!("[{index}]{way}"));
    }
    let path = member_at(map, &map.structure(ty)?.members, start, wanted)?;
    Some(format!(".{path}"))
}

fn named<'m>(variables: &'m [Variable], name: &str) -> Option<&'m Variable> {
    let mut found = variables.iter().filter(|it| same(&it.name, name));
    let first = found.next()?;
    // The storage of a UNION has a name that a member may have, too.
    let is_storage = first.section == Section::Memory;
    found.next().filter(|_| is_storage).or(Some(first))
}

/// IEC names are the same in any case.
pub fn same(a: &str, b: &str) -> bool {
    a.eq_ignore_ascii_case(b) || a.to_lowercase() == b.to_lowercase()
}

/// A variable of the one running program that has it.
fn in_programs(map: &Map, running: &[usize], name: &str) -> Result<Option<Place>, String> {
    let mut found: Option<(usize, Place)> = None;
    for at in running {
        let Some(variable) = named(&map.instances[*at].variables, name) else { continue };
        let place = Place::of(variable, 0);
        match found {
            Some((first, before)) if before.offset != place.offset => {
                let (a, b) = (&map.instances[first].name, &map.instances[*at].name);
                return Err(format!("`{name}` is ambiguous: `{a}.{name}` or `{b}.{name}`"));
            }
            _ => found = Some((*at, place)),
        }
    }
    Ok(found.map(|it| it.1))
}

/// `scope.name`, where the scope is an instance, a PROGRAM, or `Globals`.
fn in_scope(map: &Map, running: &[usize], scope: &str, name: &str) -> Result<Option<Place>, String> {
    let instances = map.instances.iter();
    let one = instances.clone().find(|it| same(&it.name, scope));
    let mut of_program = running.iter().map(|at| &map.instances[*at]).filter(|it| same(&it.program, scope));
    let instance = match (one, of_program.next(), of_program.next()) {
        (Some(one), ..) => Some(one),
        (None, Some(a), Some(b)) => {
            return Err(format!("`{scope}` is ambiguous: `{}` or `{}`", a.name, b.name));
        }
        (None, first, _) => first.or_else(|| instances.clone().find(|it| same(&it.program, scope))),
    };
    if let Some(instance) = instance {
        let found = named(&instance.variables, name).map(|it| Place::of(it, 0));
        return found.map(Some).ok_or_else(|| {
            let near = nearest(name, instance.variables.iter().map(|it| it.name.as_str()));
            format!("PROGRAM `{}` has no variable `{name}`{near}", instance.program)
        });
    }
    let (globals, base) = map.globals();
    if !same(scope, "Globals") {
        return Ok(None);
    }
    let found = named(globals, name).map(|it| Place::of(it, base));
    found.map(Some).ok_or_else(|| {
        let near = nearest(name, globals.iter().map(|it| it.name.as_str()));
        format!("there is no global variable `{name}`{near}")
    })
}

/// `Panel.start`, `Plant.Panel.start`: a global variable by its name in full, and what follows.
fn in_list<'s, 't>(map: &Map, steps: &'s [Step<'t>]) -> Option<(Place, &'s [Step<'t>])> {
    let (globals, base) = map.globals();
    let mut path = String::new();
    for (at, step) in steps.iter().enumerate() {
        let Step::Name(name) = step else { return None };
        path = if at == 0 { (*name).to_owned() } else { format!("{path}.{name}") };
        let known = map.global_paths.iter().find(|it| same(&it.1, &path));
        if let Some(variable) = known.and_then(|it| named(globals, &it.0)) {
            return Some((Place::of(variable, base), &steps[at + 1..]));
        }
    }
    None
}

/// The names of what a NAMESPACE or list holds.
fn held_by<'m>(map: &'m Map, list: &'m str) -> impl Iterator<Item = &'m str> {
    let of = map.global_paths.iter().filter_map(|it| it.1.rsplit_once('.'));
    of.filter(move |it| same(it.0, list)).map(|it| it.1)
}

fn follow(map: &Map, mut place: Place, steps: &[Step<'_>]) -> Result<Place, String> {
    for step in steps {
        place = match step {
            Step::Name(name) => member(map, place, name)?,
            Step::Index(index) => element(map, place, *index)?,
        };
    }
    Ok(place)
}

/// The part of a variable of type `ty` that a path leads to: `.a[3]`. Its offset is from the variable.
///
/// The error is a sentence without a full stop.
pub fn part(map: &Map, ty: Type, path: &str) -> Result<Place, String> {
    let text = format!("variable{path}");
    let steps = steps(&text).ok_or_else(|| format!("`{path}` does not lead to a part of a variable"))?;
    follow(map, Place::of_type(ty), &steps[1..])
}

fn member(map: &Map, place: Place, name: &str) -> Result<Place, String> {
    let Some(structure) = map.structure(place.ty) else {
        return Err(format!("{} has no member `{name}`", with_article(&map.type_name(place.ty))));
    };
    named(&structure.members, name).map(|it| place.member(it)).ok_or_else(|| {
        let near = nearest(name, structure.members.iter().map(|it| it.name.as_str()));
        format!("{} has no member `{name}`{near}", structure.name)
    })
}

fn with_article(name: &str) -> String {
    let article = if name.starts_with(['A', 'E', 'I', 'O']) { "an" } else { "a" };
    format!("{article} {name}")
}

fn element(map: &Map, place: Place, index: i64) -> Result<Place, String> {
    let Some(array) = map.array(place.ty) else {
        return Err(format!("{} has no elements", with_article(&map.type_name(place.ty))));
    };
    if !(array.low..=array.high).contains(&index) {
        return Err(format!("the index {index} is outside {}..{}", array.low, array.high));
    }
    let position = usize::try_from(index.abs_diff(array.low)).unwrap_or(usize::MAX);
    let part = place.part(array.element, position * array.stride);
    // A subrange holds for the elements of an array too.
    Ok(Place { range: place.range, ..part })
}

/// `%IW10`, and `%IW10.n` or `%IW10[3]` in the variable there. Of several variables there, it is one that has a value.
fn by_address(map: &Map, running: &[usize], text: &str) -> Result<Place, String> {
    let (address, rest) = split_address(text);
    let path = format!("_{rest}");
    let steps = steps(&path).ok_or_else(|| format!("`{text}` is not the name of a variable"))?;
    let (mut found, mut error) = (None, None);
    for place in at_address(map, running, address) {
        match follow(map, place, &steps[1..]) {
            Ok(place) if map.structure(place.ty).is_none() && map.array(place.ty).is_none() => return Ok(place),
            Ok(place) => found = found.or(Some(place)),
            Err(text) => error = error.or(Some(text)),
        }
    }
    found.ok_or_else(|| error.unwrap_or_else(|| format!("no variable has the address `{address}`")))
}

/// An address, and the way from it to a member or an element.
fn split_address(text: &str) -> (&str, &str) {
    let starts_way = |(at, character): &(usize, char)| match character {
        '[' => true,
        '.' => !text[at + 1..].trim_start().starts_with(|it: char| it.is_ascii_digit()),
        _ => false,
    };
    let end = text.char_indices().find(starts_way).map_or(text.len(), |it| it.0);
    (text[..end].trim_end(), &text[end..])
}

/// The variables at an address: a program's own come first.
fn at_address(map: &Map, running: &[usize], address: &str) -> Vec<Place> {
    let wanted = canonical(address);
    let has = |it: &&Variable| it.address.as_deref().is_some_and(|it| canonical(it) == wanted);
    let (globals, base) = map.globals();
    let own = running.iter().flat_map(|at| &map.instances[*at].variables).filter(has).map(|it| Place::of(it, 0));
    let global = globals.iter().filter(has).map(|it| Place::of(it, base));
    own.chain(global).chain(inside_blocks(map, running, &wanted)).collect()
}

/// What the world writes for a variable: a VAR_CONFIG has its value copied from an address before each scan.
pub(crate) fn written(map: &Map, running: &[usize], place: Place) -> Place {
    let from = |(ty, offset, address): &(Type, usize, String)| {
        let whole = Place { offset: *offset, ty: *ty, range: None, constant: false, input: false, is_shared: false };
        let way = way_between(map, whole, place)?;
        by_address(map, running, &format!("{address}{way}")).ok()
    };
    map.bound.iter().find_map(from).unwrap_or(place)
}

/// The way from a variable to a part of it.
fn way_between(map: &Map, whole: Place, part: Place) -> Option<String> {
    if (whole.offset, whole.ty) == (part.offset, part.ty) {
        return Some(String::new());
    }
    let inside = part.offset.checked_sub(whole.offset).filter(|it| *it < map.size_of(whole.ty))?;
    if let Some(array) = map.array(whole.ty) {
        let position = inside.checked_div(array.stride)?;
        let way = way_between(map, whole.part(array.element, position * array.stride), part)?;
        let index = array.low.checked_add_unsigned(u64::try_from(position).ok()?)?;
        return Some(format!("[{index}]{way}"));
    }
    map.structure(whole.ty)?.members.iter().find_map(|it| {
        let way = way_between(map, whole.member(it), part)?;
        Some(format!(".{}{way}", it.name))
    })
}

/// An address inside a function block instance.
fn inside_blocks(map: &Map, running: &[usize], wanted: &str) -> Option<Place> {
    let variables = running.iter().flat_map(|at| &map.instances[*at].variables);
    variables.map(|it| Place::of(it, 0)).find_map(|it| find_address(map, it, wanted))
}

fn find_address(map: &Map, place: Place, wanted: &str) -> Option<Place> {
    map.structure(place.ty)?.members.iter().find_map(|it| {
        let inner = place.member(it);
        match it.address.as_deref().map(canonical) {
            Some(address) if address == wanted => Some(Place { input: it.is_input(), ..inner }),
            _ => find_address(map, inner, wanted),
        }
    })
}

/// `%i0.0` and `%IX0.0` are one address.
fn canonical(address: &str) -> String {
    let upper = address.to_ascii_uppercase();
    match upper.as_bytes().get(2) {
        Some(b'0'..=b'9') => format!("{}X{}", &upper[..2], &upper[2..]),
        _ => upper,
    }
}

fn unknown(map: &Map, running: &[usize], name: &str) -> String {
    let own = running.iter().flat_map(|at| &map.instances[*at].variables);
    let globals = map.globals().0.iter();
    let scopes = map.instances.iter().flat_map(|it| [it.name.as_str(), it.program.as_str()]);
    let names = own.chain(globals).filter(|it| it.section != Section::Temp).map(|it| it.name.as_str());
    format!("there is no variable `{name}`{}", nearest(name, names.chain(scopes)))
}

/// `; did you mean …?` for the name that is most like `wanted`, or nothing.
pub fn nearest<'n>(wanted: &str, names: impl Iterator<Item = &'n str>) -> String {
    // A name may come out of a file; nobody means one that is so long.
    if wanted.len() > 256 {
        return String::new();
    }
    let wanted = wanted.to_lowercase();
    let limit = wanted.chars().count() / 3 + 1;
    let ranked = names.map(|name| (distance(&wanted, &name.to_lowercase()), name));
    match ranked.min_by_key(|(distance, _)| *distance) {
        Some((distance, name)) if distance <= limit => format!("; did you mean `{name}`?"),
        _ => String::new(),
    }
}

/// Insertions, deletions and replacements from `a` to `b`.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{map, offset_of};

    fn find(text: &str) -> Result<Place, String> {
        resolve(&map(), &[0], text)
    }

    #[test]
    fn a_path_starts_at_the_program_its_instance_or_a_global() {
        let cv = find("c.CV").unwrap();
        assert_eq!(cv.offset, offset_of("c.CV"));
        for text in ["C.cv", "main.c.CV", "Garage.c.CV", " garage . c . cv "] {
            assert_eq!(find(text).unwrap(), cv, "{text}");
        }
        assert_eq!(find("total").unwrap(), find("Globals.total").unwrap());
        assert_eq!(find("%IX0.0").unwrap(), find("up").unwrap());
        assert_eq!(find("%i0.0").unwrap(), find("up").unwrap());
    }

    #[test]
    fn elements_of_arrays_are_counted_from_their_bounds() {
        assert_eq!(find("m[1,2]").unwrap(), find("m[1][2]").unwrap());
        assert_eq!(find("m[1, -1]").unwrap().offset, find("m").unwrap().offset);
        assert_eq!(find("m[2,2]").unwrap().offset, find("m").unwrap().offset + 7 * 2);
        assert_eq!(find("m[3,0]").unwrap_err(), "the index 3 is outside 1..2");
    }

    #[test]
    fn a_wrong_name_gets_a_near_one() {
        assert_eq!(find("c.CW").unwrap_err(), "CTU has no member `CW`; did you mean `CU`?");
        assert_eq!(find("Upp").unwrap_err(), "there is no variable `Upp`; did you mean `up`?");
        assert_eq!(find("main.sped").unwrap_err(), "PROGRAM `Garage` has no variable `sped`; did you mean `speed`?");
        assert_eq!(find("up.x").unwrap_err(), "a BOOL has no member `x`");
        assert_eq!(find("a..b").unwrap_err(), "`a..b` is not the name of a variable");
        assert_eq!(find("%QX7.7").unwrap_err(), "no variable has the address `%QX7.7`");
    }
}
