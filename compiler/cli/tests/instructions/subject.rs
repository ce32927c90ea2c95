//! The programs that are measured, and what their first lines say.

use crate::perf;
use std::fs;
use std::path::{Path, PathBuf};

/// A program, and how it is called.
pub struct Subject {
    pub name: String,
    pub path: PathBuf,
    pub dialect: Option<String>,
    pub scans: u32,
    /// `// in: START = s & 1`: a variable of the PROGRAM, and its value in scan `s`, in C.
    pub inputs: Vec<(String, String)>,
    /// `// out: FULL`: variables that are compared with those of the program by hand.
    pub outputs: Vec<String>,
    /// The PROGRAM, as macros of the header spell it.
    pub program: String,
    pub by_hand: Option<PathBuf>,
}

impl Subject {
    fn of_several(mut self, dialect: &str) -> Self {
        self.name = format!("{}.{dialect}", self.name);
        self
    }
}

pub fn all() -> Vec<Subject> {
    let mut paths: Vec<_> = fs::read_dir(perf().join("programs")).unwrap().map(|it| it.unwrap().path()).collect();
    paths.sort();
    paths.iter().flat_map(|it| of(it)).collect()
}

/// A program in each of the dialects that it names, else in the default one.
fn of(path: &Path) -> Vec<Subject> {
    let text = fs::read_to_string(path).unwrap();
    let named = text.lines().find_map(|line| line.strip_prefix("// dialect: ")).unwrap_or_default();
    let dialects: Vec<_> = named.split_whitespace().collect();
    match dialects.as_slice() {
        [] => vec![subject(path, &text, None)],
        [one] => vec![subject(path, &text, Some(*one))],
        several => several.iter().map(|it| subject(path, &text, Some(*it)).of_several(it)).collect(),
    }
}

fn subject(path: &Path, text: &str, dialect: Option<&str>) -> Subject {
    let heads = |key: &str| -> Vec<String> {
        let start = format!("// {key}: ");
        text.lines().filter_map(|line| line.strip_prefix(&start)).map(str::to_owned).collect()
    };
    let input =
        |line: &String| line.split_once(" = ").map(|(name, value)| (name.to_owned(), value.to_owned())).unwrap();
    let program = text.lines().filter_map(|line| line.strip_prefix("PROGRAM ")).next_back().unwrap();
    let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
    Subject {
        dialect: dialect.map(str::to_owned),
        scans: heads("scans").pop().unwrap().parse().unwrap(),
        inputs: heads("in").iter().map(input).collect(),
        outputs: heads("out").iter().flat_map(|it| it.split_whitespace()).map(str::to_owned).collect(),
        program: program.trim().to_uppercase(),
        path: path.to_owned(),
        by_hand: Some(perf().join("by_hand").join(format!("{name}.rs"))).filter(|it| it.exists()),
        name,
    }
}
