use super::Severity;

macro_rules! codes {
    ($($code:ident $severity:ident $title:literal $explanation:literal;)*) => {
        /// A stable code. `E` codes are errors, `W` codes are lints.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Code { $($code),* }

        impl Code {
            pub const ALL: &'static [Self] = &[$(Self::$code),*];

            pub const fn name(self) -> &'static str {
                match self { $(Self::$code => stringify!($code)),* }
            }

            /// The diagnostic in a few words.
            pub const fn title(self) -> &'static str {
                match self { $(Self::$code => $title),* }
            }

            /// The long text that `staunch explain` prints.
            pub const fn explanation(self) -> &'static str {
                match self { $(Self::$code => $explanation),* }
            }

            /// What it is unless the user says otherwise.
            pub const fn severity(self) -> Severity {
                match self { $(Self::$code => Severity::$severity),* }
            }

            /// A lint about which statements run and which variables they use.
            pub const fn is_of_the_flow(self) -> bool {
                matches!(self, Self::W0501 | Self::W0502 | Self::W0507)
            }

            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|it| it.name().eq_ignore_ascii_case(name))
            }
        }
    };
}

// 00xx text and syntax; 01xx names; 02xx types and values; 03xx calls and blocks; 04xx
// declarations; 05xx statements; 06xx what a move between systems changes, by the number that
// `docs/compare.md` gives it; 09xx limits and what is not supported.
codes! {
    E0001 Error "the text does not parse"
"The text breaks the grammar at the marked place. The message says what was expected there.

    x = 1;      (* an assignment is written x := 1; *)
";
E0002 Error "a character that means nothing"
"Outside strings and comments, Structured Text is written in ASCII letters, digits and a few signs. The
marked characters are none of them. Typographic quotes and dashes come from word processors.

    name := ‘Mixer’;      (* before *)
    name := 'Mixer';      (* after *)
";
E0003 Error "a comment or pragma is not closed"
"The comment or pragma that starts at the marked place runs to the end of the file. Comments nest: inside
`(* … *)` every further `(*` needs its own `*)`.

    (* count the parts (* of line 1 *)         before
    (* count the parts (* of line 1 *) *)      after
";
E0004 Error "a string is not closed"
"A string ends on the line it starts on. A line break inside a string is written `$N`, a quote `$'`.

    text := 'it's late';       (* before *)
    text := 'it$'s late';      (* after *)
";
E0005 Error "a number that cannot be read"
"A number is decimal, or has one of the bases 2, 8 and 16. Its value fits 64 bits, and its digits belong to its
base. `_` may stand between two digits, one at a time.

    mask := 2#1021;      (* before *)
    mask := 2#1011;      (* after *)
";
E0006 Error "a duration that cannot be read"
"A duration is a sequence of numbers with units, from the longest unit to the shortest: d, h, m, s, ms, us, ns.
Only the last number may have a fraction. `_` may stand between two digits and between two units. A duration is held as signed nanoseconds in 64 bits, so it reaches about 292 years.

    delay := T#500;        (* before *)
    delay := T#500ms;      (* after *)
";
E0007 Error "an escape that means nothing"
"In a string, `$` starts an escape: `$$`, `$'`, `$\"`, `$L` and `$N` (new line), `$P` (new page), `$R` (return),
`$T` (tab), or a character's number in two hexadecimal digits (four in a WSTRING). A dollar sign is `$$`.

    price := '5$';       (* before *)
    price := '5$$';      (* after *)
";
E0008 Error "`=` where `:=` assigns"
"`=` compares. An assignment is written `:=`, in one piece.

    x = 1;       (* before *)
    x := 1;      (* after *)
";
E0009 Error "`:=` where `=` compares"
"`:=` assigns, and an assignment is a statement, not a condition. A comparison is written `=`.

    IF x := 1 THEN      (* before *)
    IF x = 1 THEN       (* after *)
";
E0010 Error "an operator of another language"
"Structured Text has its own operators:

    C           Structured Text
    a == b      a = b
    a != b      a <> b
    a && b      a AND b      (AND_THEN: b only when needed)
    a || b      a OR b       (OR_ELSE: b only when needed)
    !a          NOT a
    a % b       a MOD b
    a += b      a := a + b
";
E0011 Error "`ELSE IF` where `ELSIF` is meant"
"`ELSE IF` starts a second IF inside the ELSE, and that one needs an END_IF of its own. A further branch of the
same IF is written ELSIF.

    IF a THEN           (* before *)
        x := 1;
    ELSE IF b THEN
        x := 2;
    END_IF

    IF a THEN           (* after *)
        x := 1;
    ELSIF b THEN
        x := 2;
    END_IF
";
E0012 Error "a missing `;`"
"Every statement and every declaration ends with `;`.

    x := 1         (* before *)
    y := 2;

    x := 1;        (* after *)
    y := 2;
";
E0013 Error "a missing THEN, DO or OF"
"A condition is followed by THEN (IF, ELSIF) or DO (WHILE), the bounds of a FOR by DO, the selector of a CASE and
the bounds of an ARRAY by OF.

    IF ready            (* before *)
        start := TRUE;
    END_IF

    IF ready THEN       (* after *)
        start := TRUE;
    END_IF
";
E0014 Error "a block is not closed"
"Every block is closed by its own END_: IF by END_IF, FOR by END_FOR, VAR by END_VAR, PROGRAM by END_PROGRAM, and
so on; REPEAT by UNTIL and END_REPEAT. The message says what was opened, and where.

    FOR i := 1 TO 3 DO      (* before *)
        sum := sum + i;
    END_PROGRAM

    FOR i := 1 TO 3 DO      (* after *)
        sum := sum + i;
    END_FOR
    END_PROGRAM
";
E0015 Error "an END_, ELSE or UNTIL that belongs to nothing"
"The marked keyword closes or continues a block, but no such block is open here: it stands twice, or the block
was closed before.

    IF a THEN x := 1; END_IF
    END_IF                          (* delete this *)
";
E0016 Error "a reserved word used as a name"
"Keywords cannot be names, in any mixture of capital and small letters.

    VAR to : INT; END_VAR          (* before *)
    VAR target : INT; END_VAR      (* after *)
";
E0017 Error "a declaration behind statements"
"All VAR blocks of a PROGRAM, FUNCTION_BLOCK or FUNCTION stand before its first statement.

    x := 1;                    (* before *)
    VAR x : INT; END_VAR

    VAR x : INT; END_VAR       (* after *)
    x := 1;
";
E0018 Error "a misspelt keyword"
"Keywords that end a block have a stroke, and stand in one piece: END_IF, END_FOR, END_VAR. A further branch of an IF
is ELSIF.

    IF a THEN x := 1; ENDIF       (* before *)
    IF a THEN x := 1; END_IF      (* after *)
";
E0019 Error "RETURN with a value"
"RETURN leaves the POU; it takes no value. A FUNCTION's result is what was assigned to its own name.

    FUNCTION Twice : INT           (* before *)
    VAR_INPUT x : INT; END_VAR
        RETURN 2 * x;
    END_FUNCTION

    FUNCTION Twice : INT           (* after *)
    VAR_INPUT x : INT; END_VAR
        Twice := 2 * x;
    END_FUNCTION
";
E0020 Error "a habit of another language"
"Structured Text ends each block with a word of its own, and has neither braces nor BEGIN and END:

    C, Pascal                       Structured Text
    if (a) { x = 1; }               IF a THEN x := 1; END_IF
    if a then begin x := 1; end;    IF a THEN x := 1; END_IF
    for (i = 0; i < 10; i++) {…}    FOR i := 0 TO 9 DO … END_FOR
    for i := 10 downto 1 do …       FOR i := 10 TO 1 BY -1 DO … END_FOR
    function f(x : INT) : INT       FUNCTION f : INT
                                    VAR_INPUT x : INT; END_VAR
";
E0030 Error "too many errors"
"Reading stopped here: what follows was not looked at. Correct the errors above first.
";
E0031 Error "a file that is too large"
"A source file has at most 4 GiB.
";
E0032 Error "a file of another kind"
"The file is no Structured Text: an XML or binary file of another system, Instruction List, Siemens' SCL, or Logix's
neutral text. The message says which, and what to do; nothing else is said of the sources until then. Text may be UTF-8,
UTF-16 or Windows-1252.

    LD  start                 (* before *)
    AND ready
    ST  motor

    motor := start AND ready;   (* after *)
";
E0090 Error "not supported yet"
"The marked construct is valid in IEC 61131-3 or in a vendor's dialect, and this compiler knows it, but does not
compile it yet.
";
E0091 Error "too deep or too long"
"Expressions and statements nest at most 256 levels deep, types and initial values 64; a chain of operators has at most
1000 operands and an IF at most 1000 branches. Split the construct: name a part of the expression with a
variable, or move statements into a FUNCTION.
";
    E0101 Error "unknown name"
"A name is used that no declaration introduces. Names compare without regard to case. The
message offers the nearest declared name, where there is one.

    VAR count : INT; END_VAR
    cuont := 1;      (* did you mean `count`? *)
";
    W0101 Warning "underlines in a name"
"In the standard a name has no two underlines in a row and none at its end, so that other systems may refuse
it. CODESYS keeps names with two underlines for itself.
";
    E0102 Error "unknown type"
"A declaration names a type that is neither elementary, nor declared in a TYPE block, nor a
FUNCTION_BLOCK of the program, nor a standard block of the dialect in force.

    VAR speed : IINT; END_VAR      (* did you mean `INT`? *)
";
    W0102 Warning "a pragma without effect"
"A pragma in braces that Staunch does not know has no effect. Those of editors and other tools
pass without a word; those that would change the program's meaning are refused. An `allow` that names no
lint, or that nothing follows, has no effect either.

    {alow W0501} spare : BOOL;      (* before *)
    {allow W0501} spare : BOOL;     (* after *)
";
    E0103 Error "declared twice"
"A scope holds each name once, whatever its case: `Motor` and `MOTOR` are one name. POUs, types
and global variables share one scope; the variables of a POU are another.
";
    E0104 Error "reserved name"
"A POU, type or global variable cannot bear the name of an elementary type.
";
    E0105 Error "unknown dialect"
"The pragma `{dialect '…'}` names a dialect that does not exist. The dialects are iec, cscape,
codesys, openplc and logix; they decide whose counters a bare `CTU` means.
";
    E0106 Error "two dialects in one file"
"A file has one dialect. To use a block of another system beside it, name its family:

    VAR
        a : CTU;             (* of the file's dialect *)
        b : CODESYS.CTU;     (* of CODESYS, in every dialect *)
    END_VAR
";
    E0107 Error "unknown member"
"A structure, enumeration or instance has no member of that name.
";
    E0108 Error "ambiguous name"
"Several enumerations have a value of that name, or several lists of global variables a variable, and the place does
not say which is meant. Write it in full: `Color#Red` or `Color.Red`; `GVL.x`.
";
    E0109 Error "internal variable"
"From outside an instance only its inputs and outputs can be reached. Declare the variable in
VAR_OUTPUT to show it. In the codesys dialect an internal variable can be read from outside, but not assigned,
given to a VAR_IN_OUT or called.
";
    E0201 Error "wrong type"
"The value is of another type than its place, and no implicit conversion leads there.
";
    E0202 Error "value does not fit"
"A literal or constant lies outside the range of its type.

    VAR small : SINT; END_VAR
    small := 300;      (* a SINT holds -128 to 127 *)
";
    E0203 Error "conversion needed"
"Implicit conversions only widen (IEC 61131-3, third edition, figure 12). One that may lose
something is written down, so that a reader sees it:

    VAR long : DINT; short : INT; END_VAR
    short := DINT_TO_INT(long);
";
    E0204 Error "operator does not take these types"
"Arithmetic takes numbers, AND OR XOR NOT take BOOL and bit strings, comparisons take two
operands of one type. A TIME is added to a TIME, and multiplied or divided by a number. A bit
string becomes a number with a conversion: `WORD_TO_UINT(w) + 1`. The codesys dialect lets bit
strings and integers mix.
";
    E0205 Error "not a constant"
"Array bounds, string lengths, initial values, CASE labels and enumerators are computed by the
compiler: they may use literals, enumerators and variables declared CONSTANT.
";
    E0206 Error "wrong length or count"
"A string's length, a repeat count or the number of initial values does not fit its type.
";
    E0207 Error "constant expression faults"
"The compiler computed a constant expression, and it faults: a division by zero, for instance.
In the program it would stop every scan.
";
    E0208 Error "constant index out of range"
"An index that is known now lies outside the array's bounds, or a bit number outside of the
value. An index that is not known is checked in every scan, and faults.
";
    E0209 Error "constant TIME overflows"
"A TIME counts nanoseconds in 64 bits: it reaches 292 years either way.
";
    E0210 Error "an instance is not a value"
"A counter, timer or other block instance is storage with behaviour; it is called, and its
outputs are read. It cannot be copied or computed with, nor can what holds it: a
structure, an array, a parameter that is passed by value, a result.

    VAR parts : CTU; count : INT; END_VAR
    count := parts.CV;      (* not `count := parts;` *)
";
    W0202 Warning "a text is cut"
"A text is longer than the STRING that it goes into, which keeps its first characters.

    VAR name : STRING[3] := 'pump'; END_VAR      (* before *)
    VAR name : STRING[4] := 'pump'; END_VAR      (* after *)
";
    E0301 Error "unknown pin or parameter"
"A call names a parameter that the block or function does not have. Systems disagree on pin
names: the reset of a counter is `R` in IEC 61131-3, `RESET` in CODESYS and Cscape; the load
input is `LD` or `LOAD`. Positional arguments mean the same in all of them.
";
    E0302 Error "wrong number of arguments"
"A call gives more or fewer arguments than the function takes, or an array more indices than it
has dimensions. A call that names its arguments may leave out a block's inputs, which keep their values. One that
names none gives all inputs of a FUNCTION, and in the iec dialect of a block, but those with a declared value.

    x := Scale(raw);                     (* before *)
    x := Scale(raw, 2.0);                (* after *)
";
    E0303 Error "argument missing"
"A VAR_IN_OUT works on the caller's variable, so each call names one. In the codesys dialect a call of a FUNCTION
also gives every input that has no default.
";
    E0304 Error "argument given twice"
"A parameter was given by position and by name, or by name twice.
";
    E0305 Error "cannot be called"
"Only functions and instances of blocks are called. A FUNCTION_BLOCK is a type: declare an
instance and call that. A PROGRAM is called in the codesys dialect only.
";
    E0306 Error "a variable is needed"
"The call writes here, so a literal or expression will not do.
";
    E0307 Error "unknown function"
"No function or instance of that name is declared, and the standard has none.
";
    E0309 Error "a block of another dialect"
"The dialect in force decides whose blocks a bare name means, and its system documents no block
of this name. Name the family (`IEC.CTUD`), compile with another `--dialect`, or start the file
with `{dialect 'iec'}`.
";
    E0310 Error "recursion"
"A POU calls itself, directly or through others. The stack of a controller is bounded, and so
is the time of a scan: IEC 61131-3 forbids it. Write a loop.
";
    E0311 Error "the call has no value"
"A block, or a FUNCTION without a result type, has no value. Call it in a statement, then read
its outputs.
";
    E0312 Error "wrong arrow"
"Inputs are connected with `:=`, outputs with `=>`.

    VAR parts : CTU; sensor, full : BOOL; END_VAR
    parts(CU := sensor, PV := 10, Q => full);
";
    E0313 Error "instruction on the wrong structure"
"The Logix instructions CTU, CTD and RES work on a COUNTER, CTUD on an FBD_COUNTER.
";
    E0314 Error "RCV shared by two counters"
"R_CTU and R_CTD keep their count in the variable given as RCV. Two counters on one variable
would overwrite each other's count.
";
    E0315 Error "RCV is assigned"
"Only the counter writes the variable that keeps its count. To clear the count, call the counter
with RESET TRUE.
";
    E0402 Error "a declaration needs itself"
"A structure contains itself, an instance contains an instance of its own kind, or a constant is
defined by itself: its size or value would have no end.
";
    E0403 Error "qualifier does not belong here"
"RETAIN, CONSTANT, R_EDGE and F_EDGE each have sections to which they belong. A VAR_TEMP or a
function's variable has no value from one call to the next, so there is nothing to retain.
";
    E0405 Error "VAR_EXTERNAL differs from its global"
"VAR_EXTERNAL names a global variable, with the type of its declaration.
";
    E0406 Error "array bounds"
"The bounds of an array are two whole numbers, the lower one first.
";
    E0407 Error "base of a subrange or enumeration"
"A subrange is a part of an integer type; an enumeration's values are of one.
";
    E0408 Error "empty type"
"A structure has at least one member, an enumeration at least one value.
";
    E0409 Error "direct address"
"A direct address is an area (I inputs, Q outputs, M memory), a size (X bit, B byte, W 16, D 32,
L 64 bits) and a place: `%IX0.3`, `%QW2`. Its variable has just that many bits. It is declared in a
PROGRAM or among the globals, in codesys also in a FUNCTION_BLOCK, and is one variable wherever it
is declared: its declarations agree in the type and in the initial value.
";
    E0410 Error "overlapping addresses"
"One area is addressed in several sizes, so that %MB1 is a part of %MW0. Such variables would share
their bits, which is not supported yet. Declare the larger one, and take its parts: `word.%B1`, `word.3`.
";
    E0501 Error "assignment to a constant"
"A variable declared CONSTANT keeps its value.
";
    E0502 Error "assignment to an input"
"A POU does not assign to its own VAR_INPUT: the caller decides it. The codesys dialect makes
this a lint, since real code does it.
";
    E0503 Error "assignment to a FOR counter"
"A FOR loop alone advances its counter. The codesys dialect makes this a lint.
";
    E0504 Error "assignment to an output from outside"
"An output is set by its block only.
";
    E0505 Error "EXIT or CONTINUE outside of a loop"
"EXIT leaves the innermost FOR, WHILE or REPEAT, CONTINUE goes on with its next turn.
";
    E0506 Error "CASE label twice"
"Each value selects one branch. The second label of a value could never be chosen.
";
    E0507 Error "condition is not a BOOL"
"IF, ELSIF, WHILE and UNTIL take a BOOL. A number is compared first: `count <> 0`.
";
    E0508 Error "statement without effect"
"An expression alone does nothing. An instance is called with parentheses: `timer();`.
";
    E0509 Error "FOR step is 0"
"A FOR loop with the step 0 would never end.
";
    E0510 Error "empty range of CASE labels"
"A range of labels goes from its lower to its higher value; the other way round it holds none, and its branch is
never chosen.

    CASE step OF
        5..3: next := 1;      (* before *)
        3..5: next := 1;      (* after *)
    END_CASE
";
    E0511 Error "assignment to an input address"
"Before each scan the hardware's inputs are copied to `%I`: what a program assigns there is overwritten. CODESYS
refuses it, and so does the codesys dialect; the others have the lint W0509.
";
    E0512 Error "several assignments in a row"
"An assignment is a statement and has no value. The codesys dialect knows several in a row, where each variable gets
what the one to its right was given; elsewhere write one statement for each.

    a := b := 0;          (* before *)
    b := 0; a := b;       (* after *)
";
    E0901 Error "too large"
"Variables are laid out in one block of memory, which may take 1 GiB. An array has at most 64 dimensions,
and all initial values together hold at most 1048576 constants; a repeated one counts once.
";
    E0902 Error "not supported yet"
"The construct is part of the language, but this version of Staunch cannot compile it. It is
refused rather than compiled wrongly.
";
    E0903 Error "too many temporary variables"
"VAR_TEMP, the variables of functions, and the strings that a statement makes on its way live on the
stack during a call. Those of a call and of all calls below it may take 1 MiB.
";
    W0301 Warning "RCV is not retained"
"R_CTU and R_CTD restore their count from the variable given as RCV after a restart. A variable
that is not RETAIN starts anew, and so does the count.
";
    W0302 Warning "RETAIN does not keep this count"
"Horner Cscape keeps the count of R_CTU and R_CTD over a restart, through a RETAIN variable given as
RCV. Its CTU and CTD count anew, also where they or the instance around them are RETAIN; RETAIN keeps their inputs.
";
    W0303 Warning "a block that starts anew at each call"
"VAR_TEMP and the variables of a FUNCTION start anew at each call. A timer, counter, edge or bistable there remembers
nothing: a TON never expires, a CTU never passes 1, an R_TRIG takes every TRUE for an edge.

    VAR_TEMP delay : TON; END_VAR      (* before *)
    VAR delay : TON; END_VAR           (* after *)
";
    W0304 Warning "an input of a FUNCTION is left out"
"A FUNCTION keeps nothing from call to call: an input that a call leaves out has its declared default, or 0, FALSE or an
empty text where none is declared. That is rarely meant. CODESYS refuses it, and so does the codesys dialect.

    FUNCTION Scale : REAL
    VAR_INPUT raw : REAL; factor : REAL; END_VAR             (* before *)
    VAR_INPUT raw : REAL; factor : REAL := 1.0; END_VAR      (* after *)
";
    W0404 Warning "a constant without a value"
"A CONSTANT without a value keeps its type's initial value: 0, FALSE or an empty text. Write the value, also
where it is that.

    VAR CONSTANT limit : INT; END_VAR             (* before *)
    VAR CONSTANT limit : INT := 100; END_VAR      (* after *)
";
    W0410 Warning "overlapping addresses"
"Two variables lie on addresses that share bits, such as %MW0 and %MB1. In the iec dialect each size
has registers of its own, as in OpenPLC: writing one does not change the other.
";
    W0411 Warning "one address under two names"
"Two variables of one scope lie on the same direct address, so they are one variable: what is assigned
to one of them is read from the other.

    VAR start AT %IX0.0 : BOOL; stop AT %IX0.0 : BOOL; END_VAR      (* before *)
    VAR start AT %IX0.0 : BOOL; stop AT %IX0.1 : BOOL; END_VAR      (* after *)
";
    W0412 Warning "a task without a priority"
"The standard has a PRIORITY in each TASK, 0 the most urgent. A task without one runs after the others.

    TASK fast(INTERVAL := T#10ms);                    (* before *)
    TASK fast(INTERVAL := T#10ms, PRIORITY := 1);     (* after *)
";
    W0501 Warning "unused variable"
"A variable is declared but never read or written. Start its name with `_` to keep it.
";
    W0502 Warning "unreachable statement"
"The statement stands behind EXIT, CONTINUE or RETURN.
";
    W0503 Warning "REAL compared for equality"
"Rounding makes results differ that are equal on paper. Compare the distance. A comparison with 0 is left alone: it
guards a division, or asks whether a value was set.
";
    W0504 Warning "input assigned from inside"
"The codesys dialect allows it; the value that the caller gave the FUNCTION_BLOCK or PROGRAM is lost. A FUNCTION's
input is a copy, and may be used as a variable.
";
    W0505 Warning "FOR counter assigned in its loop"
"The codesys dialect allows it; the loop goes on from the new value.
";
    W0507 Warning "instance called twice in a scan"
"A counter, trigger or timer works once a scan. Called twice, it sees the input of the first call
as the past of the second: an edge is counted twice, or not at all. Branches that exclude each
other may each call it.
";
    W0508 Warning "endless loop"
"The condition of a WHILE or REPEAT is constant, and no EXIT or RETURN leaves it: the scan would
never come to its end.
";
    W0506 Warning "sign may change"
"The codesys dialect converts between signed and unsigned types of one size without being asked.
";
    W0509 Warning "assignment to an input address"
"Before each scan the hardware's inputs are copied to `%I`: what a program assigns there is overwritten. The codesys
dialect refuses it, as CODESYS does.
";
    W0510 Warning "a comparison that never changes"
"An integer is compared with a value that its type does not reach, so the outcome is the same in every scan.

    VAR level : INT; END_VAR
    IF level > 40000 THEN alarm := TRUE; END_IF      (* never: an INT holds -32768 to 32767 *)
";
    W0511 Warning "an integer loses digits as a real"
"CODESYS makes a REAL of a DINT without being asked, and an LREAL of a LINT. Above 16777216, or 9007199254740992, not
every integer is a real, and the nearest one is taken. Write the conversion to say that this is meant.
";
    W0512 Warning "CASE labels that overlap"
"Of the labels that hold the value, the first in the text is chosen. A label whose values all belong to labels before it
is never chosen.

    CASE level OF
    0..9:  state := 1;
    5..20: state := 2;      (* 10..20 *)
    7:     state := 3;      (* never *)
    END_CASE
";
    W0515 Warning "a subrange wider than the array that it indexes"
"The index is a variable of a subrange, which is checked when it is assigned. But the subrange holds values that the
array has no element for, so the index can still fault.

    VAR i : INT(0..5); levels : ARRAY[0..3] OF INT; END_VAR      (* before *)
    VAR i : INT(0..3); levels : ARRAY[0..3] OF INT; END_VAR      (* after *)
";
    W0516 Warning "a result that is never assigned"
"A FUNCTION's result is what was last assigned to its name. Where nothing is, each call gives the type's initial
value.

    FUNCTION Twice : INT VAR_INPUT a : INT; END_VAR b := 2 * a; END_FUNCTION          (* before *)
    FUNCTION Twice : INT VAR_INPUT a : INT; END_VAR Twice := 2 * a; END_FUNCTION      (* after *)
";
    W0602 Warning "a count is compared beyond its preset"
"A CSCAPE counter stops at its preset, so its count is not above it. Elsewhere counting goes on, and programs
that were written there wait for the count to pass PV. (Only after PV was lowered can CV lie above it.)

    parts(CU := sensor, PV := 10);
    IF parts.CV > 10 THEN alarm := TRUE; END_IF      (* before *)
    IF parts.CV >= 10 THEN alarm := TRUE; END_IF     (* after *)
";
    W0608 Warning "an unsigned value is compared with what lies below zero"
"An unsigned value, or a bit string, is never negative: `x < 0` is always FALSE, `x >= 0` always TRUE. CODESYS counts
in WORD, so its counters stop at 0 where others go on to -1.

    down(CD := sensor);
    IF down.CV < 0 THEN alarm := TRUE; END_IF      (* before *)
    IF down.CV = 0 THEN alarm := TRUE; END_IF      (* after *)
";
    W0609 Warning "a pin has another name on this system"
"`staunch compare` reads the program as another system's. That system has the pin, under another name: R or RESET,
LD or LOAD, S1 or SET1. Inputs that are given by position need no change.

    parts(CU := sensor, R := clear, PV := 10);          (* IEC *)
    parts(CU := sensor, RESET := clear, PV := 10);      (* CODESYS, CSCAPE *)
    parts(sensor, clear, 10);                           (* all three *)
";
    W0612 Warning "a counter's own output resets it"
"The reset takes effect in the scan after the count is complete, and reset wins over counting. Where Q rises on an edge
of the counter's one input, nothing is lost by it: the input has no other edge in that scan. But a CSCAPE counter
counts calls and loses one; a CTUD loses an edge of its other input; and where the preset moves, Q rises without an
edge, so that one may arrive with the reset. Reset the counter in a second call in the scan in which it completes,
after what reads its output; the call that counts then says that it does not reset.

    both(CU := up, CD := down, R := done, LD := FALSE, PV := 10);       (* before *)
    done := both.QU;

    both(CU := up, CD := down, R := FALSE, LD := FALSE, PV := 10);      (* after *)
    done := both.QU;
    IF done THEN both(R := TRUE); END_IF
";
}
