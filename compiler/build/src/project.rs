//! `staunch.toml`: the settings of the command and of build scripts, for the folder it is in and those
//! below.

mod gpio;
mod layout;
mod modbus;
mod safe;

pub use gpio::{Gpio, GpioLine};
pub use modbus::Modbus;

use staunch_frontend::{Dialect, Level, Levels, format, nearest};
use std::path::{Path, PathBuf};

/// The contents of a project file. Paths are relative to its folder.
#[derive(Clone, Debug, Default)]
pub struct Project {
    pub folder: PathBuf,
    pub dialect: Option<String>,
    pub files: Vec<PathBuf>,
    /// Libraries that the sources use.
    pub libraries: Vec<PathBuf>,
    pub program: Option<String>,
    pub cycle: Option<String>,
    pub loop_budget: Option<u64>,
    /// The maximum number of instructions in a scan of a task, and the maximum number of bytes of its stack, in native code.
    pub max_scan_instructions: Option<u64>,
    pub max_stack: Option<u64>,
    pub ctu_stop_at_pv: bool,
    /// `openplc4-cd-edge = "rising"`.
    pub openplc4_cd_rises: bool,
    /// `s7-ld = "edge"`.
    pub s7_ld_edge: bool,
    pub f_trig_before_2024_12: bool,
    /// `codesys-real-literals = "lreal"`.
    pub codesys_lreal_literals: bool,
    pub implicit_narrowing: bool,
    /// The number of objects in the pool of a type that declares none, `[pool] default`.
    pub default_pool: Option<u32>,
    pub warn: Vec<String>,
    pub deny: Vec<String>,
    pub allow: Vec<String>,
    pub message_format: Option<String>,
    pub color: Option<String>,
    pub quiet: bool,
    pub verbose: bool,
    /// `[[modbus]]`
    pub modbus: Vec<Modbus>,
    /// `[[gpio]]`
    pub gpio: Vec<Gpio>,
    /// `[safe]`: outputs, and their values.
    pub safe: Vec<(String, String)>,
    /// `[fmt]`
    pub layout: format::Style,
    text: String,
}

impl Project {
    /// The project file of `start` or of the nearest folder above it.
    pub fn find(start: &Path) -> Result<Option<Self>, String> {
        let start = start.canonicalize().unwrap_or_else(|_| start.to_owned());
        // Whatever has that name: where it cannot be read, compiling by other settings would be wrong.
        let found = start.ancestors().map(|it| it.join("staunch.toml")).find(|it| it.symlink_metadata().is_ok());
        found.map(|path| read(&path)).transpose()
    }

    /// The dialect that it names.
    pub fn dialect(&self) -> Result<Option<Dialect>, String> {
        let named = |name: &String| {
            Dialect::asked_for(name).map_err(|it| format!("{}: {it}", self.place("dialect", Some(name))))
        };
        self.dialect.as_ref().map(named).transpose()
    }

    /// Its levels of lints.
    pub fn levels(&self) -> Result<Levels, String> {
        let mut levels = Levels::default();
        for (level, names) in [(Level::Warn, &self.warn), (Level::Deny, &self.deny), (Level::Allow, &self.allow)] {
            let key = match level {
                Level::Warn => "warn",
                Level::Deny => "deny",
                Level::Allow => "allow",
            };
            for name in names {
                let place = || self.place(key, Some(name));
                levels.add(level, [name.as_str()]).map_err(|it| format!("{}: {it}", place()))?;
            }
        }
        Ok(levels)
    }

    /// The project file, as messages name it: as seen from the current folder.
    pub fn file(&self) -> String {
        shown(&self.folder.join("staunch.toml"))
    }

    /// Whether the file has this setting.
    pub fn has(&self, key: &str) -> bool {
        line_of(&self.text, key, None).is_some()
    }

    /// The file and the line of a setting, or of a text in it.
    pub fn place(&self, key: &str, value: Option<&str>) -> String {
        line_of(&self.text, key, value).map_or_else(|| self.file(), |line| format!("{}:{line}", self.file()))
    }

    /// Whether it says something of what a run in real time reads from and writes to.
    pub fn is_connected(&self) -> bool {
        !self.modbus.is_empty() || !self.gpio.is_empty() || !self.safe.is_empty()
    }

    /// The file and the line of a setting in the table `[[name]]` with this number, from 0.
    pub fn place_in_table(&self, name: &str, number: usize, key: &str) -> String {
        self.place_below(&format!("[[{name}]]"), number, key)
    }

    /// The file and the line of a setting in the table `[safe]`.
    pub fn place_of_safe(&self, key: &str) -> String {
        self.place_below("[safe]", 0, key)
    }

