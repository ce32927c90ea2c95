//! Writes what `.ci/proofs` compiles, links and runs: all golden cases as Rust that must not reach a panic, and as objects; and those that
//! compute with floats, with what they did on this machine, for others.
//!
//! ```text
//! proofs linked FOLDER
//! proofs objects FOLDER
//! proofs floats FOLDER
//! ```

mod floats;
mod linked;
mod module;
mod objects;
mod record;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let written = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["linked", folder] => linked::write(Path::new(folder)),
        ["objects", folder] => objects::write(Path::new(folder)),
        ["floats", folder] => floats::write(Path::new(folder)),
        _ => Err("proofs linked|objects|floats FOLDER".to_owned()),
    };
    match written {
        Ok(text) => println!("{text}"),
        Err(problem) => {
            eprintln!("{problem}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
