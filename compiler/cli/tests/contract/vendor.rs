//! Files of other systems: what names them, and what their names are in messages.

use super::{Folder, has};

const MAIN: &str = r#"<?xml version="1.0" encoding="utf-8"?>
<TcPlcObject Version="1.1.0.1">
  <POU Name="MAIN" Id="{a1}">
    <Declaration><![CDATA[PROGRAM MAIN
VAR_INPUT
    pulse : BOOL;
    divisor : INT := 1;
END_VAR
VAR
    station : FB_Station;
END_VAR
]]></Declaration>
    <Implementation>
      <ST><![CDATA[station(go := pulse);
GVL_Line.parts := station.Count() / divisor;]]></ST>
    </Implementation>
  </POU>
</TcPlcObject>
"#;

const STATION: &str = r#"<TcPlcObject><POU Name="FB_Station"><Declaration><![CDATA[FUNCTION_BLOCK FB_Station
VAR_INPUT go : BOOL; END_VAR
VAR parts : CTU; END_VAR
]]></Declaration><Implementation><ST><![CDATA[parts(CU := go, PV := 5);]]></ST></Implementation>
<Method Name="Count"><Declaration><![CDATA[METHOD Count : INT
]]></Declaration><Implementation><ST><![CDATA[Count := WORD_TO_INT(parts.CV);]]></ST></Implementation></Method>
</POU></TcPlcObject>
"#;

const LIST: &str = "<TcPlcObject><GVL Name=\"GVL_Line\"><Declaration><![CDATA[{attribute 'qualified_only'}
VAR_GLOBAL parts : INT; END_VAR
]]></Declaration></GVL></TcPlcObject>
";

const PROJECT: &str = r#"<Project xmlns="http://schemas.microsoft.com/developer/msbuild/2003"><ItemGroup>
    <Compile Include="POUs\MAIN.TcPOU"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\FB_Station.TcPOU"><SubType>Code</SubType></Compile>
    <Compile Include="GVL_Line.TcGVL"><SubType>Code</SubType></Compile>
    <Compile Include="POUs\Gone.TcPOU"><ExcludeFromBuild>true</ExcludeFromBuild></Compile>
</ItemGroup></Project>
"#;

pub(super) fn project(name: &str) -> Folder {
    let folder = Folder::with(name, &[("Line.plcproj", PROJECT), ("GVL_Line.TcGVL", LIST)]);
    std::fs::create_dir_all(folder.0.join("POUs")).unwrap();
    folder.write("POUs/MAIN.TcPOU", MAIN);
    folder.write("POUs/FB_Station.TcPOU", STATION);
    folder.write("in.csv", "scan,pulse,divisor\n1,TRUE,1\n2,FALSE,\n3,TRUE,\n4,,0\n");
    folder
}

/// In an object of JSON, `rendered` is what a person sees: it has the same places, and the same help.
#[test]
fn json_shows_places_of_vendors_files_as_people_see_them() {
    let folder = project("json_vendor");
    folder.write("POUs/MAIN.TcPOU", MAIN.replace("go := pulse", "go := pluse"));
    let err = folder.staunch("check Line.plcproj").err(1);
    let out = folder.staunch("check Line.plcproj --message-format json").out(1);
    let diagnostic: serde_json::Value = serde_json::from_str(out.lines().next().unwrap()).unwrap();
    let rendered = diagnostic["rendered"].as_str().unwrap();
    assert!(err.starts_with(rendered), "{err}\nand\n{rendered}");
    has(rendered, &["MAIN.TcPOU:14:", "did you mean `pulse`?"]);
}

#[test]
fn a_project_of_twincat_is_written_as_structured_text() {
    let folder = project("converted");
    let run = "--stimulus in.csv --scans 3 --vars GVL_Line.parts --trace -";
    let before = folder.staunch(&format!("run Line.plcproj {run}")).out(0);
    has(&folder.staunch("convert Line.plcproj -o line.st").err(0), &["Converted Line.plcproj to line.st"]);
    has(&folder.read("line.st"), &["// POUs/MAIN.TcPOU\n", "parts(CU := go, PV := 5);", "END_FUNCTION_BLOCK"]);
    assert_eq!(folder.staunch(&format!("run line.st {run}")).out(0), before);
    assert_eq!(folder.staunch("convert Line.plcproj -o -").out(0), folder.read("line.st"));
    // A file in the dialect that the command line names does not depend on it any more.
    folder.write("words.st", "PROGRAM Main VAR c : CTU; w : WORD; END_VAR c(RESET := FALSE); w := c.CV; END_PROGRAM\n");
    folder.staunch("convert words.st -o named.st --dialect codesys").out(0);
    folder.staunch("check named.st").out(0);
    // The file that is written is not a source, and a program with a mistake is not written.
    has(&folder.staunch("convert line.st -o line.st").err(2), &["line.st"]);
    folder.write("wrong.st", "PROGRAM Main VAR n : INT; END_VAR n := m; END_PROGRAM");
    has(&folder.staunch("convert wrong.st -o other.st").err(1), &["`m` is not declared"]);
    assert!(!folder.0.join("other.st").exists());
}

