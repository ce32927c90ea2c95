//! What a member of an object has to be: anything else is reported, and passed over.

use super::super::assembly::{Assembly, Chunk, Trouble};
use super::super::json::{Kind, Member, Value};
use core::ops::Range;

#[derive(Clone, Copy)]
pub struct Object<'t> {
    pub file: &'t str,
    pub place: &'t Range<usize>,
    pub members: &'t [Member],
}

impl<'t> Object<'t> {
    /// A value that has to be an object: `what` is what it stands for, with its article.
    pub fn required(file: &'t str, value: &'t Value, what: &str, out: &mut Assembly) -> Option<Self> {
        if let Kind::Object(members) = &value.kind {
            return Some(Self { file, place: &value.place, members });
        }
        let message = format!("{what} of OpenPLC Editor must be an object, not {}", value.what());
        out.problem(Trouble::Odd, message, &first(&value.place));
        None
    }

    /// A member that is given.
    pub fn get(&self, name: &str) -> Option<&'t Value> {
        let member = self.members.iter().find(|it| it.name.raw(self.file) == name)?;
        (member.value.kind != Kind::Null).then_some(&member.value)
    }

    /// An object that has to be there.
    pub fn needed(&self, name: &str, what: &str, out: &mut Assembly) -> Option<Self> {
        if self.get(name).is_none() {
            out.problem(Trouble::Odd, format!("`{name}` is missing: {what} of OpenPLC Editor has it"), &self.start());
        }
        self.object(name, out)
    }

    pub fn object(&self, name: &str, out: &mut Assembly) -> Option<Self> {
        let value = self.get(name)?;
        if let Kind::Object(members) = &value.kind {
            return Some(Self { file: self.file, place: &value.place, members });
        }
        wrong(name, value, "an object", out);
        None
    }

    pub fn list(&self, name: &str, out: &mut Assembly) -> &'t [Value] {
        match self.get(name) {
            None => &[],
            Some(Value { kind: Kind::List(values), .. }) => values,
            Some(value) => {
                wrong(name, value, "a list", out);
                &[]
            }
        }
    }

    /// A text that is not empty.
    pub fn text(&self, name: &str, out: &mut Assembly) -> Option<&'t Value> {
        let value = self.get(name)?;
        if value.kind != Kind::Text {
            wrong(name, value, "a string", out);
            return None;
        }
        (!value.text(self.file).trim().is_empty()).then_some(value)
    }

    /// A text that decides what the object is.
    pub fn word(&self, name: &str, out: &mut Assembly) -> Option<&'t str> {
        self.text(name, out).map(|it| it.raw(self.file))
    }

    /// The name of what the object declares. It is reported where it is missing, or cannot be a name.
    pub fn name(&self, name: &str, what: &str, out: &mut Assembly) -> Option<&'t Value> {
        if self.get(name).is_none() {
            out.problem(Trouble::Odd, format!("{what} has no `{name}`"), &first(self.place));
            return None;
        }
        let value = self.text(name, out);
        if value.is_none() && self.get(name).is_some_and(|it| it.kind == Kind::Text) {
            let place = self.get(name).map_or(first(self.place), |it| it.place.clone());
            out.problem(Trouble::Odd, format!("{what} has an empty `{name}`"), &place);
        }
        value.filter(|it| is_name(self.file, it, out))
    }

    /// The bracket that opens it.
    pub fn start(&self) -> Range<usize> {
        first(self.place)
    }
}

/// Messages point at one character of what may extend over many lines.
fn first(place: &Range<usize>) -> Range<usize> {
    place.start..place.end.min(place.start + 1)
}

fn wrong(name: &str, value: &Value, expected: &str, out: &mut Assembly) {
    let message = format!("`{name}` is {} here, but must be {expected} in files of OpenPLC Editor", value.what());
    out.problem(Trouble::Odd, message, &first(&value.place));
}

/// Whether a text is a name in Structured Text, which is reported if not.
pub fn is_name(file: &str, value: &Value, out: &mut Assembly) -> bool {
    let text = value.raw(file);
    let is_it = text.starts_with(|it: char| it.is_alphabetic() || it == '_')
        && text.chars().all(|it| it.is_alphanumeric() || it == '_');
    if !is_it {
        out.problem(Trouble::Odd, format!("`{}` is not a name", shown(&value.text(file))), &value.place);
    }
    is_it
}

/// The beginning of a text, on one line, for a message.
pub fn shown(text: &str) -> String {
    let line: String = text.chars().map(|it| if it.is_control() { ' ' } else { it }).take(40).collect();
    if text.chars().count() > 40 { format!("{line}…") } else { line }
}

/// A comment that documents what is before it. What opens or closes a comment in it does so no more.
pub fn comment(object: &Object<'_>, out: &mut Assembly) -> Option<Chunk> {
    let value = object.text("documentation", out)?;
    let text = value.text(object.file).replace("*)", "* )").replace("(*", "( *");
    let words: Vec<&str> = text.split_whitespace().collect();
    Some(Chunk::words(format!(" (* {} *)", words.join(" ")), &value.place))
}
