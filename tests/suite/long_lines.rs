//! Declarations on a line that is longer than a place has columns: none takes the value, the path or the storage of another.

use staunch_frontend::{Options, Source, Sources};
use staunch_ir::Retain;
use staunch_tests::execute::{Settings, agree};
use staunch_tests::long_line::{MODULE, VALUES, program};
use staunch_tests::scan::Table;

#[test]
fn declarations_beyond_the_last_column_are_distinct_on_all_executors() {
    let mut sources = Sources::default();
    sources.add(Source::new("program.st", program()));
    let compilation = staunch_frontend::compile(&sources, &Options::default());
    let program = compilation.program.unwrap_or_else(|| panic!("{:?}", compilation.diagnostics));
    let (paths, values): (Vec<_>, Vec<_>) = VALUES.into_iter().unzip();
    let table = Table::parse(&format!("|,{}\n|,{}\n", paths.join(","), values.join(","))).unwrap();
    let outcome = agree(&program, MODULE, &table, &Settings::default()).unwrap();
    let found: Vec<_> =
        paths.iter().zip(&outcome.table.rows[0].outputs).map(|(path, it)| (*path, it.as_str())).collect();
    assert_eq!(found, VALUES);
    let field = |name: &str| program.structs.iter().flat_map(|it| &it.fields).find(|it| it.name == name).unwrap();
    assert_eq!((field("kept").retain, field("anew").retain), (Retain::Kept, Retain::Inherited));
}
