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

fn project(name: &str) -> Folder {
    let folder = Folder::with(name, &[("Line.plcproj", PROJECT), ("GVL_Line.TcGVL", LIST)]);
    std::fs::create_dir_all(folder.0.join("POUs")).unwrap();
    folder.write("POUs/MAIN.TcPOU", MAIN);
    folder.write("POUs/FB_Station.TcPOU", STATION);
    folder.write("in.csv", "scan,pulse,divisor\n1,TRUE,1\n2,FALSE,\n3,TRUE,\n4,,0\n");
    folder
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
    has(&folder.staunch("check Line.plcproj").err(2), &["Line.plcproj lists no source file"]);
    folder.write("Line.plcproj", PROJECT.replace("MAIN.TcPOU", "NONE.TcPOU"));
    has(&folder.staunch("check Line.plcproj").err(2), &["NONE.TcPOU"]);
}
