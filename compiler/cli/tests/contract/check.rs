//! Diagnostics: verdicts, forms, lints, dialects.

use super::{COUNTER, Folder, has};

const WRONG: &str = "PROGRAM Main
VAR size : INT; END_VAR (* größe *)
size := 300000;
other := 1;
END_PROGRAM
";

#[test]
fn the_verdict_is_the_exit_code() {
    let folder = Folder::with("verdict", &[("good.st", COUNTER), ("bad.st", WRONG)]);
    assert_eq!(folder.staunch("check good.st").out(0), "");
    has(&folder.staunch("check bad.st").err(1), &["error", "bad.st:4:1", "other"]);
    folder.staunch("build bad.st --emit rust").err(1);
    folder.staunch("run bad.st").err(1);
    for usage in ["check", "check missing.st", "check --nonsense good.st", "nonsense", "run good.st --scans many"] {
        folder.staunch(usage).err(2);
    }
}

#[test]
fn short_is_a_line_a_diagnostic() {
    let folder = Folder::with("short", &[("bad.st", WRONG)]);
    let err = folder.staunch("check bad.st --message-format short").err(1);
    let lines: Vec<_> = err.lines().filter(|it| it.contains(": error[")).collect();
    assert_eq!(lines.len(), 2, "{err}");
    assert!(lines[0].starts_with("bad.st:3:9: error[E"), "{err}");
    assert!(lines[1].starts_with("bad.st:4:1: error[E"), "{err}");
}

#[test]
fn json_is_an_object_a_line() {
    let folder = Folder::with("json", &[("bad.st", WRONG)]);
    let out = folder.staunch("check bad.st --message-format json").out(1);
    let diagnostics: Vec<serde_json::Value> = out.lines().map(|it| serde_json::from_str(it).unwrap()).collect();
    let second = &diagnostics[1];
    assert_eq!(second["reason"], "diagnostic");
    assert_eq!(second["severity"], "error");
    assert!(second["code"].as_str().unwrap().starts_with('E'));
    assert!(second["message"].as_str().unwrap().contains("other"));
    assert!(second["rendered"].as_str().unwrap().contains("bad.st:4:1"));
    let span = &second["spans"][0];
    let start = usize::try_from(span["byte_start"].as_u64().unwrap()).unwrap();
    assert_eq!(&WRONG[start..start + 5], "other");
    assert_eq!((&span["line_start"], &span["column_start"]), (&4.into(), &1.into()));
}

/// What an editor does with the fix of the first diagnostic of a file.
fn repaired(folder: &Folder, file: &str) -> Vec<u8> {
    let out = folder.staunch(&format!("check {file} --message-format json")).out(1);
    let diagnostic: serde_json::Value = serde_json::from_str(out.lines().next().unwrap()).unwrap();
    let fix = &diagnostic["fix"];
    let at = |key: &str| usize::try_from(fix[key].as_u64().unwrap()).unwrap();
    let mut bytes = std::fs::read(folder.0.join(file)).unwrap();
    bytes.splice(at("byte_start")..at("byte_end"), fix["replacement"].as_str().unwrap().bytes());
    bytes
}

#[test]
fn a_fix_counts_the_bytes_of_the_file() {
    let (wrong, right) =
        ("VAR x : INT; END_VAR\nx = 1;\nEND_PROGRAM\n", "VAR x : INT; END_VAR\nx := 1;\nEND_PROGRAM\n");
    let head = "PROGRAM Main (* größe *) ";
    let windows: Vec<u8> = head.chars().map(|it| u8::try_from(u32::from(it)).unwrap()).collect();
    let heads = [
        ("utf8.st", head.as_bytes().to_vec()),
        ("marked.st", [b"\xEF\xBB\xBF", head.as_bytes()].concat()),
        ("windows.st", windows.clone()),
        ("both.st", [b"\xEF\xBB\xBF".to_vec(), windows].concat()),
    ];
    let folder = Folder::new("encodings");
    for (file, head) in heads {
        folder.write(file, [&head, wrong.as_bytes()].concat());
        assert_eq!(repaired(&folder, file), [&head, right.as_bytes()].concat(), "{file}");
    }
}

