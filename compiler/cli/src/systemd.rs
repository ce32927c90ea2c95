//! `--emit systemd`: a unit that runs an executable as a service, in real time.

use staunch_ir::{Program, Retain};
use std::path::Path;

/// Above the kernel's own threads that serve ordinary devices, below those of its timers.
const PRIORITY: u8 = 50;
const SECOND: i64 = 1_000_000_000;
/// Scans that may be missing before the service is ended.
const SCANS: i64 = 10;
/// Of a program without a TASK.
const DEFAULT_CYCLE: i64 = 10_000_000;

/// The unit of the executable of the same name.
pub fn unit(program: &Program, out: &Path) -> String {
    let name = out.file_stem().map_or("program".into(), |it| it.to_string_lossy());
    let name = if name == "-" { "program".into() } else { name };
    let programs: Vec<&str> = program.instances.iter().map(|it| it.name.as_str()).collect();
    let programs = programs.join(", ");
    let retain = match has_retained(program) {
        true => format!(" --retain /var/lib/{name}/retained"),
        false => String::new(),
    };
    let watchdog = seconds(program);
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
ExecStart=/usr/local/bin/{name} --realtime --quiet --priority {PRIORITY} --watchdog {watchdog}s{retain}
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
StateDirectory={name}
NoNewPrivileges=yes
ProtectSystem=strict
ProtectHome=yes

[Install]
WantedBy=multi-user.target
"
    )
}

fn has_retained(program: &Program) -> bool {
    program.structs.iter().flat_map(|it| &it.fields).any(|it| it.retain == Retain::Kept)
}

/// How long no scan may end.
fn seconds(program: &Program) -> i64 {
    let periods = program.instances.iter().map(|it| it.interval.unwrap_or(DEFAULT_CYCLE));
    let shortest = periods.min().unwrap_or(DEFAULT_CYCLE);
    (shortest.saturating_mul(SCANS) / SECOND).max(1)
}
