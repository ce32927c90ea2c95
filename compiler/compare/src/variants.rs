//! What the vendors' documents leave open about what a program uses: each answer is a program of its own, and no
//! verdict rests on one of them alone.

use crate::pair::{Pair, Side};
use staunch_frontend::{OPEN_OPTIONS, OpenOption, Options, Question};

/// Options of one program that are tried in all combinations; further ones keep their setting.
const MAX_OPTIONS: usize = 3;

/// An answer to each question that the program raises.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variant {
    settings: Vec<(usize, bool)>,
}

impl Variant {
    /// As the project answers.
    pub fn own(pair: &Pair, answer: impl Fn(Question) -> Result<bool, String>) -> Result<Self, String> {
        let matters = |row: &OpenOption| {
            let blocks = |it: &Side| it.scalars.blocks.iter().map(|it| it.block).collect::<Vec<_>>();
            pair.sides.iter().any(|it| row.matters(it.dialect, blocks(it), &it.program.uses))
        };
        let used = OPEN_OPTIONS.iter().enumerate().filter(|(_, row)| matters(row));
        let settings = used.take(MAX_OPTIONS).map(|(at, row)| Ok((at, answer(row.asks)?)));
        Ok(Self { settings: settings.collect::<Result<_, String>>()? })
    }

    /// The other combinations.
    pub fn others(&self) -> Vec<Self> {
        let flipped = |mask: usize| {
            let setting = |(bit, (at, is_on)): (usize, &(usize, bool))| (*at, *is_on != (mask >> bit & 1 == 1));
            Self { settings: self.settings.iter().enumerate().map(setting).collect() }
        };
        (1..1 << self.settings.len()).map(flipped).collect()
    }

    /// These answers, and what else was set.
    pub fn applied(&self, options: Options) -> Options {
        self.settings.iter().fold(options, |options, (at, is_on)| options.with(OPEN_OPTIONS[*at].asks, *is_on))
    }

    /// Whether all of them are decided, by their names.
    pub fn is_decided(&self, is_decided: impl Fn(&str) -> bool) -> bool {
        self.rows().all(|it| is_decided(it.0.name))
    }

    fn rows(&self) -> impl Iterator<Item = (&'static OpenOption, bool)> {
        self.settings.iter().map(|(at, is_on)| (&OPEN_OPTIONS[*at], *is_on))
    }

    /// As lines of `staunch.toml`, for a sentence.
    pub fn words(&self) -> String {
        let lines: Vec<String> = self.rows().map(|(row, is_on)| format!("`{}`", row.line(is_on))).collect();
        lines.join(" and ")
    }

    pub fn questions(&self) -> Vec<&'static str> {
        self.rows().map(|it| it.0.question).collect()
    }

    /// As an object of JSON.
    pub fn object(&self) -> String {
        let quoted = staunch_host::json_text;
        let pair = |(row, is_on): (&OpenOption, bool)| {
            let setting = row.settings[usize::from(is_on)];
            let plain = matches!(setting, "false" | "true");
            format!("{}:{}", quoted(row.name), if plain { setting.to_owned() } else { quoted(setting) })
        };
        format!("{{{}}}", self.rows().map(pair).collect::<Vec<_>>().join(","))
    }
}
