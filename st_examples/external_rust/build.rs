fn main() {
    staunch_build::compile("src/scale.st");
}
