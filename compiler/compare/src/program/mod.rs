//! What the text of one program says: its variables, what they are made of and compared with, and how it uses its
//! counters; and what two programs compute in other types.

pub mod scalar;

pub mod held;

pub mod walked;

pub mod flow;

pub mod bounds;
pub mod dependency;
pub mod facts;
pub mod usage;

pub mod apart;

pub mod moving_preset;
pub mod unfollowed;
