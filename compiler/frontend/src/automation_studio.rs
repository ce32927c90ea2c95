//! Programs of B&R's Automation Studio. Each is a folder: `PROGRAM _INIT`, `_CYCLIC` and `_EXIT` are its parts, and its variables are in
//! files `.var`. It becomes a PROGRAM with the name of the folder. A library declares its functions in `.fun`, and their bodies are elsewhere.

mod edges;
mod members;
mod scopes;

use crate::Sources;
use crate::added::STARTED_UP;
use crate::ast::{
    Expr, ExprKind, File, Item, Name, Pou, PouKind, Statement, TypeDecl, TypeKind, VarBlock, VarDecl, VarKind,
};
use crate::spelling::Key;
use crate::start_up::once;
use crate::testing::tree::variables;
use rustc_hash::FxHashMap;

/// Functions that remember their last argument, each with the library unit that stores it.
pub(crate) const EDGES: [(&str, &str); 3] = [("EDGEPOS", "__EDGEPOS"), ("EDGENEG", "__EDGENEG"), ("EDGE", "__EDGE")];

const INIT: &str = "_INIT";
const CYCLIC: &str = "_CYCLIC";
const EXIT: &str = "_EXIT";

/// Puts the parts of programs and functions together. A function without a body that `is_known` is not one of the program's.
pub(crate) fn expand<'s>(files: &mut [File<'s>], sources: &'s Sources, is_known: &dyn Fn(&Pou<'_>) -> bool) {
    let shared = join(files, sources, is_known);
    if !sources.is_of_automation_studio() {
        return;
    }
    members::rename_types(files);
    scopes::expand(files, sources, &shared);
    members::expand(files, sources);
    let own = files.iter_mut().zip(sources.files()).filter(|it| !it.1.is_bundled());
    for item in own.flat_map(|it| &mut it.0.items) {
        match item {
            Item::Pou(pou) => {
                edges::expand(pou);
                rename_this(pou);
            }
            Item::Types(types) => types.iter_mut().for_each(number_values),
            Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => {}
        }
    }
}

/// Automation Studio has no THIS: a variable of a PROGRAM may be called so, and is called otherwise here.
fn rename_this(pou: &mut Pou<'_>) {
    const NAME: &str = "this_";
    let is_it = |it: &Name<'_>| it.text.eq_ignore_ascii_case("THIS");
    let declared = pou.blocks.iter_mut().flat_map(|it| &mut it.vars).flat_map(|it| &mut it.names);
    let mut declared = declared.filter(|it| is_it(it)).peekable();
    if pou.kind != PouKind::Program || declared.peek().is_none() {
        return;
    }
    declared.for_each(|it| it.text = NAME);
    let mut rename = |it: &mut Expr<'_>| match &mut it.kind {
        ExprKind::Name(name) if is_it(name) => name.text = NAME,
        _ => {}
    };
    edges::each_expr(&mut pou.body, &mut rename);
    pou.routines.iter_mut().for_each(|it| edges::each_expr(&mut it.body, &mut rename));
}

/// An enumeration is a DINT: in the C that Automation Studio makes of a program it is an enumeration of C's, which takes 4 bytes.
fn number_values(ty: &mut TypeDecl<'_>) {
    if let TypeKind::Enum { base: base @ None, .. } = &mut ty.ty.kind {
        *base = Some(Name { text: "DINT", span: ty.name.span });
    }
}

