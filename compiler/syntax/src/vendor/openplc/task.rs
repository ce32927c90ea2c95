//! The resource's tasks and the instances of PROGRAMs in them, as a CONFIGURATION with one RESOURCE.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::json::{Kind, Value};
use super::object::{Object, shown};
use super::variable::unknown;

pub fn configuration(file: &str, resource: &Object<'_>, out: &mut Assembly) {
    let place = resource.start();
    let instances = resource.list("instances", out);
    let instances: Vec<_> = instances.iter().filter_map(|it| Object::required(file, it, "an instance", out)).collect();
    let tasks = resource.list("tasks", out);
    let tasks: Vec<_> = tasks.iter().filter_map(|it| Object::required(file, it, "a task", out)).collect();
    if instances.is_empty() {
        return;
    }
    let mut chunks = vec![Chunk::words("CONFIGURATION Config0\nRESOURCE Res0 ON PLC\n", &place)];
    for it in &tasks {
        let name = it.get("name").map(|it| it.raw(file));
        // A task that runs nothing is of no consequence, whatever starts it.
        let is_used = instances.iter().any(|it| it.get("task").map(|it| it.raw(file)) == name);
        chunks.extend(task(it, is_used, out).unwrap_or_default());
    }
    for it in &instances {
        chunks.extend(instance(it, out).unwrap_or_default());
    }
    chunks.push(Chunk::words("END_RESOURCE\nEND_CONFIGURATION\n", &place));
    out.copy(file, &chunks);
}

/// `TASK Fast(INTERVAL := T#20ms, PRIORITY := 1);`
fn task(object: &Object<'_>, is_used: bool, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let file = object.file;
    let name = object.name("name", "a task", out)?;
    let mut chunks = vec![Chunk::words("TASK ", &name.place)];
    chunks.extend(name.chunks(file));
    chunks.push(Chunk::words("(", &name.place));
    let triggering = object.word("triggering", out).unwrap_or("Cyclic");
    if triggering.eq_ignore_ascii_case("interrupt") {
        if is_used {
            let place = object.get("triggering").map_or(object.start(), |it| it.place.clone());
            let message = format!("the task `{}` is started by an interrupt, which is not supported", name.raw(file));
            out.problem(Trouble::NotSupported, message, &place);
            out.help("give its instances to a cyclic task");
        }
    } else if triggering.eq_ignore_ascii_case("cyclic") {
        chunks.extend(interval(object, out)?);
    } else {
        return unknown(object, "triggering", triggering, out);
    }
    chunks.extend(priority(object, out)?);
    chunks.push(Chunk::words(");\n", &name.place));
    Some(chunks)
}

/// `INTERVAL := T#20ms, `
fn interval(object: &Object<'_>, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let Some(value) = object.text("interval", out) else {
        out.problem(Trouble::Odd, "this cyclic task has no `interval`".to_owned(), &object.start());
        return None;
    };
    let text = value.raw(object.file);
    let is_it = text.contains('#') && text.chars().all(|it| it.is_ascii_alphanumeric() || "#._".contains(it));
    if !is_it {
        let message = format!("`{}` is not an interval", shown(&value.text(object.file)));
        out.problem(Trouble::Odd, message, &value.place);
        out.help("write it as `T#20ms`");
        return None;
    }
    let mut chunks = vec![Chunk::words("INTERVAL := ", &value.place)];
    chunks.extend(value.chunks(object.file));
    chunks.push(Chunk::words(", ", &value.place));
    Some(chunks)
}

/// `PRIORITY := 1`
fn priority(object: &Object<'_>, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let Some(value) = object.get("priority") else { return Some(vec![Chunk::words("PRIORITY := 0", object.place)]) };
    let text = value.raw(object.file);
    let is_number = matches!(value.kind, Kind::Number) && text.bytes().all(|it| it.is_ascii_digit());
    if !is_number {
        out.problem(Trouble::Odd, "a priority is a whole number, 0 or more".to_owned(), &value.place);
        return None;
    }
    Some(vec![Chunk::words("PRIORITY := ", &value.place), Chunk::verbatim(value.place.clone())])
}

/// `PROGRAM instance0 WITH task0 : main;`
fn instance(object: &Object<'_>, out: &mut Assembly) -> Option<Vec<Chunk>> {
    let file = object.file;
    let name = object.name("name", "an instance", out)?;
    let program = object.name("program", "an instance", out)?;
    let task: Option<&Value> = match object.text("task", out) {
        Some(_) => Some(object.name("task", "an instance", out)?),
        None => None,
    };
    let mut chunks = vec![Chunk::words("PROGRAM ", &name.place)];
    chunks.extend(name.chunks(file));
    if let Some(task) = task {
        chunks.push(Chunk::words(" WITH ", &task.place));
        chunks.extend(task.chunks(file));
    }
    chunks.push(Chunk::words(" : ", &program.place));
    chunks.extend(program.chunks(file));
    chunks.push(Chunk::words(";\n", &program.place));
    Some(chunks)
}
