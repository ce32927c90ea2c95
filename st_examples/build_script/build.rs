fn main() {
    staunch_build::compile("src/parking_garage.st");
}
