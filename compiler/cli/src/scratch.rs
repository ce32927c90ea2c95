//! Folders for what a command needs meanwhile: private to the user, and gone when they are dropped.

use tempfile::TempDir;

pub fn folder() -> Result<TempDir, String> {
    let made = tempfile::Builder::new().prefix("staunch-").tempdir();
    made.map_err(|error| format!("cannot create a temporary folder: {error}"))
}
