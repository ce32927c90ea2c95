//! Projects of OpenPLC Editor, which are folders: what is read of one, and where problems are reported.

use super::{Folder, has};

const PROJECT: &str = r#"{
  "meta": { "name": "tank", "type": "plc-project" },
  "data": {
    "dataTypes": [],
    "pous": [],
    "libraries": [],
    "configuration": { "resource": {
      "tasks": [ { "name": "task0", "triggering": "Cyclic", "interval": "T#20ms", "priority": 1 } ],
      "instances": [ { "name": "instance0", "task": "task0", "program": "main" } ],
      "globalVariables": []
    } }
  }
}
"#;

const MAIN: &str = "PROGRAM main
  VAR
    full : BOOL AT FloatSwitch; (* the float *)
    pump : BOOL AT %QX0.0 := FALSE;
    level : UINT AT %MW0 := 20;
    pulses : Pulses;
    mode : Mode;
  END_VAR

  pulses(go := NOT full);
  level := level + pulses.count;
  pump := NOT full;
  mode := Filling;
END_PROGRAM
";

const PULSES: &str = "FUNCTION_BLOCK Pulses
  VAR_INPUT
    go : BOOL;
  END_VAR
  VAR_OUTPUT
    count : UINT;
  END_VAR
  IF go THEN count := count + 1; END_IF;
END_FUNCTION_BLOCK
";

const PINS: &str = r#"{
  "Arduino Uno": [
    { "pin": "2", "pinType": "digitalInput", "address": "%IX0.0", "alias": "FloatSwitch" },
    { "pin": "7", "pinType": "digitalOutput", "address": "%QX0.0", "alias": "" }
  ],
  "Arduino Mega": [ { "pin": "62", "pinType": "digitalInput", "address": "%IX0.3", "alias": "FloatSwitch" } ]
}
"#;

const FOLDERS: [&str; 7] =
    ["pous/programs", "pous/function-blocks", "pous/functions", "datatypes", "devices/remote", "build/src", ".git"];

