//! Compiles the Structured Text next to it into a module of this crate.

fn main() {
    staunch_build::compile("src/parking_garage.st");
}
