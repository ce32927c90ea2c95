//! How much of the stack functions take that are not the program's own, and how many instructions.
//!
//! What the runtime's functions take was measured in their code for x86-64, over all that they call. Stacks are at least twice as
//! much, for other compilers and machines. A function of the C library that copies or fills memory takes a few registers.
//!
//! `straight.tsv` has the longest way through each function of the runtime without a loop; a quarter is added for other
//! compilers. Functions with loops are counted by the size that they work on, as far as calls show it, or were run with all
//! kinds of values. Others are in no table: nothing is known of them.

/// By what a symbol of the runtime begins with; the first that fits.
const RUNTIME: [(&str, u64); 9] = [
    // Numbers to text and back, in all digits.
    ("staunch_text_from_", 2560),
    ("staunch_text_to_", 2560),
    ("staunch_reference_", 1408),
    // Angles that are reduced by many digits of pi.
    ("staunch_sin_", 1408),
    ("staunch_cos_", 1408),
    ("staunch_tan_", 1408),
    ("staunch_text_", 512),
    ("staunch_wide_text_", 512),
    ("staunch_", 384),
];

/// What the code generator calls of the C library.
const C_LIBRARY: [&str; 11] =
    ["memcpy", "memmove", "memset", "ceil", "ceilf", "floor", "floorf", "trunc", "truncf", "nearbyint", "nearbyintf"];
const OF_C_LIBRARY: u64 = 256;

/// The bytes of the stack that a call takes, with the calls that it makes; `None` for a function that is implemented outside.
pub fn stack_outside(symbol: &str) -> Option<u64> {
    if C_LIBRARY.contains(&symbol) {
        return Some(OF_C_LIBRARY);
    }
    let mut is_of_runtime = false;
    staunch_runtime_abi::for_each_symbol(&mut |name, _| is_of_runtime |= name == symbol);
    let found = RUNTIME.iter().find(|(start, _)| symbol.starts_with(start));
    found.filter(|_| is_of_runtime).map(|it| it.1)
}

/// Functions without loops, by their symbols without `staunch_` and the names of types.
const STRAIGHT: &str = include_str!("straight.tsv");

/// Functions with loops: what a call takes, and what each byte or character adds.
const LOOPS: [(&str, u64, u64); 37] = [
    ("memcpy", 64, 1),
    ("memmove", 64, 1),
    ("memset", 64, 1),
    ("ceil", 64, 0),
    ("floor", 64, 0),
    ("trunc", 64, 0),
    ("nearbyint", 64, 0),
    ("staunch_sin", 2200, 0),
    ("staunch_cos", 2200, 0),
    ("staunch_tan", 2200, 0),
    ("staunch_atan2", 96, 0),
    ("staunch_text_from_lreal", 2400, 0),
    ("staunch_text_from_real", 2400, 0),
    ("staunch_text_from_lint", 900, 0),
    ("staunch_text_from_ulint", 900, 0),
    ("staunch_text_append", 64, 3),
    ("staunch_wide_text_append", 64, 3),
    ("staunch_text_copy", 192, 4),
    ("staunch_wide_text_copy", 192, 6),
    ("staunch_text_clear", 96, 2),
    ("staunch_wide_text_clear", 96, 4),
    ("staunch_text_left", 384, 4),
    ("staunch_text_right", 384, 4),
    ("staunch_text_mid", 384, 4),
    ("staunch_text_concat", 384, 4),
    ("staunch_text_insert", 384, 4),
    ("staunch_text_delete", 384, 4),
    ("staunch_text_replace", 384, 4),
    ("staunch_wide_text_left", 384, 6),
    ("staunch_wide_text_right", 384, 6),
    ("staunch_wide_text_mid", 384, 6),
    ("staunch_wide_text_concat", 384, 6),
    ("staunch_wide_text_insert", 384, 6),
    ("staunch_wide_text_delete", 384, 6),
    ("staunch_wide_text_replace", 384, 6),
    ("staunch_text_compare", 160, 4),
    ("staunch_text_compare_start", 160, 4),
];

/// Words of a symbol that are a type.
const TYPES: [&str; 11] = ["i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64", "f32", "f64", "bool"];

/// The instructions of a call, with those of the calls that it makes, where it works on so many bytes or characters at most;
/// `None` if that is not known.
pub(crate) fn instructions_outside(symbol: &str, size: Option<u64>) -> Option<u64> {
    stack_outside(symbol)?;
    let words: Vec<&str> = symbol.split('_').filter(|it| !TYPES.contains(it)).collect();
    let name = words.join("_");
    if let Some((_, call, each)) = LOOPS.iter().find(|it| it.0 == name || it.0 == name.trim_end_matches('f')) {
        let size = if *each == 0 { 0 } else { size? };
        return Some(each.saturating_mul(size).saturating_add(*call));
    }
    let own = name.strip_prefix("staunch_")?;
    let (_, most) = STRAIGHT.lines().filter_map(|it| it.split_once('\t')).find(|it| it.0 == own)?;
    let most: u64 = most.parse().ok()?;
    Some(most + most / 4 + 4)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_the_runtime_is_known() {
        staunch_runtime_abi::for_each_symbol(&mut |name, _| assert!(stack_outside(name).is_some(), "{name}"));
        assert_eq!(stack_outside("memcpy"), Some(OF_C_LIBRARY));
        assert_eq!(stack_outside("staunch_of_a_user"), None);
        assert_eq!(stack_outside("read_sensor"), None);
    }

    #[test]
    fn instructions_are_of_functions_that_exist() {
        let mut names = std::collections::BTreeSet::new();
        staunch_runtime_abi::for_each_symbol(&mut |name, _| {
            let words: Vec<&str> = name.split('_').filter(|it| !TYPES.contains(it)).collect();
            names.insert(words.join("_"));
        });
        for line in STRAIGHT.lines() {
            let (name, number) = line.split_once('\t').unwrap();
            assert!(names.contains(&format!("staunch_{name}")) && number.parse::<u64>().is_ok(), "{line}");
        }
        for (name, ..) in LOOPS {
            assert!(names.contains(name) || C_LIBRARY.contains(&name), "{name}");
        }
    }

    #[test]
    fn instructions_depend_on_the_size() {
        assert_eq!(instructions_outside("memcpy", Some(1000)), Some(1064));
        assert_eq!(instructions_outside("memcpy", None), None);
        assert_eq!(instructions_outside("nearbyintf", None), Some(64));
        assert!(instructions_outside("staunch_div_i32", None).is_some_and(|it| (4..40).contains(&it)));
        assert_eq!(instructions_outside("staunch_text_find", None), None);
        assert_eq!(instructions_outside("read_sensor", Some(1)), None);
    }
}
