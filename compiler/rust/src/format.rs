//! From printed tokens to a file that reads well and that rustfmt leaves as it is: source marks become comments,
//! items get air, and what rustfmt would break at other places is marked to be skipped.

use proc_macro2::TokenStream;

/// A statement that stands for a comment: the printer of syntax trees has none.
const MARK: &str = "st_mark!(\"";

/// A statement that makes a strip of the loop around it: `format` puts the macro around that.
const STRIPS: &str = "st_strips!(";

/// rustfmt breaks calls, chains of calls and arrays that are wider.
const SMALL: usize = 60;

/// The same for the parts of a structure's value.
const SMALL_STRUCTURE: usize = 18;

/// The widest line.
const WIDE: usize = 100;

/// Formats items.
///
/// # Panics
/// If they are not Rust, which would be a bug in this crate.
pub fn format(items: TokenStream) -> String {
    finish(&print(items))
}

/// The first half of [`format`]: the text of items, to which that of others can be appended. Their tokens and syntax trees are large: a
/// program is printed in pieces.
pub fn print(items: TokenStream) -> String {
    prettyplease::unparse(&syn::parse2(items).expect("the emitted items are Rust"))
}

/// The second half, for all items of a file together.
pub fn finish(printed: &str) -> String {
    let mut lines = Vec::new();
    for line in hug(&heads(&fill(printed))).lines() {
        expand(line.to_owned(), &mut lines);
    }
    skip(&space(&strips(&comment(&lines.join("\n")))))
}

/// Each mark becomes a comment: at the end of its statement, or first in the block that the statement opens.
fn comment(text: &str) -> String {
    let mut commented = String::with_capacity(text.len());
    let mut pending: Option<(&str, usize)> = None;
    for line in text.lines() {
        let content = line.trim_start();
        if let Some(mark) = content.strip_prefix(MARK) {
            pending = Some((mark.trim_end_matches("\");"), line.len() - content.len()));
            continue;
        }
        commented.push_str(line);
        // The block has ended without another statement.
        pending = pending.filter(|it| content.is_empty() || line.len() - content.len() >= it.1);
        if let Some((mark, indent)) = pending
            && line.len() - content.len() == indent
        {
            if opens_block(content) {
                commented.push_str(&format!("\n{:indent$}    // {mark}", ""));
                pending = None;
            } else if content.ends_with([';', '}']) {
                commented.push_str(&format!(" // {mark}"));
                pending = None;
            }
        }
        commented.push('\n');
    }
    commented
}

/// Puts the macro around each loop that has the mark. rustfmt leaves its contents, since they are not a list of expressions.
fn strips(text: &str) -> String {
    if !text.contains(STRIPS) {
        return text.to_owned();
    }
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let marks: Vec<usize> = (0..lines.len()).filter(|at| lines[*at].trim_start().starts_with(STRIPS)).collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    for &mark in marks.iter().rev() {
        let arguments = lines[mark].trim_start().trim_start_matches(STRIPS).trim_end_matches(");").to_owned();
        let outer = indent(&lines[mark]) - 4;
        let starts = |it: &String| indent(it) == outer && (it.contains("loop {") || it.contains("while ("));
        let ends = |it: &String| indent(it) == outer && it.trim_start() == "}";
        let start = lines[..mark].iter().rposition(starts).expect("the mark is in a loop");
        let end = mark + lines[mark..].iter().position(ends).expect("the loop ends");
        lines[end].push_str(");");
        let head = lines[start].split_off(outer);
        lines[start].push_str(&format!("strips!({arguments}; {head}"));
        lines.remove(mark);
    }
    lines.join("\n") + "\n"
}

/// Whether the line is the end of the head of an IF, a loop or a `match`.
fn opens_block(line: &str) -> bool {
    line.ends_with('{')
}

/// Imports take the lines that they need.
fn fill(text: &str) -> String {
    let Some((before, rest)) = text.split_once("::{\n") else { return text.to_owned() };
    let Some((names, after)) = rest.split_once("};\n").filter(|_| before.lines().last().is_some_and(is_import)) else {
        return text.to_owned();
    };
    let names: Vec<&str> = names.split([',', '\n', ' ']).filter(|it| !it.is_empty()).collect();
    let start = before.lines().last().unwrap_or_default();
    let whole = names.join(", ");
    // rustfmt leaves the last column of an import empty.
    if start.len() + whole.len() + "::{};".len() < WIDE {
        return format!("{before}::{{{whole}}};\n{after}");
    }
    let mut lines = vec![String::new()];
    for name in names {
        match lines.last_mut() {
            Some(last) if last.len() + name.len() + "     ,".len() <= WIDE => last.push_str(&format!(" {name},")),
            Some(_) | None => lines.push(format!(" {name},")),
        }
    }
    format!("{before}::{{\n   {}\n}};\n{after}", lines.join("\n   "))
}

