//! Keywords that are nearly written: `ENDIF`, `END_FOOR`, `VAR INPUT`, `SWITCH`.

use crate::{
    ast::{Expr, ExprKind},
    lex::Kind,
    spelling::abbreviates,
};

use super::{
    diagnostics,
    parser::{In, TokenReader},
    token_class::{is_pou_end, opens_item},
};

/// `ENDIF`, `ELSEIF`: the keyword that a name at the start of a statement stands for.
fn misspelt_word(word: &str) -> Option<Kind> {
    const WORDS: [(&str, Kind); 16] = [
        ("ELSEIF", Kind::Elsif),
        ("ELSE_IF", Kind::Elsif),
        ("ELIF", Kind::Elsif),
        ("ENDIF", Kind::EndIf),
        ("ENDFOR", Kind::EndFor),
        ("ENDWHILE", Kind::EndWhile),
        ("ENDCASE", Kind::EndCase),
        ("END_SWITCH", Kind::EndCase),
        ("ENDSWITCH", Kind::EndCase),
        ("ENDREPEAT", Kind::EndRepeat),
        ("ENDVAR", Kind::EndVar),
        ("ENDSTRUCT", Kind::EndStruct),
        ("ENDTYPE", Kind::EndType),
        ("ENDPROGRAM", Kind::EndProgram),
        ("ENDFUNCTION", Kind::EndFunction),
        ("ENDFUNCTION_BLOCK", Kind::EndFunctionBlock),
    ];
    WORDS.iter().find(|(it, _)| word.eq_ignore_ascii_case(it)).map(|(_, kind)| *kind)
}

/// The end that a name stands for, with the kind after it, and how many tokens that takes:
/// `ENDIF`, `END_FOOR`, `END IF`, `END_PROG`. The ends of blocks that are `open`, from the innermost on, come first.
pub fn misspelt_end(word: &str, next: Kind, open: impl Iterator<Item = Kind>) -> Option<(Kind, usize)> {
    let rest = word.get(..3).filter(|it| it.eq_ignore_ascii_case("END")).and_then(|_| word.get(3..))?;
    if rest.is_empty() {
        return misspelt_word(&format!("END{}", next.keyword()?)).map(|kind| (kind, 2));
    }
    if let Some(kind) = misspelt_word(word) {
        return Some((kind, 1));
    }
    let open: Vec<Kind> = open.collect();
    let near = || (word.len() > 4).then(|| nearest_of(word, &open).or_else(|| nearest_of(word, ENDS))).flatten();
    abbreviated_end(rest, &open).or_else(near).map(|kind| (kind, 1))
}

/// The end whose block a word names by its first letters, by some of its letters, or with letters after it: `_PROG`,
/// `_FUNC_BLOCK`, `_FB`, `_VARS`. LOOP is any loop.
fn abbreviated_end(rest: &str, open: &[Kind]) -> Option<Kind> {
    let plain = |it: &str| it.replace('_', "").to_ascii_uppercase();
    let stem = plain(rest);
    if matches!(stem.as_str(), "LOOP" | "DO") {
        let is_loop = |it: &&Kind| matches!(it, Kind::EndFor | Kind::EndWhile | Kind::EndRepeat);
        return open.iter().find(is_loop).copied();
    }
    let find = |is: fn(&str, &str) -> bool| {
        let own = |it: &Kind| it.keyword().and_then(|it| it.strip_prefix("END_")).map(plain);
        open.iter().copied().find(|it| own(it).is_some_and(|own| is(&stem, &own)))
    };
    let is_long_enough = stem.len() > 1;
    let by_first = |stem: &str, own: &str| own.starts_with(stem);
    let by_more = |stem: &str, own: &str| stem.strip_prefix(own).is_some_and(|it| it.len() < 3);
    is_long_enough.then(|| find(by_first).or_else(|| find(by_more)).or_else(|| find(abbreviates))).flatten()
}