fn project(name: &str) -> Folder {
    let folder = Folder::with(name, &[("project.json", PROJECT)]);
    FOLDERS.iter().for_each(|it| std::fs::create_dir_all(folder.0.join(it)).unwrap());
    folder.write("pous/programs/main.st", MAIN);
    folder.write("pous/function-blocks/Pulses.st", PULSES);
    folder.write("datatypes/Mode.dt", "TYPE\n  Mode : (Idle, Filling) := Idle;\nEND_TYPE\n");
    folder.write("devices/configuration.json", r#"{ "deviceBoard": "Arduino Uno", "vendorScreenData": {} }"#);
    folder.write("devices/pin-mapping.json", PINS);
    // What the editor generates is not the program.
    folder.write("build/src/program.st", MAIN);
    folder
}

#[test]
fn a_folder_or_its_project_is_one_program() {
    let folder = project("openplc");
    folder.write("in.csv", "scan,full\n1,FALSE\n3,TRUE\n");
    let expected = "scan,time_ms,full,level,pump,mode\n1,0,FALSE,21,TRUE,Filling\n2,20,FALSE,23,TRUE,Filling\n\
                    3,40,TRUE,25,FALSE,Filling\n";
    for source in [".", "project.json"] {
        let run = format!("run {source} --stimulus in.csv --scans 3 --vars full,level,pump,mode --trace -");
        assert_eq!(folder.staunch(&run).out(0), expected, "{source}");
        has(&folder.staunch(&format!("check {source}")).err(0), &["Checked project.json\n"]);
    }
    let all = folder.staunch("check . -v").err(0);
    has(&all, &["pous/programs/main.st", "pous/function-blocks/Pulses.st", "datatypes/Mode.dt"]);
    assert!(!all.contains("build/src"), "{all}");
    folder.write("staunch.toml", "files = [\"project.json\"]\n");
    has(&folder.staunch("check").err(0), &["Checked project.json"]);
    has(&folder.staunch("build --emit rust -o -").out(0), &["pous/programs/main.st"]);
}

/// The garage of the examples, as a file and as a project.
#[test]
fn a_project_does_what_its_program_does_in_a_file() {
    let folder = Folder::new("openplc-garage");
    let examples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../st_examples");
    let run = |source: &str| {
        let (source, inputs) = (examples.join(source), examples.join("openplc_garage/stimulus.csv"));
        let options = "--scans 14 --vars CarIn,CarOut,Cars.CV,Full,Empty --trace -";
        let command = format!("run {} --stimulus {} {options}", source.display(), inputs.display());
        folder.staunch(&command).out(0)
    };
    std::fs::copy(examples.join("openplc_garage/garage_v4.st"), folder.0.join("garage_v4.st")).unwrap();
    let plain = folder.staunch(&format!(
        "run garage_v4.st --dialect openplc4 --stimulus {} --scans 14 --vars CarIn,CarOut,Cars.CV,Full,Empty --trace -",
        examples.join("openplc_garage/stimulus.csv").display()
    ));
    assert_eq!(run("openplc_project"), plain.out(0));
    assert_eq!(run("openplc_project/project.json"), run("openplc_project"));
}

#[test]
fn a_project_below_a_folder_is_one_too() {
    let folder = project("openplc-below");
    let outer = Folder::new("openplc-above");
    let inner = outer.0.join("plc");
    std::fs::rename(&folder.0, &inner).unwrap();
    outer.write("test.st", "{dialect 'openplc4'}\nTEST 'counts'\nVAR p : Pulses; END_VAR\np(go := TRUE);\nASSERT(p.count = 1);\nEND_TEST\n");
    has(&outer.staunch("check . -v").err(0), &["plc/pous/programs/main.st"]);
    has(&outer.staunch("test .").out(0), &["counts"]);
}

#[test]
fn what_a_pin_is_called_documents_its_variable() {
    let folder = project("openplc-pins");
    let rust = folder.staunch("build . --emit rust -o -").out(0);
    has(&rust, &["the float: pin 2 (FloatSwitch)", "/// pin 7\n"]);
    folder.write("devices/configuration.json", r#"{ "deviceBoard": "Arduino Mega" }"#);
    has(&folder.staunch("build . --emit rust -o -").out(0), &["the float: pin 62 (FloatSwitch)"]);
    let unknown = folder.staunch("check .").err(0);
    assert!(!unknown.contains("warning"), "{unknown}");
    folder.write("devices/configuration.json", r#"{ "deviceBoard": "OpenPLC Simulator" }"#);
    has(&folder.staunch("check .").err(0), &["W0413", "`FloatSwitch`", "pous/programs/main.st:3:20"]);
    let points = r#"{ "name": "io", "protocol": "modbus-tcp", "modbusTcpConfig": { "ioGroups": [ { "ioPoints": [
        { "name": "a", "iecLocation": "%IX2.0", "alias": "FloatSwitch" }, { "iecLocation": "%IX2.1", "alias": "" } ] } ] } }"#;
    folder.write("devices/remote/io.json", points);
    has(&folder.staunch("build . --emit rust -o -").out(0), &["the float: FloatSwitch"]);
}

#[test]
fn pins_that_contradict_each_other_are_reported() {
    let folder = project("openplc-contradictions");
    let pins = r#"[
  { "pin": "2", "pinType": "digitalInput", "address": "%IX0.0", "name": "FloatSwitch" },
  { "pin": "3", "pinType": "digitalInput", "address": "%IX0.0", "name": "" },
  { "pin": "4", "pinType": "digitalOutput", "address": "%QX0.0", "name": "FloatSwitch" },
  { "pin": "5", "pinType": "digitalOutput", "address": "%IX0.5", "name": "" },
  { "pin": "6", "pinType": "analogInput", "address": "seven", "name": "" },
  "A0"
]
"#;
    folder.write("devices/pin-mapping.json", pins);
    let found = folder.staunch("check . --message-format short").err(1);
    let expected = [
        "devices/pin-mapping.json:3:55: error[E0033]: `%IX0.0` is the address of two pins, `2` and `3`",
        "devices/pin-mapping.json:4:74: error[E0033]: `FloatSwitch` is the alias of two pins, `2` and `4`",
        "devices/pin-mapping.json:5:56: error[E0033]: `%IX0.5` is not an address of this kind of pin, `%QX…`",
        "devices/pin-mapping.json:6:54: error[E0033]: `seven` is not an address",
        "devices/pin-mapping.json:7:3: error[E0033]: a pin of OpenPLC Editor must be an object, not a string",
    ];
    has(&found, &expected);
}

