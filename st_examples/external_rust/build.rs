//! Compiles the Structured Text, whose external FUNCTIONs this crate has.

fn main() {
    staunch_build::compile("src/scale.st");
}