#[test]
fn utf_16_is_read_with_its_columns() {
    let folder = Folder::new("utf16");
    let text = "PROGRAM Main (* größe 𝄞 *) VAR x : INT; END_VAR\nx = 1;\nEND_PROGRAM\n";
    let words = |mark: &str| format!("{mark}{text}").encode_utf16().collect::<Vec<_>>();
    let little = |mark| words(mark).iter().flat_map(|it| it.to_le_bytes()).collect::<Vec<_>>();
    let big = |mark| words(mark).iter().flat_map(|it| it.to_be_bytes()).collect::<Vec<_>>();
    for (bytes, mark) in [(little("\u{feff}"), 2), (little(""), 0), (big("\u{feff}"), 2), (big(""), 0)] {
        folder.write("main.st", bytes);
        let out = folder.staunch("check main.st --message-format json").out(1);
        let diagnostic: serde_json::Value = serde_json::from_str(out.lines().next().unwrap()).unwrap();
        let span = &diagnostic["spans"][0];
        assert_eq!((&span["line_start"], &span["column_start"]), (&2.into(), &3.into()));
        let before = text.find("= 1").unwrap();
        let expected = mark + 2 * text[..before].encode_utf16().count();
        assert_eq!(span["byte_start"], expected);
    }
}

#[test]
fn sources_are_files_folders_and_standard_input() {
    let folder = Folder::with("sources", &[]);
    std::fs::create_dir_all(folder.0.join("plc/inner")).unwrap();
    folder.write("plc/main.st", "PROGRAM Main VAR a : INT; END_VAR a := Twice(a); END_PROGRAM");
    folder
        .write("plc/inner/twice.iecst", "FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := 2 * x; END_FUNCTION");
    folder.staunch("check plc").out(0);
    folder.staunch("check plc/main.st").err(1);
    folder.staunch("check plc/inner/twice.iecst plc/main.st").out(0);
    folder.with_input("check -", COUNTER).out(0);
    has(&folder.with_input("check -", WRONG).err(1), &["<stdin>:4:1"]);
    folder.write("plc/other.TcPOU", "<TcPlcObject>");
    has(&folder.staunch("check plc").err(1), &["error[E0033]", "plc/other.TcPOU:1:1", "TwinCAT"]);
}

#[test]
fn lints_are_warned_of_denied_and_allowed() {
    let folder = Folder::with("lints", &[("unused.st", "PROGRAM Main VAR a : INT; END_VAR ; END_PROGRAM")]);
    has(&folder.staunch("check unused.st").err(0), &["warning[W0501]"]);
    has(&folder.staunch("check unused.st -D W0501").err(1), &["error[W0501]"]);
    has(&folder.staunch("check unused.st -D warnings").err(1), &["W0501"]);
    assert_eq!(folder.staunch("check unused.st -A W0501 -q").err(0), "");
    folder.staunch("check unused.st -A W9999").err(2);
}

#[test]
fn a_dialect_is_a_flag_a_pragma_or_a_setting() {
    let wide = "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE, PV := 1); w := c.CV; END_PROGRAM";
    let folder = Folder::with("dialect", &[("wide.st", wide)]);
    has(&folder.staunch("check wide.st").err(1), &["RESET"]);
    folder.staunch("check wide.st --dialect codesys").out(0);
    folder.write("pragma.st", format!("{{dialect 'codesys'}}\n{wide}"));
    folder.staunch("check pragma.st").out(0);
    folder.staunch("check pragma.st --dialect iec").out(0);
    folder.write("staunch.toml", "dialect = \"codesys\"\nfiles = [\"wide.st\"]\n");
    folder.staunch("check").out(0);
    has(&folder.staunch("check wide.st --dialect pascal").err(2), &["iec, cscape, codesys, twincat, openplc"]);
    folder.write("staunch.toml", "dialekt = \"codesys\"\n");
    has(&folder.staunch("check wide.st").err(2), &["staunch.toml", "dialekt"]);
}

#[test]
fn twincat_is_another_name_of_codesys() {
    let wide = "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE, PV := 1); w := c.CV; END_PROGRAM";
    let folder = Folder::with("twincat", &[("wide.st", wide)]);
    folder.staunch("check wide.st --dialect twincat").out(0);
    folder.staunch("check wide.st --dialect TwinCAT").out(0);
    folder.write("pragma.st", format!("{{dialect 'twincat'}}\n{wide}"));
    folder.staunch("check pragma.st --dialect iec").out(0);
    folder.write("staunch.toml", "dialect = \"twincat\"\nfiles = [\"wide.st\"]\n");
    folder.staunch("check").out(0);
    folder.staunch("new made --dialect twincat").out(0);
    has(&folder.read("made/staunch.toml"), &["dialect = \"codesys\""]);
}

