//! Makes a program smaller for as long as it shows what it is kept for.

/// Programs that are tried.
const TRIES: usize = 4000;

/// A way to make a program smaller.
enum Edit {
    /// Leaves out these lines.
    Without(Vec<usize>),
    /// Writes a line in another way.
    With(usize, String),
}

/// The least program found for which `keeps` still holds.
pub fn shrink(text: &str, keeps: &dyn Fn(&str) -> bool) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut tries = 0;
    loop {
        let before = lines.len();
        let mut smaller = false;
        for edits in [without_ranges, without_frames, with_parts] {
            let mut found = edits(&lines);
            let mut at = 0;
            while let Some(edit) = found.get(at) {
                tries += 1;
                if tries > TRIES {
                    return joined(&lines);
                }
                let candidate = applied(&lines, edit);
                if keeps(&joined(&candidate)) {
                    // Its own edits continue at the same place.
                    lines = candidate;
                    found = edits(&lines);
                    smaller = true;
                } else {
                    at += 1;
                }
            }
        }
        if !smaller && lines.len() == before {
            return joined(&lines);
        }
    }
}

fn applied(lines: &[String], edit: &Edit) -> Vec<String> {
    match edit {
        Edit::Without(numbers) => {
            let kept = lines.iter().enumerate().filter(|(at, _)| !numbers.contains(at));
            kept.map(|it| it.1.clone()).collect()
        }
        Edit::With(number, line) => {
            let mut lines = lines.to_vec();
            lines[*number].clone_from(line);
            lines
        }
    }
}

fn joined(lines: &[String]) -> String {
    lines.join("\n") + "\n"
}

/// Lines that follow each other, many first.
fn without_ranges(lines: &[String]) -> Vec<Edit> {
    let mut found = Vec::new();
    let mut size = lines.len() / 2;
    while size > 0 {
        let starts = (0..lines.len()).step_by(size);
        found.extend(starts.map(|start| Edit::Without((start..lines.len().min(start + size)).collect())));
        size /= 2;
    }
    found
}

/// A statement or declaration, with or without what is inside of it.
fn without_frames(lines: &[String]) -> Vec<Edit> {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let own = depth(line);
        let after = lines[start + 1..].iter().position(|it| depth(it) <= own && it.trim_start().starts_with("END_"));
        let Some(end) = after.map(|it| start + 1 + it).filter(|it| depth(&lines[*it]) == own) else { continue };
        found.push(Edit::Without((start..=end).collect()));
        let frame = (start..=end).filter(|at| depth(&lines[*at]) <= own);
        found.push(Edit::Without(frame.collect()));
    }
    found
}

/// A part of a parenthesis in the place of the whole.
fn with_parts(lines: &[String]) -> Vec<Edit> {
    let shorter = lines.iter().enumerate().map(|(at, line)| (at, shorter(line)));
    shorter.flat_map(|(at, all)| all.into_iter().map(move |it| Edit::With(at, it))).collect()
}

fn shorter(line: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (open, _) in line.match_indices('(') {
        let Some(close) = closing(line, open) else { continue };
        let name = line[..open].rfind(|it: char| !it.is_alphanumeric() && !"_#.".contains(it)).map_or(0, |it| it + 1);
        let parts = parts(&line[open + 1..close]);
        for part in &parts {
            found.push(format!("{}{part}{}", &line[..name], &line[close + 1..]));
        }
        for (at, part) in parts.iter().enumerate() {
            // Without one of the arguments.
            let others: Vec<_> = parts.iter().enumerate().filter(|it| it.0 != at).map(|it| it.1.as_str()).collect();
            found.push(format!("{}{}{}", &line[..open + 1], others.join(", "), &line[close..]));
            for simple in ["0", "1", "FALSE", "TRUE", "''"] {
                if part.len() > 5 && !part.contains(":=") {
                    found.push(format!("{}{simple}{}", &line[..name], &line[close + 1..]));
                }
            }
        }
    }
    if let Some((target, value)) = line.split_once(" := ").filter(|it| !it.0.contains('(') && it.1.len() > 6)
        && value.ends_with(';')
    {
        found.extend(["0;", "1;", "TRUE;", "FALSE;"].map(|it| format!("{target} := {it}")));
    }
    found
}

fn closing(line: &str, open: usize) -> Option<usize> {
    let mut depth = 0;
    for (at, character) in line.char_indices().skip_while(|it| it.0 < open) {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// The operands, or the arguments without their names.
fn parts(inside: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut depth = 0;
    for character in inside.chars() {
        match character {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' | ' ' if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().expect("there is a first part").push(character);
    }
    parts.retain(|it| it.chars().any(char::is_alphanumeric));
    parts
}
