//! `ASSERT_NEAR`: a tolerance is a distance, whatever the type of the numbers can hold.

use super::{Folder, has};

const NEAR: &str = "TEST 'near'
VAR
    low : LINT := -9223372036854775808; high : LINT := 9223372036854775807;
    most : ULINT := 18446744073709551615; none : ULINT;
    cold : SINT := -100; full : USINT := 255; parts : UINT := 3; three : DINT := 3;
END_VAR
    ASSERT_NEAR(low, high, 18446744073709551615);
    ASSERT_NEAR(high, low, most);
    ASSERT_NEAR(most, none, 18446744073709551615);
    ASSERT_NEAR(none, most, most);
    ASSERT_NEAR(cold, 100, 200);
    ASSERT_NEAR(full, cold, 355);
    ASSERT_NEAR(cold, full, 355);
    ASSERT_NEAR(parts, 5, 2);
    ASSERT_NEAR(parts, 0, three);
    ASSERT_NEAR(parts, 3, 0);
    ASSERT_NEAR(5, 3, 2);
END_TEST
TEST 'a' VAR low : LINT := -9223372036854775808; END_VAR ASSERT_NEAR(low, 9223372036854775807, 18446744073709551614); END_TEST
TEST 'b' VAR none : ULINT; END_VAR ASSERT_NEAR(none, 18446744073709551615, 18446744073709551614); END_TEST
TEST 'c' VAR cold : SINT := -100; END_VAR ASSERT_NEAR(cold, 100, 199); END_TEST
TEST 'd' VAR parts : UINT := 3; END_VAR ASSERT_NEAR(parts, 5, 1); END_TEST
TEST 'e' VAR full : USINT; END_VAR ASSERT_NEAR(full, 255, 1); END_TEST
TEST 'f' VAR less : INT := -1; END_VAR ASSERT_NEAR(3, 3, less); END_TEST
TEST 'g' ASSERT_NEAR(T#1s, T#1200ms, T#100ms); END_TEST
";

/// In `codesys` a LINT meets a ULINT, and a DINT a UDINT.
const MIXED: &str = "{dialect 'codesys'}
TEST 'near'
VAR low : LINT := -9223372036854775808; less : LINT := -1; one : ULINT := 1; most : UDINT := 4294967295;
    least : DINT := -2147483648; word : WORD := 16#FFFF; END_VAR
    ASSERT_NEAR(most, least, 6442450943);
    ASSERT_NEAR(least, most, 6442450943);
    ASSERT_NEAR(less, one, 2);
    ASSERT_NEAR(one, less, 2);
    ASSERT_NEAR(low, one, 9223372036854775809);
    ASSERT_NEAR(word, 65530, 5);
END_TEST
TEST 'a' VAR less : LINT := -1; most : ULINT := 18446744073709551615; END_VAR ASSERT_NEAR(most, less, most); END_TEST
TEST 'b' VAR less : LINT := -1; most : ULINT := 18446744073709551615; END_VAR ASSERT_NEAR(less, most, most); END_TEST
TEST 'c' VAR less : LINT := -1; one : ULINT := 1; END_VAR ASSERT_NEAR(less, one, 1); END_TEST
TEST 'd' VAR less : DINT := -1; most : UDINT := 4294967295; END_VAR ASSERT_NEAR(less, most, 1); END_TEST
";

#[test]
fn integers_are_as_far_apart_as_they_are() {
    let folder = Folder::with("tests_near", &[("near.st", NEAR), ("mixed.st", MIXED)]);
    for backend in super::unit_tests::BACKENDS {
        let out = folder.staunch(&format!("test near.st --backend {backend}")).out(1);
        has(&out, &["ok      near\n", "\n1 passed, 7 failed\n"]);
        has(&out, &["expected to be within 199 of 100, found -100\n", "expected to be within -1 of 3, found 3\n"]);
        has(&out, &["expected to be within T#100ms of T#1s200ms, found T#1s\n"]);
        let out = folder.staunch(&format!("test mixed.st --backend {backend}")).out(1);
        has(&out, &["ok      near\n", "\n1 passed, 4 failed\n"]);
    }
}
