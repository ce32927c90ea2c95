//! The results as JUnit's XML has them: a suite for each file.

use super::report::{Report, Result};
use std::collections::HashMap;

pub fn text(report: &Report<'_>) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let (all, failed) = (report.results.len(), report.failed());
    text += &format!("<testsuites tests=\"{all}\" failures=\"{failed}\">\n");
    for suite in report.results.chunk_by(|a, b| a.file == b.file) {
        let failed = suite.iter().filter(|it| !it.problem.is_empty()).count();
        let file = escaped(&suite[0].file);
        text += &format!("  <testsuite name=\"{file}\" tests=\"{}\" failures=\"{failed}\">\n", suite.len());
        let mut titles: HashMap<&str, u32> = HashMap::new();
        for result in suite {
            let count = titles.entry(&result.title).or_default();
            *count += 1;
            // Readers of the file take two tests with the same name for one.
            let title = if *count == 1 { result.title.clone() } else { format!("{} ({count})", result.title) };
            text += &case(result, &title);
        }
        text += "  </testsuite>\n";
    }
    text + "</testsuites>\n"
}

fn case(result: &Result, title: &str) -> String {
    let (title, file) = (escaped(title), escaped(&result.file));
    let head = format!("    <testcase name=\"{title}\" classname=\"{file}\" file=\"{file}\" line=\"{}\"", result.line);
    if let Some(why) = &result.skipped {
        return format!("{head}>\n      <skipped message=\"{}\"/>\n    </testcase>\n", escaped(why));
    }
    if result.problem.is_empty() {
        return format!("{head}/>\n");
    }
    // Of a fault the second line is what the source says there.
    let told = result.problem.get(usize::from(!result.faulted)).unwrap_or(&result.problem[0]);
    let what = escaped(told);
    let kind = if result.faulted { "fault" } else { "assertion" };
    let details = escaped(&result.problem.join("\n"));
    format!("{head}>\n      <failure type=\"{kind}\" message=\"{what}\">{details}</failure>\n    </testcase>\n")
}

/// As text or an attribute of XML; characters that XML does not have are left out.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\n' => out += "&#10;",
            it if it.is_control() || matches!(it, '\u{fffe}' | '\u{ffff}') => {}
            it => out.push(it),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_xml_keeps_for_itself_is_escaped() {
        assert_eq!(super::escaped("a < b & \"c\"\u{1}"), "a &lt; b &amp; &quot;c&quot;");
    }
}
