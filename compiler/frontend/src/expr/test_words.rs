//! The words that only a test has.

use crate::spelling::nearest;

/// How many values each takes, and how it is written.
pub(crate) const WORDS: [(&str, usize, &str); 14] = [
    ("ASSERT_TRUE", 1, "ASSERT_TRUE(condition);"),
    ("ASSERT_FALSE", 1, "ASSERT_FALSE(condition);"),
    ("ASSERT_EQ", 2, "ASSERT_EQ(actual, expected);"),
    ("ASSERT_NEQ", 2, "ASSERT_NEQ(actual, expected);"),
    ("ASSERT_GT", 2, "ASSERT_GT(actual, expected);"),
    ("ASSERT_LT", 2, "ASSERT_LT(actual, expected);"),
    ("ASSERT_GE", 2, "ASSERT_GE(actual, expected);"),
    ("ASSERT_LE", 2, "ASSERT_LE(actual, expected);"),
    ("ASSERT_NEAR", 3, "ASSERT_NEAR(actual, expected, tolerance);"),
    ("MOCK_VERIFY_CALLED", 1, "MOCK_VERIFY_CALLED(instance);"),
    ("MOCK_VERIFY_CALL_COUNT", 2, "MOCK_VERIFY_CALL_COUNT(instance, count);"),
    ("MOCK", 1, "MOCK instance;"),
    ("MOCK_FUNCTION", 2, "MOCK_FUNCTION name RETURNS value;"),
    ("ADVANCE_TIME", 1, "ADVANCE_TIME(T#100ms);"),
];

/// What is tried in their place, by what other tools have.
const TRIED: [(&str, &str); 9] = [
    ("ADVANCE", "ADVANCE_TIME"),
    ("DELAY", "ADVANCE_TIME"),
    ("SLEEP", "ADVANCE_TIME"),
    ("WAIT", "ADVANCE_TIME"),
    ("ASSERT_EQUAL", "ASSERT_EQ"),
    ("ASSERT_EQUALS", "ASSERT_EQ"),
    ("ASSERTEQUALS", "ASSERT_EQ"),
    ("ASSERT_NE", "ASSERT_NEQ"),
    ("EXPECT", "ASSERT_TRUE"),
];

/// What may help who wrote a name in a test that nothing has.
pub(super) fn hint(name: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    if ["CYCLE", "RUN", "SCAN"].contains(&upper.as_str()) {
        return Some(
            "a test scans by a call of the instance, `machine();`; time passes by `ADVANCE_TIME(T#100ms);`".to_owned(),
        );
    }
    let tried = TRIED.iter().find(|it| upper == it.0).map(|it| it.1);
    let word = tried.or_else(|| nearest(name, WORDS.iter().map(|it| it.0)))?;
    let (.., form) = WORDS.iter().find(|it| it.0 == word)?;
    Some(format!("in a test write `{form}`"))
}
