//! Coverage as a table, with what is left open below it; or one JSON object a file.

use super::File;
use crate::args::MessageFormat;
use crate::session::Session;
use staunch_host::json_text;

pub fn text(session: &Session, files: &[File]) -> String {
    match session.common.format() {
        MessageFormat::Json => files.iter().map(|it| json(session, it)).collect(),
        MessageFormat::Human | MessageFormat::Short => human(session, files),
    }
}

fn human(session: &Session, files: &[File]) -> String {
    let mut rows: Vec<(String, [(usize, usize); 3])> = files.iter().map(|it| (it.path.clone(), it.figures())).collect();
    let mut total = [(0, 0); 3];
    for (sum, figure) in rows.iter().flat_map(|it| it.1.into_iter().enumerate()) {
        total[sum] = (total[sum].0 + figure.0, total[sum].1 + figure.1);
    }
    rows.push(("total".to_owned(), total));
    let width = rows.iter().map(|it| it.0.chars().count()).max().unwrap_or(0).max("coverage".len());
    let mut text = format!("\n{:width$}  {:>16}  {:>16}  {:>16}\n", "coverage", "statements", "branches", "conditions");
    for (name, figures) in &rows {
        text += &format!("{name:width$}");
        figures.iter().for_each(|it| text += &format!("  {:>16}", share(*it)));
        text.push('\n');
    }
    for file in files {
        let open = file.open(session);
        if !open.is_empty() {
            text.push('\n');
        }
        for (at, what) in open {
            text += &format!("{}:{}:{}: {what}\n", file.path, at.line, at.column);
        }
    }
    text
}

/// `3 of 4   75 %`; a part is never shown as all, nor as nothing.
fn share((part, whole): (usize, usize)) -> String {
    if whole == 0 {
        return "none".to_owned();
    }
    let percent = match part * 100 / whole {
        0 if part > 0 => 1,
        percent => percent,
    };
    format!("{part} of {whole} {percent:>3} %")
}

fn json(session: &Session, file: &File) -> String {
    let [statements, branches, conditions] = file.figures().map(|(part, whole)| format!("[{part},{whole}]"));
    let open: Vec<_> = file
        .open(session)
        .into_iter()
        .map(|(at, what)| format!("{{\"line\":{},\"column\":{},\"message\":{}}}", at.line, at.column, json_text(&what)))
        .collect();
    format!(
        "{{\"reason\":\"coverage\",\"file\":{},\"statements\":{statements},\"branches\":{branches},\"conditions\":{conditions},\"open\":[{}]}}\n",
        json_text(&file.path),
        open.join(",")
    )
}