fn is_import(line: &str) -> bool {
    line.starts_with("use ")
}

/// Gives the head of a function one line, where it fits: rustfmt's lines are wider than the printer's.
fn heads(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut joined = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(line) = lines.get(at) {
        let head = &lines[at..at + head_length(&lines[at..])];
        let whole = match head {
            [first, parameters @ .., last] => {
                let parameters: Vec<_> = parameters.iter().map(|it| it.trim_start()).collect();
                format!("{first}{}{}", parameters.join(" ").trim_end_matches(','), last.trim_start())
            }
            [] | [_] => (*line).to_owned(),
        };
        if whole.len() <= WIDE {
            joined.push_str(&format!("{whole}\n"));
        } else {
            let broken = head.join("\n");
            let indent = line.len() - line.trim_start().len();
            match broken.strip_suffix(") {}").filter(|_| head.len() > 1) {
                // A body without statements ends on a line of its own then.
                Some(open) => joined.push_str(&format!("{open}) {{\n{:indent$}}}\n", "")),
                None => joined.push_str(&format!("{broken}\n")),
            }
        }
        at += head.len();
    }
    joined
}

/// How many lines the head of a function has that begins here, one for each parameter; 1 where none begins.
fn head_length(lines: &[&str]) -> usize {
    let Some(first) = lines.first() else { return 0 };
    let content = first.trim_start();
    let indent = first.len() - content.len();
    let is_broken = is_item(content) && content.contains("fn ") && content.ends_with('(');
    // Only then: a search for each line would cost the square of the file's length.
    if !is_broken {
        return 1;
    }
    let ends = |it: &&str| it.len() - it.trim_start().len() == indent && it.trim_start().starts_with(')');
    lines.iter().position(ends).map_or(1, |it| it + 1)
}

/// A table of one row is opened and closed with it.
fn hug(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut hugged = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(line) = lines.get(at) {
        let opens = line.ends_with("= &[") && !line.starts_with(' ');
        let length = || lines[at..].iter().position(|it| *it == "];");
        let rows = opens.then(length).flatten().map(|length| &lines[at + 1..at + length]);
        match rows {
            Some([first, inner @ .., last]) if is_row(first, inner, last) => {
                hugged.push_str(&format!("{line}{}\n", first.trim_start()));
                for it in inner {
                    hugged.push_str(&format!("{}\n", it.strip_prefix("    ").unwrap_or(it)));
                }
                hugged.push_str("}];\n");
                at += inner.len() + 4;
            }
            Some(_) | None => {
                hugged.push_str(&format!("{line}\n"));
                at += 1;
            }
        }
    }
    hugged
}

/// Gives each part of a structure's value its line, where they are too wide for one, and the ELSE of a `let`.
fn expand(line: String, lines: &mut Vec<String>) {
    let indent = line.len() - line.trim_start().len();
    let (head, inner, end) = match structure(&line) {
        Some((head, inner, end)) if is_value(head, inner) => (head, inner, end),
        Some(_) | None => return lines.push(line),
    };
    let is_else = head.ends_with(" else");
    lines.push(format!("{head} {{"));
    for part in parts(inner) {
        let comma = if is_else {
            ";"
        } else if part.starts_with("..") {
            ""
        } else {
            ","
        };
        expand(format!("{:indent$}    {part}{comma}", ""), lines);
    }
    lines.push(format!("{:indent$}}}{end}", ""));
}

/// Whether the braces hold a structure's value that is too wide for one line, or the ELSE of a `let`.
fn is_value(head: &str, inner: &str) -> bool {
    let name = head.rsplit([' ', ':']).next().unwrap_or_default();
    let is_structure = name.starts_with(|it: char| it.is_ascii_uppercase()) && inner.len() > SMALL_STRUCTURE;
    head.ends_with(" else") && head.trim_start().starts_with("let ") || is_structure
}

/// What is before, in and after the first braces of a line that has them at its end.
fn structure(line: &str) -> Option<(&str, &str, &str)> {
    let (head, rest) = line.split_once(" { ")?;
    let (inner, end) = rest.rsplit_once(" }")?;
    matches!(end, "" | "," | ";").then_some((head, inner, end))
}

