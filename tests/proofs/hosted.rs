//! The programs on a machine with an operating system.

mod drive;
mod entries;

struct Output;

impl core::fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        print!("{text}");
        Ok(())
    }
}

fn main() {
    std::process::exit(drive::all(entries::ENTRIES, &mut Output).min(1) as i32);
}