#[test]
fn a_project_file_holds_the_settings_of_the_command_line() {
    let folder = Folder::with("settings", &[("bad.st", WRONG), ("good.st", COUNTER)]);
    folder.write("staunch.toml", "message-format = \"short\"\n");
    assert!(folder.staunch("check bad.st").err(1).starts_with("bad.st:3:9: error[E"));
    has(&folder.staunch("check bad.st --message-format human").err(1), &["error: rejected with 2 errors"]);
    folder.write("staunch.toml", "message-format = \"json\"\n");
    has(&folder.staunch("check bad.st").out(1), &["\"reason\":\"diagnostic\""]);
    folder.write("staunch.toml", "color = \"always\"\n");
    has(&folder.staunch("check bad.st").err(1), &["\u{1b}["]);
    assert!(!folder.staunch("check bad.st --color never").err(1).contains('\u{1b}'));
    folder.write("staunch.toml", "quiet = true\n");
    assert_eq!(folder.staunch("check good.st").err(0), "");
    folder.write("staunch.toml", "verbose = true\n");
    has(&folder.staunch("check good.st").err(0), &["Settings ", "staunch.toml", "Read good.st", "Checked good.st"]);
    assert_eq!(folder.staunch("check good.st -q").err(0), "");
    folder.write("staunch.toml", "color = \"pink\"\n");
    has(&folder.staunch("check good.st").err(2), &["`color` must be one of \"auto\", \"always\", \"never\""]);
    folder.write("staunch.toml", "quiet = 1\n");
    has(&folder.staunch("check good.st").err(2), &["`quiet` must be true or false"]);
}

/// What a project file says is checked by every command, and reported at its line.
#[test]
fn a_setting_that_is_wrong_is_reported_at_its_line() {
    let folder = Folder::new("wrong_setting");
    folder.write("p.st", "PROGRAM P VAR x : INT; END_VAR x := 1; END_PROGRAM");
    for (setting, line, text) in [
        ("cycle = \"10\"", 2, "`cycle`: `10` is not a time above zero: write `10ms`"),
        ("cycle = \"0ms\"", 2, "is not a time above zero"),
        ("cycle = 10", 2, "`cycle` must be a string in quotes"),
        ("dialect = \"iecc\"", 2, "there is no dialect `iecc`; did you mean `iec`?"),
        ("dialekt = \"iec\"", 2, "unknown setting `dialekt`; did you mean `dialect`?"),
        ("allow = [\"W501\"]", 2, "there is no lint `W501`; did you mean `W0501`?"),
        ("deny = [\n  \"W0501\",\n  \"E0203\",\n]", 4, "E0203 is an error"),
        ("quiet = \"yes\"", 2, "`quiet` must be true or false"),
        ("libraries = [\"no\"]", 2, "there is no file or folder `no`"),
    ] {
        folder.write("staunch.toml", format!("# a plant\n{setting}\n"));
        has(&folder.staunch("check p.st").err(2), &[&format!("staunch.toml:{line}: "), text]);
    }
    // One that cannot be read is not passed over: the program would be compiled by other settings.
    #[cfg(unix)]
    for target in ["missing.toml", "staunch.toml", ".", "/dev/zero"] {
        std::fs::remove_file(folder.0.join("staunch.toml")).unwrap();
        std::os::unix::fs::symlink(target, folder.0.join("staunch.toml")).unwrap();
        has(&folder.staunch("check p.st").err(2), &["error: staunch.toml: "]);
    }
    std::fs::remove_file(folder.0.join("staunch.toml")).unwrap();
    folder.write("staunch.toml", "files = [\n\"p.st\",\n\"q.st\"]\n");
    has(&folder.staunch("check").err(2), &["staunch.toml:3: there is no file or folder `q.st`"]);
}

/// A program in the wrong dialect is not to be rewritten.
#[test]
fn the_dialect_that_accepts_the_sources_is_named_last() {
    let text = "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE); w := c.CV; END_PROGRAM";
    let folder = Folder::with("accepting", &[("main.st", text), ("wrong.st", "PROGRAM Main x := 1; END_PROGRAM")]);
    let last = |line: &str| folder.staunch(line).err(1).lines().last().unwrap_or_default().to_owned();
    for verb in ["check", "run", "build", "test"] {
        assert_eq!(last(&format!("{verb} main.st")), "help: accepted with `--dialect codesys`", "{verb}");
    }
    has(&folder.staunch("compare main.st --from iec --to logix").err(1), &["help: accepted with `--from codesys`"]);
    assert_eq!(last("check wrong.st"), "error: rejected with 1 error");
    assert_eq!(last("check main.st -q"), "error: rejected with 2 errors");
    assert!(!folder.staunch("check main.st --message-format json").out(1).contains("accepted"));
}

#[test]
fn a_file_without_a_verb_is_what_to_type() {
    let folder = Folder::with("verbless", &[("main.st", COUNTER)]);
    has(&folder.staunch("main.st").err(2), &["error: `main.st` is a file; `staunch run main.st` runs it"]);
}

