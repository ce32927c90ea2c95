//! The library TcUnit: its suite, with a METHOD for the arrays of each type that it compares.

/// Whether two arrays differ, and where, for the assertion `AssertArrayEquals_…`.
macro_rules! arrays {
    ($($ty:literal)*) => {
        concat!($(
            "METHOD __ARRAYS_", $ty, " : BOOL\n",
            "VAR_IN_OUT Expecteds, Actuals : ARRAY[*] OF ", $ty, "; END_VAR\n",
            "VAR low, n, distance : DINT; END_VAR\n",
            "low := LOWER_BOUND(Expecteds, 1);\n",
            "distance := LOWER_BOUND(Actuals, 1) - low;\n",
            "IF __SIZES_DIFFER(UPPER_BOUND(Expecteds, 1) - low + 1, UPPER_BOUND(Actuals, 1) - low - distance + 1) THEN\n",
            "__ARRAYS_", $ty, " := TRUE; RETURN; END_IF;\n",
            "FOR n := low TO UPPER_BOUND(Expecteds, 1) DO\n",
            "IF Expecteds[n] <> Actuals[n + distance] THEN\n",
            "__NOTE(__INDEX(n), __INDEX(n + distance), ",
            $ty, "_TO_STRING(Expecteds[n]), ", $ty, "_TO_STRING(Actuals[n + distance]));\n",
            "__ARRAYS_", $ty, " := TRUE; RETURN; END_IF; END_FOR;\n",
            "END_METHOD\n",
        )*)
    };
}

/// The same within a distance, of one, two and three dimensions. Arrays of several dimensions begin at the same indices,
/// or are seen as if they did.
macro_rules! real_arrays {
    ($($ty:literal)*) => {
        concat!($(
            "METHOD __DIFFER_", $ty, " : BOOL\n",
            "VAR_INPUT expected, actual, delta : ", $ty, "; END_VAR\n",
            "__DIFFER_", $ty, " := NOT (expected = actual OR ABS(expected - actual) <= delta);\n",
            "IF __DIFFER_", $ty, " THEN __expected := ", $ty, "_TO_STRING(expected); __actual := ", $ty, "_TO_STRING(actual); END_IF;\n",
            "END_METHOD\n",
            "METHOD __ARRAYS_", $ty, " : BOOL\n",
            "VAR_IN_OUT Expecteds, Actuals : ARRAY[*] OF ", $ty, "; END_VAR\n",
            "VAR_INPUT Delta : ", $ty, "; END_VAR\n",
            "VAR low, n, d : DINT; END_VAR\n",
            "low := LOWER_BOUND(Expecteds, 1); d := LOWER_BOUND(Actuals, 1) - low;\n",
            "__ARRAYS_", $ty, " := __SIZES_DIFFER(UPPER_BOUND(Expecteds, 1) - low + 1, UPPER_BOUND(Actuals, 1) - low - d + 1);\n",
            "IF __ARRAYS_", $ty, " THEN RETURN; END_IF;\n",
            "FOR n := low TO UPPER_BOUND(Expecteds, 1) DO\n",
            "IF __DIFFER_", $ty, "(Expecteds[n], Actuals[n + d], Delta) THEN\n",
            "__NOTE(__INDEX(n), __INDEX(n + d), __expected, __actual);\n",
            "__ARRAYS_", $ty, " := TRUE; RETURN; END_IF; END_FOR;\n",
            "END_METHOD\n",
            "METHOD __ARRAYS2_", $ty, " : BOOL\n",
            "VAR_IN_OUT Expecteds, Actuals : ARRAY[*, *] OF ", $ty, "; END_VAR\n",
            "VAR_INPUT Delta : ", $ty, "; END_VAR\n",
            "VAR low, low2, n, n2, d, d2 : DINT; END_VAR\n",
            "low := LOWER_BOUND(Expecteds, 1); d := LOWER_BOUND(Actuals, 1) - low;\n",
            "low2 := LOWER_BOUND(Expecteds, 2); d2 := LOWER_BOUND(Actuals, 2) - low2;\n",
            "__ARRAYS2_", $ty, " := __SIZES_DIFFER(UPPER_BOUND(Expecteds, 1) - low + 1, UPPER_BOUND(Actuals, 1) - low - d + 1)\n",
            "OR __SIZES_DIFFER(UPPER_BOUND(Expecteds, 2) - low2 + 1, UPPER_BOUND(Actuals, 2) - low2 - d2 + 1);\n",
            "IF __ARRAYS2_", $ty, " THEN RETURN; END_IF;\n",
            "FOR n := low TO UPPER_BOUND(Expecteds, 1) DO FOR n2 := low2 TO UPPER_BOUND(Expecteds, 2) DO\n",
            "IF __DIFFER_", $ty, "(Expecteds[n, n2], Actuals[n + d, n2 + d2], Delta) THEN\n",
            "__NOTE(CONCAT(__INDEX(n), __INDEX(n2)), CONCAT(__INDEX(n + d), __INDEX(n2 + d2)), __expected, __actual);\n",
            "__ARRAYS2_", $ty, " := TRUE; RETURN; END_IF; END_FOR; END_FOR;\n",
            "END_METHOD\n",
            "METHOD __ARRAYS3_", $ty, " : BOOL\n",
            "VAR_IN_OUT Expecteds, Actuals : ARRAY[*, *, *] OF ", $ty, "; END_VAR\n",
            "VAR_INPUT Delta : ", $ty, "; END_VAR\n",
            "VAR low, low2, low3, n, n2, n3, d, d2, d3 : DINT; END_VAR\n",
            "low := LOWER_BOUND(Expecteds, 1); d := LOWER_BOUND(Actuals, 1) - low;\n",
            "low2 := LOWER_BOUND(Expecteds, 2); d2 := LOWER_BOUND(Actuals, 2) - low2;\n",
            "low3 := LOWER_BOUND(Expecteds, 3); d3 := LOWER_BOUND(Actuals, 3) - low3;\n",
            "__ARRAYS3_", $ty, " := __SIZES_DIFFER(UPPER_BOUND(Expecteds, 1) - low + 1, UPPER_BOUND(Actuals, 1) - low - d + 1)\n",
            "OR __SIZES_DIFFER(UPPER_BOUND(Expecteds, 2) - low2 + 1, UPPER_BOUND(Actuals, 2) - low2 - d2 + 1)\n",
            "OR __SIZES_DIFFER(UPPER_BOUND(Expecteds, 3) - low3 + 1, UPPER_BOUND(Actuals, 3) - low3 - d3 + 1);\n",
            "IF __ARRAYS3_", $ty, " THEN RETURN; END_IF;\n",
            "FOR n := low TO UPPER_BOUND(Expecteds, 1) DO FOR n2 := low2 TO UPPER_BOUND(Expecteds, 2) DO\n",
            "FOR n3 := low3 TO UPPER_BOUND(Expecteds, 3) DO\n",
            "IF __DIFFER_", $ty, "(Expecteds[n, n2, n3], Actuals[n + d, n2 + d2, n3 + d3], Delta) THEN\n",
            "__NOTE(CONCAT(CONCAT(__INDEX(n), __INDEX(n2)), __INDEX(n3)),\n",
            "CONCAT(CONCAT(__INDEX(n + d), __INDEX(n2 + d2)), __INDEX(n3 + d3)), __expected, __actual);\n",
            "__ARRAYS3_", $ty, " := TRUE; RETURN; END_IF; END_FOR; END_FOR; END_FOR;\n",
            "END_METHOD\n",
        )*)
    };
}

