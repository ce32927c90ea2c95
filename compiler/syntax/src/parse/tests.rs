//! Tests of the parser: trees, recovery, and texts of any kind.

mod recovery;
mod robust;
mod shape;
mod trees;