#[test]
fn the_dialect_is_that_of_the_editor() {
    let folder = project("openplc-dialect");
    folder.write("pous/programs/main.st", "PROGRAM main VAR c : CTD; END_VAR c(CD := TRUE, PV := 1); END_PROGRAM\n");
    let dialect = |folder: &Folder, arguments: &str| {
        let rust = folder.staunch(&format!("build . --emit rust -o - {arguments}")).out(0);
        if rust.contains("openplc4::Ctd") { "openplc4" } else { "another" }
    };
    assert_eq!(dialect(&folder, ""), "openplc4");
    assert_eq!(dialect(&folder, "--dialect openplc"), "another");
    folder.write("devices/configuration.json", r#"{ "deviceBoard": "OpenPLC Runtime v3", "vendorScreenData": {} }"#);
    assert_eq!(dialect(&folder, ""), "another");
    folder.write("devices/configuration.json", r#"{ "deviceBoard": "OpenPLC Runtime v4" }"#);
    assert_eq!(dialect(&folder, ""), "openplc4");
    folder.write("staunch.toml", "dialect = \"openplc\"\n");
    assert_eq!(dialect(&folder, ""), "another");
    std::fs::remove_file(folder.0.join("staunch.toml")).unwrap();
    folder.write("project.json", PROJECT.replace("\"libraries\": [],", ""));
    folder.write("devices/pin-mapping.json", "[]");
    assert_eq!(dialect(&folder, ""), "another");
}

#[test]
fn bodies_in_other_languages_are_refused_by_name() {
    let folder = project("openplc-languages");
    let ladder = MAIN.replace("PROGRAM main", "(* lamps *)\n\nPROGRAM lamps");
    let (head, _) = ladder.split_once("  pulses(go").unwrap();
    let body = "{\n  \"name\": \"lamps\",\n  \"rungs\": [ { \"comment\": \"END_VAR\" } ]\n}\nEND_PROGRAM";
    folder.write("pous/programs/lamps.sfc", format!("{head}{body}"));
    folder.write("pous/function-blocks/Native.cpp", "FUNCTION_BLOCK Native\nVAR_INPUT\n  id : INT := 3; // END_VAR\nEND_VAR\n#include <CAN.h>\nint x; (*\nEND_FUNCTION_BLOCK\n");
    folder.write(
        "pous/functions/Area.py",
        "FUNCTION Area : REAL\nVAR_INPUT\n  w, h : REAL;\nEND_VAR\ndef area():\n  return w * h\nEND_FUNCTION",
    );
    folder.write("pous/functions/Empty.il", "FUNCTION Empty : INT");
    folder.write("pous/functions/Note.il", "remember this");
    folder.write("pous/programs/main.st", MAIN.replace("mode := Filling;", "mode := Area(w := 2.0, h := 3.0);"));
    let found = folder.staunch("check . --message-format short").err(1);
    let expected = [
        "pous/programs/lamps.sfc:12:1: error[E0902]: the body of `lamps` is a sequential function chart (SFC), not Structured Text",
        "pous/functions/Area.py:5:1: error[E0902]: the body of `Area` is Python, not Structured Text",
        "pous/functions/Empty.il:1:20: error[E0902]: the body of `Empty` is Instruction List (IL), not Structured Text",
        "pous/functions/Note.il:1:1: error",
        // What they declare counts.
        "pous/programs/main.st:13:",
    ];
    has(&found, &expected);
    assert!(!found.contains("Native"), "nothing calls it: {found}");
}

/// A diagram is read, and what is in C++ is refused where it is called.
#[test]
fn diagrams_are_read_and_code_in_cpp_is_refused_where_it_is_called() {
    let folder = project("openplc-diagrams");
    let node = |id: &str, kind: &str, data: &str| {
        format!(r#"{{ "id": "{id}", "type": "{kind}", "position": {{ "x": 0, "y": 0 }}, "data": {{ {data} }} }}"#)
    };
    let body = format!(
        r#"{{ "name": "lamps", "rungs": [ {{ "nodes": [ {}, {}, {} ], "edges": [
           {{ "source": "left", "target": "native" }}, {{ "source": "native", "sourceHandle": "done", "target": "lamp" }} ] }} ] }}"#,
        node("left", "powerRail", r#""variant": "left""#),
        node(
            "native",
            "block",
            r#""numericId": "7", "variable": { "name": "native" }, "variant": { "name": "Native", "type": "function-block", "variables": [] },
               "inputConnector": { "id": "go" }, "outputConnector": { "id": "done" },
               "inputHandles": [ { "id": "go" } ], "outputHandles": [ { "id": "done" } ]"#,
        ),
        node("lamp", "coil", r#""variable": { "name": "lamp" }"#),
    );
    let head = "PROGRAM lamps\nVAR\n  native : Native;\n  lamp : BOOL;\nEND_VAR\n";
    folder.write("pous/programs/lamps.ld", format!("{head}{body}\nEND_PROGRAM"));
    let block = "FUNCTION_BLOCK Native\nVAR_INPUT\n  go : BOOL;\nEND_VAR\nVAR_OUTPUT\n  done : BOOL;\nEND_VAR\n";
    folder.write("pous/function-blocks/Native.cpp", format!("{block}#include <CAN.h>\nEND_FUNCTION_BLOCK\n"));
    let found = folder.staunch("check . --message-format short").err(1);
    has(&found, &["pous/programs/lamps.ld:", "error[E0902]: `Native` has code in C"]);
    std::fs::remove_file(folder.0.join("pous/function-blocks/Native.cpp")).unwrap();
    folder.write("pous/function-blocks/Native.st", format!("{block}done := NOT go;\nEND_FUNCTION_BLOCK\n"));
    folder.staunch("check .").err(0);
}