/// The parts of a list, which end with commas outside of brackets.
fn parts(list: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0_usize, 0);
    for (at, it) in list.char_indices() {
        match it {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.push(list[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(list[start..].trim());
    parts
}

/// Whether the lines are one structure in a table.
fn is_row(first: &str, inner: &[&str], last: &str) -> bool {
    first.ends_with(" {") && last == "    }," && inner.iter().all(|it| it.starts_with("        "))
}

/// Marks the functions and constants that rustfmt would lay out otherwise.
fn skip(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut marked = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(line) = lines.get(at) {
        let indent = line.len() - line.trim_start().len();
        let is_item = is_item(line.trim_start()) && indent <= 4;
        let count = if is_item { item_length(&lines[at..], indent) } else { 1 };
        let item = &lines[at..at + count];
        if is_item && !is_plain(item, indent) {
            marked.push_str(&format!("{:indent$}#[rustfmt::skip]\n", ""));
        }
        for it in item {
            marked.push_str(it);
            marked.push('\n');
        }
        at += count;
    }
    marked
}

fn is_item(line: &str) -> bool {
    let line = line.strip_prefix("pub ").unwrap_or(line);
    ["fn ", "const ", "reference::"].iter().any(|it| line.starts_with(it))
}

/// How many lines an item has that begins at this indentation.
fn item_length(lines: &[&str], indent: usize) -> usize {
    let ends = |line: &&str| {
        let content = line.trim_start();
        line.len() - content.len() == indent && content.ends_with(['}', ';'])
    };
    lines.iter().position(ends).map_or(1, |it| it + 1)
}

/// The parts of a line between spaces outside of brackets: no call, chain or array is wider than its part.
fn words(code: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0_usize;
    code.split(move |it| {
        match it {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        it == ' ' && depth == 0
    })
}

/// Whether it is certain that rustfmt leaves the lines of an item as they are.
fn is_plain(item: &[&str], indent: usize) -> bool {
    let (broken, item) = item.split_at(head_length(item).saturating_sub(1));
    let Some((head, body)) = item.split_first() else { return true };
    let is_whole = body.is_empty() && !head.replace("{}", "").contains('{');
    // Rows that are not structures may share lines.
    let is_table = head.ends_with("= &[") && body.first().is_some_and(|it| it.ends_with('{'));
    let opens = head.ends_with('{') && !head.contains("!(") || is_table;
    let head_is_plain = head.len() <= WIDE && (is_whole || opens);
    head_is_plain
        && broken.iter().all(|it| it.len() <= WIDE)
        && body.iter().all(|line| line.len() == indent + 1 || is_plain_line(line))
}

/// A statement, the head or the end of a block, a row of a table, or a comment, and none too wide.
fn is_plain_line(line: &str) -> bool {
    let content = line.trim_start();
    if content.starts_with("//") {
        return true;
    }
    let (code, mark) = content.split_once(" // ").unwrap_or((content, ""));
    let is_whole = code.is_empty() || code.ends_with([';', '{', '}', ',', ')']);
    is_whole
        && words(code).all(|it| it.len() <= SMALL)
        && line.len() - mark.len() <= WIDE
        && !code.starts_with(['.', '|', '&', '+'])
        && !starts_with_operator(code)
        && !code.contains("{} else")
        && (!has_value(code) || structure(code).is_some_and(|(_, inner, _)| inner.len() <= SMALL_STRUCTURE))
}

/// Whether a line continues an expression: `- x`, which is not a negative number in a table.
fn starts_with_operator(code: &str) -> bool {
    let (first, rest) = code.split_once(' ').unwrap_or_default();
    !first.is_empty() && !rest.is_empty() && first.chars().all(|it| "+-*/%<>=!^".contains(it))
}

/// Whether a line holds a structure's value or a block: rustfmt leaves `const { x }` where it is.
fn has_value(code: &str) -> bool {
    code.match_indices(" { ").any(|(at, _)| !code[..at].ends_with("const"))
}

/// Puts an empty line before each item and method that follows another.
fn space(text: &str) -> String {
    let mut spaced = String::with_capacity(text.len());
    let mut ended = false;
    let mut used = None;
    for line in text.lines() {
        let content = line.trim_start();
        // Two groups of one crate.
        let root = content.strip_prefix("use ").and_then(|it| it.rsplit_once("::")).map(|it| it.0);
        if root.is_some() && root == used {
            spaced.push('\n');
        }
        if !line.starts_with(' ') && content != "};" {
            used = root;
        }
        let depth = (line.len() - content.len()) / 4;
        let opens = content.starts_with("pub ")
            || content.starts_with("///")
            || content.starts_with("#[")
            || content.starts_with("fn ")
            || content.starts_with("impl ");
        if ended && opens && depth < 2 {
            spaced.push('\n');
        }
        spaced.push_str(line);
        spaced.push('\n');
        let is_comment = content.starts_with("//");
        ended = depth < 2 && !is_comment && (content == "}" || depth == 0 && content.ends_with([';', '}']));
    }
    spaced
}
