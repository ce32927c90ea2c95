//! Systems other than Linux: no line can be requested.

use super::group::Group;
use super::lines::{Chips, Lines};

pub(super) struct Kernel;

impl Chips for Kernel {
    fn open(&self, _: &Group) -> Result<Box<dyn Lines>, String> {
        Err("only on Linux are GPIO lines read and written".to_owned())
    }
}
