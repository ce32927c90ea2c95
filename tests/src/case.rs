//! A golden case: a program, and next to it the files that say what is pinned.

use staunch_frontend::{Compilation, Dialect, Options, Source, Sources};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// What a file next to a case pins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Pin {
    /// The typed intermediate representation, printed.
    Ir,
    /// The emitted Rust.
    Rust,
    /// The native back end's code before it becomes the machine's.
    Clif,
    /// All diagnostics, as a person sees them.
    Diagnostics,
    /// Stimulus and expected outputs, a row a scan.
    Scan,
}

impl Pin {
    pub const ALL: [Self; 5] = [Self::Diagnostics, Self::Ir, Self::Rust, Self::Clif, Self::Scan];

    pub const fn extension(self) -> &'static str {
        match self {
            Self::Ir => "ir",
            Self::Rust => "rs",
            Self::Clif => "clif",
            Self::Diagnostics => "err",
            Self::Scan => "scan",
        }
    }
}

#[derive(Clone, Debug)]
pub struct Case {
    /// `topic/case`
    pub name: String,
    /// The program's files: `case.st`, then `case.2.st` and so on.
    pub sources: Vec<PathBuf>,
    pub pins: BTreeSet<Pin>,
}

/// What the comments at the top of a case ask for.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    pub options: Options,
    /// `// cycle: 20ms`, in the command's own words.
    pub cycle: Option<String>,
    /// `// loop-budget: 1000`.
    pub loop_budget: Option<u64>,
}

impl Case {
    pub fn golden(&self, pin: Pin) -> PathBuf {
        self.sources[0].with_extension(pin.extension())
    }

    pub fn pinned(&self, pin: Pin) -> String {
        fs::read_to_string(self.golden(pin)).unwrap_or_default().replace("\r\n", "\n")
    }

    /// A Rust identifier.
    pub fn module(&self) -> String {
        self.name.replace(|it: char| !it.is_ascii_alphanumeric(), "_")
    }

    /// Diagnostics name a file by its last part, so that a golden is the same on every machine.
    pub fn sources(&self) -> Sources {
        let mut sources = Sources::default();
        for path in &self.sources {
            let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let source = Source::decode(file_name(path), &bytes);
            let library = source.text.lines().next().and_then(|it| it.strip_prefix("// library ")).map(str::to_owned);
            sources.add(match library {
                Some(name) => source.of_library(&name),
                None => source,
            });
        }
        sources
    }

    /// # Panics
    /// If a comment gives a setting a value that it does not have.
    pub fn settings(&self) -> Settings {
        let sources = self.sources();
        let comments = sources.files()[0].text.lines().map_while(|line| line.strip_prefix("//"));
        let mut settings = Settings::default();
        for (key, value) in comments.filter_map(|it| it.split_once(':')) {
            let dialect = |name| Dialect::named(name).unwrap_or_else(|| panic!("{}: dialect {name}", self.name));
            match (key.trim(), value.trim()) {
                ("dialect", name) => settings.options.dialect = dialect(name),
                ("moved-from", name) => settings.options.moved_from = Some(dialect(name)),
                ("ctu-stop-at-pv", value) => settings.options.ctu_stop_at_pv = value == "on",
                ("openplc4-cd-edge", value) => settings.options.openplc4_cd_rises = value == "rising",
                ("s7-ld", value) => settings.options.s7_ld_edge = value == "edge",
                ("openplc-f-trig", value) => settings.options.f_trig_before_2024_12 = value == "before-2024-12",
                ("codesys-real-literals", value) => settings.options.codesys_lreal_literals = value == "lreal",
                ("pool", value) => settings.options.default_pool = value.parse().ok(),
                ("implicit-narrowing", value) => settings.options.implicit_narrowing = value == "on",
                ("tests", value) => settings.options.tests = value == "on",
                ("coverage", value) => settings.options.coverage = value.parse().ok(),
                ("loop-budget", value) => settings.loop_budget = value.parse().ok(),
                ("cycle", value) => settings.cycle = Some(value.to_owned()),
                _ => {}
            }
        }
        settings
    }

    pub fn compile(&self) -> (Sources, Compilation) {
        let sources = self.sources();
        let compilation = staunch_frontend::compile(&sources, &self.settings().options);
        (sources, compilation)
    }
}

/// All cases below `root`, and what is wrong with the files there.
pub fn discover(root: &Path) -> (Vec<Case>, Vec<String>) {
    let mut files = Vec::new();
    list(root, &mut files);
    files.sort();
    let mut cases: BTreeMap<String, Case> = BTreeMap::new();
    let mut problems = Vec::new();
    // `case.st` sorts before `case.2.st` no more than after it: cases first, then what is theirs.
    let (mains, others): (Vec<_>, Vec<_>) = files.into_iter().partition(|it| is_main(it));
    for path in mains {
        let name = relative(root, &path.with_extension(""));
        cases.insert(name.clone(), Case { name, sources: vec![path], pins: BTreeSet::new() });
    }
    for path in others {
        if let Err(problem) = attach(root, path, &mut cases) {
            problems.push(problem);
        }
    }
    let unpinned = cases.values().filter(|it| it.pins.is_empty());
    problems.extend(unpinned.map(|it| format!("{}.st pins nothing: add a file next to it", it.name)));
    (cases.into_values().collect(), problems)
}

fn attach(root: &Path, path: PathBuf, cases: &mut BTreeMap<String, Case>) -> Result<(), String> {
    let shown = relative(root, &path);
    let (stem, extension) = shown.rsplit_once('.').ok_or_else(|| format!("{shown}: what is it?"))?;
    if extension == "st" {
        let owner = stem.rsplit_once('.').map_or(stem, |it| it.0);
        let case = cases.get_mut(owner).ok_or_else(|| format!("{shown} belongs to no case"))?;
        case.sources.push(path);
        return Ok(());
    }
    let pin = Pin::ALL.into_iter().find(|it| it.extension() == extension);
    let pin = pin.ok_or_else(|| format!("{shown}: `.{extension}` pins nothing"))?;
    let case = cases.get_mut(stem).ok_or_else(|| format!("{shown} is an orphan: there is no {stem}.st"))?;
    case.pins.insert(pin);
    match fs::metadata(&path) {
        Ok(file) if file.len() == 0 => Err(format!("{shown} is empty: run `cargo bless {stem}`")),
        _ => Ok(()),
    }
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() { list(&path, files) } else { files.push(path) }
    }
}

/// `case.st`, not `case.2.st`.
fn is_main(path: &Path) -> bool {
    file_name(path).strip_suffix(".st").is_some_and(|stem| !stem.contains('.'))
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |it| it.to_string_lossy().into_owned())
}

fn relative(root: &Path, path: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).to_string_lossy().replace('\\', "/")
}