#[test]
fn codes_are_explained() {
    let folder = Folder::new("explain");
    has(&folder.staunch("explain E0203").out(0), &["E0203"]);
    folder.staunch("explain Z9").err(2);
    let list = folder.staunch("explain").out(0);
    has(&list, &["\nNames\n", "\n  E0101  ", "\n  W0501  "]);
    // The page is this list, with a heading for each section; write it again when it differs.
    let page = include_str!("../../../../docs/diagnostics.md");
    let (about, sections) = list.trim_end().split_once("\n\n").expect("sections follow the first lines");
    let mut shown = format!("```text\n{about}\n```\n");
    let listed: Vec<_> = page.split_once("\n## ").map(|it| it.1.split("\n## ").collect()).unwrap_or_default();
    assert!(page.contains(&shown), "docs/diagnostics.md does not begin as `staunch explain` does");
    for (section, on_page) in sections.split("\n\n").zip(&listed) {
        let (title, codes) = section.split_once('\n').expect("a section has codes");
        shown = format!("{title}\n\n```text\n{codes}\n```\n");
        assert_eq!(shown.trim_end(), on_page.trim_end(), "docs/diagnostics.md is not what `staunch explain` prints");
    }
    assert_eq!(sections.split("\n\n").count(), listed.len());
    let codes = list.lines().filter(|it| it.starts_with("  E") || it.starts_with("  W")).count();
    assert_eq!(codes, staunch_frontend::Code::ALL.len());
}

#[test]
fn shells_and_manuals_know_the_command() {
    let folder = Folder::new("manual");
    let help = folder.staunch("--help").out(0);
    let listed = help.lines().skip_while(|it| *it != "Commands:").skip(1).take_while(|it| !it.is_empty());
    // The text of a command continues further right.
    let starts = listed.filter_map(|it| it.strip_prefix("  ")).filter(|it| !it.starts_with(' '));
    let verbs: Vec<_> = starts.filter_map(|it| it.split_whitespace().next()).filter(|it| *it != "help").collect();
    assert!(verbs.contains(&"doctor"), "{help}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = folder.staunch(&format!("completions {shell}")).out(0);
        has(&text, &["staunch", "stimulus"]);
        has(&text, &verbs);
    }
    folder.staunch("completions cmd").err(2);
    has(&folder.staunch("man").out(0), &[".TH", "staunch"]);
    folder.staunch("man pages").out(0);
    has(&folder.read("pages/staunch-run.1"), &["stimulus", "loop"]);
    for verb in &verbs {
        has(&folder.read("pages/staunch.1"), &[&format!("staunch\\-{verb}(1)")]);
        has(&folder.read(&format!("pages/staunch-{verb}.1")), &[".TH"]);
    }
}

#[test]
fn a_source_and_a_project_allow_lints() {
    let unused = "PROGRAM Main VAR a : INT; END_VAR ; END_PROGRAM";
    let folder =
        Folder::with("allowed", &[("plain.st", unused), ("all.st", &format!("{{allow_file W0501}} {unused}"))]);
    folder.write("one.st", unused.replace("a :", "{allow W0501} a :"));
    for quiet in ["one.st", "all.st"] {
        assert_eq!(folder.staunch(&format!("check {quiet} -D warnings -q")).err(0), "", "{quiet}");
    }
    folder.staunch("check plain.st -D warnings").err(1);
    folder.write("staunch.toml", "deny = [\"W0501\"]\n");
    folder.staunch("check plain.st").err(1);
    folder.staunch("check one.st").out(0);
    folder.write("staunch.toml", "allow = [\"W0501\"]\n");
    assert_eq!(folder.staunch("check plain.st -q").err(0), "");
}

#[test]
fn a_new_project_builds_and_runs() {
    let folder = Folder::new("new");
    folder.staunch("new plant").out(0);
    let inside = Folder(folder.0.join("plant"));
    inside.staunch("check -D warnings").out(0);
    inside.staunch("run").out(0);
    has(&inside.staunch("test").out(0), &["ok      ten parts fill a box", "1 passed, 0 failed"]);
    folder.staunch("new plant").err(2);
}

/// What is missing is reported with what to type. Where nothing is on the path, native code of this machine can still be
/// made, but not linked.
#[test]
fn the_doctor_says_what_to_install() {
    let folder = Folder::new("doctor");
    let text = folder.staunch("doctor").out(0);
    has(&text, &[", this machine\n       ok  an object of native code\n", "thumbv7em-none-eabihf\n"]);
    let bare = folder.command("doctor").env("PATH", "").env_remove("RUSTC").env_remove("CC").output().unwrap();
    let text = String::from_utf8_lossy(&bare.stdout);
    assert_eq!(bare.status.code(), Some(2), "{text}");
    let missing = ["ok  an object", "missing  an executable of native code: no linker was found", "https://rustup.rs"];
    has(&text, &missing);
    has(
        &folder.staunch("doctor --target no-such-machine").out(2),
        &["rustc does not know the target `no-such-machine`"],
    );
}

#[test]
fn the_version_is_named() {
    has(&Folder::new("version").staunch("--version").out(0), &[concat!("staunch ", env!("CARGO_PKG_VERSION"))]);
}
