//! Machine files and controller profiles, from the outside.

mod builtin;