/// The name of a list is its file's, which one text does not have.
#[test]
fn what_files_say_beside_their_text_is_not_lost() {
    let files = [
        ("main.st", "PROGRAM Main VAR n : INT; END_VAR n := Line.speed; END_PROGRAM\n"),
        ("Line.st", "VAR_GLOBAL speed : INT := 7; END_VAR\n"),
    ];
    let folder = Folder::with("beside_the_text", &files);
    let said = folder.staunch("convert main.st Line.st -o all.st --dialect codesys").err(1);
    has(
        &said,
        &[
            "as one file of ST the program would be another",
            "in line 3 of that text: `Line` is not declared",
            "nothing was written",
        ],
    );
    assert!(!folder.0.join("all.st").exists());
}

#[test]
fn a_project_of_twincat_runs_as_it_lies() {
    let folder = project("twincat");
    for source in ["Line.plcproj", "."] {
        let trace = folder.staunch(&format!("run {source} --stimulus in.csv --scans 3 --vars parts --trace -"));
        assert_eq!(trace.out(0), "scan,time_ms,parts\n1,0,1\n2,10,1\n3,20,2\n");
    }
    let faulted = folder.staunch("run Line.plcproj --stimulus in.csv --scans 4 --vars parts --trace -").err(3);
    has(&faulted, &["division by zero", "POUs/MAIN.TcPOU:15:"]);
    let rust = folder.staunch("build Line.plcproj --emit rust -o -").out(0);
    has(&rust, &["POUs/MAIN.TcPOU", "// :14", "// :15"]);
}

#[test]
fn a_program_knows_the_names_of_its_project_and_task() {
    let folder = project("twincat-names");
    let task = "<TcPlcObject Version=\"1.1.0.1\"><Task Name=\"PlcTask\" Id=\"{b1}\"><CycleTime>4000</CycleTime><Priority>20</Priority>\
                <PouCall><Name>MAIN</Name></PouCall></Task></TcPlcObject>\n";
    folder.write("PlcTask.TcTTO", task);
    let listed =
        "<ItemGroup><Compile Include=\"PlcTask.TcTTO\"><SubType>Code</SubType></Compile></ItemGroup></Project>";
    let named = "<PropertyGroup><Name>BottlingLine</Name></PropertyGroup><ItemGroup>";
    folder.write("Line.plcproj", PROJECT.replacen("<ItemGroup>", named, 1).replacen("</Project>", listed, 1));
    let body = "task := _TaskInfo[1].TaskName; project := _AppInfo.ProjectName; cycle := _TaskInfo[1].CycleTime;";
    let variables = "station : FB_Station; task, project : STRING; cycle : UDINT;";
    let main = MAIN.replacen("station : FB_Station;", variables, 1);
    folder.write("POUs/MAIN.TcPOU", main.replacen("<ST><![CDATA[", &format!("<ST><![CDATA[{body}"), 1));
    let trace = folder.staunch("run Line.plcproj --scans 2 --trace - --vars task,project,cycle").out(0);
    assert_eq!(
        trace,
        "scan,time_ms,task,project,cycle\n1,0,PlcTask,BottlingLine,40000\n2,4,PlcTask,BottlingLine,40000\n"
    );
}

#[test]
fn a_project_has_enumerations_with_texts() {
    let folder = project("twincat_texts");
    let list = "<TcPlcObject><EnumerationTextList Name=\"E_Part\"><Declaration><![CDATA[TYPE E_Part : (None, One := 7); END_TYPE
]]></Declaration><XmlArchive><Data><v n=\"None\">\"no part\"</v></Data></XmlArchive></EnumerationTextList></TcPlcObject>
";
    folder.write("E_Part.TcTLEO", list);
    folder.write("POUs/MAIN.TcPOU", MAIN.replace("station.Count() / divisor", "E_Part.One"));
    folder.write("Line.plcproj", PROJECT.replace("</ItemGroup>", "<Compile Include=\"E_Part.TcTLEO\"/></ItemGroup>"));
    for source in ["Line.plcproj", "."] {
        let trace = folder.staunch(&format!("run {source} --scans 1 --vars parts --trace -"));
        assert_eq!(trace.out(0), "scan,time_ms,parts\n1,0,7\n");
    }
}