    fn place_below(&self, head: &str, number: usize, key: &str) -> String {
        let tables = self.text.match_indices(head).map(|it| it.0);
        let start = tables.take(number + 1).last().unwrap_or(0);
        let before = self.text[..start].lines().count();
        let line = line_of(&self.text[start..], key, None).unwrap_or(1);
        format!("{}:{}", self.file(), before + line)
    }

    /// A path of the file, as seen from `from`, with `/` on every machine.
    pub fn seen_from(&self, from: &Path, path: &Path) -> PathBuf {
        relative(&self.folder.join(path), from)
    }
}

/// A path as seen from the current folder.
fn shown(path: &Path) -> String {
    let here = std::env::current_dir().and_then(|it| it.canonicalize());
    here.map_or_else(|_| path.to_owned(), |it| relative(path, &it)).display().to_string()
}

/// `path` as seen from `from`: both absolute, and not on two drives.
fn relative(path: &Path, from: &Path) -> PathBuf {
    let shared = path.components().zip(from.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return path.to_owned();
    }
    let up = from.components().skip(shared).map(|_| Path::new("..").as_os_str());
    let down = path.components().skip(shared).map(std::path::Component::as_os_str);
    let parts: PathBuf = up.chain(down).collect();
    if parts.as_os_str().is_empty() { PathBuf::from(".") } else { parts }
}

fn read(path: &Path) -> Result<Project, String> {
    let fail = |what: String| format!("{}: {what}", shown(path));
    let metadata = std::fs::metadata(path).map_err(|it| match path.is_symlink() {
        true => fail(format!("this is a link, and what it leads to cannot be read: {it}")),
        false => fail(it.to_string()),
    })?;
    if !metadata.is_file() {
        return Err(fail("this is a folder, a pipe or a device, and not a file".to_owned()));
    }
    let text = std::fs::read_to_string(path).map_err(|it| fail(it.to_string()))?;
    let table: toml::Table = text.parse().map_err(|it: toml::de::Error| fail(it.to_string()))?;
    let folder = path.parent().unwrap_or(Path::new(".")).to_owned();
    let mut project = Project { folder, text, ..Project::default() };
    for (key, value) in &table {
        set(&mut project, key, value).map_err(|it| format!("{}: {it}", project.place(key, None)))?;
    }
    Ok(project)
}

/// The line of a setting, or of the first line from there on that contains a text in quotes, counted from 1.
fn line_of(text: &str, key: &str, value: Option<&str>) -> Option<usize> {
    let is_key = |line: &str| {
        let name = line.split_once('=').map_or(line, |it| it.0).trim();
        name.trim_matches(['"', '\'', '[', ']']) == key
    };
    let start = text.lines().position(is_key)?;
    let has = |line: &str| value.is_some_and(|it| line.contains(&format!("\"{it}\"")));
    let further = text.lines().skip(start).position(has);
    Some(start + further.unwrap_or(0) + 1)
}

/// The keys of `staunch.toml`.
const SETTINGS: [&str; 26] = [
    "dialect",
    "files",
    "libraries",
    "program",
    "cycle",
    "loop-budget",
    "max-scan-instructions",
    "max-stack",
    "ctu-stop-at-pv",
    "openplc4-cd-edge",
    "s7-ld",
    "openplc-f-trig",
    "codesys-real-literals",
    "implicit-narrowing",
    "pool",
    "warn",
    "deny",
    "allow",
    "message-format",
    "color",
    "quiet",
    "verbose",
    "modbus",
    "gpio",
    "safe",
    "fmt",
];