pub(super) const TEXT: &str = concat!(
    include_str!("tcunit.st"),
    "METHOD __INDEX : STRING\nVAR_INPUT n : DINT; END_VAR\n",
    "__INDEX := CONCAT(CONCAT('[', DINT_TO_STRING(n)), ']');\nEND_METHOD\n",
    arrays!("BOOL" "BYTE" "WORD" "DWORD" "LWORD" "SINT" "INT" "DINT" "LINT" "USINT" "UINT" "UDINT" "ULINT"),
    real_arrays!("REAL" "LREAL"),
    "END_FUNCTION_BLOCK\nEND_NAMESPACE\n"
);

/// What writes to a variable that others may only read, by its address.
macro_rules! write_protected {
    ($($ty:literal)*) => {
        concat!($(
            "FUNCTION WRITE_PROTECTED_", $ty, "\nVAR_INPUT Ptr : POINTER TO ", $ty, "; Value : ", $ty, "; END_VAR\n",
            "Ptr^ := Value;\nEND_FUNCTION\n",
        )*)
    };
}
pub(super) use write_protected;

/// All of them, where they are named with the library's name before.
pub(super) const WRITE_PROTECTED: &str = concat!(
    "NAMESPACE TcUnit\n",
    write_protected!("BOOL" "BYTE" "WORD" "DWORD" "LWORD" "SINT" "INT" "DINT" "LINT" "USINT" "UINT" "UDINT" "ULINT"),
    write_protected!("REAL" "LREAL" "TIME" "DATE" "TIME_OF_DAY" "DATE_AND_TIME" "STRING" "WSTRING"),
    "END_NAMESPACE\n"
);
