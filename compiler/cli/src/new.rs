//! `staunch new`: a folder with a program, its stimulus and a project file.

use crate::args;
use crate::output;
use std::fs;
use std::path::Path;

const PROGRAM: &str = "(* Counts parts; ten of them fill a box. *)
PROGRAM Main
VAR_INPUT
    part  : BOOL;    // light barrier at the belt
    empty : BOOL;    // the box was changed
END_VAR
VAR_OUTPUT
    full  : BOOL;    // lamp: change the box
END_VAR
VAR
    parts : CTU;
END_VAR

parts(CU := part, R := empty, PV := 10, Q => full);
END_PROGRAM
";

const TEST: &str = "TEST 'ten parts fill a box'
VAR
    line : Main;
    i    : INT;
END_VAR
FOR i := 1 TO 10 DO
    ASSERT_FALSE(line.full);
    line(part := FALSE);
    line(part := TRUE);
END_FOR
ASSERT_TRUE(line.full);

line(part := FALSE, empty := TRUE);
ASSERT_FALSE(line.full, 'an empty box is not full');
END_TEST
";

const STIMULUS: &str = "scan,part,empty
1,FALSE,FALSE
2,TRUE,
3,FALSE,
4,TRUE,
5,FALSE,
6,,TRUE
7,TRUE,FALSE
";

const README: &str = "# A Staunch project

    staunch check
    staunch test
    staunch run --stimulus stimulus.csv
    staunch run --stimulus stimulus.csv --trace -
    staunch build -o plc && ./plc --scans 10
";

/// Makes a project that builds and runs.
pub fn new(args: &args::New, common: &args::Common) -> Result<u8, String> {
    let occupied = fs::read_dir(&args.dir).is_ok_and(|mut it| it.next().is_some());
    if occupied {
        return Err(format!("{} is not empty", args.dir.display()));
    }
    let dialect = common.dialect.unwrap_or_default();
    let program = match dialect {
        staunch_frontend::Dialect::Iec
        | staunch_frontend::Dialect::Openplc
        | staunch_frontend::Dialect::Openplc4
        | staunch_frontend::Dialect::Siemens => PROGRAM.to_owned(),
        staunch_frontend::Dialect::Cscape | staunch_frontend::Dialect::Codesys => {
            PROGRAM.replace("R := empty", "RESET := empty")
        }
        staunch_frontend::Dialect::Logix => PROGRAM.replace("parts : CTU;", "parts : COUNTER := (PRE := 10);").replace(
            "parts(CU := part, R := empty, PV := 10, Q => full);",
            "CTU(Counter := parts, RungIn := part);\nRES(Counter := parts, RungIn := empty);\nfull := parts.DN;",
        ),
    };
    let project = format!("dialect = \"{}\"\nfiles = [\"src\"]\ncycle = \"10ms\"\n", dialect.name());
    let files = [
        ("staunch.toml", project.as_str()),
        ("src/main.st", program.as_str()),
        ("src/main_test.st", TEST),
        ("stimulus.csv", STIMULUS),
        ("README.md", README),
    ];
    for (name, text) in files {
        write(&args.dir.join(name), text)?;
    }
    if !common.quiet {
        output::tell(format_args!("{:>12} {}", "Created", args.dir.display()));
    }
    Ok(0)
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|it| format!("{}: {it}", folder.display()))?;
    }
    fs::write(path, text).map_err(|it| format!("{}: {it}", path.display()))
}
