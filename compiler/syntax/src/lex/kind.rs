//! The kinds of tokens, and how they are called in messages.

use core::fmt;

/// Makes the token kinds: keywords in any case, then signs, then kinds with many spellings.
macro_rules! kinds {
    (
        keywords { $($keyword:ident $word:literal)* }
        signs { $($sign:ident $text:literal)* }
        rest { $($(#[$attribute:meta])* $kind:ident $shown:literal)* }
    ) => {
        /// What a token is; its text and value are read from its span when they are needed.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Kind {
            $($keyword,)*
            $($sign,)*
            $($(#[$attribute])* $kind,)*
        }

        const WORDS: &[(&str, Kind)] = &[$(($word, Kind::$keyword)),*];
        const SIGNS: &[(&str, Kind)] = &[$(($text, Kind::$sign)),*];

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
        TildeEqual "~="
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
        Name "a name"
        /// A type, and its `#`.
        Prefix "a type prefix"
        Integer "a number"
        /// `16#FF`
        Based "a number"
        Real "a number"
        /// `T#5s`
        Time "a duration"
        /// `D#2024-02-29`, `TOD#12:30:00`
        Date "a date"
        Text "a string"
        /// In double quotes.
        WideText "a string"
        OpenText "a string that is not closed"
        /// `%IX0.3`
        Address "an address"
        /// `%X3`, after a point.
        Part "a part"
        Comment "a comment"
        Pragma "a pragma"
        /// Characters that do not form a token; reported by the lexer.
        Unknown "an unknown character"
        /// Once, after the last token.
        End "the end of the file"
    }
}

/// Places of words in a table by their hash, two for each.
const SLOTS: usize = 256;
const _: () = assert!(2 * WORDS.len() <= SLOTS && WORDS.len() < u8::MAX as usize);

/// For each hash the number of a word plus 1; 0 where no word is, and the search ends.
static TABLE: [u8; SLOTS] = {
    let mut table = [0; SLOTS];
    let mut at = 0;
    while at < WORDS.len() {
        let mut slot = hash(WORDS[at].0.as_bytes());
        while table[slot] != 0 {
            slot = (slot + 1) % SLOTS;
        }
        at += 1;
        table[slot] = at as u8;
    }
    table
};

/// For each character the number of the sign that it is, plus 1; 0 where it is none.
static SINGLE: [u8; 128] = {
    let mut table = [0; 128];
    let mut at = 0;
    while at < SIGNS.len() {
        let sign = SIGNS[at].0.as_bytes();
        at += 1;
        if sign.len() == 1 {
            table[sign[0] as usize] = at as u8;
        }
    }
    table
};

/// The characters that may be the second of a sign.
static SECONDS: [bool; 128] = {
    let mut table = [false; 128];
    let mut at = 0;
    while at < SIGNS.len() {
        let sign = SIGNS[at].0.as_bytes();
        if sign.len() == 2 {
            table[sign[1] as usize] = true;
        }
        at += 1;
    }
    table
};

fn is_in(table: &[bool; 128], byte: u8) -> bool {
    table.get(usize::from(byte)).is_some_and(|it| *it)
}

/// Of the length, and of three letters in either case.
const fn hash(word: &[u8]) -> usize {
    let (first, middle, last) = (word[0] & 31, word[word.len() / 2] & 31, word[word.len() - 1] & 31);
    (word.len() + 7 * first as usize + 37 * middle as usize + 101 * last as usize) % SLOTS
}

impl Kind {
    /// All reserved words.
    pub fn keywords() -> impl Iterator<Item = (&'static str, Self)> {
        WORDS.iter().copied()
    }

    /// The keyword that a word is, in any case.
    pub(super) fn of_word(word: &[u8]) -> Option<Self> {
        let mut slot = hash(word);
        while let Some(at) = usize::from(TABLE[slot]).checked_sub(1) {
            let (text, kind) = WORDS[at];
            if text.as_bytes().eq_ignore_ascii_case(word) {
                return Some(kind);
            }
            slot = (slot + 1) % SLOTS;
        }
        None
    }

    /// The sign of two characters.
    pub(super) fn of_signs(first: u8, second: u8) -> Option<Self> {
        if !is_in(&SECONDS, second) {
            return None;
        }
        let found = SIGNS.iter().find(|it| matches!(*it.0.as_bytes(), [a, b] if a == first && b == second));
        found.map(|it| it.1)
    }

    /// The sign of one character.
    pub(super) fn of_sign(sign: u8) -> Option<Self> {
        let at = usize::from(*SINGLE.get(usize::from(sign))?).checked_sub(1)?;
        Some(SIGNS[at].1)
    }
}
