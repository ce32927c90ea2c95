//! The kinds of tokens, and how they are called in messages.

use core::fmt;

use logos::Logos;

/// Makes the token kinds: keywords in any case, then signs, then kinds with many spellings.
macro_rules! kinds {
    (
        keywords { $($keyword:ident $word:literal)* }
        signs { $($sign:ident $text:literal)* }
        rest { $($(#[$attribute:meta])* $kind:ident $shown:literal)* }
    ) => {
        /// What a token is; its text and value are read from its span when they are needed.
        #[derive(Logos, Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[logos(skip r"[ \t\r\n\f]+")]
        pub enum Kind {
            $(#[token($word, ignore(case))] $keyword,)*
            $(#[token($text)] $sign,)*
            $($(#[$attribute])* $kind,)*
        }

        impl Kind {
            /// A reserved word's own spelling.
            pub const fn keyword(self) -> Option<&'static str> {
                match self {
                    $(Self::$keyword => Some($word),)*
                    $(Self::$sign)|* | $(Self::$kind)|* => None,
                }
            }
        }

        impl Kind {
            /// Whether it is an operator or punctuation.
            pub const fn is_sign(self) -> bool {
                matches!(self, $(Self::$sign)|*)
            }
        }

        /// As a message says it: `` `;` ``, `` `END_IF` ``, `a name`.
        impl fmt::Display for Kind {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $(Self::$keyword => concat!("`", $word, "`"),)*
                    $(Self::$sign => concat!("`", $text, "`"),)*
                    $(Self::$kind => $shown,)*
                })
            }
        }
    };
}

kinds! {
    keywords {
        Program "PROGRAM"
        EndProgram "END_PROGRAM"
        Function "FUNCTION"
        EndFunction "END_FUNCTION"
        FunctionBlock "FUNCTION_BLOCK"
        EndFunctionBlock "END_FUNCTION_BLOCK"
        Type "TYPE"
        EndType "END_TYPE"
        Struct "STRUCT"
        EndStruct "END_STRUCT"
        Configuration "CONFIGURATION"
        EndConfiguration "END_CONFIGURATION"
        EndResource "END_RESOURCE"
        Var "VAR"
        VarInput "VAR_INPUT"
        VarOutput "VAR_OUTPUT"
        VarInOut "VAR_IN_OUT"
        VarTemp "VAR_TEMP"
        VarStat "VAR_STAT"
        VarGlobal "VAR_GLOBAL"
        VarExternal "VAR_EXTERNAL"
        VarConfig "VAR_CONFIG"
        VarAccess "VAR_ACCESS"
        VarInst "VAR_INST"
        EndVar "END_VAR"
        Constant "CONSTANT"
        Retain "RETAIN"
        NonRetain "NON_RETAIN"
        Persistent "PERSISTENT"
        At "AT"
        Array "ARRAY"
        Of "OF"
        If "IF"
        Then "THEN"
        Elsif "ELSIF"
        Else "ELSE"
        EndIf "END_IF"
        Case "CASE"
        EndCase "END_CASE"
        For "FOR"
        To "TO"
        By "BY"
        Do "DO"
        EndFor "END_FOR"
        While "WHILE"
        EndWhile "END_WHILE"
        Repeat "REPEAT"
        Until "UNTIL"
        EndRepeat "END_REPEAT"
        Try "__TRY"
        Catch "__CATCH"
        Finally "__FINALLY"
        EndTry "__ENDTRY"
        Exit "EXIT"
        Continue "CONTINUE"
        Return "RETURN"
        Not "NOT"
        And "AND"
        AndThen "AND_THEN"
        Or "OR"
        OrElse "OR_ELSE"
        Xor "XOR"
        Mod "MOD"
        True "TRUE"
        False "FALSE"
        EndMethod "END_METHOD"
        EndProperty "END_PROPERTY"
        EndAction "END_ACTION"
        EndGet "END_GET"
        EndSet "END_SET"
        EndInterface "END_INTERFACE"
        EndClass "END_CLASS"
        EndNamespace "END_NAMESPACE"
        EndUnion "END_UNION"
        EndSetup "END_SETUP"
        EndTeardown "END_TEARDOWN"
        EndTest "END_TEST"
    }
    signs {
        Assign ":="
        Arrow "=>"
        Attempt "?="
        Semicolon ";"
        Colon ":"
        Comma ","
        Dot "."
        DotDot ".."
        OpenParen "("
        CloseParen ")"
        OpenBracket "["
        CloseBracket "]"
        Caret "^"
        Power "**"
        Star "*"
        Slash "/"
        Plus "+"
        Minus "-"
        Equal "="
        Unequal "<>"
        Less "<"
        Greater ">"
        LessEqual "<="
        GreaterEqual ">="
        Ampersand "&"
        // Signs of other languages, to be answered in ours.
        EqualEqual "=="
        BangEqual "!="
        AndAnd "&&"
        OrOr "||"
        Bang "!"
        Percent "%"
        PlusEqual "+="
        MinusEqual "-="
        StarEqual "*="
        SlashEqual "/="
    }
    rest {
        #[regex(r"[A-Za-z_\p{Alphabetic}][A-Za-z0-9_\p{Alphabetic}]*")]
        Name "a name"
        #[regex(r"[A-Za-z_][A-Za-z0-9_]*#")]
        Prefix "a type prefix"
        #[regex(r"[0-9][0-9_]*")]
        Integer "a number"
        #[regex(r"[0-9][0-9_]*#[0-9A-Za-z_]*")]
        Based "a number"
        #[regex(r"[0-9][0-9_]*\.[0-9][0-9_]*([eE][+-]?[0-9][0-9_]*)?")]
        #[regex(r"[0-9][0-9_]*[eE][+-]?[0-9][0-9_]*")]
        Real "a number"
        #[regex(r"(T|TIME|LT|LTIME)#[+-]?[0-9][0-9A-Za-z_]*(\.[0-9A-Za-z_]+)*", ignore(case))]
        Time "a duration"
        #[regex(r"(D|DATE|LD|LDATE|TOD|TIME_OF_DAY|LTOD|LTIME_OF_DAY|DT|DATE_AND_TIME|LDT|LDATE_AND_TIME)#[0-9][0-9_]*([-:.][0-9_]+)*", ignore(case))]
        Date "a date"
        #[regex(r"'([^'$\r\n]|\$[^\r\n])*'")]
        Text "a string"
        #[regex(r#""([^"$\r\n]|\$[^\r\n])*""#)]
        WideText "a string"
        #[regex(r"'([^'$\r\n]|\$[^\r\n])*")]
        #[regex(r#""([^"$\r\n]|\$[^\r\n])*"#)]
        OpenText "a string that is not closed"
        #[regex(r"%[IQMiqm][A-Za-z]?(\*|[0-9]+(\.[0-9A-Za-z_]+)*)")]
        Address "an address"
        #[regex(r"%[XBWDLxbwdl][0-9]+")]
        Part "a part"
        #[token("(*", super::comment::nested)]
        #[token("/*", super::comment::plain)]
        #[regex(r"//[^\n]*", allow_greedy = true)]
        Comment "a comment"
        #[token("{", super::comment::pragma)]
        Pragma "a pragma"
        /// Characters that do not form a token; reported by the lexer.
        Unknown "an unknown character"
        /// Stands once, after the last token.
        End "the end of the file"
    }
}