#[test]
fn a_pou_is_in_one_file() {
    let folder = project("openplc-twice");
    let json = r#"{ "type": "function-block", "data": { "language": "st", "name": "Pulses", "variables": [],
      "body": { "language": "st", "value": "wrong(" }, "documentation": "" } }"#;
    // The editor reads the text where there is one.
    folder.write("pous/function-blocks/Pulses.json", json);
    folder.staunch("check .").err(0);
    std::fs::remove_file(folder.0.join("pous/function-blocks/Pulses.st")).unwrap();
    has(&folder.staunch("check .").err(1), &["pous/function-blocks/Pulses.json:2:"]);
    folder.write("pous/function-blocks/Pulses.st", PULSES);
    folder.write("pous/function-blocks/Again.st", PULSES);
    has(&folder.staunch("check .").err(1), &["Again.st:1:16", "Pulses.st:1:16", "`Pulses` is declared twice"]);
    std::fs::remove_file(folder.0.join("pous/function-blocks/Again.st")).unwrap();
    folder
        .write("project.json", PROJECT.replace("\"pous\": []", &format!("\"pous\": [{}]", json.replace("wrong(", ""))));
    has(&folder.staunch("check .").err(1), &["project.json:5:", "`Pulses` is declared twice"]);
}

#[test]
fn damaged_files_are_reported_where_they_are_damaged() {
    let folder = project("openplc-damaged");
    let check = |folder: &Folder, parts: &[&str]| {
        let ran = folder.staunch("check . --message-format short");
        has(&ran.err(1), parts);
    };
    folder.write("project.json", PROJECT.replace("\"meta\":", "\"meta\""));
    check(&folder, &["project.json:2:10: error[E0033]: this file of OpenPLC Editor is not well-formed JSON: `:` is"]);
    folder.write("project.json", "");
    check(&folder, &["project.json:1:1: error[E0033]", "the file ends where a value is expected"]);
    folder.write("project.json", "[]");
    check(&folder, &["project.json:1:1: error[E0033]: a project of OpenPLC Editor must be an object, not a list"]);
    folder.write("project.json", format!("{}{}", "[".repeat(5000), "]".repeat(5000)));
    check(&folder, &["project.json:1:129: error[E0033]", "values are nested too deeply"]);
    folder.write("project.json", PROJECT.replace("\"main\"", "\"../main\""));
    check(&folder, &["project.json:9:73: error[E0033]: `../main` is not a name"]);
    folder.write("project.json", PROJECT.replace("\"main\"", "\"absent\""));
    check(&folder, &["project.json:9:", "`absent`"]);
    folder.write("project.json", PROJECT);
    folder.write("devices/pin-mapping.json", "{ \"Uno\": 5 }");
    check(&folder, &["devices/pin-mapping.json:1:3: error[E0033]: the pins of `Uno` are a number, not a list"]);
    folder.write("devices/pin-mapping.json", "{");
    check(&folder, &["devices/pin-mapping.json:1:1: error[E0033]", "this is not closed"]);
    folder.write("devices/pin-mapping.json", PINS);
    folder.write("pous/programs/more.json", "{ \"body\": 5, \"language\": 6, \"data\": 7 }");
    check(&folder, &["pous/programs/more.json:1:37: error[E0033]: `data` is a number here, but must be an object"]);
    // It is a project even without these.
    std::fs::remove_dir_all(folder.0.join("devices")).unwrap();
    std::fs::remove_file(folder.0.join("pous/programs/more.json")).unwrap();
    has(&folder.staunch("check .").err(0), &["W0413"]);
    // Other JSON is not a project.
    std::fs::remove_dir_all(folder.0.join("pous")).unwrap();
    folder.write("project.json", "{ \"dependencies\": {} }");
    has(&folder.staunch("check project.json").err(1), &["E0032", "JSON"]);
}