/// Gives the files whose CONSTANTs are those of a program, and of the types of its folder.
fn join<'s>(files: &mut [File<'s>], sources: &'s Sources, is_known: &dyn Fn(&Pou<'_>) -> bool) -> Vec<usize> {
    let paths: Vec<&'s str> = sources.files().iter().map(|it| it.path.as_str()).collect();
    join_functions(files, &paths, is_known);
    let folders: Vec<&'s str> = paths.iter().map(|it| folder_of(it)).collect();
    let mut programs: FxHashMap<&'s str, usize> = FxHashMap::default();
    for ((at, file), folder) in files.iter().enumerate().zip(&folders) {
        if file.items.iter().any(|it| part_of(it).is_some()) {
            programs.entry(folder).or_insert(at);
        }
    }
    let mut shared = Vec::new();
    let lists = constants(files, &paths);
    for (folder, first) in programs {
        let of_types = scopes::words_of_types(folder, sources);
        let mut parts: Vec<Pou<'s>> = Vec::new();
        let mut blocks: Vec<VarBlock<'s>> = Vec::new();
        let mut actions: Vec<Pou<'s>> = Vec::new();
        for at in (0..files.len()).filter(|at| folders.get(*at) == Some(&folder)) {
            let is_list = has_extension(paths[at], "var");
            actions.extend(std::mem::take(&mut files[at].apart).into_iter().map(|it| it.0));
            for item in std::mem::take(&mut files[at].items) {
                match item {
                    Item::Globals(mut block) if is_list => {
                        let is_shared = |it: &VarDecl<'s>| {
                            let is_it = |it: &Name<'s>| {
                                of_types.contains(&Key(it.text)) && lists.get(&Key(it.text)) == Some(&1)
                            };
                            it.names.iter().all(is_it)
                        };
                        let (of_all, own) = std::mem::take(&mut block.vars).into_iter().partition(is_shared);
                        blocks.push(VarBlock { kind: VarKind::Var, vars: own, ..block.clone() });
                        if !Vec::is_empty(&of_all) {
                            shared.push(at);
                            files[at].items.push(Item::Globals(VarBlock { vars: of_all, ..block }));
                        }
                    }
                    item if part_of(&item).is_some() => {
                        if let Item::Pou(pou) = item {
                            parts.push(pou);
                        }
                    }
                    item => files[at].items.push(item),
                }
            }
        }
        let program = program(folder, parts, blocks).map(|mut it| {
            it.routines.append(&mut actions);
            it
        });
        files[first].items.extend(program.map(Item::Pou));
    }
    shared
}

/// In how many places each CONSTANT is declared; what may change counts twice.
fn constants<'s>(files: &[File<'s>], paths: &[&str]) -> FxHashMap<Key<'s>, usize> {
    let mut found: FxHashMap<Key<'s>, usize> = FxHashMap::default();
    let lists = files.iter().zip(paths).filter(|it| has_extension(it.1, "var"));
    for item in lists.flat_map(|it| &it.0.items) {
        let Item::Globals(block) = item else { continue };
        let weight = if block.constant.is_some() { 1 } else { 2 };
        for name in block.vars.iter().flat_map(|it| &it.names) {
            *found.entry(Key(name.text)).or_default() += weight;
        }
    }
    found
}

fn folder_of(path: &str) -> &str {
    path.rsplit_once(['/', '\\']).map_or("", |it| it.0)
}

fn has_extension(path: &str, wanted: &str) -> bool {
    path.rsplit_once('.').is_some_and(|it| it.1.eq_ignore_ascii_case(wanted))
}

/// Which part of a program an item is.
fn part_of(item: &Item<'_>) -> Option<&'static str> {
    let Item::Pou(pou) = item else { return None };
    let is_it = |it: &&str| pou.kind == PouKind::Program && pou.name.text.eq_ignore_ascii_case(it);
    [INIT, CYCLIC, EXIT].into_iter().find(is_it)
}

/// The PROGRAM of a folder: what `_INIT` does runs once, before the first `_CYCLIC`. `_EXIT` runs where a program is taken off a
/// controller: it is an ACTION here, which nothing calls.
fn program<'s>(folder: &'s str, parts: Vec<Pou<'s>>, blocks: Vec<VarBlock<'s>>) -> Option<Pou<'s>> {
    let mut parts: Vec<(bool, Pou<'s>)> = parts.into_iter().map(|it| (Key(it.name.text) == Key(CYCLIC), it)).collect();
    parts.sort_by_key(|it| !it.0);
    let (_, first) = parts.first()?;
    let at = first.name.span;
    let mut program = Pou::new(PouKind::Program, Name { text: name_of(folder), span: at }, first.span);
    (program.extent, program.doc) = (first.extent, first.doc.clone());
    program.blocks = blocks;
    let (mut init, mut cyclic): (Vec<Statement<'s>>, Vec<Statement<'s>>) = (Vec::new(), Vec::new());
    for (_, part) in parts {
        program.blocks.extend(part.blocks);
        program.routines.extend(part.routines);
        match part.name.text {
            it if Key(it) == Key(INIT) => init.extend(part.body),
            it if Key(it) == Key(CYCLIC) => cyclic.extend(part.body),
            _ => {
                let action =
                    Pou { body: part.body, extent: part.extent, ..Pou::new(PouKind::Action, part.name, part.span) };
                program.routines.push(action);
            }
        }
    }
    if !init.is_empty() {
        program.blocks.push(variables(&[(STARTED_UP, &["BOOL"])], at));
        cyclic.insert(0, once(init, at));
    }
    program.body = cyclic;
    Some(program)
}

