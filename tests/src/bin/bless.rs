//! Rewrites the files next to golden cases, where they exist: `cargo bless [filter]`.

use staunch_tests::{case, cases, golden};
use std::process::ExitCode;

fn main() -> ExitCode {
    let filter = std::env::args().nth(1).unwrap_or_default();
    let (all, _) = case::discover(&cases());
    let mut refused = 0;
    for case in all.iter().filter(|it| it.name.contains(&filter)) {
        match golden::bless(case) {
            Ok(changes) => print!("{changes}"),
            Err(problem) => {
                refused += 1;
                eprintln!("{}: not blessed: {problem}", case.name);
            }
        }
    }
    ExitCode::from(u8::from(refused > 0))
}