#[test]
fn a_project_moves_to_another_system() {
    let folder = project("openplc-moved");
    // The two keep different variables over a restart, which has nothing to do with the files.
    folder.staunch("compare . --from openplc4 --to codesys --write codesys.st").out(1);
    has(&folder.read("codesys.st"), &["full AT %IX0.0 : BOOL; (* the float *)", "level AT %MW0 : UINT := 20;"]);
    folder.staunch("check codesys.st --dialect codesys").err(0);
}

/// The folder of a project of Beremiz, or of the editors before v4, also has what they generate from it.
#[test]
fn a_project_in_one_file_of_xml_is_read_once() {
    let cases = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases/vendor");
    let xml = std::fs::read_to_string(cases.join("plcopen_ladder.st")).unwrap();
    let folder = Folder::with("beremiz", &[("plc.xml", xml.as_str()), ("beremiz.xml", "<BeremizRoot/>")]);
    std::fs::create_dir_all(folder.0.join("build")).unwrap();
    folder.write("build/plc.st", "PROGRAM Main\nVAR motor : BOOL; END_VAR\nmotor := TRUE;\nEND_PROGRAM\n");
    has(&folder.staunch("check . --dialect openplc").err(0), &["Checked plc.xml\n"]);
    folder.write("in.csv", "scan,start\n1,TRUE\n2,FALSE\n");
    let run = folder.staunch("run . --dialect openplc --stimulus in.csv --scans 2 --vars start,motor --trace -");
    assert_eq!(run.out(0), "scan,time_ms,start,motor\n1,0,TRUE,TRUE\n2,10,FALSE,TRUE\n");
    // Without the mark of a project it is a folder like others.
    std::fs::remove_file(folder.0.join("beremiz.xml")).unwrap();
    has(&folder.staunch("check . --dialect openplc").err(0), &["Checked build/plc.st\n"]);
}

/// MATIEC's comments end at the first `*)`, whether the file, the command or the settings name the dialect.
#[test]
fn comments_end_as_the_dialect_has_it() {
    let text = "PROGRAM Main VAR_OUTPUT y : INT; END_VAR\n(* (* *) y := y + 1; (* *)\nEND_PROGRAM\n";
    let folder = Folder::with("comments_of_matiec", &[("a.st", text)]);
    let run = "run a.st --scans 1 --vars y --trace - --dialect";
    assert_eq!(folder.staunch(&format!("{run} openplc")).out(0), "scan,time_ms,y\n1,0,1\n");
    has(&folder.staunch(&format!("{run} openplc4")).err(1), &["a.st:2:1", "comments nest"]);
    folder.write("staunch.toml", "files = [\"a.st\"]\ndialect = \"openplc\"\n");
    assert_eq!(folder.staunch("run --scans 1 --vars y --trace -").out(0), "scan,time_ms,y\n1,0,1\n");
}
