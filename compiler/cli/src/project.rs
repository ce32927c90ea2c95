//! `staunch.toml`: the settings of the command line, for the folder it lies in and those below.

use crate::args::{Color, MessageFormat};
use clap::ValueEnum;
use std::path::{Path, PathBuf};

/// What a project file says. Paths are relative to its folder.
#[derive(Clone, Debug, Default)]
pub struct Project {
    pub folder: PathBuf,
    pub dialect: Option<String>,
    pub files: Vec<PathBuf>,
    pub program: Option<String>,
    pub cycle: Option<String>,
    pub loop_budget: Option<u64>,
    pub ctu_stop_at_pv: bool,
    pub warn: Vec<String>,
    pub deny: Vec<String>,
    pub allow: Vec<String>,
    pub message_format: Option<MessageFormat>,
    pub color: Option<Color>,
    pub quiet: bool,
    pub verbose: bool,
}

/// The project file of `start` or of the nearest folder above it.
pub fn find(start: &Path) -> Result<Option<Project>, String> {
    let start = start.canonicalize().unwrap_or_else(|_| start.to_owned());
    let found = start.ancestors().map(|folder| folder.join("staunch.toml")).find(|it| it.is_file());
    found.map(|path| read(&path)).transpose()
}

fn read(path: &Path) -> Result<Project, String> {
    let fail = |what: String| format!("{}: {what}", path.display());
    let text = std::fs::read_to_string(path).map_err(|it| fail(it.to_string()))?;
    let table: toml::Table = text.parse().map_err(|it: toml::de::Error| fail(it.to_string()))?;
    let mut project = Project { folder: path.parent().unwrap_or(Path::new(".")).to_owned(), ..Project::default() };
    for (key, value) in &table {
        set(&mut project, key, value).map_err(fail)?;
    }
    Ok(project)
}

fn set(project: &mut Project, key: &str, value: &toml::Value) -> Result<(), String> {
    match key {
        "dialect" => project.dialect = Some(text(key, value)?),
        "files" => project.files = texts(key, value)?.into_iter().map(PathBuf::from).collect(),
        "program" => project.program = Some(text(key, value)?),
        "cycle" => project.cycle = Some(text(key, value)?),
        "loop-budget" => project.loop_budget = Some(number(key, value)?),
        "ctu-stop-at-pv" => project.ctu_stop_at_pv = flag(key, value)?,
        "warn" => project.warn = texts(key, value)?,
        "deny" => project.deny = texts(key, value)?,
        "allow" => project.allow = texts(key, value)?,
        "message-format" => project.message_format = Some(choice(key, value)?),
        "color" => project.color = Some(choice(key, value)?),
        "quiet" => project.quiet = flag(key, value)?,
        "verbose" => project.verbose = flag(key, value)?,
        _ => {
            return Err(format!(
                "there is no setting `{key}`; there are dialect, files, program, cycle, loop-budget, ctu-stop-at-pv, warn, deny, allow, message-format, color, quiet and verbose"
            ));
        }
    }
    Ok(())
}

fn text(key: &str, value: &toml::Value) -> Result<String, String> {
    value.as_str().map(str::to_owned).ok_or_else(|| format!("`{key}` is a text in quotes"))
}

fn number(key: &str, value: &toml::Value) -> Result<u64, String> {
    let number = value.as_integer().and_then(|it| u64::try_from(it).ok());
    number.ok_or_else(|| format!("`{key}` is a whole number, 0 or more"))
}

fn flag(key: &str, value: &toml::Value) -> Result<bool, String> {
    value.as_bool().ok_or_else(|| format!("`{key}` is true or false"))
}

/// One of the words that the option of this name takes.
fn choice<T: ValueEnum>(key: &str, value: &toml::Value) -> Result<T, String> {
    let named = value.as_str().and_then(|it| T::from_str(it, false).ok());
    let words =
        || T::value_variants().iter().filter_map(T::to_possible_value).map(|it| format!("\"{}\"", it.get_name()));
    named.ok_or_else(|| format!("`{key}` is one of {}", words().collect::<Vec<_>>().join(", ")))
}

fn texts(key: &str, value: &toml::Value) -> Result<Vec<String>, String> {
    let list = value.as_array().ok_or_else(|| format!("`{key}` is a list"))?;
    list.iter().map(|it| text(key, it)).collect()
}
