//! What shells and `man` know of the command, made of its arguments.

use crate::args::{Cli, Completions, Man};
use crate::output;
use clap::CommandFactory;

pub fn completions(args: &Completions) -> Result<u8, String> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "staunch", &mut text);
    output::print(&text).map(|()| 0)
}

pub fn pages(args: &Man) -> Result<u8, String> {
    let Some(folder) = &args.dir else {
        let mut text = Vec::new();
        let rendered = clap_mangen::Man::new(Cli::command()).render(&mut text);
        return rendered.map_err(|it| it.to_string()).and_then(|()| output::print(&text)).map(|()| 0);
    };
    let made = std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    made.map_err(|it| format!("{}: {it}", folder.display())).map(|()| 0)
}
