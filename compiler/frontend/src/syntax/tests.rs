mod recovery;
mod robust;
mod shape;
mod trees;