#[test]
fn what_a_project_defines_decides_what_is_compiled() {
    let folder = project("twincat-defines");
    let body =
        "{IF defined(SIMULATION) AND defined(FAST)}{error 'both'}{ELSIF defined(SIMULATION)}{error 'slow'}{END_IF}
        {IF hasvalue(LINE, '2')}{error 'line two'}{END_IF}";
    folder.write("POUs/MAIN.TcPOU", MAIN.replacen("<ST><![CDATA[", &format!("<ST><![CDATA[{body}"), 1));
    folder.staunch("check Line.plcproj").out(0);
    let defined = [
        ("simulation", "slow"),
        ("SIMULATION, FAST", "both"),
        ("FAST;SIMULATION=1", "both"),
        ("FAST, Line := '2'", "line two"),
    ];
    for (defines, expected) in defined {
        let properties =
            format!("<PropertyGroup><CompilerDefines>{defines}</CompilerDefines></PropertyGroup><ItemGroup>");
        folder.write("Line.plcproj", PROJECT.replacen("<ItemGroup>", &properties, 1));
        has(&folder.staunch("check Line.plcproj").err(1), &["E0110", expected]);
    }
}

#[test]
fn a_comparison_sees_what_a_project_defines() {
    let folder = project("twincat-compared");
    let defines = "<PropertyGroup><CompilerDefines>FAST</CompilerDefines></PropertyGroup><ItemGroup>";
    folder.write("Line.plcproj", PROJECT.replacen("<ItemGroup>", defines, 1));
    let body = "{IF defined(FAST)}parts(CU := go, PV := 5);{ELSE}parts(CU := TRUE, PV := 1);{END_IF}";
    let station = STATION.replacen("parts(CU := go, PV := 5);", body, 1);
    folder.write("POUs/FB_Station.TcPOU", station.replacen("WORD_TO_INT(parts.CV)", "7", 1));
    // The list's name and its attribute are CODESYS's alone.
    let main = MAIN.replacen("GVL_Line.parts := station.Count() / divisor;", "divisor := station.Count();", 1);
    folder.write("POUs/MAIN.TcPOU", main);
    let list = "<TcPlcObject><GVL Name=\"G\"><Declaration><![CDATA[VAR_GLOBAL x : INT; END_VAR]]></Declaration></GVL></TcPlcObject>";
    folder.write("GVL_Line.TcGVL", list);
    for (to, call) in [("iec", "parts(CU := go, PV := 5);"), ("logix", "parts.PRE := 5; CTU(parts, go);")] {
        let compared = format!("compare Line.plcproj --from codesys --to {to} --budget 2000 --write {to}.st");
        let output = folder.staunch(&compared);
        let written = folder.read(&format!("{to}.st"));
        assert!(
            written.starts_with(&format!("{{dialect '{to}'}}\n{{define FAST}}\n")) && written.contains(call),
            "{written}{}",
            output.out(1)
        );
        folder.staunch(&format!("check {to}.st --dialect {to}")).out(0);
    }
}

#[test]
fn messages_name_the_file_with_its_lines() {
    let folder = project("twincat-messages");
    folder.write("POUs/MAIN.TcPOU", MAIN.replace("station.Count()", "station.Counts()"));
    let short = folder.staunch("check Line.plcproj --message-format short").err(1);
    has(&short, &["POUs/MAIN.TcPOU:15:27: error[E0"]);
    let json = folder.staunch("check Line.plcproj --message-format json").out(1);
    let first: serde_json::Value = serde_json::from_str(json.lines().next().unwrap()).unwrap();
    let text = folder.read("POUs/MAIN.TcPOU");
    assert_eq!(first["spans"][0]["line_start"], 15);
    assert_eq!(first["spans"][0]["byte_start"], text.find("Counts").unwrap());
}

#[test]
fn a_project_that_cannot_be_read_is_said() {
    let folder = project("twincat-projects");
    folder.write("Line.plcproj", PROJECT.replace("</ItemGroup>", ""));
    has(&folder.staunch("check Line.plcproj").err(2), &["Line.plcproj", "XML"]);
    folder.write("Line.plcproj", "<Project></Project>");
    has(&folder.staunch("check Line.plcproj").err(2), &["Line.plcproj does not list a source file"]);
    folder.write("Line.plcproj", PROJECT.replace("MAIN.TcPOU", "NONE.TcPOU"));
    let absent = folder.staunch("check Line.plcproj").err(1);
    has(&absent, &["E0033", "POUs/NONE.TcPOU:1:1", "the project lists `NONE.TcPOU`, but the file does not exist"]);
    // No condition is blamed for what is not known of its declarations.
    let asks = MAIN.replacen("GVL_Line.parts :=", "{IF defined(task: FastTask)} {END_IF} GVL_Line.parts :=", 1);
    folder.write("POUs/MAIN.TcPOU", asks);
    folder.write("Line.plcproj", PROJECT.replacen("<ItemGroup>", "<ItemGroup><Compile Include=\"NONE.TcPOU\"/>", 1));
    let absent = folder.staunch("check Line.plcproj --message-format short").err(1);
    assert!(absent.contains("the project lists `NONE.TcPOU`") && !absent.contains("E0902"), "{absent}");
    folder.write("POUs/MAIN.TcPOU", MAIN);
    // As Windows finds it.
    folder.write("Line.plcproj", PROJECT.replace("MAIN.TcPOU", "Main.TCPOU"));
    has(&folder.staunch("check Line.plcproj -v").err(0), &["POUs/MAIN.TcPOU"]);
}

