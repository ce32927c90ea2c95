//! `--emit systemd`: a unit that runs an executable as a service, in real time.

use staunch_host::{DEFAULT_CYCLE, Line};
use staunch_ir::{Program, Retain};
use std::path::Path;

/// Above the kernel's own threads that serve ordinary devices, below those of its timers.
const PRIORITY: u8 = 50;
const SECOND: i64 = 1_000_000_000;
/// Scans that may be missing before the service is ended.
const SCANS: i64 = 10;

/// The unit of the executable of the same name. `cycle` is the project's, which the executable does not know.
pub fn unit(program: &Program, cycle: Option<i64>, out: &Path) -> String {
    let name = name(out);
    let programs: Vec<&str> = program.instances.iter().map(|it| it.name.as_str()).collect();
    let programs = programs.join(", ");
    let retain = match has_retained(program) {
        true => format!(" --retain /var/lib/{name}/retained"),
        false => String::new(),
    };
    let given = cycle.map_or_else(String::new, |it| format!(" --cycle {it}ns"));
    let watchdog = seconds(program, cycle);
    let groups = groups(program);
    let (restart, priority) = (2 * watchdog, PRIORITY + 1);
    format!(
        "# The executable is /usr/local/bin/{name}, this file /etc/systemd/system/{name}.service. To start it, now and with the
# machine: systemctl daemon-reload && systemctl enable --now {name}
# Its figures, on the journal: systemctl kill --signal=SIGUSR1 {name}

[Unit]
Description={programs}, compiled by Staunch
After=local-fs.target

[Service]
# The program says when it has started, and that scans end.
Type=notify
ExecStart=/usr/local/bin/{name} --realtime --quiet{given} --priority {PRIORITY} --watchdog {watchdog}s{retain}
WatchdogSec={restart}
# A program that has faulted (exit code 3) waits for somebody who looks at the machine.
Restart=on-failure
RestartPreventExitStatus=3
RestartSec=1
TimeoutStopSec=5
LimitRTPRIO={priority}
LimitMEMLOCK=infinity
OOMScoreAdjust=-900
DynamicUser=yes
{groups}StateDirectory={name}
NoNewPrivileges=yes
ProtectSystem=strict
ProtectHome=yes

[Install]
WantedBy=multi-user.target
"
    )
}

/// What a serial port and the lines of a board ask for, whose devices belong to groups.
fn groups(program: &Program) -> String {
    let needs = |is_there: bool, name| is_there.then_some(name);
    let is_serial =
        |it: &String| it.strip_prefix("remote\t").and_then(|it| it.split('\t').nth(1)).is_some_and(Line::is_port);
    let serial = needs(program.remotes.iter().any(is_serial), "dialout");
    let lines = needs(program.remotes.iter().any(|it| it.starts_with("gpio\t")), "gpio");
    let all: Vec<&str> = serial.into_iter().chain(lines).collect();
    match all.is_empty() {
        true => String::new(),
        false => {
            format!("# Who may open the devices: `ls -l` shows their groups.\nSupplementaryGroups={}\n", all.join(" "))
        }
    }
}

/// The names of units, and of what systemd makes for them, have few characters.
fn name(out: &Path) -> String {
    let stem = out.file_stem().map_or("".into(), |it| it.to_string_lossy());
    let kept = |it: char| if it.is_ascii_alphanumeric() || "_-.".contains(it) { it } else { '_' };
    let name: String = stem.chars().map(kept).collect();
    if name.trim_matches(['-', '.']).is_empty() { "program".to_owned() } else { name }
}

fn has_retained(program: &Program) -> bool {
    program.structs.iter().flat_map(|it| &it.fields).any(|it| it.retain == Retain::Kept)
}

/// How long no scan may end.
fn seconds(program: &Program, cycle: Option<i64>) -> i64 {
    let intervals = program.instances.iter().map(|it| it.interval.or(cycle).unwrap_or(DEFAULT_CYCLE));
    let shortest = intervals.min().unwrap_or(DEFAULT_CYCLE);
    (shortest.saturating_mul(SCANS) / SECOND).max(1)
}
