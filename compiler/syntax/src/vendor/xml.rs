//! XML, an element after the other, with the places of all that is in it. Entities that a document declares
//! are not known: none is expanded, and what uses one is an error.

mod well_formed;

use super::assembly::{Chunk, Says};
use core::ops::Range;
use quick_xml::events::{BytesStart, Event};

/// No program has elements that are nested deeper.
const DEEPEST: usize = 1000;

/// What comes next.
#[derive(Debug)]
pub enum Part<'t> {
    Open(Element<'t>),
    Close,
    Text(Chunk),
}

#[derive(Clone, Debug)]
pub struct Element<'t> {
    /// Without a prefix.
    pub name: &'t str,
    /// The tag.
    pub place: Range<usize>,
}

/// Where and why reading ends before the file does.
#[derive(Debug)]
pub struct Broken {
    pub place: Range<usize>,
    pub why: String,
}

pub struct Reader<'t> {
    text: &'t str,
    inner: quick_xml::Reader<&'t [u8]>,
    /// The tags of the elements that are open.
    open: Vec<Range<usize>>,
    /// An element without content was opened, and is to be closed.
    is_empty: bool,
    /// The root was opened.
    has_root: bool,
    /// What is wrong with the root's tag: its name still shows what kind of file it is.
    wrong_root: Option<Broken>,
    last: Range<usize>,
}

impl<'t> Reader<'t> {
    /// Reads a text that begins as XML does.
    pub fn new(text: &'t str) -> Option<Self> {
        let rest = text.trim_start().strip_prefix('<')?;
        let begins = rest.starts_with(|it: char| it == '?' || it == '!' || it.is_ascii_alphabetic());
        let mut inner = quick_xml::Reader::from_str(text);
        inner.config_mut().check_comments = true;
        begins.then(|| Self {
            text,
            inner,
            open: Vec::new(),
            is_empty: false,
            has_root: false,
            wrong_root: None,
            last: 0..0,
        })
    }