const ENDS: &[Kind] = &[
    Kind::EndIf,
    Kind::EndFor,
    Kind::EndWhile,
    Kind::EndCase,
    Kind::EndRepeat,
    Kind::EndVar,
    Kind::EndStruct,
    Kind::EndType,
    Kind::EndProgram,
    Kind::EndFunction,
    Kind::EndFunctionBlock,
];

const SECTIONS: &[Kind] = &[
    Kind::VarInput,
    Kind::VarOutput,
    Kind::VarInOut,
    Kind::VarTemp,
    Kind::VarStat,
    Kind::VarGlobal,
    Kind::VarExternal,
];

const QUALIFIERS: &[Kind] = &[Kind::Constant, Kind::Retain, Kind::NonRetain, Kind::Persistent];

const OPENERS: &[Kind] = &[Kind::While, Kind::Repeat, Kind::Case, Kind::For, Kind::If, Kind::Elsif, Kind::Return];

const ITEMS: &[Kind] =
    &[Kind::Program, Kind::FunctionBlock, Kind::Function, Kind::Type, Kind::Configuration, Kind::VarGlobal];

fn nearest_of(word: &str, kinds: &[Kind]) -> Option<Kind> {
    let near = crate::spelling::nearest(word, kinds.iter().filter_map(|it| it.keyword()))?;
    kinds.iter().copied().find(|it| it.keyword() == Some(near))
}

/// The misspelt keyword at the current place, and how many tokens it takes: `END IF` has two.
pub fn misspelt(input: &mut In<'_, '_, '_>) -> Option<(Kind, usize)> {
    if input.kind() != Kind::Name {
        return None;
    }
    let span = input.here();
    let (word, next) = (input.text(span), input.kind_ahead(1));
    if let Some(found) = misspelt_end(word, next, open_ends(input)) {
        return Some(found);
    }
    if word.eq_ignore_ascii_case("FI") && waits_for(input, Kind::EndIf) {
        return Some((Kind::EndIf, 1));
    }
    if word.eq_ignore_ascii_case("WEND") && waits_for(input, Kind::EndWhile) {
        return Some((Kind::EndWhile, 1));
    }
    if word.eq_ignore_ascii_case("NEXT") && next == Kind::Name && waits_for(input, Kind::EndFor) {
        let at = input.number();
        let state = input.state();
        let joined = !state.breaks(state.place(at).end, state.place(at + 1).start);
        return Some((Kind::EndFor, if joined { 2 } else { 1 }));
    }
    if word.eq_ignore_ascii_case("END") || (word.eq_ignore_ascii_case("NEXT") && waits_for(input, Kind::EndFor)) {
        let after = usize::from(next == Kind::Semicolon) + 1;
        let after = input.kind_ahead(after);
        return innermost(input, after).map(|end| (end, 1));
    }
    let section = match word.to_ascii_uppercase().as_str() {
        "VARIN" | "VAR_IN" | "VARINPUT" | "VAR_INPUTS" => Some(Kind::VarInput),
        "VAROUT" | "VAR_OUT" | "VAROUTPUT" | "VAR_OUTPUTS" => Some(Kind::VarOutput),
        "VARINOUT" | "VAR_INOUT" => Some(Kind::VarInOut),
        "VARS" | "VAR_RETAIN" | "VAR_CONSTANT" | "VAR_PERSISTENT" => Some(Kind::Var),
        upper if upper.starts_with("VAR") && upper.len() > 4 => nearest_of(word, SECTIONS),
        _ => None,
    };
    if let Some(section) = section.filter(|_| next == Kind::Name) {
        return Some((section, 1));
    }
    let operand = matches!(next, Kind::Name | Kind::Integer | Kind::Not | Kind::True | Kind::False | Kind::OpenParen);
    match word.to_ascii_uppercase().as_str() {
        "SWITCH" | "SELECT" if operand => Some((Kind::Case, 1)),
        _ if operand => nearest_of(word, OPENERS).map(|kind| (kind, 1)),
        _ => None,
    }
}

