//! Prints the random program of a seed: `cargo run -p staunch-witness --example generate 7`.

fn main() {
    let seed = std::env::args().nth(1).and_then(|it| it.parse().ok()).unwrap_or_default();
    print!("{}", staunch_witness::generate::program(seed));
}
