//! Compiles the Structured Text beside it into a module of this crate.

fn main() {
    staunch_build::compile("src/parking_garage.st");
}