/// `THNE` where a THEN is expected, and no assignment or call begins; `D0` for DO. Otherwise DO and OF are too
/// short to decide.
pub fn is_misspelt_then(input: &mut In<'_, '_, '_>, word: Kind) -> bool {
    let begins = matches!(
        input.kind_ahead(1),
        Kind::Assign | Kind::Equal | Kind::Dot | Kind::OpenParen | Kind::OpenBracket | Kind::Semicolon | Kind::Colon
    );
    if input.kind() != Kind::Name || begins {
        return false;
    }
    let span = input.here();
    if word != Kind::Then {
        return word == Kind::Do && input.text(span).eq_ignore_ascii_case("D0");
    }
    nearest_of(input.text(span), &[word]).is_some()
}

/// Takes and reports a word that stands for `end`, which is awaited: `END_REP`.
pub fn takes_end(input: &mut In<'_, '_, '_>, end: Kind) -> bool {
    if input.kind() != Kind::Name {
        return false;
    }
    let (span, next) = (input.here(), input.kind_ahead(1));
    let Some((kind, words)) = misspelt_end(input.text(span), next, std::iter::once(end)) else { return false };
    if kind != end {
        return false;
    }
    for _ in 0..words {
        input.take();
    }
    let whole = span.to(input.last());
    diagnostics::misspelt_keyword(input, kind, whole);
    true
}

fn waits_for(input: &mut In<'_, '_, '_>, end: Kind) -> bool {
    input.state().open.last().is_some_and(|(it, _)| *it == end)
}

/// The ends of the open blocks, from the innermost on.
fn open_ends<'i>(input: &'i mut In<'_, '_, '_>) -> impl Iterator<Item = Kind> + 'i {
    input.state().open.iter().rev().map(|(end, _)| *end)
}

/// The end of the innermost block; that of a unit only where nothing of it can follow.
fn innermost(input: &mut In<'_, '_, '_>, next: Kind) -> Option<Kind> {
    let follows = next == Kind::End || opens_item(next);
    open_ends(input).next().filter(|it| follows || !is_pou_end(*it))
}

/// `PROGRM Main`, `FUNCTION BLOCK f`: the keyword that opens an item.
pub fn misspelt_item(input: &mut In<'_, '_, '_>) -> Option<Kind> {
    if input.kind() != Kind::Name || input.kind_ahead(1) != Kind::Name {
        return None;
    }
    let span = input.here();
    nearest_of(input.text(span), ITEMS)
}

/// `RETIAN` after `VAR`, on its line.
pub fn misspelt_qualifier(input: &mut In<'_, '_, '_>) -> Option<Kind> {
    let follows = matches!(input.kind_ahead(1), Kind::Name | Kind::Constant | Kind::Retain | Kind::Persistent);
    if input.kind() != Kind::Name || !follows || input.on_new_line() {
        return None;
    }
    let span = input.here();
    // `CONST n : INT`; `const int n` is a declaration as in C.
    if input.text(span).eq_ignore_ascii_case("CONST") && input.kind_ahead(2) == Kind::Colon {
        return Some(Kind::Constant);
    }
    nearest_of(input.text(span), QUALIFIERS)
}

/// Whether a name that is alone is a misspelt keyword.
pub fn is_misspelt(input: &mut In<'_, '_, '_>, target: &Expr<'_>) -> bool {
    let ExprKind::Name(name) = &target.kind else { return false };
    let at = usize::from(input.kind() == Kind::Semicolon);
    let next = input.kind_ahead(at);
    (name.text.eq_ignore_ascii_case("END") && innermost(input, next).is_some())
        || (name.text.eq_ignore_ascii_case("FI") && waits_for(input, Kind::EndIf))
        || (name.text.eq_ignore_ascii_case("NEXT") && waits_for(input, Kind::EndFor))
        || (name.text.eq_ignore_ascii_case("WEND") && waits_for(input, Kind::EndWhile))
        || misspelt_end(name.text, Kind::Semicolon, open_ends(input)).is_some()
}
