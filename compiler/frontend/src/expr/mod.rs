//! Expressions and calls: what types they have, and what they become. They are checked against
//! declarations, and resolve none.

mod argument;
mod binding;
mod block_call;
mod call;
pub(crate) mod call_tracking;
mod callee;
pub(crate) mod checker;
mod coerce;
pub(crate) mod constant;
mod constant_comparison;
mod conversion;
mod dates;
mod enable;
mod expression;
mod fold;
mod function;
mod literal;
mod logix_operands;
mod method;
mod migration;
pub(crate) mod operand;
pub(crate) mod operator;
mod order;
mod overload;
mod place;
mod promotion;
mod real;
mod reference;
mod retained;
pub(crate) mod standard;
mod string_compare;
mod text_conversion;
pub(crate) mod unresolved;
pub(crate) mod uses;
mod variadic;
mod view;