#[test]
fn tasks_say_what_runs() {
    let folder = project("twincat-tasks");
    let idle = "<TcPlcObject><POU Name=\"Idle\"><Declaration>PROGRAM Idle</Declaration></POU></TcPlcObject>";
    folder.write("POUs/Idle.TcPOU", idle);
    let task = |name: &str, calls: &str| {
        let call = format!("<PouCall><Name>{calls}</Name></PouCall>");
        format!("<TcPlcObject><Task Name=\"{name}\"><CycleTime>2000</CycleTime>{call}</Task></TcPlcObject>")
    };
    folder.write("Fast.TcTTO", task("Fast", "MAIN"));
    folder.write("Slow.TcTTO", task("Slow", "MAIN"));
    let with = |tasks: &[&str]| {
        let files = tasks.iter().chain(&["POUs\\Idle.TcPOU"]).map(|it| format!("<Compile Include=\"{it}\"/>"));
        PROJECT.replacen("<ItemGroup>", &format!("<ItemGroup>{}", files.collect::<String>()), 1)
    };
    folder.write("Line.plcproj", with(&["Fast.TcTTO"]));
    // What is checked is the project, and not its first file.
    has(&folder.staunch("check Line.plcproj").err(0), &["Checked Line.plcproj"]);
    let idle = folder.staunch("run Line.plcproj --program idle").err(2);
    has(&idle, &["no task or CONFIGURATION runs the PROGRAM `Idle`; there is MAIN"]);
    has(&folder.staunch("run Line.plcproj --program None").err(2), &["there is no PROGRAM `None`; there is MAIN"]);
    folder.write("Line.plcproj", with(&["Fast.TcTTO", "Slow.TcTTO"]));
    folder.staunch("check Line.plcproj").err(0);
    let slow = folder.staunch("run Line.plcproj --program Slow_MAIN --scans 1").out(0);
    has(&slow, &["1 scan of MAIN"]);
}

