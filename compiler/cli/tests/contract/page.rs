//! A trace as a page, in a browser without a screen.

use super::{Folder, has};
use std::process::Command;

const PULSES: &str = "PROGRAM Main
VAR n : DINT; pulse : BOOL; saw : INT; fixed : INT := 5; state : (Idle, Busy); END_VAR
n := n + 1;
pulse := n = 77777;
saw := DINT_TO_INT(n MOD 100);
IF n = 50000 THEN state := Busy; END_IF
fixed := 5;
END_PROGRAM
";

/// Works the page as a user would, and writes down what it then reads.
const VISIT: &str = "<script>
const said = [];
const read = (name) => [...document.querySelectorAll('.lane')].find((it) => it.querySelector('.name').firstChild.data === name).querySelector('.value').textContent;
const axis = () => document.querySelector('#axis canvas').getBoundingClientRect();
const xOf = (time) => axis().left + (time - view.from) / (view.to - view.from) * axis().width;
const point = (type, x, more) => document.querySelector('.lane canvas').dispatchEvent(new (type === 'wheel' ? WheelEvent : PointerEvent)(type, { bubbles: true, cancelable: true, clientX: x, ...more }));
(() => {
  said.push('lanes ' + document.querySelectorAll('.lane').length, document.querySelector('#unchanged div').textContent);
  for (let turn = 0; turn < 90; turn++) point('wheel', xOf(777.765e9), { deltaY: -100 });
  drawAll();
  said.push('span ' + Math.round(view.to - view.from));
  point('pointermove', xOf(777.765e9));
  drawAll();
  said.push('pulse ' + read('pulse'), 'n ' + (read('n').includes('changes') ? 'band' : read('n')), 'state ' + read('state'));
  said.push(document.querySelector('#where').textContent);
  const before = view.from;
  point('pointerdown', 500); point('pointermove', 400); point('pointerup', 400);
  drawAll();
  said.push('moved ' + (view.from > before));
  document.querySelector('#all').click();
  drawAll();
  said.push('all ' + (view.from === data.start && view.to === data.end));
  const ink = document.querySelectorAll('.lane canvas')[1].getContext('2d').getImageData(0, 0, 4000, 8).data;
  said.push('pulse is drawn ' + ink.some((it, at) => at % 4 === 3 && it > 100));
  const out = document.createElement('pre');
  out.id = 'said';
  out.textContent = said.join('\\n');
  document.body.append(out);
})();
</script>";

/// Debian's name, and those of other systems.
const BROWSERS: [&str; 4] = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];

#[test]
fn a_page_zooms_moves_and_reads_values() {
    let folder = Folder::with("page", &[("main.st", PULSES)]);
    folder.staunch("run main.st --scans 200000 --trace out.html -q").out(0);
    let page = folder.read("out.html");
    assert!(page.len() < 12_000_000 && !page.contains("http://") && !page.contains("https://"));
    folder.write("visit.html", page.replace("</body>", &format!("{VISIT}</body>")));
    let Some(dom) = BROWSERS.iter().find_map(|it| visit(it, &folder)) else {
        assert!(std::env::var_os("CI").is_none(), "no browser was found to try a page in");
        eprintln!("SKIPPED: a_page_zooms_moves_and_reads_values: there is no {}", BROWSERS.join(", no "));
        return;
    };
    let said = dom.split_once("<pre id=\"said\">").and_then(|(_, it)| it.split_once("</pre>")).map(|it| it.0);
    let said = said.unwrap_or_else(|| panic!("the page said nothing:\n{}", &dom[dom.len().saturating_sub(500)..]));
    has(said, &["lanes 4\nfixed = 5\n", "pulse TRUE\n", "state Busy\n", "at 12 min 57.76", "scan 77777\n"]);
    has(said, &["moved true\n", "all true\n", "pulse is drawn true"]);
}

/// The page as it is after its scripts ran; `None` without that browser.
fn visit(browser: &str, folder: &Folder) -> Option<String> {
    let flags = ["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", "--virtual-time-budget=10000"];
    let mut command = Command::new(browser);
    command
        .args(flags)
        .arg("--window-size=1200,600")
        .arg(format!("--user-data-dir={}", folder.0.join("user").display()));
    command.arg(format!("file://{}", folder.0.join("visit.html").display()));
    let output = command.output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}
