//! Declared types, variables and signatures, and which types become which.

pub(crate) mod address;
pub(crate) mod coercion;
pub(crate) mod counter;
pub(crate) mod coverage;
pub(crate) mod declarations;
pub(crate) mod dispatches;
pub(crate) mod generic;
pub(crate) mod image;
pub(crate) mod in_outs;
pub(crate) mod index;
pub(crate) mod instances;
pub(crate) mod interfaces;
pub(crate) mod jumps;
mod overload_names;
pub(crate) mod overloads;
pub(crate) mod polymorphic;
pub(crate) mod pools;
pub(crate) mod scope;
pub(crate) mod signature;
mod started;
pub(crate) mod starts;
mod storage;
pub(crate) mod synthetic;
pub(crate) mod table;
pub(crate) mod tests;
pub(crate) mod whole;
pub(crate) mod window;