#[test]
fn a_solution_leads_to_its_project() {
    let folder = project("twincat-solution");
    let solution = "\u{feff}\nMicrosoft Visual Studio Solution File, Format Version 12.00\n\
        Project(\"{B1E7}\") = \"Plant\", \"Plant\\Plant.tsproj\", \"{6FA2}\"\nEndProject\n\
        Project(\"{FAE0}\") = \"View\", \"View\\View.csproj\", \"{1}\"\nEndProject\n";
    std::fs::create_dir_all(folder.0.join("Plant/_Config/PLC")).unwrap();
    folder.write("Plant.sln", solution);
    let inline = |more: &str| {
        let line = r#"<Project Name="Line" PrjFilePath="..\Line.plcproj"/>"#;
        format!("<TcSmProject><Project><Plc>{line}{more}</Plc></Project></TcSmProject>")
    };
    folder.write("Plant/Plant.tsproj", inline(""));
    has(&folder.staunch("check Plant.sln -v").err(0), &["POUs/MAIN.TcPOU"]);
    // A part of it in a file of its own.
    folder.write("Plant/Plant.tsproj", r#"<TcSmProject><Plc><Project File="Line.xti"/></Plc></TcSmProject>"#);
    let part = r#"<TcSmItem><Project Name="Line" PrjFilePath="..\..\..\Line.plcproj"/></TcSmItem>"#;
    folder.write("Plant/_Config/PLC/Line.xti", part);
    has(&folder.staunch("check Plant.sln -v").err(0), &["POUs/MAIN.TcPOU"]);
    // Each PLC project is a program of its own.
    folder.write("Other.plcproj", PROJECT);
    folder.write("Plant/Plant.tsproj", inline(r#"<Project PrjFilePath="..\Other.plcproj"/>"#));
    let several = folder.staunch("check Plant.sln").err(2);
    has(&several, &["2 PLC projects; name one of them: Line.plcproj, Other.plcproj"]);
    folder.write("Plant.sln", solution.replace("tsproj", "vcxproj"));
    has(&folder.staunch("check Plant.sln").err(2), &["Plant.sln does not list a PLC project"]);
}

#[test]
fn libraries_of_the_project_file_are_used_and_not_judged() {
    let main = "PROGRAM Main VAR x : INT; END_VAR x := Own(1) + Vendors(2); END_PROGRAM";
    let own = "FUNCTION Own : INT VAR_INPUT a : INT; END_VAR VAR unused : INT; END_VAR Own := a; END_FUNCTION";
    let stub = "FUNCTION Vendors : INT VAR_INPUT a : INT; END_VAR END_FUNCTION PROGRAM Try Vendors(1); END_PROGRAM";
    let toml = "files = [\"src\"]\nlibraries = [\"lib/own.st\", \"lib/stubs\"]\ndeny = [\"warnings\"]\n";
    let folder = Folder::with("libraries", &[("staunch.toml", toml)]);
    for name in ["src", "lib/stubs"] {
        std::fs::create_dir_all(folder.0.join(name)).unwrap();
    }
    folder.write("src/main.st", main);
    folder.write("lib/own.st", own);
    folder.write("lib/stubs/vendor.st", stub);
    folder.staunch("check").out(0);
    // A file that is named has the libraries of the project that it is in.
    folder.staunch("check src/main.st").out(0);
    let refused = folder.staunch("run --scans 1").err(1);
    has(&refused, &["error[E0318]: `Vendors` has no implementation", "src/main.st:1:", "lib/stubs/vendor.st"]);
    folder
        .write("lib/stubs/vendor.st", stub.replace("END_VAR END_FUNCTION", "END_VAR Vendors := 40 + a; END_FUNCTION"));
    assert_eq!(folder.staunch("run --scans 1 --trace -").out(0), "scan,time_ms,x\n1,0,43\n");
}

#[test]
fn a_library_is_called_as_the_project_refers_to_it() {
    let folder = project("referring_to_a_library");
    let references = r#"<PlaceholderReference Include="Plant_Core"><DefaultResolution>Plant Core, *</DefaultResolution>
        <Namespace>Core</Namespace></PlaceholderReference></ItemGroup></Project>"#;
    folder.write("Line.plcproj", PROJECT.replace("</ItemGroup></Project>", references));
    folder.write("POUs/FB_Station.TcPOU", STATION.replace("parts : CTU;", "parts : CTU; base : Core.FB_Base;"));
    let missing = folder.staunch("check Line.plcproj").err(1);
    has(&missing, &["there is no namespace `Core`", "the project refers to a library by this name"]);
    has(&missing, &["libraries = [\"…/Plant_Core.plcproj\"]"]);
    std::fs::create_dir_all(folder.0.join("Plant_Core")).unwrap();
    folder.write("Plant_Core/base.st", "{dialect 'codesys'} FUNCTION_BLOCK FB_Base END_FUNCTION_BLOCK");
    folder.write("staunch.toml", "libraries = [\"Plant_Core\"]");
    folder.staunch("check Line.plcproj").err(0);
}

/// Libraries that are not available are reported once, not each name; one of the same solution is found by its title or name.
#[test]
fn a_library_is_missing_once_or_in_the_solution() {
    let folder = project("library_in_the_solution");
    let references = r#"<PlaceholderReference Include="Core"><Namespace>Core</Namespace></PlaceholderReference>
        <PlaceholderReference Include="Tc2_System"><Namespace>Tc2_System</Namespace></PlaceholderReference>
        </ItemGroup></Project>"#;
    folder.write("Line.plcproj", PROJECT.replace("</ItemGroup></Project>", references));
    folder.write(
        "POUs/FB_Station.TcPOU",
        STATION.replace("parts : CTU;", "parts : CTU; base : FB_Base; list : ST_List;"),
    );
    let missing = folder.staunch("check Line.plcproj").err(1);
    has(&missing, &["the project refers to a library that is not available: `Core`", "unknown: `FB_Base`, `ST_List`"]);
    has(&missing, &["rejected with 1 error"]);
    std::fs::create_dir_all(folder.0.join("Core")).unwrap();
    let base = "{dialect 'codesys'} FUNCTION_BLOCK FB_Base END_FUNCTION_BLOCK TYPE ST_List : STRUCT n : INT; END_STRUCT; END_TYPE";
    folder.write("Core/base.st", base);
    let core =
        r#"<Project><ItemGroup><Compile Include="base.st"><SubType>Code</SubType></Compile></ItemGroup></Project>"#;
    folder.write("Core/Core.plcproj", core);
    let solution = "Microsoft Visual Studio Solution File, Format Version 12.00\n\
        Project(\"{B1E7}\") = \"Line\", \"Line.plcproj\", \"{1}\"\nEndProject\n\
        Project(\"{B1E7}\") = \"Core\", \"Core\\Core.plcproj\", \"{2}\"\nEndProject\n";
    folder.write("Plant.sln", solution);
    folder.staunch("check Line.plcproj").err(0);
    // A library's name is its title; MSBuild writes some characters of a path as their numbers.
    std::fs::rename(folder.0.join("Core/base.st"), folder.0.join("Core/base (1) 100%.st")).unwrap();
    std::fs::remove_file(folder.0.join("Core/Core.plcproj")).unwrap();
    folder.write("Plant.sln", solution.replace("Core.plcproj", "Parts.plcproj"));
    let titled = core.replace("<Project>", "<Project><PropertyGroup><Title>Core</Title></PropertyGroup>");
    folder.write("Core/Parts.plcproj", titled.replace("base.st", "base %281%29 100%.st"));
    folder.staunch("check Line.plcproj").err(0);
    std::fs::remove_file(folder.0.join("Plant.sln")).unwrap();
    folder.staunch("check Line.plcproj").err(1);
    folder.write("staunch.toml", "libraries = [\"Core/Parts.plcproj\"]");
    folder.staunch("check Line.plcproj").err(0);
}

/// A file that holds nothing but VAR_GLOBAL is a list by its name, also where the start of a variable needs code.
#[test]
fn a_list_with_a_computed_initial_value_keeps_its_name() {
    let main = "FUNCTION Next : INT VAR_INPUT a : INT; END_VAR Next := a + 1; END_FUNCTION
PROGRAM Main VAR k, l : INT; END_VAR k := GVL.base; l := GVL.computed; END_PROGRAM
";
    for attribute in ["", "{attribute 'qualified_only'}\n"] {
        let list = format!("{attribute}VAR_GLOBAL base : INT := 4; computed : INT := Next(7); END_VAR\n");
        let folder = Folder::with("computed_list", &[("GVL.st", &list), ("main.st", main)]);
        let ran = folder.staunch("run . --dialect codesys --scans 1 --trace - --vars k,l -q");
        assert_eq!(ran.out(0), "scan,time_ms,k,l\n1,0,4,8\n");
    }
}

/// TIA Portal exports data types and data blocks in files of their own; a picture cache of Windows is called `.db`, too.
#[test]
fn a_folder_of_tia_portal_holds_types_and_data_blocks() {
    let files = [
        ("Part.udt", "TYPE \"Part\"\nVERSION : 0.1\n   STRUCT\n      weight : Int := 3;\n   END_STRUCT;\nEND_TYPE\n"),
        (
            "Line.db",
            "DATA_BLOCK \"Line\"\nVERSION : 0.1\n   STRUCT\n      part : \"Part\";\n   END_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
        ),
        ("Thumbs.db", "\u{0}\u{1}\u{2}"),
        (
            "Main.scl",
            "ORGANIZATION_BLOCK \"Main\"\nBEGIN\n\t\"Line\".part.weight := \"Line\".part.weight + 1;\nEND_ORGANIZATION_BLOCK\n",
        ),
    ];
    let folder = Folder::with("tia_folder", &files);
    let trace = folder.staunch("run . --scans 2 --vars Line.part.weight --trace -").out(0);
    assert_eq!(trace, "scan,time_ms,Line.part.weight\n1,0,4\n2,10,5\n");
}

#[test]
fn what_no_other_program_reads_is_named() {
    let binary = "\u{0}\u{1}\u{2}\u{0}";
    let files = [("Main.TcPOU", binary), ("Line.project", binary), ("Tools.library", binary), ("Line.ACD", binary)];
    let folder = Folder::with("protected", &files);
    has(&folder.staunch("check Main.TcPOU").err(1), &["an encrypted file of TwinCAT", "take the encryption off"]);
    has(&folder.staunch("check Line.project").err(1), &["a project of CODESYS", "PLCopen XML"]);
    has(&folder.staunch("check Tools.library").err(1), &["a library of CODESYS or TwinCAT", "`libraries`"]);
    has(&folder.staunch("check Line.ACD").err(1), &["a project of Logix Designer", "L5X"]);
}

/// `_INIT` runs once, before `_CYCLIC`; the variables of a folder are its program's, others are global.
#[test]
fn programs_of_automation_studio_are_folders() {
    let folder =
        Folder::with("automation_studio", &[("Global.var", "(* all *)\nVAR\n\tgCount : INT := 100;\nEND_VAR\n")]);
    for name in ["Press", "Lib"] {
        std::fs::create_dir_all(folder.0.join(name)).unwrap();
    }
    folder.write(
        "Press/Variables.var",
        "VAR\n\tstep : INT := 3;\n\tramp : MyRamp;\nEND_VAR\nVAR CONSTANT\n\tMOST : INT := 6;\nEND_VAR\n",
    );
    folder.write("Press/Types.typ", "TYPE\n\tLevel : STRUCT\n\t\tx : INT;\n\tEND_STRUCT;\nEND_TYPE\n");
    folder.write(
        "Press/Main.st",
        "PROGRAM _INIT\n\tstep := 4;\n\tgCount := gCount + 1;\nEND_PROGRAM\n\nPROGRAM _CYCLIC\n\tIF step < MOST THEN step := step + 1; END_IF;\n\
         \tramp(up := TRUE);\n\tgCount := gCount + ramp.out + Twice(step);\nEND_PROGRAM\n\nPROGRAM _EXIT\n\tstep := 0;\nEND_PROGRAM\n",
    );
    folder.write(
        "Lib/Lib.fun",
        "FUNCTION_BLOCK MyRamp\n\tVAR_INPUT\n\t\tup : BOOL;\n\tEND_VAR\n\tVAR_OUTPUT\n\t\tout : INT;\n\tEND_VAR\nEND_FUNCTION_BLOCK\n\
         FUNCTION Twice : INT\n\tVAR_INPUT\n\t\tx : INT;\n\tEND_VAR\nEND_FUNCTION\n",
    );
    folder.write(
        "Lib/Lib.st",
        "FUNCTION_BLOCK MyRamp\n\tIF up THEN out := out + 1; END_IF\nEND_FUNCTION_BLOCK\nFUNCTION Twice\n\tTwice := 2 * x;\nEND_FUNCTION\n",
    );
    let trace = folder.staunch("run . --scans 3 --vars Press.step,gCount --trace -").out(0);
    assert_eq!(trace, "scan,time_ms,Press.step,gCount\n1,0,5,112\n2,10,6,126\n3,20,6,141\n");
    // A mistake is where it is written.
    folder
        .write("Press/Variables.var", "VAR\n\tstep : INT := 3;\nEND_VAR\nVAR CONSTANT\n\tMOST : INT := 6;\nEND_VAR\n");
    has(&folder.staunch("check .").err(1), &["Press/Main.st:8:", "`ramp`"]);
}

/// What the files of Automation Studio have that no other system has, with the values that the C has which it makes of them.
#[test]
fn automation_studio_has_its_own_words() {
    let folder =
        Folder::with("automation_studio_words", &[("Modes.typ", MODES), ("Global.var", "VAR gMode : Mode; END_VAR")]);
    for name in ["Operator", "Lib", "Press", "Mill"] {
        std::fs::create_dir_all(folder.0.join(name)).unwrap();
    }
    folder.write("Operator/Operator.fun", OPERATOR);
    folder.write("Lib/Lib.fun", LIB);
    folder.write("Lib/Lib.st", LIB_BODY);
    folder.write("Press/Press.var", PRESS);
    folder.write("Press/Press.st", PRESS_BODY);
    folder.write("Press/Work.st", "ACTION Work:\n\tworked := worked + 1;\nEND_ACTION\n");
    folder.write("Press/Press.typ", "TYPE Local : STRUCT a : INT; END_STRUCT; END_TYPE");
    folder
        .write("Mill/Mill.typ", "TYPE Local : STRUCT b : STRING[MOST]; inner : INT; Inner : INT; END_STRUCT; END_TYPE");
    folder.write(
        "Mill/Mill.var",
        "VAR it : Local := (0); END_VAR VAR CONSTANT MOST : INT := 3; LEAST : INT := 1; END_VAR",
    );
    folder.write("Mill/Mill.st", "PROGRAM _CYCLIC\n\tit.b := 'abcd';\n\tit.inner := MOST - LEAST;\nEND_PROGRAM\n");
    let vars = "Press.worked,Press.rises,Press.falls,Press.changes,Press.number,Press.reader.Type,Press.sample.Type";
    for backend in ["interpret", "native", "rust"] {
        let run =
            format!("run . --program Press --dialect codesys --backend {backend} --scans 4 --vars {vars} --trace -");
        assert_eq!(folder.staunch(&run).out(0), WORDS_TRACE, "{backend}");
    }
    let trace = folder
        .staunch("run . --program Mill --dialect codesys --scans 1 --vars Mill.it.b,Mill.it.inner --trace -")
        .out(0);
    assert_eq!(trace, "scan,time_ms,Mill.it.b,Mill.it.inner\n1,0,abc,2\n");
    // Which of two members is meant is not known where their names differ by capitals alone.
    folder.write("Mill/Mill.st", "PROGRAM _CYCLIC\n\tit.Inner := 1;\nEND_PROGRAM\n");
    has(&folder.staunch("check . --dialect codesys").err(1), &["Mill/Mill.typ:1:", "`Inner` is declared twice"]);
    // A call of what has no body is refused where the program is built.
    folder
        .write("Lib/Lib.fun", format!("{LIB}FUNCTION memcpy : UDINT VAR_INPUT pDest : UDINT; END_VAR END_FUNCTION\n"));
    folder.write("Mill/Mill.st", "PROGRAM _CYCLIC\n\tmemcpy(ADR('ab'));\nEND_PROGRAM\n");
    folder.staunch("check . --dialect codesys").out(0);
    has(&folder.staunch("run . --program Mill --dialect codesys --scans 1").err(1), &["Mill/Mill.st:2:", "`memcpy`"]);
    // What an address is that is a number is not known before the program runs.
    folder.write("Mill/Mill.var", "VAR it : REFERENCE TO Local; address : UDINT; END_VAR");
    folder.write("Mill/Mill.st", "PROGRAM _CYCLIC\n\tit ACCESS address;\nEND_PROGRAM\n");
    has(&folder.staunch("check . --dialect codesys").err(1), &["Mill/Mill.st:2:", "after ACCESS"]);
    // An ACTION needs a program in its folder.
    folder.write("Lib/Work.st", "ACTION Work:\nEND_ACTION\n");
    has(&folder.staunch("check . --dialect codesys").err(1), &["Lib/Work.st:1:", "ACTION"]);
}

/// A comment ends at the first `*)`, and one that looks like SCL's names is a comment.
const MODES: &str = "TYPE\n\tMode : (mOFF, mBIG := 70000); (*which (*it is*) (* *) (*#CMD#;*)\n\
     Sample : STRUCT Type : INT; (*#PAR#;*) Continue : BOOL; Until : INT; Constant : INT; END_STRUCT;\n\
     logRead : STRUCT a : INT; END_STRUCT;\nEND_TYPE\n";
const OPERATOR: &str = "{REDUND_OK} FUNCTION AND : ANY VAR_INPUT IN1 : ANY; IN2 : ANY; END_VAR END_FUNCTION\n\
     {REDUND_OK} FUNCTION EDGEPOS : BOOL VAR_INPUT IN : BOOL; END_VAR END_FUNCTION\n\
     {REDUND_OK} FUNCTION MAX : ANY VAR_INPUT IN1 : ANY; IN2 : ANY; END_VAR END_FUNCTION\n\
     {REDUND_OK} FUNCTION_BLOCK TON VAR_INPUT IN : BOOL; PT : TIME; END_VAR VAR_OUTPUT Q : BOOL; ET : TIME; END_VAR VAR \
     M : BOOL; END_VAR END_FUNCTION_BLOCK\n\
     FUNCTION st_ident : UINT VAR_INPUT ST_ident : {REDUND_UNREPLICABLE} UDINT; END_VAR END_FUNCTION\n";
const LIB: &str = "{REDUND_ERROR} FUNCTION_BLOCK Reader VAR_INPUT Source : REFERENCE TO Sample; END_VAR VAR_OUTPUT Type : INT; \
     END_VAR VAR edges : INT; END_VAR END_FUNCTION_BLOCK\n\
     FUNCTION_BLOCK LogRead VAR_INPUT on : BOOL; END_VAR VAR inner : logRead; END_VAR END_FUNCTION_BLOCK\n";
const LIB_BODY: &str = "FUNCTION_BLOCK Reader\n\tType := Source.Type + 1;\n\tIF EDGEPOS(Type > 5) THEN edges := edges + 1; END_IF\n\
     Source.Continue := edges > 0;\nEND_FUNCTION_BLOCK\n";
const PRESS: &str = "VAR\n\tworked, rises, falls, changes : INT; number : DINT; toggles : BOOL; sample : Sample := (0);\n\
     this : REFERENCE TO Sample; reader : Reader; local : Local; entry : logRead; unused : LogRead; END_VAR\n";
/// `toggles` is TRUE, FALSE, TRUE, FALSE: a call that is not reached keeps what it was given last.
const PRESS_BODY: &str = "PROGRAM _INIT\n\tthis ACCESS ADR(sample);\n\treader.Source := ADR(sample);\nEND_PROGRAM\n\
     PROGRAM _CYCLIC\n\ttoggles := NOT toggles;\n\tIF EDGEPOS(toggles) THEN rises := rises + 1; END_IF\n\
     IF EDGENEG(toggles) THEN falls := falls + 1; END_IF\n\
     CASE worked OF 0: Work; 1: Work(); END_CASE\n\
     IF EDGE(toggles) OR EDGEPOS(worked > 1) THEN changes := changes + 1; END_IF\n\
     gMode := mBIG;\n\tnumber := gMode + 1;\n\tentry.a := 5;\n\tthis.Type := MAX(4, worked + entry.a);\n\treader();\n\
     FOR local.a := 0 TO 9 DO IF this.Continue THEN EXIT; END_IF END_FOR\nEND_PROGRAM\n";
const WORDS_TRACE: &str = "scan,time_ms,Press.worked,Press.rises,Press.falls,Press.changes,Press.number,Press.reader.Type,\
     Press.sample.Type\n1,0,1,1,0,1,70001,7,6\n2,10,2,1,1,2,70001,8,7\n3,20,2,2,1,3,70001,8,7\n4,30,2,2,2,4,70001,8,7\n";
