//! Pieces of files, and that reading takes time by the length of the file, whatever is in it.

use super::{Trouble, listed, read, read_named};
use crate::source::{Source, Span};

fn pou(declaration: &str, body: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<TcPlcObject><POU Name=\"P\"><Declaration><![CDATA[{declaration}]]></Declaration>\
         <Implementation><ST><![CDATA[{body}]]></ST></Implementation></POU></TcPlcObject>\n"
    )
}

/// The assembled text's words.
fn words(text: &str) -> String {
    read(text).unwrap().text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_declaration_says_how_its_unit_ends() {
    let ends = |declaration: &str| words(&pou(declaration, "")).rsplit(' ').next().unwrap().to_owned();
    assert_eq!(ends("PROGRAM P"), "END_PROGRAM");
    assert_eq!(ends("{attribute 'x'}\n// PROGRAM\n(* (* *) FUNCTION *) function_block P"), "END_FUNCTION_BLOCK");
    assert_eq!(ends("/* */ FUNCTION P : INT"), "END_FUNCTION");
    assert_eq!(ends("INTERFACE I"), "END_INTERFACE");
    assert_eq!(ends("TYPE T : INT; END_TYPE"), "END_TYPE");
}

#[test]
fn methods_properties_and_actions_are_before_the_body() {
    let text = "<TcPlcObject><POU Name='F'><Declaration>FUNCTION_BLOCK F</Declaration>\
        <Implementation><ST>body();</ST></Implementation>\
        <Property Name='V'><Declaration>PROPERTY V : INT</Declaration>\
        <Get Name='Get'><Declaration>VAR END_VAR</Declaration><Implementation><ST>V := 1;</ST></Implementation></Get>\
        <Set Name='Set'><Declaration/><Implementation><ST/></Implementation></Set></Property>\
        <Action Name='A'><Implementation><ST>x := a &lt; b;</ST></Implementation></Action>\
        <Method Name='M'><Declaration>METHOD M</Declaration><Implementation><ST>]]&gt;</ST></Implementation></Method>\
        </POU></TcPlcObject>";
    assert_eq!(
        words(text),
        "{dialect 'codesys'} FUNCTION_BLOCK F PROPERTY V : INT GET VAR END_VAR V := 1; END_GET SET END_SET \
         END_PROPERTY ACTION A x := a < b; END_ACTION METHOD M ]]> END_METHOD body(); END_FUNCTION_BLOCK"
    );
}

/// Each place of a text leads to the file, and back where it is verbatim.
#[test]
fn places_are_those_of_the_file() {
    let file = "\u{feff}".to_owned() + &pou("PROGRAM P\nVAR ä, n : INT; END_VAR", "(* ä *) n := 1;\nn := 2;");
    let source = Source::decode("P.TcPOU", file.as_bytes());
    for (word, count) in [("PROGRAM P", 1), ("n := 1", 1), ("n := 2", 1), ("ä *)", 1)] {
        assert_eq!(source.text.matches(word).count(), count);
        let start = u32::try_from(source.text.find(word).unwrap()).unwrap();
        let span = Span { file: 0, start, end: start + u32::try_from(word.len()).unwrap() };
        let placed = source.in_file(span);
        let whole = &source.file().text;
        assert_eq!(&whole[usize::try_from(placed.start).unwrap()..usize::try_from(placed.end).unwrap()], word);
        assert!(source.is_verbatim(span), "{word}");
        assert_eq!(source.in_text(placed.start), Some(start));
    }
    let line_2 = file.lines().nth(2).unwrap();
    let start = u32::try_from(source.text.find("n := 1").unwrap()).unwrap();
    let column = line_2[..line_2.find("n := 1").unwrap()].chars().count() + 1;
    assert_eq!(source.line_column(start), (3, u32::try_from(column).unwrap()));
}

/// Windows-1252 and UTF-16 are read as in other files.
#[test]
fn files_are_in_every_encoding() {
    let text = pou("PROGRAM P", "// ü\nn := 1;");
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let single: Vec<u8> = text.chars().map(|it| u8::try_from(u32::from(it)).unwrap()).collect();
    let utf_8 = Source::decode("P", text.as_bytes());
    for bytes in [[vec![0xFF, 0xFE], wide].concat(), single] {
        assert_eq!(Source::decode("P", &bytes).text, utf_8.text);
    }
}

#[test]
fn what_is_no_document_is_said_where() {
    for (text, at, why) in [
        ("<TcPlcObject><POU>", "<POU>", "not closed"),
        ("<TcPlcObject><POU></GVL></POU></TcPlcObject>", "</GVL>", "expected"),
        ("<TcPlcObject><POU><Declaration>&many;</Declaration></POU></TcPlcObject>", "&many;", "entity"),
        ("<TcPlcObject><POU><Declaration><![CDATA[PROGRAM", "<![CDATA[PROGRAM", ""),
        ("<TcPlcObject><POU/></TcPlcObject><extra/>", "<extra/>", "a second root element"),
        ("<TcPlcObject><POU/></TcPlcObject> x", " x", "text outside"),
        (&format!("<TcPlcObject>{}", "<a>".repeat(2000)), "<a>", "nested"),
    ] {
        let assembly = read(text).unwrap();
        let problem = assembly.problems.last().unwrap();
        assert_eq!(problem.trouble, Trouble::Broken);
        assert!(problem.message.contains(why), "{}", problem.message);
        let piece = assembly.pieces.iter().find(|it| it.start == problem.at).unwrap();
        assert!(text[usize::try_from(piece.at).unwrap()..].starts_with(at), "{text}: {piece:?}");
    }
}

/// Whatever is cut out of a file, reading ends, and its pieces cover the text.
#[test]
fn no_file_is_too_broken() {
    let whole = pou("PROGRAM P\nVAR ä : INT; END_VAR", "ä := 1 &lt; 2;");
    let cuts: Vec<usize> = (0..=whole.len()).filter(|it| whole.is_char_boundary(*it)).collect();
    for cut in cuts {
        for text in [&whole[..cut], &whole[cut..]] {
            let Some(assembly) = read(text) else { continue };
            let first = assembly.pieces.first().map(|it| it.start);
            assert_eq!(first.unwrap_or(0), 0);
            assert!(assembly.pieces.is_sorted_by_key(|it| it.start));
        }
    }
}

#[test]
fn large_files_take_time_by_their_length() {
    let many = |units: usize| {
        let unit = "<POU Name='P'><Declaration>FUNCTION P : INT</Declaration><Implementation><ST>P := 1 &lt; 2;</ST>\
            </Implementation></POU>";
        format!("<TcPlcObject>{}</TcPlcObject>", unit.repeat(units))
    };
    let time = |text: &str| {
        let start = std::time::Instant::now();
        assert!(read(text).unwrap().problems.is_empty());
        start.elapsed()
    };
    let (small, large) = (many(2_000), many(40_000));
    let (few, all) = (time(&small).max(time(&small)), time(&large));
    assert!(all < few * 100, "{few:?} for {} bytes, {all:?} for {}", small.len(), large.len());
}

#[test]
fn a_project_lists_what_it_compiles() {
    let project = "<Project><ItemGroup><Compile Include='POUs\\A.TcPOU'><SubType>Code</SubType></Compile>\
        <Compile Include='B.TcGVL' /><Compile Include='C.TcDUT'><ExcludeFromBuild>true</ExcludeFromBuild></Compile>\
        <Compile Include='D.TcIO'><ExcludeFromBuild>false</ExcludeFromBuild></Compile>\
        <None Include='E.tmc' /></ItemGroup></Project>";
    assert_eq!(listed(project).unwrap(), ["POUs\\A.TcPOU", "B.TcGVL", "D.TcIO"]);
    assert!(listed("<Solution/>").is_err());
    assert!(listed("PROGRAM P").is_err());
    assert!(listed("<Project><ItemGroup></Project>").is_err());
}

#[test]
fn a_project_excludes_files_and_folders() {
    let project = "<Project><ItemGroup><Compile Include='B.TcPOU'><SubType>Code</SubType></Compile>\
        <Compile Include='Old\\Older\\C.TcPOU'><SubType>Code</SubType></Compile><Compile Include='Olds\\D.TcPOU'/>\
        <Compile Include='A.TcPOU'><SubType>Code</SubType></Compile></ItemGroup><ItemGroup>\
        <Folder Include='old\\'><ExcludeFromBuild>true</ExcludeFromBuild></Folder>\
        <Folder Include='Olds'><ExcludeFromBuild>false</ExcludeFromBuild></Folder></ItemGroup></Project>";
    assert_eq!(listed(project).unwrap(), ["B.TcPOU", "Olds\\D.TcPOU", "A.TcPOU"]);
}

#[test]
fn a_file_that_holds_nothing_is_said() {
    for text in ["<TcPlcObject></TcPlcObject>", "<TcPlcObject/>"] {
        assert_eq!(read(text).unwrap().problems[0].message, "this TwinCAT file is empty");
    }
    let without = read("<TcPlcObject><POU Name='P'><Declaration/></POU></TcPlcObject>").unwrap();
    assert_eq!(without.problems[0].message, "`P` has no declaration");
    for (name, problems) in [("a/P.TcPOU", 1), ("P.st", 0)] {
        assert_eq!(Source::decode(name, b"\r\n").problems().len(), problems, "{name}");
    }
}

#[test]
fn declarations_that_are_elements_are_written_out() {
    let text = "<project xmlns='http://www.plcopen.org/xml/tc6_0201'><types><dataTypes><dataType name='A'><baseType><array>\
        <dimension lower='1' upper='N'/><dimension lower='0' upper='3'/><baseType><wstring length='4'/></baseType></array>\
        </baseType></dataType><dataType name='E'><baseType><enum><values><value name='X' value='3'/><value name='Y'/></values>\
        <baseType><BYTE/></baseType></enum></baseType></dataType></dataTypes><pous><pou name='F' pouType='function'>\
        <interface><returnType><pointer><baseType><derived name='A'/></baseType></pointer></returnType>\
        <inOutVars><variable name='a'><type><derived name='A'/></type></variable></inOutVars>\
        <localVars constant='true' retain='true'/></interface><body><ST>;</ST></body></pou></pous></types>\
        <instances><configurations><configuration name='C'><resource name='R'><task name='T' interval='PT0.5S' priority='2'>\
        <pouInstance name='M'/></task><pouInstance name='n' typeName='M'/></resource></configuration></configurations>\
        </instances></project>";
    assert_eq!(
        words(text),
        "TYPE A : ARRAY[1..N, 0..3] OF WSTRING[4]; END_TYPE TYPE E : (X := 3, Y) BYTE; END_TYPE \
         FUNCTION F : POINTER TO A VAR_IN_OUT a : A; END_VAR VAR CONSTANT RETAIN END_VAR ; END_FUNCTION \
         CONFIGURATION Config RESOURCE Res ON PLC TASK T(INTERVAL := T#0.5s, PRIORITY := 2); PROGRAM M WITH T : M; \
         PROGRAM n : M; END_RESOURCE END_CONFIGURATION"
    );
}

/// What is no Structured Text is passed over to its end, or to that of the file.
#[test]
fn sections_of_an_export_are_passed_over() {
    let export = |text: &str| words(&format!("\r\n(* @NESTEDCOMMENTS := 'Yes' *)\r\n{text}"));
    let head = "{dialect 'codesys'} (* @NESTEDCOMMENTS := 'Yes' *)";
    assert_eq!(export("LIBRARY\r\na.lib\r\nEND_LIBRARY\r\nx"), format!("{head} x"));
    assert_eq!(export("TYPE resource : INT; END_TYPE"), format!("{head} TYPE resource : INT; END_TYPE"));
    assert_eq!(export("resource := 1;"), format!("{head} resource := 1;"));
    assert_eq!(export("PROGRAM P\n_LD_BODY\n_NETWORK\nEND_PROGRAM\nx"), format!("{head} PROGRAM P END_PROGRAM x"));
    assert_eq!(export("RESOURCE\n"), head);
    assert!(read("(* a comment *) PROGRAM P").is_none());
}

#[test]
fn a_file_that_is_called_so_is_scl() {
    let text =
        "FUNCTION_BLOCK FB10\nVAR_INPUT a : INT; END_VAR\nCONST Top := 5; END_CONST\nBEGIN\nEND_FUNCTION_BLOCK\n";
    assert!(read(text).is_none());
    assert!(read_named("fb10.st", text).is_none());
    let read = read_named("S7/FB10.SCL", text).unwrap();
    assert!(read.problems.is_empty());
    assert!(read.text.contains("VAR CONSTANT Top : INT := 5; END_VAR") && !read.text.contains("BEGIN"));
}
