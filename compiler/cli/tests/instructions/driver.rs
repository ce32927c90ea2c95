//! What calls the scans of a program with the inputs of its first lines, and prints a hash of the outputs after each.

use crate::perf;
use crate::subject::Subject;
use std::fmt::Write;

/// How C reaches a program.
struct Called<'a> {
    /// Declarations.
    head: String,
    start: &'a str,
    scan: String,
    set: &'a dyn Fn(&str, &str) -> String,
    get: &'a dyn Fn(&str) -> String,
    /// What is printed besides, of type `unsigned long long`.
    end: &'a str,
}

const STATE_HASH: &str = "    unsigned long long all = 0xcbf29ce484222325u;
    for (uint32_t i = 0; i < STAUNCH_STATE_SIZE; i++) all = (all ^ state[i]) * 0x100000001b3u;
";

/// C for a program that was compiled; it prints a hash of the whole state as well.
pub fn compiled(subject: &Subject) -> String {
    let program = &subject.program;
    let called = Called {
        head: "#include \"program.h\"\nstatic _Alignas(64) uint8_t state[STAUNCH_STATE_SIZE];\n".to_owned(),
        start: "    staunch_init(state);\n",
        scan: format!(
            "        staunch_context cx = {{ .now = (int64_t)s * 1000000, .first_scan = s == 0, .turns = STAUNCH_TURNS, .cycle = 1000000 }};
        if (staunch_scan(state, &cx, STAUNCH_{program}) != 0) return 1;\n"
        ),
        set: &|name, value| format!("STAUNCH_{program}_{name}(state) = {value};"),
        get: &|name| format!("STAUNCH_{program}_{name}(state)"),
        end: STATE_HASH,
    };
    text(subject, &called)
}

/// C for the program by hand.
pub fn by_hand(subject: &Subject) -> String {
    let mut head = "#include <stdint.h>\nvoid by_hand_scan(int64_t now);\n".to_owned();
    for (name, _) in &subject.inputs {
        writeln!(head, "void by_hand_set_{name}(double value);").unwrap();
    }
    for name in &subject.outputs {
        writeln!(head, "double by_hand_get_{name}(void);").unwrap();
    }
    let called = Called {
        head,
        start: "",
        scan: "        by_hand_scan((int64_t)s * 1000000);\n".to_owned(),
        set: &|name, value| format!("by_hand_set_{name}({value});"),
        get: &|name| format!("by_hand_get_{name}()"),
        end: "    unsigned long long all = 0;\n",
    };
    text(subject, &called)
}

fn text(subject: &Subject, called: &Called<'_>) -> String {
    let (mut inputs, mut outputs) = (String::new(), String::new());
    for (name, value) in &subject.inputs {
        writeln!(inputs, "        {}", (called.set)(name, value)).unwrap();
    }
    for name in &subject.outputs {
        writeln!(outputs, "        hash = hashed(hash, {});", (called.get)(name)).unwrap();
    }
    let Called { head, start, scan, end, .. } = called;
    let scans = subject.scans;
    format!(
        "{head}#include <stdio.h>
#include <string.h>
static unsigned long long hashed(unsigned long long hash, double value) {{
    unsigned long long bits;
    memcpy(&bits, &value, sizeof bits);
    return (hash ^ bits) * 0x100000001b3u;
}}
int main(void) {{
    unsigned long long hash = 0xcbf29ce484222325u;
{start}    for (uint32_t s = 0; s < {scans}; s++) {{
{inputs}{scan}{outputs}    }}
{end}    printf(\"%016llx %016llx\", hash, all);
    return 0;
}}
"
    )
}

/// Rust around the program by hand, so that C can call it. The program is a symbol that others may use: else the optimiser
/// would leave out what no line of this crate reads, as pins of blocks, and take for constant what none writes.
pub fn around_by_hand(subject: &Subject) -> String {
    let folder = perf().join("by_hand");
    let mut text = format!(
        "#![no_std]
#![allow(non_snake_case)]
#[path = {:?}] mod blocks;
#[path = {:?}] mod by_hand;
use by_hand::Program;
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {{ loop {{}} }}
trait Number {{ fn set(&mut self, value: f64); fn get(&self) -> f64; }}
impl Number for bool {{ fn set(&mut self, value: f64) {{ *self = value != 0.0; }} fn get(&self) -> f64 {{ f64::from(u8::from(*self)) }} }}
macro_rules! numbers {{ ($($t:ty)*) => {{ $(impl Number for $t {{
    fn set(&mut self, value: f64) {{ *self = value as i64 as $t; }} fn get(&self) -> f64 {{ *self as f64 }} }})* }} }}
numbers!(i8 i16 i32 u8 u16 u32);
macro_rules! reals {{ ($($t:ty)*) => {{ $(impl Number for $t {{
    fn set(&mut self, value: f64) {{ *self = value as $t; }} fn get(&self) -> f64 {{ *self as f64 }} }})* }} }}
reals!(f32 f64);
#[unsafe(no_mangle)]
pub static mut PROGRAM: Program = Program::NEW;
fn program() -> &'static mut Program {{ unsafe {{ &mut *&raw mut PROGRAM }} }}
#[unsafe(no_mangle)]
pub extern \"C\" fn by_hand_scan(now: i64) {{ program().scan(now); }}
",
        folder.join("blocks.rs"),
        subject.by_hand.as_ref().unwrap(),
    );
    let field = |name: &str| match name.to_lowercase().as_str() {
        "box" => "r#box".to_owned(),
        other => other.to_owned(),
    };
    for (name, _) in &subject.inputs {
        let field = field(name);
        writeln!(text, "#[unsafe(no_mangle)] pub extern \"C\" fn by_hand_set_{name}(value: f64) {{ program().{field}.set(value); }}").unwrap();
    }
    for name in &subject.outputs {
        let field = field(name);
        writeln!(
            text,
            "#[unsafe(no_mangle)] pub extern \"C\" fn by_hand_get_{name}() -> f64 {{ program().{field}.get() }}"
        )
        .unwrap();
    }
    text
}