fn set(project: &mut Project, key: &str, value: &toml::Value) -> Result<(), String> {
    match key {
        "dialect" => project.dialect = Some(text(key, value)?),
        "files" => project.files = texts(key, value)?.into_iter().map(PathBuf::from).collect(),
        "libraries" => project.libraries = texts(key, value)?.into_iter().map(PathBuf::from).collect(),
        "program" => project.program = Some(text(key, value)?),
        "cycle" => project.cycle = Some(text(key, value)?),
        "loop-budget" => project.loop_budget = Some(number(key, value)?),
        "max-scan-instructions" => project.max_scan_instructions = Some(number(key, value)?),
        "max-stack" => project.max_stack = Some(number(key, value)?),
        "ctu-stop-at-pv" => project.ctu_stop_at_pv = flag(key, value)?,
        "openplc4-cd-edge" => project.openplc4_cd_rises = choice(key, value, &["falling", "rising"])? == "rising",
        "s7-ld" => project.s7_ld_edge = choice(key, value, &["level", "edge"])? == "edge",
        "openplc-f-trig" => {
            project.f_trig_before_2024_12 = choice(key, value, &["now", "before-2024-12"])? == "before-2024-12";
        }
        "codesys-real-literals" => {
            project.codesys_lreal_literals = choice(key, value, &["place", "lreal"])? == "lreal";
        }
        "pool" => project.default_pool = Some(default_pool(value)?),
        "implicit-narrowing" => project.implicit_narrowing = flag(key, value)?,
        "warn" => project.warn = texts(key, value)?,
        "deny" => project.deny = texts(key, value)?,
        "allow" => project.allow = texts(key, value)?,
        "message-format" => project.message_format = Some(choice(key, value, &["human", "short", "json"])?),
        "color" => project.color = Some(choice(key, value, &["auto", "always", "never"])?),
        "quiet" => project.quiet = flag(key, value)?,
        "verbose" => project.verbose = flag(key, value)?,
        "modbus" => project.modbus = modbus::read(value)?,
        "gpio" => project.gpio = gpio::read(value)?,
        "safe" => project.safe = safe::read(value)?,
        "fmt" => project.layout = layout::read(value)?,
        _ => {
            return Err(match nearest(key, SETTINGS.into_iter()) {
                Some(near) => format!("unknown setting `{key}`; did you mean `{near}`?"),
                None => format!("unknown setting `{key}`; the settings are {}", SETTINGS.join(", ")),
            });
        }
    }
    Ok(())
}

/// `[pool] default = 16`
fn default_pool(value: &toml::Value) -> Result<u32, String> {
    let table = value.as_table().ok_or("`pool` must be a table with `default`")?;
    if let Some(key) = table.keys().find(|it| *it != "default") {
        return Err(format!("unknown setting `{key}` of `pool`; the only one is `default`"));
    }
    let count = table.get("default").ok_or("`pool` needs `default`, the number of objects")?;
    let fits = count.as_integer().and_then(|it| u32::try_from(it).ok()).filter(|it| (1..=65535).contains(it));
    fits.ok_or_else(|| "`default` of `pool` must be a number from 1 to 65535".to_owned())
}

fn text(key: &str, value: &toml::Value) -> Result<String, String> {
    value.as_str().map(str::to_owned).ok_or_else(|| format!("`{key}` must be a string in quotes"))
}

fn number(key: &str, value: &toml::Value) -> Result<u64, String> {
    let number = value.as_integer().and_then(|it| u64::try_from(it).ok());
    number.ok_or_else(|| format!("`{key}` must be a whole number, 0 or more"))
}

fn flag(key: &str, value: &toml::Value) -> Result<bool, String> {
    value.as_bool().ok_or_else(|| format!("`{key}` must be true or false"))
}

/// One of the words that the option with this name accepts.
fn choice(key: &str, value: &toml::Value, words: &[&str]) -> Result<String, String> {
    let named = value.as_str().filter(|it| words.contains(it)).map(str::to_owned);
    let quoted = || words.iter().map(|it| format!("\"{it}\"")).collect::<Vec<_>>().join(", ");
    named.ok_or_else(|| format!("`{key}` must be one of {}", quoted()))
}

fn texts(key: &str, value: &toml::Value) -> Result<Vec<String>, String> {
    let list = value.as_array().ok_or_else(|| format!("`{key}` must be a list"))?;
    list.iter().map(|it| text(key, it)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_has_a_line() {
        let text = "# dialect\ndialect = \"iec\"\nwarn = [\n  \"W0501\",\n  \"W0001\",\n]\n[tool]\nx = 1\n";
        assert_eq!(line_of(text, "dialect", None), Some(2));
        assert_eq!(line_of(text, "warn", Some("W0001")), Some(5));
        assert_eq!(line_of(text, "warn", Some("W0002")), Some(3));
        assert_eq!(line_of(text, "tool", None), Some(7));
        assert_eq!(line_of(text, "cycle", None), None);
    }

    #[test]
    fn paths_are_seen_from_a_folder() {
        let seen = |path: &str, from: &str| relative(Path::new(path), Path::new(from)).display().to_string();
        assert_eq!(seen("/home/a/plant/src/x.st", "/home/a/plant"), "src/x.st");
        assert_eq!(seen("/home/a/plant/src/x.st", "/home/a/plant/src"), "x.st");
        assert_eq!(seen("/home/a/plant/src", "/home/a/plant/tests/deep"), "../../src");
        assert_eq!(seen("/home/a/plant", "/home/a/plant"), ".");
    }
}
