//! Packs what the command carries: the runtime's source, for compiling with rustc where no
//! registry can be reached, and the runtime's libraries for the host, so that a native
//! executable needs a linker only.

#[path = "../src/toolchain.rs"]
#[allow(dead_code)]
mod toolchain;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use toolchain::{Library, RUNTIME, Rustc};

fn main() {
    if let Err(error) = pack() {
        println!("cargo::error={}", error.replace('\n', "\ncargo::error="));
    }
}

fn pack() -> Result<(), String> {
    println!("cargo::rerun-if-changed=build/main.rs");
    println!("cargo::rerun-if-changed=src/toolchain.rs");
    let out = PathBuf::from(variable("OUT_DIR")?);
    let unpacked = out.join("sources");
    let _ = fs::remove_dir_all(&unpacked);
    let mut archive = Vec::new();
    for (package, folder) in packages()? {
        println!("cargo::rerun-if-changed={}", folder.join("src").display());
        for file in sources(&folder.join("src"))? {
            let relative = file.strip_prefix(&folder).map_err(|it| it.to_string())?;
            let text = fs::read(&file).map_err(|it| format!("{}: {it}", file.display()))?;
            let path = Path::new(&package).join(relative);
            append(&mut archive, &path, &text)?;
            write(&unpacked.join(&path), &text)?;
        }
    }
    write(&out.join("runtime-sources"), &archive)?;
    let target = target_of_programs()?;
    println!("cargo::rustc-env=STAUNCH_TARGET={target}");
    println!("cargo::rustc-env=STAUNCH_VERSION={}", version()?);
    let built = out.join("runtime");
    fs::create_dir_all(&built).map_err(|it| it.to_string())?;
    let rustc = Rustc { program: variable("RUSTC")?.into(), target: Some(target.clone()), level: "3" };
    rustc.runtime(&unpacked, &built, true)?;
    for library in [Library::Runtime, Library::Program] {
        strip(&rustc.static_library(library, &built)?, &target);
    }
    Ok(())
}

/// A command that is linked statically, so that it runs on every Linux, makes programs with the C library of that Linux.
fn target_of_programs() -> Result<String, String> {
    println!("cargo::rerun-if-env-changed=STAUNCH_TARGET_OF_PROGRAMS");
    env::var("STAUNCH_TARGET_OF_PROGRAMS").or_else(|_| variable("TARGET"))
}

/// The version, with the commit where it is known. A development build names none: it would be compiled again with each.
fn version() -> Result<String, String> {
    let version = variable("CARGO_PKG_VERSION")?;
    if variable("PROFILE")? != "release" {
        return Ok(format!("{version} (development build)"));
    }
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
    let commit = git(&["log", "-1", "--format=%h %cs"]);
    Ok(commit.map_or(version.clone(), |it| format!("{version} ({it})")))
}

/// What git prints of the sources, if they are of a checkout.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}

fn variable(name: &str) -> Result<String, String> {
    env::var(name).map_err(|_| format!("cargo sets {name}"))
}

/// The folders of the runtime's packages, as this build resolved them.
fn packages() -> Result<Vec<(String, PathBuf)>, String> {
    let manifest = Path::new(&variable("CARGO_MANIFEST_DIR")?).join("Cargo.toml");
    let output = Command::new(variable("CARGO")?)
        // Packages for other platforms than the target's need not be on this machine.
        .args(["metadata", "--format-version=1", "--filter-platform", &variable("TARGET")?, "--manifest-path"])
        .arg(manifest)
        .output()
        .map_err(|it| format!("cannot run cargo metadata: {it}"))?;
    if !output.status.success() {
        return Err(format!("cargo metadata failed:\n{}", String::from_utf8_lossy(&output.stderr)));
    }
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).map_err(|it| it.to_string())?;
    let all = metadata["packages"].as_array().ok_or("cargo metadata lists packages")?;
    RUNTIME
        .iter()
        .map(|recipe| {
            let found = all.iter().find(|it| it["name"] == recipe.package);
            let path = found.and_then(|it| it["manifest_path"].as_str()).and_then(|it| Path::new(it).parent());
            let path = path.ok_or_else(|| format!("{} is not among the dependencies", recipe.package))?;
            Ok((recipe.package.to_owned(), path.to_owned()))
        })
        .collect()
}

/// Every file of source below `folder`, sorted: the archive is the same in every build.
fn sources(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).map_err(|it| format!("{}: {it}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|it| it.to_string())?.path();
        if path.is_dir() {
            files.extend(sources(&path)?);
        } else if path.extension().is_some_and(|it| it == "rs" || it == "html") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// One file of the archive: its path and length on a line, then its bytes.
fn append(archive: &mut Vec<u8>, path: &Path, text: &[u8]) -> Result<(), String> {
    let path = path.to_str().ok_or("the runtime's paths are UTF-8")?.replace('\\', "/");
    archive.extend(format!("{path}\t{}\n", text.len()).bytes());
    archive.extend(text);
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|it| format!("{}: {it}", folder.display()))?;
    fs::write(path, bytes).map_err(|it| format!("{}: {it}", path.display()))
}

/// Takes out the debug information and the bitcode that are for other builds than this: two
/// thirds of the library, and four fifths for Windows. It works with them too, where the host has no `strip`.
fn strip(library: &Path, target: &str) {
    let prefix = match target {
        "x86_64-pc-windows-gnu" => "x86_64-w64-mingw32-",
        "aarch64-unknown-linux-gnu" if cfg!(not(target_arch = "aarch64")) => "aarch64-linux-gnu-",
        _ => "",
    };
    let tool = |name: &str| Command::new(format!("{prefix}{name}"));
    // Debug information in files of its own is nothing that `strip` knows.
    let members = tool("ar").arg("t").arg(library).output().map(|it| it.stdout).unwrap_or_default();
    let members = String::from_utf8_lossy(&members);
    let apart: Vec<_> = members.lines().filter(|it| it.ends_with(".dwo")).collect();
    if !apart.is_empty() {
        let _ = tool("ar").arg("d").arg(library).args(apart).output();
    }
    let sections = ["--strip-debug", "--remove-section=.llvmbc", "--remove-section=.llvmcmd"];
    let _ = tool("strip").args(sections).arg(library).output();
}
