//! What the world outside may do: the values of the inputs that are tried, and what they are said never to be.

pub mod choice;

pub mod assume;

pub mod alphabet;
