//! Lists of global variables that are files of their own.

use super::{Folder, has};

const MAIN: &str = "PROGRAM Main VAR n : INT; END_VAR n := _Line2.speed; END_PROGRAM\n";
const LIST: &str = "VAR_GLOBAL speed : INT := 7; END_VAR\n";

#[test]
fn lists_are_named_after_their_files() {
    let folder = Folder::with("list_of_a_file", &[("main.st", MAIN), ("_Line2.st", LIST), ("2Line.st", LIST)]);
    let trace = "--dialect codesys --scans 1 --vars n --trace -";
    has(&folder.staunch(&format!("run main.st _Line2.st {trace}")).out(0), &["1,0,7"]);
    folder.write("main.st", MAIN.replace("_Line2.", ""));
    has(&folder.staunch(&format!("run main.st _Line2.st {trace}")).out(0), &["1,0,7"]);
    // A file whose name is not an identifier gives no list a name.
    has(&folder.staunch(&format!("run main.st 2Line.st {trace}")).out(0), &["1,0,7"]);
}

#[test]
fn lists_have_their_attribute_from_the_first_byte_on() {
    let list = format!("{{attribute 'qualified_only'}} {LIST}");
    let folder = Folder::with("list_of_a_file_alone", &[("main.st", MAIN), ("_Line2.st", &list)]);
    folder.staunch("check main.st _Line2.st --dialect codesys").out(0);
    folder.write("main.st", MAIN.replace("_Line2.", ""));
    has(&folder.staunch("check main.st _Line2.st --dialect codesys").err(1), &["write `_Line2.speed`"]);
}

#[test]
fn lists_are_files_of_globals_alone_in_a_dialect_that_names_them() {
    let folder = Folder::with("lists_that_are_none", &[("main.st", MAIN)]);
    let texts = [
        format!("{{dialect 'iec'}}\n{LIST}"),
        format!("{LIST}TYPE T : INT; END_TYPE\n"),
        format!("NAMESPACE Plant\n{LIST}END_NAMESPACE\n"),
    ];
    for text in texts {
        folder.write("_Line2.st", text);
        has(&folder.staunch("check main.st _Line2.st --dialect codesys").err(1), &["`_Line2` is not declared"]);
    }
}

#[test]
fn what_a_list_holds_is_named_in_full_from_outside() {
    let main = "PROGRAM Main\nPanel.count := Panel.count + BOOL_TO_INT(Panel.able); Line.count := Panel.most[2];\nEND_PROGRAM\n";
    let panel = "VAR_GLOBAL able : BOOL; count : INT; most : ARRAY[1..2] OF INT := [3, 4]; END_VAR\n";
    let line = "NAMESPACE Line VAR_GLOBAL count : INT; END_VAR END_NAMESPACE\n";
    let stimulus = "scan,Panel.able\n2,TRUE\n";
    let files = [("main.st", main), ("Panel.st", panel), ("line.st", line), ("in.csv", stimulus)];
    let folder = Folder::with("named_in_full", &files);
    let run = "run main.st Panel.st line.st --dialect codesys --scans 2 --stimulus in.csv --trace -";
    // A name that two lists have is shown in full, too.
    let all = folder.staunch(run).out(0);
    has(&all, &["scan,time_ms,able,Panel.count,most[1],most[2],Line.count", "2,10,TRUE,1,3,4,4"]);
    let some = folder.staunch(&format!("{run} --vars line.COUNT,Panel.count,Panel.most[2],Globals.able")).out(0);
    has(
        &some,
        &["scan,time_ms,line.COUNT,Panel.count,Panel.most[2],Globals.able", "1,0,4,0,4,FALSE", "2,10,4,1,4,TRUE"],
    );
    let err = folder.staunch(&format!("{run} --vars Panel.cuont")).err(2);
    has(&err, &["`Panel` has no variable `cuont`; did you mean `count`?"]);
}
