//! Classes of tokens: what opens, continues and closes the parts of a file.

use crate::lex::Kind;

/// Keywords that open a POU, a TYPE block or a configuration.
pub fn opens_item(kind: Kind) -> bool {
    matches!(kind, Kind::Program | Kind::Function | Kind::FunctionBlock | Kind::Type | Kind::Configuration)
}

/// VAR and its relatives.
pub fn opens_section(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Var
            | Kind::VarInput
            | Kind::VarOutput
            | Kind::VarInOut
            | Kind::VarTemp
            | Kind::VarStat
            | Kind::VarGlobal
            | Kind::VarExternal
            | Kind::VarConfig
            | Kind::VarAccess
            | Kind::VarInst
    )
}

/// Keywords that open a statement.
pub fn opens_statement(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::If
            | Kind::Case
            | Kind::For
            | Kind::While
            | Kind::Repeat
            | Kind::Try
            | Kind::Exit
            | Kind::Continue
            | Kind::Return
    )
}

/// END_IF and the like.
pub fn is_end(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::EndProgram
            | Kind::EndFunction
            | Kind::EndFunctionBlock
            | Kind::EndType
            | Kind::EndStruct
            | Kind::EndConfiguration
            | Kind::EndResource
            | Kind::EndVar
            | Kind::EndIf
            | Kind::EndCase
            | Kind::EndFor
            | Kind::EndWhile
            | Kind::EndRepeat
            | Kind::EndTry
            | Kind::EndMethod
            | Kind::EndProperty
            | Kind::EndAction
            | Kind::EndGet
            | Kind::EndSet
            | Kind::EndInterface
            | Kind::EndClass
            | Kind::EndNamespace
            | Kind::EndUnion
            | Kind::EndSetup
            | Kind::EndTeardown
            | Kind::EndTest
    )
}

pub fn is_pou_end(kind: Kind) -> bool {
    matches!(kind, Kind::EndProgram | Kind::EndFunction | Kind::EndFunctionBlock)
}

/// Keywords that close or continue a block.
pub fn closes(kind: Kind) -> bool {
    matches!(kind, Kind::Else | Kind::Elsif | Kind::Until | Kind::Catch | Kind::Finally) || is_end(kind)
}

pub fn ends_statements(kind: Kind) -> bool {
    kind == Kind::End || closes(kind) || opens_section(kind) || opens_item(kind)
}

pub fn ends_declarations(kind: Kind) -> bool {
    ends_statements(kind) || opens_statement(kind)
}

/// The ends of the blocks that a keyword closes or continues.
pub fn partners(kind: Kind) -> [Kind; 2] {
    match kind {
        Kind::Else => [Kind::EndIf, Kind::EndCase],
        Kind::Elsif => [Kind::EndIf; 2],
        Kind::Until => [Kind::EndRepeat; 2],
        Kind::Catch | Kind::Finally => [Kind::EndTry; 2],
        kind => [kind; 2],
    }
}

/// What closes the block that a keyword opens.
pub fn end_of(kind: Kind) -> Option<Kind> {
    Some(match kind {
        Kind::If => Kind::EndIf,
        Kind::Case => Kind::EndCase,
        Kind::For => Kind::EndFor,
        Kind::While => Kind::EndWhile,
        Kind::Repeat => Kind::EndRepeat,
        Kind::Try => Kind::EndTry,
        Kind::Struct => Kind::EndStruct,
        kind if opens_section(kind) => Kind::EndVar,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::is_end;
    use crate::lex::Scanner;

    #[test]
    fn ends_are_those_words() {
        let words = "IF THEN END_IF END_CASE END_FOR END_WHILE END_REPEAT END_VAR END_STRUCT END_TYPE END_PROGRAM \
                     END_FUNCTION END_FUNCTION_BLOCK END_CONFIGURATION END_RESOURCE END_METHOD END_PROPERTY END_ACTION \
                     END_GET END_SET END_INTERFACE END_CLASS END_NAMESPACE END_UNION END_SETUP END_TEARDOWN END_TEST END ELSE";
        for (kind, word) in Scanner::new(words).zip(words.split_whitespace()) {
            assert_eq!(is_end(kind), (word.starts_with("END_")), "{word}");
        }
    }
}
