//! `staunch.toml`: the settings of the command line, for the folder it lies in and those below.

use std::path::{Path, PathBuf};

/// What a project file says. Paths are relative to its folder.
#[derive(Clone, Debug, Default)]
pub struct Project {
    pub folder: PathBuf,
    pub dialect: Option<String>,
    pub files: Vec<PathBuf>,
    pub program: Option<String>,
    pub cycle: Option<String>,
    pub ctu_stop_at_pv: bool,
    pub warn: Vec<String>,
    pub deny: Vec<String>,
    pub allow: Vec<String>,
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
        "ctu-stop-at-pv" => {
            project.ctu_stop_at_pv = value.as_bool().ok_or("`ctu-stop-at-pv` is true or false")?;
        }
        "warn" => project.warn = texts(key, value)?,
        "deny" => project.deny = texts(key, value)?,
        "allow" => project.allow = texts(key, value)?,
        _ => {
            return Err(format!(
                "there is no setting `{key}`; there are dialect, files, program, cycle, ctu-stop-at-pv, warn, deny and allow"
            ));
        }
    }
    Ok(())
}

fn text(key: &str, value: &toml::Value) -> Result<String, String> {
    value.as_str().map(str::to_owned).ok_or_else(|| format!("`{key}` is a text in quotes"))
}

fn texts(key: &str, value: &toml::Value) -> Result<Vec<String>, String> {
    let list = value.as_array().ok_or_else(|| format!("`{key}` is a list"))?;
    list.iter().map(|it| text(key, it)).collect()
}