/// The last part of a folder's path, where that can be a name.
fn name_of(folder: &str) -> &str {
    let name = folder.rsplit(['/', '\\']).next().unwrap_or_default();
    let is_name = name.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_')
        && name.bytes().all(|it| it.is_ascii_alphanumeric() || it == b'_');
    if is_name { name } else { "Main" }
}

/// Gives the bodies of functions and function blocks the declarations in files `.fun`.
fn join_functions<'s>(files: &mut [File<'s>], paths: &[&'s str], is_known: &dyn Fn(&Pou<'_>) -> bool) {
    let mut heads: FxHashMap<Key<'s>, Pou<'s>> = FxHashMap::default();
    let is_list = |at: usize| paths.get(at).is_some_and(|it| has_extension(it, "fun"));
    if !(0..files.len()).any(is_list) {
        return;
    }
    let bodies: Vec<Key<'s>> = (0..files.len()).filter(|at| !is_list(*at)).flat_map(|at| names(&files[at])).collect();
    let mut stubs: Vec<Pou<'s>> = Vec::new();
    for at in (0..files.len()).filter(|at| is_list(*at)) {
        for item in std::mem::take(&mut files[at].items) {
            match item {
                Item::Pou(pou) if bodies.contains(&Key(pou.name.text)) => {
                    heads.insert(Key(pou.name.text), pou);
                }
                Item::Pou(pou) if is_known(&pou) => {}
                // Its body is not among the sources.
                Item::Pou(pou) if stubs.iter().any(|it| is_the_same(it, &pou)) => {}
                Item::Pou(pou) => {
                    let pou = Pou { is_stub: true, ..pou };
                    stubs.push(pou.clone());
                    files[at].items.push(Item::Pou(pou));
                }
                item => files[at].items.push(item),
            }
        }
    }
    for item in files.iter_mut().flat_map(|it| &mut it.items) {
        let Item::Pou(pou) = item else { continue };
        if let Some(head) = heads.remove(&Key(pou.name.text)) {
            pou.blocks.splice(0..0, head.blocks);
            pou.result = pou.result.take().or(head.result);
            pou.doc = pou.doc.take().or(head.doc);
        }
    }
}

/// Whether two declarations without bodies have the same name and parameters: two libraries of Automation Studio declare RF_TRIG.
fn is_the_same(one: &Pou<'_>, other: &Pou<'_>) -> bool {
    let shown = |pou: &Pou<'_>| {
        let blocks: Vec<_> = pou.blocks.iter().filter(|it| it.kind != VarKind::Var).map(|it| it.kind).collect();
        blocks
    };
    let parameters = |pou: &Pou<'_>| {
        let shown = pou.blocks.iter().filter(|it| it.kind != VarKind::Var);
        let names = shown.flat_map(|it| &it.vars).flat_map(|it| &it.names);
        names.map(|it| it.text.to_ascii_lowercase()).collect::<Vec<_>>()
    };
    Key(one.name.text) == Key(other.name.text)
        && one.kind == other.kind
        && shown(one) == shown(other)
        && parameters(one) == parameters(other)
}

fn names<'s>(file: &File<'s>) -> Vec<Key<'s>> {
    let pous = file.items.iter().filter_map(|it| match it {
        Item::Pou(pou) => Some(Key(pou.name.text)),
        Item::Types(_) | Item::Globals(_) | Item::Configuration(_) | Item::Test(_) => None,
    });
    pous.collect()
}