    /// The first element.
    pub fn root(&mut self) -> Result<Option<Element<'t>>, Broken> {
        while let Some(part) = self.part()? {
            match part {
                Part::Open(element) => return Ok(Some(element)),
                Part::Close | Part::Text(_) => {}
            }
        }
        Ok(None)
    }

    /// What comes next; `None` at the end of the file.
    pub fn part(&mut self) -> Result<Option<Part<'t>>, Broken> {
        if let Some(broken) = self.wrong_root.take() {
            return Err(broken);
        }
        if std::mem::take(&mut self.is_empty) {
            self.open.pop();
            return Ok(Some(Part::Close));
        }
        loop {
            let start = self.position();
            let event = self.inner.read_event().map_err(|error| self.broken(&error.to_string()))?;
            let place = start..self.position();
            self.last = place.clone();
            self.check_outside(&event, &place)?;
            match event {
                Event::Start(tag) => return self.open(&tag, place).map(Some),
                Event::Empty(tag) => {
                    self.is_empty = true;
                    return self.open(&tag, place).map(Some);
                }
                Event::End(_) => {
                    self.open.pop();
                    return Ok(Some(Part::Close));
                }
                Event::Text(_) => {
                    well_formed::text(self.text, &place)?;
                    return Ok(Some(Part::Text(Chunk::verbatim(place))));
                }
                Event::CData(_) => {
                    let place = place.start + "<![CDATA[".len()..place.end - "]]>".len();
                    return Ok(Some(Part::Text(Chunk::verbatim(place))));
                }
                Event::GeneralRef(name) => return self.symbol(&name, place).map(Some),
                Event::Eof => {
                    return match self.open.pop() {
                        Some(place) => Err(Broken { place, why: "this element is not closed".to_owned() }),
                        None => Ok(None),
                    };
                }
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
            }
        }
    }

    /// The tag that was read last.
    pub fn last(&self) -> Range<usize> {
        self.last.clone()
    }

    /// Passes over the rest of an element that was opened.
    pub fn skip(&mut self) -> Result<(), Broken> {
        let mut open = 1;
        while open > 0 {
            match self.part()? {
                Some(Part::Open(_)) => open += 1,
                Some(Part::Close) => open -= 1,
                Some(Part::Text(_)) => {}
                None => return Ok(()),
            }
        }
        Ok(())
    }

    /// The text of an element that was opened, to its end; what other elements hold is left out, but for what
    /// `inner` names.
    pub fn content(&mut self, inner: &str) -> Result<Vec<Chunk>, Broken> {
        let mut chunks = Vec::new();
        loop {
            match self.part()? {
                Some(Part::Text(chunk)) => chunks.push(chunk),
                Some(Part::Open(element)) if element.name == inner => chunks.extend(self.content("")?),
                Some(Part::Open(_)) => self.skip()?,
                Some(Part::Close) | None => return Ok(chunks),
            }
        }
    }

    /// Whether a text is the content of a CDATA section.
    pub fn is_cdata(&self, place: &Range<usize>) -> bool {
        self.text[..place.start].ends_with("<![CDATA[") && self.text[place.end..].starts_with("]]>")
    }

    fn open(&mut self, tag: &BytesStart<'t>, place: Range<usize>) -> Result<Part<'t>, Broken> {
        self.open.push(place.clone());
        if self.open.len() > DEEPEST {
            return Err(Broken { place, why: format!("elements are nested more than {DEEPEST} deep") });
        }
        match well_formed::tag(self.text, &place).map_err(Broken::from) {
            Err(broken) if self.open.len() == 1 => self.wrong_root = Some(broken),
            checked => checked?,
        }
        let tag_text = &self.text[place.clone()];
        let length = tag.name().as_ref().len();
        let name = &tag_text[1..=length];
        let name = name.rsplit_once(':').map_or(name, |it| it.1);
        Ok(Part::Open(Element { name, place }))
    }

    /// Outside of the one root are comments, instructions and space.
    fn check_outside(&mut self, event: &Event<'t>, place: &Range<usize>) -> Result<(), Broken> {
        if !self.open.is_empty() {
            return Ok(());
        }
        let broken = |why: &str| Err(Broken { place: place.clone(), why: why.to_owned() });
        match event {
            Event::Start(_) | Event::Empty(_) if self.has_root => broken("a second root element"),
            Event::Start(_) | Event::Empty(_) => {
                self.has_root = true;
                Ok(())
            }
            Event::Text(text) if text.trim_matches([' ', '\t', '\r', '\n', '\u{feff}']).is_empty() => Ok(()),
            Event::Text(_) | Event::CData(_) | Event::GeneralRef(_) => broken("text outside the root element"),
            Event::End(_) | Event::Eof | Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {
                Ok(())
            }
        }
    }

    fn position(&self) -> usize {
        usize::try_from(self.inner.buffer_position()).unwrap_or(usize::MAX).min(self.text.len())
    }

    fn broken(&self, why: &str) -> Broken {
        let at = usize::try_from(self.inner.error_position()).unwrap_or(usize::MAX).min(self.text.len());
        well_formed::end(self.text, at, why).into()
    }

    fn symbol(&self, name: &str, place: Range<usize>) -> Result<Part<'t>, Broken> {
        match well_formed::character(name) {
            Some(symbol) => Ok(Part::Text(Chunk { place, says: Says::Symbol(symbol) })),
            None => Err(well_formed::unknown(self.text, place).into()),
        }
    }
}

impl From<(Range<usize>, String)> for Broken {
    fn from((place, why): (Range<usize>, String)) -> Self {
        Self { place, why }
    }
}

impl<'t> Element<'t> {
    /// The value of an attribute as it is written.
    pub fn attribute(&self, file: &'t str, name: &str) -> Option<&'t str> {
        self.attribute_place(file, name).map(|it| &file[it])
    }

    /// Where the value of an attribute is.
    pub fn attribute_place(&self, file: &'t str, name: &str) -> Option<Range<usize>> {
        let tag = &file[self.place.clone()];
        let tag = tag.strip_prefix('<')?.trim_end_matches('>').trim_end_matches('/');
        let mut attributes = quick_xml::events::attributes::Attributes::new(tag, tag.find(char::is_whitespace)?);
        // The check for duplicates would take time quadratic in their number.
        attributes.with_checks(false);
        let found = attributes.flatten().find(|it| it.key.local_name().as_ref() == name)?;
        // What is borrowed is a part of the file.
        let start = found.value.as_ptr().addr().checked_sub(file.as_ptr().addr())?;
        let place = start..start + found.value.len();
        file.get(place.clone()).filter(|it| **it == *found.value).map(|_| place)
    }

    /// The text that the value of an attribute stands for.
    pub fn attribute_text(&self, file: &'t str, name: &str) -> Option<Chunk> {
        let place = self.attribute_place(file, name)?;
        match quick_xml::escape::unescape(&file[place.clone()]) {
            Ok(std::borrow::Cow::Owned(text)) => Some(Chunk::words(text, &place)),
            Ok(std::borrow::Cow::Borrowed(_)) | Err(_) => Some(Chunk::verbatim(place)),
        }
    }
}
